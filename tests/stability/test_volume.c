/* Deformable surface bodies that keep their volume. */
#include <math.h>
#include <string.h>

#include "core/integrate/integrator.h"
#include "tests/stability/rig.h"

#define RADIUS 0.02
#define RINGS 10
#define SEGMENTS 16
#define NODES ((RINGS - 1) * SEGMENTS + 2)

static uint32_t node_at(unsigned ring, unsigned segment) {
  return ring == 0 ? 0 : ring == RINGS ? NODES - 1 : 1 + (ring - 1) * SEGMENTS + segment % SEGMENTS;
}

/* A ball about the origin, of rings between two poles; inside out: with its normals inwards. */
static void ball(SporeTriangleMesh *mesh, bool inside_out) {
  g_assert_true(spore_triangle_mesh_allocate(mesh, NODES, 2 * SEGMENTS * (RINGS - 1), NULL));
  for (unsigned ring = 0; ring <= RINGS; ring++)
    for (unsigned s = 0; s < SEGMENTS; s++) {
      double across = G_PI * ring / RINGS, around = 2 * G_PI * s / SEGMENTS;
      spore_vec3_store(
          mesh->vertices + 3 * (size_t)node_at(ring, s),
          spore_vec3_scale(RADIUS, spore_vec3(sin(across) * cos(around), cos(across), sin(across) * sin(around))));
    }
  uint32_t *t = mesh->triangles;
  for (unsigned ring = 0; ring < RINGS; ring++)
    for (unsigned s = 0; s < SEGMENTS; s++) {
      uint32_t a = node_at(ring, s), b = node_at(ring, s + 1), c = node_at(ring + 1, s), d = node_at(ring + 1, s + 1);
      const uint32_t two[6] = {a, b, c, b, d, c};
      for (int k = 0; k < 2; k++) {
        const uint32_t *n = two + 3 * k;
        if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) continue;
        *t++ = n[0], *t++ = n[inside_out ? 2 : 1], *t++ = n[inside_out ? 1 : 2];
      }
    }
}

static double volume_of(const double *q) {
  SporeTriangleMesh mesh;
  double sum = 0;
  ball(&mesh, false);
  for (size_t t = 0; t < mesh.triangle_count; t++) {
    SporeVec3 corner[3];
    for (int k = 0; k < 3; k++) corner[k] = spore_vec3_load(q + 3 * (size_t)mesh.triangles[3 * t + (size_t)k]);
    sum += spore_vec3_dot(corner[0], spore_vec3_cross(corner[1], corner[2])) / 6;
  }
  spore_triangle_mesh_clear(&mesh);
  return sum;
}

/* All but the volume as soft as can be, or as it is usually. */
static SporeModel *ball_model(double bulk, bool alone, bool inside_out) {
  SporeTriangleMesh mesh;
  ball(&mesh, inside_out);
  if (alone)
    return rig_surface_model(&spore_deformable_surface, &mesh, "volume_stiffness", bulk, "structural_stiffness", 0.0,
                             "shear_stiffness", 0.0, "shape_stiffness", 0.0, "damping", 0.0, NULL);
  return rig_surface_model(&spore_deformable_surface, &mesh, "volume_stiffness", bulk, NULL);
}

typedef struct State {
  double *q, *v, *f;
} State;

static State placed(const SporeModel *model) {
  State state = {g_new0(double, model->q_count), g_new0(double, 3 * model->block_count),
                 g_new0(double, 3 * model->block_count)};
  model->type->place(model, (SporePose){.orientation = {1, 0, 0, 0}}, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), state.q,
                     state.v);
  return state;
}

static void state_free(State *state) {
  g_free(state->q);
  g_free(state->v);
  g_free(state->f);
}

/* Made smaller or larger by a factor s the ball pushes out with p = K (1 - s^3): what p does through a change of volume
 * is what the nodes' forces do, sum f . x = 3 p V, whichever way the normals point. */
static void test_pressure(void) {
  const double bulk = 1e5, factors[] = {0.9, 0.99, 1, 1.05};
  for (int inside_out = 0; inside_out < 2; inside_out++)
    for (size_t i = 0; i < G_N_ELEMENTS(factors); i++) {
      SporeModel *model = ball_model(bulk, true, inside_out);
      State state = placed(model);
      double s = factors[i], whole = volume_of(state.q), work = 0;
      for (size_t k = 0; k < 3 * NODES; k++) state.q[k] *= s;
      model->type->force(model, state.q, state.q, state.v, state.f);
      for (size_t k = 0; k < 3 * NODES; k++) work += state.f[k] * state.q[k];
      double pressure = work / (3 * s * s * s * whole), expected = bulk * (1 - s * s * s);
      double energy = 0.5 * bulk * whole * (s * s * s - 1) * (s * s * s - 1);
      g_test_message("by %g: %.6f Pa, theory %.6f", s, pressure, expected);
      g_assert_cmpfloat_with_epsilon(pressure, expected, 1e-10 * bulk);
      g_assert_cmpfloat_with_epsilon(model->type->potential(model, state.q), energy, 1e-10 * bulk * whole);
      state_free(&state);
      model->type->destroy(model);
    }
}

static void shake(GRand *random, double *q, double amplitude) {
  for (size_t k = 0; k < 3 * NODES; k++) q[k] += g_rand_double_range(random, -amplitude, amplitude);
}

/* The whole tangent against differences of the force, and the force against differences of the energy. */
static void test_jacobian(void) {
  SporeModel *model = ball_model(1e5, false, false);
  GRand *random = g_rand_new_with_seed(5);
  double worst = 0, worst_force = 0;
  size_t n = 3 * model->block_count;
  for (int trial = 0; trial < 10; trial++) {
    State state = placed(model);
    for (size_t k = 0; k < 3 * NODES; k++) state.q[k] *= 0.9;
    shake(random, state.q, 0.05 * RADIUS);
    SporeBlockMatrix matrix;
    g_assert_true(spore_model_matrix_create(model, &matrix));
    SporeTangent at = {.q = state.q, .shape = state.q, .v = state.v, .stiffness_scale = 1, .whole = true};
    model->type->tangent(model, &at, &matrix);
    double *w = g_new0(double, n), *product = g_new0(double, n), *f[2], energy[2], error = 0, size = 0, along = 0;
    for (size_t k = 0; k < 3 * NODES; k++) w[k] = g_rand_double_range(random, -1, 1);
    spore_block_matrix_multiply_add(&matrix, w, product);
    const double h = 2e-6 * RADIUS;
    for (int side = 0; side < 2; side++) {
      double *q = g_memdup2(state.q, model->q_count * sizeof *q);
      for (size_t k = 0; k < 3 * NODES; k++) q[k] += (side ? -h : h) * w[k];
      f[side] = g_new0(double, n);
      model->type->force(model, q, q, state.v, f[side]);
      energy[side] = model->type->potential(model, q);
      g_free(q);
    }
    model->type->force(model, state.q, state.q, state.v, state.f);
    for (size_t k = 0; k < n; k++) {
      error += pow((f[1][k] - f[0][k]) / (2 * h) - product[k], 2);
      size += product[k] * product[k];
      along += state.f[k] * w[k];
    }
    worst = fmax(worst, sqrt(error / size));
    worst_force = fmax(worst_force, fabs((energy[1] - energy[0]) / (2 * h) / along - 1));
    for (int side = 0; side < 2; side++) g_free(f[side]);
    g_free(w);
    g_free(product);
    spore_block_matrix_clear(&matrix);
    state_free(&state);
  }
  g_test_message("Jacobian off by %.1e, force by %.1e", worst, worst_force);
  g_assert_cmpfloat(worst, <, 1e-7);
  g_assert_cmpfloat(worst_force, <, 1e-6);
  g_rand_free(random);
  model->type->destroy(model);
}

/* A crumpled ball, far from the origin, neither pushes nor turns itself. */
static void test_momentum(void) {
  SporeModel *model = ball_model(1e6, true, false);
  GRand *random = g_rand_new_with_seed(6);
  double worst[2] = {0, 0};
  for (int trial = 0; trial < 10; trial++) {
    State state = placed(model);
    shake(random, state.q, 0.3 * RADIUS);
    for (size_t i = 0; i < NODES; i++) state.q[3 * i] += 0.5;
    model->type->force(model, state.q, state.q, state.v, state.f);
    SporeVec3 force = {0, 0, 0}, torque = {0, 0, 0};
    double sum = 0;
    for (size_t i = 0; i < NODES; i++) {
      SporeVec3 f = spore_vec3_load(state.f + 3 * i), arm = spore_vec3_load(state.q + 3 * i);
      arm.x -= 0.5;
      force = spore_vec3_add(force, f);
      torque = spore_vec3_add(torque, spore_vec3_cross(arm, f));
      sum += spore_vec3_length(f);
    }
    worst[0] = fmax(worst[0], spore_vec3_length(force) / sum);
    worst[1] = fmax(worst[1], spore_vec3_length(torque) / (sum * RADIUS));
    state_free(&state);
  }
  g_test_message("force off by %.1e, torque by %.1e", worst[0], worst[1]);
  g_assert_cmpfloat(worst[0], <, 1e-12);
  g_assert_cmpfloat(worst[1], <, 1e-12);
  g_rand_free(random);
  model->type->destroy(model);
}

/* A plate comes down on the ball, to `squeeze` of the radius, and stays there. */
typedef struct Plate {
  SporeDevice base;
  double squeeze;
} Plate;
static bool plate_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                           SporeDeviceState *state) {
  double down = ((const Plate *)device)->squeeze * RADIUS * fmin(time_s / 0.5, 1);
  *state = (SporeDeviceState){.position = {0, RADIUS + 0.004 - down, 0}, .orientation = {1, 0, 0, 0}};
  return true;
}
static void plate_close(SporeDevice *device) {}
static const SporeDeviceType plate_type = {
    .name = "plate", .doc = "", .exchange = plate_exchange, .close = plate_close};

typedef struct Squeezed {
  double change, lowest, newton, residual;
  uint64_t unsolved;
} Squeezed;

static Squeezed squeeze(double bulk, double by, SporeIntegratorKind method, int linear) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 0.004;
  rig->description.solver.integrator = method;
  rig->description.solver.substeps = spore_integrator(method)->implicit ? 1 : 60;
  rig->description.solver.linear = linear;
  SporeTriangleMesh mesh;
  ball(&mesh, false);
  const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, NODES, 0.002);
  spore_triangle_mesh_clear(&mesh);
  SporeBodyDescription *body = rig_passive(rig, "ball", ball_model(bulk, false, false), spheres);
  body->contact.friction = 0;
  body->contact.stiffness = 2000;
  rig_unmovable(rig, "floor", rig_floor(rig, 16, 16, 0.004, 0.004))->pose.position = spore_vec3(0, -RADIUS - 0.002, 0);
  rig_active(rig, "plate", rig_floor(rig, 16, 16, 0.004, 0.004))->pose.position = spore_vec3(0, RADIUS + 0.004, 0);
  Plate plate = {{&plate_type}, by};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 2, &plate.base);
  double whole = volume_of(spore_world_q(world, 0));
  Squeezed result = {.lowest = 1};
  for (int step = 0; step < 250; step++) {
    spore_world_step(world);
    result.newton += (double)spore_world_counts(world).newton_iterations / 250;
    result.residual = fmax(result.residual, spore_world_counts(world).residual);
    result.lowest = fmin(result.lowest, volume_of(spore_world_q(world, 0)) / whole);
  }
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  result.change = volume_of(spore_world_q(world, 0)) / whole - 1;
  result.unsolved = spore_world_monitor(world)->not_converged;
  g_test_message("%s, K %g Pa: volume %+.3f %%, %.3f at the least, %.1f Newton iterations a step, %llu unsolved; %s",
                 spore_integrator(method)->name, bulk, 100 * result.change, result.lowest, result.newton,
                 (unsigned long long)result.unsolved, rig_last_message(world));
  rig_free(rig);
  return result;
}

/* Squeezed by a quarter of its height a ball that knows no volume loses more than a tenth of it; one that does loses
 * what its pressure divided by its bulk modulus is: the stiffer the less, in proportion. */
static void test_squeezed(void) {
  const SporeIntegratorKind implicit = SPORE_INTEGRATOR_IMPLICIT_EULER;
  Squeezed without = squeeze(0, 0.5, implicit, SPORE_LINEAR_AUTOMATIC);
  g_assert_cmpfloat(without.change, <, -0.1);
  g_assert_cmpfloat(fabs(squeeze(1e6, 0.5, implicit, SPORE_LINEAR_AUTOMATIC).change), <, 5e-3);
  g_assert_cmpfloat(fabs(squeeze(1e8, 0.5, implicit, SPORE_LINEAR_AUTOMATIC).change), <, 5e-5);
  g_assert_cmpfloat(fabs(squeeze(1e11, 0.5, implicit, SPORE_LINEAR_AUTOMATIC).change), <, 5e-5);
  Squeezed explicit = squeeze(1e4, 0.5, SPORE_INTEGRATOR_VERLET, SPORE_LINEAR_AUTOMATIC);
  Squeezed direct = squeeze(1e4, 0.5, SPORE_INTEGRATOR_BDF2, SPORE_LINEAR_CHOLESKY);
  Squeezed iterated = squeeze(1e4, 0.5, SPORE_INTEGRATOR_BDF2, SPORE_LINEAR_CONJUGATE_GRADIENTS);
  g_assert_cmpfloat_with_epsilon(direct.change, iterated.change, 1e-4);
  g_assert_cmpfloat_with_epsilon(direct.change, explicit.change, 1e-3);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/volume/pressure", test_pressure);
  g_test_add_func("/volume/jacobian", test_jacobian);
  g_test_add_func("/volume/momentum", test_momentum);
  g_test_add_func("/volume/squeezed", test_squeezed);
  return g_test_run();
}
