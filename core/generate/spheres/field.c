/* Points in blocks, balls as columns, and the depth field of the balls at the points. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres/kernels.h"
#include "core/generate/spheres/private.h"
#include "core/mesh/sort.h"

/* Spreads 21 bits to every third place (Morton order). */
static uint64_t spread_bits(uint64_t v) {
  v = (v | v << 32) & UINT64_C(0x1f00000000ffff);
  v = (v | v << 16) & UINT64_C(0x1f0000ff0000ff);
  v = (v | v << 8) & UINT64_C(0x100f00f00f00f00f);
  v = (v | v << 4) & UINT64_C(0x10c30c30c30c30c3);
  return (v | v << 2) & UINT64_C(0x1249249249249249);
}

static bool morton_order(const double *xyz, size_t count, uint32_t *order) {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, extent = 0;
  uint64_t *keys = SPORE_NEW_ARRAY(uint64_t, count);
  if (!keys) return false;
  for (size_t i = 0; i < 3 * count; i++) {
    lower[i % 3] = fmin(lower[i % 3], xyz[i]);
    upper[i % 3] = fmax(upper[i % 3], xyz[i]);
  }
  for (int k = 0; k < 3; k++) extent = fmax(extent, upper[k] - lower[k]);
  double scale = extent > 0 ? 0x1fffff / extent : 0;
  for (size_t i = 0; i < count; i++) {
    order[i] = (uint32_t)i;
    for (int k = 0; k < 3; k++) keys[i] |= spread_bits((uint64_t)((xyz[3 * i + k] - lower[k]) * scale)) << k;
  }
  bool done = spore_sort_keys(keys, order, count);
  spore_free(keys);
  return done;
}

/* Bounding sphere of the points first .. end - 1, centred in their bounding box. */
static void bound_points(const SporePoints *points, size_t first, size_t end, double bound[4]) {
  const double *column[3] = {points->x, points->y, points->z};
  double radius = 0;
  for (int k = 0; k < 3; k++) {
    double low = column[k][first], high = low;
    for (size_t i = first; i < end; i++) low = fmin(low, column[k][i]), high = fmax(high, column[k][i]);
    bound[k] = 0.5 * (low + high);
  }
  for (size_t i = first; i < end; i++)
    radius =
        fmax(radius, spore_vec3_distance(spore_vec3(points->x[i], points->y[i], points->z[i]), spore_vec3_load(bound)));
  bound[3] = radius;
}

/* The block's points relative to its middle. */
static void load_local(SporePoints *points, size_t b) {
  const double *middle = points->block + 4 * b, *columns[3] = {points->x, points->y, points->z};
  for (size_t k = 0; k < 3; k++)
    for (size_t i = 0; i < SPORE_BLOCK; i++)
      points->local[SPORE_BLOCK * (3 * b + k) + i] = (float)(columns[k][b * SPORE_BLOCK + i] - middle[k]);
}

bool spore_points_create(SporePoints *points, const double *xyz, size_t count) {
  size_t blocks = (count + SPORE_BLOCK - 1) / SPORE_BLOCK, padded = blocks * SPORE_BLOCK;
  size_t groups = (blocks + SPORE_GROUP - 1) / SPORE_GROUP, wide = SPORE_GROUP * SPORE_BLOCK;
  *points = (SporePoints){.count = count,
                          .block_count = blocks,
                          .group_count = groups,
                          .x = SPORE_NEW_ARRAY(double, padded),
                          .y = SPORE_NEW_ARRAY(double, padded),
                          .z = SPORE_NEW_ARRAY(double, padded),
                          .block = SPORE_NEW_ARRAY(double, 4 * blocks),
                          .group = SPORE_NEW_ARRAY(double, 4 * groups),
                          .local = SPORE_NEW_ARRAY(float, 3 * padded),
                          .original = SPORE_NEW_ARRAY(uint32_t, count)};
  if (!points->x || !points->y || !points->z || !points->block || !points->group || !points->local ||
      !points->original || !morton_order(xyz, count, points->original)) {
    spore_points_clear(points);
    return false;
  }
  for (size_t i = 0; i < padded; i++) {
    const double *p = xyz + 3 * (size_t)points->original[i < count ? i : count - 1];
    points->x[i] = p[0], points->y[i] = p[1], points->z[i] = p[2];
  }
  for (size_t b = 0; b < blocks; b++) {
    bound_points(points, b * SPORE_BLOCK, (b + 1) * SPORE_BLOCK, points->block + 4 * b);
    load_local(points, b);
  }
  for (size_t g = 0; g < groups; g++)
    bound_points(points, g * wide, (g + 1) * wide < padded ? (g + 1) * wide : padded, points->group + 4 * g);
  return true;
}

void spore_points_clear(SporePoints *points) {
  spore_free(points->x);
  spore_free(points->y);
  spore_free(points->z);
  spore_free(points->block);
  spore_free(points->group);
  spore_free(points->local);
  spore_free(points->original);
  *points = (SporePoints){0};
}

bool spore_balls_create(SporeBalls *balls, size_t count) {
  double *memory = SPORE_NEW_ARRAY(double, 4 * count);
  *balls = (SporeBalls){0};
  if (memory) *balls = (SporeBalls){count, memory, memory + count, memory + 2 * count, memory + 3 * count};
  return memory;
}

void spore_balls_clear(SporeBalls *balls) {
  spore_free(balls->x);
  *balls = (SporeBalls){0};
}

void spore_balls_copy(SporeBalls *to, const SporeBalls *from) {
  memcpy(to->x, from->x, 4 * from->count * sizeof *to->x);
}

bool spore_field_create(SporeField *field, const SporePoints *points, size_t ball_count) {
  size_t padded = points->block_count * SPORE_BLOCK;
  *field = (SporeField){.best = SPORE_NEW_ARRAY(double, padded),
                        .second = SPORE_NEW_ARRAY(double, padded),
                        .owner = SPORE_NEW_ARRAY(uint32_t, padded),
                        .value = SPORE_NEW_ARRAY(double, ball_count),
                        .number = SPORE_NEW_ARRAY(uint32_t, ball_count),
                        .listed = SPORE_NEW_ARRAY(uint32_t, ball_count),
                        .local = SPORE_NEW_ARRAY(float, 5 * ball_count),
                        .capacity = ball_count};
  if (spore_balls_create(&field->near, ball_count) && field->best && field->second && field->owner && field->value &&
      field->number && field->listed && field->local)
    return true;
  spore_field_clear(field);
  return false;
}

void spore_field_clear(SporeField *field) {
  spore_free(field->best);
  spore_free(field->second);
  spore_free(field->owner);
  spore_free(field->value);
  spore_free(field->number);
  spore_free(field->listed);
  spore_free(field->local);
  spore_balls_clear(&field->near);
  *field = (SporeField){0};
}

static double ball_values(const SporeBalls *balls, const double p[3], double *values) {
  return SPORE_KERNEL(spore_balls_values)(balls->x, balls->y, balls->z, balls->r, balls->count, p, values);
}

/* The numbers of the values that are at least `least`; returns how many. Without a branch, as which ones are is hard to
 * foretell. */
static size_t list_near(const double *value, size_t count, double least, uint32_t *list) {
  size_t near = 0;
  for (size_t i = 0; i < count; i++) {
    list[near] = (uint32_t)i;
    near += value[i] >= least;
  }
  return near;
}

/* Gathers the balls whose value at the middle of the group is at least `least`. */
static void gather_near(SporeField *field, const SporeBalls *balls, double least) {
  SporeBalls *near = &field->near;
  near->count = list_near(field->value, balls->count, least, field->number);
  for (size_t n = 0; n < near->count; n++) {
    uint32_t i = field->number[n];
    near->x[n] = balls->x[i], near->y[n] = balls->y[i], near->z[n] = balls->z[i], near->r[n] = balls->r[i];
  }
}

/* Evaluates the near balls at the block's points, relative to the block's middle, in single precision. */
static void evaluate_block(SporeField *field, const SporePoints *points, size_t b, double least) {
  const double *middle = points->block + 4 * b;
  const float *local = points->local + 3 * SPORE_BLOCK * b;
  const SporeBalls *balls = &field->near;
  float best[SPORE_BLOCK], second[SPORE_BLOCK], owner[SPORE_BLOCK];
  float *x = field->local, *y = x + field->capacity, *z = y + field->capacity, *r = z + field->capacity,
        *number = r + field->capacity;
  SporeNearBalls near = {list_near(field->value, balls->count, least, field->listed), x, y, z, r, number};
  for (size_t n = 0; n < near.count; n++) {
    uint32_t i = field->listed[n];
    x[n] = (float)(balls->x[i] - middle[0]), y[n] = (float)(balls->y[i] - middle[1]);
    z[n] = (float)(balls->z[i] - middle[2]), r[n] = (float)balls->r[i];
    number[n] = (float)(int32_t)field->number[i];
  }
  SPORE_KERNEL(spore_field_block)
  (&near, local, local + SPORE_BLOCK, local + 2 * SPORE_BLOCK, best, second, owner);
  for (size_t k = 0, at = b * SPORE_BLOCK; k < SPORE_BLOCK; k++, at++) {
    field->best[at] = (double)best[k], field->second[at] = (double)second[k];
    field->owner[at] = (uint32_t)(int32_t)owner[k];
  }
}

/* Within R of the middle no value changes by more than R. So a ball whose value at the middle is 2 R below the second
 * largest is third at best. */
static double least_value(double second, double radius) { return second - 2 * radius * (1 + 1e-12); }

static size_t group_end(const SporePoints *points, size_t g) {
  size_t end = (g + 1) * SPORE_GROUP;
  return end < points->block_count ? end : points->block_count;
}

double spore_field_evaluate_group(SporeField *field, const SporePoints *points, const SporeBalls *balls, size_t g) {
  const double *group = points->group + 4 * g;
  double least = least_value(ball_values(balls, group, field->value), group[3]);
  gather_near(field, balls, least);
  for (size_t b = g * SPORE_GROUP; b < group_end(points, g); b++) {
    const double *block = points->block + 4 * b;
    double second = ball_values(&field->near, block, field->value);
    evaluate_block(field, points, b, least_value(second, block[3]));
  }
  return least;
}

void spore_field_evaluate(SporeField *field, const SporePoints *points, const SporeBalls *balls) {
  for (size_t g = 0; g < points->group_count; g++) spore_field_evaluate_group(field, points, balls, g);
}

static void count_held(const SporePoints *points, size_t b, const SporeBalls *balls, const double *value,
                       uint32_t *held) {
  for (size_t i = 0; i < balls->count; i++) {
    if (value[i] < -points->block[4 * b + 3] * (1 + 1e-12)) continue;
    double r2 = balls->r[i] * balls->r[i] * (1 + 1e-12);
    for (size_t k = b * SPORE_BLOCK; k < (b + 1) * SPORE_BLOCK; k++) {
      double dx = balls->x[i] - points->x[k], dy = balls->y[i] - points->y[k], dz = balls->z[i] - points->z[k];
      held[k] += dx * dx + dy * dy + dz * dz <= r2;
    }
  }
}

void spore_field_multiplicity(SporeField *field, const SporePoints *points, const SporeBalls *balls, uint32_t *held) {
  memset(held, 0, points->block_count * SPORE_BLOCK * sizeof *held);
  for (size_t g = 0; g < points->group_count; g++) {
    const double *group = points->group + 4 * g;
    ball_values(balls, group, field->value);
    gather_near(field, balls, -group[3] * (1 + 1e-12));
    for (size_t b = g * SPORE_GROUP; b < group_end(points, g); b++) {
      ball_values(&field->near, points->block + 4 * b, field->value);
      count_held(points, b, &field->near, field->value, held);
    }
  }
}

size_t spore_balls_images(const SporeSymmetry *symmetry, const SporeBalls *balls, const uint8_t *bound,
                          double *spheres) {
  size_t count = 0;
  for (size_t i = 0; i < balls->count; i++)
    for (unsigned planes = 0; planes < 1u << symmetry->count; planes++) {
      if (bound && planes & bound[i]) continue;
      double *sphere = spheres ? spheres + 4 * count : NULL;
      count++;
      if (!sphere) continue;
      spore_vec3_store(sphere, spore_symmetry_mirror(symmetry, planes, spore_balls_centre(balls, i)));
      sphere[3] = balls->r[i];
    }
  return count;
}

void spore_progress_show_images(const SporeProgressPart *part, const SporeSymmetry *symmetry, const SporeBalls *balls,
                                const uint8_t *bound) {
  if (!part->whole || !part->whole->show) return;
  size_t count = spore_balls_images(symmetry, balls, bound, NULL);
  double *spheres = SPORE_NEW_ARRAY(double, 4 * count);
  if (!spheres) return; /* this display update is skipped */
  spore_balls_images(symmetry, balls, bound, spheres);
  part->whole->show(part->whole->data, spheres, count);
  spore_free(spheres);
}

void spore_progress_show_balls(const SporeProgressPart *part, const SporeBalls *balls) {
  spore_progress_show_images(part, &(SporeSymmetry){0}, balls, NULL);
}
