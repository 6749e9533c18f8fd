/* Places picked by hand: numbered handles on the organ, which can be dragged over its surface. */
#include "ui/viewport/spore-viewport-private.h"

static SporePose pose_of(SporeViewport *self) {
  SporeObject *body = spore_document_by_id(spore_editor_document_get(self->document), self->places.body);
  return body ? spore_body_pose(body) : spore_pose_identity();
}

static SporeVec3 in_scene(SporeViewport *self, guint k) {
  return spore_pose_apply(pose_of(self), spore_vec3_load(self->places.at[k]));
}

void spore_viewport_set_places(SporeViewport *self, const SporeViewportPlaces *places) {
  if (self->drag == DRAG_PLACE) return; /* the hand knows better */
  self->places = *places;
  spore_viewport_redraw(self);
}

/* The last one was picked last, and lies on top. */
gboolean spore_viewport_places_press(SporeViewport *self, double x, double y) {
  for (guint k = self->places.count; k-- > 0;) {
    if (!spore_viewport_handle_is_at(self, in_scene(self, k), x, y)) continue;
    self->place_held = k;
    self->place_before = spore_vec3_load(self->places.at[k]);
    self->drag = DRAG_PLACE;
    return TRUE;
  }
  return FALSE;
}

/* Beside the organ, the place stays where it was. */
void spore_viewport_places_motion(SporeViewport *self, guint32 body, SporeVec3 place) {
  if (body != self->places.body) return;
  spore_vec3_store(self->places.at[self->place_held], spore_pose_apply_inverse(pose_of(self), place));
}

void spore_viewport_places_release(SporeViewport *self, gboolean keep) {
  double *at = self->places.at[self->place_held];
  gboolean moved = spore_vec3_distance(spore_vec3_load(at), self->place_before) > 0;
  if (!keep) spore_vec3_store(at, self->place_before);
  else if (moved) g_signal_emit_by_name(self, "places-moved", &self->places);
}

static void draw_number(SporeViewport *self, cairo_t *cr, guint number, double x, double y) {
  char text[16];
  g_snprintf(text, sizeof text, "%u", number);
  spore_viewport_draw_text(self, cr, text, x + 9, y - 22);
}

void spore_viewport_places_draw(SporeViewport *self, cairo_t *cr) {
  for (guint k = 0; k < self->places.count; k++) {
    double x, y;
    SporeVec3 place = in_scene(self, k);
    if (!spore_viewport_project(self, place, &x, &y)) continue;
    spore_viewport_draw_handle(self, cr, place, TRUE);
    draw_number(self, cr, k + 1, x, y);
  }
}
