/* Spheres on a surface without volume: k-means (Lloyd 1982) divides the area among the centres. Parts where the surface
 * bends weigh more. Each centre stays on the surface. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define SAMPLES_A_SPHERE 60
#define SAMPLES_LEAST 6000
#define SAMPLES_MOST 120000
#define ROUNDS 20
#define BENDING 2.0      /* additional weight where the radius of curvature equals the spacing of spheres */
#define BENDING_MOST 8.0 /* largest weight; 1: flat */

typedef struct Sheet {
  SporeTriangleMesh mesh; /* a copy, for the sampler of solids */
  SporeBvh *bvh;
  SporeSolid solid; /* not a solid: only the mesh and the areas are set, for the sampler */
  SporePoints points;
  double *weight; /* of the points, in their order; the padding has weight 0 */
  SporeBalls balls;
  SporeField field;
  double *sums; /* balls x 4 */
  double area, diagonal, spacing;
} Sheet;

static SporeVec3 corner(const SporeTriangleMesh *mesh, size_t triangle, int k) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * triangle + (size_t)k]);
}

/* Curvature about a triangle, 1/m: largest change of the corner normals along an edge, over the edge's length. */
static double bend(const SporeTriangleMesh *mesh, const double *normals, size_t triangle) {
  double most = 0;
  for (int k = 0; k < 3; k++) {
    int next = (k + 1) % 3;
    size_t a = mesh->triangles[3 * triangle + (size_t)k], b = mesh->triangles[3 * triangle + (size_t)next];
    double length = spore_vec3_distance(corner(mesh, triangle, k), corner(mesh, triangle, next));
    double turn = spore_vec3_distance(spore_vec3_load(normals + 3 * a), spore_vec3_load(normals + 3 * b));
    if (length > 0) most = fmax(most, turn / length);
  }
  return most;
}

static bool sum_areas(Sheet *sheet) {
  sheet->solid.triangle_end = SPORE_NEW_ARRAY(double, sheet->mesh.triangle_count);
  if (!sheet->solid.triangle_end) return false;
  for (size_t t = 0; t < sheet->mesh.triangle_count; t++) {
    SporeVec3 a = corner(&sheet->mesh, t, 0);
    sheet->area += 0.5 * spore_vec3_length(spore_vec3_cross(spore_vec3_sub(corner(&sheet->mesh, t, 1), a),
                                                            spore_vec3_sub(corner(&sheet->mesh, t, 2), a)));
    sheet->solid.triangle_end[t] = sheet->area;
  }
  return true;
}

/* Sets the weights in the points' order, by the curvature of the triangle on which each point lies. */
static bool weigh(Sheet *sheet) {
  size_t padded = sheet->points.block_count * SPORE_BLOCK;
  double *normals = SPORE_NEW_ARRAY(double, 3 * sheet->mesh.vertex_count);
  sheet->weight = SPORE_NEW_ARRAY(double, padded);
  if (normals && sheet->weight) {
    const SporeTriangleMesh *mesh = &sheet->mesh;
    spore_triangle_mesh_normals(mesh->vertices, mesh->vertex_count, mesh->triangles, mesh->triangle_count, normals);
    for (size_t i = 0; i < sheet->points.count; i++) {
      uint32_t triangle;
      spore_bvh_distance(sheet->bvh, spore_vec3(sheet->points.x[i], sheet->points.y[i], sheet->points.z[i]), NULL,
                         &triangle);
      sheet->weight[i] = fmin(1 + BENDING * bend(mesh, normals, triangle) * sheet->spacing, BENDING_MOST);
    }
  }
  spore_free(normals);
  return normals && sheet->weight;
}

static bool open_sheet(Sheet *sheet, const SporeTriangleMesh *mesh, size_t count, SporeRandom *random,
                       SporeError *error) {
  SporeMeshReport report;
  size_t samples = SAMPLES_A_SPHERE * count;
  if (samples < SAMPLES_LEAST) samples = SAMPLES_LEAST;
  if (samples > SAMPLES_MOST) samples = SAMPLES_MOST;
  *sheet = (Sheet){0};
  if (!spore_triangle_mesh_report(mesh, &report, error)) return false;
  sheet->diagonal = report.diagonal;
  if (!spore_triangle_mesh_copy(&sheet->mesh, mesh, error) || !(sheet->bvh = spore_bvh_create(&sheet->mesh, error)))
    return false;
  if (!sum_areas(sheet)) return spore_generate_no_memory(error);
  if (!(sheet->area > 0))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface has no area; triangles with some were expected; check the mesh"));
  sheet->solid.mesh = sheet->mesh;
  sheet->spacing = sqrt(sheet->area / (double)count);
  double *xyz = SPORE_NEW_ARRAY(double, 3 * samples);
  if (xyz) spore_solid_surface(&sheet->solid, samples, random, xyz, NULL);
  bool done = xyz && spore_points_create(&sheet->points, xyz, samples) && weigh(sheet) &&
              spore_balls_create(&sheet->balls, count) && spore_field_create(&sheet->field, &sheet->points, count) &&
              (sheet->sums = SPORE_NEW_ARRAY(double, 4 * count));
  spore_free(xyz);
  return done || spore_generate_no_memory(error);
}

static void close_sheet(Sheet *sheet) {
  spore_triangle_mesh_clear(&sheet->mesh);
  spore_bvh_free(sheet->bvh);
  spore_free(sheet->solid.triangle_end);
  spore_points_clear(&sheet->points);
  spore_free(sheet->weight);
  spore_balls_clear(&sheet->balls);
  spore_field_clear(&sheet->field);
  spore_free(sheet->sums);
}

static SporeVec3 sample(const Sheet *sheet, size_t i) {
  return spore_vec3(sheet->points.x[i], sheet->points.y[i], sheet->points.z[i]);
}

/* Puts centres at equal shares of the weight along the space-filling order of the points. */
static void start(Sheet *sheet) {
  double all = 0, sum = 0;
  size_t n = sheet->balls.count, next = 0;
  for (size_t i = 0; i < sheet->points.count; i++) all += sheet->weight[i];
  for (size_t i = 0; i < sheet->points.count && next < n; i++) {
    sum += sheet->weight[i];
    while (next < n && sum >= all * ((double)next + 0.5) / (double)n)
      spore_balls_set(&sheet->balls, next++, sample(sheet, i), 0);
  }
  for (; next < n; next++) spore_balls_set(&sheet->balls, next, sample(sheet, sheet->points.count - 1), 0);
}

/* Moves each centre to the weighted mean of the points nearest to it, then back onto the surface. */
static void move_centres(Sheet *sheet) {
  memset(sheet->sums, 0, 4 * sheet->balls.count * sizeof *sheet->sums);
  for (size_t i = 0; i < sheet->points.count; i++) {
    double *sum = sheet->sums + 4 * (size_t)sheet->field.owner[i], w = sheet->weight[i];
    sum[0] += w * sheet->points.x[i], sum[1] += w * sheet->points.y[i], sum[2] += w * sheet->points.z[i], sum[3] += w;
  }
  for (size_t i = 0; i < sheet->balls.count; i++) {
    const double *sum = sheet->sums + 4 * i;
    SporeVec3 nearest = spore_balls_centre(&sheet->balls, i);
    if (sum[3] > 0) spore_bvh_distance(sheet->bvh, spore_vec3_scale(1 / sum[3], spore_vec3_load(sum)), &nearest, NULL);
    spore_balls_set(&sheet->balls, i, nearest, 0);
  }
}

/* Radii from the thickness; if that is 0, each sphere just contains the points nearest to its centre. */
static void set_radii(Sheet *sheet, double thickness) {
  for (size_t i = 0; i < sheet->balls.count; i++)
    sheet->balls.r[i] = thickness > 0 ? 0.5 * thickness : 1e-6 * sheet->spacing;
  for (size_t i = 0; thickness <= 0 && i < sheet->points.count; i++)
    sheet->balls.r[sheet->field.owner[i]] = fmax(sheet->balls.r[sheet->field.owner[i]], -sheet->field.best[i]);
}

static void measure(Sheet *sheet, double thickness, SporeSpheresReport *report) {
  double held = 0, sum = 0, most = 0;
  spore_field_evaluate(&sheet->field, &sheet->points, &sheet->balls);
  for (size_t i = 0; i < sheet->points.count; i++) {
    double gap = fmax(-sheet->field.best[i], 0);
    double distance = thickness > 0 ? gap : sheet->balls.r[sheet->field.owner[i]];
    held += gap <= 1e-6 * sheet->spacing;
    sum += distance, most = fmax(most, distance);
  }
  *report = (SporeSpheresReport){.coverage = held / (double)sheet->points.count,
                                 .outside = NAN,
                                 .distance_mean = sum / (double)sheet->points.count / sheet->diagonal,
                                 .distance_max = most / sheet->diagonal,
                                 .depth_error = NAN};
}

static bool settle(Sheet *sheet, const SporeProgressPart *progress, SporeError *error) {
  start(sheet);
  for (int round = 0; round < ROUNDS; round++) {
    if (!spore_progress_part(progress, (double)round / ROUNDS, _("Spreading spheres"), error)) return false;
    spore_field_evaluate(&sheet->field, &sheet->points, &sheet->balls);
    move_centres(sheet);
    spore_progress_show_balls(progress, &sheet->balls);
  }
  spore_field_evaluate(&sheet->field, &sheet->points, &sheet->balls);
  return true;
}

bool spore_spheres_over(const SporeTriangleMesh *mesh, size_t count, const SporeSpheresOptions *options,
                        SporeSphereSet *set, SporeSpheresReport *report, const SporeProgressPart *progress,
                        SporeError *error) {
  Sheet sheet;
  SporeRandom random = {options->seed};
  *set = (SporeSphereSet){0};
  bool done = open_sheet(&sheet, mesh, count, &random, error) && settle(&sheet, progress, error);
  if (done) {
    set_radii(&sheet, options->thickness);
    measure(&sheet, options->thickness, report);
  }
  done = done && spore_sphere_set_allocate(set, count, error);
  for (size_t i = 0; done && i < count; i++) {
    spore_vec3_store(set->spheres + 4 * i, spore_balls_centre(&sheet.balls, i));
    set->spheres[4 * i + 3] = sheet.balls.r[i];
  }
  close_sheet(&sheet);
  return done;
}
