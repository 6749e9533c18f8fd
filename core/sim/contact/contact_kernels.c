/* Forces of contacts in lanes, several at once, one kernel for each level of the processor. */
#include <assert.h>

#include "core/sim/contact/contact_lanes.h"

#include "core/math/simd_matrix.h"

SPORE_INLINE SporeVd3 load(const SporeLaneVector *vector, int k) {
  return (SporeVd3){spore_vd_load(vector->x + k), spore_vd_load(vector->y + k), spore_vd_load(vector->z + k)};
}

SPORE_INLINE void store(SporeLaneVector *vector, int k, SporeVd3 value) {
  spore_vd_store(vector->x + k, value.x);
  spore_vd_store(vector->y + k, value.y);
  spore_vd_store(vector->z + k, value.z);
}

SPORE_INLINE SporeVd3 none(void) { return (SporeVd3){{0}, {0}, {0}}; }

SPORE_INLINE SporeVd3 across(SporeVd3 normal, SporeVd3 a) {
  return spore_vd3_sub(a, spore_vd3_scale(spore_vd3_dot(normal, a), normal));
}

/* State of an end that physics moves: its displacement, its velocity where the force acts, and the motion of its arm by
 * turning. */
typedef struct EndState {
  SporeVd3 motion, velocity, turned;
} EndState;

SPORE_INLINE EndState node_state(const SporeLaneEnd *end, int k, SporeVl moves, const double *q, const double *v) {
  SporeVd3 motion = spore_vd3_sub(spore_vd3_gather(q, end->at + k), load(&end->start, k));
  SporeVd3 velocity = spore_vd3_gather(v, end->v_node + k);
  return (EndState){spore_vd3_select(moves, motion, none()), spore_vd3_select(moves, velocity, none()), none()};
}

SPORE_INLINE EndState frame_state(SporeLaneEnd *end, int k, SporeVl moves, const double *frames, bool rubs) {
  SporeVd3 row[6], point = load(&end->point, k), arm = load(&end->arm, k), turned = none();
  for (int i = 0; i < 6; i++) row[i] = spore_vd3_gather(frames + 3 * i, end->at + k);
  SporeVd3 radius = {spore_vd3_dot(row[0], point), spore_vd3_dot(row[1], point), spore_vd3_dot(row[2], point)};
  SporeVd3 lever = spore_vd3_add(radius, arm);
  SporeVd3 motion = spore_vd3_sub(spore_vd3_add(row[3], radius), load(&end->start, k));
  SporeVd3 velocity = spore_vd3_add(row[4], spore_vd3_cross(row[5], lever));
  if (rubs) {
    SporeVd3 frame_arm = load(&end->frame_arm, k);
    SporeVd3 now = {spore_vd3_dot(row[0], frame_arm), spore_vd3_dot(row[1], frame_arm),
                    spore_vd3_dot(row[2], frame_arm)};
    turned = spore_vd3_select(moves, spore_vd3_sub(now, arm), none());
  }
  store(&end->lever, k, lever);
  return (EndState){spore_vd3_select(moves, motion, none()), spore_vd3_select(moves, velocity, none()), turned};
}

SPORE_INLINE SporeVl mask(const int64_t *lanes) { return (SporeVl)spore_vd_load((const double *)(const void *)lanes); }

SPORE_INLINE EndState end_state(SporeContactLanes *lanes, SporeLaneEnd *end, int k, const double *at, const double *v) {
  SporeVl moves = mask(end->moves + k);
  if (lanes->kind == SPORE_LANES_NODES) return node_state(end, k, moves, at, v);
  return frame_state(end, k, moves, at, lanes->rubs);
}

/* spore_contact_step, without the slope */
SPORE_INLINE SporeVd step(SporeVd x, SporeVd width) {
  SporeVd y = x / width, zero = {0}, one = spore_vd_all(1);
  SporeVl inside = (x > zero) & (x < width);
  return spore_vd_select(inside, y * y * (3 - 2 * y), spore_vd_select(x > zero, one, zero));
}

/* N of the law. */
SPORE_INLINE SporeVd press(const SporeContactLanes *lanes, int k, SporeVd depth, SporeVd gap_speed, SporeVd viscous) {
  const double half_exit = 0.5 * SPORE_CONTACT_EXIT_SPEED;
  SporeVd stiffness = spore_vd_load(lanes->stiffness + k), zero = {0}, held = depth;
  if (lanes->overlaps) {
    SporeVd overlap = spore_vd_load(lanes->overlap + k);
    SporeVd lost = step(gap_speed - half_exit, spore_vd_all(half_exit));
    held = depth - lost * spore_vd_select(overlap < depth, overlap, depth);
  }
  SporeVd force = stiffness * held - viscous * gap_speed;
  return spore_vd_select((depth > zero) & (force > zero), force, zero);
}

/* T. moved: motion of the contact point of a on b since the step began. */
SPORE_INLINE SporeVd3 hold(const SporeContactLanes *lanes, int k, SporeVd3 n, SporeVd3 moved, SporeVd3 velocity,
                           SporeVd viscous, SporeVd pressing) {
  SporeVd stiffness = spore_vd_load(lanes->stiffness + k), zero = {0};
  SporeVd3 stretch = spore_vd3_add(load(&lanes->stretch, k), across(n, moved));
  SporeVd3 held = spore_vd3_add(spore_vd3_scale(stiffness, stretch), spore_vd3_scale(viscous, across(n, velocity)));
  SporeVd longest = spore_vd_load(lanes->friction + k) * pressing, square = spore_vd3_dot(held, held);
  SporeVl slips = square > longest * longest, rubs = longest > zero;
  SporeVd cut = spore_vd_select(slips, longest / spore_vd_sqrt(square), spore_vd_all(1));
  return spore_vd3_select(rubs, spore_vd3_scale(cut, held), none());
}

SPORE_INLINE void evaluate(SporeContactLanes *lanes, int k, const double *at, const double *v, double elapsed_s) {
  assert(k + SPORE_WIDTH <= SPORE_LANES);
  SporeVd3 n = load(&lanes->normal, k), driven = load(&lanes->driven, k);
  EndState a = end_state(lanes, &lanes->a, k, at, v), b = end_state(lanes, &lanes->b, k, at, v);
  SporeVd3 own = spore_vd3_sub(a.velocity, b.velocity), velocity = spore_vd3_add(own, driven);
  SporeVd3 moved = spore_vd3_add(spore_vd3_sub(a.motion, b.motion), spore_vd3_scale(spore_vd_all(elapsed_s), driven));
  SporeVd depth = spore_vd_load(lanes->depth + k) - spore_vd3_dot(n, moved);
  SporeVd viscous = spore_vd_load(lanes->damping + k) * step(depth, spore_vd_load(lanes->damping_depth + k));
  SporeVd pressing = press(lanes, k, depth, spore_vd3_dot(n, velocity), viscous);
  SporeVd3 force = spore_vd3_scale(pressing, n);
  spore_vd_store(lanes->pressing + k, pressing);
  if (lanes->rubs) {
    moved = spore_vd3_add(moved, spore_vd3_sub(a.turned, b.turned));
    if (lanes->kind == SPORE_LANES_FRAMES) {
      SporeVl rolls = mask(lanes->rolls + k);
      SporeVd3 slip = spore_vd3_scale(spore_vd_all(elapsed_s), velocity);
      moved = spore_vd3_select(rolls, slip, moved);
    }
    force = spore_vd3_sub(force, hold(lanes, k, n, moved, velocity, viscous, pressing));
  }
  store(&lanes->force, k, force);
}

void SPORE_LEVEL_NAME(spore_contact_lanes_force)(SporeContactLanes *lanes, const double *at, const double *v,
                                                 double elapsed_s) {
  assert(lanes->kind != SPORE_LANES_APART);
  assert(lanes->count <= SPORE_LANES);
  for (int k = 0; k < SPORE_LANES; k += SPORE_WIDTH) evaluate(lanes, k, at, v, elapsed_s);
}
