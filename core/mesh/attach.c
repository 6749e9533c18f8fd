/* Attaches each vertex of a surface to a point of a curve. */
#include "core/mesh/attach.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/mesh/half_edges.h"

#define FAR 4 /* neighbours belong to places no farther apart, in distances from the curve */

typedef struct Attachment {
  const SporeCurve *curve;
  const SporeTriangleMesh *mesh;
  double *length; /* length of the curve up to each of its points */
  uint32_t *place;
  size_t edge_count;
  uint32_t *edges;                    /* 2 each */
  uint32_t *first, *neighbour;        /* of vertex v: neighbour[first[v] .. first[v + 1]) */
  uint32_t *surface, *part, *members; /* sets of vertices: joined by edges, by edges that are not torn; their sizes */
  uint32_t *queue;
  bool *kept;
} Attachment;

static double power(const Attachment *a, SporeVec3 p, size_t i) {
  assert(i < a->curve->count);
  const double *point = a->curve->points + 4 * i;
  SporeVec3 off = spore_vec3_sub(p, spore_vec3_load(point));
  return spore_vec3_dot(off, off) - point[3] * point[3];
}

static SporeVec3 vertex(const Attachment *a, uint32_t v) {
  assert(v < a->mesh->vertex_count);
  return spore_vec3_load(a->mesh->vertices + 3 * (size_t)v);
}

static uint32_t nearest(const Attachment *a, SporeVec3 p) {
  uint32_t best = 0;
  double least = HUGE_VAL;
  for (uint32_t i = 0; i < a->curve->count; i++) {
    double here = power(a, p, i);
    if (here < least) least = here, best = i;
  }
  return best;
}

static uint32_t downhill(const Attachment *a, SporeVec3 p, uint32_t i) {
  for (double here = power(a, p, i);;) {
    double back = i > 0 ? power(a, p, i - 1) : HUGE_VAL;
    double ahead = i + 1 < a->curve->count ? power(a, p, i + 1) : HUGE_VAL;
    if (!(fmin(back, ahead) < here)) return i;
    i = back < ahead ? i - 1 : i + 1;
    here = fmin(back, ahead);
  }
}

static double off_curve(const Attachment *a, uint32_t v) {
  return spore_vec3_distance(vertex(a, v), spore_vec3_load(a->curve->points + 4 * (size_t)a->place[v]));
}

static bool is_torn(const Attachment *a, size_t edge) {
  uint32_t v = a->edges[2 * edge], w = a->edges[2 * edge + 1];
  double along = fabs(a->length[a->place[v]] - a->length[a->place[w]]);
  double side = spore_vec3_distance(vertex(a, v), vertex(a, w));
  return along > 2 * side + FAR * fmax(off_curve(a, v), off_curve(a, w));
}

static void find_neighbours(Attachment *a) {
  size_t count = a->mesh->vertex_count;
  for (size_t i = 0; i < 2 * a->edge_count; i++) a->first[a->edges[i] + 2]++;
  for (size_t v = 0; v < count; v++) a->first[v + 2] += a->first[v + 1];
  for (size_t i = 0; i < 2 * a->edge_count; i++) a->neighbour[a->first[a->edges[i] + 1]++] = a->edges[i ^ 1];
}

/* Keeps of each piece of the surface the largest part without a torn edge. */
static void keep_largest(Attachment *a) {
  size_t count = a->mesh->vertex_count;
  uint32_t *largest = a->queue;
  for (uint32_t v = 0; v < count; v++) a->surface[v] = a->part[v] = largest[v] = v;
  for (size_t e = 0; e < a->edge_count; e++) {
    spore_set_join(a->surface, a->edges[2 * e], a->edges[2 * e + 1]);
    if (!is_torn(a, e)) spore_set_join(a->part, a->edges[2 * e], a->edges[2 * e + 1]);
  }
  for (uint32_t v = 0; v < count; v++) a->members[spore_set_find(a->part, v)]++;
  for (uint32_t v = 0; v < count; v++) {
    uint32_t whole = spore_set_find(a->surface, v), part = spore_set_find(a->part, v);
    if (a->members[part] > a->members[largest[whole]]) largest[whole] = part;
  }
  for (uint32_t v = 0; v < count; v++)
    a->kept[v] = spore_set_find(a->part, v) == largest[spore_set_find(a->surface, v)];
}

static void grow(Attachment *a) {
  size_t filled = 0;
  for (uint32_t v = 0; v < a->mesh->vertex_count; v++)
    if (a->kept[v]) a->queue[filled++] = v;
  for (size_t done = 0; done < filled; done++) {
    uint32_t v = a->queue[done];
    for (uint32_t k = a->first[v]; k < a->first[v + 1]; k++) {
      uint32_t w = a->neighbour[k];
      if (a->kept[w]) continue;
      a->kept[w] = true;
      a->place[w] = downhill(a, vertex(a, w), a->place[v]);
      a->queue[filled++] = w;
    }
  }
}

static bool allocate(Attachment *a) {
  size_t count = a->mesh->vertex_count;
  if (!spore_edges_of_triangles(a->mesh->triangles, a->mesh->triangle_count, &a->edges, &a->edge_count)) return false;
  a->length = SPORE_NEW_ARRAY(double, a->curve->count);
  a->first = SPORE_NEW_ARRAY(uint32_t, count + 2);
  a->neighbour = SPORE_NEW_ARRAY(uint32_t, 2 * a->edge_count);
  a->surface = SPORE_NEW_ARRAY(uint32_t, count);
  a->part = SPORE_NEW_ARRAY(uint32_t, count);
  a->members = SPORE_NEW_ARRAY(uint32_t, count);
  a->queue = SPORE_NEW_ARRAY(uint32_t, count);
  a->kept = SPORE_NEW_ARRAY(bool, count);
  return a->length && a->first && a->neighbour && a->surface && a->part && a->members && a->queue && a->kept;
}

static void release(Attachment *a) {
  spore_free(a->edges);
  spore_free(a->length);
  spore_free(a->first);
  spore_free(a->neighbour);
  spore_free(a->surface);
  spore_free(a->part);
  spore_free(a->members);
  spore_free(a->queue);
  spore_free(a->kept);
}

bool spore_curve_attach(const SporeCurve *curve, const SporeTriangleMesh *mesh, uint32_t *place, double *torn) {
  Attachment a = {.curve = curve, .mesh = mesh, .place = place};
  size_t count = 0;
  bool made = allocate(&a);
  if (made) {
    for (size_t i = 1; i < curve->count; i++)
      a.length[i] = a.length[i - 1] + spore_vec3_distance(spore_vec3_load(curve->points + 4 * (i - 1)),
                                                          spore_vec3_load(curve->points + 4 * i));
    for (uint32_t v = 0; v < mesh->vertex_count; v++) place[v] = nearest(&a, vertex(&a, v));
    find_neighbours(&a);
    keep_largest(&a);
    grow(&a);
    for (size_t e = 0; e < a.edge_count; e++) count += is_torn(&a, e);
  }
  *torn = a.edge_count ? (double)count / (double)a.edge_count : 0;
  release(&a);
  return made;
}
