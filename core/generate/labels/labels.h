/* Tetrahedra of several organs at once from a label map, with shared faces where they touch. */
#ifndef SPORE_GENERATE_LABELS_LABELS_H
#define SPORE_GENERATE_LABELS_LABELS_H

#include "core/io/label_map.h"
#include "core/mesh/mesh.h"

typedef struct SporeLabelTetrahedraOptions {
  size_t cells;           /* wanted of all labels together, about; or 0 to go by size */
  double size;            /* m, edge of the lattice's cubes, when cells is 0 */
  const uint16_t *labels; /* wanted ones; the rest counts as nothing */
  size_t label_count;     /* 0: all above 0 */
} SporeLabelTetrahedraOptions;

typedef struct SporeLabelFigures {
  uint16_t label;
  size_t cells;
  double volume, voxel_volume; /* m^3: of its cells, of its voxels */
  double min_dihedral_deg;
} SporeLabelFigures;

typedef struct SporeLabelTetrahedraReport {
  GArray *labels; /* of SporeLabelFigures, ascending; g_array_unref */
  SporeTetrahedraQuality quality;
  size_t shared_faces; /* between two organs */
  double edge;         /* m, of the lattice's cubes */
  double seconds;
} SporeLabelTetrahedraReport;

/* A body-centred cubic lattice whose cells take the label that has most of them, of the voxels' labels blurred by one
 * voxel (no layer of a voxel is lost by that); its vertices between labels then move to where the labels' shares are
 * alike (against nothing: where that has half), as far as no angle between faces gets nearer than 15 degrees to flat or
 * to nothing; cells that the border could not pass change sides. Where a number of cells is asked for the lattice has
 * up to 24 times as many, and is made coarser where that moves the borders least, which then give way a little for each
 * label's volume: no angle gets below 11 degrees then. So every cell is sound, and organs share the faces between them.
 * result->labels says of which organ each tetrahedron is. An organ finer than the lattice may have no cell: the figures
 * say so. FALSE: nothing to mesh, too many cells, no memory, cancelled. */
gboolean spore_label_tetrahedra(const char *place, const SporeLabelMap *map, const SporeLabelTetrahedraOptions *options,
                                SporeTetrahedralMesh *result, SporeLabelTetrahedraReport *report,
                                const SporeProgress *progress, GError **error);

/* The closed surface of one label at the voxels' resolution (marching tetrahedra, corners halfway between voxels). */
bool spore_label_surface(const SporeLabelMap *map, uint16_t label, SporeTriangleMesh *surface,
                         const SporeProgress *progress, SporeError *error);

#endif
