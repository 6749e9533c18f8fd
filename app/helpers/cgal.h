/* CGAL behind C. Lengths are those of the input; the caller brings it to a diagonal of about 1. */
#ifndef SPORE_HELPERS_CGAL_H
#define SPORE_HELPERS_CGAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/helpers/failure.h"
#include "core/mesh/sizing.h"
#include "core/io/tetrahedra_wire.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Triangles (3 corners a cell, counter-clockwise from outside) or tetrahedra (4, positive volume); arrays malloc'ed. */
typedef struct SporeFlatMesh {
  size_t vertex_count, cell_count;
  double *vertices;
  uint32_t *corners;
} SporeFlatMesh;

/* Closed, oriented, bounding a volume and free of self-intersections: what Mesh_3 can take. */
bool spore_cgal_check(const SporeFlatMesh *surface, SporeHelperFailure *failure);
/* Stitches, orients, fills holes, removes degenerate triangles and what bounds no volume. The result passes the check.
 */
bool spore_cgal_repair(const SporeFlatMesh *surface, SporeFlatMesh *result, SporeHelperFailure *failure);
/* Alpha wrapping (Portaneri et al. 2022, "Alpha wrapping with an offset"): gaps narrower than alpha are closed, the
 * result lies about `offset` outside. The result passes the check. Refused where it takes more than `most_vertices`. */
bool spore_cgal_wrap(const SporeFlatMesh *surface, double alpha, double offset, size_t most_vertices,
                     SporeFlatMesh *result, SporeHelperFailure *failure);

/* Delaunay refinement of a surface that passes the check: circumradii of cells and of facets follow the sizing, and
 * facets lie within a tenth of it of the surface. Refused above `most_vertices`. */
bool spore_cgal_mesh(const SporeFlatMesh *surface, const SporeSizing *sizing, SporeTetrahedraFinish finish,
                     size_t most_vertices, void (*progress)(double fraction, const char *stage), SporeFlatMesh *result,
                     SporeHelperFailure *failure);

#ifdef __cplusplus
}
#endif

#endif
