/* Measures how long the main loop does not come round: from the return of one poll to the beginning of the next. */
#include "ui/jobs/loop-gaps.h"

#include <glib/gi18n.h>
#include <time.h>

static struct {
  GPollFunc poll;
  gint64 came_round_us; /* 0: the loop has not turned yet */
  gint64 worked_us;     /* of the thread's processor time then */
  gboolean tells;
  GPtrArray *going_on; /* interned titles, the newest last */
  const char *ended;   /* in this turn of the loop */
  GArray *told;        /* of SporeGap */
} gaps;

static const char *what(void) {
  if (gaps.ended) return gaps.ended;
  return gaps.going_on->len ? g_ptr_array_index(gaps.going_on, gaps.going_on->len - 1)
                            : g_intern_string(_("Something by hand"));
}

/* What the main thread has worked so far: the rest of a gap it waited, for a processor or for the picture. */
static gint64 worked_us(void) {
  struct timespec worked;
  return clock_gettime(CLOCK_THREAD_CPUTIME_ID, &worked) == 0 ? worked.tv_sec * G_USEC_PER_SEC + worked.tv_nsec / 1000
                                                              : 0;
}

static void tell(double ms) {
  SporeGap gap = {.what = what()};
  guint i = 0;
  while (i < gaps.told->len && g_array_index(gaps.told, SporeGap, i).what != gap.what) i++;
  if (i == gaps.told->len) g_array_append_val(gaps.told, gap);
  SporeGap *told = &g_array_index(gaps.told, SporeGap, i);
  told->longest_ms = MAX(told->longest_ms, ms);
  told->count++;
  double worked_ms = (double)(worked_us() - gaps.worked_us) / 1e3;
  if (gaps.tells) g_printerr("gap %.0f ms, %.0f ms of work: %s\n", ms, worked_ms, gap.what);
}

static int timed_poll(GPollFD *files, guint count, int timeout) {
  double ms = gaps.came_round_us ? (double)(g_get_monotonic_time() - gaps.came_round_us) / 1e3 : 0;
  if (ms > SPORE_GAP_TOLD_MS) tell(ms);
  gaps.ended = NULL;
  int ready = gaps.poll(files, count, timeout);
  gaps.came_round_us = g_get_monotonic_time();
  if (gaps.tells) gaps.worked_us = worked_us();
  return ready;
}

void spore_gaps_watch(gboolean tells) {
  gaps.tells = tells;
  gaps.told = g_array_new(FALSE, FALSE, sizeof(SporeGap));
  gaps.going_on = g_ptr_array_new();
  gaps.poll = g_main_context_get_poll_func(NULL);
  g_main_context_set_poll_func(NULL, timed_poll);
}

void spore_gaps_enter(const char *title) {
  if (gaps.told) g_ptr_array_add(gaps.going_on, (gpointer)g_intern_string(title));
}

void spore_gaps_leave(const char *title) {
  const char *ended = g_intern_string(title);
  if (gaps.told && g_ptr_array_remove(gaps.going_on, (gpointer)ended)) gaps.ended = ended;
}

const SporeGap *spore_gaps_told(guint *count) {
  *count = gaps.told ? gaps.told->len : 0;
  return gaps.told ? (const SporeGap *)gaps.told->data : NULL;
}
