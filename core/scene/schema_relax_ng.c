/* Writes the RELAX NG schema of the format, from the same tables that the reader uses. */
#include <math.h>

#include "core/base/number.h"
#include "core/scene/schema.h"

/* A number as spore_number_read accepts it, with blanks around it. */
#define NUMBER "\\s*[+\\-]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][+\\-]?[0-9]+)?\\s*"
#define INTEGER "\\s*[+\\-]?[0-9]+\\s*"
#define NAME "\\s*[A-Za-z_][A-Za-z0-9_.\\-]*\\s*"
#define TEXT "[^&#127;]*"
/* Parts of a path are anything but ".."; the first is not empty. */
#define PART "([^./\\\\:&#127;][^/\\\\:&#127;]*|\\.[^./\\\\:&#127;][^/\\\\:&#127;]*|\\.\\.[^/\\\\:&#127;]+|\\.)"
#define PATH "\\s*" PART "(/" PART "?)*\\s*"
#define VERSION "1(\\.[0-9]{1,4})?"

static void open_data(GString *text, const char *type, const char *pattern) {
  g_string_append_printf(text, "<data type=\"%s\"><param name=\"pattern\">%s</param>", type, pattern);
}

static void append_bound(GString *text, const char *facet, double bound) {
  char number[SPORE_NUMBER_TEXT];
  spore_number_format(bound, number);
  g_string_append_printf(text, "<param name=\"%s\">%s</param>", facet, number);
}

/* Bounds are always written. Without bounds, a number too large for a double would pass as infinite. */
static void append_number(GString *text, const SporeParameter *parameter) {
  gboolean integer = parameter->type == SPORE_INTEGER;
  double largest = integer ? 9007199254740992.0 : G_MAXDOUBLE;
  open_data(text, integer ? "integer" : "double", integer ? INTEGER : NUMBER);
  append_bound(text, "minInclusive", fmax(parameter->minimum, -largest));
  append_bound(text, "maxInclusive", fmin(parameter->maximum, largest));
  g_string_append(text, "</data>");
}

static void append_words(GString *text, const char *const *words) {
  g_string_append(text, "<choice>");
  for (; *words; words++) g_string_append_printf(text, "<value>%s</value>", *words);
  g_string_append(text, "</choice>");
}

static void append_pattern(GString *text, const char *pattern) {
  open_data(text, "string", pattern);
  g_string_append(text, "</data>");
}

static void append_type(GString *text, const SporeObjectType *type, const SporeParameter *parameter) {
  static const char *const booleans[] = {"true", "false", NULL};
  switch (parameter->type) {
  case SPORE_REAL:
  case SPORE_INTEGER:
    append_number(text, parameter);
    break;
  case SPORE_VECTOR:
    g_string_append(text, "<list>");
    for (int i = 0; i < 3; i++) append_number(text, parameter);
    g_string_append(text, "</list>");
    break;
  case SPORE_BOOLEAN:
    append_words(text, booleans);
    break;
  case SPORE_CHOICE:
    append_words(text, parameter->choices);
    break;
  case SPORE_TEXT:
    append_pattern(text, parameter->required ? VERSION : TEXT);
    break;
  case SPORE_FILE:
    append_pattern(text, PATH);
    break;
  case SPORE_REFERENCE:
  case SPORE_NAME:
    append_pattern(text, NAME);
    break;
  }
}

static void append_attribute(GString *text, const SporeObjectType *type, const SporeParameter *parameter) {
  g_autofree char *doc = g_markup_escape_text(parameter->doc ? parameter->doc : "", -1);
  g_autofree char *unit = g_markup_escape_text(parameter->unit ? parameter->unit : "", -1);
  if (!parameter->required) g_string_append(text, "    <optional>\n");
  g_string_append_printf(text, "    <attribute name=\"%s\">\n      <a:documentation>%s%s%s%s</a:documentation>\n      ",
                         parameter->name, doc, *unit ? " [" : "", unit, *unit ? "]" : "");
  append_type(text, type, parameter);
  g_string_append(text, "\n    </attribute>\n");
  if (!parameter->required) g_string_append(text, "    </optional>\n");
}

/* A name of XML: no key begins so that two become one. */
static char *define_of(const SporeObjectType *type) { return g_strdelimit(g_strdup(type->key), "/", '.'); }

static void append_children(GString *text, const SporeObjectType *type) {
  if (type->children->len == 0) return;
  const char *around = type->ordered ? "group" : type->single_child ? "optional" : "zeroOrMore";
  g_string_append_printf(text, "    <%s>%s", around, type->ordered ? "" : "<choice>");
  for (guint i = 0; i < type->children->len; i++) {
    g_autofree char *define = define_of(g_ptr_array_index(type->children, i));
    g_string_append_printf(text, type->ordered ? "<optional><ref name=\"%s\"/></optional>" : "<ref name=\"%s\"/>",
                           define);
  }
  g_string_append_printf(text, "%s</%s>\n", type->ordered ? "" : "</choice>", around);
}

static void append_element(GString *text, const SporeObjectType *type) {
  g_autofree char *doc = g_markup_escape_text(type->doc ? type->doc : "", -1), *define = define_of(type);
  g_string_append_printf(text,
                         "  <define name=\"%s\"><element name=\"%s\">\n    <a:documentation>%s</a:documentation>\n",
                         define, type->element, doc);
  if (type->table->count == 0 && type->children->len == 0) g_string_append(text, "    <empty/>\n");
  for (size_t i = 0; i < type->table->count; i++) append_attribute(text, type, &type->table->parameters[i]);
  append_children(text, type);
  g_string_append(text, "  </element></define>\n");
}

/* An element that several others hold is defined once. */
static void append_tree(GString *text, const SporeObjectType *type, GHashTable *defined) {
  if (!g_hash_table_add(defined, (gpointer)type)) return;
  append_element(text, type);
  for (guint i = 0; i < type->children->len; i++) append_tree(text, g_ptr_array_index(type->children, i), defined);
}

char *spore_schema_relax_ng(const SporeSchema *schema) {
  GString *text = g_string_new("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                               "<grammar xmlns=\"http://relaxng.org/ns/structure/1.0\"\n"
                               "         xmlns:a=\"http://relaxng.org/ns/compatibility/annotations/1.0\"\n"
                               "         datatypeLibrary=\"http://www.w3.org/2001/XMLSchema-datatypes\">\n");
  const SporeObjectType *root = spore_schema_root(schema);
  g_string_append_printf(text, "  <start><ref name=\"%s\"/></start>\n", root->element);
  g_autoptr(GHashTable) defined = g_hash_table_new(NULL, NULL);
  append_tree(text, root, defined);
  g_string_append(text, "</grammar>\n");
  return g_string_free(text, FALSE);
}
