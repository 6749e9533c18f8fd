/* Finds the tags and comments in the text of a scene, with the line and column of each. */
#include "core/io/scene_markup.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/error.h"

/* A place in the text, with its line and column. */
typedef struct Cursor {
  const char *file, *text;
  gsize size, at;
  int line, column;
} Cursor;

static void advance(Cursor *cursor, gsize to) {
  for (; cursor->at < to; cursor->at++) {
    unsigned char c = (unsigned char)cursor->text[cursor->at];
    if (c == '\n') cursor->line++, cursor->column = 1;
    else if ((c & 0xC0) != 0x80) cursor->column++; /* not for the later bytes of a character */
  }
}

void spore_text_position(const char *text, gsize offset, int *line, int *column) {
  Cursor cursor = {.text = text, .line = 1, .column = 1};
  if (offset >= 3 && g_str_has_prefix(text, "\xEF\xBB\xBF")) cursor.at = 3;
  advance(&cursor, offset);
  *line = cursor.line, *column = cursor.column;
}

static gboolean refuse(const Cursor *cursor, const char *message, GError **error) {
  g_autofree char *place = g_strdup_printf("%s:%d:%d", cursor->file, cursor->line, cursor->column);
  return spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s", message);
}

static gboolean refuse_limit(const Cursor *cursor, const char *message, guint limit, GError **error) {
  g_autofree char *text = g_strdup_printf("%s %u; %s", message, limit, _("leave out what is not needed"));
  return refuse(cursor, text, error);
}

static gboolean looking_at(const Cursor *cursor, const char *word) {
  gsize length = strlen(word);
  return cursor->size - cursor->at >= length && memcmp(cursor->text + cursor->at, word, length) == 0;
}

static gboolean is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* The byte behind the next `word` at or after `from`; 0: there is none. */
static gsize behind(const Cursor *cursor, gsize from, const char *word) {
  gsize length = strlen(word);
  const char *found = memmem(cursor->text + from, cursor->size - from, word, length);
  return found ? (gsize)(found - cursor->text) + length : 0;
}

/* The byte behind the tag that begins here; a quoted '>' does not end it. 0: the tag does not end. */
static gsize tag_end(const Cursor *cursor, guint *attributes) {
  char quote = 0;
  *attributes = 0;
  for (gsize i = cursor->at + 1; i < cursor->size; i++) {
    char c = cursor->text[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=') {
      (*attributes)++;
    } else if (c == '>') {
      return i + 1;
    }
  }
  return 0;
}

/* Skips blanks up to the next '<'. FALSE: there is other text. */
static gboolean skip_blanks(Cursor *cursor, gboolean inside, guint *lines, GError **error) {
  gsize to = cursor->at;
  while (to < cursor->size && is_blank(cursor->text[to])) to++;
  int line = cursor->line;
  advance(cursor, to);
  *lines = (guint)(cursor->line - line);
  if (to == cursor->size || cursor->text[to] == '<') return TRUE;
  return refuse(cursor,
                inside ? _("text does not belong here; expected elements, whose values are attributes; remove it")
                       : _("this is not a SPORE scene; expected XML that begins with <spore version=\"1.0\">; "
                           "choose a .spore file"),
                error);
}

static gboolean refuse_declaration(const Cursor *cursor, GError **error) {
  if (looking_at(cursor, "<!DOCTYPE"))
    return refuse(cursor,
                  _("a document type is not allowed; expected elements alone, without entities; remove <!DOCTYPE>"),
                  error);
  if (looking_at(cursor, "<![CDATA["))
    return refuse(cursor, _("a CDATA section is text, which does not belong here; expected elements; remove it"),
                  error);
  return refuse(cursor, _("a processing instruction is not allowed; expected elements or comments; remove it"), error);
}

static gboolean check_limits(const Cursor *cursor, const SporeMarkupLimits *limits, guint elements, guint depth,
                             guint attributes, GError **error) {
  if (elements > limits->elements)
    return refuse_limit(cursor, _("too many elements; expected at most"), limits->elements, error);
  if (depth > limits->depth)
    return refuse_limit(cursor, _("elements are nested too deeply; expected at most"), limits->depth, error);
  if (attributes > limits->attributes)
    return refuse_limit(cursor, _("too many attributes in one tag; expected at most"), limits->attributes, error);
  return TRUE;
}

static gboolean scan(Cursor *cursor, const SporeMarkupLimits *limits, GArray *markups, GError **error) {
  guint elements = 0, depth = 0, attributes = 0, lines;
  for (;;) {
    if (!skip_blanks(cursor, markups->len > 0, &lines, error)) return FALSE;
    if (cursor->at == cursor->size) return TRUE;
    SporeMarkup markup = {SPORE_MARKUP_START, cursor->at, 0, cursor->line, cursor->column, lines};
    if (looking_at(cursor, "<!--")) {
      markup.kind = SPORE_MARKUP_COMMENT;
      markup.end = behind(cursor, cursor->at + 4, "-->");
    } else if (looking_at(cursor, "<!") || looking_at(cursor, "<?")) {
      return refuse_declaration(cursor, error);
    } else {
      markup.kind = looking_at(cursor, "</") ? SPORE_MARKUP_END : SPORE_MARKUP_START;
      markup.end = tag_end(cursor, &attributes);
    }
    if (markup.end == 0) return TRUE;
    gboolean empty = markup.kind == SPORE_MARKUP_START && cursor->text[markup.end - 2] == '/';
    if (markup.kind == SPORE_MARKUP_START) {
      elements++, depth++;
      if (!check_limits(cursor, limits, elements, depth, attributes, error)) return FALSE;
    }
    if (depth > 0 && (empty || markup.kind == SPORE_MARKUP_END)) depth--;
    g_array_append_val(markups, markup);
    advance(cursor, markup.end);
  }
}

GArray *spore_markup_scan(const char *file, const char *text, gsize size, const SporeMarkupLimits *limits,
                          gboolean *declaration, GError **error) {
  Cursor cursor = {file, text, size, 0, 1, 1};
  if (looking_at(&cursor, "\xEF\xBB\xBF")) cursor.at = 3; /* a byte order mark has no column */
  *declaration = looking_at(&cursor, "<?xml") && cursor.size - cursor.at > 5 && is_blank(cursor.text[cursor.at + 5]);
  GArray *markups = g_array_new(FALSE, FALSE, sizeof(SporeMarkup));
  if (*declaration) {
    gsize end = behind(&cursor, cursor.at, "?>");
    if (end == 0) return markups;
    advance(&cursor, end);
  }
  if (scan(&cursor, limits, markups, error)) return markups;
  g_array_unref(markups);
  return NULL;
}

gboolean spore_markup_next_attribute(const char *text, const SporeMarkup *tag, SporeMarkupAttribute *from) {
  gsize at = from->value_end ? from->value_end + 1 : tag->begin + 1;
  if (!from->value_end) {
    while (!is_blank(text[at]) && text[at] != '>' && text[at] != '/') at++;
    from->line = tag->line, from->column = tag->column, from->name = tag->begin;
  }
  Cursor cursor = {.text = text, .at = from->name, .line = from->line, .column = from->column};
  advance(&cursor, at);
  int line = cursor.line;
  while (is_blank(text[at])) at++;
  if (text[at] == '>' || text[at] == '/') return FALSE;
  advance(&cursor, at);
  *from = (SporeMarkupAttribute){.name = at, .line = cursor.line, .column = cursor.column};
  from->on_new_line = cursor.line > line;
  while (text[at] != '"' && text[at] != '\'') at++;
  from->quote = text[at];
  from->value = ++at;
  while (text[at] != from->quote) at++;
  from->value_end = at;
  return TRUE;
}
