/* Node splitting: scissors cut tetrahedra apart. */
#include <math.h>
#include <string.h>

#include "core/base/cpu.h"
#include "core/base/memory.h"
#include "core/base/threads.h"
#include "models/tetrahedra/map.h"
#include "tests/conformance/specimen.h"
#include "tests/stability/rig.h"

static const SporeModelType *const types[] = {&spore_corotational_tetrahedra, &spore_neo_hookean_tetrahedra,
                                              &spore_saint_venant_kirchhoff_tetrahedra};

enum { NX = 8, NY = 3, NZ = 3 };
#define LENGTH 0.04
#define SIDE 0.015
#define CUT_AT 0.0221 /* of the length: between planes of nodes */

/* Opens at once and closes from 0.1 s on, across the bar. */
static bool cutter_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                            SporeDeviceState *state) {
  *state = (SporeDeviceState){
      .position = {CUT_AT, -0.01, 0.5 * SIDE}, .orientation = {1, 0, 0, 0}, .grip_rad = time_s < 0.1 ? 1.2 : 0};
  return true;
}
static void cutter_close(SporeDevice *device) {}
static const SporeDeviceType cutter_type = {
    .name = "cutter", .doc = "", .exchange = cutter_exchange, .close = cutter_close};

typedef struct Bar {
  Rig *rig;
  SporeTetrahedralMesh mesh;
  SporeDevice cutter;
} Bar;

static Bar *bar_new(const SporeModelType *type, double reserve) {
  Bar *bar = g_new0(Bar, 1);
  bar->rig = rig_new();
  bar->cutter.type = &cutter_type;
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, NX, NY, NZ, spore_vec3(LENGTH, SIDE, SIDE));
  shape_block(&bar->mesh, NX, NY, NZ, spore_vec3(LENGTH, SIDE, SIDE));
  double points[3 * NX];
  for (int i = 0; i < NX; i++)
    memcpy(points + 3 * i, (double[3]){(i + 0.5) * LENGTH / NX, 0.9 * SIDE, 0.4 * SIDE}, 3 * sizeof *points);
  rig_passive(
      bar->rig, "bar",
      rig_solid_model(type, &mesh, "cut_reserve", reserve, "young_modulus", 20000.0, "stiffness_damping", 0.02, NULL),
      rig_spheres(bar->rig, points, NX, 0.002));
  rig_active(bar->rig, "shaft", NULL)->pose.position = spore_vec3(CUT_AT, -0.01, 0.5 * SIDE);
  rig_unmovable(bar->rig, "far", rig_sphere(bar->rig, 0.01))->pose.position = spore_vec3(1, 1, 1);
  SporeJawFields *fields = rig_tool_fields(rig_tool(bar->rig, &spore_scissors, "scissors", 1));
  spore_vec3_store(fields->hinge, spore_vec3(CUT_AT, -0.01, 0.5 * SIDE));
  spore_vec3_store(fields->axis, spore_vec3(1, 0, 0));
  spore_vec3_store(fields->tip, spore_vec3(CUT_AT, 0.04, 0.5 * SIDE));
  fields->speed = 20;
  fields->opening = 1.2;
  return bar;
}

static SporeWorld *bar_build(Bar *bar) {
  SporeWorld *world = rig_build(bar->rig);
  spore_world_set_device(world, 1, &bar->cutter);
  return world;
}

static void bar_free(Bar *bar) {
  spore_tetrahedral_mesh_clear(&bar->mesh);
  rig_free(bar->rig);
  g_free(bar);
}

static const SporeModel *model_of(const Bar *bar) {
  return g_array_index(bar->rig->bodies, SporeBodyDescription, 0).model;
}

static const uint32_t *corners_of(const Bar *bar) {
  size_t count;
  const SporeModel *model = model_of(bar);
  return model->type->cut->corners(model, &count);
}

typedef struct Sums {
  double mass, volume, thinnest; /* thinnest: least volume of a tetrahedron against that at rest */
  SporeVec3 momentum, spin;
} Sums;

static Sums sums_of(const Bar *bar) {
  const SporeModel *model = model_of(bar);
  const double *q = spore_world_q(bar->rig->world, 0), *v = spore_world_v(bar->rig->world, 0);
  Sums sums = {.thinnest = HUGE_VAL};
  for (size_t i = 0; i < model->node_count; i++) {
    SporeVec3 p = spore_vec3_scale(model->block_mass[i], spore_vec3_load(v + 3 * i));
    sums.mass += model->block_mass[i];
    sums.momentum = spore_vec3_add(sums.momentum, p);
    sums.spin = spore_vec3_add(sums.spin, spore_vec3_cross(spore_vec3_load(q + 3 * i), p));
  }
  const uint32_t *corners = corners_of(bar);
  for (size_t t = 0; t < bar->mesh.tetrahedron_count; t++) {
    SporeVec3 gradient[3];
    double now = spore_tetrahedron_gradients(q, corners + 4 * t, gradient);
    double rest = spore_tetrahedron_gradients(bar->mesh.vertices, bar->mesh.tetrahedra + 4 * t, gradient);
    sums.volume += now / 6;
    sums.thinnest = fmin(sums.thinnest, now / rest);
  }
  return sums;
}

static uint32_t root_of(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i];
  return i;
}

/* Pieces: tetrahedra that hang together by nodes. *least: tetrahedra of the smallest. */
static unsigned pieces_of(const Bar *bar, unsigned *least) {
  size_t nodes = model_of(bar)->node_count, count = bar->mesh.tetrahedron_count;
  uint32_t *parent = g_new(uint32_t, nodes);
  unsigned *size = g_new0(unsigned, nodes), pieces = 0;
  const uint32_t *corners = corners_of(bar);
  for (uint32_t i = 0; i < nodes; i++) parent[i] = i;
  for (size_t t = 0; t < count; t++)
    for (int k = 1; k < 4; k++) parent[root_of(parent, corners[4 * t])] = root_of(parent, corners[4 * t + k]);
  for (size_t t = 0; t < count; t++) size[root_of(parent, corners[4 * t])]++;
  *least = G_MAXUINT;
  for (size_t i = 0; i < nodes; i++)
    if (size[i]) pieces++, *least = MIN(*least, size[i]);
  g_free(parent);
  g_free(size);
  return pieces;
}

static void run_to(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
}

/* A free bar is cut through: two bodies, each with its spheres; nothing of mass, volume and momentum is lost. Pinned at
 * one end, the other half falls. After a reset all is as before, to the bit. */
static void check_bar(const SporeModelType *type) {
  Bar *bar = bar_new(type, 0.5);
  for (int i = 0; i <= NY; i++)
    for (int k = 0; k <= NZ; k++) rig_pin(bar->rig, 0, spore_vec3(0, i * SIDE / NY, k * SIDE / NZ), 1e-5);
  SporeWorld *world = bar_build(bar);
  Sums whole = sums_of(bar);
  unsigned least, pieces = pieces_of(bar, &least);
  g_assert_cmpuint(pieces, ==, 1);
  uint64_t before = spore_allocation_count();
  run_to(world, 0.12);
  size_t first = spore_world_tool_state(world, 0).cut;
  run_to(world, 0.5);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  pieces = pieces_of(bar, &least);
  Sums parted = sums_of(bar);
  g_test_message(
      "%s: %zu faces at first, %zu in all; %u pieces, the smaller of %u tetrahedra; mass off by %.1e, volume "
      "by %.1e; %s",
      type->name, first, spore_world_tool_state(world, 0).cut, pieces, least, parted.mass / whole.mass - 1,
      parted.volume / whole.volume - 1, rig_last_message(world));
  g_assert_cmpuint(first, >, 0);
  g_assert_cmpuint(first, <, spore_world_tool_state(world, 0).cut); /* it follows the blades */
  g_assert_cmpuint(pieces, ==, 2);
  g_assert_cmpuint(least, >=, bar->mesh.tetrahedron_count / 3);
  g_assert_cmpfloat_with_epsilon(parted.mass, whole.mass, 1e-14 * whole.mass);
  g_assert_cmpfloat_with_epsilon(parted.volume, whole.volume, 1e-12 * whole.volume);
  const SporeCommand gravity = {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, 0, -9.81}};
  spore_world_post(world, &gravity);
  run_to(world, 1);
  const SporeSpheres *spheres = spore_world_spheres(world);
  double held = spheres->centre[3 * (spheres->count - NX) + 2], fallen = spheres->centre[3 * (spheres->count - 1) + 2];
  g_test_message("a sphere of the one at %.4f m, of the other at %.3f m; %s", held, fallen, rig_last_message(world));
  g_assert_cmpfloat(held, >, 0);
  g_assert_cmpfloat(fallen, <, -1);
  g_assert_cmpfloat(sums_of(bar).thinnest, >, 0.5);
  uint64_t hash = spore_world_hash(world);
  spore_world_reset(world);
  const SporeCommand none = {.kind = SPORE_COMMAND_GRAVITY};
  spore_world_post(world, &none);
  g_assert_cmpuint(pieces_of(bar, &least), ==, 1);
  run_to(world, 0.5);
  spore_world_post(world, &gravity);
  run_to(world, 1);
  g_assert_cmpuint(spore_world_hash(world), ==, hash);
  bar_free(bar);
}

static void test_bar(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(types); i++) check_bar(types[i]);
}

/* A model by itself, whose state is any. */
typedef struct Lone {
  SporeModel *model;
  SporeBlockMatrix matrix;
  SporeBlockPattern pattern;
  SporeBlockRoom room;
  size_t n;
  double *q, *v, *f, *g, *d, *y;
} Lone;

static void lone_init(Lone *lone, const SporeModelType *type, GRand *random) {
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, 5, 4, 4, spore_vec3(0.05, 0.04, 0.04));
  lone->model = rig_solid_model(type, &mesh, "cut_reserve", 8.0, NULL);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(type->cut->reserve(lone->model, &error));
  lone->n = 3 * lone->model->block_count;
  double **all[] = {&lone->q, &lone->v, &lone->f, &lone->g, &lone->d, &lone->y};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) *all[i] = g_new0(double, lone->n);
  type->place(lone->model, (SporePose){{0, 0, 0}, {1, 0, 0, 0}}, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), lone->q,
              lone->v);
  for (size_t i = 0; i < lone->n; i++) {
    lone->q[i] = 1.06 * lone->q[i] + g_rand_double_range(random, -0.0001, 0.0001);
    lone->v[i] = g_rand_double_range(random, -1, 1);
    lone->d[i] = g_rand_double_range(random, -1, 1);
  }
  spore_block_pattern_init(&lone->pattern, lone->model->block_count);
  g_assert_true(type->pattern(lone->model, &lone->pattern) &&
                spore_block_matrix_create_roomy(&lone->matrix, &lone->pattern, lone->pattern.block_count,
                                                lone->pattern.pair_count, &lone->room));
}

static void lone_clear(Lone *lone) {
  double *const all[] = {lone->q, lone->v, lone->f, lone->g, lone->d, lone->y};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) g_free(all[i]);
  spore_block_matrix_clear(&lone->matrix);
  spore_block_pattern_clear(&lone->pattern);
  spore_block_room_clear(&lone->room);
  lone->model->type->destroy(lone->model);
}

static void lone_sums(const Lone *lone, double sums[8]) {
  const SporeModel *model = lone->model;
  memset(sums, 0, 8 * sizeof *sums);
  for (size_t i = 0; i < model->node_count - model->spare_count; i++) {
    SporeVec3 p = spore_vec3_scale(model->block_mass[i], spore_vec3_load(lone->v + 3 * i));
    SporeVec3 l = spore_vec3_cross(spore_vec3_load(lone->q + 3 * i), p);
    const double of[] = {model->block_mass[i], p.x, p.y, p.z, l.x, l.y, l.z};
    for (size_t k = 0; k < G_N_ELEMENTS(of); k++) sums[k] += of[k];
  }
  sums[7] = model->type->potential(model, lone->q);
}

/* The matrix against a difference of forces, in one direction. */
static double lone_error(Lone *lone) {
  const SporeModelType *type = lone->model->type;
  double h = 1e-8, change = 0, error = 0;
  for (int side = -1; side <= 1; side += 2) {
    double *f = side < 0 ? lone->f : lone->g;
    memset(f, 0, lone->n * sizeof *f);
    for (size_t i = 0; i < lone->n; i++) lone->q[i] += side * h * lone->d[i];
    type->force(lone->model, lone->q, lone->q, lone->v, f);
    for (size_t i = 0; i < lone->n; i++) lone->q[i] -= side * h * lone->d[i];
  }
  spore_block_matrix_zero(&lone->matrix);
  type->jacobian(lone->model, lone->q, lone->q, lone->v, 1, 0, &lone->matrix);
  memset(lone->y, 0, lone->n * sizeof *lone->y);
  spore_block_matrix_multiply_add(&lone->matrix, lone->d, lone->y);
  for (size_t i = 0; i < lone->n; i++) {
    double difference = (lone->f[i] - lone->g[i]) / (2 * h);
    change += difference * difference, error += (difference - lone->y[i]) * (difference - lone->y[i]);
  }
  return sqrt(error / change);
}

static void random_triangle(GRand *random, double triangle[9]) {
  for (int k = 0; k < 9; k += 3)
    spore_vec3_store(triangle + k,
                     spore_vec3(g_rand_double_range(random, -0.02, 0.07), g_rand_double_range(random, -0.02, 0.06),
                                g_rand_double_range(random, -0.02, 0.06)));
}

/* A hundred cuts anywhere: what is parted has the mass, the momenta and the energy that it had, its matrix is right,
 * and no tetrahedron is alone. */
static void check_random(const SporeModelType *type) {
  GRand *random = g_rand_new_with_seed(7);
  Lone lone = {0};
  lone_init(&lone, type, random);
  double before[8], after[8], whole = lone.model->block_mass[0], off = 0, error = 0;
  lone_sums(&lone, before);
  size_t faces = 0, nodes = 0;
  SporeCuts cuts = {0};
  for (int i = 0; i < 100; i++) {
    double triangle[9];
    const uint32_t *from;
    random_triangle(random, triangle);
    faces += type->cut->cut(lone.model, lone.q, triangle, 0, &cuts);
    size_t made = type->cut->split(lone.model, lone.q, lone.v, &from);
    nodes += made;
    if (made > 0) {
      spore_block_pattern_empty(&lone.pattern);
      g_assert_true(type->pattern(lone.model, &lone.pattern) &&
                    spore_block_matrix_lay_out(&lone.matrix, &lone.pattern, &lone.room));
      type->settle(lone.model, &lone.matrix);
    }
    lone_sums(&lone, after);
    for (int k = 0; k < 8; k++) off = fmax(off, fabs(after[k] - before[k]) / (fabs(before[k]) + 1e-3 * before[0]));
    if (i % 25 == 24) { /* at rest: what the viscous force makes of shape is not in the matrix */
      double *kept = lone.v;
      lone.v = g_new0(double, lone.n);
      error = fmax(error, lone_error(&lone));
      g_free(lone.v);
      lone.v = kept;
    }
  }
  g_test_message("%s: %zu faces, %zu nodes more; mass, momenta and energy off by %.1e; matrix by %.1e", type->name,
                 faces, nodes, off, error);
  g_assert_null(type->notice(lone.model, lone.q));
  g_assert_cmpuint(nodes, >, 100);
  g_assert_cmpfloat(off, <, 1e-12);
  g_assert_cmpfloat(error, <, 1e-5);
  type->mend(lone.model);
  g_assert_cmpfloat(lone.model->block_mass[0], ==, whole);
  g_rand_free(random);
  lone_clear(&lone);
}

static void test_random(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(types); i++) check_random(types[i]);
}

/* Between the steps a body that was parted gets a factor of its new pattern, and takes fewer iterations then. */
static void test_tidy(void) {
  double iterations[2] = {0, 0};
  for (int tidy = 0; tidy < 2; tidy++) {
    Bar *bar = bar_new(&spore_neo_hookean_tetrahedra, 0.5);
    bar->rig->description.gravity = spore_vec3(0, 0, -9.81);
    bar->rig->description.solver.linear = SPORE_LINEAR_CHOLESKY;
    rig_pin(bar->rig, 0, spore_vec3(0, 0.5 * SIDE, 0.5 * SIDE), 0.6 * SIDE);
    rig_pin(bar->rig, 0, spore_vec3(LENGTH, 0.5 * SIDE, 0.5 * SIDE), 0.6 * SIDE);
    SporeWorld *world = bar_build(bar);
    unsigned done = 0;
    while (spore_world_time_s(world) < 0.5) {
      uint64_t before = spore_allocation_count();
      spore_world_step(world);
      g_assert_cmpuint(spore_allocation_count(), ==, before);
      if (tidy) done += spore_world_tidy(world);
      if (spore_world_time_s(world) > 0.35) iterations[tidy] += (double)spore_world_counts(world).linear_iterations;
    }
    g_assert_cmpuint(done, ==, tidy);
    g_assert_cmpstr(rig_last_message(world), ==, "");
    bar_free(bar);
  }
  g_test_message("linear iterations: %.0f without, %.0f with", iterations[0], iterations[1]);
  g_assert_cmpfloat(iterations[1], <, 0.5 * iterations[0]);
}

/* The same bits on one thread and on three, and at each level of the processor. */
static uint64_t hash_with(int threads, SporeCpuLevel level) {
  SporePool *pool = spore_pool_create(threads);
  spore_cpu_limit(level);
  Bar *bar = bar_new(&spore_neo_hookean_tetrahedra, 0.5);
  bar->rig->description.gravity = spore_vec3(0, 0, -9.81);
  rig_pin(bar->rig, 0, spore_vec3(0, 0, 0), 0.5 * SIDE);
  SporeWorld *world = rig_build_on(bar->rig, pool);
  spore_world_set_device(world, 1, &bar->cutter);
  run_to(world, 0.3);
  g_assert_cmpuint(spore_world_tool_state(world, 0).cut, >, 0);
  uint64_t hash = spore_world_hash(world);
  bar_free(bar);
  spore_pool_free(pool);
  return hash;
}

static void test_same(void) {
  SporeCpuLevel highest = spore_cpu_level();
  uint64_t hash = hash_with(1, highest);
  g_assert_cmpuint(hash_with(3, highest), ==, hash);
  for (SporeCpuLevel level = 0; level < highest; level++) g_assert_cmpuint(hash_with(1, level), ==, hash);
  spore_cpu_limit(highest);
}

/* Without nodes in reserve it stays whole, and that is said. Quadratic elements are refused where they could be cut. */
static void test_reserve(void) {
  Bar *bar = bar_new(&spore_neo_hookean_tetrahedra, 0.05);
  SporeWorld *world = bar_build(bar);
  unsigned least;
  run_to(world, 0.5);
  g_test_message("%s", rig_last_message(world));
  g_assert_cmpuint(pieces_of(bar, &least), ==, 1);
  g_assert_nonnull(strstr(rig_last_message(world), "cut_reserve"));
  g_assert_true(rig_finite(world));
  bar_free(bar);
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, 2, 2, 2, spore_vec3(0.02, 0.02, 0.02));
  SporeModel *model = rig_solid_model(&spore_neo_hookean_tetrahedra, &mesh, "element", 1.0, NULL);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(model->type->cut->reserve(model, &error));
  g_test_message("%s", error.message);
  g_assert_nonnull(strstr(error.message, "linear"));
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/node_splitting/bar", test_bar);
  g_test_add_func("/node_splitting/random", test_random);
  g_test_add_func("/node_splitting/same", test_same);
  g_test_add_func("/node_splitting/tidy", test_tidy);
  g_test_add_func("/node_splitting/reserve", test_reserve);
  return g_test_run();
}
