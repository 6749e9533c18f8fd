/* spore advise --budget-us: level, integrator, step and solvers within a budget of time. */
#ifndef SPORE_APP_CLI_ADVISE_BUDGET_H
#define SPORE_APP_CLI_ADVISE_BUDGET_H

#include "app/cli/scene.h"

/* Options as they were given; NULL: not given. */
typedef struct SporeBudgetRequest {
  char *budget, *time, *seconds, *output;
  char **keep;
  gboolean apply;
} SporeBudgetRequest;

/* Chooses, reports, and writes the scene where that is asked for. Returns the exit status: 1 where the budget cannot be
 * met, or the promise did not hold. */
int spore_advise_budget(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                        const SporeBudgetRequest *request);

#endif
