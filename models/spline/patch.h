/* Sheets as tensor products of cubic B-splines with clamped, uniform knots: what a membrane follows. */
#ifndef SPORE_MODELS_SPLINE_PATCH_H
#define SPORE_MODELS_SPLINE_PATCH_H

#include "core/linalg/block_matrix.h"
#include "core/math/simd.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "core/body/model.h"

#define SPORE_PATCH_POINTS 4     /* Gauss points a cell: two each way */
#define SPORE_PATCH_FUNCTIONS 16 /* that are not 0 in a cell */
#define SPORE_PATCH_PAIRS 136    /* of them, i <= j */
#define SPORE_PATCH_SPANS 3      /* least each way: with fewer, two Gauss points do not see every shape */

/* One Gauss point of each of SPORE_LANES cells; behind the last cell all is 0. With orthonormal coordinates s1, s2 of
 * the sheet at rest around the point, a_i = dr/ds_i and b_k = d2r/ds1^2, d2r/ds2^2, d2r/ds1 ds2 (less what the
 * parameters' own curvature adds: at rest b_k = c_k a1 x a2, c_k the curvature), and with E the Green strain of a1, a2:
 *   U = sum area young t / (1 - nu^2) (membrane(E) + t^2 / 12 bending(b_k - c_k a1 x a2))
 *   membrane(E) = 1/2 (E11^2 + E22^2 + 2 nu E11 E22 + 2 (1 - nu) E12^2), St Venant-Kirchhoff in plane stress
 *   bending(c)  = 1/2 (c1.c1 + c2.c2 + 2 nu c1.c2 + 2 (1 - nu) c3.c3), Kirchhoff's plate
 * Both are as they were when all turns. Of a flat sheet bending is quadratic (Bergou et al. 2006) and its part of the
 * matrix constant. a1 x a2 in place of the unit normal keeps all polynomial, so that a crushed sheet has forces too; a
 * sheet stretched to s times its area then wants to be s times as curved. */
typedef struct SporePatchGauss {
  double first[2][SPORE_PATCH_FUNCTIONS][SPORE_LANES], second[3][SPORE_PATCH_FUNCTIONS][SPORE_LANES];
  double bent[SPORE_PATCH_FUNCTIONS]
             [SPORE_LANES];         /* sum over k of (Q c)_k second[k], Q the quadratic form of bending */
  double curvature[3][SPORE_LANES]; /* c_k, 1/m */
  double area[SPORE_LANES];         /* m^2 */
} SporePatchGauss;

/* What a_i and b_k were in the shape that was last damped along: an implicit step asks for that again and again. */
typedef struct SporePatchShape {
  bool ready;
  double *shape;                 /* 3 a control point */
  double (*at)[15][SPORE_LANES]; /* as gauss: a1, a2, b1, b2, b3, x y z each */
} SporePatchShape;

typedef struct SporePatch {
  size_t span_u, span_v, cell_count, group_count; /* groups of SPORE_LANES cells */
  SporePatchGauss *gauss;                         /* group x SPORE_PATCH_POINTS */
  uint32_t *node;              /* group x SPORE_PATCH_FUNCTIONS x SPORE_LANES: control points, u runs first */
  double (*flat)[SPORE_LANES]; /* group x SPORE_PATCH_PAIRS: sum over points of area second Q second, 1/m^2 */
  uint32_t (*upper)[SPORE_PATCH_PAIRS], (*lower)[SPORE_PATCH_PAIRS]; /* cell: where blocks (i, j) and (j, i) lie */
  bool curved;                                                       /* some c_k is not 0 */
  double thickness, poisson, young, viscous;                         /* m, -, Pa, s */
  SporePatchShape *damped;
} SporePatch;

static inline size_t spore_patch_nodes(const SporePatch *patch) { return (patch->span_u + 3) * (patch->span_v + 3); }

/* Makes all but the points; thickness and so on are set by the caller before. False: no memory. */
bool spore_patch_allocate(SporePatch *patch, size_t span_u, size_t span_v);
void spore_patch_clear(SporePatch *patch);
bool spore_patch_pattern(const SporePatch *patch, SporeBlockPattern *pattern);
/* Sets the Gauss points from the control points at rest, and adds each function's integral, m^2, to `share`. Returns
 * the cell that has no area, or SIZE_MAX. */
size_t spore_patch_set_rest(SporePatch *patch, const double *control, double *share);

/* Rows that give points by control points (in the body's frame). A point on the sheet follows the sixteen control
 * points of its cell; a point off the sheet follows as few more control points around it as reproduce its offset.
 * Refused where the sheet is too flat for that. */
bool spore_patch_map(size_t span_u, size_t span_v, const double *control, const double *points, size_t count,
                     const SporeCancel *cancel, double slack, SporeMapping *mapping, SporeError *error);
/* Points of the sheet, 3 each, even by its parameters and four a span each way. False: no memory. */
bool spore_patch_sample(size_t span_u, size_t span_v, const double *control, double **points, size_t *count);

/* The largest stretch of the sheet at its Gauss points, less 1. */
double spore_patch_strain(const SporePatch *patch, const double *q);

/* Forces, energy and stiffness as SporeModelType says; force_along where h > 0. Viscous: the rates of E and of
 * b_k.(a1 x a2), each times viscous and its stiffness. */
SPORE_DECLARE_KERNEL(void, spore_patch_force, const SporePatch *patch, const double *q, const double *shape,
                     const double *v, double h, double *f);
SPORE_DECLARE_KERNEL(double, spore_patch_potential, const SporePatch *patch, const double *q);
SPORE_DECLARE_KERNEL(void, spore_patch_jacobian, const SporePatch *patch, const SporeTangent *at,
                     SporeBlockMatrix *matrix);

#endif
