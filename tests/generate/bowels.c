/* Bowels whose middle line is known. */
#include "tests/generate/bowels.h"

#include <glib.h>
#include <math.h>

#include "core/generate/common/common.h"
#include "core/mesh/isosurface.h"

#define STEP 0.15 /* between points of the line, in radii */
#define GRID 0.38 /* of unions, in radii, where a shape names none */
#define BALLS 81  /* of a bridge */
#define CAP 1.5   /* radii at each end that are not compared */

static SporeVec3 at(const SporeCurve *line, size_t i) { return spore_vec3_load(line->points + 4 * i); }

/* Place on the line at `along`, in radii: rows along x, side by side in y, layers in z, joined by half circles. */
static SporeVec3 place_at(const BowelShape *shape, double along) {
  double pitch = 2 + shape->gap, turn = 0.5 * M_PI * pitch;
  int row = (int)(along / (shape->row + turn)), last = shape->rows * shape->layers - 1;
  if (row > last) row = last;
  double rest = along - row * (shape->row + turn), beyond = fmax(rest - shape->row, 0) / (0.5 * pitch);
  int layer = row / shape->rows, in_layer = row % shape->rows;
  double y = layer % 2 ? shape->rows - 1 - in_layer : in_layer, z = layer;
  double x = fmin(rest, shape->row) + 0.5 * pitch * sin(beyond), side = 0.5 * (1 - cos(beyond));
  if (in_layer == shape->rows - 1) z += side;
  else y += layer % 2 ? -side : side;
  return spore_vec3(row % 2 ? shape->row - x : x, pitch * y, pitch * z);
}

static double whole_length(const BowelShape *shape) {
  int rows = shape->rows * shape->layers;
  return rows * shape->row + (rows - 1) * 0.5 * M_PI * (2 + shape->gap);
}

/* Bends space, so that neighbours stay neighbours and nothing that is apart meets. */
static SporeVec3 bend(const BowelShape *shape, SporeVec3 p) {
  double w = shape->waves;
  return spore_vec3(p.x + w * sin(p.y / 5 + p.z / 7), p.y + w * sin(p.x / 6 + p.z / 5),
                    p.z + w * sin(p.x / 5 + p.y / 6));
}

static double radius_at(const BowelShape *shape, double along) {
  return 1 - shape->haustra * 0.5 * (1 + cos(M_PI * along));
}

/* Points by their distances `along`; the tube's own radius, folds included, if `folds`. */
static SporeCurve line_of(const BowelShape *shape, const double *along, size_t count, bool folds) {
  SporeCurve line;
  g_assert_true(spore_curve_allocate(&line, count, NULL));
  for (size_t i = 0; i < count; i++) {
    spore_vec3_store(line.points + 4 * i, place_at(shape, along[i]));
    line.points[4 * i + 3] = folds ? radius_at(shape, along[i]) : 1;
  }
  return line;
}

static double *evenly(double whole, double step, size_t *count) {
  *count = (size_t)ceil(whole / step) + 1;
  double *along = g_new(double, *count);
  for (size_t i = 0; i < *count; i++) along[i] = whole * (double)i / (double)(*count - 1);
  return along;
}

static void sweep(const BowelShape *shape, SporeTriangleMesh *mesh) {
  SporeRandom random = {11};
  size_t count;
  g_autofree double *along = evenly(whole_length(shape), shape->haustra > 0 ? 0.25 : 0.4, &count);
  double step = along[1];
  for (size_t i = 1; i + 1 < count; i++) along[i] += shape->unevenness * (spore_random_unit(&random) - 0.5) * step;
  SporeCurve rings = line_of(shape, along, count, true);
  g_assert_true(spore_curve_tube(&rings, (size_t)shape->sectors, mesh, NULL));
  spore_curve_clear(&rings);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    SporeVec3 p = spore_vec3_add_scaled(spore_vec3_load(mesh->vertices + 3 * i),
                                        shape->noise * spore_random_unit(&random), spore_random_direction(&random));
    spore_vec3_store(mesh->vertices + 3 * i, p);
  }
}

/* Balls along the line, sorted into a grid of cells as wide as the largest is thick. */
typedef struct Union {
  SporeCurve balls;
  GHashTable *cells; /* cell -> GArray of the balls that begin or end in it */
} Union;

static gint64 cell_of(double x, double y, double z) {
  return ((gint64)floor(x / 2) + 4096) << 32 | ((gint64)floor(y / 2) + 4096) << 16 | ((gint64)floor(z / 2) + 4096);
}

static double depth_field(void *data, SporeVec3 p) {
  const Union *whole = data;
  double least = 1;
  for (int i = 0; i < 27; i++) {
    gint64 cell = cell_of(p.x + 2 * (i / 9 - 1), p.y + 2 * (i / 3 % 3 - 1), p.z + 2 * (i % 3 - 1));
    const GArray *some = g_hash_table_lookup(whole->cells, &cell);
    for (guint k = 0; some && k < some->len; k++) {
      guint32 ball = g_array_index(some, guint32, k);
      least = fmin(least, spore_vec3_distance(p, at(&whole->balls, ball)) - whole->balls.points[4 * ball + 3]);
    }
  }
  return least;
}

static void free_cell(gpointer cell) { g_array_free(cell, TRUE); }

static void put_balls(Union *whole) {
  whole->cells = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, free_cell);
  for (guint32 i = 0; i < whole->balls.count; i++) {
    SporeVec3 p = at(&whole->balls, i);
    gint64 cell = cell_of(p.x, p.y, p.z);
    GArray *some = g_hash_table_lookup(whole->cells, &cell);
    if (!some) {
      some = g_array_new(FALSE, FALSE, sizeof(guint32));
      g_hash_table_insert(whole->cells, g_memdup2(&cell, sizeof cell), some);
    }
    g_array_append_val(some, i);
  }
}

/* Replaces the last balls by bridges between rows of the same layer, all over the bowel. */
static void put_bridges(const BowelShape *shape, SporeCurve *balls, size_t first) {
  double pitch = 2 + shape->gap;
  for (int i = 0; i < shape->bridges; i++) {
    int layer = i % shape->layers, row = i * 7 % (shape->rows - 1);
    double x = shape->row * (0.2 + 0.6 * (double)(i * 3 % 5) / 4);
    for (int k = 0; k < BALLS; k++) {
      double *ball = balls->points + 4 * (first + (size_t)(i * BALLS + k)), along = (k % 9 - 4) / 9.0;
      spore_vec3_store(ball, spore_vec3(x + along * shape->seam, pitch * (row + (k / 9 + 0.5) / 9), pitch * layer));
      ball[3] = shape->bridge;
    }
  }
}

/* The surface of the balls. */
static void skin(const SporeCurve *balls, double grid, SporeTriangleMesh *mesh) {
  Union whole = {.balls = *balls};
  double lower[3], upper[3];
  put_balls(&whole);
  for (size_t k = 0; k < 3; k++) {
    lower[k] = HUGE_VAL, upper[k] = -HUGE_VAL;
    for (size_t i = 0; i < balls->count; i++) {
      lower[k] = fmin(lower[k], balls->points[4 * i + k] - 1.5);
      upper[k] = fmax(upper[k], balls->points[4 * i + k] + 1.5);
    }
  }
  g_assert_true(spore_isosurface(lower, upper, grid, HUGE_VAL, depth_field, &whole, mesh, NULL, NULL));
  g_hash_table_unref(whole.cells);
}

static void unite(const BowelShape *shape, SporeTriangleMesh *mesh) {
  size_t count, bridges = BALLS * (size_t)shape->bridges;
  g_autofree double *along = evenly(whole_length(shape), STEP, &count);
  SporeCurve tube = line_of(shape, along, count, true), balls;
  g_assert_true(spore_curve_allocate(&balls, count + bridges, NULL));
  for (size_t i = 0; i < 4 * count; i++) balls.points[i] = tube.points[i];
  put_bridges(shape, &balls, count);
  skin(&balls, shape->grid > 0 ? shape->grid : GRID, mesh);
  spore_curve_clear(&balls);
  spore_curve_clear(&tube);
}

void bowel_create(const BowelShape *shape, SporeTriangleMesh *mesh, SporeCurve *line) {
  size_t count;
  g_autofree double *along = evenly(whole_length(shape), STEP, &count);
  if (shape->sectors) sweep(shape, mesh);
  else unite(shape, mesh);
  *line = line_of(shape, along, count, false);
  for (size_t i = 0; i < mesh->vertex_count; i++)
    spore_vec3_store(mesh->vertices + 3 * i,
                     spore_vec3_scale(BOWEL_RADIUS, bend(shape, spore_vec3_load(mesh->vertices + 3 * i))));
  for (size_t i = 0; i < line->count; i++) {
    spore_vec3_store(line->points + 4 * i, spore_vec3_scale(BOWEL_RADIUS, bend(shape, at(line, i))));
    line->points[4 * i + 3] *= BOWEL_RADIUS;
  }
}

/* Adds the balls of a branch and of those that it forks into. */
static void grow(GArray *balls, SporeVec3 from, SporeVec3 along, SporeVec3 side, double radius, int forks) {
  double length = 8 * radius;
  for (double gone = 0; gone <= length; gone += 0.2 * radius) {
    SporeVec3 p = spore_vec3_add_scaled(from, gone, along);
    const double ball[4] = {p.x, p.y, p.z, radius};
    g_array_append_vals(balls, ball, 4);
  }
  SporeVec3 tip = spore_vec3_add_scaled(from, length, along);
  for (int k = -1; forks > 0 && k <= 1; k += 2)
    grow(balls, tip, spore_vec3_normalise(spore_vec3_add_scaled(along, 0.7 * k, side), along),
         spore_vec3_cross(along, side), 0.8 * radius, forks - 1);
}

void bowel_tree(SporeTriangleMesh *mesh) {
  g_autoptr(GArray) balls = g_array_new(FALSE, FALSE, sizeof(double));
  grow(balls, spore_vec3(0, 0, 0), spore_vec3(0, 0, -1), spore_vec3(1, 0, 0), 1, 3);
  SporeCurve all = {balls->len / 4, (double *)balls->data};
  skin(&all, GRID, mesh);
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) mesh->vertices[i] *= BOWEL_RADIUS;
}

static double distance_to(const SporeCurve *line, SporeVec3 p) {
  double least = HUGE_VAL;
  for (size_t i = 1; i < line->count; i++) {
    SporeVec3 a = at(line, i - 1), d = spore_vec3_sub(at(line, i), a);
    double square = spore_vec3_dot(d, d);
    double part = square > 0 ? fmin(fmax(spore_vec3_dot(spore_vec3_sub(p, a), d) / square, 0), 1) : 0;
    least = fmin(least, spore_vec3_distance(p, spore_vec3_add_scaled(a, part, d)));
  }
  return least;
}

/* The length of the line smoothed: of the means over a radius. */
static double smooth_length(const SporeCurve *line) {
  double step = STEP * BOWEL_RADIUS, whole = spore_curve_length(line), walked = 0, length = 0;
  size_t count = (size_t)ceil(whole / step) + 1, half = (size_t)lround(0.5 / STEP), from = 0;
  g_autofree SporeVec3 *even = g_new(SporeVec3, count);
  for (size_t i = 0; i < count; i++) {
    double wanted = whole * (double)i / (double)(count - 1), piece;
    while (walked + (piece = spore_vec3_distance(at(line, from), at(line, from + 1))) < wanted &&
           from + 2 < line->count)
      walked += piece, from++;
    even[i] = spore_vec3_add_scaled(at(line, from), fmin((wanted - walked) / piece, 1),
                                    spore_vec3_sub(at(line, from + 1), at(line, from)));
  }
  SporeVec3 before = even[0];
  for (size_t i = 1; i < count; i++) {
    size_t reach = MIN(half, MIN(i, count - 1 - i));
    SporeVec3 mean = {0, 0, 0};
    for (size_t k = i - reach; k <= i + reach; k++)
      mean = spore_vec3_add_scaled(mean, 1 / (2 * (double)reach + 1), even[k]);
    length += spore_vec3_distance(before, mean);
    before = mean;
  }
  return length;
}

BowelFit bowel_fit(const SporeCurve *known, const SporeCurve *line) {
  BowelFit fit = {0};
  size_t cap = (size_t)ceil(CAP / STEP), compared = known->count - 2 * cap;
  for (size_t i = cap; i + cap < known->count; i++) {
    double away = distance_to(line, at(known, i)) / known->points[4 * i + 3];
    fit.within += (away <= 1) / (double)compared;
    fit.offset += away / (double)compared;
  }
  fit.length = smooth_length(line) / smooth_length(known);
  return fit;
}
