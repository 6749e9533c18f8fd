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
  return picture->pixels && picture->width == width && picture->height == height;
}

static int coarse_side(int side, int coarseness) { return (side + coarseness - 1) / coarseness; }

/* The picture has the pixels for an area of that size. */
static void fit(SporeViewportPicture *picture, int width, int height, int coarseness) {
  int across = coarse_side(width, coarseness), down = coarse_side(height, coarseness);
  picture->width = width, picture->height = height;
  if (picture->pixels && cairo_image_surface_get_width(picture->pixels) == across &&
      cairo_image_surface_get_height(picture->pixels) == down)
    return;
  g_clear_pointer(&picture->pixels, cairo_surface_destroy);
  picture->pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, across, down);
}

void spore_viewport_drop_drawing(SporeViewport *self) {
  g_clear_handle_id(&self->drawing.look, g_source_remove);
  self->drawing.of = NULL;
}

void spore_viewport_clear_picture(SporeViewportPicture *picture) {
  g_clear_handle_id(&picture->rest, g_source_remove);
  g_clear_pointer(&picture->pixels, cairo_surface_destroy);
}

/* What a coarse picture showed has come to rest. */
static gboolean sharpen(SporeViewport *self, SporeViewportPicture *picture, GtkWidget *area) {
  picture->rest = 0;
  spore_sharpness_rest(&picture->sharpness);
  picture->stale = TRUE;
  gtk_widget_queue_draw(area);
  return G_SOURCE_REMOVE;
}

static gboolean sharpen_large(gpointer data) {
  SporeViewport *self = data;
  return sharpen(self, &self->picture, self->area);
}

static gboolean sharpen_second(gpointer data) {
  SporeViewport *self = data;
  return sharpen(self, &self->second_picture, self->second_area);
}

/* A coarse picture is drawn again once it rests. */
static void mind_sharpness(SporeViewport *self, SporeViewportPicture *picture, gboolean coarse) {
  picture->coarse = coarse;
  if (!coarse) return;
  picture->rest = g_timeout_add((guint)(spore_sharpness_rest_us / 1000),
                                picture == &self->picture ? sharpen_large : sharpen_second, self);
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
                                .light = self->light,
                                .clip = spore_viewport_clip(self)};
  g_autoptr(GError) error = NULL;
  gint64 now = g_get_monotonic_time();
  int coarseness = options.coarse ? spore_sharpness_begin(&picture->sharpness, now) : 1;
  options.width = coarse_side(width, coarseness), options.height = coarse_side(height, coarseness);
  picture->stale = FALSE;
  g_clear_handle_id(&picture->rest, g_source_remove);
  if (spore_renderer_begin(self->renderer, camera, &options, &error)) {
    self->drawing = (SporeViewportDrawing){.of = picture, *camera, width, height, coarseness, .since = now};
  } else {
    g_warning("%s", error->message);
    fit(picture, width, height, coarseness); /* it is not tried again before something changes */
    picture->camera = *camera;
    picture->coarse = FALSE;
  }
}

static void take(SporeViewport *self) {
  SporeViewportDrawing drawn = self->drawing;
  g_autoptr(GError) error = NULL;
  spore_viewport_drop_drawing(self);
  fit(drawn.of, drawn.width, drawn.height, drawn.coarseness);
  cairo_surface_t *pixels = drawn.of->pixels;
  cairo_surface_flush(pixels);
  if (!spore_renderer_read(self->renderer, cairo_image_surface_get_data(pixels),
                           (gsize)cairo_image_surface_get_stride(pixels), &error))
    g_warning("%s", error->message);
  cairo_surface_mark_dirty(pixels);
  drawn.of->camera = drawn.camera;
  gint64 now = g_get_monotonic_time();
  spore_sharpness_drawn(&drawn.of->sharpness, now);
  mind_sharpness(self, drawn.of, drawn.coarseness > 1);
  if (drawn.of == &self->picture) self->draw_ms = (double)(now - drawn.since) / 1000;
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
  cairo_scale(cr, (double)picture->width / scale / cairo_image_surface_get_width(picture->pixels),
              (double)picture->height / scale / cairo_image_surface_get_height(picture->pixels));
  cairo_set_source_surface(cr, picture->pixels, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cr), picture->coarse ? CAIRO_FILTER_BILINEAR : CAIRO_FILTER_NEAREST);
  cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD); /* no dark edge around what is enlarged */
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
