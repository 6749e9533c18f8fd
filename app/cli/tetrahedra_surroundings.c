/* spore tetrahedra --surroundings: the labels that are not meshed, as unmovable surfaces. */
#include "app/cli/tetrahedra_surroundings.h"

#include <glib/gi18n.h>

#include "app/cli/tetrahedra_list.h"
#include "core/base/profile.h"

static gboolean is_chosen(const GArray *chosen, guint16 label) {
  for (guint i = 0; i < chosen->len; i++)
    if (g_array_index(chosen, guint16, i) == label) return TRUE;
  return FALSE;
}

/* The labels that are not chosen, without their surfaces yet. */
static GArray *rest_of(const SporeLabelSurvey *survey, const GArray *chosen) {
  GArray *rest = spore_label_surroundings_new();
  for (guint i = 0; i < survey->entries->len; i++) {
    const SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    if (is_chosen(chosen, entry->label)) continue;
    const SporeLabelSurrounding one = {.surface = {.label = entry->label},
                                       .name = g_strdup(entry->name),
                                       .guessed = entry->naming == SPORE_LABEL_GUESSED};
    g_array_append_val(rest, one);
  }
  return rest;
}

GArray *spore_cli_surroundings(SporeCli *cli, const SporeLabelMap *map, const SporeLabelSurvey *survey,
                               const GArray *chosen, GError **error) {
  g_autoptr(GArray) rest = rest_of(survey, chosen);
  const guint64 started = spore_clock_ns();
  if (!spore_label_surroundings_make(rest, map, spore_cli_progress(cli), error)) return NULL;
  const double seconds = 1e-9 * (double)(spore_clock_ns() - started);
  spore_cli_number(cli, "surroundings_seconds", seconds);
  spore_cli_say(cli, _("%u surroundings, %.1f s\n"), rest->len, seconds);
  return g_steal_pointer(&rest);
}

void spore_cli_report_surroundings(SporeCli *cli, const GArray *surroundings, const SporeLabelSurvey *survey) {
  spore_cli_open_array(cli, "surroundings");
  for (guint i = 0; i < surroundings->len; i++) {
    const SporeLabelSurrounding *one = &g_array_index(surroundings, SporeLabelSurrounding, i);
    const SporeLabelEntry *entry = spore_label_survey_entry(survey, one->surface.label);
    spore_cli_open(cli, NULL);
    spore_cli_count(cli, "label", one->surface.label);
    spore_cli_text(cli, "name", one->name);
    spore_cli_count(cli, "triangles", (gint64)one->surface.mesh.triangle_count);
    spore_cli_count(cli, "triangles_before", (gint64)one->surface.triangles_before);
    spore_cli_number(cli, "off_voxels", one->surface.off);
    spore_cli_report_sides(cli, entry);
    spore_cli_close(cli);
    spore_cli_say(cli, _("  %s: unmovable, %zu triangles of %zu, at most %.2f voxels off its voxels"), one->name,
                  one->surface.mesh.triangle_count, one->surface.triangles_before, one->surface.off);
    spore_cli_say_sides(cli, entry);
    spore_cli_say(cli, "\n");
  }
  spore_cli_close_array(cli);
}
