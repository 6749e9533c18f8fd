/* The shortest path along edges (E. Dijkstra 1959). */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"

#define NONE SPORE_SHEET_NONE

typedef struct Entry {
  double length;
  uint32_t vertex;
} Entry;

/* The nearest on top; a vertex may be in it more than once. */
typedef struct Queue {
  size_t count, room;
  Entry *entry;
} Queue;

static bool comes_before(Entry a, Entry b) {
  return a.length < b.length || (a.length == b.length && a.vertex < b.vertex);
}

static bool push(Queue *queue, Entry new) {
  Entry *entry = spore_room_for_one(queue->entry, queue->count, &queue->room, 256, sizeof *entry);
  if (!entry) return false;
  queue->entry = entry;
  size_t i = queue->count++;
  for (; i > 0 && comes_before(new, entry[(i - 1) / 2]); i = (i - 1) / 2) entry[i] = entry[(i - 1) / 2];
  entry[i] = new;
  return true;
}

static Entry pop(Queue *queue) {
  Entry *entry = queue->entry, top = entry[0], last = entry[--queue->count];
  size_t i = 0;
  for (size_t child = 1; child < queue->count; child = 2 * i + 1) {
    if (child + 1 < queue->count && comes_before(entry[child + 1], entry[child])) child++;
    if (!comes_before(entry[child], last)) break;
    entry[i] = entry[child];
    i = child;
  }
  entry[i] = last;
  return top;
}

/* What is known of each vertex. */
typedef struct Search {
  const SporeSheetCut *cut;
  double *length;     /* of the shortest path so far, m */
  uint32_t *previous; /* on it */
  Queue queue;
} Search;

static bool reach(Search *search, uint32_t from, uint32_t to) {
  double length = search->length[from] +
                  spore_vec3_distance(spore_sheet_vertex(search->cut, from), spore_sheet_vertex(search->cut, to));
  if (!(length < search->length[to])) return true;
  search->length[to] = length, search->previous[to] = from;
  return push(&search->queue, (Entry){length, to});
}

static bool reach_around(Search *search, uint32_t vertex) {
  const SporeSheetCut *cut = search->cut;
  uint32_t first = cut->leaving[vertex], turn = first, last;
  do {
    if (!reach(search, vertex, spore_sheet_to(cut, turn))) return false;
    last = turn, turn = spore_sheet_turn(cut, turn);
  } while (turn != NONE && turn != first);
  return turn != NONE || reach(search, vertex, spore_sheet_from(cut, spore_sheet_before(last)));
}

static bool run(Search *search, uint32_t from, uint32_t to) {
  for (size_t i = 0; i < search->cut->vertex_count; i++) search->length[i] = HUGE_VAL;
  search->length[from] = 0;
  bool good = push(&search->queue, (Entry){0, from});
  while (good && search->queue.count > 0) {
    Entry top = pop(&search->queue);
    if (top.vertex == to) break;
    if (top.length == search->length[top.vertex]) good = reach_around(search, top.vertex);
  }
  return good;
}

/* The vertices from the end back. */
static bool collect(const Search *search, uint32_t from, uint32_t to, uint32_t **path, size_t *count) {
  *count = 1;
  for (uint32_t v = to; v != from; v = search->previous[v]) ++*count;
  *path = SPORE_NEW_ARRAY(uint32_t, *count);
  if (!*path) return false;
  uint32_t v = to;
  for (size_t i = *count; i-- > 0; v = search->previous[v]) (*path)[i] = v;
  return true;
}

bool spore_sheet_find_path(const SporeSheetCut *cut, uint32_t from, uint32_t to, uint32_t **path, size_t *count,
                           SporeError *error) {
  Search search = {cut, SPORE_NEW_ARRAY(double, cut->vertex_count), SPORE_NEW_ARRAY(uint32_t, cut->vertex_count), {0}};
  bool good = search.length && search.previous && run(&search, from, to);
  *path = NULL, *count = 0;
  if (good && search.length[to] < HUGE_VAL) good = collect(&search, from, to, path, count);
  spore_free(search.length);
  spore_free(search.previous);
  spore_free(search.queue.entry);
  return good || spore_generate_no_memory(error);
}
