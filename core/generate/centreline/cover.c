/* How much of an organ's surface a path through its middle reaches, by area, and how far each place is from the path,
 * through the inside. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/private.h"

#define SAMPLES 16000
#define REPORT_EACH 64 /* samples */

bool spore_voxel_path_cover(const SporeVoxelPath *path, const SporeVoxelTube *tube, double *cover,
                            const SporeProgressPart *progress, SporeError *error) {
  double *points = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  uint32_t *triangles = SPORE_NEW_ARRAY(uint32_t, SAMPLES);
  bool room = points && triangles, going = true;
  size_t reached = 0, all = 0;
  if (room) spore_surface_samples(&tube->solid->mesh, SAMPLES, points, triangles);
  for (size_t i = 0; room && going && i < SAMPLES; i++) {
    if (i % REPORT_EACH == 0)
      going = spore_progress_part(progress, (double)i / SAMPLES, _("measuring what the line reaches"), error);
    bool within;
    uint32_t voxel = spore_voxel_under(tube, spore_vec3_load(points + 3 * i), triangles[i], &within);
    all += !within;
    reached += !within && voxel != SPORE_NO_VOXEL && path->near[voxel];
  }
  *cover = all ? (double)reached / (double)all : 0;
  spore_free(points);
  spore_free(triangles);
  return going && (room || spore_generate_no_memory(error));
}

bool spore_voxel_path_ways(const SporeVoxelPath *path, const SporeVoxelTube *tube, const SporeTriangleMesh *mesh,
                           double *way, const SporeProgressPart *progress, SporeError *error) {
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    if (i % REPORT_EACH == 0 && !spore_progress_part(progress, (double)i / (double)mesh->vertex_count,
                                                     _("measuring what the line reaches"), error))
      return false;
    SporeVec3 p = spore_vec3_load(mesh->vertices + 3 * i);
    uint32_t voxel = spore_voxel_beside(tube, p);
    if (voxel == SPORE_NO_VOXEL) voxel = spore_voxel_nearest(tube, p); /* the organ is too thin there */
    way[i] = fmin((double)path->way[voxel], tube->solid->diagonal);
  }
  return true;
}
