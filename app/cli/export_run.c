/* What exports of a run share: the scene at its moments, and what pictures of a scene do not hold. */
#include <glib/gi18n.h>

#include "app/cli/export.h"
#include "app/cli/scene.h"

/* The moments of a run, in steps. */
typedef struct Moments {
  guint64 steps, stride; /* stride 0: the end alone */
} Moments;

static gboolean find_moments(const SporeExport *export, Moments *moments, GError **error) {
  double dt_s = spore_object_number(spore_document_section(export->document, "solver"), "time_step");
  gint64 steps = 0;
  *moments = (Moments){0};
  if (export->time && !spore_cli_steps(export->time, dt_s, &steps, error)) return FALSE;
  moments->steps = (guint64)steps;
  return !export->every || spore_cli_stride(export->every, dt_s, &moments->stride, error);
}

static gboolean is_moment(const Moments *moments, guint64 step) {
  return moments->stride ? step % moments->stride == 0 : step == moments->steps;
}

static gboolean run_to_end(const SporeExport *export, SporeWorld *world, SporeDrawing *drawing, const Moments *moments,
                           SporeExportMoment moment, gpointer data, GError **error) {
  for (guint64 step = 0;; step++) {
    if (spore_cli_interrupted() || spore_world_cancelled(world))
      return spore_error_raise(error, SPORE_ERROR_CANCELLED, export->output,
                               _("interrupted; it was not written, and what was there stays"));
    if (is_moment(moments, step)) {
      if (!spore_drawing_update(drawing, error) || !moment(data, drawing, spore_world_time_s(world), error))
        return FALSE;
    }
    if (step == moments->steps) return TRUE;
    spore_world_step(world);
    spore_world_tidy(world);
    spore_progress(spore_cli_progress(export->cli), (double)(step + 1) / (double)moments->steps, _("running"));
  }
}

/* What is shown is no better than the steps that led there. */
static void tell_unsolved(const SporeExport *export, const SporeWorld *world) {
  guint64 most = 0;
  for (gsize i = 0; i < spore_world_unsolved_count(world); i++) {
    guint64 steps = spore_world_unsolved(world, i).steps;
    most = MAX(most, steps);
  }
  spore_cli_count(export->cli, "unsolved", (gint64)most);
  if (most)
    spore_cli_say(export->cli,
                  _("%llu steps were not solved as the scene is written; spore run says of which body, and why\n"),
                  (unsigned long long)most);
}

gboolean spore_export_run(SporeExport *export, SporeExportMoment moment, gpointer data, GError **error) {
  Moments moments;
  if (!find_moments(export, &moments, error)) return FALSE;
  g_autoptr(SporeSimulation) simulation =
      spore_simulation_new(export->document, NULL, export->input, spore_cli_cancel(), error);
  g_autoptr(SporeDrawing) drawing = simulation ? spore_drawing_new(export->document, simulation, error) : NULL;
  if (!drawing || !run_to_end(export, simulation->world, drawing, &moments, moment, data, error)) return FALSE;
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

void spore_export_lose_physics(SporeExport *export, gboolean colours) {
  spore_export_lose_sections(export, TRUE);
  spore_export_lose(export, g_strdup(_("how bodies move and touch: models, materials, collision spheres, gravity")));
  if (!colours) spore_export_lose(export, g_strdup(_("colours and wetness")));
}

gboolean spore_export_refuse_empty(const SporeExport *export, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, export->output,
                           _("the scene shows no surface; expected a body that has one; add one"));
}
