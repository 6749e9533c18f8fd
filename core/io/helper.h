/* Helper processes: work on strangers' data, or with libraries that may crash, happens in a child that can do nothing
 * but compute. Messages are frames on its standard input and output; its death is a message to the user. */
#ifndef SPORE_IO_HELPER_H
#define SPORE_IO_HELPER_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/scene/error.h"

typedef struct SporeHelperLimits {
  double time_s;  /* wall clock, and as much of processor time; then it is killed */
  guint64 memory; /* bytes of address space */
  guint64 output; /* bytes of answer at most */
} SporeHelperLimits;

/* Runs helper `program` ("spore-import", "spore-tetrahedra"; found in SPORE_HELPERS, beside the running program, or in
 * the installed libexec folder), sends `request`, reports its progress, and returns its answer. NULL with a GError: not
 * in this build, died (with signal), timed out, answered too much, said an error, or was cancelled (killed at once). */
GBytes *spore_helper_run(const char *program, const char *place, GBytes *request, const SporeHelperLimits *limits,
                         const SporeProgress *progress, GError **error);

/* Child's side (libc alone). A helper's main calls spore_helper_start first, then reads the request, sends any number
 * of progress messages and one answer or one error, and ends by _exit: nothing is left to tidy up. */

/* Reads the limits from the arguments, keeps standard output for frames alone, and enters the sandbox. What the kernel
 * lacks is told to the parent. Ends the program when it was started by hand. */
void spore_helper_start(int argc, char **argv);
gboolean spore_helper_read_request(void **content, gsize *size); /* free() */
/* stage and message: marked by N_(), the parent translates them; detail: what a library said, or NULL. */
void spore_helper_send_progress(double fraction, const char *stage);
void spore_helper_send_error(SporeErrorCode code, const char *message, const char *detail);
void spore_helper_send_answer(const void *content, gsize size);

/* Closes every file but 0 to 3, then: no_new_privs, limits (memory: address space, which a sanitizer build leaves open;
 * processor time; no files, no processes, no core), Landlock without any file, seccomp with what computing needs.
 * FALSE: the kernel lacks one, *missing names it, the rest is in force. */
gboolean spore_sandbox_enter(guint64 memory, guint64 processor_s, const char **missing);

#endif
