/* The Lennard-Jones fluid against pair by pair sums, and against what is known of the liquid at its triple point:
 * density 0.8442 in units of sigma, started from a lattice at temperature 1.44 in units of epsilon. */
#include "core/sim/world.h"
#include "models/particles/lennard_jones_law.h"
#include "tests/conformance/specimen.h"

#define DENSITY 0.8442

typedef struct FluidFields { /* as the model's own */
  int64_t particles;
  double density, surface_tension, temperature, thermostat, drag, stain;
  double period[3];
} FluidFields;

/* cells^3 x 4 particles in a periodic box, in units where sigma, epsilon and mass are 1: the number is that of the
 * surface's volume. */
static SporeModel *periodic_fluid_at(unsigned cells, double temperature, double thermostat, double *side) {
  size_t count = 4 * (size_t)cells * cells * cells;
  *side = cbrt((double)count / DENSITY);
  SporeTriangleMesh box;
  double half = 0.5 * *side;
  shape_box(&box, spore_vec3(half, half, half), spore_vec3(*side, *side, *side));
  FluidFields fields = {.particles = (int64_t)count,
                        .density = DENSITY,
                        .surface_tension = 0.585,
                        .temperature = temperature,
                        .thermostat = thermostat,
                        .period = {*side, *side, *side}};
  SporeGeometry geometry = {.surface = &box};
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model = spore_lennard_jones.create(&geometry, &fields, &error);
  if (!model) g_error("%s", error.message);
  g_assert_cmpuint(model->block_count, ==, count);
  g_assert_cmpfloat(fabs(model->block_mass[0] - 1), <, 1e-12);
  spore_triangle_mesh_clear(&box);
  return model;
}

static SporeModel *periodic_fluid(unsigned cells, double temperature, double *side) {
  return periodic_fluid_at(cells, temperature, 0, side);
}

/* A state at rest in the body's own place. */
static State at_rest(const SporeModel *model) {
  const SporeVec3 still = {0, 0, 0};
  return state_new(model, spore_pose_identity(), still, still);
}

/* Kick, drift, kick; f is the force at q before and after. */
static void verlet(const SporeModel *model, State *state, double *f, double dt) {
  for (size_t i = 0; i < state->v_count; i++) {
    state->v[i] += 0.5 * dt * f[i] / model->block_mass[i / 3];
    state->q[i] += dt * state->v[i];
    f[i] = 0;
  }
  model->type->force(model, state->q, state->q, state->v, f);
  for (size_t i = 0; i < state->v_count; i++) state->v[i] += 0.5 * dt * f[i] / model->block_mass[i / 3];
}

static double kinetic(const SporeModel *model, const State *state) {
  double energy = 0;
  for (size_t i = 0; i < state->v_count; i++) energy += 0.5 * model->block_mass[i / 3] * state->v[i] * state->v[i];
  return energy;
}

static double total(const SporeModel *model, const State *state) {
  return kinetic(model, state) + model->type->potential(model, state->q);
}

/* Pair by pair, by the definition. */
static double pair_sums(size_t count, const double *q, double period, double *f) {
  double cut = 2.5, shift = 24 * (2 * pow(cut, -12) - pow(cut, -6)) / (cut * cut), energy = 0;
  double level = 4 * (pow(cut, -12) - pow(cut, -6)) + 0.5 * shift * cut * cut;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < i; j++) {
      SporeVec3 d = spore_vec3_sub(spore_vec3_load(q + 3 * i), spore_vec3_load(q + 3 * j));
      if (period > 0)
        d = spore_vec3_sub(
            d, spore_vec3(period * round(d.x / period), period * round(d.y / period), period * round(d.z / period)));
      double r = spore_vec3_length(d);
      if (r >= cut) continue;
      double stiffness = 24 * (2 * pow(r, -12) - pow(r, -6)) / (r * r) - shift;
      energy += 4 * (pow(r, -12) - pow(r, -6)) + 0.5 * shift * r * r - level;
      spore_vec3_accumulate(f + 3 * i, spore_vec3_scale(stiffness, d));
      spore_vec3_accumulate(f + 3 * j, spore_vec3_scale(-stiffness, d));
    }
  return energy;
}

static void check_against_pairs(const char *name, const SporeModel *model, const State *state, double period) {
  double *f = model_force(model, state), *expected = vector_new(state->v_count);
  double energy = pair_sums(model->block_count, state->q, period, expected);
  double size = fmax(vector_length(expected, state->v_count), 1); /* in a lattice they all but cancel */
  double off = vector_distance(f, expected, state->v_count) / size;
  double energy_off = fabs(model->type->potential(model, state->q) / energy - 1);
  g_test_message("%s: %zu particles: forces off by %.1e, energy by %.1e", name, model->block_count, off, energy_off);
  g_assert_cmpfloat(off, <, 1e-12);
  g_assert_cmpfloat(energy_off, <, 1e-12);
  g_free(f);
  g_free(expected);
}

/* While a liquid flows, list after list, and after it was thrown apart. */
static void test_pairs(void) {
  for (unsigned cells = 4; cells <= 6; cells += 2) {
    double side;
    SporeModel *model = periodic_fluid(cells, 1.44, &side);
    State state = at_rest(model);
    double *f = model_force(model, &state);
    check_against_pairs("lattice", model, &state, side);
    for (int i = 0; i < 10; i++) {
      for (int k = 0; k < 17; k++) verlet(model, &state, f, 0.005);
      check_against_pairs("liquid", model, &state, side);
    }
    for (size_t i = 0; i < state.q_count; i++) state.q[i] += side * (double)((i * 7) % 5) - 2 * side;
    check_against_pairs("other periods", model, &state, side);
    g_free(f);
    state_clear(&state);
    model->type->destroy(model);
  }
}

/* A drop in the open, and far strangers. */
static void test_open(void) {
  double side;
  SporeModel *periodic = periodic_fluid(4, 1.44, &side);
  State state = at_rest(periodic);
  double *f = model_force(periodic, &state);
  for (int k = 0; k < 100; k++) verlet(periodic, &state, f, 0.005);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  FluidFields fields = {.particles = 256, .density = DENSITY, .surface_tension = 0.585};
  SporeModel *model = spore_lennard_jones.create(&(SporeGeometry){.surface = &box}, &fields, NULL);
  check_against_pairs("drop", model, &state, 0);
  state.q[3 * 17] = -1e9, state.q[3 * 99 + 2] = 1e12, state.q[3 * 100 + 1] = 1e-3;
  check_against_pairs("strangers", model, &state, 0);
  for (size_t i = 0; i < state.q_count; i++) state.q[i] *= 10; /* nobody has a neighbour */
  memset(f, 0, state.v_count * sizeof *f);
  model->type->force(model, state.q, state.q, state.v, f);
  g_assert_cmpfloat(vector_length(f, state.v_count), ==, 0);
  state.q[5] = NAN;
  model->type->force(model, state.q, state.q, state.v, f);
  g_assert_true(isnan(f[0]) && isnan(model->type->potential(model, state.q)));
  g_free(f);
  state_clear(&state);
  spore_triangle_mesh_clear(&box);
  model->type->destroy(model);
  periodic->type->destroy(periodic);
}

/* All instruction sets give the same bits. */
static void test_instruction_sets(void) {
  double side, *first = NULL;
  SporeCpuLevel highest = spore_cpu_level();
  for (int level = (int)highest; level >= 0; level--) {
    spore_cpu_limit((SporeCpuLevel)level);
    SporeModel *model = periodic_fluid(5, 1.44, &side);
    State state = at_rest(model);
    double *f = model_force(model, &state);
    for (int k = 0; k < 60; k++) verlet(model, &state, f, 0.005);
    f = g_renew(double, f, state.v_count + 1);
    f[state.v_count] = model->type->potential(model, state.q);
    if (first) g_assert_cmpmem(first, (state.v_count + 1) * sizeof *f, f, (state.v_count + 1) * sizeof *f);
    else first = g_memdup2(f, (state.v_count + 1) * sizeof *f);
    g_free(f);
    state_clear(&state);
    model->type->destroy(model);
  }
  spore_cpu_limit(highest);
  g_test_message("%d levels", (int)highest + 1);
  g_free(first);
}

/* The energy of a liquid at rest temperature errs with the square of the step. */
static void test_energy_slope(void) {
  double side, error[3];
  SporeModel *model = periodic_fluid(4, 1.44, &side);
  State start = at_rest(model);
  double *f = model_force(model, &start);
  for (int k = 0; k < 2000; k++) verlet(model, &start, f, 0.005);
  for (int n = 0; n < 3; n++) {
    double dt = 0.008 / (1 << n), sum = 0, square = 0;
    int steps = 250 << n;
    State state = state_copy(&start);
    double *g = g_memdup2(f, state.v_count * sizeof *f);
    for (int k = 0; k < steps; k++) {
      verlet(model, &state, g, dt);
      double energy = total(model, &state) / (double)model->block_count;
      sum += energy, square += energy * energy;
    }
    error[n] = sqrt(fmax(square / steps - sum / steps * (sum / steps), 0));
    g_test_message("step %.3f: energy a particle varies by %.2e = %.2f step^2", dt, error[n], error[n] / (dt * dt));
    g_free(g);
    state_clear(&state);
  }
  double slope = log2(error[0] / error[2]) / 2;
  g_test_message("slope %.3f", slope);
  g_assert_cmpfloat(fabs(slope - 2), <, 0.2);
  g_free(f);
  state_clear(&start);
  model->type->destroy(model);
}

/* What the lattice melts into: L. Verlet, Physical Review 159 (1967) 98 and 165 (1968) 201, finds neighbours at 1.09
 * sigma, three times as dense as on average. */
static void test_liquid(void) {
  enum { BINS = 150 };
  double side, width = 0.02, bins[BINS] = {0}, temperature = 0;
  SporeModel *model = periodic_fluid(5, 1.44, &side);
  size_t n = model->block_count;
  State state = at_rest(model);
  double *f = model_force(model, &state), before = total(model, &state), after = 0;
  for (int k = 0; k < 2000; k++) verlet(model, &state, f, 0.004);
  const int samples = 100;
  for (int s = 0; s < samples; s++) {
    for (int k = 0; k < 20; k++) verlet(model, &state, f, 0.004);
    temperature += 2 * kinetic(model, &state) / (3 * (double)(n - 1)) / samples;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < i; j++) {
        double square = 0;
        for (size_t k = 0; k < 3; k++) {
          double d = state.q[3 * i + k] - state.q[3 * j + k];
          d -= side * round(d / side);
          square += d * d;
        }
        if (square < BINS * BINS * width * width) bins[(int)(sqrt(square) / width)] += 2.0 / (double)n / samples;
      }
  }
  after = total(model, &state);
  double peak = 0, place = 0, valley = HUGE_VAL;
  for (int b = 0; b < BINS; b++) {
    double r = (b + 0.5) * width, g = bins[b] / (4 * G_PI * r * r * width * DENSITY);
    if (g > peak) peak = g, place = r;
    if (r > 1.2 && r < 2 && g < valley) valley = g;
  }
  SporeVec3 momentum = {0, 0, 0};
  for (size_t i = 0; i < n; i++) momentum = spore_vec3_add(momentum, spore_vec3_load(state.v + 3 * i));
  g_test_message("temperature %.3f; neighbours at %.2f, %.2f times the average, then %.2f; energy a particle %.4f, "
                 "off by %.1e after %d steps; momentum %.1e",
                 temperature, place, peak, valley, after / (double)n, (after - before) / (double)n, 2000 + 20 * samples,
                 spore_vec3_length(momentum));
  g_assert_cmpfloat(fabs(temperature - 0.70), <, 0.04);
  g_assert_cmpfloat(fabs(place - 1.09), <, 0.03);
  g_assert_cmpfloat(fabs(peak - 3.0), <, 0.25);
  g_assert_cmpfloat(valley, <, 0.65);
  g_assert_cmpfloat(fabs(after - before), <, 1e-3 * (double)n);
  g_assert_cmpfloat(spore_vec3_length(momentum), <, 1e-9);
  g_free(f);
  state_clear(&state);
  model->type->destroy(model);
}

/* What a fluid that began at temperature 0.75 comes to: its lattice takes half of the heat as it melts. A stream along
 * x goes through it. */
typedef struct Warmth {
  double temperature, diffusion, momentum, energy_off, power_off;
} Warmth;

static Warmth warmth_of(double thermostat) {
  double side, temperature = 0, work = 0, stream = 0.5, dt = 0.005;
  SporeModel *model = periodic_fluid_at(4, 0.75, thermostat, &side);
  size_t n = model->block_count, size = 3 * n;
  State state = state_new(model, spore_pose_identity(), spore_vec3(stream, 0, 0), (SporeVec3){0, 0, 0});
  double *f = model_force(model, &state), before = total(model, &state), moved = 0, sum = 0;
  const int settle = 2000, steps = 2000;
  double *from = NULL;
  for (int k = 0; k < settle + steps; k++) {
    if (k == settle) from = g_memdup2(state.q, size * sizeof *from);
    double power = model->type->power(model);
    verlet(model, &state, f, dt);
    work += 0.5 * dt * (power + model->type->power(model));
    if (k >= settle)
      temperature += (2 * kinetic(model, &state) - (double)n * stream * stream) / (3 * (double)n) / steps;
  }
  for (size_t i = 0; i < size; i++) {
    double way = state.q[i] - from[i] - (i % 3 == 0 ? stream * dt * steps : 0);
    moved += way * way / (double)n;
    sum += i % 3 == 0 ? state.v[i] : 0;
  }
  double gained = total(model, &state) - before;
  Warmth found = {.temperature = temperature, .diffusion = moved / (6 * dt * steps)};
  found.momentum = sum / ((double)n * stream) - 1;
  found.energy_off = gained / (double)n;
  found.power_off = (gained - work) / (double)n;
  g_test_message(
      "thermostat %g: temperature %.3f, diffusion %.4f, momentum off by %.1e, energy a particle up by %.3f, of "
      "which %.1e without work",
      thermostat, found.temperature, found.diffusion, found.momentum, found.energy_off, found.power_off);
  g_free(from);
  g_free(f);
  state_clear(&state);
  model->type->destroy(model);
  return found;
}

/* The thermostat brings the heat back, accounts for it, and neither slows a stream nor keeps particles from diffusing.
 * Left alone the fluid is a solid: its particles stay where they are. */
static void test_thermostat(void) {
  Warmth kept = warmth_of(1), alone = warmth_of(0);
  g_assert_cmpfloat(fabs(kept.temperature - 0.75), <, 0.03);
  g_assert_cmpfloat(alone.temperature, <, 0.5);
  g_assert_cmpfloat(kept.diffusion, >, 0.02);
  g_assert_cmpfloat(kept.diffusion, <, 0.05);
  g_assert_cmpfloat(alone.diffusion, <, 0.2 * kept.diffusion);
  g_assert_cmpfloat(fabs(kept.momentum), <, 1e-9);
  g_assert_cmpfloat(kept.energy_off, >, 0.3);
  g_assert_cmpfloat(fabs(kept.power_off), <, 0.02);
  g_assert_cmpfloat(fabs(alone.energy_off), <, 0.01);
}

/* Pushed along x by a wave along y that is one box long, a viscous fluid comes to flow by push density / (viscosity
 * k^2) where the push is greatest. */
static double viscosity_of(double thermostat, double push) {
  const double dt = 0.005;
  double side, speed = 0;
  SporeModel *model = periodic_fluid_at(4, 0.75, thermostat, &side);
  size_t n = model->block_count;
  State state = at_rest(model);
  double *f = model_force(model, &state), wave = 2 * G_PI / side;
  const int settle = 2000, steps = 4000;
  for (int k = 0; k < settle + steps; k++) {
    for (size_t i = 0; i < n; i++) state.v[3 * i] += dt * push * cos(wave * state.q[3 * i + 1]);
    verlet(model, &state, f, dt);
    if (k < settle) continue;
    for (size_t i = 0; i < n; i++) speed += 2 * state.v[3 * i] * cos(wave * state.q[3 * i + 1]) / (double)n / steps;
  }
  g_free(f);
  state_clear(&state);
  model->type->destroy(model);
  return DENSITY * push / (wave * wave * speed);
}

/* As the liquid whose molecules these were meant for; what has set does not flow. Boxes of 4, 6 and 8 cells,
 * thermostats of 1 and 3, pushes of .1 and .3, 30 units of time each: 2.5 to 3.1, 2.8 on average. */
static void test_viscosity(void) {
  double liquid = viscosity_of(3, 0.3), set = viscosity_of(0, 0.3);
  g_test_message("viscosity %.2f sqrt(mass epsilon) / sigma^2; %.2g of what has set", liquid, set);
  g_assert_cmpfloat(fabs(liquid - 2.8), <, 0.4);
  g_assert_cmpfloat(fabs(set), >, 3 * liquid);
}

/* Blood in physical units: mass and volume are right, and a drop of it holds together. */
static void test_units(void) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  FluidFields fields;
  spore_parameters_set_initial(&spore_lennard_jones.parameters, &fields);
  SporeModel *model = spore_lennard_jones.create(&(SporeGeometry){.surface = &box}, &fields, NULL);
  double mass = spore_model_total_mass(model), frequency, damping;
  model->type->rates(model, &frequency, &damping);
  g_test_message("8 ml of blood: %zu particles, %.4g kg, a step of at most about %.2g s", model->block_count, mass,
                 1.7 / frequency);
  g_assert_cmpfloat(fabs(mass / (1060 * 8e-6) - 1), <, 1e-12);
  g_assert_cmpuint(model->block_count, >=, 250);
  g_assert_cmpuint(model->block_count, <=, 400);
  State state = at_rest(model);
  double *f = model_force(model, &state), dt = 0.5 / frequency, before = total(model, &state);
  for (int k = 0; k < 3000; k++) verlet(model, &state, f, dt);
  double far = 0;
  for (size_t i = 0; i < model->block_count; i++) far = fmax(far, spore_vec3_length(spore_vec3_load(state.q + 3 * i)));
  double after = total(model, &state);
  g_test_message("after %.2g s: nothing farther than %.3g m from the middle; energy %.3e J, off by %.1e", 3000 * dt,
                 far, after, after / before - 1);
  g_assert_cmpfloat(far, <, 0.03);
  g_assert_cmpfloat(fabs(after / before - 1), <, 1e-3);
  g_free(f);
  state_clear(&state);
  spore_triangle_mesh_clear(&box);
  model->type->destroy(model);
}

/* A world that was reset runs as it did: nothing of the lists before shows. And steps allocate nothing. */
static void test_world(void) {
  double side;
  SporeBodyDescription body = {.name = "fluid",
                               .role = SPORE_PASSIVE,
                               .model = periodic_fluid(4, 1.44, &side),
                               .integrator = SPORE_INTEGRATOR_SYMPLECTIC_EULER,
                               .pose = spore_pose_identity()};
  spore_parameters_set_initial(&spore_contact_parameters, &body.contact);
  SporeWorldDescription description = {.body_count = 1, .bodies = &body};
  spore_parameters_set_initial(&spore_solver_parameters, &description.solver);
  description.solver.time_step = 0.005;
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, NULL, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  uint64_t hash[2];
  for (int run = 0; run < 2; run++) {
    spore_world_reset(world);
    for (int i = 0; i < 300; i++) spore_world_step(world);
    uint64_t allocations = spore_allocation_count();
    for (int i = 0; i < 300; i++) spore_world_step(world);
    if (run == 1) g_assert_cmpuint(spore_allocation_count(), ==, allocations);
    hash[run] = spore_world_hash(world);
  }
  g_assert_cmpuint(hash[0], ==, hash[1]);
  spore_world_free(world);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/lennard_jones/pairs", test_pairs);
  g_test_add_func("/lennard_jones/open", test_open);
  g_test_add_func("/lennard_jones/instruction-sets", test_instruction_sets);
  g_test_add_func("/lennard_jones/energy_slope", test_energy_slope);
  g_test_add_func("/lennard_jones/liquid", test_liquid);
  g_test_add_func("/lennard_jones/thermostat", test_thermostat);
  g_test_add_func("/lennard_jones/viscosity", test_viscosity);
  g_test_add_func("/lennard_jones/units", test_units);
  g_test_add_func("/lennard_jones/world", test_world);
  return g_test_run();
}
