/* Sphere sets that approximate a solid's depth field (Meseure et al. 2003, section 4). */
#ifndef SPORE_GENERATE_SPHERES_H
#define SPORE_GENERATE_SPHERES_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* What a set is to be good at; the names below are those of files and of the command line. */
typedef enum SporeSpheresMode {
  SPORE_SPHERES_BALANCED, /* fits max(r_i - |x - c_i|) to the depth, inside and just outside */
  SPORE_SPHERES_MODE_COUNT
} SporeSpheresMode;
extern const char *const spore_spheres_mode_names[SPORE_SPHERES_MODE_COUNT + 1]; /* NULL-terminated */

#define SPORE_SPHERES_MAXIMUM 5000u /* of one set */

typedef struct SporeSpheresOptions {
  SporeSpheresMode mode;
  size_t count;     /* wanted; > 0, or 0 to go by tolerance */
  double tolerance; /* largest mean two-sided distance, as a fraction of the diagonal, when count is 0 */
  uint64_t seed;
} SporeSpheresOptions;

/* Measured on samples other than those of the fit. Distances in fractions of the bounding box diagonal. */
typedef struct SporeSpheresReport {
  double coverage;                    /* volume of the solid that is inside the spheres / volume */
  double outside;                     /* volume of the union that is outside the solid / volume of the solid */
  double distance_mean, distance_max; /* two-sided, surface of the solid to surface of the union */
  double depth_error;                 /* mean |depth - max_i(r_i - d_i)+| inside / largest depth */
  double seconds;
} SporeSpheresReport;

/* mesh: valid; need not be watertight (winding number > 0.5 is inside; one that is inside out is turned), but must
 * enclose volume. The same input and options give the same spheres, on any number of threads. By count: exactly that
 * many. By tolerance: the fewest found, to about 2 %. *set is empty on failure. */
bool spore_spheres_from_mesh(const SporeTriangleMesh *mesh, const SporeSpheresOptions *options, SporeSphereSet *set,
                             SporeSpheresReport *report, const SporeProgress *progress, SporeError *error);
bool spore_spheres_from_tetrahedra(const SporeTetrahedralMesh *mesh, const SporeSpheresOptions *options,
                                   SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                                   SporeError *error);
/* Measures any set against a solid. */
bool spore_spheres_measure(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresReport *report,
                           SporeError *error);

#endif
