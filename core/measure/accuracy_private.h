/* What the files of the accuracy study share. */
#ifndef SPORE_MEASURE_ACCURACY_PRIVATE_H
#define SPORE_MEASURE_ACCURACY_PRIVATE_H

#include "core/measure/accuracy.h"

/* A study while it runs. */
typedef struct SporeStudy {
  SporeAccuracyScene scene;
  SporeAccuracyOptions options;
  SporeAccuracyReport *report;
  SporeTrialPoints points;
  SporeTrial *trials;    /* one a point of the report */
  double *costs;         /* points x repeats: s on the processor for a simulated s */
  SporeTrial reference;  /* the run that errors are measured from */
  SporeTrial *perturbed; /* perturbed_count */
  size_t perturbed_count;
  double **q, **v;       /* of each body at the start; NULL: the stretch begins at time 0 */
  SporeLodGrade *levels; /* which these are of */
  size_t body_count, samples;
  size_t steps;       /* of each method */
  double most_s;      /* on the processor, so that what else it does changes nothing */
  double started_s;   /* by spore_processor_s */
  double until_s;     /* a single run ends there; 0: never */
  double done;        /* for progress, 0..1 */
  SporeError refusal; /* the last reason why the scene did not run by a method */
  SporeError *error;
} SporeStudy;

/* accuracy_notes.c: what all parts of the study ask. */
/* Seconds that the thread has had on the processor: what the program does beside the study does not count. */
double spore_processor_s(void);
/* The same since the study began. */
double spore_study_elapsed_s(const SporeStudy *study);
/* Adds a translated sentence to what was cut. */
void spore_study_cut(SporeStudy *study, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Order of a method where forces are smooth. */
double spore_study_nominal_order(SporeIntegratorKind kind);
/* The finest of the levels that were asked for, which the reference is of; -1: none were, so the scene's. */
int spore_study_finest_level(const SporeAccuracyReport *report);

/* How a run differs from a plain one. */
typedef struct SporeStudyRun {
  double perturbation;
  uint32_t seed;
  bool timed_only;
  double most_s; /* on the processor; 0: any */
} SporeStudyRun;
typedef enum SporeStudyOutcome {
  SPORE_STUDY_RAN,
  SPORE_STUDY_REFUSED,  /* the scene cannot run so; `why` says the reason */
  SPORE_STUDY_TOO_LONG, /* it took longer than most_s */
  SPORE_STUDY_ENDED     /* cancelled, or no memory: the study's error says so */
} SporeStudyOutcome;
/* Makes a world, puts it where the stretch begins, and runs it over the stretch. trial: spore_trial_clear. */
SporeStudyOutcome spore_study_run(SporeStudy *study, const SporeAccuracyWorld *world, const SporeStudyRun *run,
                                  SporeTrial *trial, SporeError *why);

/* accuracy_window.c: finds where something happens in the input, and the state there. False: study->error. */
bool spore_study_find_window(SporeStudy *study);
void spore_study_forget_state(SporeStudy *study);
/* Puts a world at the start of the stretch, which may be the state of another level: the first step changes it. */
void spore_study_start(const SporeStudy *study, SporeWorld *world);
/* Whether the first step did so. False: *why tells. */
bool spore_study_started(const SporeStudy *study, const SporeWorld *world, SporeError *why);

/* accuracy_reference.c: runs the reference, the second method and the perturbed runs. False: study->error. */
bool spore_study_refer(SporeStudy *study);
/* Means over the stretch: how far the mean places of the bodies in two trials are apart, by the bodies' lengths. */
double spore_study_mean_difference(const SporeStudy *study, const SporeTrial *a, const SporeTrial *b);

/* Runs a method as exactly as the reference is run. spheres: a factor, 0: the scene's; seed 0: not perturbed. */
bool spore_study_run_exactly(SporeStudy *study, size_t method, const SporeAccuracyWorld *as, uint32_t seed,
                             SporeTrial *trial);
/* How far two trials are apart: positions, or where the scene is chaotic their means. */
double spore_study_difference(const SporeStudy *study, const SporeTrial *a, const SporeTrial *b);

/* accuracy_spheres.c: what each set of spheres gives away, after the reference. False: study->error. */
bool spore_study_compare_spheres(SporeStudy *study);

/* accuracy_judge.c */
/* What a trial says of a point. costs: of its timed runs, sorted by it. */
void spore_study_judge_point(const SporeStudy *study, SporeAccuracyPoint *point, const SporeTrial *trial,
                             double *costs);
/* Errors of all points, orders, the Pareto set and the sentence. False: no memory. */
bool spore_study_judge(SporeStudy *study);

#endif
