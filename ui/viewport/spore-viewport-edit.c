/* The Edit tool: spheres and points of curves by hand. Each gesture is one undo step. */
#include <glib/gi18n.h>

#include "ui/panels/report.h"
#include "ui/viewport/camera-moves.h"
#include "ui/viewport/spore-viewport-private.h"

#define RADIUS_A_NOTCH 1.05
#define NOTCHES_REST_MS 400 /* wheel notches that come faster are one step */
#define STEP_PART 0.1       /* of the radius, that an arrow key moves by */

static SporeDocument *document_of(SporeViewport *self) { return spore_editor_document_get(self->document); }

static SporePose pose_of(SporeViewport *self) {
  SporeObject *body = spore_document_by_id(document_of(self), self->edit.body);
  return body ? spore_body_pose(body) : spore_pose_identity();
}

static SporeVec3 to_body(SporeViewport *self, SporeVec3 world) {
  SporePose pose = pose_of(self);
  return spore_quat_rotate(spore_quat_conjugate(pose.orientation), spore_vec3_sub(world, pose.position));
}

static SporeVec3 turned_to_body(SporeViewport *self, SporeVec3 direction) {
  return spore_quat_rotate(spore_quat_conjugate(pose_of(self).orientation), direction);
}

static double *chosen(SporeViewport *self) {
  return self->edit.chosen < self->edit.count ? self->edit.points + 4 * self->edit.chosen : NULL;
}

/* Showing. */

static void add_lines(SporeStageCandidate *candidate, const SporeHandEdit *edit) {
  candidate->line_count = edit->count - 1;
  candidate->lines = g_new(double, 6 * candidate->line_count);
  for (gsize i = 0; i < candidate->line_count; i++) {
    memcpy(candidate->lines + 6 * i, edit->points + 4 * i, 3 * sizeof(double));
    memcpy(candidate->lines + 6 * i + 3, edit->points + 4 * (i + 1), 3 * sizeof(double));
  }
}

static void show(SporeViewport *self) {
  static const SporeQuality none = {0};
  const SporeHandEdit *edit = &self->edit;
  SporeStageCandidate *candidate = edit->count ? g_new0(SporeStageCandidate, 1) : NULL;
  if (candidate) {
    candidate->body = edit->body;
    candidate->sphere_count = edit->count;
    candidate->spheres = g_memdup2(edit->points, 4 * edit->count * sizeof(double));
    candidate->chosen = edit->chosen;
    if (edit->curve) add_lines(candidate, edit);
  }
  spore_viewport_set_candidate(self, candidate, &none);
}

void spore_viewport_edit_refresh(SporeViewport *self) {
  if (self->tool != SPORE_TOOL_EDIT || !self->document || self->drag == DRAG_EDIT || self->edit_timer) return;
  spore_hand_edit_open(&self->edit, document_of(self), spore_editor_document_selected(self->document));
  show(self);
}

static void commit(SporeViewport *self, const char *label) {
  g_autoptr(GError) error = NULL;
  g_clear_handle_id(&self->edit_timer, g_source_remove);
  if (!spore_hand_edit_commit(&self->edit, document_of(self), label, &error) && error)
    spore_report(GTK_WIDGET(self), error);
  show(self);
}

void spore_viewport_edit_end(SporeViewport *self) {
  if (self->edit_timer) commit(self, _("Resize by hand"));
  if (!self->edit.count) return;
  spore_hand_edit_close(&self->edit);
  show(self);
}

/* Gestures. */

static gboolean notches_rest(gpointer data) {
  SporeViewport *self = data;
  self->edit_timer = 0;
  commit(self, _("Resize by hand"));
  return G_SOURCE_REMOVE;
}

static void pick(SporeViewport *self, double x, double y) {
  SporeVec3 origin, direction;
  spore_camera_ray(&self->camera, x, y, gtk_widget_get_allocated_width(self->area),
                   gtk_widget_get_allocated_height(self->area), &origin, &direction);
  self->edit.chosen = spore_hand_edit_pick(&self->edit, to_body(self, origin), turned_to_body(self, direction));
}

static SporeVec3 under_cursor(SporeViewport *self, SporeVec3 through) {
  return spore_camera_unproject(&self->camera, through, self->last_x, self->last_y,
                                gtk_widget_get_allocated_width(self->area),
                                gtk_widget_get_allocated_height(self->area));
}

/* Where there is one under the cursor, a drag begins. FALSE: select another body instead. */
gboolean spore_viewport_edit_press(SporeViewport *self, double x, double y) {
  if (!self->edit.count) return FALSE;
  if (self->edit_timer) commit(self, _("Resize by hand"));
  pick(self, x, y);
  show(self);
  double *sphere = chosen(self);
  if (!sphere) return FALSE;
  memcpy(self->edit_before, sphere, sizeof self->edit_before);
  SporeVec3 place = spore_pose_apply(pose_of(self), spore_vec3_load(sphere));
  self->offset = spore_vec3_sub(place, under_cursor(self, place));
  self->drag = DRAG_EDIT;
  return TRUE;
}

void spore_viewport_edit_motion(SporeViewport *self) {
  double *sphere = chosen(self);
  SporeVec3 place = spore_pose_apply(pose_of(self), spore_vec3_load(sphere));
  spore_vec3_store(sphere, to_body(self, spore_vec3_add(under_cursor(self, place), self->offset)));
  show(self);
}

void spore_viewport_edit_release(SporeViewport *self, gboolean keep) {
  double *sphere = chosen(self);
  if (!sphere || memcmp(sphere, self->edit_before, sizeof self->edit_before) == 0) return;
  if (keep) commit(self, _("Move by hand"));
  else memcpy(sphere, self->edit_before, sizeof self->edit_before);
  show(self);
}

gboolean spore_viewport_edit_scroll(SporeViewport *self, double notches) {
  double *sphere = chosen(self);
  if (!sphere) return FALSE;
  sphere[3] *= pow(RADIUS_A_NOTCH, -notches);
  g_clear_handle_id(&self->edit_timer, g_source_remove);
  self->edit_timer = g_timeout_add(NOTCHES_REST_MS, notches_rest, self);
  show(self);
  return TRUE;
}

/* Beside the chosen one, to its right on the screen. */
static void add(SporeViewport *self) {
  SporeVec3 eye, right, up, forward;
  const double *sphere = chosen(self);
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  SporeVec3 place = sphere ? spore_vec3_add_scaled(spore_vec3_load(sphere), sphere[3], turned_to_body(self, right))
                           : to_body(self, self->camera.target);
  spore_hand_edit_add(&self->edit, place, 0);
  commit(self, _("Add by hand"));
}

static void nudge(SporeViewport *self, double dx, double dy) {
  SporeVec3 eye, right, up, forward;
  double *sphere = chosen(self);
  if (!sphere) return;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  SporeVec3 move = spore_vec3_add(spore_vec3_scale(dx, right), spore_vec3_scale(dy, up));
  SporeVec3 place = spore_vec3_add_scaled(spore_vec3_load(sphere), STEP_PART * sphere[3], turned_to_body(self, move));
  spore_vec3_store(sphere, place);
  commit(self, _("Move by hand"));
}

static void resize(SporeViewport *self, double notches) {
  if (spore_viewport_edit_scroll(self, notches)) commit(self, _("Resize by hand"));
}

static void go(SporeViewport *self, gboolean back) {
  gsize last = self->edit.count - 1;
  if (self->edit.chosen > last) self->edit.chosen = back ? last : 0;
  else if (back) self->edit.chosen = self->edit.chosen ? self->edit.chosen - 1 : last;
  else self->edit.chosen = self->edit.chosen < last ? self->edit.chosen + 1 : 0;
  show(self);
}

gboolean spore_viewport_edit_key(SporeViewport *self, guint key) {
  if (self->tool != SPORE_TOOL_EDIT || !self->edit.count || self->drag != DRAG_NONE) return FALSE;
  switch (key) {
  case GDK_KEY_Delete:
    if (spore_hand_edit_remove(&self->edit)) commit(self, _("Delete by hand"));
    return TRUE;
  case GDK_KEY_Insert:
  case GDK_KEY_a:
    add(self);
    return TRUE;
  case GDK_KEY_n:
  case GDK_KEY_p:
    go(self, key == GDK_KEY_p);
    return TRUE;
  case GDK_KEY_plus:
  case GDK_KEY_KP_Add:
    resize(self, -1);
    return TRUE;
  case GDK_KEY_minus:
  case GDK_KEY_KP_Subtract:
    resize(self, 1);
    return TRUE;
  case GDK_KEY_Left:
  case GDK_KEY_Right:
    nudge(self, key == GDK_KEY_Right ? 1 : -1, 0);
    return TRUE;
  case GDK_KEY_Up:
  case GDK_KEY_Down:
    nudge(self, 0, key == GDK_KEY_Up ? 1 : -1);
    return TRUE;
  default:
    return FALSE;
  }
}
