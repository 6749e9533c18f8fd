/* Sphere sets that approximate a solid's depth field (Meseure et al. 2003, section 4). */
#ifndef SPORE_GENERATE_SPHERES_SPHERES_H
#define SPORE_GENERATE_SPHERES_SPHERES_H

#include "core/generate/common/common.h"

/* What a set is optimised for. The names below are used in files and on the command line. */
typedef enum SporeSpheresMode {
  SPORE_SPHERES_BALANCED, /* fits max(r_i - |x - c_i|) to the depth, inside and just outside */
  SPORE_SPHERES_BOUNDING, /* covers all of the solid, with little outside */
  SPORE_SPHERES_WEIGHTED, /* has weights, and fits sum w_i max(0, r_i - |x - c_i|) to the depth */
  SPORE_SPHERES_MODE_COUNT
} SporeSpheresMode;
extern const char *const spore_spheres_mode_names[SPORE_SPHERES_MODE_COUNT + 1]; /* NULL-terminated */

#define SPORE_SPHERES_NEAR 0.02     /* of the diagonal */
#define SPORE_SPHERES_MAXIMUM 5000u /* of one set */

/* Limits of a region's factor (SporeGenerateRegion.value): the density of spheres there over the density elsewhere.
 * Where regions overlap, the largest factor holds. */
#define SPORE_SPHERES_FACTOR_LEAST 0.0625
#define SPORE_SPHERES_FACTOR_MOST 16.0

/* Targets for a set, in the terms of the report. 0: not asked for. */
typedef struct SporeSpheresTargets {
  double coverage;    /* at least, in (0, 1) */
  double outside;     /* at most, > 0; not for a sheet */
  double distance;    /* the mean at most, in (0, 1] */
  double depth_error; /* spore_spheres_felt_error at most, in (0, 1]; not for a sheet */
} SporeSpheresTargets;

typedef struct SporeSpheresOptions {
  SporeSpheresMode mode;
  size_t count;                /* number of spheres; 0: the targets decide */
  SporeSpheresTargets targets; /* used when count is 0; the set reaches all that are asked for */
  uint64_t seed;
  const SporeGenerateRegion *regions; /* region_count; for solids only */
  size_t region_count;
  bool each_cell;   /* of tetrahedra: one round each, whatever the number */
  bool asymmetric;  /* do not search the solid for mirror planes */
  double thickness; /* m, for a sheet: diameter of all spheres; 0: each sphere is as large as needed to leave no gap */
} SporeSpheresOptions;

/* Measured on samples that the fit did not use. Distances are fractions of the bounding box diagonal. */
typedef struct SporeSpheresReport {
  double coverage;                    /* volume of the solid that is inside the spheres / volume */
  double outside;                     /* volume of the union that is outside the solid / volume of the solid */
  double distance_mean, distance_max; /* two-sided, surface of the solid to surface of the union */
  double depth_error;                 /* mean |depth - max_i(r_i - d_i)+| inside / largest depth */
  /* For a set with weights, else 0: mean |depth - (sum_i w_i (r_i - d_i)+ - level)+| inside / largest depth; and the
   * share of points up to SPORE_SPHERES_NEAR outside where the sum is above 0. */
  double weighted_depth_error, felt_outside;
  bool certified; /* the mesh is closed, and all of it is proven, not sampled, to be inside the spheres */
  double seconds;
  size_t mirrors; /* mirror planes that the solid and the set have in common: 0 to 3 */
} SporeSpheresReport;
/* The depth error that counts: of the weighted sum if the set has weights, else of the deepest sphere. */
static inline double spore_spheres_felt_error(const SporeSpheresReport *report) {
  return report->weighted_depth_error > 0 ? report->weighted_depth_error : report->depth_error;
}

/* The target with the largest ratio of error to allowed error: "coverage", "outside", "distance" or "depth_error".
 * NULL: there is no target. *excess (may be NULL): that ratio; at most 1 where all targets are reached. */
const char *spore_spheres_hardest_target(const SporeSpheresTargets *targets, const SporeSpheresReport *report,
                                         double *excess);

/* What spheres are made from. The first member that is not NULL is used. */
typedef struct SporeSpheresSource {
  /* Valid. The mesh need not be watertight, but must enclose volume. Inside is where the winding number is > 0.5; a
   * mesh that is inside out is turned. If the mesh has up to three mirror planes at right angles, the set has as many
   * of these planes as the number of spheres allows: an odd number needs spheres on the planes. */
  const SporeTriangleMesh *solid;
  /* The solid is what the boundary of the cells encloses. 64 spheres made from the boundary approximate the solid
   * better than one sphere around each of 500 cells. This holds at rest and when cells and centres are bent, twisted
   * and pressed (`./dev bench authoring` shows the figures at rest). */
  const SporeTetrahedralMesh *tetrahedra;
  /* All points within the curve's radius of the curve, with round ends. Spheres lie along the curve, in order from the
   * first end to the last. Spheres are closer where the curve is thin or bends. */
  const SporeCurve *curve;
  /* A surface without volume, open or closed. Spheres lie on the surface, closer where the surface bends. In the
   * report, coverage is the share of the area that lies in spheres. Distance is the distance from points of the surface
   * to the nearest sphere if `thickness` is given, else the radius of the sphere there. Outside and depth error are
   * NaN. */
  const SporeTriangleMesh *sheet;
} SporeSpheresSource;

/* The same input and options give the same spheres, on any number of threads. With a count: exactly that many. With
 * targets: the fewest found, to about 4 %. *set is empty on failure. */
bool spore_spheres_from_source(const SporeSpheresSource *source, const SporeSpheresOptions *options,
                               SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                               SporeError *error);
bool spore_spheres_from_mesh(const SporeTriangleMesh *mesh, const SporeSpheresOptions *options, SporeSphereSet *set,
                             SporeSpheresReport *report, const SporeProgress *progress, SporeError *error);
bool spore_spheres_from_tetrahedra(const SporeTetrahedralMesh *mesh, const SporeSpheresOptions *options,
                                   SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                                   SporeError *error);
/* One sphere round each cell, the least that holds its corners, measured against the solid; NULL: what the boundary of
 * the cells encloses. At most SPORE_SPHERES_MAXIMUM cells. *set is empty on failure. */
bool spore_spheres_of_cells(const SporeTetrahedralMesh *cells, const SporeTriangleMesh *solid, SporeSphereSet *set,
                            SporeSpheresReport *report, SporeError *error);
/* Measures any set against a solid. */
bool spore_spheres_measure(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresReport *report,
                           SporeError *error);

/* The error of each sphere and of each part of the surface, for colours and histograms. */
typedef struct SporeSpheresQuality {
  size_t sphere_count, vertex_count;
  double *outside;     /* sphere_count: share of the sphere's volume outside the solid, 0..1, from points inside it */
  double *depth_error; /* sphere_count: |radius, or the weighted sum at the centre - depth of the centre|, m */
  double *distance; /* vertex_count: from the vertex to the union of spheres, m. Below 0: the vertex is inside, by its
                       largest depth in one sphere. Single precision. */
  double *area;     /* vertex_count: share of the surface, a third of each triangle at the vertex; the sum is 1 */
} SporeSpheresQuality;

/* mesh as in spore_spheres_from_mesh. *quality is empty on failure. */
bool spore_spheres_quality(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresQuality *quality,
                           const SporeProgress *progress, SporeError *error);
void spore_spheres_quality_clear(SporeSpheresQuality *quality);

/* Error against the number of spheres: from where more spheres bring little. */

#define SPORE_SPHERES_WORTH 0.01 /* default for `worth`: least gain of a doubling, in largest depths */

/* Called with each point as soon as it is measured, on the working thread. report: valid during the call. */
typedef void SporeSpheresMeasured(void *data, size_t point, const SporeSpheresReport *report);

/* Generates and measures a set for each of the counts (1 to SPORE_SPHERES_MAXIMUM, ascending). All other options hold
 * for each set. reports: `count` of them, out. measured: may be NULL. */
bool spore_spheres_series(const SporeSpheresSource *source, const SporeSpheresOptions *options, const size_t *counts,
                          size_t count, SporeSpheresReport *reports, SporeSpheresMeasured *measured, void *data,
                          const SporeProgress *progress, SporeError *error);

/* Index of the first point after which each doubling of the number lowers the error by less than `worth`, up to the
 * last point; `count` if there is none. Between points the error is taken as linear in the logarithm of the number. */
size_t spore_enough(const size_t *counts, const double *errors, size_t count, double worth);

#endif
