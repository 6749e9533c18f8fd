/* A solid of linear elasticity with a constant stiffness, in a frame that turns with the body as a whole.
 *
 * The frame stands at the centre of mass c, and its rotation R is that of A = sum m (q - c) X^T = R S, with X the
 * places at rest from the centre of mass (as in B. Mueller et al. 2005, "Meshless deformations based on shape
 * matching"). With p = R^T (q - c) and u = p - X the energy is 1/2 u . K u, and with its rate u' the viscous force is
 * that of K u' times a time. As R follows the nodes, forces get a part that hinders the body from turning itself: g = K
 * (u + time u'),  y = (tr S I - S)^-1 sum p x g,  f = -R (g - m y x X), so that both momenta are kept. The stiffness R
 * K R^T is exact where u is 0: this is a model for small strains, and for small rotations of one part of the body
 * against another. */
#ifndef SPORE_MODELS_TETRAHEDRA_LINEAR_SOLID_H
#define SPORE_MODELS_TETRAHEDRA_LINEAR_SOLID_H

#include "core/body/model.h"
#include "models/common/tissues.h"
#include "models/tetrahedra/elements.h"

typedef struct SporeLinearFields {
  double young_modulus, poisson_ratio, density, mass_damping, stiffness_damping;
} SporeLinearFields;

#define SPORE_LINEAR_PARAMETERS 5
extern const SporeParameter spore_linear_parameters[SPORE_LINEAR_PARAMETERS];

typedef struct SporeLinearSolid {
  SporeModel base;
  SporeTetrahedronNodes nodes;                   /* what it was made of; the model's nodes may be fewer */
  SporeTriangleMesh surface;                     /* of the model's nodes, body's frame; its vertices are all of them */
  double *place;                                 /* X, block_count x 3 */
  SporeVec3 centre;                              /* of mass at rest, body's frame */
  SporeBlockMatrix stiffness;                    /* K for a Young's modulus of 1 Pa */
  double young_modulus, viscosity, mass_damping; /* Pa, s, 1/s */
  bool locks;
  double *u, *pull, *carried; /* block_count x 3 each: what a force is computed in */
} SporeLinearSolid;

/* K of four-node elements on the model's pattern, for 1 Pa; the matrix is created. False: no memory. */
bool spore_linear_stiffness(const SporeTetrahedronNodes *nodes, double poisson_ratio, SporeBlockMatrix *matrix);
/* Fills the rest once masses, surface and stiffness are there. False: no memory. */
bool spore_linear_solid_finish(SporeLinearSolid *body, const SporeLinearFields *fields);
bool spore_linear_solid_no_memory(SporeError *error);
/* A model that `build` makes of the geometry; false with an error, and no model comes of it. */
typedef bool SporeLinearBuild(SporeLinearSolid *body, const SporeGeometry *geometry, const SporeLinearFields *fields,
                              SporeError *error);
SporeModel *spore_linear_solid_create(SporeLinearBuild *build, const SporeGeometry *geometry, const void *fields,
                                      SporeError *error);

/* matrix += R K back for each of `count` blocks of 9, row-major. */
SPORE_DECLARE_KERNEL(void, spore_linear_turn, size_t count, const double *blocks, SporeMat3 rotation, SporeMat3 back,
                     double *matrix);

/* Slots of the model type. */
void spore_linear_solid_destroy(SporeModel *model);
void spore_linear_solid_place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q,
                              double *v);
void spore_linear_solid_force(const SporeModel *model, const double *q, const double *shape, const double *v,
                              double *f);
double spore_linear_solid_potential(const SporeModel *model, const double *q);
bool spore_linear_solid_pattern(const SporeModel *model, SporeBlockPattern *pattern);
void spore_linear_solid_jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                                 double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix);
bool spore_linear_solid_retune(SporeModel *model, const void *fields, SporeError *error);
const char *spore_linear_solid_notice(const SporeModel *model, const double *q);
const char *spore_linear_solid_doubt(const SporeModel *model);

#define SPORE_LINEAR_SOLID_SLOTS                                                                                       \
  .parameters = {spore_linear_parameters, SPORE_LINEAR_PARAMETERS, sizeof(SporeLinearFields)},                         \
  .geometry = SPORE_GEOMETRY_TETRAHEDRA, .regions = true, .presets = spore_tissue_presets,                             \
  .destroy = spore_linear_solid_destroy, .place = spore_linear_solid_place, .force = spore_linear_solid_force,         \
  .potential = spore_linear_solid_potential, .pattern = spore_linear_solid_pattern,                                    \
  .jacobian = spore_linear_solid_jacobian, .retune = spore_linear_solid_retune, .notice = spore_linear_solid_notice,   \
  .doubt = spore_linear_solid_doubt

#endif
