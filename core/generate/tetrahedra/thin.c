/* Walls and slits of a solid that are thinner than the cells of a lattice contain no node of the lattice. Points of
 * such walls and slits are found by their distance from the cells. Around these points, the depth is changed so that
 * the lattice has solid, or a gap. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define MISSED 0.5       /* of the tolerance: points farther from the cells are missed */
#define NECK 1.2         /* of the tolerance: around a missed wall, walls within this are widened too, */
#define NECK_MISSED 0.05 /* if they are farther than this from the cells */
#define REACH 0.7        /* edges: any point has a node within 0.56; with the excess, neighbouring nodes connect */
#define MOST_REACH 0.6   /* of the tolerance */

double spore_tetrahedra_depth(const SporeTetrahedraWork *work, SporeVec3 p) {
  const SporeTetrahedraThin *thin = &work->thin;
  double depth = spore_bvh_depth(work->tree, p);
  if (thin->slit_tree) depth = fmin(depth, spore_bvh_distance(thin->slit_tree, p, NULL, NULL) - thin->reach);
  if (thin->wall_tree) depth = fmax(depth, thin->reach - spore_bvh_distance(thin->wall_tree, p, NULL, NULL));
  return depth;
}

/* Builds a tree of points, as triangles without area. */
static bool grow_tree(SporeBvh **tree, double *points, size_t count, SporeError *error) {
  SporeTriangleMesh mesh = {.vertex_count = count, .vertices = points, .triangle_count = count};
  spore_bvh_free(*tree);
  *tree = NULL;
  if (!count) return true;
  if (!(mesh.triangles = SPORE_NEW_ARRAY(uint32_t, 3 * count))) return spore_mesh_no_memory(error);
  for (size_t i = 0; i < 3 * count; i++) mesh.triangles[i] = (uint32_t)(i / 3);
  *tree = spore_bvh_create(&mesh, error);
  spore_free(mesh.triangles);
  return *tree != NULL;
}

/* Adds points of walls next to missed walls: without these points, missed walls would become islands. */
static void note_necks(SporeTetrahedraWork *work, const SporeBvh *cells) {
  SporeTetrahedraThin *thin = &work->thin;
  const size_t missed = thin->wall_count;
  for (size_t i = 0; missed && i < work->bounding_count; i++) {
    SporeVec3 p = spore_vec3_load(work->bounding + 3 * i);
    double gap = spore_bvh_distance(thin->wall_tree, p, NULL, NULL);
    if (!(gap > 0) || gap > NECK * work->options.tolerance) continue;
    double distance = spore_bvh_distance(cells, p, NULL, NULL);
    if (distance > NECK_MISSED * work->options.tolerance && !spore_bvh_inside(cells, p))
      spore_vec3_store(thin->walls + 3 * thin->wall_count++, p);
  }
}

/* Whether the point is already in the tree: each point counts once. */
static bool is_of(const SporeBvh *tree, SporeVec3 p) { return tree && !(spore_bvh_distance(tree, p, NULL, NULL) > 0); }

/* cells: NULL if there are none; then all points are missed. Returns the largest distance. */
static double note_missed(SporeTetrahedraWork *work, const SporeBvh *cells) {
  SporeTetrahedraThin *thin = &work->thin;
  double farthest = 0;
  for (size_t i = 0; i < work->bounding_count; i++) {
    SporeVec3 p = spore_vec3_load(work->bounding + 3 * i);
    double distance = cells ? spore_bvh_distance(cells, p, NULL, NULL) : 1;
    if (distance < MISSED * work->options.tolerance) continue;
    farthest = fmax(farthest, distance);
    bool slit = cells && spore_bvh_inside(cells, p);
    if (is_of(slit ? thin->slit_tree : thin->wall_tree, p)) continue;
    if (slit) spore_vec3_store(thin->slits + 3 * thin->slit_count++, p);
    else spore_vec3_store(thin->walls + 3 * thin->wall_count++, p);
  }
  return farthest;
}

bool spore_tetrahedra_find_thin(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double edge,
                                double *farthest, SporeError *error) {
  SporeTetrahedraThin *thin = &work->thin;
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  const size_t walls = 3 * (thin->wall_count + 2 * work->bounding_count),
               slits = 3 * (thin->slit_count + work->bounding_count);
  double *grown_walls = spore_reallocate(thin->walls, 3 * thin->wall_count, walls, sizeof *grown_walls);
  if (grown_walls) thin->walls = grown_walls;
  double *grown_slits = spore_reallocate(thin->slits, 3 * thin->slit_count, slits, sizeof *grown_slits);
  if (grown_slits) thin->slits = grown_slits;
  bool done = (grown_walls && grown_slits &&
               spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count)) ||
              spore_mesh_no_memory(error);
  SporeBvh *cells = done && mesh->tetrahedron_count ? spore_bvh_create(&boundary, error) : NULL;
  done = done && (cells || !mesh->tetrahedron_count);
  if (done) *farthest = note_missed(work, cells);
  thin->reach = fmin(REACH * edge, MOST_REACH * work->options.tolerance);
  done = done && grow_tree(&thin->wall_tree, thin->walls, thin->wall_count, error);
  if (cells && done) note_necks(work, cells);
  done = done && grow_tree(&thin->wall_tree, thin->walls, thin->wall_count, error) &&
         grow_tree(&thin->slit_tree, thin->slits, thin->slit_count, error);
  spore_bvh_free(cells);
  spore_free(boundary.triangles);
  return done;
}

void spore_tetrahedra_clear_thin(SporeTetrahedraThin *thin) {
  spore_free(thin->walls);
  spore_free(thin->slits);
  spore_bvh_free(thin->wall_tree);
  spore_bvh_free(thin->slit_tree);
  *thin = (SporeTetrahedraThin){0};
}
