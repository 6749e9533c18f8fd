/* Gestures in the viewport: they move the camera, pull tissue, select, and call the hand and the Edit tool. */
#include "core/author/edits.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define ZOOM_A_NOTCH 0.88
/* A hand's pull on soft tissue. */
#define PULL_STIFFNESS_N_M 100.0

static SporeSession *session_of(SporeViewport *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

static int width_of(SporeViewport *self) { return gtk_widget_get_allocated_width(self->area); }
static int height_of(SporeViewport *self) { return gtk_widget_get_allocated_height(self->area); }

static guint32 pick_past(SporeViewport *self, GHashTable *skipped, double x, double y, SporeVec3 *point) {
  SporeVec3 origin, direction;
  if (!self->stage) return 0;
  spore_camera_ray(&self->camera, x, y, width_of(self), height_of(self), &origin, &direction);
  spore_viewport_clip_picking(self);
  return spore_stage_pick_past(self->stage, skipped, origin, direction, point);
}

/* A place on whatever is there. */
static guint32 pick(SporeViewport *self, double x, double y, SporeVec3 *point) {
  return pick_past(self, NULL, x, y, point);
}

/* What is to be selected or pulled: locked bodies are looked through. */
static guint32 pick_unlocked(SporeViewport *self, double x, double y, SporeVec3 *point) {
  return pick_past(self, self->locked, x, y, point);
}

/* Pull. */

static gboolean begin_pull(SporeViewport *self, double x, double y) {
  SporeSession *session = session_of(self);
  SporeVec3 point;
  guint32 id = session ? pick_unlocked(self, x, y, &point) : 0;
  SporeObject *object = id ? spore_document_by_id(spore_editor_document_get(self->document), id) : NULL;
  if (!object) return FALSE;
  const SporeSimulation *simulation = spore_session_simulation(session);
  self->body = spore_simulation_body_of(simulation, object);
  if (self->body == SPORE_NO_BODY || spore_world_body_role(simulation->world, self->body) != SPORE_PASSIVE)
    return FALSE;
  self->start = self->cursor = point;
  self->drag = DRAG_PULL;
  return TRUE;
}

static void move_pull(SporeViewport *self) {
  self->cursor = spore_viewport_under_cursor(self, self->start);
  SporeCommand command = {.kind = SPORE_COMMAND_PULL,
                          .body = self->body,
                          .point = self->start,
                          .vector = self->cursor,
                          .number = PULL_STIFFNESS_N_M};
  spore_session_post(session_of(self), &command);
}

static void release_pull(SporeViewport *self) {
  SporeCommand command = {.kind = SPORE_COMMAND_RELEASE, .body = self->body};
  if (session_of(self)) spore_session_post(session_of(self), &command);
}

/* Places. */

static void move_place(SporeViewport *self) {
  SporeVec3 point;
  guint32 body = pick(self, self->last_x, self->last_y, &point);
  if (body) spore_viewport_places_motion(self, body, point);
}

static void move_port(SporeViewport *self) {
  SporeVec3 point = {0, 0, 0};
  guint32 body = pick(self, self->last_x, self->last_y, &point);
  spore_viewport_ports_motion(self, body, point);
}

/* Drags. */

void spore_viewport_end_drag(SporeViewport *self) {
  gboolean edits = self->drag == DRAG_EDIT && self->document, places = self->drag == DRAG_PLACE && self->document;
  gboolean gizmo = self->drag == DRAG_GIZMO && self->document, ports = self->drag == DRAG_PORT && self->document;
  gboolean box = self->drag == DRAG_BOX && self->document, brush = self->drag == DRAG_BRUSH && self->document;
  if (self->drag == DRAG_PULL) release_pull(self);
  self->drag = DRAG_NONE;
  if (gizmo) spore_viewport_gizmo_release(self, TRUE);
  if (edits) spore_viewport_edit_release(self, TRUE);
  if (brush) spore_viewport_brush_release(self, TRUE);
  if (places) spore_viewport_places_release(self, TRUE);
  if (ports) spore_viewport_ports_release(self, TRUE);
  if (box) spore_viewport_box_release(self, TRUE);
}

static void abort_drag(SporeViewport *self) {
  if (self->drag == DRAG_ORBIT || self->drag == DRAG_PAN) self->camera = self->camera_before;
  if (self->drag == DRAG_PROBE) {
    spore_viewport_hand_take_back(self);
  }
  if (self->drag == DRAG_EDIT) {
    self->drag = DRAG_NONE;
    spore_viewport_edit_release(self, FALSE);
  }
  if (self->drag == DRAG_BRUSH) {
    self->drag = DRAG_NONE;
    spore_viewport_brush_release(self, FALSE);
  }
  if (self->drag == DRAG_PLACE) {
    self->drag = DRAG_NONE;
    spore_viewport_places_release(self, FALSE);
  }
  if (self->drag == DRAG_PORT) {
    self->drag = DRAG_NONE;
    spore_viewport_ports_release(self, FALSE);
  }
  if (self->drag == DRAG_BOX) {
    self->drag = DRAG_NONE;
    spore_viewport_box_release(self, FALSE);
  }
  if (self->drag == DRAG_GIZMO) {
    self->drag = DRAG_NONE;
    spore_viewport_gizmo_release(self, FALSE);
  }
  spore_viewport_end_drag(self);
  spore_viewport_redraw(self);
}

static void begin_camera(SporeViewport *self, gboolean pan) {
  spore_viewport_leave_scene_camera(self);
  self->camera_before = self->camera;
  self->drag = pan ? DRAG_PAN : DRAG_ORBIT;
}

/* Beside all bodies, the place is as far away as the last one, or as what the camera looks at. */
static void emit_place(SporeViewport *self, const char *signal, double x, double y) {
  SporeVec3 point, through = self->anchor_count ? self->anchors[self->anchor_count - 1] : self->camera.target;
  guint32 body = pick(self, x, y, &point);
  if (!body) point = spore_camera_unproject(&self->camera, through, x, y, width_of(self), height_of(self));
  g_signal_emit_by_name(self, signal, body, &point);
}

static void press_left(SporeViewport *self, const GdkEventButton *event) {
  SporeVec3 point;
  if (spore_viewport_places_press(self, event->x, event->y)) return;
  if (self->picking) {
    emit_place(self, "picked", event->x, event->y);
    return;
  }
  if (spore_viewport_measures_now(self)) {
    self->beside = !spore_viewport_measures_press(self, event->x, event->y);
    self->pressed_x = event->x, self->pressed_y = event->y;
    return;
  }
  if (self->boxing && spore_viewport_box_press(self, event)) return;
  if (spore_viewport_has_brush(self)) {
    self->beside = !spore_viewport_brush_press(self, event->x, event->y, event->state & GDK_CONTROL_MASK);
    self->pressed_x = event->x, self->pressed_y = event->y;
    return;
  }
  if (self->tool == SPORE_VIEWPORT_TOOL_EDIT && spore_viewport_ports_press(self, event->x, event->y)) return;
  if (spore_viewport_gizmo_press(self, event->x, event->y)) return;
  if (spore_viewport_box_press(self, event)) return;
  if (event->state & GDK_CONTROL_MASK && begin_pull(self, event->x, event->y)) return;
  if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && spore_viewport_hand_press(self)) return;
  if (self->tool == SPORE_VIEWPORT_TOOL_EDIT && spore_viewport_edit_press(self, event->x, event->y)) return;
  guint32 link = self->tool == SPORE_VIEWPORT_TOOL_SELECT ? spore_viewport_link_at(self, event->x, event->y) : 0;
  guint32 body = link ? link : pick_unlocked(self, event->x, event->y, &point);
  if (body && spore_viewport_edit_place(self, body, point)) return;
  if (body && event->state & GDK_SHIFT_MASK) spore_editor_document_toggle(self->document, body);
  else if (body) spore_editor_document_select(self->document, body);
  self->beside = !body;
  self->pressed_x = event->x, self->pressed_y = event->y;
}

/* The menu is of what lies under the cursor, or of all that is selected where that is a part of it. */
static void press_right(SporeViewport *self, const GdkEventButton *event) {
  SporeVec3 point;
  guint32 body = pick_unlocked(self, event->x, event->y, &point);
  if (body && !spore_editor_document_is_selected(self->document, body))
    spore_editor_document_select(self->document, body);
  spore_viewport_popup(self, (const GdkEvent *)event, body != 0);
}

gboolean spore_viewport_button_press(GtkWidget *area, GdkEventButton *event, SporeViewport *self) {
  gtk_widget_grab_focus(area);
  if (event->type != GDK_BUTTON_PRESS || !self->document) return GDK_EVENT_STOP;
  if (event->button == GDK_BUTTON_SECONDARY && self->tool == SPORE_VIEWPORT_TOOL_PROBE) {
    spore_viewport_hand_squeeze(self, event->state & GDK_CONTROL_MASK ? SPORE_HAND_OPENS : SPORE_HAND_CLOSES);
    return GDK_EVENT_STOP;
  }
  if (self->drag != DRAG_NONE) return GDK_EVENT_STOP;
  self->last_x = event->x;
  self->last_y = event->y;
  if (event->button == GDK_BUTTON_PRIMARY) press_left(self, event);
  if (event->button == GDK_BUTTON_SECONDARY) press_right(self, event);
  if (event->button == GDK_BUTTON_MIDDLE) begin_camera(self, event->state & GDK_SHIFT_MASK);
  return GDK_EVENT_STOP;
}

gboolean spore_viewport_button_release(GtkWidget *area, GdkEventButton *event, SporeViewport *self) {
  if (event->button == GDK_BUTTON_SECONDARY) {
    /* With Shift, jaws and pedals stay as they are until the button is pressed and released again. A clamp stays closed
     * by itself; Ctrl and the button open it, or press the second pedal of others. */
    if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && !(event->state & GDK_SHIFT_MASK))
      spore_viewport_hand_squeeze(self, SPORE_HAND_RESTS);
    return GDK_EVENT_STOP;
  }
  gboolean selects =
      !spore_viewport_edits_regions(self) && !spore_viewport_has_brush(self) && !spore_viewport_measures_now(self);
  if (self->beside && self->document && selects) spore_editor_document_select(self->document, 0);
  self->beside = FALSE;
  spore_viewport_end_drag(self);
  spore_viewport_redraw(self);
  return GDK_EVENT_STOP;
}

gboolean spore_viewport_motion(GtkWidget *area, GdkEventMotion *event, SporeViewport *self) {
  double dx = event->x - self->last_x, dy = event->y - self->last_y;
  self->last_x = event->x;
  self->last_y = event->y;
  if (self->beside &&
      gtk_drag_check_threshold(area, (int)self->pressed_x, (int)self->pressed_y, (int)event->x, (int)event->y)) {
    self->beside = FALSE;
    if (!self->habits.middle_turns_alone) begin_camera(self, event->state & GDK_SHIFT_MASK);
  }
  switch (self->drag) {
  case DRAG_NONE:
    if (self->anchor_count || spore_viewport_measures_now(self) || spore_viewport_has_brush(self))
      gtk_widget_queue_draw(area); /* the line to the cursor, or the brush */
    if (self->picking) emit_place(self, "pointed", event->x, event->y);
    return GDK_EVENT_PROPAGATE;
  case DRAG_ORBIT:
    spore_camera_orbit(&self->camera, dx, dy);
    break;
  case DRAG_PAN:
    spore_camera_pan(&self->camera, dx, dy, height_of(self));
    break;
  case DRAG_PROBE:
    if (event->state & GDK_SHIFT_MASK) spore_viewport_hand_turn(self, dx, dy);
    else spore_viewport_hand_motion(self);
    break;
  case DRAG_PULL:
    move_pull(self);
    break;
  case DRAG_EDIT:
    spore_viewport_edit_motion(self);
    break;
  case DRAG_BRUSH:
    spore_viewport_brush_motion(self, event->x - dx, event->y - dy);
    break;
  case DRAG_PLACE:
    move_place(self);
    break;
  case DRAG_PORT:
    move_port(self);
    break;
  case DRAG_GIZMO:
    spore_viewport_gizmo_motion(self, event->state);
    break;
  case DRAG_BOX:
    gtk_widget_queue_draw(area);
    return GDK_EVENT_STOP;
  }
  spore_viewport_redraw(self);
  return GDK_EVENT_STOP;
}

static double notches_of(const GdkEventScroll *event) {
  if (event->direction == GDK_SCROLL_UP) return -1;
  if (event->direction == GDK_SCROLL_DOWN) return 1;
  return event->direction == GDK_SCROLL_SMOOTH ? event->delta_y : 0;
}

gboolean spore_viewport_scroll(GtkWidget *area, GdkEventScroll *event, SporeViewport *self) {
  double notches = notches_of(event);
  if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && session_of(self)) spore_viewport_hand_deepen(self, notches);
  else if (spore_viewport_brush_scroll(self, notches)) return GDK_EVENT_STOP;
  else if (self->tool != SPORE_VIEWPORT_TOOL_EDIT || !spore_viewport_edit_scroll(self, notches)) {
    spore_viewport_leave_scene_camera(self);
    double away = self->habits.wheel_goes_away ? -notches : notches;
    spore_camera_zoom(&self->camera, pow(ZOOM_A_NOTCH, -away), event->x, event->y, width_of(self), height_of(self));
  }
  spore_viewport_redraw(self);
  return GDK_EVENT_STOP;
}

static gboolean has_whole_screen(GtkWidget *area) {
  GdkWindow *window = gtk_widget_get_window(gtk_widget_get_toplevel(area));
  return window && gdk_window_get_state(window) & GDK_WINDOW_STATE_FULLSCREEN;
}

static gboolean has_message(GtkWidget *area) {
  GtkWidget *window = gtk_widget_get_toplevel(area);
  return G_IS_ACTION_GROUP(window) && g_action_group_get_action_enabled(G_ACTION_GROUP(window), "close-message");
}

/* Keys of the view that are actions of the window. */
static const struct {
  guint key;
  const char *action; /* detailed */
  gboolean presented; /* only while the view is shown alone */
} keys[] = {
    {GDK_KEY_m, "win.measure::distance"},
    {GDK_KEY_h, "win.hide"},
    {GDK_KEY_i, "win.isolate"},
    {GDK_KEY_a, "win.show-all"},
    {GDK_KEY_f, "win.frame"},
    {GDK_KEY_0, "win.view::camera"},
    {GDK_KEY_1, "win.view::front"},
    {GDK_KEY_3, "win.view::right"},
    {GDK_KEY_7, "win.view::top"},
    {GDK_KEY_e, "win.show-guide", TRUE},
    {GDK_KEY_x, "win.swap-views"},
    {GDK_KEY_w, "win.gizmo::move"},
    {GDK_KEY_e, "win.gizmo::turn"},
    {GDK_KEY_r, "win.gizmo::scale"},
    {GDK_KEY_v, "win.second-view"},
    {GDK_KEY_k, "win.lock"},
    {GDK_KEY_b, "win.box-select"},
};

guint spore_viewport_key_of(const char *action) {
  for (gsize i = 0; i < G_N_ELEMENTS(keys); i++)
    if (g_str_equal(keys[i].action, action)) return keys[i].key;
  return 0;
}

/* Digits of the keypad do the same as the others. */
static guint digit_of(guint key) {
  return key >= GDK_KEY_KP_0 && key <= GDK_KEY_KP_9 ? GDK_KEY_0 + key - GDK_KEY_KP_0 : key;
}

/* With Ctrl, keys of views look from the other side. FALSE: not such a key. */
static gboolean look_from_other_side(GtkWidget *area, guint key) {
  const char *view = digit_of(key) == GDK_KEY_1   ? "back"
                     : digit_of(key) == GDK_KEY_3 ? "left"
                     : digit_of(key) == GDK_KEY_7 ? "bottom"
                                                  : NULL;
  if (view) spore_activate(area, "view", g_variant_new_string(view));
  return view != NULL;
}

/* FALSE: not its key. */
static gboolean act_on(GtkWidget *area, guint key, gboolean presented) {
  key = digit_of(key);
  for (gsize i = 0; i < G_N_ELEMENTS(keys); i++) {
    g_autofree char *action = NULL;
    g_autoptr(GVariant) target = NULL;
    if (keys[i].key != key || (keys[i].presented && !presented) ||
        !g_action_parse_detailed_name(keys[i].action, &action, &target, NULL))
      continue;
    spore_activate(area, action + strlen("win."), target);
    return TRUE;
  }
  return FALSE;
}

gboolean spore_viewport_key_press(GtkWidget *area, GdkEventKey *event, SporeViewport *self) {
  const guint modifiers = event->state & gtk_accelerator_get_default_mod_mask();
  if (event->keyval == GDK_KEY_Escape && self->drag != DRAG_NONE) { /* keys of the drag may be down, too */
    abort_drag(self);
    return GDK_EVENT_STOP;
  }
  if (modifiers == GDK_CONTROL_MASK && event->keyval == GDK_KEY_a) {
    spore_activate(area, "select-organs", NULL);
    return GDK_EVENT_STOP;
  }
  if (modifiers == GDK_CONTROL_MASK && look_from_other_side(area, event->keyval)) return GDK_EVENT_STOP;
  if (modifiers) return GDK_EVENT_PROPAGATE;
  if (spore_viewport_gizmo_key(self, event->keyval) || spore_viewport_brush_key(self, event->keyval) ||
      spore_viewport_edit_key(self, event->keyval) || spore_viewport_hand_key(self, event->keyval))
    return GDK_EVENT_STOP;
  switch (event->keyval) {
  case GDK_KEY_Escape:
    if (self->boxing) spore_activate(area, "box-select", NULL);
    else if (self->picking) spore_activate(area, "pick-back", NULL);
    else if (spore_viewport_measures_back(self)) break;
    else if (has_message(area)) spore_activate(area, "close-message", NULL);
    else if (has_whole_screen(area)) spore_activate(area, "present", NULL);
    else spore_activate(area, "cancel-job", NULL); /* a preview, if there is one */
    break;
  case GDK_KEY_space:
    if (self->picking) emit_place(self, "picked", 0.5 * width_of(self), 0.5 * height_of(self));
    else if (spore_viewport_measures_now(self))
      spore_viewport_measures_press(self, 0.5 * width_of(self), 0.5 * height_of(self));
    else return GDK_EVENT_PROPAGATE;
    break;
  case GDK_KEY_Return:
  case GDK_KEY_KP_Enter:
    if (!self->picking) return GDK_EVENT_PROPAGATE;
    spore_activate(area, "pick-done", NULL);
    break;
  default:
    return act_on(area, event->keyval, self->presented) ? GDK_EVENT_STOP : GDK_EVENT_PROPAGATE;
  }
  return GDK_EVENT_STOP;
}
