/* spore tetrahedra of a label map. */
#ifndef SPORE_APP_CLI_TETRAHEDRA_LABELS_H
#define SPORE_APP_CLI_TETRAHEDRA_LABELS_H

#include "app/cli/cli.h"
#include "core/generate/label_tetrahedra.h"

/* Meshes the label map that `content` of `file` is; labels: "1,2,5" or NULL. The report's members are those of spore
 * tetrahedra and `labels`. */
gboolean spore_cli_label_tetrahedra(SporeCli *cli, const char *file, GBytes *content, const char *labels, size_t cells,
                                    double size, SporeTetrahedralMesh *mesh, SporeLabelTetrahedraReport *report,
                                    GError **error);
void spore_cli_report_labels(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeLabelTetrahedraReport *report);

#endif
