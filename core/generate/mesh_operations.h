/* What an author may have done to a mesh, with the figures before and after: one table for command line, help and
 * editor. */
#ifndef SPORE_GENERATE_MESH_OPERATIONS_H
#define SPORE_GENERATE_MESH_OPERATIONS_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* In the order in which several are done. */
typedef enum SporeMeshOperationKind {
  SPORE_MESH_WELD,
  SPORE_MESH_CLEAN,
  SPORE_MESH_ORIENT,
  SPORE_MESH_FILL_HOLES,
  SPORE_MESH_SMOOTH,
  SPORE_MESH_DECIMATE,
  SPORE_MESH_OPERATIONS
} SporeMeshOperationKind;

typedef struct SporeMeshOperation {
  const char *name;               /* of the option and in reports: "fill-holes" */
  const char *label, *doc;        /* translatable */
  const char *argument;           /* "EDGES"; NULL: it takes none */
  const char *argument_label;     /* translatable */
  bool argument_optional;         /* `usual` where it is not given */
  double minimum, maximum, usual; /* of the argument */
  bool whole;                     /* it is a whole number */
} SporeMeshOperation;

extern const SporeMeshOperation spore_mesh_operations[SPORE_MESH_OPERATIONS];

/* In range, and whole where it must be; any where the operation takes none. */
bool spore_mesh_argument_is_valid(const SporeMeshOperation *operation, double argument);

typedef struct SporeMeshFigures {
  size_t vertices, triangles;
  SporeMeshReport report;
} SporeMeshFigures;
bool spore_mesh_figures(const SporeTriangleMesh *mesh, SporeMeshFigures *figures, SporeError *error);

typedef struct SporeMeshChange {
  SporeMeshOperationKind operation;
  double argument;
  SporeMeshFigures before, after;
  double moved; /* m, sampled Hausdorff distance, both ways, between the surface before and after */
} SporeMeshChange;

/* Does it in place; *change may be NULL. False: the argument is out of range, no memory, cancelled, or nothing would be
 * left; the mesh is then as it was. */
bool spore_mesh_operate(SporeTriangleMesh *mesh, SporeMeshOperationKind operation, double argument,
                        SporeMeshChange *change, const SporeProgress *progress, SporeError *error);

#endif
