/* Contacts that come to rest and stay there: cases 33 and 34; and how smoothly they slide. */
#include <math.h>

#include "tests/stability/rig.h"

#define STIFFNESS 1e5 /* N/m */
#define DAMPING 100   /* N s/m */

static SporeBodyDescription *give_law(SporeBodyDescription *body, double friction) {
  body->contact.stiffness = STIFFNESS;
  body->contact.damping = DAMPING;
  body->contact.friction = friction;
  return body;
}

/* A plane through the origin: the top of a sphere so large that it is flat. */
static void add_plane(Rig *rig, const char *name, SporeVec3 up, double friction) {
  const double radius = 1e4;
  give_law(rig_unmovable(rig, name, rig_sphere(rig, radius)), friction)->pose.position = spore_vec3_scale(-radius, up);
}

/* A box with spheres in its corners that just fill it. */
static SporeBodyDescription *add_box(Rig *rig, const char *name, SporeVec3 sides, double radius, double friction) {
  double corners[24], *corner = corners;
  for (int i = 0; i < 8; i++, corner += 3)
    spore_vec3_store(corner, spore_vec3((i & 1 ? 1 : -1) * (0.5 * sides.x - radius),
                                        (i & 2 ? 1 : -1) * (0.5 * sides.y - radius),
                                        (i & 4 ? 1 : -1) * (0.5 * sides.z - radius)));
  const SporeSphereSet *spheres = rig_spheres(rig, corners, 8, radius);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), sides);
  return give_law(rig_passive(rig, name, rig_surface_model(&spore_rigid_body, &box, NULL), spheres), friction);
}

/* The same of tetrahedra, from corner 0 on. */
static SporeBodyDescription *add_soft_box(Rig *rig, const char *name, SporeVec3 sides, double radius, double friction) {
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, 2, 1, 2, sides);
  const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, mesh.vertex_count, radius);
  SporeModel *model = rig_tetrahedra_model(&mesh, "young_modulus", 1e6, NULL);
  return give_law(rig_passive(rig, name, model, spheres), friction);
}

/* Speed of the fastest sphere of the body, m/s. */
static double fastest(const SporeWorld *world, uint32_t body) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  double most = 0;
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == body) most = fmax(most, spore_vec3_length(spore_vec3_load(spheres->velocity + 3 * i)));
  return most;
}

/* Mean over the body's spheres of a coordinate, or of its speed, along x. */
static double mean_x(const SporeWorld *world, uint32_t body, gboolean speed) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  double sum = 0, count = 0;
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == body) sum += (speed ? spheres->velocity : spheres->centre)[3 * i], count++;
  return sum / count;
}

/* Gravity as on a slope that falls by `slope` along x; the plane stays where it is. */
static SporeVec3 gravity_on_slope(double slope) {
  double angle = atan(slope);
  return spore_vec3(9.81 * sin(angle), -9.81 * cos(angle), 0);
}

/* Case 34: a block comes to rest on a plane, which is then tilted to `slope` within a second or two: mu = slope is what
 * just holds. Close to it the soft block slides a little until all of its contacts pull uphill, at a millimetre a
 * second or less; at mu = slope nothing takes that speed away again, a thousandth below it stops for good. */
static void slide(double friction, double slope, gboolean soft, SporeIntegratorKind integrator) {
  const double explicit_step = soft ? 1e-5 : 2e-4;
  const double time_step = integrator == SPORE_INTEGRATOR_SYMPLECTIC_EULER ? explicit_step : 2e-3;
  Rig *rig = rig_new();
  rig->description.gravity = gravity_on_slope(0);
  rig->description.solver.sleep_speed = 0; /* friction alone is to hold */
  rig->description.solver.integrator = (int)integrator;
  rig->description.solver.time_step = time_step;
  add_plane(rig, "slope", spore_vec3(0, 1, 0), friction);
  const SporeVec3 sides = {0.1, 0.04, 0.1};
  if (soft) add_soft_box(rig, "block", sides, 0.01, friction)->pose.position = spore_vec3(0, 0.01, 0);
  else add_box(rig, "block", sides, 0.01, friction)->pose.position = spore_vec3(0, 0.02, 0);
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(0.5 / time_step));
  for (unsigned i = 1; i <= 1000; i++) {
    SporeCommand tilt = {.kind = SPORE_COMMAND_GRAVITY, .vector = gravity_on_slope(1e-3 * slope * i)};
    g_assert_true(spore_world_post(world, &tilt));
    rig_run(world, MAX(1, (unsigned)lround(1e-3 / time_step)));
  }
  rig_run(world, (unsigned)lround((friction > slope ? 1 : 0.2) / time_step));
  double start = mean_x(world, 1, FALSE), start_speed = mean_x(world, 1, TRUE);
  rig_run(world, (unsigned)lround(1 / time_step));
  double moved = mean_x(world, 1, FALSE) - start;
  SporeVec3 pull = gravity_on_slope(slope);
  double expected = start_speed + 0.5 * (pull.x + friction * pull.y);
  g_test_message("case 34: mu %g, %s, %s: %.3g m in a second on a slope of %g (slipping: %.3g m), then %.3g m/s",
                 friction, soft ? "soft" : "rigid", spore_integrator_names[integrator], moved, slope, expected,
                 fastest(world, 1));
  if (friction < slope) g_assert_cmpfloat(fabs(moved - expected), <, 0.02 * expected);
  else if (friction > slope) g_assert_cmpfloat(fmax(fabs(moved), fastest(world, 1)), <, 1e-7);
  else g_assert_cmpfloat(fabs(moved), <, 3e-3); /* just held: nothing brakes what speed there is; at 0.49 it is 6e-2 */
  rig_free(rig);
}

static void case_34(void) {
  static const double cases[][2] = {{0.49, 0.5}, {0.5, 0.5}, {0.5, 0.4995}};
  for (unsigned i = 0; i < G_N_ELEMENTS(cases); i++)
    for (int soft = 0; soft < 2; soft++) {
      slide(cases[i][0], cases[i][1], soft, SPORE_INTEGRATOR_IMPLICIT_EULER);
      slide(cases[i][0], cases[i][1], soft, SPORE_INTEGRATOR_SYMPLECTIC_EULER);
    }
}

/* Runs for 4 s; then, for half a second, nothing may move faster than a hundredth of a millimetre a second, nor creep.
 */
static void expect_rest(Rig *rig, const char *what, uint32_t body) {
  SporeWorld *world = rig_build(rig);
  double time_step = rig->description.solver.time_step, jitter = 0;
  rig_run(world, (unsigned)lround(4 / time_step));
  SporeVec3 start = spore_vec3_load(spore_world_q(world, body));
  for (unsigned i = 0; i < (unsigned)lround(0.5 / time_step); i++) {
    spore_world_step(world);
    jitter = fmax(jitter, fastest(world, body));
  }
  SporeVec3 end = spore_vec3_load(spore_world_q(world, body));
  double creep = spore_vec3_distance(start, end);
  g_test_message("case 33: %s, %s: rests at (%.4f %.4f %.4f) m on %u contacts, jitter %.2g m/s, creep %.2g m in 0.5 s, "
                 "%u recoveries",
                 what, spore_integrator_names[rig->description.solver.integrator], end.x, end.y, end.z,
                 (unsigned)spore_world_counts(world).contacts, jitter, creep,
                 (unsigned)spore_world_monitor(world)->recoveries);
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_cmpfloat(jitter, <, 1e-5);
  g_assert_cmpfloat(creep, <, 1e-6);
  g_assert_cmpuint(spore_world_counts(world).contacts, >, 0);
}

static Rig *new_rest_rig(SporeIntegratorKind integrator) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.sleep_speed = 0;
  rig->description.solver.integrator = (int)integrator;
  rig->description.solver.time_step = integrator == SPORE_INTEGRATOR_SYMPLECTIC_EULER ? 2e-4 : 2e-3;
  return rig;
}

/* A box, edge down, dropped into a groove of 90 degrees and of 60: two sides press at once. */
static void wedge(SporeIntegratorKind integrator) {
  for (double half = 30; half <= 45; half += 15) {
    Rig *rig = new_rest_rig(integrator);
    double angle = half / 180 * G_PI;
    add_plane(rig, "left", spore_vec3(cos(angle), sin(angle), 0), 0.3);
    add_plane(rig, "right", spore_vec3(-cos(angle), sin(angle), 0), 0.3);
    add_box(rig, "wedge", spore_vec3(0.05, 0.05, 0.1), 0.005, 0.3)->pose =
        (SporePose){{0.003, 0.07, 0}, spore_quat_from_rotation_vector(spore_vec3(0, 0, 0.7))};
    g_autofree char *what = g_strdup_printf("wedge in a groove of %g degrees", 2 * half);
    expect_rest(rig, what, 2);
    rig_free(rig);
  }
}

/* A stake of ever smaller spheres dropped into the hollow between four spheres of a floor, where it jams upright. */
static void spike(SporeIntegratorKind integrator) {
  Rig *rig = new_rest_rig(integrator);
  give_law(rig_unmovable(rig, "floor", rig_floor(rig, 10, 10, 0.02, 0.01)), 0.5);
  double points[3 * 20];
  for (int i = 0; i < 20; i++) spore_vec3_store(points + 3 * i, spore_vec3(0, 0.005 * i - 0.0475, 0));
  const SporeSphereSet *spheres = rig_spheres(rig, points, 20, 1);
  for (int i = 0; i < 20; i++) spheres->spheres[4 * i + 3] = 0.0005 * (i + 1);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0.01, 0), spore_vec3(0.01, 0.08, 0.01));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &box, NULL);
  give_law(rig_passive(rig, "spike", model, spheres), 0.5)->pose =
      (SporePose){{-0.0405, 0.04, 0.0003}, spore_quat_from_rotation_vector(spore_vec3(0.01, 0, 0.02))};
  expect_rest(rig, "spike between spheres", 1);
  rig_free(rig);
}

/* A long box with two fifths of it over the edge of a table, and one with its corner on it. */
static void cliff(SporeIntegratorKind integrator) {
  for (int turned = 0; turned < 2; turned++) {
    Rig *rig = new_rest_rig(integrator);
    SporeBodyDescription *table = give_law(rig_unmovable(rig, "table", rig_floor(rig, 11, 11, 0.02, 0.015)), 0.5);
    table->pose.position = spore_vec3(-0.1, 0, 0); /* its last row is at x = 0 */
    double points[3 * 44];
    for (int i = 0; i < 44; i++)
      spore_vec3_store(points + 3 * i, spore_vec3(0.01 * (i / 4) - 0.05, i & 1 ? 0.01 : -0.01, i & 2 ? 0.02 : -0.02));
    const SporeSphereSet *spheres = rig_spheres(rig, points, 44, 0.005);
    SporeTriangleMesh box;
    shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.11, 0.03, 0.05));
    SporeModel *model = rig_surface_model(&spore_rigid_body, &box, NULL);
    give_law(rig_passive(rig, "box", model, spheres), 0.5)->pose =
        (SporePose){{-0.012, 0.02, 0.003}, spore_quat_from_rotation_vector(spore_vec3(0, 0.6 * turned, 0))};
    expect_rest(rig, turned ? "box turned across the edge of a cliff" : "box over the edge of a cliff", 1);
    rig_free(rig);
  }
}

static void case_33(void) {
  static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_IMPLICIT_EULER};
  for (unsigned i = 0; i < G_N_ELEMENTS(kinds); i++) {
    wedge(kinds[i]);
    spike(kinds[i]);
    cliff(kinds[i]);
  }
}

typedef struct Slide {
  double lost, height, ripple; /* part of the speed; m, mean of the ball's centre and deviation */
} Slide;

/* A ball without friction on a floor of spheres a radius apart, pushed along a row. */
static Slide slide_ball(SporeSurface surface, double radius) {
  Rig *rig = new_rest_rig(SPORE_INTEGRATOR_IMPLICIT_EULER);
  rig->description.solver.time_step = 1e-3;
  SporeBodyDescription *floor = give_law(rig_unmovable(rig, "floor", rig_floor(rig, 61, 9, 0.01, 0.01)), 0);
  floor->contact.surface = (int)surface;
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(radius, radius, radius));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &box, "mass", 0.1, NULL);
  SporeBodyDescription *ball = give_law(rig_passive(rig, "ball", model, rig_sphere(rig, radius)), 0);
  ball->pose.position = spore_vec3(-0.2, radius, 0);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 500);
  double velocity[6] = {0.2};
  spore_world_set_state(world, 1, spore_world_q(world, 1), velocity);
  Slide slide = {0, 0, 0};
  const unsigned steps = 1500;
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    double y = spore_world_q(world, 1)[1];
    slide.height += y / steps;
    slide.ripple += y * y / steps;
  }
  slide.ripple = sqrt(fmax(0, slide.ripple - slide.height * slide.height));
  slide.lost = 1 - spore_world_v(world, 1)[0] / 0.2;
  rig_free(rig);
  return slide;
}

/* Sliding over spheres, felt one by one and as one depth field: bumps take speed away, and shake. */
static void test_surface(void) {
  for (double radius = 0.005; radius < 0.03; radius *= 2) {
    Slide spheres = slide_ball(SPORE_SURFACE_SPHERES, radius), field = slide_ball(SPORE_SURFACE_DEPTH_FIELD, radius);
    g_test_message(
        "surface: ball of %g mm over spheres of 10 mm, 0.3 m at 0.2 m/s: one by one it loses %.2g of its speed "
        "and shakes by %.2g mm, on the depth field %.2g and %.2g mm",
        radius * 1e3, spheres.lost, spheres.ripple * 1e3, field.lost, field.ripple * 1e3);
    g_assert_cmpfloat(fabs(field.lost), <, 0.01);
    g_assert_cmpfloat(field.ripple, <, 2e-5);
    g_assert_cmpfloat(spheres.lost, >, 0.5); /* what there is to win */
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/33_sharp", case_33);
  g_test_add_func("/stability/surface", test_surface);
  g_test_add_func("/stability/34_slope", case_34);
  return g_test_run();
}
