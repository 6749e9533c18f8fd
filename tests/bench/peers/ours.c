/* The cases of case.h by us. Besides what they share, for the solver: integrator=NAME nonlinear=NAME substeps=N
 * newton=N linear=N tolerance=X. */
#include <math.h>

#include "core/base/memory.h"
#include "core/sim/world.h"
#include "models/registry.h"
#include "tests/bench/peers/case.h"
#include "tests/bench/sofa/hardware.h"
#include "tests/stability/chain.h"
#include "tests/stability/rig.h"

static void refuse(const SporeError *error) {
  fprintf(stderr, "%s: %s\n", error->place, error->message);
  exit(1);
}

static void set(const SporeParameterTable *table, void *fields, const char *name, const char *text) {
  SporeError error = SPORE_ERROR_INIT;
  const SporeParameter *parameter = table->parameters + spore_parameter_find(table, name);
  SporeValue value;
  if (!spore_parameter_parse(parameter, text, &value, &error)) refuse(&error);
  spore_parameter_store(parameter, &value, fields);
  spore_value_clear(&value);
}

static void set_solver(SporeSolverFields *solver, const char *name, const char *text) {
  set(&spore_solver_parameters, solver, name, text);
}

static Rig *begin(const CaseRun *run, const char *integrator) {
  Rig *rig = rig_new();
  SporeSolverFields *solver = &rig->description.solver;
  rig->description.gravity = spore_vec3(0, -CASE_GRAVITY, 0);
  set_solver(solver, "integrator", integrator);
  set_solver(solver, "maximum_speed", "1000");
  set_solver(solver, "sleep_speed", "0"); /* no peer sleeps here */
  for (size_t p = 0; p < spore_solver_parameters.count; p++) {
    const char *name = spore_solver_parameters.parameters[p].name, *text = case_word(run, name, NULL);
    if (text) set_solver(solver, name, text);
  }
  solver->time_step = case_time_step(run);
  return rig;
}

/* Depth of the contacts over `radius`, the mean of those listed in the snapshot. */
static double mean_depth(SporeWorld *world, double radius) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  double sum = 0;
  size_t count = MIN(snapshot->contact_count, snapshot->contact_capacity);
  for (size_t i = 0; i < count; i++) {
    uint32_t a = snapshot->contacts[i].sphere_a, b = snapshot->contacts[i].sphere_b;
    sum += spheres->radius[a] + spheres->radius[b] -
           spore_vec3_distance(spore_vec3_load(spheres->centre + 3 * (size_t)a),
                               spore_vec3_load(spheres->centre + 3 * (size_t)b));
  }
  return count ? sum / (double)count / radius : 0;
}

/* Runs, answers and ends. A body of nodes tells where they are, another where it is. */
static void finish(CaseRun *run, Rig *rig) {
  SporeWorld *world = rig->world;
  double newton = 0, linear = 0, residual = 0, first = 0, mean = 0,
         square = 0; /* the last two: energy beside `first` */
  uint32_t bodies = (uint32_t)spore_world_body_count(world);
  for (unsigned count; (count = case_next_frame(run));) {
    rig_run(world, count);
    case_stop(run);
    SporeStepCounts counts = spore_world_counts(world);
    newton += (double)counts.newton_iterations / run->frames;
    linear += (double)counts.linear_iterations / run->frames;
    residual = fmax(residual, counts.residual);
    double energy = rig_energy(world);
    if (run->frame == 1) first = energy;
    mean += (energy - first) / run->frames, square += (energy - first) * (energy - first) / run->frames;
    for (uint32_t b = 0; b < bodies; b++) {
      const SporeModel *model = spore_world_body_model(world, b);
      const double *q = spore_world_q(world, b);
      size_t nodes = !model ? 0 : spore_model_is_nodal(model) ? model->block_count : 1;
      for (size_t i = 0; i < nodes; i++) case_node(run, q[3 * i], q[3 * i + 1], q[3 * i + 2]);
    }
  }
  const SporeMonitor *monitor = spore_world_monitor(world);
  char more[320];
  snprintf(more, sizeof more,
           ", \"contacts\": %zu, \"depth\": %.6g, \"newton\": %.3g, \"linear\": %.3g, \"residual\": %.3g, "
           "\"astray\": %.6g, \"mended\": %llu",
           spore_world_counts(world).contacts, mean_depth(world, PILE_RADIUS), newton, linear, residual,
           sqrt(fmax(0, square - mean * mean)), (unsigned long long)(monitor->recoveries + monitor->not_converged));
  case_end(run, more);
  rig_free(rig);
}

/* What the kernel refuses, such as too large a step, is the caller's to know. */
static void build(Rig *rig) {
  SporeError error = SPORE_ERROR_INIT;
  if (!rig_try_build(rig, &error)) refuse(&error);
}

/* The cloth with its nodes where `place` says. */
static void add_cloth(CaseRun *run, Rig *rig, void (*place)(unsigned, double[3]), const SporeSphereSet *spheres) {
  SporeTriangleMesh mesh;
  g_assert_true(spore_triangle_mesh_allocate(&mesh, CLOTH_NODES * CLOTH_NODES, CLOTH_TRIANGLES, NULL));
  for (unsigned i = 0; i < CLOTH_NODES * CLOTH_NODES; i++) place(i, mesh.vertices + 3 * i);
  for (unsigned t = 0; t < CLOTH_TRIANGLES; t++) cloth_triangle(t, mesh.triangles + 3 * t);
  SporeModel *model = rig_surface_model(&spore_mass_spring_net, &mesh, "mass", CLOTH_MASS, "structural_stiffness",
                                        case_number(run, "stiffness", 100), "shear_stiffness", 0.0, "bending_stiffness",
                                        0.0, "damping", CLOTH_DAMPING, NULL);
  rig_passive(rig, "cloth", model, spheres);
}

static void cloth(CaseRun *run) {
  Rig *rig = begin(run, "symplectic_euler");
  add_cloth(run, rig, cloth_node, NULL);
  for (unsigned i = 0; i < CLOTH_NODES; i++) {
    double held[3];
    cloth_node(i, held);
    rig_pin(rig, 0, spore_vec3_load(held), 1e-3);
  }
  build(rig);
  finish(run, rig);
}

/* Contact springs of both sides are in series. */
static void add_net_and_balls(CaseRun *run, Rig *rig) {
  const SporeContactFields contact = {.stiffness = 2 * NET_CONTACT};
  double points[3 * CLOTH_NODES * CLOTH_NODES];
  for (unsigned i = 0; i < CLOTH_NODES * CLOTH_NODES; i++) {
    net_node(i, points + 3 * i);
    if (net_is_held(i)) rig_pin(rig, 0, spore_vec3_load(points + 3 * i), 1e-3);
  }
  add_cloth(run, rig, net_node, rig_spheres(rig, points, CLOTH_NODES * CLOTH_NODES, NET_NODE_RADIUS));
  g_array_index(rig->bodies, SporeBodyDescription, 0).contact = contact;
  for (int b = 0; b < NET_BALLS; b++) {
    SporeBodyDescription *ball = rig_unmovable(rig, "ball", rig_sphere(rig, NET_BALL_RADIUS));
    ball->pose.position = spore_vec3_load(net_ball[b]);
    ball->contact = contact;
  }
}

static void net(CaseRun *run) {
  Rig *rig = begin(run, "symplectic_euler");
  double x[3 * CLOTH_NODES * CLOTH_NODES], v[3 * CLOTH_NODES * CLOTH_NODES] = {0};
  add_net_and_balls(run, rig);
  build(rig);
  memcpy(x, spore_world_q(rig->world, 0), sizeof x);
  for (size_t i = 0; i < sizeof x / sizeof *x; i++) x[i] *= NET_STRETCH;
  spore_world_set_state(rig->world, 0, x, v);
  finish(run, rig);
}

static void rope(CaseRun *run) {
  enum { SPRINGS = ROPE_NODES - 1 };
  double stiffness[SPRINGS], mass[ROPE_NODES];
  for (int i = 0; i < SPRINGS; i++) stiffness[i] = case_number(run, "stiffness", 1000);
  for (int i = 0; i < ROPE_NODES; i++) mass[i] = ROPE_MASS / ROPE_NODES;
  Rig *rig = begin(run, "symplectic_euler");
  SporeModel *model = chain_new(SPRINGS, ROPE_LENGTH / SPRINGS, stiffness, mass, case_number(run, "damping", 0));
  rig_passive(rig, "rope", model, NULL)->pose.orientation = spore_quat_from_rotation_vector(spore_vec3(0, 0, G_PI / 2));
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  build(rig);
  finish(run, rig);
}

static SporeModel *make_bar(const CaseRun *run, unsigned parts) {
  SporeTetrahedralMesh mesh;
  g_assert_true(spore_tetrahedral_mesh_allocate(&mesh, bar_nodes(parts), bar_tetrahedra(parts), NULL));
  for (unsigned i = 0; i < mesh.vertex_count; i++) bar_node(parts, i, mesh.vertices + 3 * i);
  for (unsigned t = 0; t < mesh.tetrahedron_count; t++) bar_tetrahedron(parts, t, mesh.tetrahedra + 4 * t);
  bool neo_hookean = !strcmp(case_word(run, "law", "corotational"), "neo_hookean");
  return rig_solid_model(neo_hookean ? &spore_neo_hookean_tetrahedra : &spore_corotational_tetrahedra, &mesh,
                         "young_modulus", BAR_YOUNG_MODULUS, "poisson_ratio",
                         case_number(run, "poisson_ratio", BAR_POISSON_RATIO), "density", BAR_DENSITY,
                         "stiffness_damping", case_number(run, "viscosity", BAR_VISCOSITY), NULL);
}

static void bar(CaseRun *run) {
  unsigned parts = (unsigned)case_number(run, "parts", 1);
  Rig *rig = begin(run, "implicit_euler");
  rig_passive(rig, "bar", make_bar(run, parts), NULL);
  for (unsigned i = 0; i < bar_nodes(parts); i++) {
    double x[3];
    bar_node(parts, i, x);
    if (x[0] == 0) rig_pin(rig, 0, spore_vec3_load(x), 1e-3);
  }
  build(rig);
  finish(run, rig);
}

/* A wall is one unmovable sphere, so big that over the pile it is a plane to within 1e-6 m. */
#define WALL_RADIUS 1e5
static void add_wall(Rig *rig, const char *name, SporeVec3 normal, double distance, const SporeContactFields *contact) {
  SporeBodyDescription *wall = rig_unmovable(rig, name, rig_sphere(rig, WALL_RADIUS));
  wall->pose.position = spore_vec3_scale(-(distance + WALL_RADIUS), normal);
  wall->contact = *contact;
}

/* Mass and inertia of a ball, those of the latter by a cube. */
static SporeModel *make_ball(void) {
  double side = sqrt(2.4) * PILE_RADIUS, mass = PILE_DENSITY * 4 / 3 * G_PI * pow(PILE_RADIUS, 3);
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  return rig_surface_model(&spore_rigid_body, &cube, "mass", mass, NULL);
}

static void pile(CaseRun *run) {
  Rig *rig = begin(run, "symplectic_euler");
  const SporeContactFields contact = {.stiffness = case_number(run, "stiffness", 2e5),
                                      .damping = case_number(run, "damping", 100),
                                      .friction = PILE_FRICTION};
  const SporeSphereSet *sphere = rig_sphere(rig, PILE_RADIUS);
  for (unsigned i = 0; i < PILE_SPHERES; i++) {
    double centre[3];
    pile_start(run, i, centre);
    SporeBodyDescription *body = rig_passive(rig, "sphere", make_ball(), sphere);
    body->pose.position = spore_vec3_load(centre);
    body->contact = contact;
  }
  add_wall(rig, "floor", spore_vec3(0, 1, 0), 0, &contact);
  add_wall(rig, "left", spore_vec3(1, 0, 0), PILE_HALF, &contact);
  add_wall(rig, "right", spore_vec3(-1, 0, 0), PILE_HALF, &contact);
  add_wall(rig, "back", spore_vec3(0, 0, 1), PILE_HALF, &contact);
  add_wall(rig, "front", spore_vec3(0, 0, -1), PILE_HALF, &contact);
  build(rig);
  rig_run(rig->world, (unsigned)case_number(run, "settle", 2000));
  finish(run, rig);
}

/* The Lennard-Jones liquid in units where sigma, epsilon and a particle's mass are 1: 4 cells^3 particles of density
 * 0.8442 in a periodic cube. */
static void fluid(CaseRun *run) {
  unsigned count = 4 * (unsigned)pow(case_number(run, "cells", 4), 3);
  double side = cbrt(count / 0.8442);
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  const SporeParameterTable *table = &spore_lennard_jones.parameters;
  char period[96], *fields = spore_allocate(1, table->size);
  snprintf(period, sizeof period, "%.17g %.17g %.17g", side, side, side);
  spore_parameters_set_initial(table, fields);
  const struct {
    const char *name, *text;
  } values[] = {{"density", "0.8442"}, {"surface_tension", "0.585"}, {"temperature", "1.44"}, {"period", period}};
  for (size_t i = 0; i < G_N_ELEMENTS(values); i++) set(table, fields, values[i].name, values[i].text);
  ((int64_t *)(void *)(fields + table->parameters[spore_parameter_find(table, "particles")].offset))[0] = count;
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model = spore_lennard_jones.create(&(SporeGeometry){.surface = &cube}, fields, &error);
  spore_free(fields);
  spore_triangle_mesh_clear(&cube);
  if (!model) refuse(&error);
  Rig *rig = begin(run, "verlet");
  rig->description.gravity = spore_vec3(0, 0, 0);
  rig_passive(rig, "fluid", model, NULL);
  build(rig);
  rig_run(rig->world, (unsigned)case_number(run, "settle", 0));
  finish(run, rig);
}

/* What the machine can do, for the floors: a working set of the second level of cache. */
static void machine(void) {
  printf("{\"gflops\": %.4g, \"gbytes\": %.4g}\n", hardware_peak(), hardware_bandwidth(512 << 10));
}

int main(int argc, char **argv) {
  CaseRun run = case_begin(argc, argv);
  const char *name = argc > 1 ? argv[1] : "";
  if (!strcmp(name, "cloth")) cloth(&run);
  else if (!strcmp(name, "net")) net(&run);
  else if (!strcmp(name, "bar")) bar(&run);
  else if (!strcmp(name, "rope")) rope(&run);
  else if (!strcmp(name, "pile")) pile(&run);
  else if (!strcmp(name, "fluid")) fluid(&run);
  else if (!strcmp(name, "machine")) machine();
  else return 2;
  return 0;
}
