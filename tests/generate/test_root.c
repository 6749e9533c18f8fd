/* Roots of mesenteries that are proposed for a bowel, and what is measured of the mesentery between. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/generate/centreline/centreline.h"
#include "core/math/vec3.h"

#define THICK 0.01 /* m */

/* A helix of that radius along x. */
static SporeCurve helix(double radius, double length, double turns) {
  enum { POINTS = 2000 };
  SporeCurve line;
  g_assert_true(spore_curve_allocate(&line, POINTS + 1, NULL));
  for (size_t i = 0; i <= POINTS; i++) {
    double part = (double)i / POINTS, angle = 2 * G_PI * turns * part;
    spore_vec3_store(line.points + 4 * i, spore_vec3(length * part, radius * cos(angle), radius * sin(angle)));
    line.points[4 * i + 3] = THICK;
  }
  return line;
}

/* The middle of a helix of many turns is its axis; the mesentery is as long as the helix is wide. Only at its ends the
 * root follows it a little: of a polynomial of degree d, by about (d + 1)^2 / (2 pi turns) of its radius. */
static void test_helix(void) {
  SporeCurve line = helix(0.05, 0.4, 40), root;
  SporeCentrelineRoot figures;
  for (size_t degree = 1; degree <= SPORE_CENTRELINE_ROOT_DEGREE; degree++) {
    double farthest = 0;
    g_assert_true(spore_centreline_root(&line, degree, &root, NULL));
    for (size_t i = 0; i < root.count; i++)
      farthest = fmax(farthest, hypot(root.points[4 * i + 1], root.points[4 * i + 2]));
    g_assert_true(spore_centreline_root_measure(&line, &root, &figures, NULL));
    g_test_message("degree %zu: %.1f %% off the axis, %.4f m long, mesentery %.4f m (%.4f to %.4f)", degree,
                   100 * farthest / 0.05, figures.length, figures.mean, figures.shortest, figures.longest);
    g_assert_cmpfloat(farthest, <, 2 * pow((double)degree + 1, 2) / (2 * G_PI * 40) * 0.05);
    g_assert_cmpfloat(fabs(figures.length / 0.4 - 1), <, 0.03);
    g_assert_cmpfloat(fabs(figures.mean / 0.05 - 1), <, 0.02);
    g_assert_cmpfloat(fabs(root.points[3] / (0.2 * THICK) - 1), <, 1e-9);
    spore_curve_clear(&root);
  }
  spore_curve_clear(&line);
}

/* A line that is itself such a polynomial is its own root, and the mesentery has no length. */
static void test_of_itself(void) {
  SporeCurve line = helix(0, 0.3, 0), root;
  SporeCentrelineRoot figures;
  for (size_t degree = 1; degree <= SPORE_CENTRELINE_ROOT_DEGREE; degree++) {
    g_assert_true(spore_centreline_root(&line, degree, &root, NULL));
    g_assert_true(spore_centreline_root_measure(&line, &root, &figures, NULL));
    g_assert_cmpfloat(fabs(figures.length / 0.3 - 1), <, 1e-9);
    g_assert_cmpfloat(figures.longest, <, 1e-9);
    spore_curve_clear(&root);
  }
  spore_curve_clear(&line);
}

/* Loops around one place have no middle line; how short the least squares make it is the radius over their number. */
static void test_around_one_place(void) {
  SporeCurve line = helix(0.05, 0, 60), root;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_centreline_root(&line, 1, &root, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_cmpuint(root.count, ==, 0);
  spore_curve_clear(&line);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/root/helix", test_helix);
  g_test_add_func("/root/of-itself", test_of_itself);
  g_test_add_func("/root/around-one-place", test_around_one_place);
  return g_test_run();
}
