#include <assert.h>
#include <string.h>

#include "models/particles/cluster_list.h"

/* Squared ways of all particles from where they were. */
typedef struct Ways {
  SporeVd most;
  SporeVl strange; /* not a number */
} Ways;

SPORE_INLINE void add_ways(Ways *ways, const double *x, const double *from) {
  for (int k = 0; k < SPORE_LANES; k += SPORE_WIDTH) {
    SporeVd square = {0};
    for (int axis = 0; axis < 3; axis++) {
      SporeVd way = spore_vd_load(x + axis * SPORE_LANES + k) - spore_vd_load(from + axis * SPORE_LANES + k);
      square += way * way;
    }
    ways->strange |= ~(square >= 0);
    ways->most = spore_vd_max(square, ways->most);
  }
}

SPORE_INLINE double greatest_way(const Ways *ways) {
  if (spore_vl_any(ways->strange)) return __builtin_nan("");
  double greatest = 0;
  for (int k = 0; k < SPORE_WIDTH; k++) greatest = ways->most[k] > greatest ? ways->most[k] : greatest;
  return greatest;
}

double SPORE_LEVEL_NAME(spore_cluster_move)(SporeClusterList *list, const double *q) {
  assert(list->made);
  Ways ways = {0};
  for (size_t c = 0; c < list->cluster_count; c++) {
    const uint32_t *particle = list->particle + c * SPORE_LANES;
    size_t at = c * SPORE_CLUSTER_DOUBLES;
    double *x = list->x + at;
    for (int k = 0; k < SPORE_LANES; k++) {
      if (particle[k] == SPORE_NO_PARTICLE) break;
      const double *from = q + 3 * (size_t)particle[k];
      x[k] = from[0], x[SPORE_LANES + k] = from[1], x[2 * SPORE_LANES + k] = from[2];
    }
    for (int k = 0; list->offset && k < SPORE_CLUSTER_DOUBLES; k += SPORE_WIDTH)
      spore_vd_store(x + k, spore_vd_load(x + k) + spore_vd_load(list->offset + at + k));
    add_ways(&ways, x, list->near_at + at);
  }
  return greatest_way(&ways);
}

double SPORE_LEVEL_NAME(spore_cluster_way)(const SporeClusterList *list) {
  assert(list->made);
  Ways ways = {0};
  for (size_t at = 0; at < list->cluster_count * SPORE_CLUSTER_DOUBLES; at += SPORE_CLUSTER_DOUBLES)
    add_ways(&ways, list->x + at, list->wide_at + at);
  return greatest_way(&ways);
}

/* How far [lower, upper] is from an interval, 0 where they meet. */
SPORE_INLINE SporeVd gap_to(double lower, double upper, SporeVd other_lower, SporeVd other_upper) {
  return spore_vd_max(spore_vd_max(other_lower - upper, lower - other_upper), spore_vd_all(0));
}

size_t SPORE_LEVEL_NAME(spore_cluster_search)(const SporeClusterList *list, size_t cluster, const double image[3],
                                              size_t from, size_t to, uint32_t *found) {
  assert(cluster < list->cluster_count);
  assert(from <= to && to <= list->cluster_count);
  size_t n = list->particle_count, count = 0;
  double far = list->wide.reach, lower[3], upper[3];
  for (size_t k = 0; k < 3; k++) {
    lower[k] = list->bounds[k * n + cluster] - image[k];
    upper[k] = list->bounds[(3 + k) * n + cluster] - image[k];
  }
  for (size_t c = from; c < to; c += SPORE_WIDTH) {
    SporeVd square = {0};
    for (size_t k = 0; k < 3; k++) {
      SporeVd gap = gap_to(lower[k], upper[k], spore_vd_load(list->bounds + k * n + c),
                           spore_vd_load(list->bounds + (3 + k) * n + c));
      square += gap * gap;
    }
    SporeVl near = square < spore_vd_all(far * far);
    if (!spore_vl_any(near)) continue;
    for (size_t i = 0; i < SPORE_WIDTH && c + i < to; i++)
      if (near[i]) found[count++] = (uint32_t)(c + i);
  }
  return count;
}

size_t SPORE_LEVEL_NAME(spore_cluster_refine)(const SporeClusterList *list, double far, size_t group,
                                              const double image[3], const uint32_t *clusters, size_t count,
                                              uint32_t *found) {
  assert(far > 0);
  assert(group < SPORE_CLUSTER_GROUPS * list->cluster_count);
  const double *xi = list->x + group / SPORE_CLUSTER_GROUPS * SPORE_CLUSTER_DOUBLES +
                     group % SPORE_CLUSTER_GROUPS * SPORE_CLUSTER_ROWS;
  SporeVd row[SPORE_CLUSTER_ROWS][3], far2 = spore_vd_all(far * far);
  for (int a = 0; a < SPORE_CLUSTER_ROWS; a++)
    for (int k = 0; k < 3; k++) row[a][k] = spore_vd_all(xi[k * SPORE_LANES + a] - image[k]);
  size_t kept = 0;
  for (size_t i = 0; i < count; i++) {
    const double *x = list->x + clusters[i] * SPORE_CLUSTER_DOUBLES;
    SporeVl near = {0};
    for (int k = 0; k < SPORE_LANES; k += SPORE_WIDTH) {
      SporeVd xj = spore_vd_load(x + k), yj = spore_vd_load(x + SPORE_LANES + k);
      SporeVd zj = spore_vd_load(x + 2 * SPORE_LANES + k);
      for (int a = 0; a < SPORE_CLUSTER_ROWS; a++) {
        SporeVd dx = xj - row[a][0], dy = yj - row[a][1], dz = zj - row[a][2];
        near |= dx * dx + dy * dy + dz * dz < far2;
      }
    }
    found[kept] = clusters[i];
    kept += spore_vl_any(near);
  }
  return kept;
}
