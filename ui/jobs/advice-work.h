/* Physical or effect, as data for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_ADVICE_WORK_H
#define SPORE_UI_JOBS_ADVICE_WORK_H

#include "core/author/advice.h"

typedef struct SporeAdviceWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  SporeAdvice *advice;     /* out; taken by setting it to NULL */
} SporeAdviceWork;

SporeAdviceWork *spore_advice_work_new(const SporeDocument *document);
gboolean spore_advice_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_advice_work_free(gpointer work);

#endif
