/* Forces, energy and Jacobian of springs. */
#include "models/net/springs.h"

#include <assert.h>
#include <math.h>

#include "models/common/block_rows.h"
#include "models/net/springs_lines.h"

/* The values of x (three entries a node) at the neighbours in the slot. */
SPORE_INLINE SporeVd3 at_neighbours(const SporeSprings *springs, size_t slot, const double *x) {
  const uint32_t *neighbour = springs->neighbour + slot;
  return springs->is_run[slot / SPORE_LANES] ? spore_vd3_load(x + 3 * (size_t)*neighbour)
                                             : spore_vd3_gather(x, neighbour);
}

/* From the neighbours in the slot to the nodes. */
SPORE_INLINE SporeVd3 line_of(const SporeSprings *springs, const uint32_t *node, size_t slot, SporeVd3 position,
                              const double *q, SporeVd length, SporeVd *square) {
  SporeVd3 line = spore_vd3_sub(position, at_neighbours(springs, slot, q));
  return spore_line_not_short(springs->rest, node, springs->neighbour + slot, line, length, square);
}

/* How many of the SPORE_WIDTH lanes from `first` hold nodes. */
SPORE_INLINE size_t lanes_from(const SporeSprings *springs, size_t first) {
  size_t all = springs->lanes[first / SPORE_LANES], before = first % SPORE_LANES;
  return all < before ? 0 : all - before < SPORE_WIDTH ? all - before : SPORE_WIDTH;
}

/* Lanes of all groups of the chunks before. */
SPORE_INLINE size_t lanes_before(const SporeSprings *springs, size_t chunk) {
  assert(chunk <= springs->chunk_count);
  return SPORE_LANES * (size_t)springs->chunk_start[chunk];
}

SPORE_INLINE void subtract_rows(const SporeSprings *springs, size_t first, SporeVd3 sum, double *f) {
  double rows[4 * SPORE_WIDTH];
  spore_vd3_store_rows(rows, sum);
  for (size_t i = 0; i < lanes_from(springs, first); i++) {
    double *force = f + 3 * (size_t)springs->node[first + i];
    for (int k = 0; k < 3; k++) force[k] -= rows[4 * i + (size_t)k];
  }
}

enum { UNDAMPED, DAMPED_AT_Q, DAMPED_ALONG_LINES, MOVED_FROM_LINES };

SPORE_INLINE double *lines_at(const SporeSprings *springs, size_t slot) {
  assert(slot < SPORE_LANES * (size_t)springs->slot_start[springs->group_count]);
  return springs->lines->along + 4 * (slot - slot % SPORE_LANES) + slot % SPORE_LANES;
}
SPORE_INLINE SporeVd3 load_line(const double *line) {
  return (SporeVd3){spore_vd_load(line), spore_vd_load(line + SPORE_LANES), spore_vd_load(line + 2 * SPORE_LANES)};
}
SPORE_INLINE SporeVd load_inverse_square(const double *line) { return spore_vd_load(line + 3 * SPORE_LANES); }

void SPORE_LEVEL_NAME(spore_springs_chunk_lines)(const SporeSprings *springs, size_t chunk, const double *shape) {
  assert(chunk < springs->chunk_count);
  for (size_t first = lanes_before(springs, chunk); first < lanes_before(springs, chunk + 1); first += SPORE_WIDTH) {
    const uint32_t *node = springs->node + first, *start = springs->slot_start + first / SPORE_LANES;
    SporeVd3 position = spore_vd3_gather(shape, node);
    for (size_t s = start[0]; s < start[1]; s++) {
      size_t slot = s * SPORE_LANES + first % SPORE_LANES;
      SporeVd square;
      SporeVd3 line = line_of(springs, node, slot, position, shape, spore_vd_load(springs->length + slot), &square);
      double *to = lines_at(springs, slot);
      spore_vd_store(to, line.x), spore_vd_store(to + SPORE_LANES, line.y),
          spore_vd_store(to + 2 * SPORE_LANES, line.z);
      spore_vd_store(to + 3 * SPORE_LANES, 1 / square);
    }
  }
}

/* shared: some have more stiffness than others, or less. */
SPORE_INLINE SporeVd stiffness_at(const SporeSprings *springs, size_t slot, double stiffness, bool shared) {
  SporeVd all = spore_vd_all(stiffness);
  return shared ? all * spore_vd_load(springs->share + slot) : all;
}

/* What a line has become; *square: of its length, not 0. */
SPORE_INLINE SporeVd3 moved_line(const SporeSprings *springs, const uint32_t *node, size_t slot, SporeVd3 line,
                                 SporeVd3 speed, double h, SporeVd length, SporeVd *square) {
  line.x += h * speed.x, line.y += h * speed.y, line.z += h * speed.z;
  return spore_line_not_short(springs->rest, node, springs->neighbour + slot, line, length, square);
}

/* f = -k (1 - L/l) d - c (e . w) / |e|^2 e, with e = d or as lines->along. Nodes that meet with L = 0 feel nothing. */
SPORE_INLINE void add_forces(const SporeSprings *springs, size_t chunk, const double *q, const double *v, double h,
                             double *f, int damped, bool shared) {
  for (size_t first = lanes_before(springs, chunk); first < lanes_before(springs, chunk + 1); first += SPORE_WIDTH) {
    const uint32_t *node = springs->node + first, *start = springs->slot_start + first / SPORE_LANES;
    SporeVd3 position, velocity, sum = {0};
    if (damped != MOVED_FROM_LINES) position = spore_vd3_gather(q, node);
    if (damped) velocity = spore_vd3_gather(v, node);
    for (size_t s = start[0]; s < start[1]; s++) {
      size_t slot = s * SPORE_LANES + first % SPORE_LANES;
      SporeVd length = spore_vd_load(springs->length + slot), square;
      SporeVd3 line, speed, before;
      if (damped) speed = spore_vd3_sub(velocity, at_neighbours(springs, slot, v));
      if (damped >= DAMPED_ALONG_LINES) before = load_line(lines_at(springs, slot));
      if (damped != MOVED_FROM_LINES) line = line_of(springs, node, slot, position, q, length, &square);
      else line = moved_line(springs, node, slot, before, speed, h, length, &square);
      SporeVd inverse_length = 1 / spore_vd_sqrt(square);
      SporeVd pull = stiffness_at(springs, slot, springs->stiffness, shared) * (1 - length * inverse_length);
      if (damped == DAMPED_AT_Q)
        pull += springs->damping * spore_vd3_dot(line, speed) * (inverse_length * inverse_length);
      if (damped >= DAMPED_ALONG_LINES) {
        SporeVd inverse = load_inverse_square(lines_at(springs, slot));
        SporeVd drag = springs->damping * (spore_vd3_dot(before, speed) * inverse);
        sum.x += drag * before.x, sum.y += drag * before.y, sum.z += drag * before.z;
      }
      sum.x += pull * line.x, sum.y += pull * line.y, sum.z += pull * line.z;
    }
    if (springs->node_is_run[first / SPORE_LANES]) {
      double *force = f + 3 * (size_t)*node;
      spore_vd3_store(force, spore_vd3_sub(spore_vd3_load(force), sum));
    } else subtract_rows(springs, first, sum, f);
  }
}

SPORE_INLINE void add_damped_forces(const SporeSprings *springs, size_t chunk, const double *q, const double *v,
                                    bool along_lines, double h, double *f, bool shared) {
  if (along_lines && h > 0) add_forces(springs, chunk, q, v, h, f, MOVED_FROM_LINES, shared);
  else if (along_lines) add_forces(springs, chunk, q, v, 0, f, DAMPED_ALONG_LINES, shared);
  else if (springs->damping > 0) add_forces(springs, chunk, q, v, 0, f, DAMPED_AT_Q, shared);
  else add_forces(springs, chunk, q, v, 0, f, UNDAMPED, shared);
}

void SPORE_LEVEL_NAME(spore_springs_chunk_force)(const SporeSprings *springs, size_t chunk, const double *q,
                                                 const double *v, bool along_lines, double h, double *f) {
  assert(chunk < springs->chunk_count);
  assert(springs->stiffness > 0 && h >= 0);
  if (springs->share) add_damped_forces(springs, chunk, q, v, along_lines, h, f, true);
  else add_damped_forces(springs, chunk, q, v, along_lines, h, f, false);
}

/* Each spring comes twice, hence a quarter of k (l - L)^2. */
double SPORE_LEVEL_NAME(spore_springs_potential)(const SporeSprings *springs, const double *q) {
  double lanes[SPORE_LANES] = {0};
  for (size_t first = 0; first < SPORE_LANES * springs->group_count; first += SPORE_WIDTH) {
    const uint32_t *node = springs->node + first, *start = springs->slot_start + first / SPORE_LANES;
    double *lane = lanes + first % SPORE_LANES;
    SporeVd3 position = spore_vd3_gather(q, node);
    SporeVd sum = spore_vd_load(lane);
    for (size_t s = start[0]; s < start[1]; s++) {
      size_t slot = s * SPORE_LANES + first % SPORE_LANES;
      SporeVd3 line = spore_vd3_sub(position, at_neighbours(springs, slot, q));
      SporeVd stretch = spore_vd_sqrt(spore_vd3_dot(line, line)) - spore_vd_load(springs->length + slot);
      sum += stiffness_at(springs, slot, 1, springs->share != NULL) * stretch * stretch;
    }
    spore_vd_store(lane, sum);
  }
  return 0.25 * springs->stiffness * spore_lanes_sum(lanes);
}

bool SPORE_LEVEL_NAME(spore_springs_exceed)(const SporeSprings *springs, const double *q, double strain) {
  assert(strain > 0);
  double limit = (1 + strain) * (1 + strain);
  for (size_t first = 0; first < SPORE_LANES * springs->group_count; first += SPORE_WIDTH) {
    const uint32_t *node = springs->node + first, *start = springs->slot_start + first / SPORE_LANES;
    SporeVd3 position = spore_vd3_gather(q, node);
    SporeVl over = {0};
    for (size_t s = start[0]; s < start[1]; s++) {
      size_t slot = s * SPORE_LANES + first % SPORE_LANES;
      SporeVd3 line = spore_vd3_sub(position, at_neighbours(springs, slot, q));
      SporeVd length = spore_vd_load(springs->length + slot);
      over |= (spore_vd3_dot(line, line) > limit * length * length) & (length > 0);
    }
    if (spore_vl_any(over)) return true;
  }
  return false;
}

/* A symmetric 3x3 matrix a lane. */
typedef struct Symmetric {
  SporeVd xx, xy, xz, yy, yz, zz;
} Symmetric;

/* The matrices as SPORE_WIDTH x 3 rows of 4. */
SPORE_INLINE void store_matrices(double rows[3][4 * SPORE_WIDTH], const Symmetric *a) {
  spore_vd3_store_rows(rows[0], (SporeVd3){a->xx, a->xy, a->xz});
  spore_vd3_store_rows(rows[1], (SporeVd3){a->xy, a->yy, a->yz});
  spore_vd3_store_rows(rows[2], (SporeVd3){a->xz, a->yz, a->zz});
}

/* k t (I - nn^T) + (k + c) nn^T; where there is no line (k + c) nn^T alone. t: the tension over k l. */
SPORE_INLINE Symmetric stiffness_of(SporeVd3 line, SporeVd inverse, SporeVd length, SporeVd tension, SporeVd stiffness,
                                    double damping) {
  SporeVd none = {0}, across = spore_vd_select((SporeVl)length < 0, none, stiffness * tension);
  SporeVd nx = line.x * inverse, ny = line.y * inverse, nz = line.z * inverse;
  SporeVd along = stiffness - across + damping;
  SporeVd ax = along * nx, ay = along * ny, az = along * nz;
  return (Symmetric){ax * nx + across, ax * ny, ax * nz, ay * ny + across, ay * nz, az * nz + across};
}

/* damping: along the lines at q; drag: along lines->along. promised: the tension is the one that the linearisation at
 * `from` predicts for q, k (n . d - L) with the direction n at `from`. */
SPORE_INLINE void add_jacobian(const SporeSprings *springs, size_t chunk, const SporeTangent *at, double damping,
                               double drag, int damped, bool promised, bool shared, SporeBlockMatrix *matrix) {
  double rows[3][4 * SPORE_WIDTH], stiffness = at->stiffness_scale * springs->stiffness;
  SporeVd none = {0}, least = none + (at->whole ? -HUGE_VAL : 0);
  for (size_t first = lanes_before(springs, chunk); first < lanes_before(springs, chunk + 1); first += SPORE_WIDTH) {
    const uint32_t *node = springs->node + first, *start = springs->slot_start + first / SPORE_LANES;
    size_t lanes = lanes_from(springs, first);
    SporeVd3 position = spore_vd3_gather(at->q, node), old;
    if (promised) old = spore_vd3_gather(at->from, node);
    Symmetric sum = {0};
    for (size_t s = start[0]; s < start[1]; s++) {
      size_t slot = s * SPORE_LANES + first % SPORE_LANES;
      SporeVd length = spore_vd_load(springs->length + slot), square;
      SporeVd3 line = line_of(springs, node, slot, position, at->q, length, &square);
      SporeVd inverse = 1 / spore_vd_sqrt(square), tension = 1 - length * inverse;
      if (promised) {
        SporeVd3 along = line_of(springs, node, slot, old, at->from, length, &square);
        tension = (spore_vd3_dot(along, line) / spore_vd_sqrt(square) - length) * inverse;
      }
      Symmetric block = stiffness_of(line, inverse, length, spore_vd_max(tension, least),
                                     stiffness_at(springs, slot, stiffness, shared), damping);
      if (damped == DAMPED_ALONG_LINES) {
        const double *before = lines_at(springs, slot);
        SporeVd root = spore_vd_sqrt(load_inverse_square(before));
        Symmetric part = stiffness_of(load_line(before), root, length, none, none, drag);
        block.xx += part.xx, block.xy += part.xy, block.xz += part.xz;
        block.yy += part.yy, block.yz += part.yz, block.zz += part.zz;
      }
      sum.xx += block.xx, sum.xy += block.xy, sum.xz += block.xz;
      sum.yy += block.yy, sum.yz += block.yz, sum.zz += block.zz;
      block = (Symmetric){-block.xx, -block.xy, -block.xz, -block.yy, -block.yz, -block.zz};
      store_matrices(rows, &block);
      /* A lane without a spring adds nothing, to the diagonal block of its node. */
      for (size_t i = 0; i < lanes; i++)
        spore_block_add_rows(matrix->values + 9 * (size_t)springs->block[slot + i], rows, i);
    }
    store_matrices(rows, &sum);
    for (size_t i = 0; i < lanes; i++)
      spore_block_add_rows(matrix->values + 9 * (size_t)springs->diagonal[first + i], rows, i);
  }
}

SPORE_INLINE void add_damped_jacobian(const SporeSprings *springs, size_t chunk, const SporeTangent *at,
                                      bool along_lines, bool shared, SporeBlockMatrix *matrix) {
  double damping = at->damping_scale * springs->damping;
  if (!along_lines && !at->from) add_jacobian(springs, chunk, at, damping, 0, DAMPED_AT_Q, false, shared, matrix);
  else if (!along_lines) add_jacobian(springs, chunk, at, damping, 0, DAMPED_AT_Q, true, shared, matrix);
  else if (!at->from) add_jacobian(springs, chunk, at, 0, damping, DAMPED_ALONG_LINES, false, shared, matrix);
  else add_jacobian(springs, chunk, at, 0, damping, DAMPED_ALONG_LINES, true, shared, matrix);
}

void SPORE_LEVEL_NAME(spore_springs_chunk_jacobian)(const SporeSprings *springs, size_t chunk, const SporeTangent *at,
                                                    bool along_lines, SporeBlockMatrix *matrix) {
  assert(chunk < springs->chunk_count);
  assert(springs->stiffness > 0);
  if (springs->share) add_damped_jacobian(springs, chunk, at, along_lines, true, matrix);
  else add_damped_jacobian(springs, chunk, at, along_lines, false, matrix);
}
