/* Special effects in place of physics: what they do, that nothing else feels them, and the way there and back. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/effect/effect.h"
#include "tests/stability/rig.h"

#define SIDE 11
#define SPACING 0.005
#define THICK 0.003 /* radius of the sheet's spheres, m */
#define TOOL 0.004  /* radius of the instrument's sphere, m */
#define SPEED 0.05  /* of the instrument, m/s */
#define HALF (0.5 * (SIDE - 1) * SPACING)
#define DEEP 0.006 /* how far the instrument goes into the sheet, m */

static void set_effect(SporeWorld *world, uint32_t body, bool on) {
  const SporeCommand command = {.kind = SPORE_COMMAND_EFFECT, .body = body, .effect = on};
  g_assert_true(spore_world_post(world, &command));
}

static SporeModel *cloud(double swirl, double drag) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  return rig_surface_model(&spore_smoke, &box, "swirl", swirl, "drag", drag, "life", 10., NULL);
}

static Rig *sky(double swirl, double drag, double h, bool effect) {
  Rig *rig = rig_new();
  rig->description.solver.time_step = h;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeBodyDescription *smoke = rig_passive(rig, "smoke", cloud(swirl, drag), NULL);
  smoke->effect = effect;
  if (swirl == 0) smoke->velocity = spore_vec3(0.2, 0, 0);
  return rig;
}

/* Farthest that a puff of the one is from the same puff of the other, m. */
static double apart(const SporeWorld *a, const SporeWorld *b) {
  double most = 0;
  for (size_t i = 0; i < spore_world_body_model(a, 0)->node_count; i++)
    most = fmax(most, spore_vec3_distance(spore_vec3_load(spore_world_q(a, 0) + 3 * i),
                                          spore_vec3_load(spore_world_q(b, 0) + 3 * i)));
  return most;
}

/* Smoke as an effect goes where physics would take it, at steps of which physics could not take one. */
static void test_smoke_goes_with_the_air(void) {
  static const struct {
    double swirl, h, most; /* most: m that it may be off after .4 s, on a way of 1.6 cm */
  } cases[] = {{0, 4e-3, 1e-7}, {0, 0.1, 1e-7}, {0.014, 4e-3, 2e-5}, {0.014, 0.02, 1e-4}};
  Rig *exact[2] = {sky(0, 250, 1e-4, false), sky(0.014, 250, 1e-4, false)};
  for (int i = 0; i < 2; i++)
    exact[i]->description.solver.integrator = SPORE_INTEGRATOR_RK4, rig_run(rig_build(exact[i]), 4000);
  for (unsigned c = 0; c < G_N_ELEMENTS(cases); c++) {
    Rig *rig = sky(cases[c].swirl, 250, cases[c].h, true);
    SporeWorld *world = rig_build(rig);
    rig_run(world, (unsigned)lround(0.4 / cases[c].h));
    double off = apart(world, exact[cases[c].swirl > 0]->world);
    g_test_message("swirl %g m/s, steps of %g s: %.2g m off", cases[c].swirl, cases[c].h, off);
    g_assert_cmpfloat(off, <, cases[c].most);
    g_assert_cmpuint(spore_world_dof(world), ==, 0);
    rig_free(rig);
  }
  for (int i = 0; i < 2; i++) rig_free(exact[i]);
}

/* Physics has a limit on the step, the effect has none; it says so where it is to become physics. */
static void test_smoke_has_no_limit(void) {
  SporeError error = SPORE_ERROR_INIT;
  Rig *physical = sky(0.014, 1000, 0.1, false);
  g_assert_null(rig_try_build(physical, &error));
  rig_free(physical);
  Rig *rig = sky(0.014, 1000, 0.1, true);
  SporeWorld *world = rig_build(rig);
  set_effect(world, 0, false);
  rig_run(world, 3);
  g_test_message("%s", rig_last_message(world));
  g_assert_true(spore_world_body_is_effect(world, 0) && rig_said(world, "smoke: the time step is too long"));
  g_assert_true(rig_finite(world));
  rig_free(rig);
}

/* A sheet of spheres, held at two corners, over which an instrument comes down; beside them a ball falls. */
static Rig *sheet(const SporeModelType *type, RigMover *mover, bool effect) {
  SporeTriangleMesh mesh;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 4e-3;
  rig->description.solver.sleep_speed = 0;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, mesh.vertex_count, THICK);
  rig_passive(rig, "sheet", rig_surface_model(type, &mesh, NULL), spheres)->effect = effect;
  rig_active(rig, "tool", rig_sphere(rig, TOOL))->pose.position = mover->from;
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.005))->pose.position =
      spore_vec3(0.3, 0, 0);
  return rig;
}

static SporeWorld *build_sheet(Rig *rig, RigMover *mover) {
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &mover->base);
  return world;
}

/* How deep the instrument is in the deepest of the sheet's spheres, m. */
static double depth(const SporeWorld *world) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  SporeVec3 tool = spore_vec3_load(spore_world_q(world, 1));
  double most = 0;
  for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
    most = fmax(most, TOOL + THICK - spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), tool));
  return spheres->count > 0 ? most : NAN;
}

static SporeVec3 corner(int i) { return spore_vec3(i & 1 ? 2 * HALF : 0, 0, i & 2 ? 2 * HALF : 0); }

/* Tissue gives way to the instrument at once, and comes back to its shape when that is gone; what is pinned stays. */
static void test_tissue_gives_way(void) {
  RigMover mover = {{&rig_mover_type}, {HALF + 0.001, TOOL + THICK + 0.001, HALF + 0.0007}, {0, -SPEED, 0}};
  Rig *rig = sheet(&spore_mass_spring_net, &mover, true);
  SporeTriangleMesh mesh;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  double worst = 0, lowest = 0;
  rig_pin(rig, 0, corner(0), 1e-4);
  SporeWorld *world = build_sheet(rig, &mover);
  g_autofree double *rest = g_memdup2(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *rest);
  spore_world_step(world);
  uint64_t before = spore_allocation_count();
  for (double gone = 0; gone < DEEP + 0.001; gone += SPEED * 4e-3) {
    spore_world_step(world);
    worst = fmax(worst, depth(world));
  }
  for (size_t i = 0; i < SIDE * SIDE; i++) lowest = fmin(lowest, spore_world_q(world, 0)[3 * i + 1]);
  g_test_message("pressed in by %.2g mm, %.2g mm of the instrument in the tissue at most", -1e3 * lowest, 1e3 * worst);
  g_assert_cmpfloat(lowest, <, -0.8 * DEEP);
  g_assert_cmpfloat(worst, <, 0.05 * THICK);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * sizeof *rest, rest, 3 * sizeof *rest);
  mover.from = spore_vec3(0, 0.1, 0), mover.velocity = spore_vec3(0, 0, 0);
  rig_run(world, 1000);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *rest, rest, 3 * SIDE * SIDE * sizeof *rest);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  spore_triangle_mesh_clear(&mesh);
  rig_free(rig);
}

/* What neither touches it nor is tied to it is the same to the bit; the effect has no unknowns, and its energy is not
 * counted. */
static void test_others_do_not_feel_it(void) {
  uint64_t hashes[2];
  size_t dof[2];
  for (int effect = 0; effect < 2; effect++) {
    RigMover mover = {{&rig_mover_type}, {HALF + 0.001, TOOL + THICK + 0.001, HALF + 0.0007}, {0, -SPEED, 0}};
    Rig *rig = sheet(&spore_mass_spring_net, &mover, effect);
    SporeWorld *world = build_sheet(rig, &mover);
    rig_run(world, 30);
    hashes[effect] = spore_world_body_hash(world, 2);
    dof[effect] = spore_world_dof(world);
    g_assert_true(rig_finite(world));
    rig_free(rig);
  }
  g_assert_cmphex(hashes[0], ==, hashes[1]);
  g_assert_cmpuint(dof[0], ==, dof[1] + 3 * SIDE * SIDE);
}

/* Farthest that a node moved from `before`, m. */
static double moved(const SporeWorld *world, const double *before) {
  double most = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++)
    most = fmax(most,
                spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), spore_vec3_load(before + 3 * i)));
  return most;
}

/* There and back while it runs: without a jump, and a reset is time 0 again to the bit. */
static void test_there_and_back(void) {
  RigMover mover = {{&rig_mover_type}, {0, 0.2, 0}, {0, 0, 0}};
  Rig *rig = sheet(&spore_mass_spring_net, &mover, false);
  SporeTriangleMesh mesh;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  for (int i = 0; i < 2; i++) rig_pin(rig, 0, corner(i), 1e-4);
  SporeWorld *world = build_sheet(rig, &mover);
  g_autofree double *before = g_new(double, 3 * SIDE * SIDE);
  uint64_t start = spore_world_hash(world);
  double hangs = 0;
  rig_run(world, 500);
  memcpy(before, spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *before);
  for (size_t i = 0; i < SIDE * SIDE; i++) hangs = fmax(hangs, -before[3 * i + 1]);
  set_effect(world, 0, true);
  spore_world_step(world);
  g_test_message("hangs by %.2g mm; the first step of the effect moves it by %.2g mm", 1e3 * hangs,
                 1e3 * moved(world, before));
  g_assert_cmpfloat(hangs, >, 5e-3);
  g_assert_cmpfloat(moved(world, before), <, 0.05 * SIDE * SPACING);
  g_assert_true(spore_world_body_is_effect(world, 0));
  rig_run(world, 1000);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof(double), mesh.vertices,
                  3 * SIDE * SIDE * sizeof(double));
  memcpy(before, spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *before);
  set_effect(world, 0, false);
  spore_world_step(world);
  g_assert_cmpfloat(moved(world, before), <, 2 * 9.81 * 4e-3 * 4e-3);
  rig_run(world, 500);
  g_assert_cmpfloat(moved(world, before), >, 0.5 * hangs);
  set_effect(world, 0, true);
  rig_run(world, 10);
  spore_world_reset(world);
  g_assert_false(spore_world_body_is_effect(world, 0));
  g_assert_cmphex(spore_world_hash(world), ==, start);
  spore_triangle_mesh_clear(&mesh);
  rig_free(rig);
}

/* A rigid body stands still, and what falls on it stays on it. */
static void test_rigid_stands(void) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  rig_passive(rig, "stand", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.01))->effect = true;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  SporeBodyDescription *ball =
      rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.01));
  ball->pose.position = spore_vec3(0, 0.0205, 0);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 100);
  g_assert_cmpfloat(spore_world_q(world, 0)[1], ==, 0);
  g_assert_cmpfloat(spore_world_q(world, 1)[1], >, 0.018);
  g_assert_cmpuint(spore_world_dof(world), ==, 6);
  rig_free(rig);
}

#define PIT 0.03    /* width of the pit, m */
#define STONE 0.002 /* radius of the spheres that it is made of, m */
#define CUBE 0.014  /* side of the blood, m */
#define DROPS 200

static const SporeSphereSet *own_spheres(Rig *rig, const SporeModel *model) {
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  SporeError error = SPORE_ERROR_INIT;
  if (!model->type->spheres(model, set, &error)) g_error("%s", error.message);
  g_ptr_array_add(rig->sets, set);
  return set;
}

static const SporeSphereSet *pit(Rig *rig) {
  g_autoptr(GArray) points = g_array_new(FALSE, FALSE, sizeof(double));
  int side = (int)lround((PIT + 2 * STONE) / STONE);
  for (int i = 0; i <= side; i++)
    for (int j = 0; j <= side; j++)
      for (int k = 0; k <= side; k++) {
        bool wall = i == 0 || i == side || k == 0 || k == side;
        const double at[3] = {(i - 0.5 * side) * STONE, (j - 1) * STONE, (k - 0.5 * side) * STONE};
        if (wall || j == 0) g_array_append_vals(points, at, 3);
      }
  return rig_spheres(rig, (const double *)points->data, points->len / 3, STONE);
}

/* Blood over a pit, as an effect; nothing but the pit and the blood, but for what `extra` adds. */
static Rig *pour(double h, void (*extra)(Rig *rig)) {
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0.02, 0), spore_vec3(CUBE, CUBE, CUBE));
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = h;
  SporeModel *model = rig_fluid_model(&cube, DROPS, NULL);
  rig_passive(rig, "blood", model, own_spheres(rig, model))->effect = true;
  rig_unmovable(rig, "pit", pit(rig));
  if (extra) extra(rig);
  return rig;
}

/* Drops come to lie in the pit as a level pool of the fluid's volume, at short steps and at such as physics never
 * takes. */
static void test_drops_pool(void) {
  static const double steps[] = {5e-4, 4e-3, 0.1};
  for (unsigned c = 0; c < G_N_ELEMENTS(steps); c++) {
    Rig *rig = pour(steps[c], NULL);
    SporeWorld *world = rig_build(rig);
    size_t n = spore_world_body_model(world, 0)->node_count;
    unsigned count = (unsigned)lround(1 / steps[c]);
    rig_run(world, count / 2);
    uint64_t before = spore_allocation_count(); /* by now there were as many near pairs as ever */
    rig_run(world, count - count / 2);
    double mean = 0, fastest = 0, off = 0, level = 2 * CUBE * CUBE * CUBE / (PIT * PIT), sides[2] = {0, 0};
    for (size_t i = 0; i < n; i++) {
      SporeVec3 at = spore_vec3_load(spore_world_q(world, 0) + 3 * i);
      mean += at.y / (double)n;
      sides[at.x > 0] += at.y / (0.5 * (double)n);
      fastest = fmax(fastest, spore_vec3_length(spore_vec3_load(spore_world_v(world, 0) + 3 * i)));
      off = fmax(off, fmax(fmax(fabs(at.x), fabs(at.z)) - 0.5 * PIT, -at.y));
    }
    g_test_message("steps of %g s: middle %.2f mm high, of %.2f mm; %.2g mm out of the pit; up to %.2g m/s", steps[c],
                   1e3 * mean, 0.25e3 * level, 1e3 * off, fastest);
    g_assert_cmpfloat(fabs(mean - 0.25 * level), <, 0.08 * level);
    g_assert_cmpfloat(fabs(sides[1] - sides[0]), <, 0.1 * level);
    g_assert_cmpfloat(off, <, 0.2 * STONE);
    g_assert_cmpfloat(fastest, <, 0.1);
    g_assert_cmpuint(spore_world_dof(world), ==, 0);
    g_assert_cmpuint(spore_allocation_count(), ==, before);
    rig_free(rig);
  }
}

static void add_ball(Rig *rig) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.008, 0.008, 0.008));
  rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.005))->pose.position =
      spore_vec3(0.001, 0.008, 0);
}

/* Drops lie on a ball and beside it; the ball, which comes down meanwhile, goes as it does where they are far off. */
static void test_drops_push_nothing(void) {
  uint64_t hashes[2];
  for (int away = 0; away < 2; away++) {
    Rig *rig = pour(2e-3, add_ball);
    if (away) g_array_index(rig->bodies, SporeBodyDescription, 0).pose.position = spore_vec3(1, 0, 0);
    SporeWorld *world = rig_build(rig);
    double nearest = HUGE_VAL;
    rig_run(world, 400);
    SporeVec3 ball = spore_vec3_load(spore_world_q(world, 2));
    for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
      nearest = fmin(nearest, spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), ball));
    g_test_message("the nearest drop is %.2f mm from the middle of the ball", 1e3 * nearest);
    if (away) g_assert_cmpfloat(nearest, >, 0.5);
    else g_assert_cmpfloat(nearest, >, 0.005);
    if (!away) g_assert_cmpfloat(nearest, <, 0.007);
    hashes[away] = spore_world_body_hash(world, 2);
    rig_free(rig);
  }
  g_assert_cmphex(hashes[0], ==, hashes[1]);
}

/* Friction holds drops on a slope where the angle of friction is wider, and nothing holds them without. */
static double slipped(double friction) {
  Rig *rig = pour(2e-3, NULL);
  SporeBodyDescription *bodies = (SporeBodyDescription *)rig->bodies->data;
  rig->description.gravity = spore_vec3(4, -9, 0);
  bodies[0].contact.friction = bodies[1].contact.friction = friction;
  bodies[1].spheres = rig_floor(rig, 80, 40, 0.002, 0.004);
  SporeWorld *world = rig_build(rig);
  double way[2] = {0, 0};
  for (int half = 0; half < 2; half++) {
    rig_run(world, 300); /* the drops have come to rest after the first half */
    for (size_t i = 0; i < DROPS / 2; i++) way[half] += spore_world_q(world, 0)[3 * i] / (DROPS / 2);
  }
  rig_free(rig);
  return way[1] - way[0];
}

static void test_drops_slip(void) {
  double held = slipped(1), loose = slipped(0);
  g_test_message("in the second half %.2f mm down the slope with friction, %.2f mm without", 1e3 * held, 1e3 * loose);
  g_assert_cmpfloat(fabs(held), <, 2e-3);
  g_assert_cmpfloat(loose, >, 0.05);
}

/* Blood becomes an effect and blood again without a jump, and a reset is time 0 again to the bit. */
static void test_drops_there_and_back(void) {
  Rig *rig = pour(1e-4, NULL);
  g_array_index(rig->bodies, SporeBodyDescription, 0).effect = false;
  SporeWorld *world = rig_build(rig);
  uint64_t start = spore_world_hash(world);
  for (int on = 1; on >= 0; on--) {
    rig_run(world, 400);
    double before = spore_world_q(world, 0)[1], speed = spore_world_v(world, 0)[1];
    set_effect(world, 0, on);
    rig_run(world, 20); /* drops go on once in so many */
    double way = spore_world_q(world, 0)[1] - before;
    g_assert_true(spore_world_body_is_effect(world, 0) == on);
    g_assert_cmpfloat(fabs(way - 2e-3 * speed), <, 3e-4); /* of drops 2.3 mm wide, which make some room */
    g_assert_cmpuint(spore_world_dof(world), ==, on ? 0 : 3 * spore_world_body_model(world, 0)->node_count);
  }
  g_assert_true(rig_finite(world));
  spore_world_reset(world);
  g_assert_cmphex(spore_world_hash(world), ==, start);
  rig_free(rig);
}

/* In its middle a dent is its push; far off it falls as the third power. */
/* Blood in a pit, until it sleeps; `extra` as of pour. */
static SporeWorld *sleeping_pool(Rig *rig) {
  rig->description.solver.sleep_speed = 1e-3;
  SporeWorld *world = rig_build(rig);
  for (int i = 0; i < 3000 && !spore_world_body_asleep(world, 0); i++) spore_world_step(world);
  g_assert_true(spore_world_body_asleep(world, 0));
  return world;
}

/* Mean height of the drops in the world, and how many there are; of those left and right of the middle. */
static double mean_height(const SporeWorld *world) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
    if (!spore_particle_is_out(spore_world_q(world, 0) + 3 * i)) sum += spore_world_q(world, 0)[3 * i + 1], count++;
  return sum / (double)count;
}

/* A pool that lies still sleeps where it is, to the bit; a pool that never sleeps is as high. */
static void test_drops_sleep(void) {
  Rig *rig = pour(4e-3, NULL), *awake = pour(4e-3, NULL);
  awake->description.solver.sleep_speed = 0;
  SporeWorld *world = sleeping_pool(rig), *other = rig_build(awake);
  double when = spore_world_time_s(world);
  uint64_t hash = spore_world_body_hash(world, 0), before = spore_allocation_count();
  rig_run(world, 250);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  rig_run(other, (unsigned)lround((when + 1) / 4e-3));
  g_test_message("asleep after %.2f s, %.3f mm high; %.3f mm where it never sleeps", when, 1e3 * mean_height(world),
                 1e3 * mean_height(other));
  g_assert_cmphex(spore_world_body_hash(world, 0), ==, hash);
  g_assert_false(spore_world_body_asleep(other, 0));
  g_assert_cmpfloat(fabs(mean_height(world) - mean_height(other)), <, 1e-4);
  uint64_t end = spore_world_hash(world), steps = spore_world_step_count(world);
  spore_world_reset(world);
  g_assert_false(spore_world_body_asleep(world, 0));
  rig_run(world, (unsigned)steps);
  g_assert_cmphex(spore_world_hash(world), ==, end);
  const SporeCommand turn = {.kind = SPORE_COMMAND_GRAVITY, .vector = {8, -5, 0}};
  g_assert_true(spore_world_post(world, &turn));
  rig_run(world, 50);
  g_assert_false(spore_world_body_asleep(world, 0));
  rig_free(rig);
  rig_free(awake);
}

static void add_table(Rig *rig) {
  g_array_remove_index(rig->bodies, 1); /* in place of the pit */
  rig_active(rig, "table", pit(rig));
}

/* What the pool lies on may sink slower than any drop would be seen to move: the pool goes down with it. */
static void test_drops_follow_the_ground(void) {
  static const double speeds[] = {-0.05, -1e-4};
  for (unsigned c = 0; c < G_N_ELEMENTS(speeds); c++) {
    RigMover mover = {{&rig_mover_type}, {0, 0, 0}, {0, 0, 0}};
    Rig *rig = pour(4e-3, add_table);
    rig->description.solver.sleep_speed = 1e-3;
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &mover.base);
    for (int i = 0; i < 3000 && !spore_world_body_asleep(world, 0); i++) spore_world_step(world);
    g_assert_true(spore_world_body_asleep(world, 0));
    double height = mean_height(world), start = spore_world_time_s(world);
    mover.velocity.y = speeds[c];
    mover.from.y = -speeds[c] * start;
    rig_run(world, 500);
    double way = mean_height(world) - height, sunk = speeds[c] * (spore_world_time_s(world) - start);
    g_test_message("the ground went %.3f mm, the pool %.3f mm", 1e3 * sunk, 1e3 * way);
    g_assert_cmpfloat(fabs(way - sunk), <, 1.5e-4);
    rig_free(rig);
  }
}

static void add_sucker(Rig *rig) {
  rig_active(rig, "sucker", NULL)->pose.position = spore_vec3(0, 0.2, 0);
  SporeSuctionFields *fields = rig_tool_fields(rig_tool(rig, &spore_suction, "suction", 2));
  fields->rate = 100;
  fields->radius = 0.004;
  spore_vec3_store(fields->point, spore_vec3(0, 0.2, 0));
}

/* A suction that comes to a pool asleep takes drops out of it, and the others flow to where they were. */
static void test_sleeping_pool_is_sucked(void) {
  RigMover mover = {{&rig_mover_type}, {0, 0.2, 0}, {0, 0, 0}};
  Rig *rig = pour(4e-3, add_sucker);
  rig->description.solver.sleep_speed = 1e-3;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 2, &mover.base);
  for (int i = 0; i < 3000 && !spore_world_body_asleep(world, 0); i++) spore_world_step(world);
  g_assert_true(spore_world_body_asleep(world, 0));
  double height = mean_height(world);
  g_assert_cmpuint(spore_world_tool_state(world, 0).taken, ==, 0);
  mover.from.y = 0.001;
  rig_run(world, 200);
  size_t taken = spore_world_tool_state(world, 0).taken, left = spore_world_particle_count(world, 0);
  g_test_message("%zu of %zu taken; %.2f mm high before, %.2f mm after", taken, left + taken, 1e3 * height,
                 1e3 * mean_height(world));
  g_assert_cmpuint(taken, >, 30);
  g_assert_cmpuint(left + taken, ==, spore_world_body_model(world, 0)->node_count);
  g_assert_cmpfloat(mean_height(world), <, height - 1e-4);
  rig_free(rig);
}

/* Blood, poured or as particles, over a floor: its mean stain, and that of the part under the blood. */
typedef struct Stained {
  double mean, under, beside;
  uint64_t hash; /* of the world's state */
} Stained;

static Stained stained_floor(const char *rate_name, double rate, double h, bool effect, unsigned steps) {
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0.01, 0), spore_vec3(0.008, 0.008, 0.008));
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = h;
  SporeModel *model = rig_fluid_model(&cube, 60, rate_name, rate, "temperature", 0.7, "thermostat", 200., NULL);
  rig_passive(rig, "blood", model, own_spheres(rig, model))->effect = effect;
  rig_unmovable(rig, "floor", rig_floor(rig, 48, 48, 0.002, 0.002))->contact =
      (SporeContactFields){.stiffness = 60, .damping = 0.02, .friction = 1};
  g_array_index(rig->bodies, SporeBodyDescription, 0).contact =
      (SporeContactFields){.stiffness = 60, .damping = 0.02, .friction = 1};
  SporeWorld *world = rig_build(rig);
  g_assert_cmpfloat(spore_world_stained(world, 1), ==, 0);
  rig_run(world, steps);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  SporeStainPlaces places = spore_world_stain_places(world, 1);
  Stained found = {.mean = spore_world_stained(world, 1), .hash = spore_world_hash(world)};
  for (size_t i = 0; i < places.count; i++) {
    const double *at = places.rest + 3 * i;
    double far = hypot(at[0], at[2]), stain = (double)snapshot->stain[places.start + i];
    g_assert_true(stain >= 0 && stain <= 1);
    if (far < 0.004) found.under = fmax(found.under, stain);
    if (far > 0.04) found.beside = fmax(found.beside, stain);
  }
  spore_world_reset(world);
  snapshot = spore_world_snapshot_acquire(world);
  g_assert_cmpfloat(spore_world_stained(world, 1), ==, 0);
  for (size_t i = 0; i < snapshot->stain_count; i++) g_assert_cmpfloat((double)snapshot->stain[i], ==, 0);
  rig_free(rig);
  return found;
}

/* Blood stains what it lies on, as an effect and as particles, and nothing else; the motion is the same to the bit. */
static void test_blood_stains(void) {
  static const struct {
    double h;
    unsigned steps;
    bool effect;
  } cases[] = {{4e-3, 100, true}, {5e-4, 800, true}, {2e-4, 1000, false}};
  for (unsigned c = 0; c < G_N_ELEMENTS(cases); c++) {
    Stained red = stained_floor("stain", 10, cases[c].h, cases[c].effect, cases[c].steps);
    Stained clear = stained_floor("stain", 0, cases[c].h, cases[c].effect, cases[c].steps);
    g_test_message("%s, steps of %g s: %.2f under the blood, %.2f beside it", cases[c].effect ? "effect" : "physics",
                   cases[c].h, red.under, red.beside);
    g_assert_cmpfloat(red.under, >, 0.15);
    g_assert_cmpfloat(red.beside, ==, 0);
    g_assert_cmpfloat(clear.mean, ==, 0);
    g_assert_cmphex(red.hash, ==, clear.hash);
  }
}

#define SEEP_M3_S 2e-7 /* .2 ml a second */

/* A wound in the floor that is an effect, or lets particles out, for .8 s. */
static Rig *seeping(bool effect) {
  static SporeEmitterDescription wound;
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0.03, 0), spore_vec3(0.008, 0.008, 0.008));
  rig->description.solver.time_step = 2e-3;
  SporeModel *model = rig_fluid_model(&cube, 60, "stain", 10., NULL);
  rig_passive(rig, "blood", model, own_spheres(rig, model))->effect = true;
  rig_unmovable(rig, "floor", rig_floor(rig, 48, 48, 0.002, 0.002));
  wound = (SporeEmitterDescription){
      .name = "wound", .body = 0, .source = 1, .point = {0.01, 0.001, 0}, .direction = {0, 1, 0}, .effect = effect};
  spore_parameters_set_initial(&spore_emitter_parameters, &wound.fields);
  wound.fields.flow = SEEP_M3_S, wound.fields.reserve = 40;
  rig->description.emitters = &wound, rig->description.emitter_count = 1;
  rig_run(rig_build(rig), 400);
  return rig;
}

/* What seeps is counted as what comes out is, makes no particle, and stains its source around the mouth as far as it
 * would run as a film. */
static void test_seeping(void) {
  Rig *effect = seeping(true), *physical = seeping(false);
  SporeBodyMarks seeped = spore_world_body_marks(effect->world, 0), poured = spore_world_body_marks(physical->world, 0);
  SporeStainPlaces places = spore_world_stain_places(effect->world, 1);
  double film = sqrt(0.8 * SEEP_M3_S / (3.141592653589793 * 5e-4)), farthest = 0, under = 0;
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(effect->world);
  for (size_t i = 0; i < places.count; i++) {
    double far = spore_vec3_distance(spore_vec3_load(places.rest + 3 * i), spore_vec3(0.01, 0.001, 0));
    double stain = (double)snapshot->stain[places.start + i];
    if (stain > 0) farthest = fmax(farthest, far);
    if (far < 0.004) under = fmax(under, stain);
  }
  g_test_message("%zu drops' worth seeped, %zu drops came out; stained up to %.1f mm from the mouth, film %.1f mm",
                 (size_t)seeped.seeped, (size_t)poured.poured, 1e3 * farthest, 1e3 * film);
  g_assert_cmpuint(seeped.poured, ==, 0);
  g_assert_cmpuint(seeped.seeped, ==, poured.poured);
  g_assert_cmpuint(seeped.seeped, >, 5);
  g_assert_cmpuint(spore_world_particle_count(effect->world, 0), ==,
                   spore_world_body_model(effect->world, 0)->node_count - 40);
  g_assert_cmpfloat(farthest, <=, film);
  g_assert_cmpfloat(farthest, >, 0.7 * film);
  g_assert_cmpfloat(under, >, 0.9);
  g_assert_cmpfloat_with_epsilon(snapshot->tools.poured, 0.8 * SEEP_M3_S, 0.02 * 0.8 * SEEP_M3_S);
  rig_free(effect);
  rig_free(physical);
}

/* Blood stains a thread that lies in it, whether the thread resists twist or not. */
static void test_blood_stains_lines(void) {
  double stained[2];
  for (int twists = 0; twists < 2; twists++) {
    Rig *rig = rig_new();
    SporeTriangleMesh cube;
    shape_box(&cube, spore_vec3(0, 0.012, 0), spore_vec3(0.008, 0.008, 0.008));
    rig->description.gravity = spore_vec3(0, -9.81, 0);
    rig->description.solver.time_step = 4e-3;
    SporeModel *blood = rig_fluid_model(&cube, 60, "stain", 10., "temperature", 0.7, "thermostat", 200., NULL);
    rig_passive(rig, "blood", blood, own_spheres(rig, blood))->effect = true;
    double *line = SPORE_NEW_ARRAY(double, 4 * 12);
    for (int i = 0; i < 12; i++)
      spore_vec3_store(line + 4 * i, spore_vec3(-0.011 + 0.002 * i, 0.002, 0)), line[4 * i + 3] = 1e-3;
    SporeModel *thread =
        rig_curve_model(&spore_spline_1d, &(SporeCurve){12, line}, "twist_modulus", twists ? 1e6 : 0., NULL);
    rig_passive(rig, "thread", thread, own_spheres(rig, thread));
    rig_unmovable(rig, "floor", rig_floor(rig, 48, 48, 0.002, 0.002));
    SporeWorld *world = rig_build(rig);
    rig_run(world, 100);
    g_test_message("a thread that %s twist is stained by %.3f", twists ? "resists" : "does not resist",
                   spore_world_stained(world, 1));
    stained[twists] = spore_world_stained(world, 1);
    rig_free(rig);
  }
  g_assert_cmpfloat(stained[1], >, 0.02);
  g_assert_cmpfloat(stained[0], >, 0.5 * stained[1]);
  g_assert_cmpfloat(stained[0], <, 2 * stained[1]);
}

/* Blood that is put away after .2 s, and what is left of its stain after .4 s more; *hash: of the state then. */
static double stain_left(Rig *rig, SporeDevice *device, uint64_t *hash) {
  SporeWorld *world = rig_build(rig);
  if (device) spore_world_set_device(world, 2, device);
  rig_run(world, 50);
  double before = spore_world_stained(world, 1);
  size_t count = 3 * spore_world_body_model(world, 0)->node_count;
  g_autofree double *q = g_memdup2(spore_world_q(world, 0), count * sizeof *q), *v = g_new0(double, count);
  for (size_t i = 0; i < count; i++) q[i] += 1;
  spore_world_set_state(world, 0, q, v);
  g_assert_cmpfloat(before, >, 2e-3);
  rig_run(world, 100);
  double left = spore_world_stained(world, 1) / before;
  *hash = spore_world_hash(world);
  rig_free(rig);
  return left;
}

/* Water over a stained floor. */
static void add_water(Rig *rig) {
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0.02, 0), spore_vec3(CUBE, CUBE, CUBE));
  SporeModel *model = rig_fluid_model(&cube, DROPS, "stain", -20., NULL);
  SporeBodyDescription *water = rig_passive(rig, "water", model, own_spheres(rig, model));
  water->effect = true;
  water->pose.position = spore_vec3(0, 0.4, 0); /* falls for .28 s */
}

/* What washes takes the stain off, where the blood has gone. */
static void test_water_washes(void) {
  double left[2];
  uint64_t hash;
  for (int washed = 0; washed < 2; washed++)
    left[washed] = stain_left(pour(4e-3, washed ? add_water : NULL), NULL, &hash);
  g_test_message("%.2f of the stain is left without water, %.2f with", left[0], left[1]);
  g_assert_cmpfloat(left[0], ==, 1);
  g_assert_cmpfloat(left[1], <, 0.6);
}

/* An irrigator over the floor, which pours while the second button is down. */
typedef struct Pedal {
  SporeDevice base;
  uint32_t buttons;
} Pedal;

static bool press(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  (void)command;
  *state = (SporeDeviceState){.position = {0, 0.06, 0}, .orientation = {1, 0, 0, 0}};
  state->buttons = time_s > 0.199 ? ((const Pedal *)device)->buttons : 0;
  return true;
}

static Rig *irrigated(double stain) {
  static SporeEmitterDescription jet;
  static const SporeVec3 tip = {0, 0.06, 0};
  Rig *rig = pour(4e-3, NULL);
  SporeTriangleMesh cube;
  rig_active(rig, "tube", rig_sphere(rig, 0.0005))->pose.position = tip;
  shape_box(&cube, spore_vec3(0, 0.1, 0), spore_vec3(CUBE, CUBE, CUBE));
  SporeModel *model = rig_fluid_model(&cube, DROPS, "stain", stain, NULL);
  rig_passive(rig, "water", model, own_spheres(rig, model))->effect = true;
  jet = (SporeEmitterDescription){.name = "jet", .body = 3, .source = 2, .point = tip, .direction = {0, -1, 0}};
  spore_parameters_set_initial(&spore_emitter_parameters, &jet.fields);
  jet.fields.flow = 1.667e-5, jet.fields.radius = 0.00175, jet.fields.trigger = SPORE_FLOW_SECOND_BUTTON;
  jet.fields.reserve = (int64_t)model->node_count;
  rig->description.emitters = &jet;
  rig->description.emitter_count = 1;
  return rig;
}

/* The stain goes while the button is down, and with what washes; the motion is the same whether it washes or not. */
static void test_irrigation_washes(void) {
  static const SporeDeviceType type = {.name = "pedal", .exchange = press};
  static const struct {
    uint32_t buttons;
    double stain;
  } cases[] = {{0, -20}, {1, -20}, {2, -20}, {2, 0}};
  double left[G_N_ELEMENTS(cases)];
  uint64_t hash[G_N_ELEMENTS(cases)];
  for (unsigned c = 0; c < G_N_ELEMENTS(cases); c++) {
    Pedal pedal = {{&type}, cases[c].buttons};
    left[c] = stain_left(irrigated(cases[c].stain), &pedal.base, &hash[c]);
    g_test_message("buttons %u, stain %g: %.2f of the stain is left", cases[c].buttons, cases[c].stain, left[c]);
    g_assert_true(cases[c].buttons == 2 && cases[c].stain < 0 ? left[c] < 0.7 : left[c] == 1);
  }
  g_assert_cmphex(hash[2], ==, hash[3]);
  g_assert_cmphex(hash[0], !=, hash[2]);
}

/* An endoscope that stands in the blood, presses its first button from .3 s to .34 s, and is drawn up from .6 s on. */
#define DRAWN_S 0.6
static bool dip(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  (void)device;
  (void)command;
  *state = (SporeDeviceState){.position = {0, 0.004, 0}, .orientation = {1, 0, 0, 0}};
  state->position[1] += 0.3 * fmin(fmax(time_s - DRAWN_S, 0), 0.2);
  state->buttons = time_s > 0.299 && time_s < 0.339;
  return true;
}

static Rig *dipped(SporeEyeDescription *eyes, size_t count, bool port) {
  Rig *rig = pour(4e-3, NULL);
  rig_active(rig, "scope", rig_sphere(rig, 0.0005))->pose.position = spore_vec3(0, 0.004, 0);
  for (size_t i = 0; i < count; i++)
    eyes[i] =
        (SporeEyeDescription){.body = 2, .point = {0.2 * (double)i, 0.003, 0}, .sight = {0, -1, 0}, .lens = 0.004};
  rig->description.eyes = eyes;
  rig->description.eye_count = count;
  if (port) rig_link(rig, "port", &spore_link_port, 2, SPORE_NO_BODY, spore_vec3(0, 0.03, 0));
  return rig;
}

/* Blood wets a lens that it touches and no other; a button and a command wipe the lens, and so does an assistant once
 * it is out of its port. Nothing else knows of it. */
static void test_lens_is_wetted(void) {
  static const SporeDeviceType type = {.name = "dip", .exchange = dip};
  SporeDevice device = {&type};
  uint64_t hash[3];
  double wet[3];
  for (int c = 0; c < 3; c++) { /* no eye; with a port; without one */
    SporeEyeDescription eyes[2];
    Rig *rig = dipped(eyes, c == 0 ? 0 : 2, c < 2);
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 2, &device);
    rig_run(world, 74);
    if (c > 0) {
      g_assert_cmpfloat((double)spore_world_lens(world, 0).blood, >, 0.3);
      g_assert_cmpfloat((double)spore_world_lens(world, 1).blood, ==, 0);
    }
    rig_run(world, 9);
    if (c > 0) g_assert_cmpfloat((double)spore_world_lens(world, 0).blood, ==, 0);
    rig_run(world, 65);
    if (c > 0) g_assert_cmpfloat((double)spore_world_lens(world, 0).blood, >, 0.3);
    rig_run(world, 60);
    hash[c] = spore_world_hash(world);
    if (c > 0) wet[c] = (double)spore_world_snapshot_acquire(world)->lenses[0].blood;
    if (c == 2) {
      const SporeCommand wipe = {.kind = SPORE_COMMAND_WIPE, .number = 0},
                         none = {.kind = SPORE_COMMAND_WIPE, .number = 9};
      g_assert_true(spore_world_post(world, &none));
      rig_run(world, 1);
      g_assert_cmpfloat((double)spore_world_lens(world, 0).blood, ==, wet[2]);
      g_assert_true(spore_world_post(world, &wipe));
      rig_run(world, 1);
      g_assert_cmpfloat((double)spore_world_lens(world, 0).blood, ==, 0);
    }
    rig_free(rig);
  }
  g_assert_cmpfloat(wet[1], ==, 0);
  g_assert_cmpfloat(wet[2], >, 0.3);
  g_assert_cmphex(hash[0], ==, hash[1]);
}

/* Smoke hazes the view, and the haze fades once the smoke is gone; an eye without haze sees none, nor one that is far
 * and looks away. */
static void test_smoke_hazes(void) {
  SporeEyeDescription eyes[] = {
      {.body = SPORE_NO_BODY, .sight = {0, 0, -1}, .haze_s = 0.5},
      {.body = SPORE_NO_BODY, .sight = {0, 0, -1}, .lens = 0.004},
      {.body = SPORE_NO_BODY, .point = {0.5, 0, 0}, .sight = {-1, 0, 0}, .haze_s = 0.5},
      {.body = SPORE_NO_BODY, .point = {0.5, 0, 0}, .sight = {0, 0, -1}, .haze_s = 0.5},
      {.body = SPORE_NO_BODY, .point = {0.05, 0, 0}, .sight = {0, 0, -1}, .haze_s = 0.5},
  };
  Rig *rig = sky(0, 250, 4e-3, true);
  rig->description.eyes = eyes;
  rig->description.eye_count = G_N_ELEMENTS(eyes);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 250);
  double thick = (double)spore_world_lens(world, 0).haze;
  g_assert_cmpfloat((double)spore_world_lens(world, 2).haze, ==, thick); /* far, before it */
  g_assert_cmpfloat((double)spore_world_lens(world, 3).haze, ==, 0);     /* far, beside it */
  g_assert_cmpfloat((double)spore_world_lens(world, 4).haze, ==, thick); /* near, beside it */
  size_t count = spore_world_body_model(world, 0)->node_count;
  g_autofree double *q = g_memdup2(spore_world_q(world, 0), 4 * count * sizeof *q), *v = g_new0(double, 3 * count);
  for (size_t i = 0; i < count; i++) q[3 * i] = 2 * SPORE_PARTICLES_OUT_M;
  spore_world_set_state(world, 0, q, v);
  rig_run(world, 125);
  double thin = (double)spore_world_lens(world, 0).haze;
  g_test_message("haze %.3f, and %.3f half a second later", thick, thin);
  g_assert_cmpfloat(thick, >, 0.01);
  g_assert_cmpfloat(fabs(thin / thick - exp(-1)), <, 0.03);
  g_assert_cmpfloat((double)spore_world_lens(world, 1).haze, ==, 0);
  spore_world_reset(world);
  g_assert_cmpfloat((double)spore_world_lens(world, 0).haze, ==, 0);
  rig_free(rig);
}

static void test_dent(void) {
  const SporeDent dent = {{0, 0, 0}, {0, -1e-3, 0}, 2e-3};
  SporeVec3 middle = spore_dents_at(&dent, 1, dent.at);
  double near = spore_vec3_length(spore_dents_at(&dent, 1, spore_vec3(0.1, 0, 0))),
         far = spore_vec3_length(spore_dents_at(&dent, 1, spore_vec3(0.2, 0, 0)));
  g_assert_cmpfloat(spore_vec3_distance(middle, dent.push), <, 1e-15);
  g_assert_cmpfloat(fabs(near / far / 8 - 1), <, 0.01);
  g_assert_cmpfloat(near, <, 1e-2 * 1e-3);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/effect/smoke-goes-with-the-air", test_smoke_goes_with_the_air);
  g_test_add_func("/stability/effect/smoke-has-no-limit", test_smoke_has_no_limit);
  g_test_add_func("/stability/effect/tissue-gives-way", test_tissue_gives_way);
  g_test_add_func("/stability/effect/others-do-not-feel-it", test_others_do_not_feel_it);
  g_test_add_func("/stability/effect/there-and-back", test_there_and_back);
  g_test_add_func("/stability/effect/rigid-stands", test_rigid_stands);
  g_test_add_func("/stability/effect/drops-pool", test_drops_pool);
  g_test_add_func("/stability/effect/drops-push-nothing", test_drops_push_nothing);
  g_test_add_func("/stability/effect/drops-slip", test_drops_slip);
  g_test_add_func("/stability/effect/drops-there-and-back", test_drops_there_and_back);
  g_test_add_func("/stability/effect/drops-sleep", test_drops_sleep);
  g_test_add_func("/stability/effect/drops-follow-the-ground", test_drops_follow_the_ground);
  g_test_add_func("/stability/effect/sleeping-pool-is-sucked", test_sleeping_pool_is_sucked);
  g_test_add_func("/stability/effect/blood-stains", test_blood_stains);
  g_test_add_func("/stability/effect/water-washes", test_water_washes);
  g_test_add_func("/stability/effect/lens-is-wetted", test_lens_is_wetted);
  g_test_add_func("/stability/effect/smoke-hazes", test_smoke_hazes);
  g_test_add_func("/stability/effect/irrigation-washes", test_irrigation_washes);
  g_test_add_func("/stability/effect/dent", test_dent);
  g_test_add_func("/stability/effect/seeping", test_seeping);
  g_test_add_func("/stability/effect/blood-stains-lines", test_blood_stains_lines);
  return g_test_run();
}
