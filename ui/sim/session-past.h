/* What went into a run since time 0, so that the run can be computed anew, to the bit: what each device said whenever
 * it was asked, and the commands. GLib, no GTK; one thread at a time. */
#ifndef SPORE_UI_SIM_SESSION_PAST_H
#define SPORE_UI_SIM_SESSION_PAST_H

#include <glib.h>

#include "core/sim/world.h"

typedef struct SporePast SporePast;

/* What one hand's device said at a time. */
typedef struct SporePastInput {
  double time_s;
  SporeDeviceState state;
  gboolean driven, led; /* by any device; by the pointer */
} SporePastInput;

SporePast *spore_past_new(guint hands);
void spore_past_free(SporePast *past);
/* Forgets everything. */
void spore_past_clear(SporePast *past);

/* Adds what the hand's device said; times go up. */
void spore_past_add(SporePast *past, guint hand, const SporePastInput *input);
/* What the hand's device said at that time. NULL: it had not been asked by then. */
const SporePastInput *spore_past_find(const SporePast *past, guint hand, double time_s);

/* Adds a command that was posted as the world's `number`-th, from 1. Commands with fields are not kept. */
void spore_past_post(SporePast *past, gsize number, const SporeCommand *command);
/* Of the commands posted so far, the world has applied `applied`: those that are new were applied in this step. */
void spore_past_applied(SporePast *past, gsize applied, guint64 step);
/* The i-th command of those that were applied in this step. NULL: there are no more. */
const SporeCommand *spore_past_command(const SporePast *past, guint64 step, guint i);

/* Forgets what is later than the state after `step` steps, at time_s. */
void spore_past_cut(SporePast *past, guint64 step, double time_s);

#endif
