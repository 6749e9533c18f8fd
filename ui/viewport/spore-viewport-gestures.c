/* Gestures in the viewport: they move the camera and the probe, pull tissue, select, and call the Edit tool. */
#include "core/author/edits.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define ZOOM_A_NOTCH 0.88
/* Depth of the probe, as a part of the distance to the camera. */
#define DEPTH_A_NOTCH 0.02
#define TURN_RAD_A_PIXEL 0.01
/* A hand's pull on soft tissue. */
#define PULL_STIFFNESS_N_M 100.0

static SporeSession *session_of(SporeViewport *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

static int width_of(SporeViewport *self) { return gtk_widget_get_allocated_width(self->area); }
static int height_of(SporeViewport *self) { return gtk_widget_get_allocated_height(self->area); }

static SporeVec3 under_cursor(SporeViewport *self, SporeVec3 through) {
  return spore_camera_unproject(&self->camera, through, self->last_x, self->last_y, width_of(self), height_of(self));
}

static guint32 pick(SporeViewport *self, double x, double y, SporeVec3 *point) {
  SporeVec3 origin, direction;
  if (!self->stage) return 0;
  spore_camera_ray(&self->camera, x, y, width_of(self), height_of(self), &origin, &direction);
  return spore_stage_pick(self->stage, origin, direction, point);
}

/* Probe. */

/* The selected active body, else the first one that the scene has. */
static guint32 active_body(SporeViewport *self, const SporeSimulation *simulation) {
  SporeObject *selected = spore_editor_document_selected_body(self->document);
  guint32 body = selected ? spore_simulation_body_of(simulation, selected) : SPORE_NO_BODY;
  if (body != SPORE_NO_BODY) body = spore_world_hand(simulation->world, body);
  if (body != SPORE_NO_BODY) return body;
  for (body = 0; body < spore_world_body_count(simulation->world); body++)
    if (spore_world_hand(simulation->world, body) == body) return body;
  return SPORE_NO_BODY;
}

gboolean spore_viewport_probe(SporeViewport *self, guint32 *body, SporeVec3 *position) {
  SporeSession *session = session_of(self);
  if (!session) return FALSE;
  const SporeSimulation *simulation = spore_session_simulation(session);
  *body = active_body(self, simulation);
  if (*body == SPORE_NO_BODY) return FALSE;
  *position = spore_vec3_load(spore_session_snapshot(session)->q + spore_world_q_offset(simulation->world, *body));
  return TRUE;
}

/* The hand starts at the pose that the body has from its device, the mouse or a track. */
static gboolean take_hand(SporeViewport *self) {
  SporeVec3 position;
  if (self->drag == DRAG_PULL || !spore_viewport_probe(self, &self->body, &position)) return FALSE;
  SporeSession *session = session_of(self);
  const SporeWorld *world = spore_session_simulation(session)->world;
  const double *q = spore_session_snapshot(session)->q + spore_world_q_offset(world, self->body);
  if (self->drag == DRAG_PROBE) return TRUE;
  self->hand = spore_session_input(session, self->body);
  spore_vec3_store(self->hand.position, position);
  spore_quat_store(self->hand.orientation, spore_quat_load(q + 3));
  return TRUE;
}

static SporeVec3 hand_position(const SporeViewport *self) { return spore_vec3_load(self->hand.position); }

static void lead_probe(SporeViewport *self) {
  self->hand.t_ns = spore_clock_ns();
  spore_session_set_pointer(session_of(self), self->body, &self->hand);
}

static void lead_probe_to(SporeViewport *self, SporeVec3 position) {
  spore_vec3_store(self->hand.position, position);
  lead_probe(self);
}

static gboolean begin_probe(SporeViewport *self) {
  if (!take_hand(self)) return FALSE;
  self->drag = DRAG_PROBE;
  self->hand_before = self->hand;
  self->offset = spore_vec3_sub(hand_position(self), under_cursor(self, hand_position(self)));
  lead_probe(self);
  return TRUE;
}

static void move_probe(SporeViewport *self) {
  lead_probe_to(self, spore_vec3_add(under_cursor(self, hand_position(self)), self->offset));
}

/* Turns the probe about its tip, as a ball under the cursor would roll. */
static void turn_probe(SporeViewport *self, double dx, double dy) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  SporeVec3 turn =
      spore_vec3_add(spore_vec3_scale(dx * TURN_RAD_A_PIXEL, up), spore_vec3_scale(dy * TURN_RAD_A_PIXEL, right));
  SporeQuat orientation =
      spore_quat_multiply(spore_quat_from_rotation_vector(turn), spore_quat_load(self->hand.orientation));
  spore_quat_store(self->hand.orientation, spore_quat_normalise(orientation));
  self->offset = spore_vec3_sub(hand_position(self), under_cursor(self, hand_position(self)));
  lead_probe(self);
}

/* Moves in depth; the point under the cursor stays there. */
static void deepen_probe(SporeViewport *self, double notches) {
  SporeVec3 eye, right, up, forward;
  if (!take_hand(self)) return;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  double depth = spore_vec3_distance(eye, hand_position(self));
  lead_probe_to(self, spore_vec3_add_scaled(hand_position(self), -notches * DEPTH_A_NOTCH * depth, forward));
  self->offset = spore_vec3_sub(hand_position(self), under_cursor(self, hand_position(self)));
}

/* Closes or opens the jaws, and presses or releases the pedal. */
static void squeeze_probe(SporeViewport *self, gboolean squeezed) {
  if (!take_hand(self)) return;
  self->hand.grip_rad = squeezed ? 0 : G_PI;
  self->hand.buttons = squeezed ? 1 : 0;
  lead_probe(self);
}

/* Pull. */

static gboolean begin_pull(SporeViewport *self, double x, double y) {
  SporeSession *session = session_of(self);
  SporeVec3 point;
  guint32 id = session ? pick(self, x, y, &point) : 0;
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
  self->cursor = under_cursor(self, self->start);
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

/* Drags. */

void spore_viewport_end_drag(SporeViewport *self) {
  gboolean edits = self->drag == DRAG_EDIT && self->document, places = self->drag == DRAG_PLACE && self->document;
  if (self->drag == DRAG_PULL) release_pull(self);
  self->drag = DRAG_NONE;
  if (edits) spore_viewport_edit_release(self, TRUE);
  if (places) spore_viewport_places_release(self, TRUE);
}

static void abort_drag(SporeViewport *self) {
  if (self->drag == DRAG_ORBIT || self->drag == DRAG_PAN) self->camera = self->camera_before;
  if (self->drag == DRAG_PROBE) {
    self->hand = self->hand_before;
    lead_probe(self);
  }
  if (self->drag == DRAG_EDIT) {
    self->drag = DRAG_NONE;
    spore_viewport_edit_release(self, FALSE);
  }
  if (self->drag == DRAG_PLACE) {
    self->drag = DRAG_NONE;
    spore_viewport_places_release(self, FALSE);
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
static void emit_picked(SporeViewport *self, double x, double y) {
  SporeVec3 point, through = self->anchor_count ? self->anchors[self->anchor_count - 1] : self->camera.target;
  guint32 body = pick(self, x, y, &point);
  if (!body) point = spore_camera_unproject(&self->camera, through, x, y, width_of(self), height_of(self));
  g_signal_emit_by_name(self, "picked", body, &point);
}

static void press_left(SporeViewport *self, const GdkEventButton *event) {
  SporeVec3 point;
  if (spore_viewport_places_press(self, event->x, event->y)) return;
  if (self->picking) {
    emit_picked(self, event->x, event->y);
    return;
  }
  if (event->state & GDK_CONTROL_MASK && begin_pull(self, event->x, event->y)) return;
  if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && begin_probe(self)) return;
  if (self->tool == SPORE_VIEWPORT_TOOL_EDIT && spore_viewport_edit_press(self, event->x, event->y)) return;
  guint32 link = self->tool == SPORE_VIEWPORT_TOOL_SELECT ? spore_viewport_link_at(self, event->x, event->y) : 0;
  guint32 body = link ? link : pick(self, event->x, event->y, &point);
  if (body && spore_viewport_edit_place(self, body, point)) return;
  if (body && event->state & GDK_SHIFT_MASK) spore_editor_document_toggle(self->document, body);
  else if (body) spore_editor_document_select(self->document, body);
  self->beside = !body;
  self->pressed_x = event->x, self->pressed_y = event->y;
}

/* The menu is of what lies under the cursor, or of all that is selected where that is a part of it. */
static void press_right(SporeViewport *self, const GdkEventButton *event) {
  SporeVec3 point;
  guint32 body = pick(self, event->x, event->y, &point);
  if (body && !spore_editor_document_is_selected(self->document, body))
    spore_editor_document_select(self->document, body);
  spore_viewport_popup(self, (const GdkEvent *)event, body != 0);
}

gboolean spore_viewport_button_press(GtkWidget *area, GdkEventButton *event, SporeViewport *self) {
  gtk_widget_grab_focus(area);
  if (event->type != GDK_BUTTON_PRESS || !self->document) return GDK_EVENT_STOP;
  if (event->button == GDK_BUTTON_SECONDARY && self->tool == SPORE_VIEWPORT_TOOL_PROBE) {
    squeeze_probe(self, TRUE);
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
    /* With Shift, jaws and pedal stay as they are until the button is pressed and released again. */
    if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && !(event->state & GDK_SHIFT_MASK)) squeeze_probe(self, FALSE);
    return GDK_EVENT_STOP;
  }
  if (self->beside && self->document && !spore_viewport_edits_regions(self))
    spore_editor_document_select(self->document, 0);
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
    begin_camera(self, event->state & GDK_SHIFT_MASK);
  }
  switch (self->drag) {
  case DRAG_NONE:
    if (self->anchor_count) gtk_widget_queue_draw(area); /* the line to the cursor */
    return GDK_EVENT_PROPAGATE;
  case DRAG_ORBIT:
    spore_camera_orbit(&self->camera, dx, dy);
    break;
  case DRAG_PAN:
    spore_camera_pan(&self->camera, dx, dy, height_of(self));
    break;
  case DRAG_PROBE:
    if (event->state & GDK_SHIFT_MASK) turn_probe(self, dx, dy);
    else move_probe(self);
    break;
  case DRAG_PULL:
    move_pull(self);
    break;
  case DRAG_EDIT:
    spore_viewport_edit_motion(self);
    break;
  case DRAG_PLACE:
    move_place(self);
    break;
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
  if (self->tool == SPORE_VIEWPORT_TOOL_PROBE && session_of(self)) deepen_probe(self, notches);
  else if (self->tool != SPORE_VIEWPORT_TOOL_EDIT || !spore_viewport_edit_scroll(self, notches)) {
    spore_viewport_leave_scene_camera(self);
    spore_camera_zoom(&self->camera, pow(ZOOM_A_NOTCH, -notches), event->x, event->y, width_of(self), height_of(self));
  }
  spore_viewport_redraw(self);
  return GDK_EVENT_STOP;
}

static gboolean has_whole_screen(GtkWidget *area) {
  GdkWindow *window = gtk_widget_get_window(gtk_widget_get_toplevel(area));
  return window && gdk_window_get_state(window) & GDK_WINDOW_STATE_FULLSCREEN;
}

gboolean spore_viewport_key_press(GtkWidget *area, GdkEventKey *event, SporeViewport *self) {
  const guint modifiers = event->state & gtk_accelerator_get_default_mod_mask();
  if (modifiers == GDK_CONTROL_MASK && event->keyval == GDK_KEY_a) {
    spore_activate(area, "select-organs", NULL);
    return GDK_EVENT_STOP;
  }
  if (modifiers) return GDK_EVENT_PROPAGATE;
  if (spore_viewport_edit_key(self, event->keyval)) return GDK_EVENT_STOP;
  switch (event->keyval) {
  case GDK_KEY_Escape:
    if (self->drag != DRAG_NONE) abort_drag(self);
    else if (self->picking) spore_activate(area, "pick-back", NULL);
    else if (has_whole_screen(area)) spore_activate(area, "present", NULL);
    else spore_activate(area, "cancel-job", NULL); /* a preview, if there is one */
    break;
  case GDK_KEY_space:
    if (!self->picking) return GDK_EVENT_PROPAGATE;
    emit_picked(self, 0.5 * width_of(self), 0.5 * height_of(self));
    break;
  case GDK_KEY_Return:
  case GDK_KEY_KP_Enter:
    if (!self->picking) return GDK_EVENT_PROPAGATE;
    spore_activate(area, "pick-done", NULL);
    break;
  case GDK_KEY_h:
    spore_activate(area, "hide", NULL);
    break;
  case GDK_KEY_i:
    spore_activate(area, "isolate", NULL);
    break;
  case GDK_KEY_a:
    spore_activate(area, "show-all", NULL);
    break;
  case GDK_KEY_f:
    spore_viewport_frame(self);
    break;
  case GDK_KEY_0:
  case GDK_KEY_KP_0:
    spore_viewport_view(self, "camera");
    break;
  case GDK_KEY_1:
  case GDK_KEY_KP_1:
    spore_viewport_view(self, "front");
    break;
  case GDK_KEY_3:
  case GDK_KEY_KP_3:
    spore_viewport_view(self, "right");
    break;
  case GDK_KEY_7:
  case GDK_KEY_KP_7:
    spore_viewport_view(self, "top");
    break;
  default:
    return GDK_EVENT_PROPAGATE;
  }
  return GDK_EVENT_STOP;
}
