#include "models/particles/cluster_columns.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Side of a column over the reach: clusters of a liquid are then about as high as wide. */
#define COLUMN_SIDE 0.85
#define FAR_OFF 1e30
#define RUNS_SORTED 16 /* records that are put in order by insertion before they are merged */
#define MIDDLE (1 << 30)

static inline bool is_before(const SporeClusterRecord *a, const SporeClusterRecord *b) {
  if (a->column != b->column) return a->column < b->column;
  if (a->z != b->z) return a->z < b->z;
  return a->particle < b->particle;
}

static void insert_sort(SporeClusterRecord *records, size_t count) {
  for (size_t i = 1; i < count; i++) {
    SporeClusterRecord moved = records[i];
    size_t at = i;
    for (; at > 0 && is_before(&moved, &records[at - 1]); at--) records[at] = records[at - 1];
    records[at] = moved;
  }
}

static void merge(const SporeClusterRecord *from, size_t start, size_t middle, size_t end, SporeClusterRecord *to) {
  assert(start <= middle && middle <= end && from != to);
  if (middle >= end || is_before(&from[middle - 1], &from[middle])) { /* in order already */
    memcpy(to + start, from + start, (end - start) * sizeof *to);
    return;
  }
  for (size_t a = start, b = middle, k = start; k < end; k++)
    to[k] = b >= end || (a < middle && is_before(&from[a], &from[b])) ? from[a++] : from[b++];
}

/* From the bottom up; the order of before is near, and what is in order is only copied. */
static void sort_records(SporeClusterList *list) {
  size_t n = list->particle_count;
  for (size_t i = 0; i < n; i += RUNS_SORTED) insert_sort(list->records + i, n - i < RUNS_SORTED ? n - i : RUNS_SORTED);
  for (size_t width = RUNS_SORTED; width < n; width *= 2) {
    for (size_t i = 0; i < n; i += 2 * width) {
      size_t middle = i + width < n ? i + width : n, end = i + 2 * width < n ? i + 2 * width : n;
      merge(list->records, i, middle, end, list->sorting);
    }
    SporeClusterRecord *sorted = list->sorting;
    list->sorting = list->records;
    list->records = sorted;
  }
}

SporeColumnGrid spore_column_grid(const SporeClusterList *list) {
  SporeColumnGrid columns;
  for (int k = 0; k < 2; k++) {
    double side = COLUMN_SIDE * list->reach;
    columns.count[k] = list->box[k] > 0 ? (int64_t)fmax(1, round(list->box[k] / side)) : 0;
    columns.side[k] = list->box[k] > 0 ? list->box[k] / (double)columns.count[k] : side;
    columns.per_side[k] = 1 / columns.side[k];
  }
  return columns;
}

/* floor, of what fits an integer; without a call on processors that have no instruction for it. */
static inline double whole_below(double x) {
  double whole = (double)(int64_t)x;
  return whole > x ? whole - 1 : whole;
}

int64_t spore_column_of(const SporeColumnGrid *columns, int axis, double x) {
  assert(axis == 0 || axis == 1);
  double number = x * columns->per_side[axis];
  double least = columns->count[axis] ? 0 : -MIDDLE;
  double most = columns->count[axis] ? (double)(columns->count[axis] - 1) : MIDDLE;
  return (int64_t)whole_below(number < least ? least : number > most ? most : number);
}

static uint64_t key_of(int64_t cx, int64_t cy) {
  return (uint64_t)(cx + 2 * (int64_t)MIDDLE) << 32 | (uint64_t)(cy + 2 * (int64_t)MIDDLE);
}

/* By how much a coordinate is moved to lie within the period. */
static double period_offset(const SporeClusterList *list, int axis, double x) {
  if (!(list->box[axis] > 0)) return 0;
  double periods = x / list->box[axis];
  return -list->box[axis] * (fabs(periods) < 1e15 ? whole_below(periods) : periods);
}

static bool set_records(SporeClusterList *list, const SporeColumnGrid *columns, const double *q) {
  for (size_t i = 0; i < list->particle_count; i++) {
    SporeClusterRecord *record = &list->records[i];
    double at[3];
    for (int k = 0; k < 3; k++) {
      double x = q[3 * (size_t)record->particle + (size_t)k];
      if (!(fabs(x) < 0.1 * FAR_OFF)) return false;
      at[k] = x + period_offset(list, k, x);
    }
    int64_t cx = spore_column_of(columns, 0, at[0]), cy = spore_column_of(columns, 1, at[1]);
    record->column = key_of(cx, cy);
    record->z = cy % 2 ? -at[2] : at[2]; /* up one column and down the next: what follows each other is near */
  }
  return true;
}

static void fill_lane(SporeClusterList *list, size_t cluster, size_t lane, const double *q, uint32_t particle) {
  assert(cluster < list->particle_count && lane < SPORE_LANES);
  list->particle[cluster * SPORE_LANES + lane] = particle;
  for (size_t k = 0; k < 3; k++) {
    size_t at = cluster * SPORE_CLUSTER_DOUBLES + k * SPORE_LANES + lane;
    bool there = particle != SPORE_NO_PARTICLE;
    /* Far from everything, and from each other: no pair of them is near. */
    double stranger = FAR_OFF * (double)(k == 0 ? lane + 1 : cluster + 1), x = there ? q[3 * (size_t)particle + k] : 0;
    double offset = there ? period_offset(list, (int)k, x) : 0;
    if (list->offset) list->offset[at] = offset;
    list->x[at] = there ? x + offset : stranger;
  }
}

static void bound_cluster(SporeClusterList *list, size_t cluster) {
  assert(cluster < list->cluster_count);
  size_t n = list->particle_count, lanes = 0;
  while (lanes < SPORE_LANES && list->particle[cluster * SPORE_LANES + lanes] != SPORE_NO_PARTICLE) lanes++;
  for (size_t k = 0; k < 3; k++) {
    const double *x = list->x + cluster * SPORE_CLUSTER_DOUBLES + k * SPORE_LANES;
    double lower = x[0], upper = x[0];
    for (size_t i = 1; i < lanes; i++) {
      lower = x[i] < lower ? x[i] : lower;
      upper = x[i] > upper ? x[i] : upper;
    }
    list->bounds[k * n + cluster] = lower, list->bounds[(3 + k) * n + cluster] = upper;
  }
}

static void close_cluster(SporeClusterList *list, size_t lane, const double *q) {
  assert(list->cluster_count > 0);
  size_t cluster = list->cluster_count - 1;
  for (; lane < SPORE_LANES; lane++) fill_lane(list, cluster, lane, q, SPORE_NO_PARTICLE);
  bound_cluster(list, cluster);
}

/* Clusters are filled from column to column as long as these lie side by side along y: only the last one of such a row
 * may have lanes without a particle. */
static void fill_clusters(SporeClusterList *list, const double *q) {
  size_t lane = SPORE_LANES; /* of the cluster being filled */
  list->cluster_count = list->column_count = 0;
  for (size_t i = 0; i < list->particle_count; i++) {
    const SporeClusterRecord *record = &list->records[i];
    bool next = i == 0 || record->column != record[-1].column;
    if (lane == SPORE_LANES || (next && record->column != record[-1].column + 1)) {
      if (i > 0) close_cluster(list, lane, q);
      list->cluster_count++;
      lane = 0;
    }
    uint32_t cluster = (uint32_t)list->cluster_count - 1;
    if (next) list->columns[list->column_count++] = (SporeClusterColumn){.key = record->column, .start = cluster};
    list->columns[list->column_count - 1].end = cluster + 1;
    fill_lane(list, cluster, lane++, q, record->particle);
  }
  if (list->particle_count > 0) close_cluster(list, lane, q);
}

bool spore_cluster_fill(SporeClusterList *list, const SporeColumnGrid *columns, const double *q) {
  assert(q || list->particle_count == 0);
  if (!set_records(list, columns, q)) return false;
  sort_records(list);
  fill_clusters(list, q);
  return true;
}

/* First column whose key is not below `key`. */
static size_t find_column(const SporeClusterList *list, uint64_t key) {
  size_t low = 0, high = list->column_count;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (list->columns[middle].key < key) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* Columns that follow each other along y hold clusters that follow each other. */
void spore_cluster_row(const SporeClusterList *list, int64_t cx, int64_t least, int64_t most, size_t *start,
                       size_t *end) {
  assert(least <= most);
  size_t from = find_column(list, key_of(cx, least)), to = find_column(list, key_of(cx, most + 1));
  *start = from < to ? list->columns[from].start : 0;
  *end = from < to ? list->columns[to - 1].end : 0;
}
