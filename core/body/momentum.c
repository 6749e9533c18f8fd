/* Momentum of a body, and velocities with a given momentum. */
#include "core/body/momentum.h"

#include <assert.h>

static SporeVec3 node_at(const double *q, size_t i) { return spore_vec3_load(q + 3 * i); }

static SporeVec3 centre_of_mass(const SporeModel *model, const double *q, double mass) {
  assert(mass > 0);
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < model->node_count; i++) sum = spore_vec3_add_scaled(sum, model->block_mass[i], node_at(q, i));
  return spore_vec3_scale(1 / mass, sum);
}

static void add_node(SporeMotion *motion, double mass, SporeVec3 arm, SporeVec3 v) {
  SporeVec3 p = spore_vec3_scale(mass, v);
  motion->momentum = spore_vec3_add(motion->momentum, p);
  motion->angular = spore_vec3_add(motion->angular, spore_vec3_cross(arm, p));
  motion->kinetic += 0.5 * spore_vec3_dot(v, p);
  SporeMat3 skew = spore_mat3_skew(arm);
  motion->inertia = spore_mat3_sub(motion->inertia, spore_mat3_scale(mass, spore_mat3_multiply(skew, skew)));
}

/* Adds the turning of a frame. */
static void add_frame(SporeMotion *motion, const SporeModel *model, const double *q, const double *v) {
  assert(model->block_count == model->node_count + 1);
  SporeMat3 inertia = model->type->inertia(model, q);
  SporeVec3 spin = spore_vec3_load(v + 3 * model->node_count), angular = spore_mat3_apply(inertia, spin);
  motion->inertia = spore_mat3_add(motion->inertia, inertia);
  motion->angular = spore_vec3_add(motion->angular, angular);
  motion->kinetic += 0.5 * spore_vec3_dot(spin, angular);
}

SporeMotion spore_model_motion(const SporeModel *model, const double *q, const double *v, const SporeVec3 *centre) {
  assert(q && v);
  SporeMotion motion = {.mass = spore_model_total_mass(model)};
  motion.centre = centre ? *centre : centre_of_mass(model, q, motion.mass);
  for (size_t i = 0; i < model->node_count; i++)
    add_node(&motion, model->block_mass[i], spore_vec3_sub(node_at(q, i), motion.centre), spore_vec3_load(v + 3 * i));
  if (!spore_model_is_nodal(model)) add_frame(&motion, model, q, v);
  return motion;
}

/* v += scale times the rigid motion a + w x r. */
static void add_rigid(const SporeModel *model, const double *q, SporeVec3 centre, SporeVec3 a, SporeVec3 w, double *v) {
  for (size_t i = 0; i < model->node_count; i++) {
    SporeVec3 arm = spore_vec3_sub(node_at(q, i), centre);
    spore_vec3_accumulate(v + 3 * i, spore_vec3_add(a, spore_vec3_cross(w, arm)));
  }
  if (!spore_model_is_nodal(model)) spore_vec3_accumulate(v + 3 * model->node_count, w);
}

/* Spin with this angular momentum. About an axis without inertia, such as that of a line, the spin is 0. */
static SporeVec3 spin_of(const SporeMat3 *inertia, SporeVec3 angular) {
  double values[3], most = 0;
  SporeMat3 vectors;
  SporeVec3 spin = {0, 0, 0};
  spore_mat3_eigen_symmetric(*inertia, values, &vectors);
  for (int k = 0; k < 3; k++) most = fmax(most, values[k]);
  for (int k = 0; k < 3; k++) {
    SporeVec3 axis = spore_mat3_column(vectors, k);
    if (values[k] > 1e-12 * most) spin = spore_vec3_add_scaled(spin, spore_vec3_dot(axis, angular) / values[k], axis);
  }
  return spin;
}

/* Gives the velocities the momentum of `before`. The second round corrects rounding. */
static void correct(const SporeModel *model, const double *q, const SporeMotion *before, SporeVec3 centre, double *v) {
  assert(before->mass > 0);
  SporeVec3 shift = spore_vec3_sub(before->centre, centre);
  SporeVec3 wanted = spore_vec3_add(before->angular, spore_vec3_cross(shift, before->momentum));
  for (int round = 0; round < 2; round++) {
    SporeMotion now = spore_model_motion(model, q, v, &centre);
    SporeVec3 a = spore_vec3_scale(1 / now.mass, spore_vec3_sub(before->momentum, now.momentum));
    add_rigid(model, q, centre, a, spin_of(&now.inertia, spore_vec3_sub(wanted, now.angular)), v);
  }
}

void spore_model_keep_momentum(const SporeModel *model, const double *q, const SporeMotion *before, double kinetic,
                               double *v) {
  assert(kinetic >= 0);
  SporeVec3 centre = centre_of_mass(model, q, spore_model_total_mass(model));
  correct(model, q, before, centre, v);
  SporeMotion now = spore_model_motion(model, q, v, &centre);
  if (now.kinetic <= kinetic) return;
  SporeVec3 a = spore_vec3_scale(1 / now.mass, now.momentum), w = spin_of(&now.inertia, now.angular);
  double rigid = 0.5 * (spore_vec3_dot(a, now.momentum) + spore_vec3_dot(w, now.angular)), rest = now.kinetic - rigid;
  if (!(rest > 0)) return;
  double share = kinetic > rigid ? sqrt((kinetic - rigid) / rest) : 0;
  for (size_t i = 0; i < 3 * model->block_count; i++) v[i] *= share;
  add_rigid(model, q, centre, spore_vec3_scale(1 - share, a), spore_vec3_scale(1 - share, w), v);
  correct(model, q, before, centre, v);
}
