/* Fewer triangles of a fine surface, for machines that draw on processors.
 *
 * Vertices that lie in one cell of a grid at rest, and look the same way, are drawn as the one that is nearest to their
 * middle (vertex clustering: Rossignac and Borrel 1993). The vertices stay, and all that belongs to them: how they
 * move, their normals, stains and values; only the list of triangles is shorter. So it takes a few milliseconds to
 * make, and a machine that draws fast, or a user who asks for fine pictures, has the whole surface at once. */
#include <math.h>
#include <string.h>

#include "ui/render/passes.h"

#define FINE_TRIANGLES 40000 /* surfaces of fewer are drawn whole */
#define KEPT_VERTICES 9000   /* about as many remain */
#define NONE G_MAXUINT32

/* The vertices of one cell that look the same way. */
typedef struct Cluster {
  guint64 key;
  guint32 count, nearest;
  double middle[3], gap;
} Cluster;

typedef struct Clusters {
  double side, lower[3];
  guint32 mask;
  guint32 *slot; /* mask + 1: number of a cluster; NONE */
  GArray *all;   /* Cluster */
  guint32 *of;   /* of each vertex */
} Clusters;

static double area_of(const double *vertices, const guint32 *triangles, gsize count) {
  double sum = 0;
  for (gsize t = 0; t < count; t++) {
    SporeVec3 a = spore_vec3_load(vertices + 3 * (gsize)triangles[3 * t]);
    SporeVec3 b = spore_vec3_sub(spore_vec3_load(vertices + 3 * (gsize)triangles[3 * t + 1]), a);
    SporeVec3 c = spore_vec3_sub(spore_vec3_load(vertices + 3 * (gsize)triangles[3 * t + 2]), a);
    sum += 0.5 * spore_vec3_length(spore_vec3_cross(b, c));
  }
  return sum;
}

/* Cell and octant of the normal, so that both sides of a thin wall stay apart. */
static guint64 key_of(const Clusters *clusters, const double *vertex, const double *normal) {
  guint64 key = 0;
  for (int k = 0; k < 3; k++)
    key = key << 21 | ((guint64)((vertex[k] - clusters->lower[k]) / clusters->side) & 0xfffff) << 1 | (normal[k] > 0);
  return key;
}

static guint32 find(Clusters *clusters, guint64 key) {
  guint64 hash = key * G_GUINT64_CONSTANT(0x9e3779b97f4a7c15);
  for (guint32 at = (guint32)(hash >> 32) & clusters->mask;; at = (at + 1) & clusters->mask) {
    guint32 number = clusters->slot[at];
    if (number != NONE && g_array_index(clusters->all, Cluster, number).key != key) continue;
    if (number != NONE) return number;
    const Cluster made = {.key = key, .nearest = NONE};
    g_array_append_val(clusters->all, made);
    return clusters->slot[at] = clusters->all->len - 1;
  }
}

/* Sorts the vertices into clusters, and finds the one of each that is drawn. */
static void sort(Clusters *clusters, const SporeSurfaceGroup *surface, const double *vertices) {
  for (gsize v = 0; v < surface->vertex_count; v++) {
    guint32 number = find(clusters, key_of(clusters, vertices + 3 * v, surface->normals + 3 * v));
    Cluster *cluster = &g_array_index(clusters->all, Cluster, number);
    clusters->of[v] = number;
    cluster->count++;
    for (int k = 0; k < 3; k++) cluster->middle[k] += vertices[3 * v + k];
  }
  for (gsize v = 0; v < surface->vertex_count; v++) {
    Cluster *cluster = &g_array_index(clusters->all, Cluster, clusters->of[v]);
    SporeVec3 middle = spore_vec3_scale(1.0 / cluster->count, spore_vec3_load(cluster->middle));
    double gap = spore_vec3_distance(middle, spore_vec3_load(vertices + 3 * v));
    if (cluster->nearest == NONE || gap < cluster->gap) cluster->nearest = (guint32)v, cluster->gap = gap;
  }
}

/* Whether a triangle faces away from where its corners look. */
static gboolean is_turned(const SporeSurfaceGroup *surface, const double *vertices, const guint32 *corners) {
  SporeVec3 at[3], out = {0, 0, 0};
  for (int k = 0; k < 3; k++) {
    at[k] = spore_vec3_load(vertices + 3 * (gsize)corners[k]);
    out = spore_vec3_add(out, spore_vec3_load(surface->normals + 3 * (gsize)corners[k]));
  }
  SporeVec3 across = spore_vec3_cross(spore_vec3_sub(at[1], at[0]), spore_vec3_sub(at[2], at[0]));
  return spore_vec3_dot(across, out) < 0;
}

/* The triangles whose corners lie in three clusters; *count: of them. g_free. */
static guint32 *join(const Clusters *clusters, const SporeSurfaceGroup *surface, const double *vertices, gsize *count) {
  guint32 *kept = g_new(guint32, 3 * surface->triangle_count), *out = kept;
  for (gsize t = 0; t < surface->triangle_count; t++) {
    guint32 corners[3];
    for (int k = 0; k < 3; k++) corners[k] = clusters->of[surface->triangles[3 * t + k]];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (int k = 0; k < 3; k++) out[k] = g_array_index(clusters->all, Cluster, corners[k]).nearest;
    if (is_turned(surface, vertices, out)) corners[0] = out[1], out[1] = out[2], out[2] = corners[0];
    out += 3;
  }
  *count = (gsize)(out - kept) / 3;
  return kept;
}

static void upload(SporeSurfaceGroup *surface, const guint32 *triangles, gsize count) {
  surface->coarse_count = count;
  glGenBuffers(1, &surface->coarse);
  glBindVertexArray(0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, surface->coarse);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(3 * count * sizeof *triangles), triangles, GL_STATIC_DRAW);
}

void spore_surface_make_coarse(SporeSurfaceGroup *surface, const double *vertices) {
  double area = area_of(vertices, surface->triangles, surface->triangle_count);
  guint32 slots = 1;
  if (surface->triangle_count < FINE_TRIANGLES || !(area > 0)) return;
  while (slots < 2 * surface->vertex_count) slots *= 2;
  Clusters clusters = {.side = sqrt(area / KEPT_VERTICES), .mask = slots - 1};
  for (int k = 0; k < 3; k++) clusters.lower[k] = surface->base.lower[k];
  clusters.slot = g_new(guint32, slots);
  memset(clusters.slot, 0xff, slots * sizeof *clusters.slot);
  clusters.all = g_array_new(FALSE, FALSE, sizeof(Cluster));
  clusters.of = g_new(guint32, surface->vertex_count);
  sort(&clusters, surface, vertices);
  gsize count;
  g_autofree guint32 *kept = join(&clusters, surface, vertices, &count);
  if (2 * count < surface->triangle_count) upload(surface, kept, count);
  g_free(clusters.slot);
  g_free(clusters.of);
  g_array_free(clusters.all, TRUE);
}
