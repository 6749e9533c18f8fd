/* Improves the cells of a tetrahedral mesh in place, in rounds of smoothing and flipping. */
#include "core/generate/common/common.h"

#include <math.h>

#include "core/base/text.h"
#include "core/generate/common/stars.h"
#include "core/mesh/common.h"

#define ROUNDS 20
#define PATIENCE 3     /* rounds without a higher least angle */
#define FIRST_STEP 0.3 /* of an edge */
#define LAST_STEP 0.01
#define GAIN 1e-3 /* degrees */
#define WAYS 14

/* Unit directions to the faces and the corners of a cube. */
static SporeVec3 way(int i) {
  if (i < 6) {
    double d[3] = {0, 0, 0};
    d[i / 2] = i % 2 ? -1 : 1;
    return spore_vec3_load(d);
  }
  const double c = 1 / sqrt(3);
  return spore_vec3(i & 1 ? -c : c, i & 2 ? -c : c, (i - 6) & 4 ? -c : c);
}

/* The position of v after a step in direction i, projected onto the surface if v is on the boundary. False: there is
 * none. */
static bool candidate(const SporeStars *stars, const SporeBvh *surface, uint32_t v, SporeVec3 here, double step, int i,
                      SporeVec3 *place) {
  *place = spore_vec3_add_scaled(here, step, way(i));
  if (!stars->outer[v]) return true;
  spore_bvh_distance(surface, *place, place, NULL);
  return spore_vec3_distance(*place, here) < 1.5 * step;
}

/* Pattern search for the place where the worst cell around v is best. */
static bool settle(SporeStars *stars, const SporeBvh *surface, uint32_t v) {
  if (stars->outer[v] && !surface) return false;
  SporeVec3 here = spore_mesh_vertex(stars->mesh->vertices, v);
  const double edge = spore_stars_edge(stars, v), before = spore_stars_quality_at(stars, v, here, -2);
  double best = before, step = FIRST_STEP * edge;
  while (step > LAST_STEP * edge) {
    SporeVec3 place, found = here;
    double found_quality = best;
    for (int i = 0; i < WAYS; i++) {
      if (!candidate(stars, surface, v, here, step, i, &place)) continue;
      double quality = spore_stars_quality_at(stars, v, place, found_quality);
      if (quality > found_quality + GAIN) found_quality = quality, found = place;
    }
    if (found_quality > best) best = found_quality, here = found;
    else step *= 0.5;
  }
  if (!(best > before)) return false;
  spore_stars_move(stars, v, here);
  return true;
}

long spore_stars_smooth(SporeStars *stars, const SporeBvh *surface, double goal) {
  long moved = 0;
  for (size_t t = 0; t < stars->mesh->tetrahedron_count; t++)
    for (int k = 0; k < 4 && stars->quality[t] < goal; k++)
      moved += settle(stars, surface, stars->mesh->tetrahedra[4 * t + (size_t)k]);
  return moved;
}

static double worst_of(const SporeStars *stars) {
  double worst = 180;
  for (size_t t = 0; t < stars->mesh->tetrahedron_count; t++) worst = fmin(worst, stars->quality[t]);
  return worst;
}

bool spore_tetrahedra_improve(SporeTetrahedralMesh *mesh, uint32_t **labels, const SporeBvh *surface, double goal,
                              const SporeProgress *progress, SporeError *error) {
  double best = -2;
  int waited = 0;
  for (int round = 0; round < ROUNDS && waited < PATIENCE; round++) {
    SporeStars stars;
    if (!spore_progress_step(progress, (double)round / ROUNDS, _("bettering the cells"), error)) return false;
    if (!spore_stars_create(&stars, mesh, labels ? *labels : NULL, error)) return false;
    double worst = worst_of(&stars);
    waited = worst > best + GAIN ? 0 : waited + 1;
    best = fmax(best, worst);
    bool done = worst >= goal;
    long moved = done ? 0 : spore_stars_smooth(&stars, surface, goal),
         flipped = done ? 0 : spore_stars_flip(&stars, labels, goal, error);
    spore_stars_clear(&stars);
    if (flipped < 0) return false;
    if (!moved && !flipped) break;
  }
  return true;
}
