/* Kinds of metrics of an exercise. Each kind has its own parameters; metric_kinds.c lists them. */
#ifndef SPORE_EXERCISE_METRIC_H
#define SPORE_EXERCISE_METRIC_H

#include "core/sim/world.h"

/* Parameters of every kind of metric; a kind's table has some of them. */
typedef struct SporeMetricFields {
  const char *name, *tool, *body, *camera;
  const char *good, *pass; /* a number and a unit: "249 s"; NULL: none */
  const char *source;      /* of the thresholds */
  double weight;           /* in the score */
  double speed;            /* m/s: slower is at rest */
  double force;            /* N: more is too much */
  double density;          /* kg/m^3, of a fluid */
  double strain;           /* part of the length at rest: more is too much */
} SporeMetricFields;

/* A unit in which a threshold may be given. */
typedef struct SporeMetricUnit {
  const char *name;
  double scale; /* times the number, in the metric's own unit */
} SporeMetricUnit;
#define SPORE_METRIC_UNITS 4

struct SporeExercise;
struct SporeMetricRun;
/* A kind of metric. */
typedef struct SporeMetricKind {
  const char *element;                       /* name in the file: "path_length" */
  const char *label;                         /* for people, translatable */
  const char *doc;                           /* one sentence, translatable */
  SporeParameterTable parameters;            /* of SporeMetricFields */
  SporeMetricUnit units[SPORE_METRIC_UNITS]; /* its own first; name "": a number without unit; NULL: no more */
  bool more_is_better, needs_body, needs_fluid, needs_strain, needs_view;
  bool traces; /* it follows instruments */
  /* Adds what the last step did. NULL: value says all. h: s since the last look. */
  void (*look)(const struct SporeExercise *exercise, struct SporeMetricRun *metric, const SporeWorld *world, double h);
  /* The figure so far, in its own unit; NAN: not known. */
  double (*value)(const struct SporeExercise *exercise, const struct SporeMetricRun *metric);
} SporeMetricKind;

extern const SporeMetricKind *const spore_metric_kinds[]; /* NULL at the end */
/* The kind of that element; NULL: there is none. */
const SporeMetricKind *spore_metric_kind_find(const char *element);

/* Reads a threshold, a number and a unit that the kind knows. NULL: done, *value is in the kind's own unit. Otherwise
 * what is wrong, translated, with one %s for the text and one for the unit that was expected. */
const char *spore_threshold_read(const SporeMetricKind *kind, const char *text, double *value);

#endif
