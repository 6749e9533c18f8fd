/* An accuracy study of a scene, as data for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_ACCURACY_WORK_H
#define SPORE_UI_JOBS_ACCURACY_WORK_H

#include "core/author/accuracy_study.h"
#include "core/base/progress.h"

typedef struct SporeAccuracyWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  /* What is studied; zero chooses everything. */
  char *body;                /* NULL: all that physics moves */
  GArray *methods;           /* of SporeAccuracyMethod; empty: chosen by what the bodies allow */
  gboolean levels;           /* each level of detail that the body, or any body, has */
  gboolean spheres;          /* sets of spheres of half, the same and twice as many, generated anew */
  double time_s;             /* 0: as the study chooses */
  gboolean full;             /* nothing is cut to fit the time */
  SporeAccuracyStudy *study; /* out; taken by setting it to NULL */
} SporeAccuracyWork;

SporeAccuracyWork *spore_accuracy_work_new(const SporeDocument *document);
gboolean spore_accuracy_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_accuracy_work_free(gpointer work);
/* Whether the body, or any body where it is NULL, has more than one level of detail. */
gboolean spore_accuracy_work_has_levels(const SporeDocument *document, const char *body);

#endif
