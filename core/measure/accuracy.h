/* Error against run time: one scene by several methods, steps and levels, against a reference that tells its own error.
 *
 * Every point of the study is a run of the same stretch of input. Its error is how far points of the bodies are from
 * where the reference has them (core/measure/trial.h), its cost the time on the processor. The reference is the method
 * that gets nearest in the time that there is, at three steps h, h/2 and h/4: how these differ tells its own error
 * (Richardson), and a second method has to come to the same. A run whose start is moved by 1e-8 tells how far any two
 * runs of the scene may drift apart: where that is more than 1e-3, positions cannot be compared, and means over the
 * stretch are, with their spread over 8 such runs. */
#ifndef SPORE_MEASURE_ACCURACY_H
#define SPORE_MEASURE_ACCURACY_H

#include "core/base/progress.h"
#include "core/measure/plot.h"
#include "core/measure/trial.h"

/* How the bodies are moved and solved. */
typedef struct SporeAccuracyMethod {
  SporeIntegratorKind integrator;
  int nonlinear, linear; /* SporeNonlinearKind, SporeLinearKind; -1: as the scene says */
} SporeAccuracyMethod;
#define SPORE_ACCURACY_LABEL 80 /* room for a method's label */
/* "implicit_euler/broyden/cholesky"; what is as the scene says is left out. */
void spore_accuracy_label(const SporeAccuracyMethod *method, char label[SPORE_ACCURACY_LABEL]);

/* A world to be made. */
typedef struct SporeAccuracyWorld {
  const SporeAccuracyMethod *method; /* NULL: the scene's own */
  int level;                         /* SporeLodGrade; -1: the scene's */
  double spheres;                    /* times as many as the scene has; 0: the scene's own */
  double dt_s;                       /* 0: the scene's */
  double tolerance;                  /* of implicit steps; 0: the scene's */
  double start_s;                    /* the input begins there */
  bool awake;                        /* no body sleeps */
  const void *choice;                /* what else differs, as whoever makes the worlds understands it; NULL: nothing */
} SporeAccuracyWorld;

/* Makes the worlds of a scene. */
typedef struct SporeAccuracyScene {
  void *data;
  /* NULL with *error: the scene cannot run so. The world asks for cancelling by itself. */
  SporeWorld *(*make)(void *data, const SporeAccuracyWorld *world, SporeError *error);
  void (*drop)(void *data, SporeWorld *world);
  bool starts_late;        /* input may begin later than at time 0 */
  SporeAccuracyMethod own; /* the scene's method, of the bodies in question */
  double dt_s;             /* its step */
} SporeAccuracyScene;

/* What is to be studied; all zero chooses everything. */
typedef struct SporeAccuracyOptions {
  const char *body; /* whose error is measured; NULL: of all passive bodies */
  const SporeAccuracyMethod *methods;
  size_t method_count; /* 0: chosen by what the bodies allow */
  const int *levels;
  size_t level_count;    /* 0: the scene's */
  const double *spheres; /* factors on the numbers of spheres, ascending, two at least */
  size_t sphere_count;   /* 0: the scene's spheres alone */
  double dt_low_s, dt_high_s;
  size_t dt_count; /* 0: chosen for each method */
  size_t dt_most;  /* of those that are chosen; 0: 5, or up to 8 where there is time */
  double time_s;   /* simulated, of the stretch; 0: 1 s */
  double most_s;   /* on the processor; 0: 36 s */
  size_t repeats;  /* timed runs of each point; 0: 5 */
  bool full;       /* nothing is cut to fit the time */
  const SporeCancel *cancel;
  const SporeProgress *progress;
} SporeAccuracyOptions;

/* A method at a step and a level. */
typedef struct SporeAccuracyPoint {
  size_t method; /* index */
  int level;     /* -1: the scene's */
  double dt_s;
  double error;                     /* see SporeAccuracyReport.statistics; infinite: it cannot be told */
  double final, worst;              /* of the trajectory at the end, and of any point */
  double energy_drift;              /* largest, as a part of the energy at work in the reference */
  double penetration;               /* deepest, by the smaller radius */
  double gap, line_stretch;         /* of links, m, and of lines, relative; not a number: there are none */
  double us_per_step, p99_us, cost; /* cost: s on the processor for a simulated s; medians of the repeats */
  double real_time_factor;
  double force_evaluations, newton, linear; /* a step */
  size_t repeats;                           /* timed runs */
  SporeTrialEvents events;
  bool stable;
  bool as_written; /* every step was solved as the scene is written */
  bool sound;      /* stable, as written, and its energy is off by no more than all that is at work */
  bool resolved;   /* the error is above what the reference and the scene can tell */
  bool pareto;     /* sound and resolved, and no other such point has both a smaller error and a smaller cost */
} SporeAccuracyPoint;

/* A method over all its steps. */
typedef struct SporeAccuracyFit {
  SporeAccuracyMethod method;
  char label[SPORE_ACCURACY_LABEL];
  double order;        /* slope of the error over the step; not a number: fewer than three points tell it */
  double order_spread; /* of the slope */
  double nominal;      /* order where forces are smooth */
  size_t alike;   /* index of the first method that moves the bodies alike at the same steps; its own: none before */
  bool converges; /* false: at these steps smaller ones do not help, while another method is much nearer */
} SporeAccuracyFit;

typedef struct SporeAccuracyReference {
  size_t method; /* index */
  double dt_s, own_error;
  double order;                                        /* observed */
  size_t cross_method;                                 /* the second method; SIZE_MAX: there was none */
  double cross_dt_s, cross_difference, cross_expected; /* expected: its own error by its steps */
  double gap, line_stretch;                            /* as those of a point */
  bool agreed; /* the second method came to the same, within what both say of their errors */
} SporeAccuracyReference;

typedef struct SporeAccuracyLevel {
  int level;
  double error; /* spatial: of the reference method at this level against the reference */
} SporeAccuracyLevel;

/* What a set of spheres gives away against the finest one, by the reference's method: apart from what steps do. */
typedef struct SporeAccuracySpheres {
  double factor; /* times as many as the scene has */
  size_t count;  /* of the whole world */
  /* Of the forces of contacts on each body, and of the depth of the deepest contact, as parts of their root mean square
   * with the finest set; not a number: nothing touches there. Of places, as the error of a point. Where the scene is
   * chaotic, of means. */
  double force, depth, error;
} SporeAccuracySpheres;

typedef struct SporeAccuracyReport {
  size_t method_count, point_count, level_count, cut_count;
  SporeAccuracyFit *methods;
  SporeAccuracyPoint *points;    /* by levels, methods and falling steps */
  SporeAccuracyLevel *levels;    /* where several were asked for */
  SporeAccuracySpheres *spheres; /* by factors, where several were asked for; the finest against itself at half the
                                    step: what is nearer cannot be told apart */
  size_t sphere_count;
  char **cuts; /* translated: what was cut to fit the time, or could not be had */
  double start_s, time_s, interval_s;
  double contacts; /* mean a step, in the reference */
  SporeAccuracyReference reference;
  double growth;            /* how far a run drifted whose start was moved by 1e-8 of a body's length */
  bool chaotic;             /* growth is above 1e-3 */
  bool statistics;          /* errors are of means over the stretch, not of positions */
  double spread;            /* of these means over the perturbed runs */
  double floor;             /* errors below it are not told apart from the reference's */
  char *sentence;           /* translated: what it comes to */
  struct SporeStudy *study; /* the reference and what it was run over, for spore_accuracy_measure_more */
} SporeAccuracyReport;

/* Runs it all. NULL with *error: the scene cannot run, no reference converges, no memory, or cancelled. */
SporeAccuracyReport *spore_accuracy_study(const SporeAccuracyScene *scene, const SporeAccuracyOptions *options,
                                          SporeError *error);
void spore_accuracy_report_free(SporeAccuracyReport *report);
/* Seconds that the program has had on the processor. */
double spore_processor_s(void);
/* Runs one more world over the stretch of a report and judges it against the reference: *point, without a method. Its
 * start_s is the stretch's. What the scene, its options' cancel and progress point to, must still be there. timed_only:
 * only the cost, which is then of this run. A scene that cannot run so, or takes too long, gives a point that is not
 * stable, of infinite error and cost. False with *error: cancelled, or no memory. */
bool spore_accuracy_measure_more(SporeAccuracyReport *report, const SporeAccuracyWorld *world, bool timed_only,
                                 SporeAccuracyPoint *point, SporeError *error);
/* The work-precision plot: error over step, and error over cost, a line a method and level. Points whose error is not a
 * number stand above all others; empty points are not sound, ringed ones are the Pareto set. */
typedef struct SporeAccuracyPlot {
  SporePlotPanel panels[2]; /* by step (ms) and by cost (s on the processor for a simulated s); errors in percent */
  size_t *first;            /* of each line: index in the report of the line's first point; the others follow */
  struct SporeAccuracyPlotData *data;
} SporeAccuracyPlot;
/* The report stays alive longer than the plot. False with *error: no memory. */
bool spore_accuracy_plot_make(SporeAccuracyPlot *plot, const SporeAccuracyReport *report, SporeError *error);
void spore_accuracy_plot_clear(SporeAccuracyPlot *plot);
/* The same as an SVG document in UTF-8, to be freed with spore_free, legible in black and white. title: translated.
 * NULL: no memory, or no point can be shown. */
char *spore_accuracy_svg(const SporeAccuracyReport *report, const char *title, SporeError *error);

#endif
