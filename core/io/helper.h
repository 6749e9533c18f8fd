/* Helper processes. Work on untrusted data, or with libraries that may crash, happens in a child process that can only
 * compute. Messages are frames on its standard input and output. The death of a child becomes a message to the user. */
#ifndef SPORE_IO_HELPER_H
#define SPORE_IO_HELPER_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/scene/error.h"

typedef struct SporeHelperLimits {
  double time_s;  /* limit of wall clock time and of processor time; the child is killed then */
  guint64 memory; /* bytes of address space */
  guint64 output; /* bytes of answer at most */
} SporeHelperLimits;

/* Where the program is: in SPORE_HELPERS, beside the running program, or in the installed libexec folder. g_free; NULL:
 * it is in none of them. */
char *spore_helper_path(const char *program);

/* Runs the helper `program` ("spore-import", "spore-tetrahedra"), found by spore_helper_path. Sends `request`, reports
 * the helper's progress, and returns its answer. NULL with a GError: the helper is not in this build, died (with its
 * signal), took too long, answered too much, reported an error, or was cancelled (killed at once). */
GBytes *spore_helper_run(const char *program, const char *place, GBytes *request, const SporeHelperLimits *limits,
                         const SporeProgress *progress, GError **error);

/* Child's side (libc alone). A helper's main calls spore_helper_start first and reads the request. It then sends any
 * number of progress messages and one answer or one error, and ends by _exit: nothing has to be freed. */

/* Reads the limits from the arguments, reserves standard output for frames, and enters the sandbox. Reports to the
 * parent what the kernel lacks. Ends the program when somebody started it by hand. */
void spore_helper_start(int argc, char **argv);
gboolean spore_helper_read_request(void **content, gsize *size); /* free() */
/* stage and message: marked by N_(); the parent translates them. detail: the message of a library, or NULL. */
void spore_helper_send_progress(double fraction, const char *stage);
void spore_helper_send_error(SporeErrorCode code, const char *message, const char *detail);
void spore_helper_send_answer(const void *content, gsize size);

/* Closes every file but 0 to 3, then: no_new_privs, limits (memory: address space, which a sanitizer build leaves open;
 * processor time; no files, no processes, no core), Landlock without any file, seccomp with what computing needs.
 * FALSE: the kernel lacks one, *missing names it, the rest is in force. */
gboolean spore_sandbox_enter(guint64 memory, guint64 processor_s, const char **missing);

#endif
