/* The corners and sides of a patch: corners become vertices of the surface, and the surface is cut along the sides. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"
#include "core/mesh/common.h"

#define NONE SPORE_SHEET_NONE
#define SNAP 0.02    /* of a triangle: a corner so near to a vertex or an edge lies on it */
#define ON_EDGE 0.01 /* of the diagonal: a corner so near to an open edge lies on it */
#define FAR 0.5      /* of its diagonal: a place so far from the surface is not meant to lie on it */

/* Corners. */

/* A vertex at this share of the half-edge. */
static bool vertex_on_edge(SporeSheetCut *cut, uint32_t h, double share, uint32_t *vertex, SporeError *error) {
  if (share <= SNAP) *vertex = spore_sheet_from(cut, h);
  else if (share >= 1 - SNAP) *vertex = spore_sheet_to(cut, h);
  else return spore_sheet_cut_split_edge(cut, h, share, vertex, error);
  return true;
}

/* A vertex at a place in the triangle. */
static bool vertex_in_triangle(SporeSheetCut *cut, uint32_t triangle, SporeVec3 at, uint32_t *vertex,
                               SporeError *error) {
  SporeVec3 corner[3];
  double weight[3], sum = 0;
  for (uint32_t k = 0; k < 3; k++) corner[k] = spore_sheet_vertex(cut, cut->triangles[3 * triangle + k]);
  for (int k = 0; k < 3; k++) { /* areas opposite to the corners */
    weight[k] = spore_vec3_length(spore_mesh_area_vector(at, corner[(k + 1) % 3], corner[(k + 2) % 3]));
    sum += weight[k];
  }
  for (uint32_t k = 0; k < 3; k++) {
    uint32_t h = 3 * triangle + (k + 1) % 3; /* the edge opposite to corner k */
    if (weight[k] > SNAP * sum) continue;
    double far = weight[(k + 2) % 3], all = far + weight[(k + 1) % 3];
    return vertex_on_edge(cut, h, all > 0 ? far / all : 0, vertex, error);
  }
  return spore_sheet_cut_split_triangle(cut, triangle, at, vertex, error);
}

/* The open half-edge nearest to a point, and where; NONE: the surface has none within `reach`. */
static uint32_t nearest_open_edge(const SporeSheetCut *cut, SporeVec3 p, double reach, double *share) {
  uint32_t best = NONE;
  for (uint32_t h = 0; h < 3 * cut->triangle_count; h++) {
    if (cut->across[h] != NONE) continue;
    SporeVec3 from = spore_sheet_vertex(cut, spore_sheet_from(cut, h)),
              along = spore_vec3_sub(spore_sheet_vertex(cut, spore_sheet_to(cut, h)), from);
    double at = spore_vec3_dot(spore_vec3_sub(p, from), along) / spore_vec3_dot(along, along);
    at = fmin(fmax(at, 0), 1);
    double distance = spore_vec3_distance(p, spore_vec3_add_scaled(from, at, along));
    if (distance <= reach) reach = distance, best = h, *share = at;
  }
  return best;
}

static bool is_near(double distance, double diagonal, size_t k, SporeError *error) {
  if (distance <= FAR * diagonal) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("corner %zu lies %.3g m off the surface, which measures %.3g m across; expected a place on "
                           "the surface or near it, in metres; move it"),
                         k + 1, distance, diagonal);
}

static bool place_corners(SporeSheetCut *cut, const SporeSheetOptions *options, uint32_t corner[4],
                          SporeSheetReport *report, SporeError *error) {
  double diagonal = spore_mesh_diagonal(cut->vertices, cut->vertex_count, 3), reach = ON_EDGE * diagonal;
  for (size_t k = 0; k < 4; k++) {
    SporeVec3 given = spore_vec3_load(options->corners[k]), at = {0, 0, 0};
    double share = 0;
    uint32_t triangle = spore_sheet_cut_nearest(cut, given, &at), open = nearest_open_edge(cut, at, reach, &share);
    if (!is_near(spore_vec3_distance(given, at), diagonal, k, error)) return false;
    if (!(open != NONE ? vertex_on_edge(cut, open, share, &corner[k], error)
                       : vertex_in_triangle(cut, triangle, at, &corner[k], error)))
      return false;
    for (size_t other = 0; other < k; other++)
      if (corner[other] == corner[k])
        return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                               _("corners %zu and %zu come to lie at the same place of the surface; expected four "
                                 "places around a patch; move one of them"),
                               other + 1, k + 1);
    at = spore_sheet_vertex(cut, corner[k]);
    spore_vec3_store(report->corners[k], at);
    report->corner_distance[k] = spore_vec3_distance(given, at);
  }
  for (size_t k = 0; k < 4; k++) cut->sides[corner[k]] = (uint8_t)(1 << k | 1 << (k + 3) % 4);
  return true;
}

/* Sides. */

static bool refuse_touch(size_t side, SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the side from corner %zu to corner %zu meets another side or corner on its way; expected "
                           "sides that meet in corners alone; give the corners in turn around the patch, or move "
                           "them apart"),
                         side + 1, (side + 1) % 4 + 1);
}

/* Marks the edge from a to b as part of a side: 1 + side where the side runs so, 5 + side on the other half-edge. */
static bool mark(SporeSheetCut *cut, size_t side, uint32_t a, uint32_t b, SporeSheetReport *report, SporeError *error) {
  uint32_t h;
  if (!spore_sheet_cut_find(cut, a, b, &h) || cut->side[h]) return refuse_touch(side, error);
  bool along = spore_sheet_from(cut, h) == a;
  uint32_t other = cut->across[h];
  cut->side[h] = (uint8_t)(along ? 1 + side : 5 + side);
  if (other != NONE) cut->side[other] = (uint8_t)(along ? 5 + side : 1 + side);
  cut->sides[a] |= (uint8_t)(1 << side), cut->sides[b] |= (uint8_t)(1 << side);
  report->side[side] += spore_vec3_distance(spore_sheet_vertex(cut, a), spore_sheet_vertex(cut, b));
  return true;
}

static bool mark_path(SporeSheetCut *cut, size_t side, const uint32_t *path, size_t count, SporeSheetReport *report,
                      SporeError *error) {
  for (size_t i = 1; i + 1 < count; i++)
    if (cut->sides[path[i]]) return refuse_touch(side, error);
  for (size_t i = 0; i + 1 < count; i++)
    if (!mark(cut, side, path[i], path[i + 1], report, error)) return false;
  return true;
}

/* Makes the places where the path crosses edges vertices of the path. False: an edge is part of another side, or the
 * path crosses an edge twice. */
static bool cut_stops(SporeSheetCut *cut, size_t side, SporeSheetStop *stops, size_t count, SporeError *error) {
  for (size_t i = 0; i < count; i++) {
    if (stops[i].b == NONE) continue;
    uint32_t h;
    if (!spore_sheet_cut_find(cut, stops[i].a, stops[i].b, &h) || cut->side[h]) return refuse_touch(side, error);
    double share = spore_sheet_from(cut, h) == stops[i].a ? stops[i].share : 1 - stops[i].share;
    if (!spore_sheet_cut_split_edge(cut, h, share, &stops[i].a, error)) return false;
    stops[i].b = NONE;
  }
  return true;
}

static bool cut_across(SporeSheetCut *cut, size_t side, const uint32_t *path, size_t path_count,
                       SporeSheetReport *report, SporeError *error) {
  SporeSheetStop *stops = NULL;
  size_t count = 0;
  bool good =
      spore_sheet_straighten(cut, path, path_count, &stops, &count, error) && cut_stops(cut, side, stops, count, error);
  uint32_t *line = good ? SPORE_NEW_ARRAY(uint32_t, count) : NULL;
  if (good && !line) good = spore_generate_no_memory(error);
  for (size_t i = 0; good && i < count; i++) line[i] = stops[i].a;
  good = good && mark_path(cut, side, line, count, report, error);
  spore_free(line);
  spore_free(stops);
  return good;
}

/* Open edges. */

/* Vertices of the open edge from a on until b: *count of them, from spore_allocate; *passes: some corner lies between.
 * *path NULL: b is not on it. False: no memory. */
static bool along_open_edge(const SporeSheetCut *cut, uint32_t a, uint32_t b, uint32_t **path, size_t *count,
                            bool *passes, SporeError *error) {
  size_t room = 0;
  *path = NULL, *count = 0, *passes = false;
  for (uint32_t v = a; cut->across[cut->leaving[v]] == NONE;) {
    uint32_t *grown = spore_room_for_one(*path, *count, &room, 64, sizeof *grown);
    if (!grown) return spore_generate_no_memory(error);
    *path = grown;
    grown[(*count)++] = v;
    if (v == b && *count > 1) return true;
    if (*count > 1) *passes = *passes || cut->sides[v];
    v = spore_sheet_to(cut, cut->leaving[v]);
    if (v == a) break;
  }
  spore_free(*path);
  *path = NULL, *count = 0;
  return true;
}

static double length_of(const SporeSheetCut *cut, const uint32_t *path, size_t count) {
  double length = 0;
  for (size_t i = 0; i + 1 < count; i++)
    length += spore_vec3_distance(spore_sheet_vertex(cut, path[i]), spore_sheet_vertex(cut, path[i + 1]));
  return length;
}

/* The way along an open edge that has both corners: the one that passes no other corner, else the shorter one;
 * NULL: there is none. False: no memory. */
static bool find_open_edge(const SporeSheetCut *cut, uint32_t a, uint32_t b, uint32_t **path, size_t *count,
                           SporeError *error) {
  uint32_t *back = NULL;
  size_t back_count = 0;
  bool passes, back_passes;
  if (!along_open_edge(cut, a, b, path, count, &passes, error)) return false;
  if (!*path) return true;
  if (!along_open_edge(cut, b, a, &back, &back_count, &back_passes, error)) {
    spore_free(back);
    return false;
  }
  bool other = passes != back_passes ? passes : length_of(cut, back, back_count) < length_of(cut, *path, *count);
  if (other) {
    spore_free(*path);
    *path = back, *count = back_count;
    for (size_t i = 0; i < back_count / 2; i++) {
      uint32_t vertex = back[i];
      back[i] = back[back_count - 1 - i], back[back_count - 1 - i] = vertex;
    }
  } else spore_free(back);
  return true;
}

static bool cut_side(SporeSheetCut *cut, size_t side, uint32_t a, uint32_t b, SporeSheetReport *report,
                     SporeError *error) {
  uint32_t *path = NULL;
  size_t count = 0;
  bool good = find_open_edge(cut, a, b, &path, &count, error);
  if (good && path) {
    report->follows_edge[side] = true;
    good = mark_path(cut, side, path, count, report, error);
  } else if (good) {
    good = spore_sheet_find_path(cut, a, b, &path, &count, error);
    if (good && !path)
      good = spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("corners %zu and %zu lie on pieces of the surface that do not hang together; expected "
                               "all four on one piece; move them, or weld the pieces"),
                             side + 1, (side + 1) % 4 + 1);
    good = good && cut_across(cut, side, path, count, report, error);
  }
  spore_free(path);
  return good;
}

bool spore_sheet_cut_sides(SporeSheetCut *cut, const SporeSheetOptions *options, SporeSheetReport *report,
                           SporeError *error) {
  uint32_t corner[4];
  if (!place_corners(cut, options, corner, report, error)) return false;
  for (size_t k = 0; k < 4; k++)
    if (!cut_side(cut, k, corner[k], corner[(k + 1) % 4], report, error)) return false;
  return true;
}
