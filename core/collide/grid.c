#include "core/collide/grid.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/collide/cells.h"
#include "core/collide/narrow.h"

#define SLACK 1e-6  /* of a cell's width, added to every range of cells: more than any rounding of a bound */
#define LARGEST 1e9 /* m: of radii and of the coordinates of what never moves */
#define SMALLEST_RADIUS 1e-9

enum { BODY_PASSIVE = 1, BODY_SELF = 2 };

typedef struct Pair {
  uint32_t a, b; /* a < b */
} Pair;

struct SporeGrid {
  size_t count, static_count, body_count, capacity;
  unsigned char *bodies; /* BODY_ flags */
  SporeCellScale scale;
  SporeCells unmovable, moving;
  /* Spheres outside their body's region, the part of space that it shares with bodies it pairs with, need no cell.
   * Regions are looked for only where there are so few bodies that trying every pair of them costs no more than
   * the spheres do; else NULL. */
  SporeBounds *bounds, *regions; /* body_count */
  /* Pairs of one body that touch at rest: for sphere a, those b > a, ascending. NULL: no body collides with itself. */
  uint32_t *excluded_start; /* count + 1 */
  uint32_t *excluded;

  SporeContact *contacts; /* capacity */
  size_t pair_count, missed;
  Pair *pairs, *sorted_pairs; /* capacity */
  uint32_t *bucket;           /* count + 1 */
};

/* Pair filter. */

static inline bool bodies_pair(const SporeGrid *grid, uint32_t a, uint32_t b) {
  if (a == b) return grid->bodies[a] & BODY_SELF;
  return (grid->bodies[a] | grid->bodies[b]) & BODY_PASSIVE;
}

static bool touched_at_rest(const SporeGrid *grid, uint32_t a, uint32_t b) {
  if (!grid->excluded_start) return false;
  for (uint32_t k = grid->excluded_start[a]; k < grid->excluded_start[a + 1] && grid->excluded[k] <= b; k++)
    if (grid->excluded[k] == b) return true;
  return false;
}

static void add_pair(SporeGrid *grid, uint32_t body_a, uint32_t sphere_a, uint32_t body_b, uint32_t sphere_b) {
  if (!bodies_pair(grid, body_a, body_b)) return;
  uint32_t a = sphere_a < sphere_b ? sphere_a : sphere_b, b = sphere_a < sphere_b ? sphere_b : sphere_a;
  if (body_a == body_b && touched_at_rest(grid, a, b)) return;
  if (grid->pair_count < grid->capacity) grid->pairs[grid->pair_count++] = (Pair){a, b};
  else grid->missed++;
}

/* Broad phase. */

static inline bool balls_touch(const double *a, const double *b) {
  double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2], reach = a[3] + b[3];
  return x * x + y * y + z * z < reach * reach;
}

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
      if (balls_touch(ball, others->middle + 4 * (size_t)j))
        add_pair(grid, moving->body[i], moving->sphere[i], others->body[j], others->sphere[j]);
  }
}

static void pair_within_cell(SporeGrid *grid, const SporeCell *cell) {
  if (!cells_pair(grid, cell, cell)) return;
  const SporeCells *moving = &grid->moving;
  for (uint32_t i = cell->first; i < cell->first + cell->count; i++)
    for (uint32_t j = i + 1; j < cell->first + cell->count; j++)
      if (balls_touch(moving->middle + 4 * (size_t)i, moving->middle + 4 * (size_t)j))
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

static void find_pairs(SporeGrid *grid) {
  grid->pair_count = grid->missed = 0;
  for (size_t c = 0; c < grid->moving.cell_count; c++) {
    const SporeCell *cell = &grid->moving.cells[c];
    pair_within_cell(grid, cell);
    pair_with_neighbours(grid, cell);
    for (int class = cell->class + 1; class < SPORE_CELL_CLASSES && grid->moving.classes >> class; class ++)
      if (grid->moving.classes >> class & 1) pair_with_class(grid, cell, &grid->moving, class);
    for (int class = 0; class < SPORE_CELL_CLASSES && grid->unmovable.classes >> class; class ++)
      if (grid->unmovable.classes >> class & 1) pair_with_class(grid, cell, &grid->unmovable, class);
  }
}

/* Regions. */

static void add_balls_to_bounds(SporeBounds *bounds, const SporeSpheres *spheres, size_t first, size_t count,
                                const double *balls) {
  for (size_t i = 0; i < count; i++)
    if (balls[4 * i + 3] >= 0) spore_bounds_add_ball(&bounds[spheres->body[first + i]], balls + 4 * i);
}

static void find_regions(SporeGrid *grid, const SporeSpheres *spheres) {
  size_t moving = grid->count - grid->static_count;
  const uint32_t *bodies = spheres->body + grid->static_count;
  for (size_t i = 0; i < moving; i++) grid->bounds[bodies[i]] = SPORE_BOUNDS_EMPTY;
  add_balls_to_bounds(grid->bounds, spheres, grid->static_count, moving, grid->moving.unsorted);
  for (uint32_t i = 0; i < grid->body_count; i++)
    grid->regions[i] = grid->bodies[i] & BODY_SELF ? grid->bounds[i] : SPORE_BOUNDS_EMPTY;
  for (uint32_t i = 0; i < grid->body_count; i++)
    for (uint32_t j = i + 1; j < grid->body_count; j++)
      if (bodies_pair(grid, i, j) && spore_bounds_touch(&grid->bounds[i], &grid->bounds[j])) {
        spore_bounds_add_common(&grid->regions[i], &grid->bounds[i], &grid->bounds[j]);
        spore_bounds_add_common(&grid->regions[j], &grid->bounds[i], &grid->bounds[j]);
      }
}

static void place_moving(SporeGrid *grid, const SporeSpheres *spheres, double dt_s) {
  size_t count = grid->count - grid->static_count;
  spore_cells_find_balls(spheres, grid->static_count, count, dt_s, grid->moving.unsorted);
  if (grid->regions) find_regions(grid, spheres);
  spore_cells_fill(&grid->moving, &grid->scale, spheres, grid->static_count, count, grid->regions);
}

/* Sorting by (a, b): two stable counting sorts, b first. */

static inline uint32_t key_of(const Pair *pair, bool by_a) { return by_a ? pair->a : pair->b; }

static void counting_sort(SporeGrid *grid, const Pair *from, Pair *to, bool by_a) {
  memset(grid->bucket, 0, (grid->count + 1) * sizeof *grid->bucket);
  for (size_t i = 0; i < grid->pair_count; i++) grid->bucket[key_of(&from[i], by_a) + 1]++;
  for (size_t i = 0; i < grid->count; i++) grid->bucket[i + 1] += grid->bucket[i];
  for (size_t i = 0; i < grid->pair_count; i++) to[grid->bucket[key_of(&from[i], by_a)]++] = from[i];
}

static void sort_pairs(SporeGrid *grid) {
  counting_sort(grid, grid->pairs, grid->sorted_pairs, false);
  counting_sort(grid, grid->sorted_pairs, grid->pairs, true);
}

size_t spore_grid_detect(SporeGrid *grid, const SporeSpheres *spheres, double dt_s, size_t *missed) {
  place_moving(grid, spheres, dt_s);
  find_pairs(grid);
  sort_pairs(grid);
  size_t contact_count = 0;
  for (size_t i = 0; i < grid->pair_count; i++) {
    const Pair *pair = &grid->pairs[i];
    if (spore_narrow_contact(spheres, pair->a, pair->b, dt_s, &grid->contacts[contact_count])) contact_count++;
  }
  *missed = grid->missed;
  return contact_count;
}

/* Creation. */

static void refuse_memory(SporeError *error) {
  spore_error_set(error, SPORE_ERROR_MEMORY, NULL, "%s",
                  _("not enough memory for the collision grid; use fewer spheres"));
}

static bool check_spheres(const SporeSpheres *spheres, size_t body_count, SporeError *error) {
  if (spheres->count >= UINT32_MAX || spheres->static_count > spheres->count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%zu spheres cannot collide; expected fewer than 4 billion; use fewer spheres"),
                           spheres->count);
  for (size_t i = 0; i < spheres->count; i++) {
    double radius = spheres->radius[i];
    if (!(radius >= SMALLEST_RADIUS && radius <= LARGEST))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("sphere %zu has radius %g m; expected 1e-9 to 1e9 m; correct it"), i, radius);
    if (spheres->body[i] >= body_count)
      return spore_error_set(error, SPORE_ERROR_INTERNAL, NULL, _("sphere %zu names body %u of %zu"), i,
                             spheres->body[i], body_count);
  }
  for (size_t i = 0; i < 3 * spheres->static_count; i++)
    if (!(fabs(spheres->centre[i]) <= LARGEST))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("unmovable sphere %zu lies at %g m; expected within 1e9 m; correct its position"), i / 3,
                             spheres->centre[i]);
  return true;
}

/* Middle of the bounds of the spheres that are usable. */
static SporeVec3 middle_of(const SporeSpheres *spheres, size_t first) {
  double middle[3] = {0, 0, 0};
  for (size_t k = 0; k < 3; k++) {
    double lower = INFINITY, upper = -INFINITY;
    for (size_t i = first; i < spheres->count; i++) {
      double x = spheres->centre[3 * i + k];
      if (fabs(x) <= LARGEST) lower = fmin(lower, x), upper = fmax(upper, x);
    }
    if (lower <= upper) middle[k] = 0.5 * (lower + upper);
  }
  return spore_vec3_load(middle);
}

/* Geometric mean of the radii: near what is usual, whatever their order. */
static double usual_radius(const SporeSpheres *spheres, size_t first) {
  double sum = 0;
  for (size_t i = first; i < spheres->count; i++) sum += log(spheres->radius[i]);
  return exp(sum / (double)(spheres->count - first));
}

static SporeCellScale scale_of(const SporeSpheres *spheres) {
  size_t first = spheres->static_count < spheres->count ? spheres->static_count : 0;
  if (spheres->count == 0) return spore_cell_scale((SporeVec3){0, 0, 0}, 1, 1);
  double smallest = INFINITY;
  for (size_t i = 0; i < spheres->count; i++) smallest = fmin(smallest, spheres->radius[i]);
  return spore_cell_scale(middle_of(spheres, first), smallest, fmax(usual_radius(spheres, first), smallest));
}

static bool create_regions(SporeGrid *grid) {
  if (grid->body_count > 4 * grid->count / (grid->body_count + 1)) return true;
  grid->bounds = SPORE_NEW_ARRAY(SporeBounds, grid->body_count);
  grid->regions = SPORE_NEW_ARRAY(SporeBounds, grid->body_count);
  for (size_t i = 0; grid->bounds && i < grid->body_count; i++) grid->bounds[i] = SPORE_BOUNDS_EMPTY;
  return grid->bounds && grid->regions;
}

static void place_unmovable(SporeGrid *grid, const SporeSpheres *spheres) {
  double *balls = grid->unmovable.unsorted;
  spore_cells_find_balls(spheres, 0, grid->static_count, 0, balls);
  if (grid->bounds) add_balls_to_bounds(grid->bounds, spheres, 0, grid->static_count, balls);
  spore_cells_fill(&grid->unmovable, &grid->scale, spheres, 0, grid->static_count, NULL);
}

/* A grid without exclusions. */
static SporeGrid *create_plain(const SporeSpheres *spheres, const unsigned char *bodies, size_t body_count,
                               size_t contact_capacity) {
  SporeGrid *grid = SPORE_NEW(SporeGrid);
  if (!grid) return NULL;
  grid->count = spheres->count;
  grid->static_count = spheres->static_count;
  grid->body_count = body_count;
  grid->scale = scale_of(spheres);
  grid->bodies = SPORE_NEW_ARRAY(unsigned char, body_count);
  grid->bucket = SPORE_NEW_ARRAY(uint32_t, spheres->count + 1);
  bool complete = grid->bodies && grid->bucket && spore_cells_create(&grid->unmovable, grid->static_count) &&
                  spore_cells_create(&grid->moving, grid->count - grid->static_count) &&
                  spore_grid_reserve(grid, contact_capacity) && create_regions(grid);
  if (!complete) {
    spore_grid_free(grid);
    return NULL;
  }
  memcpy(grid->bodies, bodies, body_count);
  place_unmovable(grid, spheres);
  return grid;
}

/* Fills the exclusion list from the sorted pairs of a grid. */
static bool take_exclusions(SporeGrid *grid, const SporeGrid *rest) {
  grid->excluded_start = SPORE_NEW_ARRAY(uint32_t, grid->count + 1);
  grid->excluded = SPORE_NEW_ARRAY(uint32_t, rest->pair_count);
  if (!grid->excluded_start || !grid->excluded) return false;
  for (size_t i = 0; i < rest->pair_count; i++) {
    grid->excluded_start[rest->pairs[i].a + 1]++;
    grid->excluded[i] = rest->pairs[i].b;
  }
  for (size_t i = 0; i < grid->count; i++) grid->excluded_start[i + 1] += grid->excluded_start[i];
  return true;
}

/* The pairs to exclude are those that a grid finds at rest among spheres that are larger by the margin, when bodies
 * collide with nothing but themselves. */
static bool build_exclusions(SporeGrid *grid, const SporeSpheres *rest, double *still, double *wider,
                             unsigned char *selves) {
  SporeSpheres spheres = *rest;
  spheres.radius = wider;
  spheres.velocity = still;
  for (size_t i = 0; i < rest->count; i++) wider[i] = rest->radius[i] * (1 + SPORE_GRID_SELF_MARGIN);
  for (size_t i = 0; i < grid->body_count; i++) selves[i] = grid->bodies[i] & BODY_SELF;
  SporeGrid *finder = create_plain(&spheres, selves, grid->body_count, 0);
  if (!finder) return false;
  place_moving(finder, &spheres, 0);
  find_pairs(finder);
  bool complete = finder->missed == 0 || spore_grid_reserve(finder, finder->capacity + finder->missed);
  if (complete) {
    find_pairs(finder);
    sort_pairs(finder);
    complete = take_exclusions(grid, finder);
  }
  spore_grid_free(finder);
  return complete;
}

static bool exclude_rest_contacts(SporeGrid *grid, const SporeSpheres *rest) {
  if (!memchr(grid->bodies, BODY_PASSIVE | BODY_SELF, grid->body_count)) return true;
  double *still = SPORE_NEW_ARRAY(double, 3 * rest->count), *wider = SPORE_NEW_ARRAY(double, rest->count);
  unsigned char *selves = SPORE_NEW_ARRAY(unsigned char, grid->body_count);
  bool complete = still && wider && selves && build_exclusions(grid, rest, still, wider, selves);
  spore_free(still);
  spore_free(wider);
  spore_free(selves);
  return complete;
}

static unsigned char flags_of(const SporeGridBody *body) {
  if (!body->passive) return 0;
  return body->self ? BODY_PASSIVE | BODY_SELF : BODY_PASSIVE;
}

SporeGrid *spore_grid_create(const SporeSpheres *rest, const SporeGridBody *bodies, size_t body_count,
                             size_t contact_capacity, SporeError *error) {
  if (!check_spheres(rest, body_count, error)) return NULL;
  unsigned char *flags = SPORE_NEW_ARRAY(unsigned char, body_count);
  for (size_t i = 0; flags && i < body_count; i++) flags[i] = flags_of(&bodies[i]);
  SporeGrid *grid = flags ? create_plain(rest, flags, body_count, contact_capacity) : NULL;
  spore_free(flags);
  if (grid && exclude_rest_contacts(grid, rest)) return grid;
  spore_grid_free(grid);
  refuse_memory(error);
  return NULL;
}

void spore_grid_free(SporeGrid *grid) {
  if (!grid) return;
  spore_cells_clear(&grid->unmovable);
  spore_cells_clear(&grid->moving);
  spore_free(grid->bodies);
  spore_free(grid->bounds);
  spore_free(grid->regions);
  spore_free(grid->excluded_start);
  spore_free(grid->excluded);
  spore_free(grid->contacts);
  spore_free(grid->pairs);
  spore_free(grid->sorted_pairs);
  spore_free(grid->bucket);
  spore_free(grid);
}

bool spore_grid_reserve(SporeGrid *grid, size_t contact_capacity) {
  if (contact_capacity == 0) contact_capacity = 4 * (grid->count - grid->static_count) + 64;
  SporeContact *contacts = SPORE_NEW_ARRAY(SporeContact, contact_capacity);
  Pair *pairs = SPORE_NEW_ARRAY(Pair, contact_capacity), *sorted_pairs = SPORE_NEW_ARRAY(Pair, contact_capacity);
  if (!contacts || !pairs || !sorted_pairs) {
    spore_free(contacts);
    spore_free(pairs);
    spore_free(sorted_pairs);
    return false;
  }
  spore_free(grid->contacts);
  spore_free(grid->pairs);
  spore_free(grid->sorted_pairs);
  grid->contacts = contacts;
  grid->pairs = pairs;
  grid->sorted_pairs = sorted_pairs;
  grid->capacity = contact_capacity;
  return true;
}

const SporeContact *spore_grid_contacts(const SporeGrid *grid) { return grid->contacts; }

size_t spore_grid_capacity(const SporeGrid *grid) { return grid->capacity; }

size_t spore_grid_body_pairs(const SporeGridBody *bodies, size_t body_count) {
  size_t passive = 0, selves = 0;
  for (size_t i = 0; i < body_count; i++) {
    passive += bodies[i].passive;
    selves += bodies[i].passive && bodies[i].self;
  }
  return passive * (body_count - passive) + passive * (passive - 1) / 2 + selves;
}
