/* Writes a scene in a canonical form, indented by two spaces a level. A file that has this form already stays as it is.
 */
#include "core/io/scene_format.h"

#include <string.h>

#include "core/io/scene_xml.h"

typedef struct Writer {
  GString *text;
  int line;
  GArray *places; /* of SporeObjectPlace, or NULL */
} Writer;

static void append_lines(Writer *writer, const char *text) {
  g_string_append(writer->text, text);
  for (const char *c = text; *c; c++) writer->line += *c == '\n';
}

/* Ends the line, keeps at most one empty line, and indents. */
static void new_line(Writer *writer, guint lines, guint depth) {
  if (writer->text->len > 0)
    for (guint i = 0; i < CLAMP(lines, 1, 2); i++) append_lines(writer, "\n");
  for (guint i = 0; i < depth; i++) g_string_append(writer->text, "  ");
}

static void write_comments(Writer *writer, const GArray *comments, guint depth) {
  for (guint i = 0; comments && i < comments->len; i++) {
    const SporeComment *comment = &g_array_index(comments, SporeComment, i);
    if (comment->lines_before == 0 && writer->text->len > 0) g_string_append_c(writer->text, ' ');
    else new_line(writer, comment->lines_before, depth);
    g_string_append(writer->text, "<!--");
    append_lines(writer, comment->text);
    g_string_append(writer->text, "-->");
  }
}

static void write_escaped(GString *text, const char *value) {
  for (; *value; value++) switch (*value) {
    case '&':
      g_string_append(text, "&amp;");
      break;
    case '<':
      g_string_append(text, "&lt;");
      break;
    case '>':
      g_string_append(text, "&gt;");
      break;
    case '"':
      g_string_append(text, "&quot;");
      break;
    case '\n':
      g_string_append(text, "&#10;");
      break;
    case '\r':
      g_string_append(text, "&#13;");
      break;
    case '\t':
      g_string_append(text, "&#9;");
      break;
    default:
      g_string_append_c(text, *value);
    }
}

static void write_value(GString *text, const SporeParameter *parameter, const SporeValue *value) {
  if (value->text) {
    write_escaped(text, value->text);
    return;
  }
  char number[256];
  spore_parameter_format(parameter, value, number, sizeof number);
  write_escaped(text, number);
}

static void write_property(Writer *writer, const SporeObject *object, guint property, guint depth) {
  const SporeParameter *parameter = &object->type->table->parameters[property];
  const SporeSlot *slot = &object->slots[property];
  if (slot->on_new_line) { /* below the first one */
    new_line(writer, 1, depth);
    for (size_t i = 0; i < strlen(object->type->element) + 2; i++) g_string_append_c(writer->text, ' ');
  } else {
    g_string_append_c(writer->text, ' ');
  }
  g_string_append_printf(writer->text, "%s=\"", parameter->name);
  if (slot->source) append_lines(writer, slot->source);
  else write_value(writer->text, parameter, &slot->value);
  g_string_append_c(writer->text, '"');
}

static void write_start(Writer *writer, const SporeObject *object, guint depth) {
  new_line(writer, object->lines_before, depth);
  if (writer->places) {
    SporeObjectPlace place = {(SporeObject *)object, writer->line, (int)(2 * depth) + 1};
    g_array_append_val(writer->places, place);
  }
  g_string_append_printf(writer->text, "<%s", object->type->element);
  if (!object->parent && object->order->len == 0)
    g_string_append_printf(writer->text, " version=\"%d.%d\"", SPORE_FORMAT_MAJOR, SPORE_FORMAT_MINOR);
  for (guint i = 0; i < object->order->len; i++)
    write_property(writer, object, g_array_index(object->order, guint, i), depth);
}

/* Whether an object is written. An empty section is written only where the author wrote it. */
static gboolean is_written(const SporeObject *object) {
  gboolean section = object->parent && !object->parent->parent;
  return !section || object->written || object->order->len > 0 || object->children->len > 0;
}

static gboolean has_content(const SporeObject *object) {
  for (guint i = 0; i < object->children->len; i++)
    if (is_written(spore_object_child(object, i))) return TRUE;
  return object->tail != NULL;
}

static void write_object(Writer *writer, const SporeObject *object, guint depth) {
  write_comments(writer, object->before, depth);
  write_start(writer, object, depth);
  if (has_content(object)) {
    g_string_append_c(writer->text, '>');
    for (guint i = 0; i < object->children->len; i++)
      if (is_written(spore_object_child(object, i))) write_object(writer, spore_object_child(object, i), depth + 1);
    write_comments(writer, object->tail, depth + 1);
    new_line(writer, 1, depth);
    g_string_append_printf(writer->text, "</%s>", object->type->element);
  } else {
    g_string_append(writer->text, "/>");
  }
  write_comments(writer, object->beside, depth);
}

char *spore_scene_format_places(const SporeDocument *document, gsize *size, GArray *places) {
  Writer writer = {g_string_new(NULL), 1, places};
  if (document->declaration) g_string_append(writer.text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
  write_object(&writer, document->root, 0);
  g_string_append_c(writer.text, '\n');
  if (size) *size = writer.text->len;
  return g_string_free(writer.text, FALSE);
}

char *spore_scene_format(const SporeDocument *document, gsize *size) {
  return spore_scene_format_places(document, size, NULL);
}
