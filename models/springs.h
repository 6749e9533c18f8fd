/* Springs between the nodes of a model. */
#ifndef SPORE_MODELS_SPRINGS_H
#define SPORE_MODELS_SPRINGS_H

#include "core/linalg/block_matrix.h"
#include "core/mesh/mesh.h"

/* A spring between nodes at distance l pulls with stiffness (l - length) along the line between them, and damps the
 * speed of that distance. Where the nodes meet and there is no line, it works along `direction`, that of rest. */
typedef struct SporeSprings {
  size_t count;
  uint32_t *nodes;   /* count x 2 */
  double *length;    /* count, at rest, m */
  double *direction; /* count x 3, unit, from the second node to the first at rest; 0 where length is 0 */
  double *stiffness; /* count, N/m */
  double damping;    /* N s/m, of each */
  size_t *blocks;    /* count x 4: where (a,a), (b,b), (a,b), (b,a) lie in the values of the model's matrix */
} SporeSprings;

/* Structural springs along the edges, then from *structural_end shear springs across each edge with two triangles,
 * then from *shear_end bending springs from a neighbour of a vertex to the one straight opposite. No pair twice.
 * Stiffness and damping are left 0. False: no memory; *springs may then be cleared. */
bool spore_springs_of_triangles(SporeSprings *springs, const SporeTriangleMesh *mesh, size_t *structural_end,
                                size_t *shear_end);
void spore_springs_clear(SporeSprings *springs);

void spore_springs_force(const SporeSprings *springs, const double *q, const double *v, double *f);
double spore_springs_potential(const SporeSprings *springs, const double *q);
bool spore_springs_pattern(const SporeSprings *springs, SporeBlockPattern *pattern);
/* Under compression the stiffness across the spring is negative and left out. */
void spore_springs_jacobian(const SporeSprings *springs, const double *q, double stiffness_scale, double damping_scale,
                            SporeBlockMatrix *matrix);

#endif
