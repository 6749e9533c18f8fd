/* How much of its energy a body's method takes from the body's slowest swing, in the scene as it is. Measured on a
 * worker, one body at a time, and kept until the scene changes. No GTK.
 *
 * Signals
 *   measured ()   a measurement has ended */
#ifndef SPORE_UI_JOBS_SPORE_SWING_MEASURES_H
#define SPORE_UI_JOBS_SPORE_SWING_MEASURES_H

#include <glib-object.h>

#include "core/scene/document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_SWING_MEASURES spore_swing_measures_get_type()
G_DECLARE_FINAL_TYPE(SporeSwingMeasures, spore_swing_measures, SPORE, SWING_MEASURES, GObject)

SporeSwingMeasures *spore_swing_measures_new(void);
/* In words; borrowed until the next call. "": nothing is known of such a body, or the scene cannot run. NULL: not
 * measured yet; the measurement begins as soon as the one before is through. */
const char *spore_swing_measures_text(SporeSwingMeasures *self, const SporeDocument *document, const SporeObject *body);

G_END_DECLS
#endif
