/* Prints what each kernel takes, in CPU time of this thread, at each level that this machine has:
 * "KERNEL, LEVEL: N us". */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "core/base/memory.h"
#include "core/math/vector.h"
#include "models/registry.h"

enum { REPEATS = 40, SIDE = 20 };

static double cpu_us(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

/* A model in motion, away from rest. */
typedef struct Case {
  const char *name;
  SporeModel *model;
  double *q, *v, *f;
  SporeBlockMatrix matrix;
} Case;

static bool prepare(Case *run) {
  SporeModel *model = run->model;
  size_t n = 3 * model->block_count;
  run->q = SPORE_NEW_ARRAY(double, model->q_count);
  run->v = SPORE_NEW_ARRAY(double, n);
  run->f = SPORE_NEW_ARRAY(double, n);
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, model->block_count);
  bool made = run->q && run->v && run->f && model->type->pattern(model, &pattern) &&
              spore_block_matrix_create(&run->matrix, &pattern);
  spore_block_pattern_clear(&pattern);
  if (!made) return false;
  model->type->place(model, spore_pose_identity(), (SporeVec3){0.1, 0.2, 0.3}, (SporeVec3){1, 2, 3}, run->q, run->v);
  for (size_t i = 0; i < n; i++)
    run->q[i] += 0.002 * sin(12.9898 * (double)i), run->v[i] += 0.1 * sin(78.233 * (double)i);
  return true;
}

static void clear(Case *run) {
  spore_free(run->q);
  spore_free(run->v);
  spore_free(run->f);
  spore_block_matrix_clear(&run->matrix);
  run->model->type->destroy(run->model);
}

static void force(Case *run) { run->model->type->force(run->model, run->q, run->q, run->v, run->f); }
static void potential(Case *run) { run->f[0] += run->model->type->potential(run->model, run->q); }
static void jacobian(Case *run) {
  run->model->type->jacobian(run->model, run->q, run->q, run->v, 1e-4, 1e-2, &run->matrix);
}
static void multiply(Case *run) { spore_block_matrix_multiply_add(&run->matrix, run->v, run->f); }
static void dot(Case *run) { run->f[0] = spore_vector_dot(3 * run->model->block_count, run->q, run->v); }

/* The least of many, each of about 200 us. */
static void measure(Case *run, const char *what, void (*work)(Case *run)) {
  for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    if ((int)spore_cpu_level() != level) continue;
    double start = cpu_us(), best = INFINITY;
    work(run);
    int times = 1 + (int)(200 / (cpu_us() - start));
    for (int repeat = 0; repeat < REPEATS; repeat++) {
      start = cpu_us();
      for (int i = 0; i < times; i++) work(run);
      best = fmin(best, (cpu_us() - start) / times);
    }
    printf("%s %s, %s: %.3f us\n", run->name, what, spore_cpu_level_name(level), best);
  }
}

static void measure_model(Case *run) {
  if (run->model && prepare(run)) {
    measure(run, "force", force);
    measure(run, "Jacobian", jacobian);
    measure(run, "potential", potential);
    measure(run, "multiply", multiply);
    measure(run, "dot", dot);
  }
  if (run->model) clear(run);
}

static void *new_fields(const SporeModelType *type) {
  void *fields = spore_allocate(1, type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  return fields;
}

static void set(const SporeModelType *type, void *fields, const char *name, double number) {
  int index = spore_parameter_find(&type->parameters, name);
  SporeValue value = {.type = SPORE_REAL, .number = {number}};
  spore_parameter_store(&type->parameters.parameters[index], &value, fields);
}

/* A net with one diagonal in each square, which its structural springs are. */
static void net(const char *name, double damping, double others) {
  SporeTriangleMesh mesh = {0};
  if (!spore_triangle_mesh_allocate(&mesh, SIDE * SIDE, 2 * (SIDE - 1) * (SIDE - 1), NULL)) return;
  size_t corner = 0;
  for (uint32_t i = 0; i < SIDE * SIDE; i++) {
    mesh.vertices[3 * i] = (i % SIDE) / (SIDE - 1.0), mesh.vertices[3 * i + 2] = (i / SIDE) / (SIDE - 1.0);
    if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1) continue;
    const uint32_t square[6] = {i, i + SIDE, i + 1, i + 1, i + SIDE, i + SIDE + 1};
    for (int k = 0; k < 6; k++) mesh.triangles[corner++] = square[k];
  }
  void *fields = new_fields(&spore_mass_spring_net);
  set(&spore_mass_spring_net, fields, "structural_stiffness", 1e4);
  set(&spore_mass_spring_net, fields, "shear_stiffness", others);
  set(&spore_mass_spring_net, fields, "bending_stiffness", others);
  set(&spore_mass_spring_net, fields, "damping", damping);
  SporeGeometry geometry = {.surface = &mesh};
  Case run = {.name = name, .model = spore_mass_spring_net.create(&geometry, fields, NULL)};
  measure_model(&run);
  spore_free(fields);
  spore_triangle_mesh_clear(&mesh);
}

/* A beam of 20x4x4 cells of six tetrahedra, 5 cm thick: 525 nodes at corners. element: the index of the choice. */
static void beam(const char *name, const SporeModelType *type, int element, double damping) {
  enum { X = 20, Y = 4, Z = 4 };
  static const uint8_t paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}; /* corners between 0 and 7 */
  SporeTetrahedralMesh mesh = {0};
  if (!spore_tetrahedral_mesh_allocate(&mesh, (X + 1) * (Y + 1) * (Z + 1), 6 * X * Y * Z, NULL)) return;
  uint32_t *corner = mesh.tetrahedra, i = 0;
  for (uint32_t z = 0; z <= Z; z++)
    for (uint32_t y = 0; y <= Y; y++)
      for (uint32_t x = 0; x <= X; x++, i++) {
        spore_vec3_store(mesh.vertices + 3 * i, (SporeVec3){0.0125 * x, 0.0125 * y, 0.0125 * z});
        if (x == X || y == Y || z == Z) continue;
        uint32_t cell[8];
        for (uint32_t k = 0; k < 8; k++) cell[k] = i + (k & 1) + (k >> 1 & 1) * (X + 1) + (k >> 2) * (X + 1) * (Y + 1);
        for (int t = 0; t < 6; t++) {
          *corner++ = cell[0], *corner++ = cell[paths[t][0]], *corner++ = cell[paths[t][1]], *corner++ = cell[7];
        }
      }
  void *fields = new_fields(type);
  set(type, fields, "stiffness_damping", damping);
  int choice = spore_parameter_find(&type->parameters, "element");
  SporeValue value = {.type = SPORE_CHOICE, .number = {element}};
  if (choice >= 0) spore_parameter_store(&type->parameters.parameters[choice], &value, fields);
  SporeGeometry geometry = {.tetrahedra = &mesh};
  SporeError error = SPORE_ERROR_INIT;
  Case run = {.name = name, .model = type->create(&geometry, fields, &error)};
  if (!run.model) fprintf(stderr, "%s: %s\n", error.place, error.message);
  measure_model(&run);
  spore_free(fields);
  spore_tetrahedral_mesh_clear(&mesh);
}

/* The same beam as a grid of as many nodes. */
static void grid(const char *name, double damping) {
  SporeTriangleMesh mesh = {0};
  if (!spore_triangle_mesh_allocate(&mesh, 8, 12, NULL)) return;
  static const uint32_t corners[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  memcpy(mesh.triangles, corners, sizeof corners);
  for (size_t i = 0; i < 8; i++)
    spore_vec3_store(mesh.vertices + 3 * i, (SporeVec3){0.25 * (i & 1), 0.05 * (i >> 1 & 1), 0.05 * (double)(i >> 2)});
  void *fields = new_fields(&spore_finite_differences);
  set(&spore_finite_differences, fields, "stiffness_damping", damping);
  set(&spore_finite_differences, fields, "cells", 20);
  SporeError error = SPORE_ERROR_INIT;
  Case run = {.name = name,
              .model = spore_finite_differences.create(&(SporeGeometry){.surface = &mesh}, fields, &error)};
  if (!run.model) fprintf(stderr, "%s: %s\n", error.place, error.message);
  measure_model(&run);
  spore_free(fields);
  spore_triangle_mesh_clear(&mesh);
}

int main(void) {
  net("net 20x20, 1121 springs,", 0, 0);
  net("net 20x20, 1121 damped springs,", 0.01, 0);
  net("net 20x20, all springs damped,", 0.01, 10);
  beam("1920 corotational tetrahedra", &spore_corotational_tetrahedra, 0, 0);
  beam("1920 damped corotational tetrahedra", &spore_corotational_tetrahedra, 0, 0.01);
  beam("1920 neo-Hookean tetrahedra", &spore_neo_hookean_tetrahedra, 0, 0);
  beam("1920 St Venant-Kirchhoff tetrahedra", &spore_saint_venant_kirchhoff_tetrahedra, 0, 0);
  beam("1920 linear tetrahedra", &spore_linear_tetrahedra, 0, 0);
  beam("1920 quadratic neo-Hookean tetrahedra", &spore_neo_hookean_tetrahedra, 1, 0);
  grid("grid of 320 cells", 0);
  grid("damped grid of 320 cells", 0.01);
  return 0;
}
