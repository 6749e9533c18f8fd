/* Rows of a coupled preconditioner: which couplings it holds, and how much the bodies give way there. */
#include "core/sim/solve/coupled_rows.h"

#include <assert.h>
#include <string.h>

#define MOVED 0.2 /* of the weights and levers of a coupling: beyond, its row is another */

typedef SporeCoupledPart Part;
typedef SporeCoupledRow Row;

static size_t add_end(const SporeCoupledEnd *end, unsigned char kind, double sign, Part *part, size_t room) {
  if (kind == SPORE_COUPLED_NOTHING) return 0;
  if (kind != SPORE_COUPLED_POINT) {
    if (room == 0) return SIZE_MAX;
    *part = (Part){.v = (uint32_t)end->v, .turns = kind == SPORE_COUPLED_RIGID, .weight = sign};
    if (part->turns) memcpy(part->lever, end->lever, sizeof part->lever);
    return 1;
  }
  const SporeMapping *mapping = end->end->mapping;
  uint32_t first = mapping->row_start[end->end->point], last = mapping->row_start[end->end->point + 1];
  if (last - first > room) return SIZE_MAX;
  for (uint32_t k = first; k < last; k++)
    *part++ = (Part){.v = (uint32_t)end->v + 3 * mapping->block[k], .weight = sign * mapping->weight[k]};
  return last - first;
}

/* False: it hangs on more blocks than there is room for. */
static bool set_row(Row *row, const SporeCoupling *coupling) {
  row->part_count = 0;
  size_t a = add_end(&coupling->a, coupling->kind_a, 1, row->part, SPORE_COUPLED_ENDS);
  if (a == SIZE_MAX) return false;
  size_t b = add_end(&coupling->b, coupling->kind_b, -1, row->part + a, SPORE_COUPLED_ENDS - a);
  if (b == SIZE_MAX) return false;
  row->part_count = (uint32_t)(a + b);
  return true;
}

static inline bool lies_in(const Part *part, size_t from, size_t to) { return part->v >= from && part->v < to; }

static bool touches(const Row *row, size_t from, size_t to) {
  for (uint32_t p = 0; p < row->part_count; p++)
    if (lies_in(&row->part[p], from, to)) return true;
  return false;
}

/* J x, of the blocks of v between `from` and `to`; x begins with that at `from`. */
static SporeVec3 motion_of(const Row *row, size_t from, size_t to, const double *x) {
  SporeVec3 sum = {0, 0, 0};
  for (uint32_t p = 0; p < row->part_count; p++) {
    const Part *part = &row->part[p];
    if (!lies_in(part, from, to)) continue;
    SporeVec3 u = spore_vec3_load(x + part->v - from);
    if (part->turns)
      u = spore_vec3_add(u, spore_vec3_cross(spore_vec3_load(x + part->v - from + 3), spore_vec3_load(part->lever)));
    sum = spore_vec3_add_scaled(sum, part->weight, u);
  }
  return sum;
}

/* y += J^T force, likewise. */
static void push(const Row *row, size_t from, size_t to, SporeVec3 force, double *y) {
  for (uint32_t p = 0; p < row->part_count; p++) {
    const Part *part = &row->part[p];
    if (!lies_in(part, from, to)) continue;
    SporeVec3 share = spore_vec3_scale(part->weight, force);
    spore_vec3_accumulate(y + part->v - from, share);
    if (part->turns)
      spore_vec3_accumulate(y + part->v - from + 3, spore_vec3_cross(spore_vec3_load(part->lever), share));
  }
}

SporeVec3 spore_coupled_row_motion(const Row *row, const double *x) { return motion_of(row, 0, SIZE_MAX, x); }

void spore_coupled_row_push(const Row *row, SporeVec3 force, double *y) { push(row, 0, SIZE_MAX, force, y); }

/* A group of columns of G: of coupling `row[lane]` along the axis `axis[lane]`. */
typedef struct Group {
  size_t count;
  uint32_t row[SPORE_LANES];
  uint32_t axis[SPORE_LANES];
} Group;

/* Adds what the body makes of these columns of G, and of the rows that mirror them. */
static void add_group(const SporeIslandSystem *system, SporeCoupledRoom *room, SporeBody *body, size_t from,
                      const Group *group) {
  size_t n = 3 * body->block_count, to = from + n;
  double *vectors = spore_island_system_lanes(system, from);
  const double *inverse = spore_island_system_precondition_blocks(system) + 3 * from;
  memset(vectors, 0, SPORE_LANES * n * sizeof *vectors);
  for (size_t lane = 0; lane < group->count; lane++) {
    double unit[3] = {0, 0, 0}, *x = vectors + lane * n;
    unit[group->axis[lane]] = 1;
    push(&room->row[group->row[lane]], from, to, spore_vec3_load(unit), x);
    spore_pin_filter(body->held.blocks, body->held.count, x);
    if (!spore_island_system_has_factor(system, body)) spore_blocks_apply(inverse, body->block_count, x, x);
  }
  if (spore_island_system_has_factor(system, body))
    spore_block_cholesky_solve_many(&body->preconditioner.factor, vectors, n);
  for (size_t lane = 0; lane < group->count; lane++) {
    size_t column = 3 * group->row[lane] + group->axis[lane];
    spore_pin_filter(body->held.blocks, body->held.count, vectors + lane * n);
    for (size_t i = 0; i < room->count; i++) {
      if (!touches(&room->row[i], from, to)) continue;
      double u[3];
      spore_vec3_store(u, motion_of(&room->row[i], from, to, vectors + lane * n));
      for (size_t e = 0; e < 3; e++) {
        room->flexibility[(3 * i + e) * SPORE_COUPLED_ROWS + column] += u[e];
        if (room->row[i].known) room->flexibility[column * SPORE_COUPLED_ROWS + 3 * i + e] += u[e];
      }
    }
  }
}

/* Says where the body is coupled. */
static void ask(const SporeIslandSystem *system, const SporeCoupledRoom *room, SporeBody *body, size_t from) {
  uint8_t *asked = (uint8_t *)spore_island_system_lanes(system, from);
  memset(asked, 0, body->block_count);
  for (size_t i = 0; i < room->count; i++)
    for (uint32_t p = 0; p < room->row[i].part_count; p++) {
      const Part *part = &room->row[i].part[p];
      if (lies_in(part, from, from + 3 * body->block_count)) asked[(part->v - from) / 3] = 1;
    }
  spore_block_cholesky_ask(&body->preconditioner.factor, asked);
}

/* No part of G that belongs to a row that is not known. */
static void clear_unknown(SporeCoupledRoom *room) {
  size_t n = 3 * room->count;
  for (size_t i = 0; i < n; i++) {
    double *line = room->flexibility + i * SPORE_COUPLED_ROWS;
    if (!room->row[i / 3].known) memset(line, 0, n * sizeof *line);
    for (size_t j = 0; j < n; j += 3)
      if (!room->row[j / 3].known) memset(line + j, 0, 3 * sizeof *line);
  }
}

static void add_body(const SporeIslandSystem *system, SporeCoupledRoom *room, SporeBody *body, size_t from) {
  Group group = {0};
  if (spore_island_system_has_factor(system, body)) ask(system, room, body, from);
  for (size_t i = 0; i < room->count; i++) {
    if (room->row[i].known || !touches(&room->row[i], from, from + 3 * body->block_count)) continue;
    for (uint32_t axis = 0; axis < 3; axis++) {
      group.row[group.count] = (uint32_t)i;
      group.axis[group.count++] = axis;
      if (group.count < SPORE_LANES) continue;
      add_group(system, room, body, from, &group);
      group.count = 0;
    }
  }
  if (group.count > 0) add_group(system, room, body, from, &group);
}

size_t spore_coupled_rows_solve(const SporeIslandSystem *system, SporeCoupledRoom *room) {
  size_t unknown = 0;
  for (size_t i = 0; i < room->count; i++) unknown += !room->row[i].known;
  if (unknown == 0) return 0;
  clear_unknown(room);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    add_body(system, room, body, site->v);
  }
  for (size_t i = 0; i < room->count; i++) room->row[i].known = true;
  return unknown;
}

static SporeCoupledName name_of(const SporeCoupling *coupling) {
  const SporeEnd *a = coupling->a.end, *b = coupling->b.end;
  return (SporeCoupledName){a->mapping, b->mapping, a->body, a->point, b->body, b->point};
}

static bool is_same(const SporeCoupledName *one, const SporeCoupledName *other) {
  return one->mapping_a == other->mapping_a && one->mapping_b == other->mapping_b && one->body_a == other->body_a &&
         one->point_a == other->point_a && one->body_b == other->body_b && one->point_b == other->point_b;
}

/* Whether two rows hang on the same blocks in much the same way. */
static bool is_near(const Row *one, const Row *other) {
  if (one->part_count != other->part_count) return false;
  double apart = 0, size = 0, turned = 0, lever = 0;
  for (uint32_t p = 0; p < one->part_count; p++) {
    const Part *a = &one->part[p], *b = &other->part[p];
    if (a->v != b->v || a->turns != b->turns) return false;
    apart += fabs(a->weight - b->weight);
    size += fabs(a->weight);
    if (!a->turns) continue;
    SporeVec3 arm = spore_vec3_load(a->lever);
    turned += spore_vec3_length(spore_vec3_sub(arm, spore_vec3_load(b->lever)));
    lever += spore_vec3_length(arm);
  }
  return apart <= MOVED * size && turned <= MOVED * lever;
}

void spore_coupled_room_forget(SporeCoupledRoom *room) {
  room->count = 0;
  room->recall = (SporeRecall){0};
}

void spore_coupled_rows_begin(SporeCoupledRoom *room) {
  room->takes++;
  room->active_count = 0;
}

/* A row that has none of the present couplings: one of the same name; else a new one, or the one that was not asked for
 * the longest. NULL: all have. */
static Row *free_row(SporeCoupledRoom *room, const SporeCoupledName *name) {
  Row *oldest = NULL;
  for (size_t i = 0; i < room->count; i++) {
    Row *row = &room->row[i];
    if (row->taken == room->takes) continue;
    if (is_same(&row->name, name)) return row;
    if (!oldest || row->taken < oldest->taken) oldest = row;
  }
  if (room->count == SPORE_COUPLED_MOST) return oldest;
  Row *row = &room->row[room->count++];
  row->name = (SporeCoupledName){0};
  row->known = false;
  row->part_count = 0;
  return row;
}

size_t spore_coupled_rows_take(SporeCoupledRoom *room, const SporeCoupling *coupling) {
  Row now;
  if (room->active_count == SPORE_COUPLED_MOST || !set_row(&now, coupling)) return SPORE_COUPLED_MOST;
  SporeCoupledName name = name_of(coupling);
  Row *row = free_row(room, &name);
  if (!row) return SPORE_COUPLED_MOST;
  if (!is_same(&row->name, &name) || !is_near(row, &now)) {
    row->known = false;
    row->part_count = now.part_count;
    memcpy(row->part, now.part, now.part_count * sizeof *now.part);
  }
  row->name = name;
  row->taken = room->takes;
  room->active[room->active_count] = (uint32_t)(row - room->row);
  return room->active_count++;
}
