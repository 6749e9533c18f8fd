/* Smoke and steam: parcels of warm gas that rise in the air, are slowed and driven about by it, and dissolve.
 *
 * A parcel of mass m weighs (1 - b) m g, with b the weight of the displaced air over the weight of the parcel. Drag d m
 * v, linear in the speed as for small parcels, lets the parcel rise at (b - 1) g / d. The unevenness of the air is a
 * pressure that stands still in the scene,
 *   U = -(m d s / k) (sin kx cos ky + sin ky cos kz + sin kz cos kx),
 * with k = 2 pi over the size of an eddy. It drives parcels about at speeds near s, by a force that has an energy, so
 * that the energy account of the world stays right. Parcels do not interact: a step costs as little as one spring for
 * each parcel.
 *
 * The content of a parcel spreads by diffusion: the square of its radius grows by 4 D t, and its opacity falls. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/particles/fill.h"
#include "models/registry.h"

typedef struct SmokeFields {
  int64_t particles;
  double density, buoyancy, drag, swirl, eddy, life, radius, opacity, diffusivity;
} SmokeFields;

typedef struct Smoke {
  SporeModel base;
  double *rest;    /* particles x 3, body's frame */
  double spacing;  /* m, of them at rest */
  double wave;     /* k, rad/m */
  SmokeFields now; /* drag and swirl change while it runs */
} Smoke;

static const SporeParameter parameters[] = {
    {.name = "particles",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 4,
     .maximum = 1e6,
     .initial = {100},
     .offset = offsetof(SmokeFields, particles),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("About how many puffs fill the surface.")},
    SPORE_REAL_FIELD(SmokeFields, density, "kg/m^3", 1e-3, 1e3, 0.9, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume; 0.6 is steam at 100 degrees, 1.2 air.")),
    SPORE_REAL_FIELD(SmokeFields, buoyancy, "", 0, 100, 2, SPORE_CHANGE_REBUILD,
                     N_("Weight of the air that it displaces over its own: above 1 it rises, below it sinks. Carbon "
                        "dioxide over steam is 2 to 3.")),
    SPORE_REAL_FIELD(SmokeFields, drag, "1/s", 0.1, 1e6, 250, SPORE_CHANGE_LIVE,
                     N_("Rate at which it takes on the speed of the air. It rises at its lift, gravity times buoyancy "
                        "less one, over this.")),
    SPORE_REAL_FIELD(SmokeFields, swirl, "m/s", 0, 10, 0.014, SPORE_CHANGE_LIVE,
                     N_("How fast the uneven air drives it about.")),
    SPORE_REAL_FIELD(SmokeFields, eddy, "m", 1e-4, 10, 0.025, SPORE_CHANGE_REBUILD,
                     N_("Distance after which the unevenness of the air repeats itself.")),
    SPORE_REAL_FIELD(SmokeFields, life, "s", 1e-3, 1e6, 1.5, SPORE_CHANGE_REBUILD,
                     N_("Time after which it has dissolved and is taken out of the world.")),
    SPORE_REAL_FIELD(SmokeFields, radius, "m", 1e-5, 1, 0.0015, SPORE_CHANGE_REBUILD,
                     N_("Radius that a puff is shown with when it comes out.")),
    SPORE_REAL_FIELD(SmokeFields, opacity, "", 0, 1, 0.7, SPORE_CHANGE_REBUILD,
                     N_("How much of what is behind it the middle of such a puff covers.")),
    SPORE_REAL_FIELD(SmokeFields, diffusivity, "m^2/s", 0, 1, 3e-5, SPORE_CHANGE_REBUILD,
                     N_("How fast a puff spreads; steam in still air 2.5e-5.")),
};

static void destroy(SporeModel *model) {
  Smoke *smoke = (Smoke *)model;
  spore_free(smoke->rest);
  spore_model_clear(&smoke->base);
  spore_free(smoke);
}

static SporeModel *create(const SporeGeometry *geometry, const void *data, SporeError *error) {
  const SmokeFields *fields = data;
  double *points, volume;
  size_t count;
  if (!spore_particle_fill(geometry->surface, (size_t)fields->particles, geometry->cancel, &points, &count, &volume,
                           error))
    return NULL;
  Smoke *smoke = SPORE_NEW(Smoke);
  if (!smoke || !spore_model_init(&smoke->base, &spore_smoke, count, false, error)) {
    spore_free(points);
    spore_free(smoke);
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for smoke"));
    return NULL;
  }
  smoke->rest = points;
  smoke->spacing = cbrt(volume / (double)count);
  smoke->wave = 6.283185307179586 / fields->eddy;
  smoke->now = *fields;
  smoke->base.q_count = smoke->base.q_room += count; /* ages */
  smoke->base.life_s = fields->life;
  smoke->base.buoyancy = fields->buoyancy;
  smoke->base.particle_volume = volume / (double)count;
  for (size_t i = 0; i < count; i++) smoke->base.block_mass[i] = fields->density * volume / (double)count;
  return &smoke->base;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_smoke);
  spore_nodal_place(((const Smoke *)model)->rest, model->node_count, pose, velocity, spin, q, v);
  for (size_t i = 0; i < model->node_count; i++) q[3 * model->node_count + i] = 0;
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(model->type == &spore_smoke);
  assert(f != q && f != v);
  const Smoke *smoke = (const Smoke *)model;
  double drag = smoke->now.drag * model->block_mass[0], push = drag * smoke->now.swirl, k = smoke->wave;
  for (size_t i = 0; i < 3 * model->node_count; i++) f[i] -= drag * v[i];
  if (!(push > 0)) return;
  for (size_t i = 0; i < model->node_count; i++, q += 3, f += 3) {
    double sine[3], cosine[3];
    for (int a = 0; a < 3; a++) sine[a] = sin(k * q[a]), cosine[a] = cos(k * q[a]);
    f[0] += push * (cosine[0] * cosine[1] - sine[2] * sine[0]);
    f[1] += push * (cosine[1] * cosine[2] - sine[0] * sine[1]);
    f[2] += push * (cosine[2] * cosine[0] - sine[1] * sine[2]);
  }
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_smoke);
  const Smoke *smoke = (const Smoke *)model;
  double k = smoke->wave, sum = 0;
  for (size_t i = 0; i < model->node_count; i++, q += 3)
    sum += sin(k * q[0]) * cos(k * q[1]) + sin(k * q[1]) * cos(k * q[2]) + sin(k * q[2]) * cos(k * q[0]);
  return -smoke->now.drag * model->block_mass[0] * smoke->now.swirl / k * sum;
}

/* Parcels grow older. */
static void drift(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1) {
  assert(model->type == &spore_smoke);
  assert(isfinite(h));
  size_t n = model->node_count;
  for (size_t i = 0; i < 3 * n; i++) q1[i] = q[i] + h * v[i], v1[i] = v[i];
  for (size_t i = 3 * n; i < 4 * n; i++) q1[i] = q[i] + h;
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_smoke);
  const Smoke *smoke = (const Smoke *)model;
  return spore_particle_map(smoke->rest, model->node_count, smoke->spacing, points, count, cancel, mapping, error);
}

static bool retune(SporeModel *model, const void *data, SporeError *error) {
  assert(model->type == &spore_smoke);
  Smoke *smoke = (Smoke *)model;
  const SmokeFields *fields = data;
  smoke->now.drag = fields->drag;
  smoke->now.swirl = fields->swirl;
  return true;
}

/* Each second derivative of the pressure is at most 2 k times its strength. */
static void rates(const SporeModel *model, double *frequency, double *damping) {
  const Smoke *smoke = (const Smoke *)model;
  *frequency = sqrt(2 * smoke->wave * smoke->now.drag * smoke->now.swirl);
  *damping = smoke->now.drag;
}

/* What it holds is spread over a wider disc and, towards the end, taken up by the air. */
static void puff(const SporeModel *model, const double *q, size_t particle, double *radius, double *opacity) {
  assert(model->type == &spore_smoke);
  assert(particle < model->node_count);
  const SmokeFields *fields = &((const Smoke *)model)->now;
  double age = q[3 * model->node_count + particle], start = fields->radius * fields->radius;
  double square = start + 4 * fields->diffusivity * age;
  *radius = sqrt(square);
  *opacity = fields->opacity * sqrt(start / square) * fmax(1 - age / fields->life, 0);
}

/* Speed that the air and the lift give a parcel at `place` in the end. */
static SporeVec3 wind(const Smoke *smoke, SporeVec3 gravity, SporeVec3 place) {
  double k = smoke->wave, s = smoke->now.swirl;
  double sx = sin(k * place.x), sy = sin(k * place.y), sz = sin(k * place.z);
  double cx = cos(k * place.x), cy = cos(k * place.y), cz = cos(k * place.z);
  SporeVec3 swirl = {s * (cx * cy - sz * sx), s * (cy * cz - sx * sy), s * (cz * cx - sy * sz)};
  return spore_vec3_add_scaled(swirl, 1 / smoke->now.drag, gravity);
}

/* v' = d (w - v) is solved exactly where the wind w does not change along the way; w is taken half-way, as the parcel
 * goes now. */
static void carry(const SporeModel *model, SporeVec3 gravity, double h, const double *q, const double *v, double *q1,
                  double *v1) {
  assert(model->type == &spore_smoke && h > 0);
  const Smoke *smoke = (const Smoke *)model;
  size_t n = model->node_count;
  double drag = smoke->now.drag, kept = exp(-drag * h), whole = (1 - kept) / drag;
  for (size_t i = 0; i < n; i++) {
    SporeVec3 x = spore_vec3_load(q + 3 * i), speed = spore_vec3_load(v + 3 * i);
    SporeVec3 air = wind(smoke, gravity, spore_vec3_add_scaled(x, 0.5 * h, speed));
    SporeVec3 excess = spore_vec3_sub(speed, air), end = spore_vec3_add_scaled(x, h, air);
    spore_vec3_store(q1 + 3 * i, spore_vec3_add_scaled(end, whole, excess));
    spore_vec3_store(v1 + 3 * i, spore_vec3_add_scaled(air, kept, excess));
  }
  for (size_t i = 3 * n; i < 4 * n; i++) q1[i] = q[i] + h;
}

static const SporeModelParticles particles = {.puff = puff, .carry = carry};

const SporeModelType spore_smoke = {
    .name = "smoke",
    .label = N_("Smoke"),
    .doc = N_("Puffs of smoke or steam: the air bears them up, slows them and drives them about until they dissolve. "
              "They start in a closed surface, or come out of an emitter. They do not feel each other, and touch other "
              "bodies only with the spheres that their collision unit names."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SmokeFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .drift = drift,
    .map = map,
    .retune = retune,
    .rates = rates,
    .particles = &particles,
};
