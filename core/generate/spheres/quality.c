/* The error of each sphere, and the distance of each vertex of the surface from the set. */
#include "core/generate/spheres/spheres.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define POINTS_A_SPHERE 64
#define GOLDEN_ANGLE 2.399963229728653 /* rad: points on a Fibonacci spiral */

/* Points spread evenly in the unit ball: directions on a spiral, radii of shells of equal volume. */
static SporeVec3 unit_point(int i) {
  double z = 1 - (2 * i + 1.0) / POINTS_A_SPHERE, ring = sqrt(1 - z * z), turn = i * GOLDEN_ANGLE;
  double r = cbrt((i * 29 % POINTS_A_SPHERE + 0.5) / POINTS_A_SPHERE);
  return spore_vec3(r * ring * cos(turn), r * ring * sin(turn), r * z);
}

static double outside_share(const SporeBvh *bvh, const double *sphere) {
  int outside = 0;
  for (int i = 0; i < POINTS_A_SPHERE; i++)
    outside += !spore_bvh_inside(bvh, spore_vec3_add_scaled(spore_vec3_load(sphere), sphere[3], unit_point(i)));
  return (double)outside / POINTS_A_SPHERE;
}

static bool judge_spheres(const SporeSolid *solid, const SporeSphereSet *set, SporeSpheresQuality *quality,
                          const SporeProgressPart *progress, SporeError *error) {
  for (size_t i = 0; i < set->count; i++) {
    const double *sphere = set->spheres + 4 * i;
    if (i % 16 == 0 && !spore_progress_part(progress, (double)i / (double)set->count, _("Measuring"), error))
      return false;
    quality->outside[i] = outside_share(solid->bvh, sphere);
    double felt = set->weights ? spore_spheres_weighted_depth(set, sphere) : sphere[3];
    quality->depth_error[i] = fabs(felt - spore_bvh_depth(solid->bvh, spore_vec3_load(sphere)));
  }
  return true;
}

static bool judge_surface(const SporeTriangleMesh *mesh, const SporeSphereSet *set, double *distance,
                          SporeError *error) {
  SporePoints points = {0};
  SporeBalls balls = {0};
  SporeField field = {0};
  bool done = spore_balls_create(&balls, set->count) &&
              spore_points_create(&points, mesh->vertices, mesh->vertex_count) &&
              spore_field_create(&field, &points, set->count);
  for (size_t i = 0; done && i < set->count; i++) {
    const double *sphere = set->spheres + 4 * i;
    balls.x[i] = sphere[0], balls.y[i] = sphere[1], balls.z[i] = sphere[2], balls.r[i] = sphere[3];
  }
  if (done) spore_field_evaluate(&field, &points, &balls);
  for (size_t i = 0; done && i < mesh->vertex_count; i++) distance[points.original[i]] = -field.best[i];
  spore_field_clear(&field);
  spore_points_clear(&points);
  spore_balls_clear(&balls);
  return done || spore_generate_no_memory(error);
}

static void share_area(const SporeTriangleMesh *mesh, double *area) {
  double whole = 0;
  for (size_t i = 0; i < mesh->vertex_count; i++) area[i] = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *corner = mesh->triangles + 3 * t;
    SporeVec3 a = spore_vec3_load(mesh->vertices + 3 * (size_t)corner[0]);
    SporeVec3 ab = spore_vec3_sub(spore_vec3_load(mesh->vertices + 3 * (size_t)corner[1]), a);
    SporeVec3 ac = spore_vec3_sub(spore_vec3_load(mesh->vertices + 3 * (size_t)corner[2]), a);
    double size = spore_vec3_length(spore_vec3_cross(ab, ac));
    whole += size;
    for (int k = 0; k < 3; k++) area[corner[k]] += size / 3;
  }
  for (size_t i = 0; whole > 0 && i < mesh->vertex_count; i++) area[i] /= whole;
}

bool spore_spheres_quality(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresQuality *quality,
                           const SporeProgress *progress, SporeError *error) {
  SporeSolid solid;
  SporeProgressPart whole = {progress, 0, 1};
  *quality = (SporeSpheresQuality){0};
  if (!spore_sphere_set_validate(set, error) || !spore_solid_create(&solid, mesh, error)) return false;
  *quality = (SporeSpheresQuality){.sphere_count = set->count,
                                   .vertex_count = mesh->vertex_count,
                                   .outside = SPORE_NEW_ARRAY(double, set->count),
                                   .depth_error = SPORE_NEW_ARRAY(double, set->count),
                                   .distance = SPORE_NEW_ARRAY(double, mesh->vertex_count),
                                   .area = SPORE_NEW_ARRAY(double, mesh->vertex_count)};
  bool memory = quality->outside && quality->depth_error && quality->distance && quality->area;
  if (memory) share_area(mesh, quality->area);
  bool done =
      memory ? judge_spheres(&solid, set, quality, &whole, error) && judge_surface(mesh, set, quality->distance, error)
             : spore_generate_no_memory(error);
  spore_solid_clear(&solid);
  if (!done) spore_spheres_quality_clear(quality);
  return done;
}

void spore_spheres_quality_clear(SporeSpheresQuality *quality) {
  spore_free(quality->outside);
  spore_free(quality->depth_error);
  spore_free(quality->distance);
  spore_free(quality->area);
  *quality = (SporeSpheresQuality){0};
}
