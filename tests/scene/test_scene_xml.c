/* Scene files: what is read, where exactly what is wrong stands, and that writing gives back what was read. */
#include <string.h>
#include <sys/stat.h>

#include "fixture.h"

static const char canonical[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<!-- A scene\n"
    "     of two lines. -->\n"
    "\n"
    "<spore version=\"1.0\">\n"
    "  <meta description=\"a &lt; b &amp; c &gt; d &quot;e&quot; &amp;#38; f&#10;g &#x151;\" "
    "title=\"H\xC3\xA9p\xC3\xA1s\"/>\n"
    "  <environment gravity=\"0 -9.810 0e0\"/>\n"
    "  <solver/>\n"
    "\n"
    "  <defaults>\n"
    "    <contact stiffness=\"1e3\"/>\n"
    "  </defaults>\n"
    "  <assets> <!-- on the line of the tag -->\n"
    "    <mesh unit=\"mm\" name=\"liver\" file=\"meshes/liver.off\"/> <!-- beside --> <!-- twice -->\n"
    "    <!-- above -->\n"
    "\n"
    "    <spheres name=\"liver-spheres\" file=\"liver.spheres\" source=\"liver\" count=\"0110\"/>\n"
    "    <spheres name=\"bag\" file=\"bag.spheres\" tolerance=\".010\">\n"
    "      <sphere_region name=\"neck\" centre=\"0 0 1e-2\" radius=\"5e-3\"/> <!-- beside -->\n"
    "      <sphere_region name=\"body\" density=\"0.50\"/>\n"
    "    </spheres>\n"
    "    <tetrahedra name=\"cells\" file=\"cells.mesh\" method=\"wrapped\" size=\"2e-3\" fill=\"true\">\n"
    "      <cell_region name=\"neck\" size=\"1e-3\"/>\n"
    "    </tetrahedra>\n"
    "  </assets>\n"
    "  <bodies>\n"
    "    <!-- first -->\n"
    "    <body name=\"liver\"\n"
    "          role=\"passive\" position=\"+.5 1. -2E-3\"\n"
    "          rotation=\"0 0 1\">\n"
    "      <mechanical geometry=\"liver\" integrator=\"implicit_euler\">\n"
    "        <particle heavy=\"true\" shape=\"cube\"/>\n"
    "      </mechanical>\n"
    "      <collision spheres=\"liver-spheres\" friction=\"0.30\"/>\n"
    "      <!-- last -->\n"
    "    </body>\n"
    "    <!-- tail -->\n"
    "  </bodies>\n"
    "  <links>\n"
    "    <!-- nothing but a comment -->\n"
    "  </links>\n"
    "</spore> <!-- after -->\n"
    "<!-- the end -->\n";

static void test_round_trip(void) {
  SporeDocument *document = fixture_parse(canonical);
  g_autofree char *text = fixture_format(document);
  g_assert_cmpstr(text, ==, canonical);
  g_assert_false(spore_document_is_modified(document));
  SporeObject *meta = spore_document_section(document, "meta");
  g_assert_cmpstr(spore_object_text(meta, "description"), ==, "a < b & c > d \"e\" &#38; f\ng \xC5\x91");
  SporeObject *body = spore_document_by_path(document, "bodies/liver");
  g_assert_cmpfloat(spore_object_value(body, 2)->number[2], ==, -0.002);
  g_assert_cmpint(spore_object_line(body), ==, 28);
  g_assert_cmpint(spore_object_column(body), ==, 5);
  g_assert_cmpfloat(spore_object_number(spore_document_by_path(document, "assets/liver-spheres"), "count"), ==, 110);
  g_assert_cmpfloat(spore_object_number(spore_document_by_path(document, "bodies/liver/collision"), "stiffness"), ==,
                    1000);
  spore_document_free(document);
}

/* One change gives one changed line, whatever stands around it. */
static void test_change_stays_local(void) {
  SporeDocument *document = fixture_parse(canonical);
  GError *error = NULL;
  SporeObject *body = spore_document_by_path(document, "bodies/liver");
  spore_document_set_text(document, body, "position", "1 2 3", &error);
  g_assert_no_error(error);
  g_autofree char *text = fixture_format(document);
  g_auto(GStrv) expected = g_strsplit(canonical, "+.5 1. -2E-3", 2);
  g_autofree char *changed = g_strconcat(expected[0], "1 2 3", expected[1], NULL);
  g_assert_cmpstr(text, ==, changed);
  spore_document_undo(document);
  g_autofree char *again = fixture_format(document);
  g_assert_cmpstr(again, ==, canonical);
  spore_document_free(document);
}

static void test_comments_travel(void) {
  SporeDocument *document = fixture_parse("<spore version=\"1.0\">\n"
                                          "  <bodies>\n"
                                          "    <!-- of a -->\n"
                                          "    <body name=\"a\"/> <!-- beside a -->\n"
                                          "    <body name=\"b\"/>\n"
                                          "  </bodies>\n"
                                          "</spore>\n");
  GError *error = NULL;
  SporeObject *a = spore_document_by_path(document, "bodies/a");
  g_assert_true(spore_document_move(document, a, spore_object_parent(a), 1, &error));
  g_autofree char *moved = fixture_format(document);
  g_assert_cmpstr(moved, ==,
                  "<spore version=\"1.0\">\n"
                  "  <bodies>\n"
                  "    <body name=\"b\"/>\n"
                  "    <!-- of a -->\n"
                  "    <body name=\"a\"/> <!-- beside a -->\n"
                  "  </bodies>\n"
                  "</spore>\n");
  g_assert_true(spore_document_remove(document, a, &error));
  g_autofree char *removed = fixture_format(document);
  g_assert_null(strstr(removed, "<!--"));
  spore_document_free(document);
}

/* What is not canonical becomes so, and nothing is lost. */
static void test_other_layouts(void) {
  SporeDocument *document = fixture_parse("\xEF\xBB\xBF<spore version='1.0' ><!--a--><assets\t><!--b-->\r\n\r\n\r\n\r\n"
                                          "<mesh file='x\"y.off'   name = \"m\" ></mesh></assets  ></spore>");
  g_autofree char *text = fixture_format(document);
  g_assert_cmpstr(text, ==,
                  "<spore version=\"1.0\"> <!--a-->\n"
                  "  <assets> <!--b-->\n"
                  "\n"
                  "    <mesh file=\"x&quot;y.off\" name=\"m\"/>\n"
                  "  </assets>\n"
                  "</spore>\n");
  SporeDocument *again = fixture_parse(text);
  g_autofree char *fixed = fixture_format(again);
  g_assert_cmpstr(fixed, ==, text);
  spore_document_free(document);
  spore_document_free(again);
}

static void test_newer_minor(void) {
  spore_document_free(fixture_parse("<spore version=\"1.7\"><bodies><body name=\"a\"/></bodies></spore>"));
}

/* Bad input: text, place, what the message says. */
typedef struct Bad {
  const char *name, *text, *place, *says;
} Bad;

#define SCENE(content) "<spore version=\"1.0\">\n" content "\n</spore>\n"
static const Bad bad[] = {
    {"empty", "", "bad.spore", "the file is empty"},
    {"blank", " \n ", "bad.spore:", "not well-formed"},
    {"text", "solid spleen\n facet normal", "bad.spore:1:1", "not a SPORE scene"},
    {"binary",
     "\x7f"
     "ELF\x02\x01\xff\xfe",
     "bad.spore:1:7", "not UTF-8"},
    {"latin-1", SCENE("<meta title=\"Caf\xe9\"/>"), "bad.spore:2:17", "not UTF-8"},
    {"other-xml", "<!-- x -->\n <html/>", "bad.spore:2:2", "this is not a SPORE scene but <html>"},
    {"no-version", "<spore>\n</spore>", "bad.spore:1:1", "<spore> has no version"},
    {"newer-major", "<spore\n  format=\"x\" version=\"2.1\"/>", "bad.spore:2:14", "version 2.1"},
    {"older-major", "<spore version=\"0.9\"/>", "bad.spore:1:8", "0.9"},
    {"not-a-version", "<spore version=\"one\"/>", "bad.spore:1:8", "write version=\"1.0\""},
    {"unknown-element", SCENE("  <bodies>\n    <boddy/>\n  </bodies>"), "bad.spore:3:5", "did you mean <body>?"},
    {"unknown-nothing-near", SCENE("<quux/>"), "bad.spore:2:1", "expected <meta>, <units>"},
    {"element-elsewhere", SCENE("<bodies>\n\t<pin name=\"p\"/></bodies>"), "bad.spore:3:2",
     "does not belong in <bodies>"},
    {"model-outside", SCENE("<bodies><body name=\"a\"><particle/></body></bodies>"), "bad.spore:2:24", "<mechanical>"},
    {"unknown-attribute", SCENE("<bodies><body name=\"a\"\n   rol=\"active\"/></bodies>"), "bad.spore:3:4",
     "did you mean \"role\"?"},
    {"unknown-attribute-far", SCENE("<effects zzzzzz=\"1\"/>"), "bad.spore:2:10", "expected none"},
    {"columns-count-characters", SCENE("<meta title=\"\xC3\xA9\xC3\xA9\xC3\xA9\" zzzzzzzzz=\"1\"/>"), "bad.spore:2:19",
     "zzzzzzzzz"},
    {"out-of-range",
     SCENE(
         "<bodies><body name=\"a\"><mechanical>\n<particle note=\"x > y\" mass=\"-1\"/></mechanical></body></bodies>"),
     "bad.spore:3:24", "mass=\"-1\" is out of range"},
    {"not-a-number", SCENE("<environment gravity=\"0 down 0\"/>"), "bad.spore:2:14", "three numbers"},
    {"infinite", SCENE("<environment gravity=\"0 1e999 0\"/>"), "bad.spore:2:14", "finite"},
    {"nan", SCENE("<environment gravity=\"0 nan 0\"/>"), "bad.spore:2:14", "gravity=\"0 nan 0\""},
    {"hexadecimal", SCENE("<environment gravity=\"0 0x10 0\"/>"), "bad.spore:2:14", "three numbers"},
    {"junk-behind", SCENE("<environment gravity=\"0 1 0 m\"/>"), "bad.spore:2:14", "three numbers"},
    {"comma", SCENE("<environment gravity=\"0,1,0\"/>"), "bad.spore:2:14", "three numbers"},
    {"choice", SCENE("<bodies><body name=\"a\" role=\"pasive\"/></bodies>"), "bad.spore:2:24", "did you mean passive?"},
    {"name", SCENE("<bodies><body name=\"my liver\"/></bodies>"), "bad.spore:2:15", "is not a name"},
    {"no-name", SCENE("<bodies>\n  <body/></bodies>"), "bad.spore:3:3", "<body> has no name"},
    {"no-file", SCENE("<assets><mesh name=\"m\"/></assets>"), "bad.spore:2:9", "<mesh> has no file"},
    {"duplicate-name", SCENE("<bodies>\n  <body name=\"a\"/>\n  <body role=\"active\" name=\"a\"/></bodies>"),
     "bad.spore:4:23", "taken by the body at line 3, column 3"},
    {"duplicate-across-kinds", SCENE("<links><pin name=\"a\"/><spring name=\"a\"/></links>"), "bad.spore:2:31",
     "taken by the pin at line 2, column 8"},
    {"outside-up", SCENE("<assets><mesh name=\"m\" file=\"../secret.off\"/></assets>"), "bad.spore:2:24",
     "inside the scene's folder"},
    {"outside-middle", SCENE("<assets><mesh name=\"m\" file=\"a/../../b.off\"/></assets>"), "bad.spore:2:24", "file="},
    {"outside-root", SCENE("<assets><mesh name=\"m\" file=\"/etc/passwd\"/></assets>"), "bad.spore:2:24", "file="},
    {"outside-backslash", SCENE("<assets><mesh name=\"m\" file=\"a\\b.off\"/></assets>"), "bad.spore:2:24", "file="},
    {"outside-drive", SCENE("<assets><mesh name=\"m\" file=\"C:/b.off\"/></assets>"), "bad.spore:2:24", "file="},
    {"control-character", SCENE("<assets><mesh name=\"m\" file=\"a\x7f.off\"/></assets>"), "bad.spore:2:24", "control"},
    {"section-twice", SCENE("<bodies/>\n<bodies/>"), "bad.spore:3:1", "already holds <bodies>"},
    {"section-order", SCENE("<bodies/>\n <assets/>"), "bad.spore:3:2", "<assets> comes after <bodies>"},
    {"unit-order", SCENE("<bodies><body name=\"a\"><visual/><collision/></body></bodies>"), "bad.spore:2:33",
     "move it up"},
    {"two-models", SCENE("<bodies><body name=\"a\"><mechanical><particle/>\n<particle/></mechanical></body></bodies>"),
     "bad.spore:3:1", "at most one element"},
    {"text-inside", SCENE("<bodies>\n  liver</bodies>"), "bad.spore:3:3", "text does not belong here"},
    {"text-behind", SCENE("") "junk", "bad.spore:4:1", "text does not belong here"},
    {"entity", SCENE("<bodies>&boom;</bodies>"), "bad.spore:2:9", "text does not belong here"},
    {"entity-in-value", SCENE("<meta title=\"&boom;\"/>"), "bad.spore:2:", "boom"},
    {"cdata", SCENE("<bodies><![CDATA[x]]></bodies>"), "bad.spore:2:9", "CDATA"},
    {"instruction", SCENE("<?run me?>"), "bad.spore:2:1", "processing instruction"},
    {"stylesheet", "<?xml version=\"1.0\"?>\n<?xml-stylesheet href=\"x\"?><spore version=\"1.0\"/>", "bad.spore:2:1",
     "processing"},
    {"document-type",
     "<?xml version=\"1.0\"?>\n<!DOCTYPE spore SYSTEM \"file:///etc/passwd\">\n<spore version=\"1.0\"/>",
     "bad.spore:2:1", "<!DOCTYPE>"},
    {"laughs",
     "<!DOCTYPE spore [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;\">]>\n<spore "
     "version=\"&c;\"/>",
     "bad.spore:1:1", "<!DOCTYPE>"},
    {"namespace", SCENE("<bodies xmlns=\"urn:x\"/>"), "bad.spore:2:1", "namespace"},
    {"prefix", SCENE("<x:bodies xmlns:x=\"urn:x\"/>"), "bad.spore:2:1", "namespace"},
    {"prefixed-attribute", SCENE("<bodies xml:lang=\"fr\"/>"), "bad.spore:2:9", "xml:lang"},
    {"unclosed", "<spore version=\"1.0\">\n<bodies>", "bad.spore:2:", "not well-formed"},
    {"mismatched", SCENE("<bodies></links>"), "bad.spore:2:", "not well-formed"},
    {"unquoted", SCENE("<bodies name=a/>"), "bad.spore:2:", "not well-formed"},
    {"attribute-twice", SCENE("<meta title=\"a\" title=\"b\"/>"), "bad.spore:2:", "not well-formed"},
    {"two-roots", "<spore version=\"1.0\"/><spore version=\"1.0\"/>", "bad.spore:1:", "not well-formed"},
    {"open-quote", "<spore version=\"1.0>", "bad.spore:1:", "not well-formed"},
    {"open-comment", SCENE("<!-- x"), "bad.spore:", "not well-formed"},
    {"control-in-value", SCENE("<meta title=\"\x01\"/>"), "bad.spore:2:", "not well-formed"},
    {"utf-16-said", "<?xml version=\"1.0\" encoding=\"latin1-or-so\"?>\n<spore version=\"1.0\"/>",
     "bad.spore:1:", "encoding"},
};

static void test_bad(gconstpointer data) {
  const Bad *one = data;
  GError *error = NULL;
  SporeDocument *document = spore_scene_parse(fixture_schema(), "bad.spore", one->text, strlen(one->text), &error);
  g_assert_null(document);
  g_test_message("%s", error->message);
  if (!g_str_has_prefix(error->message, one->place)) g_error("\"%s\" is not at %s", error->message, one->place);
  char after = error->message[strlen(one->place)];
  g_assert_true(one->place[strlen(one->place) - 1] == ':' || after == ':');
  g_assert_cmpint(spore_error_exit_status(error), ==, 2);
  g_assert_null(strchr(error->message, '\n'));
  fixture_assert_error(error, SPORE_ERROR_INPUT, one->says);
}

static char *repeat(const char *before, const char *one, guint count, const char *after) {
  GString *text = g_string_new(before);
  for (guint i = 0; i < count; i++) g_string_append(text, one);
  g_string_append(text, after);
  return g_string_free(text, FALSE);
}

static void refuse_text(char *text, const char *place, const char *says) {
  GError *error = NULL;
  g_assert_null(spore_scene_parse(fixture_schema(), "bad.spore", text, strlen(text), &error));
  if (!g_str_has_prefix(error->message, place)) g_error("\"%.300s\" is not at %s", error->message, place);
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
  g_free(text);
}

static void test_limits(void) {
  refuse_text(repeat("<spore version=\"1.0\">", "<a>", 20, ""), "bad.spore:1:67", "nested too deeply");
  refuse_text(repeat("<spore version=\"1.0\"><bodies>\n", "<body/>", 250000, ""), "bad.spore:2:1399987",
              "too many elements");
  refuse_text(repeat("<spore", " a=\"1\"", 1000000, "/>"), "bad.spore:1:1", "too many attributes");
  refuse_text(repeat("<!DOCTYPE spore [", "<!ENTITY a \"b\">", 1000000, "]><spore version=\"1.0\"/>"), "bad.spore:1:1",
              "<!DOCTYPE>");
  refuse_text(repeat("<spore version=\"1.0\">", "<!-- 0123456789 -->", (65 << 20) / 19, "</spore>"),
              "bad.spore: ", "over 64 MiB");
}

/* As large as it may be: read, and not in time that grows with the square. */
static void test_large(void) {
  GString *text = g_string_new("<spore version=\"1.0\">\n  <bodies>\n");
  for (guint i = 0; i < 100000; i++) g_string_append_printf(text, "    <body name=\"b%u\"/>\n", i);
  g_string_append(text, "  </bodies>\n</spore>\n");
  SporeDocument *document = fixture_parse(text->str);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(document, "bodies")), ==, 100000);
  g_autofree char *again = fixture_format(document);
  g_assert_cmpstr(again, ==, text->str);
  spore_document_free(document);
  g_string_free(text, TRUE);
}

static void refuse_file(const char *path, const char *says) {
  GError *error = NULL;
  g_assert_null(spore_scene_load(fixture_schema(), path, &error));
  g_assert_true(g_str_has_prefix(error->message, path));
  g_assert_cmpint(spore_error_exit_status(error), ==, 2);
  fixture_assert_error(error, error->code, says);
}

static void test_files(void) {
  char *folder = fixture_folder_new();
  g_autofree char *missing = g_build_filename(folder, "missing.spore", NULL);
  g_autofree char *pipe = g_build_filename(folder, "pipe.spore", NULL);
  g_autofree char *empty = fixture_write(folder, "empty.spore", "");
  g_autofree char *good = fixture_write(folder, "good.spore", canonical);
  refuse_file(missing, "there is no such file");
  refuse_file(folder, "this is a folder");
  refuse_file(empty, "the file is empty");
  g_assert_cmpint(mkfifo(pipe, 0600), ==, 0);
  refuse_file(pipe, "not a regular file");
  GError *error = NULL;
  SporeDocument *document = spore_scene_load(fixture_schema(), good, &error);
  g_assert_no_error(error);
  g_assert_cmpstr(spore_document_file(document), ==, good);
  spore_document_free(document);
  fixture_folder_free(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/scene-xml/round-trip", test_round_trip);
  g_test_add_func("/scene-xml/change-stays-local", test_change_stays_local);
  g_test_add_func("/scene-xml/comments-travel", test_comments_travel);
  g_test_add_func("/scene-xml/other-layouts", test_other_layouts);
  g_test_add_func("/scene-xml/newer-minor", test_newer_minor);
  for (guint i = 0; i < G_N_ELEMENTS(bad); i++) {
    g_autofree char *path = g_strconcat("/scene-xml/bad/", bad[i].name, NULL);
    g_test_add_data_func(path, &bad[i], test_bad);
  }
  g_test_add_func("/scene-xml/limits", test_limits);
  g_test_add_func("/scene-xml/large", test_large);
  g_test_add_func("/scene-xml/files", test_files);
  return g_test_run();
}
