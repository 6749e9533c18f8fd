/* What `spore accuracy` says: lines for people, members of --json, and the files of --csv, --svg and --html. */
#ifndef SPORE_APP_CLI_ACCURACY_REPORT_H
#define SPORE_APP_CLI_ACCURACY_REPORT_H

#include "app/cli/cli.h"
#include "core/measure/accuracy.h"

/* Members of the report. */
extern const SporeReportMember spore_accuracy_members[];

/* Reports to people and to --json. */
void spore_accuracy_tell(SporeCli *cli, const char *scene, const SporeAccuracyReport *report);
/* Texts of the files; g_free. NULL with a GError. */
char *spore_accuracy_csv(const SporeAccuracyReport *report);
char *spore_accuracy_plot(const char *scene, const SporeAccuracyReport *report, GError **error);
char *spore_accuracy_html(const char *scene, const SporeAccuracyReport *report, GError **error);

#endif
