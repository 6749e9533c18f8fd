/* Inner loops of sphere sets, compiled once for each instruction set. */
#include "core/generate/spheres/kernels.h"

#include <math.h>

#include "core/generate/spheres/private.h"

#define LANES SPORE_LOCAL_LANES /* of the widest instruction set: the values of this many points stay in registers */

/* Single precision is enough: lengths are relative to the block. */
void SPORE_LEVEL_NAME(spore_field_block)(const SporeNearBalls *balls, const float *x, const float *y, const float *z,
                                         float *best, float *second, float *owner) {
  for (size_t first = 0; first < SPORE_BLOCK; first += LANES) {
    float most[LANES], next[LANES], whose[LANES];
    for (int k = 0; k < LANES; k++) most[k] = next[k] = -HUGE_VALF, whose[k] = 0;
    for (size_t i = 0; i < balls->count; i++) {
      float cx = balls->x[i], cy = balls->y[i], cz = balls->z[i], r = balls->r[i], number = balls->number[i];
      for (int k = 0; k < LANES; k++) {
        float dx = cx - x[first + k], dy = cy - y[first + k], dz = cz - z[first + k];
        float value = r - sqrtf(dx * dx + dy * dy + dz * dz), before = most[k];
        float lower = value < before ? value : before;
        next[k] = lower > next[k] ? lower : next[k];
        whose[k] = value > before ? number : whose[k];
        most[k] = value > before ? value : before;
      }
    }
    for (int k = 0; k < LANES; k++) best[first + k] = most[k], second[first + k] = next[k], owner[first + k] = whose[k];
  }
}

/* The two largest of the values, lane by lane. */
static void add_values(const double *values, size_t lanes, double *restrict first, double *restrict second) {
  for (size_t k = 0; k < lanes; k++) {
    double value = values[k], before = first[k], lower = value < before ? value : before;
    second[k] = lower > second[k] ? lower : second[k];
    first[k] = value > before ? value : before;
  }
}

double SPORE_LEVEL_NAME(spore_balls_values)(const double *x, const double *y, const double *z, const double *r,
                                            size_t count, const double at[3], double *restrict values) {
  double ax = at[0], ay = at[1], az = at[2], first[SPORE_LANES], second[SPORE_LANES], most = -HUGE_VAL,
         next = -HUGE_VAL;
  size_t whole = count / SPORE_LANES * SPORE_LANES;
  for (size_t i = 0; i < count; i++) {
    double dx = x[i] - ax, dy = y[i] - ay, dz = z[i] - az;
    values[i] = r[i] - sqrt(dx * dx + dy * dy + dz * dz);
  }
  for (int k = 0; k < SPORE_LANES; k++) first[k] = second[k] = -HUGE_VAL;
  for (size_t i = 0; i < whole; i += SPORE_LANES) add_values(values + i, SPORE_LANES, first, second);
  add_values(values + whole, count - whole, first, second);
  for (int k = 0; k < SPORE_LANES; k++) {
    add_values(first + k, 1, &most, &next);
    add_values(second + k, 1, &most, &next);
  }
  return count > 1 ? next : most;
}

uint32_t SPORE_LEVEL_NAME(spore_block_between)(const double *x, const double *y, const double *z, const double at[3],
                                               double inner, double outer) {
  double square[SPORE_BLOCK];
  uint32_t bits = 0;
  for (int k = 0; k < SPORE_BLOCK; k++) {
    double dx = x[k] - at[0], dy = y[k] - at[1], dz = z[k] - at[2];
    square[k] = dx * dx + dy * dy + dz * dz;
  }
  for (int k = 0; k < SPORE_BLOCK; k++) bits |= (uint32_t)((square[k] <= outer) & (square[k] >= inner)) << k;
  return bits;
}

void SPORE_LEVEL_NAME(spore_block_depths)(const double *x, const double *y, const double *z, const double at[3],
                                          double radius, double *restrict depth) {
  double ax = at[0], ay = at[1], az = at[2];
  for (int k = 0; k < SPORE_BLOCK; k++) {
    double dx = x[k] - ax, dy = y[k] - ay, dz = z[k] - az;
    depth[k] = radius - sqrt(dx * dx + dy * dy + dz * dz);
  }
}

void SPORE_LEVEL_NAME(spore_balls_reach)(const double *x, const double *y, const double *z, const double *r,
                                         size_t count, const double bound[4], uint8_t *restrict reaches) {
  for (size_t i = 0; i < count; i++) {
    double dx = x[i] - bound[0], dy = y[i] - bound[1], dz = z[i] - bound[2], reach = r[i] + bound[3];
    reaches[i] = dx * dx + dy * dy + dz * dz < reach * reach;
  }
}

void SPORE_LEVEL_NAME(spore_local_distances)(const float *x, const float *y, const float *z, size_t count,
                                             const float at[3], float *restrict distance) {
  float cx = at[0], cy = at[1], cz = at[2];
  for (size_t first = 0; first < count; first += LANES)
    for (size_t k = first; k < first + LANES; k++) {
      float dx = x[k] - cx, dy = y[k] - cy, dz = z[k] - cz;
      distance[k] = sqrtf(dx * dx + dy * dy + dz * dz);
    }
}

/* Two sums, so that small costs are not lost to rounding beside large ones. */
void SPORE_LEVEL_NAME(spore_local_cost)(const float *distance, const float *cost, size_t count, float radius,
                                        SporeLocalCost *sum) {
  float outside[LANES] = {0}, inside[LANES] = {0}, farthest[LANES] = {0};
  for (size_t first = 0; first < count; first += LANES)
    for (int k = 0; k < LANES; k++) {
      float d = distance[first + k], c = cost[first + k]; /* factors of 0 or 1 instead of branches: lanes alike */
      int within = d <= radius;
      outside[k] += c * (float)(within & (c > 0));
      inside[k] += c * (float)(within & (c < 0));
      float needed = d * (float)(within & (c < 0));
      farthest[k] = needed > farthest[k] ? needed : farthest[k];
    }
  *sum = (SporeLocalCost){0};
  for (int k = 0; k < LANES; k++) {
    sum->outside += outside[k];
    sum->inside += inside[k];
    sum->farthest = farthest[k] > sum->farthest ? farthest[k] : sum->farthest;
  }
}

void SPORE_LEVEL_NAME(spore_local_bins)(const float *distance, size_t count, float first, float scale, int bins,
                                        int32_t *restrict bin) {
  float most = (float)bins;
  size_t whole = (count + LANES - 1) / LANES * LANES;
  for (size_t k = 0; k < whole; k++) {
    float at = (distance[k] - first) * scale + 1;
    at = at < most ? at : most;
    bin[k] = (int32_t)(0.5f * (at + fabsf(at))); /* 0 below 0, without a branch */
  }
}

static float sum_lanes(const float *lane) {
  float sum = 0;
  for (int k = 0; k < LANES; k++) sum += lane[k];
  return sum;
}

static void sum_depths(const SporeWeightedBlock *b, size_t first, float *restrict sum) {
  float all[LANES] = {0};
  for (size_t i = 0; i < b->count; i++) {
    float *restrict distance = b->distance + SPORE_BLOCK * i + first;
    float cx = b->x[i], cy = b->y[i], cz = b->z[i], r = b->r[i], w = b->weight[i];
    for (int k = 0; k < LANES; k++) {
      float dx = b->px[first + k] - cx, dy = b->py[first + k] - cy, dz = b->pz[first + k] - cz;
      distance[k] = sqrtf(dx * dx + dy * dy + dz * dz);
      float depth = r - distance[k];
      all[k] += w * (depth > 0 ? depth : 0);
    }
  }
  for (int k = 0; k < LANES; k++) sum[first + k] = all[k] - b->level;
}

/* Derivative of each sample's loss by the sum there. */
static void slopes_of_samples(const SporeWeightedBlock *b, const float *sum, float *restrict slope) {
  for (size_t k = 0; k < SPORE_BLOCK; k++) {
    float depth = b->depth[k], wrong = sum[k] - (depth > 0 ? depth : 0);
    wrong = depth < 0 && wrong < 0 ? 0 : wrong;
    slope[k] = b->share[k] * wrong / sqrtf(wrong * wrong + b->smoothing * b->smoothing);
  }
}

static float slope_of_level(const SporeWeightedBlock *b, const float *sum, const float *slope) {
  float all[LANES] = {0};
  for (size_t first = 0; first < SPORE_BLOCK; first += LANES)
    for (int k = 0; k < LANES; k++) all[k] -= sum[first + k] > -b->level ? slope[first + k] : 0;
  return sum_lanes(all);
}

void SPORE_LEVEL_NAME(spore_weighted_slopes)(const SporeWeightedBlock *b, float *restrict sum, float *restrict slopes) {
  float slope[SPORE_BLOCK];
  for (size_t first = 0; first < SPORE_BLOCK; first += LANES) sum_depths(b, first, sum);
  slopes_of_samples(b, sum, slope);
  slopes[5 * b->count] = slope_of_level(b, sum, slope);
  for (size_t i = 0; i < b->count; i++) {
    float cx = b->x[i], cy = b->y[i], cz = b->z[i], r = b->r[i], w = b->weight[i];
    const float *distances = b->distance + SPORE_BLOCK * i;
    float sx[LANES] = {0}, sy[LANES] = {0}, sz[LANES] = {0}, sr[LANES] = {0}, sw[LANES] = {0};
    for (size_t first = 0; first < SPORE_BLOCK; first += LANES)
      for (int k = 0; k < LANES; k++) {
        float dx = b->px[first + k] - cx, dy = b->py[first + k] - cy, dz = b->pz[first + k] - cz;
        float distance = distances[first + k], depth = r - distance;
        float s = depth > 0 ? slope[first + k] : 0, along = s / (distance > 1e-12f ? distance : 1e-12f);
        sx[k] += along * dx, sy[k] += along * dy, sz[k] += along * dz, sr[k] += s, sw[k] += s * depth;
      }
    float *out = slopes + 5 * i;
    out[0] = w * sum_lanes(sx), out[1] = w * sum_lanes(sy), out[2] = w * sum_lanes(sz), out[3] = w * sum_lanes(sr);
    out[4] = sum_lanes(sw);
  }
}

void SPORE_LEVEL_NAME(spore_rays_leave)(const float *x, const float *y, const float *z, size_t count,
                                        const float ball[4], float *restrict from) {
  float cx = ball[0], cy = ball[1], cz = ball[2], room = ball[3] * ball[3] - (cx * cx + cy * cy + cz * cz);
  for (size_t first = 0; first < count; first += LANES)
    for (size_t k = first; k < first + LANES; k++) {
      float along = cx * x[k] + cy * y[k] + cz * z[k], square = along * along + room;
      float half = sqrtf(square > 0 ? square : 0), leave = along + half;
      leave = square > 0 && along - half <= 1 ? leave : 0;
      from[k] = leave > from[k] ? leave : from[k];
    }
}

void SPORE_LEVEL_NAME(spore_rays_volume)(const float *x, const float *y, const float *z, const float *from,
                                         const float *to, size_t count, const float ball[4], float *sum) {
  float cx = ball[0], cy = ball[1], cz = ball[2], room = ball[3] * ball[3] - (cx * cx + cy * cy + cz * cz);
  float sums[LANES] = {0};
  for (size_t first = 0; first < count; first += LANES)
    for (int k = 0; k < LANES; k++) {
      float along = cx * x[first + k] + cy * y[first + k] + cz * z[first + k], square = along * along + room;
      float leave = square > 0 ? along + sqrtf(square > 0 ? square : 0) : 0, f = from[first + k];
      leave = leave < to[first + k] ? leave : to[first + k];
      sums[k] += leave > f ? leave * leave * leave - f * f * f : 0;
    }
  *sum = sum_lanes(sums);
}
