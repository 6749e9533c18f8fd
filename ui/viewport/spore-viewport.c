#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/region_edits.h"
#include "ui/document/labels.h"
#include "ui/panels/report.h"
#include "ui/render/colour_scale.h"
#include "ui/viewport/camera-moves.h"
#include "ui/viewport/spore-viewport-private.h"

#define HUD_INTERVAL_US (G_USEC_PER_SEC / 10)
#define FIELD_OF_VIEW_RAD 0.61
/* An empty scene shows about a hand's breadth. */
#define EMPTY_DISTANCE_M 0.4
#define MOST_LEVELS 4      /* bodies in the corner */
#define WELCOME_PADDING 72 /* on both sides, of the style */
#define LEGEND_WIDTH 200
#define LEGEND_MARGIN 22
#define LEGEND_HEIGHT 48
#define ARROW_PIXELS_A_NEWTON 40.0
#define ARROW_LONGEST_PIXELS 160.0

G_DEFINE_FINAL_TYPE(SporeViewport, spore_viewport, GTK_TYPE_OVERLAY)

enum { PICKED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

void spore_viewport_redraw(SporeViewport *self) {
  self->stale = TRUE;
  gtk_widget_queue_draw(self->area);
}

/* Drawing. */

/* Where GL is missing the label says why, and the rest of the editor works. */
static gboolean ensure_renderer(SporeViewport *self) {
  if (self->renderer) return TRUE;
  if (self->renderer_name) return FALSE;
  g_autoptr(GError) error = NULL;
  self->offscreen = spore_offscreen_new(&error);
  if (self->offscreen) self->renderer = spore_renderer_new(self->offscreen, &error);
  if (self->renderer) {
    self->renderer_name = g_strdup(spore_offscreen_renderer(self->offscreen));
  } else {
    g_clear_pointer(&self->offscreen, spore_offscreen_free);
    self->renderer_name = g_strdup(_("no 3D graphics"));
    g_autofree char *text =
        g_strdup_printf(_("The scene cannot be drawn on this machine: %s\n\nEverything else works."), error->message);
    gtk_label_set_text(GTK_LABEL(self->failure), text);
    gtk_widget_show(self->failure);
  }
  return self->renderer != NULL;
}

static gboolean has_anything(SporeViewport *self) {
  if (self->candidate && !self->candidate->body) return TRUE;
  return self->document &&
         spore_object_child_count(spore_document_section(spore_editor_document_get(self->document), "bodies")) > 0;
}

static const SporeSimulation *simulation_of(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  return session ? spore_session_simulation(session) : NULL;
}

static double aspect_of(SporeViewport *self) {
  return (double)gtk_widget_get_allocated_width(self->area) / MAX(gtk_widget_get_allocated_height(self->area), 1);
}

/* Goes where the scene's camera goes, as long as there is one. */
static void follow_camera(SporeViewport *self) {
  self->through = self->through && self->stage && spore_stage_has_camera(self->stage);
  if (self->through) spore_stage_camera(self->stage, NULL, aspect_of(self), &self->camera, NULL);
}

static void update_stage(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  if (self->stage && session) {
    const SporeSnapshot *snapshot = spore_session_snapshot(session);
    spore_stage_update(self->stage, snapshot);
    self->shown_step = snapshot->step;
  }
  follow_camera(self);
  spore_viewport_redraw(self);
}

static void show_welcome(SporeViewport *self) {
  gtk_widget_set_visible(self->welcome,
                         !self->waiting && !has_anything(self) && !gtk_widget_get_visible(self->failure));
}

/* As the author's camera looks, where the scene has one. */
static void look_through_camera(SporeViewport *self) {
  if (!self->stage || !has_anything(self)) return;
  spore_stage_camera(self->stage, NULL, aspect_of(self), &self->camera, NULL);
  self->framed = TRUE;
  self->through = spore_stage_has_camera(self->stage);
}

/* What comes where nothing was to be seen is looked at whole. */
static void look_afresh(SporeViewport *self) {
  if (!has_anything(self)) self->framed = FALSE;
  else if (!self->framed) look_through_camera(self);
}

void spore_viewport_leave_scene_camera(SporeViewport *self) {
  self->through = FALSE;
  self->camera.roll = 0;
}

static gboolean rebuild(gpointer data) {
  SporeViewport *self = data;
  self->rebuild = 0;
  show_welcome(self);
  if (!self->stage) return G_SOURCE_REMOVE;
  spore_stage_rebuild(self->stage, simulation_of(self));
  spore_stage_set_options(self->stage, &self->options);
  spore_stage_set_selection(self->stage, spore_editor_document_get_selection(self->document));
  look_afresh(self);
  spore_viewport_edit_refresh(self);
  update_stage(self);
  return G_SOURCE_REMOVE;
}

/* After the panels, in a pass of its own, and before anything is drawn. */
static void queue_rebuild(SporeViewport *self) {
  if (!self->rebuild) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE + 5, rebuild, self, NULL);
}

static void ensure_stage(SporeViewport *self) {
  if (self->stage || !self->document || !ensure_renderer(self)) return;
  self->stage = spore_stage_new(self->renderer, spore_editor_document_get(self->document));
  g_clear_handle_id(&self->rebuild, g_source_remove);
  spore_stage_set_candidate(self->stage, self->candidate);
  spore_stage_set_marks(self->stage, &self->marks);
  rebuild(self);
}

static void render(SporeViewport *self, int width, int height) {
  if (!self->pixels || cairo_image_surface_get_width(self->pixels) != width ||
      cairo_image_surface_get_height(self->pixels) != height) {
    g_clear_pointer(&self->pixels, cairo_surface_destroy);
    self->pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    self->stale = TRUE;
  }
  if (!self->stale) return;
  SporeRenderOptions options = {width, height, .grid = TRUE,
                                .antialias = !spore_offscreen_is_software(self->offscreen)};
  g_autoptr(GError) error = NULL;
  gint64 start = g_get_monotonic_time();
  cairo_surface_flush(self->pixels);
  if (!spore_renderer_draw(self->renderer, &self->camera, &options, cairo_image_surface_get_data(self->pixels),
                           (gsize)cairo_image_surface_get_stride(self->pixels), &error))
    g_warning("%s", error->message);
  cairo_surface_mark_dirty(self->pixels);
  self->draw_ms = (double)(g_get_monotonic_time() - start) / 1000;
  self->stale = FALSE;
}

static gboolean probe_force(SporeViewport *self, SporeVec3 *tip, SporeVec3 *force) {
  guint32 body;
  if (!spore_viewport_probe(self, &body, tip)) return FALSE;
  *force = spore_vec3_load(spore_session_snapshot(spore_player_get_session(self->player))->reaction + 6 * body);
  return TRUE;
}

static void draw_arrow(cairo_t *cr, double x, double y, double dx, double dy) {
  double length = hypot(dx, dy);
  if (length < 3) return;
  double ux = dx / length, uy = dy / length;
  cairo_move_to(cr, x, y);
  cairo_line_to(cr, x + dx, y + dy);
  cairo_stroke(cr);
  cairo_move_to(cr, x + dx + 7 * ux, y + dy + 7 * uy);
  cairo_line_to(cr, x + dx - 5 * uy, y + dy + 5 * ux);
  cairo_line_to(cr, x + dx + 5 * uy, y + dy - 5 * ux);
  cairo_fill(cr);
}

/* Reaction force at the probe's tip, along its direction on the screen. */
static void draw_force(SporeViewport *self, cairo_t *cr, int width, int height) {
  SporeVec3 tip, force, eye, right, up, forward;
  double x, y;
  if (!probe_force(self, &tip, &force) || !spore_camera_project(&self->camera, tip, width, height, &x, &y)) return;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  double newtons = spore_vec3_length(force);
  double scale = ARROW_PIXELS_A_NEWTON * fmin(1, ARROW_LONGEST_PIXELS / fmax(newtons * ARROW_PIXELS_A_NEWTON, 1e-9));
  cairo_set_source_rgb(cr, 1, 0.78, 0.25);
  cairo_set_line_width(cr, 3);
  draw_arrow(cr, x, y, spore_vec3_dot(force, right) * scale, -spore_vec3_dot(force, up) * scale);
}

static void draw_pull(SporeViewport *self, cairo_t *cr, int width, int height) {
  double x0, y0, x1, y1;
  if (self->drag != DRAG_PULL || !spore_camera_project(&self->camera, self->start, width, height, &x0, &y0) ||
      !spore_camera_project(&self->camera, self->cursor, width, height, &x1, &y1))
    return;
  cairo_set_source_rgb(cr, 0.45, 0.8, 1);
  cairo_set_line_width(cr, 2);
  draw_arrow(cr, x0, y0, x1 - x0, y1 - y0);
}

/* A bar of the scale's colours with its ends, at the lower right. */
static void draw_legend(SporeViewport *self, cairo_t *cr, int width, int height, const char *label, const char *high) {
  const double bar = LEGEND_WIDTH, left = width - bar - LEGEND_MARGIN, top = height - LEGEND_HEIGHT;
  if (width < bar + 2 * LEGEND_MARGIN) return;
  cairo_set_source_rgba(cr, 0.04, 0.05, 0.055, 0.62);
  cairo_rectangle(cr, left - 10, top - 26, bar + 20, LEGEND_HEIGHT + 14);
  cairo_fill(cr);
  for (int i = 0; i < bar; i++) {
    double colour[3];
    spore_colour_scale(i / bar, colour);
    cairo_set_source_rgb(cr, colour[0], colour[1], colour[2]);
    cairo_rectangle(cr, left + i, top, 1, 10);
    cairo_fill(cr);
  }
  const struct {
    const char *text;
    double y, align;
  } lines[] = {{label, top - 21, 0}, {"0", top + 13, 0}, {high, top + 13, 1}};
  cairo_set_source_rgb(cr, 0.91, 0.92, 0.93);
  for (gsize i = 0; i < G_N_ELEMENTS(lines); i++) {
    int wide;
    g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(self->area, lines[i].text);
    pango_layout_get_pixel_size(layout, &wide, NULL);
    cairo_move_to(cr, left + lines[i].align * (bar - wide), lines[i].y);
    pango_cairo_show_layout(cr, layout);
  }
}

/* Of the candidate's colours, else of those of the spheres that the bodies have. */
static void draw_legends(SporeViewport *self, cairo_t *cr, int width, int height) {
  SporeSphereScale scale = self->stage ? spore_stage_sphere_scale(self->stage) : (SporeSphereScale){0};
  if (self->legend) {
    draw_legend(self, cr, width, height, self->legend, self->legend_high);
  } else if (scale.share > 0) {
    g_autofree char *high = scale.high > 0 ? g_strdup_printf("%.3g mm", 1e3 * scale.high)
                                           : g_strdup_printf(_("%g %% of the diagonal"), 100 * scale.share);
    draw_legend(self, cr, width, height, _("Depth error"), high);
  }
}

static gboolean draw_area(GtkWidget *area, cairo_t *cr, SporeViewport *self) {
  int width = gtk_widget_get_allocated_width(area), height = gtk_widget_get_allocated_height(area);
  int scale = gtk_widget_get_scale_factor(area);
  ensure_stage(self);
  if (!self->renderer) return FALSE;
  render(self, width * scale, height * scale);
  cairo_save(cr);
  cairo_scale(cr, 1.0 / scale, 1.0 / scale);
  cairo_set_source_surface(cr, self->pixels, 0, 0);
  cairo_set_operator(cr, CAIRO_OPERATOR_SOURCE);
  cairo_paint(cr);
  cairo_restore(cr);
  draw_force(self, cr, width, height);
  draw_pull(self, cr, width, height);
  draw_legends(self, cr, width, height);
  spore_viewport_edit_draw(self, cr);
  return FALSE;
}

/* What is shown is chosen beside the tools, or below them where there is no room. */
static gboolean place_overlays(gpointer data) {
  g_autoptr(SporeViewport) self = data;
  int tools, overlays, height, margin = gtk_widget_get_margin_start(self->tools);
  gtk_widget_get_preferred_width(self->tools, NULL, &tools);
  gtk_widget_get_preferred_width(self->overlays, NULL, &overlays);
  gtk_widget_get_preferred_height(self->tools, NULL, &height);
  gboolean room = tools + overlays + margin <= gtk_widget_get_allocated_width(self->area);
  gtk_widget_set_margin_top(self->overlays, room ? margin : height - margin / 2); /* its margins are in it */
  spore_box_fit(GTK_BOX(self->beginnings), gtk_widget_get_allocated_width(self->area) - WELCOME_PADDING);
  return G_SOURCE_REMOVE;
}

static void size_changed(GtkWidget *area, GdkRectangle *allocation, SporeViewport *self) {
  follow_camera(self);
  self->stale = TRUE;
  g_idle_add(place_overlays, g_object_ref(self));
}

/* Following the simulation. */

/* What scissors and needles have done. */
static void append_tools(GString *text, const SporeSnapshot *snapshot) {
  const SporeToolCounts *tools = &snapshot->tools;
  if (tools->cut > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Cut %zu"), tools->cut);
  }
  if (tools->pierced > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Pierced %zu, stitches %zu"), tools->pierced, tools->stitches);
  }
}

/* The level of each body that has several, a line each. */
static void append_levels(GString *text, const SporeWorld *world, const SporeSnapshot *snapshot) {
  guint32 count = snapshot->level ? (guint32)spore_world_body_count(world) : 0;
  for (guint32 body = 0, shown = 0; body < count && shown < MOST_LEVELS; body++) {
    SporeLevelState state;
    if (!spore_world_level_state(world, body, &state)) continue;
    g_autofree char *level = spore_label_of_name(spore_level_names[snapshot->level[body]]);
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("%s: %s"), spore_world_body_name(world, body), _(level));
    shown++;
  }
}

static void update_hud(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  gtk_widget_set_visible(self->hud, session != NULL);
  if (!session) return;
  const SporeSnapshot *snapshot = spore_session_snapshot(session);
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("Time %.3f s"), snapshot->time_s);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Step %.2f ms"), snapshot->step_us / 1000);
  double factor = spore_session_real_time_factor(session);
  if (factor > 0) {
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("%.2f × real time"), factor);
  }
  guint64 late, steps;
  spore_session_late_steps(session, &late, &steps);
  if (late > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Late steps %.1f %%"), 100 * (double)late / (double)steps);
  }
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Contacts %zu"), snapshot->contact_count);
  if (snapshot->counts.sleeping > 0) {
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("Asleep %zu"), snapshot->counts.sleeping);
  }
  append_tools(text, snapshot);
  append_levels(text, spore_session_simulation(session)->world, snapshot);
  SporeVec3 tip, force;
  if (probe_force(self, &tip, &force)) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Probe force %.3f N"), spore_vec3_length(force));
  }
  gtk_label_set_text(GTK_LABEL(self->hud), text->str);
  g_string_free(text, TRUE);
}

static gboolean tick(GtkWidget *widget, GdkFrameClock *clock, gpointer data) {
  SporeViewport *self = SPORE_VIEWPORT(widget);
  if (!spore_player_is_playing(self->player)) {
    self->tick = 0;
    return G_SOURCE_REMOVE;
  }
  if (spore_session_snapshot(spore_player_get_session(self->player))->step != self->shown_step) update_stage(self);
  gint64 now = gdk_frame_clock_get_frame_time(clock);
  if (now - self->hud_clock >= HUD_INTERVAL_US) {
    self->hud_clock = now;
    update_hud(self);
  }
  return G_SOURCE_CONTINUE;
}

static void player_changed(SporeViewport *self) {
  if (spore_player_is_playing(self->player) && !self->tick)
    self->tick = gtk_widget_add_tick_callback(GTK_WIDGET(self), tick, NULL, NULL);
  update_stage(self);
  update_hud(self);
}

/* The world that a drag holds is gone. */
static void player_replaced(SporeViewport *self) {
  self->drag = DRAG_NONE;
  queue_rebuild(self);
}

static void selection_changed(SporeViewport *self) {
  if (self->stage) spore_stage_set_selection(self->stage, spore_editor_document_get_selection(self->document));
  self->regions = 0;
  spore_viewport_edit_refresh(self);
  spore_viewport_redraw(self);
}

static void document_changed(SporeViewport *self, int kind, guint id, guint property) {
  SporeObject *object = spore_document_by_id(spore_editor_document_get(self->document), id);
  /* Regions only show where something is: the bodies look as before. */
  if (object && spore_region_is(object)) spore_viewport_edit_refresh(self);
  else queue_rebuild(self);
}

/* Life. */

static void release_document(SporeViewport *self) {
  if (self->document) spore_viewport_edit_end(self);
  g_clear_handle_id(&self->rebuild, g_source_remove);
  g_clear_pointer(&self->stage, spore_stage_free);
  if (self->renderer) spore_renderer_clear(self->renderer);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  if (self->player) g_signal_handlers_disconnect_by_data(self->player, self);
  g_clear_object(&self->document);
  g_clear_object(&self->player);
}

void spore_viewport_set_document(SporeViewport *self, SporeEditorDocument *document, SporePlayer *player) {
  spore_viewport_end_drag(self);
  release_document(self);
  self->document = g_object_ref(document);
  self->player = g_object_ref(player);
  self->framed = FALSE;
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(selection_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "state-changed", G_CALLBACK(player_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "replaced", G_CALLBACK(player_replaced), self, G_CONNECT_SWAPPED);
  if (self->renderer) ensure_stage(self);
  queue_rebuild(self);
  gtk_widget_grab_focus(self->area);
  update_hud(self);
  spore_viewport_redraw(self);
}

void spore_viewport_set_waiting(SporeViewport *self, gboolean waiting) {
  self->waiting = waiting;
  show_welcome(self);
}

void spore_viewport_set_picking(SporeViewport *self, gboolean picking) {
  spore_viewport_end_drag(self);
  self->picking = picking;
}

void spore_viewport_picked(SporeViewport *self, guint32 body, SporeVec3 place) {
  g_signal_emit(self, signals[PICKED], 0, body, &place);
}

void spore_viewport_set_tool(SporeViewport *self, SporeTool tool) {
  spore_viewport_end_drag(self);
  spore_viewport_edit_end(self);
  self->tool = tool;
  self->regions = 0;
  spore_viewport_edit_refresh(self);
  spore_viewport_redraw(self);
}

void spore_viewport_set_options(SporeViewport *self, const SporeStageOptions *options) {
  self->options = *options;
  if (self->stage) spore_stage_set_options(self->stage, options);
  update_stage(self);
}

static void clear_legend(SporeViewport *self) {
  g_clear_pointer(&self->legend, g_free);
  g_clear_pointer(&self->legend_high, g_free);
}

void spore_viewport_set_candidate(SporeViewport *self, SporeStageCandidate *candidate, const SporeQuality *legend) {
  if (!candidate && !self->candidate) return;
  if (self->stage) spore_stage_set_candidate(self->stage, candidate);
  spore_stage_candidate_free(self->candidate);
  self->candidate = candidate;
  if (!has_anything(self)) self->framed = FALSE;
  show_welcome(self);
  clear_legend(self);
  if (candidate && legend->count && !legend->names) {
    self->legend = g_strdup(legend->label);
    self->legend_high = spore_quality_figure(legend, legend->high);
  }
  spore_viewport_redraw(self);
}

void spore_viewport_set_marks(SporeViewport *self, SporeStageMarks marks) {
  if (!marks.count && !self->marks.count) {
    g_free(marks.segments);
    return;
  }
  g_free(self->marks.segments);
  self->marks = marks;
  if (self->stage) spore_stage_set_marks(self->stage, &self->marks);
  update_stage(self);
}

void spore_viewport_frame(SporeViewport *self) {
  if (!self->stage || !has_anything(self)) return;
  double lower[3], upper[3];
  spore_stage_bounds(self->stage, lower, upper);
  if (!(lower[0] <= upper[0])) return;
  spore_viewport_leave_scene_camera(self);
  spore_camera_frame(&self->camera, lower, upper, aspect_of(self));
  self->framed = TRUE;
  spore_viewport_redraw(self);
}

void spore_viewport_frame_soon(SporeViewport *self) {
  self->framed = FALSE;
  queue_rebuild(self);
}

void spore_viewport_view(SporeViewport *self, const char *view) {
  if (g_str_equal(view, "camera")) {
    look_through_camera(self);
    spore_viewport_redraw(self);
    return;
  }
  gboolean right = g_str_equal(view, "right"), top = g_str_equal(view, "top");
  spore_viewport_leave_scene_camera(self);
  self->camera.azimuth = right ? G_PI_2 : 0;
  self->camera.elevation = top ? G_PI_2 * 0.99 : 0;
  spore_viewport_redraw(self);
}

double spore_viewport_get_draw_ms(SporeViewport *self) { return self->draw_ms; }

const char *spore_viewport_get_renderer(SporeViewport *self) {
  ensure_renderer(self);
  return self->renderer_name;
}

static void spore_viewport_dispose(GObject *object) {
  SporeViewport *self = SPORE_VIEWPORT(object);
  release_document(self);
  g_clear_pointer(&self->renderer, spore_renderer_free);
  g_clear_pointer(&self->offscreen, spore_offscreen_free);
  g_clear_pointer(&self->pixels, cairo_surface_destroy);
  g_clear_pointer(&self->renderer_name, g_free);
  g_clear_pointer(&self->candidate, spore_stage_candidate_free);
  g_clear_pointer(&self->marks.segments, g_free);
  clear_legend(self);
  G_OBJECT_CLASS(spore_viewport_parent_class)->dispose(object);
}

static void spore_viewport_class_init(SporeViewportClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_viewport_dispose;
  signals[PICKED] = g_signal_new("picked", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL,
                                 G_TYPE_NONE, 2, G_TYPE_UINT, G_TYPE_POINTER);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-viewport.ui");
  gtk_widget_class_bind_template_child(widget, SporeViewport, area);
  gtk_widget_class_bind_template_child(widget, SporeViewport, hud);
  gtk_widget_class_bind_template_child(widget, SporeViewport, tools);
  gtk_widget_class_bind_template_child(widget, SporeViewport, overlays);
  gtk_widget_class_bind_template_child(widget, SporeViewport, welcome);
  gtk_widget_class_bind_template_child(widget, SporeViewport, beginnings);
  gtk_widget_class_bind_template_child(widget, SporeViewport, failure);
  gtk_widget_class_bind_template_callback(widget, draw_area);
  gtk_widget_class_bind_template_callback(widget, size_changed);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_button_press);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_button_release);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_motion);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_scroll);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_key_press);
}

static void spore_viewport_init(SporeViewport *self) {
  self->options = (SporeStageOptions){.surfaces = TRUE};
  spore_hand_edit_close(&self->edit);
  self->camera = (SporeCamera){
      .distance = EMPTY_DISTANCE_M, .azimuth = 0.5, .elevation = 0.35, .field_of_view = FIELD_OF_VIEW_RAD};
  gtk_widget_init_template(GTK_WIDGET(self));
}
