/* Legends: their rows, and where they lie in a picture. */
#include <string.h>

#include "ui/render/colour_scale.h"
#include "ui/render/legend.h"
#include "ui/render/svg.h"

#define WIDTH 640
#define HEIGHT 480
#define STRIDE (4 * WIDTH + 16)
#define GROUND 0x55

static const SporeStageLegend scaled = {
    .label = "Speed", .low = "0", .high = "2 m/s", .range = "fixed scale", .without = "not known of: <net> & \"bag\""};
static const SporeStageLegend keyed = {
    .label = "Links", .key_count = 2, .keys = {{{1, 0, 0}, "Pin (red): 2"}, {{0, 1, 0}, "Weld (green): 1"}}};
static const SporeStageLegend tinted = {.label = "Out of reach", .tint = TRUE, .range = "blue, at the start"};

static void assert_rows(const SporeStageLegend *legend, gboolean brief, const char *kinds) {
  SporeLegendRow rows[SPORE_LEGEND_ROWS];
  GString *found = g_string_new(NULL);
  guint count = spore_legend_rows(legend, brief, rows);
  g_assert_cmpuint(count, <=, SPORE_LEGEND_ROWS);
  for (guint i = 0; i < count; i++) g_string_append_c(found, "lbtek"[rows[i].kind]);
  g_assert_cmpstr(found->str, ==, kinds);
  g_string_free(found, TRUE);
}

static void test_rows(void) {
  SporeStageLegend full = scaled;
  assert_rows(&scaled, FALSE, "lbell");
  assert_rows(&scaled, TRUE, "lbe");
  assert_rows(&keyed, FALSE, "lkk");
  assert_rows(&tinted, FALSE, "ltl");
  assert_rows(&tinted, TRUE, "ltl"); /* its remark says what the colour means */
  full.tint = TRUE, full.key_count = SPORE_STAGE_LINK_KINDS;
  assert_rows(&full, FALSE, "ltbekkkkkkkkll");
}

#ifdef SPORE_HAVE_PIXBUF

typedef struct Drawn {
  guint8 pixels[HEIGHT * STRIDE];
  guint left_out;
  int left, top, right, bottom; /* of what changed */
} Drawn;

static void draw(Drawn *drawn, const SporeStageLegend *legends, guint count, int width, int height, gboolean light) {
  GError *error = NULL;
  memset(drawn->pixels, GROUND, sizeof drawn->pixels);
  drawn->left_out = spore_legends_draw(legends, count, light, drawn->pixels, width, height, STRIDE, &error);
  g_assert_no_error(error);
  drawn->left = width, drawn->top = height, drawn->right = drawn->bottom = -1;
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < STRIDE / 4; x++) {
      const guint8 *pixel = drawn->pixels + y * STRIDE + 4 * x;
      if (pixel[0] == GROUND && pixel[1] == GROUND && pixel[2] == GROUND) continue;
      drawn->left = MIN(drawn->left, x), drawn->top = MIN(drawn->top, y);
      drawn->right = MAX(drawn->right, x), drawn->bottom = MAX(drawn->bottom, y);
    }
}

/* Whether the colour is anywhere in the picture, within a little. */
static gboolean has(const Drawn *drawn, const double srgb[3]) {
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    guint32 pixel;
    gboolean same = TRUE;
    memcpy(&pixel, drawn->pixels + i / WIDTH * STRIDE + i % WIDTH * 4, 4);
    for (int k = 0; k < 3; k++) same = same && ABS((int)(pixel >> (16 - 8 * k) & 255) - (int)(255 * srgb[k])) <= 3;
    if (same) return TRUE;
  }
  return FALSE;
}

/* A legend lies at the lower right, and shows its colours alone. */
static void test_picture(void) {
  g_autofree Drawn *drawn = g_new(Drawn, 1);
  double first[3], last[3];
  spore_colour_scale(0, first);
  spore_colour_scale(1, last);
  for (int light = 0; light < 2; light++) {
    draw(drawn, &scaled, 1, WIDTH, HEIGHT, light);
    g_assert_cmpuint(drawn->left_out, ==, 0);
    g_assert_cmpint(drawn->left, >, WIDTH / 3);
    g_assert_cmpint(drawn->top, >, HEIGHT / 2);
    g_assert_cmpint(drawn->right, >, WIDTH - 20);
    g_assert_cmpint(drawn->right, <, WIDTH);
    g_assert_cmpint(drawn->bottom, <, HEIGHT);
    g_assert_true(has(drawn, first) && has(drawn, last));
    g_assert_false(has(drawn, keyed.keys[0].colour) || has(drawn, spore_tint_colour));
  }
  draw(drawn, &keyed, 1, WIDTH, HEIGHT, FALSE);
  g_assert_true(has(drawn, keyed.keys[0].colour) && has(drawn, keyed.keys[1].colour));
  g_assert_false(has(drawn, first) || has(drawn, last));
  draw(drawn, &tinted, 1, WIDTH, HEIGHT, FALSE);
  g_assert_true(has(drawn, spore_tint_colour));
}

/* Several stand one above the other; where not all have room, some are left out, and nothing is drawn elsewhere. */
static void test_room(void) {
  g_autofree Drawn *drawn = g_new(Drawn, 1);
  const SporeStageLegend all[] = {scaled, keyed, tinted};
  draw(drawn, all, 1, WIDTH, HEIGHT, FALSE);
  int top = drawn->top;
  draw(drawn, all, 3, WIDTH, HEIGHT, FALSE);
  g_assert_cmpuint(drawn->left_out, ==, 0);
  g_assert_cmpint(drawn->top, <, top - 60);
  draw(drawn, all, 3, 190, 90, FALSE);
  g_assert_cmpuint(drawn->left_out, >, 0);
  g_assert_cmpuint(drawn->left_out, <, 3);
  g_assert_cmpint(drawn->right, <, 190);
  g_assert_cmpint(drawn->bottom, <, 90);
  draw(drawn, all, 3, 64, 64, FALSE);
  g_assert_cmpuint(drawn->left_out, ==, 3);
  g_assert_cmpint(drawn->right, ==, -1);
}

#endif

/* Without a picture the reason is told, and the pixels stay. */
static void test_without(void) {
  guint8 pixels[16 * 16 * 4] = {0};
  const guint8 none[sizeof pixels] = {0};
  g_autoptr(GError) error = NULL;
  g_assert_false(spore_svg_draw_over("<svg xmlns='http://www.w3.org/2000/svg'><broken", pixels, 16, 16, 64, &error));
  g_assert_nonnull(error);
  g_assert_cmpmem(pixels, sizeof pixels, none, sizeof none);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/legend/rows", test_rows);
  g_test_add_func("/legend/without", test_without);
#ifdef SPORE_HAVE_PIXBUF
  g_test_add_func("/legend/picture", test_picture);
  g_test_add_func("/legend/room", test_room);
#endif
  return g_test_run();
}
