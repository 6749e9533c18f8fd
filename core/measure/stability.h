/* Stability of a scene: what becomes of it when it is pushed, and how large the steps of its bodies may be.
 *
 * A case runs the scene with one thing changed: a larger step, stiffer bodies, a device that goes mad. The verdict says
 * what came of it, after all that the world does where a step goes wrong. A limit is the largest step of a method on
 * one body alone, without any such help (core/sim/solve/method_trial.h). The map runs the scene with steps and
 * stiffnesses side by side. */
#ifndef SPORE_MEASURE_STABILITY_H
#define SPORE_MEASURE_STABILITY_H

#include "core/base/progress.h"
#include "core/measure/step_search.h"
#include "core/sim/solve/method_trial.h"
#include "core/sim/world.h"

/* How a world differs from the scene: factors, 1 where nothing changes. */
typedef struct SporeStabilityChange {
  double time_step, stiffness, mass, contact; /* contact: stiffness of the contact law of all bodies */
  bool every_second;                          /* stiffness and mass change of every second passive body alone */
} SporeStabilityChange;

/* Makes the worlds of a scene. */
typedef struct SporeStabilityScene {
  void *data;
  double time_step_s; /* of the scene */
  /* NULL with *error: the scene cannot run so. The world asks for cancelling by itself. */
  SporeWorld *(*make)(void *data, const SporeStabilityChange *change, SporeError *error);
  void (*drop)(void *data, SporeWorld *world);
  /* Posts commands to a running world: stiffness of bodies, and of contacts, times a factor. False: no body of the
   * world takes such a change. */
  bool (*jump)(void *data, SporeWorld *world, double stiffness, double contact);
} SporeStabilityScene;

typedef struct SporeStabilityOptions {
  bool quick;    /* fewer cases; each body by its own method alone; short runs */
  bool map;      /* the map is wanted also where quick */
  double time_s; /* simulated, of each case; 0: chosen by the scene */
  double most_s; /* of the clock: what does not fit is left out */
  const SporeProgress *progress;
} SporeStabilityOptions;

typedef enum SporeStabilityVerdict {
  SPORE_STABILITY_STABLE, /* every step was solved as the scene is written, and the energy bounded */
  /* The program met trouble, said so, and went on, finite and with bounded energy; or contacts did not hold what the
   * case loads them with, the program said so, and as much stiffer as it said they do. */
  SPORE_STABILITY_RECOVERED,
  SPORE_STABILITY_REFUSED, /* the program refused to run it, with the remedy */
  SPORE_STABILITY_FAILED
} SporeStabilityVerdict;
/* "stable", "recovered", "recovered" for what was refused, "failed". Translatable. */
extern const char *const spore_stability_verdicts[];

typedef struct SporeStabilityCase {
  const char *name, *label; /* name: for programs; label: translatable */
  SporeStabilityVerdict verdict;
  char detail[640]; /* translated */
} SporeStabilityCase;

/* The largest step of a method on a body. */
typedef struct SporeStabilityLimit {
  char *body;
  SporeIntegratorKind method;
  bool own;                  /* the method is the body's in the scene */
  double step_s;             /* of the body's integrator in the scene */
  double predicted_s;        /* by the stiffest mode; infinite: none */
  SporeStepFound found;      /* by bisection */
  SporeMethodOutcome beyond; /* what came of the smallest step that was not safe */
  size_t steps;              /* of a trial */
} SporeStabilityLimit;

#define SPORE_STABILITY_COLUMNS 7
#define SPORE_STABILITY_ROWS 5
#define SPORE_STABILITY_LARGEST_STEP_S 0.1 /* that a scene may have: none above it is tried */
/* Verdicts of the scene by step and stiffness. */
typedef struct SporeStabilityMap {
  size_t columns, rows, steps; /* steps: taken in each cell; 0 columns: there is no map */
  double time_step_s[SPORE_STABILITY_COLUMNS], stiffness[SPORE_STABILITY_ROWS]; /* ascending */
  SporeStabilityVerdict cells[SPORE_STABILITY_ROWS][SPORE_STABILITY_COLUMNS];
  const SporeStabilityLimit
      *narrowest; /* of a body by its own method, where theory sets a limit; NULL: it does nowhere */
  double limit_s[SPORE_STABILITY_ROWS]; /* time step that this body bears by theory; 0: not known */
  bool known[SPORE_STABILITY_ROWS][SPORE_STABILITY_COLUMNS]; /* false: left out */
} SporeStabilityMap;

/* Things that were not tried, for one reason. */
typedef struct SporeStabilityLeftOut {
  char what[1500], why[200]; /* translated; things apart by commas */
} SporeStabilityLeftOut;

typedef struct SporeStabilityReport {
  double time_step_s; /* of the scene */
  size_t steps;       /* of a case, in steps of the scene */
  size_t contacts;    /* most at once, in the case where nothing is changed */
  bool instruments;   /* the scene has some that a device may move */
  bool met;           /* within these steps an instrument feels a force in that case */
  size_t case_count, limit_count, left_out_count;
  SporeStabilityCase *cases;
  SporeStabilityLimit *limits;
  SporeStabilityLeftOut *left_out;
  SporeStabilityMap map;
} SporeStabilityReport;

/* Runs it all. NULL with *error: the scene as it is cannot run, no memory, or cancelled. */
SporeStabilityReport *spore_stability_study(const SporeStabilityScene *scene, const SporeStabilityOptions *options,
                                            SporeError *error);
void spore_stability_report_free(SporeStabilityReport *report);
/* Number of cases with the verdict. */
size_t spore_stability_count(const SporeStabilityReport *report, SporeStabilityVerdict verdict);
/* The map as an SVG document in UTF-8, legible in black and white, to be freed with spore_free; title: translated.
 * NULL: no memory, or there is no map. */
char *spore_stability_map_svg(const SporeStabilityReport *report, const char *title, SporeError *error);

#endif
