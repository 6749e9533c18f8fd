#include "models/tetrahedra/linear_solid.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/nodal.h"
#include "models/tetrahedra/map.h"

#define LOCKS 0.45       /* Poisson's ratio above which elements of four nodes are said to be too stiff */
#define TURNED 0.9800666 /* cosine of 0.2 rad, from which on a rotation is no longer small */
#define LOOKED_AT 32     /* triangles of the surface, each time */

const SporeParameter spore_linear_parameters[SPORE_LINEAR_PARAMETERS] = {
    SPORE_TISSUE_YOUNG_MODULUS(SporeLinearFields),
    SPORE_REAL_FIELD(SporeLinearFields, poisson_ratio, "", 0, 0.499, 0.4, SPORE_CHANGE_REBUILD,
                     N_("Poisson's ratio; near 0.5 volume is kept, and linear elements become too stiff in bending.")),
    SPORE_TISSUE_DENSITY_AND_DAMPING(SporeLinearFields),
};

bool spore_linear_solid_no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a linear solid"));
}

void spore_linear_solid_destroy(SporeModel *model) {
  SporeLinearSolid *body = (SporeLinearSolid *)model;
  spore_tetrahedron_nodes_clear(&body->nodes);
  spore_triangle_mesh_clear(&body->surface);
  spore_block_matrix_clear(&body->stiffness);
  spore_free(body->place);
  spore_free(body->u);
  spore_free(body->pull);
  spore_free(body->carried);
  spore_model_clear(&body->base);
  spore_free(body);
}

SporeModel *spore_linear_solid_create(SporeLinearBuild *build, const SporeGeometry *geometry, const void *fields,
                                      SporeError *error) {
  if (!spore_tetrahedra_check_mesh(geometry->tetrahedra, error)) return NULL;
  SporeLinearSolid *body = SPORE_NEW(SporeLinearSolid);
  if (!body) {
    spore_linear_solid_no_memory(error);
    return NULL;
  }
  if (build(body, geometry, fields, error)) return &body->base;
  spore_linear_solid_destroy(&body->base);
  return NULL;
}

/* Making. */

/* Blocks V (mu (g_a . g_b) I + mu g_b g_a^T + lambda g_a g_b^T) of an element, g the gradients of its corners. */
static void add_element(SporeBlockMatrix *matrix, const uint32_t *corners, const double *vertices, double mu,
                        double lambda) {
  assert(mu > 0 && lambda >= 0);
  SporeVec3 g[4];
  double volume = spore_tetrahedron_gradients(vertices, corners, g + 1) / 6;
  g[0] = spore_vec3_scale(-1, spore_vec3_add(g[1], spore_vec3_add(g[2], g[3])));
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      double same = volume * mu * spore_vec3_dot(g[a], g[b]);
      SporeMat3 block = spore_mat3_add(spore_mat3_scale(volume * mu, spore_mat3_outer(g[b], g[a])),
                                       spore_mat3_scale(volume * lambda, spore_mat3_outer(g[a], g[b])));
      block = spore_mat3_add(block, spore_mat3_diagonal(same, same, same));
      spore_block_matrix_add(matrix, corners[a], corners[b], block.m);
    }
}

bool spore_linear_stiffness(const SporeTetrahedronNodes *nodes, double poisson_ratio, SporeBlockMatrix *matrix) {
  assert(nodes->per_element == 4);
  assert(poisson_ratio >= 0 && poisson_ratio < 0.5);
  double mu = 1 / (2 * (1 + poisson_ratio)), lambda = poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, nodes->count);
  bool made = spore_tetrahedron_nodes_pattern(nodes, &pattern) && spore_block_matrix_create(matrix, &pattern);
  spore_block_pattern_clear(&pattern);
  if (!made) return false;
  spore_block_matrix_zero(matrix);
  for (size_t t = 0; t < nodes->mesh.tetrahedron_count; t++) {
    double stiffer = spore_tetrahedron_factors(nodes, t).stiffness;
    add_element(matrix, nodes->nodes + 4 * t, nodes->rest, stiffer * mu, stiffer * lambda);
  }
  return true;
}

static SporeVec3 mass_centre(const SporeLinearSolid *body, const double *x) {
  SporeVec3 sum = {0, 0, 0};
  double mass = 0;
  for (size_t i = 0; i < body->base.block_count; i++) {
    sum = spore_vec3_add_scaled(sum, body->base.block_mass[i], spore_vec3_load(x + 3 * i));
    mass += body->base.block_mass[i];
  }
  return spore_vec3_scale(1 / mass, sum);
}

static void tune(SporeLinearSolid *body, const SporeLinearFields *fields) {
  body->young_modulus = fields->young_modulus;
  body->viscosity = fields->stiffness_damping;
  body->mass_damping = fields->mass_damping;
  body->locks = fields->poisson_ratio > LOCKS;
}

bool spore_linear_solid_finish(SporeLinearSolid *body, const SporeLinearFields *fields) {
  assert(body->stiffness.block_count == body->base.block_count);
  assert(body->surface.vertex_count == body->base.block_count);
  size_t n = body->base.block_count;
  body->place = SPORE_NEW_ARRAY(double, 3 * n);
  body->u = SPORE_NEW_ARRAY(double, 3 * n);
  body->pull = SPORE_NEW_ARRAY(double, 3 * n);
  body->carried = SPORE_NEW_ARRAY(double, 3 * n);
  if (!body->place || !body->u || !body->pull || !body->carried) return false;
  body->centre = mass_centre(body, body->surface.vertices);
  for (size_t i = 0; i < n; i++)
    spore_vec3_store(body->place + 3 * i,
                     spore_vec3_sub(spore_vec3_load(body->surface.vertices + 3 * i), body->centre));
  tune(body, fields);
  return true;
}

/* Motion. */

void spore_linear_solid_place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q,
                              double *v) {
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  spore_nodal_place(body->surface.vertices, body->base.block_count, pose, velocity, spin, q, v);
}

/* The frame of a configuration. */
typedef struct Frame {
  SporeVec3 centre;
  SporeMat3 rotation, back; /* R, R^T */
  SporeMat3 flexible;       /* (tr S I - S)^-1; 0 where the body is crushed to a line and has no frame */
} Frame;

static Frame frame_of(const SporeLinearSolid *body, const double *q) {
  Frame frame = {.centre = mass_centre(body, q)};
  SporeMat3 a = {{0}}, s;
  for (size_t i = 0; i < body->base.block_count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(q + 3 * i), frame.centre);
    SporeVec3 weighed = spore_vec3_scale(body->base.block_mass[i], spore_vec3_load(body->place + 3 * i));
    a = spore_mat3_add(a, spore_mat3_outer(arm, weighed));
  }
  spore_mat3_polar(a, &frame.rotation, &s);
  frame.back = spore_mat3_transpose(frame.rotation);
  double trace = spore_mat3_trace(s);
  if (!spore_mat3_invert(spore_mat3_sub(spore_mat3_diagonal(trace, trace, trace), s), &frame.flexible))
    frame.flexible = spore_mat3_diagonal(0, 0, 0);
  return frame;
}

static SporeVec3 place_in(const Frame *frame, const double *q, size_t i) {
  return spore_mat3_apply(frame->back, spore_vec3_sub(spore_vec3_load(q + 3 * i), frame->centre));
}

/* u += p - X */
static void add_displacements(const SporeLinearSolid *body, const Frame *frame, const double *q, double *u) {
  for (size_t i = 0; i < body->base.block_count; i++)
    spore_vec3_accumulate(u + 3 * i, spore_vec3_sub(place_in(frame, q, i), spore_vec3_load(body->place + 3 * i)));
}

/* u += time u' */
static void add_rates(const SporeLinearSolid *body, const Frame *frame, const double *q, const double *v, double time_s,
                      double *u) {
  const double *mass = body->base.block_mass;
  SporeVec3 centre = mass_centre(body, v), turning = {0, 0, 0};
  for (size_t i = 0; i < body->base.block_count; i++) {
    SporeVec3 w = spore_mat3_apply(frame->back, spore_vec3_sub(spore_vec3_load(v + 3 * i), centre));
    SporeVec3 arm = spore_vec3_load(body->place + 3 * i);
    turning = spore_vec3_add_scaled(turning, mass[i], spore_vec3_cross(arm, w));
  }
  turning = spore_mat3_apply(frame->flexible, turning);
  for (size_t i = 0; i < body->base.block_count; i++) {
    SporeVec3 w = spore_mat3_apply(frame->back, spore_vec3_sub(spore_vec3_load(v + 3 * i), centre));
    SporeVec3 rate = spore_vec3_sub(w, spore_vec3_cross(turning, place_in(frame, q, i)));
    spore_vec3_accumulate(u + 3 * i, spore_vec3_scale(time_s, rate));
  }
}

/* f -= what K u pulls in the frame at q. */
static void add_pull(const SporeLinearSolid *body, const Frame *frame, const double *q, const double *u, double *f) {
  size_t n = body->base.block_count;
  double *g = body->pull;
  memset(g, 0, 3 * n * sizeof *g);
  spore_block_matrix_multiply_add(&body->stiffness, u, g);
  SporeVec3 torque = {0, 0, 0};
  for (size_t i = 0; i < n; i++)
    torque = spore_vec3_add(torque, spore_vec3_cross(place_in(frame, q, i), spore_vec3_load(g + 3 * i)));
  SporeVec3 y = spore_mat3_apply(frame->flexible, torque);
  for (size_t i = 0; i < n; i++) {
    SporeVec3 across = spore_vec3_cross(y, spore_vec3_load(body->place + 3 * i));
    SporeVec3 pull = spore_vec3_add_scaled(spore_vec3_load(g + 3 * i), -body->base.block_mass[i], across);
    pull = spore_mat3_apply(frame->rotation, pull);
    spore_vec3_accumulate(f + 3 * i, spore_vec3_scale(-body->young_modulus, pull));
  }
}

void spore_linear_solid_force(const SporeModel *model, const double *q, const double *shape, const double *v,
                              double *f) {
  assert(f != q && f != v);
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  size_t n = 3 * body->base.block_count;
  Frame frame = frame_of(body, q);
  memset(body->u, 0, n * sizeof *body->u);
  add_displacements(body, &frame, q, body->u);
  if (shape == q && body->viscosity > 0) add_rates(body, &frame, q, v, body->viscosity, body->u);
  add_pull(body, &frame, q, body->u, f);
  if (shape != q && body->viscosity > 0) {
    Frame held = frame_of(body, shape);
    memset(body->carried, 0, n * sizeof *body->carried);
    add_rates(body, &held, shape, v, body->viscosity, body->carried);
    add_pull(body, &held, shape, body->carried, f);
  }
  spore_nodal_damp(model, body->mass_damping, v, f);
}

double spore_linear_solid_potential(const SporeModel *model, const double *q) {
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  size_t n = 3 * body->base.block_count;
  Frame frame = frame_of(body, q);
  memset(body->u, 0, n * sizeof *body->u);
  memset(body->pull, 0, n * sizeof *body->pull);
  add_displacements(body, &frame, q, body->u);
  spore_block_matrix_multiply_add(&body->stiffness, body->u, body->pull);
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += body->u[i] * body->pull[i];
  return 0.5 * body->young_modulus * sum;
}

bool spore_linear_solid_pattern(const SporeModel *model, SporeBlockPattern *pattern) {
  const SporeBlockMatrix *stiffness = &((const SporeLinearSolid *)model)->stiffness;
  for (uint32_t i = 0; i < stiffness->block_count; i++)
    for (uint32_t k = stiffness->row_start[i]; k < stiffness->row_start[i + 1]; k++)
      if (stiffness->column[k] < i && !spore_block_pattern_add(pattern, i, stiffness->column[k])) return false;
  return true;
}

/* matrix += scale R K R^T; both have the same pattern. */
static void add_turned(const SporeLinearSolid *body, const Frame *frame, double scale, SporeBlockMatrix *matrix) {
  assert(matrix->block_count == body->stiffness.block_count);
  SporeMat3 rotation = spore_mat3_scale(scale * body->young_modulus, frame->rotation);
  SPORE_KERNEL(spore_linear_turn)
  (body->stiffness.row_start[body->stiffness.block_count], body->stiffness.values, rotation, frame->back,
   matrix->values);
}

void spore_linear_solid_jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                                 double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  assert(stiffness_scale >= 0);
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  double viscous = damping_scale * body->viscosity;
  Frame frame = frame_of(body, q);
  if (shape == q) stiffness_scale += viscous;
  if (stiffness_scale != 0) add_turned(body, &frame, stiffness_scale, matrix);
  if (shape != q && viscous != 0) {
    frame = frame_of(body, shape);
    add_turned(body, &frame, viscous, matrix);
  }
  spore_nodal_damp_jacobian(model, damping_scale * body->mass_damping, matrix);
}

bool spore_linear_solid_retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((SporeLinearSolid *)model, fields);
  return true;
}

static SporeVec3 normal_of(const double *x, const uint32_t *corners) {
  SporeVec3 a = spore_vec3_load(x + 3 * (size_t)corners[0]);
  SporeVec3 ab = spore_vec3_sub(spore_vec3_load(x + 3 * (size_t)corners[1]), a);
  SporeVec3 ac = spore_vec3_sub(spore_vec3_load(x + 3 * (size_t)corners[2]), a);
  return spore_vec3_normalise(spore_vec3_cross(ab, ac), (SporeVec3){0, 0, 0});
}

const char *spore_linear_solid_notice(const SporeModel *model, const double *q) {
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  const SporeTriangleMesh *surface = &body->surface;
  Frame frame = frame_of(body, q);
  size_t step = (surface->triangle_count + LOOKED_AT - 1) / LOOKED_AT;
  for (size_t t = 0; t < surface->triangle_count; t += step) {
    const uint32_t *corners = surface->triangles + 3 * t;
    SporeVec3 turned = spore_mat3_apply(frame.rotation, normal_of(surface->vertices, corners));
    if (spore_vec3_dot(turned, normal_of(q, corners)) < TURNED)
      return _(
          "parts of it have turned by more than 0.2 rad against each other: linear elasticity makes it swell there "
          "and bend too little; choose neo-Hookean or corotational tetrahedra, or a smaller load");
  }
  return NULL;
}

const char *spore_linear_solid_doubt(const SporeModel *model) {
  if (!((const SporeLinearSolid *)model)->locks) return NULL;
  return _("linear elements with a Poisson's ratio above 0.45 are much too stiff: a bar 2 cells thick bends by a third "
           "of what it should at 0.45, and by a twentieth at 0.499; choose neo-Hookean tetrahedra with "
           "element=\"quadratic\", or a Poisson's ratio of 0.45 or less");
}
