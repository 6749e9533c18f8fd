/* Verification: what stage `verify` finds is the residual of each integrator's own equations as computed by hand, of
 * the laws as written, and names the body; what is not solved is counted. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/sim/world_private.h"
#include "tests/sim/chain_model.h"

#define GRAVITY ((SporeVec3){0, -9.81, 0})
#define MASS 0.2      /* kg, of a particle */
#define DRAG 0.1      /* N s/m, on a particle */
#define STIFFNESS 4e3 /* N/m, of the tie between a particle and a point of the world */
#define DAMPING 2.    /* N s/m, of the tie */
#define LENGTH 0.3    /* m, of the tie at rest */
#define STEP 0.02     /* s */
#define HOOK ((SporeVec3){0.1, 0.32, 0})

static SporeBodyDescription particle(const char *name, SporeVec3 position) {
  SporeModel *model =
      chain_create((ChainFields){.count = 1, .mass = MASS, .spacing = 0.1, .damping = DRAG, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body(name, model, position);
  body.velocity = (SporeVec3){3, 1, 2};
  return body;
}

static SporeLinkDescription tie(const char *name, uint32_t body, uint32_t other, SporeVec3 from, SporeVec3 to) {
  return (SporeLinkDescription){.name = name,
                                .type = &spore_link_spring,
                                .body_a = body,
                                .body_b = other,
                                .point_a = from,
                                .point_b = to,
                                .stiffness = STIFFNESS,
                                .damping = DAMPING,
                                .rest_length = LENGTH};
}

/* Two particles: the first is tied to the hook, the second to the first. count: how many of them there are. A balance
 * is sought from nearby. */
static SporeWorld *make(SporeIntegratorKind kind, size_t count, int64_t newton) {
  bool moves = kind != SPORE_INTEGRATOR_STATIC;
  SporeVec3 first = moves ? (SporeVec3){0, 0, 0} : (SporeVec3){0.11, -0.01, 0.02};
  SporeVec3 second = moves ? (SporeVec3){0.25, -0.2, 0.1} : (SporeVec3){0.12, -0.33, 0.01};
  SporeBodyDescription bodies[] = {particle("first", first), particle("second", second)};
  SporeLinkDescription links[] = {tie("hook", 0, SPORE_NO_BODY, first, HOOK), tie("rope", 1, 0, second, first)};
  if (count == 1) bodies[1].model->type->destroy(bodies[1].model);
  SporeWorldDescription description = world_description(bodies, count);
  description.gravity = GRAVITY;
  description.links = links;
  description.link_count = count;
  description.solver.integrator = kind;
  description.solver.time_step = STEP;
  description.solver.newton_iterations = newton;
  description.solver.tolerance = 1e-10;
  SporeWorld *world = spore_world_create(&description, NULL, NULL);
  g_assert_nonnull(world);
  return world;
}

/* One attempt at the next step, and its verification. */
static SporeIsland *attempt(SporeWorld *world, int64_t newton) {
  world->solver.newton_iterations = newton;
  spore_world_link(world);
  spore_world_find_islands(world);
  SporeIsland *island = &world->solve.islands[0];
  spore_island_gather(world, island);
  island->result = spore_island_advance(world, island, island->integrator, island->substeps, NULL);
  spore_island_examine(world, island);
  spore_world_verify(world);
  return island;
}

/* Force on the first particle alone; drag: that on the particle. */
static SporeVec3 force(SporeVec3 q, SporeVec3 v, double drag) {
  SporeVec3 apart = spore_vec3_sub(q, HOOK), n = spore_vec3_normalise(apart, HOOK);
  double pull = STIFFNESS * (spore_vec3_length(apart) - LENGTH) + DAMPING * spore_vec3_dot(n, v);
  SporeVec3 f = spore_vec3_add_scaled(spore_vec3_scale(MASS, GRAVITY), -pull, n);
  return spore_vec3_add_scaled(f, -drag, v);
}

/* |c f - m dv| / sqrt m */
static double miss(double c, SporeVec3 f, SporeVec3 dv) {
  return spore_vec3_length(spore_vec3_add_scaled(spore_vec3_scale(c, f), -MASS, dv)) / sqrt(MASS);
}

typedef struct State {
  SporeVec3 q, v;
} State;

static State state(const double *q, const double *v) { return (State){spore_vec3_load(q), spore_vec3_load(v)}; }

static SporeVec3 mix(double a, SporeVec3 x, double b, SporeVec3 y) {
  return spore_vec3_add(spore_vec3_scale(a, x), spore_vec3_scale(b, y));
}

/* The larger residual of the two stages of TR-BDF2, as parts of their loads: p_m = p_0 + D h (F_0 + F_m),
 * p_1 = p_0 + W/D (p_m - p_0) + D h F_1, where q tells the velocity in the middle. */
static double miss_tr_bdf2(State a, State b, const SporeKeptEquations *equations) {
  const double d = 1 - M_SQRT1_2, w = 0.25 * M_SQRT2, h = STEP;
  State m;
  m.v = spore_vec3_sub(
      spore_vec3_scale(1 / (w * h), spore_vec3_sub(spore_vec3_sub(b.q, a.q), spore_vec3_scale(d * h, b.v))), a.v);
  m.q = spore_vec3_add_scaled(a.q, d * h, spore_vec3_add(a.v, m.v));
  SporeVec3 first = mix(1, spore_vec3_sub(m.v, a.v), -d * h / MASS, force(a.q, a.v, DRAG));
  SporeVec3 second = mix(1, spore_vec3_sub(b.v, a.v), -w / d, spore_vec3_sub(m.v, a.v));
  return fmax(miss(d * h, force(m.q, m.v, DRAG), first) / equations->kept[0].load,
              miss(d * h, force(b.q, b.v, DRAG), second) / equations->kept[1].load);
}

/* The relative residual of the step from a to b by hand; `before`: the state before a. */
static double by_hand(SporeIntegratorKind kind, State before, State a, State b, const SporeKeptEquations *equations) {
  double h = STEP, load = equations->kept[0].load;
  SporeVec3 change = spore_vec3_sub(b.v, a.v), none = {0, 0, 0};
  switch (kind) {
  case SPORE_INTEGRATOR_IMPLICIT_EULER:
    return miss(h, force(b.q, b.v, DRAG), change) / load;
  case SPORE_INTEGRATOR_IMPLICIT_MIDPOINT:
    return miss(0.5 * h, force(mix(0.5, a.q, 0.5, b.q), mix(0.5, a.v, 0.5, b.v), DRAG), spore_vec3_scale(0.5, change)) /
           load;
  case SPORE_INTEGRATOR_BDF2:
    return miss(2 * h / 3, force(b.q, b.v, DRAG), mix(1, change, -1. / 3, spore_vec3_sub(a.v, before.v))) / load;
  case SPORE_INTEGRATOR_TR_BDF2:
    return miss_tr_bdf2(a, b, equations);
  default:
    g_assert_cmpint(kind, ==, SPORE_INTEGRATOR_STATIC);
    return miss(1, force(b.q, b.v, 0), none) / load;
  }
}

static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_IMPLICIT_MIDPOINT,
                                            SPORE_INTEGRATOR_BDF2, SPORE_INTEGRATOR_TR_BDF2, SPORE_INTEGRATOR_STATIC};

/* After each of these many iterations the residual found is that by hand, and in the end it is within the tolerance. */
static void test_by_hand(void) {
  for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++) {
    SporeWorld *world = make(kinds[k], 1, 50);
    bool moves = kinds[k] != SPORE_INTEGRATOR_STATIC; /* a balance does not move any more */
    for (int i = 0; moves && i < 2; i++) spore_world_step(world);
    State before = state(world->state.q, world->state.v);
    if (moves) spore_world_step(world);
    State a = state(world->state.q, world->state.v);
    for (int64_t newton = 1; newton <= 50; newton += newton < 4 ? 1 : 46) {
      const SporeIsland *island = attempt(world, newton);
      double exact = by_hand(kinds[k], before, a, state(island->q1, island->v1), &island->equations);
      double found = island->verdict.residual;
      g_test_message("%s, %d iterations: %.3e by hand, %.3e found", spore_integrator_names[kinds[k]], (int)newton,
                     exact, found);
      g_assert_cmpfloat(fabs(found - exact), <=, 1e-6 * exact + 1e-11);
      if (newton == 1) g_assert_cmpfloat(found, >, 1e-6);
      if (newton == 1) g_assert_cmpint(island->verdict.body, ==, 0);
      if (newton == 50) g_assert_cmpfloat(found, <=, 1e-10);
    }
    spore_world_free(world);
  }
}

/* What a step left in the terms does not change; a law that is not the one that was solved shows at once. */
static void test_as_written(void) {
  SporeWorld *world = make(SPORE_INTEGRATOR_IMPLICIT_EULER, 2, 50);
  for (int i = 0; i < 3; i++) spore_world_step(world);
  const SporeIsland *island = attempt(world, 50);
  g_assert_cmpfloat(island->verdict.residual, <=, 1e-10);
  SporeSpringTerm *term = &world->links.springs[1];
  SporeSpringTerm left = *term;
  spore_world_verify(world);
  g_assert_cmpfloat(island->verdict.residual, <=, 1e-10);
  g_assert_cmpmem(term, sizeof *term, &left, sizeof left);
  term->law.stiffness *= 1.001;
  spore_world_verify(world);
  g_assert_cmpfloat(island->verdict.residual, >, 1e-6);
  g_assert_cmpfloat(island->verdict.residual, >, island->verdict.rounding);
  g_assert_cmpint(island->trouble, ==, SPORE_TROUBLE_NOT_CONVERGED);
  spore_world_free(world);
}

/* The body is named whose equations miss most. */
static void test_names(void) {
  for (uint32_t body = 0; body < 2; body++) {
    SporeWorld *world = make(SPORE_INTEGRATOR_IMPLICIT_EULER, 2, 50);
    const SporeIsland *island = attempt(world, 50);
    g_assert_cmpuint(island->equations.count, ==, 1);
    g_assert_cmpint(island->verdict.body == SPORE_NO_BODY || island->verdict.residual <= 1e-10, ==, true);
    world->solve.kept_va[0][world->bodies[body].v_offset] += 0.01;
    spore_world_verify(world);
    g_assert_cmpint(island->verdict.body, ==, body);
    g_assert_cmpfloat_with_epsilon(island->verdict.residual * island->equations.kept[0].load, 0.01 * sqrt(MASS), 1e-9);
    spore_world_free(world);
  }
}

/* A solver that says it has solved what it has not is not believed. */
static void test_says_solved(void) {
  for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++) {
    SporeWorld *world = make(kinds[k], 2, 50);
    SporeIsland *island = attempt(world, 1);
    island->result.converged = true;
    island->result.residual = 0;
    island->trouble = SPORE_TROUBLE_NONE;
    spore_world_verify(world);
    g_test_message("%s: %.2e found", spore_integrator_names[kinds[k]], island->verdict.residual);
    g_assert_cmpfloat(island->verdict.residual, >, 1e-8);
    g_assert_cmpint(island->trouble, ==, SPORE_TROUBLE_NOT_CONVERGED);
    spore_world_free(world);
  }
}

/* A particle's step, solved, and then as by a solver whose forces are 1 % too large: with those its answer is exact. */
static SporeIsland *take_step_with_wrong_forces(SporeWorld *world) {
  do spore_world_step(world);
  while (world->state.step % SPORE_STEPS_BETWEEN_LOOKS != 1);
  SporeIsland *island = attempt(world, 50);
  g_assert_cmpfloat(island->verdict.residual, <=, 1e-10);
  SporeEvaluation *last = &world->solve.evaluated[0];
  for (int k = 0; k < 3; k++) {
    last->f[k] *= 1.01;
    world->solve.kept_va[0][k] = world->solve.kept_v[0][k] - island->equations.kept[0].c * last->f[k] / MASS;
  }
  return island;
}

/* Such forces are used again only where the solver evaluated them at its answer. */
static void test_elsewhere(void) {
  for (int what = 0; what < 3; what++) {
    SporeWorld *world = make(SPORE_INTEGRATOR_IMPLICIT_EULER, 1, 50);
    const SporeIsland *island = take_step_with_wrong_forces(world);
    double *moved[] = {world->solve.kept_v[0], world->solve.evaluated[0].v, world->solve.evaluated[0].q};
    moved[what][1] = nextafter(moved[what][1], HUGE_VAL);
    spore_world_verify(world);
    g_assert_cmpfloat(island->verdict.residual, >, 1e-4);
    g_assert_cmpint(island->trouble, ==, SPORE_TROUBLE_NOT_CONVERGED);
    spore_world_free(world);
  }
}

/* Where it did they go unnoticed, but not for long. */
static void test_wrong_forces(void) {
  SporeWorld *world = make(SPORE_INTEGRATOR_IMPLICIT_EULER, 1, 50);
  const SporeIsland *island = take_step_with_wrong_forces(world);
  unsigned found = 0;
  for (int i = 0; i < SPORE_STEPS_BETWEEN_LOOKS; i++, world->state.step++) {
    spore_world_verify(world);
    g_assert_true(island->verdict.residual > 1e-4 || island->verdict.residual <= 1e-10);
    found += island->verdict.residual > 1e-4;
  }
  g_assert_cmpuint(found, ==, 1);
  spore_world_free(world);
}

static bool is_counted(const SporeWorld *world, uint32_t body, SporeUnsolvedCause cause) {
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
    SporeUnsolved entry = spore_world_unsolved(world, i);
    if (entry.body == body && !strcmp(entry.cause, spore_unsolved_cause(cause))) return true;
  }
  return false;
}

/* A world's steps with too few iterations are counted as unsolved, by the residual that was found; with enough there is
 * none. */
static void test_counts(void) {
  unsigned stand_ins = 0;
  for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++)
    for (int enough = 0; enough < 2; enough++) {
      SporeWorld *world = make(kinds[k], 2, enough ? 50 : 1);
      double worst = 0;
      for (int i = 0; i < 20; i++) {
        spore_world_step(world);
        worst = fmax(worst, spore_world_counts(world).residual);
      }
      g_test_message("%s: %s, worst %.2e", spore_integrator_names[kinds[k]], enough ? "enough" : "one iteration",
                     worst);
      if (enough) g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
      else g_assert_cmpuint(spore_world_unsolved_count(world), >, 0);
      g_assert_cmpint(worst <= 1e-10, ==, enough);
      /* Smaller steps are those of implicit Euler: it stands in for the others. */
      bool stood_in = is_counted(world, 0, SPORE_UNSOLVED_STOOD_IN);
      if (enough || kinds[k] == SPORE_INTEGRATOR_IMPLICIT_EULER) g_assert_false(stood_in);
      stand_ins += stood_in;
      spore_world_free(world);
    }
  g_assert_cmpuint(stand_ins, >=, 2);
}

/* A tie so stiff that the last digit of a position is more than the tolerance: no answer is good enough, and that is
 * said. Nearer to the origin it is solved. */
static void test_rounding(void) {
  for (int near = 0; near < 2; near++) {
    SporeVec3 at = {near ? 0 : 1e3, 0, 0};
    SporeBodyDescription body = particle("particle", at);
    SporeLinkDescription link = tie("tie", 0, SPORE_NO_BODY, at, spore_vec3_add(at, (SporeVec3){0, LENGTH, 0}));
    SporeWorldDescription description = world_description(&body, 1);
    link.stiffness = 1e9;
    description.gravity = GRAVITY;
    description.links = &link;
    description.link_count = 1;
    description.solver.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    description.solver.time_step = STEP;
    description.solver.tolerance = 1e-6;
    SporeWorld *world = spore_world_create(&description, NULL, NULL);
    g_assert_nonnull(world);
    for (int i = 0; i < 50; i++) spore_world_step(world);
    for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
      SporeUnsolved entry = spore_world_unsolved(world, i);
      g_test_message("%g m from the origin: %u steps, worst %.2e: %s", at.x, (unsigned)entry.steps, entry.worst,
                     entry.cause);
      g_assert_cmpstr(entry.cause, ==, spore_unsolved_cause(SPORE_UNSOLVED_ROUNDING));
      g_assert_cmpfloat(entry.worst, >, 1e-6);
    }
    g_assert_cmpuint(spore_world_unsolved_count(world), ==, near ? 0 : 1);
    spore_world_free(world);
  }
}

/* What recovery did with a step is counted by body, and nothing of it where it was not needed. */
static void test_causes(void) {
  static const SporeUnsolvedCause causes[] = {SPORE_UNSOLVED_RETAKEN, SPORE_UNSOLVED_FRICTION, SPORE_UNSOLVED_CAUSES};
  for (size_t c = 0; c < G_N_ELEMENTS(causes); c++) {
    SporeWorld *world = make(SPORE_INTEGRATOR_IMPLICIT_EULER, 2, 50);
    SporeIsland *island = attempt(world, 50);
    island->offender = 1;
    island->frictionless = causes[c] == SPORE_UNSOLVED_FRICTION;
    if (causes[c] == SPORE_UNSOLVED_RETAKEN) {
      island->trouble = SPORE_TROUBLE_SPEED;
      spore_island_recover(world, island);
      spore_world_verify(world);
      g_assert_cmpuint(island->mending_substeps, >, 0);
      g_assert_cmpuint(island->equations.count, ==, island->mending_substeps);
    }
    g_assert_cmpfloat(island->verdict.residual, <=, 1e-10);
    spore_world_report_islands(world);
    g_assert_cmpuint(spore_world_unsolved_count(world), ==, causes[c] == SPORE_UNSOLVED_CAUSES ? 0 : 1);
    if (causes[c] != SPORE_UNSOLVED_CAUSES) g_assert_true(is_counted(world, 1, causes[c]));
    spore_world_free(world);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/verify/by_hand", test_by_hand);
  g_test_add_func("/verify/as_written", test_as_written);
  g_test_add_func("/verify/names", test_names);
  g_test_add_func("/verify/says_solved", test_says_solved);
  g_test_add_func("/verify/elsewhere", test_elsewhere);
  g_test_add_func("/verify/wrong_forces", test_wrong_forces);
  g_test_add_func("/verify/counts", test_counts);
  g_test_add_func("/verify/causes", test_causes);
  g_test_add_func("/verify/rounding", test_rounding);
  return g_test_run();
}
