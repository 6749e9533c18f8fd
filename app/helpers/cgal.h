/* An interface in C to CGAL. Lengths are in units of the input, which the caller scales to a diagonal of about 1. */
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

/* Checks that the surface is closed, oriented, bounds a volume and has no self-intersections, as Mesh_3 needs. */
bool spore_cgal_check(const SporeFlatMesh *surface, SporeHelperFailure *failure);
/* Stitches and orients the surface, fills holes, and removes degenerate triangles and parts without volume. The result
 * passes the check. */
bool spore_cgal_repair(const SporeFlatMesh *surface, SporeFlatMesh *result, SporeHelperFailure *failure);
/* Alpha wrapping (Portaneri et al. 2022, "Alpha wrapping with an offset"). Gaps narrower than alpha are closed, and the
 * result lies about `offset` outside. The result passes the check. Refused where the result needs more than
 * `most_vertices`. */
bool spore_cgal_wrap(const SporeFlatMesh *surface, double alpha, double offset, size_t most_vertices,
                     SporeFlatMesh *result, SporeHelperFailure *failure);

/* Delaunay refinement of a surface that passes the check. Circumradii of cells and facets follow the sizing, and facets
 * lie within a tenth of the local size of the surface. Refused above `most_vertices`. */
bool spore_cgal_mesh(const SporeFlatMesh *surface, const SporeSizing *sizing, SporeTetrahedraFinish finish,
                     size_t most_vertices, void (*progress)(double fraction, const char *stage), SporeFlatMesh *result,
                     SporeHelperFailure *failure);

#ifdef __cplusplus
}
#endif

#endif
