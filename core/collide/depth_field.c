#include "core/collide/depth_field.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "core/base/memory.h"

#define SWEEPS 8           /* of the weights; each about halves what is wrong */
#define ROUNDS 4           /* in search of the deepest point of a ball */
#define BEFORE_MIDDLE 0.25 /* of a sphere's radius */
#define MARGIN 1.3         /* of the distance to the nearest neighbour, */
#define WIDEST_MARGIN 1.5  /* of the radius */
#define DIRECTIONS 26      /* in which a sphere may stand out: to the corners, edges and faces of a cube */
#define OUTWARD_STEPS 8    /* in which it is looked for how far out a sphere is felt, */
#define HALVINGS 8         /* and between two of them */
#define LEAST_FELT 0.05    /* of its radius: a sphere that is felt only together with others */

static SporeVec3 centre_of(const SporeDepthField *field, size_t i) { return spore_vec3_load(field->ball + 4 * i); }
static double radius_of(const SporeDepthField *field, size_t i) { return field->ball[4 * i + 3]; }

static bool allocate(SporeDepthField *field, size_t count) {
  *field = (SporeDepthField){.count = count,
                             .ball = SPORE_NEW_ARRAY(double, 4 * count),
                             .weight = SPORE_NEW_ARRAY(double, count),
                             .start = SPORE_NEW_ARRAY(uint32_t, count + 1)};
  return field->ball && field->weight && field->start;
}

void spore_depth_field_clear(SporeDepthField *field) {
  spore_free(field->ball);
  spore_free(field->weight);
  spore_free(field->start);
  spore_free(field->neighbour);
  *field = (SporeDepthField){0};
}

static double half_width_of(const SporeDepthField *field) {
  double widest = 0;
  for (size_t k = 0; k < 3; k++) {
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    for (size_t i = 0; i < field->count; i++) {
      lower = fmin(lower, field->ball[4 * i + k] - field->ball[4 * i + 3]);
      upper = fmax(upper, field->ball[4 * i + k] + field->ball[4 * i + 3]);
    }
    widest = fmax(widest, upper - lower);
  }
  return 0.5 * widest;
}

static bool are_neighbours(const SporeDepthField *field, size_t i, size_t j) {
  double reach = radius_of(field, i) + radius_of(field, j) + field->margin;
  return spore_vec3_distance(centre_of(field, i), centre_of(field, j)) < reach;
}

typedef struct Place {
  double x;
  uint32_t sphere;
} Place;

static int compare_places(const void *a, const void *b) {
  const Place *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  return p->sphere < q->sphere ? -1 : p->sphere > q->sphere;
}

/* Neighbours along the x axis, both ways; counts them where field->neighbour is NULL. */
static void sweep(SporeDepthField *field, const Place *places, double widest, uint32_t *filled) {
  for (size_t p = 0; p < field->count; p++) {
    uint32_t i = places[p].sphere;
    for (size_t k = p; k < field->count; k++) {
      uint32_t j = places[k].sphere;
      if (places[k].x - places[p].x > radius_of(field, i) + widest + field->margin) break;
      if (i != j && !are_neighbours(field, i, j)) continue;
      if (field->neighbour) field->neighbour[field->start[i] + filled[i]] = j;
      filled[i]++;
      if (i == j) continue;
      if (field->neighbour) field->neighbour[field->start[j] + filled[j]] = i;
      filled[j]++;
    }
  }
}

static bool find_neighbours(SporeDepthField *field) {
  Place *places = SPORE_NEW_ARRAY(Place, field->count);
  uint32_t *filled = SPORE_NEW_ARRAY(uint32_t, field->count);
  bool made = places && filled;
  double widest = 0;
  for (size_t i = 0; made && i < field->count; i++) {
    places[i] = (Place){field->ball[4 * i], (uint32_t)i};
    widest = fmax(widest, radius_of(field, i));
  }
  if (made) {
    spore_free(field->neighbour);
    field->neighbour = NULL;
    qsort(places, field->count, sizeof *places, compare_places);
    sweep(field, places, widest, filled);
    for (size_t i = 0; i < field->count; i++) field->start[i + 1] = field->start[i] + filled[i], filled[i] = 0;
    field->neighbour = SPORE_NEW_ARRAY(uint32_t, field->start[field->count]);
    if (field->neighbour) sweep(field, places, widest, filled);
  }
  spore_free(places);
  spore_free(filled);
  return made && field->neighbour;
}

/* Wide enough to be smooth over spheres as far apart as these are. */
static double choose_margin(const SporeDepthField *field) {
  double sum = 0;
  for (size_t i = 0; i < field->count; i++) {
    double nearest = WIDEST_MARGIN / MARGIN * radius_of(field, i);
    for (uint32_t k = field->start[i]; k < field->start[i + 1]; k++) {
      uint32_t j = field->neighbour[k];
      if (j != i) nearest = fmin(nearest, spore_vec3_distance(centre_of(field, i), centre_of(field, j)));
    }
    sum += MARGIN * nearest;
  }
  return sum / (double)field->count;
}

/* sum w_i max(0, m + r_i - d_i)^4, and a quarter of its gradient. */
static double sum_at(const SporeDepthField *field, uint32_t nearest, SporeVec3 point, SporeVec3 *gradient) {
  assert(nearest < field->count);
  double sum = 0;
  *gradient = (SporeVec3){0, 0, 0};
  for (uint32_t k = field->start[nearest]; k < field->start[nearest + 1]; k++) {
    uint32_t i = field->neighbour[k];
    SporeVec3 offset = spore_vec3_sub(point, centre_of(field, i));
    double distance = spore_vec3_length(offset), depth = field->margin + radius_of(field, i) - distance;
    if (!(depth > 0)) continue;
    double cube = field->weight[i] * depth * depth * depth;
    sum += cube * depth;
    if (distance > 0) *gradient = spore_vec3_add_scaled(*gradient, -cube / distance, offset);
  }
  return sum;
}

/* sum w_i max(0, r_i - d_i) - level, and its gradient. */
static double plain_sum_at(const SporeDepthField *field, uint32_t nearest, SporeVec3 point, SporeVec3 *gradient) {
  assert(nearest < field->count);
  double sum = -field->level;
  *gradient = (SporeVec3){0, 0, 0};
  for (uint32_t k = field->start[nearest]; k < field->start[nearest + 1]; k++) {
    uint32_t i = field->neighbour[k];
    SporeVec3 offset = spore_vec3_sub(point, centre_of(field, i));
    double distance = spore_vec3_length(offset), depth = radius_of(field, i) - distance;
    if (!(depth > 0)) continue;
    sum += field->weight[i] * depth;
    if (distance > 0) *gradient = spore_vec3_add_scaled(*gradient, -field->weight[i] / distance, offset);
  }
  return sum;
}

double spore_depth_field_at(const SporeDepthField *field, uint32_t nearest, SporeVec3 point, SporeVec3 *gradient) {
  if (field->plain) return plain_sum_at(field, nearest, point, gradient);
  double sum = sum_at(field, nearest, point, gradient);
  if (!(sum > 0)) return 0;
  double root = sqrt(sqrt(sum));
  *gradient = spore_vec3_scale(root / sum, *gradient);
  return root - field->margin;
}

static SporeVec3 direction_of(int i) {
  int k = i < 13 ? i : i + 1; /* of 27, without the middle */
  return spore_vec3_normalise(spore_vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1), (SporeVec3){0, 1, 0});
}

/* The place on sphere i where it stands out most: where the others reach least. False: they cover it. */
static bool find_top(const SporeDepthField *field, uint32_t i, SporeVec3 *top) {
  double least = HUGE_VAL;
  for (int d = 0; d < DIRECTIONS; d++) {
    SporeVec3 unused, place = spore_vec3_add_scaled(centre_of(field, i), radius_of(field, i), direction_of(d));
    bool covered = false;
    for (uint32_t k = field->start[i]; k < field->start[i + 1] && !covered; k++) {
      uint32_t j = field->neighbour[k];
      covered = j != i && spore_vec3_distance(place, centre_of(field, j)) < 0.999 * radius_of(field, j);
    }
    double sum = covered ? HUGE_VAL : sum_at(field, i, place, &unused);
    if (sum < least) least = sum, *top = place;
  }
  return least < HUGE_VAL;
}

/* Each sphere's weight is brought to where g is 0 at its top; covered ones take the mean of the others. */
static bool weigh(SporeDepthField *field) {
  SporeVec3 *top = SPORE_NEW_ARRAY(SporeVec3, field->count);
  bool *stands_out = SPORE_NEW_ARRAY(bool, field->count);
  bool made = top && stands_out;
  for (size_t i = 0; made && i < field->count; i++) field->weight[i] = 1;
  for (size_t i = 0; made && i < field->count; i++) stands_out[i] = find_top(field, (uint32_t)i, &top[i]);
  double right = pow(field->margin, 4);
  for (int round = 0; made && round < SWEEPS; round++) {
    double mean = 0, count = 0;
    for (size_t i = 0; i < field->count; i++) {
      SporeVec3 unused;
      if (!stands_out[i]) continue;
      field->weight[i] *= right / sum_at(field, (uint32_t)i, top[i], &unused);
      mean += field->weight[i], count++;
    }
    for (size_t i = 0; i < field->count; i++)
      if (!stands_out[i] && count > 0) field->weight[i] = mean / count;
  }
  spore_free(top);
  spore_free(stands_out);
  return made;
}

/* Along one direction; 0 where others reach out over it. */
static double felt_along(const SporeDepthField *field, uint32_t sphere, SporeVec3 direction) {
  assert(sphere < field->count);
  SporeVec3 unused, centre = centre_of(field, sphere);
  double inner = 0, outer = radius_of(field, sphere), step = outer / OUTWARD_STEPS;
  if (spore_depth_field_at(field, sphere, spore_vec3_add_scaled(centre, outer, direction), &unused) > 0) return 0;
  for (int k = OUTWARD_STEPS - 1; k > 0 && inner == 0; k--)
    if (spore_depth_field_at(field, sphere, spore_vec3_add_scaled(centre, k * step, direction), &unused) > 0)
      inner = k * step;
    else outer = k * step;
  for (int k = 0; k < HALVINGS; k++) {
    double middle = 0.5 * (inner + outer);
    bool felt = spore_depth_field_at(field, sphere, spore_vec3_add_scaled(centre, middle, direction), &unused) > 0;
    *(felt ? &inner : &outer) = middle;
  }
  return inner;
}

double spore_depth_field_felt_radius(const SporeDepthField *field, uint32_t sphere) {
  assert(field->plain && sphere < field->count);
  double farthest = LEAST_FELT * radius_of(field, sphere);
  for (int d = 0; d < DIRECTIONS; d++) farthest = fmax(farthest, felt_along(field, sphere, direction_of(d)));
  return farthest;
}

bool spore_depth_field_create(SporeDepthField *field, const double *centre, const double *radius, const double *weight,
                              double level, size_t count) {
  assert(count > 0 && centre && radius);
  bool made = allocate(field, count);
  field->plain = weight;
  field->level = weight ? level : 0;
  for (size_t i = 0; made && i < count; i++) {
    for (size_t k = 0; k < 3; k++) field->ball[4 * i + k] = centre[3 * i + k];
    field->ball[4 * i + 3] = radius[i];
    field->mean_radius += radius[i] / (double)count;
    if (weight) field->weight[i] = weight[i];
  }
  field->margin = WIDEST_MARGIN * field->mean_radius;
  if (made) field->half_width = half_width_of(field);
  if (made && find_neighbours(field)) {
    field->margin = choose_margin(field);
    if (find_neighbours(field) && (field->plain || weigh(field))) return true;
  }
  spore_depth_field_clear(field);
  return false;
}

/* Part of the way from n to where the field says out is, next in the search. What is off of the normal of a sphere of
 * radius r comes back -ahead/r times as large, seen from the deepest point of a ball of radius `ahead`: so much less is
 * taken at first, and then what the last step has shown (J. Barzilai and J. M. Borwein, "Two-Point Step Size Gradient
 * Methods", IMA Journal of Numerical Analysis 8, 1988). */
static double search_step(double least, SporeVec3 moved, SporeVec3 change) {
  double along = spore_vec3_dot(moved, change);
  return along > 0 ? fmin(fmax(spore_vec3_dot(moved, moved) / along, least), 1) : least;
}

double spore_depth_field_ball(const SporeDepthField *field, uint32_t nearest, SporeVec3 centre, double radius,
                              SporeVec3 *normal) {
  assert(nearest < field->count);
  assert(radius >= 0);
  SporeVec3 offset = spore_vec3_sub(centre, centre_of(field, nearest));
  SporeVec3 n = spore_vec3_normalise(offset, spore_vec3(0, 1, 0)), before = n, wrong_before = {0, 0, 0};
  /* The field is looked at in the ball's deepest point, but not beyond the middle of the sphere, where out is the other
   * way. */
  double farthest = spore_vec3_length(offset) - BEFORE_MIDDLE * radius_of(field, nearest);
  double ahead = fmin(radius, fmax(farthest, 0)), depth = 0;
  double least = radius_of(field, nearest) / (radius_of(field, nearest) + ahead);
  for (int round = 0; round < ROUNDS; round++) {
    SporeVec3 gradient, place = spore_vec3_add_scaled(centre, -ahead, n);
    double value = spore_depth_field_at(field, nearest, place, &gradient), slope = spore_vec3_length(gradient);
    *normal = n;
    depth = value / fmax(slope, 0.5) + radius - ahead;
    if (!(slope > 1e-6))
      return value > 0 ? value + radius - ahead
                       : fmin(radius_of(field, nearest) + radius - spore_vec3_length(offset), 0);
    if (round + 1 == ROUNDS) break;
    SporeVec3 wrong = spore_vec3_add_scaled(n, 1 / slope, gradient);
    double step =
        round == 0 ? least : search_step(least, spore_vec3_sub(n, before), spore_vec3_sub(wrong, wrong_before));
    before = n;
    wrong_before = wrong;
    n = spore_vec3_normalise(spore_vec3_add_scaled(n, -step, wrong), n);
  }
  return depth;
}
