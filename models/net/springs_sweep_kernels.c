/* Springs met one chain after the other. */
#include <assert.h>
#include <string.h>

#include "models/net/springs.h"
#include "models/net/springs_lines.h"

#define TURNED 0.0004 /* square of the part of a chain's forces that the turning of its lines may hide */
#define MOST 4        /* times that a chain is met */

/* Columns of the work, each with zeros before its first entry. */
typedef enum Column {
  X,                  /* nodes, four columns; the last: inverse mass */
  BEFORE = X + 4,     /* where they were, three */
  MOVED = BEFORE + 3, /* by this, three */
  LINE = MOVED + 3,   /* springs, three */
  SIZE = LINE + 3,    /* l */
  STIFF,              /* K */
  WHOLE,              /* diagonal */
  BELOW,              /* its entry in the row of the spring, for the spring before */
  ABOVE,              /* that in the row of the spring before, for the spring */
  BOTH,               /* their product */
  RIGHT,              /* right side, and what elimination leaves of it */
  LEADS,              /* by which the spring towards the middle counts */
  STEP,               /* s */
  FORCE,              /* h^2 times what the spring has moved its nodes with so far */
  COLUMNS
} Column;
_Static_assert(COLUMNS == SPORE_SPRINGS_COLUMNS, "as much room as is used");

typedef struct Chains {
  const SporeSprings *springs;
  const SporeSpringsBatch *batch;
  const SporeSweep *at;
  size_t width, nodes, count; /* entries of nodes and springs, whole groups */
  double *first[COLUMNS];
} Chains;

SPORE_INLINE SporeVd get(const Chains *c, Column column, size_t i) { return spore_vd_load(c->first[column] + i); }
SPORE_INLINE void put(const Chains *c, Column column, size_t i, SporeVd a) { spore_vd_store(c->first[column] + i, a); }
SPORE_INLINE SporeVd3 get3(const Chains *c, Column column, size_t i) {
  return (SporeVd3){get(c, column, i), get(c, column + 1, i), get(c, column + 2, i)};
}
SPORE_INLINE void put3(const Chains *c, Column column, size_t i, SporeVd3 a) {
  put(c, column, i, a.x), put(c, column + 1, i, a.y), put(c, column + 2, i, a.z);
}
/* The same of the spring before. */
SPORE_INLINE SporeVd back(const Chains *c, Column column, size_t i) {
  return spore_vd_load(c->first[column] + i - c->width);
}
SPORE_INLINE SporeVd3 back3(const Chains *c, Column column, size_t i) {
  return (SporeVd3){back(c, column, i), back(c, column + 1, i), back(c, column + 2, i)};
}

/* What lies behind the last spring counts for nothing. */
SPORE_INLINE void end_column(const Chains *c, Column column) {
  memset(c->first[column] + c->batch->length * c->width, 0, 2 * SPORE_LANES * sizeof(double));
}

SPORE_INLINE void gather(const Chains *c, bool damped) {
  const uint32_t *node = c->springs->sweep.node + c->batch->node;
  for (size_t i = 0; i < c->nodes; i += SPORE_WIDTH) {
    SporeVd4 row = spore_vd4_gather(c->at->now, node + i);
    put3(c, X, i, (SporeVd3){row.x, row.y, row.z});
    put(c, X + 3, i, row.w);
    if (damped) put3(c, BEFORE, i, spore_vd3_gather(c->at->before, node + i));
  }
  for (size_t i = 0; i < c->count; i += SPORE_WIDTH) put(c, FORCE, i, (SporeVd){0});
  end_column(c, LINE), end_column(c, LINE + 1), end_column(c, LINE + 2), end_column(c, STEP), end_column(c, LEADS);
  end_column(c, RIGHT);
}

SPORE_INLINE void scatter(const Chains *c) {
  const uint32_t *node = c->springs->sweep.node + c->batch->node;
  const uint8_t *lanes = c->springs->sweep.lanes + c->batch->group;
  for (size_t i = 0; i < c->nodes; i += SPORE_WIDTH) {
    size_t lane = i % SPORE_LANES, count = lanes[i / SPORE_LANES];
    SporeVd3 x = get3(c, X, i);
    if (count > lane)
      spore_vd4_scatter(c->at->now, node + i, count - lane, (SporeVd4){x.x, x.y, x.z, get(c, X + 3, i)});
  }
}

/* Lines, diagonal and right side; returns the sum of the squares of the right side. */
SPORE_INLINE double look(const Chains *c, bool damped) {
  const SporeSprings *springs = c->springs;
  const SporeSpringsSweep *sweep = &springs->sweep;
  const uint32_t *node = sweep->node + c->batch->node;
  double h = c->at->h, whole = h * h * springs->stiffness;
  SporeVd sum[SPORE_LANES / SPORE_WIDTH] = {{0}};
  for (size_t i = 0; i < c->count; i += SPORE_WIDTH) {
    size_t k = c->batch->spring + i, next = i + c->width;
    SporeVd length = spore_vd_load(sweep->length + k), stiffness = whole * spore_vd_load(sweep->share + k), square;
    SporeVd3 across = spore_vd3_sub(get3(c, X, i), get3(c, X, next));
    SporeVd3 line = spore_line_not_short(springs->rest, node + i, node + next, across, length, &square);
    SporeVd size = spore_vd_sqrt(square), pull = stiffness * (square - length * size) + get(c, FORCE, i) * size;
    if (damped) {
      SporeVd3 moved = spore_vd3_sub(across, spore_vd3_sub(get3(c, BEFORE, i), get3(c, BEFORE, next)));
      SporeVd drag = h * springs->damping * spore_vd_load(sweep->held + k);
      pull += drag * spore_vd3_dot(line, moved);
      stiffness += drag;
    }
    put3(c, LINE, i, line);
    put(c, SIZE, i, size);
    put(c, STIFF, i, stiffness);
    put(c, WHOLE, i,
        square * (1 + stiffness * (get(c, X + 3, i) + get(c, X + 3, next))) + spore_vd_load(sweep->idle + k));
    put(c, RIGHT, i, -pull);
    sum[i % SPORE_LANES / SPORE_WIDTH] += pull * pull;
  }
  return spore_parts_sum(sum);
}

SPORE_INLINE void couple(const Chains *c) {
  for (size_t i = 0; i < c->nodes; i += SPORE_WIDTH) {
    SporeVd both = get(c, X + 3, i) * spore_vd3_dot(get3(c, LINE, i), back3(c, LINE, i));
    SporeVd below = get(c, STIFF, i) * both, above = back(c, STIFF, i) * both;
    put(c, BELOW, i, below), put(c, ABOVE, i, above), put(c, BOTH, i, below * above);
  }
}

/* Eliminates from both ends at once, which the processor overlaps, and goes back from the middle. */
#define DEFINE_SOLVE(name, Type, load, store)                                                                          \
  SPORE_INLINE void name(const Chains *c, size_t lane) {                                                               \
    const size_t w = c->width, count = c->batch->length, middle = count / 2;                                           \
    const double *whole = c->first[WHOLE] + lane, *below = c->first[BELOW] + lane, *above = c->first[ABOVE] + lane;    \
    const double *both = c->first[BOTH] + lane;                                                                        \
    double *right = c->first[RIGHT] + lane, *leads = c->first[LEADS] + lane, *step = c->first[STEP] + lane;            \
    Type one = {0}, left = {0}, its_one = {0}, its_left = {0};                                                         \
    for (size_t i = 0, k = count - 1; i < middle; i++, k--) {                                                          \
      one = 1 / (load(whole + i * w) - load(both + i * w) * one);                                                      \
      left = (load(right + i * w) + load(below + i * w) * left) * one;                                                 \
      store(right + i * w, left), store(leads + i * w, load(above + (i + 1) * w) * one);                               \
      if (k == middle) break;                                                                                          \
      its_one = 1 / (load(whole + k * w) - load(both + (k + 1) * w) * its_one);                                        \
      its_left = (load(right + k * w) + load(above + (k + 1) * w) * its_left) * its_one;                               \
      store(right + k * w, its_left), store(leads + k * w, load(below + k * w) * its_one);                             \
    }                                                                                                                  \
    size_t at = middle * w, next = at + w;                                                                             \
    Type s = (load(right + at) + load(below + at) * left + load(above + next) * its_left) /                            \
             (load(whole + at) - load(both + at) * one - load(both + next) * its_one);                                 \
    Type its = s;                                                                                                      \
    store(step + at, s);                                                                                               \
    for (size_t i = middle, k = middle + 1; i > 0; k++) {                                                              \
      i--, s = load(right + i * w) + load(leads + i * w) * s;                                                          \
      store(step + i * w, s);                                                                                          \
      if (k >= count) continue;                                                                                        \
      its = load(right + k * w) + load(leads + k * w) * its;                                                           \
      store(step + k * w, its);                                                                                        \
    }                                                                                                                  \
  }

SPORE_INLINE double load_one(const double *p) { return *p; }
SPORE_INLINE void store_one(double *p, double a) { *p = a; }
DEFINE_SOLVE(solve_one, double, load_one, store_one)
DEFINE_SOLVE(solve_many, SporeVd, spore_vd_load, spore_vd_store)

/* Moves the nodes. */
SPORE_INLINE void move(const Chains *c) {
  for (size_t i = 0; i < c->nodes; i += SPORE_WIDTH) {
    SporeVd step = get(c, STEP, i), other = back(c, STEP, i), weight = get(c, X + 3, i);
    SporeVd3 line = get3(c, LINE, i), last = back3(c, LINE, i), x = get3(c, X, i);
    SporeVd3 by = {weight * (step * line.x - other * last.x), weight * (step * line.y - other * last.y),
                   weight * (step * line.z - other * last.z)};
    put3(c, X, i, (SporeVd3){x.x + by.x, x.y + by.y, x.z + by.z});
    put3(c, MOVED, i, by);
  }
}

/* Whether the lines turned so far that the forces are off by more than a part of what they were; no more than what the
 * stretch of each line by its whole turn makes of them. first: sum of the squares of the right side. */
SPORE_INLINE bool has_turned(const Chains *c, double first) {
  SporeVd sum[SPORE_LANES / SPORE_WIDTH] = {{0}};
  for (size_t i = 0; i < c->count; i += SPORE_WIDTH) {
    SporeVd3 by = spore_vd3_sub(get3(c, MOVED, i), get3(c, MOVED, i + c->width));
    SporeVd off = 0.5 * get(c, STIFF, i) * spore_vd3_dot(by, by);
    sum[i % SPORE_LANES / SPORE_WIDTH] += off * off;
    put(c, FORCE, i, get(c, FORCE, i) + get(c, STEP, i) * get(c, SIZE, i));
  }
  return spore_parts_sum(sum) > TURNED * first;
}

SPORE_INLINE void meet(const Chains *c, bool damped) {
  gather(c, damped);
  double first = 0;
  for (int time = 0; time < MOST; time++) {
    double square = look(c, damped);
    if (time == 0) first = square;
    couple(c);
    if (c->width == 1) solve_one(c, 0);
    else
      for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) solve_many(c, lane);
    move(c);
    if (!has_turned(c, first)) break;
  }
  scatter(c);
}

void SPORE_LEVEL_NAME(spore_springs_sweep_batches)(const SporeSprings *springs, const SporeSweep *at) {
  assert(at->h > 0 && springs->stiffness > 0);
  const SporeSpringsSweep *sweep = &springs->sweep;
  Chains chains = {.springs = springs, .at = at};
  for (size_t k = 0; k < COLUMNS; k++) chains.first[k] = sweep->work + k * sweep->room + SPORE_LANES;
  for (size_t b = 0; b < sweep->count; b++) {
    const SporeSpringsBatch *batch = &sweep->batches[b];
    chains.batch = batch, chains.width = batch->width;
    chains.count = (batch->length * batch->width + SPORE_LANES - 1) / SPORE_LANES * SPORE_LANES;
    chains.nodes = chains.count + SPORE_LANES;
    if (springs->damping > 0) meet(&chains, true);
    else meet(&chains, false);
  }
}
