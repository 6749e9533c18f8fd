/* Approximate minimum degree on the quotient graph. */
#include "core/linalg/minimum_degree.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"

#define NONE UINT32_MAX

/* The quotient graph. The row of a variable in the pattern holds its remaining neighbours: variables from the front,
 * elements from the back. An element is an eliminated variable; it knows the variables around it. */
typedef struct Graph {
  uint32_t count;
  uint32_t *row_start, *row;            /* count + 1; neighbours */
  uint32_t *variables, *elements;       /* how many of each in a row */
  uint32_t *degree;                     /* approximate */
  uint32_t *first, *next, *previous;    /* lists of variables by degree */
  uint32_t *around_start, *around_size; /* by element; size NONE: variable, or absorbed */
  uint32_t *around;
  size_t around_count, around_capacity;
  uint32_t *mark;            /* pivot + 1 that a variable is around of */
  uint32_t *outside, *stamp; /* by element: variables not around the pivot, valid where stamp is pivot + 1 */
  bool *eliminated;
} Graph;

static void unlist(Graph *graph, uint32_t i) {
  assert(i < graph->count && graph->degree[i] <= graph->count);
  uint32_t before = graph->previous[i], after = graph->next[i];
  if (before == NONE) graph->first[graph->degree[i]] = after;
  else graph->next[before] = after;
  if (after != NONE) graph->previous[after] = before;
}

static void enlist(Graph *graph, uint32_t i, uint32_t degree) {
  assert(i < graph->count && degree <= graph->count);
  uint32_t after = graph->first[degree];
  graph->degree[i] = degree;
  graph->next[i] = after;
  graph->previous[i] = NONE;
  if (after != NONE) graph->previous[after] = i;
  graph->first[degree] = i;
}

static void clear(Graph *graph) {
  void *arrays[] = {graph->row_start, graph->row,  graph->variables, graph->elements,     graph->degree,
                    graph->first,     graph->next, graph->previous,  graph->around_start, graph->around_size,
                    graph->around,    graph->mark, graph->outside,   graph->stamp,        graph->eliminated};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
}

static bool make(Graph *graph, const SporeBlockMatrix *pattern) {
  size_t n = pattern->block_count, entries = pattern->row_start[n];
  uint32_t **arrays[] = {&graph->variables, &graph->elements, &graph->degree,       &graph->first,
                         &graph->next,      &graph->previous, &graph->around_start, &graph->around_size,
                         &graph->mark,      &graph->outside,  &graph->stamp};
  *graph = (Graph){.count = (uint32_t)n};
  bool made = true;
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
    made = (*arrays[i] = SPORE_NEW_ARRAY(uint32_t, n + 1)) != NULL && made;
  graph->row_start = SPORE_NEW_ARRAY(uint32_t, n + 1);
  graph->row = SPORE_NEW_ARRAY(uint32_t, entries);
  graph->eliminated = SPORE_NEW_ARRAY(bool, n);
  graph->around_capacity = entries;
  graph->around = SPORE_NEW_ARRAY(uint32_t, entries);
  return made && graph->row_start && graph->row && graph->eliminated && graph->around;
}

static void fill_in(Graph *graph, const SporeBlockMatrix *pattern) {
  uint32_t n = graph->count;
  for (uint32_t i = 0; i <= n; i++) graph->first[i] = NONE;
  memcpy(graph->row_start, pattern->row_start, (n + 1) * sizeof *graph->row_start);
  for (uint32_t i = n; i-- > 0;) {
    uint32_t count = 0, *row = graph->row + graph->row_start[i];
    for (uint32_t k = pattern->row_start[i]; k < pattern->row_start[i + 1]; k++)
      if (pattern->column[k] != i) row[count++] = pattern->column[k];
    graph->variables[i] = count;
    graph->around_size[i] = NONE;
    enlist(graph, i, count);
  }
}

static void surround(Graph *graph, uint32_t i, uint32_t pivot) {
  if (graph->eliminated[i] || graph->mark[i] == pivot + 1) return;
  graph->mark[i] = pivot + 1;
  graph->around[graph->around_count++] = i;
}

static bool reserve(Graph *graph) {
  if (graph->around_count + graph->count <= graph->around_capacity) return true;
  size_t capacity = 2 * graph->around_capacity + graph->count;
  if (capacity > UINT32_MAX) return false;
  uint32_t *around = spore_reallocate(graph->around, graph->around_capacity, capacity, sizeof *around);
  if (!around) return false;
  graph->around = around;
  graph->around_capacity = capacity;
  return true;
}

/* Makes the pivot an element. The variables around the element are those around the pivot and those around the elements
 * that the pivot touches; these elements are absorbed. */
static bool eliminate(Graph *graph, uint32_t pivot) {
  assert(pivot < graph->count && !graph->eliminated[pivot]);
  if (!reserve(graph)) return false;
  uint32_t *row = graph->row + graph->row_start[pivot], *back = graph->row + graph->row_start[pivot + 1];
  size_t start = graph->around_count;
  unlist(graph, pivot);
  graph->eliminated[pivot] = true;
  for (uint32_t k = 0; k < graph->variables[pivot]; k++) surround(graph, row[k], pivot);
  for (uint32_t k = 1; k <= graph->elements[pivot]; k++) {
    uint32_t element = *(back - k), size = graph->around_size[element];
    if (size == NONE) continue;
    for (uint32_t l = 0; l < size; l++) surround(graph, graph->around[graph->around_start[element] + l], pivot);
    graph->around_size[element] = NONE;
  }
  graph->around_start[pivot] = (uint32_t)start;
  graph->around_size[pivot] = (uint32_t)(graph->around_count - start);
  return true;
}

/* How much of each element lies outside of what is around the pivot. */
static void measure_outside(Graph *graph, uint32_t pivot) {
  const uint32_t *around = graph->around + graph->around_start[pivot];
  for (uint32_t l = 0; l < graph->around_size[pivot]; l++) {
    const uint32_t *back = graph->row + graph->row_start[around[l] + 1];
    for (uint32_t k = 1; k <= graph->elements[around[l]]; k++) {
      uint32_t element = *(back - k);
      if (graph->around_size[element] == NONE) continue;
      if (graph->stamp[element] != pivot + 1) {
        graph->stamp[element] = pivot + 1;
        graph->outside[element] = graph->around_size[element];
      }
      graph->outside[element]--;
    }
  }
}

/* Removes from the row of a variable around the pivot what the new element covers; returns the degree of the
 * variable. */
static uint32_t prune(Graph *graph, uint32_t i, uint32_t pivot) {
  assert(graph->mark[i] == pivot + 1 && graph->around_size[pivot] > 0);
  uint32_t *row = graph->row + graph->row_start[i], *back = graph->row + graph->row_start[i + 1];
  uint32_t kept = 0, elements = 0, degree = graph->around_size[pivot] - 1;
  for (uint32_t k = 0; k < graph->variables[i]; k++)
    if (!graph->eliminated[row[k]] && graph->mark[row[k]] != pivot + 1) row[kept++] = row[k];
  for (uint32_t k = 1; k <= graph->elements[i]; k++) {
    uint32_t element = *(back - k);
    if (graph->around_size[element] == NONE || graph->outside[element] == 0) continue;
    degree += graph->outside[element];
    *(back - ++elements) = element;
  }
  *(back - ++elements) = pivot; /* in the place of the pivot, or of an element that it absorbed */
  graph->variables[i] = kept;
  graph->elements[i] = elements;
  return degree + kept;
}

bool spore_minimum_degree(const SporeBlockMatrix *pattern, double most, const SporeCancel *cancel, uint32_t *order,
                          SporeFill *fill) {
  assert(pattern->block_count < UINT32_MAX && most >= 0);
  assert(order && fill);
  Graph graph;
  uint32_t lowest = 0;
  bool made = make(&graph, pattern);
  *fill = (SporeFill){0};
  if (made) fill_in(&graph, pattern);
  for (uint32_t step = 0; made && step < graph.count && fill->squares <= most; step++) {
    while (graph.first[lowest] == NONE) lowest++;
    uint32_t pivot = order[step] = graph.first[lowest], left = graph.count - step - 1;
    made = !spore_cancel_asked(cancel) && eliminate(&graph, pivot);
    if (!made) break;
    uint32_t size = graph.around_size[pivot];
    fill->squares += (1.0 + size) * (1.0 + size);
    fill->blocks += 1 + (size_t)size;
    measure_outside(&graph, pivot);
    for (uint32_t l = 0; l < size; l++) {
      uint32_t i = graph.around[graph.around_start[pivot] + l], degree = prune(&graph, i, pivot);
      if (degree > graph.degree[i] + size) degree = graph.degree[i] + size;
      if (degree >= left) degree = left - 1;
      unlist(&graph, i);
      enlist(&graph, i, degree);
      if (degree < lowest) lowest = degree;
    }
  }
  clear(&graph);
  return made;
}
