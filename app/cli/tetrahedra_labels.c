/* spore tetrahedra of a label map: tetrahedra of all its organs, in a scene or in files. */
#include "app/cli/tetrahedra_labels.h"

#include <glib/gi18n.h>

#include "app/cli/scene.h"
#include "app/cli/tetrahedra_list.h"
#include "core/author/anatomy.h"
#include "core/author/label_surroundings.h"
#include "core/io/scene_xml.h"

gboolean spore_cli_label_tetrahedra(SporeCli *cli, const char *file, const SporeLabelMap *map, const GArray *labels,
                                    const SporeLabelSurvey *survey, const SporeTetrahedraFields *fields,
                                    SporeTetrahedralMesh *mesh, SporeLabelTetrahedraReport *report, GError **error) {
  g_autofree double *weights = g_new(double, labels->len);
  SporeLabelTetrahedraOptions options = {.cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                         .size = fields->size,
                                         .labels = (const uint16_t *)(const void *)labels->data,
                                         .label_count = labels->len,
                                         .weights = weights};
  for (guint i = 0; i < labels->len; i++)
    weights[i] = spore_anatomy_cell_weight(spore_label_survey_entry(survey, options.labels[i])->name);
  return spore_label_tetrahedra(file, map, &options, mesh, report, spore_cli_progress(cli), error);
}

static gboolean save(SporeCli *cli, const char *output, const SporeLabelBodies *organs, const GArray *surroundings,
                     GError **error) {
  SporeDocument *document = spore_cli_new_scene(cli, output);
  gboolean done =
      spore_edit_use_labels(document, organs, error) &&
      (!surroundings || spore_edit_add_surroundings(document, (SporeLabelSurrounding *)(void *)surroundings->data,
                                                    surroundings->len, spore_cli_progress(cli), error)) &&
      spore_cli_save_scene(document, output, error);
  guint seams = spore_object_child_count(spore_document_section(document, "links"));
  spore_document_free(document);
  if (!done) return FALSE;
  spore_cli_text(cli, "scene", output);
  spore_cli_count(cli, "seams", seams);
  spore_cli_say(cli, _("%s: written; bodies: %zu, seams between them: %u\n"), output, organs->count, seams);
  return TRUE;
}

gboolean spore_cli_save_labels(SporeCli *cli, const char *output, const SporeLabelBodies *organs,
                               const SporeLabelTetrahedraReport *report, const SporeLabelSurvey *survey,
                               const GArray *surroundings, GError **error) {
  g_autoptr(GPtrArray) called = g_ptr_array_new();
  g_autoptr(GArray) labels = g_array_new(FALSE, FALSE, sizeof(guint32)),
                    guessed = g_array_new(FALSE, FALSE, sizeof(gboolean));
  for (guint i = 0; i < report->labels->len; i++) {
    const SporeLabelFigures *figures = &g_array_index(report->labels, SporeLabelFigures, i);
    const SporeLabelEntry *entry = spore_label_survey_entry(survey, figures->label);
    const guint32 label = figures->label;
    const gboolean guess = entry->naming == SPORE_LABEL_GUESSED;
    if (!figures->cells) continue; /* finer than the cells */
    g_ptr_array_add(called, entry->name);
    g_array_append_val(labels, label);
    g_array_append_val(guessed, guess);
  }
  SporeLabelBodies bodies = *organs;
  bodies.labels = (const guint32 *)(const void *)labels->data;
  bodies.names = (char *const *)called->pdata;
  bodies.guessed = (const gboolean *)(const void *)guessed->data;
  bodies.count = labels->len;
  return save(cli, output, &bodies, surroundings, error);
}

void spore_cli_report_labels(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeLabelTetrahedraReport *report,
                             const SporeLabelSurvey *survey) {
  spore_cli_count(cli, "nodes", (gint64)mesh->vertex_count);
  spore_cli_count(cli, "tetrahedra", (gint64)mesh->tetrahedron_count);
  spore_cli_number(cli, "min_dihedral_deg", report->quality.min_dihedral_deg);
  spore_cli_number(cli, "mean_dihedral_deg", report->quality.mean_dihedral_deg);
  spore_cli_text(cli, "method", "labels");
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_count(cli, "shared_faces", (gint64)report->shared_faces);
  spore_cli_say(
      cli,
      _("%zu tetrahedra, %zu nodes: least dihedral angle %.1f degrees (mean of minima %.1f), %zu faces shared "
        "between organs, %.1f s\n"),
      mesh->tetrahedron_count, mesh->vertex_count, report->quality.min_dihedral_deg, report->quality.mean_dihedral_deg,
      report->shared_faces, report->seconds);
  spore_cli_open_array(cli, "labels");
  for (guint i = 0; i < report->labels->len; i++) {
    const SporeLabelFigures *figures = &g_array_index(report->labels, SporeLabelFigures, i);
    double change = figures->volume / figures->voxel_volume - 1;
    spore_cli_open(cli, NULL);
    const SporeLabelEntry *entry = spore_label_survey_entry(survey, figures->label);
    const char *name = entry->name;
    const double weight = spore_anatomy_cell_weight(name);
    spore_cli_count(cli, "label", figures->label);
    spore_cli_text(cli, "name", name);
    spore_cli_count(cli, "cells", (gint64)figures->cells);
    spore_cli_number(cli, "weight", weight);
    spore_cli_number(cli, "share", (double)figures->cells / (double)mesh->tetrahedron_count);
    spore_cli_number(cli, "volume_m3", figures->volume);
    spore_cli_number(cli, "voxel_volume_m3", figures->voxel_volume);
    spore_cli_number(cli, "volume_change", change);
    spore_cli_number(cli, "min_dihedral_deg", figures->min_dihedral_deg);
    spore_cli_report_sides(cli, entry);
    spore_cli_close(cli);
    if (figures->cells)
      spore_cli_say(cli, _("  %s: %zu cells (%.1f %%), %.4g cm3 (%+.2f %% of its voxels'), least angle %.1f degrees"),
                    name, figures->cells, 100 * (double)figures->cells / (double)mesh->tetrahedron_count,
                    1e6 * figures->volume, 100 * change, figures->min_dihedral_deg);
    else spore_cli_say(cli, _("  %s: finer than the cells, it has none; ask for more or smaller cells"), name);
    if (figures->cells && weight != 1)
      spore_cli_say(cli, _(", cells for its volume by its tissue: %.2g times"), weight);
    spore_cli_say_sides(cli, entry);
    spore_cli_say(cli, "\n");
  }
  spore_cli_close_array(cli);
}
