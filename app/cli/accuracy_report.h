/* What `spore accuracy` says: lines for people, and members of --json. */
#ifndef SPORE_APP_CLI_ACCURACY_REPORT_H
#define SPORE_APP_CLI_ACCURACY_REPORT_H

#include "app/cli/cli.h"
#include "core/measure/accuracy.h"

/* Members of the report. */
extern const SporeReportMember spore_accuracy_members[];

/* Reports to people and to --json. */
void spore_accuracy_tell(SporeCli *cli, const char *scene, const SporeAccuracyReport *report);

#endif
