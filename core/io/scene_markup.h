/* Where things stand in the text of a scene. libxml2 says what a file means, but its positions run ahead of what it
 * reports; so the tags and comments are found in the text first, each with its exact line and column, and the parser's
 * events then take them up one after the other. */
#ifndef SPORE_IO_SCENE_MARKUP_H
#define SPORE_IO_SCENE_MARKUP_H

#include <glib.h>

typedef enum SporeMarkupKind { SPORE_MARKUP_START, SPORE_MARKUP_END, SPORE_MARKUP_COMMENT } SporeMarkupKind;

typedef struct SporeMarkup {
  SporeMarkupKind kind;
  gsize begin, end;   /* bytes: of '<', and behind '>' */
  int line, column;   /* of '<', from 1; columns count characters */
  guint lines_before; /* line ends between the markup before and this one */
} SporeMarkup;

typedef struct SporeMarkupLimits {
  guint elements, depth, attributes; /* at most in a file, around each other, and in a tag */
} SporeMarkupLimits;

/* All markup of a text that is valid UTF-8. Refuses, with place, what no scene holds: text outside tags, document
 * types, CDATA sections, processing instructions, and more than the limits. Where the text is not well-formed it ends
 * early, and leaves the complaint to the parser. `declaration`: the text begins with <?xml ...?>. NULL with a GError.
 */
GArray *spore_markup_scan(const char *file, const char *text, gsize size, const SporeMarkupLimits *limits,
                          gboolean *declaration, GError **error);

typedef struct SporeMarkupAttribute {
  gsize name, value, value_end; /* bytes from the start of the text */
  int line, column;             /* of the name */
  char quote;
  gboolean on_new_line;
} SporeMarkupAttribute;

/* The attributes of a well-formed start tag, in order. `from` zeroed before the first; FALSE: no more. */
gboolean spore_markup_next_attribute(const char *text, const SporeMarkup *tag, SporeMarkupAttribute *from);

/* Line and column of a byte of the text. */
void spore_text_position(const char *text, gsize offset, int *line, int *column);

#endif
