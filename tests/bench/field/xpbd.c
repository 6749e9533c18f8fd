/* XPBD: each constraint C with energy C^2 / 2 a is met in turn by moving its nodes along its gradient. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/field/method.h"

typedef struct SpringBatch {
  uint32_t a[LANES], b[LANES];
  Lanes rest, compliance, damping; /* 1/k; c/k */
  Lanes multiplier;
} SpringBatch;

typedef struct SolidBatch {
  uint32_t corner[4][LANES];
  Lanes3 gradient[3];
  Lanes compliance[2], multiplier[2]; /* of the shape, of the volume */
} SolidBatch;

typedef struct Xpbd {
  Options options;
  SpringBatch *springs;
  SolidBatch *solids;
  size_t spring_batches, solid_batches;
  Lanes *before;
  double *contact; /* multipliers: balls x nodes */
} Xpbd;

static void make_springs(Xpbd *m, const System *s) {
  uint32_t *corner = clear_memory(2 * s->spring_count, sizeof *corner), *order;
  for (size_t i = 0; i < s->spring_count; i++) corner[2 * i] = s->springs[i].a, corner[2 * i + 1] = s->springs[i].b;
  size_t count = colour(corner, 2, s->spring_count, s->node_count, &order);
  if (m->options.in_order) {
    count = LANES * s->spring_count;
    order = realloc(order, count * sizeof *order);
    for (size_t i = 0; i < count; i++) order[i] = i % LANES ? UINT32_MAX : (uint32_t)(i / LANES);
  }
  m->spring_batches = count / LANES;
  m->springs = clear_memory(m->spring_batches, sizeof *m->springs);
  for (size_t i = 0; i < count; i++) {
    SpringBatch *batch = m->springs + i / LANES;
    size_t e = i % LANES;
    batch->a[e] = batch->b[e] = (uint32_t)s->node_count;
    batch->compliance[e] = 1;
    if (order[i] == UINT32_MAX) continue;
    const Spring *spring = s->springs + order[i];
    batch->a[e] = spring->a, batch->b[e] = spring->b;
    batch->rest[e] = spring->rest, batch->compliance[e] = 1 / spring->stiffness;
    batch->damping[e] = spring->damping / spring->stiffness;
  }
  free(corner), free(order);
}

static void make_solids(Xpbd *m, const System *s) {
  uint32_t *corner = clear_memory(4 * s->tetrahedron_count, sizeof *corner), *order;
  for (size_t i = 0; i < s->tetrahedron_count; i++)
    memcpy(corner + 4 * i, s->tetrahedra[i].corner, sizeof s->tetrahedra[i].corner);
  size_t count = colour(corner, 4, s->tetrahedron_count, s->node_count, &order);
  m->solid_batches = count / LANES;
  m->solids = clear_memory(m->solid_batches, sizeof *m->solids);
  for (size_t i = 0; i < count; i++) {
    SolidBatch *batch = m->solids + i / LANES;
    size_t e = i % LANES;
    for (int c = 0; c < 4; c++) batch->corner[c][e] = (uint32_t)s->node_count;
    batch->compliance[0][e] = batch->compliance[1][e] = 1;
    if (order[i] == UINT32_MAX) continue;
    const Tetrahedron *t = s->tetrahedra + order[i];
    for (int c = 0; c < 4; c++) batch->corner[c][e] = t->corner[c];
    for (int k = 0; k < 3; k++)
      batch->gradient[k].x[e] = t->gradient[k][0], batch->gradient[k].y[e] = t->gradient[k][1],
      batch->gradient[k].z[e] = t->gradient[k][2];
    batch->compliance[0][e] = 1 / (s->m * t->volume), batch->compliance[1][e] = 1 / (s->l * t->volume);
  }
  free(corner), free(order);
}

static void *create(const System *s, const Options *options) {
  Xpbd *m = clear_memory(1, sizeof *m);
  m->options = *options;
  make_springs(m, s);
  make_solids(m, s);
  m->before = clear_memory(s->node_count + 1, sizeof *m->before);
  m->contact = clear_memory(s->ball_count * s->node_count, sizeof *m->contact);
  return m;
}

static void destroy(void *data) {
  Xpbd *m = data;
  free(m->springs), free(m->solids), free(m->before), free(m->contact), free(m);
}

/* Adds step times each node's weight. */
static void move(Lanes *x, const uint32_t index[4], Lanes weight, Lanes3 step) {
  lanes_add(x, index, lanes3_scale(weight, step));
}

static void solve_springs(const Xpbd *m, const System *s) {
  double h = m->options.step_s;
  Lanes *x = s->x;
  for (SpringBatch *batch = m->springs; batch < m->springs + m->spring_batches; batch++) {
    Lanes wa, wb, compliance = batch->compliance / (h * h);
    Lanes3 a = lanes_load(x, batch->a, &wa), b = lanes_load(x, batch->b, &wb), d = lanes3_minus(a, b);
    Lanes length = lanes_sqrt(lanes3_dot(d, d) + 1e-300), weights = wa + wb;
    Lanes3 n = lanes3_scale(1 / length, d);
    Lanes residual = batch->rest - length - compliance * batch->multiplier;
    if (s->damped) {
      Lanes3 old = lanes3_minus(lanes_load(m->before, batch->a, NULL), lanes_load(m->before, batch->b, NULL));
      Lanes gamma = batch->damping / h;
      residual -= gamma * lanes3_dot(n, lanes3_minus(d, old));
      weights *= 1 + gamma;
    }
    Lanes change = residual / (weights + compliance);
    batch->multiplier += change;
    Lanes3 step = lanes3_scale(change, n);
    move(x, batch->a, wa, step);
    move(x, batch->b, -wb, step);
  }
}

/* Both constraints of an element at once: sqrt(I - log(I + 1)), whose energy is that of the shape, and J - alpha. At
 * rest neither is zero; solved one after the other they would push against each other. */
static void solve_solids(const Xpbd *m, const System *s) {
  double h = m->options.step_s;
  Lanes *x = s->x;
  for (SolidBatch *batch = m->solids; batch < m->solids + m->solid_batches; batch++) {
    Lanes w[4];
    Lanes3 d[3], origin = lanes_load(x, batch->corner[0], w), shape[4], volume[4];
    for (int k = 0; k < 3; k++) d[k] = lanes3_minus(lanes_load(x, batch->corner[k + 1], w + k + 1), origin);
    Lanes33 f = lanes33_of(d, batch->gradient), c = lanes33_cofactor(&f);
    Lanes square = lanes33_square(&f), value = lanes_sqrt(square - lanes_log(square + 1) + 1e-300);
    Lanes slope = (1 - 1 / (square + 1)) / value;
    shape[0] = volume[0] = (Lanes3){lanes(0), lanes(0), lanes(0)};
    for (int k = 0; k < 3; k++) {
      shape[k + 1] = lanes3_scale(slope, lanes33_times(&f, batch->gradient[k]));
      volume[k + 1] = lanes33_times(&c, batch->gradient[k]);
      shape[0] = lanes3_minus(shape[0], shape[k + 1]), volume[0] = lanes3_minus(volume[0], volume[k + 1]);
    }
    Lanes both = lanes(0), of_shape = batch->compliance[0] / (h * h), of_volume = batch->compliance[1] / (h * h);
    Lanes r0 = -value - of_shape * batch->multiplier[0];
    Lanes r1 = s->alpha - lanes3_dot(f.c[0], c.c[0]) - of_volume * batch->multiplier[1];
    for (int k = 0; k < 4; k++) {
      of_shape += w[k] * lanes3_dot(shape[k], shape[k]);
      of_volume += w[k] * lanes3_dot(volume[k], volume[k]);
      both += w[k] * lanes3_dot(shape[k], volume[k]);
    }
    Lanes scale = 1 / (of_shape * of_volume - both * both);
    Lanes l0 = (r0 * of_volume - r1 * both) * scale, l1 = (r1 * of_shape - r0 * both) * scale;
    batch->multiplier[0] += l0, batch->multiplier[1] += l1;
    for (int k = 0; k < 4; k++)
      move(x, batch->corner[k], w[k], lanes3_plus(lanes3_scale(l0, shape[k]), lanes3_scale(l1, volume[k])));
  }
}

/* A contact pushes only: its multiplier is never negative. */
static void solve_contacts(const Xpbd *m, const System *s) {
  double h = m->options.step_s, compliance = 1 / (s->contact_stiffness * h * h);
  for (size_t b = 0; b < s->ball_count; b++)
    for (size_t i = 0; i < s->node_count; i++) {
      const double *ball = s->balls[b];
      double d[3], square = 0, *multiplier = m->contact + b * s->node_count + i;
      for (int e = 0; e < 3; e++) d[e] = s->x[i][e] - ball[e], square += d[e] * d[e];
      if (square >= ball[3] * ball[3] && *multiplier == 0) continue;
      double distance = sqrt(square), w = s->x[i][3];
      double next = *multiplier + (ball[3] - distance - compliance * *multiplier) / (w + compliance);
      if (next < 0) next = 0;
      s->x[i] += w * (next - *multiplier) / distance * (Lanes){d[0], d[1], d[2], 0};
      *multiplier = next;
    }
}

static void step(void *data, System *s) {
  Xpbd *m = data;
  double h = m->options.step_s;
  for (size_t i = 0; i < s->node_count; i++) {
    m->before[i] = s->x[i];
    s->x[i] += h * s->v[i] + h * h * s->acceleration[i];
  }
  for (size_t i = 0; i < m->spring_batches; i++) m->springs[i].multiplier = lanes(0);
  for (size_t i = 0; i < m->solid_batches; i++) m->solids[i].multiplier[0] = m->solids[i].multiplier[1] = lanes(0);
  if (s->ball_count) memset(m->contact, 0, s->ball_count * s->node_count * sizeof *m->contact);
  for (unsigned sweep = 0; sweep < m->options.iterations; sweep++) {
    solve_springs(m, s);
    solve_solids(m, s);
    solve_contacts(m, s);
  }
  for (size_t i = 0; i < s->node_count; i++) s->v[i] = 1 / h * (s->x[i] - m->before[i]);
}

const Method xpbd = {"xpbd", create, step, destroy};
