/* Moves vertices of the skin to where their faces are nearest to their points, on either side: Gauss-Newton steps on
 * the sum of squares and, for large distances, of fourth and sixth powers. */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/generate/common/skin.h"
#include "core/generate/common/stars.h"
#include "core/mesh/common.h"

#define HALVINGS 2
#define RELAX 1.5        /* times the least quality: goal for smoothing the vertices inside */
#define LEAST_SHARE 1e-3 /* least sum of squared weights: a vertex that hardly moves its points stays */
#define OF_A_FACE 2.0    /* weight in points of the middle of a face, of its sides together, and of the vertex */

typedef struct {
  const SporeStars *stars;
  const SporeSkin *skin;
  const SporeSkinPoints *points;
  const SporeBvh *surface;
  double usual; /* squared; larger distances count more */
} Approach;

typedef struct {
  SporeVec3 step; /* sum of weight x share x gap */
  double squares, cost;
} Sum;

/* The barycentric coordinate of corner k at a point of a triangle. */
static double share_of(const double *corners, int k, SporeVec3 p) {
  SporeVec3 a = spore_vec3_load(corners + 3 * k), b = spore_vec3_load(corners + 3 * ((k + 1) % 3)),
            c = spore_vec3_load(corners + 3 * ((k + 2) % 3));
  double whole = spore_vec3_length(spore_mesh_area_vector(a, b, c));
  return whole > 0 ? fmin(spore_vec3_length(spore_mesh_area_vector(p, b, c)) / whole, 1) : 0;
}

static void add_gap(const Approach *approach, Sum *sum, SporeVec3 gap, double share, double count) {
  double squared = spore_vec3_dot(gap, gap), far = squared / approach->usual, weight = count * (1 + far + far * far);
  sum->step = spore_vec3_add_scaled(sum->step, weight * share, gap);
  sum->squares += weight * share * share;
  sum->cost += count * squared * (1 + far / 2 + far * far / 3);
}

/* Adds the gap from a place of the mesh to the surface. */
static void add_place(const Approach *approach, Sum *sum, SporeVec3 p, double share, double count) {
  SporeVec3 near;
  spore_bvh_distance(approach->surface, p, &near, NULL);
  add_gap(approach, sum, spore_vec3_sub(near, p), share, count);
}

/* The step and the cost with v at p. */
static Sum measure(const Approach *approach, uint32_t v, SporeVec3 p) {
  const SporeSkin *skin = approach->skin;
  Sum sum = {0};
  for (size_t i = skin->first[v]; i < skin->first[v + 1]; i++) {
    const uint32_t *corner = skin->corners + 3 * (size_t)skin->faces[i];
    double corners[9];
    int moving = 0;
    SporeVec3 middle = {0, 0, 0}, near;
    for (int k = 0; k < 3; k++) {
      SporeVec3 place = corner[k] == v ? p : spore_mesh_vertex(approach->stars->mesh->vertices, corner[k]);
      if (corner[k] == v) moving = k;
      spore_vec3_store(corners + 3 * k, place);
      middle = spore_vec3_add_scaled(middle, 1.0 / 3, place);
    }
    for (size_t j = skin->first_point[skin->faces[i]]; j < skin->first_point[skin->faces[i] + 1]; j++) {
      SporeVec3 at = spore_vec3_load(approach->points->places + 3 * (size_t)skin->points[j]);
      near = spore_triangle_nearest(at, corners);
      add_gap(approach, &sum, spore_vec3_sub(at, near), share_of(corners, moving, near), 1);
    }
    if (!approach->surface) continue;
    add_place(approach, &sum, middle, 1.0 / 3, OF_A_FACE);
    for (int k = 0; k < 3; k++) {
      if (k == moving) continue;
      SporeVec3 half = spore_vec3_scale(0.5, spore_vec3_add(p, spore_vec3_load(corners + 3 * k)));
      add_place(approach, &sum, half, 0.5, 0.5 * OF_A_FACE); /* each side belongs to two faces */
    }
  }
  if (approach->surface) {
    SporeVec3 near;
    spore_bvh_distance(approach->surface, p, &near, NULL);
    add_gap(approach, &sum, spore_vec3_sub(near, p), 1, OF_A_FACE);
  }
  return sum;
}

static bool move(const Approach *approach, SporeStars *stars, uint32_t v, double least) {
  SporeVec3 here = spore_mesh_vertex(stars->mesh->vertices, v);
  Sum now = measure(approach, v, here);
  if (!(now.squares > LEAST_SHARE)) return false;
  const double floor = fmin(least, spore_stars_quality_at(stars, v, here, -2));
  double share = 1 / now.squares;
  for (int k = 0; k <= HALVINGS; k++, share *= 0.5) {
    SporeVec3 place = spore_vec3_add_scaled(here, share, now.step);
    if (spore_stars_quality_at(stars, v, place, floor) < floor || !(measure(approach, v, place).cost < now.cost))
      continue;
    spore_stars_move(stars, v, place);
    return true;
  }
  return false;
}

bool spore_tetrahedra_approach(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points, int rounds,
                               double usual, double least, SporeError *error) {
  SporeStars stars = {0};
  bool done = spore_stars_create(&stars, mesh, mesh->labels, error);
  for (int round = 0; done && round < rounds; round++) {
    SporeSkin skin;
    if (!(done = spore_skin_create(&skin, mesh, points, error))) break;
    Approach approach = {&stars, &skin, points, surface, usual * usual};
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
      if (skin.first[v + 1] > skin.first[v]) move(&approach, &stars, v, least);
    }
    spore_skin_clear(&skin);
    spore_stars_smooth(&stars, NULL, RELAX * least);
  }
  spore_stars_clear(&stars);
  return done;
}
