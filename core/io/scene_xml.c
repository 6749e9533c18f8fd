/* Reads scene files. The whole text is in memory. Its markup is found first (scene_markup.h), then libxml2's push
 * parser gets the text and tells what it means. Each event is matched with the next piece of markup, and so has an
 * exact place. */
#include "core/io/scene_xml.h"

#include <glib/gi18n.h>
#include <libxml/parser.h>
#include <string.h>

#include "core/io/scene_markup.h"
#include "core/scene/document_private.h"

#define FEED (64u << 10) /* bytes at a time: the parser's own buffer stays small */
static const SporeMarkupLimits limits = {.elements = 200000, .depth = 16, .attributes = 64};

/* An element that is open. */
typedef struct Frame {
  SporeObject *object;
  const SporeObjectType *last; /* type of the child read last */
  guint rank;                  /* its place in the fixed order, from 1; 0: none yet */
} Frame;

typedef struct Reader {
  const SporeSchema *schema;
  SporeDocument *document;
  const char *file, *text;
  xmlParserCtxtPtr parser;
  GArray *markups;    /* of SporeMarkup */
  guint next;         /* markup that the next event takes up */
  GArray *frames;     /* of Frame */
  GArray *comments;   /* of SporeComment: read, and not yet given to an object */
  SporeObject *ended; /* the element that ended last, where only comments followed it */
  GHashTable *names;  /* "section/name" -> SporeObject * */
  GError *error;
} Reader;

/* Faults. Only the first fault is reported. */

static void fail_as(Reader *reader, SporeErrorCode code, int line, int column, const char *message) {
  if (reader->error) return;
  g_autofree char *place = g_strdup_printf("%s:%d:%d", reader->file, line, column);
  spore_error_raise(&reader->error, code, place, "%s", message);
  if (reader->parser) xmlStopParser(reader->parser);
}

static void fail(Reader *reader, int line, int column, const char *format, ...) G_GNUC_PRINTF(4, 5);
static void fail(Reader *reader, int line, int column, const char *format, ...) {
  if (reader->error) return;
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  fail_as(reader, SPORE_ERROR_INPUT, line, column, message);
}

static const char *no_memory(void) { return _("there is not enough memory for the scene; close other programs"); }

#if LIBXML_VERSION >= 21200
typedef const xmlError *XmlError;
#else
typedef xmlErrorPtr XmlError;
#endif

static void on_error(void *data, XmlError error) {
  Reader *reader = ((xmlParserCtxtPtr)data)->_private;
  if (error->level < XML_ERR_ERROR) return;
  if (error->code == XML_ERR_NO_MEMORY) {
    fail_as(reader, SPORE_ERROR_MEMORY, MAX(error->line, 1), MAX(error->int2, 1), no_memory());
    return;
  }
  g_autofree char *message = g_strdup(error->message ? error->message : "");
  g_strstrip(message);
  fail(reader, MAX(error->line, 1), MAX(error->int2, 1),
       _("this is not well-formed XML: %s; expected tags that match and quoted values; correct it"), message);
}

/* The markup of an event. NULL: parser and scan disagree, which happens only in text that is not well-formed. */
static const SporeMarkup *take(Reader *reader, SporeMarkupKind kind) {
  if (reader->error) return NULL;
  if (reader->next < reader->markups->len) {
    const SporeMarkup *markup = &g_array_index(reader->markups, SporeMarkup, reader->next);
    if (markup->kind == kind) {
      reader->next++;
      return markup;
    }
  }
  fail(reader, MAX(reader->parser->input->line, 1), MAX(reader->parser->input->col, 1), "%s",
       _("this is not well-formed XML; expected tags that match and quoted values; correct it"));
  return NULL;
}

static gboolean is_empty_tag(const Reader *reader, const SporeMarkup *markup) {
  return reader->text[markup->end - 2] == '/';
}

/* Comments. */

/* Gives comments on the line of the element before to that element, and the other comments to *rest. */
static void give_comments(Reader *reader, GArray **rest) {
  gboolean same_line = reader->ended != NULL;
  for (guint i = 0; i < reader->comments->len; i++) {
    SporeComment *comment = &g_array_index(reader->comments, SporeComment, i);
    same_line = same_line && comment->lines_before == 0;
    spore_comments_add(same_line ? &reader->ended->beside : rest, comment->text, comment->lines_before);
    g_free(comment->text);
  }
  g_array_set_size(reader->comments, 0);
  reader->ended = NULL;
}

static void on_comment(void *data, const xmlChar *text) {
  Reader *reader = ((xmlParserCtxtPtr)data)->_private;
  const SporeMarkup *markup = take(reader, SPORE_MARKUP_COMMENT);
  if (!markup) return;
  SporeComment comment = {g_strdup((const char *)text), markup->lines_before};
  g_array_append_val(reader->comments, comment);
}

/* Attributes. */

/* The text of an attribute. libxml2 leaves one reference in the values that it reports, however the file spells it:
 * "&#38;" for an ampersand. */
static char *attribute_text(const xmlChar *begin, const xmlChar *end) {
  g_autofree char *text = g_strndup((const char *)begin, (gsize)(end - begin));
  g_auto(GStrv) parts = g_strsplit(text, "&#38;", -1);
  return g_strjoinv("&", parts);
}

static void refuse_attribute(Reader *reader, const SporeObject *object, const SporeMarkupAttribute *at,
                             const char *name) {
  const SporeObjectType *type = object->type;
  const char *nearest = spore_parameter_nearest(type->table, name);
  if (nearest) {
    fail(reader, at->line, at->column, _("<%s> has no attribute \"%s\"; did you mean \"%s\"?"), type->element, name,
         nearest);
    return;
  }
  g_autoptr(GString) known = g_string_new(NULL);
  for (size_t i = 0; i < type->table->count; i++)
    g_string_append_printf(known, "%s%s", i ? ", " : "", type->table->parameters[i].name);
  fail(reader, at->line, at->column, _("<%s> has no attribute \"%s\"; expected %s; remove or correct it"),
       type->element, name, known->len ? known->str : _("none"));
}

static void read_attribute(Reader *reader, SporeObject *object, const SporeMarkupAttribute *at, const char *name,
                           const char *text) {
  int property = spore_parameter_find(object->type->table, name);
  if (property < 0) {
    refuse_attribute(reader, object, at, name);
    return;
  }
  SporeError fault = SPORE_ERROR_INIT;
  SporeValue value;
  const SporeParameter *parameter = &object->type->table->parameters[property];
  if (!spore_parameter_parse(parameter, text, &value, &fault)) {
    fail_as(reader, fault.code, at->line, at->column, fault.message);
    return;
  }
  char *source = at->quote == '"' ? g_strndup(reader->text + at->value, at->value_end - at->value) : NULL;
  spore_document_load_value(object, (guint)property, &value, source);
  object->slots[property].on_new_line = at->on_new_line;
}

static void check_name(Reader *reader, SporeObject *object, const SporeMarkupAttribute *at) {
  const char *name = spore_object_name(object);
  char *key = g_strdup_printf("%s/%s", object->parent->type->element, name);
  const SporeObject *other = g_hash_table_lookup(reader->names, key);
  if (other) {
    fail(reader, at->line, at->column,
         _("the name \"%s\" is taken by the %s at line %d, column %d; expected names that are unique in <%s>; rename "
           "one"),
         name, other->type->element, other->line, other->column, object->parent->type->element);
    g_free(key);
  } else {
    g_hash_table_insert(reader->names, key, object);
  }
}

static void check_required(Reader *reader, const SporeObject *object) {
  const SporeParameterTable *table = object->type->table;
  for (size_t i = 0; i < table->count && !reader->error; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (!parameter->required || object->slots[i].set) continue;
    fail(reader, object->line, object->column, _("<%s> has no %s; expected %s=\"%s\"; add it"), object->type->element,
         parameter->name, parameter->name, parameter->initial_text ? parameter->initial_text : "...");
  }
}

/* Checks the version first, so that a newer file is reported as newer, and not for its new elements. */
static void check_version_first(Reader *reader, const SporeMarkup *markup, int count, const xmlChar **attributes) {
  SporeMarkupAttribute at = {0};
  for (int i = 0; i < count && spore_markup_next_attribute(reader->text, markup, &at); i++) {
    if (strcmp((const char *)attributes[5 * i], "version") != 0) continue;
    g_autofree char *version = attribute_text(attributes[5 * i + 3], attributes[5 * i + 4]);
    SporeError fault = SPORE_ERROR_INIT;
    if (!spore_format_version_check(version, &fault)) fail(reader, at.line, at.column, "%s", fault.message);
  }
}

static void read_attributes(Reader *reader, SporeObject *object, const SporeMarkup *markup, int count,
                            const xmlChar **attributes) {
  SporeMarkupAttribute at = {0};
  int name = spore_object_name_property(object);
  if (!object->parent) check_version_first(reader, markup, count, attributes);
  for (int i = 0; i < count && !reader->error; i++) {
    if (!spore_markup_next_attribute(reader->text, markup, &at)) return;
    const xmlChar **attribute = &attributes[5 * i]; /* name, prefix, URI, value, end of value */
    g_autofree char *text = attribute_text(attribute[3], attribute[4]);
    g_autofree char *full = attribute[1] ? g_strdup_printf("%s:%s", attribute[1], attribute[0]) : NULL;
    read_attribute(reader, object, &at, full ? full : (const char *)attribute[0], text);
    if (!reader->error && name >= 0 && object->slots[name].set &&
        object->slots[name].position == object->order->len - 1)
      check_name(reader, object, &at);
  }
  check_required(reader, object);
}

/* Elements. */

static const SporeObjectType *refuse_element(Reader *reader, const SporeMarkup *markup, const SporeObjectType *parent,
                                             const char *element) {
  const SporeObjectType *elsewhere = spore_schema_find(reader->schema, element);
  const char *nearest = spore_object_type_nearest_child(parent, element);
  g_autoptr(GString) known = g_string_new(NULL);
  for (guint i = 0; i < parent->children->len; i++)
    g_string_append_printf(known, "%s<%s>", i ? ", " : "", ((SporeObjectType *)parent->children->pdata[i])->element);
  if (!known->len) g_string_append(known, _("nothing inside"));
  if (elsewhere)
    fail(reader, markup->line, markup->column, _("<%s> does not belong in <%s>; expected %s; move it"), element,
         parent->element, known->str);
  else if (nearest)
    fail(reader, markup->line, markup->column, _("<%s> is not known in <%s>; did you mean <%s>?"), element,
         parent->element, nearest);
  else
    fail(reader, markup->line, markup->column, _("<%s> is not known in <%s>; expected %s; remove or correct it"),
         element, parent->element, known->str);
  return NULL;
}

/* Checks that a child occurs at most once and in the fixed order, where the parent requires that. */
static gboolean check_order(Reader *reader, Frame *frame, const SporeMarkup *markup, const SporeObjectType *type) {
  const SporeObjectType *parent = frame->object->type;
  guint rank;
  g_ptr_array_find(parent->children, type, &rank);
  gboolean again = parent->ordered ? frame->rank == rank + 1 : parent->single_child && frame->last;
  if (again)
    fail(reader, markup->line, markup->column, _("<%s> already holds <%s>; expected at most one%s; remove one"),
         parent->element, frame->last->element, parent->single_child ? _(" element") : "");
  else if (parent->ordered && frame->rank > rank + 1)
    fail(reader, markup->line, markup->column, _("<%s> comes after <%s>; expected it before; move it up"),
         type->element, frame->last->element);
  frame->last = type;
  frame->rank = rank + 1;
  return !reader->error;
}

static const SporeObjectType *child_type(Reader *reader, const SporeMarkup *markup, const char *element) {
  if (reader->frames->len == 0) {
    const SporeObjectType *root = spore_schema_root(reader->schema);
    if (strcmp(element, root->element) == 0) return root;
    fail(reader, markup->line, markup->column,
         _("this is not a SPORE scene but <%s>; expected <spore version=\"1.0\">; choose a .spore file"), element);
    return NULL;
  }
  Frame *frame = &g_array_index(reader->frames, Frame, reader->frames->len - 1);
  const SporeObjectType *type = spore_object_type_child(frame->object->type, element);
  if (!type) return refuse_element(reader, markup, frame->object->type, element);
  return check_order(reader, frame, markup, type) ? type : NULL;
}

static void on_start(void *data, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int namespace_count,
                     const xmlChar **namespaces, int attribute_count, int defaulted, const xmlChar **attributes) {
  Reader *reader = ((xmlParserCtxtPtr)data)->_private;
  const SporeMarkup *markup = take(reader, SPORE_MARKUP_START);
  if (!markup) return;
  if (prefix || uri || namespace_count > 0) {
    fail(reader, markup->line, markup->column,
         _("<%s> has an XML namespace; expected plain names; remove xmlns and prefixes"), (const char *)name);
    return;
  }
  const SporeObjectType *type = child_type(reader, markup, (const char *)name);
  if (!type) return;
  SporeObject *parent =
      reader->frames->len ? g_array_index(reader->frames, Frame, reader->frames->len - 1).object : NULL;
  SporeObject *object = spore_document_load_object(reader->document, parent, type, markup->line, markup->column);
  object->lines_before = markup->lines_before;
  give_comments(reader, &object->before);
  read_attributes(reader, object, markup, attribute_count, attributes);
  Frame frame = {object, NULL, 0};
  g_array_append_val(reader->frames, frame);
}

static void on_end(void *data, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri) {
  Reader *reader = ((xmlParserCtxtPtr)data)->_private;
  if (reader->error || reader->frames->len == 0) return;
  SporeObject *object = g_array_index(reader->frames, Frame, reader->frames->len - 1).object;
  const SporeMarkup *last = reader->next ? &g_array_index(reader->markups, SporeMarkup, reader->next - 1) : NULL;
  gboolean empty = last && last->kind == SPORE_MARKUP_START && is_empty_tag(reader, last) &&
                   last->line == object->line && last->column == object->column;
  if (!empty && !take(reader, SPORE_MARKUP_END)) return;
  give_comments(reader, &object->tail);
  reader->ended = object;
  g_array_set_size(reader->frames, reader->frames->len - 1);
}

/* Refuses a document type a second time: the scan has refused it already. */
static void on_document_type(void *data, const xmlChar *name, const xmlChar *external, const xmlChar *system) {
  Reader *reader = ((xmlParserCtxtPtr)data)->_private;
  fail(reader, 1, 1, "%s", _("a document type is not allowed; expected elements alone; remove <!DOCTYPE>"));
}

/* The whole. */

static void feed(Reader *reader, gsize size) {
  gsize from = 0;
  for (guint i = 0; i < reader->markups->len && !reader->error; i++) {
    gsize to = g_array_index(reader->markups, SporeMarkup, i).end;
    if (to - from < FEED) continue;
    xmlParseChunk(reader->parser, reader->text + from, (int)(to - from), 0);
    from = to;
  }
  if (!reader->error) xmlParseChunk(reader->parser, reader->text + from, (int)(size - from), 1);
  if (!reader->parser->wellFormed || reader->frames->len > 0)
    fail(reader, 1, 1, "%s", _("this is not well-formed XML; expected tags that match and quoted values; correct it"));
}

/* What libxml2 prints by itself while it has no memory for a parser: the reader says it. */
static void say_nothing(void *context, const char *format, ...) {}

static void parse(Reader *reader, gsize size) {
  xmlSAXHandler handler = {.initialized = XML_SAX2_MAGIC,
                           .startElementNs = on_start,
                           .endElementNs = on_end,
                           .comment = on_comment,
                           .internalSubset = on_document_type,
                           .serror = on_error};
  xmlSetGenericErrorFunc(NULL, say_nothing); /* of this thread */
  reader->parser = xmlCreatePushParserCtxt(&handler, NULL, NULL, 0, NULL);
  xmlSetGenericErrorFunc(NULL, NULL);
  if (!reader->parser) {
    fail_as(reader, SPORE_ERROR_MEMORY, 1, 1, no_memory());
    return;
  }
  xmlCtxtUseOptions(reader->parser, XML_PARSE_NONET);
  reader->parser->_private = reader;
  reader->parser->userData = reader->parser;
  feed(reader, size);
  if (reader->comments->len > 0 && !reader->error) /* behind the end of the root */
    for (guint i = 0; i < reader->comments->len; i++) {
      const SporeComment *comment = &g_array_index(reader->comments, SporeComment, i);
      spore_comments_add(&reader->document->root->beside, comment->text, comment->lines_before);
    }
  xmlFreeParserCtxt(reader->parser);
}

/* Checks size and encoding, and finds the markup, before anything is created. */
static GArray *prepare(const char *file, const char *text, gsize size, gboolean *declaration, GError **error) {
  const char *end;
  if (size == 0) {
    spore_error_raise(error, SPORE_ERROR_INPUT, file, "%s",
                      _("the file is empty; expected a SPORE scene; choose another"));
    return NULL;
  }
  if (size > SPORE_LARGEST_SCENE) {
    spore_error_raise(error, SPORE_ERROR_INPUT, file,
                      _("the scene has over %u MiB; expected less; keep meshes in files of "
                        "their own"),
                      SPORE_LARGEST_SCENE >> 20);
    return NULL;
  }
  if (!g_utf8_validate(text, (gssize)size, &end)) {
    int line, column;
    spore_text_position(text, (gsize)(end - text), &line, &column);
    g_autofree char *place = g_strdup_printf("%s:%d:%d", file, line, column);
    spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s",
                      _("the file is not UTF-8 text; expected a SPORE scene in UTF-8; convert it or choose another"));
    return NULL;
  }
  return spore_markup_scan(file, text, size, &limits, declaration, error);
}

static void free_pending(GArray *comments) {
  for (guint i = 0; i < comments->len; i++) g_free(g_array_index(comments, SporeComment, i).text);
  g_array_unref(comments);
}

SporeDocument *spore_scene_parse(const SporeSchema *schema, const char *file, const char *text, gsize size,
                                 GError **error) {
  gboolean declaration;
  const char *called = file ? file : _("scene");
  GArray *markups = prepare(called, text, size, &declaration, error);
  if (!markups) return NULL;
  Reader reader = {
      .schema = schema, .document = spore_document_new(schema), .file = called, .text = text, .markups = markups};
  reader.frames = g_array_new(FALSE, FALSE, sizeof(Frame));
  reader.comments = g_array_new(FALSE, FALSE, sizeof(SporeComment));
  reader.names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
  parse(&reader, size);
  g_array_unref(markups);
  g_array_unref(reader.frames);
  free_pending(reader.comments);
  g_hash_table_unref(reader.names);
  if (reader.error) {
    g_propagate_error(error, reader.error);
    spore_document_free(reader.document);
    return NULL;
  }
  reader.document->declaration = declaration;
  spore_document_set_file(reader.document, file);
  spore_document_set_readers(reader.document, &spore_io_readers);
  return reader.document;
}
