/* Pictures of the stage: the large one, in which the mouse works, and the second view's. */
#include "ui/viewport/spore-viewport-private.h"

#define SHARE_OF_WIDTH 0.25 /* of the second view in the whole */
#define LEAST_WIDTH 200     /* pixels */
#define MOST_WIDTH 480
#define ASPECT (16.0 / 9)

static void fit(SporeViewportPicture *picture, int width, int height) {
  if (picture->pixels && cairo_image_surface_get_width(picture->pixels) == width &&
      cairo_image_surface_get_height(picture->pixels) == height)
    return;
  g_clear_pointer(&picture->pixels, cairo_surface_destroy);
  picture->pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  picture->stale = TRUE;
}

static void draw(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera) {
  cairo_surface_t *pixels = picture->pixels;
  SporeRenderOptions options = {cairo_image_surface_get_width(pixels), cairo_image_surface_get_height(pixels),
                                .grid = !self->presented, .antialias = !spore_offscreen_is_software(self->offscreen),
                                .clip = spore_viewport_clip(self)};
  g_autoptr(GError) error = NULL;
  cairo_surface_flush(pixels);
  if (!spore_renderer_draw(self->renderer, camera, &options, cairo_image_surface_get_data(pixels),
                           (gsize)cairo_image_surface_get_stride(pixels), &error))
    g_warning("%s", error->message);
  cairo_surface_mark_dirty(pixels);
  picture->stale = FALSE;
}

void spore_viewport_paint(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera,
                          GtkWidget *area, cairo_t *cr) {
  int scale = gtk_widget_get_scale_factor(area);
  fit(picture, gtk_widget_get_allocated_width(area) * scale, gtk_widget_get_allocated_height(area) * scale);
  if (picture->stale) draw(self, picture, camera);
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
