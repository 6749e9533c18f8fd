/* Plots: points lie where their numbers say, labels are escaped, what cannot be shown is left out. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/plot.h"

/* The centres of all points, in the order of the document. */
static GArray *centres(const char *svg) {
  GArray *found = g_array_new(FALSE, FALSE, sizeof(double));
  for (const char *at = strstr(svg, " cx=\""); at; at = strstr(at + 1, " cx=\"")) {
    double x = g_ascii_strtod(at + 5, NULL), y = g_ascii_strtod(strstr(at, "cy=\"") + 4, NULL);
    g_array_append_val(found, x);
    g_array_append_val(found, y);
  }
  return found;
}

/* A power law is straight where both axes are logarithmic: equal ratios, equal steps. The last centre is the legend's.
 */
static void test_logarithmic(void) {
  const double x[] = {10, 100, 1000}, y[] = {8, 4, 2};
  SporePlotLine line = {"a < b & c", 3, x, y, false};
  SporePlotPanel panel = {"x", "y", true, true, &line, 1, "here", 100};
  char *svg = spore_plot_svg("title", "one\ntwo", &panel, 1, NULL);
  g_assert_nonnull(svg);
  g_autoptr(GArray) c = centres(svg);
  g_assert_cmpuint(c->len, ==, 8);
  const double *p = (const double *)(gconstpointer)c->data;
  g_assert_cmpfloat_with_epsilon(p[2] - p[0], p[4] - p[2], 0.02);
  g_assert_cmpfloat_with_epsilon(p[3] - p[1], p[5] - p[3], 0.02);
  g_assert_cmpfloat(p[3], >, p[1]); /* less is lower, and y grows downward */
  g_assert_nonnull(strstr(svg, "a &lt; b &amp; c"));
  g_assert_nonnull(strstr(svg, ">two</text>"));
  g_autofree char *mark = g_strdup_printf("<line x1=\"%g\"", p[2]);
  g_assert_nonnull(strstr(strstr(svg, mark), "stroke-dasharray"));
  g_assert_nonnull(strstr(svg, ">here<"));
  panel.mark_x = 1e6; /* where no line comes near there is no mark */
  char *without = spore_plot_svg("title", NULL, &panel, 1, NULL);
  g_assert_null(strstr(without, ">here<"));
  spore_free(without);
  spore_free(svg);
}

static void test_left_out(void) {
  const double x[] = {0, 1, 2, 3}, y[] = {1, NAN, -1, 2};
  SporePlotLine line = {"a", 4, x, y, true};
  SporePlotPanel panel = {"x", "y", false, true, &line, 1, NULL, 0};
  char *svg = spore_plot_svg("title", NULL, &panel, 1, NULL);
  g_autoptr(GArray) c = centres(svg);
  g_assert_cmpuint(c->len / 2, ==, 3); /* 2 points and the legend's */
  spore_free(svg);
}

/* Bars stand from low to high, and the axis has room for them. */
static void test_bars(void) {
  const double x[] = {1, 2}, y[] = {10, 20}, low[] = {8, 20}, high[] = {40, 20};
  SporePlotLine line = {"a", 2, x, y, true, .low = low, .high = high};
  SporePlotPanel panel = {"x", "y", false, false, &line, 1, NULL, 0};
  char *svg = spore_plot_svg("title", NULL, &panel, 1, NULL);
  g_autoptr(GArray) c = centres(svg);
  const double *p = (const double *)(gconstpointer)c->data;
  double pixels = (p[1] - p[3]) / 10; /* of 1 */
  gboolean found = FALSE;
  guint upright = 0;
  for (const char *at = strstr(svg, "<line x1=\""); at; at = strstr(at + 1, "<line x1=\"")) {
    double x1 = g_ascii_strtod(at + 10, NULL), y1 = g_ascii_strtod(strstr(at, "y1=\"") + 4, NULL),
           y2 = g_ascii_strtod(strstr(at, "y2=\"") + 4, NULL);
    gboolean bar = fabs(x1 - p[0]) < 0.02 && strstr(at, "#444444") && strstr(at, "#444444") < strchr(at, '>');
    found |= bar && fabs(y1 - p[1] - 2 * pixels) < 0.1 && fabs(y2 - p[1] + 30 * pixels) < 0.1;
    upright += fabs(x1 - p[2]) < 0.02 && strstr(at, "#444444") && strstr(at, "#444444") < strchr(at, '>');
    if (bar) g_assert_cmpfloat(y2, >, 70); /* below the title */
  }
  g_assert_true(found);
  g_assert_cmpuint(upright, ==, 0); /* nothing spreads there */
  spore_free(svg);
}

static void test_nothing(void) {
  const double x[] = {1}, y[] = {NAN};
  SporePlotLine line = {"a", 1, x, y, true};
  SporePlotPanel panel = {"x", "y", false, false, &line, 1, NULL, 0};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_plot_svg("title", NULL, &panel, 1, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
}

/* Lines differ without colour: by the shape of their points and their dashes. */
static void test_black_and_white(void) {
  const double x[] = {1, 10}, y[] = {5, 50};
  const SporePlotLine lines[] = {{"a", 2, x, y, false}, {"b", 2, x, y, false}, {"c", 2, x, y, false}};
  SporePlotPanel panel = {"x", "y", true, true, lines, 3, NULL, 0};
  char *svg = spore_plot_svg("title", NULL, &panel, 1, NULL);
  const char *first = strstr(svg, "<polyline"), *second = strstr(first + 1, "<polyline"),
             *third = strstr(second + 1, "<polyline");
  g_autofree char *dash = g_strndup(strstr(second, "stroke-dasharray"), 22),
                  *other = g_strndup(strstr(third, "stroke-dasharray"), 22);
  g_assert_true(strstr(first, "stroke-dasharray") > second);
  g_assert_cmpstr(dash, !=, other);
  g_autofree char *shape = g_strndup(strstr(second, "<path d="), 16), *next = g_strndup(strstr(third, "<path d="), 16);
  g_assert_cmpstr(shape, !=, next);
  spore_free(svg);
}

/* Empty and ringed points, the band, and labels at the ends of lines, none on another one. */
static void test_marks(void) {
  const double x[] = {1, 10}, y[] = {0.5, 50};
  const bool hollow[] = {false, true}, ringed[] = {true, false};
  const SporePlotLine lines[] = {{"first", 2, x, y, false, hollow, ringed}, {"second", 2, x, y, false}};
  SporePlotPanel panel = {.x_label = "x",
                          .y_label = "y",
                          .log_x = true,
                          .log_y = true,
                          .lines = lines,
                          .line_count = 2,
                          .shade_below = 5,
                          .shade_label = "dim",
                          .label_lines = true};
  char *svg = spore_plot_svg("title", NULL, &panel, 1, NULL);
  g_autoptr(GArray) c = centres(svg);
  const double *p = (const double *)(gconstpointer)c->data;
  const char *band = strstr(svg, "<rect fill=\"#e8e8e8\"");
  double top = g_ascii_strtod(strstr(band, " y=\"") + 4, NULL);
  g_assert_cmpfloat_with_epsilon(top, 0.5 * (p[1] + p[3]), 0.02); /* 5 is half way from 0.5 to 50 */
  g_assert_nonnull(strstr(band, ">dim</text>"));
  g_assert_nonnull(strstr(svg, "fill=\"white\" stroke"));
  const char *ring = strstr(svg, "<ellipse");
  g_assert_nonnull(ring);
  g_assert_null(strstr(ring + 1, "<ellipse"));
  const char *first = strstr(svg, "font-size=\"11\">first"), *second = strstr(svg, "font-size=\"11\">second");
  g_assert_true(first && second);
  while (strncmp(first, " y=", 3) != 0) first--;
  while (strncmp(second, " y=", 3) != 0) second--;
  g_assert_cmpfloat(fabs(g_ascii_strtod(first + 4, NULL) - g_ascii_strtod(second + 4, NULL)), >=, 12);
  spore_free(svg);
}

/* Each allocation fails in turn. */
static void test_memory(void) {
  const double x[] = {1, 2}, y[] = {1, 2};
  SporePlotLine line = {"a", 2, x, y, false};
  SporePlotPanel panel = {"x", "y", false, false, &line, 1, NULL, 0};
  char *svg = NULL;
  for (uint64_t n = 1; !svg; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    svg = spore_plot_svg("title", NULL, &panel, 1, &error);
    spore_allocation_fail_at(0);
    g_assert_cmpint(error.code, ==, svg ? SPORE_ERROR_NONE : SPORE_ERROR_MEMORY);
  }
  spore_free(svg);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/measure/plot/logarithmic", test_logarithmic);
  g_test_add_func("/measure/plot/left-out", test_left_out);
  g_test_add_func("/measure/plot/bars", test_bars);
  g_test_add_func("/measure/plot/nothing", test_nothing);
  g_test_add_func("/measure/plot/black_and_white", test_black_and_white);
  g_test_add_func("/measure/plot/marks", test_marks);
  g_test_add_func("/measure/plot/memory", test_memory);
  return g_test_run();
}
