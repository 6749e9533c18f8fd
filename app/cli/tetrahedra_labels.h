/* spore tetrahedra of a label map. */
#ifndef SPORE_APP_CLI_TETRAHEDRA_LABELS_H
#define SPORE_APP_CLI_TETRAHEDRA_LABELS_H

#include "app/cli/cli.h"
#include "core/author/generated_edits.h"
#include "core/generate/labels/labels.h"

/* Meshes the label map that `content` of `file` is; labels: "1,2,5" or NULL. The report's members are those of spore
 * tetrahedra and `labels`. */
gboolean spore_cli_label_tetrahedra(SporeCli *cli, const char *file, GBytes *content, const char *labels,
                                    const SporeTetrahedraFields *fields, SporeTetrahedralMesh *mesh,
                                    SporeLabelTetrahedraReport *report, GError **error);
/* names: of spore_label_map_names. */
void spore_cli_report_labels(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeLabelTetrahedraReport *report,
                             GHashTable *names);
/* A new scene: a soft body of each organ, joined by seams where they share faces; it keeps the map. organs: file,
 * content, fields, mesh and use of it. The report gets the members `scene` and `seams`. */
gboolean spore_cli_save_labels(SporeCli *cli, const char *output, const SporeLabelBodies *organs,
                               const SporeLabelTetrahedraReport *report, GHashTable *names, GError **error);

#endif
