/* The widget: it draws the stage, follows the document and the player, and passes gestures on. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/region_edits.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define HUD_INTERVAL_US (G_USEC_PER_SEC / 10)
/* Widths of the figures in the corner; beside the large controls there is less room. */
#define HUD_CHARS 60
#define HUD_BESIDE_CONTROLS 38

G_DEFINE_FINAL_TYPE(SporeViewport, spore_viewport, GTK_TYPE_OVERLAY)

enum { PICKED, POINTED, PLACES_MOVED, MEASURING, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

/* Drawing. */

static const SporeSimulation *simulation_of(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  return session ? spore_session_simulation(session) : NULL;
}

static void update_stage(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  if (self->stage) spore_stage_mark_links(self->stage, !self->presented);
  if (self->stage && session && !self->rebuild) { /* a stage that is to be built anew is of another world */
    const SporeSnapshot *snapshot = spore_session_snapshot(session);
    spore_stage_update(self->stage, snapshot);
    self->shown_step = snapshot->step;
  }
  spore_viewport_measures_follow(self);
  spore_viewport_follow_camera(self);
  spore_viewport_redraw(self);
}

static void show_selection(SporeViewport *self) {
  gsize count;
  const guint32 *ids = spore_editor_document_get_selected(self->document, &count);
  spore_stage_set_selection(self->stage, ids, count);
}

/* What is edited by hand, after the document or the stage has changed. */
static void refresh_edit(SporeViewport *self) {
  spore_viewport_edit_refresh(self);
  if (spore_viewport_has_brush(self)) spore_viewport_brush_show(self);
}

static gboolean rebuild(gpointer data) {
  SporeViewport *self = data;
  self->rebuild = 0;
  spore_viewport_show_welcome(self);
  /* The run before goes on until the edited one is prepared; the stage is of its world till then. */
  gboolean outdated = simulation_of(self) && spore_player_is_making(self->player);
  if (!self->stage || outdated) {
    spore_viewport_tell_drawing(self);
    return G_SOURCE_REMOVE;
  }
  spore_stage_set_hidden(self->stage, self->hidden);
  spore_stage_rebuild(self->stage, simulation_of(self));
  spore_stage_set_options(self->stage, &self->options);
  show_selection(self);
  spore_viewport_links_refresh(self);
  if (self->drag != DRAG_PORT) spore_viewport_ports_refresh(self);
  spore_viewport_look_afresh(self);
  refresh_edit(self);
  update_stage(self);
  return G_SOURCE_REMOVE;
}

/* After the panels, in a pass of its own, and before anything is drawn. */
static void queue_rebuild(SporeViewport *self) {
  if (!self->rebuild) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE + 5, rebuild, self, NULL);
  spore_viewport_tell_drawing(self);
}

static void measured_aside(gpointer data) { queue_rebuild(data); }

/* Not before the view has its size, by which the scene is framed. */
static void ensure_stage(SporeViewport *self) {
  if (self->stage || !self->document || !self->renderer || gtk_widget_get_allocated_width(self->area) <= 1) return;
  self->stage = spore_stage_new(self->renderer, spore_editor_document_get(self->document));
  spore_stage_measure_aside(self->stage, measured_aside, self);
  g_clear_handle_id(&self->rebuild, g_source_remove);
  spore_stage_set_candidate(self->stage, self->candidate);
  spore_stage_set_marks(self->stage, &self->marks);
  rebuild(self);
}

static gboolean tell_sharpness(gpointer data) {
  g_autoptr(SporeViewport) self = data;
  if (self->document) spore_viewport_overlay_update(self);
  return G_SOURCE_REMOVE;
}

/* The corner says of another picture how sharp it is, once it is shown. */
static void mind_sharpness(SporeViewport *self) {
  if (self->told_coarse == self->picture.coarse) return;
  self->told_coarse = self->picture.coarse;
  g_idle_add(tell_sharpness, g_object_ref(self));
}

static gboolean draw_area(GtkWidget *area, cairo_t *cr, SporeViewport *self) {
  int width = gtk_widget_get_allocated_width(area), height = gtk_widget_get_allocated_height(area);
  ensure_stage(self);
  if (!self->renderer) return FALSE;
  spore_viewport_paint(self, &self->picture, &self->camera, area, cr);
  mind_sharpness(self);
  SporeCamera now = self->camera;
  if (self->picture.pixels) self->camera = self->picture.camera; /* what lies over the picture fits to it */
  spore_viewport_overlay_draw(self, cr, width, height);
  spore_viewport_links_draw(self, cr);
  spore_viewport_ports_draw(self, cr);
  spore_viewport_hand_draw(self, cr);
  spore_viewport_edit_draw(self, cr);
  spore_viewport_brush_draw(self, cr);
  spore_viewport_places_draw(self, cr);
  spore_viewport_gizmo_draw(self, cr);
  spore_viewport_measures_draw(self, cr);
  spore_viewport_box_draw(self, cr);
  self->camera = now;
  spore_viewport_tell_axes(self);
  return FALSE;
}

gboolean spore_viewport_save_picture(SporeViewport *self, const char *file, GError **error) {
  int scale = gtk_widget_get_scale_factor(self->area);
  SporeRenderOptions options = {gtk_widget_get_allocated_width(self->area) * scale,
                                gtk_widget_get_allocated_height(self->area) * scale,
                                .grid = FALSE,
                                .antialias = TRUE,
                                .scale = scale,
                                .light = self->light,
                                .clip = spore_viewport_clip(self)};
  gsize stride = (gsize)options.width * 4;
  spore_viewport_wait_for_graphics(self);
  ensure_stage(self);
  spore_viewport_drop_drawing(self);
  spore_viewport_redraw(self); /* what was being drawn */
  if (!self->renderer)
    return spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, file, "%s",
                             _("the scene cannot be drawn on this machine; the view says why"));
  g_autofree guint8 *pixels = g_malloc(stride * (gsize)options.height);
  return spore_renderer_draw(self->renderer, &self->camera, &options, pixels, stride, error) &&
         spore_png_write(file, pixels, options.width, options.height, stride, error);
}

/* Where the view is narrower than a row of buttons, these are set in smaller letters: none is cut off. */
static void fit_buttons(SporeViewport *self) {
  GtkStyleContext *style = gtk_widget_get_style_context(GTK_WIDGET(self));
  gboolean narrow = gtk_style_context_has_class(style, "narrow");
  if (!narrow) {
    int row, overlays;
    gtk_widget_get_preferred_width(self->tool_row, NULL, &row);
    gtk_widget_get_preferred_width(self->overlays, NULL, &overlays); /* with its margins */
    self->buttons_width = MAX(row + 2 * gtk_widget_get_margin_start(self->tools), overlays);
  }
  if (narrow == (self->buttons_width > gtk_widget_get_allocated_width(self->area))) return;
  if (narrow) gtk_style_context_remove_class(style, "narrow");
  else gtk_style_context_add_class(style, "narrow");
}

/* The choice of what is shown stands beside the first row of tools that leaves room for it, or below both. The cube
 * stands below that choice, or above it beside the tools. */
static gboolean place_overlays(gpointer data) {
  g_autoptr(SporeViewport) self = data;
  GtkWidget *const rows[] = {self->tool_row, self->look_row};
  int overlays, cube, width, widest = 0, height, margin = gtk_widget_get_margin_start(self->tools), top = margin;
  int whole = gtk_widget_get_allocated_width(self->area);
  gboolean beside = FALSE;
  fit_buttons(self);
  gtk_widget_get_preferred_width(self->overlays, NULL, &overlays); /* with its margins */
  gtk_widget_get_preferred_width(self->axes, NULL, &cube);         /* so, too */
  for (guint i = 0; i < G_N_ELEMENTS(rows) && !beside; i++) {
    gtk_widget_get_preferred_width(rows[i], NULL, &width);
    gtk_widget_get_preferred_height(rows[i], NULL, &height);
    widest = MAX(widest, width);
    beside = width + overlays + margin <= whole;
    if (!beside) top += height + gtk_box_get_spacing(GTK_BOX(self->tools));
  }
  gtk_widget_set_margin_top(self->overlays, top);
  spore_viewport_size_second(self);
  gtk_widget_get_preferred_height(self->overlays, NULL, &height); /* with its margins */
  gtk_widget_set_margin_top(self->axes, beside || margin + widest + cube > whole ? height - margin : margin);
  spore_viewport_fit_welcome(self, height);
  return G_SOURCE_REMOVE;
}

static void tools_sized(GtkWidget *tools, GdkRectangle *allocation, SporeViewport *self) {
  g_idle_add_full(G_PRIORITY_HIGH_IDLE, place_overlays, g_object_ref(self), NULL); /* not during size allocation */
}

static void size_changed(GtkWidget *area, GdkRectangle *allocation, SporeViewport *self) {
  spore_viewport_follow_camera(self);
  self->picture.stale = TRUE;
  g_idle_add_full(G_PRIORITY_HIGH_IDLE, place_overlays, g_object_ref(self),
                  NULL); /* before drawing, which may fill time */
}

/* Following the simulation. */

static gboolean tick(GtkWidget *widget, GdkFrameClock *clock, gpointer data) {
  SporeViewport *self = SPORE_VIEWPORT(widget);
  if (!spore_player_is_playing(self->player)) {
    self->tick = 0;
    return G_SOURCE_REMOVE;
  }
  SporeSession *session = spore_player_get_session(self->player);
  if (session && spore_session_snapshot(session)->step != self->shown_step) update_stage(self);
  gint64 now = gdk_frame_clock_get_frame_time(clock);
  if (now - self->hud_clock >= HUD_INTERVAL_US) {
    self->hud_clock = now;
    spore_viewport_overlay_update(self);
  }
  return G_SOURCE_CONTINUE;
}

static void player_changed(SporeViewport *self) {
  if (spore_player_is_playing(self->player) && !self->tick)
    self->tick = gtk_widget_add_tick_callback(GTK_WIDGET(self), tick, NULL, NULL);
  update_stage(self);
  spore_viewport_overlay_update(self);
}

/* The world has been replaced, and with it the body that a drag holds. */
static void player_replaced(SporeViewport *self) {
  if (self->drag == DRAG_PULL || self->drag == DRAG_PROBE) self->drag = DRAG_NONE;
  queue_rebuild(self);
}

static void selection_changed(SporeViewport *self) {
  if (self->stage) show_selection(self);
  self->regions = 0;
  spore_viewport_end_brush(self);
  spore_viewport_ports_refresh(self);
  spore_viewport_edit_refresh(self);
  spore_viewport_overlay_update(self); /* which instrument is led */
  spore_viewport_redraw(self);
}

static void document_changed(SporeViewport *self, int kind, guint id, guint property) {
  SporeObject *object = spore_document_by_id(spore_editor_document_get(self->document), id);
  /* Regions do not change how bodies look. */
  if (object && (spore_region_is(object) || spore_region_is_dab(object))) refresh_edit(self);
  else queue_rebuild(self);
}

/* Life. */

static void release_document(SporeViewport *self) {
  if (self->document) {
    spore_viewport_edit_end(self);
    spore_viewport_end_brush(self);
  }
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
  g_hash_table_remove_all(self->hidden);
  g_hash_table_remove_all(self->locked);
  spore_viewport_measures_forget(self->measures);
  self->document = g_object_ref(document);
  self->player = g_object_ref(player);
  self->framed = FALSE;
  self->has_outside = self->strayed = FALSE;
  self->through = 0; /* another document numbers its objects anew */
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(selection_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "state-changed", G_CALLBACK(player_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "replaced", G_CALLBACK(player_replaced), self, G_CONNECT_SWAPPED);
  ensure_stage(self);
  queue_rebuild(self);
  gtk_widget_grab_focus(self->area);
  spore_viewport_overlay_update(self);
  spore_viewport_redraw(self);
}

void spore_viewport_set_waiting(SporeViewport *self, gboolean waiting) {
  self->waiting = waiting;
  spore_viewport_show_welcome(self);
}

static void tool_clicked(GtkWidget *button, SporeViewport *self);

/* The tool that is used is lit, and no other; none while something is picked or measured. */
static void light_tool(SporeViewport *self) {
  GtkWidget *const buttons[] = {self->select_tool, self->lead_tool, self->edit_tool};
  gboolean picks = self->picking || spore_viewport_measures_now(self);
  for (guint i = 0; i < G_N_ELEMENTS(buttons); i++) {
    g_signal_handlers_block_by_func(buttons[i], tool_clicked, self);
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(buttons[i]), !picks && i == (guint)self->tool);
    g_signal_handlers_unblock_by_func(buttons[i], tool_clicked, self);
  }
}

/* The window may refuse the tool; and a click on what is lit does not turn it off. */
static void tool_clicked(GtkWidget *button, SporeViewport *self) {
  const char *tool = button == self->select_tool ? "select" : button == self->lead_tool ? "probe" : "edit";
  spore_activate(self->area, "tool", g_variant_new_string(tool));
  light_tool(self);
}

/* The room is as light as the windows are, which their theme tells: its letters are dark then. Not for who works in the
 * picture: that is what the lamp shows in a body. */
static void follow_theme(SporeViewport *self) {
  GdkRGBA letters;
  GtkStyleContext *style = gtk_widget_get_style_context(GTK_WIDGET(self));
  gboolean light = !self->presented && gtk_style_context_lookup_color(style, "theme_fg_color", &letters) &&
                   letters.red + letters.green + letters.blue < 1.5;
  if (light == self->light) return;
  self->light = light;
  if (light) gtk_style_context_add_class(style, "light-room");
  else gtk_style_context_remove_class(style, "light-room");
  spore_viewport_redraw(self);
  gtk_widget_queue_draw(self->axes);
}

void spore_viewport_set_presented(SporeViewport *self, gboolean presented) {
  self->presented = presented;
  gtk_widget_set_visible(self->notice, presented);
  gtk_label_set_max_width_chars(GTK_LABEL(self->hud), presented ? HUD_BESIDE_CONTROLS : HUD_CHARS);
  gtk_widget_set_visible(self->overlays, !presented); /* its author's; a trainee's exercise stands there */
  gtk_widget_set_visible(self->axes, !presented);
  follow_theme(self);
  spore_viewport_ports_refresh(self);
  update_stage(self);
}

void spore_viewport_set_boxing(SporeViewport *self, gboolean boxing) {
  spore_viewport_end_drag(self);
  self->boxing = boxing;
  GdkWindow *window = gtk_widget_get_window(self->area);
  g_autoptr(GdkCursor) cross =
      boxing ? gdk_cursor_new_from_name(gtk_widget_get_display(self->area), "crosshair") : NULL;
  if (window) gdk_window_set_cursor(window, cross);
}

void spore_viewport_set_picking(SporeViewport *self, gboolean picking) {
  spore_viewport_end_drag(self);
  if (picking) spore_viewport_end_measuring(self);
  self->picking = picking;
  light_tool(self);
  spore_viewport_set_anchors(self, NULL, 0);
  if (picking) gtk_widget_grab_focus(self->area); /* whose keys pick, too */
}

void spore_viewport_set_tool(SporeViewport *self, SporeViewportTool tool) {
  spore_viewport_end_drag(self);
  spore_viewport_edit_end(self);
  spore_viewport_end_brush(self);
  spore_viewport_end_measuring(self);
  self->tool = tool;
  light_tool(self);
  self->regions = 0;
  spore_viewport_edit_refresh(self);
  spore_viewport_redraw(self);
}

void spore_viewport_set_gizmo(SporeViewport *self, SporeGizmo gizmo) {
  spore_viewport_end_drag(self);
  self->gizmo = gizmo;
  gtk_widget_queue_draw(self->area);
}

void spore_viewport_set_options(SporeViewport *self, const SporeStageOptions *options, gboolean keep_scale) {
  double end = self->options.field_end;
  if (keep_scale && !end && self->stage) end = spore_stage_field_end(self->stage);
  self->options = *options;
  self->options.field_end = keep_scale ? end : 0;
  if (self->stage) spore_stage_set_options(self->stage, &self->options);
  update_stage(self);
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

void spore_viewport_frame_soon(SporeViewport *self) {
  self->framed = FALSE;
  queue_rebuild(self);
}

double spore_viewport_get_draw_ms(SporeViewport *self) { return self->draw_ms; }

const char *spore_viewport_get_renderer(SporeViewport *self) {
  spore_viewport_wait_for_graphics(self);
  return self->renderer_name;
}

static void spore_viewport_dispose(GObject *object) {
  SporeViewport *self = SPORE_VIEWPORT(object);
  release_document(self);
  spore_viewport_drop_drawing(self);
  self->graphics = NULL;
  g_clear_pointer(&self->renderer, spore_renderer_free);
  g_clear_pointer(&self->offscreen, spore_offscreen_free);
  spore_viewport_clear_picture(&self->picture);
  spore_viewport_clear_picture(&self->second_picture);
  g_clear_pointer(&self->renderer_name, g_free);
  g_clear_pointer(&self->candidate, spore_stage_candidate_free);
  g_clear_pointer(&self->marks.segments, g_free);
  g_clear_pointer(&self->hidden, g_hash_table_unref);
  g_clear_pointer(&self->locked, g_hash_table_unref);
  g_clear_pointer(&self->link_marks, g_array_unref);
  g_clear_pointer(&self->ports, g_array_unref);
  g_clear_pointer(&self->measures, spore_viewport_measures_free);
  g_clear_object(&self->link_kinds);
  g_clear_object(&self->instrument_kinds);
  g_clear_object(&self->fluid_kinds);
  spore_viewport_clear_legend(self);
  G_OBJECT_CLASS(spore_viewport_parent_class)->dispose(object);
}

static void spore_viewport_class_init(SporeViewportClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_viewport_dispose;
  signals[PICKED] = g_signal_new("picked", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL,
                                 G_TYPE_NONE, 2, G_TYPE_UINT, G_TYPE_POINTER);
  signals[POINTED] = g_signal_new("pointed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL,
                                  G_TYPE_NONE, 2, G_TYPE_UINT, G_TYPE_POINTER);
  signals[PLACES_MOVED] = g_signal_new("places-moved", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL,
                                       G_TYPE_NONE, 1, G_TYPE_POINTER);
  signals[MEASURING] =
      g_signal_new("measuring", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-viewport.ui");
  gtk_widget_class_bind_template_child(widget, SporeViewport, area);
  gtk_widget_class_bind_template_child(widget, SporeViewport, foot);
  gtk_widget_class_bind_template_child(widget, SporeViewport, template_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, recent_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, hud);
  gtk_widget_class_bind_template_child(widget, SporeViewport, tools);
  gtk_widget_class_bind_template_child(widget, SporeViewport, tool_row);
  gtk_widget_class_bind_template_child(widget, SporeViewport, look_row);
  gtk_widget_class_bind_template_child(widget, SporeViewport, select_tool);
  gtk_widget_class_bind_template_child(widget, SporeViewport, lead_tool);
  gtk_widget_class_bind_template_child(widget, SporeViewport, edit_tool);
  gtk_widget_class_bind_template_child(widget, SporeViewport, overlays);
  gtk_widget_class_bind_template_child(widget, SporeViewport, colours_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, axes);
  gtk_widget_class_bind_template_child(widget, SporeViewport, measure_list);
  gtk_widget_class_bind_template_child(widget, SporeViewport, welcome);
  gtk_widget_class_bind_template_child(widget, SporeViewport, beginnings);
  gtk_widget_class_bind_template_child(widget, SporeViewport, failure);
  gtk_widget_class_bind_template_child(widget, SporeViewport, link_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, links_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, instrument_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, led_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, measure_button);
  gtk_widget_class_bind_template_child(widget, SporeViewport, cut_slider);
  gtk_widget_class_bind_template_child(widget, SporeViewport, notice);
  gtk_widget_class_bind_template_child(widget, SporeViewport, foot_row);
  gtk_widget_class_bind_template_child(widget, SporeViewport, second);
  gtk_widget_class_bind_template_child(widget, SporeViewport, second_area);
  gtk_widget_class_bind_template_child(widget, SporeViewport, second_name);
  gtk_widget_class_bind_template_child(widget, SporeViewport, large_name);
  gtk_widget_class_bind_template_callback(widget, draw_area);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_draw_second);
  gtk_widget_class_bind_template_callback(widget, size_changed);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_cut_moved);
  gtk_widget_class_bind_template_callback(widget, tool_clicked);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_button_press);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_button_release);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_motion);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_scroll);
  gtk_widget_class_bind_template_callback(widget, spore_viewport_key_press);
}

void spore_viewport_set_messages(SporeViewport *self, GtkWidget *messages) {
  self->messages = messages;
  gtk_box_pack_end(GTK_BOX(self->foot), messages, FALSE, FALSE, 0);
  g_signal_connect_object(messages, "size-allocate", G_CALLBACK(gtk_widget_queue_draw), self->area, G_CONNECT_SWAPPED);
}

void spore_viewport_set_controls(SporeViewport *self, GtkWidget *controls) {
  gtk_box_set_center_widget(GTK_BOX(self->foot_row), controls);
}

static void spore_viewport_init(SporeViewport *self) {
  self->hidden = g_hash_table_new(NULL, NULL);
  self->locked = g_hash_table_new(NULL, NULL);
  self->link_marks = spore_viewport_link_marks_new();
  self->ports = spore_viewport_ports_new();
  self->measures = spore_viewport_measures_new();
  self->options = (SporeStageOptions){.surfaces = TRUE};
  spore_hand_edit_close(&self->edit);
  self->camera = spore_viewport_beginning();
  gtk_widget_init_template(GTK_WIDGET(self));
  gtk_overlay_set_overlay_pass_through(GTK_OVERLAY(self), self->foot, TRUE);
  g_signal_connect_object(self->tools, "size-allocate", G_CALLBACK(tools_sized), self, 0);
  g_signal_connect_object(self->hud, "size-allocate", G_CALLBACK(gtk_widget_queue_draw), self->area, G_CONNECT_SWAPPED);
  spore_ignore_wheel(self->cut_slider);
  spore_viewport_measures_fill_menu(GTK_MENU_BUTTON(self->measure_button));
  g_signal_connect(self, "measuring", G_CALLBACK(light_tool), NULL);
  light_tool(self);
  g_signal_connect(self, "style-updated", G_CALLBACK(follow_theme), NULL);
  follow_theme(self);
  spore_viewport_prepare_graphics(self);
}
