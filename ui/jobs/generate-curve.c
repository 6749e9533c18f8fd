/* The middle line of a tubular organ, and a body along it. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static SporeVec3 point(const SporeCurve *curve, gsize i) { return spore_vec3_load(curve->points + 4 * i); }

/* Each point stands for half of the line to either side of it. */
static void measure_radius(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = spore_generate_scaled(curve->points + 3, quality->count, 4, 1e3);
  quality->weights = g_new0(double, quality->count);
  for (gsize i = 0; i + 1 < curve->count; i++) {
    double half = 0.5 * spore_vec3_distance(point(curve, i), point(curve, i + 1));
    quality->weights[i] += half;
    quality->weights[i + 1] += half;
  }
}

/* The angle by which the line turns at each point. */
static void measure_bend(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = g_new0(double, quality->count);
  for (gsize i = 1; i + 1 < curve->count; i++) {
    SporeVec3 before = spore_vec3_sub(point(curve, i), point(curve, i - 1));
    SporeVec3 after = spore_vec3_sub(point(curve, i + 1), point(curve, i));
    double across = spore_vec3_length(spore_vec3_cross(before, after)), along = spore_vec3_dot(before, after);
    quality->values[i] = 180 / G_PI * atan2(across, along);
  }
}

static void show(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  const SporeSphereSet balls = {.count = work->curve.count, .spheres = work->curve.points};
  spore_generate_show_spheres(&balls, places, candidate);
  candidate->line_count = work->curve.count - 1;
  candidate->lines = g_new(double, 6 * candidate->line_count);
  for (gsize i = 0; i < candidate->line_count; i++) {
    spore_vec3_store(candidate->lines + 6 * i, point(&work->curve, i));
    spore_vec3_store(candidate->lines + 6 * i + 3, point(&work->curve, i + 1));
  }
}

static const SporeGenerateQuality qualities[] = {
    {N_("Radius"), "mm", FALSE, measure_radius, show},
    {N_("Bend"), "°", FALSE, measure_bend, show},
};

const SporeGenerateType spore_generate_curve = {
    .shows = "curve",
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
};
