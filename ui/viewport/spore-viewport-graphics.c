/* The OpenGL context and the renderer, which a thread prepares. */
#include <glib/gi18n.h>

#include "ui/jobs/under-way.h"
#include "ui/viewport/spore-viewport-private.h"

typedef struct {
  SporeOffscreen *offscreen;
  SporeRenderer *renderer;
} Graphics;

static void free_graphics(gpointer data) {
  Graphics *graphics = data;
  g_clear_pointer(&graphics->renderer, spore_renderer_free);
  g_clear_pointer(&graphics->offscreen, spore_offscreen_free);
  g_free(graphics);
  spore_work_end();
}

static void prepare(GTask *task, gpointer source, gpointer data, GCancellable *cancellable) {
  Graphics *graphics = data;
  GError *error = NULL;
  graphics->offscreen = spore_offscreen_new(&error);
  if (graphics->offscreen) graphics->renderer = spore_renderer_new(graphics->offscreen, &error);
  gboolean ready = graphics->renderer && spore_renderer_warm(graphics->renderer, &error);
  if (graphics->offscreen) spore_offscreen_release(graphics->offscreen);
  if (ready) g_task_return_boolean(task, TRUE);
  else g_task_return_error(task, error);
}

/* Where OpenGL is missing, a label says why. The rest of the editor works. */
static void say_why(SporeViewport *self, const GError *error) {
  self->renderer_name = g_strdup(_("no 3D graphics"));
  g_autofree char *text =
      g_strdup_printf(_("The scene cannot be drawn on this machine: %s\n\nEverything else works."), error->message);
  gtk_label_set_text(GTK_LABEL(self->failure), text);
  gtk_widget_show(self->failure);
}

static void prepared(GObject *source, GAsyncResult *result, gpointer user_data) {
  SporeViewport *self = user_data; /* which the task holds */
  GTask *task = G_TASK(result);
  g_autoptr(GError) error = NULL;
  gboolean ready = g_task_propagate_boolean(task, &error);
  if (self->graphics != task) return; /* the view is gone */
  self->graphics = NULL;
  if (ready) {
    Graphics *graphics = g_task_get_task_data(task);
    self->offscreen = g_steal_pointer(&graphics->offscreen);
    self->renderer = g_steal_pointer(&graphics->renderer);
    self->renderer_name = g_strdup(spore_offscreen_renderer(self->offscreen));
  } else {
    say_why(self, error);
  }
  spore_viewport_show_welcome(self);
  spore_viewport_redraw(self);
}

void spore_viewport_prepare_graphics(SporeViewport *self) {
  g_autoptr(GTask) task = g_task_new(self, NULL, prepared, self);
  spore_work_begin();
  g_task_set_task_data(task, g_new0(Graphics, 1), free_graphics);
  self->graphics = task;
  g_task_run_in_thread(task, prepare);
}

void spore_viewport_wait_for_graphics(SporeViewport *self) {
  while (self->graphics) g_main_context_iteration(NULL, TRUE);
}
