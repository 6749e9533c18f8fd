/* Reads words and numbers of an untrusted text, with the place of each for messages. */
#ifndef SPORE_IO_SCANNER_H
#define SPORE_IO_SCANNER_H

#include <glib.h>

#include "core/scene/error.h"

typedef struct SporeScanner {
  const char *place; /* the file, begins every message; borrowed */
  const char *at, *end, *line_start;
  unsigned line;    /* from 1 */
  const char *word; /* the word read last, not NUL-terminated; NULL at the end of the text */
  gsize length;
  unsigned word_line, word_column;
} SporeScanner;

void spore_scanner_init(SporeScanner *scanner, const char *place, const char *text, gsize size);
/* Reads the next word; skips white space and # comments. FALSE at the end. */
gboolean spore_scanner_next(SporeScanner *scanner);
/* Whether there is another word on the line of the last word. */
gboolean spore_scanner_more_on_line(SporeScanner *scanner);
/* The last word equals `text`, upper or lower case. */
gboolean spore_scanner_is(const SporeScanner *scanner, const char *text);
/* Skips the rest of the line of the last word. */
void spore_scanner_skip_line(SporeScanner *scanner);

/* Reads the next word as a number. `what` names the expected number in messages ("the x of a vertex", translated). */
gboolean spore_scanner_real(SporeScanner *scanner, const char *what, double *value, GError **error);
gboolean spore_scanner_integer(SporeScanner *scanner, const char *what, guint64 minimum, guint64 maximum,
                               guint64 *value, GError **error);
/* Reads a number of items that each take at least `bytes` bytes. Refuses more items than the rest of the text can hold,
 * and more than SPORE_MESH_MAXIMUM. */
gboolean spore_scanner_count(SporeScanner *scanner, const char *what, gsize bytes, gsize *count, GError **error);
/* Writes rows of `width` numbers, each row on a line that ends in `ending`; every number reads back to the same bits.
 */
void spore_append_reals(GString *text, const double *values, gsize rows, gsize width, const char *ending);
/* Raises "FILE:LINE:COLUMN: message" at the last word. Returns FALSE. */
gboolean spore_scanner_fail(const SporeScanner *scanner, GError **error, const char *format, ...) G_GNUC_PRINTF(3, 4);

#endif
