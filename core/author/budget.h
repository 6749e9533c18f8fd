/* A scene within a budget of time: chooses the level and integrator of each body, and the step and solvers of the
 * scene, so that the scene costs no more than it may, with the least error.
 *
 * The budget is time on the processor for as much simulated time as one step of the scene takes now: a scene of 4 ms
 * steps that may take 1000 us runs four times faster than real time, whatever step is chosen. Candidates are the points
 * of an accuracy study (core/measure/accuracy.h): all methods, steps and levels, each with its measured error and cost.
 * From the best of them that fits, single bodies, solvers and the step are changed one at a time while that helps, and
 * then several of them at once, the best few by what each did alone; every candidate is run and judged against the same
 * reference. What was chosen is timed again beside the scene as it is. */
#ifndef SPORE_AUTHOR_BUDGET_H
#define SPORE_AUTHOR_BUDGET_H

#include "core/base/progress.h"
#include "core/measure/accuracy.h"
#include "core/scene/compile.h"

#define SPORE_BUDGET_RUNS 20     /* timed runs of either form, in turn */
#define SPORE_BUDGET_WITHIN 0.15 /* of the promise */
#define SPORE_BUDGET_USUAL_S 40  /* on the processor, for the study and the search */

typedef struct SporeBudgetOptions {
  double budget_us;              /* above 0 */
  double time_s;                 /* simulated, of the stretch; 0: by itself */
  double most_s;                 /* on the processor, for the study and the search; 0: the usual */
  const char *const *kept;       /* names of bodies that keep their level and integrator, NULL at the end; NULL: none */
  const SporeCancel *cancel;     /* borrowed while it works */
  const SporeProgress *progress; /* NULL: none */
} SporeBudgetOptions;

/* A form of the scene. Times are for the simulated time of one step of the scene as it was. */
typedef struct SporeBudgetForm {
  double dt_s;
  const char *nonlinear, *linear; /* as in the file */
  double error;                   /* of positions, by a body's length; see SporeAccuracyReport.statistics */
  gboolean resolved;              /* error is above what can be told; else it is what can be told */
  gboolean as_written;            /* every step was solved as it is written */
  double us;                      /* measured in the search: of what was chosen, the promise */
  double step_us, p99_us;         /* of one of its own steps */
  double median_us, low_us,
      high_us; /* timed again: the median of the runs, and where it lies with 95 %; 0: not timed */
} SporeBudgetForm;

/* A body that physics moves, before and after. */
typedef struct SporeBudgetBody {
  char *name;
  const char *integrator[2], *level[2]; /* names; level NULL: it has but one */
  const char *reason; /* translated: why its level was not touched; NULL: it was open, or has but one */
} SporeBudgetBody;

typedef struct SporeBudget {
  double budget_us, step_s;       /* for step_s of simulated time */
  gboolean met;                   /* what was chosen fits, also where timed again */
  gboolean kept_promise;          /* timed again, it is within SPORE_BUDGET_WITHIN of the promise */
  SporeBudgetForm before, chosen; /* chosen: where nothing fits the cheapest that was found */
  gsize body_count;
  SporeBudgetBody *bodies;
  guint tried, together;            /* runs of the search; of them, of several changes at once that a forecast chose */
  double start_s, time_s, contacts; /* of the stretch; contacts: mean a step */
  double floor;                     /* errors below cannot be told */
  gboolean statistics;              /* errors are of mean places over the stretch */
  const char *happens;              /* translated: what instruments do in one of the forms alone; NULL: nothing */
  char **cuts;                      /* NULL at the end: what the study and the search left out */
  SporeAccuracyReport *report;      /* of the study */
  gint64 time;                      /* when it ended, Unix time, s */
  gsize setting_count;
  struct SporeBodySetting *settings; /* for spore_budget_apply */
} SporeBudget;

/* document and simulation (of the document as it is, with this input) are borrowed, and not changed. NULL with a
 * GError: the scene cannot be studied, or cancelled. */
SporeBudget *spore_budget_find(SporeDocument *document, const SporeSimulation *simulation, SporePool *pool,
                               const SporeTrack *input, const SporeBudgetOptions *options, GError **error);
void spore_budget_free(SporeBudget *budget);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeBudget, spore_budget_free)
/* Whether anything differs from the scene as it is. */
gboolean spore_budget_changes(const SporeBudget *budget);
/* In words, translated: "0.3 %", or that it cannot be told or is not stable; g_free. */
char *spore_budget_error_text(const SporeBudgetForm *form);
/* "level coarse instead of fine"; NULL: the body stays as it is; g_free. */
char *spore_budget_body_change(const SporeBudgetBody *body);
/* One change: a property of the solver or a body, and what becomes of it. */
typedef struct SporeBudgetChange {
  char *id, *text;
} SporeBudgetChange;
/* All changes, of SporeBudgetChange; g_array_unref. */
GArray *spore_budget_list_changes(const SporeBudget *budget);
/* Writes what was chosen into the document, as one undo step, and remembers what was measured of it. */
gboolean spore_budget_apply(const SporeBudget *budget, SporeDocument *document, GError **error);

#endif
