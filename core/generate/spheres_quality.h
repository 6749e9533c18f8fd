/* How well each sphere fits and each part of a surface is met: for colours and histograms. */
#ifndef SPORE_GENERATE_SPHERES_QUALITY_H
#define SPORE_GENERATE_SPHERES_QUALITY_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

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

#endif
