/* Levels of a body: the same body made less finely, to change to while it runs. Private to the room.
 *
 * The active level lies in the SporeBody itself, as if there were no other; the others wait here. A body's place in the
 * world's vectors has room for its largest level, and what a smaller one leaves of it is 0. Spheres, links and grips
 * are of material points, so that each level has them: by mappings of its own. */
#ifndef SPORE_SIM_LOD_H
#define SPORE_SIM_LOD_H

#include "core/linalg/block_cholesky.h"
#include "core/sim/state/state.h"

/* What a SporeBody has of its level; of the active one only what does not lie in the body. */
typedef struct SporeLevel {
  SporeModel *model;                 /* always; NULL: there is no such level */
  double *rest_q, *rest_v;           /* at time 0 */
  SporeMapping samples;              /* where the level puts the samples of all levels */
  size_t sample_start, sample_count; /* the level's own among them */
  size_t seen_count;                 /* of those, the first ones, that lie in the body */
  uint32_t *nearest;                 /* a node: the sample that lies next to it at time 0 */
  double *diagonal;                  /* a block: of the fit's normal equations */
  SporeMapping *ends;                /* as SporeLevels.ends */
  /* Of a level that is not active. */
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
  /* Material points by which one level is fitted to another, and on which the error of that is measured. */
  size_t sample_count;
  double *sample_weight;          /* in the fit; 0: only looked at */
  double *before, *speed, *after; /* 3 a sample: where they were, how fast; where they are */
  double *q, *v;                  /* the candidate */
  double *work;                   /* LEVEL_VECTORS x v_room */
  SporeLevelState state;
} SporeLevels;
#define SPORE_LEVEL_VECTORS 4

/* Puts the body at the level as it is. */
void spore_world_exchange_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

/* samples.c: all that fitting one level to another needs, once all are made. */
bool spore_levels_sample(SporeWorld *world, const SporeBodyDescription *from, uint32_t body, SporeError *error);

/* fit.c: the configuration and velocity of level `to`, in levels->q and v, that put the samples where the body
 * has them now; with the momentum that the body has. `from`: the active one, whose state is q, v. */
void spore_level_fit(const SporeWorld *world, const SporeBody *body, SporeLevelGrade to);
/* Greatest distance between where the samples that lie in the body were and where the candidate puts them, m. */
double spore_level_error(const SporeLevels *levels, SporeLevelGrade to);

/* lod.c */
bool spore_levels_make(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error);
/* Makes what the levels that are not active need, after everything else of the world was made. */
bool spore_world_create_levels(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_levels_free(SporeBody *body);
/* Gives the models back to the caller. */
void spore_levels_give_up(SporeBody *body);
/* Makes the level active, with its state at time 0 for that of the body. */
void spore_world_select_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);
/* Back to the levels of time 0. */
void spore_world_reset_levels(SporeWorld *world);

/* change.c: while the world runs, at the start of a step. */
void spore_world_change_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

#endif
