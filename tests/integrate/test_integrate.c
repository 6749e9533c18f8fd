/* The integrators: order, energy, cost, and what each promises, on chains about which everything is known. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/integrate/integrator.h"
#include "core/sim/world_private.h"
#include "tests/sim/chain_model.h"

#define GRAVITY ((SporeVec3){0, -9.81, 0})
#define COUNT 4                       /* particles of the chain */
#define KINDS SPORE_INTEGRATOR_STATIC /* those that move */

/* What each method claims. */
static const int orders[KINDS] = {1, 1, 2, 4, 1, 1, 2, 2, 2};

static SporeWorld *create(SporeWorldDescription *description) {
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(description, NULL, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

typedef struct Swing {
  double stiffness, damping, link_stiffness, link_damping;
  size_t substeps;
  double error_tolerance;
  double tolerance; /* of the solver; 0: 1e-12 */
} Swing;

/* A chain held at one end swings under gravity; a spring and a damper tie its other end to the world. */
static SporeWorld *swing(const Swing *swing, SporeIntegratorKind kind, double h) {
  SporeModel *model = chain_create((ChainFields){.count = COUNT,
                                                 .mass = 0.1,
                                                 .spacing = 0.2,
                                                 .stiffness = swing->stiffness,
                                                 .damping = swing->damping,
                                                 .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("chain", model, (SporeVec3){0, 0, 0});
  SporeLinkDescription links[2] = {{.name = "pin", .type = &spore_link_pin, .body_a = 0, .radius = 0.01},
                                   {.name = "tie",
                                    .type = &spore_link_spring,
                                    .body_a = 0,
                                    .body_b = SPORE_NO_BODY,
                                    .point_a = {0.6, 0, 0},
                                    .point_b = {0.7, 0.3, 0.1},
                                    .stiffness = swing->link_stiffness,
                                    .damping = swing->link_damping,
                                    .rest_length = 0.1}};
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = GRAVITY;
  description.links = links;
  description.link_count = swing->link_stiffness > 0 ? 2 : 1;
  description.solver.integrator = kind;
  description.solver.time_step = h;
  description.solver.tolerance = swing->tolerance > 0 ? swing->tolerance : 1e-12;
  description.solver.newton_iterations = 50;
  description.solver.substeps = swing->substeps > 0 ? (int64_t)swing->substeps : 1;
  description.solver.error_tolerance = swing->error_tolerance;
  return create(&description);
}

static double total(const SporeWorld *world) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity + energy.contact;
}

static size_t run(SporeWorld *world, int steps) {
  size_t evaluations = 0;
  for (int i = 0; i < steps; i++) {
    spore_world_step(world);
    evaluations += spore_world_counts(world).force_evaluations;
  }
  return evaluations;
}

static void swing_to(const Swing *how, SporeIntegratorKind kind, double h, double time_s, double *q) {
  SporeWorld *world = swing(how, kind, h);
  run(world, (int)lround(time_s / h));
  memcpy(q, spore_world_q(world, 0), 3 * COUNT * sizeof *q);
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  spore_world_free(world);
}

static double distance(const double *a, const double *b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

/* Slope of log error against log step, by least squares; error: one for each step halved. */
static double fit_slope(const double *error, int count) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int i = 0; i < count; i++) {
    double x = -i, y = log2(error[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

#define LEVELS 4

static double measure_order(const Swing *how, SporeIntegratorKind kind, double coarse, double time_s, double *error) {
  static const Swing *reference_of;
  static double exact[3 * COUNT];
  if (reference_of != how) swing_to(how, SPORE_INTEGRATOR_RK4, 1e-5, time_s, exact);
  reference_of = how;
  for (int level = 0; level < LEVELS; level++) {
    double q[3 * COUNT];
    swing_to(how, kind, ldexp(coarse, -level), time_s, q);
    error[level] = distance(q, exact, 3 * COUNT);
  }
  return fit_slope(error, LEVELS);
}

/* Coarsest step by order: small enough for the slope, large enough for rounding. */
static double coarsest(int order) { return order == 1 ? 2.5e-4 : order == 2 ? 2e-3 : 4e-3; }

/* With dampers, so that forces depend on velocity too, and with a spring and a damper between body and world: explicit
 * methods are not to lose their order by what protects them from stiff ones. */
static void test_order(void) {
  static const Swing free_swing = {.stiffness = 60}, tied = {60, 0.08, 20, 0.1, 1, 0, 0};
  for (int damped = 0; damped < 2; damped++)
    for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < KINDS; kind++) {
      if (!damped && kind == SPORE_INTEGRATOR_EXPLICIT_EULER) continue; /* refused: nothing damps */
      double error[LEVELS], slope;
      slope = measure_order(damped ? &tied : &free_swing, kind, coarsest(orders[kind]), 0.4, error);
      g_test_message("order: %s, %s: slope %.3f (error %.1e m at %g s, %.1e m at %g s)", spore_integrator_names[kind],
                     damped ? "damped and tied" : "free", slope, error[0], coarsest(orders[kind]), error[LEVELS - 1],
                     ldexp(coarsest(orders[kind]), 1 - LEVELS));
      g_assert_cmpfloat_with_epsilon(slope, orders[kind], 0.2);
    }
}

/* Substeps are steps where nothing is frozen for the step. */
static void test_substeps(void) {
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_SYMPLECTIC_EULER; kind < KINDS; kind++) {
    const Swing once = {.stiffness = 60, .damping = 0.08}, ten = {.stiffness = 60, .damping = 0.08, .substeps = 10};
    double a[3 * COUNT], b[3 * COUNT];
    swing_to(&once, kind, 2e-4, 0.2, a);
    swing_to(&ten, kind, 2e-3, 0.2, b);
    double apart = distance(a, b, 3 * COUNT);
    g_test_message("substeps: %s: 10 in 2 ms are %.1e m from 0.2 ms", spore_integrator_names[kind], apart);
    g_assert_cmpfloat(apart, <, 1e-9);
  }
}

/* Drift of the energy over 1000 swings or so of what has no damping, as part of what there is to lose. */
static void test_energy(void) {
  /* Verlet: bounded; RK4: loses slowly; L-stable ones: lose. */
  const Swing how = {.stiffness = 60};
  double drift[KINDS] = {0}, h = 5e-3;
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_SYMPLECTIC_EULER; kind < KINDS; kind++) {
    SporeWorld *world = swing(&how, kind, h);
    double start = total(world), mean = 0, scale = 4 * 0.1 * 9.81 * 0.3;
    run(world, 20000);
    for (int i = 0; i < 2000; i++) {
      spore_world_step(world);
      mean += (total(world) - start) / 2000;
    }
    drift[kind] = mean / scale;
    g_test_message("energy: %s: %+.2e of what swings after %g s", spore_integrator_names[kind], drift[kind], 22000 * h);
    spore_world_free(world);
  }
  g_assert_cmpfloat(fabs(drift[SPORE_INTEGRATOR_SYMPLECTIC_EULER]), <, 0.05);
  g_assert_cmpfloat(fabs(drift[SPORE_INTEGRATOR_VERLET]), <, 0.01);
  g_assert_cmpfloat(fabs(drift[SPORE_INTEGRATOR_RK4]), <, 0.1);
  g_assert_cmpfloat(fabs(drift[SPORE_INTEGRATOR_IMPLICIT_MIDPOINT]), <, 0.05);
  g_assert_cmpfloat(drift[SPORE_INTEGRATOR_IMPLICIT_EULER], <, -0.5);
  g_assert_cmpfloat(drift[SPORE_INTEGRATOR_BDF2], <, 0);
  g_assert_cmpfloat(drift[SPORE_INTEGRATOR_TR_BDF2], <, 0);
  g_assert_cmpfloat(drift[SPORE_INTEGRATOR_IMPLICIT_EULER], <, drift[SPORE_INTEGRATOR_BDF2]);
}

/* A step so long for the stiffness that only L-stable methods calm down: h w is 600. */
static void test_stiff(void) {
  static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_BDF2,
                                              SPORE_INTEGRATOR_TR_BDF2};
  for (unsigned i = 0; i < G_N_ELEMENTS(kinds); i++) {
    const Swing how = {.stiffness = 1e8, .tolerance = 1e-6};
    SporeWorld *world = swing(&how, kinds[i], 0.01);
    double stretched = 0;
    run(world, 500);
    const double *q = spore_world_q(world, 0);
    for (int p = 0; p + 1 < COUNT; p++)
      stretched = fmax(stretched, fabs(distance(q + 3 * p, q + 3 * p + 3, 3) / 0.2 - 1));
    g_test_message("stiff: %s: 1e8 N/m at 10 ms: stretch %.1e, %+.3e J, %u recoveries",
                   spore_integrator_names[kinds[i]], stretched, total(world),
                   (unsigned)spore_world_monitor(world)->recoveries);
    g_assert_cmpfloat(stretched, <, 1e-6);
    g_assert_cmpfloat(total(world), <, 0.01); /* it starts at 0 */
    g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
    spore_world_free(world);
  }
}

/* The estimate is kept: the error at the end stays below what all steps together may make, and follows the tolerance.
 */
static void test_error_control(void) {
  double exact[3 * COUNT], time_s = 0.4, h = 0.02, last = HUGE_VAL;
  const Swing fine = {60, 0.08, 20, 0.1, 1, 0, 0};
  swing_to(&fine, SPORE_INTEGRATOR_RK4, 1e-5, time_s, exact);
  for (double tolerance = 1e-5; tolerance > 1e-9; tolerance /= 10) {
    Swing how = fine;
    double q[3 * COUNT];
    how.error_tolerance = tolerance;
    SporeWorld *world = swing(&how, SPORE_INTEGRATOR_TR_BDF2, h);
    size_t evaluations = run(world, (int)lround(time_s / h));
    memcpy(q, spore_world_q(world, 0), sizeof q);
    double error = distance(q, exact, 3 * COUNT) / sqrt(COUNT); /* root mean square */
    g_test_message("error control: %.0e m a step: off by %.1e m after %g steps, %zu force evaluations", tolerance,
                   error, time_s / h, evaluations);
    g_assert_cmpfloat(error, <, 3 * tolerance * time_s / h);
    g_assert_cmpfloat(error, <, 0.3 * last);
    last = error;
    spore_world_free(world);
  }
}

/* What a step costs, for those who choose among methods. */
static void test_cost(void) {
  static const double most[KINDS] = {1, 1, 1.01, 4, 1, 6, 6, 6, 12};
  const Swing how = {.stiffness = 60, .damping = 0.08};
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < KINDS; kind++) {
    SporeWorld *world = swing(&how, kind, kind == SPORE_INTEGRATOR_EXPLICIT_EULER ? 2.5e-4 : 1e-3);
    double each = (double)run(world, 400) / 400;
    g_test_message("cost: %s: %.2f force evaluations a step", spore_integrator_names[kind], each);
    g_assert_cmpfloat(each, <=, most[kind]);
    spore_world_free(world);
  }
}

/* What a multistep method remembers does not outlive a change: a state that is set, and reset. */
static void test_restart(void) {
  const Swing how = {.stiffness = 60};
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_VERLET; kind < KINDS; kind++) {
    SporeWorld *one = swing(&how, kind, 2e-3), *other = swing(&how, kind, 2e-3);
    run(one, 50);
    double q[3 * COUNT], v[3 * COUNT];
    memcpy(q, spore_world_q(one, 0), sizeof q);
    memcpy(v, spore_world_v(one, 0), sizeof v);
    run(other, 7); /* elsewhere, with a memory of it */
    spore_world_set_state(one, 0, q, v);
    spore_world_set_state(other, 0, q, v);
    run(one, 20);
    run(other, 20);
    g_assert_cmpmem(spore_world_q(one, 0), sizeof q, spore_world_q(other, 0), sizeof q);
    g_assert_cmpmem(spore_world_v(one, 0), sizeof v, spore_world_v(other, 0), sizeof v);
    spore_world_reset(one);
    uint64_t before = spore_world_hash(one);
    run(one, 30);
    uint64_t first = spore_world_hash(one);
    spore_world_reset(one);
    g_assert_cmpuint(spore_world_hash(one), ==, before);
    run(one, 30);
    g_assert_cmpuint(spore_world_hash(one), ==, first);
    spore_world_free(one);
    spore_world_free(other);
  }
}

/* Each explicit method stands at its limit and falls beyond it; the limit counts substeps. */
static void test_limits(void) {
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind <= SPORE_INTEGRATOR_RK4; kind++) {
    for (int damped = 0; damped < 2; damped++) {
      double h = 0.1, most = 0;
      SporeBodyDescription body = {0};
      SporeWorldDescription description;
      SporeError error = SPORE_ERROR_INIT;
      SporeModel *model = chain_create((ChainFields){
          .count = COUNT, .mass = 0.1, .spacing = 0.2, .stiffness = 5e3, .damping = damped * 3, .poison_at = HUGE_VAL});
      body = passive_body("chain", model, (SporeVec3){0, 0, 0});
      description = world_description(&body, 1);
      description.solver.integrator = kind;
      description.solver.time_step = h;
      g_assert_null(spore_world_create(&description, NULL, &error));
      const char *limit = strstr(error.message, "at most "), *remedy = strstr(error.message, "take ");
      g_test_message("limit: %s%s: %s", spore_integrator_names[kind], damped ? ", damped" : "", error.message);
      if (kind == SPORE_INTEGRATOR_EXPLICIT_EULER && !damped) {
        g_assert_null(limit);
        model->type->destroy(model);
        continue;
      }
      g_assert_nonnull(limit);
      g_assert_nonnull(remedy);
      double limit_s = g_ascii_strtod(limit + strlen("at most "), NULL);
      if (limit_s * SPORE_SUBSTEPS_MAXIMUM > h)
        description.solver.substeps = strtol(remedy + strlen("take "), NULL, 10);
      else description.solver.time_step = limit_s;
      SporeWorld *world = create(&description);
      double q[3 * COUNT], v[3 * COUNT];
      memcpy(q, spore_world_q(world, 0), sizeof q);
      memcpy(v, spore_world_v(world, 0), sizeof v);
      for (int k = 0; k < 3 * COUNT; k++) q[k] += 1e-4 * sin(k * k + 1.);
      spore_world_set_state(world, 0, q, v);
      for (int i = 0; i < 300; i++) {
        spore_world_step(world);
        for (int k = 0; k < 3 * COUNT; k++) most = fmax(most, fabs(spore_world_v(world, 0)[k]));
      }
      g_assert_cmpfloat(most, <, 0.1);
      spore_world_free(world);
    }
  }
}

/* A chain held at one end, or at both, that lay straight: where it hangs after one step. */
static SporeWorld *hang(bool both, double mass, double stiffness, SporeIntegratorKind kind) {
  SporeModel *model = chain_create((ChainFields){
      .count = 10, .mass = mass, .spacing = 0.1, .stiffness = stiffness, .damping = 0.5, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("chain", model, (SporeVec3){0, 0, 0});
  const SporeLinkDescription pins[2] = {
      {.name = "left", .type = &spore_link_pin, .body_a = 0, .radius = 0.01},
      {.name = "right", .type = &spore_link_pin, .body_a = 0, .point_a = {0.9, 0, 0}, .radius = 0.01}};
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = GRAVITY;
  description.links = pins;
  description.link_count = both ? 2 : 1;
  description.solver.integrator = kind;
  description.solver.newton_iterations = 60;
  description.solver.tolerance = 1e-9;
  description.solver.maximum_speed = 1e8;
  return create(&description);
}

/* Tension of the spring behind particle i, N, as a vector. */
static SporeVec3 tension(const double *q, int i, double stiffness) {
  SporeVec3 d = spore_vec3_sub(spore_vec3_load(q + 3 * i + 3), spore_vec3_load(q + 3 * i));
  return spore_vec3_scale(stiffness * (1 - 0.1 / spore_vec3_length(d)), d);
}

/* Against what statics says: each spring carries all below it, or between two pins, the same horizontal force
 * everywhere and a vertical one that changes by each particle's weight and is 0 in the middle. From a light load to one
 * that stretches the chain a thousandfold. */
static void test_static(void) {
  static const double masses[] = {1e-3, 0.1, 10, 1000};
  for (unsigned m = 0; m < G_N_ELEMENTS(masses); m++)
    for (int both = 0; both < 2; both++) {
      double weight = masses[m] * 9.81, stiffness = 500, worst = 0;
      SporeWorld *world = hang(both, masses[m], stiffness, SPORE_INTEGRATOR_STATIC);
      spore_world_step(world);
      const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
      SporeStepCounts counts = spore_world_counts(world);
      double moved = v[3 * 4 + 1] * 0.002 - q[3 * 4 + 1];
      for (int i = 0; i < 9; i++) {
        SporeVec3 t = tension(q, i, stiffness), first = tension(q, 0, stiffness);
        double vertical = both ? (i - 4) * weight : -(9 - i) * weight;
        worst = fmax(worst, fabs(t.y - vertical) / weight);
        worst = fmax(worst, both ? fabs(t.x - first.x) / weight : fabs(t.x) / weight);
      }
      g_test_message("static: %g kg, held at %s: balance off by %.1e of a particle's weight after one step, %zu Newton "
                     "iterations, %zu force evaluations, lowest %.4g m",
                     masses[m], both ? "both ends" : "one end", worst, counts.newton_iterations,
                     counts.force_evaluations, both ? q[3 * 4 + 1] : q[3 * 9 + 1]);
      g_assert_cmpfloat(worst, <, 1e-6);
      g_assert_cmpfloat(fabs(moved), <, 1e-9 * fabs(q[3 * 4 + 1])); /* v is how it moved */
      g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
      g_assert_cmpuint(spore_world_monitor(world)->not_converged, ==, 0);
      /* In balance already: nothing moves, and little is spent. */
      run(world, 3);
      counts = spore_world_counts(world);
      g_assert_cmpuint(counts.newton_iterations, <=, 2);
      spore_world_free(world);
    }
}

/* Nothing can hold it: refused, and with contacts alone it creeps, bounded. */
static void test_static_unheld(void) {
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model =
      chain_create((ChainFields){.count = 3, .mass = 0.1, .spacing = 0.1, .stiffness = 100, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("loose", model, (SporeVec3){0, 0, 0});
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = GRAVITY;
  description.solver.integrator = SPORE_INTEGRATOR_STATIC;
  g_assert_null(spore_world_create(&description, NULL, &error));
  g_assert_cmpstr(error.place, ==, "bodies/loose");
  g_assert_nonnull(strstr(error.message, "pin it"));
  double sphere[4] = {0, 0, 0, 0.01};
  const SporeSphereSet set = {1, sphere};
  body.spheres = &set;
  SporeWorld *world = create(&description);
  run(world, 500);
  g_assert_cmpfloat_with_epsilon(spore_world_v(world, 0)[1], -9.81 * 0.002, 1e-9);
  g_assert_cmpfloat_with_epsilon(spore_world_q(world, 0)[1], -9.81 * 0.002 * 1, 1e-6);
  spore_world_free(world);
}

typedef struct Pair {
  SporeIntegratorKind kinds[2];
  size_t substeps;      /* of the first */
  double stiffness[2];  /* of the chains */
  double link, damping; /* spring between them */
  double h;
  SporeVec3 gravity;
  double drag; /* of all particles */
} Pair;

/* Two chains, one behind the other, tied by a spring of no length; the second is held at its far end where there is
 * gravity. The first chain is the explicit one. */
static SporeWorld *couple(const Pair *pair) {
  SporeBodyDescription bodies[2];
  for (int b = 0; b < 2; b++) {
    SporeModel *model = chain_create((ChainFields){.count = 3,
                                                   .mass = 0.1 + 0.2 * b,
                                                   .spacing = 0.2,
                                                   .stiffness = pair->stiffness[b],
                                                   .damping = pair->drag,
                                                   .poison_at = HUGE_VAL});
    bodies[b] = passive_body(b ? "implicit" : "explicit", model, (SporeVec3){0.5 * b, 0, 0});
    bodies[b].integrator = pair->kinds[b];
  }
  bodies[0].substeps = pair->substeps;
  bodies[0].velocity = (SporeVec3){0.3, 0.5, -0.2};
  SporeLinkDescription links[2] = {{.name = "tie",
                                    .type = &spore_link_spring,
                                    .body_a = 0,
                                    .body_b = 1,
                                    .point_a = {0.4, 0, 0},
                                    .point_b = {0.5, 0, 0},
                                    .stiffness = pair->link,
                                    .damping = pair->damping},
                                   {.name = "pin", .type = &spore_link_pin, .body_a = 1, .radius = 0.01}};
  links[1].point_a = (SporeVec3){0.9, 0, 0};
  SporeWorldDescription description = world_description(bodies, 2);
  description.gravity = pair->gravity;
  description.links = links;
  description.link_count = spore_vec3_length(pair->gravity) > 0 ? 2 : 1;
  description.solver.time_step = pair->h;
  description.solver.tolerance = 1e-10;
  description.solver.sleep_speed = 0;
  return create(&description);
}

static void couple_to(const Pair *pair, double time_s, double *q) {
  SporeWorld *world = couple(pair);
  run(world, (int)lround(time_s / pair->h));
  for (uint32_t b = 0; b < 2; b++) memcpy(q + 9 * b, spore_world_q(world, b), 9 * sizeof *q);
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  spore_world_free(world);
}

static const SporeIntegratorKind explicit_kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_VERLET,
                                                     SPORE_INTEGRATOR_RK4};

/* Bodies of two methods on a smooth spring: of first order together, and both implicit, so that the spring acts as it
 * is written. */
static void test_multirate_order(void) {
  Pair pair = {{SPORE_INTEGRATOR_RK4, SPORE_INTEGRATOR_RK4}, 1, {60, 200}, 40, 0.1, 1e-5, {0, -9.81, 0}, 0};
  double exact[18], q[18], error[LEVELS];
  couple_to(&pair, 0.3, exact);
  for (unsigned k = 0; k < G_N_ELEMENTS(explicit_kinds); k++) {
    pair.kinds[0] = explicit_kinds[k];
    pair.kinds[1] = SPORE_INTEGRATOR_IMPLICIT_EULER;
    pair.substeps = 5;
    for (int level = 0; level < LEVELS; level++) {
      pair.h = ldexp(1e-3, -level);
      couple_to(&pair, 0.3, q);
      error[level] = distance(q, exact, 18);
    }
    double slope = fit_slope(error, LEVELS);
    SporeWorld *world = couple(&pair);
    run(world, 3);
    g_test_message("multirate order: %s with implicit Euler: slope %.3f (error %.1e m at 1 ms)",
                   spore_integrator_names[explicit_kinds[k]], slope, error[0]);
    g_assert_cmpfloat_with_epsilon(slope, 1, 0.2);
    g_assert_cmpuint(spore_world_counts(world).islands, ==, 1);
    g_assert_cmpfloat(world->bodies[0].preconditioner.matrix_c, >, 0);
    g_assert_cmpfloat(world->bodies[1].preconditioner.matrix_c, >, 0);
    spore_world_free(world);
  }
}

/* Highest energy above the start, as a part of it, and how far momentum is off at the end, as a part too. */
static double couple_long(const Pair *pair, double *drift) {
  SporeWorld *world = couple(pair);
  double start = total(world), wanted = 3 * 0.1 * 0.5, most = 0, momentum = 0;
  for (int i = 0; i < 1500; i++) {
    spore_world_step(world);
    most = fmax(most, total(world) / start - 1);
  }
  for (int p = 0; p < 3; p++)
    momentum += 0.1 * spore_world_v(world, 0)[3 * p + 1] + 0.3 * spore_world_v(world, 1)[3 * p + 1];
  *drift = fmax(*drift, fabs(momentum / wanted - 1));
  spore_world_free(world);
  return most;
}

/* Nothing gains energy however stiff the spring between them, also where the explicit chain's fastest mode and the step
 * meet (h w = pi and around), where impulses at the step's end would resonate. What one gains the other loses, to
 * the solver's tolerance of what they exchange, which grows with the stiffness. */
static void test_multirate_stiff(void) {
  for (unsigned k = 0; k < G_N_ELEMENTS(explicit_kinds); k++)
    for (double link = 1e2; link < 1e9; link *= 1e3) {
      double most = 0, drift = 0, both_implicit = 0;
      static const double products[] = {0.5, 1.5, 2.5, 3, G_PI, 3.3, 4.5, 6};
      for (unsigned i = 0; i < G_N_ELEMENTS(products); i++) {
        /* A chain of three has w^2 = 3 k / m along itself. */
        double h = 2e-3, w = products[i] / h, stiffness = 0.1 / 3 * w * w;
        Pair pair = {
            {explicit_kinds[k], SPORE_INTEGRATOR_IMPLICIT_EULER}, 20, {stiffness, 500}, link, 0, h, {0, 0, 0}, 0};
        most = fmax(most, couple_long(&pair, &drift));
        pair.kinds[0] = SPORE_INTEGRATOR_IMPLICIT_EULER;
        pair.substeps = 1;
        couple_long(&pair, &both_implicit);
      }
      g_test_message(
          "multirate: %s, tie of %.0e N/m: energy at most %+.1e of the start's above it, momentum off by %.1e "
          "(both implicit: %.1e)",
          spore_integrator_names[explicit_kinds[k]], link, most, drift, both_implicit);
      g_assert_cmpfloat(most, <, 0.01);
      g_assert_cmpfloat(drift, <, fmax(1e-8, 1e-11 * link));
    }
}

/* Hanging together they come to rest where statics has them: static beside moving, and explicit beside implicit but for
 * h^2 a / 2 in the spring that ties them, a = 3 g being what it gives the particle that carries two others. */
static void test_multirate_rest(void) {
  static const struct {
    SporeIntegratorKind kinds[2];
    size_t substeps;
  } cases[] = {{{SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_STATIC}, 1},
               {{SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_STATIC}, 10},
               {{SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_IMPLICIT_EULER}, 10}};
  double exact[18], q[18], h = 5e-3;
  Pair pair = {{SPORE_INTEGRATOR_STATIC, SPORE_INTEGRATOR_STATIC}, 1, {400, 400}, 300, 0, h, {0, -9.81, 0}, 0.5};
  couple_to(&pair, 20 * h, exact);
  for (unsigned i = 0; i < G_N_ELEMENTS(cases); i++) {
    memcpy(pair.kinds, cases[i].kinds, sizeof pair.kinds);
    pair.substeps = cases[i].substeps;
    pair.damping = 2;
    couple_to(&pair, 30, q);
    double off = distance(q, exact, 18) / sqrt(6);
    g_test_message("multirate rest: %s under %s: %.1e m from the balance", spore_integrator_names[pair.kinds[0]],
                   spore_integrator_names[pair.kinds[1]], off);
    bool apart = !spore_integrator(pair.kinds[0])->implicit;
    g_assert_cmpfloat(off, <, apart ? 1.1 * h * h * 3 * 9.81 / 2 : 1e-5);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/integrate/order", test_order);
  g_test_add_func("/integrate/substeps", test_substeps);
  g_test_add_func("/integrate/energy", test_energy);
  g_test_add_func("/integrate/stiff", test_stiff);
  g_test_add_func("/integrate/error-control", test_error_control);
  g_test_add_func("/integrate/cost", test_cost);
  g_test_add_func("/integrate/restart", test_restart);
  g_test_add_func("/integrate/limits", test_limits);
  g_test_add_func("/integrate/static", test_static);
  g_test_add_func("/integrate/static-unheld", test_static_unheld);
  g_test_add_func("/integrate/multirate-order", test_multirate_order);
  g_test_add_func("/integrate/multirate-stiff", test_multirate_stiff);
  g_test_add_func("/integrate/multirate-rest", test_multirate_rest);
  return g_test_run();
}
