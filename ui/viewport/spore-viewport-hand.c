/* The hand: which instrument it leads, and how mouse and keys lead that one. */
#include "core/scene/compile.h"
#include "ui/document/hands.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

/* Depth of the instrument, as a part of the distance to the camera; so far do the arrow keys move it aside, too. */
#define DEPTH_A_NOTCH 0.02
#define TURN_RAD_A_PIXEL 0.01
#define NAME_PADDING 6 /* pixels, about the name in the view */
#define NAME_ASIDE 14  /* pixels, from the instrument's end */

static SporeSession *session_of(SporeViewport *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

/* Which one. */

SporeObject *spore_viewport_get_led(SporeViewport *self) {
  SporeDocument *document = self->document ? spore_editor_document_get(self->document) : NULL;
  if (!document) return NULL;
  SporeObject *chosen = spore_hand_of(document, spore_editor_document_selected(self->document));
  SporeObject *before = spore_hand_of(document, spore_document_by_id(document, self->led));
  g_autoptr(GPtrArray) hands = spore_hands(document);
  SporeObject *led = chosen ? chosen : before ? before : hands->len ? hands->pdata[0] : NULL;
  self->led = led ? spore_object_id(led) : 0;
  return led;
}

gboolean spore_viewport_probe(SporeViewport *self, guint32 *body, SporeVec3 *position) {
  SporeSession *session = session_of(self);
  SporeObject *led = session ? spore_viewport_get_led(self) : NULL;
  if (!led) return FALSE;
  const SporeSimulation *simulation = spore_session_simulation(session);
  *body = spore_simulation_body_of(simulation, led);
  if (*body == SPORE_NO_BODY || spore_world_hand(simulation->world, *body) != *body) return FALSE;
  *position = spore_vec3_load(spore_session_snapshot(session)->q + spore_world_q_offset(simulation->world, *body));
  return TRUE;
}

/* Jaws stand closed in the document; the angle between them now, less that one, is the opening. */
gboolean spore_viewport_hand_opening(SporeViewport *self, double *opening) {
  SporeObject *jaws[2];
  SporeQuat now[2], closed[2];
  SporeSession *session = session_of(self);
  const SporeObject *led = session ? spore_viewport_get_led(self) : NULL;
  if (!led || !spore_hand_jaws(spore_editor_document_get(self->document), led, jaws)) return FALSE;
  const SporeSimulation *simulation = spore_session_simulation(session);
  for (int i = 0; i < 2; i++) {
    guint32 body = spore_simulation_body_of(simulation, jaws[i]);
    if (body == SPORE_NO_BODY) return FALSE;
    const double *q = spore_session_snapshot(session)->q + spore_world_q_offset(simulation->world, body);
    now[i] = spore_quat_load(q + 3);
    closed[i] = spore_body_pose(jaws[i]).orientation;
  }
  SporeQuat between = spore_quat_multiply(spore_quat_conjugate(now[0]), now[1]);
  SporeQuat before = spore_quat_multiply(spore_quat_conjugate(closed[0]), closed[1]);
  SporeQuat turned = spore_quat_multiply(spore_quat_conjugate(before), between);
  *opening = spore_vec3_length(spore_quat_to_rotation_vector(turned));
  return TRUE;
}

/* Chooses the next or the one before, round and round. */
static void choose(SporeViewport *self, int by) {
  SporeObject *led = spore_viewport_get_led(self);
  g_autoptr(GPtrArray) hands = spore_hands(spore_editor_document_get(self->document));
  guint at = 0;
  if (!led || !g_ptr_array_find(hands, led, &at)) return;
  SporeObject *next = hands->pdata[(at + hands->len + (guint)(by + (int)hands->len)) % hands->len];
  spore_activate(GTK_WIDGET(self), "lead", g_variant_new_string(spore_object_name(next)));
}

void spore_viewport_lead_next(SporeViewport *self) { choose(self, 1); }

/* Leading it. */

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

static void lead(SporeViewport *self) {
  self->hand.t_ns = spore_clock_ns();
  spore_session_set_pointer(session_of(self), self->body, &self->hand);
}

static void lead_to(SporeViewport *self, SporeVec3 position) {
  spore_vec3_store(self->hand.position, position);
  lead(self);
}

static void hold_offset(SporeViewport *self) {
  self->offset = spore_vec3_sub(hand_position(self), spore_viewport_under_cursor(self, hand_position(self)));
}

gboolean spore_viewport_hand_press(SporeViewport *self) {
  if (!take_hand(self)) return FALSE;
  self->drag = DRAG_PROBE;
  self->hand_before = self->hand;
  hold_offset(self);
  lead(self);
  return TRUE;
}

void spore_viewport_hand_take_back(SporeViewport *self) {
  self->hand = self->hand_before;
  lead(self);
}

void spore_viewport_hand_motion(SporeViewport *self) {
  lead_to(self, spore_vec3_add(spore_viewport_under_cursor(self, hand_position(self)), self->offset));
}

void spore_viewport_hand_turn(SporeViewport *self, double dx, double dy) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  SporeVec3 turn =
      spore_vec3_add(spore_vec3_scale(dx * TURN_RAD_A_PIXEL, up), spore_vec3_scale(dy * TURN_RAD_A_PIXEL, right));
  SporeQuat orientation =
      spore_quat_multiply(spore_quat_from_rotation_vector(turn), spore_quat_load(self->hand.orientation));
  spore_quat_store(self->hand.orientation, spore_quat_normalise(orientation));
  hold_offset(self);
  lead(self);
}

/* Moves by parts of the distance to the camera: to the right, up, and away on the screen. */
static void move(SporeViewport *self, double to_right, double to_top, double away) {
  SporeVec3 eye, right, up, forward;
  if (!take_hand(self)) return;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  double depth = DEPTH_A_NOTCH * spore_vec3_distance(eye, hand_position(self));
  SporeVec3 aside = spore_vec3_add(spore_vec3_scale(to_right, right), spore_vec3_scale(to_top, up));
  SporeVec3 way = spore_vec3_add_scaled(aside, away, forward);
  lead_to(self, spore_vec3_add_scaled(hand_position(self), depth, way));
  hold_offset(self); /* the point under the cursor stays there */
}

void spore_viewport_hand_deepen(SporeViewport *self, double notches) { move(self, 0, 0, -notches); }

/* A click may be shorter than a step; so a clamp that opens goes on to do so until it is closed. */
void spore_viewport_hand_squeeze(SporeViewport *self, SporeHandSqueeze squeeze) {
  const SporeObject *led = spore_viewport_get_led(self);
  gboolean opens = self->hand.buttons == SPORE_HAND_OPENS && squeeze == SPORE_HAND_RESTS;
  if (opens && led && spore_hand_latches(spore_editor_document_get(self->document), led)) return;
  if (!take_hand(self)) return;
  self->hand.grip_rad = squeeze == SPORE_HAND_CLOSES ? 0 : G_PI;
  self->hand.buttons = squeeze; /* as bits */
  lead(self);
}

gboolean spore_viewport_hand_key(SporeViewport *self, guint key) {
  if (self->tool != SPORE_VIEWPORT_TOOL_PROBE || self->picking || !self->document) return FALSE;
  if (key == GDK_KEY_n || key == GDK_KEY_p) choose(self, key == GDK_KEY_n ? 1 : -1);
  else if (key == GDK_KEY_c) spore_viewport_hand_squeeze(self, SPORE_HAND_CLOSES);
  else if (key == GDK_KEY_o) spore_viewport_hand_squeeze(self, SPORE_HAND_OPENS);
  else if (key == GDK_KEY_l) spore_viewport_hand_squeeze(self, SPORE_HAND_RESTS);
  else if (key == GDK_KEY_Left) move(self, -1, 0, 0);
  else if (key == GDK_KEY_Right) move(self, 1, 0, 0);
  else if (key == GDK_KEY_Up) move(self, 0, 1, 0);
  else if (key == GDK_KEY_Down) move(self, 0, -1, 0);
  else if (key == GDK_KEY_Page_Up) move(self, 0, 0, 1);
  else if (key == GDK_KEY_Page_Down) move(self, 0, 0, -1);
  else return FALSE;
  spore_viewport_redraw(self);
  return TRUE;
}

/* Its name in the view. */

/* Where its body is, in the run or at the start. */
static gboolean place_of(SporeViewport *self, const SporeObject *led, SporeVec3 *place) {
  guint32 body;
  if (session_of(self)) return spore_viewport_probe(self, &body, place);
  *place = spore_body_pose(led).position;
  return TRUE;
}

/* On the right of the body, or on the left where the view ends there. */
void spore_viewport_hand_draw(SporeViewport *self, cairo_t *cr) {
  SporeVec3 place;
  double x, y;
  int wide, high;
  const SporeObject *led = self->tool == SPORE_VIEWPORT_TOOL_PROBE ? spore_viewport_get_led(self) : NULL;
  if (!led || !place_of(self, led, &place) || !spore_viewport_project(self, place, &x, &y)) return;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(self->area, spore_object_name(led));
  pango_layout_get_pixel_size(layout, &wide, &high);
  double width = wide + 2 * NAME_PADDING, height = high + 2 * NAME_PADDING;
  gboolean fits = x + NAME_ASIDE + width < gtk_widget_get_allocated_width(self->area);
  double left = fits ? x + NAME_ASIDE : x - NAME_ASIDE - width;
  cairo_move_to(cr, x, y);
  cairo_line_to(cr, fits ? left : left + width, y);
  spore_viewport_stroke(cr, (const double[4]){1, 0.78, 0.25, 1}, 1.5);
  cairo_rectangle(cr, left, y - 0.5 * height, width, height);
  cairo_set_source_rgba(cr, 0.04, 0.05, 0.055, 0.75);
  cairo_fill_preserve(cr);
  cairo_set_source_rgb(cr, 1, 0.78, 0.25);
  cairo_stroke(cr);
  cairo_move_to(cr, left + NAME_PADDING, y - 0.5 * high);
  pango_cairo_show_layout(cr, layout);
}
