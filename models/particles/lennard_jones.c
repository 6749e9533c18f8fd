/* Lennard-Jones fluid: particles that attract each other from near and repel from nearer. Which pairs are near is in
 * models/particles/cluster_list.c, what they do to each other in models/particles/lennard_jones_law.h; here are units
 * and parameters.
 *
 * From the fluid to its particles: n of them share volume V evenly, so each has mass density V / n, and the lattice
 * that they start from has the density of the liquid at its triple point, n sigma^3 / V = 0.8442. Surface tension makes
 * epsilon: gamma = 0.585 epsilon / sigma^2 at a temperature of 0.7 epsilon (J. Vrabec, G. K. Kedia, G. Fuchs, H. Hasse,
 * Molecular Physics 104, 2006: the potential cut off at 2.5 sigma). The particles are no molecules: their temperature
 * is how much they jostle. Nor are they as thin: the liquid's viscosity, 2.8 sqrt(m epsilon) / sigma^2 (measured in
 * tests/conformance/test_lennard_jones.c), is 4 sqrt(density gamma sigma), however many there are.
 *
 * What falls or is stirred grows hot and boils, since a drop has no walls that would take the heat; what touches damped
 * bodies is cooled until it sets. The thermostat keeps the temperature: it couples thermal motion, and not the flow,
 * weakly to a bath (H. J. C. Berendsen, J. P. M. Postma, W. F. van Gunsteren et al., Journal of Chemical Physics 81,
 * 1984). No chance is in it, so that a run can be repeated to the bit. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/particles/fill.h"
#include "models/particles/lennard_jones_law.h"
#include "models/particles/thermal_motion.h"
#include "models/registry.h"

#define LIQUID_DENSITY 0.8442
#define LIQUID_TENSION 0.585
#define CUTOFF 2.5 /* sigma */
#define CUBE 2.5   /* sigma: of the cubes in which thermal motion is told from flow; some 13 particles of a liquid */
#define CORE 0.7   /* sigma: nearer the force does not grow; at 255 epsilon nothing comes there by itself */

SporeLennardJonesLaw spore_lennard_jones_law(double sigma, double epsilon, double cutoff, double core) {
  assert(sigma > 0 && epsilon > 0);
  assert(0 < core && core < cutoff);
  double s6 = pow(sigma, 6), c2 = 1 / (cutoff * cutoff), c6 = c2 * c2 * c2, k2 = 1 / (core * core), k6 = k2 * k2 * k2;
  SporeLennardJonesLaw law = {.cutoff2 = cutoff * cutoff, .core2 = core * core};
  law.e6 = 4 * epsilon * s6;
  law.e12 = law.e6 * s6;
  law.f6 = 6 * law.e6;
  law.f12 = 12 * law.e12;
  law.shift = (law.f12 * c6 - law.f6) * c6 * c2;
  law.level = (law.e12 * c6 - law.e6) * c6 + 0.5 * law.shift * law.cutoff2;
  law.core_stiffness = (law.f12 * k6 - law.f6) * k6 * k2 - law.shift;
  return law;
}

typedef struct FluidFields {
  int64_t particles;
  double density, surface_tension, temperature, thermostat, drag, stain;
  double period[3];
} FluidFields;

/* What evaluations leave behind: which particles are near each other does not change what their forces are. */
typedef struct FluidMemory {
  SporeClusterList list;
  SporeThermalMotion motion; /* of a fluid with a thermostat */
  double power;              /* of the thermostat in the last evaluation of forces, W */
  bool capped;               /* in the last evaluation of forces */
} FluidMemory;

typedef struct Fluid {
  SporeModel base;
  double *rest; /* particles x 3, body's frame */
  double *heat; /* particles x 3, body's frame: how they move at time 0, m/s */
  double sigma, epsilon, thermostat, drag;
  double warmth; /* temperature over mass, m^2/s^2 */
  double period[3];
  SporeLennardJonesLaw law;
  FluidMemory *memory;
} Fluid;

static const SporeParameter parameters[] = {
    SPORE_INTEGER_FIELD(
        FluidFields, particles, 4, 1e6, 300, SPORE_CHANGE_REBUILD,
        N_("About how many particles fill the surface; more of them are finer and need a smaller step. What flows of "
           "them is thick: its viscosity is 4 times the root of density, surface tension and width of a particle, 1.4 "
           "Pa s at a width of 2 mm, and that of blood 0.0035 Pa s.")),
    SPORE_REAL_FIELD(FluidFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume; 1060 is blood, 998 water.")),
    SPORE_REAL_FIELD(FluidFields, surface_tension, "N/m", 1e-9, 1e9, 0.056, SPORE_CHANGE_REBUILD,
                     N_("How strongly the fluid holds together: 0.056 is blood, 0.072 water. The largest stable step "
                        "goes with one over its root.")),
    SPORE_REAL_FIELD(FluidFields, temperature, "", 0, 100, 0, SPORE_CHANGE_REBUILD,
                     N_("How much the particles jostle at time 0, in units of the depth of their attraction; about 0.7 "
                        "to 1.2 flows, less sets.")),
    SPORE_REAL_FIELD(FluidFields, thermostat, "1/s", 0, 1e6, 0, SPORE_CHANGE_LIVE,
                     N_("Rate at which the particles come back to that temperature, while their flow is not slowed. 0: "
                        "what is stirred grows hot and boils, what touches damped bodies sets.")),
    SPORE_REAL_FIELD(FluidFields, drag, "1/s", 0, 1e6, 0, SPORE_CHANGE_LIVE, N_("Rate at which motion dies away.")),
    SPORE_REAL_FIELD(
        FluidFields, stain, "1/s", -1e3, 1e3, 12, SPORE_CHANGE_LIVE,
        N_("Rate at which what drops lie on takes on the colour of blood, which is seen and changes nothing "
           "else. Below 0: at which they wash that colour off, as water does. 0: neither.")),
    {.name = "period",
     .type = SPORE_VECTOR,
     .unit = "m",
     .minimum = 0,
     .maximum = 1e6,
     .offset = offsetof(FluidFields, period),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Distance along x, y and z after which the fluid repeats itself, without a wall: for measuring the "
               "inside of a large one. 0: it ends.")},
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a fluid"));
}

static void destroy(SporeModel *model) {
  Fluid *fluid = (Fluid *)model;
  if (fluid->memory) {
    spore_cluster_list_clear(&fluid->memory->list);
    spore_thermal_motion_clear(&fluid->memory->motion);
  }
  spore_free(fluid->memory);
  spore_free(fluid->rest);
  spore_free(fluid->heat);
  spore_model_clear(&fluid->base);
  spore_free(fluid);
}

/* Uniform in -0.5..0.5, the same on every machine. */
static double next_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53 - 0.5;
}

/* Velocities near those of a gas, without momentum and of exactly the temperature (in units of epsilon). */
static void set_heat(Fluid *fluid, double mass, double temperature) {
  assert(mass > 0 && temperature >= 0);
  size_t n = fluid->base.block_count;
  uint64_t state = 1;
  double mean[3] = {0, 0, 0}, square = 0;
  for (size_t i = 0; i < 3 * n; i++) {
    fluid->heat[i] = 0;
    for (int k = 0; k < 12; k++) fluid->heat[i] += next_random(&state);
    mean[i % 3] += fluid->heat[i] / (double)n;
  }
  for (size_t i = 0; i < 3 * n; i++) {
    fluid->heat[i] -= mean[i % 3];
    square += fluid->heat[i] * fluid->heat[i];
  }
  double scale = sqrt(3 * (double)(n - 1) * temperature * fluid->epsilon / (mass * square));
  for (size_t i = 0; i < 3 * n; i++) fluid->heat[i] *= scale;
}

/* From the first particle to the last along axis k, m. */
static double extent(const Fluid *fluid, int k) {
  assert(k >= 0 && k < 3);
  double lower = INFINITY, upper = -INFINITY;
  for (size_t i = 0; i < fluid->base.block_count; i++) {
    lower = fmin(lower, fluid->rest[3 * i + (size_t)k]);
    upper = fmax(upper, fluid->rest[3 * i + (size_t)k]);
  }
  return upper - lower;
}

static bool check_period(const Fluid *fluid, const double period[3], SporeError *error) {
  double least = 2 * spore_cluster_reach(CUTOFF * fluid->sigma);
  for (int k = 0; k < 3; k++) {
    if (!(period[k] > 0)) continue;
    double room = extent(fluid, k) + CORE * fluid->sigma;
    if (period[k] < room)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("a period of %.3g m is shorter than the fluid, whose particles would lie inside each "
                               "other; expected 0 or at least %.3g m; take a longer one or a smaller surface"),
                             period[k], fmax(room, least));
    if (period[k] < least)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("a period of %.3g m is shorter than twice the reach of a particle; expected 0 or at "
                               "least %.3g m; take a longer one or more particles"),
                             period[k], least);
  }
  return true;
}

static bool set_particles(Fluid *fluid, double volume, const FluidFields *fields, SporeError *error) {
  size_t n = fluid->base.block_count;
  double mass = fields->density * volume / (double)n;
  fluid->sigma = cbrt(LIQUID_DENSITY * volume / (double)n);
  fluid->epsilon = fields->surface_tension * fluid->sigma * fluid->sigma / LIQUID_TENSION;
  fluid->thermostat = fields->thermostat;
  fluid->drag = fields->drag;
  fluid->base.stain = fields->stain;
  fluid->base.particle_volume = volume / (double)n;
  fluid->warmth = fields->temperature * fluid->epsilon / mass;
  memcpy(fluid->period, fields->period, sizeof fluid->period);
  fluid->law = spore_lennard_jones_law(fluid->sigma, fluid->epsilon, CUTOFF * fluid->sigma, CORE * fluid->sigma);
  for (size_t i = 0; i < n; i++) fluid->base.block_mass[i] = mass;
  if (!check_period(fluid, fields->period, error)) return false;
  fluid->heat = SPORE_NEW_ARRAY(double, 3 * n);
  fluid->memory = SPORE_NEW(FluidMemory);
  if (!fluid->heat || !fluid->memory || !spore_thermal_motion_init(&fluid->memory->motion, n, CUBE * fluid->sigma) ||
      !spore_cluster_list_init(&fluid->memory->list, n, fields->period, CUTOFF * fluid->sigma) ||
      !spore_cluster_list_update(&fluid->memory->list, fluid->rest) || !spore_cluster_list_spare(&fluid->memory->list))
    return no_memory(error);
  fluid->memory->list.made = false;
  set_heat(fluid, mass, fields->temperature);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *data, SporeError *error) {
  const FluidFields *fields = data;
  double *points, volume;
  size_t count;
  if (!spore_particle_fill(geometry->surface, (size_t)fields->particles, geometry->cancel, &points, &count, &volume,
                           error))
    return NULL;
  Fluid *fluid = SPORE_NEW(Fluid);
  if (!fluid) {
    spore_free(points);
    no_memory(error);
    return NULL;
  }
  fluid->rest = points;
  if (spore_model_init(&fluid->base, &spore_lennard_jones, count, false, error) &&
      set_particles(fluid, volume, fields, error))
    return &fluid->base;
  destroy(&fluid->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_lennard_jones);
  const Fluid *fluid = (const Fluid *)model;
  spore_nodal_place(fluid->rest, model->block_count, pose, velocity, spin, q, v);
  for (size_t i = 0; i < model->block_count; i++)
    spore_vec3_accumulate(v + 3 * i, spore_quat_rotate(pose.orientation, spore_vec3_load(fluid->heat + 3 * i)));
}

/* Thermal energy Q of a bath with Q_0: dQ/dt = rate (Q_0 - Q), velocities so at half that rate; where the fluid is all
 * but cold, no faster than the rate. */
static void keep_warm(const Fluid *fluid, const double *q, const double *v, double *f) {
  SporeThermalMotion *motion = &fluid->memory->motion;
  double warmth = spore_thermal_motion_find(motion, q, v, fluid->period);
  if (!(warmth > 0)) return;
  double rate = fluid->base.block_mass[0] * 0.5 * fluid->thermostat * fmin(fluid->warmth / warmth - 1, 2);
  spore_thermal_motion_push(motion, v, rate, f);
  fluid->memory->power = rate * warmth * (double)motion->degrees;
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(model->type == &spore_lennard_jones);
  assert(f != q && f != v);
  const Fluid *fluid = (const Fluid *)model;
  FluidMemory *memory = fluid->memory;
  if (!spore_cluster_list_update(&memory->list, q)) {
    for (size_t i = 0; i < 3 * model->block_count; i++) f[i] = NAN; /* the monitor's affair */
    return;
  }
  memory->capped = SPORE_KERNEL(spore_lennard_jones_force)(&memory->list, &fluid->law);
  spore_cluster_list_add_forces(&memory->list, f);
  memory->power = 0;
  if (fluid->thermostat > 0) keep_warm(fluid, q, v, f);
  if (fluid->drag == 0) return;
  double drag = fluid->drag * model->block_mass[0];
  for (size_t i = 0; i < 3 * model->block_count; i++) f[i] -= drag * v[i];
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_lennard_jones);
  const Fluid *fluid = (const Fluid *)model;
  if (!spore_cluster_list_update(&fluid->memory->list, q)) return NAN;
  return SPORE_KERNEL(spore_lennard_jones_energy)(&fluid->memory->list, &fluid->law);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_lennard_jones);
  const Fluid *fluid = (const Fluid *)model;
  return spore_particle_map(fluid->rest, model->block_count, fluid->sigma, points, count, cancel, mapping, error);
}

/* As wide as the distance at which two particles begin to repel each other more than they attract: sigma, where the
 * energy of a pair is that of particles far apart. */
static bool spheres(const SporeModel *model, SporeSphereSet *set, SporeError *error) {
  assert(model->type == &spore_lennard_jones);
  const Fluid *fluid = (const Fluid *)model;
  if (!spore_sphere_set_allocate(set, model->block_count, error)) return false;
  for (size_t i = 0; i < model->block_count; i++) {
    memcpy(set->spheres + 4 * i, fluid->rest + 3 * i, 3 * sizeof(double));
    set->spheres[4 * i + 3] = 0.5 * fluid->sigma;
  }
  return true;
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_lennard_jones);
  Fluid *fluid = (Fluid *)model;
  fluid->thermostat = ((const FluidFields *)fields)->thermostat;
  fluid->drag = ((const FluidFields *)fields)->drag;
  model->stain = ((const FluidFields *)fields)->stain;
  return true;
}

/* The stiffest that is reckoned with: a particle and five others, all in each other's cores. */
static void rates(const SporeModel *model, double *frequency, double *damping) {
  assert(model->type == &spore_lennard_jones);
  const Fluid *fluid = (const Fluid *)model;
  *frequency = sqrt(6 * fluid->law.core_stiffness / model->block_mass[0]);
  *damping = fluid->drag + fluid->thermostat;
}

static double power(const SporeModel *model) {
  assert(model->type == &spore_lennard_jones);
  return ((const Fluid *)model)->memory->power;
}

static void forget(SporeModel *model) {
  assert(model->type == &spore_lennard_jones);
  ((Fluid *)model)->memory->list.made = false;
}

static const char *notice(const SporeModel *model, const double *q) {
  return ((const Fluid *)model)->memory->capped
             ? _("particles are so near each other that the force between them was capped; start them farther apart "
                 "or take a smaller time step")
             : NULL;
}

/* Drops fall freely but for the drag: v' = g - d v. */
static void carry(const SporeModel *model, SporeVec3 gravity, double h, const double *q, const double *v, double *q1,
                  double *v1) {
  assert(model->type == &spore_lennard_jones && h > 0);
  double drag = ((const Fluid *)model)->drag, whole = drag > 0 ? -expm1(-drag * h) / drag : h;
  double fall = drag * h > 1e-6 ? (h - whole) / drag : 0.5 * h * h, kept = 1 - drag * whole;
  for (size_t i = 0; i < 3 * model->block_count; i += 3) {
    SporeVec3 at = spore_vec3_load(q + i), speed = spore_vec3_load(v + i);
    at = spore_vec3_add_scaled(at, whole, speed);
    spore_vec3_store(q1 + i, spore_vec3_add_scaled(at, fall, gravity));
    spore_vec3_store(v1 + i, spore_vec3_add_scaled(spore_vec3_scale(kept, speed), whole, gravity));
  }
}

static const SporeModelParticles particles = {.carry = carry};

const SporeModelType spore_lennard_jones = {
    .name = "lennard_jones",
    .label = N_("Lennard-Jones fluid"),
    .doc = N_("Particles that fill a closed surface and then flow: blood, water. They attract each other from near and "
              "repel from nearer, so that drops hold together, merge and part. Mass and volume are the fluid's. It "
              "touches other bodies with a sphere at each particle, unless its collision unit names other spheres."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(FluidFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .map = map,
    .retune = retune,
    .rates = rates,
    .power = power,
    .forget = forget,
    .spheres = spheres,
    .notice = notice,
    .particles = &particles,
};
