/* How results of generators are shown: one table, by what a result is. No
 * GTK. */
#ifndef SPORE_UI_JOBS_GENERATE_TYPES_H
#define SPORE_UI_JOBS_GENERATE_TYPES_H

#include "ui/jobs/quality.h"
#include "ui/render/stage.h"

/* A quality of a result, by colours and as a histogram. */
typedef struct SporeGenerateQuality {
  const char *label, *unit; /* label: N_ */
  gboolean names;           /* the values number things: they are no measure of how good it is */
  /* Fills count, values and, where they differ, weights. */
  void (*measure)(const SporeGenerateWork *work, SporeQuality *quality);
  /* Shows them: places are the values on the scale of colours (spore_quality_place), taken. */
  void (*show)(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate);
} SporeGenerateQuality;

typedef struct SporeGenerateType {
  const char *shows; /* as a generator says */
  gboolean cells;    /* the result is of cells, and can be seen cut open */

  /* Error against number: for these numbers, ended by 0; NULL: no plot. */
  const size_t *counts;
  const char *error_label; /* N_ */
  double worth;            /* %, that twice the number must lower the error by */

  const SporeGenerateQuality *qualities; /* at least one */
  gsize quality_count;

} SporeGenerateType;

extern const SporeGenerateType spore_generate_spheres, spore_generate_tetrahedra, spore_generate_curve,
    spore_generate_surface, spore_generate_labels;
const SporeGenerateType *spore_generate_type(SporeGenerateKind kind);

/* values x scale, without sign, every stride-th; g_free. */
double *spore_generate_scaled(const double *values, gsize count, gsize stride, double scale);
/* Copies a surface into a candidate, with a place on the scale a vertex (taken) or none. */
void spore_generate_show_surface(const SporeTriangleMesh *mesh, float *places, SporeStageCandidate *candidate);
/* Triangles of three corners each (count x 3 x 3, m) with one place on the scale each; takes both. */
void spore_generate_show_triangles(double *corners, gsize count, float *places, SporeStageCandidate *candidate);
/* Least angle between faces of each tetrahedron, degrees. */
void spore_generate_measure_angles(const SporeGenerateWork *work, SporeQuality *quality);
/* The outside of cells, each face in the colour of its cell, as the candidate's view wants them. */
void spore_generate_show_cells(const SporeTetrahedralMesh *mesh, float *places, SporeStageCandidate *candidate);
void spore_generate_show_spheres(const SporeSphereSet *set, float *places, SporeStageCandidate *candidate);

#endif
