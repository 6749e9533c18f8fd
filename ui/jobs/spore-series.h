/* The error for several numbers (SporeGenerateType.counts), measured one after the other on a worker, and the number
 * from which more do not pay.
 *
 * Signals
 *   changed ()   another point was measured, or it ended; on the GTK thread                                          */
#ifndef SPORE_UI_JOBS_SPORE_SERIES_H
#define SPORE_UI_JOBS_SPORE_SERIES_H

#include "ui/jobs/spore-job.h"
#include "ui/jobs/works.h"

G_BEGIN_DECLS

#define SPORE_TYPE_SERIES spore_series_get_type()
G_DECLARE_FINAL_TYPE(SporeSeries, spore_series, SPORE, SERIES, GObject)

#define SPORE_SERIES_POINTS 8 /* at most */

SporeSeries *spore_series_new(void);
/* Begins anew. NULL with an error: the body shows no mesh. */
gboolean spore_series_start(SporeSeries *self, SporeDocument *document, SporeObject *body,
                            const SporeGenerateOptions *options, GError **error);
void spore_series_stop(SporeSeries *self);  /* what was measured stays */
void spore_series_clear(SporeSeries *self); /* and goes */
/* Whether the measured points are still valid for this body and these options, whatever the number in them. */
gboolean spore_series_is_of(SporeSeries *self, SporeDocument *document, SporeObject *body,
                            const SporeGenerateOptions *options);
gboolean spore_series_is_running(SporeSeries *self);
/* Points measured so far; errors in %. */
gsize spore_series_get_points(SporeSeries *self, size_t counts[SPORE_SERIES_POINTS],
                              double errors[SPORE_SERIES_POINTS]);
/* The number from which on more do not pay; 0: not known, or all pay. */
size_t spore_series_get_enough(SporeSeries *self);

G_END_DECLS
#endif
