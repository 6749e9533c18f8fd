/* Levels of a body: the same body made less finely, to change to while it runs. Private to the room.
 *
 * The active level lies in the SporeBody itself, as if there were no other; the others wait here. A body's place in the
 * world's vectors has room for its largest level, and what a smaller one leaves of it is 0. Spheres, links and grips
 * are of material points, so that each level has them: by mappings of its own. */
#ifndef SPORE_SIM_LEVELS_H
#define SPORE_SIM_LEVELS_H

#include "core/sim/world_private.h"

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

struct SporeLevels {
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
};
#define SPORE_LEVEL_VECTORS 4

/* Puts the body at the level as it is. */
void spore_world_exchange_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

/* level_samples.c: all that fitting one level to another needs, once all are made. */
bool spore_levels_sample(SporeWorld *world, const SporeBodyDescription *from, uint32_t body, SporeError *error);

/* level_fit.c: the configuration and velocity of level `to`, in levels->q and v, that put the samples where the body
 * has them now; with the momentum that the body has. `from`: the active one, whose state is q, v. */
void spore_level_fit(const SporeWorld *world, const SporeBody *body, SporeLevelGrade to);
/* Greatest distance between where the samples that lie in the body were and where the candidate puts them, m. */
double spore_level_error(const SporeLevels *levels, SporeLevelGrade to);

/* level_momentum.c */
typedef struct SporeMotion { /* of a whole body, about `centre` */
  double mass;
  SporeVec3 centre, momentum, angular;
  SporeMat3 inertia;
  double kinetic;
} SporeMotion;
/* centre: as given, or NULL for the centre of mass. */
SporeMotion spore_level_motion(const SporeModel *model, const double *q, const double *v, const SporeVec3 *centre);
/* Gives the model's velocities the momentum of `before`, and takes so much of what moves besides that kinetic energy
 * becomes at most `kinetic`, J, as far as that momentum allows. */
void spore_level_keep_momentum(const SporeModel *model, const double *q, const SporeMotion *before, double kinetic,
                               double *v);

#endif
