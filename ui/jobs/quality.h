/* The quality of a generated result, shown by colours and as a histogram. No GTK. */
#ifndef SPORE_UI_JOBS_QUALITY_H
#define SPORE_UI_JOBS_QUALITY_H

#include "ui/jobs/works.h"

typedef struct SporeQuality {
  const char *label, *unit; /* translated; of the values */
  gboolean names;           /* the values are numbers of things: they have no mean and no scale */
  gsize count;
  double *values, *weights; /* count; weights NULL: all the same */
  double high;              /* end of the scale, which begins at 0: a round number above all but a few values */
} SporeQuality;

/* The number of qualities for results of this kind, and the name of each (translated). */
gsize spore_quality_count(SporeGenerateKind kind);
const char *spore_quality_label(SporeGenerateKind kind, gsize which);
/* Empty where the work has no result with this quality. */
void spore_quality_of(const SporeGenerateWork *work, gsize which, SporeQuality *quality);
void spore_quality_clear(SporeQuality *quality);
/* Place of a value on the scale of colours, 0..1; the second for all values (g_free). */
double spore_quality_place(const SporeQuality *quality, gsize i);
float *spore_quality_places(const SporeQuality *quality);
/* Whether some values lie above the scale. */
gboolean spore_quality_goes_beyond(const SporeQuality *quality);
/* A value with its unit: "0.26 mm", "39°". g_free. */
char *spore_quality_figure(const SporeQuality *quality, double value);
double spore_quality_mean(const SporeQuality *quality);
/* The value below which this share of the weight lies. */
double spore_quality_quantile(const SporeQuality *quality, double share);

#endif
