/* Counts the works that a program may not end without. */
#include "ui/jobs/under-way.h"

static int under_way; /* atomic */

void spore_work_begin(void) { g_atomic_int_inc(&under_way); }

void spore_work_end(void) {
  g_atomic_int_add(&under_way, -1);
  g_main_context_wakeup(NULL);
}

void spore_works_wait(void) {
  while (g_atomic_int_get(&under_way) > 0) g_main_context_iteration(NULL, TRUE);
}
