/* A bowel that hangs by its mesentery from a root: where the mesentery begins, what it holds, and when it is slack. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/mesentery.h"
#include "tests/stability/rig.h"
#include "tests/stability/statics.h"

#define LENGTH 0.3
#define RADIUS 0.012
#define WALL 0.002
#define DENSITY 1060.0
#define CONTENT 300.0
#define HELD 0.05 /* m: length of the mesentery */

static void set_line(SporeCurve *curve, double from, double to, double y) {
  const double points[8] = {from, y, 0, RADIUS, to, y, 0, RADIUS};
  g_assert_true(spore_curve_allocate(curve, 2, NULL));
  memcpy(curve->points, points, sizeof points);
}

/* A straight bowel along x, below a root as long as itself. */
static SporeModel *hanging(double stiffness, gboolean turned) {
  SporeCurve curve, root;
  set_line(&curve, 0, LENGTH, 0);
  set_line(&root, turned ? LENGTH : 0, turned ? 0 : LENGTH, HELD);
  void *fields = rig_fields(&spore_intestine, "wall_thickness", WALL, "density", DENSITY, "content_density", CONTENT,
                            "mesentery_stiffness", stiffness, NULL);
  SporeModel *model = spore_intestine.create(&(SporeGeometry){.curve = &curve, .root = &root}, fields, NULL);
  g_assert_nonnull(model);
  spore_free(fields);
  spore_curve_clear(&curve);
  spore_curve_clear(&root);
  return model;
}

static double weight_per_length(void) {
  double inner = RADIUS - WALL;
  return 9.81 * G_PI * (DENSITY * (RADIUS * RADIUS - inner * inner) + CONTENT * inner * inner);
}

/* It sags by its weight per length over the mesentery's stiffness, everywhere the same, in either order of the root. */
static void hangs(void) {
  for (int turned = 0; turned <= 1; turned++) {
    double stiffness = 300, expected = weight_per_length() / stiffness, error = 0;
    Statics statics = statics_new(hanging(stiffness, turned));
    size_t root = statics.model->node_count - 1;
    statics.held[root] = statics.held[root + 1] = TRUE;
    for (size_t i = 0; i < root; i++) {
      statics.q[3 * i + 1] -= 1e-3; /* taut: the search for a balance begins where there is something to hold */
      statics.load[3 * i + 1] = -9.81 * statics.model->block_mass[i];
    }
    double left = statics_balance(&statics);
    for (size_t i = 0; i < root; i++) error = fmax(error, fabs(-statics.q[3 * i + 1] / expected - 1));
    g_test_message("sag %.9f m of %.9f m, worst %+.1e; force left %.0e", -statics.q[1], expected, error, left);
    g_assert_cmpfloat(left, <, 1e-9);
    g_assert_cmpfloat(error, <, 1e-8);
    statics_free(&statics);
  }
}

/* Nearer to the root than at rest it is free: no force, no energy. */
static void folds(void) {
  SporeModel *model = hanging(300, FALSE);
  const SporeVec3 none = {0, 0, 0};
  double *q = g_new0(double, model->q_count), *v = g_new0(double, 3 * model->block_count);
  double *f = g_new0(double, 3 * model->block_count), worst = 0, pull = 0;
  model->type->place(model, spore_pose_identity(), none, none, q, v);
  for (size_t i = 0; i + 1 < model->node_count; i++) q[3 * i + 1] += 0.02;
  model->type->force(model, q, q, v, f);
  for (size_t i = 0; i < 3 * model->block_count; i++) worst = fmax(worst, fabs(f[i]));
  g_assert_cmpfloat(worst, <, 1e-12);
  g_assert_cmpfloat(model->type->potential(model, q), <, 1e-15);
  for (size_t i = 0; i + 1 < model->node_count; i++) q[3 * i + 1] -= 0.03;
  memset(f, 0, 3 * model->block_count * sizeof *f);
  model->type->force(model, q, q, v, f);
  for (size_t i = 0; i + 1 < model->node_count; i++) pull += f[3 * i + 1];
  g_test_message("slack: %.1e N; 1 cm too long: %.6f N of %.6f N", worst, pull, 300 * 0.01 * LENGTH);
  g_assert_cmpfloat(fabs(pull / (300 * 0.01 * LENGTH) - 1), <, 1e-9);
  g_free(q);
  g_free(v);
  g_free(f);
  model->type->destroy(model);
}

/* Loops of a bowel that go to and fro below a root: the nearest places alone would cross each other. */
static void keeps_order(void) {
  enum { POINTS = 200 };
  double points[3 * POINTS], weight[POINTS], feet[3 * POINTS], sum = 0, even = 0;
  size_t crossing = 0;
  for (int i = 0; i < POINTS; i++) {
    double s = (double)i / (POINTS - 1);
    points[3 * i] = LENGTH * (s + 0.15 * sin(40 * s));
    points[3 * i + 1] = 0.03 * cos(40 * s);
    points[3 * i + 2] = 0.01;
    weight[i] = 1;
    crossing += i > 0 && points[3 * i] < points[3 * i - 3];
  }
  g_assert_cmpuint(crossing, >, POINTS / 4);
  SporeCurve root;
  set_line(&root, 0, LENGTH, 0.05);
  g_assert_true(spore_mesentery_spread(&root, points, weight, POINTS, feet));
  for (int i = 0; i < POINTS; i++) {
    SporeVec3 p = spore_vec3_load(points + 3 * i), foot = spore_vec3_load(feet + 3 * i);
    if (i > 0) g_assert_cmpfloat(foot.x, >=, feet[3 * i - 3]);
    g_assert_cmpfloat(foot.y, ==, 0.05);
    sum += pow(spore_vec3_distance(p, foot), 2);
    even += pow(spore_vec3_distance(p, spore_vec3(LENGTH * i / (POINTS - 1), 0.05, 0)), 2);
  }
  g_test_message("sum of squares %.4f m^2, spread evenly %.4f m^2; %zu points go back", sum, even, crossing);
  g_assert_cmpfloat(sum, <, even);
  spore_curve_clear(&root);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesentery/hangs", hangs);
  g_test_add_func("/mesentery/folds", folds);
  g_test_add_func("/mesentery/keeps-order", keeps_order);
  return g_test_run();
}
