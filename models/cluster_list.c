#include "models/cluster_list.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"

/* Side of a column over the reach: clusters of a liquid are then about as high as wide. */
#define COLUMN_SIDE 0.85
#define FAR_OFF 1e30
#define RUNS_SORTED 16 /* records that are put in order by insertion before they are merged */
#define MIDDLE (1 << 30)

struct SporeClusterRecord {
  uint64_t column; /* of its place along x, then y */
  double z;
  uint32_t particle;
};

struct SporeClusterColumn {
  uint64_t key;
  uint32_t start; /* cluster */
};

typedef struct Columns {
  double side[2], per_side[2];
  int64_t count[2]; /* of a period; 0: no period */
} Columns;

bool spore_cluster_list_init(SporeClusterList *list, size_t particle_count, const double box[3], double reach,
                             double skin) {
  size_t n = particle_count; /* no particle shares its cluster at worst */
  *list = (SporeClusterList){.particle_count = n, .reach = reach, .skin = skin};
  memcpy(list->box, box, sizeof list->box);
  list->particle = SPORE_NEW_ARRAY(uint32_t, n * SPORE_LANES);
  list->x = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->f = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->reference = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  bool periodic = box[0] > 0 || box[1] > 0 || box[2] > 0;
  if (periodic) list->offset = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->bounds = SPORE_NEW_ARRAY(double, 6 * n + SPORE_LANES); /* the last vector may begin at the last cluster */
  list->group_runs = SPORE_NEW_ARRAY(uint32_t, SPORE_CLUSTER_GROUPS * n + 1);
  list->records = SPORE_NEW_ARRAY(SporeClusterRecord, n);
  list->sorting = SPORE_NEW_ARRAY(SporeClusterRecord, n);
  list->columns = SPORE_NEW_ARRAY(SporeClusterColumn, n + 1);
  for (size_t i = 0; list->records && i < n; i++) list->records[i].particle = (uint32_t)i;
  bool made = list->particle && list->x && list->f && list->reference && (list->offset || !periodic) && list->bounds &&
              list->group_runs && list->records && list->sorting && list->columns;
  if (!made) spore_cluster_list_clear(list);
  return made;
}

void spore_cluster_list_clear(SporeClusterList *list) {
  void *arrays[] = {list->particle, list->x,          list->f,         list->reference, list->offset,
                    list->bounds,   list->group_runs, list->runs,      list->entries,   list->records,
                    list->sorting,  list->columns,    list->candidates};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  *list = (SporeClusterList){0};
}

/* Sorting. */

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

/* Places. */

static Columns lay_columns(const SporeClusterList *list) {
  Columns columns;
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

/* Number of the column along one axis; strangers at the far end of the world share one. */
static int64_t column_of(const Columns *columns, int axis, double x) {
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

static bool set_records(SporeClusterList *list, const Columns *columns, const double *q) {
  for (size_t i = 0; i < list->particle_count; i++) {
    SporeClusterRecord *record = &list->records[i];
    double at[3];
    for (int k = 0; k < 3; k++) {
      double x = q[3 * (size_t)record->particle + (size_t)k];
      if (!(fabs(x) < 0.1 * FAR_OFF)) return false;
      at[k] = x + period_offset(list, k, x);
    }
    record->column = key_of(column_of(columns, 0, at[0]), column_of(columns, 1, at[1]));
    record->z = at[2];
  }
  return true;
}

static void fill_lane(SporeClusterList *list, size_t cluster, size_t lane, const double *q, uint32_t particle) {
  list->particle[cluster * SPORE_LANES + lane] = particle;
  for (size_t k = 0; k < 3; k++) {
    size_t at = cluster * SPORE_CLUSTER_DOUBLES + k * SPORE_LANES + lane;
    bool there = particle != SPORE_NO_PARTICLE;
    /* Far from everything, and from each other: no pair of them is near. */
    double stranger = FAR_OFF * (double)(k == 0 ? lane + 1 : cluster + 1), x = there ? q[3 * (size_t)particle + k] : 0;
    double offset = there ? period_offset(list, (int)k, x) : 0;
    if (list->offset) list->offset[at] = offset;
    list->x[at] = list->reference[at] = there ? x + offset : stranger;
  }
}

static void bound_cluster(SporeClusterList *list, size_t cluster) {
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

static void fill_clusters(SporeClusterList *list, const double *q) {
  list->cluster_count = list->column_count = 0;
  for (size_t i = 0; i < list->particle_count;) {
    uint64_t key = list->records[i].column;
    list->columns[list->column_count++] = (SporeClusterColumn){key, (uint32_t)list->cluster_count};
    while (i < list->particle_count && list->records[i].column == key) {
      for (size_t lane = 0; lane < SPORE_LANES; lane++) {
        bool there = i < list->particle_count && list->records[i].column == key;
        fill_lane(list, list->cluster_count, lane, q, there ? list->records[i++].particle : SPORE_NO_PARTICLE);
      }
      bound_cluster(list, list->cluster_count++);
    }
  }
  list->columns[list->column_count].start = (uint32_t)list->cluster_count;
}

/* Pairs. */

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

/* Room for `count` more. */
static bool reserve_indices(uint32_t **indices, size_t *capacity, size_t used, size_t count) {
  if (*capacity - used >= count) return true;
  size_t wanted = *capacity + *capacity / 2 + 2 * count;
  uint32_t *grown = spore_reallocate(*indices, *capacity, wanted, sizeof *grown);
  if (!grown) return false;
  *indices = grown;
  *capacity = wanted;
  return true;
}

static bool reserve_runs(SporeClusterList *list, size_t count) {
  if (list->run_capacity - list->run_count >= count) return true;
  size_t capacity = list->run_capacity + list->run_capacity / 2 + 2 * count;
  SporeClusterRun *runs = spore_reallocate(list->runs, list->run_capacity, capacity, sizeof *runs);
  if (!runs) return false;
  list->runs = runs;
  list->run_capacity = capacity;
  return true;
}

/* What one cluster may meet, by bounds: candidates in runs, one an image. */
typedef struct Search {
  size_t cluster, candidate_count, run_count;
  int64_t column[2];
  SporeClusterRun runs[27];
} Search;

static bool out_of_reach(const SporeClusterList *list, size_t cluster, const int image[3]) {
  size_t n = list->particle_count;
  double far = list->reach + list->skin;
  for (size_t k = 0; k < 3; k++) {
    if (image[k] > 0 && list->box[k] - list->bounds[(3 + k) * n + cluster] > far) return true;
    if (image[k] < 0 && list->bounds[k * n + cluster] > far) return true;
  }
  return false;
}

/* Everything moved by the image: of a pair of clusters only the later one is a candidate, of a cluster and its own
 * image only one of the two ways. */
static bool search_image(SporeClusterList *list, const Columns *columns, Search *search, const int image[3]) {
  if (out_of_reach(list, search->cluster, image)) return true;
  SporeClusterRun run = {.start = (uint32_t)search->candidate_count};
  for (int k = 0; k < 3; k++) run.image[k] = image[k] * list->box[k];
  int side = image[0] ? image[0] : image[1] ? image[1] : image[2];
  run.own = side == 0;
  size_t first = side >= 0 ? search->cluster : search->cluster + 1;
  int64_t reach[2], at[2];
  for (int k = 0; k < 2; k++) {
    reach[k] = 1 + (int64_t)((list->reach + list->skin) / columns->side[k]);
    at[k] = search->column[k] - image[k] * columns->count[k];
  }
  /* Columns that follow each other along y hold clusters that follow each other. */
  for (int64_t cx = at[0] - reach[0]; cx <= at[0] + reach[0]; cx++) {
    size_t start = list->columns[find_column(list, key_of(cx, at[1] - reach[1]))].start;
    size_t end = list->columns[find_column(list, key_of(cx, at[1] + reach[1] + 1))].start;
    if (start < first) start = first;
    if (start >= end) continue;
    if (!reserve_indices(&list->candidates, &list->candidate_capacity, search->candidate_count, end - start))
      return false;
    search->candidate_count += SPORE_KERNEL(spore_cluster_search)(list, search->cluster, run.image, start, end,
                                                                  list->candidates + search->candidate_count);
  }
  run.end = (uint32_t)search->candidate_count;
  if (run.end > run.start) search->runs[search->run_count++] = run;
  return true;
}

static bool search_cluster(SporeClusterList *list, const Columns *columns, Search *search) {
  int most[3], image[3];
  for (int k = 0; k < 3; k++) most[k] = list->box[k] > 0;
  search->candidate_count = search->run_count = 0;
  for (image[0] = -most[0]; image[0] <= most[0]; image[0]++)
    for (image[1] = -most[1]; image[1] <= most[1]; image[1]++)
      for (image[2] = -most[2]; image[2] <= most[2]; image[2]++)
        if (!search_image(list, columns, search, image)) return false;
  return true;
}

static bool add_group(SporeClusterList *list, const Search *search, size_t group) {
  list->group_runs[group] = (uint32_t)list->run_count;
  size_t first = group % SPORE_CLUSTER_GROUPS * SPORE_CLUSTER_ROWS;
  if (list->particle[search->cluster * SPORE_LANES + first] == SPORE_NO_PARTICLE) return true;
  if (!reserve_runs(list, search->run_count) ||
      !reserve_indices(&list->entries, &list->entry_capacity, list->entry_count, search->candidate_count))
    return false;
  for (size_t r = 0; r < search->run_count; r++) {
    SporeClusterRun run = search->runs[r];
    size_t start = list->entry_count;
    list->entry_count += SPORE_KERNEL(spore_cluster_refine)(list, group, run.image, list->candidates + run.start,
                                                            run.end - run.start, list->entries + start);
    run.start = (uint32_t)start;
    run.end = (uint32_t)list->entry_count;
    if (run.end > run.start) list->runs[list->run_count++] = run;
  }
  return true;
}

static bool find_pairs(SporeClusterList *list, const Columns *columns) {
  list->run_count = list->entry_count = 0;
  for (size_t c = 0; c < list->column_count; c++) {
    uint64_t key = list->columns[c].key;
    Search search = {
        .column = {(int64_t)(key >> 32) - 2 * (int64_t)MIDDLE, (int64_t)(key & UINT32_MAX) - 2 * (int64_t)MIDDLE}};
    for (size_t i = list->columns[c].start; i < list->columns[c + 1].start; i++) {
      search.cluster = i;
      if (!search_cluster(list, columns, &search)) return false;
      for (size_t g = 0; g < SPORE_CLUSTER_GROUPS; g++)
        if (!add_group(list, &search, i * SPORE_CLUSTER_GROUPS + g)) return false;
    }
  }
  list->group_runs[list->cluster_count * SPORE_CLUSTER_GROUPS] = (uint32_t)list->run_count;
  return true;
}

bool spore_cluster_list_update(SporeClusterList *list, const double *q) {
  double limit = 0.5 * list->skin;
  if (list->made && SPORE_KERNEL(spore_cluster_move)(list, q) <= limit * limit) return true;
  Columns columns = lay_columns(list);
  list->made = false;
  if (!set_records(list, &columns, q)) return false;
  sort_records(list);
  fill_clusters(list, q);
  list->made = find_pairs(list, &columns);
  list->rebuilds += list->made;
  return list->made;
}

bool spore_cluster_list_spare(SporeClusterList *list) {
  return reserve_runs(list, list->run_count) &&
         reserve_indices(&list->entries, &list->entry_capacity, list->entry_count, list->entry_count) &&
         reserve_indices(&list->candidates, &list->candidate_capacity, list->candidate_capacity,
                         list->candidate_capacity);
}

void spore_cluster_list_add_forces(const SporeClusterList *list, double *f) {
  for (size_t c = 0; c < list->cluster_count; c++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++) {
      uint32_t particle = list->particle[c * SPORE_LANES + lane];
      if (particle == SPORE_NO_PARTICLE) break;
      const double *from = list->f + c * SPORE_CLUSTER_DOUBLES + lane;
      for (size_t k = 0; k < 3; k++) f[3 * (size_t)particle + k] += from[k * SPORE_LANES];
    }
}
