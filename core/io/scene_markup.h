/* Places of tags and comments in the text of a scene. libxml2 tells what a file means, but its positions run ahead of
 * its events. So the tags and comments are found in the text first, each with its exact line and column. The events of
 * the parser are then matched with them one after the other. */
#ifndef SPORE_IO_SCENE_MARKUP_H
#define SPORE_IO_SCENE_MARKUP_H

#include <glib.h>

#define SPORE_LARGEST_SCENE (64u << 20) /* bytes of its text */

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

/* All markup of a text that is valid UTF-8. Refuses, with place, what no scene holds: text outside of tags, document
 * types, CDATA sections, processing instructions, and more than the limits. Where the text is not well-formed, the list
 * ends early and the parser reports the fault. `declaration`: the text begins with <?xml ...?>. NULL with a GError. */
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
