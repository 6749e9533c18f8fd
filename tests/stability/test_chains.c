/* Chains of springs, which position-based steps meet at once: which ones are found, and how they hang and fall. */
#include <math.h>
#include <string.h>

#include "models/net/spring_chains.h"
#include "tests/stability/chain.h"
#include "tests/stability/rig.h"

/* Each spring is in one chain, no node is twice in one, and its springs lie end to end. */
static void check_chains(const SporeSpringChains *chains, const SporeSpringPair *pairs, size_t count, size_t nodes) {
  g_autofree unsigned *springs = g_new0(unsigned, count), *seen = g_new0(unsigned, nodes);
  for (unsigned c = 0; c < chains->count; c++) {
    const uint32_t *node = chains->node + chains->start[c] + c;
    size_t length = spore_spring_chain_length(chains, c);
    for (size_t i = 0; i <= length; i++) {
      g_assert_cmpuint(seen[node[i]], !=, c + 1);
      seen[node[i]] = c + 1;
    }
    for (size_t i = 0; i < length; i++) {
      uint32_t spring = chains->spring[chains->start[c] + i];
      g_assert_cmpuint(MIN(node[i], node[i + 1]), ==, pairs[spring].a);
      g_assert_cmpuint(MAX(node[i], node[i + 1]), ==, pairs[spring].b);
      g_assert_cmpuint(springs[spring]++, ==, 0);
    }
  }
  for (size_t s = 0; s < count; s++) g_assert_cmpuint(springs[s], ==, 1);
}

/* Rows and columns of a grid are chains, two colours of them. */
static void grid_has_rows(void) {
  enum { ACROSS = 9, DOWN = 7, NODES = ACROSS * DOWN };
  SporeSpringPair pairs[2 * NODES];
  double rest[3 * NODES];
  size_t count = 0, rows = 0;
  for (uint32_t n = 0; n < NODES; n++) {
    rest[3 * n] = n % ACROSS, rest[3 * n + 1] = n / ACROSS, rest[3 * n + 2] = 0;
    if (n % ACROSS + 1 < ACROSS) pairs[count++] = (SporeSpringPair){n, n + 1, 0};
    if (n + ACROSS < NODES) pairs[count++] = (SporeSpringPair){n, n + ACROSS, 0};
  }
  SporeSpringChains chains;
  g_assert_true(spore_spring_chains_find(&chains, pairs, count, rest, NODES));
  check_chains(&chains, pairs, count, NODES);
  g_assert_cmpuint(chains.count, ==, ACROSS + DOWN);
  for (size_t c = 0; c < chains.count; c++) {
    g_assert_cmpuint(chains.colour[c], <, 2);
    rows += spore_spring_chain_length(&chains, c) == ACROSS - 1;
  }
  g_assert_cmpuint(rows, ==, DOWN);
  spore_spring_chains_clear(&chains);
}

/* A ring is cut open: its last spring is a chain of its own, of another colour. */
static void ring_is_opened(void) {
  enum { NODES = 24 };
  SporeSpringPair pairs[NODES];
  double rest[3 * NODES] = {0};
  for (uint32_t n = 0; n < NODES; n++) {
    uint32_t next = (n + 1) % NODES;
    pairs[n] = (SporeSpringPair){MIN(n, next), MAX(n, next), 0};
    rest[3 * n] = cos(2 * G_PI * n / NODES), rest[3 * n + 1] = sin(2 * G_PI * n / NODES);
  }
  SporeSpringChains chains;
  g_assert_true(spore_spring_chains_find(&chains, pairs, NODES, rest, NODES));
  check_chains(&chains, pairs, NODES, NODES);
  g_assert_cmpuint(chains.count, ==, 2);
  g_assert_cmpuint(spore_spring_chain_length(&chains, 0), ==, NODES - 1);
  g_assert_cmpuint(chains.colour[0], !=, chains.colour[1]);
  spore_spring_chains_clear(&chains);
}

enum { LINKS = 30 };
#define LENGTH 1.0 /* m */

static Rig *chain_rig(SporeIntegratorKind kind, double step, double stiffness, double damping) {
  double stiffnesses[LINKS], masses[LINKS + 1];
  for (int i = 0; i < LINKS; i++) stiffnesses[i] = stiffness;
  for (int i = 0; i <= LINKS; i++) masses[i] = 0.1 / (LINKS + 1);
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = step;
  rig->description.solver.sleep_speed = 0;
  rig->description.solver.maximum_speed = 1000;
  SporeModel *model = chain_new(LINKS, LENGTH / LINKS, stiffnesses, masses, damping);
  rig_passive(rig, "chain", model, NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  return rig;
}

/* Held level by its first node and let go; copies where the nodes are after `time_s`. */
static double *fall(SporeIntegratorKind kind, double step, double time_s) {
  Rig *rig = chain_rig(kind, step, 2e5, 0);
  g_array_index(rig->bodies, SporeBodyDescription, 0).pose.orientation =
      spore_quat_from_rotation_vector(spore_vec3(0, 0, G_PI / 2));
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(time_s / step));
  double *q = g_memdup2(spore_world_q(world, 0), 3 * (LINKS + 1) * sizeof *q);
  rig_free(rig);
  return q;
}

static double apart(const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < 3 * (LINKS + 1); i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* A stiff one falls as it should at steps far above those that an explicit method bears. */
static void falls(void) {
  const double time_s = 0.3;
  g_autofree double *exact = fall(SPORE_INTEGRATOR_RK4, 2e-5, time_s);
  g_autofree double *coarse = fall(SPORE_INTEGRATOR_POSITION_BASED, 5e-3, time_s);
  g_autofree double *fine = fall(SPORE_INTEGRATOR_POSITION_BASED, 2.5e-3, time_s);
  double less = apart(fine, exact), more = apart(coarse, exact);
  g_test_message("%.3g and %.3g m from where it should be", more, less);
  g_assert_cmpfloat(more, <, 0.05 * LENGTH);
  g_assert_cmpfloat(less, <, 0.03 * LENGTH);
}

/* It comes to hang as the closed solution says, at any step. */
static void hangs(void) {
  static const double steps[] = {1e-3, 1e-2, 5e-2};
  double stiffnesses[LINKS], masses[LINKS + 1], heights[LINKS + 1];
  for (int i = 0; i < LINKS; i++) stiffnesses[i] = 200;
  for (int i = 0; i <= LINKS; i++) masses[i] = 0.1 / (LINKS + 1);
  chain_hang(LINKS, LENGTH / LINKS, stiffnesses, masses, 9.81, heights);
  for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++) {
    Rig *rig = chain_rig(SPORE_INTEGRATOR_POSITION_BASED, steps[s], 200, 20);
    SporeWorld *world = rig_build(rig);
    rig_run(world, 10000);
    double worst = 0;
    for (int i = 0; i <= LINKS; i++) worst = fmax(worst, fabs(spore_world_q(world, 0)[3 * i + 1] - heights[i]));
    g_test_message("step %g s: %.2g m from the closed solution", steps[s], worst);
    g_assert_cmpfloat(worst, <, 1e-9);
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/chains/grid", grid_has_rows);
  g_test_add_func("/chains/ring", ring_is_opened);
  g_test_add_func("/chains/falls", falls);
  g_test_add_func("/chains/hangs", hangs);
  return g_test_run();
}
