#include <assert.h>

#include "models/particles/lennard_jones_law.h"

#define PARTS (SPORE_LANES / SPORE_WIDTH)
#define ROWS SPORE_CLUSTER_ROWS

/* A row group, its particles one by one, moved by an image, and the lanes of what acts on them. */
typedef struct Rows {
  SporeVd x[ROWS], y[ROWS], z[ROWS];
  SporeVd fx[ROWS], fy[ROWS], fz[ROWS];
  SporeVd least; /* squared distance */
} Rows;

typedef enum Variant { PLAIN, CAPPED } Variant;

SPORE_INLINE void load_rows(Rows *rows, const double *x, const double image[3]) {
#pragma GCC unroll 4
  for (int a = 0; a < ROWS; a++) {
    rows->x[a] = spore_vd_all(x[a] - image[0]);
    rows->y[a] = spore_vd_all(x[SPORE_LANES + a] - image[1]);
    rows->z[a] = spore_vd_all(x[2 * SPORE_LANES + a] - image[2]);
  }
}

/* Lanes whose particle has a greater number than a row of the same cluster: each pair inside a cluster once. */
static const int64_t behind[SPORE_LANES][SPORE_LANES] = {
    {0, -1, -1, -1, -1, -1, -1, -1}, {0, 0, -1, -1, -1, -1, -1, -1}, {0, 0, 0, -1, -1, -1, -1, -1},
    {0, 0, 0, 0, -1, -1, -1, -1},    {0, 0, 0, 0, 0, -1, -1, -1},    {0, 0, 0, 0, 0, 0, -1, -1},
    {0, 0, 0, 0, 0, 0, 0, -1},       {0, 0, 0, 0, 0, 0, 0, 0}};

/* Squared distances of a row to the cluster that it belongs to: beyond the cut-off where a pair is not to be seen. */
SPORE_INLINE SporeVd see_once(const SporeLennardJonesLaw *law, SporeVd square, int row, int part) {
  assert(row >= 0 && row < SPORE_LANES && part < PARTS);
  SporeVl seen = (SporeVl)spore_vd_load((const double *)(const void *)(behind[row] + part * SPORE_WIDTH));
  return spore_vd_select(seen, square, spore_vd_all(4 * law->cutoff2));
}

SPORE_INLINE SporeVd both(SporeVl mask, SporeVd a) { return (SporeVd)(mask & (SporeVl)a); }

SPORE_INLINE void meet(Rows *rows, const SporeLennardJonesLaw *law, const double *x, double *f, Variant variant,
                       int own_row, int part) {
  const SporeVd one = spore_vd_all(1), cutoff2 = spore_vd_all(law->cutoff2), core2 = spore_vd_all(law->core2);
  const SporeVd f12 = spore_vd_all(law->f12), f6 = spore_vd_all(law->f6), shift = spore_vd_all(law->shift);
  SporeVd xj = spore_vd_load(x), yj = spore_vd_load(x + SPORE_LANES), zj = spore_vd_load(x + 2 * SPORE_LANES);
  SporeVd fx = spore_vd_load(f), fy = spore_vd_load(f + SPORE_LANES), fz = spore_vd_load(f + 2 * SPORE_LANES);
  SporeVd dx[ROWS], dy[ROWS], dz[ROWS], square[ROWS], inverse[ROWS];
  SporeVl near[ROWS];
#pragma GCC unroll 4
  for (int a = 0; a < ROWS; a++) {
    dx[a] = xj - rows->x[a], dy[a] = yj - rows->y[a], dz[a] = zj - rows->z[a];
    square[a] = dx[a] * dx[a] + dy[a] * dy[a] + dz[a] * dz[a];
    if (own_row >= 0) square[a] = see_once(law, square[a], own_row + a, part);
    near[a] = square[a] < cutoff2;
    if (variant == PLAIN) rows->least = spore_vd_min(square[a], rows->least);
    else square[a] = spore_vd_max(square[a], core2);
  }
#pragma GCC unroll 2
  for (int a = 0; a < ROWS; a += 2) {
    SporeVd product = one / (square[a] * square[a + 1]);
    inverse[a] = product * square[a + 1], inverse[a + 1] = product * square[a];
  }
#pragma GCC unroll 4
  for (int a = 0; a < ROWS; a++) {
    SporeVd s = inverse[a], s3 = s * s * s;
    SporeVd g = both(near[a], s * (s3 * (f12 * s3 - f6)) - shift);
    SporeVd gx = g * dx[a], gy = g * dy[a], gz = g * dz[a];
    rows->fx[a] -= gx, rows->fy[a] -= gy, rows->fz[a] -= gz;
    fx += gx, fy += gy, fz += gz;
  }
  spore_vd_store(f, fx);
  spore_vd_store(f + SPORE_LANES, fy);
  spore_vd_store(f + 2 * SPORE_LANES, fz);
}

/* One part of the lanes of all that the row group meets. */
SPORE_INLINE void meet_all(const SporeClusterList *list, const SporeLennardJonesLaw *law, size_t group, int part,
                           Variant variant, Rows *rows) {
  assert(group < list->cluster_count * SPORE_CLUSTER_GROUPS);
  const double *x = list->x + part * SPORE_WIDTH;
  double *f = list->f + part * SPORE_WIDTH;
  size_t cluster = group / SPORE_CLUSTER_GROUPS;
  int first = (int)(group % SPORE_CLUSTER_GROUPS) * ROWS;
  for (uint32_t r = list->near.group_runs[group]; r < list->near.group_runs[group + 1]; r++) {
    const SporeClusterRun *run = &list->near.runs[r];
    load_rows(rows, list->x + cluster * SPORE_CLUSTER_DOUBLES + first, run->image);
    uint32_t e = run->start;
    if (run->own) {
      size_t at = cluster * SPORE_CLUSTER_DOUBLES;
      meet(rows, law, x + at, f + at, variant, first, part);
      e++;
    }
    for (; e < run->end; e++) {
      size_t at = (size_t)list->near.entries[e] * SPORE_CLUSTER_DOUBLES;
      meet(rows, law, x + at, f + at, variant, -1, part);
    }
  }
}

SPORE_INLINE void add_lanes(const SporeClusterList *list, size_t group, const double lanes[3 * ROWS][SPORE_LANES]) {
  double *f = list->f + group / SPORE_CLUSTER_GROUPS * SPORE_CLUSTER_DOUBLES + group % SPORE_CLUSTER_GROUPS * ROWS;
  for (int k = 0; k < 3; k++)
    for (int a = 0; a < ROWS; a++) f[k * SPORE_LANES + a] += spore_lanes_sum(lanes[k * ROWS + a]);
}

/* Returns the least squared distance of a pair. */
SPORE_INLINE double all_groups(const SporeClusterList *list, const SporeLennardJonesLaw *law, Variant variant) {
  double lanes[3 * ROWS][SPORE_LANES], least = law->cutoff2;
  __builtin_memset(list->f, 0, list->cluster_count * SPORE_CLUSTER_DOUBLES * sizeof *list->f);
  for (size_t group = 0; group < list->cluster_count * SPORE_CLUSTER_GROUPS; group++) {
    if (list->near.group_runs[group] == list->near.group_runs[group + 1]) continue;
    for (int part = 0; part < PARTS; part++) {
      Rows rows = {.least = spore_vd_all(law->cutoff2)};
      meet_all(list, law, group, part, variant, &rows);
      for (int a = 0; a < ROWS; a++) {
        spore_vd_store(&lanes[a][part * SPORE_WIDTH], rows.fx[a]);
        spore_vd_store(&lanes[ROWS + a][part * SPORE_WIDTH], rows.fy[a]);
        spore_vd_store(&lanes[2 * ROWS + a][part * SPORE_WIDTH], rows.fz[a]);
      }
      for (int k = 0; k < SPORE_WIDTH; k++) least = rows.least[k] < least ? rows.least[k] : least;
    }
    add_lanes(list, group, (const double(*)[SPORE_LANES])lanes);
  }
  return least;
}

/* Few pairs are ever capped: what that takes is done only where it turns out to be needed. */
bool SPORE_LEVEL_NAME(spore_lennard_jones_force)(const SporeClusterList *list, const SporeLennardJonesLaw *law) {
  assert(list->made);
  assert(law->core2 < law->cutoff2);
  if (all_groups(list, law, PLAIN) >= law->core2) return false;
  all_groups(list, law, CAPPED);
  return true;
}

SPORE_INLINE SporeVd energy_of(const SporeLennardJonesLaw *law, SporeVd square) {
  SporeVl near = square < spore_vd_all(law->cutoff2);
  SporeVd core2 = spore_vd_all(law->core2), outside = spore_vd_max(square, core2);
  SporeVd s = spore_vd_all(1) / outside, s3 = s * s * s;
  SporeVd pair = (spore_vd_all(law->e12) * s3 - spore_vd_all(law->e6)) * s3 + spore_vd_all(0.5 * law->shift) * outside -
                 spore_vd_all(law->level);
  SporeVd inside = spore_vd_all(0.5 * law->core_stiffness) * (outside - square);
  return both(near, pair + inside);
}

double SPORE_LEVEL_NAME(spore_lennard_jones_energy)(const SporeClusterList *list, const SporeLennardJonesLaw *law) {
  assert(list->made);
  double lanes[SPORE_LANES];
  for (int part = 0; part < PARTS; part++) {
    SporeVd sum = {0};
    for (size_t group = 0; group < list->cluster_count * SPORE_CLUSTER_GROUPS; group++) {
      size_t cluster = group / SPORE_CLUSTER_GROUPS;
      int first = (int)(group % SPORE_CLUSTER_GROUPS) * ROWS;
      for (uint32_t r = list->near.group_runs[group]; r < list->near.group_runs[group + 1]; r++) {
        const SporeClusterRun *run = &list->near.runs[r];
        Rows rows;
        load_rows(&rows, list->x + cluster * SPORE_CLUSTER_DOUBLES + first, run->image);
        for (uint32_t e = run->start; e < run->end; e++) {
          const double *x = list->x + (size_t)list->near.entries[e] * SPORE_CLUSTER_DOUBLES + part * SPORE_WIDTH;
          bool own = run->own && e == run->start;
          for (int a = 0; a < ROWS; a++) {
            SporeVd dx = rows.x[a] - spore_vd_load(x), dy = rows.y[a] - spore_vd_load(x + SPORE_LANES);
            SporeVd dz = rows.z[a] - spore_vd_load(x + 2 * SPORE_LANES);
            SporeVd square = dx * dx + dy * dy + dz * dz;
            if (own) square = see_once(law, square, first + a, part);
            sum += energy_of(law, square);
          }
        }
      }
    }
    spore_vd_store(lanes + part * SPORE_WIDTH, sum);
  }
  return spore_lanes_sum(lanes);
}
