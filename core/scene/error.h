/* Converts the kernel's errors to GErrors. */
#ifndef SPORE_SCENE_ERROR_H
#define SPORE_SCENE_ERROR_H

#include <glib.h>

#include "core/base/error.h"

/* Codes are SporeErrorCode; the message is "PLACE: what is wrong; what was expected; what to do". */
#define SPORE_ERROR spore_error_quark()
GQuark spore_error_quark(void);
/* Returns FALSE. */
gboolean spore_error_propagate(const SporeError *from, GError **error);
gboolean spore_error_raise(GError **error, SporeErrorCode code, const char *place, const char *format, ...)
    G_GNUC_PRINTF(4, 5);
/* The text as one line of valid UTF-8 that people can read: what is too long loses its middle. Takes over the text;
 * g_free. */
char *spore_error_line(char *text);
/* Exit status of the contract: 2 for what the user can mend, 1 for numerical failure, 3 for a fault of ours. */
int spore_error_exit_status(const GError *error);

#endif
