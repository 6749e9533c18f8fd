/* The systems, with the numbers that tests/bench/peers/ours.c gives our models. */
#include "tests/bench/field/cases.h"

/* A cloth whose nodes lie where `place` says: springs along the triangles' edges, a third of a triangle's mass to each
 * of its corners. */
static System *make_cloth(const CaseRun *run, void (*place)(unsigned, double[3])) {
  enum { NODES = CLOTH_NODES * CLOTH_NODES };
  System *s = system_new(NODES, 3 * CLOTH_TRIANGLES, 0);
  static bool tied[NODES][NODES];
  memset(tied, 0, sizeof tied);
  for (unsigned i = 0; i < NODES; i++) {
    double x[3];
    place(i, x);
    s->x[i] = (Lanes){x[0], x[1], x[2], 0};
  }
  size_t count = 0;
  for (unsigned t = 0; t < CLOTH_TRIANGLES; t++) {
    unsigned corner[3];
    cloth_triangle(t, corner);
    for (int k = 0; k < 3; k++) {
      unsigned a = corner[k], b = corner[(k + 1) % 3], low = a < b ? a : b, high = a < b ? b : a;
      s->mass[a] += CLOTH_MASS / (3.0 * CLOTH_TRIANGLES);
      if (tied[low][high]) continue;
      tied[low][high] = true;
      s->springs[count++] =
          (Spring){.a = low, .b = high, .stiffness = case_number(run, "stiffness", 100), .damping = CLOTH_DAMPING};
    }
  }
  s->spring_count = count;
  system_rest(s, 0);
  return s;
}

static System *cloth(const CaseRun *run) {
  System *s = make_cloth(run, cloth_node);
  for (uint32_t i = 0; i < CLOTH_NODES; i++) system_hold(s, i);
  return s;
}

static System *net(const CaseRun *run) {
  System *s = make_cloth(run, net_node);
  for (uint32_t i = 0; i < s->node_count; i++) {
    s->x[i] *= NET_STRETCH;
    if (net_is_held(i)) system_hold(s, i);
  }
  s->ball_count = NET_BALLS, s->contact_stiffness = NET_CONTACT;
  s->balls = clear_memory(NET_BALLS, sizeof *s->balls);
  for (int b = 0; b < NET_BALLS; b++) {
    memcpy(s->balls[b], net_ball[b], sizeof net_ball[b]);
    s->balls[b][3] = NET_BALL_RADIUS + NET_NODE_RADIUS;
  }
  return s;
}

static System *rope(const CaseRun *run) {
  System *s = system_new(ROPE_NODES, ROPE_NODES - 1, 0);
  for (uint32_t i = 0; i < ROPE_NODES; i++) {
    s->x[i] = (Lanes){i * ROPE_LENGTH / (ROPE_NODES - 1), 0, 0, 0};
    s->mass[i] = ROPE_MASS / ROPE_NODES;
    if (i) s->springs[i - 1] = (Spring){.a = i - 1, .b = i, .stiffness = case_number(run, "stiffness", 1000)};
  }
  system_rest(s, 0);
  system_hold(s, 0);
  return s;
}

static System *bar(const CaseRun *run) {
  unsigned parts = (unsigned)case_number(run, "parts", 1), nodes = bar_nodes(parts), count = bar_tetrahedra(parts);
  System *s = system_new(nodes, 0, count);
  for (unsigned i = 0; i < nodes; i++) {
    double x[3];
    bar_node(parts, i, x);
    s->x[i] = (Lanes){x[0], x[1], x[2], 0};
  }
  for (unsigned t = 0; t < count; t++) bar_tetrahedron(parts, t, s->tetrahedra[t].corner);
  system_rest(s, BAR_DENSITY);
  system_law(s, strcmp(case_word(run, "law", ""), "corotational") ? NEO_HOOKEAN : COROTATIONAL, BAR_YOUNG_MODULUS,
             case_number(run, "poisson_ratio", BAR_POISSON_RATIO));
  for (unsigned i = 0; i < nodes; i++)
    if (s->x[i][0] == 0) system_hold(s, i);
  return s;
}

System *case_system(const CaseRun *run, const char *name) {
  static const struct {
    const char *name;
    System *(*make)(const CaseRun *run);
  } cases[] = {{"cloth", cloth}, {"net", net}, {"rope", rope}, {"bar", bar}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    if (strcmp(cases[i].name, name)) continue;
    System *s = cases[i].make(run);
    system_finish(s);
    return s;
  }
  return NULL;
}

const Method *case_method(const char *name) {
  static const Method *const methods[] = {&xpbd, &vertex_block_descent, &projective_dynamics, &runge_kutta};
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    if (!strcmp(methods[i]->name, name)) return methods[i];
  return NULL;
}
