#include "models/spline/carry.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/mat3.h"

double spore_carry_offset(const double *points, size_t count, SporeVec3 offset, double nothing, double *weight,
                          double *work) {
  assert(count > 0);
  assert(weight != work);
  assert(nothing >= 0);
  SporeVec3 centre = {0, 0, 0};
  for (size_t i = 0; i < count; i++)
    centre = spore_vec3_add_scaled(centre, 1 / (double)count, spore_vec3_load(points + 3 * i));
  SporeMat3 square = {{0}}, axes;
  double value[3], sum = 0, mean = 0;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(points + 3 * i), centre);
    square = spore_mat3_add(square, spore_mat3_outer(arm, arm));
  }
  spore_mat3_eigen_symmetric(square, value, &axes);
  memset(work, 0, count * sizeof *work);
  for (int k = 0; k < 3; k++) {
    SporeVec3 axis = spore_mat3_column(axes, k);
    double part = spore_vec3_dot(offset, axis);
    if (fabs(part) <= nothing) continue;
    for (size_t i = 0; i < count; i++)
      work[i] += part / value[k] * spore_vec3_dot(axis, spore_vec3_sub(spore_vec3_load(points + 3 * i), centre));
  }
  for (size_t i = 0; i < count; i++) mean += work[i] / (double)count; /* rounding */
  for (size_t i = 0; i < count; i++) {
    weight[i] += work[i] - mean;
    sum += fabs(work[i]);
  }
  return isfinite(sum) ? sum : HUGE_VAL;
}

double spore_carry_size(const double *points, size_t count) {
  assert(count > 0);
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < 3 * count; i++) {
    lower[i % 3] = fmin(lower[i % 3], points[i]);
    upper[i % 3] = fmax(upper[i % 3], points[i]);
  }
  return spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
}
