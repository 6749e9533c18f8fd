/* What can be computed by hand: outlines and depth of impostors, rows and channels of the picture, handles. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/render/scenery.h"
#include "ui/render/sharpness.h"

static const float red[3] = {0.7f, 0.02f, 0.02f}, blue[3] = {0.02f, 0.02f, 0.7f};

/* The background is a dark red, and so is the light in the shade. */
static gboolean is_red(const Picture *picture, int x, int y) {
  int rgb[3];
  picture_pixel(picture, x, y, rgb);
  return rgb[0] > rgb[2] + 30;
}

static gboolean is_blue(const Picture *picture, int x, int y) {
  int rgb[3];
  picture_pixel(picture, x, y, rgb);
  return rgb[2] > rgb[0] + 6;
}

static double hit_sphere(SporeVec3 origin, SporeVec3 direction, const double *sphere) {
  SporeVec3 to = spore_vec3_sub(spore_vec3_load(sphere), origin);
  double along = spore_vec3_dot(to, direction);
  double inside = sphere[3] * sphere[3] - (spore_vec3_dot(to, to) - along * along);
  return inside >= 0 ? along - sqrt(inside) : HUGE_VAL;
}

/* Two spheres that run into each other, off the middle where perspective makes ellipses of them: each pixel must show
 * the one that its own ray meets first. Pixels next to a border of either kind are left out. */
static void check_impostors(gboolean antialias, double distortion) {
  static const double spheres[2][4] = {{0.030, 0.030, 0.010, 0.040}, {0.060, 0.010, 0.030, 0.030}};
  Bench bench = bench_open();
  spore_renderer_add_spheres(bench.renderer, spheres[0], 1, red, NULL, FALSE);
  spore_renderer_add_spheres(bench.renderer, spheres[1], 1, blue, NULL, FALSE);
  SporeCamera camera = {
      .distance = 0.20, .azimuth = 0.2, .elevation = -0.1, .field_of_view = 1.0, .distortion = distortion};
  Picture picture = draw_picture(bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, antialias, FALSE);
  int counts[3] = {0}, wrong = 0;
  for (int y = 1; y < PICTURE_HEIGHT - 1; y++)
    for (int x = 1; x < PICTURE_WIDTH - 1; x++) {
      int kind = -1;
      gboolean border = FALSE;
      for (int corner = 0; corner < 9; corner++) {
        SporeVec3 origin, direction;
        spore_camera_ray(&camera, x + 0.5 * (corner % 3), y + 0.5 * (corner / 3), PICTURE_WIDTH, PICTURE_HEIGHT,
                         &origin, &direction);
        double a = hit_sphere(origin, direction, spheres[0]), b = hit_sphere(origin, direction, spheres[1]);
        int here = a == HUGE_VAL && b == HUGE_VAL ? 0 : a < b ? 1 : 2;
        border |= kind >= 0 && kind != here;
        kind = here;
      }
      if (border) continue;
      counts[kind]++;
      gboolean red_here = is_red(&picture, x, y), blue_here = is_blue(&picture, x, y);
      wrong += red_here != (kind == 1) || blue_here != (kind == 2);
    }
  g_assert_cmpint(counts[0], >, 10000);
  g_assert_cmpint(counts[1], >, 2000);
  g_assert_cmpint(counts[2], >, 2000);
  g_assert_cmpint(wrong, <=, counts[1] / 100); /* a glint of the wet film is white */
  picture_clear(&picture);
  bench_close(&bench);
}

static void test_impostors_fast(void) { check_impostors(FALSE, 0); }

static void test_impostors_full(void) { check_impostors(TRUE, 0); }

/* A lens bends lines, and rays through pixels bend with them. */
static void test_impostors_through_lens(void) {
  check_impostors(FALSE, 0.35);
  check_impostors(TRUE, 0.35);
}

/* A ball of count x count quadrilaterals, squeezed along y. */
static SporeTriangleMesh fine_ball(guint32 count, double squeeze) {
  SporeTriangleMesh mesh = {.vertex_count = (gsize)count * count, .triangle_count = 2 * (gsize)(count - 1) * count};
  mesh.vertices = spore_allocate(3 * mesh.vertex_count, sizeof *mesh.vertices);
  mesh.triangles = spore_allocate(3 * mesh.triangle_count, sizeof *mesh.triangles);
  guint32 *out = mesh.triangles;
  for (guint32 r = 0; r < count; r++)
    for (guint32 s = 0; s < count; s++) {
      double down = G_PI * (r + 0.5) / count, round = 2 * G_PI * s / count;
      SporeVec3 place = {sin(down) * cos(round), squeeze * cos(down), -sin(down) * sin(round)};
      spore_vec3_store(mesh.vertices + 3 * (gsize)(r * count + s), spore_vec3_scale(0.05, place));
      guint32 a = r * count + s, b = a + count, next = (s + 1) % count - s;
      const guint32 two[6] = {a, b, b + next, a, b + next, a + next};
      if (r + 1 < count) memcpy(out, two, sizeof two), out += 6;
    }
  return mesh;
}

static Picture draw_coarse(const Bench *bench, gboolean coarse) {
  const SporeCamera camera = straight_camera(0.2);
  const SporeRenderOptions options = {.width = PICTURE_WIDTH, .height = PICTURE_HEIGHT, .coarse = coarse};
  Picture picture = {PICTURE_WIDTH, PICTURE_HEIGHT, g_malloc(4 * PICTURE_WIDTH * PICTURE_HEIGHT)};
  GError *error = NULL;
  spore_renderer_draw(bench->renderer, &camera, &options, picture.pixels, 4 * PICTURE_WIDTH, &error);
  g_assert_no_error(error);
  return picture;
}

/* A coarse picture has fewer triangles of a fine surface and looks alike, also when the surface moves; others stay as
 * they are. */
static void test_coarse(void) {
  const SporeSurfaceStyle style = {.colour = {0.5f, 0.1f, 0.1f}, .wetness = 0.5f};
  gsize whole, coarse;
  Bench bench = bench_open();
  SporeTriangleMesh organ = make_organ(0.05), fine = fine_ball(160, 1), moved = fine_ball(160, 0.6);
  guint small = spore_renderer_add_surface(bench.renderer, organ.vertices, organ.vertex_count, organ.triangles,
                                           organ.triangle_count, &style);
  spore_renderer_count_triangles(bench.renderer, &whole, &coarse);
  g_assert_cmpuint(coarse, ==, whole);
  spore_renderer_set_visible(bench.renderer, small, FALSE);
  guint handle = spore_renderer_add_surface(bench.renderer, fine.vertices, fine.vertex_count, fine.triangles,
                                            fine.triangle_count, &style);
  spore_renderer_count_triangles(bench.renderer, &whole, &coarse);
  g_assert_cmpuint(whole, ==, fine.triangle_count);
  g_assert_cmpuint(coarse, <, whole / 2);
  for (int squeezed = 0; squeezed < 2; squeezed++) {
    if (squeezed) spore_renderer_move_surface(bench.renderer, handle, moved.vertices);
    Picture a = draw_coarse(&bench, FALSE), b = draw_coarse(&bench, TRUE);
    PictureDifference difference = picture_compare(&a, &b);
    g_test_message("%zu of %zu triangles: mean %.2f", coarse, whole, difference.mean);
    g_assert_cmpfloat(difference.mean, <, 1);
    g_assert_cmpfloat(difference.mean, >, 0);
    picture_clear(&a);
    picture_clear(&b);
  }
  spore_triangle_mesh_clear(&organ);
  spore_triangle_mesh_clear(&fine);
  spore_triangle_mesh_clear(&moved);
  bench_close(&bench);
}

/* Rows of the picture that a line across it takes. */
static int rows_of_line(const Bench *bench, int scale) {
  const SporeCamera camera = straight_camera(0.3);
  const SporeRenderOptions options = {.width = 120, .height = 120, .scale = scale};
  Picture picture = {120, 120, g_malloc(4 * 120 * 120)};
  GError *error = NULL;
  int rows = 0;
  spore_renderer_draw(bench->renderer, &camera, &options, picture.pixels, 4 * 120, &error);
  g_assert_no_error(error);
  for (int y = 0; y < 120; y++) rows += is_blue(&picture, 60, y);
  picture_clear(&picture);
  return rows;
}

/* A picture of two pixels for each of the widget has lines twice as wide. */
static void test_scale(void) {
  static const double points[6] = {-0.2, 0, 0, 0.2, 0, 0};
  Bench bench = bench_open();
  spore_renderer_add_lines(bench.renderer, points, 1, blue, 6);
  int one = rows_of_line(&bench, 1), two = rows_of_line(&bench, 2);
  g_assert_cmpint(one, ==, rows_of_line(&bench, 0));
  g_assert_cmpint(abs(one - 6), <=, 1);
  g_assert_cmpint(abs(two - 12), <=, 1);
  bench_close(&bench);
}

static void test_rows_from_the_top(void) {
  static const double above[4] = {-0.05, 0.05, 0, 0.02}, below[4] = {0.05, -0.05, 0, 0.02};
  Bench bench = bench_open();
  spore_renderer_add_spheres(bench.renderer, above, 1, red, NULL, FALSE);
  spore_renderer_add_spheres(bench.renderer, below, 1, blue, NULL, FALSE);
  SporeCamera camera = straight_camera(0.3);
  for (int antialias = 0; antialias < 2; antialias++) {
    Picture picture = draw_picture(bench.renderer, &camera, 200, 200, antialias, FALSE);
    int half = (int)(0.05 / (0.3 * tan(0.35)) * 100);
    g_assert_true(is_red(&picture, 100 - half, 100 - half));
    g_assert_true(is_blue(&picture, 100 + half, 100 + half));
    g_assert_false(is_red(&picture, 100 - half, 100 + half));
    picture_clear(&picture);
  }
  bench_close(&bench);
}

/* A surface seen from its front in front of a sphere, with rows longer than the picture. */
static void test_depth_and_stride(void) {
  static const double square[12] = {-0.05, -0.05, 0, 0.05, -0.05, 0, 0.05, 0.05, 0, -0.05, 0.05, 0};
  static const guint32 triangles[6] = {0, 1, 2, 0, 2, 3};
  static const double behind[4] = {0, 0, -0.05, 0.02}, before[4] = {0, 0, 0.01, 0.02};
  const SporeSurfaceStyle style = {{0.7f, 0.02f, 0.02f}, 0, FALSE, FALSE, FALSE};
  Bench bench = bench_open();
  spore_renderer_add_surface(bench.renderer, square, 4, triangles, 2, &style);
  guint sphere = spore_renderer_add_spheres(bench.renderer, behind, 1, blue, NULL, FALSE);
  SporeCamera camera = straight_camera(0.3);
  const SporeRenderOptions options = {.width = 64, .height = 64};
  guint8 *pixels = g_malloc0(64 * 400);
  g_assert_true(spore_renderer_draw(bench.renderer, &camera, &options, pixels, 400, NULL));
  guint32 middle;
  memcpy(&middle, pixels + 32 * 400 + 32 * 4, 4);
  g_assert_cmpuint(middle >> 16 & 255, >, 2 * (middle & 255));
  for (int i = 256; i < 400; i++) g_assert_cmpint(pixels[i], ==, 0);
  spore_renderer_move_spheres(bench.renderer, sphere, before, 1);
  g_assert_true(spore_renderer_draw(bench.renderer, &camera, &options, pixels, 400, NULL));
  memcpy(&middle, pixels + 32 * 400 + 32 * 4, 4);
  g_assert_cmpuint(middle & 255, >, 2 * (middle >> 16 & 255));
  g_free(pixels);
  bench_close(&bench);
}

/* A picture that is drawn while the caller goes on is the one that is drawn at once; the last that was begun counts. */
static void test_begun_and_read(void) {
  static const double sphere[4] = {0, 0, 0, 0.03};
  Bench bench = bench_open();
  g_assert_false(spore_renderer_is_drawn(bench.renderer, 0)); /* none was begun */
  guint group = spore_renderer_add_spheres(bench.renderer, sphere, 1, red, NULL, FALSE);
  const SporeCamera camera = straight_camera(0.3), other = straight_camera(0.2);
  Picture at_once = draw_picture(bench.renderer, &camera, 64, 64, FALSE, FALSE);
  const SporeRenderOptions options = {.width = 64, .height = 64}, small = {.width = 16, .height = 16};
  g_assert_true(spore_renderer_begin(bench.renderer, &other, &small, NULL));
  g_assert_true(spore_renderer_begin(bench.renderer, &camera, &options, NULL));
  spore_renderer_remove(bench.renderer, group); /* after it was begun */
  g_autofree guint8 *pixels = g_malloc(64 * 64 * 4);
  while (!spore_renderer_is_drawn(bench.renderer, 1)) {
  }
  g_assert_true(spore_renderer_read(bench.renderer, pixels, 64 * 4, NULL));
  g_assert_cmpmem(pixels, 64 * 64 * 4, at_once.pixels, 64 * 64 * 4);
  g_assert_false(spore_renderer_is_drawn(bench.renderer, 0)); /* and none is left */
  picture_clear(&at_once);
  bench_close(&bench);
}

static gpointer prepare_bench(gpointer data) {
  Bench *bench = data;
  *bench = bench_open();
  g_assert_true(spore_renderer_warm(bench->renderer, NULL));
  spore_offscreen_release(bench->offscreen);
  return NULL;
}

/* What a thread has prepared draws on another one, and draws the same as what draws at once. */
static void test_prepared_on_a_thread(void) {
  static const double sphere[4] = {0, 0, 0, 0.03};
  Bench prepared, plain = bench_open();
  g_thread_join(g_thread_new("prepare", prepare_bench, &prepared));
  const SporeCamera camera = straight_camera(0.3);
  spore_renderer_add_spheres(plain.renderer, sphere, 1, red, NULL, TRUE);
  spore_renderer_add_spheres(prepared.renderer, sphere, 1, red, NULL, TRUE);
  SporeTriangleMesh organ = make_organ(0.02);
  const SporeSurfaceStyle style = {.colour = {0.5f, 0.1f, 0.1f}, .wetness = 0.5f};
  spore_renderer_add_surface(plain.renderer, organ.vertices, organ.vertex_count, organ.triangles, organ.triangle_count,
                             &style);
  spore_renderer_add_surface(prepared.renderer, organ.vertices, organ.vertex_count, organ.triangles,
                             organ.triangle_count, &style);
  spore_triangle_mesh_clear(&organ);
  Picture expected = draw_picture(plain.renderer, &camera, 64, 64, FALSE, TRUE),
          found = draw_picture(prepared.renderer, &camera, 64, 64, FALSE, TRUE);
  g_assert_cmpmem(found.pixels, 64 * 64 * 4, expected.pixels, 64 * 64 * 4);
  picture_clear(&expected);
  picture_clear(&found);
  bench_close(&prepared);
  bench_close(&plain);
}

static Picture draw_clipped(const Bench *bench, const SporeClip *clip, gboolean antialias) {
  const SporeCamera camera = straight_camera(0.3);
  const SporeRenderOptions options = {.width = 200, .height = 150, .antialias = antialias, .clip = *clip};
  Picture picture = {200, 150, g_malloc(200 * 150 * 4)};
  g_assert_true(spore_renderer_draw(bench->renderer, &camera, &options, picture.pixels, 200 * 4, NULL));
  return picture;
}

/* Half of an organ beyond a plane, with a sphere within and one that the plane goes through. Pictures: whole, cut by a
 * plane behind which all lies, cut open, and cut from the other side. */
static void draw_cut(const Bench *bench, const SporeTriangleMesh *mesh, gsize triangle_count, gboolean antialias,
                     Picture pictures[4]) {
  const SporeSurfaceStyle style = {{0.7f, 0.02f, 0.02f}, 0, FALSE, FALSE, FALSE};
  const SporeClip clips[4] = {{{0}}, {{0, 0, 1}, 0.2}, {{0, 0, 1}, 0}, {{0, 0, -1}, 0}};
  static const double within[4] = {0, 0, -0.01, 0.009}, half[4] = {0.01, 0.02, 0.002, 0.008};
  guint surface = spore_renderer_add_surface(bench->renderer, mesh->vertices, mesh->vertex_count, mesh->triangles,
                                             triangle_count, &style);
  guint spheres[2] = {spore_renderer_add_spheres(bench->renderer, within, 1, blue, NULL, FALSE),
                      spore_renderer_add_spheres(bench->renderer, half, 1, blue, NULL, FALSE)};
  for (int i = 0; i < 4; i++) pictures[i] = draw_clipped(bench, &clips[i], antialias);
  for (int i = 0; i < 2; i++) spore_renderer_remove(bench->renderer, spheres[i]);
  spore_renderer_remove(bench->renderer, surface);
}

/* A plane takes the near half of a body away, and what the body holds is seen where its surface is open; the cut of a
 * closed one is filled. A plane behind which all lies, and the other side of the first one, leave the picture as it
 * was. */
static void test_clip(void) {
  Bench bench = bench_open();
  SporeTriangleMesh mesh = make_organ(0.05);
  for (int way = 0; way < 4; way++) {
    gboolean closed = way & 1;
    Picture pictures[4], *whole = &pictures[0], *open = &pictures[2];
    draw_cut(&bench, &mesh, mesh.triangle_count - !closed, way >> 1, pictures);
    g_assert_cmpfloat(picture_compare(whole, &pictures[1]).mean, <, 0.02);
    g_assert_true(is_red(whole, 100, 75));
    g_assert_cmpint(is_blue(open, 100, 75), ==, !closed);
    g_assert_cmpint(is_blue(open, 100 + 7, 75 - 14), ==, !closed); /* the sphere that is cut, from within */
    g_assert_cmpint(is_red(open, 100, 75), ==, closed);
    g_assert_true(is_red(open, 100 - 20, 75));
    g_assert_true(is_red(&pictures[3], 100, 75));
    g_assert_cmpfloat(picture_compare(whole, open).mean, >, 2);
    for (int i = 0; i < 4; i++) picture_clear(&pictures[i]);
  }
  spore_triangle_mesh_clear(&mesh);
  bench_close(&bench);
}

/* The cut of a closed body is as bright in its middle as beside it, in the colour of the body, and ends where the body
 * does; a smaller body within is seen in the cut of the larger one, whichever was added first. */
static void test_caps(void) {
  const SporeSurfaceStyle outer = {{0.7f, 0.02f, 0.02f}, 0, SPORE_MATERIAL_TISSUE, FALSE, FALSE},
                          inner = {{0.02f, 0.02f, 0.7f}, 0, SPORE_MATERIAL_TISSUE, FALSE, FALSE};
  const SporeClip near = {{0, 0, 1}, 0};
  SporeTriangleMesh large = make_organ(0.05), small = make_organ(0.02);
  for (int order = 0; order < 2; order++) {
    Bench bench = bench_open();
    for (int i = 0; i < 2; i++) {
      const SporeTriangleMesh *mesh = i == order ? &large : &small;
      spore_renderer_add_surface(bench.renderer, mesh->vertices, mesh->vertex_count, mesh->triangles,
                                 mesh->triangle_count, i == order ? &outer : &inner);
    }
    for (int antialias = 0; antialias < 2; antialias++) {
      Picture open = draw_clipped(&bench, &near, antialias);
      int left[3], right[3];
      picture_pixel(&open, 100 - 26, 75, left);
      picture_pixel(&open, 100 + 26, 75, right);
      g_assert_true(is_red(&open, 100 - 26, 75) && is_red(&open, 100 + 26, 75));
      g_assert_cmpint(abs(left[0] - right[0]), <, 40);
      g_assert_true(is_blue(&open, 100, 75));
      g_assert_false(is_red(&open, 100 - 60, 75));
      picture_clear(&open);
    }
    bench_close(&bench);
  }
  spore_triangle_mesh_clear(&large);
  spore_triangle_mesh_clear(&small);
}

/* What lies in no cone is tinted, and nothing else: by depth, by angle, and where another cone reaches it. */
static void test_tint(void) {
  const SporeSurfaceStyle style = {{0.7f, 0.02f, 0.02f}, 0, SPORE_MATERIAL_TISSUE, FALSE, FALSE};
  const SporeClip none = {0};
  const SporeCone cones[3] = {{{0, 0.2, 0}, {0, -1, 0}, 0.8, 0.02, 0.2},
                              {{0, -0.2, 0}, {0, 1, 0}, 0.8, 0.02, 0.205},
                              {{-0.1, 0, 0.04}, {0, 1, 0}, 0.8, 0.02, 0.3}};
  static const struct {
    guint first, count;
    gboolean above, below;
  } cases[] = {
      {0, 0, FALSE, FALSE}, {0, 1, FALSE, TRUE}, {1, 1, TRUE, FALSE}, {0, 2, FALSE, FALSE}, {2, 1, TRUE, TRUE}};
  Bench bench = bench_open();
  SporeTriangleMesh mesh = make_organ(0.05);
  spore_renderer_add_surface(bench.renderer, mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count,
                             &style);
  for (guint i = 0; i < 2 * G_N_ELEMENTS(cases); i++) {
    gboolean antialias = i >= G_N_ELEMENTS(cases);
    guint at = i % G_N_ELEMENTS(cases);
    spore_renderer_tint_beyond(bench.renderer, cones + cases[at].first, cases[at].count);
    Picture picture = draw_clipped(&bench, &none, antialias);
    g_assert_cmpint(is_blue(&picture, 100, 75 - 16), ==, cases[at].above);
    g_assert_cmpint(is_blue(&picture, 100, 75 + 16), ==, cases[at].below);
    picture_clear(&picture);
  }
  spore_triangle_mesh_clear(&mesh);
  bench_close(&bench);
}

/* The background is kept from picture to picture: not for another room, nor for another size. */
static void test_background_kept(void) {
  const SporeCamera camera = {.distance = 0.24, .field_of_view = 0.7};
  SporeRenderOptions options = {.width = 64, .height = 48};
  guint32 rooms[2][3][64 * 48] = {0};
  Bench bench = bench_open();
  for (int turn = 0; turn < 2; turn++)
    for (int room = 0; room < 3; room++) {
      GError *error = NULL;
      options.light = room == 1, options.height = room == 2 ? 40 : 48;
      spore_renderer_draw(bench.renderer, &camera, &options, (guint8 *)rooms[turn][room], 64 * 4, &error);
      g_assert_no_error(error);
    }
  g_assert_cmpmem(rooms[0], sizeof rooms[0], rooms[1], sizeof rooms[1]);
  for (int a = 0; a < 3; a++) g_assert_true(memcmp(rooms[0][a], rooms[0][(a + 1) % 3], 64 * 40 * 4) != 0);
  bench_close(&bench);
}

/* A surface that has values, all of them "none", or stains of nothing, is drawn by the program that does everything;
 * else by one that does what its material needs. */
static void check_own_program(SporeMaterial material, gboolean stains) {
  const SporeSurfaceStyle style = {.colour = {0.45f, 0.09f, 0.075f}, .wetness = 0.8f, .material = material};
  const SporeCamera camera = {.distance = 0.24, .azimuth = 0.5, .elevation = 0.35, .field_of_view = 0.7};
  Bench bench = bench_open();
  SporeTriangleMesh mesh = make_organ(0.05);
  g_autofree float *numbers = g_new0(float, mesh.vertex_count);
  guint surface = spore_renderer_add_surface(bench.renderer, mesh.vertices, mesh.vertex_count, mesh.triangles,
                                             mesh.triangle_count, &style);
  Picture own = draw_picture(bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, FALSE, FALSE);
  for (gsize v = 0; v < mesh.vertex_count && !stains; v++) numbers[v] = -1;
  if (stains) spore_renderer_stain_surface(bench.renderer, surface, numbers);
  else spore_renderer_value_surface(bench.renderer, surface, numbers);
  Picture any = draw_picture(bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, FALSE, FALSE);
  g_assert_cmpfloat(picture_compare(&own, &any).mean, <, 0.1);
  for (gsize v = 0; v < mesh.vertex_count; v++) numbers[v] = 1;
  if (stains) spore_renderer_stain_surface(bench.renderer, surface, numbers);
  else spore_renderer_value_surface(bench.renderer, surface, numbers);
  Picture other = draw_picture(bench.renderer, &camera, PICTURE_WIDTH, PICTURE_HEIGHT, FALSE, FALSE);
  g_assert_cmpfloat(picture_compare(&own, &other).mean, >, 1);
  picture_clear(&own), picture_clear(&any), picture_clear(&other);
  spore_triangle_mesh_clear(&mesh);
  bench_close(&bench);
}

static void test_own_programs(void) {
  check_own_program(SPORE_MATERIAL_TISSUE, FALSE);
  check_own_program(SPORE_MATERIAL_METAL, TRUE);
  check_own_program(SPORE_MATERIAL_LIQUID, FALSE);
}

/* Far from the world's origin single precision no longer resolves millimetres: the same picture must come out. */
static void test_far_from_the_origin(void) {
  const SporeSurfaceStyle style = {{0.45f, 0.09f, 0.075f}, 0.5f, FALSE, FALSE, FALSE};
  const double away = 5e4;
  Picture pictures[2];
  for (int moved = 0; moved < 2; moved++) {
    Bench bench = bench_open();
    SporeTriangleMesh mesh = make_organ(0.05);
    for (gsize i = 0; i < mesh.vertex_count; i++) mesh.vertices[3 * i] += moved * away;
    spore_renderer_add_surface(bench.renderer, mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count,
                               &style);
    SporeCamera camera = straight_camera(0.25);
    camera.target.x += moved * away;
    pictures[moved] = draw_picture(bench.renderer, &camera, 200, 150, FALSE, FALSE);
    spore_triangle_mesh_clear(&mesh);
    bench_close(&bench);
  }
  PictureDifference difference = picture_compare(&pictures[0], &pictures[1]);
  g_assert_cmpfloat(difference.mean, <, 0.2);
  picture_clear(&pictures[0]);
  picture_clear(&pictures[1]);
}

static int middle_blue(const Bench *bench, gboolean antialias) {
  SporeCamera camera = straight_camera(0.3);
  int rgb[3];
  Picture picture = draw_picture(bench->renderer, &camera, 64, 64, antialias, FALSE);
  picture_pixel(&picture, 32, 32, rgb);
  picture_clear(&picture);
  return rgb[2];
}

/* Smoke covers what is behind it in part, is covered by what is before it, and the order of its puffs is no matter. */
static void test_puffs(void) {
  static const double ball[4] = {0, 0, 0, 0.02};
  static const SporePuff behind = {{0, 0, -0.1}, 0.03, 0.9, 3}, before = {{0, 0, 0.06}, 0.03, 0.9, 3};
  const SporePuff both[2] = {{{0, 0, 0.08}, 0.03, 0.5, 3}, {{0, 0, 0.05}, 0.03, 0.9, 5}},
                  turned[2] = {both[1], both[0]};
  Bench bench = bench_open();
  spore_renderer_add_spheres(bench.renderer, ball, 1, red, NULL, FALSE);
  for (int antialias = 0; antialias < 2; antialias++) {
    int bare = middle_blue(&bench, antialias);
    guint smoke = spore_renderer_add_puffs(bench.renderer, blue);
    g_assert_cmpint(middle_blue(&bench, antialias), ==, bare);
    spore_renderer_move_puffs(bench.renderer, smoke, &behind, 1);
    g_assert_cmpint(abs(middle_blue(&bench, antialias) - bare), <=, 1); /* the range of depth is another */
    spore_renderer_move_puffs(bench.renderer, smoke, &before, 1);
    g_test_message("blue of 255: %d bare, %d behind smoke", bare, middle_blue(&bench, antialias));
    g_assert_cmpint(middle_blue(&bench, antialias), >, bare + 20);
    spore_renderer_move_puffs(bench.renderer, smoke, both, 2);
    int sorted = middle_blue(&bench, antialias);
    spore_renderer_move_puffs(bench.renderer, smoke, turned, 2);
    g_assert_cmpint(middle_blue(&bench, antialias), ==, sorted);
    spore_renderer_remove(bench.renderer, smoke);
  }
  bench_close(&bench);
}

/* A ball inside a larger body, and one before it: the first is seen where the body is clear, the second always. */
static void test_clear(void) {
  static const double inside[4] = {0, 0, 0, 0.02}, before[4] = {0, 0, 0.08, 0.01};
  static const float clearness[] = {0, 0.8f, 0};
  const SporeClip whole = {{0, 0, 0}, 0};
  SporeSurfaceStyle style = {{0.02f, 0.02f, 0.7f}, 0, SPORE_MATERIAL_LIQUID, FALSE, FALSE, 0};
  SporeTriangleMesh mesh = make_organ(0.05);
  Bench bench = bench_open();
  spore_renderer_add_spheres(bench.renderer, inside, 1, red, NULL, FALSE);
  guint body = spore_renderer_add_surface(bench.renderer, mesh.vertices, mesh.vertex_count, mesh.triangles,
                                          mesh.triangle_count, &style);
  for (int antialias = 0; antialias < 2; antialias++)
    for (gsize i = 0; i < G_N_ELEMENTS(clearness); i++) {
      style.clearness = clearness[i];
      spore_renderer_style_surface(bench.renderer, body, &style);
      Picture picture = draw_clipped(&bench, &whole, antialias);
      g_assert_cmpint(is_red(&picture, 100, 75), ==, clearness[i] > 0);
      picture_clear(&picture);
    }
  style.clearness = 0.8f;
  spore_renderer_style_surface(bench.renderer, body, &style);
  spore_renderer_add_spheres(bench.renderer, before, 1, blue, NULL, FALSE);
  Picture picture = draw_clipped(&bench, &whole, FALSE);
  g_assert_true(is_blue(&picture, 100, 75));
  picture_clear(&picture);
  spore_triangle_mesh_clear(&mesh);
  bench_close(&bench);
}

static void test_handles(void) {
  static const double sphere[4] = {0, 0, 0, 0.05};
  Bench bench = bench_open();
  SporeCamera camera = straight_camera(0.3);
  guint a = spore_renderer_add_spheres(bench.renderer, sphere, 1, red, NULL, FALSE);
  guint b = spore_renderer_add_spheres(bench.renderer, sphere, 1, blue, NULL, FALSE);
  g_assert_cmpuint(a, !=, 0);
  g_assert_cmpuint(a, !=, b);
  spore_renderer_remove(bench.renderer, b);
  Picture picture = draw_picture(bench.renderer, &camera, 64, 64, FALSE, FALSE);
  g_assert_true(is_red(&picture, 32, 32));
  picture_clear(&picture);
  spore_renderer_set_visible(bench.renderer, a, FALSE);
  picture = draw_picture(bench.renderer, &camera, 64, 64, FALSE, FALSE);
  g_assert_false(is_red(&picture, 32, 32));
  picture_clear(&picture);
  spore_renderer_clear(bench.renderer);
  guint c = spore_renderer_add_spheres(bench.renderer, sphere, 1, blue, NULL, FALSE);
  picture = draw_picture(bench.renderer, &camera, 64, 64, TRUE, TRUE);
  g_assert_cmpuint(c, !=, 0);
  g_assert_true(is_blue(&picture, 32, 32));
  picture_clear(&picture);
  bench_close(&bench);
}

static void test_bad_sizes(void) {
  static const int sizes[][2] = {{0, 100}, {100, -1}, {1000000, 100}};
  Bench bench = bench_open();
  SporeCamera camera = straight_camera(0.3);
  guint8 pixel[4];
  for (gsize i = 0; i < G_N_ELEMENTS(sizes); i++) {
    GError *error = NULL;
    const SporeRenderOptions options = {.width = sizes[i][0], .height = sizes[i][1]};
    g_assert_false(spore_renderer_draw(bench.renderer, &camera, &options, pixel, 4, &error));
    g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
    g_error_free(error);
  }
  bench_close(&bench);
}

static void test_two_contexts(void) {
  static const double sphere[4] = {0, 0, 0, 0.05};
  Bench first = bench_open(), second = bench_open();
  SporeCamera camera = straight_camera(0.3);
  spore_renderer_add_spheres(first.renderer, sphere, 1, red, NULL, FALSE);
  spore_renderer_add_spheres(second.renderer, sphere, 1, blue, NULL, FALSE);
  Picture a = draw_picture(first.renderer, &camera, 64, 64, FALSE, FALSE);
  bench_close(&first); /* the display must outlive it */
  Picture b = draw_picture(second.renderer, &camera, 64, 64, FALSE, FALSE);
  g_assert_true(is_red(&a, 32, 32));
  g_assert_true(is_blue(&b, 32, 32));
  picture_clear(&a);
  picture_clear(&b);
  bench_close(&second);
}

static void test_camera(void) {
  const double lower[3] = {-0.1, 0.2, -0.3}, upper[3] = {0.3, 0.4, 0.1};
  for (int i = 0; i < 20; i++) {
    SporeCamera camera = {.azimuth = 0.7 * i, .elevation = sin(i), .roll = 0.4 * i, .field_of_view = 0.7};
    double aspect = i % 2 ? 1.6 : 0.6;
    int height = 500, width = (int)(aspect * height);
    spore_camera_frame(&camera, lower, upper, aspect);
    SporeVec3 eye, right, up, forward, origin, direction;
    spore_camera_eye(&camera, &eye, &right, &up, &forward);
    g_assert_cmpfloat_with_epsilon(spore_vec3_dot(right, up), 0, 1e-12);
    g_assert_cmpfloat_with_epsilon(spore_vec3_dot(spore_vec3_cross(right, up), forward), -1, 1e-12);
    spore_camera_ray(&camera, width / 2.0, height / 2.0, width, height, &origin, &direction);
    SporeVec3 reached = spore_vec3_add_scaled(origin, camera.distance, direction);
    g_assert_cmpfloat_with_epsilon(spore_vec3_distance(reached, camera.target), 0, 1e-9);
    for (int corner = 0; corner < 8; corner++) { /* the whole box is seen */
      SporeVec3 p = {(corner & 1 ? upper : lower)[0], (corner & 2 ? upper : lower)[1], (corner & 4 ? upper : lower)[2]};
      SporeVec3 to = spore_vec3_sub(p, eye);
      double depth = spore_vec3_dot(to, forward), slope = tan(camera.field_of_view / 2);
      g_assert_cmpfloat(depth, >, 0);
      g_assert_cmpfloat(fabs(spore_vec3_dot(to, up)), <=, depth * slope * 1.1);
      g_assert_cmpfloat(fabs(spore_vec3_dot(to, right)), <=, depth * slope * aspect * 1.1);
    }
  }
}

/* A lens leaves the corners, the middle and what the field of view ends at where they are; the measure says how much
 * larger it draws the middle than a corner's distance tells; and a place is drawn where its ray goes through. */
static void test_lens(void) {
  const int width = 640, height = 360;
  SporeCamera plain = {.distance = 0.2, .azimuth = 0.3, .elevation = 0.2, .field_of_view = 0.8}, bent = plain;
  SporeVec3 eye, right, up, forward;
  bent.distortion = 0.2;
  spore_camera_eye(&bent, &eye, &right, &up, &forward);
  SporeVec3 near = spore_vec3_add_scaled(bent.target, 1e-6, right);
  const double places[][2] = {{320, 180}, {320, 0}, {0, 0}, {100, 300}, {639, 200}};
  for (gsize i = 0; i < G_N_ELEMENTS(places); i++) {
    double x, y;
    SporeVec3 place = spore_camera_unproject(&bent, bent.target, places[i][0], places[i][1], width, height);
    g_assert_true(spore_camera_project(&bent, place, width, height, &x, &y));
    g_assert_cmpfloat_with_epsilon(x, places[i][0], 1e-9);
    g_assert_cmpfloat_with_epsilon(y, places[i][1], 1e-9);
    SporeVec3 straight = spore_camera_unproject(&plain, bent.target, places[i][0], places[i][1], width, height);
    if (i < 2) g_assert_cmpfloat(spore_vec3_distance(place, straight), <, 1e-12);
    else g_assert_cmpfloat(spore_vec3_distance(place, straight), >, 1e-3);
  }
  double x, y, corner_x, corner_y, a_metre;
  g_assert_true(spore_camera_project(&bent, near, width, height, &x, &y));
  a_metre = (x - 320) / 1e-6;
  SporeVec3 corner = spore_camera_unproject(&bent, bent.target, 0, 0, width, height);
  g_assert_true(spore_camera_project(&bent, corner, width, height, &corner_x, &corner_y));
  double off = spore_vec3_distance(corner, bent.target) * a_metre;
  g_assert_cmpfloat_with_epsilon(hypot(corner_x - 320, corner_y - 180) / off, 0.8, 1e-6);
}

/* Pictures of something that moves are coarse where a sharp one takes long, and only then; the last one is sharp. */
static void test_sharpness(void) {
  for (int slow = 0; slow < 2; slow++) {
    SporeSharpness sharpness = {0};
    gint64 now_us = 1000000, takes_us = slow ? 60000 : 20000;
    for (int picture = 0; picture < 6; picture++) {
      g_assert_cmpint(spore_sharpness_begin(&sharpness, now_us), ==, slow && picture >= 2 ? 2 : 1);
      spore_sharpness_drawn(&sharpness, now_us += sharpness.coarse ? takes_us / 4 : takes_us);
      now_us += 16000;
    }
    g_assert_true(sharpness.coarse == slow);
    spore_sharpness_rest(&sharpness);
    g_assert_cmpint(spore_sharpness_begin(&sharpness, now_us), ==, 1);
    spore_sharpness_drawn(&sharpness, now_us += takes_us);
    now_us += spore_sharpness_rest_us;
    g_assert_cmpint(spore_sharpness_begin(&sharpness, now_us), ==, 1);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/render/renderer/lens", test_lens);
  g_test_add_func("/render/renderer/impostors-fast", test_impostors_fast);
  g_test_add_func("/render/renderer/impostors-full", test_impostors_full);
  g_test_add_func("/render/renderer/impostors-through-lens", test_impostors_through_lens);
  g_test_add_func("/render/renderer/clip", test_clip);
  g_test_add_func("/render/renderer/caps", test_caps);
  g_test_add_func("/render/renderer/tint", test_tint);
  g_test_add_func("/render/renderer/coarse", test_coarse);
  g_test_add_func("/render/renderer/scale", test_scale);
  g_test_add_func("/render/renderer/rows-from-the-top", test_rows_from_the_top);
  g_test_add_func("/render/renderer/depth-and-stride", test_depth_and_stride);
  g_test_add_func("/render/renderer/begun-and-read", test_begun_and_read);
  g_test_add_func("/render/renderer/prepared-on-a-thread", test_prepared_on_a_thread);
  g_test_add_func("/render/renderer/own-programs", test_own_programs);
  g_test_add_func("/render/renderer/sharpness", test_sharpness);
  g_test_add_func("/render/renderer/background-kept", test_background_kept);
  g_test_add_func("/render/renderer/far-from-the-origin", test_far_from_the_origin);
  g_test_add_func("/render/renderer/puffs", test_puffs);
  g_test_add_func("/render/renderer/clear", test_clear);
  g_test_add_func("/render/renderer/handles", test_handles);
  g_test_add_func("/render/renderer/bad-sizes", test_bad_sizes);
  g_test_add_func("/render/renderer/two-contexts", test_two_contexts);
  g_test_add_func("/render/renderer/camera", test_camera);
  return g_test_run();
}
