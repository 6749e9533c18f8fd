/* What each level of a body costs, for spore plan. */
#ifndef SPORE_APP_CLI_PLAN_LEVELS_H
#define SPORE_APP_CLI_PLAN_LEVELS_H

#include "app/cli/scene.h"

/* Reports the levels of every body that has some; steps: how many to measure each with, in a copy of the scene where
 * all else is as it is; 0: none. FALSE with a GError where a copy cannot be made. */
gboolean spore_plan_report_levels(SporeCli *cli, SporeRun *run, int steps, GError **error);

#endif
