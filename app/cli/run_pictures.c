/* Draws the scene as the steps of its exercise are done. */
#include "app/cli/run_pictures.h"

#include "ui/render/renderer.h"
#include "ui/render/panes.h"

#define WIDTH 480
#define HEIGHT 270

struct SporeRunPictures {
  SporeRun *run;
  GPtrArray *of_step; /* of GBytes; NULL: none yet */
  GError *fault;      /* nothing is drawn any more */
  SporePanes *panes;  /* made for the first picture */
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
  spore_panes_free(pictures->panes);
  g_ptr_array_unref(pictures->of_step);
  g_clear_error(&pictures->fault);
  g_free(pictures);
}

static gboolean open_panes(SporeRunPictures *pictures) {
  static const SporeStageOptions shown = {.surfaces = TRUE};
  if (pictures->panes) return TRUE;
  pictures->panes = spore_panes_new(WIDTH, HEIGHT, &pictures->fault);
  return pictures->panes && spore_panes_add(pictures->panes, pictures->run->document, pictures->run->simulation, NULL,
                                            &shown, &pictures->fault);
}

/* The scene as it is now; NULL with the fault. */
static GBytes *draw(SporeRunPictures *pictures) {
  const guint8 *pixels = open_panes(pictures) ? spore_panes_draw(pictures->panes, &pictures->fault) : NULL;
  return pixels ? spore_png_encode(pixels, WIDTH, HEIGHT, (gsize)WIDTH * 4, &pictures->fault) : NULL;
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
