/* The cut plane: it hides what lies before it, so that the inside of bodies is seen. It is of the view alone. */
#include "ui/viewport/spore-viewport-private.h"

/* Where the planes stand. All look along their direction at what they leave. */
static const struct {
  const char *name;
  SporeVec3 normal; /* zeros: towards the eye */
} cuts[] = {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}, {"view", {0, 0, 0}}};

static SporeVec3 normal_of(SporeViewport *self) {
  SporeVec3 eye, right, up, forward, normal = cuts[self->cut - 1].normal;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  return spore_vec3_length(normal) > 0 ? normal : spore_vec3_scale(-1, forward);
}

/* How far the box that was chosen reaches along the direction. */
static void reach_along(SporeViewport *self, SporeVec3 normal, double *low, double *high) {
  *low = HUGE_VAL, *high = -HUGE_VAL;
  for (int corner = 0; corner < 8; corner++) {
    SporeVec3 p = {self->cut_box[corner & 1][0], self->cut_box[corner >> 1 & 1][1], self->cut_box[corner >> 2 & 1][2]};
    *low = fmin(*low, spore_vec3_dot(normal, p));
    *high = fmax(*high, spore_vec3_dot(normal, p));
  }
}

SporeClip spore_viewport_clip(SporeViewport *self) {
  double low, high;
  if (!self->cut) return (SporeClip){0};
  SporeVec3 normal = normal_of(self);
  reach_along(self, normal, &low, &high);
  double share = gtk_range_get_value(GTK_RANGE(self->cut_slider));
  SporeClip clip = {normal, high - share * (high - low)};
  return self->cut_turned ? (SporeClip){spore_vec3_scale(-1, normal), -clip.distance} : clip;
}

void spore_viewport_clip_picking(SporeViewport *self) {
  SporeClip clip = spore_viewport_clip(self);
  spore_stage_set_clip(self->stage, &clip);
}

/* The plane goes over what is there now; what moves later does not take it along. */
void spore_viewport_set_cut(SporeViewport *self, const char *name) {
  guint cut = 0;
  for (guint i = 0; i < G_N_ELEMENTS(cuts); i++)
    if (g_str_equal(cuts[i].name, name)) cut = i + 1;
  if (cut && !self->cut) gtk_range_set_value(GTK_RANGE(self->cut_slider), 0.5);
  self->cut = cut;
  if (self->stage) spore_stage_bounds(self->stage, self->cut_box[0], self->cut_box[1]);
  gtk_widget_set_visible(self->cut_slider, cut != 0);
  spore_viewport_redraw(self);
}

void spore_viewport_turn_cut(SporeViewport *self, gboolean turned) {
  self->cut_turned = turned;
  spore_viewport_redraw(self);
}

void spore_viewport_cut_moved(GtkRange *slider, SporeViewport *self) { spore_viewport_redraw(self); }
