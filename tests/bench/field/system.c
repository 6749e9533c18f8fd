/* Making the system, its forces and its energy. */
#include "tests/bench/field/system.h"

#include <stdlib.h>
#include <string.h>

#include "tests/bench/peers/case.h"

void *clear_memory(size_t count, size_t size) {
  size_t bytes = (count * size + 63) / 64 * 64 + 64;
  void *memory = aligned_alloc(64, bytes);
  if (!memory) abort();
  return memset(memory, 0, bytes);
}

System *system_new(size_t nodes, size_t springs, size_t tetrahedra) {
  System *s = clear_memory(1, sizeof *s);
  s->node_count = nodes, s->spring_count = springs, s->tetrahedron_count = tetrahedra;
  s->x = clear_memory(nodes + 1, sizeof *s->x);
  s->v = clear_memory(nodes + 1, sizeof *s->v);
  s->acceleration = clear_memory(nodes + 1, sizeof *s->acceleration);
  s->mass = clear_memory(nodes, sizeof *s->mass);
  s->springs = clear_memory(springs, sizeof *s->springs);
  s->tetrahedra = clear_memory(tetrahedra, sizeof *s->tetrahedra);
  return s;
}

void system_free(System *s) {
  free(s->x), free(s->v), free(s->acceleration), free(s->mass), free(s->springs), free(s->tetrahedra), free(s->balls);
  free(s);
}

static void rest_tetrahedron(System *s, Tetrahedron *t, double density) {
  double d[3][3], *g = t->gradient[0];
  for (int k = 0; k < 3; k++)
    for (int e = 0; e < 3; e++) d[k][e] = s->x[t->corner[k + 1]][e] - s->x[t->corner[0]][e];
  for (int k = 0; k < 3; k++)
    for (int e = 0; e < 3; e++) {
      const double *a = d[(k + 1) % 3], *b = d[(k + 2) % 3];
      g[3 * k + e] = a[(e + 1) % 3] * b[(e + 2) % 3] - a[(e + 2) % 3] * b[(e + 1) % 3];
    }
  double six = d[0][0] * g[0] + d[0][1] * g[1] + d[0][2] * g[2];
  for (int i = 0; i < 9; i++) g[i] /= six;
  t->volume = fabs(six) / 6;
  for (int c = 0; c < 4; c++) s->mass[t->corner[c]] += density * t->volume / 4;
}

void system_rest(System *s, double density) {
  for (size_t i = 0; i < s->spring_count; i++) {
    Spring *spring = s->springs + i;
    Lanes d = s->x[spring->a] - s->x[spring->b];
    spring->rest = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    s->damped |= spring->damping > 0;
  }
  for (size_t i = 0; i < s->tetrahedron_count; i++) rest_tetrahedron(s, s->tetrahedra + i, density);
}

void system_hold(System *s, uint32_t node) { s->mass[node] = 0; }

void system_law(System *s, Law law, double young_modulus, double poisson_ratio) {
  double mu = young_modulus / (2 * (1 + poisson_ratio));
  double lambda = young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  s->law = law, s->m = mu;
  if (law == COROTATIONAL) return;
  s->m = 4 * mu / 3, s->l = lambda + 5 * mu / 6, s->alpha = 1 + 0.75 * s->m / s->l;
}

void system_finish(System *s) {
  s->x[s->node_count] = (Lanes){1e3, 1e3, 1e3, 0}; /* away from all that could touch it */
  for (size_t i = 0; i < s->node_count; i++) {
    bool free_node = s->mass[i] > 0;
    s->x[i][3] = free_node ? 1 / s->mass[i] : 0;
    s->acceleration[i] = (Lanes){0, free_node ? -CASE_GRAVITY : 0, 0, 0};
  }
}

/* The rotation of a polar decomposition, by Newton's iteration on the matrix (Higham 1986). */
static Lanes33 rotation(Lanes33 r) {
  for (int round = 0; round < 20; round++) {
    Lanes33 c = lanes33_cofactor(&r);
    Lanes half = 0.5 / lanes3_dot(r.c[0], c.c[0]), change = lanes(0);
    for (int k = 0; k < 3; k++) {
      Lanes3 next = lanes3_plus(lanes3_scale(lanes(0.5), r.c[k]), lanes3_scale(half, c.c[k]));
      Lanes3 d = lanes3_minus(next, r.c[k]);
      change += lanes3_dot(d, d);
      r.c[k] = next;
    }
    /* The next change would be about the square of this one. */
    if (change[0] < 1e-14 && change[1] < 1e-14 && change[2] < 1e-14 && change[3] < 1e-14) break;
  }
  return r;
}

Lanes33 law_stress(const System *s, const Lanes33 *f) {
  Lanes33 p;
  if (s->law == COROTATIONAL) {
    Lanes33 r = rotation(*f);
    for (int k = 0; k < 3; k++) p.c[k] = lanes3_scale(lanes(2 * s->m), lanes3_minus(f->c[k], r.c[k]));
    return p;
  }
  Lanes33 c = lanes33_cofactor(f);
  Lanes of_f = s->m - s->m / (lanes33_square(f) + 1);
  Lanes pressure = s->l * (lanes3_dot(f->c[0], c.c[0]) - s->alpha);
  for (int k = 0; k < 3; k++) p.c[k] = lanes3_plus(lanes3_scale(of_f, f->c[k]), lanes3_scale(pressure, c.c[k]));
  return p;
}

static void add_springs(const System *s, const Lanes *x, const Lanes *v, Lanes *f) {
  for (size_t i = 0; i < s->spring_count; i += LANES) {
    uint32_t a[4], b[4], pad = (uint32_t)s->node_count;
    Lanes rest = lanes(0), k = lanes(0), c = lanes(0);
    for (uint32_t e = 0; e < LANES; e++) {
      const Spring *spring = s->springs + i + e;
      bool real = i + e < s->spring_count;
      a[e] = real ? spring->a : pad, b[e] = real ? spring->b : pad;
      if (real) rest[e] = spring->rest, k[e] = spring->stiffness, c[e] = spring->damping;
    }
    Lanes3 d = lanes3_minus(lanes_load(x, a, NULL), lanes_load(x, b, NULL));
    Lanes length = lanes_sqrt(lanes3_dot(d, d) + 1e-300);
    Lanes3 n = lanes3_scale(1 / length, d);
    Lanes tension = k * (length - rest);
    if (s->damped) tension += c * lanes3_dot(n, lanes3_minus(lanes_load(v, a, NULL), lanes_load(v, b, NULL)));
    Lanes3 force = lanes3_scale(tension, n);
    lanes_add(f, b, force);
    lanes_add(f, a, lanes3_scale(lanes(-1), force));
  }
}

static void add_tetrahedra(const System *s, const Lanes *x, Lanes *f) {
  for (size_t i = 0; i < s->tetrahedron_count; i += LANES) {
    uint32_t corner[4][4];
    double gradient[9][4] = {{0}};
    Lanes volume = lanes(0);
    for (uint32_t e = 0; e < LANES; e++) {
      bool real = i + e < s->tetrahedron_count;
      const Tetrahedron *t = s->tetrahedra + (real ? i + e : i);
      for (int c = 0; c < 4; c++) corner[c][e] = t->corner[c];
      for (int k = 0; k < 9; k++) gradient[k][e] = t->gradient[k / 3][k % 3];
      if (real) volume[e] = t->volume;
    }
    Lanes3 b[3], d[3], origin = lanes_load(x, corner[0], NULL), sum = {lanes(0), lanes(0), lanes(0)};
    memcpy(b, gradient, sizeof b);
    for (int k = 0; k < 3; k++) d[k] = lanes3_minus(lanes_load(x, corner[k + 1], NULL), origin);
    Lanes33 deformation = lanes33_of(d, b), p = law_stress(s, &deformation);
    for (int k = 0; k < 3; k++) {
      Lanes3 force = lanes3_scale(-volume, lanes33_times(&p, b[k]));
      lanes_add(f, corner[k + 1], force);
      sum = lanes3_minus(sum, force);
    }
    lanes_add(f, corner[0], sum);
  }
}

/* Depth of a node in a ball, and the way out. */
static double depth(const double ball[4], Lanes x, double out[3]) {
  double square = 0;
  for (int e = 0; e < 3; e++) out[e] = x[e] - ball[e], square += out[e] * out[e];
  if (square >= ball[3] * ball[3]) return 0;
  double distance = sqrt(square);
  for (int e = 0; e < 3; e++) out[e] /= distance;
  return ball[3] - distance;
}

void system_force(const System *s, const Lanes *x, const Lanes *v, Lanes *f) {
  add_springs(s, x, v, f);
  add_tetrahedra(s, x, f);
  for (size_t b = 0; b < s->ball_count; b++)
    for (size_t i = 0; i < s->node_count; i++) {
      double out[3], deep = depth(s->balls[b], x[i], out);
      if (deep > 0) f[i] += s->contact_stiffness * deep * (Lanes){out[0], out[1], out[2], 0};
    }
}

static double tetrahedron_potential(const System *s, const Tetrahedron *t, const Lanes *x) {
  Lanes3 d[3], b[3];
  for (int k = 0; k < 3; k++) {
    Lanes e = x[t->corner[k + 1]] - x[t->corner[0]];
    d[k] = (Lanes3){lanes(e[0]), lanes(e[1]), lanes(e[2])};
    b[k] = (Lanes3){lanes(t->gradient[k][0]), lanes(t->gradient[k][1]), lanes(t->gradient[k][2])};
  }
  Lanes33 f = lanes33_of(d, b), c = lanes33_cofactor(&f), r = rotation(f);
  double square = lanes33_square(&f)[0], j = lanes3_dot(f.c[0], c.c[0])[0];
  if (s->law == NEO_HOOKEAN)
    return t->volume * (0.5 * s->m * (square - log(square + 1)) + 0.5 * s->l * (j - s->alpha) * (j - s->alpha));
  for (int k = 0; k < 3; k++) r.c[k] = lanes3_minus(f.c[k], r.c[k]);
  return t->volume * s->m * lanes33_square(&r)[0];
}

double system_potential(const System *s, const Lanes *x) {
  double sum = 0, out[3];
  for (size_t i = 0; i < s->spring_count; i++) {
    Lanes d = x[s->springs[i].a] - x[s->springs[i].b];
    double stretch = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - s->springs[i].rest;
    sum += 0.5 * s->springs[i].stiffness * stretch * stretch;
  }
  for (size_t i = 0; i < s->tetrahedron_count; i++) sum += tetrahedron_potential(s, s->tetrahedra + i, x);
  for (size_t b = 0; b < s->ball_count; b++)
    for (size_t i = 0; i < s->node_count; i++) {
      double deep = depth(s->balls[b], x[i], out);
      sum += 0.5 * s->contact_stiffness * deep * deep;
    }
  return sum;
}

size_t colour(const uint32_t *corner, size_t corners, size_t count, size_t nodes, uint32_t **order) {
  enum { MOST = 128 };
  uint64_t(*taken)[MOST / 64] = clear_memory(nodes, sizeof *taken);
  uint8_t *of = clear_memory(count, 1);
  size_t number[MOST] = {0}, place[MOST], total = 0;
  for (size_t i = 0; i < count; i++) {
    const uint32_t *c = corner + i * corners;
    unsigned pick = 0;
    for (bool again = true; again;) {
      again = false;
      for (size_t k = 0; k < corners; k++) again |= taken[c[k]][pick / 64] >> pick % 64 & 1;
      if (again && ++pick == MOST) abort();
    }
    for (size_t k = 0; k < corners; k++) taken[c[k]][pick / 64] |= 1ull << pick % 64;
    of[i] = (uint8_t)pick, number[pick]++;
  }
  for (int c = 0; c < MOST; c++) place[c] = total, total += (number[c] + LANES - 1) / LANES * LANES;
  *order = clear_memory(total, sizeof **order);
  memset(*order, 0xff, total * sizeof **order);
  for (size_t i = 0; i < count; i++) (*order)[place[of[i]]++] = (uint32_t)i;
  free(taken), free(of);
  return total;
}
