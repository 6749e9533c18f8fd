/* Moves points of the cells onto the surface where the surface passes near to them, so that the surface has fewer and
 * better triangles (Labelle and Shewchuk 2007, "Isosurface stuffing"). */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"
#include "core/mesh/isosurface_parts.h"

#define NEAR 0.3       /* of an edge: where it is crossed so near to an end, the end moves */
#define FLATTEST 0.1   /* of its volume: what a cell must keep */
#define MOST_AROUND 64 /* points around a point that may move */
#define POINTS_A_REPORT 1024

/* The crossed edge on which the surface is nearest to each point, as if the field were linear. */
typedef struct Nearest {
  double *distance; /* m; HUGE_VAL: none is near */
  uint32_t *other;  /* its other end */
} Nearest;

static void look_at_edge(const SporeIsosurfaceCells *cells, const Nearest *nearest, uint32_t a, uint32_t b) {
  const SporeIsosurfacePoint *p = &cells->points[a], *q = &cells->points[b];
  double share = p->value / (p->value - q->value), length = spore_vec3_distance(p->place, q->place);
  if (share > 0.5) {
    uint32_t swap = a;
    a = b, b = swap, share = 1 - share;
  }
  double distance = share * length;
  if (share >= NEAR || distance > nearest->distance[a]) return;
  if (distance == nearest->distance[a] && b >= nearest->other[a]) return;
  nearest->distance[a] = distance, nearest->other[a] = b;
}

static void look_at_cells(const SporeIsosurfaceCells *cells, const Nearest *nearest) {
  for (size_t i = 0; i < cells->point_count; i++) nearest->distance[i] = HUGE_VAL;
  for (size_t i = 0; i < cells->cell_count; i++) {
    const SporeIsosurfaceCell *cell = &cells->cells[i];
    for (int k = 0; cell->tag && k < 4; k++)
      for (int j = 0; j < k; j++)
        if ((cells->points[cell->corner[k]].value < 0) != (cells->points[cell->corner[j]].value < 0))
          look_at_edge(cells, nearest, cell->corner[k], cell->corner[j]);
  }
}

static double volume_of(const SporeIsosurfaceCells *cells, const SporeIsosurfaceCell *cell, bool home) {
  SporeVec3 p[4];
  for (int k = 0; k < 4; k++) {
    const SporeIsosurfacePoint *point = &cells->points[cell->corner[k]];
    p[k] = home && point->on ? cells->home[cell->corner[k]].place : point->place;
  }
  return spore_vec3_dot(spore_vec3_sub(p[1], p[0]),
                        spore_vec3_cross(spore_vec3_sub(p[2], p[0]), spore_vec3_sub(p[3], p[0])));
}

static void take_home(SporeIsosurfaceCells *cells, uint32_t point) {
  if (cells->points[point].on) cells->points[point] = cells->home[point];
}

/* Takes points back until no cell is turned over or nearly flat. */
static void unfold_cells(SporeIsosurfaceCells *cells) {
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < cells->cell_count; i++) {
      const SporeIsosurfaceCell *cell = &cells->cells[i];
      if (!cell->tag) continue;
      double before = volume_of(cells, cell, true), now = volume_of(cells, cell, false);
      if (now / before >= FLATTEST) continue;
      for (int k = 0; k < 4; k++) take_home(cells, cell->corner[k]);
      changed = true;
    }
  }
}

/* The cells around each point: cells[first[p]] .. cells[first[p + 1] - 1]. */
typedef struct Stars {
  size_t *first;
  uint32_t *cells;
} Stars;

static bool make_stars(const SporeIsosurfaceCells *cells, Stars *stars) {
  size_t all = 0;
  stars->first = SPORE_NEW_ARRAY(size_t, cells->point_count + 2);
  if (!stars->first) return false;
  for (size_t i = 0; i < cells->cell_count; i++)
    for (int k = 0; cells->cells[i].tag && k < 4; k++, all++) stars->first[cells->cells[i].corner[k] + 2]++;
  for (size_t p = 2; p < cells->point_count + 2; p++) stars->first[p] += stars->first[p - 1];
  stars->cells = SPORE_NEW_ARRAY(uint32_t, all);
  if (!stars->cells) return false;
  for (size_t i = 0; i < cells->cell_count; i++)
    for (int k = 0; cells->cells[i].tag && k < 4; k++)
      stars->cells[stars->first[cells->cells[i].corner[k] + 1]++] = (uint32_t)i;
  return true;
}

static uint32_t number_of(uint32_t *points, uint32_t *count, uint32_t point) {
  uint32_t at = 0;
  while (at < *count && points[at] != point) at++;
  if (at == *count && at < MOST_AROUND) points[(*count)++] = point;
  return at;
}

/* Whether the points around a point, joined along the cells' edges, are one piece inside and one outside: then the
 * point can be on either side, or between, and what is inside hangs together as before. */
static bool is_simple(const SporeIsosurfaceCells *cells, const Stars *stars, uint32_t point) {
  uint32_t around[MOST_AROUND], set[MOST_AROUND], count = 0, pieces[2] = {0, 0};
  for (uint32_t i = 0; i < MOST_AROUND; i++) set[i] = i;
  for (size_t c = stars->first[point]; c < stars->first[point + 1]; c++) {
    const uint32_t *corner = cells->cells[stars->cells[c]].corner;
    uint32_t at[3], others = 0;
    for (int k = 0; k < 4; k++)
      if (corner[k] != point) at[others++] = number_of(around, &count, corner[k]);
    for (int k = 0; k < 3; k++) {
      const uint32_t one = at[k], other = at[(k + 1) % 3];
      if (one == MOST_AROUND || other == MOST_AROUND) return false;
      if ((cells->points[around[one]].value < 0) == (cells->points[around[other]].value < 0))
        spore_set_join(set, one, other);
    }
  }
  for (uint32_t i = 0; i < count; i++)
    if (spore_set_find(set, i) == i) pieces[cells->points[around[i]].value < 0]++;
  return pieces[0] == 1 && pieces[1] == 1;
}

static bool move_points(SporeIsosurfaceCells *cells, const Nearest *nearest, const Stars *stars,
                        const SporeProgress *progress, SporeError *error) {
  for (uint32_t i = 0; i < cells->point_count; i++) {
    if (i % POINTS_A_REPORT == 0 &&
        !spore_progress_step(progress, (double)i / (double)cells->point_count, _("sampling the depth"), error))
      return false;
    if (nearest->distance[i] == HUGE_VAL || !is_simple(cells, stars, i)) continue;
    cells->points[i].place = spore_isosurface_root(cells, cells->home[i], cells->home[nearest->other[i]]);
    cells->points[i].value = -SPORE_ISOSURFACE_ON * cells->step;
    cells->points[i].on = true;
  }
  return true;
}

bool spore_isosurface_snap(SporeIsosurfaceCells *cells, const SporeProgress *progress, SporeError *error) {
  const size_t count = cells->point_count;
  if (count == 0) return true;
  Nearest nearest = {SPORE_NEW_ARRAY(double, count), SPORE_NEW_ARRAY(uint32_t, count)};
  Stars stars = {NULL, NULL};
  cells->home = SPORE_NEW_ARRAY(SporeIsosurfacePoint, count);
  bool done =
      (nearest.distance && nearest.other && cells->home && make_stars(cells, &stars)) || spore_mesh_no_memory(error);
  if (done) look_at_cells(cells, &nearest);
  if (done) memcpy(cells->home, cells->points, count * sizeof *cells->home);
  done = done && move_points(cells, &nearest, &stars, progress, error);
  if (done) unfold_cells(cells);
  spore_free(nearest.distance);
  spore_free(nearest.other);
  spore_free(stars.first);
  spore_free(stars.cells);
  return done;
}

/* Marks the corners of triangles at edges that have not exactly two triangles; joins those around one vertex. */
static void look_around(const SporeHalfEdges *halves, const uint32_t *triangles, bool *bad, uint32_t *fan) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    const uint32_t one = halves->half[i], other = halves->half[end - 1];
    if (end - i == 2 && triangles[one] != triangles[other]) {
      spore_set_join(fan, one, spore_half_edge_after(other));
      spore_set_join(fan, spore_half_edge_after(one), other);
      continue;
    }
    for (size_t h = i; h < end; h++)
      bad[triangles[halves->half[h]]] = bad[triangles[spore_half_edge_after(halves->half[h])]] = true;
  }
}

/* Marks vertices around which the triangles are no single fan. first: of each vertex, a corner. */
static void look_at_fans(const uint32_t *triangles, size_t corners, bool *bad, uint32_t *fan, uint32_t *first) {
  for (size_t c = 0; c < corners; c++) first[triangles[c]] = spore_set_find(fan, (uint32_t)c);
  for (size_t c = 0; c < corners; c++)
    if (spore_set_find(fan, (uint32_t)c) != first[triangles[c]]) bad[triangles[c]] = true;
}

/* Marks the corners of triangles that are off, of those with a fresh corner. */
static void look_at_distances(const SporeIsosurfaceCells *cells, const SporeTriangleMesh *mesh, const bool *fresh,
                              double tolerance, bool *bad) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    SporeVec3 p[3];
    if (!fresh[n[0]] && !fresh[n[1]] && !fresh[n[2]]) continue;
    for (int k = 0; k < 3; k++) p[k] = spore_mesh_vertex(mesh->vertices, n[k]);
    if (spore_isosurface_is_off(cells, p, tolerance)) bad[n[0]] = bad[n[1]] = bad[n[2]] = true;
  }
}

bool spore_isosurface_unsnap(SporeIsosurfaceCells *cells, const SporeTriangleMesh *mesh, const uint64_t *edges,
                             const bool *fresh, double tolerance, size_t *changed, SporeError *error) {
  const size_t corners = 3 * mesh->triangle_count;
  SporeHalfEdges halves = {0};
  bool *bad = SPORE_NEW_ARRAY(bool, mesh->vertex_count);
  uint32_t *fan = SPORE_NEW_ARRAY(uint32_t, corners), *first = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  bool done = (bad && fan && first && spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) ||
              spore_mesh_no_memory(error);
  *changed = 0;
  for (size_t c = 0; done && c < corners; c++) fan[c] = (uint32_t)c;
  if (done) look_around(&halves, mesh->triangles, bad, fan);
  if (done) look_at_fans(mesh->triangles, corners, bad, fan, first);
  if (done) look_at_distances(cells, mesh, fresh, tolerance, bad);
  for (size_t v = 0; done && v < mesh->vertex_count; v++) {
    const uint32_t point = (uint32_t)edges[v];
    if (!bad[v] || edges[v] >> 32 != point || !cells->points[point].on) continue;
    take_home(cells, point);
    ++*changed;
  }
  spore_half_edges_clear(&halves);
  spore_free(bad);
  spore_free(fan);
  spore_free(first);
  return done;
}
