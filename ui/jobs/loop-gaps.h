/* How long the main loop did not come round, and during what: while it does not, the window answers nobody. */
#ifndef SPORE_UI_JOBS_LOOP_GAPS_H
#define SPORE_UI_JOBS_LOOP_GAPS_H

#include <glib.h>

/* What holds a window for longer than this is told. */
#define SPORE_GAP_TOLD_MS 100

/* The longest gap of what was going on. */
typedef struct SporeGap {
  const char *what; /* translated; interned */
  double longest_ms;
  guint count; /* of the gaps that were longer than SPORE_GAP_TOLD_MS */
} SporeGap;

/* Measures the default main context's loop from now on: two readings of the clock a turn. tells: each gap that is to be
 * told is printed to stderr, too. */
void spore_gaps_watch(gboolean tells);
/* On the main thread: something begins and ends, of which a gap may come. title: translated. What ended last stands for
 * the rest of that turn of the loop, since a result is taken in there. */
void spore_gaps_enter(const char *title);
void spore_gaps_leave(const char *title);
/* What was going on when the loop did not come round for more than SPORE_GAP_TOLD_MS. *count of them; borrowed until
 * the next turn of the loop. */
const SporeGap *spore_gaps_told(guint *count);

#endif
