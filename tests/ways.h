/* From where a program's allocations come. For programs whose linker sends the kernel's calls of spore_allocate,
 * spore_reallocate, spore_grow and spore_copy_text to this file (--wrap). */
#ifndef TESTS_WAYS_H
#define TESTS_WAYS_H

#include <glib.h>
#include <stdbool.h>

/* Notes allocations from here on, until ways_end. */
void ways_begin(void);
/* Numbers, from 1 and ascending, of the first and of the last allocation on each way since ways_begin by which the
 * program had not come before. count: ways that were noted; may be NULL. g_array_unref; of guint64. */
GArray *ways_end(guint *count);
/* What a program does with memory; false with an error. */
typedef bool WaysWork(GError **error);
/* Lets allocations of `work` fail, one in each run: the first and the last on each new way, of which `most` are chosen
 * evenly. Asserts that it works when none fails, that it otherwise does without or refuses for want of memory, and
 * that it refused at least once. */
void ways_fail_each(WaysWork *work, guint most);
/* Forgets all. */
void ways_clear(void);

#endif
