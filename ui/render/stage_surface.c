/* The surface that is drawn of a body: a new one in place of the last, and the one that is left after cuts. */
#include <string.h>

#include "core/base/memory.h"
#include "ui/render/stage_body.h"

#define NODES_MAXIMUM 64 /* most nodes that move a triangle; the mesh of a net has three */

void spore_stage_body_show_surface(SporeStage *stage, SporeStageBody *body, const SporeTriangleMesh *mesh) {
  if (body->surface_handle) spore_renderer_remove(stage->renderer, body->surface_handle);
  g_free(body->surface.positions);
  spore_free(body->own_triangles);
  body->surface.positions = g_memdup2(mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  body->surface.count = mesh->vertex_count;
  body->triangles = body->own_triangles = mesh->triangles;
  body->triangle_count = mesh->triangle_count;
  body->surface_handle = 0;
  if (!mesh->vertex_count) return;
  body->surface_handle = spore_renderer_add_surface(stage->renderer, mesh->vertices, mesh->vertex_count,
                                                    mesh->triangles, mesh->triangle_count, &body->style);
  spore_renderer_set_visible(stage->renderer, body->surface_handle,
                             stage->options.surfaces && spore_stage_shows(stage, body->object));
}

/* Cuts: triangles that follow nodes of both sides of a cut are left out. */

static guint64 key_of(guint32 a, guint32 b) { return (guint64)MIN(a, b) << 32 | MAX(a, b); }

static gint compare(gconstpointer a, gconstpointer b) {
  guint64 x = *(const guint64 *)a, y = *(const guint64 *)b;
  return (x > y) - (x < y);
}

/* The body's cut edges, sorted. */
static GArray *edges_of(const SporeCuts *cuts, guint32 body) {
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

static gboolean is_cut(const SporeMapping *mapping, const guint32 *triangle, const GArray *edges) {
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

void spore_stage_body_cut(SporeStage *stage, SporeStageBody *body, const SporeCuts *cuts) {
  const SporeMapping *mapping = &body->surface.mapping;
  gboolean follows = mapping->kind == SPORE_MAPPING_IDENTITY || mapping->kind == SPORE_MAPPING_LINEAR;
  if (body->cells || !body->surface_handle || !follows || (body->own_triangles && !body->whole_triangles)) return;
  g_autoptr(GArray) edges = edges_of(cuts, body->world_body);
  if (edges->len == 0 && !body->whole_triangles) return;
  if (!body->whole_triangles) body->whole_triangles = body->triangles, body->whole_count = body->triangle_count;
  uint32_t *left = SPORE_NEW_ARRAY(uint32_t, 3 * body->whole_count);
  if (!left) return;
  gsize count = 0;
  for (gsize i = 0; i < body->whole_count; i++)
    if (!is_cut(mapping, body->whole_triangles + 3 * i, edges))
      memcpy(left + 3 * count++, body->whole_triangles + 3 * i, 3 * sizeof *left);
  spore_free(body->own_triangles);
  body->triangles = body->own_triangles = left;
  body->triangle_count = count;
  spore_renderer_remove(stage->renderer, body->surface_handle);
  body->surface_handle = spore_renderer_add_surface(stage->renderer, body->surface.positions, body->surface.count, left,
                                                    count, &body->style);
  spore_renderer_set_visible(stage->renderer, body->surface_handle,
                             stage->options.surfaces && spore_stage_shows(stage, body->object));
}
