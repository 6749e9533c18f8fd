/* The distribution of the values of a quality. The bars have the colours of the scale, so the histogram is also the
 * legend. */
#ifndef SPORE_UI_PANELS_SPORE_HISTOGRAM_H
#define SPORE_UI_PANELS_SPORE_HISTOGRAM_H

#include <gtk/gtk.h>

#include "ui/jobs/quality.h"

G_BEGIN_DECLS

#define SPORE_TYPE_HISTOGRAM spore_histogram_get_type()
G_DECLARE_FINAL_TYPE(SporeHistogram, spore_histogram, SPORE, HISTOGRAM, GtkDrawingArea)

/* Copied. NULL: nothing to show. */
void spore_histogram_set_quality(SporeHistogram *self, const SporeQuality *quality);

G_END_DECLS
#endif
