/* How well a sphere set approximates a solid: coverage, volume outside, distance and depth error. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/spheres/bounding.h"

#define MEASURE_SAMPLES 30000
#define ON_BALL 2e-6 /* of the largest radius: a point that is not deeper counts as on the union's surface */
#define REPORT_EVERY 1024
#define MEASURE_SEED UINT64_C(0x5350484552455321) /* differs from the seeds of the fits */

typedef struct Measure {
  const SporeSolid *solid;
  SporeBalls balls;
  SporeRandom random;
  double *points; /* 3 x capacity, scratch */
  double *value;  /* capacity, scratch */
  size_t capacity;
  SporeProgressPart progress; /* of the quantity being measured */
  SporeError *error;
  bool cancelled;
  double ball_volume; /* sum of r^3 of all balls, overlaps counted repeatedly */
  double on_ball;     /* m: see ON_BALL */
} Measure;

/* Called before each of `count` points. False: cancelled. */
static bool go_on(Measure *m, size_t i, size_t count) {
  if (i % REPORT_EVERY) return true;
  m->cancelled = !spore_progress_part(&m->progress, (double)i / (double)count, _("Measuring"), m->error);
  return !m->cancelled;
}

/* Draws points inside the solid into m->points. False: cancelled. */
static bool draw_interior(Measure *m) {
  m->cancelled = !spore_solid_interior(m->solid, MEASURE_SAMPLES, &m->random, m->points, &m->progress, m->error);
  return !m->cancelled;
}

/* At each point of xyz, in order: max_i (r_i - d_i), the ball that has it, and the number of balls that contain the
 * point. Each output may be NULL. */
static bool field_at(const Measure *m, const double *xyz, size_t count, double *best, uint32_t *owner, uint32_t *held) {
  SporePoints points = {0};
  SporeField field = {0};
  bool done = spore_points_create(&points, xyz, count) && spore_field_create(&field, &points, m->balls.count);
  if (done) spore_field_evaluate(&field, &points, &m->balls);
  for (size_t i = 0; done && i < count; i++) {
    if (best) best[points.original[i]] = field.best[i];
    if (owner) owner[points.original[i]] = field.owner[i];
  }
  uint32_t *sorted = done && held ? SPORE_NEW_ARRAY(uint32_t, points.block_count * SPORE_BLOCK) : NULL;
  if (sorted) {
    spore_field_multiplicity(&field, &points, &m->balls, sorted);
    for (size_t i = 0; i < count; i++) held[points.original[i]] = sorted[i];
  }
  done = done && (!held || sorted);
  spore_free(sorted);
  spore_field_clear(&field);
  spore_points_clear(&points);
  return done;
}

/* Coverage and depth error on interior points. */
static bool measure_inside(Measure *m, SporeSpheresReport *report) {
  if (!draw_interior(m)) return false;
  if (!field_at(m, m->points, MEASURE_SAMPLES, m->value, NULL, NULL)) return false;
  double deepest = 0, error = 0;
  size_t covered = 0;
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    if (!go_on(m, i, MEASURE_SAMPLES)) return false;
    double depth = spore_bvh_distance(m->solid->bvh, spore_vec3_load(m->points + 3 * i), NULL, NULL);
    deepest = fmax(deepest, depth);
    error += fabs(depth - fmax(m->value[i], 0));
    covered += m->value[i] >= 0;
  }
  report->coverage = (double)covered / MEASURE_SAMPLES;
  report->depth_error = deepest > 0 ? error / MEASURE_SAMPLES / deepest : 0;
  return true;
}

double spore_spheres_weighted_depth(const SporeSphereSet *set, const double p[3]) {
  double sum = -set->level;
  for (size_t i = 0; i < set->count; i++) {
    const double *s = set->spheres + 4 * i;
    double dx = s[0] - p[0], dy = s[1] - p[1], dz = s[2] - p[2];
    sum += set->weights[i] * fmax(0, s[3] - sqrt(dx * dx + dy * dy + dz * dz));
  }
  return fmax(sum, 0);
}

/* Depth error of the weighted sum, and the share of points outside with a sum above 0. False: cancelled. */
static bool measure_weighted(Measure *m, const SporeSphereSet *set, SporeSpheresReport *report) {
  double deepest = 0, error = 0, near = SPORE_SPHERES_NEAR * m->solid->diagonal;
  size_t outside = 0, felt = 0;
  if (!draw_interior(m)) return false;
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    if (!go_on(m, i, 2 * MEASURE_SAMPLES)) return false;
    double depth = spore_bvh_distance(m->solid->bvh, spore_vec3_load(m->points + 3 * i), NULL, NULL);
    deepest = fmax(deepest, depth);
    error += fabs(depth - spore_spheres_weighted_depth(set, m->points + 3 * i));
  }
  spore_solid_surface(m->solid, MEASURE_SAMPLES, &m->random, m->points, NULL);
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    if (!go_on(m, MEASURE_SAMPLES + i, 2 * MEASURE_SAMPLES)) return false;
    double distance = near * spore_random_unit(&m->random), p[3];
    SporeVec3 place =
        spore_vec3_add_scaled(spore_vec3_load(m->points + 3 * i), distance, spore_random_direction(&m->random));
    if (spore_bvh_inside(m->solid->bvh, place)) continue;
    spore_vec3_store(p, place);
    outside++;
    felt += spore_spheres_weighted_depth(set, p) > 0;
  }
  report->weighted_depth_error = deepest > 0 ? error / MEASURE_SAMPLES / deepest : 0;
  report->felt_outside = outside ? (double)felt / (double)outside : 0;
  return true;
}

/* Volume of the union outside the solid, from points drawn in the balls. Each point is divided by the number of balls
 * that contain it. */
static bool measure_outside(Measure *m, SporeSpheresReport *report) {
  uint32_t *held = SPORE_NEW_ARRAY(uint32_t, MEASURE_SAMPLES);
  if (!held) return false;
  double end = 0;
  size_t ball = 0;
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    double share = ((double)i + spore_random_unit(&m->random)) / MEASURE_SAMPLES * m->ball_volume;
    while (ball + 1 < m->balls.count && end + pow(m->balls.r[ball], 3) <= share) end += pow(m->balls.r[ball++], 3);
    double distance = m->balls.r[ball] * cbrt(spore_random_unit(&m->random));
    spore_vec3_store(m->points + 3 * i,
                     spore_vec3_add_scaled(spore_vec3(m->balls.x[ball], m->balls.y[ball], m->balls.z[ball]), distance,
                                           spore_random_direction(&m->random)));
  }
  bool done = field_at(m, m->points, MEASURE_SAMPLES, NULL, NULL, held);
  double sum = 0;
  for (size_t i = 0; done && i < MEASURE_SAMPLES && (done = go_on(m, i, MEASURE_SAMPLES)); i++)
    if (!spore_bvh_inside(m->solid->bvh, spore_vec3_load(m->points + 3 * i))) sum += 1. / (held[i] ? held[i] : 1);
  report->outside = sum / MEASURE_SAMPLES * m->ball_volume * (4 * M_PI / 3) / m->solid->volume;
  spore_free(held);
  return done;
}

/* Draws points on the spheres and keeps those that no other ball contains, which lie on the surface of the union.
 * Returns their number. *failed: no memory. */
static size_t union_surface(Measure *m, bool *failed) {
  double area = 0;
  size_t count = 0, kept = 0;
  for (size_t i = 0; i < m->balls.count; i++) area += m->balls.r[i] * m->balls.r[i];
  double sum = 0;
  size_t ball = 0;
  for (; count < 2 * MEASURE_SAMPLES; count++) {
    double share = ((double)count + spore_random_unit(&m->random)) / (2 * MEASURE_SAMPLES) * area;
    while (ball + 1 < m->balls.count && sum + m->balls.r[ball] * m->balls.r[ball] <= share)
      sum += m->balls.r[ball] * m->balls.r[ball], ball++;
    spore_vec3_store(m->points + 3 * count,
                     spore_vec3_add_scaled(spore_vec3(m->balls.x[ball], m->balls.y[ball], m->balls.z[ball]),
                                           m->balls.r[ball], spore_random_direction(&m->random)));
  }
  *failed = !field_at(m, m->points, count, m->value, NULL, NULL);
  if (*failed) return 0;
  for (size_t i = 0; i < count; i++)
    if (m->value[i] <= m->on_ball) memmove(m->points + 3 * kept++, m->points + 3 * i, 3 * sizeof(double));
  return kept;
}

/* A tree over points: triangles whose corners coincide. */
static SporeBvh *tree_of_points(const double *points, size_t count, SporeError *error) {
  SporeTriangleMesh mesh;
  if (!spore_triangle_mesh_allocate(&mesh, count, count, error)) return NULL;
  memcpy(mesh.vertices, points, 3 * count * sizeof *points);
  for (size_t i = 0; i < 3 * count; i++) mesh.triangles[i] = (uint32_t)(i / 3);
  SporeBvh *tree = spore_bvh_create(&mesh, error);
  spore_triangle_mesh_clear(&mesh);
  return tree;
}

typedef struct Distances {
  double sum, most;
  size_t count;
} Distances;

static void add_distance(Distances *d, double distance) {
  d->sum += distance;
  d->most = fmax(d->most, distance);
  d->count++;
}

/* Points of the solid's surface, and for each its radial projection on the sphere of its deepest ball. */
typedef struct Projection {
  double *surface, *way_out; /* x 3 */
  double *value, *way_value; /* the field there */
  uint32_t *owner;
} Projection;

static bool project_surface(Measure *m, Projection *p) {
  *p = (Projection){SPORE_NEW_ARRAY(double, 3 * MEASURE_SAMPLES), SPORE_NEW_ARRAY(double, 3 * MEASURE_SAMPLES),
                    SPORE_NEW_ARRAY(double, MEASURE_SAMPLES), SPORE_NEW_ARRAY(double, MEASURE_SAMPLES),
                    SPORE_NEW_ARRAY(uint32_t, MEASURE_SAMPLES)};
  if (!p->surface || !p->way_out || !p->value || !p->way_value || !p->owner) return false;
  spore_solid_surface(m->solid, MEASURE_SAMPLES, &m->random, p->surface, NULL);
  if (!field_at(m, p->surface, MEASURE_SAMPLES, p->value, p->owner, NULL)) return false;
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    SporeVec3 c = spore_vec3(m->balls.x[p->owner[i]], m->balls.y[p->owner[i]], m->balls.z[p->owner[i]]);
    SporeVec3 out = spore_vec3_normalise(spore_vec3_sub(spore_vec3_load(p->surface + 3 * i), c), spore_vec3(0, 0, 1));
    spore_vec3_store(p->way_out + 3 * i, spore_vec3_add_scaled(c, m->balls.r[p->owner[i]], out));
  }
  return field_at(m, p->way_out, MEASURE_SAMPLES, p->way_value, NULL, NULL);
}

static void clear_projection(Projection *p) {
  spore_free(p->surface);
  spore_free(p->way_out);
  spore_free(p->value);
  spore_free(p->way_value);
  spore_free(p->owner);
}

/* Distances from the solid's surface to the union's surface. Outside the union the distance is the absolute field.
 * Inside it is the depth in the deepest ball, if no other ball contains the projected point; else the distance to the
 * nearest known point of the union's surface. `known`: number of known points, in m->points. */
static bool from_solid(Measure *m, const Projection *p, size_t known, Distances *distances, SporeError *error) {
  for (size_t i = 0; i < MEASURE_SAMPLES; i++)
    if (p->way_value[i] <= m->on_ball) memcpy(m->points + 3 * known++, p->way_out + 3 * i, 3 * sizeof(double));
  SporeBvh *tree = known ? tree_of_points(m->points, known, error) : NULL;
  if (known && !tree) return false;
  bool done = true;
  for (size_t i = 0; i < MEASURE_SAMPLES; i++) {
    double distance = fabs(p->value[i]);
    if (!(done = go_on(m, MEASURE_SAMPLES + i, 2 * MEASURE_SAMPLES))) break;
    if (p->value[i] > 0 && p->way_value[i] > m->on_ball && tree)
      distance = fmax(distance, spore_bvh_distance(tree, spore_vec3_load(p->surface + 3 * i), NULL, NULL));
    add_distance(distances, distance);
  }
  spore_bvh_free(tree);
  return done;
}

static bool measure_surfaces(Measure *m, SporeSpheresReport *report, SporeError *error) {
  bool failed;
  size_t count = union_surface(m, &failed);
  if (failed) return false;
  Distances there = {0}, back = {0};
  for (size_t i = 0; i < count; i++) {
    if (!go_on(m, i, 2 * count)) return false;
    add_distance(&there, spore_bvh_distance(m->solid->bvh, spore_vec3_load(m->points + 3 * i), NULL, NULL));
  }
  Projection projection;
  bool done = project_surface(m, &projection) && from_solid(m, &projection, count, &back, error);
  clear_projection(&projection);
  if (!done) return false;
  double mean = 0.5 * (back.sum / (double)back.count + (there.count ? there.sum / (double)there.count : 0));
  report->distance_mean = mean / m->solid->diagonal;
  report->distance_max = fmax(there.most, back.most) / m->solid->diagonal;
  return true;
}

/* The proof is skipped where samples already found a gap. */
static bool certify(const Measure *m, const SporeSpheresReport *report) {
  SporeMeshReport mesh;
  return report->coverage == 1 && spore_triangle_mesh_report(&m->solid->mesh, &mesh, NULL) && mesh.closed &&
         spore_balls_cover(m->solid, &m->balls);
}

static SporeProgressPart part_at(const SporeProgressPart *whole, double first, double share) {
  return (SporeProgressPart){whole->whole, whole->first + whole->share * first, whole->share * share};
}

bool spore_solid_measure(const SporeSolid *solid, const SporeSphereSet *set, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error) {
  Measure m = {.solid = solid, .random = {MEASURE_SEED}, .capacity = 3 * MEASURE_SAMPLES, .error = error};
  m.points = SPORE_NEW_ARRAY(double, 3 * m.capacity);
  m.value = SPORE_NEW_ARRAY(double, m.capacity);
  bool ready = m.points && m.value && spore_balls_create(&m.balls, set->count), done = ready;
  *report = (SporeSpheresReport){0};
  for (size_t i = 0; ready && i < set->count; i++) {
    m.balls.x[i] = set->spheres[4 * i], m.balls.y[i] = set->spheres[4 * i + 1], m.balls.z[i] = set->spheres[4 * i + 2];
    m.balls.r[i] = set->spheres[4 * i + 3];
    m.ball_volume += pow(m.balls.r[i], 3);
    m.on_ball = fmax(m.on_ball, ON_BALL * m.balls.r[i]);
  }
  m.progress = part_at(progress, 0, 0.4);
  done = done && go_on(&m, 0, 1) && measure_inside(&m, report);
  m.progress = part_at(progress, 0.4, 0.2);
  done = done && go_on(&m, 0, 1) && measure_outside(&m, report);
  m.progress = part_at(progress, 0.6, 0.2);
  done = done && go_on(&m, 0, 1) && measure_surfaces(&m, report, error);
  m.progress = part_at(progress, 0.8, 0.2);
  done = done && (!set->weights || measure_weighted(&m, set, report));
  if (!done && !m.cancelled) spore_generate_no_memory(error);
  if (done) report->certified = certify(&m, report);
  spore_free(m.points);
  spore_free(m.value);
  spore_balls_clear(&m.balls);
  return done;
}

bool spore_spheres_measure(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresReport *report,
                           SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  SporeProgressPart none = {NULL, 0, 1};
  *report = (SporeSpheresReport){0};
  if (!spore_sphere_set_validate(set, error) || !spore_solid_create(&solid, mesh, error)) return false;
  bool done = spore_solid_measure(&solid, set, report, &none, error);
  spore_solid_clear(&solid);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}
