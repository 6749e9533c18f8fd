/* The part of `spore plan` about mappings: how well drawn vertices and spheres follow their bodies. */
#ifndef SPORE_APP_CLI_PLAN_MAPPING_H
#define SPORE_APP_CLI_PLAN_MAPPING_H

#include "app/cli/scene.h"

void spore_plan_report_mapping(SporeCli *cli, const SporeRun *run);

#endif
