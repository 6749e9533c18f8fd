/* The outline of an open sheet, and its four corners. */
#include "core/mesh/sheet_outline.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/math/mat3.h"
#include "core/mesh/half_edges.h"

#define NONE UINT32_MAX
#define SAME 1e-9 /* relative: what rounding may make of equal lengths */

static SporeVec3 vertex_at(const SporeTriangleMesh *mesh, uint32_t i) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)i);
}

static bool refuse(SporeError *error, const char *text) {
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL, "%s", text);
}

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
}

static bool check_topology(const SporeTriangleMesh *mesh, size_t *boundary_edges, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report(mesh, &report, error)) return false;
  *boundary_edges = report.boundary_edges;
  if (report.degenerate_triangles > 0)
    return refuse(error, _("some triangles have no area; clean the mesh (merge its double vertices)"));
  if (report.boundary_edges == 0)
    return refuse(error, _("the surface is closed; a sheet has an edge all around; give the body an open sheet, or "
                           "another mechanical model"));
  if (report.components != 1)
    return refuse(error, _("the surface is in several pieces; a sheet is one; keep one of them a body"));
  if (report.nonmanifold_edges > 0)
    return refuse(error, _("more than two triangles meet at an edge; a sheet does not branch; clean the mesh"));
  return true;
}

static bool before(SporeVec3 a, SporeVec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

/* Each vertex's two neighbours along the outline. False: an outline that touches itself. */
static bool link_edge(uint32_t *neighbours, uint32_t a, uint32_t b) {
  assert(a != b);
  for (int end = 0; end < 2; end++) {
    uint32_t *list = neighbours + 2 * (size_t)(end ? b : a), other = end ? a : b;
    if (list[0] == NONE) list[0] = other;
    else if (list[1] == NONE) list[1] = other;
    else return false;
  }
  return true;
}

/* Links the ends of every edge that one triangle alone has. False: no memory. */
static bool link_boundary(const SporeTriangleMesh *mesh, uint32_t *neighbours, bool *simple) {
  SporeHalfEdges halves;
  if (!spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) return false;
  memset(neighbours, 0xff, 2 * mesh->vertex_count * sizeof *neighbours);
  *simple = true;
  for (size_t begin = 0, end; begin < halves.count; begin = end) {
    end = spore_half_edges_end(&halves, begin);
    if (end == begin + 1)
      *simple = *simple && link_edge(neighbours, (uint32_t)(halves.edge[begin] >> 32), (uint32_t)halves.edge[begin]);
  }
  spore_half_edges_clear(&halves);
  return true;
}

/* From the least point on, until the way comes back. */
static void walk(SporeSheetOutline *outline, const uint32_t *neighbours, size_t limit) {
  const SporeTriangleMesh *mesh = outline->mesh;
  uint32_t start = NONE;
  for (uint32_t i = 0; i < mesh->vertex_count; i++)
    if (neighbours[2 * (size_t)i] != NONE && (start == NONE || before(vertex_at(mesh, i), vertex_at(mesh, start))))
      start = i;
  uint32_t last = NONE, here = start;
  do {
    const uint32_t *next = neighbours + 2 * (size_t)here;
    outline->vertex[outline->count++] = here;
    uint32_t from = last;
    last = here, here = next[0] == from ? next[1] : next[0];
  } while (here != start && outline->count < limit);
}

static bool make_outline(SporeSheetOutline *outline, size_t boundary_edges, SporeError *error) {
  uint32_t *neighbours = SPORE_NEW_ARRAY(uint32_t, 2 * outline->mesh->vertex_count);
  outline->vertex = SPORE_NEW_ARRAY(uint32_t, boundary_edges);
  outline->at = SPORE_NEW_ARRAY(double, 2 * boundary_edges);
  bool simple = false,
       made = neighbours && outline->vertex && outline->at && link_boundary(outline->mesh, neighbours, &simple);
  if (made && simple) walk(outline, neighbours, boundary_edges);
  spore_free(neighbours);
  if (!made) return no_memory(error);
  if (!simple || outline->count != boundary_edges)
    return refuse(error, _("the sheet has holes, or its edge touches itself; a spline needs one edge all around; close "
                           "the holes or use a mass-spring net"));
  return true;
}

/* The greater of two axes' reach along x, y and z: which one comes first where both are as good. */
static double rank(SporeVec3 a) { return 4 * fabs(a.x) + 2 * fabs(a.y) + fabs(a.z); }

static SporeVec3 signed_axis(SporeVec3 a) {
  double most = fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))) * (1 - SAME);
  double lead = fabs(a.x) >= most ? a.x : fabs(a.y) >= most ? a.y : a.z;
  return lead < 0 ? spore_vec3_scale(-1, a) : a;
}

/* Across the plane nearest to the vertices of the triangles. */
static SporeVec3 plane_normal(const SporeTriangleMesh *mesh) {
  SporeVec3 first = vertex_at(mesh, mesh->triangles[0]), mean = {0, 0, 0};
  size_t corners = 3 * mesh->triangle_count;
  for (size_t i = 0; i < corners; i++)
    mean = spore_vec3_add_scaled(mean, 1 / (double)corners, spore_vec3_sub(vertex_at(mesh, mesh->triangles[i]), first));
  SporeMat3 square = {{0}}, axes;
  double value[3];
  for (size_t i = 0; i < corners; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_sub(vertex_at(mesh, mesh->triangles[i]), first), mean);
    square = spore_mat3_add(square, spore_mat3_outer(arm, arm));
  }
  spore_mat3_eigen_symmetric(square, value, &axes);
  return signed_axis(spore_mat3_column(axes, 0));
}

/* Extent of the outline along an axis. */
static double extent(const SporeSheetOutline *outline, SporeVec3 axis, double *least) {
  double most = -HUGE_VAL;
  *least = HUGE_VAL;
  for (size_t i = 0; i < outline->count; i++) {
    double at = spore_vec3_dot(axis, vertex_at(outline->mesh, outline->vertex[i]));
    *least = fmin(*least, at), most = fmax(most, at);
  }
  return most - *least;
}

/* The narrowest rectangle around the outline has a side along one of its edges, or nearly so. */
static bool find_axes(SporeSheetOutline *outline, double *least_u, double *least_v, double *long_side,
                      double *short_side) {
  double best = HUGE_VAL, unused;
  outline->normal = plane_normal(outline->mesh);
  for (size_t i = 0; i < outline->count; i++) {
    SporeVec3 edge = spore_vec3_sub(vertex_at(outline->mesh, outline->vertex[(i + 1) % outline->count]),
                                    vertex_at(outline->mesh, outline->vertex[i]));
    edge = spore_vec3_add_scaled(edge, -spore_vec3_dot(edge, outline->normal), outline->normal);
    if (!(spore_vec3_dot(edge, edge) > 0)) continue;
    SporeVec3 along = spore_vec3_normalise(edge, edge), across = spore_vec3_cross(outline->normal, along);
    double area = extent(outline, along, &unused) * extent(outline, across, &unused);
    if (area < best * (1 - SAME)) best = area, outline->u = along, outline->v = across;
  }
  if (!(best > 0 && best < HUGE_VAL)) return false;
  double a = extent(outline, outline->u, &unused), b = extent(outline, outline->v, &unused);
  bool alike = fabs(a - b) <= 1e-6 * a;
  if (alike ? rank(outline->v) > rank(outline->u) : b > a) outline->u = outline->v;
  outline->u = signed_axis(outline->u);
  outline->v = spore_vec3_cross(outline->normal, outline->u);
  *long_side = extent(outline, outline->u, least_u);
  *short_side = extent(outline, outline->v, least_v);
  return true;
}

/* The outline in the rectangle of its axes, 0 to 1 each way, counter-clockwise. False: it has no area there. */
static bool lay_flat(SporeSheetOutline *outline) {
  double least_u, least_v, size_u, size_v, area = 0;
  if (!find_axes(outline, &least_u, &least_v, &size_u, &size_v)) return false;
  size_t n = outline->count;
  for (size_t i = 0; i < n; i++) {
    SporeVec3 p = vertex_at(outline->mesh, outline->vertex[i]);
    outline->at[2 * i] = (spore_vec3_dot(outline->u, p) - least_u) / size_u;
    outline->at[2 * i + 1] = (spore_vec3_dot(outline->v, p) - least_v) / size_v;
  }
  for (size_t i = 0; i < n; i++) {
    const double *a = outline->at + 2 * i, *b = outline->at + 2 * ((i + 1) % n);
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  for (size_t i = 0; area < 0 && i < n / 2; i++) {
    uint32_t vertex = outline->vertex[i];
    outline->vertex[i] = outline->vertex[n - 1 - i], outline->vertex[n - 1 - i] = vertex;
    for (size_t k = 0; k < 2; k++) {
      double at = outline->at[2 * i + k];
      outline->at[2 * i + k] = outline->at[2 * (n - 1 - i) + k], outline->at[2 * (n - 1 - i) + k] = at;
    }
  }
  return fabs(area) > 0.05; /* of the rectangle */
}

/* Where in the outline the corners (0, 0), (1, 0), (1, 1), (0, 1) are. False: not four, one after the other. */
static bool find_corners(const SporeSheetOutline *outline, size_t corner[4]) {
  static const double way[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (size_t c = 0; c < 4; c++) {
    double best = -HUGE_VAL;
    for (size_t i = 0; i < outline->count; i++) {
      double reach = way[c][0] * outline->at[2 * i] + way[c][1] * outline->at[2 * i + 1];
      if (reach > best + SAME) best = reach, corner[c] = i;
    }
  }
  size_t last = 0;
  for (size_t c = 1; c < 4; c++) {
    size_t ahead = (corner[c] + outline->count - corner[0]) % outline->count;
    if (ahead <= last) return false;
    last = ahead;
  }
  return true;
}

/* Sides of the square between corners, by length. */
static void set_outline(const SporeSheetOutline *outline, const size_t corner[4], double *parameters) {
  static const double start[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  size_t n = outline->count;
  for (size_t side = 0; side < 4; side++) {
    const double *from = start[side], *to = start[(side + 1) % 4];
    size_t edges = (corner[(side + 1) % 4] + n - corner[side]) % n;
    double whole = 0, done = 0;
    for (int pass = 0; pass < 2; pass++)
      for (size_t k = 0; k < edges; k++) {
        uint32_t a = outline->vertex[(corner[side] + k) % n], b = outline->vertex[(corner[side] + k + 1) % n];
        double length = spore_vec3_distance(vertex_at(outline->mesh, a), vertex_at(outline->mesh, b));
        if (pass == 0) whole += length;
        else {
          for (size_t e = 0; e < 2; e++) parameters[2 * (size_t)a + e] = from[e] + done / whole * (to[e] - from[e]);
          done += length;
        }
      }
  }
}

bool spore_sheet_outline_create(SporeSheetOutline *outline, const SporeTriangleMesh *mesh, SporeError *error) {
  size_t boundary_edges;
  *outline = (SporeSheetOutline){.mesh = mesh};
  return check_topology(mesh, &boundary_edges, error) && make_outline(outline, boundary_edges, error);
}

void spore_sheet_outline_clear(SporeSheetOutline *outline) {
  spore_free(outline->vertex);
  spore_free(outline->at);
  *outline = (SporeSheetOutline){0};
}

/* Corners that are given. */

/* Turns the outline the way in which its triangles run along it. */
static void follow_triangles(SporeSheetOutline *outline) {
  const SporeTriangleMesh *mesh = outline->mesh;
  uint32_t a = outline->vertex[0], b = outline->vertex[1];
  for (size_t h = 0; h < 3 * mesh->triangle_count; h++)
    if (mesh->triangles[h] == a && mesh->triangles[h % 3 == 2 ? h - 2 : h + 1] == b) return;
  for (size_t i = 0; i < outline->count / 2; i++) {
    uint32_t vertex = outline->vertex[i];
    outline->vertex[i] = outline->vertex[outline->count - 1 - i], outline->vertex[outline->count - 1 - i] = vertex;
  }
}

static size_t nearest(const SporeSheetOutline *outline, SporeVec3 p) {
  size_t best = 0;
  for (size_t i = 1; i < outline->count; i++)
    if (spore_vec3_distance(p, vertex_at(outline->mesh, outline->vertex[i])) <
        spore_vec3_distance(p, vertex_at(outline->mesh, outline->vertex[best])))
      best = i;
  return best;
}

/* Length of the outline from one of its places to another. */
static double length_between(const SporeSheetOutline *outline, size_t from, size_t to) {
  double length = 0;
  for (size_t i = from; i != to; i = (i + 1) % outline->count)
    length += spore_vec3_distance(vertex_at(outline->mesh, outline->vertex[i]),
                                  vertex_at(outline->mesh, outline->vertex[(i + 1) % outline->count]));
  return length;
}

/* The vertices nearest to the given corners, in the outline's turn. The first one is (0, 0), or the one after it, so
 * that u runs along the longer two sides. False: they are not four, in turn either way. */
static bool take_corners(SporeSheetOutline *outline, const double *corners, size_t corner[4]) {
  size_t n = outline->count, ahead[4], rising = 0, falling = 0;
  follow_triangles(outline);
  for (size_t c = 0; c < 4; c++) corner[c] = nearest(outline, spore_vec3_load(corners + 3 * c));
  for (size_t c = 1; c < 4; c++) {
    ahead[c] = (corner[c] + n - corner[0]) % n;
    rising += c == 1 ? ahead[c] > 0 : ahead[c] > ahead[c - 1];
    falling += ahead[c] > 0 && (c == 1 || ahead[c] < ahead[c - 1]);
  }
  if (rising < 3 && falling < 3) return false;
  if (falling == 3) {
    size_t other = corner[1];
    corner[1] = corner[3], corner[3] = other;
  }
  double side[4];
  for (size_t c = 0; c < 4; c++) side[c] = length_between(outline, corner[c], corner[(c + 1) % 4]);
  size_t first = corner[0];
  if (side[0] + side[2] >= side[1] + side[3]) return true;
  for (size_t c = 0; c < 3; c++) corner[c] = corner[c + 1];
  corner[3] = first;
  return true;
}

bool spore_sheet_outline_square(SporeSheetOutline *outline, const double *corners, double *parameters,
                                SporeError *error) {
  assert(outline->count > 0);
  size_t corner[4] = {0};
  if (corners) {
    if (!take_corners(outline, corners, corner))
      return refuse(error,
                    _("the four corners that are given do not follow each other around the sheet's edge; expected "
                      "four places along it, one after the other; correct them, or leave them out"));
  } else if (!lay_flat(outline) || !find_corners(outline, corner))
    return refuse(error, _("no four corners can be told apart along the sheet's edge; a spline's sheet is roughly a "
                           "rectangle, however it is curved; cut the mesh so, or use a mass-spring net"));
  set_outline(outline, corner, parameters);
  return true;
}
