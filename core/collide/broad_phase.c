/* Which pairs of balls touch, and are let through by the filter. */
#include <assert.h>
#include <string.h>

#include "core/collide/grid_private.h"

#define SLACK 1e-6 /* of a cell's width, added to every range of cells: more than any rounding of a bound */

/* Pair filter. */

static inline bool bodies_pair(const SporeGrid *grid, uint32_t a, uint32_t b) {
  assert(a < grid->body_count && b < grid->body_count);
  if (a == b) return grid->bodies[a] & SPORE_GRID_SELF;
  if (grid->group && grid->group[a] && grid->group[a] == grid->group[b]) return false;
  unsigned one = grid->bodies[a], other = grid->bodies[b];
  return ((one | other) & SPORE_GRID_PASSIVE) | ((one ^ other) & SPORE_GRID_ACTIVE);
}

static bool touched_at_rest(const SporeGrid *grid, uint32_t a, uint32_t b) {
  assert(a < b && b < grid->count);
  if (!grid->excluded_start) return false;
  for (uint32_t k = grid->excluded_start[a]; k < grid->excluded_start[a + 1] && grid->excluded[k] <= b; k++)
    if (grid->excluded[k] == b) return true;
  return false;
}

static void add_pair(SporeGrid *grid, uint32_t body_a, uint32_t sphere_a, uint32_t body_b, uint32_t sphere_b) {
  assert(sphere_a != sphere_b);
  if (!bodies_pair(grid, body_a, body_b)) return;
  uint32_t a = sphere_a < sphere_b ? sphere_a : sphere_b, b = sphere_a < sphere_b ? sphere_b : sphere_a;
  if (body_a == body_b && touched_at_rest(grid, a, b)) return;
  if (grid->pair_count < grid->pair_capacity) grid->pairs[grid->pair_count++] = (SporePair){a, b};
  else grid->missed_pairs++;
}

/* Broad phase. */

/* Whether the pair filter lets through any pair of the two cells, as far as their bodies tell. */
static bool cells_pair(const SporeGrid *grid, const SporeCell *a, const SporeCell *b) {
  return a->body == SPORE_CELL_MIXED || b->body == SPORE_CELL_MIXED || bodies_pair(grid, a->body, b->body);
}

/* Pairs of a moving cell with another cell of `others`. */
static void pair_cells(SporeGrid *grid, const SporeCell *cell, const SporeCells *others, const SporeCell *other) {
  if (!cells_pair(grid, cell, other) || !spore_bounds_touch(&cell->bounds, &other->bounds)) return;
  const SporeCells *moving = &grid->moving;
  for (uint32_t i = cell->first; i < cell->first + cell->count; i++) {
    const double *ball = moving->middle + 4 * (size_t)i;
    if (!spore_bounds_touch_ball(&other->bounds, ball)) continue;
    for (uint32_t j = other->first; j < other->first + other->count; j++)
      if (spore_balls_touch(ball, others->middle + 4 * (size_t)j))
        add_pair(grid, moving->body[i], moving->sphere[i], others->body[j], others->sphere[j]);
  }
}

static void pair_within_cell(SporeGrid *grid, const SporeCell *cell) {
  if (!cells_pair(grid, cell, cell)) return;
  const SporeCells *moving = &grid->moving;
  for (uint32_t i = cell->first; i < cell->first + cell->count; i++)
    for (uint32_t j = i + 1; j < cell->first + cell->count; j++)
      if (spore_balls_touch(moving->middle + 4 * (size_t)i, moving->middle + 4 * (size_t)j))
        add_pair(grid, moving->body[i], moving->sphere[i], moving->body[j], moving->sphere[j]);
}

/* The half of the 26 neighbours that comes after a cell in order of x, y, z: each pair of cells is met once. */
static void pair_with_neighbours(SporeGrid *grid, const SporeCell *cell) {
  static const signed char AFTER[13][3] = {{0, 0, 1},  {0, 1, -1}, {0, 1, 0},  {0, 1, 1}, {1, -1, -1},
                                           {1, -1, 0}, {1, -1, 1}, {1, 0, -1}, {1, 0, 0}, {1, 0, 1},
                                           {1, 1, -1}, {1, 1, 0},  {1, 1, 1}};
  const SporeCells *moving = &grid->moving;
  if (moving->class_count[cell->class] < 2) return;
  for (int k = 0; k < 13; k++) {
    uint32_t other =
        spore_cells_find(moving, cell->x + AFTER[k][0], cell->y + AFTER[k][1], cell->z + AFTER[k][2], cell->class);
    if (other != SPORE_CELL_NONE) pair_cells(grid, cell, moving, &moving->cells[other]);
  }
}

/* Cells of a class whose spheres may touch a cell's. */
typedef struct CellRange {
  int32_t lower[3], upper[3];
  double count;
} CellRange;

static CellRange range_of(const SporeGrid *grid, const SporeCell *cell, double reach, int class) {
  const double origin[3] = {grid->scale.origin.x, grid->scale.origin.y, grid->scale.origin.z};
  double margin = reach + SLACK * grid->scale.width[class], inverse = grid->scale.inverse[class];
  CellRange range = {.count = 1};
  for (int k = 0; k < 3; k++) {
    range.lower[k] = spore_cell_index(cell->bounds.lower[k] - margin - origin[k], inverse);
    range.upper[k] = spore_cell_index(cell->bounds.upper[k] + margin - origin[k], inverse);
    range.count *= (double)range.upper[k] - range.lower[k] + 1;
  }
  return range;
}

/* Within one class nothing touches beyond the next cell. */
static void keep_to_neighbours(CellRange *range, const SporeCell *cell) {
  const int32_t at[3] = {cell->x, cell->y, cell->z};
  for (int k = 0; k < 3; k++) {
    if (range->lower[k] < at[k] - 1) range->lower[k] = at[k] - 1;
    if (range->upper[k] > at[k] + 1) range->upper[k] = at[k] + 1;
  }
}

/* Pairs of a moving cell with all those of one class of `others`. */
static void pair_with_class(SporeGrid *grid, const SporeCell *cell, const SporeCells *others, int class) {
  assert(class >= 0 && class < SPORE_CELL_CLASSES);
  assert(others->classes >> class & 1);
  CellRange range = range_of(grid, cell, others->class_reach[class], class);
  if (class == cell->class) keep_to_neighbours(&range, cell);
  if (range.count > others->class_count[class]) { /* fewer cells exist than the range spans */
    for (uint32_t c = others->class_head[class]; c != SPORE_CELL_NONE; c = others->cells[c].next_in_class)
      pair_cells(grid, cell, others, &others->cells[c]);
    return;
  }
  for (int32_t x = range.lower[0]; x <= range.upper[0]; x++)
    for (int32_t y = range.lower[1]; y <= range.upper[1]; y++)
      for (int32_t z = range.lower[2]; z <= range.upper[2]; z++) {
        uint32_t other = spore_cells_find(others, x, y, z, class);
        if (other != SPORE_CELL_NONE) pair_cells(grid, cell, others, &others->cells[other]);
      }
}

static void pair_with_moving(SporeGrid *grid, const SporeCell *cell) {
  pair_within_cell(grid, cell);
  pair_with_neighbours(grid, cell);
  for (int class = cell->class + 1; class < SPORE_CELL_CLASSES && grid->moving.classes >> class; class ++)
    if (grid->moving.classes >> class & 1) pair_with_class(grid, cell, &grid->moving, class);
}

static void find_pairs_of_cells(SporeGrid *grid) {
  grid->pair_count = grid->missed_pairs = 0;
  for (size_t c = 0; c < grid->moving.cell_count; c++) {
    const SporeCell *cell = &grid->moving.cells[c];
    if (!grid->lone) pair_with_moving(grid, cell);
    for (int class = 0; class < SPORE_CELL_CLASSES && grid->unmovable.classes >> class; class ++)
      if (grid->unmovable.classes >> class & 1) pair_with_class(grid, cell, &grid->unmovable, class);
  }
}

/* Regions. */

void spore_grid_add_bounds(SporeBounds *bounds, const SporeSpheres *spheres, size_t first, size_t count,
                           const double *balls) {
  assert(first + count <= spheres->count);
  for (size_t i = 0; i < count; i++)
    if (balls[4 * i + 3] >= 0) spore_bounds_add_ball(&bounds[spheres->body[first + i]], balls + 4 * i);
}

static void find_regions(SporeGrid *grid, const SporeSpheres *spheres) {
  size_t moving = grid->count - grid->static_count;
  const uint32_t *bodies = spheres->body + grid->static_count;
  for (size_t i = 0; i < moving; i++) grid->bounds[bodies[i]] = SPORE_BOUNDS_EMPTY;
  spore_grid_add_bounds(grid->bounds, spheres, grid->static_count, moving, grid->moving.unsorted);
  for (uint32_t i = 0; i < grid->body_count; i++)
    grid->regions[i] = grid->bodies[i] & SPORE_GRID_SELF ? grid->bounds[i] : SPORE_BOUNDS_EMPTY;
  for (uint32_t i = 0; i < grid->body_count; i++)
    for (uint32_t j = i + 1; j < grid->body_count; j++)
      if (bodies_pair(grid, i, j) && spore_bounds_touch(&grid->bounds[i], &grid->bounds[j])) {
        spore_bounds_add_common(&grid->regions[i], &grid->bounds[i], &grid->bounds[j]);
        spore_bounds_add_common(&grid->regions[j], &grid->bounds[i], &grid->bounds[j]);
      }
}

/* Unmovable balls up to this many are each tried with every ball of a lone body: 400 balls of a sheet beside 4 take 3
 * us so, and 35 us with cells where the sheet moves fast. */
#define FEW 8

static void try_each(SporeGrid *grid, const SporeSpheres *spheres) {
  size_t moving = grid->count - grid->static_count;
  grid->pair_count = grid->missed_pairs = 0;
  for (size_t a = 0; a < grid->static_count; a++) {
    const double *unmovable = grid->balls + 4 * a, *ball = grid->moving.unsorted;
    for (size_t i = 0; unmovable[3] >= 0 && i < moving; i++, ball += 4) {
      size_t b = grid->static_count + i;
      if (ball[3] >= 0 && spore_balls_touch(unmovable, ball))
        add_pair(grid, spheres->body[a], (uint32_t)a, spheres->body[b], (uint32_t)b);
    }
  }
}

void spore_grid_find_pairs(SporeGrid *grid, const SporeSpheres *spheres) {
  assert(spheres->count == grid->count && spheres->static_count == grid->static_count);
  if (grid->lone && grid->static_count <= FEW) {
    try_each(grid, spheres);
    return;
  }
  if (grid->regions) find_regions(grid, spheres);
  spore_cells_fill(&grid->moving, &grid->scale, spheres, grid->static_count, grid->count - grid->static_count,
                   grid->regions);
  find_pairs_of_cells(grid);
}

/* Sorting by (a, b): two stable counting sorts, b first. */

static inline uint32_t key_of(const SporePair *pair, bool by_a) { return by_a ? pair->a : pair->b; }

static void counting_sort(SporeGrid *grid, const SporePair *from, SporePair *to, bool by_a) {
  assert(from != to || grid->pair_count == 0);
  memset(grid->bucket, 0, (grid->count + 1) * sizeof *grid->bucket);
  for (size_t i = 0; i < grid->pair_count; i++) grid->bucket[key_of(&from[i], by_a) + 1]++;
  for (size_t i = 0; i < grid->count; i++) grid->bucket[i + 1] += grid->bucket[i];
  for (size_t i = 0; i < grid->pair_count; i++) to[grid->bucket[key_of(&from[i], by_a)]++] = from[i];
}

void spore_grid_sort_pairs(SporeGrid *grid) {
  counting_sort(grid, grid->pairs, grid->sorted_pairs, false);
  counting_sort(grid, grid->sorted_pairs, grid->pairs, true);
}
