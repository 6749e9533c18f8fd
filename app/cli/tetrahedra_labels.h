/* spore tetrahedra of a label map. */
#ifndef SPORE_APP_CLI_TETRAHEDRA_LABELS_H
#define SPORE_APP_CLI_TETRAHEDRA_LABELS_H

#include "app/cli/cli.h"
#include "core/author/generated_edits.h"
#include "core/generate/labels/labels.h"
#include "core/io/label_survey.h"

/* Meshes these labels (of guint16) of the map that was read from `file`. Organs whose name says a softer tissue get
 * more cells for their volume. The members of the report are those of spore tetrahedra, and `labels`. */
gboolean spore_cli_label_tetrahedra(SporeCli *cli, const char *file, const SporeLabelMap *map, const GArray *labels,
                                    const SporeLabelSurvey *survey, const SporeTetrahedraFields *fields,
                                    SporeTetrahedralMesh *mesh, SporeLabelTetrahedraReport *report, GError **error);
/* Reports the organs by the names of the survey. */
void spore_cli_report_labels(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeLabelTetrahedraReport *report,
                             const SporeLabelSurvey *survey);
/* Saves a new scene: a soft body for each organ, with seams where organs share faces, and the label map. organs: file,
 * content, fields, mesh, and purpose. surroundings: of SporeLabelSurrounding, which are added; NULL: none. The report
 * gets the members `scene` and `seams`. */
gboolean spore_cli_save_labels(SporeCli *cli, const char *output, const SporeLabelBodies *organs,
                               const SporeLabelTetrahedraReport *report, const SporeLabelSurvey *survey,
                               const GArray *surroundings, GError **error);

#endif
