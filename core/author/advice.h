/* Physical or effect: each body that physics moves, and each tool and emitter that has a form as an effect, is replayed
 * in cheaper forms, and what the others do then is
 * compared with what they do when the step is halved or the start is a little off. Where the scene has an exercise, its
 * steps and its score are compared, too. The advice holds for the input that was replayed. */
#ifndef SPORE_AUTHOR_ADVICE_H
#define SPORE_AUTHOR_ADVICE_H

#include "core/base/progress.h"
#include "core/measure/influence.h"
#include "core/scene/compile.h"

typedef struct SporeAdviceOptions {
  double time_s;                 /* simulated, of each replay; 0: the whole of the recorded input, up to a limit */
  SporePool *pool;               /* NULL: one thread */
  const SporeTrack *input;       /* in place of the scene's; NULL: the scene's */
  const SporeCancel *cancel;     /* borrowed while it works */
  const SporeProgress *progress; /* NULL: none */
} SporeAdviceOptions;

/* A body that physics moves in the replays, or a tool or an emitter that has a form as an effect. */
typedef struct SporeAdviceElement {
  const char *section; /* "bodies", "tools", "effects" */
  char *name;
  char *held, *awaited;   /* the names of the evidence; NULL: none */
  SporeEvidence evidence; /* by the time of a replay's step */
  SporeVerdict verdict;
  gboolean has_effect; /* it was replayed as the effect that the kernel has for it */
  char *reason;        /* of the verdict, translated */
} SporeAdviceElement;

typedef struct SporeAdvice {
  gsize count;
  SporeAdviceElement *elements; /* bodies in the world's order, then tools and emitters */
  SporeEvidence floor;          /* what cannot be told from noise, and the time of a step of the scene as it is */
  SporeExerciseState exercise;  /* at the end of the replay of the scene as it is; steps 0: there is none */
  double time_s;                /* simulated, of each replay */
} SporeAdvice;

/* simulation: of the document with that input, at time 0; only looked at. NULL with a GError: nothing moves by physics,
 * the scene cannot run in one of the forms, or cancelled. */
SporeAdvice *spore_advice_find(SporeDocument *document, const SporeSimulation *simulation,
                               const SporeAdviceOptions *options, GError **error);
void spore_advice_free(SporeAdvice *advice); /* NULL is allowed */
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeAdvice, spore_advice_free)

/* What may be changed, translated; NULL: nothing, it stays physical. *saved_us: of a step; may be NULL. */
const char *spore_advice_change(const SporeAdviceElement *element, double *saved_us);
/* How many elements of the document would take their verdict: those that have an effect and may be one, and those that
 * are no longer to be one. */
guint spore_advice_count(const SporeAdvice *advice, SporeDocument *document);
/* Gives them their verdicts, as one step of undo. */
gboolean spore_advice_apply(const SporeAdvice *advice, SporeDocument *document, GError **error);

#endif
