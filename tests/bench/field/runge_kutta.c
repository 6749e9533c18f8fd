/* The classical Runge-Kutta method, on the forces of system.c. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/field/method.h"

typedef struct RungeKutta {
  Options options;
  Lanes *x[2], *v[2], *f; /* of a stage, and of the step */
} RungeKutta;

static void *create(const System *s, const Options *options) {
  RungeKutta *m = clear_memory(1, sizeof *m);
  m->options = *options;
  m->f = clear_memory(s->node_count + 1, sizeof *m->f);
  for (int i = 0; i < 2; i++) {
    m->x[i] = clear_memory(s->node_count + 1, sizeof(Lanes));
    m->v[i] = clear_memory(s->node_count + 1, sizeof(Lanes));
  }
  return m;
}

static void destroy(void *data) {
  RungeKutta *m = data;
  for (int i = 0; i < 2; i++) free(m->x[i]), free(m->v[i]);
  free(m->f), free(m);
}

/* Acceleration at (x, v), into m->f. */
static void accelerate(const RungeKutta *m, const System *s, const Lanes *x, const Lanes *v) {
  memset(m->f, 0, s->node_count * sizeof *m->f);
  system_force(s, x, v, m->f);
  for (size_t i = 0; i < s->node_count; i++) m->f[i] = s->x[i][3] * m->f[i] + s->acceleration[i];
}

static void step(void *data, System *s) {
  RungeKutta *m = data;
  const double part[4] = {0.5, 0.5, 1, 0}, weight[4] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  double h = m->options.step_s;
  Lanes *x = m->x[0], *v = m->v[0], *sum_x = m->x[1], *sum_v = m->v[1];
  size_t size = (s->node_count + 1) * sizeof(Lanes);
  memcpy(x, s->x, size), memcpy(v, s->v, size), memcpy(sum_x, s->x, size), memcpy(sum_v, s->v, size);
  for (int stage = 0; stage < 4; stage++) {
    accelerate(m, s, x, v);
    for (size_t i = 0; i < s->node_count; i++) {
      sum_x[i] += weight[stage] * h * v[i], sum_v[i] += weight[stage] * h * m->f[i];
      x[i] = s->x[i] + part[stage] * h * v[i];
      v[i] = s->v[i] + part[stage] * h * m->f[i];
    }
  }
  memcpy(s->x, sum_x, size), memcpy(s->v, sum_v, size);
}

const Method runge_kutta = {"rk4", create, step, destroy};
