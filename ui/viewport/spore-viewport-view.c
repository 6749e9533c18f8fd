/* What the viewport looks at: the camera, the candidate, and the welcome of an empty scene. */
#include <glib/gi18n.h>
#include <math.h>

#include "ui/panels/report.h"
#include "ui/render/legend.h"
#include "ui/viewport/spore-viewport-private.h"

#define FIELD_OF_VIEW_RAD 0.61
/* An empty scene shows about a hand's breadth. */
#define EMPTY_DISTANCE_M 0.4
/* Of the welcome, pixels. */
#define WELCOME_PADDING 72 /* on both sides, of the style */
#define WELCOME_WORDS 170  /* height without the pictures */
#define HANDLE_PIXELS 6.0  /* radius as drawn */
#define CROSS_PIXELS 9.0   /* arm of the cross in the middle while something is picked */
#define REACH_PIXELS 11.0  /* distance from a handle within which a click meets it */

/* What the views show, where both are shown. */
static void name_views(SporeViewport *self) {
  SporeCamera camera;
  gboolean shown = self->second_on && spore_viewport_other_camera(self, 1, &camera);
  gtk_widget_set_visible(self->second, shown);
  gtk_widget_set_visible(self->large_name, shown);
  if (!shown) return;
  const char *scene = spore_object_name(spore_viewport_scene_camera(self));
  g_autofree char *large = self->through ? g_strdup_printf(_("The mouse works in: %s"), scene)
                                         : g_strdup(_("The mouse works in the view from outside"));
  gtk_label_set_text(GTK_LABEL(self->large_name), large);
  const char *small = self->through ? _("From outside") : scene;
  g_autofree char *second = g_strdup_printf(_("Second view: %s"), small);
  gtk_label_set_text(GTK_LABEL(self->second_name), small);
  atk_object_set_name(gtk_widget_get_accessible(self->second), second);
}

void spore_viewport_tell_drawing(SporeViewport *self) {
  /* A run shows coarse pictures as long as it goes on. */
  gboolean rests = !self->player || !spore_player_is_playing(self->player);
  gboolean second = gtk_widget_get_mapped(self->second_area) &&
                    (self->second_picture.stale || (rests && self->second_picture.coarse));
  gboolean large = self->picture.stale || (rests && self->picture.coarse);
  gboolean late = self->rebuild || large || second || self->drawing.of;
  gboolean drawing = self->graphics || (self->renderer && late);
  if (drawing == self->told_drawing) return;
  self->told_drawing = drawing;
  atk_object_set_description(gtk_widget_get_accessible(self->area), drawing ? _("The picture is being drawn") : "");
}

void spore_viewport_redraw(SporeViewport *self) {
  self->picture.stale = self->second_picture.stale = TRUE;
  gtk_widget_queue_draw(self->area);
  if (self->second_on || gtk_widget_get_visible(self->second)) name_views(self);
  if (self->second_on) gtk_widget_queue_draw(self->second_area);
  spore_viewport_tell_drawing(self);
}

gboolean spore_viewport_has_anything(SporeViewport *self) {
  if (self->candidate && !self->candidate->body) return TRUE;
  return self->document &&
         spore_object_child_count(spore_document_section(spore_editor_document_get(self->document), "bodies")) > 0;
}

void spore_viewport_show_welcome(SporeViewport *self) {
  gtk_widget_set_visible(self->welcome, !self->waiting && !spore_viewport_has_anything(self) &&
                                            !gtk_widget_get_visible(self->failure));
}

void spore_viewport_set_templates(SporeViewport *self, GMenuModel *templates, GtkWidget *pictures) {
  gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(self->template_button), templates);
  gtk_widget_set_halign(pictures, GTK_ALIGN_CENTER);
  gtk_container_add(GTK_CONTAINER(self->welcome), pictures);
  gtk_widget_get_preferred_size(pictures, NULL, &self->pictures_size);
  self->pictures = pictures;
}

void spore_viewport_set_recent(SporeViewport *self, GMenuModel *recent) {
  if (!gtk_menu_button_get_menu_model(GTK_MENU_BUTTON(self->recent_button)))
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(self->recent_button), recent);
  gtk_widget_set_visible(self->recent_button, g_menu_model_get_n_items(recent) > 0);
}

void spore_viewport_fit_welcome(SporeViewport *self, int top) {
  int width = gtk_widget_get_allocated_width(self->area), height = gtk_widget_get_allocated_height(self->area);
  spore_box_fit(GTK_BOX(self->beginnings), width - WELCOME_PADDING);
  if (!self->pictures) return;
  gboolean room = self->pictures_size.width + WELCOME_PADDING <= width &&
                  self->pictures_size.height + WELCOME_WORDS + top <= height;
  gtk_widget_set_visible(self->pictures, room);
  gtk_widget_set_margin_top(self->welcome, room ? top : 0);
}

gboolean spore_viewport_is_locked(SporeViewport *self) {
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  for (guint i = 0; i < bodies->len; i++)
    if (g_hash_table_contains(self->locked, GUINT_TO_POINTER(spore_object_id(bodies->pdata[i])))) return TRUE;
  return FALSE;
}

/* The camera. */

SporeCamera spore_viewport_beginning(void) {
  return (SporeCamera){
      .distance = EMPTY_DISTANCE_M, .azimuth = 0.5, .elevation = 0.35, .field_of_view = FIELD_OF_VIEW_RAD};
}

static double aspect_of(SporeViewport *self) {
  return (double)gtk_widget_get_allocated_width(self->area) / MAX(gtk_widget_get_allocated_height(self->area), 1);
}

SporeObject *spore_viewport_scene_camera(SporeViewport *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *selected = spore_editor_document_selected(self->document);
  if (selected && g_str_equal(spore_object_type(selected)->element, "camera")) return selected;
  if (self->through) return spore_document_by_id(document, self->through);
  return spore_object_child_of(spore_document_section(document, "tools"), "camera");
}

void spore_viewport_follow_camera(SporeViewport *self) {
  const SporeObject *camera =
      self->through ? spore_document_by_id(spore_editor_document_get(self->document), self->through) : NULL;
  if (!camera) self->through = 0;
  else if (self->stage)
    spore_stage_camera(self->stage, spore_object_name(camera), aspect_of(self), &self->camera, NULL);
}

/* Looks through the scene's camera, where there is one. */
static void look_through_camera(SporeViewport *self) {
  if (!self->stage || !spore_viewport_has_anything(self)) return;
  const SporeObject *camera = spore_viewport_scene_camera(self);
  const char *name = camera ? spore_object_name(camera) : NULL;
  gboolean keeps = self->strayed && self->has_outside;
  if (camera && self->framed && !self->through && !keeps) self->outside = self->camera, self->has_outside = TRUE;
  spore_stage_camera(self->stage, name, aspect_of(self), &self->camera, NULL);
  self->framed = TRUE;
  self->strayed = FALSE;
  self->through = camera ? spore_object_id(camera) : 0;
}

/* Where the view was outside, else where all of the scene is seen. */
static SporeCamera outside_camera(SporeViewport *self, double aspect) {
  double lower[3], upper[3];
  SporeCamera camera = spore_viewport_beginning();
  if (self->has_outside) return self->outside;
  spore_stage_bounds(self->stage, lower, upper);
  spore_camera_frame(&camera, lower, upper, aspect);
  self->outside = camera, self->has_outside = TRUE; /* it stays there, whatever moves */
  return camera;
}

gboolean spore_viewport_other_camera(SporeViewport *self, double aspect, SporeCamera *camera) {
  const SporeObject *of_scene = self->document ? spore_viewport_scene_camera(self) : NULL;
  if (!self->stage || !of_scene || !spore_viewport_has_anything(self)) return FALSE;
  if (self->through) *camera = outside_camera(self, aspect);
  else spore_stage_camera(self->stage, spore_object_name(of_scene), aspect, camera, NULL);
  return TRUE;
}

void spore_viewport_swap_views(SporeViewport *self) {
  SporeCamera outside;
  if (!self->through) {
    look_through_camera(self);
  } else if (spore_viewport_other_camera(self, aspect_of(self), &outside)) {
    spore_viewport_leave_scene_camera(self);
    self->camera = outside;
    self->strayed = FALSE;
  }
  spore_viewport_redraw(self);
}

void spore_viewport_look_afresh(SporeViewport *self) {
  if (!spore_viewport_has_anything(self)) self->framed = FALSE;
  else if (!self->framed) look_through_camera(self);
}

void spore_viewport_leave_scene_camera(SporeViewport *self) {
  if (self->through) self->strayed = TRUE;
  self->through = 0;
  self->camera.roll = self->camera.distortion = self->camera.blood = self->camera.water = self->camera.haze = 0;
}

void spore_viewport_frame(SporeViewport *self) {
  if (!self->stage || !spore_viewport_has_anything(self)) return;
  double lower[3], upper[3];
  spore_stage_bounds(self->stage, lower, upper);
  if (!(lower[0] <= upper[0])) return;
  spore_viewport_leave_scene_camera(self);
  spore_camera_frame(&self->camera, lower, upper, aspect_of(self));
  self->strayed = FALSE;
  self->framed = TRUE;
  spore_viewport_redraw(self);
}

void spore_viewport_view(SporeViewport *self, const char *view) {
  if (g_str_equal(view, "camera")) {
    look_through_camera(self);
    spore_viewport_redraw(self);
    return;
  }
  static const struct {
    const char *view;
    double azimuth, elevation; /* rad */
  } views[] = {{"front", 0, 0},      {"back", G_PI, 0},         {"right", G_PI_2, 0},
               {"left", -G_PI_2, 0}, {"top", 0, 0.99 * G_PI_2}, {"bottom", 0, -0.99 * G_PI_2}};
  spore_viewport_leave_scene_camera(self);
  self->strayed = FALSE;
  for (gsize i = 0; i < G_N_ELEMENTS(views); i++)
    if (g_str_equal(views[i].view, view))
      self->camera.azimuth = views[i].azimuth, self->camera.elevation = views[i].elevation;
  spore_viewport_redraw(self);
}

/* Handles. */

SporeVec3 spore_viewport_under_cursor(SporeViewport *self, SporeVec3 through) {
  return spore_camera_unproject(&self->camera, through, self->last_x, self->last_y,
                                gtk_widget_get_allocated_width(self->area),
                                gtk_widget_get_allocated_height(self->area));
}

gboolean spore_viewport_project(SporeViewport *self, SporeVec3 place, double *x, double *y) {
  return spore_camera_project(&self->camera, place, gtk_widget_get_allocated_width(self->area),
                              gtk_widget_get_allocated_height(self->area), x, y);
}

gboolean spore_viewport_handle_is_at(SporeViewport *self, SporeVec3 handle, double x, double y) {
  double at_x, at_y;
  return spore_viewport_project(self, handle, &at_x, &at_y) && hypot(at_x - x, at_y - y) <= REACH_PIXELS;
}

void spore_viewport_draw_handle(SporeViewport *self, cairo_t *cr, SporeVec3 handle, gboolean filled) {
  double x, y;
  if (!spore_viewport_project(self, handle, &x, &y)) return;
  cairo_new_path(cr);
  cairo_arc(cr, x, y, HANDLE_PIXELS, 0, 2 * G_PI);
  if (filled) cairo_set_source_rgb(cr, 1, 0.85, 0.3);
  else cairo_set_source_rgba(cr, 1, 1, 1, 0.75);
  cairo_fill_preserve(cr);
  cairo_set_source_rgb(cr, 0.1, 0.1, 0.1);
  cairo_set_line_width(cr, 1.5);
  cairo_stroke(cr);
}

void spore_viewport_draw_text(SporeViewport *self, cairo_t *cr, const char *text, double x, double y) {
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(self->area, text);
  cairo_move_to(cr, x, y);
  pango_cairo_layout_path(cr, layout);
  cairo_set_source_rgb(cr, 0.1, 0.1, 0.1);
  cairo_set_line_width(cr, 3);
  cairo_stroke_preserve(cr);
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_fill(cr);
}

void spore_viewport_stroke(cairo_t *cr, const double colour[4], double width) {
  cairo_set_source_rgba(cr, 0, 0, 0, 0.5 * colour[3]);
  cairo_set_line_width(cr, width + 2.5);
  cairo_stroke_preserve(cr);
  cairo_set_source_rgba(cr, colour[0], colour[1], colour[2], colour[3]);
  cairo_set_line_width(cr, width);
  cairo_stroke(cr);
}

void spore_viewport_set_ground(SporeViewport *self, cairo_t *cr) {
  const double *ground = spore_legend_ground[self->light ? 1 : 0];
  cairo_set_source_rgba(cr, ground[0], ground[1], ground[2], ground[3]);
}

void spore_viewport_set_letters(SporeViewport *self, cairo_t *cr) {
  const double *letters = spore_legend_letters[self->light ? 1 : 0];
  cairo_set_source_rgb(cr, letters[0], letters[1], letters[2]);
}

void spore_viewport_draw_cross(SporeViewport *self, cairo_t *cr) {
  double x = 0.5 * gtk_widget_get_allocated_width(self->area), y = 0.5 * gtk_widget_get_allocated_height(self->area);
  cairo_new_path(cr);
  cairo_move_to(cr, x - CROSS_PIXELS, y);
  cairo_line_to(cr, x + CROSS_PIXELS, y);
  cairo_move_to(cr, x, y - CROSS_PIXELS);
  cairo_line_to(cr, x, y + CROSS_PIXELS);
  spore_viewport_stroke(cr, (const double[4]){1, 1, 1, 1}, 2);
}

/* The candidate. */

void spore_viewport_clear_legend(SporeViewport *self) {
  g_clear_pointer(&self->legend, g_free);
  g_clear_pointer(&self->legend_high, g_free);
}

void spore_viewport_set_candidate(SporeViewport *self, SporeStageCandidate *candidate, const SporeQuality *legend) {
  if (!candidate && !self->candidate) return;
  if (self->stage) spore_stage_set_candidate(self->stage, candidate);
  spore_stage_candidate_free(self->candidate);
  self->candidate = candidate;
  if (!spore_viewport_has_anything(self)) self->framed = FALSE;
  spore_viewport_show_welcome(self);
  spore_viewport_clear_legend(self);
  if (candidate && legend->count && !legend->names) {
    self->legend = g_strdup(legend->label);
    self->legend_high = spore_quality_figure(legend, legend->high);
  }
  spore_viewport_redraw(self);
}
