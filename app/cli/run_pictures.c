/* Draws the scene as the steps of its exercise are done. */
#include "app/cli/run_pictures.h"

#include "ui/render/stage.h"

#define WIDTH 480
#define HEIGHT 270

struct SporeRunPictures {
  SporeRun *run;
  GPtrArray *of_step; /* of GBytes; NULL: none yet */
  GError *fault;      /* nothing is drawn any more */
  SporeOffscreen *offscreen;
  SporeRenderer *renderer;
  SporeStage *stage; /* made for the first picture */
};

static void unref_picture(gpointer picture) { g_clear_pointer((GBytes **)&picture, g_bytes_unref); }

SporeRunPictures *spore_run_pictures_new(SporeRun *run) {
  SporeRunPictures *pictures = g_new0(SporeRunPictures, 1);
  pictures->run = run;
  pictures->of_step = g_ptr_array_new_with_free_func(unref_picture);
  g_ptr_array_set_size(pictures->of_step, (gint)spore_exercise_state(run->simulation->exercise).steps);
  return pictures;
}

void spore_run_pictures_free(SporeRunPictures *pictures) {
  if (!pictures) return;
  if (pictures->stage) spore_stage_free(pictures->stage);
  spore_renderer_free(pictures->renderer);
  spore_offscreen_free(pictures->offscreen);
  g_ptr_array_unref(pictures->of_step);
  g_clear_error(&pictures->fault);
  g_free(pictures);
}

static gboolean open_stage(SporeRunPictures *pictures) {
  static const SporeStageOptions shown = {.surfaces = TRUE};
  if (pictures->stage) return TRUE;
  pictures->offscreen = spore_offscreen_new(&pictures->fault);
  pictures->renderer = pictures->offscreen ? spore_renderer_new(pictures->offscreen, &pictures->fault) : NULL;
  if (!pictures->renderer) return FALSE;
  pictures->stage = spore_stage_new(pictures->renderer, pictures->run->document);
  spore_stage_set_options(pictures->stage, &shown);
  spore_stage_rebuild(pictures->stage, pictures->run->simulation);
  return TRUE;
}

/* The scene as it is now; NULL with the fault. */
static GBytes *draw(SporeRunPictures *pictures) {
  static const SporeRenderOptions how = {.width = WIDTH, .height = HEIGHT, .antialias = TRUE};
  SporeCamera camera;
  if (!open_stage(pictures)) return NULL;
  g_autofree guint8 *pixels = g_malloc((gsize)WIDTH * HEIGHT * 4);
  spore_stage_update(pictures->stage, spore_world_snapshot_acquire(pictures->run->simulation->world));
  if (!spore_stage_camera(pictures->stage, NULL, (double)WIDTH / HEIGHT, &camera, &pictures->fault) ||
      !spore_renderer_draw(pictures->renderer, &camera, &how, pixels, (gsize)WIDTH * 4, &pictures->fault))
    return NULL;
  return spore_png_encode(pixels, WIDTH, HEIGHT, (gsize)WIDTH * 4, &pictures->fault);
}

/* Steps that were done in one step of the world share a picture. */
void spore_run_pictures_look(SporeRunPictures *pictures) {
  const SporeExercise *exercise = pictures->run->simulation->exercise;
  g_autoptr(GBytes) picture = NULL;
  for (guint i = 0; i < pictures->of_step->len && !pictures->fault; i++) {
    if (pictures->of_step->pdata[i] || spore_exercise_step_state(exercise, i).phase != SPORE_STEP_DONE) continue;
    if (!picture) picture = draw(pictures);
    if (picture) pictures->of_step->pdata[i] = g_bytes_ref(picture);
  }
}

SporeReportPictures spore_run_pictures_get(const SporeRunPictures *pictures) {
  return (SporeReportPictures){pictures->of_step, pictures->fault ? pictures->fault->message : NULL};
}
