/* A trial: one run of a world, and what it gave. Trials of one scene by different methods, steps and levels follow the
 * same material points and look at them at the same times, so that their results can be compared. */
#ifndef SPORE_MEASURE_TRIAL_H
#define SPORE_MEASURE_TRIAL_H

#include "core/base/cancel.h"
#include "core/base/progress.h"
#include "core/exercise/exercise.h"
#include "core/sim/world.h"

/* What happened in a run, besides motion: counts at its end, of all instruments and bodies. */
typedef struct SporeTrialEvents {
  uint64_t broken, torn, lost;      /* links; springs of nets; holds of jaws */
  uint64_t cut;                     /* ties */
  uint64_t pierced, stitches, held; /* surfaces; stitches and spheres held now */
  uint64_t coagulated, taken;       /* amounts: ties and elements, summed over the steps; particles */
} SporeTrialEvents;

/* Adds to each count of `spread` what it lacks of the distance between a and b. */
void spore_trial_events_spread(SporeTrialEvents *spread, const SporeTrialEvents *a, const SporeTrialEvents *b);
/* Whether no count of a and b is further apart than `spread` says, and of amounts there are in both or in neither. */
bool spore_trial_events_alike(const SporeTrialEvents *a, const SporeTrialEvents *b, const SporeTrialEvents *spread);

#define SPORE_TRIAL_POINTS 64 /* of a body at most */

/* Points of a body that trials follow. */
typedef struct SporeTrialBody {
  uint32_t body; /* in the world */
  size_t count;  /* of its points */
  double *rest;  /* count x 3, body's frame at rest, m; of particles: NULL */
  size_t stride; /* of particles: point i is particle i * stride */
  double length; /* characteristic, m: diagonal of the box around its points at rest */
  bool changes;  /* particles come into the world or leave it: which of them is where means nothing then, and trials are
                    compared by their number, their mean place and how far they are spread */
} SporeTrialBody;

/* Points of the bodies of a scene that trials follow. */
typedef struct SporeTrialPoints {
  size_t body_count, count; /* count: of points of all bodies */
  SporeTrialBody *bodies;
} SporeTrialPoints;

/* Chooses points of the passive bodies of a world at time 0, each as far as it can be from those before: nodes, samples
 * of models whose nodes are no material points, six points around the centre of a rigid body. body: of this one alone;
 * SPORE_NO_BODY: of all. To be freed by spore_trial_points_clear. False: no memory, or nothing is passive. */
bool spore_trial_points_choose(SporeTrialPoints *points, const SporeWorld *world, uint32_t body, SporeError *error);
void spore_trial_points_clear(SporeTrialPoints *points);

/* The largest step of at most `most_s` of which a sampling interval is a whole number. */
double spore_trial_step(double interval_s, double most_s);

/* How a trial is run. */
typedef struct SporeTrialSettings {
  double interval_s;       /* between two looks at the points; a multiple of the world's step: spore_trial_step */
  size_t samples;          /* looks, the one at time 0 not counted */
  double dt_s;             /* the world's step */
  double perturbation;     /* by which each coordinate of the start is moved at most, as a part of the body's length */
  uint32_t seed;           /* of the perturbation */
  bool timed_only;         /* positions, energy and momentum are not looked at */
  SporeExercise *exercise; /* of the world, which begins anew and looks at each step; NULL: none */
  const SporeProgress *progress; /* told at each look; NULL: none */
  const SporeCancel *cancel;     /* asked at each look, beside what the world asks by itself */
} SporeTrialSettings;

/* What a trial gave; memory of its own. Sample k is k intervals after the start, sample 0 the start. */
typedef struct SporeTrial {
  size_t samples, points;       /* samples: looks that were made, with the one at the start; points: as followed */
  double *positions;            /* samples x points x 3, m, world; not numbers: a particle out of the world */
  double *energy;               /* samples: total, J */
  double *kinetic;              /* samples, J */
  double *momentum;             /* samples x 3: of all passive bodies, N s */
  double *centre;               /* samples x bodies followed x 3: mean position of the points of each, m; of particles
                                   that change: of all that are in the world */
  double *spread;               /* samples x bodies followed: root mean square distance of these from there, m */
  double *present;              /* samples x bodies followed: number of these */
  size_t world_bodies, spheres; /* of the world */
  double *device_force;  /* samples x world_bodies x 3: force on each body that a device moves, N; 0 of the others */
  double *contact_force; /* samples x world_bodies x 3: of contacts alone, on each body, N */
  double *contact_depth; /* samples: of the deepest contact, m */
  size_t steps;
  double dt_s, simulated_s;
  double cpu_s;                                       /* of the steps, and of the exercise after each, on the thread's
                                                         own clock; looks at the points are not in it */
  double median_us, p99_us;                           /* of a step, by the clock, of the last steps */
  double force_evaluations, newton, linear, contacts; /* sums over the steps */
  double penetration; /* deepest overlap of two spheres by the smaller radius; looked at with the positions */
  double gap,
      line_stretch;    /* largest of links, m, and of lines, relative: core/measure/stretch.h; looked at likewise */
  double residual;     /* worst, relative */
  uint64_t recoveries; /* steps taken again */
  SporeTrialEvents events;
  SporeExerciseState exercise; /* at the end; all 0 without one */
  bool *steps_done;            /* of the exercise: exercise.steps */
  size_t unsolved;             /* entries of the register of steps that were not solved as the scene is written */
  bool finite;                 /* all that was looked at is a number */
  bool stable;    /* finite, and the monitor met no energy out of nothing, no speed without bound, no body that
                     it had to freeze or to move by a safer method */
  bool cancelled; /* it ended early */
} SporeTrial;

/* Runs a world that is at time 0. The result is to be freed by spore_trial_clear. False: no memory, or a body of the
 * world cannot carry the points. A trial that was cancelled, or that went wrong, is a result. */
bool spore_trial_run(SporeTrial *trial, SporeWorld *world, const SporeTrialPoints *points,
                     const SporeTrialSettings *settings, SporeError *error);
void spore_trial_clear(SporeTrial *trial);

/* How far two trials are apart: distances of points by the length of their body. */
typedef struct SporeTrialDifference {
  double rms;   /* root of the mean square over points, bodies and samples: each body has the same weight */
  double final; /* the same over the last sample alone */
  double worst; /* of any point at any sample */
} SporeTrialDifference;
/* Both trials followed the same points at the same times. Infinite where one of them has fewer samples, or something
 * that is not finite. Of a body whose particles change, the square of a distance is the sum of those of the mean places
 * and of the spreads, and of the share of particles that only one trial has, in lengths of the body. */
SporeTrialDifference spore_trial_difference(const SporeTrialPoints *points, const SporeTrial *a, const SporeTrial *b);
/* That square for a body whose particles change, at one sample. row_a, row_b: of the body and sample, in `present`. */
double spore_trial_cloud_square(const SporeTrial *a, size_t row_a, const SporeTrial *b, size_t row_b, double length);

#endif
