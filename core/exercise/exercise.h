/* Exercises: what a trainee has to do in a running world, how well that is done, and the score.
 *
 * An exercise is a list of steps and of metrics. A step is done when its event happens: something is touched, grasped,
 * cut. A metric is a figure of the run, with thresholds. An exercise watches a world from outside of its step, after
 * each step, and never changes the world: a run that is watched has the same bits as one that is not. All figures
 * follow from the states of the world, so that the same scene and input give the same score to the bit.
 *
 * Indices are below the counts of the description, or SPORE_NO_PART. Units are SI unless a metric says otherwise. */
#ifndef SPORE_EXERCISE_EXERCISE_H
#define SPORE_EXERCISE_EXERCISE_H

#include "core/exercise/event.h"
#include "core/exercise/metric.h"

#define SPORE_NO_PART UINT32_MAX  /* in place of an index: none */
#define SPORE_INSTRUMENTS_MOST 64 /* of an exercise */

typedef struct SporeExercise SporeExercise;

/* When steps open. */
typedef enum SporeExerciseOrder {
  SPORE_ORDER_FREE, /* at once, or after the step that they name */
  SPORE_ORDER_GIVEN /* one after the other, as they are listed */
} SporeExerciseOrder;

/* Parameters of an exercise. */
typedef struct SporeExerciseFields {
  const char *task;  /* what the trainee is told; NULL: nothing */
  double time_limit; /* s; 0: none */
  int order;         /* SporeExerciseOrder */
} SporeExerciseFields;
/* The parameters of SporeExerciseFields. */
extern const SporeParameterTable spore_exercise_parameters;

/* An instrument: the bodies that one hand moves. */
typedef struct SporeInstrument {
  const char *name;
  uint32_t bodies[SPORE_TOOL_BODIES]; /* the first is moved by the device; SPORE_NO_BODY: none */
  uint32_t tool;                      /* index of the world's tool; SPORE_NO_PART: it only touches */
} SporeInstrument;

/* What a camera sees: all that is less than half of field_of_view away from the line to its target. */
typedef struct SporeView {
  SporeVec3 position, target; /* world at time 0, m */
  double field_of_view;       /* rad */
  uint32_t body;              /* that the camera moves with, where it is stiff; SPORE_NO_BODY: none */
} SporeView;

/* A step of an exercise that is to be made. */
typedef struct SporeExerciseStep {
  const SporeEventKind *kind;
  SporeEventFields fields;
  uint32_t instrument;      /* SPORE_NO_PART: any */
  uint32_t body, container; /* SPORE_NO_BODY: none */
  uint32_t after;           /* the step that must be done first; SPORE_NO_PART: none */
} SporeExerciseStep;

/* A metric of an exercise that is to be made. */
typedef struct SporeExerciseMetric {
  const SporeMetricKind *kind;
  SporeMetricFields fields;
  uint32_t instrument; /* SPORE_NO_PART: all */
  uint32_t body;       /* SPORE_NO_BODY: none */
  uint32_t view;       /* SPORE_NO_PART: none */
} SporeExerciseMetric;

/* All that an exercise is made from. The arrays and texts are borrowed during spore_exercise_create. */
typedef struct SporeExerciseDescription {
  SporeExerciseFields fields;
  SporeVec3 up; /* against gravity; any length, 0: there is no up */
  size_t instrument_count, view_count, step_count, metric_count;
  const SporeInstrument *instruments;
  const SporeView *views;
  const SporeExerciseStep *steps;
  const SporeExerciseMetric *metrics;
} SporeExerciseDescription;

/* An exercise that begins now, with the present state of the world; to be freed by spore_exercise_free. NULL with the
 * error: no memory, too many instruments, a threshold that is none, or steps that wait for each other. The error's
 * place is "exercise/NAME". */
SporeExercise *spore_exercise_create(const SporeExerciseDescription *description, const SporeWorld *world,
                                     SporeError *error);
void spore_exercise_free(SporeExercise *exercise); /* NULL is allowed */
/* Looks at what the last step of the world did; to be called after each step. Takes no memory. */
void spore_exercise_watch(SporeExercise *exercise, const SporeWorld *world);
/* Begins anew with the present state of the world: after spore_world_reset, say. */
void spore_exercise_restart(SporeExercise *exercise, const SporeWorld *world);
/* While it is paused nothing counts, and its clock stands still. */
void spore_exercise_pause(SporeExercise *exercise, bool paused);
/* From now on it is a try-out, until it begins anew: the world is not what an attempt would find. */
void spore_exercise_try_out(SporeExercise *exercise);
/* Begins a try-out: what the step waits for counts as done from now on, so that the step is open. The world stays as it
 * is. Nothing happens where the step is open or done, or where the exercise has ended. */
void spore_exercise_skip_to(SporeExercise *exercise, size_t step);

/* Where an exercise is. */
typedef enum SporeExercisePhase {
  SPORE_EXERCISE_RUNNING,
  SPORE_EXERCISE_DONE,        /* every step is done; nothing counts any more */
  SPORE_EXERCISE_OUT_OF_TIME, /* the time limit came first; the same */
  SPORE_EXERCISE_PHASES
} SporeExercisePhase;
extern const char *const spore_exercise_phase_names[SPORE_EXERCISE_PHASES]; /* "running", ... */

/* Where a step is. */
typedef enum SporeStepPhase { SPORE_STEP_WAITING, SPORE_STEP_OPEN, SPORE_STEP_DONE, SPORE_STEP_PHASES } SporeStepPhase;
extern const char *const spore_step_phase_names[SPORE_STEP_PHASES]; /* "waiting", ... */

/* How good a metric is. */
typedef enum SporeMetricVerdict {
  SPORE_METRIC_NONE, /* it has no threshold */
  SPORE_METRIC_GOOD,
  SPORE_METRIC_PASS,
  SPORE_METRIC_FAIL,
  SPORE_METRIC_UNFINISHED, /* less is better, and it grows until all steps are done: it is not worse than pass so far */
  SPORE_METRIC_VERDICTS
} SporeMetricVerdict;
extern const char *const spore_metric_verdict_names[SPORE_METRIC_VERDICTS]; /* "none", ... */

/* A step so far. Texts are owned by the exercise. */
typedef struct SporeStepState {
  const char *name, *hint; /* hint: NULL: none */
  const SporeEventKind *kind;
  SporeStepPhase phase;
  double done_s;  /* on the exercise's clock; NAN: not done */
  uint64_t early; /* how often its event began while the step waited */
  uint64_t lost;  /* how often its event ended though it had to last */
} SporeStepState;

/* A metric so far. */
typedef struct SporeMetricState {
  const char *name, *source; /* source of the thresholds; NULL: none */
  const SporeMetricKind *kind;
  const char *unit;         /* of value, good and pass */
  double value, good, pass; /* NAN: not measured; not given */
  /* 1 at `good` and better, .5 at `pass`, a straight line between, and the same line on to 0. With one threshold: 1 or
   * 0. 0 until all steps are done, where less is better: who did nothing took no time. NAN: there is no threshold. */
  double mark;
  SporeMetricVerdict verdict;
} SporeMetricState;

/* The whole so far. */
typedef struct SporeExerciseState {
  SporeExercisePhase phase;
  bool paused;
  bool tried;    /* a try-out: spore_exercise_try_out, spore_exercise_skip_to */
  double time_s; /* on the exercise's clock */
  size_t steps, steps_done, metrics;
  uint64_t errors; /* of order: early and lost of all steps together */
  double score;    /* 0 to 100: the share of the steps that are done, times the mean of the marks by weight */
  bool passed;     /* all steps are done, and no metric failed */
} SporeExerciseState;

SporeExercisePhase spore_exercise_phase(const SporeExercise *exercise);
SporeExerciseState spore_exercise_state(const SporeExercise *exercise);
SporeStepState spore_exercise_step_state(const SporeExercise *exercise, size_t step);
SporeMetricState spore_exercise_metric_state(const SporeExercise *exercise, size_t metric);

#endif
