/* Vertex block descent: one node after the other goes to where the energy of the implicit Euler step, as a function of
 * that node alone, is least, by one Newton step of three unknowns. Four nodes that share nothing are moved at once. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/field/method.h"

typedef struct Neighbour {
  uint32_t other[LANES];
  Lanes rest, stiffness, damping;
} Neighbour;

/* An element as one of its corners sees it: the other three, and the gradients of all. */
typedef struct Element {
  uint32_t other[3][LANES];
  Lanes3 gradient[3];
  Lanes volume;
} Element;

typedef struct Group {
  uint32_t node[LANES];
  size_t first_neighbour, neighbours, first_element, elements;
} Group;

typedef struct Descent {
  Options options;
  Group *groups;
  Neighbour *neighbours;
  Element *elements;
  size_t group_count;
  Lanes *before, *target, *speed_before, *last, *last_but_one;
} Descent;

/* Items of each node, one list behind the other. */
typedef struct Lists {
  size_t *start;
  uint32_t *item;
} Lists;

static Lists list_items(const uint32_t *corner, size_t corners, size_t count, size_t nodes) {
  Lists lists = {clear_memory(nodes + 2, sizeof(size_t)), clear_memory(corners * count, sizeof(uint32_t))};
  for (size_t i = 0; i < corners * count; i++) lists.start[corner[i] + 2]++;
  for (size_t n = 0; n < nodes; n++) lists.start[n + 2] += lists.start[n + 1];
  for (size_t i = 0; i < corners * count; i++) lists.item[lists.start[corner[i] + 1]++] = (uint32_t)(i / corners);
  return lists;
}

/* Nodes that are free, by colours that no two nodes of a spring or an element share. */
static size_t colour_nodes(const System *s, const Lists *springs, const Lists *elements, uint32_t **order) {
  enum { MOST = 64 };
  uint8_t *of = clear_memory(s->node_count, 1);
  size_t count = 0;
  *order = clear_memory(s->node_count + MOST * LANES, sizeof **order);
  for (uint32_t n = 0; n < s->node_count; n++) {
    uint64_t taken = 0;
    for (size_t i = springs->start[n]; i < springs->start[n + 1]; i++) {
      const Spring *spring = s->springs + springs->item[i];
      taken |= (spring->a < n) ? 1ull << of[spring->a] : 0;
      taken |= (spring->b < n) ? 1ull << of[spring->b] : 0;
    }
    for (size_t i = elements->start[n]; i < elements->start[n + 1]; i++)
      for (int c = 0; c < 4; c++) {
        uint32_t other = s->tetrahedra[elements->item[i]].corner[c];
        taken |= other < n ? 1ull << of[other] : 0;
      }
    while (taken >> of[n] & 1) of[n]++;
  }
  for (unsigned c = 0; c < MOST; c++) {
    for (uint32_t n = 0; n < s->node_count; n++)
      if (of[n] == c && s->x[n][3] > 0) (*order)[count++] = n;
    while (count % LANES) (*order)[count++] = UINT32_MAX;
  }
  free(of);
  return count;
}

static void see_spring(Neighbour *to, size_t e, const Spring *spring, uint32_t node) {
  to->other[e] = spring->a == node ? spring->b : spring->a;
  to->rest[e] = spring->rest, to->stiffness[e] = spring->stiffness, to->damping[e] = spring->damping;
}

static void see_element(Element *to, size_t e, const Tetrahedron *t, uint32_t node) {
  double g[4][3];
  int others = 0;
  memcpy(g[1], t->gradient, sizeof t->gradient);
  for (int k = 0; k < 3; k++) g[0][k] = -(g[1][k] + g[2][k] + g[3][k]);
  for (int c = 0; c < 4; c++) {
    if (t->corner[c] == node) continue;
    to->other[others][e] = t->corner[c];
    Lanes3 *to_gradient = to->gradient + others++;
    to_gradient->x[e] = g[c][0], to_gradient->y[e] = g[c][1], to_gradient->z[e] = g[c][2];
  }
  to->volume[e] = t->volume;
}

static void fill_group(Descent *m, const System *s, Group *group, const Lists *springs, const Lists *elements) {
  for (size_t e = 0; e < LANES; e++) {
    uint32_t node = group->node[e];
    size_t first = springs->start[node], count = node < s->node_count ? springs->start[node + 1] - first : 0;
    for (size_t i = 0; i < group->neighbours; i++) {
      Neighbour *to = m->neighbours + group->first_neighbour + i;
      to->other[e] = (uint32_t)s->node_count;
      if (i < count) see_spring(to, e, s->springs + springs->item[first + i], node);
    }
    first = elements->start[node], count = node < s->node_count ? elements->start[node + 1] - first : 0;
    for (size_t i = 0; i < group->elements; i++) {
      Element *to = m->elements + group->first_element + i;
      for (int k = 0; k < 3; k++) to->other[k][e] = (uint32_t)s->node_count;
      if (i < count) see_element(to, e, s->tetrahedra + elements->item[first + i], node);
    }
  }
}

static size_t most(const Lists *lists, const Group *group, size_t nodes) {
  size_t count = 0;
  for (int e = 0; e < LANES; e++) {
    uint32_t n = group->node[e];
    size_t own = n < nodes ? lists->start[n + 1] - lists->start[n] : 0;
    if (own > count) count = own;
  }
  return count;
}

static void *create(const System *s, const Options *options) {
  Descent *m = clear_memory(1, sizeof *m);
  m->options = *options;
  uint32_t *corner = clear_memory(2 * s->spring_count + 4 * s->tetrahedron_count, sizeof *corner), *order;
  for (size_t i = 0; i < s->spring_count; i++) corner[2 * i] = s->springs[i].a, corner[2 * i + 1] = s->springs[i].b;
  Lists springs = list_items(corner, 2, s->spring_count, s->node_count);
  for (size_t i = 0; i < s->tetrahedron_count; i++)
    memcpy(corner + 4 * i, s->tetrahedra[i].corner, sizeof s->tetrahedra[i].corner);
  Lists elements = list_items(corner, 4, s->tetrahedron_count, s->node_count);
  m->group_count = colour_nodes(s, &springs, &elements, &order) / LANES;
  m->groups = clear_memory(m->group_count, sizeof *m->groups);
  size_t neighbours = 0, element_count = 0;
  for (size_t i = 0; i < m->group_count; i++) {
    Group *group = m->groups + i;
    for (int e = 0; e < LANES; e++)
      group->node[e] = order[LANES * i + e] == UINT32_MAX ? (uint32_t)s->node_count : order[LANES * i + e];
    group->first_neighbour = neighbours, group->first_element = element_count;
    neighbours += group->neighbours = most(&springs, group, s->node_count);
    element_count += group->elements = most(&elements, group, s->node_count);
  }
  m->neighbours = clear_memory(neighbours, sizeof *m->neighbours);
  m->elements = clear_memory(element_count, sizeof *m->elements);
  for (size_t i = 0; i < m->group_count; i++) fill_group(m, s, m->groups + i, &springs, &elements);
  Lanes **arrays[] = {&m->before, &m->target, &m->speed_before, &m->last, &m->last_but_one};
  for (int i = 0; i < 5; i++) *arrays[i] = clear_memory(s->node_count + 1, sizeof(Lanes));
  m->target[s->node_count] = m->before[s->node_count] = s->x[s->node_count]; /* so that padding stays where it is */
  free(corner), free(order), free(springs.start), free(springs.item), free(elements.start), free(elements.item);
  return m;
}

static void destroy(void *data) {
  Descent *m = data;
  free(m->groups), free(m->neighbours), free(m->elements);
  free(m->before), free(m->target), free(m->speed_before), free(m->last), free(m->last_but_one), free(m);
}

/* Force on four nodes, and the derivatives of minus that force: a symmetric matrix each. */
typedef struct Local {
  Lanes3 f;
  Lanes xx, yy, zz, yz, zx, xy;
} Local;

static void add_outer(Local *to, Lanes w, Lanes3 a) {
  to->xx += w * a.x * a.x, to->yy += w * a.y * a.y, to->zz += w * a.z * a.z;
  to->yz += w * a.y * a.z, to->zx += w * a.z * a.x, to->xy += w * a.x * a.y;
}
static void add_diagonal(Local *to, Lanes w) { to->xx += w, to->yy += w, to->zz += w; }

/* Of a compressed spring the part across is left out, so that the matrix stays positive. */
static void add_spring(Local *to, const Descent *m, const System *s, const Neighbour *spring, Lanes3 x, Lanes3 moved) {
  double h = m->options.step_s;
  Lanes3 other = lanes_load(s->x, spring->other, NULL), d = lanes3_minus(x, other);
  Lanes length = lanes_sqrt(lanes3_dot(d, d) + 1e-300), across = 1 - spring->rest / length;
  Lanes3 n = lanes3_scale(1 / length, d);
  Lanes tension = spring->stiffness * (length - spring->rest), along = spring->stiffness;
  across = spring->stiffness * lanes_choose(across > 0, across, lanes(0));
  if (s->damped) {
    Lanes3 speed = lanes3_minus(moved, lanes3_minus(other, lanes_load(m->before, spring->other, NULL)));
    tension += spring->damping / h * lanes3_dot(n, speed);
    along += spring->damping / h;
  }
  to->f = lanes3_minus(to->f, lanes3_scale(tension, n));
  add_diagonal(to, across);
  add_outer(to, along - across, n);
}

/* The volume is linear in one node's place, so that the matrix is positive as it is. */
static void add_element(Local *to, const System *s, const Element *element, Lanes3 x) {
  Lanes3 d[3], b = {lanes(0), lanes(0), lanes(0)};
  for (int k = 0; k < 3; k++) {
    d[k] = lanes3_minus(lanes_load(s->x, element->other[k], NULL), x);
    b = lanes3_minus(b, element->gradient[k]);
  }
  Lanes33 f = lanes33_of(d, element->gradient), c = lanes33_cofactor(&f);
  Lanes inverse = 1 / (lanes33_square(&f) + 1), of_f = s->m - s->m * inverse;
  Lanes pressure = s->l * (lanes3_dot(f.c[0], c.c[0]) - s->alpha);
  Lanes3 stretch = lanes33_times(&f, b), area = lanes33_times(&c, b);
  Lanes3 pull = lanes3_plus(lanes3_scale(of_f, stretch), lanes3_scale(pressure, area));
  to->f = lanes3_minus(to->f, lanes3_scale(element->volume, pull));
  add_diagonal(to, element->volume * of_f * lanes3_dot(b, b));
  add_outer(to, element->volume * 2 * s->m * inverse * inverse, stretch);
  add_outer(to, element->volume * s->l, area);
}

static void add_contacts(Local *to, const System *s, Lanes3 x) {
  for (size_t i = 0; i < s->ball_count; i++) {
    const double *ball = s->balls[i];
    Lanes3 d = {x.x - ball[0], x.y - ball[1], x.z - ball[2]};
    Lanes square = lanes3_dot(d, d);
    LanesBits inside = square < ball[3] * ball[3];
    if (!(inside[0] | inside[1] | inside[2] | inside[3])) continue;
    Lanes length = lanes_sqrt(square), k = lanes_choose(inside, lanes(s->contact_stiffness), lanes(0));
    Lanes3 n = lanes3_scale(1 / length, d);
    to->f = lanes3_plus(to->f, lanes3_scale(k * (ball[3] - length), n));
    add_outer(to, k, n);
  }
}

static Lanes3 solve(const Local *a) {
  Lanes xx = a->yy * a->zz - a->yz * a->yz, xy = a->yz * a->zx - a->xy * a->zz, zx = a->xy * a->yz - a->yy * a->zx;
  Lanes yy = a->xx * a->zz - a->zx * a->zx, yz = a->xy * a->zx - a->xx * a->yz, zz = a->xx * a->yy - a->xy * a->xy;
  Lanes inverse = 1 / (a->xx * xx + a->xy * xy + a->zx * zx);
  return (Lanes3){inverse * (xx * a->f.x + xy * a->f.y + zx * a->f.z),
                  inverse * (xy * a->f.x + yy * a->f.y + yz * a->f.z),
                  inverse * (zx * a->f.x + yz * a->f.y + zz * a->f.z)};
}

static void sweep(const Descent *m, const System *s) {
  double h = m->options.step_s;
  for (const Group *group = m->groups; group < m->groups + m->group_count; group++) {
    Lanes weight;
    Lanes3 x = lanes_load(s->x, group->node, &weight), target = lanes_load(m->target, group->node, NULL);
    Lanes3 moved = lanes3_minus(x, lanes_load(m->before, group->node, NULL));
    /* Padding has the weight 0; any mass will do. */
    Lanes inertia = 1 / (h * h * lanes_choose(weight > 0, weight, lanes(1)));
    Local local = {.f = lanes3_scale(inertia, lanes3_minus(target, x))};
    add_diagonal(&local, inertia);
    const Neighbour *springs = m->neighbours + group->first_neighbour;
    for (size_t i = 0; i < group->neighbours; i++) add_spring(&local, m, s, springs + i, x, moved);
    const Element *elements = m->elements + group->first_element;
    for (size_t i = 0; i < group->elements; i++) add_element(&local, s, elements + i, x);
    add_contacts(&local, s, x);
    lanes_add(s->x, group->node, solve(&local));
  }
}

/* Chebyshev's weights (Wang 2015). */
static double accelerate(const Descent *m, System *s, unsigned done, double omega) {
  double square = m->options.spectral_radius * m->options.spectral_radius;
  omega = done == 0 ? 1 : done == 1 ? 2 / (2 - square) : 4 / (4 - square * omega);
  for (size_t i = 0; i < s->node_count; i++) {
    Lanes x = s->x[i];
    if (done > 0) s->x[i] = omega * (x - m->last_but_one[i]) + m->last_but_one[i];
    s->x[i][3] = x[3];
    m->last_but_one[i] = m->last[i];
    m->last[i] = s->x[i];
  }
  return omega;
}

/* Where a step begins to search: gravity counts as far as the node followed it in the step before. */
static void predict(const Descent *m, System *s) {
  double h = m->options.step_s;
  for (size_t i = 0; i < s->node_count; i++) {
    Lanes x = s->x[i], v = s->v[i], g = s->acceleration[i], a = (v - m->speed_before[i]) / h;
    double size = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    double share = size > 0 ? (a[0] * g[0] + a[1] * g[1] + a[2] * g[2]) / size : 0;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    m->before[i] = x, m->speed_before[i] = v;
    m->target[i] = x + h * v + h * h * g;
    s->x[i] = x + h * v + share * h * h * g;
    m->last[i] = s->x[i];
  }
}

static void step(void *data, System *s) {
  Descent *m = data;
  double omega = 1;
  predict(m, s);
  for (unsigned i = 0; i < m->options.iterations; i++) {
    sweep(m, s);
    if (m->options.spectral_radius > 0) omega = accelerate(m, s, i, omega);
  }
  for (size_t i = 0; i < s->node_count; i++) s->v[i] = (s->x[i] - m->before[i]) / m->options.step_s;
}

const Method vertex_block_descent = {"vbd", create, step, destroy};
