/* The Edit tool: spheres, points of curves and regions by hand. Each gesture is one undo step. */
#include <glib/gi18n.h>

#include "core/author/region_edits.h"
#include "core/scene/region.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define RADIUS_A_NOTCH 1.05
#define NOTCHES_REST_MS 400 /* wheel notches that come faster are one step */
#define STEP_PART 0.1       /* part of the radius that an arrow key moves by */
#define LEAST_M 1e-5        /* radius */

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

static int width_of(SporeViewport *self) { return gtk_widget_get_allocated_width(self->area); }
static int height_of(SporeViewport *self) { return gtk_widget_get_allocated_height(self->area); }

static gboolean edits_regions(const SporeViewport *self) { return self->edit.kind == SPORE_HAND_REGIONS; }

/* Handles. Each region has a handle in the middle, because nothing solid shows it. The chosen one has a handle on its
 * rim. */

static SporeVec3 middle_of(SporeViewport *self, const double *ball) {
  return spore_pose_apply(pose_of(self), spore_vec3_load(ball));
}

static SporeVec3 rim_of(SporeViewport *self, const double *ball) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  return spore_vec3_add_scaled(middle_of(self, ball), ball[3], right);
}

void spore_viewport_edit_draw(SporeViewport *self, cairo_t *cr) {
  const double *ball = chosen(self);
  if (self->tool != SPORE_VIEWPORT_TOOL_EDIT) return;
  for (gsize i = 0; edits_regions(self) && i < self->edit.count; i++)
    spore_viewport_draw_handle(self, cr, middle_of(self, self->edit.points + 4 * i), i == self->edit.chosen);
  if (ball) spore_viewport_draw_handle(self, cr, rim_of(self, ball), TRUE);
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

/* The chosen region is coloured on the organ. */
static void show_region(SporeViewport *self) {
  SporeObject *holder = edits_regions(self) ? spore_document_by_id(document_of(self), self->edit.asset) : NULL;
  const SporeObject *region = holder && self->edit.chosen < spore_object_child_count(holder)
                                  ? spore_object_child(holder, (guint)self->edit.chosen)
                                  : NULL;
  guint count;
  g_autofree double *balls = spore_region_balls(region, &count);
  if (self->stage) spore_stage_set_painted(self->stage, region ? self->edit.body : 0, balls, count);
}

static void show(SporeViewport *self) {
  static const SporeQuality none = {0};
  const SporeHandEdit *edit = &self->edit;
  show_region(self);
  gboolean solid = edit->count && !edits_regions(self); /* rings show regions */
  SporeStageCandidate *candidate = solid ? g_new0(SporeStageCandidate, 1) : NULL;
  if (candidate) {
    candidate->body = edit->body;
    candidate->sphere_count = edit->count;
    candidate->spheres = g_memdup2(edit->points, 4 * edit->count * sizeof(double));
    candidate->chosen = edit->chosen;
    if (edit->kind == SPORE_HAND_CURVE) add_lines(candidate, edit);
  }
  spore_viewport_set_candidate(self, candidate, &none);
  spore_viewport_redraw(self);
}

void spore_viewport_edit_refresh(SporeViewport *self) {
  if (self->tool != SPORE_VIEWPORT_TOOL_EDIT || !self->document || self->drag == DRAG_EDIT || self->edit_timer) return;
  SporeObject *holder = self->regions ? spore_document_by_id(document_of(self), self->regions) : NULL;
  if (spore_viewport_is_locked(self) || self->brush.body) spore_hand_edit_close(&self->edit);
  else if (holder) spore_hand_edit_open_regions(&self->edit, document_of(self), holder);
  else spore_hand_edit_open(&self->edit, document_of(self), spore_editor_document_selected(self->document));
  show(self);
}

void spore_viewport_edit_region(SporeViewport *self, SporeObject *region) {
  SporeObject *holder = spore_object_parent(region);
  self->regions = spore_object_id(holder);
  spore_viewport_edit_refresh(self);
  for (guint i = 0; i < spore_object_child_count(holder); i++)
    if (spore_object_child(holder, i) == region) self->edit.chosen = i;
  show(self);
}

gboolean spore_viewport_has_edited(SporeViewport *self) { return self->edit.count > 0; }

gboolean spore_viewport_edits_regions(SporeViewport *self) {
  return self->tool == SPORE_VIEWPORT_TOOL_EDIT && self->regions;
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

/* TRUE: a handle was there. */
static gboolean pick_handle(SporeViewport *self, double x, double y) {
  const double *ball = chosen(self);
  self->edit_resizes = ball && spore_viewport_handle_is_at(self, rim_of(self, ball), x, y);
  if (self->edit_resizes) return TRUE;
  if (edits_regions(self) && ball && spore_viewport_handle_is_at(self, middle_of(self, ball), x, y)) return TRUE;
  for (gsize i = 0; edits_regions(self) && i < self->edit.count; i++) {
    if (!spore_viewport_handle_is_at(self, middle_of(self, self->edit.points + 4 * i), x, y)) continue;
    self->edit.chosen = i;
    return TRUE;
  }
  return FALSE;
}

static void pick(SporeViewport *self, double x, double y) {
  SporeVec3 origin, direction;
  spore_camera_ray(&self->camera, x, y, width_of(self), height_of(self), &origin, &direction);
  self->edit.chosen = spore_hand_edit_pick(&self->edit, to_body(self, origin), turned_to_body(self, direction));
}

/* Regions change in the scene during the drag, so that their numbers in the inspector change too. */
static void write_region(SporeViewport *self) {
  g_autoptr(GError) error = NULL;
  if (edits_regions(self) && !spore_hand_edit_write_region(&self->edit, document_of(self), &error) && error)
    spore_report(GTK_WIDGET(self), error);
}

static void begin_drag(SporeViewport *self) {
  const double *ball = chosen(self);
  memcpy(self->edit_before, ball, sizeof self->edit_before);
  SporeVec3 held = self->edit_resizes ? rim_of(self, ball) : middle_of(self, ball);
  self->offset = spore_vec3_sub(held, spore_viewport_under_cursor(self, held));
  self->drag = DRAG_EDIT;
  if (edits_regions(self)) spore_document_begin(document_of(self), _("Place region"));
}

/* Begins a drag where a handle, sphere or point is under the cursor. FALSE: select another body instead. */
gboolean spore_viewport_edit_press(SporeViewport *self, double x, double y) {
  if (!self->edit.count) return FALSE;
  if (self->edit_timer) commit(self, _("Resize by hand"));
  if (!pick_handle(self, x, y)) {
    if (edits_regions(self)) return FALSE;
    pick(self, x, y);
  }
  show(self);
  if (!chosen(self)) return FALSE;
  begin_drag(self);
  return TRUE;
}

gboolean spore_viewport_edit_place(SporeViewport *self, guint32 body, SporeVec3 place) {
  double *ball = chosen(self);
  if (!spore_viewport_edits_regions(self) || !ball || body != self->edit.body) return FALSE;
  self->edit_resizes = FALSE;
  begin_drag(self);
  self->offset = (SporeVec3){0, 0, 0};
  spore_vec3_store(ball, to_body(self, place));
  write_region(self);
  show(self);
  return TRUE;
}

void spore_viewport_edit_motion(SporeViewport *self) {
  double *ball = chosen(self);
  if (!ball) return;
  SporeVec3 middle = middle_of(self, ball), held = self->edit_resizes ? rim_of(self, ball) : middle;
  SporeVec3 led = spore_vec3_add(spore_viewport_under_cursor(self, held), self->offset);
  if (self->edit_resizes) ball[3] = fmax(spore_vec3_distance(led, middle), LEAST_M);
  else spore_vec3_store(ball, to_body(self, led));
  write_region(self);
  show(self);
}

void spore_viewport_edit_release(SporeViewport *self, gboolean keep) {
  double *ball = chosen(self);
  if (edits_regions(self)) {
    if (keep) spore_document_end(document_of(self));
    else spore_document_abort(document_of(self));
    spore_viewport_edit_refresh(self);
    return;
  }
  if (!ball || memcmp(ball, self->edit_before, sizeof self->edit_before) == 0) return;
  if (keep) commit(self, self->edit_resizes ? _("Resize by hand") : _("Move by hand"));
  else memcpy(ball, self->edit_before, sizeof self->edit_before);
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

/* Adds a sphere, point or region beside the chosen one, to its right on the screen. */
static void add(SporeViewport *self) {
  if (edits_regions(self)) {
    SporeObject *holder = spore_document_by_id(document_of(self), self->edit.asset);
    g_autofree char *path = spore_object_path(holder);
    spore_activate(GTK_WIDGET(self), "add-region", g_variant_new_string(path));
    self->edit.chosen = self->edit.count - 1; /* the edit was reopened when the document changed */
    show(self);
    return;
  }
  SporeVec3 eye, right, up, forward;
  const double *sphere = chosen(self);
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  SporeVec3 place = sphere ? spore_vec3_add_scaled(spore_vec3_load(sphere), sphere[3], turned_to_body(self, right))
                           : to_body(self, self->camera.target);
  spore_hand_edit_add(&self->edit, place, 0);
  commit(self, _("Add by hand"));
}

static void delete_chosen(SporeViewport *self) {
  SporeObject *holder = edits_regions(self) ? spore_document_by_id(document_of(self), self->edit.asset) : NULL;
  if (holder && chosen(self)) {
    g_autofree char *path = spore_object_path(spore_object_child(holder, (guint)self->edit.chosen));
    self->edit.chosen = G_MAXSIZE;
    spore_activate(GTK_WIDGET(self), "remove-region", g_variant_new_string(path));
  } else if (!holder && spore_hand_edit_remove(&self->edit)) {
    commit(self, _("Delete by hand"));
  }
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
  if (self->tool != SPORE_VIEWPORT_TOOL_EDIT || !self->edit.count || self->drag != DRAG_NONE) return FALSE;
  switch (key) {
  case GDK_KEY_Delete:
    delete_chosen(self);
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
