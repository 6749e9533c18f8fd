/* From where a program's allocations come. For programs whose linker sends the kernel's calls of spore_allocate,
 * spore_reallocate, spore_grow and spore_copy_text to this file (--wrap). */
#ifndef TESTS_WAYS_H
#define TESTS_WAYS_H

#include <glib.h>
#include <stdbool.h>

/* What a program does with memory; false with an error. It does the same each time, on one thread. */
typedef bool WaysWork(GError **error);
/* Lets allocations of `work` fail: the first and the last on each new way. Each fails in a twin of the program (fork),
 * which goes on from there, so that the way there is gone once. Asserts that the work is done when none fails, that
 * otherwise it does without or refuses for want of memory, that it refused at least once if any failed, and that
 * nothing was lost (the sanitizer looks). Under sanitizers, so many of them that it does not take long. */
void ways_fail_each(WaysWork *work);
/* The same for work that talks to other processes, which have no twins: it is done anew for each allocation, of which
 * `most` are chosen evenly. */
void ways_fail_again(WaysWork *work, guint most);
/* Forgets all. */
void ways_clear(void);

#endif
