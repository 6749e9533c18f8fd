/* Tetrahedra in a surface, by CGAL in a helper process. */
#ifndef SPORE_GENERATE_TETRAHEDRA_H
#define SPORE_GENERATE_TETRAHEDRA_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/mesh/mesh.h"
#include "core/scene/error.h"

typedef struct SporeTetrahedraOptions {
  size_t cells; /* wanted, about; > 0, or 0 to go by size */
  double size;  /* edge length, m, when cells is 0 */
} SporeTetrahedraOptions;

typedef struct SporeTetrahedraReport {
  const char *method; /* "direct", "repaired" or "wrapped" */
  SporeTetrahedraQuality quality;
  double hausdorff;     /* sampled, both ways, against the given surface / diagonal */
  double volume_change; /* against the given surface, fraction; only meaningful when that was closed */
  double seconds;
} SporeTetrahedraReport;

/* Chain: direct when the surface is closed, oriented and free of self-intersections; else repaired; else wrapped. The
 * first that works is used and said. */
gboolean spore_tetrahedra_from_mesh(const char *place, const SporeTriangleMesh *mesh,
                                    const SporeTetrahedraOptions *options, SporeTetrahedralMesh *result,
                                    SporeTetrahedraReport *report, const SporeProgress *progress, GError **error);

#endif
