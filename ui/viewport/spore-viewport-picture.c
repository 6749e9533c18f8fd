/* Pictures of the stage: the large one, in which the mouse works, and the second view's. */
#include "ui/viewport/spore-viewport-private.h"

#define SHARE_OF_WIDTH 0.25 /* of the second view in the whole */
#define LEAST_WIDTH 200     /* pixels */
#define MOST_WIDTH 480
#define ASPECT (16.0 / 9)

/* A picture that takes longer is drawn while the window goes on; till it is there, the last one is shown. */
#define PATIENCE_MS 30
#define LOOK_MS 4

static gboolean is_of_size(const SporeViewportPicture *picture, int width, int height) {
  return picture->pixels && cairo_image_surface_get_width(picture->pixels) == width &&
         cairo_image_surface_get_height(picture->pixels) == height;
}

static void fit(SporeViewportPicture *picture, int width, int height) {
  if (is_of_size(picture, width, height)) return;
  g_clear_pointer(&picture->pixels, cairo_surface_destroy);
  picture->pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
}

void spore_viewport_drop_drawing(SporeViewport *self) {
  g_clear_handle_id(&self->drawing.look, g_source_remove);
  self->drawing.of = NULL;
}

gboolean spore_viewport_is_fine(SporeViewport *self) {
  if (self->habits.pictures == SPORE_PICTURES_AUTOMATIC) return !spore_offscreen_is_software(self->offscreen);
  return self->habits.pictures == SPORE_PICTURES_FINE;
}

static void begin(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera, int width,
                  int height) {
  SporeRenderOptions options = {width,
                                height,
                                .grid = !self->presented,
                                .antialias = spore_viewport_is_fine(self),
                                .coarse = !spore_viewport_is_fine(self),
                                .scale = gtk_widget_get_scale_factor(self->area),
                                .clip = spore_viewport_clip(self)};
  g_autoptr(GError) error = NULL;
  gint64 now = g_get_monotonic_time();
  picture->stale = FALSE;
  if (spore_renderer_begin(self->renderer, camera, &options, &error)) {
    self->drawing = (SporeViewportDrawing){.of = picture, *camera, width, height, .since = now};
  } else {
    g_warning("%s", error->message);
    fit(picture, width, height); /* it is not tried again before something changes */
    picture->camera = *camera;
  }
}

static void take(SporeViewport *self) {
  SporeViewportDrawing drawn = self->drawing;
  g_autoptr(GError) error = NULL;
  spore_viewport_drop_drawing(self);
  fit(drawn.of, drawn.width, drawn.height);
  cairo_surface_t *pixels = drawn.of->pixels;
  cairo_surface_flush(pixels);
  if (!spore_renderer_read(self->renderer, cairo_image_surface_get_data(pixels),
                           (gsize)cairo_image_surface_get_stride(pixels), &error))
    g_warning("%s", error->message);
  cairo_surface_mark_dirty(pixels);
  drawn.of->camera = drawn.camera;
  if (drawn.of == &self->picture) self->draw_ms = (double)(g_get_monotonic_time() - drawn.since) / 1000;
}

/* Both views are shown anew: the other one may have waited for its turn. */
static gboolean look(gpointer data) {
  SporeViewport *self = data;
  if (!spore_renderer_is_drawn(self->renderer, 0)) return G_SOURCE_CONTINUE;
  self->drawing.look = 0; /* it ends by what is returned */
  take(self);
  gtk_widget_queue_draw(self->area);
  if (self->second_on) gtk_widget_queue_draw(self->second_area);
  return G_SOURCE_REMOVE;
}

static void draw(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera, int width, int height) {
  begin(self, picture, camera, width, height);
  if (!self->drawing.of) return;
  if (spore_renderer_is_drawn(self->renderer, PATIENCE_MS)) take(self);
  else self->drawing.look = g_timeout_add(LOOK_MS, look, self);
}

void spore_viewport_paint(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera,
                          GtkWidget *area, cairo_t *cr) {
  int scale = gtk_widget_get_scale_factor(area);
  int width = gtk_widget_get_allocated_width(area) * scale, height = gtk_widget_get_allocated_height(area) * scale;
  picture->stale |= !is_of_size(picture, width, height);
  if (picture->stale && !self->drawing.of) draw(self, picture, camera, width, height);
  spore_viewport_tell_drawing(self);
  if (!picture->pixels) return;
  cairo_save(cr);
  cairo_scale(cr, 1.0 / scale, 1.0 / scale);
  cairo_set_source_surface(cr, picture->pixels, 0, 0);
  cairo_set_operator(cr, CAIRO_OPERATOR_SOURCE);
  cairo_paint(cr);
  cairo_restore(cr);
}

/* The second view. */

gboolean spore_viewport_draw_second(GtkWidget *area, cairo_t *cr, SporeViewport *self) {
  SporeCamera camera;
  double aspect = (double)gtk_widget_get_allocated_width(area) / MAX(gtk_widget_get_allocated_height(area), 1);
  if (self->renderer && spore_viewport_other_camera(self, aspect, &camera))
    spore_viewport_paint(self, &self->second_picture, &camera, area, cr);
  return FALSE;
}

void spore_viewport_size_second(SporeViewport *self) {
  int width = (int)(SHARE_OF_WIDTH * gtk_widget_get_allocated_width(self->area));
  width = CLAMP(width, LEAST_WIDTH, MOST_WIDTH);
  gtk_widget_set_size_request(self->second_area, width, (int)(width / ASPECT));
}

void spore_viewport_set_second_view(SporeViewport *self, gboolean on) {
  self->second_on = on;
  spore_viewport_redraw(self);
}

void spore_viewport_set_habits(SporeViewport *self, const SporeViewportHabits *habits) {
  gboolean other = self->habits.pictures != habits->pictures;
  self->habits = *habits;
  if (other) spore_viewport_redraw(self);
}
