/* How well what bodies carry follows them, for spore plan. */
#ifndef SPORE_APP_CLI_PLAN_CARRIED_H
#define SPORE_APP_CLI_PLAN_CARRIED_H

#include "app/cli/scene.h"

void spore_plan_report_carried(SporeCli *cli, const SporeRun *run);

#endif
