/* What models of solids cost and how wrong they are: a bar of 1 x 0.2 x 0.2 m held at one end, by its sag under its own
 * weight and by the CPU time of this thread for a step while it swings. One JSON object a line. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "core/base/memory.h"
#include "tests/conformance/specimen.h"
#include "tests/stability/rig.h"

enum { LINEAR, QUADRATIC, GRID };
static const char *const element_names[] = {"linear tetrahedra", "quadratic tetrahedra", "finite differences"};

typedef struct Bar {
  int element;
  unsigned along; /* cells; a fifth of them across */
} Bar;

static SporeModel *bar_model(Bar bar) {
  if (bar.element == GRID) {
    SporeTriangleMesh box;
    shape_box(&box, spore_vec3(0.5, 0.1, 0.1), spore_vec3(1, 0.2, 0.2));
    return rig_surface_model(&spore_finite_differences, &box, "cells", (double)bar.along, "young_modulus", 1e5,
                             "poisson_ratio", 0.3, "density", 1000.0, NULL);
  }
  SporeTetrahedralMesh block;
  shape_block(&block, bar.along, bar.along / 5, bar.along / 5, spore_vec3(1, 0.2, 0.2));
  return rig_solid_model(&spore_neo_hookean_tetrahedra, &block, "young_modulus", 1e5, "poisson_ratio", 0.3, "density",
                         1000.0, "element", (double)bar.element, NULL);
}

static Rig *hang(Bar bar, SporeIntegratorKind kind, double gravity, double h) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -gravity, 0);
  rig->description.solver.time_step = h;
  rig->description.solver.integrator = kind;
  rig->description.solver.tolerance = kind == SPORE_INTEGRATOR_STATIC ? 1e-8 : 1e-6;
  rig_passive(rig, "bar", bar_model(bar), NULL);
  rig_pin(rig, 0, spore_vec3(-1000, 0.1, 0.1), 1000.0001);
  rig_build(rig);
  return rig;
}

/* Mean way down of the face at the tip, m. */
static double sag(Bar bar) {
  Rig *rig = hang(bar, SPORE_INTEGRATOR_STATIC, 0.01, 0.01);
  size_t nodes = spore_world_body_model(rig->world, 0)->node_count, count = 0;
  double *rest = g_memdup2(spore_world_q(rig->world, 0), 3 * nodes * sizeof(double)), sum = 0;
  rig_run(rig->world, 5);
  for (size_t i = 0; i < nodes; i++)
    if (rest[3 * i] > 1 - 1e-9) sum += rest[3 * i + 1] - spore_world_q(rig->world, 0)[3 * i + 1], count++;
  g_free(rest);
  rig_free(rig);
  return sum / (double)count;
}

static double now_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

/* Of a step, us: the least mean of several runs of `steps`. */
static double step_us(Bar bar, SporeIntegratorKind kind, double h, unsigned steps, size_t *nodes) {
  Rig *rig = hang(bar, kind, 1, h);
  double best = HUGE_VAL;
  *nodes = spore_world_body_model(rig->world, 0)->node_count;
  rig_run(rig->world, steps);
  for (int repeat = 0; repeat < 5; repeat++) {
    double start = now_us();
    rig_run(rig->world, steps);
    best = fmin(best, (now_us() - start) / steps);
  }
  rig_free(rig);
  return best;
}

int main(void) {
  static const Bar bars[] = {{LINEAR, 10}, {LINEAR, 20}, {LINEAR, 40}, {QUADRATIC, 10}, {GRID, 10}, {GRID, 20}};
  double reference = sag((Bar){QUADRATIC, 20});
  for (size_t i = 0; i < G_N_ELEMENTS(bars); i++) {
    size_t nodes;
    double explicit_us = step_us(bars[i], SPORE_INTEGRATOR_SYMPLECTIC_EULER, 2e-5, 200, &nodes);
    double implicit_us = step_us(bars[i], SPORE_INTEGRATOR_IMPLICIT_EULER, 5e-3, 20, &nodes);
    printf("{\"model\": \"%s\", \"along\": %u, \"across\": %u, \"nodes\": %zu, \"error\": %.4f, \"explicit_us\": %.2f, "
           "\"implicit_us\": %.1f}\n",
           element_names[bars[i].element], bars[i].along, bars[i].along / 5, nodes, sag(bars[i]) / reference - 1,
           explicit_us, implicit_us);
    fflush(stdout);
  }
  return 0;
}
