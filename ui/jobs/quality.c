/* The quality of a generated result: values, their colours, and their histogram. */
#include "ui/jobs/quality.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/jobs/generate-types.h"

/* This share of the values lies beyond the scale, so that a few large values do not make all others look alike. */
#define BEYOND 0.02

gsize spore_quality_count(SporeGenerateKind kind) { return spore_generate_type(kind)->quality_count; }

const char *spore_quality_label(SporeGenerateKind kind, gsize which) {
  return _(spore_generate_type(kind)->qualities[which].label);
}

/* The next larger number with few digits, whose half has few digits too. */
static double round_up(double value) {
  static const double steps[] = {1, 1.2, 1.6, 2, 3, 4, 5, 6, 8};
  double power = pow(10, floor(log10(value)));
  for (gsize i = 0; i < G_N_ELEMENTS(steps); i++)
    if (value <= steps[i] * power * (1 + 1e-9)) return steps[i] * power;
  return 10 * power;
}

void spore_quality_of(const SporeGenerateWork *work, gsize which, SporeQuality *quality) {
  const SporeGenerateQuality *kind = &spore_generate_type(work->options.kind)->qualities[which];
  *quality = (SporeQuality){.label = _(kind->label), .unit = kind->unit, .names = kind->names};
  kind->measure(work, quality);
  double most = spore_quality_quantile(quality, 1 - BEYOND);
  quality->high = most > 0 ? round_up(most) : 1;
}

void spore_quality_clear(SporeQuality *quality) {
  g_free(quality->values);
  g_free(quality->weights);
  *quality = (SporeQuality){0};
}

double spore_quality_place(const SporeQuality *quality, gsize i) {
  return CLAMP(quality->values[i] / quality->high, 0, 1);
}

float *spore_quality_places(const SporeQuality *quality) {
  float *places = g_new(float, quality->count);
  for (gsize i = 0; i < quality->count; i++) places[i] = (float)spore_quality_place(quality, i);
  return places;
}

gboolean spore_quality_goes_beyond(const SporeQuality *quality) {
  for (gsize i = 0; i < quality->count; i++)
    if (quality->values[i] > quality->high) return TRUE;
  return FALSE;
}

char *spore_quality_figure(const SporeQuality *quality, double value) {
  const char *space = !*quality->unit || g_str_equal(quality->unit, "°") ? "" : " ";
  return g_strdup_printf("%.3g%s%s", value, space, quality->unit);
}

static double weight_of(const SporeQuality *quality, gsize i) { return quality->weights ? quality->weights[i] : 1; }

double spore_quality_mean(const SporeQuality *quality) {
  double sum = 0, weight = 0;
  for (gsize i = 0; i < quality->count; i++) {
    sum += weight_of(quality, i) * quality->values[i];
    weight += weight_of(quality, i);
  }
  return weight > 0 ? sum / weight : 0;
}

static int by_value(const void *a, const void *b, gpointer data) {
  const double *values = data, x = values[*(const guint32 *)a], y = values[*(const guint32 *)b];
  return (x > y) - (x < y);
}

double spore_quality_quantile(const SporeQuality *quality, double share) {
  if (!quality->count) return 0;
  g_autofree guint32 *order = g_new(guint32, quality->count);
  double whole = 0, sum = 0;
  for (gsize i = 0; i < quality->count; i++) {
    order[i] = (guint32)i;
    whole += weight_of(quality, i);
  }
  g_qsort_with_data(order, (int)quality->count, sizeof *order, by_value, quality->values);
  for (gsize i = 0; i < quality->count; i++) {
    sum += weight_of(quality, order[i]);
    if (sum >= share * whole) return quality->values[order[i]];
  }
  return quality->values[order[quality->count - 1]];
}
