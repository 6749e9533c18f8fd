/* Levels of detail of a body: the same body made less finely. The body can change to such a level while the world runs.
 *
 * The active level lies in the SporeBody itself, as if there were no other level. The other levels lie here. In the
 * world's vectors a body has room for its largest level; a smaller level leaves the rest of that room 0. Spheres, links
 * and holds belong to material points. So each level carries them, by mappings of its own. */
#ifndef SPORE_SIM_LOD_H
#define SPORE_SIM_LOD_H

#include "core/linalg/block_cholesky.h"
#include "core/sim/state/state.h"

/* One level of a body. Of the active level, only the first part is in use; the second part lies in the body. */
typedef struct SporeLodLevel {
  SporeModel *model;                 /* NULL: there is no such level */
  double *rest_q, *rest_v;           /* at time 0 */
  SporeMapping samples;              /* where the level puts the samples of all levels */
  size_t sample_start, sample_count; /* samples that this level brought in */
  size_t seen_count;                 /* of those, the first ones: they lie in the body */
  uint32_t *nearest;                 /* one a node: the sample nearest to the node at time 0 */
  double *diagonal;                  /* one a block: diagonal of the normal equations of the fit */
  SporeMapping *ends;                /* end_count: mappings of the ends that SporeLod.ends lists */
  /* Second part, of a level that is not active. */
  SporeMapping spheres;
  double *whole_weight;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  uint8_t *held_flags;
  uint32_t *held;
  size_t held_count, pin_count;
  double wrong; /* share of a bend that the level gets wrong: see estimate.c; 0 of the finest level */
} SporeLodLevel;

/* How a body changes its level by itself, and what that waits for. */
typedef struct SporeLodAutomation {
  SporeLodRule rule;
  bool stays_fine;       /* it may be cut, and its rule does not go by distance */
  uint64_t not_before;   /* number of the step from which a change may be tried again */
  uint32_t refusals;     /* in a row: each one makes the wait twice as long */
  uint64_t calm_steps;   /* for which a coarser level would have done */
  uint64_t coarser_step; /* number of the step in which it last got coarser; 0: it did not */
  uint32_t returns;      /* times in a row that it got finer again soon: each one makes the calm twice as long */
  double saved_us;       /* of a step, by the last change to a coarser level; by time alone */
} SporeLodAutomation;

/* Steps of the time that bodies follow. */
typedef struct SporeLodClock {
  double sum_us;         /* of the steps since the last look */
  uint32_t steps;        /* since the last look */
  uint32_t over, under;  /* looks in a row that found steps too long; that found them short */
  bool skip;             /* a level changes in this step, which takes time that is no step's */
  double before_us;      /* what a step took before the last change */
  uint32_t changed_body; /* made coarser at the last look; SPORE_NO_BODY: none */
} SporeLodClock;

/* Levels of all bodies. */
typedef struct SporeLodSystem {
  size_t automatic_count; /* bodies that change their level by themselves */
  bool by_time;           /* one of them by time */
  size_t eye_count;
  SporeEyeDescription *eyes;
  uint64_t look_steps; /* from one look to the next */
  SporeLodClock clock;
  uint64_t change_count;             /* ever, since time 0 */
  SporeLodChange log[SPORE_LOD_LOG]; /* change i is at i % SPORE_LOD_LOG */
} SporeLodSystem;

/* The levels of a body. */
typedef struct SporeLod {
  SporeLodLevel level[SPORE_LOD_COUNT];
  SporeLodGrade first; /* at time 0 */
  double tolerance;    /* m */
  SporeLodAutomation automation;
  size_t q_room, v_room; /* doubles in the world's vectors: those of the largest level */
  size_t end_count;
  uint32_t *ends; /* end_count: indices in SporeLinkSystem.mappings of the ends of links and of the pull on this body */
  /* Samples: material points by which one level is fitted to another, and at which the error of the fit is measured. */
  size_t sample_count;
  double *sample_weight;          /* sample_count: weight in the fit; 0: only the error is measured there */
  double *before, *speed, *after; /* sample_count x 3: positions and velocities before the change; positions after */
  double *q, *v;                  /* the fitted state, before it is accepted */
  double *work;                   /* SPORE_LOD_VECTORS x v_room */
  SporeLodState state;
} SporeLod;
#define SPORE_LOD_VECTORS 4

/* Makes the level the active one. The state of the body is not set. */
void spore_world_exchange_lod(SporeWorld *world, uint32_t body, SporeLodGrade level);

/* samples.c: makes the samples, after all levels were made. */
bool spore_lod_sample(SporeWorld *world, const SporeBodyDescription *from, uint32_t body, SporeError *error);

/* fit.c: computes the state of level `to`, in levels->q and levels->v. It puts the samples where the active level has
 * them now (weighted least squares), and keeps the momentum of the body. */
void spore_lod_fit(const SporeWorld *world, const SporeBody *body, SporeLodGrade to);
/* Places level `to`, in levels->q, so that the samples lie where levels->before has them, as if nothing held it. A
 * frame stays where it is at time 0. */
void spore_lod_place(const SporeLod *levels, SporeLodGrade to);
/* Largest distance between the positions of the samples before and after the change, of those that lie in the body, m.
 */
double spore_lod_error(const SporeLod *levels, SporeLodGrade to);

/* estimate.c */
/* Measures what each coarser level gets wrong of a bend, for bodies that change by error. The samples were made. */
void spore_lod_measure_levels(SporeLod *levels);
/* Estimated error of a level where the body is bent as it is now, m: of where its points are, beside the finest level
 * under the same loads. */
double spore_lod_estimate(const SporeLod *levels, SporeLodGrade level, double bent);
/* How far the point of the body that is bent furthest lies from where the body's rest shape has it, turned and moved as
 * well as may be, m. */
double spore_lod_bent(const SporeWorld *world, const SporeBody *body);

/* lod.c */
/* Takes the models of the levels from the description, and checks them. */
bool spore_lod_make(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error);
/* Makes what the levels that are not active need, after everything else of the world was made. */
bool spore_world_create_lod(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_lod_free(SporeBody *body);
/* Gives the models back to the caller. */
void spore_lod_give_up(SporeBody *body);
/* Makes the level the active one, and its state at time 0 that of the body (rest_q, rest_v). */
void spore_world_select_lod(SporeWorld *world, uint32_t body, SporeLodGrade level);
/* Back to the levels of time 0. */
void spore_world_reset_lod(SporeWorld *world);

/* change.c */
/* Changes to another level at the start of a step, unless the fit moves a point by more than the tolerance. False: the
 * body stays as it is, and `reason` tells why, translated. cause, figure: for the log. */
bool spore_world_try_lod(SporeWorld *world, uint32_t body, SporeLodGrade level, SporeLodCause cause, double figure,
                         char *reason, size_t size);
/* The same by hand; the monitor tells the reason. */
void spore_world_change_lod(SporeWorld *world, uint32_t body, SporeLodGrade level);

/* automatic.c */
/* Takes the rules and the eyes from the description. */
bool spore_lod_create_automation(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Whether some body changes its level by itself. */
bool spore_lod_is_automatic(const SporeWorld *world);
size_t spore_lod_automatic_count(const SporeWorld *world);
/* Stage: bodies change their levels by their rules. */
void spore_world_adapt_levels(SporeWorld *world);

#endif
