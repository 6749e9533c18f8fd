/* The surface that a net or a spline is made of, from any surface. */
#ifndef SPORE_GENERATE_SURFACE_H
#define SPORE_GENERATE_SURFACE_H

#include "core/mesh/simplify.h"

typedef struct SporeSurfaceReport {
  SporeSimplifyReport simplify;
  size_t pieces, open_edges;            /* of the result */
  double hausdorff;                     /* sampled, both ways, against the given surface / diagonal */
  double outline;                       /* largest distance between its open edges and the given one's, both ways /
                                           diagonal; 0 where it is closed */
  double min_angle_deg, mean_angle_deg; /* least of all; mean of each triangle's least */
  double edge_min, edge_mean, edge_max; /* m */
  double area_change, volume_change;    /* share that was gained; the volume only where the surface is closed */
  double seconds;
} SporeSurfaceReport;

/* Valid mesh. Fewer vertices than wanted: all are kept, and only moved where that widens angles. *result is empty on
 * failure. False: no memory, or cancelled. */
bool spore_surface_from_mesh(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                             SporeTriangleMesh *result, SporeSurfaceReport *report, const SporeProgress *progress,
                             SporeError *error);

#endif
