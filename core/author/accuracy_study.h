/* An accuracy study of a document (core/measure/accuracy.h), and what is done with it: a point of the study becomes the
 * scene's own method, and the scene remembers what was measured of it. */
#ifndef SPORE_AUTHOR_ACCURACY_STUDY_H
#define SPORE_AUTHOR_ACCURACY_STUDY_H

#include "core/measure/accuracy.h"
#include "core/scene/compile.h"

typedef struct SporeAccuracyStudy {
  SporeAccuracyReport *report;
  char *body;            /* whose method and level were varied; NULL: of all that physics moves */
  int nonlinear, linear; /* the scene's own, which points have that name none */
  gint64 time;           /* when it ended, Unix time, s */
  guint64 *hashes;       /* of each point: spore_document_run_hash of the scene as the point sets it */
} SporeAccuracyStudy;

/* Studies the document; options->body is NULL or a passive body's name. The other arguments are those of
 * spore_accuracy_source_new. NULL with a GError: the scene cannot run, no reference converges, or cancelled. */
SporeAccuracyStudy *spore_accuracy_study_new(SporeDocument *document, const SporeSimulation *simulation,
                                             SporePool *pool, const SporeTrack *input,
                                             const SporeAccuracyOptions *options, GError **error);
void spore_accuracy_study_free(SporeAccuracyStudy *study);

/* Whether the points are of this document still: what they do not set is as it was. */
gboolean spore_accuracy_study_holds(const SporeAccuracyStudy *study, const SporeDocument *document);
/* Index of the point whose settings the document of that run hash has; -1: none was measured. */
gssize spore_accuracy_study_find(const SporeAccuracyStudy *study, guint64 run_hash);

/* Gives the scene method, step, solvers and level of a point, as one undo step, and remembers in meta/measured what was
 * measured of them. FALSE with a GError: the point is not stable, the scene has no such body any more. */
gboolean spore_accuracy_study_apply(const SporeAccuracyStudy *study, gsize point, SporeDocument *document,
                                    GError **error);

/* What is to be remembered of a run that was measured. */
typedef struct SporeMeasurement {
  const char *method; /* and solvers, as in the file */
  double dt_s;
  const char *level, *body;          /* NULL: the scene's; all that physics moves */
  double error, floor, step_s;       /* by a body's length; step_s: what a step of dt_s took */
  const SporeAccuracyReport *report; /* that it was judged in */
  gint64 time;                       /* Unix time, s */
} SporeMeasurement;
/* Remembers in meta/measured what was measured of the document as it is now, instead of what it remembers. Call it
 * inside a group. FALSE with a GError. */
gboolean spore_measured_remember(SporeDocument *document, const SporeMeasurement *measurement, GError **error);

/* What the scene remembers of a study. */
typedef enum SporeMeasured {
  SPORE_MEASURED_NOT,
  SPORE_MEASURED_FRESH,
  SPORE_MEASURED_STALE /* what a run of the scene depends on has changed since */
} SporeMeasured;
/* run_hash: of the document as it is. */
SporeMeasured spore_measured_state(const SporeDocument *document, guint64 run_hash);

/* In words, translated; g_free. */
/* "1.2 % off, 0.11 ms a step", of a point of a report. */
char *spore_accuracy_point_figures(const SporeAccuracyReport *report, const SporeAccuracyPoint *point);
/* "implicit_euler at 4 ms", with the level where it is one. */
char *spore_accuracy_point_name(const SporeAccuracyReport *report, const SporeAccuracyPoint *point);
/* What the scene remembers: "1.2 % off, 0.11 ms a step". NULL: nothing. */
char *spore_measured_figures(const SporeDocument *document);
/* The same with what they are of: "measured: 1.2 % off, 0.11 ms a step (implicit_euler at 4 ms)". NULL: nothing. */
char *spore_measured_text(const SporeDocument *document);
/* Which study, when, against what, a line each. NULL: nothing. */
char *spore_measured_source(const SporeDocument *document);

#endif
