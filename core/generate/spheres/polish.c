/* The last part of a balanced fit: all balls move together to reduce the errors that a set is judged by. These are the
 * uncovered volume inside, the covered volume outside, and the depth error inside. The fit before minimises a sum of
 * depth errors, in which the two volumes count only through the errors at the surface. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define ROUNDS_MOST 160
#define ROUNDS_LEAST 30
#define MANY 1000 /* balls: from this many on, ROUNDS_MANY, as relocations before did less for each */
#define ROUNDS_MANY 60
#define ROUNDS_OF_BALLS 16000 /* balls times rounds, within those limits */
#define BLUR_FIRST 0.25       /* of the typical radius: on both sides of a ball's surface, in the first round */
#define BLUR_LAST 0.06        /* in the last round */
#define STEP_FIRST 0.02       /* of the typical radius */
#define STEP_LAST 0.0005
#define LEAST_RADIUS 0.02 /* of the typical radius */
#define REACH 0.5         /* of the typical radius: how far a ball may reach out of the solid */
#define KEEP_SLOPE 0.9    /* Adam's two rates: Kingma and Ba 2015 */
#define KEEP_SQUARE 0.98
/* Weights of the errors. Uncovered volume weighs somewhat more than volume outside. */
#define UNCOVERED_SHARE 2.4
#define OUTSIDE_SHARE 1.6
#define DEPTH_SHARE 1.0

#define NOTHING 1e-9 /* of the volume */

enum { UNCOVERED, OUTSIDE, DEPTH, JUDGED };

typedef struct Polish {
  const SporeSolid *solid;
  const uint8_t *bound;
  SporeSamples samples; /* their weights are volumes */
  SporeBalls *balls, best;
  SporeField field;
  double *slope;   /* balls x JUDGED x 4: by x, y, z, r */
  double *running; /* balls x 8: running means of the loss' slopes and of the squared slopes */
  double *known;   /* balls x 4: place where the depth of a centre was last computed, and that depth */
  double judged[JUDGED], first[JUDGED];
  double blur; /* m */
} Polish;

/* Covered share of a sample with the field value f, blurred: rises from 0 to 1 over f = -1 .. 1 times the blur. Also
 * its slope. */
static double held(double f, double blur, double *slope) {
  double x = fmin(fmax(f / blur, -1), 1);
  *slope = 0.75 * (1 - x * x) / blur;
  return 0.5 + x * (0.75 - 0.25 * x * x);
}

static void add_slope(Polish *p, size_t sample, int what, double slope) {
  const SporePoints *points = &p->samples.points;
  size_t ball = p->field.owner[sample];
  double *m = p->slope + 4 * (JUDGED * ball + (size_t)what);
  SporeVec3 from = spore_vec3_sub(spore_vec3(points->x[sample], points->y[sample], points->z[sample]),
                                  spore_balls_centre(p->balls, ball));
  double length = spore_vec3_length(from), share = length > 1e-300 ? slope / length : 0;
  m[0] += share * from.x, m[1] += share * from.y, m[2] += share * from.z, m[3] += slope;
}

static void judge_inside(Polish *p, size_t i) {
  double volume = p->samples.weight[i], f = p->field.best[i], slope;
  p->judged[UNCOVERED] += volume * (1 - held(f, p->blur, &slope));
  if (slope > 0) add_slope(p, i, UNCOVERED, -volume * slope);
  double error = p->samples.depth[i] - fmax(f, 0), smooth = sqrt(error * error + 0.01 * p->blur * p->blur);
  p->judged[DEPTH] += volume * smooth;
  if (f > 0) add_slope(p, i, DEPTH, -volume * error / smooth);
}

static void judge_outside(Polish *p, size_t i) {
  double volume = p->samples.weight[i], slope;
  p->judged[OUTSIDE] += volume * held(p->field.best[i], p->blur, &slope);
  if (slope > 0) add_slope(p, i, OUTSIDE, volume * slope);
}

/* Factors of the squared errors in the loss. Both volumes are relative to the sum of the squares of their initial
 * values. */
static void find_scales(const Polish *p, double scale[JUDGED]) {
  const double *first = p->first;
  double volumes = first[UNCOVERED] * first[UNCOVERED] + first[OUTSIDE] * first[OUTSIDE];
  scale[UNCOVERED] = UNCOVERED_SHARE / volumes;
  scale[OUTSIDE] = OUTSIDE_SHARE / volumes;
  scale[DEPTH] = DEPTH_SHARE / (first[DEPTH] * first[DEPTH]);
}

/* Scaled sum of the squares of both volumes and of the depth error. */
static double loss_of(const Polish *p) {
  double scale[JUDGED], sum = 0;
  find_scales(p, scale);
  for (int k = 0; k < JUDGED; k++) sum += scale[k] * p->judged[k] * p->judged[k];
  return sum;
}

static double judge(Polish *p, double blur) {
  p->blur = blur * p->samples.typical;
  memset(p->slope, 0, 4 * JUDGED * p->balls->count * sizeof *p->slope);
  for (int k = 0; k < JUDGED; k++) p->judged[k] = NOTHING * p->solid->volume;
  for (size_t i = 0; i < p->samples.points.count; i++)
    if (p->samples.depth[i] >= 0) judge_inside(p, i);
    else judge_outside(p, i);
  return loss_of(p);
}

/* The radius within its limits. The depth is computed again only if needed: it changes by no more than the centre
 * moves. */
static double limit(Polish *p, size_t ball, SporeVec3 centre, double radius) {
  double *known = p->known + 4 * ball, reach = REACH * p->samples.typical;
  double least = fmax(known[3] - spore_vec3_distance(centre, spore_vec3_load(known)), 0);
  if (radius > least + reach) {
    spore_vec3_store(known, centre);
    least = known[3] = fmax(spore_bvh_depth(p->solid->bvh, centre), 0);
  }
  return fmin(fmax(radius, LEAST_RADIUS * p->samples.typical), least + reach);
}

static void move(Polish *p, size_t ball, const double change[4]) {
  const SporeSymmetry *symmetry = &p->solid->symmetry;
  SporeVec3 centre = spore_vec3_sub(spore_balls_centre(p->balls, ball), spore_vec3_load(change));
  if (symmetry->count)
    centre = spore_symmetry_bind(symmetry, p->bound ? p->bound[ball] : 0, spore_symmetry_fold(symmetry, centre));
  spore_balls_set(p->balls, ball, centre, limit(p, ball, centre, p->balls->r[ball] - change[3]));
}

/* An Adam step down the loss, with the slopes of the last call of judge. */
static void step(Polish *p, int round, double length) {
  double share[JUDGED];
  find_scales(p, share);
  for (int k = 0; k < JUDGED; k++) share[k] *= p->judged[k];
  double slopes = 1 - pow(KEEP_SLOPE, round + 1), squares = 1 - pow(KEEP_SQUARE, round + 1);
  for (size_t i = 0; i < p->balls->count; i++) {
    double *mean = p->running + 8 * i, *square = mean + 4, change[4];
    for (int k = 0; k < 4; k++) {
      double slope = 0;
      for (size_t j = 0; j < JUDGED; j++) slope += share[j] * p->slope[4 * (JUDGED * i + j) + (size_t)k];
      mean[k] += (1 - KEEP_SLOPE) * (slope - mean[k]);
      square[k] += (1 - KEEP_SQUARE) * (slope * slope - square[k]);
      change[k] = length * mean[k] / slopes / (sqrt(square[k] / squares) + 1e-300);
    }
    move(p, i, change);
  }
}

static void evaluate(Polish *p) { spore_field_evaluate(&p->field, &p->samples.points, p->balls); }

/* Geometric interpolation from `first` to `last`. */
static double between(double first, double last, double fraction) { return first * pow(last / first, fraction); }

static bool open_polish(Polish *p) {
  size_t n = p->balls->count;
  p->slope = SPORE_NEW_ARRAY(double, 4 * JUDGED * n);
  p->running = SPORE_NEW_ARRAY(double, 8 * n);
  p->known = SPORE_NEW_ARRAY(double, 4 * n);
  return p->slope && p->running && p->known && spore_balls_create(&p->best, n) &&
         spore_field_create(&p->field, &p->samples.points, n);
}

static bool run(Polish *p, const SporeProgressPart *progress, SporeError *error) {
  evaluate(p);
  for (int k = 0; k < JUDGED; k++) p->first[k] = 1;
  judge(p, BLUR_LAST);
  memcpy(p->first, p->judged, sizeof p->first);
  double best = loss_of(p);
  spore_balls_copy(&p->best, p->balls);
  int rounds = (int)fmin(fmax(ROUNDS_OF_BALLS / (double)p->balls->count, ROUNDS_LEAST), ROUNDS_MOST);
  if (p->balls->count >= MANY) rounds = ROUNDS_MANY;
  for (int round = 0; round < rounds; round++) {
    double fraction = (double)round / rounds;
    if (!spore_progress_part(progress, fraction, _("Fitting spheres"), error)) return false;
    judge(p, between(BLUR_FIRST, BLUR_LAST, fraction));
    step(p, round, between(STEP_FIRST, STEP_LAST, fraction) * p->samples.typical);
    evaluate(p);
    spore_progress_show_images(progress, &p->solid->symmetry, p->balls, p->bound);
  }
  if (judge(p, BLUR_LAST) >= best) spore_balls_copy(p->balls, &p->best);
  return true;
}

bool spore_spheres_polish(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double typical,
                          uint64_t seed, const SporeProgressPart *progress, SporeError *error) {
  Polish polish = {.solid = solid, .bound = bound, .balls = balls};
  SporeRandom random = {seed ^ UINT64_C(0xd1b54a32d192ed03)};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.3 * progress->share},
                    moving = {progress->whole, progress->first + 0.3 * progress->share, 0.7 * progress->share};
  if (!spore_samples_create_graded(&polish.samples, solid, balls->count, typical, &random, &sampling, error))
    return false;
  bool done = (open_polish(&polish) || spore_generate_no_memory(error)) && run(&polish, &moving, error);
  spore_free(polish.slope);
  spore_free(polish.running);
  spore_free(polish.known);
  spore_balls_clear(&polish.best);
  spore_field_clear(&polish.field);
  spore_samples_clear(&polish.samples);
  return done;
}
