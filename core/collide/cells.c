/* Hashed regular grids: spheres are put in cells, and cells are found by their place. */
#include "core/collide/cells.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"

/* Cells are wider than needed by this part, so that rounding of a coordinate never makes neighbours seem farther
 * apart. */
#define SLACK 1e-6
/* Least width of a cell in radii of its spheres. 2 is enough to find every pair; at 4 a sheet of 400 spheres takes
 * 30 us instead of 79, since far fewer empty cells are looked for, and packed spheres take no longer. */
#define CELL_RADII 4
#define ROUNDING 1e-15 /* of a coordinate */
/* Cells along an axis, either way from the origin; a sphere farther out goes to a class of wider cells. */
#define FARTHEST 1073741824.0 /* 2^30 */

/* A k >= 0 with ratio <= 2^k: the smallest one, unless the ratio is a power of two. No class is wide enough where the
 * ratio is huge. */
static int class_of_ratio(double ratio) {
  if (ratio <= 1) return 0;
  if (!(ratio < 1e300)) return SPORE_CELL_CLASSES;
  return ilogb(ratio) + 1;
}

SporeCellScale spore_cell_scale(SporeVec3 origin, double smallest_radius, double usual_radius) {
  assert(smallest_radius > 0 && smallest_radius <= usual_radius && isfinite(usual_radius));
  /* A little room, so that slow motion does not push the usual sphere into the next class. */
  double usual_width = 1.1 * CELL_RADII * usual_radius;
  SporeCellScale scale = {.origin = origin};
  scale.width[0] = usual_width * ldexp(1, -class_of_ratio(usual_radius / smallest_radius));
  for (int k = 0; k < SPORE_CELL_CLASSES; k++) {
    scale.width[k] = ldexp(scale.width[0], k);
    scale.inverse[k] = 1 / scale.width[k];
  }
  return scale;
}

int32_t spore_cell_index(double coordinate, double inverse_width) {
  assert(inverse_width > 0);
  double position = coordinate * inverse_width;
  if (position >= 2147483000.0) return 2147483000;
  if (!(position > -2147483000.0)) return -2147483000;
  int32_t index = (int32_t)position;
  return index - (position < index);
}

bool spore_cells_create(SporeCells *cells, size_t capacity) {
  size_t slots = 16;
  while (slots < 2 * capacity) slots *= 2;
  *cells = (SporeCells){
      .capacity = capacity,
      .cells = SPORE_NEW_ARRAY(SporeCell, capacity),
      .middle = SPORE_NEW_ARRAY(double, 4 * capacity),
      .sphere = SPORE_NEW_ARRAY(uint32_t, capacity),
      .body = SPORE_NEW_ARRAY(uint32_t, capacity),
      .cell_of = SPORE_NEW_ARRAY(uint32_t, capacity),
      .unsorted = SPORE_NEW_ARRAY(double, 4 * capacity),
      .slots = SPORE_NEW_ARRAY(SporeCellSlot, slots),
      .slot_mask = slots - 1,
  };
  bool complete = cells->cells && cells->middle && cells->sphere && cells->body && cells->cell_of && cells->unsorted &&
                  cells->slots;
  if (!complete) spore_cells_clear(cells);
  return complete;
}

void spore_cells_clear(SporeCells *cells) {
  spore_free(cells->cells);
  spore_free(cells->middle);
  spore_free(cells->sphere);
  spore_free(cells->body);
  spore_free(cells->cell_of);
  spore_free(cells->unsorted);
  spore_free(cells->slots);
  *cells = (SporeCells){0};
}

/* The slot of a cell: its own, or the empty one where it belongs. Linear probing; the table is at most half full. */
static SporeCellSlot *find_slot(const SporeCells *cells, int32_t x, int32_t y, int32_t z, int32_t class) {
  uint64_t key = (uint64_t)(uint32_t)x * UINT64_C(0x9E3779B97F4A7C15) ^
                 (uint64_t)(uint32_t)y * UINT64_C(0xC2B2AE3D27D4EB4F) ^
                 (uint64_t)(uint32_t)z * UINT64_C(0x165667B19E3779F9) ^ (uint64_t)(uint32_t) class << 57;
  for (size_t at = (size_t)(key ^ key >> 32) & cells->slot_mask;; at = (at + 1) & cells->slot_mask) {
    SporeCellSlot *slot = &cells->slots[at];
    if (slot->stamp != cells->stamp) return slot;
    if (slot->x == x && slot->y == y && slot->z == z && slot->class == class) return slot;
  }
}

uint32_t spore_cells_find(const SporeCells *cells, int32_t x, int32_t y, int32_t z, int32_t class) {
  assert(class >= 0 && class < SPORE_CELL_CLASSES);
  const SporeCellSlot *slot = find_slot(cells, x, y, z, class);
  return slot->stamp == cells->stamp ? slot->cell : SPORE_CELL_NONE;
}

static uint32_t find_or_add(SporeCells *cells, int32_t x, int32_t y, int32_t z, int32_t class) {
  assert(class >= 0 && class < SPORE_CELL_CLASSES);
  SporeCellSlot *slot = find_slot(cells, x, y, z, class);
  if (slot->stamp == cells->stamp) return slot->cell;
  uint32_t index = (uint32_t)cells->cell_count++;
  *slot = (SporeCellSlot){cells->stamp, x, y, z, class, index};
  if (!(cells->classes >> class & 1)) {
    cells->classes |= UINT64_C(1) << class;
    cells->class_head[class] = SPORE_CELL_NONE;
    cells->class_count[class] = 0;
    cells->class_reach[class] = 0;
  }
  cells->cells[index] = (SporeCell){
      .x = x, .y = y, .z = z, .class = class, .next_in_class = cells->class_head[class], .bounds = SPORE_BOUNDS_EMPTY};
  cells->class_head[class] = index;
  cells->class_count[class]++;
  return index;
}

/* Sum of the sizes of the components: at least the length, and no root is needed. */
static double length_at_most(SporeVec3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

double spore_cells_find_balls(const SporeSpheres *spheres, size_t first, size_t count, double dt_s, double *balls) {
  assert(first + count <= spheres->count);
  assert(dt_s >= 0);
  double longest = 0;
  for (size_t i = first; i < first + count; i++, balls += 4) {
    SporeVec3 velocity = spore_vec3_load(spheres->velocity + 3 * i);
    SporeVec3 middle = spore_vec3_add_scaled(spore_vec3_load(spheres->centre + 3 * i), 0.5 * dt_s, velocity);
    double speed = length_at_most(velocity), size = length_at_most(middle);
    double reach = spheres->radius[i] + 0.5 * dt_s * speed + ROUNDING * size;
    spore_vec3_store(balls, middle);
    balls[3] = isfinite(size + reach) ? reach : -1;
    if (speed > longest) longest = speed;
  }
  return dt_s * longest;
}

void spore_cells_add_ways(const SporeSpheres *spheres, size_t first, size_t count, double *balls) {
  assert(first + count <= spheres->count);
  assert(spheres->before);
  for (size_t i = first; i < first + count; i++, balls += 4) {
    SporeVec3 way = spore_vec3_sub(spore_vec3_load(balls), spore_vec3_load(spheres->before + 3 * i));
    double reach = spheres->radius[i] + length_at_most(way);
    if (balls[3] >= 0 && isfinite(reach)) balls[3] = fmax(balls[3], reach);
  }
}

/* Puts a ball in its cell; SPORE_CELL_NONE where no class is wide enough. */
static uint32_t place_ball(SporeCells *cells, const SporeCellScale *scale, const double ball[4]) {
  assert(ball[3] >= 0);
  double x = ball[0] - scale->origin.x, y = ball[1] - scale->origin.y, z = ball[2] - scale->origin.z;
  double distance = fmax(fabs(x), fmax(fabs(y), fabs(z)));
  int class = class_of_ratio(CELL_RADII * (1 + SLACK) * ball[3] * scale->inverse[0]);
  if (distance > FARTHEST * scale->width[0]) {
    int far_class = class_of_ratio(distance / FARTHEST * scale->inverse[0]);
    if (far_class > class) class = far_class;
  }
  if (class >= SPORE_CELL_CLASSES) return SPORE_CELL_NONE;
  double inverse = scale->inverse[class];
  uint32_t index = find_or_add(cells, spore_cell_index(x, inverse), spore_cell_index(y, inverse),
                               spore_cell_index(z, inverse), class);
  if (ball[3] > cells->class_reach[class]) cells->class_reach[class] = ball[3];
  return index;
}

/* Sorted arrays from cell_of and unsorted. */
static void sort_by_cell(SporeCells *cells, const SporeSpheres *spheres, size_t first, size_t count) {
  uint32_t start = 0;
  for (size_t c = 0; c < cells->cell_count; c++) {
    cells->cells[c].first = start;
    start += cells->cells[c].count;
    cells->cells[c].count = 0;
  }
  for (size_t i = 0; i < count; i++) {
    if (cells->cell_of[i] == SPORE_CELL_NONE) continue;
    SporeCell *cell = &cells->cells[cells->cell_of[i]];
    const double *ball = cells->unsorted + 4 * i;
    uint32_t at = cell->first + cell->count, body = spheres->body[first + i];
    cell->body = cell->count == 0 || cell->body == body ? body : SPORE_CELL_MIXED;
    cell->count++;
    for (int k = 0; k < 4; k++) cells->middle[4 * at + (size_t)k] = ball[k];
    cells->sphere[at] = (uint32_t)(first + i);
    cells->body[at] = body;
    spore_bounds_add_ball(&cell->bounds, ball);
  }
}

void spore_cells_fill(SporeCells *cells, const SporeCellScale *scale, const SporeSpheres *spheres, size_t first,
                      size_t count, const SporeBounds *regions) {
  assert(first + count <= spheres->count);
  assert(count <= cells->capacity);
  cells->stamp++;
  cells->cell_count = 0;
  cells->classes = 0;
  for (size_t i = 0; i < count; i++) {
    const double *ball = cells->unsorted + 4 * i;
    bool takes_part = ball[3] >= 0 && (!regions || spore_bounds_touch_ball(&regions[spheres->body[first + i]], ball));
    uint32_t cell = takes_part ? place_ball(cells, scale, ball) : SPORE_CELL_NONE;
    cells->cell_of[i] = cell;
    if (cell != SPORE_CELL_NONE) cells->cells[cell].count++;
  }
  sort_by_cell(cells, spheres, first, count);
}
