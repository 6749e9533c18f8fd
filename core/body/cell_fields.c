/* Strain, stress and shape of elements, each by itself. */
#include "core/body/cell_fields.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define FLAT 1e-6 /* of the volume at rest: an element with less has no stress that means anything */

struct SporeCellFields {
  SporeModel *apart; /* elements that share no node */
  size_t count, per; /* elements; nodes of one, corners first */
  uint32_t *node;    /* count x per: the body's node that each was made from */
  uint32_t *corner;  /* count x per: that it is now */
  double *rest, *q;  /* count x per x 3, m */
  double *still;     /* the same, of velocities: 0 */
  double *force;     /* N */
};

SporeCellFields *spore_cell_fields_new(const SporeModel *model, const void *fields, SporeError *error) {
  assert(model && fields);
  SporeCellFields *cells = model->type->apart ? SPORE_NEW(SporeCellFields) : NULL;
  if (cells && (cells->apart = model->type->apart(model, fields, &cells->node, &cells->count, error))) {
    size_t nodes = cells->apart->node_count;
    SporePose pose = {{0, 0, 0}, {1, 0, 0, 0}};
    cells->per = nodes / cells->count;
    cells->corner = SPORE_NEW_ARRAY(uint32_t, nodes);
    cells->rest = SPORE_NEW_ARRAY(double, 3 * nodes);
    cells->q = SPORE_NEW_ARRAY(double, 3 * nodes);
    cells->still = SPORE_NEW_ARRAY(double, 3 * nodes);
    cells->force = SPORE_NEW_ARRAY(double, 3 * nodes);
    if (cells->corner && cells->rest && cells->q && cells->still && cells->force) {
      memcpy(cells->corner, cells->node, nodes * sizeof *cells->node);
      model->type->place(cells->apart, pose, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), cells->rest, cells->still);
      memcpy(cells->q, cells->rest, 3 * nodes * sizeof *cells->q);
      return cells;
    }
  }
  spore_cell_fields_free(cells);
  spore_error_set(error, SPORE_ERROR_INPUT, NULL, _("the elements of this model cannot be told apart"));
  return NULL;
}

void spore_cell_fields_free(SporeCellFields *cells) {
  if (!cells) return;
  if (cells->apart) cells->apart->type->destroy(cells->apart);
  spore_free(cells->node);
  spore_free(cells->corner);
  spore_free(cells->rest);
  spore_free(cells->q);
  spore_free(cells->still);
  spore_free(cells->force);
  spore_free(cells);
}

size_t spore_cell_fields_count(const SporeCellFields *cells) { return cells->count; }

bool spore_cell_fields_retune(SporeCellFields *cells, const void *fields, SporeError *error) {
  return cells->apart->type->retune(cells->apart, fields, error);
}

void spore_cell_fields_take(SporeCellFields *cells, const uint32_t *corners, const double *q) {
  for (size_t c = 0; c < cells->count; c++)
    for (size_t a = 0; a < cells->per; a++) {
      size_t at = cells->per * c + a;
      if (corners && a < 4) cells->corner[at] = corners[4 * c + a];
      memcpy(cells->q + 3 * at, q + 3 * (size_t)cells->corner[at], 3 * sizeof *q);
    }
}

/* The three edges from an element's first corner, as columns. */
static SporeMat3 edges_of(const SporeCellFields *cells, const double *x, size_t cell) {
  assert(cell < cells->count);
  const double *first = x + 3 * cells->per * cell;
  SporeVec3 origin = spore_vec3_load(first);
  return spore_mat3_from_columns(spore_vec3_sub(spore_vec3_load(first + 3), origin),
                                 spore_vec3_sub(spore_vec3_load(first + 6), origin),
                                 spore_vec3_sub(spore_vec3_load(first + 9), origin));
}

/* The largest eigenvalue of a symmetric matrix, in closed form (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
 */
static double largest_eigenvalue(const SporeMat3 *a) {
  double mean = spore_mat3_trace(*a) / 3, square = 0;
  SporeMat3 rest = spore_mat3_sub(*a, spore_mat3_diagonal(mean, mean, mean));
  for (int k = 0; k < 9; k++) square += rest.m[k] * rest.m[k];
  double size = sqrt(square / 6);
  if (!(size > 0)) return mean;
  double half = spore_mat3_determinant(spore_mat3_scale(1 / size, rest)) / 2;
  return mean + 2 * size * cos(acos(fmax(-1, fmin(1, half))) / 3);
}

void spore_cell_fields_strain(const SporeCellFields *cells, double *strain) {
  for (size_t c = 0; c < cells->count; c++) {
    SporeMat3 inverse;
    strain[c] = NAN;
    if (!spore_mat3_invert(edges_of(cells, cells->rest, c), &inverse)) continue;
    SporeMat3 f = spore_mat3_multiply(edges_of(cells, cells->q, c), inverse);
    SporeMat3 green = spore_mat3_multiply(spore_mat3_transpose(f), f);
    green = spore_mat3_scale(0.5, spore_mat3_sub(green, spore_mat3_identity()));
    strain[c] = largest_eigenvalue(&green);
  }
}

static double von_mises(const SporeMat3 *sigma) {
  double mean = spore_mat3_trace(*sigma) / 3, square = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double entry = (sigma->m[3 * i + j] + sigma->m[3 * j + i]) / 2 - (i == j ? mean : 0);
      square += entry * entry;
    }
  return sqrt(1.5 * square);
}

void spore_cell_fields_stress(const SporeCellFields *cells, double *stress) {
  const SporeModel *apart = cells->apart;
  memset(cells->force, 0, 3 * apart->node_count * sizeof *cells->force);
  apart->type->force(apart, cells->q, cells->q, cells->still, cells->force);
  for (size_t c = 0; c < cells->count; c++) {
    double volume = spore_mat3_determinant(edges_of(cells, cells->q, c)) / 6;
    double before = spore_mat3_determinant(edges_of(cells, cells->rest, c)) / 6;
    SporeMat3 sum = {{0}};
    SporeVec3 origin = spore_vec3_load(cells->q + 3 * cells->per * c);
    for (size_t a = cells->per * c; a < cells->per * (c + 1); a++)
      sum = spore_mat3_add(sum, spore_mat3_outer(spore_vec3_load(cells->force + 3 * a),
                                                 spore_vec3_sub(spore_vec3_load(cells->q + 3 * a), origin)));
    SporeMat3 sigma = spore_mat3_scale(-1 / volume, sum);
    stress[c] = volume > FLAT * before ? von_mises(&sigma) : NAN;
  }
}

void spore_cell_fields_shape(const SporeCellFields *cells, double *shape) {
  for (size_t c = 0; c < cells->count; c++) {
    SporeVec3 corner[4];
    for (size_t k = 0; k < 4; k++) corner[k] = spore_vec3_load(cells->q + 3 * (cells->per * c + k));
    shape[c] = fmax(0, spore_tetrahedron_quality(corner));
  }
}

void spore_cell_fields_least(const SporeCellFields *cells, const double *values, size_t node_count, double *nodes) {
  for (size_t i = 0; i < node_count; i++) nodes[i] = NAN;
  for (size_t a = 0; a < cells->per * cells->count; a++) {
    assert(cells->corner[a] < node_count);
    nodes[cells->corner[a]] = fmin(nodes[cells->corner[a]], values[a / cells->per]); /* not a number does not count */
  }
}

void spore_cell_fields_spread(const SporeCellFields *cells, const double *values, size_t node_count, double *nodes) {
  double *weight = SPORE_NEW_ARRAY(double, node_count);
  for (size_t i = 0; i < node_count; i++) nodes[i] = weight ? 0 : NAN;
  for (size_t c = 0; weight && c < cells->count; c++) {
    double volume = spore_mat3_determinant(edges_of(cells, cells->rest, c));
    if (isnan(values[c])) continue;
    for (size_t a = cells->per * c; a < cells->per * (c + 1); a++) {
      assert(cells->corner[a] < node_count);
      nodes[cells->corner[a]] += volume * values[c];
      weight[cells->corner[a]] += volume;
    }
  }
  for (size_t i = 0; weight && i < node_count; i++) nodes[i] = weight[i] > 0 ? nodes[i] / weight[i] : NAN;
  spore_free(weight);
}

/* Surfaces. */

typedef struct Sides {
  double first, second, product; /* of two sides: the squares of their lengths, and their product */
} Sides;

static Sides sides_of(const double *x, const uint32_t *triangle) {
  SporeVec3 origin = spore_vec3_load(x + 3 * (size_t)triangle[0]);
  SporeVec3 a = spore_vec3_sub(spore_vec3_load(x + 3 * (size_t)triangle[1]), origin);
  SporeVec3 b = spore_vec3_sub(spore_vec3_load(x + 3 * (size_t)triangle[2]), origin);
  return (Sides){spore_vec3_dot(a, a), spore_vec3_dot(b, b), spore_vec3_dot(a, b)};
}

/* Half the larger eigenvalue of R^-1 (N - R), where R and N are the products of the sides at rest and now: that is the
 * Green's strain in axes of the plane. *area: twice that at rest, squared. */
static double plane_strain(Sides rest, Sides now, double *area) {
  double d = rest.first * rest.second - rest.product * rest.product;
  double a = now.first - rest.first, b = now.second - rest.second, c = now.product - rest.product;
  double trace = (rest.second * a + rest.first * b - 2 * rest.product * c) / d;
  double determinant = (a * b - c * c) / d;
  *area = d;
  return 0.5 * (trace / 2 + sqrt(fmax(0, trace * trace / 4 - determinant)));
}

void spore_surface_strain(const double *rest, const double *now, size_t vertex_count, const uint32_t *triangles,
                          size_t triangle_count, double *strain) {
  double *weight = SPORE_NEW_ARRAY(double, vertex_count);
  memset(strain, 0, vertex_count * sizeof *strain);
  for (size_t t = 0; weight && t < triangle_count; t++) {
    double square, value = plane_strain(sides_of(rest, triangles + 3 * t), sides_of(now, triangles + 3 * t), &square);
    if (!(square > 0)) continue;
    for (int k = 0; k < 3; k++) {
      strain[triangles[3 * t + (size_t)k]] += sqrt(square) * value;
      weight[triangles[3 * t + (size_t)k]] += sqrt(square);
    }
  }
  for (size_t i = 0; weight && i < vertex_count; i++)
    if (weight[i] > 0) strain[i] /= weight[i];
  spore_free(weight);
}

void spore_line_strain(const double *rest, size_t stride, const double *now, size_t count, double *strain) {
  assert(count >= 2);
  double before = 0;
  for (size_t i = 0; i + 1 < count; i++) {
    double then = spore_vec3_distance(spore_vec3_load(rest + stride * i), spore_vec3_load(rest + stride * (i + 1)));
    double length = spore_vec3_distance(spore_vec3_load(now + 3 * i), spore_vec3_load(now + 3 * (i + 1)));
    double piece = then > 0 ? 0.5 * (length * length / (then * then) - 1) : 0;
    strain[i] = i == 0 ? piece : 0.5 * (before + piece);
    strain[i + 1] = before = piece;
  }
}
