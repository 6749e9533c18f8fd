/* A sheet from its control points: Gauss points, places in the matrix. */
#include "models/spline/patch.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/spline/spline.h"

#define FUNCTIONS SPORE_PATCH_FUNCTIONS
#define FLAT 1e-9 /* of the curvature of the sheet's size: none */

/* Control point of a cell's function k. */
static uint32_t node_of(const SporePatch *patch, size_t cell, size_t k) {
  assert(cell < patch->cell_count && k < FUNCTIONS);
  size_t i = cell % patch->span_u + k % 4, j = cell / patch->span_u + k / 4;
  return (uint32_t)(j * (patch->span_u + 3) + i);
}

bool spore_patch_pattern(const SporePatch *patch, SporeBlockPattern *pattern) {
  size_t nodes_u = patch->span_u + 3, nodes_v = patch->span_v + 3;
  for (size_t j = 0; j < nodes_v; j++)
    for (size_t i = 0; i < nodes_u; i++)
      for (size_t l = j; l < nodes_v && l < j + 4; l++)
        for (size_t k = l == j ? i + 1 : i < 3 ? 0 : i - 3; k < nodes_u && k < i + 4; k++)
          if (!spore_block_pattern_add(pattern, (uint32_t)(j * nodes_u + i), (uint32_t)(l * nodes_u + k))) return false;
  return true;
}

static bool find_blocks(SporePatch *patch) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&pattern, spore_patch_nodes(patch));
  bool made = spore_patch_pattern(patch, &pattern) && spore_block_matrix_create(&matrix, &pattern);
  spore_block_pattern_clear(&pattern);
  if (!made) return false;
  for (size_t cell = 0; cell < patch->cell_count; cell++)
    for (size_t i = 0, pair = 0; i < FUNCTIONS; i++)
      for (size_t j = i; j < FUNCTIONS; j++, pair++) {
        uint32_t a = node_of(patch, cell, i), b = node_of(patch, cell, j);
        patch->upper[cell][pair] = (uint32_t)spore_block_matrix_find(&matrix, a, b);
        patch->lower[cell][pair] = (uint32_t)spore_block_matrix_find(&matrix, b, a);
      }
  spore_block_matrix_clear(&matrix);
  return true;
}

bool spore_patch_allocate(SporePatch *patch, size_t span_u, size_t span_v) {
  assert(span_u >= SPORE_PATCH_SPANS && span_v >= SPORE_PATCH_SPANS);
  patch->span_u = span_u, patch->span_v = span_v, patch->cell_count = span_u * span_v;
  patch->group_count = (patch->cell_count + SPORE_LANES - 1) / SPORE_LANES;
  patch->gauss = SPORE_NEW_ARRAY(SporePatchGauss, SPORE_PATCH_POINTS * patch->group_count);
  patch->node = SPORE_NEW_ARRAY(uint32_t, FUNCTIONS * SPORE_LANES * patch->group_count);
  patch->flat = spore_allocate(SPORE_PATCH_PAIRS * patch->group_count, sizeof *patch->flat);
  patch->damped = SPORE_NEW(SporePatchShape);
  if (!patch->damped) return false;
  patch->damped->shape = SPORE_NEW_ARRAY(double, 3 * spore_patch_nodes(patch));
  patch->damped->at = spore_allocate(SPORE_PATCH_POINTS * patch->group_count, sizeof *patch->damped->at);
  if (!patch->damped->shape || !patch->damped->at) return false;
  patch->upper = spore_allocate(patch->cell_count, sizeof *patch->upper);
  patch->lower = spore_allocate(patch->cell_count, sizeof *patch->lower);
  if (!patch->gauss || !patch->node || !patch->flat || !patch->upper || !patch->lower || !find_blocks(patch))
    return false;
  for (size_t cell = 0; cell < patch->cell_count; cell++)
    for (size_t k = 0; k < FUNCTIONS; k++)
      patch->node[(cell / SPORE_LANES * FUNCTIONS + k) * SPORE_LANES + cell % SPORE_LANES] = node_of(patch, cell, k);
  return true;
}

void spore_patch_clear(SporePatch *patch) {
  if (patch->damped) {
    spore_free(patch->damped->shape);
    spore_free(patch->damped->at);
    spore_free(patch->damped);
  }
  spore_free(patch->gauss);
  spore_free(patch->node);
  spore_free(patch->flat);
  spore_free(patch->upper);
  spore_free(patch->lower);
  *patch = (SporePatch){0};
}

/* What derivatives by u and v there are at a point of a cell: d[0] by u, then v, uu, vv, uv. */
typedef struct Derivatives {
  double value[FUNCTIONS], d[5][FUNCTIONS];
  SporeVec3 r[5];
} Derivatives;

static Derivatives derive(const SporePatch *patch, const double *control, size_t cell, double u, double v) {
  Derivatives all = {0};
  size_t span;
  SporeSplineBasis x = spore_spline_basis(spore_spline_uniform(patch->span_u), u, &span),
                   y = spore_spline_basis(spore_spline_uniform(patch->span_v), v, &span);
  for (size_t k = 0; k < FUNCTIONS; k++) {
    size_t i = k % 4, j = k / 4;
    all.value[k] = x.value[i] * y.value[j];
    const double d[5] = {x.first[i] * y.value[j], x.value[i] * y.first[j], x.second[i] * y.value[j],
                         x.value[i] * y.second[j], x.first[i] * y.first[j]};
    SporeVec3 p = spore_vec3_load(control + 3 * (size_t)node_of(patch, cell, k));
    for (int e = 0; e < 5; e++) {
      all.d[e][k] = d[e];
      all.r[e] = spore_vec3_add_scaled(all.r[e], d[e], p);
    }
  }
  return all;
}

/* From derivatives by u and v to derivatives by s1 (along dr/du) and s2 (across it). The second derivatives are taken
 * without their part in the sheet, that is, less what moves r along s1 and s2. Returns the area of a unit of u and
 * v. */
static double by_length(const Derivatives *all, double first[2][FUNCTIONS], double second[3][FUNCTIONS],
                        double curvature[3]) {
  SporeVec3 cross = spore_vec3_cross(all->r[0], all->r[1]);
  double along = spore_vec3_length(all->r[0]), area = spore_vec3_length(cross);
  if (!(area > 0)) return 0;
  SporeVec3 e1 = spore_vec3_scale(1 / along, all->r[0]), n = spore_vec3_scale(1 / area, cross);
  SporeVec3 e2 = spore_vec3_cross(n, e1);
  double skew = spore_vec3_dot(all->r[1], e1), across = spore_vec3_dot(all->r[1], e2);
  double u1 = 1 / along, u2 = -skew / (along * across), v2 = 1 / across, raw[3], in_sheet[3][2];
  for (int k = 0; k < 3; k++) {
    raw[k] = spore_vec3_dot(all->r[2 + k], n);
    in_sheet[k][0] = spore_vec3_dot(all->r[2 + k], e1), in_sheet[k][1] = spore_vec3_dot(all->r[2 + k], e2);
  }
  for (size_t i = 0; i < FUNCTIONS; i++) {
    double f1 = u1 * all->d[0][i], f2 = u2 * all->d[0][i] + v2 * all->d[1][i], h[3];
    first[0][i] = f1, first[1][i] = f2;
    for (int k = 0; k < 3; k++) h[k] = all->d[2 + k][i] - in_sheet[k][0] * f1 - in_sheet[k][1] * f2;
    second[0][i] = u1 * u1 * h[0];
    second[1][i] = u2 * u2 * h[0] + 2 * u2 * v2 * h[2] + v2 * v2 * h[1];
    second[2][i] = u1 * u2 * h[0] + u1 * v2 * h[2];
  }
  curvature[0] = u1 * u1 * raw[0];
  curvature[1] = u2 * u2 * raw[0] + 2 * u2 * v2 * raw[2] + v2 * v2 * raw[1];
  curvature[2] = u1 * u2 * raw[0] + u1 * v2 * raw[2];
  return area;
}

/* Q x: the quadratic form of bending. */
static void bend(double poisson, const double x[3], double y[3]) {
  y[0] = x[0] + poisson * x[1], y[1] = x[1] + poisson * x[0], y[2] = 2 * (1 - poisson) * x[2];
}

static double set_point(SporePatch *patch, const double *control, size_t cell, int point, double *share) {
  double u = (double)(cell % patch->span_u) + 0.5 + (point & 1 ? 0.5 : -0.5) / sqrt(3);
  double v = (double)(cell / patch->span_u) + 0.5 + (point & 2 ? 0.5 : -0.5) / sqrt(3);
  size_t group = cell / SPORE_LANES, lane = cell % SPORE_LANES;
  double first[2][FUNCTIONS], second[3][FUNCTIONS], curvature[3], moment[3];
  Derivatives all = derive(patch, control, cell, u, v);
  double area = by_length(&all, first, second, curvature) / SPORE_PATCH_POINTS;
  if (!(area > 0)) return 0;
  double size = sqrt((double)patch->cell_count * SPORE_PATCH_POINTS * area);
  for (int k = 0; k < 3; k++) {
    if (fabs(curvature[k]) * size < FLAT) curvature[k] = 0;
    patch->curved = patch->curved || curvature[k] != 0;
  }
  SporePatchGauss *gauss = &patch->gauss[group * SPORE_PATCH_POINTS + (size_t)point];
  gauss->area[lane] = area;
  bend(patch->poisson, curvature, moment);
  for (int k = 0; k < 3; k++) gauss->curvature[k][lane] = curvature[k];
  for (size_t i = 0, pair = 0; i < FUNCTIONS; i++) {
    const double own[3] = {second[0][i], second[1][i], second[2][i]};
    double bent[3];
    bend(patch->poisson, own, bent);
    share[node_of(patch, cell, i)] += area * all.value[i];
    for (int k = 0; k < 2; k++) gauss->first[k][i][lane] = first[k][i];
    for (int k = 0; k < 3; k++) {
      gauss->second[k][i][lane] = second[k][i];
      gauss->bent[i][lane] += moment[k] * second[k][i];
    }
    for (size_t j = i; j < FUNCTIONS; j++, pair++)
      patch->flat[group * SPORE_PATCH_PAIRS + pair][lane] +=
          area * (bent[0] * second[0][j] + bent[1] * second[1][j] + bent[2] * second[2][j]);
  }
  return area;
}

size_t spore_patch_set_rest(SporePatch *patch, const double *control, double *share) {
  assert(control && share);
  double whole = 0, least = HUGE_VAL;
  size_t where = 0;
  for (size_t cell = 0; cell < patch->cell_count; cell++)
    for (int point = 0; point < SPORE_PATCH_POINTS; point++) {
      double area = set_point(patch, control, cell, point, share);
      whole += area;
      if (area < least) least = area, where = cell;
    }
  return least > 1e-4 * whole / (double)(SPORE_PATCH_POINTS * patch->cell_count) ? SIZE_MAX : where;
}

/* The larger eigenvalue of the products of a1 and a2: the square of the largest stretch at a Gauss point. */
static double stretch_square(const SporePatch *patch, size_t cell, int point, const double *q) {
  const SporePatchGauss *gauss = &patch->gauss[cell / SPORE_LANES * SPORE_PATCH_POINTS + (size_t)point];
  SporeVec3 a[2] = {{0, 0, 0}, {0, 0, 0}};
  for (size_t i = 0; i < FUNCTIONS; i++)
    for (int k = 0; k < 2; k++)
      a[k] = spore_vec3_add_scaled(a[k], gauss->first[k][i][cell % SPORE_LANES],
                                   spore_vec3_load(q + 3 * (size_t)node_of(patch, cell, i)));
  double along = spore_vec3_dot(a[0], a[0]), across = spore_vec3_dot(a[1], a[1]), both = spore_vec3_dot(a[0], a[1]);
  double half = (along - across) / 2;
  return (along + across) / 2 + sqrt(half * half + both * both);
}

double spore_patch_strain(const SporePatch *patch, const double *q) {
  assert(patch->cell_count > 0);
  double most = 0;
  for (size_t cell = 0; cell < patch->cell_count; cell++)
    for (int point = 0; point < SPORE_PATCH_POINTS; point++) most = fmax(most, stretch_square(patch, cell, point, q));
  return sqrt(most) - 1;
}
