/* Projective dynamics. A local solution turns each spring and each element to where its shape at rest would lie; the
 * global one moves all nodes by a matrix that never changes and is factorised once. Both together are x += A^-1 times
 * what is left of the implicit Euler step's balance (Liu et al. 2017), which is how it is written here. Nodes are
 * numbered along the body, so that the factor is kept as a band: a row from its first entry on. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/field/method.h"

typedef struct Projective {
  Options options;
  size_t rows;
  uint32_t *row_of, *node_of; /* UINT32_MAX: held */
  size_t *first, *start;      /* first column of a row, and where that entry is */
  double *matrix, *factor, *inverse_diagonal;
  uint8_t *touched; /* rows, by balls that the factor knows of */
  Lanes *before, *target, *speed, *force, *rhs;
} Projective;

static double *entry(Projective *m, uint32_t a, uint32_t b) {
  uint32_t i = m->row_of[a], j = m->row_of[b];
  if (i == UINT32_MAX || j == UINT32_MAX || j > i) return NULL;
  return m->matrix + m->start[i] + (j - m->first[i]);
}

static void reach(Projective *m, uint32_t a, uint32_t b) {
  uint32_t i = m->row_of[a], j = m->row_of[b];
  if (i != UINT32_MAX && j < m->first[i]) m->first[i] = j;
}

static void add(Projective *m, uint32_t a, uint32_t b, double value) {
  double *to = entry(m, a, b);
  if (to) *to += value;
}

static void find_rows(Projective *m, const System *s) {
  for (size_t i = 0; i < s->node_count; i++) {
    m->row_of[i] = s->x[i][3] > 0 ? (uint32_t)m->rows : UINT32_MAX;
    if (s->x[i][3] > 0) m->first[m->rows] = m->rows, m->node_of[m->rows++] = (uint32_t)i;
  }
  for (size_t i = 0; i < s->spring_count; i++)
    reach(m, s->springs[i].a, s->springs[i].b), reach(m, s->springs[i].b, s->springs[i].a);
  for (size_t i = 0; i < s->tetrahedron_count; i++)
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < 4; b++) reach(m, s->tetrahedra[i].corner[a], s->tetrahedra[i].corner[b]);
  for (size_t i = 0; i < m->rows; i++) m->start[i + 1] = m->start[i] + i - m->first[i] + 1;
}

/* M / h^2 and for each spring (k + c/h) of the difference of its ends, for each element 2 mu V of F. */
static void fill(Projective *m, const System *s) {
  double h = m->options.step_s;
  for (size_t i = 0; i < s->node_count; i++) add(m, (uint32_t)i, (uint32_t)i, s->mass[i] / (h * h));
  for (size_t i = 0; i < s->spring_count; i++) {
    const Spring *spring = s->springs + i;
    double w = spring->stiffness + spring->damping / h;
    add(m, spring->a, spring->a, w), add(m, spring->b, spring->b, w);
    add(m, spring->a, spring->b, -w), add(m, spring->b, spring->a, -w);
  }
  for (size_t i = 0; i < s->tetrahedron_count; i++) {
    const Tetrahedron *t = s->tetrahedra + i;
    double g[4][3];
    memcpy(g[1], t->gradient, sizeof t->gradient);
    for (int k = 0; k < 3; k++) g[0][k] = -(g[1][k] + g[2][k] + g[3][k]);
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < 4; b++)
        add(m, t->corner[a], t->corner[b],
            2 * s->m * t->volume * (g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2]));
  }
}

/* Row by row; a row's entries lie next to each other. */
static void factorise(Projective *m, double contact_stiffness) {
  for (size_t i = 0; i < m->rows; i++) {
    const double *a = m->matrix + m->start[i];
    double *to = m->factor + m->start[i];
    for (size_t j = m->first[i]; j <= i; j++) {
      const double *other = m->factor + m->start[j];
      size_t from = m->first[i] > m->first[j] ? m->first[i] : m->first[j];
      double sum = a[j - m->first[i]] + (i == j ? m->touched[i] * contact_stiffness : 0);
      for (size_t k = from; k < j; k++) sum -= to[k - m->first[i]] * other[k - m->first[j]];
      if (j < i) to[j - m->first[i]] = sum * m->inverse_diagonal[j];
      else m->inverse_diagonal[i] = 1 / sqrt(sum);
    }
  }
}

static void solve(const Projective *m, Lanes *b) {
  for (size_t i = 0; i < m->rows; i++) {
    const double *l = m->factor + m->start[i];
    const Lanes *from = b + m->first[i];
    size_t count = i - m->first[i], k = 0;
    Lanes sum[4] = {b[i]};
    for (; k + 4 <= count; k += 4)
      for (int e = 0; e < 4; e++) sum[e] -= l[k + e] * from[k + e];
    for (; k < count; k++) sum[0] -= l[k] * from[k];
    b[i] = m->inverse_diagonal[i] * (sum[0] + sum[1] + sum[2] + sum[3]);
  }
  for (size_t i = m->rows; i-- > 0;) {
    const double *l = m->factor + m->start[i];
    Lanes *to = b + m->first[i], x = b[i] = m->inverse_diagonal[i] * b[i];
    for (size_t k = 0; k < i - m->first[i]; k++) to[k] -= l[k] * x;
  }
}

static void *create(const System *s, const Options *options) {
  Projective *m = clear_memory(1, sizeof *m);
  m->options = *options;
  m->row_of = clear_memory(s->node_count, sizeof *m->row_of);
  m->node_of = clear_memory(s->node_count, sizeof *m->node_of);
  m->first = clear_memory(s->node_count, sizeof *m->first);
  m->start = clear_memory(s->node_count + 1, sizeof *m->start);
  m->inverse_diagonal = clear_memory(s->node_count, sizeof *m->inverse_diagonal);
  m->touched = clear_memory(s->node_count, 1);
  find_rows(m, s);
  m->matrix = clear_memory(m->start[m->rows], sizeof *m->matrix);
  m->factor = clear_memory(m->start[m->rows], sizeof *m->factor);
  fill(m, s);
  factorise(m, 0);
  Lanes **arrays[] = {&m->before, &m->target, &m->speed, &m->force, &m->rhs};
  for (int i = 0; i < 5; i++) *arrays[i] = clear_memory(s->node_count + 1, sizeof(Lanes));
  return m;
}

static void destroy(void *data) {
  Projective *m = data;
  free(m->row_of), free(m->node_of), free(m->first), free(m->start), free(m->matrix), free(m->factor);
  free(m->inverse_diagonal), free(m->touched), free(m->before), free(m->target), free(m->speed), free(m->force);
  free(m->rhs), free(m);
}

/* Contacts are constraints that come and go: the factor is made again when others are touched than before. */
static void find_contacts(Projective *m, const System *s) {
  bool changed = false;
  for (size_t i = 0; i < m->rows; i++) {
    Lanes x = s->x[m->node_of[i]];
    uint8_t touched = 0;
    for (size_t b = 0; b < s->ball_count; b++) {
      const double *ball = s->balls[b];
      double d[3] = {x[0] - ball[0], x[1] - ball[1], x[2] - ball[2]};
      touched += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < ball[3] * ball[3];
    }
    changed |= touched != m->touched[i];
    m->touched[i] = touched;
  }
  if (changed) factorise(m, s->contact_stiffness);
}

static void step(void *data, System *s) {
  Projective *m = data;
  double h = m->options.step_s;
  for (size_t i = 0; i < s->node_count; i++) {
    m->before[i] = s->x[i];
    m->target[i] = s->x[i] += h * s->v[i] + h * h * s->acceleration[i];
  }
  if (s->ball_count) find_contacts(m, s);
  for (unsigned iteration = 0; iteration < m->options.iterations; iteration++) {
    for (size_t i = 0; i < s->node_count; i++) {
      m->force[i] = s->mass[i] / (h * h) * (m->target[i] - s->x[i]);
      m->speed[i] = (s->x[i] - m->before[i]) / h;
    }
    system_force(s, s->x, m->speed, m->force);
    for (size_t i = 0; i < m->rows; i++) m->rhs[i] = m->force[m->node_of[i]];
    solve(m, m->rhs);
    for (size_t i = 0; i < m->rows; i++) s->x[m->node_of[i]] += m->rhs[i];
  }
  for (size_t i = 0; i < s->node_count; i++) s->v[i] = (s->x[i] - m->before[i]) / h;
}

const Method projective_dynamics = {"pd", create, step, destroy};
