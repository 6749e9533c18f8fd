/* Legends of spheres and of contact forces, and the words of all legends; those of links are in stage_links.c. */
#include <glib/gi18n.h>

#include "core/scene/length_unit.h"
#include "ui/render/stage_body.h"

SporeSphereScale spore_stage_sphere_scale(const SporeStage *stage) {
  SporeSphereScale scale = {0};
  for (guint i = 0; i < stage->bodies->len && !stage->touch_end; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (!body->fit_high || !spore_stage_body_shows_spheres(stage, body)) continue;
    scale.high = scale.share && scale.high != body->fit_high ? 0 : body->fit_high;
    scale.share = SPORE_STAGE_FIT_SCALE;
  }
  return scale;
}

gboolean spore_stage_sphere_legend(const SporeStage *stage, SporeStageLegend *legend) {
  SporeSphereScale scale = spore_stage_sphere_scale(stage);
  *legend = (SporeStageLegend){0};
  if (stage->touch_end > 0) {
    legend->label = g_strdup(_("Contact force on a sphere"));
    legend->low = g_strdup("0");
    legend->high = g_strdup_printf("%.3g N", stage->touch_end);
    legend->range = g_strdup(_("scale follows the state"));
    return TRUE;
  }
  if (!(scale.share > 0)) return FALSE;
  legend->label = g_strdup(_("Depth error"));
  legend->low = g_strdup("0");
  legend->high = scale.high > 0 ? g_strdup_printf("%.3g mm", 1e3 * scale.high)
                                : g_strdup_printf(_("%g %% of the diagonal"), 100 * scale.share);
  return TRUE;
}

gboolean spore_stage_contact_legend(const SporeStage *stage, SporeStageLegend *legend) {
  *legend = (SporeStageLegend){0};
  if (!stage->options.contacts || !(stage->contact_longest > 0)) return FALSE;
  g_autofree char *newton = spore_length_text(0.5 * stage->contact_longest);
  legend->label = g_strdup(_("Contact forces"));
  legend->range = g_strdup_printf(_("1 N is a line of %s"), newton);
  legend->without = stage->contact_most > 0 ? g_strdup_printf(_("largest now: %.3g N"), stage->contact_most)
                                            : g_strdup(_("nothing touches now"));
  return TRUE;
}

guint spore_stage_legends(const SporeStage *stage, SporeStageLegend legends[SPORE_STAGE_LEGENDS]) {
  gboolean (*const kinds[])(const SporeStage *, SporeStageLegend *) = {
      spore_stage_legend, spore_stage_sphere_legend, spore_stage_contact_legend, spore_stage_link_legend};
  guint count = 0;
  for (guint i = 0; i < G_N_ELEMENTS(kinds); i++) count += kinds[i](stage, &legends[count]);
  return count;
}

char *spore_stage_legends_text(const SporeStage *stage) {
  SporeStageLegend legends[SPORE_STAGE_LEGENDS];
  guint count = spore_stage_legends(stage, legends);
  GString *lines = g_string_new(NULL);
  for (guint i = 0; i < count; i++) {
    g_autofree char *text = spore_stage_legend_text(&legends[i]);
    g_string_append_printf(lines, "%s\n", text);
    spore_stage_legend_clear(&legends[i]);
  }
  return g_string_free(lines, FALSE);
}
