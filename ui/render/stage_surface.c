/* The surface that is drawn of a body: a new one in place of the last, and the one that is left after cuts. */
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/cut_edges.h"
#include "ui/render/stage_body.h"

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

void spore_stage_body_cut(SporeStage *stage, SporeStageBody *body, const SporeCuts *cuts) {
  const SporeMapping *mapping = &body->surface.mapping;
  gboolean follows = mapping->kind == SPORE_MAPPING_IDENTITY || mapping->kind == SPORE_MAPPING_LINEAR;
  if (body->cells || !body->surface_handle || !follows || (body->own_triangles && !body->whole_triangles)) return;
  g_autoptr(GArray) edges = spore_cut_edges_of(cuts, body->world_body);
  if (edges->len == 0 && !body->whole_triangles) return;
  if (!body->whole_triangles) body->whole_triangles = body->triangles, body->whole_count = body->triangle_count;
  uint32_t *left = SPORE_NEW_ARRAY(uint32_t, 3 * body->whole_count);
  if (!left) return;
  gsize count = 0;
  g_autofree float *places = body->places ? g_new(float, 6 * body->whole_count + 1) : NULL;
  for (gsize i = 0; i < body->whole_count; i++) {
    if (spore_triangle_is_cut(mapping, body->whole_triangles + 3 * i, edges)) continue;
    if (places) memcpy(places + 6 * count, body->places + 6 * i, 6 * sizeof *places);
    memcpy(left + 3 * count++, body->whole_triangles + 3 * i, 3 * sizeof *left);
  }
  spore_free(body->own_triangles);
  body->triangles = body->own_triangles = left;
  body->triangle_count = count;
  spore_renderer_remove(stage->renderer, body->surface_handle);
  body->surface_handle = spore_renderer_add_surface(stage->renderer, body->surface.positions, body->surface.count, left,
                                                    count, &body->style);
  spore_stage_body_lay_texture(stage, body, body->surface.positions, places);
  spore_stage_body_stain_anew(body, NULL);
  spore_renderer_set_visible(stage->renderer, body->surface_handle,
                             stage->options.surfaces && spore_stage_shows(stage, body->object));
}
