/* Fits one level to another: places its nodes so that material points lie where the other level has them.
 *
 * Least squares, min sum_s w_s |p_s - (W q)_s|^2, by conjugate gradients on W^T w W, preconditioned by its diagonal.
 * The start moves each node with the material point next to it. A shape that both levels can take is reproduced to
 * rounding, such as a spline by one with more knots. Pinned nodes stay at their places of time 0. A frame is the same
 * at each level. */
#include <assert.h>
#include <string.h>

#include "core/constraint/pin.h"
#include "core/body/momentum.h"
#include "core/sim/world_private.h"

#define ITERATIONS 300
#define SMALL 1e-28 /* of the square of the first residual: below, it is rounding */

/* Unknowns of a fit: the first `count` blocks, without the held ones. */
typedef struct Fit {
  const SporeLod *levels;
  const SporeLodLevel *level;
  size_t count;
} Fit;

static void filter(const Fit *fit, double *x) {
  memset(x + 3 * fit->count, 0, 3 * (fit->level->model->block_count - fit->count) * sizeof *x);
  spore_pin_filter(fit->level->held, fit->level->held_count, x);
}

/* r = W^T w (target - W x); without a target r = W^T w W x. */
static void residual(const Fit *fit, const double *target, const double *x, double *r) {
  assert(fit->level->samples.point_count == fit->levels->sample_count);
  const SporeLod *levels = fit->levels;
  double *at = levels->after;
  spore_mapping_positions(&fit->level->samples, x, at);
  for (size_t s = 0; s < levels->sample_count; s++)
    for (size_t k = 3 * s; k < 3 * s + 3; k++) at[k] = levels->sample_weight[s] * (target ? target[k] - at[k] : at[k]);
  memset(r, 0, 3 * fit->level->model->block_count * sizeof *r);
  spore_mapping_add_forces(&fit->level->samples, x, at, r);
  filter(fit, r);
}

static void precondition(const Fit *fit, const double *r, double *z) {
  for (size_t i = 0; i < 3 * fit->level->model->block_count; i++) {
    double diagonal = fit->level->diagonal[i / 3];
    z[i] = diagonal > 0 ? r[i] / diagonal : 0;
  }
}

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

static void solve(const Fit *fit, const double *target, double *x) {
  assert(3 * fit->level->model->block_count <= fit->levels->v_room);
  size_t n = 3 * fit->level->model->block_count, room = fit->levels->v_room;
  double *r = fit->levels->work, *z = r + room, *p = z + room, *ap = p + room;
  residual(fit, target, x, r);
  precondition(fit, r, z);
  memcpy(p, z, n * sizeof *p);
  double rz = dot(r, z, n), first = rz;
  for (int i = 0; i < ITERATIONS && rz > SMALL * first && rz > 0; i++) {
    residual(fit, NULL, p, ap);
    double curvature = dot(p, ap, n);
    if (!(curvature > 0)) return;
    double step = rz / curvature, before = rz;
    for (size_t k = 0; k < n; k++) x[k] += step * p[k], r[k] -= step * ap[k];
    precondition(fit, r, z);
    rz = dot(r, z, n);
    for (size_t k = 0; k < n; k++) p[k] = z[k] + rz / before * p[k];
  }
}

/* Start of the fit: each node is displaced from its place of time 0 like the sample next to it. */
static void begin(const Fit *fit, double *q) {
  assert(fit->level->model->q_count <= fit->levels->q_room);
  const SporeLodLevel *level = fit->level;
  double *rest = fit->levels->after;
  memcpy(q, level->rest_q, level->model->q_count * sizeof *q);
  spore_mapping_positions(&level->samples, level->rest_q, rest);
  for (size_t i = 0; i < fit->count; i++)
    for (size_t k = 0; k < 3; k++) {
      size_t s = 3 * (size_t)level->nearest[i] + k;
      q[3 * i + k] += fit->levels->before[s] - rest[s];
    }
  for (size_t i = 0; i < level->held_count; i++)
    memcpy(q + 3 * (size_t)level->held[i], level->rest_q + 3 * (size_t)level->held[i], 3 * sizeof *q);
}

/* Places the frame of `to` by that of `from`: each keeps its place in the body of time 0. */
static void place_frame(const SporeModel *from, const double *from_rest, const double *q, const double *v,
                        const SporeModel *to, const double *to_rest, double *q1, double *v1) {
  assert(!spore_model_is_nodal(from) && !spore_model_is_nodal(to));
  size_t a = 3 * (from->node_count - 1), b = 3 * (to->node_count - 1);
  SporeQuat turn =
      spore_quat_multiply(spore_quat_load(q + a + 3), spore_quat_conjugate(spore_quat_load(from_rest + a + 3)));
  SporeVec3 arm = spore_vec3_sub(spore_vec3_load(to_rest + b), spore_vec3_load(from_rest + a));
  SporeVec3 moved = spore_quat_rotate(turn, arm), spin = spore_vec3_load(v + a + 3);
  spore_vec3_store(q1 + b, spore_vec3_add(spore_vec3_load(q + a), moved));
  spore_quat_store(q1 + b + 3, spore_quat_normalise(spore_quat_multiply(turn, spore_quat_load(to_rest + b + 3))));
  spore_vec3_store(v1 + b, spore_vec3_add(spore_vec3_load(v + a), spore_vec3_cross(spin, moved)));
  spore_vec3_store(v1 + b + 3, spin);
}

/* Keeps momentum, and does not let energy grow. A pinned body gives momentum to its pins, so that only energy counts.
 */
static void keep_motion(const SporeModel *from, const double *q, const double *v, const SporeLodLevel *to, bool free,
                        double *q1, double *v1) {
  SporeMotion before = spore_model_motion(from, q, v, NULL);
  double gained = to->model->type->potential(to->model, q1) - from->type->potential(from, q);
  double kinetic = fmax(before.kinetic - fmax(gained, 0), 0);
  if (free) {
    spore_model_keep_momentum(to->model, q1, &before, kinetic, v1);
    return;
  }
  double now = spore_model_motion(to->model, q1, v1, NULL).kinetic;
  double share = now > kinetic ? sqrt(kinetic / now) : 1;
  for (size_t i = 0; i < 3 * to->model->block_count; i++) v1[i] *= share;
}

void spore_lod_fit(const SporeWorld *world, const SporeBody *body, SporeLodGrade to) {
  assert(body->lod && body->grade != to);
  assert(body->lod->level[to].model);
  const SporeLod *levels = body->lod;
  const SporeLodLevel *from = &levels->level[body->grade], *level = &levels->level[to];
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  bool framed = !spore_model_is_nodal(level->model);
  Fit fit = {levels, level, level->model->node_count - framed};
  spore_mapping_positions(&from->samples, q, levels->before);
  spore_mapping_velocities(&from->samples, q, v, levels->speed);
  begin(&fit, levels->q);
  memset(levels->v, 0, levels->v_room * sizeof *levels->v);
  for (size_t i = 0; i < fit.count; i++)
    memcpy(levels->v + 3 * i, levels->speed + 3 * (size_t)level->nearest[i], 3 * sizeof(double));
  if (framed) place_frame(from->model, from->rest_q, q, v, level->model, level->rest_q, levels->q, levels->v);
  spore_pin_filter(level->held, level->held_count, levels->v);
  solve(&fit, levels->before, levels->q);
  solve(&fit, levels->speed, levels->v);
  bool free = body->held.count == 0 && level->held_count == 0;
  keep_motion(body->model, q, v, level, free, levels->q, levels->v);
}

void spore_lod_place(const SporeLod *levels, SporeLodGrade to) {
  assert(levels->level[to].model);
  SporeLodLevel free_level = levels->level[to];
  free_level.held_count = 0;
  Fit fit = {levels, &free_level, free_level.model->node_count - !spore_model_is_nodal(free_level.model)};
  begin(&fit, levels->q);
  solve(&fit, levels->before, levels->q);
}

/* Greatest distance of `count` samples from index `start` on, m. */
static double distance_of(const SporeLod *levels, size_t start, size_t count) {
  assert(start + count <= levels->sample_count);
  double worst = 0;
  for (size_t s = start; s < start + count; s++) {
    double apart = spore_vec3_distance(spore_vec3_load(levels->before + 3 * s), spore_vec3_load(levels->after + 3 * s));
    if (!isfinite(apart)) return HUGE_VAL;
    worst = fmax(worst, apart);
  }
  return worst;
}

double spore_lod_error(const SporeLod *levels, SporeLodGrade to) {
  assert(levels->level[to].model);
  double worst = 0;
  size_t own = 0;
  spore_mapping_positions(&levels->level[to].samples, levels->q, levels->after);
  for (int k = 0; k < SPORE_LOD_COUNT; k++) {
    const SporeLodLevel *level = &levels->level[k];
    if (!level->model) continue;
    worst = fmax(worst, distance_of(levels, level->sample_start, level->seen_count));
    own = level->sample_start + level->sample_count;
  }
  return fmax(worst, distance_of(levels, own, levels->sample_count - own));
}
