/* What exports of a run share: the scene at its moments, and what pictures of a scene do not hold. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/compile.h"
#include "core/scene/texture.h"
#include "ui/export/private.h"

static gboolean is_moment(const SporeExport *export, guint64 step) {
  return export->stride ? step % export->stride == 0 : step == export->steps;
}

static gboolean run_to_end(const SporeExport *export, SporeWorld *world, SporeDrawing *drawing,
                           SporeExportMoment moment, gpointer data, GError **error) {
  for (guint64 step = 0;; step++) {
    if (spore_cancel_asked(export->cancel) || spore_world_cancelled(world))
      return spore_error_raise(error, SPORE_ERROR_CANCELLED, export->output,
                               _("interrupted; it was not written, and what was there stays"));
    if (is_moment(export, step)) {
      if (!spore_drawing_update(drawing, error) || !moment(data, drawing, spore_world_time_s(world), error))
        return FALSE;
    }
    if (step == export->steps) return TRUE;
    spore_world_step(world);
    spore_world_tidy(world);
    spore_progress(export->progress, (double)(step + 1) / (double)export->steps, _("running"));
  }
}

/* What is shown is no better than the steps that led there. */
static void tell_unsolved(SporeExport *export, const SporeWorld *world) {
  export->ran = TRUE;
  for (gsize i = 0; i < spore_world_unsolved_count(world); i++) {
    guint64 steps = spore_world_unsolved(world, i).steps;
    export->unsolved = MAX(export->unsolved, steps);
  }
}

gboolean spore_export_show(SporeExport *export, SporeExportMoment moment, gpointer data, GError **error) {
  g_autoptr(SporeSimulation) simulation =
      spore_simulation_new(export->document, NULL, export->input, export->cancel, error);
  g_autoptr(SporeDrawing) drawing = simulation ? spore_drawing_new(export->document, simulation, error) : NULL;
  if (!drawing || !run_to_end(export, simulation->world, drawing, moment, data, error)) return FALSE;
  tell_unsolved(export, simulation->world);
  return TRUE;
}

void spore_export_lose_sections(SporeExport *export, gboolean links) {
  static const struct {
    const char *section, *sentence;
  } sections[] = {
      {"links", N_("the links: what ties bodies to each other and to places")},
      {"effects", N_("the wounds: where particles come from")},
      {"tools", N_("the tools: what cuts, holds and looks; of instruments the bodies alone are shown")},
      {"devices", N_("the devices: what moved the instruments")},
      {"exercise", N_("the exercise: its steps and metrics are not in the file")},
  };
  for (gsize i = links ? 0 : 1; i < G_N_ELEMENTS(sections); i++)
    if (spore_object_child_count(spore_document_section(export->document, sections[i].section)) > 0)
      spore_export_lose(export, g_strdup(_(sections[i].sentence)));
}

static void lose_opacity(SporeExport *export) {
  const SporeObject *bodies = spore_document_section(export->document, "bodies");
  gboolean clear = FALSE;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *visual = spore_object_child_of(spore_object_child(bodies, i), "visual");
    clear |= visual && spore_object_number(visual, "opacity") < 1;
  }
  if (clear) spore_export_lose(export, g_strdup(_("what is seen through surfaces: their opacity")));
}

/* pictures: the format has those that can be read. */
static void lose_textures(SporeExport *export, gboolean pictures) {
  const SporeObject *bodies = spore_document_section(export->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i), *visual = spore_object_child_of(body, "visual");
    SporeTexture texture;
    if (!visual || !spore_object_text(visual, "texture")) continue;
    if (pictures && spore_texture_read(export->document, visual, &texture, NULL)) spore_texture_clear(&texture);
    else spore_export_lose(export, g_strdup_printf(_("%s: the picture on its surface"), spore_object_name(body)));
  }
}

void spore_export_lose_physics(SporeExport *export, gboolean colours, gboolean materials) {
  spore_export_lose_sections(export, TRUE);
  spore_export_lose(export, g_strdup(_("how bodies move and touch: models, materials, collision spheres, gravity")));
  if (!colours) spore_export_lose(export, g_strdup(_("colours and wetness")));
  if (!materials) lose_opacity(export);
  lose_textures(export, materials);
}

SporeNamedSurface spore_export_surface(const SporeDrawnPart *part) {
  SporeNamedSurface surface = {.name = g_intern_string(part->name), .wetness = part->wetness, .opacity = part->opacity};
  memcpy(surface.colour, part->colour, sizeof surface.colour);
  if (!part->picture || !part->element_count) return surface;
  surface.picture = g_bytes_ref(part->picture);
  surface.places = g_memdup2(part->places, 6 * part->element_count * sizeof *part->places);
  return surface;
}

gboolean spore_export_refuse_empty(const SporeExport *export, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, export->output,
                           _("the scene shows no surface; expected a body that has one; add one"));
}
