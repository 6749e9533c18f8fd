/* Helper processes: work on strangers' data, or with libraries that may crash, happens in a child that can do nothing but
 * compute. Messages are frames on its standard input and output; its death is a message to the user. */
#ifndef SPORE_IO_HELPER_H
#define SPORE_IO_HELPER_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/scene/error.h"

typedef struct SporeHelperLimits {
  double time_s;      /* wall clock; then it is killed */
  guint64 memory;     /* bytes of address space */
  guint64 output;     /* bytes of answer at most */
} SporeHelperLimits;

/* Runs helper `program` ("spore-import", "spore-tetrahedra"; found in SPORE_HELPERS, beside the running program, or in the
 * installed libexec folder), sends `request`, reports its progress, and returns its answer. NULL with a GError: not in
 * this build, died (with signal), timed out, answered too much, said an error, or was cancelled (killed at once). */
GBytes *spore_helper_run(const char *program, const char *place, GBytes *request, const SporeHelperLimits *limits,
                         const SporeProgress *progress, GError **error);

/* Child's side (libc alone). Closes what is not needed, then: no_new_privs, rlimits, Landlock without any file, seccomp with
 * what computing needs. False: the kernel lacks one; *missing names it (the helper goes on with the rest and says so). */
gboolean spore_sandbox_enter(guint64 memory, const char **missing);
gboolean spore_helper_read_request(void **content, gsize *size);
void spore_helper_send_progress(double fraction, const char *stage);
void spore_helper_send_error(const char *message);
void spore_helper_send_answer(const void *content, gsize size);

#endif
