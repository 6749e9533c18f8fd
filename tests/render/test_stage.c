/* The stage on the minimal scene: a ball over a floor, at rest and running. */
#include <math.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/author/link_edits.h"
#include "core/io/scene_xml.h"
#include "core/scene/schema_fields.h"
#include "models/registry.h"
#include "tests/render/scenery.h"
#include "ui/render/shader_needs.h"
#include "ui/render/stage_body.h"

#define MINIMAL SPORE_SCENES "/minimal.spore"

typedef struct Setting {
  Bench bench;
  SporeSchema *schema;
  SporeDocument *document;
  SporeSimulation *simulation; /* NULL until it runs */
  SporeStage *stage;
} Setting;

static Setting setting_open(const char *scene) {
  GError *error = NULL;
  Setting setting = {.bench = bench_open(),
                     .schema = spore_schema_new(spore_model_registry, spore_generator_elements())};
  setting.document = spore_scene_load(setting.schema, scene, &error);
  g_assert_no_error(error);
  setting.stage = spore_stage_new(setting.bench.renderer, setting.document);
  spore_stage_rebuild(setting.stage, NULL);
  return setting;
}

static void setting_run(Setting *setting, int steps) {
  GError *error = NULL;
  setting->simulation = spore_simulation_new(setting->document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  spore_stage_rebuild(setting->stage, setting->simulation);
  for (int i = 0; i < steps; i++) spore_world_step(setting->simulation->world);
  spore_stage_update(setting->stage, spore_world_snapshot_acquire(setting->simulation->world));
}

static void setting_close(Setting *setting) {
  spore_stage_free(setting->stage);
  if (setting->simulation) spore_simulation_free(setting->simulation);
  spore_document_free(setting->document);
  spore_schema_free(setting->schema);
  bench_close(&setting->bench);
}

static guint32 id_of(const Setting *setting, const char *body) {
  return spore_object_id(spore_document_find(setting->document, "body", body));
}

static guint32 pick_down(const Setting *setting, double x, double z, SporeVec3 *point) {
  return spore_stage_pick(setting->stage, spore_vec3(x, 1, z), spore_vec3(0, -1, 0), point);
}

static void test_standing(void) {
  Setting setting = setting_open(MINIMAL);
  double lower[3], upper[3];
  SporeVec3 point = {0};
  spore_stage_bounds(setting.stage, lower, upper);
  g_assert_cmpfloat_with_epsilon(lower[0], -0.065, 1e-9);
  g_assert_cmpfloat_with_epsilon(upper[1], 0.08, 1e-4);
  g_assert_cmpuint(pick_down(&setting, 0.0015, 0.001, &point), ==, id_of(&setting, "ball"));
  g_assert_cmpfloat_with_epsilon(point.y, 0.08, 1e-4);
  g_assert_cmpuint(pick_down(&setting, 0.05, 0.05, &point), ==, id_of(&setting, "floor"));
  g_assert_cmpfloat_with_epsilon(point.y, 0, 1e-9);
  g_assert_cmpuint(pick_down(&setting, 1, 1, &point), ==, 0);
  g_autoptr(GHashTable) ball = g_hash_table_new(NULL, NULL);
  SporeVec3 above = {0.0015, 1, 0.001}, down = {0, -1, 0};
  g_hash_table_add(ball, GUINT_TO_POINTER(id_of(&setting, "ball")));
  g_assert_cmpuint(spore_stage_pick_past(setting.stage, ball, above, down, &point), ==, id_of(&setting, "floor"));
  setting_close(&setting);
}

static void test_follows_the_simulation(void) {
  Setting setting = setting_open(MINIMAL);
  SporeVec3 point = {0};
  setting_run(&setting, 0);
  g_assert_cmpuint(pick_down(&setting, 0.0015, 0.001, &point), ==, id_of(&setting, "ball"));
  g_assert_cmpfloat_with_epsilon(point.y, 0.08, 1e-4);
  for (int i = 0; i < 60; i++) spore_world_step(setting.simulation->world); /* 60 ms of falling */
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(setting.simulation->world);
  spore_stage_update(setting.stage, snapshot);
  g_assert_cmpuint(pick_down(&setting, 0.0015, 0.001, &point), ==, id_of(&setting, "ball"));
  double fallen = 0.5 * 9.81 * snapshot->time_s * snapshot->time_s;
  g_assert_cmpfloat_with_epsilon(point.y, 0.08 - fallen, 4e-4);
  setting_close(&setting);
}

/* What a plane hides is not picked: of the ball, which is closed, the face of the cut is; of a sphere, its inside. */
static void test_picked_behind_a_plane(void) {
  Setting setting = setting_open(MINIMAL);
  SporeVec3 point = {0};
  const SporeClip half = {{0, 1, 0}, 0.06}, all = {{0, 1, 0}, -1};
  spore_stage_set_clip(setting.stage, &half);
  g_assert_cmpuint(pick_down(&setting, 0.0015, 0.001, &point), ==, id_of(&setting, "ball"));
  g_assert_cmpfloat_with_epsilon(point.y, 0.06, 1e-9);
  spore_stage_set_clip(setting.stage, &all);
  g_assert_cmpuint(pick_down(&setting, 0.0015, 0.001, &point), ==, 0);
  GError *error = NULL;
  SporeObject *floor = spore_document_find(setting.document, "body", "floor");
  spore_document_remove(setting.document, spore_object_child_of(floor, "visual"), &error);
  g_assert_no_error(error);
  const SporeClip top = {{0, 1, 0}, -0.001};
  spore_stage_set_clip(setting.stage, &top);
  spore_stage_rebuild(setting.stage, NULL);
  g_assert_cmpuint(pick_down(&setting, 0.03, 0.03, &point), ==, id_of(&setting, "floor"));
  g_assert_cmpfloat(point.y, <, -0.001);
  spore_stage_set_clip(setting.stage, &all);
  g_assert_cmpuint(pick_down(&setting, 0.03, 0.03, &point), ==, 0);
  setting_close(&setting);
}

/* What is held falls as the ball does. */
static void check_falls_along(Setting *setting, const SporeStageHold *hold, SporeVec3 point) {
  SporeVec3 now;
  for (int i = 0; i < 60; i++) spore_world_step(setting->simulation->world);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(setting->simulation->world);
  spore_stage_update(setting->stage, snapshot);
  g_assert_true(spore_stage_held(setting->stage, hold, &now));
  g_assert_cmpfloat_with_epsilon(now.x, point.x, 1e-9);
  g_assert_cmpfloat_with_epsilon(now.y, point.y - 0.5 * 9.81 * snapshot->time_s * snapshot->time_s, 4e-4);
}

/* A place on the face of a cut goes with the body, as deep in it as it was picked. From the side that the plane leaves,
 * the surface is picked. */
static void test_held_within(void) {
  Setting setting = setting_open(MINIMAL);
  SporeVec3 point = {0}, now = {0};
  SporeStageHold hold;
  const SporeClip half = {{0, 1, 0}, 0.063};
  const SporeVec3 above = {0.004, 1, 0.003}, down = {0, -1, 0};
  setting_run(&setting, 0);
  spore_stage_set_clip(setting.stage, &half);
  g_assert_cmpuint(spore_stage_pick_hold(setting.stage, above, down, &point, &hold), ==, id_of(&setting, "ball"));
  g_assert_cmpfloat_with_epsilon(point.y, 0.063, 1e-9);
  g_assert_true(spore_stage_held(setting.stage, &hold, &now));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(now, point), 0, 1e-12);
  check_falls_along(&setting, &hold, point);
  const SporeVec3 below = {0.004, 0.02, 0.003}, up = {0, 1, 0};
  g_assert_cmpuint(spore_stage_pick_hold(setting.stage, below, up, &point, &hold), ==, id_of(&setting, "ball"));
  g_assert_cmpfloat(point.y, <, 0.05);
  g_assert_cmpfloat(hold.above, ==, 0);
  setting_close(&setting);
}

/* What is held goes with the body, until the body is drawn with other triangles. */
static void test_held_places(void) {
  Setting setting = setting_open(MINIMAL);
  SporeVec3 point = {0}, now = {0};
  SporeStageHold hold;
  SporeTriangleMesh surface;
  const SporeVec3 above = {0.004, 1, 0.003}, down = {0, -1, 0};
  setting_run(&setting, 0);
  g_assert_cmpuint(spore_stage_pick_hold(setting.stage, above, down, &point, &hold), ==, id_of(&setting, "ball"));
  g_assert_true(spore_stage_held(setting.stage, &hold, &now));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(now, point), 0, 1e-12);
  SporeVec3 before = {0};
  g_assert_true(spore_stage_held_at_rest(setting.stage, &hold, &before));
  const SporePose start = spore_body_pose(spore_document_by_id(setting.document, hold.body));
  g_assert_cmpfloat(spore_vec3_distance(spore_pose_apply(start, before), point), <, 1e-12);
  check_falls_along(&setting, &hold, point);
  g_assert_true(spore_stage_held_at_rest(setting.stage, &hold, &now));
  g_assert_cmpfloat(spore_vec3_distance(now, before), ==, 0); /* the body has moved, and its rest has not */
  g_assert_true(spore_stage_surface(setting.stage, hold.body, &surface));
  g_assert_cmpuint(surface.vertex_count, ==, hold.count);
  hold.count++;
  g_assert_false(spore_stage_held(setting.stage, &hold, &now));
  hold.count--, hold.body = 0;
  g_assert_false(spore_stage_held(setting.stage, &hold, &now));
  g_assert_false(spore_stage_held_at_rest(setting.stage, &hold, &now));
  setting_close(&setting);
}

/* A body without a mesh shows its spheres. */
static void test_spheres_alone(void) {
  Setting setting = setting_open(MINIMAL);
  SporeVec3 point = {0};
  GError *error = NULL;
  SporeObject *floor = spore_document_find(setting.document, "body", "floor");
  spore_document_remove(setting.document, spore_object_child_of(floor, "visual"), &error);
  g_assert_no_error(error);
  spore_stage_rebuild(setting.stage, NULL);
  g_assert_cmpuint(pick_down(&setting, 0.03, 0.03, &point), ==, id_of(&setting, "floor"));
  g_assert_cmpfloat_with_epsilon(point.y, 0, 1e-6); /* the top of a sphere */
  SporeStageHold hold;
  SporeVec3 now = {0};
  spore_stage_pick_hold(setting.stage, spore_vec3(0.03, 1, 0.03), spore_vec3(0, -1, 0), &point, &hold);
  g_assert_true(hold.on_sphere && spore_stage_held(setting.stage, &hold, &now));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(now, point), 0, 1e-12);
  spore_document_undo(setting.document);
  spore_stage_rebuild(setting.stage, NULL);
  g_assert_cmpuint(pick_down(&setting, 0.06, 0.06, &point), ==, id_of(&setting, "floor"));
  setting_close(&setting);
}

/* Spheres with weights are as large as they are felt. */
static void test_weighted_spheres(void) {
  Setting setting = setting_open(MINIMAL);
  static const char text[] = "# level 0.025\n0 0 0 0.1 0.5\n";
  SporeVec3 point = {0};
  GError *error = NULL;
  SporeObject *floor = spore_document_find(setting.document, "body", "floor");
  SporeObject *asset = spore_object_reference(spore_object_child_of(floor, "collision"), "spheres");
  g_autoptr(GBytes) content = g_bytes_new_static(text, sizeof text - 1);
  spore_document_put_blob(setting.document, "felt.spheres", content);
  spore_document_set_text(setting.document, asset, "file", "felt.spheres", &error);
  g_assert_no_error(error);
  spore_document_remove(setting.document, spore_object_child_of(floor, "visual"), &error);
  g_assert_no_error(error);
  spore_stage_rebuild(setting.stage, NULL);
  SporeVec3 centre = spore_body_pose(floor).position;
  g_assert_cmpuint(pick_down(&setting, centre.x + 0.03, centre.z, &point), ==, id_of(&setting, "floor"));
  g_assert_cmpfloat_with_epsilon(point.y, centre.y + 0.04, 1e-4);
  setting_close(&setting);
}

static int changed_pixels(const Setting *setting, const SporeStageOptions *options) {
  static const SporeStageOptions surfaces = {.surfaces = TRUE};
  SporeCamera camera;
  g_assert_true(spore_stage_camera(setting->stage, NULL, 4.0 / 3, &camera, NULL));
  Picture pictures[2];
  for (int i = 0; i < 2; i++) {
    spore_stage_set_options(setting->stage, i ? options : &surfaces);
    pictures[i] = draw_picture(setting->bench.renderer, &camera, 160, 120, FALSE, FALSE);
  }
  int changed = 0;
  for (int i = 0; i < 160 * 120; i++) changed += memcmp(pictures[0].pixels + 4 * i, pictures[1].pixels + 4 * i, 3) != 0;
  picture_clear(&pictures[0]);
  picture_clear(&pictures[1]);
  return changed;
}

static void test_overlays(void) {
  Setting setting = setting_open(MINIMAL);
  const SporeStageOptions spheres = {.surfaces = TRUE, .spheres = TRUE},
                          contacts = {.surfaces = TRUE, .contacts = TRUE};
  setting_run(&setting, 400);
  g_assert_cmpint(changed_pixels(&setting, &(SporeStageOptions){.surfaces = TRUE}), ==, 0);
  g_assert_cmpint(changed_pixels(&setting, &spheres), >, 1000);
  spore_stage_set_options(setting.stage, &contacts);
  spore_stage_update(setting.stage, spore_world_snapshot_acquire(setting.simulation->world));
  g_assert_cmpint(changed_pixels(&setting, &contacts), >, 3);
  setting_close(&setting);
}

static void add_link(Setting *setting, const char *element, SporeVec3 from, SporeVec3 to) {
  GError *error = NULL;
  SporeLinkEnd ends[] = {{spore_document_find(setting->document, "body", "ball"), from}, {NULL, to}};
  g_assert_nonnull(spore_edit_add_link(setting->document, element, ends, 2, &error));
  g_assert_no_error(error);
  spore_stage_rebuild(setting->stage, NULL);
}

static void assert_link_legend(const Setting *setting, const char *pattern) {
  SporeStageLegend legend;
  g_assert_true(spore_stage_link_legend(setting->stage, &legend));
  g_autofree char *text = spore_stage_legend_text(&legend);
  spore_stage_legend_clear(&legend);
  if (!g_pattern_match_simple(pattern, text)) g_error("\"%s\" is not like \"%s\"", text, pattern);
}

/* Pixels that links change, all of which must lie between two columns. */
static int link_pixels(const Setting *setting, double from_x, double to_x) {
  SporeCamera camera = straight_camera(0.4);
  Picture pictures[2];
  for (int i = 0; i < 2; i++) {
    spore_stage_set_options(setting->stage, &(SporeStageOptions){.surfaces = TRUE, .links = i});
    pictures[i] = draw_picture(setting->bench.renderer, &camera, 160, 120, FALSE, FALSE);
  }
  int changed = 0;
  for (int i = 0; i < 160 * 120; i++) {
    if (memcmp(pictures[0].pixels + 4 * i, pictures[1].pixels + 4 * i, 3) == 0) continue;
    g_assert_true(i % 160 >= from_x && i % 160 <= to_x);
    changed++;
  }
  picture_clear(&pictures[0]);
  picture_clear(&pictures[1]);
  return changed;
}

/* A picture differs where a link is, and there alone; the legend has the kinds of the scene, and what they bear. */
static void test_links(void) {
  Setting setting = setting_open(MINIMAL);
  SporeCamera camera = straight_camera(0.4);
  SporeVec3 ball = {0.0015, 0.06, 0.001}, beside = {0.06, 0.06, 0.001};
  double from[2], to[2];
  g_assert_cmpint(link_pixels(&setting, 0, 160), ==, 0);
  assert_link_legend(&setting, "Links: the scene has none");
  add_link(&setting, "spring", ball, beside);
  g_assert_true(spore_camera_project(&camera, ball, 160, 120, &from[0], &from[1]) &&
                spore_camera_project(&camera, beside, 160, 120, &to[0], &to[1]));
  g_assert_cmpint(link_pixels(&setting, from[0] - 3, to[0] + 3), >, 20);
  assert_link_legend(&setting, "Links: Spring (yellow): 1");
  add_link(&setting, "weld", ball, beside);
  add_link(&setting, "spring", ball, beside);
  assert_link_legend(&setting, "Links: Spring (yellow): 2, Weld (red): 1");
  spore_stage_set_options(setting.stage, &(SporeStageOptions){.surfaces = TRUE});
  SporeStageLegend legend;
  g_assert_false(spore_stage_link_legend(setting.stage, &legend));
  spore_stage_set_options(setting.stage, &(SporeStageOptions){.surfaces = TRUE, .links = TRUE});
  setting_run(&setting, 60);
  assert_link_legend(&setting, "Links: Spring (yellow): 2, Weld (red): 1; most now: 0.3* N on \"ball_weld\""); /* m g */
  setting_close(&setting);
}

/* The asset of a body's collision spheres says which mesh they are of. */
static void name_source(Setting *setting, const char *body, const char *mesh) {
  const SporeObject *object = spore_document_find(setting->document, "body", body);
  SporeObject *asset = spore_object_reference(spore_object_child_of(object, "collision"), "spheres");
  g_assert_true(spore_document_set_text(setting->document, asset, "source", mesh, NULL));
  spore_stage_rebuild(setting->stage, NULL);
}

/* The scale of the spheres' colours is that of what is shown: a length where one mesh says it, else a share. */
static void test_sphere_scale(void) {
  Setting setting = setting_open(MINIMAL);
  const SporeStageOptions spheres = {.surfaces = TRUE, .spheres = TRUE};
  SporeStageCandidate instead = {
      .body = id_of(&setting, "ball"), .sphere_count = 1, .spheres = (double[]){0, 0, 0, 0.01}, .chosen = G_MAXSIZE};
  spore_stage_set_options(setting.stage, &spheres);
  g_assert_cmpfloat(spore_stage_sphere_scale(setting.stage).share, ==, 0); /* of no mesh: without colours */
  name_source(&setting, "ball", "ball");
  SporeSphereScale scale = spore_stage_sphere_scale(setting.stage);
  g_assert_cmpfloat_with_epsilon(scale.share, 0.02, 1e-12);
  g_assert_cmpfloat_with_epsilon(scale.high, 0.02 * 0.04 * sqrt(3), 1e-5); /* a ball of 2 cm */
  spore_stage_set_candidate(setting.stage, &instead);
  g_assert_cmpfloat(spore_stage_sphere_scale(setting.stage).share, ==, 0);
  spore_stage_set_candidate(setting.stage, NULL);
  name_source(&setting, "floor", "floor");
  scale = spore_stage_sphere_scale(setting.stage);
  g_assert_true(scale.share > 0 && scale.high == 0);
  spore_stage_set_options(setting.stage, &(SporeStageOptions){.surfaces = TRUE});
  g_assert_cmpfloat(spore_stage_sphere_scale(setting.stage).share, ==, 0);
  setting_close(&setting);
}

static SporeVec3 middle_of_points(const double *points, gsize count) {
  SporeVec3 sum = {0, 0, 0};
  for (gsize i = 0; i < count; i++) sum = spore_vec3_add(sum, spore_vec3_load(points + 3 * i));
  return spore_vec3_scale(1.0 / (double)count, sum);
}

/* The ovary of the scene, as a snapshot would have it: deformed alike everywhere, in motion. */
typedef struct Pulled {
  SporeSnapshot snapshot;
  double *q, *v;
} Pulled;

static Pulled pull(Setting *setting, SporeMat3 f, SporeVec3 velocity) {
  const SporeWorld *world = setting->simulation->world;
  Pulled pulled = {.snapshot = *spore_world_snapshot_acquire(setting->simulation->world)};
  guint32 body = spore_world_find_body(world, "ovary_right");
  const SporeModel *model = spore_world_lod_model(world, body, SPORE_LOD_FINE);
  pulled.q = g_memdup2(pulled.snapshot.q, pulled.snapshot.q_count * sizeof(double));
  pulled.v = g_memdup2(pulled.snapshot.v, pulled.snapshot.v_count * sizeof(double));
  double *q = pulled.q + spore_world_q_offset(world, body), *v = pulled.v + spore_world_v_offset(world, body);
  SporePose pose = spore_world_start_pose(world, body);
  model->type->place(model, pose, velocity, spore_vec3(0, 0, 0), q, v);
  SporeVec3 middle = middle_of_points(q, model->node_count);
  for (gsize i = 0; i < model->node_count; i++) {
    SporeVec3 off = spore_vec3_sub(spore_vec3_load(q + 3 * i), middle);
    spore_vec3_store(q + 3 * i, spore_vec3_add(middle, spore_mat3_apply(f, off)));
  }
  pulled.snapshot.q = pulled.q;
  pulled.snapshot.v = pulled.v;
  return pulled;
}

/* Shows a field of the pulled body, and returns the end of its scale. hue: colour in the middle of the body; NULL: no
 * picture is drawn. */
static double show_field(Setting *setting, const SporeStageOptions *options, SporeMat3 f, SporeVec3 velocity,
                         int hue[3]) {
  Pulled pulled = pull(setting, f, velocity);
  SporeCamera camera;
  SporeTriangleMesh surface;
  double x = 0, y = 0;
  spore_stage_set_options(setting->stage, options);
  spore_stage_update(setting->stage, &pulled.snapshot);
  if (hue) {
    g_assert_true(spore_stage_camera(setting->stage, NULL, 4.0 / 3, &camera, NULL));
    g_assert_true(spore_stage_surface(setting->stage, id_of(setting, "ovary_right"), &surface));
    SporeVec3 middle = middle_of_points(surface.vertices, surface.vertex_count);
    g_assert_true(spore_camera_project(&camera, middle, 160, 120, &x, &y));
    Picture picture = draw_picture(setting->bench.renderer, &camera, 160, 120, FALSE, FALSE);
    picture_pixel(&picture, (int)x, (int)y, hue);
    picture_clear(&picture);
  }
  g_free(pulled.q);
  g_free(pulled.v);
  return spore_stage_field_end(setting->stage);
}

static SporeMat3 stretched(double by) {
  SporeMat3 turn = spore_quat_to_mat3(spore_quat_from_rotation_vector(spore_vec3(0.4, -1.1, 2.0)));
  return spore_mat3_multiply(turn, spore_mat3_diagonal(by, 1, 1));
}

/* What is turned and moved has neither strain nor stress; what is stretched by a half has a strain of 62.5 %. */
static void test_fields(void) {
  Setting setting = setting_open(SPORE_SCENES "/plate7-steam.spore");
  const SporeVec3 still = {0, 0, 0}, moving = {0.3, -0.4, 0};
  int own[3], low[3], high[3];
  SporeStageLegend legend;
  setting_run(&setting, 0);
  SporeStageOptions options = {.surfaces = TRUE};
  g_assert_cmpfloat(show_field(&setting, &options, stretched(1), still, own), ==, 0);
  g_assert_false(spore_stage_legend(setting.stage, &legend));
  for (guint i = 0; i < setting.stage->bodies->len; i++)
    g_assert_null(((SporeStageBody *)setting.stage->bodies->pdata[i])->shade); /* nothing is computed */
  options.field = SPORE_FIELD_VELOCITY;
  spore_stage_set_options(setting.stage, &options);
  g_assert_true(spore_stage_legend(setting.stage, &legend));
  g_assert_null(legend.high); /* until there is a state */
  g_assert_nonnull(legend.without);
  spore_stage_legend_clear(&legend);
  g_assert_cmpfloat_with_epsilon(show_field(&setting, &options, stretched(1), moving, NULL), 0.5, 1e-12);
  options.field = SPORE_FIELD_STRAIN;
  g_assert_cmpfloat_with_epsilon(show_field(&setting, &options, stretched(1), moving, low), 0.01, 1e-12);
  g_assert_cmpfloat_with_epsilon(show_field(&setting, &options, stretched(1.5), still, NULL), 1, 1e-12);
  options.field_end = 0.625;
  g_assert_cmpfloat(show_field(&setting, &options, stretched(1.5), still, high), ==, 0.625);
  g_assert_cmpint(low[2], >, low[1]); /* violet, and yellow */
  g_assert_cmpint(high[0], >, 3 * high[2]);
  g_assert_cmpint(high[1], >, 3 * high[2]);
  options = (SporeStageOptions){.surfaces = TRUE, .field = SPORE_FIELD_STRESS};
  g_assert_cmpfloat(show_field(&setting, &options, stretched(1), moving, NULL), ==, 1);
  g_assert_cmpfloat(show_field(&setting, &options, stretched(1.5), still, NULL), >, 1000);
  options.field = SPORE_FIELD_NONE;
  show_field(&setting, &options, stretched(1), still, low);
  for (int i = 0; i < 3; i++) g_assert_cmpint(ABS(low[i] - own[i]), <=, 2); /* as it was */
  setting_close(&setting);
}

static void count_found(gpointer data) { ++*(int *)data; }

/* A stage that is looked at shows the spheres at once, and their errors when these are measured: once for each set. */
static void test_fit_aside(void) {
  Setting setting = setting_open(MINIMAL);
  int found = 0;
  spore_stage_measure_aside(setting.stage, count_found, &found);
  spore_stage_set_options(setting.stage, &(SporeStageOptions){.surfaces = TRUE, .spheres = TRUE});
  name_source(&setting, "ball", "ball");
  g_assert_cmpfloat(spore_stage_sphere_scale(setting.stage).share, ==, 0);
  while (!found) g_main_context_iteration(NULL, TRUE);
  spore_stage_rebuild(setting.stage, NULL);
  g_assert_cmpfloat_with_epsilon(spore_stage_sphere_scale(setting.stage).high, 0.02 * 0.04 * sqrt(3), 1e-5);
  while (g_main_context_iteration(NULL, FALSE)) {
  }
  g_assert_cmpint(found, ==, 1);
  name_source(&setting, "floor", "floor"); /* and the stage is gone before it is measured */
  setting_close(&setting);
}

/* A picture of the bowl in which every place whose way out is below `most` is stained so much; the blood itself is
 * hidden. */
static Picture draw_stained(Setting *setting, float stain, float most, guint64 number) {
  SporeSnapshot snapshot = *spore_world_snapshot_acquire(setting->simulation->world);
  SporeCamera camera;
  g_autofree float *amount = g_new(float, snapshot.stain_count);
  for (guint32 b = 0; b < spore_world_body_count(setting->simulation->world); b++) {
    SporeStainPlaces places = spore_world_stain_places(setting->simulation->world, b);
    for (gsize i = 0; i < places.count; i++) amount[places.start + i] = places.out[3 * i + 1] < most ? stain : 0;
  }
  snapshot.stain = amount;
  snapshot.stained = number;
  spore_stage_update(setting->stage, &snapshot);
  g_assert_true(spore_stage_camera(setting->stage, "view", 4.0 / 3, &camera, NULL));
  return draw_picture(setting->bench.renderer, &camera, 160, 120, FALSE, FALSE);
}

/* Green and blue, and red, of the middle of the picture, where the bowl is. */
static void middle_of(Picture *picture, int *cool, int *red) {
  *cool = *red = 0;
  for (int x = 60; x < 100; x += 5)
    for (int y = 45; y < 75; y += 5) {
      int rgb[3];
      picture_pixel(picture, x, y, rgb);
      *red += rgb[0], *cool += rgb[1] + rgb[2];
    }
  picture_clear(picture);
}

/* What is stained is darker, and redder; what is washed is as it was, and the inside where the underside is stained. */
static void test_stains_are_seen(void) {
  Setting setting = setting_open(SPORE_SCENES "/exercise-suction.spore");
  g_autoptr(GHashTable) hidden = g_hash_table_new(NULL, NULL);
  g_hash_table_add(hidden, GUINT_TO_POINTER(id_of(&setting, "blood")));
  setting_run(&setting, 0);
  spore_stage_set_hidden(setting.stage, hidden);
  int cool[4], red[4];
  for (guint i = 0; i < 4; i++) {
    Picture picture = draw_stained(&setting, i % 2, i == 3 ? -0.5f : 2, i + 1);
    middle_of(&picture, &cool[i], &red[i]);
  }
  g_test_message("red %d clean, %d stained; green and blue %d, %d", red[0], red[1], cool[0], cool[1]);
  g_assert_cmpint(red[1], <, 9 * red[0] / 10);
  g_assert_cmpint(cool[1] * red[0], <, cool[0] * red[1] * 3 / 4);
  for (guint i = 2; i < 4; i++) g_assert_true(red[i] == red[0] && cool[i] == cool[0]);
  setting_close(&setting);
}

/* Pixels that change where the body alone is stained; bare: its visual unit is taken away before. */
static int pixels_stained(const char *scene, const char *body, gboolean bare) {
  Setting setting = setting_open(scene);
  SporeObject *object = spore_document_find(setting.document, "body", body);
  if (bare) g_assert_true(spore_document_remove(setting.document, spore_object_child_of(object, "visual"), NULL));
  setting_run(&setting, 0);
  SporeSnapshot snapshot = *spore_world_snapshot_acquire(setting.simulation->world);
  SporeStainPlaces places =
      spore_world_stain_places(setting.simulation->world, spore_simulation_body_of(setting.simulation, object));
  g_autofree float *amount = g_new0(float, snapshot.stain_count);
  SporeCamera camera;
  Picture picture[2];
  int changed = 0, lost = 0; /* green and blue */
  g_assert_cmpuint(places.count, >, 0);
  g_assert_true(spore_stage_camera(setting.stage, NULL, 4.0 / 3, &camera, NULL));
  snapshot.stain = amount;
  for (int i = 0; i < 2; i++) {
    for (gsize k = 0; k < places.count; k++) amount[places.start + k] = (float)i;
    snapshot.stained = (guint64)i + 1;
    spore_stage_update(setting.stage, &snapshot);
    picture[i] = draw_picture(setting.bench.renderer, &camera, 160, 120, FALSE, FALSE);
  }
  for (int p = 0; p < 160 * 120; p++) {
    int clean[3], stained[3];
    picture_pixel(&picture[0], p % 160, p / 160, clean);
    picture_pixel(&picture[1], p % 160, p / 160, stained);
    if (memcmp(clean, stained, sizeof clean) == 0) continue;
    changed++;
    lost += clean[1] + clean[2] - stained[1] - stained[2];
  }
  g_test_message("%s: %d pixels change, %d of green and blue lost", body, changed, lost);
  g_assert_cmpint(lost, >, 20 * changed);
  for (int i = 0; i < 2; i++) picture_clear(&picture[i]);
  setting_close(&setting);
  return changed;
}

/* What is drawn as a tube, or by its spheres, is stained as a surface is. */
static void test_tubes_and_spheres_are_stained(void) {
  g_assert_cmpint(pixels_stained(SPORE_SCENES "/laparoscopy.spore", "thread", FALSE), >, 60);
  g_assert_cmpint(pixels_stained(SPORE_SCENES "/exercise-suction.spore", "bowl", TRUE), >, 1000);
}

/* Pixels that differ between two pictures. */
static int pixels_apart(const Picture *one, const Picture *other) {
  int apart = 0;
  for (int p = 0; p < 160 * 120; p++) {
    int a[3], b[3];
    picture_pixel(one, p % 160, p / 160, a);
    picture_pixel(other, p % 160, p / 160, b);
    apart += memcmp(a, b, sizeof a) != 0;
  }
  return apart;
}

/* What a clip squeezes is drawn so, of a body that moves and of one that does not; and as it was when the clip is off.
 */
static void test_squeezed(void) {
  static const char *const bodies[] = {"tube", "stand"};
  for (gsize i = 0; i < G_N_ELEMENTS(bodies); i++) {
    Setting setting = setting_open(SPORE_SCENES "/exercise-clip-and-cut.spore");
    setting_run(&setting, 0);
    SporeSnapshot snapshot = *spore_world_snapshot_acquire(setting.simulation->world);
    SporeSqueeze squeeze = {.body = spore_world_find_body(setting.simulation->world, bodies[i]),
                            .frame = spore_pose_identity(),
                            .length = 0.05,
                            .width = 0.05,
                            .height = 0.05,
                            .ratio = 0.2};
    SporeCamera camera;
    Picture pictures[3];
    g_assert_true(spore_stage_camera(setting.stage, NULL, 4.0 / 3, &camera, NULL));
    snapshot.squeezes = &squeeze;
    for (int k = 0; k < 3; k++) {
      snapshot.squeeze_count = k == 1;
      spore_stage_update(setting.stage, &snapshot);
      pictures[k] = draw_picture(setting.bench.renderer, &camera, 160, 120, FALSE, FALSE);
    }
    g_test_message("%s: %d pixels change", bodies[i], pixels_apart(&pictures[0], &pictures[1]));
    g_assert_cmpint(pixels_apart(&pictures[0], &pictures[1]), >, 20);
    g_assert_cmpint(pixels_apart(&pictures[0], &pictures[2]), ==, 0);
    for (int k = 0; k < 3; k++) picture_clear(&pictures[k]);
    setting_close(&setting);
  }
}

/* The ball filled with a fluid whose collision unit names no spheres. */
static void test_own_spheres(void) {
  Setting setting = setting_open(MINIMAL);
  const SporeStageOptions spheres = {.surfaces = TRUE, .spheres = TRUE};
  SporeObject *ball = spore_document_find(setting.document, "body", "ball");
  SporeObject *mechanical = spore_object_child_of(ball, "mechanical"), *collision, *floor;
  GError *error = NULL;
  spore_document_remove(setting.document, spore_object_child(mechanical, 0), &error);
  g_assert_no_error(error);
  spore_document_insert(setting.document, mechanical, "lennard_jones", NULL, G_MAXUINT, &error);
  g_assert_no_error(error);
  collision = spore_object_child_of(ball, "collision");
  spore_document_unset(setting.document, collision, 0, &error);
  g_assert_no_error(error);
  g_assert_true(spore_body_has_own_spheres(ball));
  floor = spore_document_find(setting.document, "body", "floor"); /* that only the ball's are seen */
  spore_document_remove(setting.document, floor, &error);
  g_assert_no_error(error);
  setting_run(&setting, 1);
  g_assert_cmpint(changed_pixels(&setting, &spheres), >, 200);
  spore_document_remove(setting.document, collision, &error);
  g_assert_no_error(error);
  spore_simulation_free(g_steal_pointer(&setting.simulation));
  setting_run(&setting, 1);
  g_assert_cmpint(changed_pixels(&setting, &spheres), ==, 0);
  setting_close(&setting);
}

static void test_selection_is_seen(void) {
  Setting setting = setting_open(MINIMAL);
  const SporeStageOptions options = {.surfaces = TRUE};
  SporeCamera camera;
  g_assert_true(spore_stage_camera(setting.stage, "front", 1, &camera, NULL));
  spore_stage_set_options(setting.stage, &options);
  Picture before = draw_picture(setting.bench.renderer, &camera, 100, 100, FALSE, FALSE);
  SporeObject *ball = spore_document_find(setting.document, "body", "ball");
  const guint32 part = spore_object_id(spore_object_child_of(ball, "collision"));
  spore_stage_set_selection(setting.stage, &part, 1);
  Picture during = draw_picture(setting.bench.renderer, &camera, 100, 100, FALSE, FALSE);
  spore_stage_set_selection(setting.stage, NULL, 0);
  Picture after = draw_picture(setting.bench.renderer, &camera, 100, 100, FALSE, FALSE);
  g_assert_cmpfloat(picture_compare(&before, &during).mean, >, 0.3);
  g_assert_cmpfloat(picture_compare(&before, &after).mean, ==, 0);
  picture_clear(&before);
  picture_clear(&during);
  picture_clear(&after);
  setting_close(&setting);
}

static void test_cameras(void) {
  Setting setting = setting_open(MINIMAL);
  SporeCamera camera;
  GError *error = NULL;
  g_assert_true(spore_stage_camera(setting.stage, "front", 1, &camera, &error));
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(eye, spore_vec3(0.09, 0.10, 0.20)), 0, 1e-9);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(camera.target, spore_vec3(0, 0.018, 0)), 0, 1e-9);
  SporeCamera wide, narrow; /* what a picture of 16:9 shows at the sides, a narrower one shows too */
  g_assert_true(spore_stage_camera(setting.stage, "front", 16.0 / 9, &wide, &error));
  g_assert_true(spore_stage_camera(setting.stage, "front", 0.9, &narrow, &error));
  g_assert_cmpfloat_with_epsilon(tan(narrow.field_of_view / 2) * 0.9, tan(wide.field_of_view / 2) * 16 / 9, 1e-12);
  g_assert_cmpfloat_with_epsilon(wide.field_of_view, 0.6, 1e-12);
  g_assert_false(spore_stage_camera(setting.stage, "back", 1, &camera, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_error_free(error);
  setting_close(&setting);
}

/* A camera on a body looks from where the body has come. */
static void test_camera_on_body(void) {
  Setting setting = setting_open(MINIMAL);
  SporeObject *object = spore_document_find(setting.document, "camera", "front");
  SporeCamera before, after;
  g_assert_true(spore_stage_camera(setting.stage, "front", 1, &before, NULL));
  g_assert_true(spore_document_set_text(setting.document, object, "body", "ball", NULL));
  setting_run(&setting, 20);
  guint32 ball = spore_world_find_body(setting.simulation->world, "ball");
  SporeVec3 now = spore_vec3_load(spore_world_q(setting.simulation->world, ball));
  g_assert_true(spore_stage_camera(setting.stage, "front", 1, &after, NULL));
  SporeBodyFields fields;
  spore_object_fields(spore_document_find(setting.document, "body", "ball"), &fields);
  double fallen = fields.position[1] - now.y;
  g_assert_cmpfloat(fallen, >, 1e-4);
  g_assert_cmpfloat_with_epsilon(before.target.y - after.target.y, fallen, 1e-12);
  g_assert_cmpfloat_with_epsilon(before.azimuth, after.azimuth, 1e-9);
  g_assert_cmpfloat_with_epsilon(after.roll, 0, 1e-9);
  setting_close(&setting);
}

/* A camera on a body that turns about the line of sight turns with it. */
static void test_camera_rolls(void) {
  Setting setting = setting_open(MINIMAL);
  SporeObject *object = spore_document_find(setting.document, "camera", "front");
  SporeObject *ball = spore_document_find(setting.document, "body", "ball");
  g_assert_true(spore_document_set_text(setting.document, ball, "spin", "0 0 20", NULL));
  g_assert_true(spore_document_set_text(setting.document, object, "body", "ball", NULL));
  g_assert_true(spore_document_set_text(setting.document, object, "position", "0 0.06 0.2", NULL));
  g_assert_true(spore_document_set_text(setting.document, object, "target", "0 0.06 0", NULL));
  setting_run(&setting, 20);
  const double *q = spore_world_q(setting.simulation->world, spore_world_find_body(setting.simulation->world, "ball"));
  double turned = 2 * atan2(q[6], q[3]);
  SporeCamera camera;
  SporeVec3 eye, right, up, forward;
  g_assert_true(spore_stage_camera(setting.stage, "front", 1, &camera, NULL));
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  g_assert_cmpfloat(turned, >, 0.3);
  g_assert_cmpfloat_with_epsilon(up.x, -sin(turned), 1e-6);
  g_assert_cmpfloat_with_epsilon(up.y, cos(turned), 1e-6);
  setting_close(&setting);
}

static void test_empty_scene(void) {
  Bench bench = bench_open();
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_document_new(schema);
  SporeStage *stage = spore_stage_new(bench.renderer, document);
  double lower[3], upper[3];
  SporeVec3 point;
  spore_stage_rebuild(stage, NULL);
  spore_stage_bounds(stage, lower, upper);
  g_assert_cmpfloat(lower[0], <, upper[0]);
  g_assert_cmpuint(spore_stage_pick(stage, spore_vec3(0, 0, 1), spore_vec3(0, 0, -1), &point), ==, 0);
  SporeCamera camera;
  g_assert_true(spore_stage_camera(stage, NULL, 1, &camera, NULL));
  Picture picture = draw_picture(bench.renderer, &camera, 32, 32, TRUE, TRUE);
  picture_clear(&picture);
  spore_stage_free(stage);
  spore_document_free(document);
  spore_schema_free(schema);
  bench_close(&bench);
}

/* A liquid is drawn and picked as the skin around its particles, wherever they flow. */
static void test_liquid(void) {
  Setting setting = setting_open(SPORE_SCENES "/table1-fluid.spore");
  SporeVec3 above = {0}, below = {0};
  setting_run(&setting, 0);
  g_assert_cmpuint(pick_down(&setting, 0.036, 0.028, &above), ==, id_of(&setting, "blood"));
  g_assert_cmpfloat_with_epsilon(above.y, 0.004, 0.0015); /* the top of the drop */
  for (int i = 0; i < 1000; i++) spore_world_step(setting.simulation->world);
  spore_stage_update(setting.stage, spore_world_snapshot_acquire(setting.simulation->world));
  g_assert_cmpuint(pick_down(&setting, 0.036, 0.028, &below), ==, id_of(&setting, "blood"));
  g_assert_cmpfloat(below.y, <, above.y - 0.005);
  setting_close(&setting);
}

/* Triangles that a cut goes through are no longer drawn, nor picked; whole again when a run begins anew. */
static void test_cut_is_seen(void) {
  Setting setting = setting_open(SPORE_SCENES "/table1-mass-spring.spore");
  setting_run(&setting, 0);
  const SporeWorld *world = setting.simulation->world;
  guint32 body = spore_world_find_body(world, "tissue");
  SporeObject *mesh = spore_document_find(setting.document, "mesh", "tissue");
  const SporeTriangleMesh *surface = spore_document_mesh(setting.document, mesh, NULL);
  const double *q = spore_world_q(world, body);
  const uint32_t *corner = surface->triangles + 3 * (surface->triangle_count / 2);
  SporeVec3 middle = {0, 0, 0}, point;
  for (int k = 0; k < 3; k++) middle = spore_vec3_add_scaled(middle, 1. / 3, spore_vec3_load(q + 3 * (gsize)corner[k]));
  SporeVec3 first = spore_vec3_load(q + 3 * (gsize)corner[0]);
  SporeVec3 up = spore_vec3_cross(spore_vec3_sub(spore_vec3_load(q + 3 * (gsize)corner[1]), first),
                                  spore_vec3_sub(spore_vec3_load(q + 3 * (gsize)corner[2]), first));
  up = spore_vec3_normalise(up, spore_vec3(0, 1, 0));
  SporeVec3 from = spore_vec3_add_scaled(middle, 1e-4, up), down = spore_vec3_scale(-1, up);
  guint32 id = id_of(&setting, "tissue");
  g_assert_cmpuint(spore_stage_pick(setting.stage, from, down, &point), ==, id);
  SporeSnapshot cut = *spore_world_snapshot_acquire(setting.simulation->world);
  SporeCutEdge edge = {body, MIN(corner[0], corner[1]), MAX(corner[0], corner[1])};
  cut.cuts = (SporeCuts){1, 1, &edge};
  spore_stage_update(setting.stage, &cut);
  g_assert_cmpuint(spore_stage_pick(setting.stage, from, down, &point), !=, id);
  cut.cuts.count = 0;
  cut.cut_run++;
  spore_stage_update(setting.stage, &cut);
  g_assert_cmpuint(spore_stage_pick(setting.stage, from, down, &point), ==, id);
  setting_close(&setting);
}

static const SporeStageBody *body_named(const Setting *setting, const char *name) {
  for (guint i = 0; i < setting->stage->bodies->len; i++) {
    const SporeStageBody *body = setting->stage->bodies->pdata[i];
    if (body->object == id_of(setting, name)) return body;
  }
  g_assert_not_reached();
}

/* Where scissors divide tetrahedra, the surface parts with them and the inside is seen; whole again after a reset. */
static void test_node_splitting_is_seen(void) {
  Setting setting = setting_open(SPORE_SCENES "/cut-ovary.spore");
  setting_run(&setting, 0);
  SporeWorld *world = setting.simulation->world;
  const SporeStageBody *body = body_named(&setting, "ovary_right");
  gsize whole = body->surface.count, triangles = body->triangle_count;
  g_assert_cmpuint(body->inside_handle, ==, 0);
  while (spore_world_tool_state(world, 0).cut < 10) spore_world_step(world);
  for (int i = 0; i < 20; i++) spore_world_step(world);
  spore_stage_update(setting.stage, spore_world_snapshot_acquire(world));
  g_test_message("%zu vertices became %zu", whole, body->surface.count);
  g_assert_cmpuint(body->inside_handle, !=, 0);
  g_assert_cmpuint(body->surface.count, >, whole);
  g_assert_cmpuint(body->triangle_count, ==, triangles);
  for (gsize i = 0; i < 3 * body->surface.count; i++) g_assert_cmpfloat(fabs(body->surface.positions[i]), <, 0.2);
  spore_world_reset(world);
  spore_stage_update(setting.stage, spore_world_snapshot_acquire(world));
  g_assert_cmpuint(body->inside_handle, ==, 0);
  g_assert_cmpuint(body->surface.count, ==, whole);
  setting_close(&setting);
}

/* Bodies that a shader draws, by what was said before there was a picture; -1: the shader was not named. */
static int said_of(const GArray *needs, const char *shader) {
  int bodies = -1;
  for (guint i = 0; i < needs->len; i++) {
    const SporeShaderNeed *need = &g_array_index(needs, SporeShaderNeed, i);
    if (g_str_equal(need->name, shader)) bodies = MAX(bodies, 0) + (int)need->bodies;
  }
  return bodies;
}

typedef struct Shaders {
  const char *scene, *bare; /* bare: a body whose visual unit is taken away; NULL: none */
  int steps;                /* until there is something of all that the scene shows */
  int spheres, puffs;       /* bodies; -1: none */
} Shaders;

static void compare_shaders(const Shaders *expected) {
  static const char *const all[] = {"surface.frag",   "sphere.frag", "puff.frag", "line.frag",      "background.frag",
                                    "occlusion.frag", "smooth.frag", "glow.frag", "composite.frag", "lens.frag"};
  g_autofree char *file = g_strdup_printf(SPORE_SCENES "/%s.spore", expected->scene);
  Setting setting = setting_open(file);
  if (expected->bare) {
    SporeObject *body = spore_document_find(setting.document, "body", expected->bare);
    g_assert_true(spore_document_remove(setting.document, spore_object_child_of(body, "visual"), NULL));
  }
  setting_run(&setting, expected->steps);
  g_autoptr(GArray) needs = spore_shader_needs(setting.document, setting.simulation);
  SporeCamera camera;
  g_assert_true(spore_stage_camera(setting.stage, NULL, 4.0 / 3, &camera, NULL));
  Picture picture = draw_picture(setting.bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, TRUE, FALSE);
  picture_clear(&picture);
  for (guint i = 0; i < G_N_ELEMENTS(all); i++)
    if ((said_of(needs, all[i]) >= 0) != spore_renderer_has_used(setting.bench.renderer, all[i]))
      g_error("%s: %s", expected->scene, all[i]);
  g_assert_cmpint(said_of(needs, "sphere.frag"), ==, expected->spheres);
  g_assert_cmpint(said_of(needs, "puff.frag"), ==, expected->puffs);
  setting_close(&setting);
}

/* What a picture of a scene takes is what is said before the picture is drawn, no more and no less. */
static void test_shaders(void) {
  static const Shaders scenes[] = {{"minimal", NULL, 1, -1, -1},          {"minimal", "floor", 1, 1, -1},
                                   {"table1-fluid", NULL, 1, -1, -1},     {"plate7-steam", NULL, 400, -1, 1},
                                   {"exercise-suction", NULL, 1, -1, -1}, {"plate6-intestine", NULL, 1, -1, -1}};
  for (guint i = 0; i < G_N_ELEMENTS(scenes); i++) compare_shaders(&scenes[i]);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/render/stage/standing", test_standing);
  g_test_add_func("/render/stage/follows-the-simulation", test_follows_the_simulation);
  g_test_add_func("/render/stage/picked-behind-a-plane", test_picked_behind_a_plane);
  g_test_add_func("/render/stage/held-places", test_held_places);
  g_test_add_func("/render/stage/held-within", test_held_within);
  g_test_add_func("/render/stage/sphere-scale", test_sphere_scale);
  g_test_add_func("/render/stage/fields", test_fields);
  g_test_add_func("/render/stage/fit-aside", test_fit_aside);
  g_test_add_func("/render/stage/spheres-alone", test_spheres_alone);
  g_test_add_func("/render/stage/overlays", test_overlays);
  g_test_add_func("/render/stage/links", test_links);
  g_test_add_func("/render/stage/weighted-spheres", test_weighted_spheres);
  g_test_add_func("/render/stage/own-spheres", test_own_spheres);
  g_test_add_func("/render/stage/stains-are-seen", test_stains_are_seen);
  g_test_add_func("/render/stage/tubes-and-spheres-are-stained", test_tubes_and_spheres_are_stained);
  g_test_add_func("/render/stage/squeezed", test_squeezed);
  g_test_add_func("/render/stage/selection-is-seen", test_selection_is_seen);
  g_test_add_func("/render/stage/cameras", test_cameras);
  g_test_add_func("/render/stage/camera-on-body", test_camera_on_body);
  g_test_add_func("/render/stage/camera-rolls", test_camera_rolls);
  g_test_add_func("/stage/camera-rolls", test_camera_rolls);
  g_test_add_func("/render/stage/shaders", test_shaders);
  g_test_add_func("/render/stage/empty-scene", test_empty_scene);
  g_test_add_func("/render/stage/liquid", test_liquid);
  g_test_add_func("/render/stage/cut-is-seen", test_cut_is_seen);
  g_test_add_func("/render/stage/node-splitting-is-seen", test_node_splitting_is_seen);
  return g_test_run();
}
