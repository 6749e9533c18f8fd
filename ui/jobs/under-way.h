/* Works that a program may not end without: counted, so that it can wait for them. */
#ifndef SPORE_UI_JOBS_UNDER_WAY_H
#define SPORE_UI_JOBS_UNDER_WAY_H

#include <glib.h>

/* A work begins when it is asked for, and not when a thread is found for it; it ends when nothing of it is left. Each
 * on any thread. */
void spore_work_begin(void);
void spore_work_end(void);
/* Returns when none is under way; on the main thread, whose loop goes on meanwhile. */
void spore_works_wait(void);

#endif
