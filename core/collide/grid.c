/* The grid from outside: creation, lists of near pairs, contacts. */
#include "core/collide/grid_private.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/collide/narrow.h"

#define LARGEST 1e9 /* m: of radii and of the coordinates of what never moves */
#define SMALLEST_RADIUS 1e-9

/* Pairs are looked for among balls that are larger than the spheres need by a skin. The list of pairs holds for as long
 * as every sphere stays within its ball. The narrow phase alone decides what touches, so that the contacts are those of
 * a fresh search. */
#define SKIN_STEPS                                                                                                     \
  12 /* the skin lasts for so many steps at the speed of now, however fast: one stray is enough to end a list */
#define SKIN_SMALLEST 0.3 /* of the radius */
#define LIST_STEPS 3      /* a list that serves for fewer steps does not pay */
#define PAUSE_LONGEST 128
#define CONTACT_PAIRS 3 /* room for pairs, per contact that there is room for */

/* Lists. */

/* The balls of this step with a skin: the way of so many steps at the present speed, or what a slow sphere needs. steps
 * = 0: no skin. */
static void add_skins(SporeGrid *grid, const SporeSpheres *spheres, double steps) {
  size_t moving = grid->count - grid->static_count;
  const double *ball = grid->balls + 4 * grid->static_count, *radius = spheres->radius + grid->static_count;
  double *skinned = grid->moving.unsorted;
  for (size_t i = 0; i < moving; i++, ball += 4, skinned += 4) {
    double travel = 2 * (ball[3] - radius[i]);
    double skin = fmax(steps * travel, SKIN_SMALLEST * radius[i]);
    for (int k = 0; k < 4; k++) skinned[k] = ball[k];
    if (steps > 0 && ball[3] >= 0) skinned[3] += skin;
  }
}

/* Whether every sphere stays within the ball that the list was made for. */
static bool list_serves(const SporeGrid *grid) {
  const double *ball = grid->balls + 4 * grid->static_count, *skinned = grid->moving.unsorted;
  size_t moving = grid->count - grid->static_count, outside = 0;
  for (size_t i = 0; i < moving; i++, ball += 4, skinned += 4) {
    double x = ball[0] - skinned[0], y = ball[1] - skinned[1], z = ball[2] - skinned[2], room = skinned[3] - ball[3];
    bool both = ball[3] >= 0 && room >= 0 && x * x + y * y + z * z <= room * room * (1 - 1e-9);
    outside += !(both || (ball[3] < 0 && skinned[3] < 0));
  }
  return outside == 0;
}

static void list_pairs(SporeGrid *grid, const SporeSpheres *spheres, double skin_steps) {
  add_skins(grid, spheres, skin_steps);
  spore_grid_find_pairs(grid, spheres);
}

/* Does without lists for a while, because they do not pay or have no room. */
static void pause_lists(SporeGrid *grid) {
  grid->pause_left = grid->pause;
  if (grid->pause < PAUSE_LONGEST) grid->pause *= 2;
}

static void renew_list(SporeGrid *grid, const SporeSpheres *spheres) {
  if (grid->pause_left > 0) grid->pause_left--;
  else if (grid->listed && grid->list_steps < LIST_STEPS) pause_lists(grid);
  else if (grid->listed) grid->pause = SPORE_GRID_SHORTEST_PAUSE;
  bool skinned = grid->pause_left == 0;
  list_pairs(grid, spheres, skinned ? SKIN_STEPS : 0);
  if (skinned && grid->missed_pairs) {
    pause_lists(grid);
    list_pairs(grid, spheres, 0);
  }
  spore_grid_sort_pairs(grid);
  grid->listed = grid->missed_pairs == 0;
  grid->list_steps = 0;
}

void spore_grid_set_asleep(SporeGrid *grid, uint32_t body, bool asleep) {
  assert(body < grid->body_count);
  unsigned char flags = grid->bodies[body];
  if ((flags & SPORE_GRID_ASLEEP) == (asleep ? SPORE_GRID_ASLEEP : 0)) return;
  grid->bodies[body] = flags ^ SPORE_GRID_ASLEEP;
  if (asleep) grid->sleeping++;
  else grid->sleeping--;
}

void spore_grid_set_apart(SporeGrid *grid, uint32_t body, bool apart) {
  assert(body < grid->body_count);
  unsigned char flags = grid->bodies[body];
  if ((flags & SPORE_GRID_APART) == (apart ? SPORE_GRID_APART : 0)) return;
  grid->bodies[body] = flags ^ SPORE_GRID_APART;
  if (apart) grid->apart++;
  else grid->apart--;
}

/* Unmovable spheres come first, so that only a can be one. */
static bool pair_sleeps(const SporeGrid *grid, const SporeSpheres *spheres, const SporePair *pair) {
  if (!(grid->bodies[spheres->body[pair->b]] & SPORE_GRID_ASLEEP)) return false;
  return pair->a < grid->static_count || grid->bodies[spheres->body[pair->a]] & SPORE_GRID_ASLEEP;
}

/* Whether the pair is looked at for this step alone: one of its bodies is soft, or physics moves neither. */
static bool is_soft(const SporeGrid *grid, const SporeSpheres *spheres, const SporePair *pair) {
  unsigned char flags = grid->bodies[spheres->body[pair->a]] | grid->bodies[spheres->body[pair->b]];
  return flags & SPORE_GRID_SOFT || !(flags & SPORE_GRID_PASSIVE);
}

static void note_passed(SporeGrid *grid, const SporeSpheres *spheres, const SporePair *pair, double dt_s) {
  SporeContact contact;
  if (grid->passed_count == grid->capacity || !spore_narrow_passed(spheres, pair->a, pair->b, dt_s, &contact)) return;
  grid->passed[grid->passed_count++] = contact;
}

static bool is_apart(const SporeGrid *grid, const SporeSpheres *spheres, const SporePair *pair) {
  return (grid->bodies[spheres->body[pair->a]] | grid->bodies[spheres->body[pair->b]]) & SPORE_GRID_APART;
}

/* False: there is no room. */
static bool keep_apart(SporeGrid *grid, const SporePair *pair) {
  if (grid->apart_count == grid->capacity) return false;
  grid->apart_pairs[grid->apart_count++] = *pair;
  return true;
}

/* Contacts of the listed pairs; *missed: those without room. */
static size_t find_contacts(SporeGrid *grid, const SporeSpheres *spheres, double dt_s, size_t *missed) {
  size_t contact_count = 0;
  SporeContact beyond;
  grid->passed_count = grid->apart_count = 0;
  for (size_t i = 0; i < grid->pair_count; i++) {
    const SporePair *pair = &grid->pairs[i];
    if (grid->sleeping > 0 && pair_sleeps(grid, spheres, pair)) continue;
    if (!spore_balls_touch(grid->balls + 4 * (size_t)pair->a, grid->balls + 4 * (size_t)pair->b)) continue;
    if (grid->apart > 0 && is_apart(grid, spheres, pair)) {
      *missed += !keep_apart(grid, pair);
      continue;
    }
    if (grid->strides) note_passed(grid, spheres, pair, dt_s);
    bool room = contact_count < grid->capacity;
    SporeContact *contact = room ? &grid->contacts[contact_count] : &beyond;
    if (!spore_narrow_contact(spheres, pair->a, pair->b, dt_s, is_soft(grid, spheres, pair), contact)) continue;
    if (room) contact_count++;
    else ++*missed;
  }
  return contact_count;
}

/* The way of a sphere in the step before is told by its velocity before or after that step. Of two spheres that moved
 * by the smaller radius against each other, one moved by half of it; what gains speed within a step has had half of it.
 */
static void find_balls(SporeGrid *grid, const SporeSpheres *spheres, double dt_s) {
  size_t first = grid->static_count, count = grid->count - first;
  double *balls = grid->balls + 4 * first;
  double widest = spore_cells_find_balls(spheres, first, count, grid->ahead * dt_s, balls);
  bool fast = widest > 0.25 * grid->ahead * grid->smallest;
  grid->strides = spheres->before && dt_s > 0 && (fast || grid->fast);
  grid->fast = fast;
  if (grid->strides) spore_cells_add_ways(spheres, first, count, balls);
}

size_t spore_grid_detect(SporeGrid *grid, const SporeSpheres *spheres, double dt_s, size_t *missed) {
  assert(dt_s >= 0 && isfinite(dt_s));
  assert(spheres->count == grid->count && spheres->static_count == grid->static_count);
  find_balls(grid, spheres, dt_s);
  if (!grid->listed || !list_serves(grid)) renew_list(grid, spheres);
  grid->list_steps++;
  *missed = 0;
  size_t count = find_contacts(grid, spheres, dt_s, missed);
  if (grid->missed_pairs) *missed = grid->pair_count + grid->missed_pairs - count;
  return count;
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

/* INFINITY where there is no sphere. */
static double smallest_radius(const SporeSpheres *spheres) {
  double smallest = INFINITY;
  for (size_t i = 0; i < spheres->count; i++) smallest = fmin(smallest, spheres->radius[i]);
  return smallest;
}

static SporeCellScale scale_of(const SporeSpheres *spheres) {
  size_t first = spheres->static_count < spheres->count ? spheres->static_count : 0;
  if (spheres->count == 0) return spore_cell_scale((SporeVec3){0, 0, 0}, 1, 1);
  double smallest = smallest_radius(spheres);
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
  memcpy(grid->balls, balls, 4 * grid->static_count * sizeof *balls);
  if (grid->bounds) spore_grid_add_bounds(grid->bounds, spheres, 0, grid->static_count, balls);
  spore_cells_fill(&grid->unmovable, &grid->scale, spheres, 0, grid->static_count, NULL);
}

static bool is_lone(const SporeGrid *grid, const SporeSpheres *spheres) {
  for (size_t i = grid->static_count; i < grid->count; i++)
    if (spheres->body[i] != spheres->body[grid->static_count] || grid->bodies[spheres->body[i]] & SPORE_GRID_SELF)
      return false;
  return true;
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
  grid->smallest = smallest_radius(spheres);
  grid->pause = SPORE_GRID_SHORTEST_PAUSE;
  grid->balls = SPORE_NEW_ARRAY(double, 4 * spheres->count);
  grid->bodies = SPORE_NEW_ARRAY(unsigned char, body_count);
  grid->bucket = SPORE_NEW_ARRAY(uint32_t, spheres->count + 1);
  bool complete = grid->bodies && grid->balls && grid->bucket &&
                  spore_cells_create(&grid->unmovable, grid->static_count) &&
                  spore_cells_create(&grid->moving, grid->count - grid->static_count) &&
                  spore_grid_reserve(grid, contact_capacity) && create_regions(grid);
  if (!complete) {
    spore_grid_free(grid);
    return NULL;
  }
  memcpy(grid->bodies, bodies, body_count);
  grid->lone = is_lone(grid, spheres);
  place_unmovable(grid, spheres);
  return grid;
}

/* Fills the exclusion list from the sorted pairs of a grid. */
static bool take_exclusions(SporeGrid *grid, const SporeGrid *rest) {
  assert(grid->count == rest->count);
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

/* The pairs to exclude are the pairs at rest among spheres that are larger by the margin; in the grid that finds them,
 * bodies collide only with themselves. */
static bool build_exclusions(SporeGrid *grid, const SporeSpheres *rest, double *still, double *wider,
                             unsigned char *selves) {
  SporeSpheres spheres = *rest;
  spheres.radius = wider;
  spheres.velocity = still;
  spheres.before = NULL;
  for (size_t i = 0; i < rest->count; i++) wider[i] = rest->radius[i] * (1 + SPORE_GRID_SELF_MARGIN);
  for (size_t i = 0; i < grid->body_count; i++) selves[i] = grid->bodies[i] & SPORE_GRID_SELF;
  SporeGrid *finder = create_plain(&spheres, selves, grid->body_count, 0);
  if (!finder) return false;
  spore_cells_find_balls(&spheres, 0, finder->count, 0, finder->balls);
  list_pairs(finder, &spheres, 0);
  bool complete = finder->missed_pairs == 0 || spore_grid_reserve(finder, finder->pair_capacity + finder->missed_pairs);
  if (complete) {
    spore_grid_find_pairs(finder, &spheres);
    spore_grid_sort_pairs(finder);
    complete = take_exclusions(grid, finder);
  }
  spore_grid_free(finder);
  return complete;
}

static bool some_meet_themselves(const SporeGrid *grid) {
  for (size_t i = 0; i < grid->body_count; i++)
    if (grid->bodies[i] & SPORE_GRID_SELF) return true;
  return false;
}

static bool exclude_rest_contacts(SporeGrid *grid, const SporeSpheres *rest) {
  if (!some_meet_themselves(grid)) return true;
  double *still = SPORE_NEW_ARRAY(double, 3 * rest->count), *wider = SPORE_NEW_ARRAY(double, rest->count);
  unsigned char *selves = SPORE_NEW_ARRAY(unsigned char, grid->body_count);
  bool complete = still && wider && selves && build_exclusions(grid, rest, still, wider, selves);
  spore_free(still);
  spore_free(wider);
  spore_free(selves);
  return complete;
}

static unsigned char flags_of(const SporeGridBody *body) {
  if (!body->passive) return body->active ? SPORE_GRID_ACTIVE : 0;
  return (unsigned char)(SPORE_GRID_PASSIVE | (body->self ? SPORE_GRID_SELF : 0) | (body->soft ? SPORE_GRID_SOFT : 0));
}

/* Steps that some pair is looked ahead for. */
static double steps_ahead(const SporeGridBody *bodies, size_t body_count) {
  for (size_t i = 0; i < body_count; i++)
    if (bodies[i].passive && !bodies[i].soft) return SPORE_SPHERES_AHEAD;
  return 1;
}

static bool take_groups(SporeGrid *grid, const SporeGridBody *bodies) {
  uint32_t any = 0;
  for (size_t i = 0; i < grid->body_count; i++) any |= bodies[i].group;
  if (!any) return true;
  grid->group = SPORE_NEW_ARRAY(uint32_t, grid->body_count);
  for (size_t i = 0; grid->group && i < grid->body_count; i++) grid->group[i] = bodies[i].group;
  return grid->group;
}

SporeGrid *spore_grid_create(const SporeSpheres *rest, const SporeGridBody *bodies, size_t body_count,
                             size_t contact_capacity, SporeError *error) {
  assert(body_count == 0 || bodies);
  if (!check_spheres(rest, body_count, error)) return NULL;
  unsigned char *flags = SPORE_NEW_ARRAY(unsigned char, body_count);
  for (size_t i = 0; flags && i < body_count; i++) flags[i] = flags_of(&bodies[i]);
  SporeGrid *grid = flags ? create_plain(rest, flags, body_count, contact_capacity) : NULL;
  spore_free(flags);
  if (grid) grid->ahead = steps_ahead(bodies, body_count);
  if (grid && take_groups(grid, bodies) && exclude_rest_contacts(grid, rest)) return grid;
  spore_grid_free(grid);
  refuse_memory(error);
  return NULL;
}

void spore_grid_free(SporeGrid *grid) {
  if (!grid) return;
  spore_cells_clear(&grid->unmovable);
  spore_cells_clear(&grid->moving);
  spore_free(grid->bodies);
  spore_free(grid->group);
  spore_free(grid->balls);
  spore_free(grid->bounds);
  spore_free(grid->regions);
  spore_free(grid->excluded_start);
  spore_free(grid->excluded);
  spore_free(grid->contacts);
  spore_free(grid->passed);
  spore_free(grid->apart_pairs);
  spore_free(grid->pairs);
  spore_free(grid->sorted_pairs);
  spore_free(grid->bucket);
  spore_free(grid);
}

bool spore_grid_reserve(SporeGrid *grid, size_t contact_capacity) {
  if (contact_capacity == 0) contact_capacity = 4 * (grid->count - grid->static_count) + 64;
  size_t pair_capacity = CONTACT_PAIRS * contact_capacity;
  SporeContact *contacts = SPORE_NEW_ARRAY(SporeContact, contact_capacity);
  SporeContact *passed = SPORE_NEW_ARRAY(SporeContact, contact_capacity);
  SporePair *apart_pairs = SPORE_NEW_ARRAY(SporePair, contact_capacity);
  SporePair *pairs = SPORE_NEW_ARRAY(SporePair, pair_capacity),
            *sorted_pairs = SPORE_NEW_ARRAY(SporePair, pair_capacity);
  if (!contacts || !passed || !apart_pairs || !pairs || !sorted_pairs) {
    spore_free(contacts);
    spore_free(passed);
    spore_free(apart_pairs);
    spore_free(pairs);
    spore_free(sorted_pairs);
    return false;
  }
  spore_free(grid->contacts);
  spore_free(grid->passed);
  spore_free(grid->apart_pairs);
  spore_free(grid->pairs);
  spore_free(grid->sorted_pairs);
  grid->contacts = contacts;
  grid->passed = passed;
  grid->apart_pairs = apart_pairs;
  grid->passed_count = grid->apart_count = 0;
  grid->pairs = pairs;
  grid->sorted_pairs = sorted_pairs;
  grid->capacity = contact_capacity;
  grid->pair_capacity = pair_capacity;
  grid->listed = false;
  return true;
}

const SporeContact *spore_grid_contacts(const SporeGrid *grid) { return grid->contacts; }

size_t spore_grid_capacity(const SporeGrid *grid) { return grid->capacity; }

size_t spore_grid_passed(const SporeGrid *grid, const SporeContact **passed) {
  assert(passed);
  *passed = grid->passed;
  return grid->passed_count;
}

size_t spore_grid_apart(const SporeGrid *grid, const SporePair **pairs) {
  assert(pairs);
  *pairs = grid->apart_pairs;
  return grid->apart_count;
}

/* Pairs of bodies that would touch but for their group. */
static size_t grouped_pairs(const SporeGridBody *bodies, size_t body_count) {
  size_t pairs = 0;
  for (size_t i = 0; i < body_count; i++)
    for (size_t j = i + 1; bodies[i].group && j < body_count; j++)
      pairs += bodies[i].group == bodies[j].group &&
               (bodies[i].passive || bodies[j].passive || bodies[i].active != bodies[j].active);
  return pairs;
}

size_t spore_grid_body_pairs(const SporeGridBody *bodies, size_t body_count) {
  size_t passive = 0, active = 0, selves = 0;
  for (size_t i = 0; i < body_count; i++) {
    passive += bodies[i].passive;
    active += !bodies[i].passive && bodies[i].active;
    selves += bodies[i].passive && bodies[i].self;
  }
  size_t others = body_count - passive, alike = passive * (passive - 1) / 2;
  return alike + passive * others + active * (others - active) + selves - grouped_pairs(bodies, body_count);
}
