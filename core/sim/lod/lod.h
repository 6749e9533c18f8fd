/* Levels of detail: coarser versions of a body, which it may change to while the world runs. Private to the room.
 *
 * The parts of the active level are in the SporeBody itself, as if there were no other level. The parts of the other
 * levels are kept here. A body's place in the world's vectors has room for its largest level; a smaller level leaves
 * the rest of it 0. Spheres, links and friction belong to material points. Each level has these points by mappings of
 * its own. */
#ifndef SPORE_SIM_LOD_H
#define SPORE_SIM_LOD_H

#include "core/linalg/block_cholesky.h"
#include "core/sim/state/state.h"

/* One level of a body. For the active level, only what is not in the SporeBody is valid. */
typedef struct SporeLevel {
  SporeModel *model;                 /* always; NULL: there is no such level */
  double *rest_q, *rest_v;           /* at time 0 */
  SporeMapping samples;              /* of the samples of all levels, onto this level */
  size_t sample_start, sample_count; /* the level's own among them */
  size_t seen_count;                 /* of these, the first ones lie in the body */
  uint32_t *nearest;                 /* of each node: the sample next to it at time 0 */
  double *diagonal;                  /* of each block: diagonal of the fit's normal equations */
  SporeMapping *ends;                /* as SporeLevels.ends */
  /* Valid for a level that is not active. */
  SporeMapping spheres;
  double *whole_weight;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  uint8_t *held_flags;
  uint32_t *held;
  size_t held_count, pin_count;
} SporeLevel;

typedef struct SporeLevels {
  SporeLevel level[SPORE_LEVEL_COUNT];
  SporeLevelGrade first; /* at time 0 */
  double tolerance;      /* m */
  size_t q_room, v_room; /* doubles of the world's vectors: of the largest level */
  size_t end_count;
  uint32_t *ends; /* in spring_mappings, of links and the pull */
  /* Samples: material points by which one level is fitted to another, and at which the error is measured. */
  size_t sample_count;
  double *sample_weight;          /* in the fit; 0: only the error is measured there */
  double *before, *speed, *after; /* 3 a sample: positions and velocities before, positions after */
  double *q, *v;                  /* the candidate */
  double *work;                   /* SPORE_LEVEL_VECTORS x v_room */
  SporeLevelState state;
} SporeLevels;
#define SPORE_LEVEL_VECTORS 4

/* Makes the level active. Leaves the state of the body as it is. */
void spore_world_exchange_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

/* samples.c: prepares the fit of one level to another, after all levels were made. */
bool spore_levels_sample(SporeWorld *world, const SporeBodyDescription *from, uint32_t body, SporeError *error);

/* fit.c: computes the configuration and velocity of level `to`, into levels->q and v. They put the samples where the
 * body has them now, and have the momentum of the body. */
void spore_level_fit(const SporeWorld *world, const SporeBody *body, SporeLevelGrade to);
/* Greatest distance from samples in the body to where the candidate puts them, m. */
double spore_level_error(const SporeLevels *levels, SporeLevelGrade to);

/* lod.c */
bool spore_levels_make(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error);
/* Makes the parts of the levels that are not active, after everything else of the world was made. */
bool spore_world_create_levels(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_levels_free(SporeBody *body);
/* Gives the models back to the caller. */
void spore_levels_give_up(SporeBody *body);
/* Makes the level active, with its own state of time 0. */
void spore_world_select_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);
/* Gives each body its level of time 0. */
void spore_world_reset_levels(SporeWorld *world);

/* change.c: while the world runs, at the start of a step. */
void spore_world_change_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

#endif
