/* What the files of the room share. */
#ifndef SPORE_EXERCISE_PRIVATE_H
#define SPORE_EXERCISE_PRIVATE_H

#include "core/exercise/exercise.h"

/* A step while the exercise runs. */
typedef struct SporeStepRun {
  SporeExerciseStep from; /* its texts are owned */
  SporeStepPhase phase;
  double done_s, since_s;       /* since_s: since when the event is there without a break; negative: it is not */
  uint64_t early, lost, amount; /* lost: how often it came undone; amount: of what tools did since the step opened */
  uint64_t counted;             /* SporeExercise.looks when amount last grew */
  uint64_t able;                /* the instruments that can do it, a bit each */
  bool skipped;                 /* it counts as done in a try-out, and need not last */
  bool was;                     /* the event was there after the step before */
  bool known;                   /* passed_through: `last` is */
  uint32_t holder;              /* lifted: the instrument that took hold first; SPORE_NO_PART: none holds */
  SporeVec3 last;               /* passed_through: where the point was; lifted: where the hold began */
} SporeStepRun;

/* An instrument as a metric follows it. */
typedef struct SporeTrace {
  SporeVec3 at[4];   /* where it was: now, and one to three looks ago */
  SporeVec3 stopped; /* economy: where it was when a step was last done */
  unsigned seen;     /* entries of `at` */
  bool on;           /* it moves, or holds */
  uint32_t held;     /* drops: the body that it holds, where it does */
  double path;       /* m */
  double sum, time;  /* of what the metric adds up; s */
  uint64_t touching; /* instruments that it touches, a bit each */
} SporeTrace;

typedef struct SporeMetricRun {
  SporeExerciseMetric from; /* its texts are owned */
  double good, pass;        /* in the kind's own unit; NAN: not given */
  double sum, time, peak;
  uint64_t count, start; /* start: particles at the beginning */
  SporeTrace *traces;    /* one an instrument; NULL: the kind follows none */
} SporeMetricRun;

/* What tools had done when the exercise last looked. */
typedef struct SporeToolBefore {
  size_t taken, cut, pierced;
} SporeToolBefore;

struct SporeExercise {
  SporeExerciseFields fields; /* task is owned */
  SporeVec3 up;               /* of length 1, or 0 */
  size_t instrument_count, view_count, step_count, metric_count, body_count;
  SporeInstrument *instruments; /* names are not kept */
  SporeView *views;             /* place and target in the frame of its body */
  SporeStepRun *steps;
  SporeMetricRun *metrics;
  uint32_t *instrument_of; /* a body: the instrument that it is part of, or SPORE_NO_PART */
  SporeToolBefore *before; /* an instrument */
  SporeBodyMarks *marks;   /* a body: when the exercise last looked */
  uint64_t looks;
  size_t steps_done;
  SporeExercisePhase phase;
  bool paused, tried, step_was_done; /* the last: in the last look */
  double time_s, world_s;            /* its clock; the world's when it last looked */
};

/* What was begun before its turn, and what came undone. */
static inline uint64_t spore_exercise_errors(const SporeExercise *exercise) {
  uint64_t count = 0;
  for (size_t i = 0; i < exercise->step_count; i++) count += exercise->steps[i].early + exercise->steps[i].lost;
  return count;
}

/* Particles of a fluid that have come out by now, or were there: in the world, sucked away, or seeped as an effect. */
static inline uint64_t spore_particles_out(const SporeWorld *world, uint32_t body) {
  SporeBodyMarks marks = spore_world_body_marks(world, body);
  return spore_world_particle_count(world, body) + marks.sucked + marks.seeped;
}

/* places.c */
/* The point of an instrument, m: the tip of its tool, or the origin of the body of what only touches. */
SporeVec3 spore_instrument_point(const SporeExercise *exercise, const SporeWorld *world, uint32_t instrument);
/* The mean of the body's nodes that are in the world, or the origin of its frame, m. */
SporeVec3 spore_body_middle(const SporeWorld *world, uint32_t body);
/* Share of the body's nodes that lie within the container: within the hull of 26 sides around its nodes, or around its
 * spheres where it has no nodes. */
double spore_share_within(const SporeWorld *world, uint32_t body, uint32_t container);
/* Whether the camera sees a point. */
bool spore_view_sees(const SporeView *view, const SporeWorld *world, SporeVec3 point);
/* Whether the instrument is one that the part is about: `wanted`, or any where that is SPORE_NO_PART. */
static inline bool spore_is_meant(uint32_t wanted, uint32_t instrument) {
  return wanted == SPORE_NO_PART || wanted == instrument;
}

#endif
