/* Sphere sets that approximate a solid's depth field (Meseure et al. 2003, section 4). */
#ifndef SPORE_GENERATE_SPHERES_SPHERES_H
#define SPORE_GENERATE_SPHERES_SPHERES_H

#include "core/generate/common/common.h"

/* What a set is to be good at; the names below are those of files and of the command line. */
typedef enum SporeSpheresMode {
  SPORE_SPHERES_BALANCED, /* fits max(r_i - |x - c_i|) to the depth, inside and just outside */
  SPORE_SPHERES_BOUNDING, /* covers all of the solid, with little outside */
  SPORE_SPHERES_WEIGHTED, /* has weights, and fits sum w_i max(0, r_i - |x - c_i|) to the depth */
  SPORE_SPHERES_MODE_COUNT
} SporeSpheresMode;
extern const char *const spore_spheres_mode_names[SPORE_SPHERES_MODE_COUNT + 1]; /* NULL-terminated */

#define SPORE_SPHERES_NEAR 0.02     /* of the diagonal */
#define SPORE_SPHERES_MAXIMUM 5000u /* of one set */

/* How many times as many spheres lie in a volume of a region (SporeGenerateRegion.value) as elsewhere; where regions
 * overlap, the largest holds. */
#define SPORE_SPHERES_FACTOR_LEAST 0.0625
#define SPORE_SPHERES_FACTOR_MOST 16.0

/* What a set is asked to reach, in the terms of the report; 0: not asked for. */
typedef struct SporeSpheresTargets {
  double coverage;    /* at least, in (0, 1) */
  double outside;     /* at most, > 0; not of a sheet, as the next but one */
  double distance;    /* the mean at most, in (0, 1] */
  double depth_error; /* what is felt, at most, in (0, 1] */
} SporeSpheresTargets;

typedef struct SporeSpheresOptions {
  SporeSpheresMode mode;
  size_t count;                /* wanted; > 0, or 0 to go by the targets */
  SporeSpheresTargets targets; /* all that are asked for hold, when count is 0 */
  uint64_t seed;
  const SporeGenerateRegion *regions; /* region_count; of solids alone */
  size_t region_count;
  bool asymmetric;  /* do not look whether the solid is its own mirror image */
  double thickness; /* m, of a sheet: all spheres are as wide; 0: each as wide as it takes to leave no gap */
} SporeSpheresOptions;

/* Measured on samples other than those of the fit. Distances in fractions of the bounding box diagonal. */
typedef struct SporeSpheresReport {
  double coverage;                    /* volume of the solid that is inside the spheres / volume */
  double outside;                     /* volume of the union that is outside the solid / volume of the solid */
  double distance_mean, distance_max; /* two-sided, surface of the solid to surface of the union */
  double depth_error;                 /* mean |depth - max_i(r_i - d_i)+| inside / largest depth */
  /* Of a set with weights, 0 else: mean |depth - (sum_i w_i (r_i - d_i)+ - level)+| inside / largest depth, and the
   * share of points up to SPORE_SPHERES_NEAR outside at which that sum is not 0. */
  double weighted_depth_error, felt_outside;
  bool certified; /* the mesh is closed, and all of it is proven, not sampled, to be inside the spheres */
  double seconds;
  size_t mirrors; /* planes that the solid and the set are symmetric about: 0 to 3 */
} SporeSpheresReport;
/* Depth error of what is felt: of the weighted sum where the set has weights, of the deepest sphere else. */
static inline double spore_spheres_felt_error(const SporeSpheresReport *report) {
  return report->weighted_depth_error > 0 ? report->weighted_depth_error : report->depth_error;
}

/* Of what is asked for, the one that the set is farthest from reaching, or the nearest to missing: "coverage",
 * "outside", "distance" or "depth_error"; NULL: none is asked for. *excess (may be NULL): its error over what is
 * allowed, at most 1 where all are reached. */
const char *spore_spheres_hardest_target(const SporeSpheresTargets *targets, const SporeSpheresReport *report,
                                         double *excess);

/* What spheres are made from; the first that is not NULL counts. */
typedef struct SporeSpheresSource {
  /* Valid; need not be watertight (winding number > 0.5 is inside; one that is inside out is turned), but must enclose
   * volume. One that is its own image in up to three planes at right angles gives a set that is, too, in as many of
   * them as go with the number of spheres: an odd one needs spheres on the planes. */
  const SporeTriangleMesh *solid;
  /* Its cells fill the solid inside their boundary: the same as of that. 64 such spheres lie closer to it than one
   * round each of 500 cells does, at rest and when cells and centres are bent, twisted and pressed (`./dev bench
   * authoring` shows the figures at rest). */
  const SporeTetrahedralMesh *tetrahedra;
  /* All points within the curve's radius of it, with round ends. Spheres are strung along the curve, from its first end
   * to its last, closer where it is thin or bends. */
  const SporeCurve *curve;
  /* A surface of no volume, open or closed. Spheres lie on it, closer where it bends; in the report coverage is the
   * share of its area that lies in spheres, distance is that from its points to the nearest sphere where `thickness` is
   * given, and the radii where not; outside and depth error are not numbers. */
  const SporeTriangleMesh *sheet;
} SporeSpheresSource;

/* The same input and options give the same spheres, on any number of threads. By count: exactly that many. By
 * targets: the fewest found, to about 4 %. *set is empty on failure. */
bool spore_spheres_from_source(const SporeSpheresSource *source, const SporeSpheresOptions *options,
                               SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                               SporeError *error);
bool spore_spheres_from_mesh(const SporeTriangleMesh *mesh, const SporeSpheresOptions *options, SporeSphereSet *set,
                             SporeSpheresReport *report, const SporeProgress *progress, SporeError *error);
bool spore_spheres_from_tetrahedra(const SporeTetrahedralMesh *mesh, const SporeSpheresOptions *options,
                                   SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                                   SporeError *error);
/* Measures any set against a solid. */
bool spore_spheres_measure(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresReport *report,
                           SporeError *error);

/* How well each sphere fits and each part of the surface is met: for colours and histograms. */
typedef struct SporeSpheresQuality {
  size_t sphere_count, vertex_count;
  double *outside;     /* sphere_count: share of the sphere's volume outside the solid, 0..1, from points inside it */
  double *depth_error; /* sphere_count: |radius, or the weighted sum at the centre - depth of the centre|, m */
  double *distance;    /* vertex_count: from the mesh's vertex out to the union of spheres, m; below 0: inside it, the
                          shortest way straight out of one of them; to single precision */
  double *area;        /* vertex_count: share of the surface that is nearest to the vertex; together 1 */
} SporeSpheresQuality;

/* mesh as in spore_spheres_from_mesh. *quality is empty on failure. */
bool spore_spheres_quality(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresQuality *quality,
                           const SporeProgress *progress, SporeError *error);
void spore_spheres_quality_clear(SporeSpheresQuality *quality);

/* Error against the number of spheres: where more of them stop paying. */

#define SPORE_SPHERES_WORTH 0.01 /* usual least gain of a doubling, of the largest depth */

/* Called with each point as soon as it is measured, on the working thread. report: valid during the call. */
typedef void SporeSpheresMeasured(void *data, size_t point, const SporeSpheresReport *report);

/* Generates and measures a set for each of the counts (1 to SPORE_SPHERES_MAXIMUM, ascending), everything else as the
 * options say. reports: count of them, out. measured: may be NULL. */
bool spore_spheres_series(const SporeSpheresSource *source, const SporeSpheresOptions *options, const size_t *counts,
                          size_t count, SporeSpheresReport *reports, SporeSpheresMeasured *measured, void *data,
                          const SporeProgress *progress, SporeError *error);

/* Index of the first point from which on doubling the number lowers the error by less than `worth` everywhere measured;
 * count where it pays to the end. Between points the error is taken to fall evenly with the logarithm of the number. */
size_t spore_enough(const size_t *counts, const double *errors, size_t count, double worth);

#endif
