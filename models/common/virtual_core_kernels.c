/* Forces of the ties between nodes and a virtual core. */
#include <assert.h>
#include <string.h>

#include "core/math/simd_matrix.h"
#include "models/common/virtual_core.h"

SPORE_INLINE SporeVd3 all(const double *a) {
  return (SporeVd3){spore_vd_all(a[0]), spore_vd_all(a[1]), spore_vd_all(a[2])};
}

SPORE_INLINE SporeVd3 turn(const double *m, SporeVd3 a) {
  return (SporeVd3){m[0] * a.x + m[1] * a.y + m[2] * a.z, m[3] * a.x + m[4] * a.y + m[5] * a.z,
                    m[6] * a.x + m[7] * a.y + m[8] * a.z};
}

typedef struct Core { /* at q, and in the shape that is damped along */
  SporeVd3 centre, shape_centre, velocity, spin;
} Core;

/* The part of a tie's length that is not slack. */
SPORE_INLINE SporeVd taut(SporeVd3 away, SporeVd slack) {
  SporeVd length = spore_vd_max(spore_vd_sqrt(spore_vd3_dot(away, away)), spore_vd_all(SPORE_VIRTUAL_CORE_SHORTEST));
  return spore_vd_max(length - slack, spore_vd_all(0)) / length;
}

/* Forces of the ties of the nodes from i on; *torque += their torque on the core. Lanes behind the last node have
 * weight 0. */
SPORE_INLINE SporeVd3 pull(const SporeVirtualCore *ties, const Core *core, const SporeMat3 *rotation,
                           const double *place, const double *weight, const double *slack, const double *q,
                           const double *shape, const double *v, bool damped, SporeVd3 *torque) {
  SporeVd w = spore_vd_load(weight), k = ties->stiffness * w, b = ties->damping * w;
  SporeVd3 s = turn(rotation->m, spore_vd3_load(place));
  SporeVd3 away = spore_vd3_sub(spore_vd3_sub(spore_vd3_load(q), core->centre), s);
  if (slack) k = k * taut(away, spore_vd_load(slack));
  SporeVd3 elastic = spore_vd3_scale(k, away);
  *torque = spore_vd3_add(*torque, spore_vd3_cross(s, elastic));
  if (!damped) return elastic;
  SporeVd3 arm = spore_vd3_sub(spore_vd3_load(shape), core->shape_centre);
  SporeVd3 speed = spore_vd3_sub(spore_vd3_sub(spore_vd3_load(v), core->velocity), spore_vd3_cross(core->spin, arm));
  SporeVd3 viscous = spore_vd3_scale(b, speed);
  *torque = spore_vd3_add(*torque, spore_vd3_cross(arm, viscous));
  return spore_vd3_add(elastic, viscous);
}

/* The nodes behind the last whole vector, filled up with nodes of weight 0. */
typedef struct Rest {
  double weight[SPORE_WIDTH], slack[SPORE_WIDTH], place[3 * SPORE_WIDTH], q[3 * SPORE_WIDTH], shape[3 * SPORE_WIDTH],
      v[3 * SPORE_WIDTH];
} Rest;

SPORE_INLINE void load_rest(Rest *rest, const SporeVirtualCore *ties, size_t i, size_t count, const double *q,
                            const double *shape, const double *v) {
  assert(count < SPORE_WIDTH && i + count == ties->count);
  memset(rest, 0, sizeof *rest);
  memcpy(rest->weight, ties->weight + i, count * sizeof *q);
  if (ties->slack) memcpy(rest->slack, ties->slack + i, count * sizeof *q);
  memcpy(rest->place, ties->place + 3 * i, 3 * count * sizeof *q);
  memcpy(rest->q, q + 3 * i, 3 * count * sizeof *q);
  memcpy(rest->shape, shape + 3 * i, 3 * count * sizeof *q);
  memcpy(rest->v, v + 3 * i, 3 * count * sizeof *q);
}

SPORE_INLINE void store_lanes(double lanes[3][SPORE_LANES], size_t first, SporeVd3 a) {
  spore_vd_store(lanes[0] + first, a.x);
  spore_vd_store(lanes[1] + first, a.y);
  spore_vd_store(lanes[2] + first, a.z);
}

/* Each lane has a sum of its own, by its place in a group of SPORE_LANES, so that the result does not depend on the
 * width of a vector. */
SPORE_INLINE void add_forces(const SporeVirtualCore *ties, const SporeMat3 *rotation, const double *q,
                             const double *shape, const double *v, bool damped, bool slack, double *f) {
  size_t n = ties->count;
  const Core core = {all(q + 3 * n), all(shape + 3 * n), all(v + 3 * n), all(v + 3 * n + 3)};
  double forces[3][SPORE_LANES], torques[3][SPORE_LANES];
  for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
    SporeVd3 force = {0}, torque = {0};
    for (size_t i = lane; i < n; i += SPORE_LANES) {
      size_t count = n - i < SPORE_WIDTH ? n - i : SPORE_WIDTH;
      if (count == SPORE_WIDTH) {
        SporeVd3 p = pull(ties, &core, rotation, ties->place + 3 * i, ties->weight + i, slack ? ties->slack + i : NULL,
                          q + 3 * i, shape + 3 * i, v + 3 * i, damped, &torque);
        force = spore_vd3_add(force, p);
        spore_vd3_store(f + 3 * i, spore_vd3_sub(spore_vd3_load(f + 3 * i), p));
      } else {
        Rest rest;
        double back[3 * SPORE_WIDTH];
        load_rest(&rest, ties, i, count, q, shape, v);
        SporeVd3 p = pull(ties, &core, rotation, rest.place, rest.weight, slack ? rest.slack : NULL, rest.q, rest.shape,
                          rest.v, damped, &torque);
        force = spore_vd3_add(force, p);
        spore_vd3_store(back, p);
        for (size_t k = 0; k < 3 * count; k++) f[3 * i + k] -= back[k];
      }
    }
    store_lanes(forces, lane, force);
    store_lanes(torques, lane, torque);
  }
  for (size_t k = 0; k < 3; k++) {
    f[3 * n + k] += spore_lanes_sum(forces[k]);
    f[3 * n + 3 + k] += spore_lanes_sum(torques[k]);
  }
}

void SPORE_LEVEL_NAME(spore_virtual_core_ties)(const SporeVirtualCore *core, const SporeMat3 *rotation, const double *q,
                                               const double *shape, const double *v, double *f) {
  assert(core->count > 0);
  assert(core->stiffness >= 0 && core->damping >= 0);
  if (core->slack) add_forces(core, rotation, q, shape, v, true, true, f);
  else if (core->damping > 0) add_forces(core, rotation, q, shape, v, true, false, f);
  else add_forces(core, rotation, q, shape, v, false, false, f);
}
