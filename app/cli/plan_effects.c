/* What spore plan says of effects. */
#include <glib/gi18n.h>
#include <math.h>

#include "app/cli/plan_tables.h"
#include "core/scene/fidelity.h"

#define LEAST_STEPS 200
#define LONGEST_S 10.

/* How long is measured: to the end of the recorded input, up to a limit. */
static double measured_s(const SporeRun *run) {
  double least_s = LEAST_STEPS * spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  const SporeTrack *track = run->input.channel_count ? &run->input : run->simulation->track;
  return fmin(fmax(least_s, spore_track_end_s(track)), LONGEST_S);
}

/* Mean time of a step of a copy of the scene, us. path: of what is physical in it; NULL: it is as the scene says. */
static gboolean measure(SporeRun *run, const char *path, double time_s, double *mean_us, GError **error) {
  SporeDocument *copy = spore_document_copy(run->document);
  gboolean varied = !path || spore_fidelity_set_mode(copy, spore_document_by_path(copy, path), "physical", error);
  const SporeTrack *input = run->input.channel_count ? &run->input : NULL;
  SporeSimulation *simulation = varied ? spore_simulation_new(copy, run->pool, input, spore_cli_cancel(), error) : NULL;
  if (simulation) {
    SporeWorld *world = simulation->world;
    while (spore_world_time_s(world) < time_s && !spore_world_cancelled(world)) spore_world_step(world);
    *mean_us = spore_profile_summary(spore_world_profile(world)).mean_us;
  }
  gboolean done = simulation != NULL;
  spore_simulation_free(simulation);
  spore_document_free(copy);
  return done;
}

static void report_body(SporeCli *cli, const SporeWorld *world, const char *name) {
  guint32 body = spore_world_find_body(world, name);
  double effect_us, physics_us;
  if (body == SPORE_NO_BODY || !spore_world_effect_work(world, body, &effect_us, &physics_us)) return;
  spore_cli_number(cli, "effect_us", effect_us);
  spore_cli_number(cli, "physics_us", physics_us);
  spore_cli_say(cli, _("%s: an effect, which takes about %.3g us of a step; its physics would take %.3g us\n"), name,
                effect_us, physics_us);
}

/* Nothing is counted for tools and emitters: what they save is in the contacts and particles that are not there.
 * *is_us: of the scene as it is, measured where it is wanted first; NAN until then. */
static gboolean report_other(SporeCli *cli, SporeRun *run, const SporeObject *holder, gboolean measured, double *is_us,
                             GError **error) {
  const char *name = spore_object_name(holder);
  g_autofree char *path = spore_object_path(holder);
  double time_s = measured_s(run), physical_us;
  if (!measured) {
    spore_cli_say(cli, _("%s: an effect; --measure says what that saves\n"), name);
    return TRUE;
  }
  if (isnan(*is_us) && !measure(run, NULL, time_s, is_us, error)) return FALSE;
  if (!measure(run, path, time_s, &physical_us, error)) return FALSE;
  spore_cli_number(cli, "seconds", time_s);
  spore_cli_number(cli, "step_us", *is_us);
  spore_cli_number(cli, "step_us_physical", physical_us);
  spore_cli_say(cli, _("%s: an effect; over %.3g s a step takes %.3g us, with its physics %.3g us\n"), name, time_s,
                *is_us, physical_us);
  return TRUE;
}

gboolean spore_plan_report_effects(SporeCli *cli, SporeRun *run, gboolean measured, GError **error) {
  g_autoptr(GPtrArray) holders = spore_fidelity_holders(run->document);
  gboolean done = TRUE;
  double is_us = NAN;
  spore_cli_open_array(cli, "effects");
  for (guint i = 0; done && i < holders->len && !spore_cli_interrupted(); i++) {
    const SporeObject *holder = holders->pdata[i];
    if (!spore_fidelity_is_effect(run->document, holder)) continue;
    const char *element = spore_object_type(holder)->element;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", spore_object_name(holder));
    spore_cli_text(cli, "kind", element);
    if (g_str_equal(element, "body")) report_body(cli, run->simulation->world, spore_object_name(holder));
    else done = report_other(cli, run, holder, measured, &is_us, error);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  return done;
}
