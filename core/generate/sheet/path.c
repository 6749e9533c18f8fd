/* A path over faces: the triangles that it passes are laid flat in a row, and a string is pulled tight in them. Where
 * the string turns about a vertex that has less than half a turn on its other side, the row goes around that other
 * side instead, which makes the path shorter (S. Xin and G. Wang, "Efficiently determining a locally exact shortest
 * path on polyhedral surfaces", 2007). */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"

#define NONE SPORE_SHEET_NONE
#define STRAIGHT 1e-6 /* radians short of half a turn: none */
#define SNAP 0.01     /* of an edge: a path that passes a vertex so near goes through it, and leaves no sliver */
#define HIT 1e-6      /* the same for a vertex of a side that is there already: it is hit */

typedef struct Flat {
  double x, y;
} Flat;

/* A row of triangles. */
typedef struct Row {
  const SporeSheetCut *cut;
  uint32_t from, to;
  size_t count, room;
  uint32_t *crossed;  /* half-edges, each of the triangle that is left over it */
  Flat *left, *right; /* count + 1: their ends, seen in the direction of the path; behind them the end of the path */
  Flat start;
} Row;

/* A bend of the string. */
typedef struct Bend {
  Flat at;
  size_t crossing; /* one of those that have the vertex as an end */
  uint32_t vertex;
  bool on_left;
} Bend;

typedef struct String {
  size_t count, room;
  Bend *bend; /* with the ends of the path */
} String;

static bool push_crossing(Row *row, uint32_t h) {
  uint32_t *crossed = spore_room_for_one(row->crossed, row->count, &row->room, 64, sizeof *crossed);
  if (!crossed) return false;
  row->crossed = crossed;
  crossed[row->count++] = h;
  return true;
}

static bool push_bend(String *string, Bend bend) {
  Bend *bends = spore_room_for_one(string->bend, string->count, &string->room, 64, sizeof *bends);
  if (!bends) return false;
  string->bend = bends;
  bends[string->count++] = bend;
  return true;
}

/* The vertex at the left or right end of a crossing. */
static uint32_t end_of(const Row *row, size_t i, bool left) {
  return left ? spore_sheet_to(row->cut, row->crossed[i]) : spore_sheet_from(row->cut, row->crossed[i]);
}

static bool has_end(const Row *row, size_t i, uint32_t vertex) {
  return end_of(row, i, true) == vertex || end_of(row, i, false) == vertex;
}

/* The row along a path of edges. */

/* From the triangle of *at, a half-edge, about its start until one that has the vertex `ahead`; counter-clockwise or
 * not. False: an open edge lies between, or there is no memory; all is then as before. */
static bool turn_to(Row *row, uint32_t *at, uint32_t ahead, bool left) {
  const SporeSheetCut *cut = row->cut;
  uint32_t h = *at;
  for (size_t begin = row->count;;) {
    if (spore_sheet_to(cut, h) == ahead || spore_sheet_from(cut, spore_sheet_before(h)) == ahead) {
      *at = h;
      return true;
    }
    uint32_t over = left ? spore_sheet_before(h) : h, beyond = cut->across[over];
    if (beyond == NONE || !push_crossing(row, over)) {
      row->count = begin;
      return false;
    }
    h = left ? beyond : spore_sheet_next(beyond);
  }
}

static bool follow(Row *row, const uint32_t *path, size_t count) {
  const SporeSheetCut *cut = row->cut;
  uint32_t h = SPORE_SHEET_NONE;
  spore_sheet_cut_find(cut, path[0], path[1], &h);
  for (size_t i = 1; i + 1 < count; i++) {
    while (spore_sheet_from(cut, h) != path[i]) h = spore_sheet_next(h); /* of the same triangle */
    if (!turn_to(row, &h, path[i + 1], true) && !turn_to(row, &h, path[i + 1], false)) return false;
  }
  return true;
}

/* What is crossed and crossed back goes, and so do triangles about an end that the path leaves by its other edges. */
static void tidy(Row *row) {
  size_t kept = 0, first = 0;
  for (size_t i = 0; i < row->count; i++) {
    if (kept > 0 && row->cut->across[row->crossed[kept - 1]] == row->crossed[i]) kept--;
    else row->crossed[kept++] = row->crossed[i];
  }
  row->count = kept;
  while (first < row->count && has_end(row, first, row->from)) first++;
  while (row->count > first && has_end(row, row->count - 1, row->to)) row->count--;
  row->count -= first;
  memmove(row->crossed, row->crossed + first, row->count * sizeof *row->crossed);
}

/* Laying flat. */

/* A corner beside the edge from a to b: on its left, or on its right. */
static Flat lay(const SporeSheetCut *cut, uint32_t h, Flat a, Flat b, uint32_t corner, bool left) {
  SporeVec3 from = spore_sheet_vertex(cut, spore_sheet_from(cut, h)),
            along = spore_vec3_sub(spore_sheet_vertex(cut, spore_sheet_to(cut, h)), from),
            out = spore_vec3_sub(spore_sheet_vertex(cut, corner), from);
  double length = spore_vec3_length(along), x = spore_vec3_dot(along, out) / length,
         y = spore_vec3_length(spore_vec3_cross(along, out)) / length;
  double ex = (b.x - a.x) / length, ey = (b.y - a.y) / length;
  if (!left) y = -y;
  return (Flat){a.x + x * ex - y * ey, a.y + x * ey + y * ex};
}

static bool lay_row(Row *row) {
  const SporeSheetCut *cut = row->cut;
  spore_free(row->left);
  spore_free(row->right);
  row->left = SPORE_NEW_ARRAY(Flat, row->count + 1), row->right = SPORE_NEW_ARRAY(Flat, row->count + 1);
  if (!row->left || !row->right) return false;
  uint32_t h = row->crossed[0];
  row->left[0].x = spore_vec3_distance(spore_sheet_vertex(cut, spore_sheet_from(cut, h)),
                                       spore_sheet_vertex(cut, spore_sheet_to(cut, h)));
  row->start = lay(cut, h, row->right[0], row->left[0], spore_sheet_from(cut, spore_sheet_before(h)), true);
  for (size_t i = 0; i < row->count; i++) {
    uint32_t over = row->crossed[i], beyond = cut->across[over], far = spore_sheet_before(beyond);
    Flat there = lay(cut, over, row->right[i], row->left[i], spore_sheet_from(cut, far), false);
    row->left[i + 1] = row->left[i], row->right[i + 1] = row->right[i];
    if (i + 1 == row->count) row->left[i + 1] = row->right[i + 1] = there;
    else if (row->crossed[i + 1] == far) row->right[i + 1] = there; /* from the far corner to the left end */
    else row->left[i + 1] = there;
  }
  return true;
}

/* Pulling. */

static double turn(Flat from, Flat a, Flat b) {
  return (a.x - from.x) * (b.y - from.y) - (a.y - from.y) * (b.x - from.x);
}

static bool same(Flat a, Flat b) { return a.x == b.x && a.y == b.y; }

/* The crossings first .. last of the row that have the bend's vertex as the same end. */
static void find_run(const Row *row, const Bend *bend, size_t *first, size_t *last) {
  *first = *last = bend->crossing;
  while (*first > 0 && end_of(row, *first - 1, bend->on_left) == bend->vertex) --*first;
  while (*last + 1 < row->count && end_of(row, *last + 1, bend->on_left) == bend->vertex) ++*last;
}

/* The funnel from a bend: its sides, and the crossings that they go to. */
typedef struct Funnel {
  Flat apex, side[2]; /* 0 right, 1 left */
  size_t at[2];
} Funnel;

/* Narrows the funnel on one side. Returns false where that side has passed the other one, which is then a bend. */
static bool narrow(Funnel *funnel, int side, Flat end, size_t i) {
  double sign = side ? -1 : 1;
  if (sign * turn(funnel->apex, funnel->side[side], end) < 0) return true;
  if (!same(funnel->apex, funnel->side[side]) && sign * turn(funnel->apex, funnel->side[1 - side], end) > 0)
    return false;
  funnel->side[side] = end, funnel->at[side] = i;
  return true;
}

/* The string from the start to the end of the row (the funnel of D. Lee and F. Preparata, 1984). */
static bool pull(const Row *row, String *string) {
  size_t first;
  Funnel funnel = {row->start, {row->right[0], row->left[0]}, {0, 0}};
  string->count = 0;
  if (!push_bend(string, (Bend){.at = row->start, .vertex = row->from})) return false;
  for (size_t i = 1; i <= row->count; i++) {
    const Flat end[2] = {row->right[i], row->left[i]};
    for (int side = 0; side < 2; side++) {
      if (narrow(&funnel, side, end[side], i)) continue;
      Bend bend = {funnel.side[1 - side], funnel.at[1 - side], end_of(row, funnel.at[1 - side], !side), !side};
      if (!push_bend(string, bend)) return false;
      find_run(row, &bend, &first, &i); /* goes on behind the last triangle about the bend */
      funnel = (Funnel){bend.at, {bend.at, bend.at}, {i, i}};
      break;
    }
  }
  return push_bend(string, (Bend){.at = row->left[row->count], .crossing = row->count, .vertex = row->to});
}

/* Turning to the other side of a bend. */

static double angle(Flat from, Flat a, Flat b) {
  double x = (a.x - from.x) * (b.x - from.x) + (a.y - from.y) * (b.y - from.y);
  return fabs(atan2(turn(from, a, b), x));
}

/* Angle about the bend in the row. */
static double angle_in_row(const Row *row, const Bend *bend) {
  size_t first, last;
  find_run(row, bend, &first, &last);
  const Flat *across = bend->on_left ? row->right : row->left;
  double sum = angle(bend->at, bend[-1].at, across[first]) + angle(bend->at, across[last], bend[1].at);
  for (size_t i = first; i < last; i++) sum += angle(bend->at, across[i], across[i + 1]);
  return sum;
}

/* Angle of all triangles about a vertex; infinite at an open edge. */
static double angle_about(const SporeSheetCut *cut, uint32_t vertex) {
  uint32_t first = cut->leaving[vertex], h = first;
  double sum = 0;
  if (cut->across[first] == NONE) return HUGE_VAL;
  SporeVec3 at = spore_sheet_vertex(cut, vertex);
  do {
    SporeVec3 a = spore_vec3_sub(spore_sheet_vertex(cut, spore_sheet_to(cut, h)), at),
              b = spore_vec3_sub(spore_sheet_vertex(cut, spore_sheet_from(cut, spore_sheet_before(h))), at);
    sum += atan2(spore_vec3_length(spore_vec3_cross(a, b)), spore_vec3_dot(a, b));
    h = spore_sheet_turn(cut, h);
  } while (h != first);
  return sum;
}

/* The bend with the least angle on its other side, where that is below half a turn; 0: none. */
static size_t sharpest(const Row *row, const String *string) {
  double least = M_PI - STRAIGHT;
  size_t which = 0;
  for (size_t i = 1; i + 1 < string->count; i++) {
    const Bend *bend = &string->bend[i];
    double other = angle_about(row->cut, bend->vertex) - angle_in_row(row, bend);
    if (other < least) least = other, which = i;
  }
  return which;
}

/* The row goes about the other side of the bend. */
static bool go_around(Row *row, const Bend *bend) {
  const SporeSheetCut *cut = row->cut;
  size_t first, last;
  find_run(row, bend, &first, &last);
  Row made = {.cut = cut, .from = row->from, .to = row->to};
  uint32_t end = cut->across[row->crossed[last]] / 3, h = row->crossed[first];
  bool good = true;
  for (size_t i = 0; good && i < first; i++) good = push_crossing(&made, row->crossed[i]);
  while (good && h / 3 != end) {
    uint32_t over = bend->on_left ? spore_sheet_next(h) : spore_sheet_before(h);
    good = push_crossing(&made, over);
    h = cut->across[over];
  }
  for (size_t i = last + 1; good && i < row->count; i++) good = push_crossing(&made, row->crossed[i]);
  spore_free(good ? row->crossed : made.crossed);
  if (!good) return false;
  row->crossed = made.crossed, row->count = made.count, row->room = made.room;
  tidy(row);
  return true;
}

static bool shorten(Row *row, String *string) {
  size_t limit = 64 * row->count + 1024;
  tidy(row);
  for (size_t round = 0; round < limit && row->count > 0; round++) {
    if (!lay_row(row) || !pull(row, string)) return false;
    size_t which = sharpest(row, string);
    if (!which) return true;
    if (!go_around(row, &string->bend[which])) return false;
  }
  return row->count == 0 || (lay_row(row) && pull(row, string));
}

/* What the string passes. */

typedef struct Stops {
  size_t count, room;
  SporeSheetStop *stop;
} Stops;

static bool push_stop(Stops *stops, SporeSheetStop stop) {
  if (stops->count > 0 && stop.b == NONE) {
    const SporeSheetStop *last = &stops->stop[stops->count - 1];
    if (last->b == NONE && last->a == stop.a) return true;
  }
  SporeSheetStop *grown = spore_room_for_one(stops->stop, stops->count, &stops->room, 64, sizeof *grown);
  if (!grown) return false;
  stops->stop = grown;
  grown[stops->count++] = stop;
  return true;
}

static bool pass(const Row *row, Stops *stops, const Bend *piece, size_t i) {
  const SporeSheetCut *cut = row->cut;
  uint32_t a = end_of(row, i, false), b = end_of(row, i, true);
  double right = turn(piece[0].at, piece[1].at, row->right[i]), left = turn(piece[0].at, piece[1].at, row->left[i]);
  double share = left > right ? fmin(fmax(-right / (left - right), 0), 1) : 0.5;
  if (share < (cut->sides[a] ? HIT : SNAP)) return push_stop(stops, (SporeSheetStop){a, NONE, 0});
  if (share > 1 - (cut->sides[b] ? HIT : SNAP)) return push_stop(stops, (SporeSheetStop){b, NONE, 0});
  return push_stop(stops, (SporeSheetStop){a, b, share});
}

static bool list_stops(const Row *row, const String *string, Stops *stops) {
  bool good = push_stop(stops, (SporeSheetStop){row->from, NONE, 0});
  for (size_t k = 0; good && row->count > 0 && k + 1 < string->count; k++) {
    const Bend *piece = &string->bend[k];
    for (size_t i = piece[0].crossing; good && i < row->count && i <= piece[1].crossing; i++)
      if (!has_end(row, i, piece[0].vertex) && !has_end(row, i, piece[1].vertex)) good = pass(row, stops, piece, i);
    good = good && push_stop(stops, (SporeSheetStop){piece[1].vertex, NONE, 0});
  }
  return good && push_stop(stops, (SporeSheetStop){row->to, NONE, 0});
}

bool spore_sheet_straighten(const SporeSheetCut *cut, const uint32_t *path, size_t count, SporeSheetStop **stops,
                            size_t *stop_count, SporeError *error) {
  Row row = {.cut = cut, .from = path[0], .to = path[count - 1]};
  String string = {0};
  Stops made = {0};
  bool good = follow(&row, path, count) && shorten(&row, &string) && list_stops(&row, &string, &made);
  spore_free(row.crossed);
  spore_free(row.left);
  spore_free(row.right);
  spore_free(string.bend);
  if (good) *stops = made.stop, *stop_count = made.count;
  else spore_free(made.stop);
  return good || spore_generate_no_memory(error);
}
