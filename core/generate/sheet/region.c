/* The patch between the sides: the triangles on one side of them, which have to make a disc. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"
#include "core/mesh/common.h"

#define NONE SPORE_SHEET_NONE

/* Where a triangle lies, seen along the sides. */
typedef enum Part { NOWHERE, LEFT, RIGHT } Part;

typedef struct Parts {
  uint8_t *part;          /* a triangle */
  double area[RIGHT + 1]; /* m^2 */
  bool joined;            /* left and right hang together beside the sides */
} Parts;

static bool refuse(SporeError *error, const char *text) {
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL, "%s", text);
}

/* An edge inside the patch between two places of the same side would leave a triangle without area once that side is
 * straight: it is halved. */
static bool halve_chords(SporeSheetCut *cut, SporeError *error) {
  uint32_t count = (uint32_t)(3 * cut->triangle_count), vertex;
  for (uint32_t h = 0; h < count; h++) {
    uint32_t common = cut->sides[spore_sheet_from(cut, h)] & cut->sides[spore_sheet_to(cut, h)];
    if (common && !cut->side[h] && cut->across[h] != NONE && !spore_sheet_cut_split_edge(cut, h, 0.5, &vertex, error))
      return false;
  }
  return true;
}

static double triangle_area(const SporeSheetCut *cut, size_t t) {
  const uint32_t *corner = cut->triangles + 3 * t;
  return spore_vec3_length(spore_mesh_area_vector(
      spore_sheet_vertex(cut, corner[0]), spore_sheet_vertex(cut, corner[1]), spore_sheet_vertex(cut, corner[2])));
}

/* Fills the part from all its triangles that lie along a side. stack: triangle_count. */
static void fill(const SporeSheetCut *cut, Part part, Parts *parts, uint32_t *stack) {
  size_t count = 0;
  for (uint32_t h = 0; h < 3 * cut->triangle_count; h++) {
    bool begins = part == LEFT ? cut->side[h] >= 1 && cut->side[h] <= 4 : cut->side[h] >= 5;
    if (!begins || parts->part[h / 3] == part) continue;
    parts->joined = parts->joined || parts->part[h / 3] != NOWHERE;
    parts->part[h / 3] = (uint8_t)part;
    stack[count++] = h / 3;
  }
  while (count > 0) {
    uint32_t t = stack[--count];
    parts->area[part] += triangle_area(cut, t);
    for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
      uint32_t over = cut->across[h];
      if (cut->side[h] || over == NONE || parts->part[over / 3] == part) continue;
      parts->joined = parts->joined || parts->part[over / 3] != NOWHERE;
      parts->part[over / 3] = (uint8_t)part;
      stack[count++] = over / 3;
    }
  }
}

static bool find_parts(const SporeSheetCut *cut, Parts *parts, SporeError *error) {
  uint32_t *stack = SPORE_NEW_ARRAY(uint32_t, cut->triangle_count);
  parts->part = SPORE_NEW_ARRAY(uint8_t, cut->triangle_count);
  bool good = stack && parts->part;
  for (Part part = LEFT; good && part <= RIGHT; part++) fill(cut, part, parts, stack);
  spore_free(stack);
  if (!good) return spore_generate_no_memory(error);
  if (!parts->joined) return true;
  return refuse(error, _("the four sides go around a handle of the surface and enclose no part of it; expected a patch "
                         "between them; move the corners nearer to each other"));
}

/* What keeps a part from being a disc. */
typedef enum Fault { WHOLE, OPEN, HANDLE, NO_ROOM } Fault;

/* Vertices - edges + triangles is 1 of a disc; it has no open edges but its sides. */
static Fault find_fault(const SporeSheetCut *cut, const Parts *parts, Part part) {
  bool *seen = SPORE_NEW_ARRAY(bool, cut->vertex_count);
  if (!seen) return NO_ROOM;
  size_t vertices = 0, sides = 0, halves = 0, triangles = 0, open = 0;
  for (uint32_t h = 0; h < 3 * cut->triangle_count; h++) {
    if (parts->part[h / 3] != part) continue;
    uint32_t vertex = cut->triangles[h];
    vertices += !seen[vertex];
    seen[vertex] = true;
    triangles += h % 3 == 0;
    sides += cut->side[h] != 0;
    open += !cut->side[h] && cut->across[h] == NONE;
    halves += !cut->side[h] && cut->across[h] != NONE;
  }
  spore_free(seen);
  return open > 0 ? OPEN : vertices + triangles == 1 + sides + halves / 2 ? WHOLE : HANDLE;
}

static bool refuse_fault(Fault fault, SporeError *error) {
  if (fault == NO_ROOM) return spore_generate_no_memory(error);
  if (fault == OPEN)
    return refuse(error,
                  _("the part between the four sides has holes, or reaches an open edge of the surface; a sheet is "
                    "whole; close the holes, move the corners, or name a place inside the other part"));
  return refuse(error,
                _("the part between the four sides has a handle, or goes around the surface; a sheet can be laid "
                  "out flat; move the corners, or name a place inside the other part"));
}

/* The part with the place inside; else the smaller one, or the one that is a disc where only one is. */
static bool choose(const SporeSheetCut *cut, const SporeSheetOptions *options, const Parts *parts, Part *chosen,
                   SporeError *error) {
  SporeVec3 at;
  if (options->inside_given) {
    *chosen = parts->part[spore_sheet_cut_nearest(cut, spore_vec3_load(options->inside), &at)];
    if (*chosen == NOWHERE)
      return refuse(error,
                    _("the place inside lies on another piece of the surface than the corners; expected a place on "
                      "the patch; move it, or leave it out for the smaller part"));
    Fault fault = find_fault(cut, parts, *chosen);
    return fault == WHOLE || refuse_fault(fault, error);
  }
  bool left = parts->area[LEFT] > 0, right = parts->area[RIGHT] > 0;
  *chosen = left && (!right || parts->area[LEFT] <= parts->area[RIGHT]) ? LEFT : RIGHT;
  Fault fault = find_fault(cut, parts, *chosen);
  if (fault == WHOLE) return true;
  if (left && right && find_fault(cut, parts, *chosen == LEFT ? RIGHT : LEFT) == WHOLE) {
    *chosen = *chosen == LEFT ? RIGHT : LEFT;
    return true;
  }
  return refuse_fault(fault, error);
}

static bool copy_part(const SporeSheetCut *cut, const Parts *parts, Part chosen, SporeTriangleMesh *patch,
                      SporeError *error) {
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, cut->vertex_count);
  if (!number) return spore_generate_no_memory(error);
  size_t vertices = 0, triangles = 0;
  for (size_t h = 0; h < 3 * cut->triangle_count; h++) {
    if (parts->part[h / 3] != chosen) continue;
    triangles += h % 3 == 0;
    if (!number[cut->triangles[h]]) number[cut->triangles[h]] = (uint32_t)++vertices;
  }
  bool made = spore_triangle_mesh_allocate(patch, vertices, triangles, error);
  for (size_t h = 0, to = 0; made && h < 3 * cut->triangle_count; h++) {
    if (parts->part[h / 3] != chosen) continue;
    uint32_t vertex = number[cut->triangles[h]] - 1;
    patch->triangles[to++] = vertex;
    spore_vec3_store(patch->vertices + 3 * (size_t)vertex, spore_sheet_vertex(cut, cut->triangles[h]));
  }
  spore_free(number);
  return made;
}

bool spore_sheet_take_patch(SporeSheetCut *cut, const SporeSheetOptions *options, SporeTriangleMesh *patch,
                            SporeError *error) {
  Parts parts = {0};
  Part chosen = NOWHERE;
  bool good = halve_chords(cut, error) && find_parts(cut, &parts, error) &&
              choose(cut, options, &parts, &chosen, error) && copy_part(cut, &parts, chosen, patch, error);
  spore_free(parts.part);
  return good;
}
