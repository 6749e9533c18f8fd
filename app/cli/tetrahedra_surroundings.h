/* spore tetrahedra --surroundings: the labels that are not meshed, as unmovable surfaces. */
#ifndef SPORE_APP_CLI_TETRAHEDRA_SURROUNDINGS_H
#define SPORE_APP_CLI_TETRAHEDRA_SURROUNDINGS_H

#include "app/cli/cli.h"
#include "core/author/label_surroundings.h"
#include "core/io/label_survey.h"

/* Makes the surfaces of the labels that are not chosen (of guint16), and reports the member `surroundings_seconds`.
 * GArray of SporeLabelSurrounding, whose names are
 * the survey's; NULL with an error. */
GArray *spore_cli_surroundings(SporeCli *cli, const SporeLabelMap *map, const SporeLabelSurvey *survey,
                               const GArray *chosen, GError **error);
/* Reports them: the member `surroundings`. */
void spore_cli_report_surroundings(SporeCli *cli, const GArray *surroundings, const SporeLabelSurvey *survey);

#endif
