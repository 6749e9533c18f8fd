/* The solid of a surface: where the winding number is over one half. The surface may have holes and self-intersections.
 */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define WELD 1e-6         /* of the diagonal */
#define SAMPLES 20000     /* of a surface */
#define BESIDE 1e-4       /* of the diagonal: distance from the surface at which its two sides are tested */
#define VOLUME_ROWS 96    /* across the diagonal */
#define THIN 8            /* row distance over the thickness of the thinnest wall that a row cannot miss */
#define LEAST_VOLUME 1e-6 /* of the diagonal's cube */
#define SAMPLES_A_REPORT 512
#define ROUNDS 4   /* of moving vertices of the boundary, for each turn */
#define BEYOND 0.3 /* of the tolerance: distances beyond count more than by their squares */
#define POINTS 2   /* of the surface, for each cell */
#define LEAST_POINTS 1000

static SporeVec3 normal_of(const SporeTriangleMesh *mesh, uint32_t triangle) {
  const uint32_t *corner = mesh->triangles + 3 * (size_t)triangle;
  return spore_vec3_normalise(spore_mesh_area_vector(spore_mesh_vertex(mesh->vertices, corner[0]),
                                                     spore_mesh_vertex(mesh->vertices, corner[1]),
                                                     spore_mesh_vertex(mesh->vertices, corner[2])),
                              spore_vec3(0, 0, 0));
}

/* Sorts points of the surface. Points with the solid on one side only bound the solid; points with the solid on both
 * sides lie inside. */
static bool sort_samples(SporeTetrahedraWork *work, SporeError *error) {
  double *points = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  uint32_t *triangles = SPORE_NEW_ARRAY(uint32_t, SAMPLES);
  work->bounding = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  work->inner = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  bool done = (points && triangles && work->bounding && work->inner) || spore_mesh_no_memory(error);
  if (done) spore_surface_samples(&work->surface, SAMPLES, points, triangles);
  for (size_t i = 0; done && i < SAMPLES; i++) {
    if (i % SAMPLES_A_REPORT == 0)
      done = spore_tetrahedra_progress(work, 0.5 * (double)i / SAMPLES, _("looking at the surface"), error);
    SporeVec3 p = spore_vec3_load(points + 3 * i), n = normal_of(&work->surface, triangles[i]);
    bool behind = spore_bvh_inside(work->tree, spore_vec3_add_scaled(p, -BESIDE, n));
    bool before = spore_bvh_inside(work->tree, spore_vec3_add_scaled(p, BESIDE, n));
    if (behind != before) spore_vec3_store(work->bounding + 3 * work->bounding_count++, p);
    else if (behind) spore_vec3_store(work->inner + 3 * work->inner_count++, p);
  }
  spore_free(points);
  spore_free(triangles);
  return done;
}

/* Length of the solid along a row. Each step is the distance to the surface, or at least `least`, so that no wall of
 * that thickness is missed. The errors where the row enters and leaves the solid are at most `least`, in opposite
 * directions. */
static double row_inside(const SporeBvh *tree, SporeVec3 p, double length, double least) {
  double sum = 0, step;
  for (double x = 0; x < length; x += step) {
    double depth = spore_bvh_depth(tree, spore_vec3(p.x + x, p.y, p.z));
    step = fmax(fabs(depth), least);
    if (depth > 0) sum += step;
  }
  return sum;
}

/* given: figures of the surface before its cavities were dropped. */
static bool measure_volume(SporeTetrahedraWork *work, const SporeMeshReport *given, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report(&work->surface, &report, error)) return false;
  const bool sound = given->closed && !work->inner_count && given->volume != 0;
  work->area = (sound ? given->area : report.area) * (double)work->bounding_count / SAMPLES;
  work->volume = fabs(given->volume);
  if (sound) return true;
  const double h = 1.0 / VOLUME_ROWS;
  size_t count[3];
  double sum = 0;
  for (int k = 0; k < 3; k++) count[k] = (size_t)ceil((report.upper[k] - report.lower[k]) / h) + 2;
  for (size_t z = 0; z < count[2]; z++) {
    for (size_t y = 0; y < count[1]; y++)
      sum += row_inside(work->tree,
                        spore_vec3(report.lower[0] - 0.5 * h, report.lower[1] + ((double)y - 0.5) * h,
                                   report.lower[2] + ((double)z - 0.5) * h),
                        (double)count[0] * h, h / THIN);
    if (!spore_tetrahedra_progress(work, 0.5 + 0.5 * (double)z / (double)count[2], _("looking at the surface"), error))
      return false;
  }
  work->volume = sum * h * h;
  return true;
}

/* Chooses and turns the pieces of the surface as the options say. report: of what remains. */
static bool arrange(SporeTetrahedraWork *work, SporeMeshReport *report, SporeError *error) {
  SporeTriangleMesh *surface = &work->surface;
  return spore_triangle_mesh_weld_tagged(surface, WELD, work->parts, error) &&
         spore_triangle_mesh_orient(surface, error) &&
         (!work->options.largest || spore_tetrahedra_keep_largest(work, error)) &&
         (!work->options.hollow || spore_tetrahedra_hollow(work, error)) &&
         spore_triangle_mesh_report(surface, report, error);
}

bool spore_tetrahedra_solid(SporeTetrahedraWork *work, SporeError *error) {
  SporeMeshReport report;
  if (!arrange(work, &report, error)) return false;
  /* Open sheets keep their orientation. A surface that is inside out as a whole is turned over. */
  if (report.volume < 0)
    for (size_t t = 0; t < work->surface.triangle_count; t++) {
      uint32_t *corner = work->surface.triangles + 3 * t, kept = corner[1];
      corner[1] = corner[2], corner[2] = kept;
    }
  work->open = report.boundary_edges > 0;
  if (work->options.fill && !spore_tetrahedra_fill(&work->surface, work->parts, &work->filled, error)) return false;
  work->tree = spore_bvh_create(&work->surface, error);
  if (!work->tree || !sort_samples(work, error) || !measure_volume(work, &report, error)) return false;
  if (work->volume > LEAST_VOLUME && work->bounding_count) return true;
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("the surface of %zu triangles encloses nothing; expected one that encloses a volume; give a closed surface, or "
        "make a sheet a deformable surface"),
      work->surface.triangle_count);
}

/* Largest distance from `count` points to the surface. */
static double farthest(const SporeBvh *tree, const double *points, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; i++)
    most = fmax(most, spore_bvh_distance(tree, spore_vec3_load(points + 3 * i), NULL, NULL));
  return most;
}

bool spore_tetrahedra_distances(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double *hausdorff,
                                double *inner, double *area, SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  SporeMeshReport report = {0};
  double *points = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  SporeBvh *tree = NULL;
  bool done = (points && spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count)) ||
              spore_mesh_no_memory(error);
  done = done && (tree = spore_bvh_create(&boundary, error)) && spore_triangle_mesh_report(&boundary, &report, error);
  if (done) {
    spore_surface_samples(&boundary, SAMPLES, points, NULL);
    *hausdorff = fmax(farthest(tree, work->bounding, work->bounding_count),
                      farthest(spore_tetrahedra_bounds(work), points, SAMPLES));
    *inner = farthest(tree, work->inner, work->inner_count);
    *area = report.area;
  }
  spore_bvh_free(tree);
  spore_free(points);
  spore_free(boundary.triangles);
  return done;
}

bool spore_tetrahedra_points(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, size_t most,
                             SporeSkinPoints *points, SporeError *error) {
  if (!spore_skin_points_create(points, mesh, work->bounding, work->bounding_count, most, error)) return false;
  if (!mesh->labels || spore_skin_points_add_borders(points, mesh, work->borders, work->border_count, most, error))
    return true;
  spore_skin_points_clear(points);
  return false;
}

static double distance_of(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error) {
  double hausdorff, inner, area;
  return spore_tetrahedra_distances(work, mesh, &hausdorff, &inner, &area, error) ? hausdorff : -1;
}

bool spore_tetrahedra_near(const SporeTetrahedraWork *work, const SporeBvh *surface, int turns,
                           SporeTetrahedralMesh *mesh, SporeError *error) {
  double *kept = SPORE_NEW_ARRAY(double, 3 * mesh->vertex_count), least = HUGE_VAL;
  bool done = kept || spore_mesh_no_memory(error), helps = true;
  for (int turn = 0; done && helps && turn < turns; turn++) {
    SporeSkinPoints points;
    memcpy(kept, mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
    done = spore_tetrahedra_progress(work, (double)turn / turns, _("fitting the cells"), error);
    if (!done ||
        !(done = spore_tetrahedra_points(work, mesh, POINTS * mesh->tetrahedron_count + LEAST_POINTS, &points, error)))
      break;
    done = spore_tetrahedra_approach(mesh, surface, &points, ROUNDS, BEYOND * work->options.tolerance,
                                     SPORE_TETRAHEDRA_KEPT, error);
    spore_skin_points_clear(&points);
    double distance = done ? distance_of(work, mesh, error) : -1;
    done = distance >= 0;
    helps = distance < least;
    least = distance;
  }
  if (done && !helps) memcpy(mesh->vertices, kept, 3 * mesh->vertex_count * sizeof(double));
  spore_free(kept);
  return done;
}
