/* Pictures against those kept in golden/. A driver may round otherwise, so there is a tolerance: small enough that
 * another colour, light or outline fails. SPORE_GOLDEN=write draws them anew; look at them before they are committed.
 */
#include <string.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "tests/render/scenery.h"
#include "ui/render/stage.h"

#define MEAN_TOLERANCE 1.5 /* of 255 */
#define PERCENTILE_TOLERANCE 20.0
#define PLATE_WIDTH 224
#define PLATE_HEIGHT 140

static const SporeSurfaceStyle tissue = {{0.45f, 0.09f, 0.075f}, 0.8f, FALSE, FALSE, FALSE};

static void check_golden(const char *name, const Picture *picture) {
  g_autofree char *file = g_strdup_printf("%s/golden/%s.png", SPORE_TEST_SOURCE, name);
  if (g_strcmp0(g_getenv("SPORE_GOLDEN"), "write") == 0) {
    GError *error = NULL;
    spore_png_write(file, picture->pixels, picture->width, picture->height, (gsize)picture->width * 4, &error);
    g_assert_no_error(error);
    g_test_skip("golden picture written, not compared");
    return;
  }
  Picture golden = picture_read(file);
  g_assert_nonnull(golden.pixels);
  PictureDifference difference = picture_compare(picture, &golden);
  g_test_message("%s: mean %.3f, 99 %% below %.0f", name, difference.mean, difference.percentile_99);
  g_assert_cmpfloat(difference.mean, <, MEAN_TOLERANCE);
  g_assert_cmpfloat(difference.percentile_99, <=, PERCENTILE_TOLERANCE);
  picture_clear(&golden);
}

static SporeCamera oblique_camera(void) {
  return (SporeCamera){.distance = 0.24, .azimuth = 0.5, .elevation = 0.35, .field_of_view = 0.7};
}

static void draw_and_check(Bench *bench, const char *name, gboolean antialias, gboolean grid) {
  SporeCamera camera = oblique_camera();
  Picture picture = draw_picture(bench->renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, antialias, grid);
  check_golden(name, &picture);
  picture_clear(&picture);
  bench_close(bench);
}

static void add_organ(Bench *bench, const SporeSurfaceStyle *style) {
  SporeTriangleMesh mesh = make_organ(0.05);
  spore_renderer_add_surface(bench->renderer, mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count,
                             style);
  spore_triangle_mesh_clear(&mesh);
}

static void test_tissue_fast(void) {
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  draw_and_check(&bench, "tissue_fast", FALSE, FALSE);
}

static void test_tissue_full(void) {
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  draw_and_check(&bench, "tissue_full", TRUE, FALSE);
}

static void test_metal_selected(void) {
  Bench bench = bench_open();
  SporeSurfaceStyle metal = {{0.6f, 0.6f, 0.62f}, 0, SPORE_MATERIAL_METAL, TRUE, FALSE};
  add_organ(&bench, &metal);
  draw_and_check(&bench, "metal_selected", FALSE, TRUE);
}

static void test_overlays(void) {
  static const float blue[3] = {0.03f, 0.24f, 0.36f}, yellow[3] = {0.95f, 0.62f, 0.05f};
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  double spheres[4 * 12], segments[6 * 2] = {-0.08, 0, 0, 0.08, 0, 0, 0, 0, 0.03, 0, 0.02, 0.09};
  float values[12];
  for (int i = 0; i < 12; i++) {
    double turn = 2 * G_PI * i / 12;
    const double sphere[4] = {0.045 * cos(turn), 0.045 * sin(turn), 0.01, 0.012};
    memcpy(spheres + 4 * i, sphere, sizeof sphere);
    values[i] = (float)i / 11;
  }
  spore_renderer_add_spheres(bench.renderer, spheres, 12, blue, values, TRUE);
  spore_renderer_add_lines(bench.renderer, segments, 2, yellow, 2.5f);
  draw_and_check(&bench, "overlays", FALSE, FALSE);
}

/* A plume before an organ, whose lower puffs run into it. */
static void add_smoke(Bench *bench) {
  static const float white[3] = {0.8f, 0.8f, 0.82f};
  SporePuff puffs[40];
  for (int i = 0; i < 40; i++) {
    double age = i / 39.0;
    puffs[i] = (SporePuff){{0.012 * sin(0.9 * i), 0.09 * age - 0.03, 0.045 + 0.008 * cos(1.3 * i)},
                           0.008 + 0.012 * age,
                           0.5 * (1 - age),
                           fmod(6.18 * i, 10)};
  }
  spore_renderer_move_puffs(bench->renderer, spore_renderer_add_puffs(bench->renderer, white), puffs, 40);
}

static void test_smoke_fast(void) {
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  add_smoke(&bench);
  draw_and_check(&bench, "smoke_fast", FALSE, FALSE);
}

static void test_smoke_full(void) {
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  add_smoke(&bench);
  draw_and_check(&bench, "smoke_full", TRUE, FALSE);
}

/* The lens of an endoscope that dipped into blood and water, with smoke before it. */
static void test_lens(void) {
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  SporeCamera camera = oblique_camera();
  camera.distortion = 0.2, camera.blood = 0.35, camera.water = 0.45, camera.haze = 0.3;
  Picture picture = draw_picture(bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, TRUE, FALSE);
  check_golden("lens", &picture);
  picture_clear(&picture);
  bench_close(&bench);
}

static void test_shadow_between_bodies(void) {
  static const float pale[3] = {0.55f, 0.40f, 0.33f};
  Bench bench = bench_open();
  add_organ(&bench, &tissue);
  const double sphere[4] = {-0.018, 0.045, 0.045, 0.014};
  spore_renderer_add_spheres(bench.renderer, sphere, 1, pale, NULL, FALSE);
  draw_and_check(&bench, "shadow", TRUE, FALSE);
}

/* The plates of the paper, as the shipped scenes show them after so many steps: in the dark in full quality, in a light
 * room as fast as the editor draws them. */
static const struct {
  const char *name;
  guint steps;
} plates[] = {{"plate1-ovary", 1},  {"plate2-tissue", 1},    {"plate3-blood", 60},  {"plate4-deformed-ovary", 1},
              {"plate5-string", 1}, {"plate6-intestine", 1}, {"plate7-steam", 400}, {"plate8-clamp", 1}};

static void check_plate(const Bench *bench, SporeSchema *schema, const char *name, guint steps) {
  GError *error = NULL;
  g_autofree char *file = g_strdup_printf("%s/%s.spore", SPORE_SCENES, name);
  SporeDocument *document = spore_scene_load(schema, file, &error);
  g_assert_no_error(error);
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  SporeStage *stage = spore_stage_new(bench->renderer, document);
  spore_stage_rebuild(stage, simulation);
  for (guint i = 0; i < steps; i++) spore_world_step(simulation->world);
  spore_stage_update(stage, spore_world_snapshot_acquire(simulation->world));
  for (int light = 0; light < 2; light++) {
    SporeCamera camera;
    SporeRenderOptions options = {
        .width = PLATE_WIDTH, .height = PLATE_HEIGHT, .antialias = !light, .light = light != 0};
    Picture picture = {PLATE_WIDTH, PLATE_HEIGHT, g_malloc(4 * PLATE_WIDTH * PLATE_HEIGHT)};
    g_autofree char *golden = g_strdup_printf("%.6s_%s", name, light ? "light" : "dark");
    spore_stage_camera(stage, NULL, (double)PLATE_WIDTH / PLATE_HEIGHT, &camera, &error);
    if (light) camera.distance *= 3; /* beyond the wall of the pelvis the room is seen */
    spore_renderer_draw(bench->renderer, &camera, &options, picture.pixels, 4 * PLATE_WIDTH, &error);
    g_assert_no_error(error);
    check_golden(golden, &picture);
    picture_clear(&picture);
  }
  spore_stage_free(stage);
  spore_document_free(document);
}

static void test_plates(void) {
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  Bench bench = bench_open();
  for (guint i = 0; i < G_N_ELEMENTS(plates); i++) check_plate(&bench, schema, plates[i].name, plates[i].steps);
  bench_close(&bench);
  spore_schema_free(schema);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/render/golden/tissue-fast", test_tissue_fast);
  g_test_add_func("/render/golden/tissue-full", test_tissue_full);
  g_test_add_func("/render/golden/metal-selected", test_metal_selected);
  g_test_add_func("/render/golden/overlays", test_overlays);
  g_test_add_func("/render/golden/smoke-fast", test_smoke_fast);
  g_test_add_func("/render/golden/smoke-full", test_smoke_full);
  g_test_add_func("/render/golden/lens", test_lens);
  g_test_add_func("/render/golden/plates", test_plates);
  g_test_add_func("/render/golden/shadow", test_shadow_between_bodies);
  return g_test_run();
}
