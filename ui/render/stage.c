#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/mesh/bvh.h"
#include "core/scene/schema_fields.h"
#include "ui/render/stage_body.h"

#define FIT_SCALE 0.02 /* of the diagonal: the error that has the last colour of the scale */

SporeStage *spore_stage_new(SporeRenderer *renderer, SporeDocument *document) {
  SporeStage *stage = g_new0(SporeStage, 1);
  stage->renderer = renderer;
  stage->document = document;
  stage->options.surfaces = TRUE;
  stage->bodies = g_ptr_array_new();
  stage->fit = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  stage->contacts = g_array_new(FALSE, FALSE, sizeof(double));
  return stage;
}

static void clear(SporeStage *stage) {
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_free(stage, stage->bodies->pdata[i]);
  g_ptr_array_set_size(stage->bodies, 0);
  if (stage->contact_handle) spore_renderer_remove(stage->renderer, stage->contact_handle);
  stage->contact_handle = 0;
}

void spore_stage_free(SporeStage *stage) {
  if (!stage) return;
  spore_stage_set_candidate(stage, NULL);
  spore_stage_set_marks(stage, NULL);
  clear(stage);
  g_ptr_array_free(stage->bodies, TRUE);
  g_hash_table_destroy(stage->fit);
  g_array_free(stage->contacts, TRUE);
  g_free(stage);
}

void spore_stage_rebuild(SporeStage *stage, const SporeSimulation *simulation) {
  static const float contact_colour[3] = {0.95f, 0.62f, 0.05f};
  clear(stage);
  stage->simulation = simulation;
  stage->cut_count = 0;
  const SporeObject *bodies = spore_document_section(stage->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    g_ptr_array_add(stage->bodies, spore_stage_body_new(stage, spore_object_child(bodies, i), simulation, NULL));
  stage->contact_handle = spore_renderer_add_lines(stage->renderer, NULL, 0, contact_colour, 2.5f);
  spore_renderer_set_visible(stage->renderer, stage->contact_handle, stage->options.contacts);
  spore_stage_place_candidate(stage);
  spore_stage_place_marks(stage);
}

/* Each contact as a line from its point along its force; the length grows with the force but never fills the picture.
 */
static void show_contacts(SporeStage *stage, const SporeSnapshot *snapshot) {
  double lower[3], upper[3];
  spore_stage_bounds(stage, lower, upper);
  double longest = 0.25 * spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
  gsize count = MIN(snapshot->contact_count, snapshot->contact_capacity);
  g_array_set_size(stage->contacts, (guint)(6 * count));
  double *out = (double *)stage->contacts->data;
  for (gsize i = 0; i < count; i++, out += 6) {
    const SporeSnapshotContact *contact = &snapshot->contacts[i];
    double force = spore_vec3_length(contact->force);
    double scale = longest / (1 + force); /* 1 N is half of the longest */
    spore_vec3_store(out, contact->point);
    spore_vec3_store(out + 3, spore_vec3_add_scaled(contact->point, scale, contact->force));
  }
  spore_renderer_move_lines(stage->renderer, stage->contact_handle, (const double *)stage->contacts->data, count);
}

static void show_cuts(SporeStage *stage, const SporeSnapshot *snapshot) {
  if (stage->cut_count == snapshot->cuts.count && stage->cut_run == snapshot->cut_run) return;
  stage->cut_count = snapshot->cuts.count;
  stage->cut_run = snapshot->cut_run;
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_cut(stage, stage->bodies->pdata[i], &snapshot->cuts);
}

/* The body as it is drawn, at the level that the snapshot has of it. */
static SporeStageBody *body_of_level(SporeStage *stage, guint index, const SporeSnapshot *snapshot) {
  SporeStageBody *body = stage->bodies->pdata[index];
  if (!snapshot->level || body->world_body == SPORE_NO_BODY) return body;
  SporeLevelGrade level = (SporeLevelGrade)snapshot->level[body->world_body];
  SporeObject *object = level == body->level ? NULL : spore_document_by_id(stage->document, body->object);
  if (!object) return body;
  spore_stage_body_free(stage, body);
  return stage->bodies->pdata[index] = spore_stage_body_new(stage, object, stage->simulation, &level);
}

void spore_stage_update(SporeStage *stage, const SporeSnapshot *snapshot) {
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = body_of_level(stage, i, snapshot);
    if (!body->moves) continue;
    const double *q = snapshot->q + body->q_offset;
    spore_stage_body_follow_knots(body, stage->simulation, snapshot);
    gboolean divided = body->cells && body->divided != snapshot->cuts.parted;
    if (!divided && memcmp(body->q, q, body->q_count * sizeof *q) == 0) continue;
    memcpy(body->q, q, body->q_count * sizeof *q);
    spore_stage_body_divide(stage, body, &snapshot->cuts);
    spore_stage_body_place(stage, body);
  }
  show_cuts(stage, snapshot);
  if (stage->marks_handle) spore_renderer_set_visible(stage->renderer, stage->marks_handle, snapshot->step == 0);
  if (stage->options.contacts && stage->contact_handle) show_contacts(stage, snapshot);
}

void spore_stage_set_options(SporeStage *stage, const SporeStageOptions *options) {
  stage->options = *options;
  for (guint i = 0; i < stage->bodies->len; i++) {
    spore_stage_body_show(stage, stage->bodies->pdata[i]);
    spore_stage_body_place(stage, stage->bodies->pdata[i]);
  }
  if (stage->contact_handle) spore_renderer_set_visible(stage->renderer, stage->contact_handle, options->contacts);
}

void spore_stage_set_selection(SporeStage *stage, guint32 object_id) {
  const SporeObject *object = object_id ? spore_document_by_id(stage->document, object_id) : NULL;
  while (object && strcmp(spore_object_type(object)->element, "body") != 0) object = spore_object_parent(object);
  stage->selection = object ? spore_object_id(object) : 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = stage->bodies->pdata[i];
    gboolean selected = body->object == stage->selection;
    if (body->style.selected == selected) continue;
    body->style.selected = selected;
    if (body->surface_handle) spore_renderer_style_surface(stage->renderer, body->surface_handle, &body->style);
  }
}

static void take_in(double lower[3], double upper[3], const double *p, double radius) {
  for (int i = 0; i < 3; i++) {
    lower[i] = MIN(lower[i], p[i] - radius);
    upper[i] = MAX(upper[i], p[i] + radius);
  }
}

void spore_stage_bounds(const SporeStage *stage, double lower[3], double upper[3]) {
  for (int i = 0; i < 3; i++) lower[i] = HUGE_VAL, upper[i] = -HUGE_VAL;
  for (guint b = 0; b < stage->bodies->len; b++) {
    const SporeStageBody *body = stage->bodies->pdata[b];
    for (gsize i = 0; i < body->surface.count; i++) take_in(lower, upper, body->surface.positions + 3 * i, 0);
    for (gsize i = 0; body->solid && i < body->shown; i++)
      take_in(lower, upper, body->spheres + 4 * i, body->spheres[4 * i + 3]);
  }
  const SporeStageCandidate *candidate = stage->candidate;
  for (gsize i = 0; candidate && !candidate->body && i < candidate->vertex_count; i++)
    take_in(lower, upper, candidate->vertices + 3 * i, 0);
  if (!(lower[0] <= upper[0])) /* an empty scene: a place the size of a hand */
    for (int i = 0; i < 3; i++) lower[i] = -0.05, upper[i] = 0.05;
}

/* The first camera, or the one of that name. */
static const SporeObject *find_camera(const SporeStage *stage, const char *name) {
  if (name) return spore_document_find(stage->document, "camera", name);
  return spore_object_child_of(spore_document_section(stage->document, "tools"), "camera");
}

/* Where a point of the scene at the start has come with a body that moves as a whole; as it is with any other. */
static SporeVec3 carried(const SporeStage *stage, const SporeObject *body, SporeVec3 point) {
  SporeBodyFields fields;
  for (guint i = 0; body && i < stage->bodies->len; i++) {
    const SporeStageBody *shown = stage->bodies->pdata[i];
    if (shown->object != spore_object_id(body) || !shown->moves || shown->q_count != 7) continue;
    spore_object_fields(body, &fields);
    SporeQuat start = spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation));
    SporeVec3 arm = spore_vec3_sub(point, spore_vec3_load(fields.position));
    SporePose now = {spore_vec3_load(shown->q), spore_quat_load(shown->q + 3)};
    return spore_pose_apply(now, spore_quat_rotate(spore_quat_conjugate(start), arm));
  }
  return point;
}

gboolean spore_stage_has_camera(const SporeStage *stage) { return find_camera(stage, NULL) != NULL; }

/* A camera of the scene was placed for a picture as wide as this; a narrower one shows as much to the sides. */
#define AUTHORED_ASPECT (16.0 / 9)

static SporeCamera look_from(SporeVec3 position, SporeVec3 target, double field_of_view) {
  SporeVec3 back = spore_vec3_sub(position, target);
  double distance = spore_vec3_length(back);
  if (!(distance > 0)) back = spore_vec3(0, 0, 1), distance = 1e-3;
  return (SporeCamera){.target = target,
                       .distance = distance,
                       .azimuth = atan2(back.x, back.z),
                       .elevation = asin(CLAMP(back.y / spore_vec3_length(back), -1, 1)),
                       .field_of_view = field_of_view};
}

/* It is level at the start, and turns with its body. */
static SporeCamera look_with(const SporeStage *stage, const SporeObject *object) {
  SporeCameraFields fields;
  SporeVec3 eye, right, up, forward;
  spore_object_fields(object, &fields);
  SporeVec3 position = spore_vec3_load(fields.position), target = spore_vec3_load(fields.target);
  const SporeObject *body = spore_object_reference(object, "body");
  SporeCamera camera = look_from(position, target, fields.field_of_view);
  if (!body) return camera;
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  SporeVec3 now = carried(stage, body, target);
  SporeVec3 upward = spore_vec3_sub(carried(stage, body, spore_vec3_add(target, up)), now);
  camera = look_from(carried(stage, body, position), now, fields.field_of_view);
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  camera.roll = atan2(spore_vec3_dot(upward, right), spore_vec3_dot(upward, up));
  return camera;
}

gboolean spore_stage_camera(const SporeStage *stage, const char *name, double aspect, SporeCamera *camera,
                            GError **error) {
  const SporeObject *object = find_camera(stage, name);
  if (!object && name)
    return spore_error_raise(error, SPORE_ERROR_INPUT, name,
                             _("the scene has no camera of this name; a camera among its tools was expected; leave the "
                               "name out to see everything"));
  if (!object) {
    double lower[3], upper[3];
    spore_stage_bounds(stage, lower, upper);
    *camera = (SporeCamera){.azimuth = 0.5, .elevation = 0.35};
    spore_camera_frame(camera, lower, upper, aspect);
    return TRUE;
  }
  *camera = look_with(stage, object);
  if (aspect < AUTHORED_ASPECT)
    camera->field_of_view = 2 * atan(tan(camera->field_of_view / 2) * AUTHORED_ASPECT / aspect);
  return TRUE;
}

const SporeStageFit *spore_stage_fit(SporeStage *stage, SporeObject *asset, const SporeSphereSet *set) {
  if (set->weights) return NULL; /* it is their sum that fits, which one alone says nothing of */
  SporeStageFit *fit = g_hash_table_lookup(stage->fit, set);
  if (fit) return fit;
  const char *name = spore_object_text(asset, "source");
  SporeObject *source = name ? spore_document_find(stage->document, "mesh", name) : NULL;
  const SporeTriangleMesh *mesh = source ? spore_document_mesh(stage->document, source, NULL) : NULL;
  SporeMeshReport report;
  SporeBvh *bvh = mesh && spore_triangle_mesh_report(mesh, &report, NULL) ? spore_bvh_create(mesh, NULL) : NULL;
  if (!bvh) return NULL;
  fit = g_malloc(sizeof *fit + set->count * sizeof *fit->places);
  fit->high = FIT_SCALE * report.diagonal;
  for (gsize i = 0; i < set->count; i++) {
    const double *sphere = set->spheres + 4 * i;
    double error = fabs(sphere[3] - spore_bvh_depth(bvh, spore_vec3_load(sphere)));
    fit->places[i] = (float)MIN(error / fit->high, 1.0);
  }
  spore_bvh_free(bvh);
  g_hash_table_insert(stage->fit, (gpointer)set, fit);
  return fit;
}

SporeSphereScale spore_stage_sphere_scale(const SporeStage *stage) {
  SporeSphereScale scale = {0};
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (!body->fit_high || !spore_stage_body_shows_spheres(stage, body)) continue;
    scale.high = scale.share && scale.high != body->fit_high ? 0 : body->fit_high;
    scale.share = FIT_SCALE;
  }
  return scale;
}
