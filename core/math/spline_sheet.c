/* Points of a sheet, and the place that is nearest to a point. */
#include "core/math/spline_sheet.h"

#include <math.h>
#include <stdbool.h>

SporeSheetPlace spore_spline_sheet_place(const SporeSplineSheet *sheet, const double at[2]) {
  SporeSheetPlace place;
  SporeSplineBasis x = spore_spline_basis(spore_spline_uniform(sheet->span[0]), at[0], &place.first[0]);
  SporeSplineBasis y = spore_spline_basis(spore_spline_uniform(sheet->span[1]), at[1], &place.first[1]);
  const double *factor[6][2] = {{x.value, y.value},  {x.first, y.value},  {x.value, y.first},
                                {x.second, y.value}, {x.value, y.second}, {x.first, y.first}};
  for (int d = 0; d < 6; d++)
    for (size_t k = 0; k < 16; k++) place.weight[d][k] = factor[d][0][k % 4] * factor[d][1][k / 4];
  return place;
}

SporeVec3 spore_spline_sheet_point(const SporeSplineSheet *sheet, const SporeSheetPlace *place, int derivative) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 16; k++) {
    size_t node = (place->first[1] + k / 4) * (sheet->span[0] + 3) + place->first[0] + k % 4;
    sum = spore_vec3_add_scaled(sum, place->weight[derivative][k], spore_vec3_load(sheet->control + 3 * node));
  }
  return sum;
}

double spore_spline_sheet_approach(const SporeSplineSheet *sheet, SporeVec3 p, double at[2]) {
  SporeSheetPlace place = spore_spline_sheet_place(sheet, at);
  SporeVec3 off = spore_vec3_sub(spore_spline_sheet_point(sheet, &place, 0), p),
            u = spore_spline_sheet_point(sheet, &place, 1), v = spore_spline_sheet_point(sheet, &place, 2);
  double uu = spore_vec3_dot(u, u), vv = spore_vec3_dot(v, v), uv = spore_vec3_dot(u, v);
  double bent[3], slope[2] = {spore_vec3_dot(off, u), spore_vec3_dot(off, v)};
  for (int k = 0; k < 3; k++) bent[k] = spore_vec3_dot(off, spore_spline_sheet_point(sheet, &place, 3 + k));
  double full = (uu + bent[0]) * (vv + bent[1]) - (uv + bent[2]) * (uv + bent[2]);
  if (uu + bent[0] > 0.5 * uu && full > 0.25 * (uu * vv - uv * uv)) uu += bent[0], vv += bent[1], uv += bent[2];
  bool held[2];
  for (int e = 0; e < 2; e++)
    held[e] = (at[e] <= 0 && slope[e] > 0) || (at[e] >= (double)sheet->span[e] && slope[e] < 0);
  if (held[0] || held[1]) uv = 0;
  double determinant = uu * vv - uv * uv;
  double change[2] = {(uv * slope[1] - vv * slope[0]) / determinant, (uv * slope[0] - uu * slope[1]) / determinant};
  double moved = 0;
  for (int e = 0; e < 2; e++) {
    double from = at[e];
    if (!held[e]) at[e] = fmin(fmax(at[e] + fmin(fmax(change[e], -0.5), 0.5), 0), (double)sheet->span[e]);
    moved = fmax(moved, fabs(at[e] - from));
  }
  return moved;
}
