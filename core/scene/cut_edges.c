/* Triangles that follow nodes of both sides of a cut. */
#include "core/scene/cut_edges.h"

#define NODES_MAXIMUM 64 /* most nodes that move a triangle; the mesh of a net has three */

static guint64 key_of(guint32 a, guint32 b) { return (guint64)MIN(a, b) << 32 | MAX(a, b); }

static gint compare(gconstpointer a, gconstpointer b) {
  guint64 x = *(const guint64 *)a, y = *(const guint64 *)b;
  return (x > y) - (x < y);
}

GArray *spore_cut_edges_of(const SporeCuts *cuts, guint32 body) {
  GArray *edges = g_array_new(FALSE, FALSE, sizeof(guint64));
  for (gsize i = 0; i < cuts->count; i++) {
    guint64 key = key_of(cuts->edges[i].a, cuts->edges[i].b);
    if (cuts->edges[i].body == body) g_array_append_val(edges, key);
  }
  g_array_sort(edges, compare);
  return edges;
}

static guint add_nodes(const SporeMapping *mapping, guint32 vertex, guint32 *nodes, guint count) {
  if (mapping->kind == SPORE_MAPPING_IDENTITY) {
    nodes[count] = vertex;
    return count + 1;
  }
  for (guint32 k = mapping->row_start[vertex]; k < mapping->row_start[vertex + 1] && count < NODES_MAXIMUM; k++)
    nodes[count++] = mapping->block[k];
  return count;
}

gboolean spore_triangle_is_cut(const SporeMapping *mapping, const guint32 *triangle, const GArray *edges) {
  guint32 nodes[NODES_MAXIMUM];
  guint count = 0;
  for (int k = 0; k < 3; k++) count = add_nodes(mapping, triangle[k], nodes, count);
  for (guint i = 0; i < count; i++)
    for (guint j = 0; j < i; j++) {
      guint64 key = key_of(nodes[i], nodes[j]);
      if (g_array_binary_search((GArray *)edges, &key, compare, NULL)) return TRUE;
    }
  return FALSE;
}
