/* The inside of a tubular organ: which solid its surface stands for, with its lumen or without, and its voxels. */
#include "core/base/memory.h"
#include "core/generate/centreline/private.h"

#define COILED 0.9         /* share of a piece near its centreline, if it has no lumen; less for the wall of a lumen */
#define SKIN 0.1           /* of the volume of wall and lumen: a wall with less is not a tube by itself */
#define MOST_TRIED 300000. /* voxels of a solid that may turn out to be a wall */

static void forget_tube(SporeTubeOrgan *organ) {
  spore_voxel_path_clear(&organ->path);
  spore_voxel_tube_clear(&organ->tube);
  organ->left = (SporeCentrelineReport){0};
}

/* Whether the solid without a lumen is already a tube: its hidden surface then lies between its coils and is not the
 * wall of a lumen. If so, its voxels and its path are kept. A very thin wall is not tested, because it would need too
 * many voxels. */
static bool is_tube(SporeTubeOrgan *organ, bool *tube, const SporeProgressPart *progress, SporeError *error) {
  *tube = false;
  if (spore_voxel_tube_expected(&organ->solid) > MOST_TRIED) return true;
  bool done = spore_voxel_tube_create(&organ->tube, &organ->solid, progress, error) &&
              spore_voxel_path_find(&organ->path, &organ->tube, NULL, &organ->left, progress, error);
  *tube = done && organ->path.followed >= COILED;
  if (!*tube) forget_tube(organ);
  return done;
}

static bool runs_inside(const SporeSolid *solid, const SporeCurve *curve) {
  SporeCentrelineReport report = {0};
  spore_centreline_figures(solid, curve, &report);
  return report.outside < 0.5;
}

static bool replace_solid(SporeSolid *solid, const SporeTriangleMesh *mesh, SporeError *error) {
  if (!mesh->triangle_count) return true;
  spore_solid_clear(solid);
  return spore_solid_create(solid, mesh, error);
}

static void take_lumen(SporeSolid *solid, SporeSolid *filled) {
  if (!filled->mesh.triangle_count) return;
  spore_solid_clear(solid);
  *solid = *filled;
  *filled = (SporeSolid){0};
}

bool spore_tube_solid_along(SporeSolid *solid, const SporeTriangleMesh *mesh, const SporeCurve *curve,
                            double *inner_wall, SporeError *error) {
  SporeOuterWall wall;
  SporeSolid filled = {0};
  SporeProgressPart none = {NULL, 0, 1};
  if (!spore_solid_create(solid, mesh, error)) return false;
  bool done =
      spore_outer_wall(&solid->mesh, solid->bvh, &wall, &none, error) && replace_solid(solid, &wall.solid, error);
  bool lumen = done && wall.hidden > 0 && !runs_inside(solid, curve);
  if (lumen) done = replace_solid(&filled, &wall.filled, error);
  if (lumen && done) take_lumen(solid, &filled);
  *inner_wall = lumen ? wall.hidden : 0;
  spore_solid_clear(&filled);
  spore_outer_wall_clear(&wall);
  if (!done) spore_solid_clear(solid);
  return done;
}

/* Finds walls inside, and takes the solid without them. */
static bool take_outer_wall(SporeTubeOrgan *organ, const SporeProgressPart *looking, const SporeProgressPart *trying,
                            SporeError *error) {
  SporeOuterWall wall;
  SporeSolid filled = {0};
  bool tube = true;
  bool done = spore_outer_wall(&organ->solid.mesh, organ->solid.bvh, &wall, looking, error) &&
              replace_solid(&organ->solid, &wall.solid, error);
  if (done && wall.hidden > 0) {
    done = replace_solid(&filled, &wall.filled, error);
    tube = false;
    if (done && organ->solid.volume >= SKIN * filled.volume) done = is_tube(organ, &tube, trying, error);
    if (done && !tube) take_lumen(&organ->solid, &filled);
  }
  organ->inner_wall = tube ? 0 : wall.hidden;
  spore_solid_clear(&filled);
  spore_outer_wall_clear(&wall);
  return done;
}

bool spore_tube_organ_create(SporeTubeOrgan *organ, const SporeTriangleMesh *mesh, const SporeProgress *progress,
                             SporeError *error) {
  SporeProgressPart first = {progress, 0, 0.2}, looking = {progress, 0.2, 0.1}, second = {progress, 0.3, 0.1};
  SporeProgressPart filling = {progress, 0.4, 0.1};
  SporeMeshReport report;
  bool tube = false;
  *organ = (SporeTubeOrgan){0};
  if (!spore_solid_create(&organ->solid, mesh, error)) return false;
  bool done = spore_triangle_mesh_report(&organ->solid.mesh, &report, error);
  if (done && report.closed && report.components == 1) done = is_tube(organ, &tube, &first, error);
  if (done && !tube) done = take_outer_wall(organ, &looking, &second, error);
  if (done && !organ->tube.count) done = spore_voxel_tube_create(&organ->tube, &organ->solid, &filling, error);
  if (!done) spore_tube_organ_clear(organ);
  return done;
}

void spore_tube_organ_clear(SporeTubeOrgan *organ) {
  forget_tube(organ);
  spore_solid_clear(&organ->solid);
}
