/* What `spore run` says of the loops of bodies along a line. */
#ifndef SPORE_APP_RUN_LOOPS_H
#define SPORE_APP_RUN_LOOPS_H

#include "app/cli/cli.h"
#include "core/measure/loops.h"

/* Adds them to the report, and says how near they came. FALSE: loops of a body that collides with itself went through
 * each other. */
gboolean spore_run_report_loops(SporeCli *cli, const SporeWorld *world, const SporeLoops *loops);

#endif
