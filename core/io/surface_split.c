/* Divides the vertices of a surface at the seams of its picture. */
#include "core/io/surface_split.h"

#include <string.h>

#define NONE G_MAXUINT32

/* The vertices that stand for one vertex of the mesh lead from one to the next. */
typedef struct Chains {
  guint32 *first, *next;
} Chains;

/* The one that has the place; made anew where there is none. */
static guint32 find(SporeSurfaceSplit *split, const Chains *chains, guint32 vertex, const float *place) {
  for (guint32 i = chains->first[vertex]; i != NONE; i = chains->next[i])
    if (memcmp(split->places + 2 * (gsize)i, place, 2 * sizeof *place) == 0) return i;
  guint32 made = (guint32)split->count++;
  split->vertices[made] = vertex;
  memcpy(split->places + 2 * (gsize)made, place, 2 * sizeof *place);
  chains->next[made] = chains->first[vertex];
  chains->first[vertex] = made;
  return made;
}

static void divide(SporeSurfaceSplit *split, const SporeNamedSurface *surface) {
  const SporeTriangleMesh *mesh = &surface->mesh;
  gsize corners = 3 * mesh->triangle_count;
  g_autofree guint32 *first = g_new(guint32, mesh->vertex_count + 1), *next = g_new(guint32, corners + 1);
  const Chains chains = {first, next};
  memset(first, 0xff, (mesh->vertex_count + 1) * sizeof *first);
  split->vertices = g_new(guint32, corners + 1);
  split->places = g_new(float, 2 * corners + 1);
  for (gsize i = 0; i < corners; i++)
    split->triangles[i] = find(split, &chains, mesh->triangles[i], surface->places + 2 * i);
}

void spore_surface_split_init(SporeSurfaceSplit *split, const SporeNamedSurface *surface) {
  const SporeTriangleMesh *mesh = &surface->mesh;
  *split = (SporeSurfaceSplit){.triangles = g_new(guint32, 3 * mesh->triangle_count + 1)};
  if (surface->places) {
    divide(split, surface);
    return;
  }
  split->count = mesh->vertex_count;
  split->vertices = g_new(guint32, mesh->vertex_count + 1);
  for (gsize i = 0; i < mesh->vertex_count; i++) split->vertices[i] = (guint32)i;
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++) split->triangles[i] = mesh->triangles[i];
}

void spore_surface_split_clear(SporeSurfaceSplit *split) {
  g_free(split->vertices);
  g_free(split->places);
  g_free(split->triangles);
  *split = (SporeSurfaceSplit){0};
}
