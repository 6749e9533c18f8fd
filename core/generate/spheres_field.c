#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres_parts.h"
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

/* Middle of the box, and the farthest point from it. */
static void bound_block(const SporePoints *points, size_t b) {
  const double *column[3] = {points->x + b * SPORE_BLOCK, points->y + b * SPORE_BLOCK, points->z + b * SPORE_BLOCK};
  double *block = points->block + 4 * b, radius = 0;
  for (int k = 0; k < 3; k++) {
    double low = column[k][0], high = low;
    for (int i = 1; i < SPORE_BLOCK; i++) low = fmin(low, column[k][i]), high = fmax(high, column[k][i]);
    block[k] = 0.5 * (low + high);
  }
  for (int i = 0; i < SPORE_BLOCK; i++)
    radius =
        fmax(radius, spore_vec3_distance(spore_vec3(column[0][i], column[1][i], column[2][i]), spore_vec3_load(block)));
  block[3] = radius;
}

bool spore_points_create(SporePoints *points, const double *xyz, size_t count) {
  size_t blocks = (count + SPORE_BLOCK - 1) / SPORE_BLOCK, padded = blocks * SPORE_BLOCK;
  *points = (SporePoints){.count = count,
                          .block_count = blocks,
                          .x = SPORE_NEW_ARRAY(double, padded),
                          .y = SPORE_NEW_ARRAY(double, padded),
                          .z = SPORE_NEW_ARRAY(double, padded),
                          .block = SPORE_NEW_ARRAY(double, 4 * blocks),
                          .original = SPORE_NEW_ARRAY(uint32_t, count)};
  if (!points->x || !points->y || !points->z || !points->block || !points->original ||
      !morton_order(xyz, count, points->original)) {
    spore_points_clear(points);
    return false;
  }
  for (size_t i = 0; i < padded; i++) {
    const double *p = xyz + 3 * (size_t)points->original[i < count ? i : count - 1];
    points->x[i] = p[0], points->y[i] = p[1], points->z[i] = p[2];
  }
  for (size_t b = 0; b < blocks; b++) bound_block(points, b);
  return true;
}

void spore_points_clear(SporePoints *points) {
  spore_free(points->x);
  spore_free(points->y);
  spore_free(points->z);
  spore_free(points->block);
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
  *field = (SporeField){SPORE_NEW_ARRAY(double, padded), SPORE_NEW_ARRAY(double, padded),
                        SPORE_NEW_ARRAY(uint32_t, padded), SPORE_NEW_ARRAY(double, ball_count)};
  if (field->best && field->second && field->owner && field->near_block) return true;
  spore_field_clear(field);
  return false;
}

void spore_field_clear(SporeField *field) {
  spore_free(field->best);
  spore_free(field->second);
  spore_free(field->owner);
  spore_free(field->near_block);
  *field = (SporeField){0};
}

/* r_i - distance for the middle of the block; returns the second largest (the largest when there is one ball). */
static double block_values(const SporeBalls *balls, const double *block, double *values) {
  double x = block[0], y = block[1], z = block[2], first = -HUGE_VAL, second = -HUGE_VAL;
  for (size_t i = 0; i < balls->count; i++) {
    double dx = balls->x[i] - x, dy = balls->y[i] - y, dz = balls->z[i] - z;
    values[i] = balls->r[i] - sqrt(dx * dx + dy * dy + dz * dz);
  }
  for (size_t i = 0; i < balls->count; i++) {
    double v = values[i];
    if (v <= second) continue;
    second = v > first ? first : v;
    first = v > first ? v : first;
  }
  return balls->count > 1 ? second : first;
}

static void evaluate_block(const SporePoints *points, size_t b, const SporeBalls *balls, const double *values,
                           double least, SporeField *field) {
  const double *x = points->x + b * SPORE_BLOCK, *y = points->y + b * SPORE_BLOCK, *z = points->z + b * SPORE_BLOCK;
  double best[SPORE_BLOCK], second[SPORE_BLOCK], owner[SPORE_BLOCK];
  for (int k = 0; k < SPORE_BLOCK; k++) best[k] = second[k] = -HUGE_VAL, owner[k] = 0;
  for (size_t i = 0; i < balls->count; i++) {
    if (values[i] < least) continue;
    double cx = balls->x[i], cy = balls->y[i], cz = balls->z[i], r = balls->r[i], index = (double)i;
    for (int k = 0; k < SPORE_BLOCK; k++) {
      double dx = cx - x[k], dy = cy - y[k], dz = cz - z[k];
      double v = r - sqrt(dx * dx + dy * dy + dz * dz), b1 = best[k], b2 = second[k];
      double lower = v > b2 ? v : b2;
      second[k] = v > b1 ? b1 : lower;
      owner[k] = v > b1 ? index : owner[k];
      best[k] = v > b1 ? v : b1;
    }
  }
  memcpy(field->best + b * SPORE_BLOCK, best, sizeof best);
  memcpy(field->second + b * SPORE_BLOCK, second, sizeof second);
  for (int k = 0; k < SPORE_BLOCK; k++) field->owner[b * SPORE_BLOCK + k] = (uint32_t)owner[k];
}

void spore_field_evaluate(SporeField *field, const SporePoints *points, const SporeBalls *balls) {
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    double second = block_values(balls, block, field->near_block);
    evaluate_block(points, b, balls, field->near_block, second - 2 * block[3] * (1 + 1e-12), field);
  }
}

void spore_field_multiplicity(SporeField *field, const SporePoints *points, const SporeBalls *balls, uint32_t *held) {
  memset(held, 0, points->block_count * SPORE_BLOCK * sizeof *held);
  for (size_t b = 0; b < points->block_count; b++) {
    size_t first = b * SPORE_BLOCK;
    block_values(balls, points->block + 4 * b, field->near_block);
    for (size_t i = 0; i < balls->count; i++) {
      if (field->near_block[i] < -points->block[4 * b + 3]) continue;
      double r2 = balls->r[i] * balls->r[i] * (1 + 1e-12);
      for (size_t k = first; k < first + SPORE_BLOCK; k++) {
        double dx = balls->x[i] - points->x[k], dy = balls->y[i] - points->y[k], dz = balls->z[i] - points->z[k];
        held[k] += dx * dx + dy * dy + dz * dz <= r2;
      }
    }
  }
}
