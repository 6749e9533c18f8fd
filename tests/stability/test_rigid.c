/* Rigid bodies that turn freely, against the closed solution: cases 25 and 26. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

/* Jacobi's sn, cn, dn of u with modulus squared m in [0, 1), by the descending Landen transformation (Abramowitz and
 * Stegun 16.4); *quarter gets the complete integral K. */
static void jacobi(double u, double m, double *sn, double *cn, double *dn, double *quarter) {
  double a[16], c[16], b = sqrt(1 - m);
  int n = 0;
  a[0] = 1, c[0] = sqrt(m);
  while (fabs(c[n]) > 1e-17 && n < 15) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = sqrt(a[n] * b);
    n++;
  }
  double phi = ldexp(a[n] * u, n), before = phi;
  *quarter = G_PI / (2 * a[n]);
  for (; n > 0; n--) {
    before = phi;
    phi = 0.5 * (phi + asin(c[n] / a[n] * sin(phi)));
  }
  *sn = sin(phi);
  *cn = cos(phi);
  *dn = fabs(cos(before - phi)) > 0.1 ? cos(phi) / cos(before - phi) : sqrt(1 - m * *sn * *sn);
}

typedef struct Top {
  double inertia[3]; /* ascending */
  double a, b, c, p, m;
  gboolean swapped; /* about the axis of the largest moment: cn and dn change places */
} Top;

/* numerics.md: w(t) = (a dn, b sn, c cn)(p t), or with cn and dn exchanged, from w with w2 = 0. */
static Top top_solve(const double inertia[3], double w1, double w3) {
  double i1 = inertia[0], i2 = inertia[1], i3 = inertia[2];
  double t2 = i1 * w1 * w1 + i3 * w3 * w3, g = i1 * i1 * w1 * w1 + i3 * i3 * w3 * w3;
  Top top = {.inertia = {i1, i2, i3}, .swapped = g >= t2 * i2};
  top.a = sqrt((t2 * i3 - g) / (i1 * (i3 - i1)));
  top.c = sqrt((g - t2 * i1) / (i3 * (i3 - i1)));
  if (!top.swapped) {
    top.b = sqrt((g - t2 * i1) / (i2 * (i2 - i1)));
    top.p = sqrt((i2 - i1) * (t2 * i3 - g) / (i1 * i2 * i3));
    top.m = (i3 - i2) * (g - t2 * i1) / ((i2 - i1) * (t2 * i3 - g));
  } else {
    top.b = sqrt((t2 * i3 - g) / (i2 * (i3 - i2)));
    top.p = sqrt((i3 - i2) * (g - t2 * i1) / (i1 * i2 * i3));
    top.m = (i2 - i1) * (t2 * i3 - g) / ((i3 - i2) * (g - t2 * i1));
  }
  return top;
}

static SporeVec3 top_spin(const Top *top, double t, double *quarter) {
  double sn, cn, dn;
  jacobi(top->p * t, top->m, &sn, &cn, &dn, quarter);
  /* The sign of the middle axis follows from Euler's equations: i2 w2' = (i3 - i1) w3 w1 > 0. */
  return top->swapped ? spore_vec3(top->a * cn, top->b * sn, top->c * dn)
                      : spore_vec3(top->a * dn, top->b * sn, top->c * cn);
}

/* A box with principal axes along x, y, z and the moments ascending in that order. */
static SporeModel *box(double x, double y, double z, double inertia[3]) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(x, y, z));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &mesh, "mass", 1.0, NULL);
  inertia[0] = (y * y + z * z) / 12;
  inertia[1] = (x * x + z * z) / 12;
  inertia[2] = (x * x + y * y) / 12;
  return model;
}

static SporeVec3 body_spin(const SporeWorld *world) {
  const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
  return spore_quat_rotate(spore_quat_conjugate(spore_quat_load(q + 3)), spore_vec3_load(v + 3));
}

static SporeVec3 angular_momentum(const SporeWorld *world, const double inertia[3]) {
  SporeVec3 w = body_spin(world), l = {inertia[0] * w.x, inertia[1] * w.y, inertia[2] * w.z};
  return spore_quat_rotate(spore_quat_load(spore_world_q(world, 0) + 3), l);
}

static SporeWorld *spinning(Rig *rig, SporeModel *model, SporeVec3 spin, double h, SporeIntegratorKind kind) {
  rig->description.solver.time_step = h;
  SporeBodyDescription *body = rig_passive(rig, "top", model, NULL);
  body->spin = spin;
  body->integrator = kind;
  return rig_build(rig);
}

/* Mass, centre and inertia of a box that lies off its frame's origin, turned. */
static void inertia_of_box(void) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(3, -2, 5), spore_vec3(0.1, 0.2, 0.3));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &mesh, "density", 1000.0, NULL);
  double q[7], v[6], blocks[18], expected[3] = {6 * 0.13 / 12, 6 * 0.10 / 12, 6 * 0.05 / 12}, worst = 0;
  model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
  spore_model_mass(model, q, blocks);
  for (int i = 0; i < 9; i++) worst = fmax(worst, fabs(blocks[9 + i] - (i % 4 ? 0 : expected[i / 4])));
  g_test_message("box: mass %.17g kg of 6, inertia off by %.1e kg m^2, centre (%g %g %g)", blocks[0], worst, q[0], q[1],
                 q[2]);
  g_assert_cmpfloat(fabs(blocks[0] - 6), <, 1e-12);
  g_assert_cmpfloat(worst, <, 1e-13);
  g_assert_cmpfloat(spore_vec3_distance(spore_vec3_load(q), spore_vec3(3, -2, 5)), <, 1e-13);
  model->type->destroy(model);
}

/* The whole path of the spin against the elliptic solution, about the axis of the smallest and of the largest moment.
 */
static void elliptic(void) {
  for (int swapped = 0; swapped < 2; swapped++)
    for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < SPORE_INTEGRATOR_STATIC; kind++) {
      double inertia[3], w1 = swapped ? 2 : 9, w3 = swapped ? 8 : 3, worst = 0, quarter, energy, h = 2e-3;
      SporeModel *model = box(0.3, 0.2, 0.1, inertia);
      Top top = top_solve(inertia, w1, w3);
      Rig *rig = rig_new();
      SporeWorld *world = spinning(rig, model, spore_vec3(w1, 0, w3), h, kind);
      energy = rig_energy(world);
      SporeVec3 momentum = angular_momentum(world, inertia);
      for (int i = 1; i <= 5000; i++) {
        spore_world_step(world);
        worst = fmax(worst, spore_vec3_distance(body_spin(world), top_spin(&top, i * h, &quarter)));
      }
      double lost = spore_vec3_distance(momentum, angular_momentum(world, inertia)) / spore_vec3_length(momentum);
      g_test_message(
          "free top, %s axis, %s: 10 s, %.1f periods: spin off by %.2e rad/s of %.1f, energy by %.1e, angular "
          "momentum by %.1e",
          swapped ? "large" : "small", spore_integrator_names[kind], 10 * top.p / (4 * quarter), worst, hypot(w1, w3),
          rig_energy(world) / energy - 1, lost);
      g_assert_true(top.swapped == swapped);
      g_assert_cmpfloat(worst, <, 1e-4);
      g_assert_cmpfloat(lost, <, 1e-12);
      rig_free(rig);
    }
}

/* The spin at t and the orientation that it leads to from none, by Runge and Kutta's method in steps of a tenth of a
 * millisecond, which errs by 1e-11 here. */
static SporeQuat turned_by(const Top *top, SporeQuat q, double t, double h) {
  double quarter;
  SporeQuat sum = q, at = q;
  for (int stage = 0; stage < 4; stage++) {
    SporeVec3 spin = top_spin(top, t + (stage == 0 ? 0 : stage < 3 ? 0.5 * h : h), &quarter);
    SporeQuat rate = spore_quat_multiply(at, (SporeQuat){0, 0.5 * spin.x, 0.5 * spin.y, 0.5 * spin.z});
    double weight = h * (stage == 0 || stage == 3 ? 1 : 2) / 6, next = stage < 2 ? 0.5 * h : h;
    sum =
        (SporeQuat){sum.w + weight * rate.w, sum.x + weight * rate.x, sum.y + weight * rate.y, sum.z + weight * rate.z};
    at = (SporeQuat){q.w + next * rate.w, q.x + next * rate.x, q.y + next * rate.y, q.z + next * rate.z};
  }
  return spore_quat_normalise(sum);
}

/* A hundred periods at 10 ms of a box that lies askew in its frame, so that its inertia has products: spin and
 * orientation to 1e-9 (rad, and of the spin), angular momentum to 1e-12. */
static void hundred_periods(void) {
  const double h = 0.01, fine = 1e-4;
  const SporeQuat askew = spore_quat_normalise((SporeQuat){0.8, 0.3, -0.4, 0.35});
  for (int swapped = 0; swapped < 2; swapped++) {
    double w1 = swapped ? 2 : 9, w3 = swapped ? 8 : 3, quarter, spin_off = 0, lost = 0;
    const double inertia[3] = {(0.2 * 0.2 + 0.1 * 0.1) / 12, (0.3 * 0.3 + 0.1 * 0.1) / 12,
                               (0.3 * 0.3 + 0.2 * 0.2) / 12};
    Top top = top_solve(inertia, w1, w3);
    SporeTriangleMesh mesh;
    shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.3, 0.2, 0.1));
    for (size_t i = 0; i < mesh.vertex_count; i++)
      spore_vec3_store(mesh.vertices + 3 * i, spore_quat_rotate(askew, spore_vec3_load(mesh.vertices + 3 * i)));
    Rig *rig = rig_new();
    SporeModel *model = rig_surface_model(&spore_rigid_body, &mesh, "mass", 1.0, NULL);
    SporeWorld *world =
        spinning(rig, model, spore_quat_rotate(askew, spore_vec3(w1, 0, w3)), h, SPORE_INTEGRATOR_DEFAULT);
    top_spin(&top, 0, &quarter);
    unsigned steps = (unsigned)ceil(100 * 4 * quarter / top.p / h);
    SporeQuat exact = askew, q = askew;
    SporeVec3 momentum = {0, 0, 0};
    for (unsigned i = 0; i <= steps; i++) {
      if (i > 0) spore_world_step(world);
      for (int k = 0; i > 0 && k < 100; k++) exact = turned_by(&top, exact, (i - 1) * h + k * fine, fine);
      q = spore_quat_multiply(spore_quat_load(spore_world_q(world, 0) + 3), askew);
      SporeVec3 w = spore_quat_rotate(spore_quat_conjugate(q), spore_vec3_load(spore_world_v(world, 0) + 3));
      SporeVec3 l = spore_quat_rotate(q, spore_vec3(inertia[0] * w.x, inertia[1] * w.y, inertia[2] * w.z));
      if (i == 0) momentum = l;
      spin_off = fmax(spin_off, spore_vec3_distance(w, top_spin(&top, i * h, &quarter)) / hypot(w1, w3));
      lost = fmax(lost, spore_vec3_distance(l, momentum) / spore_vec3_length(momentum));
    }
    SporeQuat off = spore_quat_multiply(spore_quat_conjugate(exact), q);
    double angle = 2 * asin(fmin(1, spore_vec3_length(spore_vec3(off.x, off.y, off.z))));
    g_test_message("free top askew, %s axis: 100 periods in %u steps of %g s: spin off by %.1e of it, orientation by "
                   "%.1e rad, angular momentum by %.1e of it",
                   swapped ? "large" : "small", steps, h, spin_off, angle, lost);
    g_assert_cmpfloat(spin_off, <, 1e-9);
    g_assert_cmpfloat(angle, <, 1e-9);
    g_assert_cmpfloat(lost, <, 1e-12);
    rig_free(rig);
  }
}

/* Slope of the error of a spinning box that a stiff and damped spring pulls at a corner, as the step is halved: its
 * orientation, position and velocities. What the first order methods claim is checked too. */
static SporeWorld *pulled(Rig *rig, SporeIntegratorKind kind, double h) {
  double inertia[3];
  rig->description.solver.time_step = h;
  rig->description.solver.tolerance = kind == SPORE_INTEGRATOR_STATIC ? 1e-8 : 1e-12;
  rig->description.solver.newton_iterations = 100;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeBodyDescription *body = rig_passive(rig, "top", box(0.3, 0.2, 0.1, inertia), NULL);
  body->spin = spore_vec3(3, 5, -4);
  body->integrator = kind;
  SporeLinkDescription spring = {.name = "spring",
                                 .type = &spore_link_spring,
                                 .body_b = SPORE_NO_BODY,
                                 .point_a = {0.15, 0.1, 0.05},
                                 .point_b = {0.3, 0.4, 0.1},
                                 .stiffness = 30,
                                 .damping = 0.2,
                                 .rest_length = 0.1};
  g_array_append_val(rig->links, spring);
  return rig_build(rig);
}

static void pulled_state(SporeIntegratorKind kind, double h, double *state) {
  Rig *rig = rig_new();
  SporeWorld *world = pulled(rig, kind, h);
  rig_run(world, (unsigned)lround(0.5 / h));
  memcpy(state, spore_world_q(world, 0), 7 * sizeof *state);
  memcpy(state + 7, spore_world_v(world, 0), 6 * sizeof *state);
  rig_free(rig);
}

static void order_of_top(void) {
  static const int orders[SPORE_INTEGRATOR_STATIC] = {[SPORE_INTEGRATOR_EXPLICIT_EULER] = 1,
                                                      [SPORE_INTEGRATOR_SYMPLECTIC_EULER] = 1,
                                                      [SPORE_INTEGRATOR_VERLET] = 2,
                                                      [SPORE_INTEGRATOR_RK4] = 4,
                                                      [SPORE_INTEGRATOR_POSITION_BASED] = 1,
                                                      [SPORE_INTEGRATOR_IMPLICIT_EULER] = 1,
                                                      [SPORE_INTEGRATOR_IMPLICIT_MIDPOINT] = 2,
                                                      [SPORE_INTEGRATOR_BDF2] = 2,
                                                      [SPORE_INTEGRATOR_TR_BDF2] = 2};
  double exact[13], state[13], error[4];
  pulled_state(SPORE_INTEGRATOR_RK4, 1e-5, exact);
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < SPORE_INTEGRATOR_STATIC; kind++) {
    double coarse = orders[kind] == 1 ? 2.5e-4 : orders[kind] == 2 ? 2e-3 : 1e-2, slope = 0;
    for (int level = 0; level < 4; level++) {
      double sum = 0;
      pulled_state(kind, ldexp(coarse, -level), state);
      for (int k = 0; k < 13; k++) sum += (state[k] - exact[k]) * (state[k] - exact[k]);
      error[level] = sqrt(sum);
      slope -= (level - 1.5) / 5 * log2(error[level]);
    }
    g_test_message("pulled top, %s: slope %.3f (off by %.1e at %g s, %.1e at %g s)", spore_integrator_names[kind],
                   slope, error[0], coarse, error[3], coarse / 8);
    g_assert_cmpfloat_with_epsilon(slope, orders[kind], 0.2);
  }
}

/* Hung up at a corner and left to balance: the corner's spring carries the weight, straight above the centre. */
static void balance(void) {
  Rig *rig = rig_new();
  SporeWorld *world = pulled(rig, SPORE_INTEGRATOR_STATIC, 2e-3);
  unsigned iterations = 0;
  for (int i = 0; i < 100; i++) { /* the damper of the spring takes its time */
    spore_world_step(world);
    iterations += (unsigned)spore_world_counts(world).newton_iterations;
  }
  const double *q = spore_world_q(world, 0);
  SporeVec3 corner =
      spore_vec3_add(spore_vec3_load(q), spore_quat_rotate(spore_quat_load(q + 3), spore_vec3(0.15, 0.1, 0.05)));
  SporeVec3 hook = spore_vec3(0.3, 0.4, 0.1);
  double length = 0.1 + 9.81 / 30, lever = sqrt(0.15 * 0.15 + 0.1 * 0.1 + 0.05 * 0.05);
  SporeVec3 lowest = spore_vec3(0.3, 0.4 - length - lever, 0.1);
  g_test_message("static box: spring %.6f m of %.6f m, centre off by %.1e m, %u Newton iterations, %u recoveries",
                 spore_vec3_distance(corner, hook), length, spore_vec3_distance(spore_vec3_load(q), lowest), iterations,
                 (unsigned)spore_world_monitor(world)->recoveries);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(corner, hook), length, 1e-4);
  g_assert_cmpfloat(spore_vec3_distance(spore_vec3_load(q), lowest), <, 1e-4);
  rig_free(rig);
}

static double middle_spin(const double *q, const double *v) {
  return spore_quat_rotate(spore_quat_conjugate(spore_quat_load(q + 3)), spore_vec3_load(v + 3)).y;
}

/* Time from the state (q, v) to the moment within h at which the spin about the middle axis passes 0, by bisection. */
static double time_to_flip(const SporeModel *model, const double *q, const double *v, double h) {
  double low = 0, high = h, start = middle_spin(q, v), q1[7], v1[6];
  for (int i = 0; i < 40; i++) {
    double middle = 0.5 * (low + high);
    model->type->drift(model, q, v, middle, q1, v1);
    if (middle_spin(q1, v1) * start > 0) low = middle;
    else high = middle;
  }
  return low;
}

/* Case 25: 1e3 rad/s about the middle axis, a little off it. The body turns over each half period 2 K / p. */
static void case_25(void) {
  static const double steps[] = {1e-4, 1e-3, 5e-3};
  for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++) {
    double inertia[3], w1 = 1, w2 = 1000, h = steps[s], quarter;
    SporeModel *model = box(0.3, 0.2, 0.1, inertia);
    /* The closed solution starts where w2 = 0: the state there with the same energy and momentum. */
    double t2 = inertia[0] * w1 * w1 + inertia[1] * w2 * w2;
    double g = inertia[0] * inertia[0] * w1 * w1 + inertia[1] * inertia[1] * w2 * w2;
    double a2 = (t2 * inertia[2] - g) / (inertia[0] * (inertia[2] - inertia[0]));
    double c2 = (g - t2 * inertia[0]) / (inertia[2] * (inertia[2] - inertia[0]));
    Top top = top_solve(inertia, sqrt(a2), sqrt(c2));
    top_spin(&top, 0, &quarter);
    double period = 2 * quarter / top.p;
    Rig *rig = rig_new();
    SporeWorld *world = spinning(rig, model, spore_vec3(w1, w2, 0), h, SPORE_INTEGRATOR_DEFAULT);
    double first = 0, last = 0, q[7], v[6];
    int flips = 0;
    for (int i = 0; flips < 21; i++) {
      memcpy(q, spore_world_q(world, 0), sizeof q);
      memcpy(v, spore_world_v(world, 0), sizeof v);
      spore_world_step(world);
      if (middle_spin(q, v) * middle_spin(spore_world_q(world, 0), spore_world_v(world, 0)) > 0) continue;
      last = i * h + time_to_flip(model, q, v, h);
      if (!flips++) first = last;
    }
    double measured = (last - first) / 20;
    g_test_message("case 25: h %g s: turns over every %.8f s, should %.8f s (off by %.1e)", h, measured, period,
                   measured / period - 1);
    g_assert_cmpfloat(fabs(measured / period - 1), <, 1e-4);
    rig_free(rig);
  }
}

/* Angle (rad) between where the first body points after one step and after a thousand in the same time. */
static double lost_phase(Rig *const rigs[2]) {
  SporeQuat one = spore_quat_load(spore_world_q(rigs[0]->world, 0) + 3);
  SporeQuat other = spore_quat_load(spore_world_q(rigs[1]->world, 0) + 3);
  SporeQuat apart = spore_quat_multiply(spore_quat_conjugate(one), other);
  return 2 * asin(fmin(1, sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z)));
}

/* Where a step turns a body further than its turning is followed, that is said, and only there. */
static void lost_turn(void) {
  static const struct {
    double size[3], h;
    SporeIntegratorKind kind;
    bool lost;
  } cases[] = {
      {{0.3, 0.2, 0.1}, 5e-3, SPORE_INTEGRATOR_SYMPLECTIC_EULER, false},
      {{0.3, 0.2, 0.1}, 2e-2, SPORE_INTEGRATOR_SYMPLECTIC_EULER, true},
      {{0.3, 0.2, 0.1}, 2e-2, SPORE_INTEGRATOR_IMPLICIT_EULER, true},
      {{0.2, 0.2, 0.1}, 2e-2, SPORE_INTEGRATOR_SYMPLECTIC_EULER, false}, /* as a body of revolution */
      {{0.2, 0.2, 0.2}, 2e-2, SPORE_INTEGRATOR_SYMPLECTIC_EULER, false},
  };
  for (unsigned c = 0; c < G_N_ELEMENTS(cases); c++) {
    Rig *rigs[2];
    for (int w = 0; w < 2; w++) {
      double inertia[3];
      SporeModel *model = box(cases[c].size[0], cases[c].size[1], cases[c].size[2], inertia);
      rigs[w] = rig_new();
      rigs[w]->description.solver.maximum_speed = 1e6;
      SporeWorld *world =
          spinning(rigs[w], model, spore_vec3(100, 1000, 20), cases[c].h / (w ? 1000 : 1), cases[c].kind);
      rig_run(world, w ? 1000 : 1);
    }
    double apart = lost_phase(rigs);
    const SporeWorld *world = rigs[0]->world;
    const SporeMonitor *monitor = spore_world_monitor(world);
    g_test_message("turn of %g rad at once: %.1e rad from a thousand steps; said: %s", 1000 * cases[c].h, apart,
                   monitor->message_count ? monitor->messages[0].text : "nothing");
    g_assert_cmpuint(spore_world_unsolved_count(rigs[1]->world), ==, 0);
    g_assert_cmpuint(spore_world_unsolved_count(world), ==, cases[c].lost);
    g_assert_cmpuint(monitor->message_count, ==, cases[c].lost);
    if (cases[c].lost) {
      SporeUnsolved entry = spore_world_unsolved(world, 0);
      g_assert_cmpstr(entry.unit, ==, "rad");
      g_assert_cmpfloat(fabs(entry.worst - cases[c].h * spore_vec3_length(body_spin(world))), <, 1e-9);
      g_assert_cmpfloat(apart, >, 0.1);
    } else {
      g_assert_cmpfloat(apart, <, 1e-9);
    }
    for (int w = 0; w < 2; w++) rig_free(rigs[w]);
  }
}

/* Case 26: a needle whose moments are as 1 to 1e6. */
static void case_26(void) {
  static const SporeVec3 spins[] = {{1, 1, 1}, {100, 1, 2}, {0, 3, 0}, {1000, 0, 1e-3}};
  for (unsigned s = 0; s < G_N_ELEMENTS(spins); s++) {
    double inertia[3], width = sqrt(0.5) * 1e-3;
    SporeModel *model = box(1, width * 1.1, width * 0.9, inertia);
    Rig *rig = rig_new();
    SporeWorld *world = spinning(rig, model, spins[s], 2e-3, SPORE_INTEGRATOR_DEFAULT);
    SporeVec3 before = angular_momentum(world, inertia);
    double energy = rig_energy(world);
    rig_run(world, 5000);
    double lost = spore_vec3_distance(before, angular_momentum(world, inertia)) / spore_vec3_length(before);
    g_test_message(
        "case 26: moments 1 : %.3g, spin (%g %g %g): after 10 s angular momentum off by %.1e, energy by %.1e",
        inertia[2] / inertia[0], spins[s].x, spins[s].y, spins[s].z, lost, rig_energy(world) / energy - 1);
    g_assert_true(rig_finite(world));
    /* The state holds the spin in world axes, to one rounding of its length. Across the needle that weighs 1e6 times as
     * much as along it, so where the spin is mostly along, no more can be kept. */
    double along = fabs(spins[s].x) / hypot(spins[s].y, spins[s].z);
    g_assert_cmpfloat(lost, <, 1e-12 * fmax(1, along));
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/rigid/inertia", inertia_of_box);
  g_test_add_func("/stability/rigid/elliptic", elliptic);
  g_test_add_func("/stability/rigid/hundred_periods", hundred_periods);
  g_test_add_func("/stability/rigid/order", order_of_top);
  g_test_add_func("/stability/rigid/balance", balance);
  g_test_add_func("/stability/25_flip", case_25);
  g_test_add_func("/stability/lost_turn", lost_turn);
  g_test_add_func("/stability/26_needle", case_26);
  return g_test_run();
}
