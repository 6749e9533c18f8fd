/* Milliseconds a frame: an organ of 8,544 triangles that moves, with and without 500 collision spheres, at 1280x720,
 * drawn and read back. Best of several rounds, one line a case. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/base/profile.h"
#include "ui/render/renderer.h"

enum { RINGS = 49, SECTORS = 89, WIDTH = 1280, HEIGHT = 720, SPHERES = 500, FRAMES = 40, ROUNDS = 5 };

static double vertices[(RINGS * SECTORS + 2) * 3];
static guint32 triangles[2 * RINGS * SECTORS * 3];
static guint8 pixels[WIDTH * HEIGHT * 4];

static void place_vertex(double *p, double polar, double turn) {
  double radius = 0.05 * (1 + 0.1 * sin(3 * turn) * sin(4 * polar));
  p[0] = radius * sin(polar) * cos(turn), p[1] = radius * cos(polar), p[2] = 0.7 * radius * sin(polar) * sin(turn);
}

/* A bumpy ball; its number of triangles. */
static gsize make_organ(void) {
  place_vertex(vertices, 0, 0);
  for (int ring = 0; ring < RINGS; ring++)
    for (int sector = 0; sector < SECTORS; sector++)
      place_vertex(vertices + 3 * (1 + ring * SECTORS + sector), G_PI * (ring + 1) / (RINGS + 1),
                   2 * G_PI * sector / SECTORS);
  place_vertex(vertices + 3 * (1 + RINGS * SECTORS), G_PI, 0);
  gsize count = 0;
  for (guint32 sector = 0; sector < SECTORS; sector++) {
    guint32 next = (sector + 1) % SECTORS, last = 1 + (RINGS - 1) * SECTORS;
    const guint32 caps[] = {0, 1 + next, 1 + sector, 1 + RINGS * SECTORS, last + sector, last + next};
    for (int i = 0; i < 6; i++) triangles[count++] = caps[i];
    for (guint32 ring = 0; ring + 1 < RINGS; ring++) {
      guint32 a = 1 + ring * SECTORS, b = a + SECTORS;
      const guint32 quad[] = {a + sector, a + next, b + sector, a + next, b + next, b + sector};
      for (int i = 0; i < 6; i++) triangles[count++] = quad[i];
    }
  }
  return count / 3;
}

static double frame_ms(SporeRenderer *renderer, guint surface, const SporeCamera *camera) {
  const SporeRenderOptions options = {.width = WIDTH, .height = HEIGHT, .grid = TRUE};
  double best = HUGE_VAL;
  for (int round = 0; round < ROUNDS; round++) {
    guint64 start_ns = spore_clock_ns();
    for (int frame = 0; frame < FRAMES; frame++) {
      vertices[1] += 1e-6;
      spore_renderer_move_surface(renderer, surface, vertices);
      if (!spore_renderer_draw(renderer, camera, &options, pixels, WIDTH * 4, NULL)) exit(1);
    }
    best = fmin(best, (double)(spore_clock_ns() - start_ns) / 1e6 / FRAMES);
  }
  return best;
}

int main(void) {
  g_autoptr(GError) error = NULL;
  SporeOffscreen *offscreen = spore_offscreen_new(&error);
  SporeRenderer *renderer = offscreen ? spore_renderer_new(offscreen, &error) : NULL;
  if (!renderer) g_error("%s", error->message);
  const double lower[3] = {-0.06, -0.06, -0.05}, upper[3] = {0.06, 0.06, 0.05};
  const float tissue[3] = {0.6f, 0.2f, 0.17f};
  const SporeSurfaceStyle style = {.colour = {0.6f, 0.2f, 0.17f}, .wetness = 0.7f};
  SporeCamera camera = {0};
  spore_camera_frame(&camera, lower, upper, (double)WIDTH / HEIGHT);
  gsize count = make_organ();
  guint surface = spore_renderer_add_surface(renderer, vertices, RINGS * SECTORS + 2, triangles, count, &style);
  printf("organ of %zu triangles, %s: %.3f ms\n", count, spore_offscreen_renderer(offscreen),
         frame_ms(renderer, surface, &camera));
  double spheres[SPHERES * 4];
  for (int i = 0; i < SPHERES; i++) {
    place_vertex(spheres + 4 * i, acos(1 - 2 * (i + 0.5) / SPHERES), 2.399963 * i);
    spheres[4 * i + 3] = 0.004;
  }
  spore_renderer_add_spheres(renderer, spheres, SPHERES, tissue, NULL, TRUE);
  printf("the same with %d spheres, %s: %.3f ms\n", SPHERES, spore_offscreen_renderer(offscreen),
         frame_ms(renderer, surface, &camera));
  spore_renderer_free(renderer);
  spore_offscreen_free(offscreen);
  return 0;
}
