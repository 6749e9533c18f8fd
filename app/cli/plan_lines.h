/* What control points that come and go cost, for spore plan. */
#ifndef SPORE_APP_CLI_PLAN_LINES_H
#define SPORE_APP_CLI_PLAN_LINES_H

#include "app/cli/scene.h"

/* Reports every line that has a reserve of them; measured: with the times that the world has taken for them so far. */
void spore_plan_report_lines(SporeCli *cli, const SporeWorld *world, gboolean measured);

#endif
