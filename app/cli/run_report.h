/* What `spore run` reports of a run. */
#ifndef SPORE_APP_RUN_REPORT_H
#define SPORE_APP_RUN_REPORT_H

#include "app/cli/cli.h"
#include "core/exercise/exercise.h"
#include "core/measure/pace.h"
#include "core/measure/run_statistics.h"

/* Prints the figures for people, or adds them to the report. pace: NULL without --realtime.
 * exercise: NULL where the scene has none. Returns the exit status. */
int spore_run_report(SporeCli *cli, const char *scene, const SporeWorld *world, const SporeRunStatistics *result,
                     const SporePace *pace, const SporeExercise *exercise);

#endif
