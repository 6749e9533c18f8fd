#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/particles/cluster_columns.h"

/* Skins over the reach: least time of a liquid at its triple point, of 256 to 10,976 particles (`./dev bench fluid`).
 */
#define WIDE_SKIN 0.30
#define NEAR_SKIN 0.06
double spore_cluster_reach(double reach) { return (1 + WIDE_SKIN) * reach; }

static bool init_pairs(SporeClusterPairs *pairs, size_t clusters, double reach) {
  pairs->reach = reach;
  pairs->group_runs = SPORE_NEW_ARRAY(uint32_t, SPORE_CLUSTER_GROUPS * clusters + 1);
  return pairs->group_runs;
}

bool spore_cluster_list_init(SporeClusterList *list, size_t particle_count, const double box[3], double reach) {
  assert(particle_count < SPORE_NO_PARTICLE);
  assert(reach > 0);
  assert(box[0] >= 0 && box[1] >= 0 && box[2] >= 0);
  size_t n = particle_count; /* no particle shares its cluster at worst */
  *list = (SporeClusterList){.particle_count = n, .reach = reach};
  memcpy(list->box, box, sizeof list->box);
  list->particle = SPORE_NEW_ARRAY(uint32_t, n * SPORE_LANES);
  list->x = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->f = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->wide_at = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->near_at = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  bool periodic = box[0] > 0 || box[1] > 0 || box[2] > 0;
  if (periodic) list->offset = SPORE_NEW_ARRAY(double, n *SPORE_CLUSTER_DOUBLES);
  list->bounds = SPORE_NEW_ARRAY(double, 6 * n + SPORE_LANES); /* the last vector may begin at the last cluster */
  list->records = SPORE_NEW_ARRAY(SporeClusterRecord, n);
  list->sorting = SPORE_NEW_ARRAY(SporeClusterRecord, n);
  list->columns = SPORE_NEW_ARRAY(SporeClusterColumn, n + 1);
  for (size_t i = 0; list->records && i < n; i++) list->records[i].particle = (uint32_t)i;
  bool made = list->particle && list->x && list->f && list->wide_at && list->near_at && (list->offset || !periodic) &&
              list->bounds && list->records && list->sorting && list->columns &&
              init_pairs(&list->wide, n, spore_cluster_reach(reach)) &&
              init_pairs(&list->near, n, (1 + NEAR_SKIN) * reach);
  if (!made) spore_cluster_list_clear(list);
  return made;
}

void spore_cluster_list_clear(SporeClusterList *list) {
  void *arrays[] = {list->particle,
                    list->x,
                    list->f,
                    list->wide_at,
                    list->near_at,
                    list->offset,
                    list->bounds,
                    list->records,
                    list->sorting,
                    list->columns,
                    list->candidates,
                    list->wide.group_runs,
                    list->wide.runs,
                    list->wide.entries,
                    list->near.group_runs,
                    list->near.runs,
                    list->near.entries};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  *list = (SporeClusterList){0};
}

/* Room for `count` more. */
static bool reserve_indices(uint32_t **indices, size_t *capacity, size_t used, size_t count) {
  assert(used <= *capacity);
  if (*capacity - used >= count) return true;
  size_t wanted = *capacity + *capacity / 2 + 2 * count;
  uint32_t *grown = spore_reallocate(*indices, *capacity, wanted, sizeof *grown);
  if (!grown) return false;
  *indices = grown;
  *capacity = wanted;
  return true;
}

/* The same for runs and entries. */
static bool reserve_pairs(SporeClusterPairs *pairs, size_t runs, size_t entries) {
  if (!reserve_indices(&pairs->entries, &pairs->entry_capacity, pairs->entry_count, entries)) return false;
  if (pairs->run_capacity - pairs->run_count >= runs) return true;
  size_t capacity = pairs->run_capacity + pairs->run_capacity / 2 + 2 * runs;
  SporeClusterRun *grown = spore_reallocate(pairs->runs, pairs->run_capacity, capacity, sizeof *grown);
  if (!grown) return false;
  pairs->runs = grown;
  pairs->run_capacity = capacity;
  return true;
}

/* What one cluster may meet, by bounds: candidates in runs, one an image. */
typedef struct Search {
  size_t cluster, candidate_count, run_count;
  SporeClusterRun runs[27];
} Search;

static bool out_of_reach(const SporeClusterList *list, size_t cluster, const int image[3]) {
  assert(cluster < list->cluster_count);
  size_t n = list->particle_count;
  double far = list->wide.reach;
  for (size_t k = 0; k < 3; k++) {
    if (image[k] > 0 && list->box[k] - list->bounds[(3 + k) * n + cluster] > far) return true;
    if (image[k] < 0 && list->bounds[k * n + cluster] > far) return true;
  }
  return false;
}

/* Everything moved by the image: of a pair of clusters only the later one is a candidate, of a cluster and its own
 * image only one of the two ways. */
static bool search_image(SporeClusterList *list, const SporeColumnGrid *columns, Search *search, const int image[3]) {
  if (out_of_reach(list, search->cluster, image)) return true;
  SporeClusterRun run = {.start = (uint32_t)search->candidate_count};
  for (int k = 0; k < 3; k++) run.image[k] = image[k] * list->box[k];
  int side = image[0] ? image[0] : image[1] ? image[1] : image[2];
  run.own = side == 0;
  size_t first = side >= 0 ? search->cluster : search->cluster + 1;
  int64_t least[2], most[2]; /* columns */
  double far = list->wide.reach;
  for (int k = 0; k < 2; k++) {
    const double *bounds = list->bounds + (size_t)k * list->particle_count + search->cluster;
    least[k] = spore_column_of(columns, k, bounds[0] - run.image[k] - far);
    most[k] = spore_column_of(columns, k, bounds[3 * list->particle_count] - run.image[k] + far);
  }
  for (int64_t cx = least[0]; cx <= most[0]; cx++) {
    size_t start, end;
    spore_cluster_row(list, cx, least[1], most[1], &start, &end);
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

static bool search_cluster(SporeClusterList *list, const SporeColumnGrid *columns, Search *search) {
  int most[3], image[3];
  for (int k = 0; k < 3; k++) most[k] = list->box[k] > 0;
  search->candidate_count = search->run_count = 0;
  for (image[0] = -most[0]; image[0] <= most[0]; image[0]++)
    for (image[1] = -most[1]; image[1] <= most[1]; image[1]++)
      for (image[2] = -most[2]; image[2] <= most[2]; image[2]++)
        if (!search_image(list, columns, search, image)) return false;
  return true;
}

/* To the runs of a row group: what of the run's clusters is within pairs->reach of it. There is room. */
static void add_run(const SporeClusterList *list, SporeClusterPairs *pairs, size_t group, SporeClusterRun run,
                    const uint32_t *clusters) {
  assert(run.start <= run.end);
  size_t start = pairs->entry_count;
  pairs->entry_count += SPORE_KERNEL(spore_cluster_refine)(list, pairs->reach, group, run.image, clusters + run.start,
                                                           run.end - run.start, pairs->entries + start);
  run.start = (uint32_t)start;
  run.end = (uint32_t)pairs->entry_count;
  if (run.end > run.start) pairs->runs[pairs->run_count++] = run;
}

static bool add_group(SporeClusterList *list, const Search *search, size_t group) {
  list->wide.group_runs[group] = (uint32_t)list->wide.run_count;
  size_t first = group % SPORE_CLUSTER_GROUPS * SPORE_CLUSTER_ROWS;
  if (list->particle[search->cluster * SPORE_LANES + first] == SPORE_NO_PARTICLE) return true;
  if (!reserve_pairs(&list->wide, search->run_count, search->candidate_count)) return false;
  for (size_t r = 0; r < search->run_count; r++) add_run(list, &list->wide, group, search->runs[r], list->candidates);
  return true;
}

static bool find_wide(SporeClusterList *list, const double *q) {
  SporeColumnGrid columns = spore_column_grid(list);
  if (!spore_cluster_fill(list, &columns, q)) return false;
  memcpy(list->wide_at, list->x, list->cluster_count * SPORE_CLUSTER_DOUBLES * sizeof *list->x);
  list->wide.run_count = list->wide.entry_count = 0;
  Search search;
  for (search.cluster = 0; search.cluster < list->cluster_count; search.cluster++) {
    if (!search_cluster(list, &columns, &search)) return false;
    for (size_t g = 0; g < SPORE_CLUSTER_GROUPS; g++)
      if (!add_group(list, &search, search.cluster * SPORE_CLUSTER_GROUPS + g)) return false;
  }
  list->wide.group_runs[list->cluster_count * SPORE_CLUSTER_GROUPS] = (uint32_t)list->wide.run_count;
  list->rebuilds++;
  return true;
}

static bool pick_near(SporeClusterList *list) {
  const SporeClusterPairs *wide = &list->wide;
  memcpy(list->near_at, list->x, list->cluster_count * SPORE_CLUSTER_DOUBLES * sizeof *list->x);
  list->near.run_count = list->near.entry_count = 0;
  if (!reserve_pairs(&list->near, wide->run_count, wide->entry_count)) return false;
  size_t groups = list->cluster_count * SPORE_CLUSTER_GROUPS;
  for (size_t group = 0; group < groups; group++) {
    list->near.group_runs[group] = (uint32_t)list->near.run_count;
    for (uint32_t r = wide->group_runs[group]; r < wide->group_runs[group + 1]; r++)
      add_run(list, &list->near, group, wide->runs[r], wide->entries);
  }
  list->near.group_runs[groups] = (uint32_t)list->near.run_count;
  return true;
}

/* Whether the wide list holds every pair that the near one needs: two particles that were not in its reach may have
 * come nearer by twice the way of one. */
static bool is_wide_enough(const SporeClusterList *list) {
  double way = 0.5 * (list->wide.reach - list->near.reach);
  return SPORE_KERNEL(spore_cluster_way)(list) <= way * way;
}

bool spore_cluster_list_update(SporeClusterList *list, const double *q) {
  double way = 0.5 * (list->near.reach - list->reach);
  if (list->made && SPORE_KERNEL(spore_cluster_move)(list, q) <= way * way) return true;
  bool kept = list->made && is_wide_enough(list);
  list->made = false;
  list->made = (kept || find_wide(list, q)) && pick_near(list);
  return list->made;
}

bool spore_cluster_list_spare(SporeClusterList *list) {
  assert(list->made);
  return reserve_pairs(&list->wide, list->wide.run_count, list->wide.entry_count) &&
         reserve_pairs(&list->near, list->wide.run_capacity, list->wide.entry_capacity) &&
         reserve_indices(&list->candidates, &list->candidate_capacity, list->candidate_capacity,
                         list->candidate_capacity);
}

void spore_cluster_list_add_forces(const SporeClusterList *list, double *f) {
  assert(list->made);
  for (size_t c = 0; c < list->cluster_count; c++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++) {
      uint32_t particle = list->particle[c * SPORE_LANES + lane];
      if (particle == SPORE_NO_PARTICLE) break;
      const double *from = list->f + c * SPORE_CLUSTER_DOUBLES + lane;
      for (size_t k = 0; k < 3; k++) f[3 * (size_t)particle + k] += from[k * SPORE_LANES];
    }
}
