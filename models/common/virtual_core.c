/* The virtual core: its inertia, motion, ties and Jacobian. */
#include "models/common/virtual_core.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/nodal.h"

bool spore_virtual_core_allocate(SporeVirtualCore *core, size_t count) {
  assert(count > 0);
  core->count = count;
  core->weight = SPORE_NEW_ARRAY(double, count);
  core->place = SPORE_NEW_ARRAY(double, 3 * count);
  core->blocks = SPORE_NEW_ARRAY(SporeVirtualCoreBlocks, count);
  return core->weight && core->place && core->blocks;
}

void spore_virtual_core_clear(SporeVirtualCore *core) {
  spore_free(core->weight);
  spore_free(core->place);
  spore_free(core->slack);
  spore_free(core->blocks);
  *core = (SporeVirtualCore){0};
}

bool spore_virtual_core_spread(SporeVirtualCore *core, const double *rest, const double *node_mass, double mass,
                               double radius, SporeError *error) {
  assert(core->count > 0 && rest && node_mass);
  assert(mass > 0 && radius >= 0);
  SporeVec3 first = {0, 0, 0};
  double whole = 0;
  for (size_t i = 0; i < core->count; i++) {
    first = spore_vec3_add_scaled(first, node_mass[i], spore_vec3_load(rest + 3 * i));
    whole += node_mass[i];
  }
  core->centre = spore_vec3_scale(1 / whole, first);
  double ball = 0.4 * mass * radius * radius;
  SporeMat3 tensor = spore_mat3_diagonal(ball, ball, ball);
  for (size_t i = 0; i < core->count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(rest + 3 * i), core->centre);
    double square = spore_vec3_dot(arm, arm), part = node_mass[i] * mass / whole;
    spore_vec3_store(core->place + 3 * i, arm);
    SporeMat3 turning = spore_mat3_sub(spore_mat3_diagonal(square, square, square), spore_mat3_outer(arm, arm));
    tensor = spore_mat3_add(tensor, spore_mat3_scale(part, turning));
  }
  if (spore_inertia_init(&core->inertia, tensor)) return true;
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("the core's smallest moment of inertia is %g kg m^2; a positive one was expected; check unit "
        "and mesh"),
      core->inertia.moment[0]);
}

bool spore_virtual_core_slacken(SporeVirtualCore *core, const double *feet, const double *rest) {
  assert(core->count > 0 && !core->slack);
  core->slack = SPORE_NEW_ARRAY(double, core->count);
  if (!core->slack) return false;
  for (size_t i = 0; i < core->count; i++) {
    SporeVec3 foot = spore_vec3_load(feet + 3 * i);
    core->slack[i] = spore_vec3_distance(spore_vec3_load(rest + 3 * i), foot);
    spore_vec3_store(core->place + 3 * i, spore_vec3_sub(foot, core->centre));
  }
  return true;
}

bool spore_virtual_core_pattern(const SporeVirtualCore *core, SporeBlockPattern *pattern) {
  uint32_t centre = (uint32_t)core->count, turning = centre + 1;
  for (uint32_t i = 0; i < centre; i++)
    if (!spore_block_pattern_add(pattern, i, centre) || !spore_block_pattern_add(pattern, i, turning)) return false;
  return spore_block_pattern_add(pattern, centre, turning);
}

void spore_virtual_core_find_blocks(SporeVirtualCore *core, const SporeBlockMatrix *matrix) {
  assert(matrix->block_count >= core->count + 2);
  uint32_t centre = (uint32_t)core->count, turning = centre + 1;
  for (uint32_t i = 0; i < centre; i++)
    core->blocks[i] = (SporeVirtualCoreBlocks){.node = matrix->diagonal[i],
                                               .centre = (uint32_t)spore_block_matrix_find(matrix, i, centre),
                                               .turning = (uint32_t)spore_block_matrix_find(matrix, i, turning),
                                               .from_centre = (uint32_t)spore_block_matrix_find(matrix, centre, i),
                                               .from_turning = (uint32_t)spore_block_matrix_find(matrix, turning, i)};
  core->centre_block = matrix->diagonal[centre];
  core->turning_block = matrix->diagonal[turning];
  core->across = (uint32_t)spore_block_matrix_find(matrix, centre, turning);
  core->back = (uint32_t)spore_block_matrix_find(matrix, turning, centre);
}

/* State. */

void spore_virtual_core_place(const SporeVirtualCore *core, const double *rest, SporePose pose, SporeVec3 velocity,
                              SporeVec3 spin, double *q, double *v) {
  double centre[3];
  spore_nodal_place(rest, core->count, pose, velocity, spin, q, v);
  q += 3 * core->count, v += 3 * core->count;
  spore_vec3_store(centre, core->centre);
  spore_nodal_place(centre, 1, pose, velocity, spin, q, v);
  spore_quat_store(q + 3, pose.orientation);
  spore_vec3_store(v + 3, spin);
}

SporeMat3 spore_virtual_core_inertia(const SporeVirtualCore *core, const double *q) {
  return spore_inertia_turned(&core->inertia, spore_quat_load(q + 3 * (core->count + 1)));
}

void spore_virtual_core_drift(const SporeVirtualCore *core, const double *q, const double *v, double h, double *q1,
                              double *v1) {
  assert(isfinite(h));
  size_t n = 3 * (core->count + 1);
  SporeQuat orientation = spore_quat_load(q + n);
  SporeVec3 spin = spore_vec3_load(v + n);
  spore_inertia_drift(&core->inertia, h, &orientation, &spin);
  for (size_t k = 0; k < n; k++) q1[k] = q[k] + h * v[k];
  for (size_t k = 0; k < n; k++) v1[k] = v[k];
  spore_quat_store(q1 + n, orientation);
  spore_vec3_store(v1 + n, spin);
}

double spore_virtual_core_longest_turn(const SporeVirtualCore *core, const double *q, const double *v) {
  size_t n = 3 * (core->count + 1);
  return spore_inertia_longest_drift(&core->inertia, spore_quat_load(q + n), spore_vec3_load(v + n));
}

/* Forces. */

/* The core in a state. */
typedef struct State {
  SporeVec3 centre;
  SporeMat3 rotation;
} State;

static State state_at(const SporeVirtualCore *core, const double *q) {
  q += 3 * core->count;
  return (State){spore_vec3_load(q), spore_quat_to_mat3(spore_quat_load(q + 3))};
}

/* s and d of node i. */
static SporeVec3 place_of(const SporeVirtualCore *core, const State *state, size_t i) {
  assert(i < core->count);
  return spore_mat3_apply(state->rotation, spore_vec3_load(core->place + 3 * i));
}
static SporeVec3 away(const State *state, const double *q, size_t i, SporeVec3 s) {
  return spore_vec3_sub(spore_vec3_sub(spore_vec3_load(q + 3 * i), state->centre), s);
}

/* How much of the tie is stretched, m, and its direction n: 0 where it has none. */
static double stretch_of(const SporeVirtualCore *core, size_t i, SporeVec3 d, SporeVec3 *n) {
  double length = fmax(spore_vec3_length(d), SPORE_VIRTUAL_CORE_SHORTEST);
  *n = spore_vec3_scale(1 / length, d);
  return fmax(length - (core->slack ? core->slack[i] : 0), 0);
}

void spore_virtual_core_force(const SporeVirtualCore *core, const double *q, const double *shape, const double *v,
                              double *f) {
  assert(f != q && f != v);
  State state = state_at(core, q);
  SPORE_KERNEL(spore_virtual_core_ties)(core, &state.rotation, q, shape, v, f);
}

double spore_virtual_core_potential(const SporeVirtualCore *core, const double *q) {
  State state = state_at(core, q);
  double sum = 0;
  for (size_t i = 0; i < core->count; i++) {
    SporeVec3 n, d = away(&state, q, i, place_of(core, &state, i));
    double stretch = core->slack ? stretch_of(core, i, d, &n) : 0;
    sum += 0.5 * core->stiffness * core->weight[i] * (core->slack ? stretch * stretch : spore_vec3_dot(d, d));
  }
  return sum;
}

/* Jacobian. With J = (1, -1, [a]x) for (node, centre, turning), a tie of weight k adds k J^T J. One that is stiffer
 * along its direction n than across it, by k, adds k (J^T n) (J^T n)^T, and J^T n is (n, -n, n x a). */

static void add(SporeBlockMatrix *matrix, uint32_t at, double scale, const SporeMat3 *block) {
  double *values = matrix->values + 9 * (size_t)at;
  for (int k = 0; k < 9; k++) values[k] += scale * block->m[k];
}

/* What all ties together add to the core's own blocks. */
typedef struct CoreSum {
  double weight;     /* sum of k */
  SporeMat3 arm;     /* of k [a]x */
  SporeMat3 turning; /* of k [a]x^T [a]x */
  SporeMat3 along;   /* of k n n^T */
  SporeMat3 lever;   /* of k n (n x a)^T */
} CoreSum;

static void add_tie(const SporeVirtualCore *core, size_t i, double k, SporeVec3 a, SporeBlockMatrix *matrix,
                    CoreSum *sum) {
  assert(i < core->count);
  const SporeVirtualCoreBlocks *blocks = &core->blocks[i];
  const SporeMat3 one = spore_mat3_identity();
  SporeMat3 skew = spore_mat3_skew(a);
  add(matrix, blocks->node, k, &one);
  add(matrix, blocks->centre, -k, &one);
  add(matrix, blocks->from_centre, -k, &one);
  add(matrix, blocks->turning, k, &skew);
  add(matrix, blocks->from_turning, -k, &skew);
  sum->weight += k;
  sum->arm = spore_mat3_add(sum->arm, spore_mat3_scale(k, skew));
  sum->turning = spore_mat3_sub(sum->turning, spore_mat3_scale(k, spore_mat3_multiply(skew, skew)));
}

static void add_along(const SporeVirtualCore *core, size_t i, double k, SporeVec3 n, SporeVec3 a,
                      SporeBlockMatrix *matrix, CoreSum *sum) {
  assert(i < core->count && k >= 0);
  const SporeVirtualCoreBlocks *blocks = &core->blocks[i];
  SporeVec3 turn = spore_vec3_cross(n, a);
  SporeMat3 along = spore_mat3_outer(n, n), lever = spore_mat3_outer(n, turn), back = spore_mat3_outer(turn, n);
  add(matrix, blocks->node, k, &along);
  add(matrix, blocks->centre, -k, &along);
  add(matrix, blocks->from_centre, -k, &along);
  add(matrix, blocks->turning, k, &lever);
  add(matrix, blocks->from_turning, k, &back);
  sum->along = spore_mat3_add(sum->along, spore_mat3_scale(k, along));
  sum->lever = spore_mat3_add(sum->lever, spore_mat3_scale(k, lever));
  sum->turning = spore_mat3_add(sum->turning, spore_mat3_scale(k, spore_mat3_outer(turn, turn)));
}

static void add_core(const SporeVirtualCore *core, const CoreSum *sum, SporeBlockMatrix *matrix) {
  const SporeMat3 one = spore_mat3_identity(), lever_back = spore_mat3_transpose(sum->lever);
  add(matrix, core->centre_block, 1, &sum->along);
  add(matrix, core->across, -1, &sum->lever);
  add(matrix, core->back, -1, &lever_back);
  add(matrix, core->centre_block, sum->weight, &one);
  add(matrix, core->turning_block, 1, &sum->turning);
  add(matrix, core->across, -1, &sum->arm);
  add(matrix, core->back, 1, &sum->arm);
}

/* The positive part of a symmetric matrix. */
static SporeMat3 positive_part(SporeMat3 a) {
  double values[3];
  SporeMat3 axes, part = spore_mat3_diagonal(0, 0, 0);
  spore_mat3_eigen_symmetric(a, values, &axes);
  for (int i = 0; i < 3; i++) {
    SporeVec3 axis = spore_mat3_column(axes, i);
    if (values[i] > 0) part = spore_mat3_add(part, spore_mat3_scale(values[i], spore_mat3_outer(axis, axis)));
  }
  return part;
}

/* What a tie that may be slack is stiffer by along its direction than across. *across: across it. False: it is slack.
 */
static bool add_taut(const SporeVirtualCore *core, size_t i, double k, SporeVec3 d, SporeVec3 s,
                     SporeBlockMatrix *matrix, CoreSum *sum, double *across) {
  SporeVec3 n;
  double stretch = stretch_of(core, i, d, &n);
  if (!(stretch > 0)) return false;
  double length = stretch + core->slack[i];
  *across = k * stretch / length;
  add_along(core, i, k * core->slack[i] / length, n, s, matrix, sum); /* k less that across, without rounding below 0 */
  return true;
}

/* Elastic ties; turning the core also turns the places, which adds the symmetric part of k ((d.s) 1 - s d^T). */
static void shape_jacobian(const SporeVirtualCore *core, const double *q, double scale, bool whole,
                           SporeBlockMatrix *matrix) {
  State state = state_at(core, q);
  CoreSum sum = {0};
  SporeMat3 bent = spore_mat3_diagonal(0, 0, 0);
  for (size_t i = 0; i < core->count; i++) {
    double k = scale * core->stiffness * core->weight[i];
    SporeVec3 s = place_of(core, &state, i), d = away(&state, q, i, s);
    if (core->slack && !add_taut(core, i, k, d, s, matrix, &sum, &k)) continue;
    double dot = spore_vec3_dot(d, s);
    add_tie(core, i, k, s, matrix, &sum);
    SporeMat3 both = spore_mat3_add(spore_mat3_outer(s, d), spore_mat3_outer(d, s));
    bent = spore_mat3_add(bent, spore_mat3_scale(k, spore_mat3_diagonal(dot, dot, dot)));
    bent = spore_mat3_sub(bent, spore_mat3_scale(0.5 * k, both));
  }
  sum.turning = spore_mat3_add(sum.turning, whole ? bent : positive_part(bent));
  add_core(core, &sum, matrix);
}

static void damping_jacobian(const SporeVirtualCore *core, const double *q, double scale, SporeBlockMatrix *matrix) {
  SporeVec3 centre = spore_vec3_load(q + 3 * core->count);
  CoreSum sum = {0};
  for (size_t i = 0; i < core->count; i++)
    add_tie(core, i, scale * core->damping * core->weight[i], spore_vec3_sub(spore_vec3_load(q + 3 * i), centre),
            matrix, &sum);
  add_core(core, &sum, matrix);
}

void spore_virtual_core_jacobian(const SporeVirtualCore *core, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(at->stiffness_scale >= 0);
  assert(matrix->block_count >= core->count + 2);
  if (at->stiffness_scale != 0) shape_jacobian(core, at->q, at->stiffness_scale, at->whole, matrix);
  if (at->damping_scale != 0 && core->damping > 0) damping_jacobian(core, at->shape, at->damping_scale, matrix);
}
