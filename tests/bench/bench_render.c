/* Milliseconds a frame at 1280x720, drawn and read back, without antialias as a machine without a graphics card does:
 * an organ that moves, with and without 500 collision spheres; one of very many triangles; and the scenes whose files
 * are the arguments, which run on from picture to picture. One line a case: time, then that of the processors, over all
 * threads, which other programs change little. The median of the pictures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/author/generator.h"
#include "core/base/profile.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "ui/render/stage.h"

enum { WIDTH = 1280, HEIGHT = 720, SPHERES = 500, FRAMES = 60, STEPS = 20 };

static guint8 pixels[WIDTH * HEIGHT * 4];

typedef struct Organ {
  guint32 rings, sectors;
  gsize vertex_count, triangle_count;
  double *vertices;
  guint32 *triangles;
} Organ;

static void place_vertex(double *p, double polar, double turn) {
  double radius = 0.05 * (1 + 0.1 * sin(3 * turn) * sin(4 * polar));
  p[0] = radius * sin(polar) * cos(turn), p[1] = radius * cos(polar), p[2] = 0.7 * radius * sin(polar) * sin(turn);
}

static void add_triangle(Organ *organ, guint32 a, guint32 b, guint32 c) {
  guint32 *corners = organ->triangles + 3 * organ->triangle_count++;
  corners[0] = a, corners[1] = b, corners[2] = c;
}

/* A bumpy ball. */
static Organ make_organ(guint32 rings, guint32 sectors) {
  Organ organ = {rings, sectors, (gsize)rings * sectors + 2};
  organ.vertices = g_new(double, 3 * organ.vertex_count);
  organ.triangles = g_new(guint32, 6 * (gsize)rings * sectors);
  place_vertex(organ.vertices, 0, 0);
  for (guint32 ring = 0; ring < rings; ring++)
    for (guint32 sector = 0; sector < sectors; sector++)
      place_vertex(organ.vertices + 3 * (1 + ring * sectors + sector), G_PI * (ring + 1) / (rings + 1),
                   2 * G_PI * sector / sectors);
  place_vertex(organ.vertices + 3 * (organ.vertex_count - 1), G_PI, 0);
  for (guint32 sector = 0; sector < sectors; sector++) {
    guint32 next = (sector + 1) % sectors, last = 1 + (rings - 1) * sectors;
    add_triangle(&organ, 0, 1 + next, 1 + sector);
    add_triangle(&organ, 1 + rings * sectors, last + sector, last + next);
    for (guint32 ring = 0; ring + 1 < rings; ring++) {
      guint32 a = 1 + ring * sectors, b = a + sectors;
      add_triangle(&organ, a + sector, a + next, b + sector);
      add_triangle(&organ, a + next, b + next, b + sector);
    }
  }
  return organ;
}

/* What moves between two pictures. */
typedef struct Moving {
  SporeRenderer *renderer;
  SporeCamera camera;
  Organ *organ; /* NULL: a scene */
  guint surface;
  SporeStage *stage;
  SporeWorld *world;
} Moving;

static double processor_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void draw(const Moving *moving, int coarseness) {
  const SporeRenderOptions options = {
      .width = WIDTH / coarseness, .height = HEIGHT / coarseness, .grid = TRUE, .coarse = TRUE};
  g_autoptr(GError) error = NULL;
  if (moving->organ) spore_renderer_move_surface(moving->renderer, moving->surface, moving->organ->vertices);
  else spore_stage_update(moving->stage, spore_world_snapshot_acquire(moving->world));
  if (!spore_renderer_draw(moving->renderer, &moving->camera, &options, pixels, WIDTH * 4, &error))
    g_error("%s", error->message);
}

/* Coarse pictures are those of something that moves (ui/render/sharpness.h): their row says what share of the
 * processors' time of sharp ones they take. */
static double tell_at(const char *what, const Moving *moving, int coarseness) {
  static double wall_ms[FRAMES], processor_ms[FRAMES];
  draw(moving, coarseness); /* compiles the programs */
  for (int frame = 0; frame < FRAMES; frame++) {
    if (moving->organ) moving->organ->vertices[1] += 1e-6;
    for (int step = 0; moving->world && step < STEPS; step++) spore_world_step(moving->world);
    guint64 start_ns = spore_clock_ns();
    double start_s = processor_s();
    draw(moving, coarseness);
    wall_ms[frame] = (double)(spore_clock_ns() - start_ns) / 1e6;
    processor_ms[frame] = 1e3 * (processor_s() - start_s);
  }
  qsort(wall_ms, FRAMES, sizeof *wall_ms, by_size);
  qsort(processor_ms, FRAMES, sizeof *processor_ms, by_size);
  printf("%s: %.3f ms\n%s, of processors: %.3f ms\n", what, wall_ms[FRAMES / 2], what, processor_ms[FRAMES / 2]);
  return processor_ms[FRAMES / 2];
}

static void tell(const char *what, const Moving *moving) {
  double sharp_ms = tell_at(what, moving, 1);
  g_autofree char *coarse = g_strdup_printf("%s, half as sharp", what);
  printf("%s, of sharp: %.2f\n", coarse, tell_at(coarse, moving, 2) / sharp_ms);
  fflush(stdout);
}

static void tell_organ(SporeOffscreen *offscreen, guint32 rings, guint32 sectors, gboolean spheres) {
  const double lower[3] = {-0.06, -0.06, -0.05}, upper[3] = {0.06, 0.06, 0.05};
  const float tissue[3] = {0.6f, 0.2f, 0.17f};
  const SporeSurfaceStyle style = {.colour = {0.6f, 0.2f, 0.17f}, .wetness = 0.7f};
  Organ organ = make_organ(rings, sectors);
  Moving moving = {.renderer = spore_renderer_new(offscreen, NULL), .organ = &organ};
  spore_camera_frame(&moving.camera, lower, upper, (double)WIDTH / HEIGHT);
  moving.surface = spore_renderer_add_surface(moving.renderer, organ.vertices, organ.vertex_count, organ.triangles,
                                              organ.triangle_count, &style);
  if (spheres) {
    double balls[SPHERES * 4];
    for (int i = 0; i < SPHERES; i++) {
      place_vertex(balls + 4 * i, acos(1 - 2 * (i + 0.5) / SPHERES), 2.399963 * i);
      balls[4 * i + 3] = 0.004;
    }
    spore_renderer_add_spheres(moving.renderer, balls, SPHERES, tissue, NULL, TRUE);
  }
  g_autofree char *what = g_strdup_printf("organ of %zu triangles%s, %s", organ.triangle_count,
                                          spheres ? " with 500 spheres" : "", spore_offscreen_renderer(offscreen));
  tell(what, &moving);
  spore_renderer_free(moving.renderer);
  g_free(organ.vertices);
  g_free(organ.triangles);
}

static void tell_scene(SporeOffscreen *offscreen, const SporeSchema *schema, const char *file) {
  g_autoptr(GError) error = NULL;
  SporeDocument *document = spore_scene_load(schema, file, &error);
  SporeSimulation *simulation = document ? spore_simulation_new(document, NULL, NULL, NULL, &error) : NULL;
  if (!simulation) g_error("%s", error->message);
  Moving moving = {.renderer = spore_renderer_new(offscreen, NULL), .world = simulation->world};
  moving.stage = spore_stage_new(moving.renderer, document);
  spore_stage_set_options(moving.stage, &(SporeStageOptions){.surfaces = TRUE});
  spore_stage_rebuild(moving.stage, simulation);
  spore_stage_camera(moving.stage, NULL, (double)WIDTH / HEIGHT, &moving.camera, NULL);
  g_autofree char *name = g_path_get_basename(file),
                  *what = g_strdup_printf("%s, %s", name, spore_offscreen_renderer(offscreen));
  tell(what, &moving);
  spore_stage_free(moving.stage);
  spore_renderer_free(moving.renderer);
  spore_simulation_free(simulation);
  spore_document_free(document);
}

int main(int argc, char **argv) {
  g_autoptr(GError) error = NULL;
  SporeOffscreen *offscreen = spore_offscreen_new(&error);
  if (!offscreen) g_error("%s", error->message);
  tell_organ(offscreen, 49, 89, FALSE);
  tell_organ(offscreen, 49, 89, TRUE);
  tell_organ(offscreen, 223, 224, FALSE);
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  for (int i = 1; i < argc; i++) tell_scene(offscreen, schema, argv[i]);
  spore_schema_free(schema);
  spore_offscreen_free(offscreen);
  return 0;
}
