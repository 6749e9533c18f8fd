/* The published schema and the reader are made from the same tables: both must accept and refuse the same files.
 *
 * What RELAX NG cannot say, and the reader alone refuses (`reader_alone` below):
 *   - names unique in a section;
 *   - names of elements nested deeper, or in greater number, than the reader's limits;
 *   - document types, CDATA sections, processing instructions (not part of RELAX NG's data model);
 *   - an empty text where there is none to be (RELAX NG ignores CDATA that is blank). */
#include <libxml/relaxng.h>
#include <string.h>

#include "fixture.h"

#define PARTS 3 /* in which what an object holds is written out */

static xmlRelaxNGPtr grammar;

static void quiet(void *data, xmlErrorPtr error) {
  if (g_test_verbose()) g_test_message("%s", error->message);
}

static void load_grammar(void) {
  g_autofree char *text = spore_schema_relax_ng(fixture_schema());
  xmlRelaxNGParserCtxtPtr parser = xmlRelaxNGNewMemParserCtxt(text, (int)strlen(text));
  grammar = xmlRelaxNGParse(parser);
  xmlRelaxNGFreeParserCtxt(parser);
  g_assert_nonnull(grammar);
}

static gboolean schema_accepts(const char *text) {
  xmlDocPtr tree = xmlReadMemory(text, (int)strlen(text), "test.spore", NULL, XML_PARSE_NONET);
  if (!tree) return FALSE;
  xmlRelaxNGValidCtxtPtr validator = xmlRelaxNGNewValidCtxt(grammar);
  xmlRelaxNGSetValidStructuredErrors(validator, quiet, NULL);
  gboolean accepted = xmlRelaxNGValidateDoc(validator, tree) == 0;
  xmlRelaxNGFreeValidCtxt(validator);
  xmlFreeDoc(tree);
  return accepted;
}

static gboolean reader_accepts(const char *text) {
  GError *error = NULL;
  SporeDocument *document = spore_scene_parse(fixture_schema(), NULL, text, strlen(text), &error);
  if (error) g_test_message("%s", error->message);
  g_clear_error(&error);
  spore_document_free(document);
  return document != NULL;
}

static void check_both(const char *text, gboolean expected) {
  gboolean schema = schema_accepts(text), reader = reader_accepts(text);
  if (schema != expected || reader != expected)
    g_error("schema %s, reader %s, expected %s:\n%s", schema ? "accepts" : "refuses", reader ? "accepts" : "refuses",
            expected ? "accepted" : "refused", text);
}

#define SCENE(content) "<spore version=\"1.0\">" content "</spore>"
#define BODY(content) SCENE("<bodies><body name=\"a\">" content "</body></bodies>")
#define PARTICLE(attributes) BODY("<mechanical><particle " attributes "/></mechanical>")
#define FILE_NAME(file) SCENE("<assets><mesh name=\"m\" file=\"" file "\"/></assets>")

static const char *const good[] = {
    "<spore version=\"1.0\"/>",
    "<spore version=\"1\"/>",
    "<spore version=\"1.23\"/>",
    SCENE("<meta/><units/><environment/><solver/><defaults/><assets/><bodies/><links/><effects/><tools/><devices/"
          "><exercise/>"),
    SCENE("<meta title=\"\" author=\"&#10;&lt;\"/><units length=\"um\"/>"),
    SCENE("<environment gravity=\"  0 -9.81   +1e-3 \"/>"),
    SCENE("<environment gravity=\"0 .5 5.\"/>"),
    SCENE("<environment gravity=\"0 -1000 1000\"/>"),
    SCENE("<solver time_step=\"0.001\" integrator=\"implicit_euler\"/>"),
    SCENE("<defaults><contact friction=\"0.1\" self=\"true\"/></defaults>"),
    FILE_NAME("a.off"),
    FILE_NAME("a/b/c.off"),
    FILE_NAME("..."),
    FILE_NAME("a..b"),
    FILE_NAME("./a"),
    FILE_NAME("..a/.b"),
    FILE_NAME("a//b"),
    FILE_NAME(" a b "),
    FILE_NAME("\xC3\xA9.off"),
    SCENE("<assets><tetrahedra name=\"t\" file=\"t.mesh\" cells=\"100\" source=\"m\" source_hash=\"00ff\"/>"
          "<spheres name=\"s\" file=\"s\" seed=\"0\" count=\"00012\" method=\"tetrahedra\"/></assets>"),
    SCENE("<bodies><body name=\" a \" role=\" active \"/><body name=\"_b-.9\"/></bodies>"),
    BODY("<mechanical/><collision/><visual/><fidelity/>"),
    BODY("<mechanical geometry=\"m\" integrator=\"scene\"/><visual colour=\"0 0.5 1\"/>"),
    PARTICLE(""),
    PARTICLE("mass=\"0.001\""),
    PARTICLE("mass=\"1000\""),
    PARTICLE("samples=\"+7\""),
    PARTICLE("heavy=\" true\""),
    PARTICLE("note=\"a&amp;b\""),
    PARTICLE("shape=\"ball\" pull=\"-10 10 0\""),
    SCENE("<links><spring name=\"s\" body_a=\"x\" rest_length=\"-1\"/><pin name=\"p\" radius=\"0\"/><spring "
          "name=\"t\"/></links>"),
    SCENE("<tools><probe name=\"p\" body=\"b\" device=\"d\"/></tools><devices><track name=\"t\" file=\"t\"/><mouse "
          "name=\"m\"/></devices>"),
    "<!-- c --><spore version=\"1.0\"><!-- d --><bodies><!-- e --></bodies></spore>",
};

static const char *const wrong[] = {
    "<scene version=\"1.0\"/>",
    "<spore/>",
    "<spore version=\"2.0\"/>",
    "<spore version=\"0.1\"/>",
    "<spore version=\"1.\"/>",
    "<spore version=\"1.0.0\"/>",
    "<spore version=\"1.00000\"/>",
    "<spore version=\"\"/>",
    "<spore version=\"1.0\" x=\"1\"/>",
    SCENE("text"),
    SCENE("<x/>"),
    SCENE("<body name=\"a\"/>"),
    SCENE("<bodies/><bodies/>"),
    SCENE("<bodies/><assets/>"),
    SCENE("<bodies><pin name=\"p\"/></bodies>"),
    SCENE("<bodies><body/></bodies>"),
    SCENE("<units length=\"furlong\"/>"),
    SCENE("<units length=\"MM\"/>"),
    SCENE("<meta titel=\"a\"/>"),
    SCENE("<meta title=\"a\x7f\"/>"),
    SCENE("<environment gravity=\"0 0\"/>"),
    SCENE("<environment gravity=\"0 0 0 0\"/>"),
    SCENE("<environment gravity=\"\"/>"),
    SCENE("<environment gravity=\"0 0 1e999\"/>"),
    SCENE("<environment gravity=\"0 0 inf\"/>"),
    SCENE("<environment gravity=\"0 0 INF\"/>"),
    SCENE("<environment gravity=\"0 0 NaN\"/>"),
    SCENE("<environment gravity=\"0 0 0x1\"/>"),
    SCENE("<environment gravity=\"0 0 1001\"/>"),
    SCENE("<environment gravity=\"0,0,0\"/>"),
    SCENE("<environment gravity=\"0 0 1e\"/>"),
    SCENE("<environment gravity=\"0 0 .\"/>"),
    FILE_NAME(""),
    FILE_NAME("/a"),
    FILE_NAME(".."),
    FILE_NAME("../a"),
    FILE_NAME("a/.."),
    FILE_NAME("a/../b"),
    FILE_NAME("a\\b"),
    FILE_NAME("c:a"),
    FILE_NAME("a\x7f"),
    FILE_NAME("a/"
              ".."),
    FILE_NAME("http://x/y"),
    SCENE("<assets><mesh name=\"m\"/></assets>"),
    SCENE("<assets><mesh file=\"m\"/></assets>"),
    SCENE("<assets><spheres name=\"s\" file=\"s\" count=\"0\"/></assets>"),
    SCENE("<assets><spheres name=\"s\" file=\"s\" count=\"1.0\"/></assets>"),
    SCENE("<assets><spheres name=\"s\" file=\"s\" count=\"1e2\"/></assets>"),
    SCENE("<assets><spheres name=\"s\" file=\"s\" count=\"99999999999999999999999\"/></assets>"),
    SCENE("<bodies><body name=\"1a\"/></bodies>"),
    SCENE("<bodies><body name=\"a b\"/></bodies>"),
    SCENE("<bodies><body name=\"\"/></bodies>"),
    SCENE("<bodies><body name=\"\xC3\xA9\"/></bodies>"),
    BODY("<visual/><mechanical/>"),
    BODY("<visual/><visual/>"),
    BODY("<mechanical><particle/><particle/></mechanical>"),
    BODY("<mechanical><rigid/></mechanical>"),
    BODY("<mechanical integrator=\"rk99\"/>"),
    BODY("<mechanical geometry=\"a/b\"/>"),
    PARTICLE("mass=\"0\""),
    PARTICLE("mass=\"1000.0001\""),
    PARTICLE("mass=\"1 2\""),
    PARTICLE("mass=\"\""),
    PARTICLE("samples=\"101\""),
    PARTICLE("heavy=\"1\""),
    PARTICLE("heavy=\"True\""),
    PARTICLE("shape=\"sphere\""),
    PARTICLE("shape=\"ball cube\""),
    PARTICLE("pull=\"0 0 10.5\""),
    PARTICLE("x:mass=\"1\" xmlns:x=\"urn:x\""),
    PARTICLE("xml:lang=\"fr\""),
    "<spore version=\"1.0\" xmlns=\"urn:x\"/>",
    "<x:spore version=\"1.0\" xmlns:x=\"urn:x\"/>",
};

static const char *const reader_alone[] = {
    SCENE("<bodies><body name=\"a\"/><body name=\"a\"/></bodies>"),
    "<!DOCTYPE spore><spore version=\"1.0\"/>",
    "<!DOCTYPE spore [<!ENTITY e \"1.0\">]><spore version=\"&e;\"/>",
    SCENE("<bodies><![CDATA[ ]]></bodies>"),
    SCENE("<bodies>&#32;</bodies>"),
    SCENE("<?pi?>"),
};

static void test_good(void) {
  for (guint i = 0; i < G_N_ELEMENTS(good); i++) check_both(good[i], TRUE);
}

static void test_wrong(void) {
  for (guint i = 0; i < G_N_ELEMENTS(wrong); i++) check_both(wrong[i], FALSE);
}

static void test_reader_alone(void) {
  for (guint i = 0; i < G_N_ELEMENTS(reader_alone); i++) {
    g_test_message("%s", reader_alone[i]);
    g_assert_false(reader_accepts(reader_alone[i]));
    xmlDocPtr tree = xmlReadMemory(reader_alone[i], (int)strlen(reader_alone[i]), NULL, NULL, XML_PARSE_NONET);
    g_assert_nonnull(tree); /* well-formed: the reader's own decision */
    xmlFreeDoc(tree);
  }
}

/* Each bound of each number, just inside and just outside, through the tables of every element. */
static char *scene_with(const SporeObjectType *type, const char *property, const char *value, const char *content);

static void append_required(GString *text, const SporeObjectType *type, const char *except) {
  for (size_t i = 0; i < type->table->count; i++)
    if (type->table->parameters[i].required && strcmp(type->table->parameters[i].name, except) != 0)
      g_string_append_printf(text, " %s=\"x\"", type->table->parameters[i].name);
}

static const SporeObjectType *parent_of(const SporeObjectType *type, const SporeObjectType *from) {
  for (guint i = 0; i < from->children->len; i++) {
    const SporeObjectType *child = g_ptr_array_index(from->children, i);
    const SporeObjectType *found = child == type ? from : parent_of(type, child);
    if (found) return found;
  }
  return NULL;
}

static char *scene_with(const SporeObjectType *type, const char *property, const char *value, const char *content) {
  const SporeObjectType *root = spore_schema_root(fixture_schema());
  if (type == root) return g_strdup_printf("<spore version=\"1.0\">%s</spore>", content);
  g_autoptr(GString) text = g_string_new("<");
  g_string_append(text, type->element);
  append_required(text, type, property);
  if (*property) g_string_append_printf(text, " %s=\"%s\"", property, value);
  g_string_append_printf(text, ">%s</%s>", content, type->element);
  return scene_with(parent_of(type, root), "", "", text->str);
}

static void check_bounds(const SporeObjectType *type, const SporeParameter *parameter) {
  double margin = parameter->type == SPORE_INTEGER ? 1 : 1e-6;
  double bounds[] = {parameter->minimum, parameter->maximum};
  for (int i = 0; i < 2; i++) {
    if (!isfinite(bounds[i])) continue;
    double outside = bounds[i] + (i ? 1 : -1) * fmax(margin, fabs(bounds[i]) * margin);
    double values[] = {bounds[i], outside};
    for (int j = 0; j < 2; j++) {
      g_autofree char *number = g_strdup_printf(parameter->type == SPORE_INTEGER ? "%.0f" : "%.17g", values[j]);
      g_autofree char *vector = g_strdup_printf("%s %s %s", number, number, number);
      g_autofree char *scene = scene_with(type, parameter->name, parameter->type == SPORE_VECTOR ? vector : number, "");
      check_both(scene, j == 0);
    }
  }
}

static void check_type(const SporeObjectType *type) {
  for (size_t i = 0; i < type->table->count; i++) {
    const SporeParameter *parameter = &type->table->parameters[i];
    if (parameter->type == SPORE_REAL || parameter->type == SPORE_INTEGER || parameter->type == SPORE_VECTOR)
      check_bounds(type, parameter);
  }
  for (guint i = 0; i < type->children->len; i++) check_type(g_ptr_array_index(type->children, i));
}

static void test_bounds(void) { check_type(spore_schema_root(fixture_schema())); }

/* Writes out every PARTS-th property of all objects, from number `part` on. */
static void write_out(SporeDocument *document, guint part) {
  GPtrArray *stack = g_ptr_array_new();
  g_ptr_array_add(stack, spore_document_root(document));
  while (stack->len > 0) {
    SporeObject *object = g_ptr_array_steal_index(stack, stack->len - 1);
    const SporeObjectType *type = spore_object_type(object);
    for (guint i = part; i < type->table->count; i += PARTS) {
      GError *error = NULL;
      const SporeValue *value = spore_object_value(object, i);
      if (type->table->parameters[i].type >= SPORE_TEXT) continue;
      g_assert_true(spore_document_set(document, object, i, value, &error));
      g_assert_no_error(error);
    }
    for (guint i = 0; i < spore_object_child_count(object); i++) g_ptr_array_add(stack, spore_object_child(object, i));
  }
  g_ptr_array_unref(stack);
}

/* Whatever a document holds after writing, both accept. In parts: libxml2 takes twice as long for each attribute more
 * that an element has, a minute for all twenty of a mesh. */
static void test_defaults_written_out(void) {
  for (guint part = 0; part < PARTS; part++) {
    SporeDocument *document =
        fixture_parse(SCENE("<defaults><contact/></defaults><assets><mesh name=\"m\" file=\"f\"/><spheres "
                            "name=\"s\" file=\"f\"/></assets><bodies><body name=\"a\"><mechanical><particle/>"
                            "</mechanical><collision/><visual/><fidelity/></body></bodies><links><pin "
                            "name=\"p\"/><spring name=\"s\"/></links>"));
    write_out(document, part);
    g_autofree char *text = fixture_format(document);
    check_both(text, TRUE);
    spore_document_free(document);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  xmlSetStructuredErrorFunc(NULL, quiet);
  load_grammar();
  g_test_add_func("/relax-ng/good", test_good);
  g_test_add_func("/relax-ng/wrong", test_wrong);
  g_test_add_func("/relax-ng/reader-alone", test_reader_alone);
  g_test_add_func("/relax-ng/bounds", test_bounds);
  g_test_add_func("/relax-ng/defaults-written-out", test_defaults_written_out);
  int status = g_test_run();
  xmlRelaxNGFree(grammar);
  xmlRelaxNGCleanupTypes();
  xmlCleanupParser();
  return status;
}
