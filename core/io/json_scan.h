/* Steps through the text of JSON (RFC 8259), value by value, in the order of the text. */
#ifndef SPORE_IO_JSON_SCAN_H
#define SPORE_IO_JSON_SCAN_H

#include <glib.h>

typedef struct SporeJson {
  const char *at, *end;
  gboolean bad; /* this is not JSON; nothing more is read */
} SporeJson;

/* A piece of the text, as it is written there: escapes are not undone. */
typedef struct SporeJsonText {
  const char *text;
  gsize length;
} SporeJsonText;

/* Marks the text as no JSON. Returns FALSE, as all others do on such a text. */
gboolean spore_json_fail(SporeJson *json);
/* Skips white space, and then the character `wanted`. FALSE: something else stands there. */
gboolean spore_json_take(SporeJson *json, char wanted);
/* Reads a string, without its quotes. */
gboolean spore_json_string(SporeJson *json, SporeJsonText *string);
/* Reads a number or a word. */
gboolean spore_json_scalar(SporeJson *json, SporeJsonText *scalar);
/* Whether there is another item before `close`, and goes to it. *count: of items so far, 0 at first. */
gboolean spore_json_next_item(SporeJson *json, char close, gsize *count);
/* The same for a member of an object; reads its key. */
gboolean spore_json_next_member(SporeJson *json, gsize *count, SporeJsonText *key);
/* Skips a value. depth: of the values that it lies in. */
void spore_json_skip(SporeJson *json, int depth);

#endif
