/* Rows of a preconditioner that holds what couples the bodies of an island: J, and G = J B^-1 J^T. See
 * coupled_factor.c. Private to the room. */
#ifndef SPORE_SIM_COUPLED_ROWS_H
#define SPORE_SIM_COUPLED_ROWS_H

#include "core/sim/solve/island_system.h"

#define SPORE_COUPLED_MOST 64 /* couplings; conjugate gradients take care of others */
#define SPORE_COUPLED_ENDS 32 /* blocks of v that both ends of a coupling hang on */
#define SPORE_COUPLED_ROWS (3 * SPORE_COUPLED_MOST)

/* A block of v that a coupling hangs on: it moves by weight x, and where the block has a rotation behind it, by
 * weight w x lever too. */
typedef struct SporeCoupledPart {
  uint32_t v;
  bool turns;
  double weight, lever[3];
} SporeCoupledPart;

/* What a coupling is known by from step to step: the points that it couples. Several may have the same name. */
typedef struct SporeCoupledName {
  const SporeMapping *mapping_a, *mapping_b;
  uint32_t body_a, point_a, body_b, point_b;
} SporeCoupledName;

/* A coupling as it was when its part of G was made: J's rows. */
typedef struct SporeCoupledRow {
  SporeCoupledName name;
  bool known;     /* its part of G is */
  uint64_t taken; /* the last of `takes` whose couplings it was among */
  uint32_t part_count;
  SporeCoupledPart part[SPORE_COUPLED_ENDS];
} SporeCoupledRow;

/* Whether the preconditioner of one step is the first of the next. */
typedef struct SporeRecall {
  bool on;
  uint64_t step;           /* number of the last one that counts, plus 1; 0: none */
  double work;             /* of that step: factors, couplings and iterations, as preconditioner.c counts operations */
  double with, without;    /* recent means of it */
  uint32_t steps;          /* since it is on */
  uint32_t wait, patience; /* steps until it may be on again; how many that is next time */
} SporeRecall;

struct SporeCoupledRoom {
  size_t count; /* rows */
  uint64_t takes;
  size_t active_count; /* couplings of the present linearisation: */
  uint32_t active[SPORE_COUPLED_MOST];
  double flexibility[SPORE_COUPLED_ROWS * SPORE_COUPLED_ROWS]; /* G */
  SporeCoupledRow row[SPORE_COUPLED_MOST];
  SporeRecall recall;
  uint64_t bodies;        /* digest of the bodies, their factors and their places in v */
  double used, iteration; /* work of iterations since the factors were made but the first of each solution; of one */
  double matrix[SPORE_COUPLED_ROWS * SPORE_COUPLED_ROWS]; /* factor of 1 + K G, of the active rows */
  uint32_t order[SPORE_COUPLED_ROWS];                     /* of that factor */
  bool factored, dragged;                                 /* there is one; of K with what friction drags */
  /* By places in `active`: K, and what is taken away from it where friction drags. */
  double k[9 * SPORE_COUPLED_MOST], drag[9 * SPORE_COUPLED_MOST];
  double motion[SPORE_COUPLED_ROWS];
};

/* Whether B is a matrix with a factor; else B is the mass, whose blocks are inverted. */
static inline bool spore_island_system_has_factor(const SporeIslandSystem *system, const SporeBody *body) {
  return spore_island_system_assembles(system, body) && body->preconditioner.factor.block_count > 0;
}

/* Room for SPORE_LANES vectors of the body whose part of v begins at `from`. */
static inline double *spore_island_system_lanes(const SporeIslandSystem *system, size_t from) {
  return system->world->solve.lanes + SPORE_LANES * (system->island->v_start + from);
}

/* Begins a linearisation: no row is active. */
void spore_coupled_rows_begin(SporeCoupledRoom *room);
/* The row of the coupling, which is then the last active one; SPORE_COUPLED_MOST: there is no room for it. The row
 * stays as it is known, where the coupling has not moved far on its bodies. */
size_t spore_coupled_rows_take(SporeCoupledRoom *room, const SporeCoupling *coupling);
/* Completes G for the rows that are not known; returns their number. */
size_t spore_coupled_rows_solve(const SporeIslandSystem *system, SporeCoupledRoom *room);
/* J x, and y += J^T force, x and y as long as the island's v. */
SporeVec3 spore_coupled_row_motion(const SporeCoupledRow *row, const double *x);
void spore_coupled_row_push(const SporeCoupledRow *row, SporeVec3 force, double *y);

#endif
