/* How well one union of balls approximates another, larger one. Used to measure a curve's spheres. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define SAMPLES 20000
#define SEED UINT64_C(0x53504f5245554e49)
#define ON_BALL 2e-5 /* of the radius: a point that is not deeper counts as on the surface */

/* Points in or on a union, and the fields of two unions there. */
typedef struct Look {
  double *xyz, *own, *other; /* SAMPLES: the field of the union from which the points are drawn, and of the other */
  uint32_t *held;            /* SAMPLES: number of balls of the own union that contain the point */
} Look;

static bool open_look(Look *look) {
  *look = (Look){SPORE_NEW_ARRAY(double, 3 * SAMPLES), SPORE_NEW_ARRAY(double, SAMPLES),
                 SPORE_NEW_ARRAY(double, SAMPLES), SPORE_NEW_ARRAY(uint32_t, SAMPLES)};
  return look->xyz && look->own && look->other && look->held;
}

static void close_look(Look *look) {
  spore_free(look->xyz);
  spore_free(look->own);
  spore_free(look->other);
  spore_free(look->held);
}

/* The field of `balls` at the points, and the number of balls that contain each point (held may be NULL). */
static bool ask(const SporeBalls *balls, const double *xyz, double *value, uint32_t *held) {
  SporePoints points = {0};
  SporeField field = {0};
  uint32_t *sorted = NULL;
  bool done = spore_points_create(&points, xyz, SAMPLES) && spore_field_create(&field, &points, balls->count) &&
              (sorted = SPORE_NEW_ARRAY(uint32_t, points.block_count * SPORE_BLOCK));
  if (done) {
    spore_field_evaluate(&field, &points, balls);
    for (size_t i = 0; i < SAMPLES; i++) value[points.original[i]] = field.best[i];
    if (held) spore_field_multiplicity(&field, &points, balls, sorted);
    for (size_t i = 0; held && i < SAMPLES; i++) held[points.original[i]] = sorted[i];
  }
  spore_free(sorted);
  spore_field_clear(&field);
  spore_points_clear(&points);
  return done;
}

/* Draws points in the balls, or on them. *size: sum of the balls' volumes or areas, overlaps counted repeatedly. */
static bool draw(Look *look, const SporeBalls *own, const SporeBalls *other, bool surface, double *size) {
  SporeRandom random = {SEED};
  double power = surface ? 2 : 3, all = 0, end = 0;
  size_t ball = 0;
  for (size_t i = 0; i < own->count; i++) all += pow(own->r[i], power);
  end = pow(own->r[0], power);
  for (size_t i = 0; i < SAMPLES; i++) {
    double share = ((double)i + spore_random_unit(&random)) / SAMPLES * all;
    while (ball + 1 < own->count && end <= share) end += pow(own->r[++ball], power);
    double r = own->r[ball] * (surface ? 1 : cbrt(spore_random_unit(&random)));
    spore_vec3_store(look->xyz + 3 * i,
                     spore_vec3_add_scaled(spore_balls_centre(own, ball), r, spore_random_direction(&random)));
  }
  *size = all * (surface ? 4 * M_PI : 4 * M_PI / 3);
  return ask(own, look->xyz, look->own, look->held) && ask(other, look->xyz, look->other, NULL);
}

/* Volume of the own union, the volume of it that the other union contains, the mean of |own - other+| in it, and the
 * largest value of own. */
typedef struct Filling {
  double volume, held, error, deepest;
} Filling;

static Filling weigh(const Look *look, double size) {
  Filling f = {0};
  double sum = 0;
  for (size_t i = 0; i < SAMPLES; i++) {
    double weight = 1. / (look->held[i] ? look->held[i] : 1);
    sum += weight;
    if (look->other[i] >= 0) f.held += weight;
    f.error += weight * fabs(look->own[i] - fmax(look->other[i], 0));
    f.deepest = fmax(f.deepest, look->own[i]);
  }
  f.volume = size * sum / SAMPLES;
  f.held *= size / SAMPLES;
  f.error /= sum;
  return f;
}

/* Mean and largest distance from the own union's surface to the other's surface. Outside the other union the distance
 * is exact; inside it is the depth in its deepest ball. */
static void compare_surfaces(const Look *look, double radius, double *mean, double *most) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < SAMPLES; i++) {
    if (look->own[i] > ON_BALL * radius) continue;
    sum += fabs(look->other[i]), count++;
    *most = fmax(*most, fabs(look->other[i]));
  }
  *mean += 0.5 * (count ? sum / (double)count : 0);
}

static double largest_radius(const SporeBalls *balls) {
  double most = 0;
  for (size_t i = 0; i < balls->count; i++) most = fmax(most, balls->r[i]);
  return most;
}

static double diagonal_of(const SporeBalls *balls) {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, sum = 0;
  const double *columns[3] = {balls->x, balls->y, balls->z};
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < balls->count; i++) {
      low[k] = fmin(low[k], columns[k][i] - balls->r[i]);
      high[k] = fmax(high[k], columns[k][i] + balls->r[i]);
    }
    sum += (high[k] - low[k]) * (high[k] - low[k]);
  }
  return sqrt(sum);
}

bool spore_balls_compare(const SporeBalls *whole, const SporeBalls *balls, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error) {
  Look look;
  double size, mean = 0, most = 0, diagonal = diagonal_of(whole);
  const char *stage = _("Measuring");
  bool going = true, done = open_look(&look);
  *report = (SporeSpheresReport){0};
  done = done && (going = spore_progress_part(progress, 0, stage, error)) && draw(&look, whole, balls, false, &size);
  Filling inside = done ? weigh(&look, size) : (Filling){0};
  done = done && (going = spore_progress_part(progress, 0.25, stage, error)) && draw(&look, balls, whole, false, &size);
  Filling outside = done ? weigh(&look, size) : (Filling){0};
  done = done && (going = spore_progress_part(progress, 0.5, stage, error)) && draw(&look, whole, balls, true, &size);
  if (done) compare_surfaces(&look, largest_radius(whole), &mean, &most);
  done = done && (going = spore_progress_part(progress, 0.75, stage, error)) && draw(&look, balls, whole, true, &size);
  if (done) compare_surfaces(&look, largest_radius(balls), &mean, &most);
  if (!done && going) spore_generate_no_memory(error);
  close_look(&look);
  if (!done) return false;
  report->coverage = inside.held / inside.volume;
  report->outside = (outside.volume - outside.held) / inside.volume;
  report->distance_mean = mean / diagonal, report->distance_max = most / diagonal;
  report->depth_error = inside.error / inside.deepest;
  return true;
}
