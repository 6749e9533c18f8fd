/* A run as pictures: each simulation goes on to the moment of the next picture, then all are drawn. */
#include "ui/render/filming.h"

#include <glib/gi18n.h>
#include <math.h>

#define ROUNDING 1e-12 /* of a time that is a sum of steps */

static gboolean is_picture(const SporeFilming *filming) {
  SporeReelKind kind;
  return spore_reel_kind(filming->file, &kind, NULL) && kind == SPORE_REEL_PICTURE;
}

static guint64 count_pictures(const SporeFilming *filming) {
  if (is_picture(filming)) return 1;
  return (guint64)fmax(1, round((filming->to_s - filming->from_s) / filming->speed * filming->fps));
}

static double moment_s(const SporeFilming *filming, guint64 picture) {
  return is_picture(filming) ? filming->to_s : filming->from_s + (double)picture / filming->fps * filming->speed;
}

static gboolean cancelled(const SporeFilming *filming, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_CANCELLED, filming->file,
                           _("interrupted; it was not written, and what was there stays"));
}

/* Runs one simulation to a moment. FALSE: cancelled. */
static gboolean run_to(const SporeFilming *filming, guint simulation, double time_s, const SporeProgress *progress) {
  SporeWorld *world = filming->simulations[simulation]->world;
  SporeExercise *exercise = filming->simulations[simulation]->exercise;
  while (spore_world_time_s(world) < time_s * (1 - ROUNDING)) {
    if (filming->before_step) filming->before_step(filming->data, simulation);
    spore_world_step(world);
    if (spore_world_cancelled(world) ||
        !spore_progress(progress, spore_world_time_s(world) / fmax(filming->to_s, time_s), _("running")))
      return FALSE;
    spore_world_tidy(world);
    if (exercise) spore_exercise_watch(exercise, world);
  }
  return !spore_cancel_asked(filming->cancel);
}

static gboolean shoot(const SporeFilming *filming, SporePanes *panes, SporeReel *reel, guint64 count,
                      const SporeProgress *progress, GError **error) {
  for (guint64 picture = 0; picture < count; picture++) {
    for (guint i = 0; i < filming->count; i++)
      if (!run_to(filming, i, moment_s(filming, picture), progress)) return cancelled(filming, error);
    const guint8 *pixels = spore_panes_draw(panes, error);
    if (!pixels || !spore_reel_add(reel, pixels, error)) return FALSE;
    if (!spore_progress(progress, (double)(picture + 1) / (double)count, _("drawing")))
      return cancelled(filming, error);
  }
  return spore_reel_end(reel, filming->cancel, error);
}

gboolean spore_filming_run(const SporeFilming *filming, const SporeProgress *progress, SporeFilmed *filmed,
                           GError **error) {
  SporePanes *panes = spore_panes_new(filming->width, filming->height, error);
  gboolean done = panes != NULL;
  if (done) spore_panes_set_clip(panes, &filming->clip), spore_panes_set_light(panes, filming->light);
  if (done) spore_panes_set_legends(panes, filming->legends);
  for (guint i = 0; done && i < filming->count; i++)
    done =
        spore_panes_add(panes, filming->documents[i], filming->simulations[i], filming->camera, &filming->shown, error);
  if (done && filming->ports) done = spore_panes_show_ports(panes, filming->ports, error);
  SporeReel *reel = NULL;
  if (done) reel = spore_reel_new(filming->file, spore_panes_width(panes), filming->height, filming->fps, error);
  guint64 count = count_pictures(filming);
  done = reel && shoot(filming, panes, reel, count, progress, error);
  if (done) {
    *filmed =
        (SporeFilmed){spore_panes_width(panes), filming->height, count,
                      is_picture(filming) ? 0 : (double)count / filming->fps, g_strdup(spore_panes_renderer(panes))};
    filmed->legends = spore_panes_legends(panes, &filmed->field_end);
    filmed->legends_left_out = spore_panes_legends_left_out(panes, &filmed->no_legends);
  }
  spore_reel_free(reel);
  spore_panes_free(panes);
  return done;
}
