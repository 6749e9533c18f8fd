/* Finds the nodes at which a seam joins two bodies. */
#include "core/scene/seam.h"

#include <math.h>
#include <stdlib.h>

/* Coordinates of the nodes at rest in the scene's axes, 3 a node; g_free. NULL: there are no nodes. */
static double *place_nodes(const SporeSeamSide *side, size_t *count) {
  const SporeModel *model = side->model;
  *count = model && model->node_count > 1 ? model->node_count : 0;
  if (!*count) return NULL;
  const SporeVec3 still = {0, 0, 0};
  double *q = g_new0(double, model->q_room > model->q_count ? model->q_room : model->q_count);
  size_t blocks = model->block_room > model->block_count ? model->block_room : model->block_count;
  g_autofree double *v = g_new0(double, 3 * blocks);
  model->type->place(model, side->pose, still, still, q, v);
  return q;
}

static int compare(const void *one, const void *other) {
  double a = *(const double *)one, b = *(const double *)other; /* x of each */
  return (a > b) - (a < b);
}

/* Whether one of the nodes, sorted by x, lies within `distance` of p. */
static gboolean has_near(const double *sorted, size_t count, SporeVec3 p, double distance) {
  size_t low = 0, high = count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (sorted[3 * middle] < p.x - distance) low = middle + 1;
    else high = middle;
  }
  for (size_t i = low; i < count && sorted[3 * i] <= p.x + distance; i++)
    if (spore_vec3_distance(spore_vec3_load(sorted + 3 * i), p) <= distance) return TRUE;
  return FALSE;
}

void spore_seam_find(const SporeSeamSide *a, const SporeSeamSide *b, double distance, GArray *points) {
  size_t count_a, count_b;
  g_autofree double *nodes_a = place_nodes(a, &count_a);
  g_autofree double *nodes_b = place_nodes(b, &count_b);
  if (count_b) qsort(nodes_b, count_b, 3 * sizeof *nodes_b, compare);
  for (size_t i = 0; i < count_a; i++) {
    SporeVec3 p = spore_vec3_load(nodes_a + 3 * i);
    if (has_near(nodes_b, count_b, p, distance)) g_array_append_val(points, p);
  }
}
