/* Sphere sets that approximate a solid's depth field (Meseure et al. 2003, section 4). */
#ifndef SPORE_GENERATE_SPHERES_H
#define SPORE_GENERATE_SPHERES_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

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

/* More spheres, or fewer, in a ball: `factor` times as many in a volume as elsewhere. Where regions overlap, the
 * largest factor holds. */
typedef struct SporeSpheresRegion {
  double centre[3], radius; /* m, > 0 */
  double factor;            /* SPORE_SPHERES_FACTOR_LEAST to _MOST */
} SporeSpheresRegion;
#define SPORE_SPHERES_FACTOR_LEAST 0.0625
#define SPORE_SPHERES_FACTOR_MOST 16.0

/* What a set is asked to reach, in the terms of the report; 0: not asked for. */
typedef struct SporeSpheresAims {
  double coverage;    /* at least, in (0, 1) */
  double outside;     /* at most, > 0; not of a sheet, as the next but one */
  double distance;    /* the mean at most, in (0, 1] */
  double depth_error; /* what is felt, at most, in (0, 1] */
} SporeSpheresAims;

typedef struct SporeSpheresOptions {
  SporeSpheresMode mode;
  size_t count;          /* wanted; > 0, or 0 to go by the aims */
  SporeSpheresAims aims; /* all that are asked for hold, when count is 0 */
  uint64_t seed;
  const SporeSpheresRegion *regions; /* region_count; of solids alone */
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
const char *spore_spheres_hardest_aim(const SporeSpheresAims *aims, const SporeSpheresReport *report, double *excess);

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
 * aims: the fewest found, to about 4 %. *set is empty on failure. */
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

#endif
