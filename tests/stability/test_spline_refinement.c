/* Spline refinement: control points of a thread are inserted and removed while it runs. */
#include <math.h>
#include <string.h>

#include "core/body/path.h"
#include "core/base/memory.h"
#include "core/body/momentum.h"
#include "core/sim/world_private.h"
#include "tests/stability/rig.h"

#define DENSITY 1000.
#define RADIUS 5e-4

/* Straight, along x from 0. */
static SporeCurve straight(double length) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 30, NULL));
  for (int i = 0; i < 30; i++) memcpy(curve.points + 4 * i, (double[4]){length * i / 29, 0, 0, RADIUS}, 32);
  return curve;
}

static SporeModel *thread(double points, double most_bend, double maximum, double twist, double turns) {
  SporeCurve curve = straight(0.1);
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", points, "most_bend", most_bend,
                         "maximum_control_points", maximum, "young_modulus", 1e6, "density", DENSITY, "damping", 0.005,
                         "twist_modulus", twist, "turns", turns, NULL);
}

/* A hook of this radius in the middle of so many control points that were straight, and a velocity that varies. */
static void bend(const SporeModel *model, double radius, double *q, double *v) {
  model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
  double arc = G_PI * radius, start = 0.05 - 0.5 * arc;
  for (size_t i = 0; i < model->node_count; i++) { /* arms go with what they stand on, and turn a little on the way */
    double s = q[3 * i], angle = fmin(fmax((s - start) / radius, 0), G_PI);
    double behind = fmax(s - start - arc, 0);
    SporeVec3 aside = spore_vec3(0, q[3 * i + 1], q[3 * i + 2]);
    double near = aside.y; /* the inner side of the bend */
    q[3 * i] = fmin(s, start) + (radius - near) * sin(angle) - behind;
    q[3 * i + 1] = radius - (radius - near) * cos(angle);
    q[3 * i + 2] = 0.002 * sin(90 * s) + aside.z;
    spore_vec3_store(v + 3 * i, spore_vec3(0.3 + 2 * q[3 * i + 1], 0.2 * cos(60 * s), 1.5 * s));
  }
}

typedef struct State {
  SporeModel *model;
  double *q, *v;
} State;

static State state_new(SporeModel *model, double radius) {
  State state = {model, g_new0(double, model->q_room), g_new0(double, 3 * model->block_room)};
  bend(model, radius, state.q, state.v);
  return state;
}

static void state_free(State *state) {
  state->model->type->destroy(state->model);
  g_free(state->q);
  g_free(state->v);
}

/* Places along the line, or speeds there. */
#define PLACES 1001
static double *along(const State *state, const double *x) {
  SporeSplineKnots knots = state->model->type->line->path(state->model);
  double *places = g_new(double, 3 * PLACES);
  for (int i = 0; i < PLACES; i++)
    spore_vec3_store(places + 3 * i, spore_path_at(knots, x, spore_spline_end(knots) * i / (PLACES - 1)).position);
  return places;
}

static double apart(const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < PLACES; i++)
    most = fmax(most, spore_vec3_distance(spore_vec3_load(a + 3 * i), spore_vec3_load(b + 3 * i)));
  return most;
}

static SporeVec3 momentum(const State *state) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < state->model->node_count; i++)
    sum = spore_vec3_add_scaled(sum, state->model->block_mass[i], spore_vec3_load(state->v + 3 * i));
  return sum;
}

static double kinetic(const State *state) {
  double sum = 0;
  for (size_t i = 0; i < 3 * state->model->node_count; i++)
    sum += 0.5 * state->model->block_mass[i / 3] * state->v[i] * state->v[i];
  return sum;
}

/* Line, velocity, mass and momentum are the same to rounding when knots come; kinetic energy loses what lumping the
 * mass added to it. They go again where it is straight, and then it is as it was made. */
static void insert(double twist, double turns) {
  State state = state_new(thread(12, 0.4, 60, twist, turns), 0.012);
  SporeModel *model = state.model;
  for (int round = 0; round < 8; round++) {
    double *line = along(&state, state.q), *speed = along(&state, state.v);
    double mass = spore_model_total_mass(model), before = kinetic(&state);
    double strain = model->type->potential(model, state.q);
    SporeVec3 p = momentum(&state);
    size_t count = model->node_count;
    bool changes = model->type->adapt->weigh_nodes(model, 1e-3, state.q, NULL);
    if (changes) model->type->adapt->change_nodes(model, state.q, state.v, NULL);
    double *line_now = along(&state, state.q), *speed_now = along(&state, state.v);
    double moved = apart(line, line_now), turned = apart(speed, speed_now);
    double missed = spore_vec3_distance(p, momentum(&state)) / spore_vec3_length(p);
    double lost = 1 - kinetic(&state) / before, heavier = spore_model_total_mass(model) / mass - 1;
    double strained = model->type->potential(model, state.q) - strain;
    g_test_message(
        "%zu to %zu control points: line %.0e m, velocity %.0e m/s, mass %.0e, momentum %.0e; kinetic energy "
        "less by %.1e of it, strain energy more by %.1e of %.1e J",
        count, model->node_count, moved, turned, heavier, missed, lost, strained, strain);
    g_assert_cmpfloat(moved, <, 1e-16);
    g_assert_cmpfloat(turned, <, 1e-15);
    g_assert_cmpfloat(fabs(heavier), <, 1e-14);
    /* A new arm takes mass from its neighbours that moves with it: the world makes up for what that misses. */
    g_assert_cmpfloat(missed, <, twist> 0 ? 1e-5 : 1e-14);
    g_assert_cmpfloat(lost, >, -1e-14);
    g_assert_cmpfloat(lost, <, 0.01);
    g_free(line), g_free(speed), g_free(line_now), g_free(speed_now);
    if (!changes) break;
    g_assert_cmpuint(round, <, 7);
    g_assert_cmpuint(model->node_count, >, count);
  }
  g_assert_cmpuint(model->node_count, >, 16);
  state_free(&state);
}

static void test_insertion(void) { insert(0, 0); }
static void test_twisted(void) { insert(3e5, 0.7); }

/* Where it is straight again, they go one by one, and the line moves by less than a twentieth of its radius each. */
static void test_removal(void) {
  const double twist = 0, turns = 0;
  State state = state_new(thread(12, 0.4, 60, twist, turns), 0.012);
  SporeModel *model = state.model;
  while (model->type->adapt->weigh_nodes(model, 1e-3, state.q, NULL))
    model->type->adapt->change_nodes(model, state.q, state.v, NULL);
  size_t most = model->node_count;
  double worst = 0, mass = spore_model_total_mass(model);
  SporeSplineKnots knots = model->type->line->path(model);
  for (size_t i = 0; i < most; i++) { /* a bow, no longer a hook */
    double mean = 0;                  /* of the knots that the point is led by, where it stands on a straight line */
    for (size_t k = 0; k < 3; k++)
      mean += spore_spline_break(knots, MIN(i + k < 2 ? 0 : i + k - 2, knots.span_count)) / 3;
    double s = 0.1 * mean / spore_spline_end(knots);
    spore_vec3_store(state.q + 3 * i, spore_vec3(s, 2 * s * (0.1 - s), 2e-5 * sin(200 * s)));
  }
  for (int i = 0; i < 200 && model->node_count > 12; i++) {
    double *line = along(&state, state.q);
    if (model->type->adapt->weigh_nodes(model, 0.05, state.q, NULL)) {
      g_assert_cmpint(i, >=, 4);
      model->type->adapt->change_nodes(model, state.q, state.v, NULL);
    }
    double *now = along(&state, state.q);
    worst = fmax(worst, apart(line, now));
    g_free(line), g_free(now);
  }
  g_test_message("%zu to %zu control points; moved by %.1e m at most; mass %.0e", most, model->node_count, worst,
                 spore_model_total_mass(model) / mass - 1);
  g_assert_cmpuint(model->node_count, ==, 12);
  g_assert_cmpfloat(worst, <, 0.05 * RADIUS);
  g_assert_cmpfloat(worst, >, 0);
  g_assert_cmpfloat(fabs(spore_model_total_mass(model) / mass - 1), <, 1e-14);
  state_free(&state);
}

/* Half around a pulley, and down on either side. */
#define LENGTH 0.12
static double pulley_radius;

static SporeVec3 over_pulley(double t) {
  double arc = G_PI * pulley_radius, up = 0.5 * (LENGTH - arc), s = t * LENGTH;
  if (s < up) return spore_vec3(-pulley_radius, s - up, 0);
  if (s > up + arc) return spore_vec3(pulley_radius, up + arc - s, 0);
  double angle = (s - up) / pulley_radius;
  return spore_vec3(-pulley_radius * cos(angle), pulley_radius * sin(angle), 0);
}

static SporeModel *pulley_thread(double points, double most_bend, double maximum) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 400, NULL));
  for (int i = 0; i < 400; i++) {
    spore_vec3_store(curve.points + 4 * i, over_pulley(i / 399.));
    curve.points[4 * i + 3] = RADIUS;
  }
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", points, "most_bend", most_bend,
                         "maximum_control_points", maximum, "young_modulus", 1e8, "density", 100., "bending_scale",
                         0.005, "straight_at_rest", 1.0, "damping", 0.01, NULL);
}

static SporeModel *box(double mass) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.002, 0.002, 0.002));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", mass, NULL);
}

typedef struct Fall {
  double fallen; /* of what a pulley without friction lets fall */
  SporeLineState line;
  uint64_t unsolved;
  gboolean told;
} Fall;

/* Two weights on a thread through rings that stand around half a small pulley. */
static Fall run_fall(double points, double most_bend, double maximum) {
  const double heavy = 0.012, light = 0.008, time_s = 0.15;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = SPORE_INTEGRATOR_TR_BDF2;
  rig->description.solver.time_step = 1e-3;
  rig_passive(rig, "thread", pulley_thread(points, most_bend, maximum), NULL);
  rig_passive(rig, "light", box(light), NULL)->pose.position = over_pulley(0);
  rig_passive(rig, "heavy", box(heavy), NULL)->pose.position = over_pulley(1);
  rig_link(rig, "knot 1", &spore_link_ball, 1, 0, over_pulley(0));
  rig_link(rig, "knot 2", &spore_link_ball, 2, 0, over_pulley(1));
  double share = G_PI * pulley_radius / LENGTH;
  for (int i = 0; i < 7; i++)
    rig_link(rig, "ring", &spore_link_port, 0, SPORE_NO_BODY, over_pulley(0.5 + share * (i / 6. - 0.5)));
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(time_s / 1e-3));
  double mass = G_PI * RADIUS * RADIUS * LENGTH * 100;
  double exact = 0.5 * time_s * time_s * (heavy - light) * 9.81 / (heavy + light + mass);
  Fall fall = {.fallen = (over_pulley(1).y - spore_world_q(world, 2)[1]) / exact,
               .unsolved = spore_world_monitor(world)->not_converged,
               .told = rig_said(world, "ring: ")};
  spore_world_line_state(world, 0, &fall.line);
  g_test_message(
      "%g control points, most_bend %g: falls %.4f of the way; %zu at the start, %zu at the end, %zu at most, "
      "+%llu -%llu; %llu unsolved; %s",
      points, most_bend, fall.fallen, fall.line.made, fall.line.points, fall.line.peak,
      (unsigned long long)fall.line.inserted, (unsigned long long)fall.line.removed, (unsigned long long)fall.unsolved,
      rig_last_message(world));
  rig_free(rig);
  return fall;
}

/* A thread that is too coarse for the pulley sticks, and that is said; with points that come where it bends, of which
 * it has no more in all, it slides, and better than with as many that are even. Where there are to be no more, it says
 * so. */
static void test_pulley(void) {
  pulley_radius = 0.004;
  Fall coarse = run_fall(20, 0, 1000), even = run_fall(64, 0, 1000), fine = run_fall(96, 0, 1000);
  Fall coming = run_fall(20, 0.35, 64), spent = run_fall(20, 0.35, 36);
  g_assert_cmpfloat(coarse.fallen, <, 0.05);
  g_assert_true(coarse.told);
  g_assert_cmpfloat(fine.fallen, >, 0.9);
  g_assert_false(fine.told);
  g_assert_cmpuint(coming.line.peak, <=, 64);
  g_assert_cmpuint(coming.line.inserted, >, 10);
  g_assert_cmpfloat(coming.fallen, >, even.fallen + 0.1);
  g_assert_false(coming.told);
  g_assert_cmpuint(spent.line.peak, ==, 36);
  g_assert_cmpfloat(spent.fallen, <, coming.fallen);
  g_assert_true(spent.told);
  g_assert_true(run_fall(20, 0.9, 64).told); /* its most_bend is too large for that */
}

/* A free thread, straight at rest, bent by hand and thrown. */
static SporeWorld *thrown(Rig **rig, double most_bend, double twist) {
  *rig = rig_new();
  (*rig)->description.solver.time_step = 1e-3;
  (*rig)->description.solver.integrator = SPORE_INTEGRATOR_TR_BDF2;
  (*rig)->description.solver.tolerance = 1e-10;
  rig_passive(*rig, "thread", thread(12, most_bend, 60, twist, twist > 0 ? 0.5 : 0), NULL);
  SporeWorld *world = rig_build(*rig);
  const SporeModel *model = world->bodies[0].model;
  double *q = g_new(double, model->q_count), *v = g_new(double, model->q_count);
  bend(model, 0.008, q, v);
  spore_world_set_state(world, 0, q, v);
  g_free(q), g_free(v);
  return world;
}

static SporeMotion motion(const SporeWorld *world) {
  const SporeVec3 origin = {0, 0, 0};
  const SporeBody *body = &world->bodies[0];
  return spore_model_motion(body->model, world->state.q + body->q_offset, world->state.v + body->v_offset, &origin);
}

/* Beside a twin that takes the same step and keeps its points: both momenta are the same to rounding, and the kinetic
 * energy is no more. It straightens, and then it has the points that it was made with. */
static void fly(double twist) {
  Rig *rig, *twin_rig;
  SporeWorld *world = thrown(&rig, 0.4, twist), *twin = thrown(&twin_rig, 3, twist);
  SporeLineState line;
  spore_world_step(world), spore_world_step(twin);
  SporeMotion now = motion(world), whole = motion(twin);
  spore_world_line_state(world, 0, &line);
  double linear = spore_vec3_distance(now.momentum, whole.momentum) / spore_vec3_length(whole.momentum);
  double angular = spore_vec3_distance(now.angular, whole.angular) / spore_vec3_length(whole.angular);
  g_test_message("%zu to %zu points: momentum to %.0e, angular to %.0e; kinetic energy %.2e less", line.made,
                 line.points, linear, angular, 1 - now.kinetic / whole.kinetic);
  g_assert_cmpuint(line.inserted, >, 2);
  g_assert_cmpfloat(linear, <, 1e-14);
  g_assert_cmpfloat(angular, <, 1e-13);
  g_assert_cmpfloat(now.kinetic, <=, whole.kinetic * (1 + 1e-14));
  double energy = rig_energy(world), most = energy;
  for (int i = 0; i < 12000 && line.points > line.made; i++) {
    spore_world_step(world);
    spore_world_tidy(world);
    spore_world_line_state(world, 0, &line);
    if (i % 50 == 0) most = fmax(most, rig_energy(world));
  }
  SporeMotion end = motion(world);
  linear = spore_vec3_distance(end.momentum, whole.momentum) / spore_vec3_length(whole.momentum);
  angular = spore_vec3_distance(end.angular, whole.angular) / spore_vec3_length(whole.angular);
  g_test_message(
      "after %.1f s: %zu points, %zu at most, +%llu -%llu; momentum to %.0e, angular to %.0e; energy %.4e to "
      "%.4e J, %.4e at most; %llu unsolved",
      spore_world_time_s(world), line.points, line.peak, (unsigned long long)line.inserted,
      (unsigned long long)line.removed, linear, angular, energy, rig_energy(world), most,
      (unsigned long long)spore_world_monitor(world)->not_converged);
  g_assert_cmpuint(line.points, ==, line.made);
  g_assert_cmpfloat(linear, <, 1e-9); /* what the equations are solved to, over thousands of steps */
  g_assert_cmpfloat(most, <, energy * 1.01);
  g_assert_cmpuint(spore_world_monitor(world)->not_converged, ==, 0);
  rig_free(rig), rig_free(twin_rig);
}

static void test_momentum(void) { fly(0); }
static void test_twisted_momentum(void) { fly(3e5); }

/* The same bits again after a reset; and what goes moves the line by no more than is said. */
static void test_repeats(void) {
  const double twist = 0;
  Rig *rig;
  SporeWorld *world = thrown(&rig, 0.4, twist);
  uint64_t hash[2], steps = 2200;
  const SporeModel *model = world->bodies[0].model;
  double *q = g_new(double, model->q_count), *v = g_new(double, model->q_count);
  bend(model, 0.008, q, v);
  for (int run = 0; run < 2; run++) {
    if (run > 0) {
      spore_world_reset(world);
      spore_world_set_state(world, 0, q, v);
    }
    uint64_t before = spore_allocation_count();
    for (uint64_t i = 0; i < steps; i++) spore_world_step(world);
    g_assert_cmpuint(spore_allocation_count(), ==, before);
    hash[run] = spore_world_hash(world);
    SporeLineState line;
    spore_world_line_state(world, 0, &line);
    g_test_message("+%llu -%llu", (unsigned long long)line.inserted, (unsigned long long)line.removed);
    g_assert_cmpuint(line.removed, >, 0);
  }
  g_assert_cmpuint(hash[0], ==, hash[1]);
  g_free(q), g_free(v);
  rig_free(rig);
}

/* A thread lies over a thin bar, held at one end; a bead runs on it, and a weight hangs at its other end. */
static Rig *draped(double twist) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 2e-3;
  SporeModel *model = thread(12, 0.3, 50, twist, 0);
  SporeSphereSet own;
  g_assert_true(model->type->spheres(model, &own, NULL));
  double *points = g_new(double, 3 * own.count);
  for (size_t i = 0; i < own.count; i++) memcpy(points + 3 * i, own.spheres + 4 * i, 3 * sizeof *points);
  rig_passive(rig, "thread", model, rig_spheres(rig, points, own.count, RADIUS))->contact.stiffness = 500;
  double bar[3 * 41];
  for (int i = 0; i < 41; i++) spore_vec3_store(bar + 3 * i, spore_vec3(0.03, -0.0026, 5e-4 * (i - 20)));
  rig_unmovable(rig, "bar", rig_spheres(rig, bar, 41, 0.002))->contact.stiffness = 500;
  rig_passive(rig, "bead", box(1e-5), NULL)->pose.position = spore_vec3(0.06, 0, 0);
  rig_passive(rig, "weight", box(2e-4), NULL)->pose.position = spore_vec3(0.1, 0, 0);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-4);
  rig_link(rig, "bead", &spore_link_slide, 2, 0, spore_vec3(0.06, 0, 0));
  rig_link(rig, "weight", &spore_link_ball, 3, 0, spore_vec3(0.1, 0, 0));
  spore_sphere_set_clear(&own);
  g_free(points);
  return rig;
}

/* Spheres, links, a slide, a pin and what a viewer maps go with the line, whose knots come and go. */
static void follow(double twist) {
  Rig *rig = draped(twist);
  SporeWorld *world = rig_build(rig);
  const SporeBody *body = &world->bodies[0];
  SporeMapping seen;
  size_t count = body->collision.spheres.point_count;
  double *parameter = g_new(double, count), *shown = g_new(double, 3 * count), most = 0, beside = 0, drift = 0;
  double *rest = g_new(double, 3 * count);
  SporeSplineKnots knots = body->model->type->line->path(body->model);
  for (size_t i = 0; i < count; i++) {
    SporeVec3 at = spore_mapping_position(&body->collision.spheres, i, world->state.q + body->q_offset);
    parameter[i] = spore_path_seek(knots, world->state.q + body->q_offset, NULL, at).parameter;
    spore_vec3_store(rest + 3 * i, at);
  }
  g_assert_true(spore_world_map(world, 0, rest, count, &seen, NULL));
  for (int step = 0; step < 400; step++) {
    spore_world_step(world);
    spore_world_tidy(world);
    const double *q = world->state.q + body->q_offset;
    const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
    g_assert_true(spore_world_follow_knots(world, 0, spore_snapshot_knots(world, snapshot, 0), &seen));
    spore_mapping_positions(&seen, snapshot->q + spore_world_q_offset(world, 0), shown);
    knots = body->model->type->line->path(body->model);
    for (size_t i = 0; i < count; i++) {
      SporeVec3 at = spore_mapping_position(&body->collision.spheres, i, q),
                line = spore_path_at(knots, q, parameter[i]).position;
      most = fmax(most, spore_vec3_distance(at, line));
      beside = fmax(beside, spore_vec3_distance(at, spore_vec3_load(shown + 3 * i)));
    }
    for (size_t i = 0; i < 2; i++) drift = fmax(drift, spore_world_link_state(world, i).drift);
    g_assert_cmpfloat(spore_vec3_length(spore_vec3_load(q)), <, 1e-16); /* the pin */
    g_assert_cmpfloat(spore_world_link_state(world, 0).along, >, 0.3);
  }
  SporeLineState line;
  spore_world_line_state(world, 0, &line);
  g_test_message(
      "%zu to %zu control points, %zu at most, +%llu -%llu: spheres %.0e m off the line, what is shown %.0e m "
      "off them; links drift by %.1e m; %llu unsolved",
      line.made, line.points, line.peak, (unsigned long long)line.inserted, (unsigned long long)line.removed, most,
      beside, drift, (unsigned long long)spore_world_monitor(world)->not_converged);
  g_assert_cmpuint(line.inserted, >, 4);
  g_assert_cmpfloat(most, <, 1e-15);
  g_assert_cmpfloat(beside, <, 1e-15);
  g_assert_cmpfloat(drift, <, 1e-4);
  spore_mapping_clear(&seen);
  g_free(parameter), g_free(shown), g_free(rest);
  rig_free(rig);
}

/* What blood may stain goes with a line that carries what lies beside it: each place stays beside its sphere while
 * control points come. */
static void test_stained(void) {
  Rig *rig = draped(3e5);
  SporeTriangleMesh cube;
  SporeSphereSet drops;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.004, 0.004, 0.004));
  SporeModel *blood = rig_fluid_model(&cube, 20, NULL);
  g_assert_true(blood->type->spheres(blood, &drops, NULL));
  SporeBodyDescription *far = rig_passive(rig, "blood", blood, &drops);
  far->effect = true;
  far->pose.position = spore_vec3(1, 0, 0);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 200);
  const SporeBody *body = &world->bodies[0];
  const SporeStainUnit *unit = &world->stains.units[0];
  const double *q = world->state.q + body->q_offset;
  double off = 0;
  for (size_t s = 0; s < body->collision.spheres.point_count; s++)
    for (size_t i = unit->first[s]; i < unit->first[s + 1]; i++)
      off = fmax(off, spore_vec3_distance(spore_mapping_position(&unit->mapping, i, q),
                                          spore_mapping_position(&body->collision.spheres, s, q)));
  SporeLineState line;
  spore_world_line_state(world, 0, &line);
  g_test_message("%zu places are at most %.1e m from their spheres; +%llu control points", unit->count, off,
                 (unsigned long long)line.inserted);
  g_assert_cmpuint(unit->count, >, 100);
  g_assert_cmpuint(line.inserted, >, 4);
  g_assert_cmpfloat(off, <, 1.5 * RADIUS);
  spore_sphere_set_clear(&drops);
  rig_free(rig);
}

static void test_follow(void) { follow(0); }
static void test_follow_twisted(void) { follow(3e5); }

/* Somebody pulls at a thread whose points come and go: the pull keeps to where it took hold, and lets go. */
static void test_pulled(void) {
  Rig *rig = draped(0);
  SporeWorld *world = rig_build(rig);
  SporeCommand pull = {.kind = SPORE_COMMAND_PULL, .body = 0, .point = {0.06, 0, 0}, .number = 5};
  SporeLineState line, before = {0};
  double moved = 0;
  for (int step = 0; step < 400; step++) {
    SporeVec3 now, then;
    pull.vector = spore_vec3(0.06 - 5e-5 * step, 1e-4 * step, 0.01);
    g_assert_true(spore_world_post(world, &pull));
    bool held = spore_world_pulled_point(world, 0, &then);
    spore_world_step(world);
    g_assert_true(spore_world_pulled_point(world, 0, &now));
    spore_world_line_state(world, 0, &line);
    bool changed = line.inserted + line.removed > before.inserted + before.removed;
    if (held && changed) moved = fmax(moved, spore_vec3_distance(now, then));
    before = line;
  }
  pull.kind = SPORE_COMMAND_RELEASE;
  g_assert_true(spore_world_post(world, &pull));
  rig_run(world, 50);
  g_test_message("%zu to %zu control points, +%llu -%llu; the pull moves by %.1e m at most where they change",
                 line.made, line.points, (unsigned long long)line.inserted, (unsigned long long)line.removed, moved);
  g_assert_cmpuint(line.inserted, >, 4);
  g_assert_cmpfloat(moved, <, 0.1 / 9); /* a span of the line as it was made */
  g_assert_true(rig_finite(world));
  g_assert_cmpuint(world->links.pull_count, ==, 0);
  rig_free(rig);
}

/* With one thread and with three. */
static void test_threads(void) {
  uint64_t hash[2];
  for (int i = 0; i < 2; i++) {
    Rig *rig = draped(0);
    SporePool *pool = spore_pool_create(i ? 3 : 1);
    rig_build_on(rig, pool);
    for (int step = 0; step < 300; step++) spore_world_step(rig->world);
    hash[i] = spore_world_hash(rig->world);
    SporeLineState line;
    g_assert_true(spore_world_line_state(rig->world, 0, &line));
    g_assert_cmpuint(line.inserted, >, 4);
    rig_free(rig);
    spore_pool_free(pool);
  }
  g_assert_cmpuint(hash[0], ==, hash[1]);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/spline_refinement/insertion", test_insertion);
  g_test_add_func("/spline_refinement/twisted", test_twisted);
  g_test_add_func("/spline_refinement/removal", test_removal);
  g_test_add_func("/spline_refinement/pulley", test_pulley);
  g_test_add_func("/spline_refinement/momentum", test_momentum);
  g_test_add_func("/spline_refinement/twisted-momentum", test_twisted_momentum);
  g_test_add_func("/spline_refinement/repeats", test_repeats);
  g_test_add_func("/spline_refinement/follow", test_follow);
  g_test_add_func("/spline_refinement/stained", test_stained);
  g_test_add_func("/spline_refinement/follow-twisted", test_follow_twisted);
  g_test_add_func("/spline_refinement/pulled", test_pulled);
  g_test_add_func("/spline_refinement/threads", test_threads);
  return g_test_run();
}
