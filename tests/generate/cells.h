/* What tests of tetrahedra begin with, and what holds for each result. */
#ifndef SPORE_TESTS_GENERATE_CELLS_H
#define SPORE_TESTS_GENERATE_CELLS_H

#include "core/generate/tetrahedra/tetrahedra.h"

#define CHAIN .method = SPORE_TETRAHEDRA_METHODS

typedef struct {
  SporeTetrahedralMesh mesh; /* to be cleared */
  SporeTetrahedraReport report;
} Result;

/* Meshes by `method` (without CGAL "voxels", where the chain is asked for) and checks what holds for every result;
 * clears the surface. */
Result fill(SporeTriangleMesh *surface, SporeTetrahedraOptions options, const char *method);
/* Refused with that code, in one line that holds `words`. */
void check_refused(SporeTriangleMesh *surface, SporeTetrahedraOptions options, int code, const char *words);
/* About as many as wanted. */
void check_cells(Result *result, double wanted);

#endif
