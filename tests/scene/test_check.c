/* Checks: each of the common mistakes is named, once, at its place, with a remedy; a good scene has none. */
#include <string.h>

#include "core/scene/check.h"
#include "fixture.h"

#define ASSETS                                                                                                         \
  "<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/></assets>\n"
#define SCENE(content) "<spore version=\"1.0\">\n" content "</spore>\n"
#define BALL "<collision spheres=\"ball\"/>"
#define STONE "<mechanical geometry=\"cube\"><rigid_body/></mechanical>"
#define FLOOR "<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\">" BALL "</body>\n"

static char *check_text(const char *text) {
  g_autofree char *folder = fixture_scene_folder_new(text);
  SporeDocument *document = fixture_load(folder);
  g_autoptr(GPtrArray) found = spore_document_check(document, NULL);
  GString *said = g_string_new(NULL);
  static const char *const severities[] = {"note", "warning", "fault"};
  SporeSeverity worst = SPORE_FAULT;
  for (guint i = 0; i < found->len; i++) {
    const SporeDiagnostic *one = g_ptr_array_index(found, i);
    g_assert_cmpint(one->severity, <=, worst); /* worst first */
    worst = one->severity;
    g_assert_nonnull(strstr(one->place, "scene.spore"));
    g_assert_cmpuint(strlen(one->remedy), >, 0);
    g_assert_true(one->object == 0 || spore_document_by_id(document, one->object));
    g_string_append_printf(said, "%s %s: %s; %s\n", severities[one->severity], strstr(one->place, "scene.spore") + 12,
                           one->message, one->remedy);
  }
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
  g_test_message("%s", said->str);
  return g_string_free(said, FALSE);
}

static void test_good(void) {
  g_autofree char *said =
      check_text(SCENE(ASSETS "<bodies>\n" FLOOR "<body name=\"stone\">" STONE BALL "</body>\n"
                              "<body name=\"probe\" role=\"active\" position=\"1 0 0\">" BALL "</body>\n</bodies>\n"
                              "<tools><probe name=\"t\" body=\"probe\" device=\"m\"/></tools>\n"
                              "<devices><mouse name=\"m\"/></devices>\n"));
  g_assert_cmpstr(said, ==, "");
}

#define FLUID(where)                                                                                                   \
  "<body name=\"blood\" position=\"" where                                                                             \
  "\"><mechanical geometry=\"cube\"><lennard_jones particles=\"60\"/></mechanical><collision/></body>\n"

/* A fluid's own spheres are spheres. */
static void test_own_spheres(void) {
  g_autofree char *said = check_text(SCENE(ASSETS "<bodies>\n" FLOOR FLUID("0 0.02 0") "</bodies>\n"));
  g_assert_cmpstr(said, ==, "");
}

typedef struct Mistake {
  const char *name, *text;
  const char *says[3]; /* severity, place and the start of the message */
} Mistake;

#define STAND "<body name=\"stone\">" STONE BALL "</body>\n"
#define BODIES(content) SCENE(ASSETS "<bodies>\n" content "</bodies>\n")

static const Mistake mistakes[] = {
    {"empty", SCENE(""), {"note 1:1: the scene has no bodies"}},
    {"dangling",
     BODIES("<body name=\"a\" role=\"unmovable\"><visual mesh=\"gone\"/>"
            "</body>\n" FLOOR STAND),
     {"fault 4:33: mesh=\"gone\" names nothing"}},
    {"no-model",
     BODIES(FLOOR STAND "<body name=\"a\" position=\"0 1 0\">" BALL "</body>\n"),
     {"fault 6:1: \"a\" is passive, but has no mechanical"}},
    {"unused-model",
     BODIES(FLOOR "<body name=\"stone\" role=\"unmovable\" position=\"0 1 0\">" STONE BALL "</body>\n"),
     {"note 5:54: the mechanical model of \"stone\" is not used"}},
    {"no-spheres",
     BODIES(FLOOR STAND "<body name=\"a\" role=\"unmovable\"/>\n"),
     {"note 6:1: \"a\" has no collision spheres"}},
    {"undriven",
     BODIES(FLOOR STAND "<body name=\"a\" role=\"active\" position=\"1 0 0\">" BALL "</body>\n"),
     {"warning 6:1: \"a\" is active, but no tool moves it"}},
    {"effect",
     BODIES(FLOOR "<body name=\"stone\">" STONE BALL "<fidelity mode=\"auto\"/></body>\n"),
     {"note 5:101: \"stone\" is to be what was advised"}},
    {"guessed",
     BODIES(FLOOR "<body name=\"stone\" name_guessed=\"true\">" STONE BALL "</body>\n"),
     {"note 5:1: the name \"stone\" is a guess"}},
    {"tool-without-anything",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n<tools><probe name=\"t\"/></tools>\n"),
     {"warning 7:8: the tool \"t\" has no body", "warning 7:8: the tool \"t\" has no device"}},
    {"needle-of-spheres",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND "<body name=\"needle\" role=\"active\" position=\"1 0 0\">" BALL
                  "</body>\n</bodies>\n<tools><needle name=\"n\" body=\"needle\" device=\"m\" tip=\"1 0 0\" "
                  "middle=\"1.01 0 0\" swage=\"1.02 0 0\"/></tools><devices><mouse name=\"m\"/></devices>\n"),
     {"note 8:8: \"n\" has nothing to work on", "note 8:8: \"n\" draws no thread"}},
    {"tool-on-passive",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n<tools><probe name=\"t\" body=\"stone\" device=\"m\"/></tools>"
                  "<devices><mouse name=\"m\"/></devices>\n"),
     {"fault 7:8: the tool \"t\" moves \"stone\", which is not active"}},
    {"link-without-body",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n<links><pin name=\"p\"/><spring name=\"s\"/></links>\n"),
     {"fault 7:8: the link \"p\" has no body", "fault 7:23: the link \"s\" has no body_a"}},
    {"tied-too-often",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n<links><weld name=\"w\" body_a=\"stone\"/>\n"
                  "<hinge name=\"h\" body_a=\"stone\" body_b=\"floor\" point=\"0 -0.1 0\"/></links>\n"),
     {"warning 8:1: \"h\" and the links before it hold 11 of the 6 ways"}},
    {"tied-far-away",
     SCENE(ASSETS "<bodies>\n" FLOOR STAND
                  "</bodies>\n<links><ball name=\"b\" body_a=\"stone\" point=\"0 7 0\"/></links>\n"),
     {"warning 7:8: \"b\" ties \"stone\" at a point that is"}},
    {"unused-asset",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\" "
           "source=\"cube\"/>\n"
           "<mesh name=\"spare\" file=\"cube.off\"/></assets><bodies>\n" FLOOR "</bodies>\n"),
     {"note 3:1: nothing uses the mesh \"spare\""}},
    {"unreadable-asset",
     SCENE("<assets><mesh name=\"cube\" file=\"gone.off\"/><spheres name=\"ball\" "
           "file=\"ball.spheres\"/></assets>\n<bodies>\n" FLOOR STAND "</bodies>\n"),
     {"fault 2:9: there is no file \"gone.off\""}},
    {"unreadable-unused-asset",
     SCENE("<assets><mesh name=\"cube\" file=\"gone.off\"/><spheres name=\"ball\" "
           "file=\"ball.spheres\"/></assets>\n<bodies>\n" FLOOR "</bodies>\n"),
     {"warning 2:9: there is no file \"gone.off\"", "note 2:9: nothing uses"}},
    {"too-large",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\" unit=\"m\"/><mesh name=\"huge\" file=\"large.off\"/>"
           "<spheres name=\"ball\" file=\"ball.spheres\"/></assets>\n<bodies>\n"
           "<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\">" BALL
           "<visual mesh=\"huge\"/></body>\n" STAND "</bodies>\n"),
     {"warning 2:53: \"huge\" is 173 m across"}},
    {"too-small",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\" unit=\"um\"/><spheres name=\"ball\" "
           "file=\"ball.spheres\"/></assets>\n"
           "<bodies>\n<body name=\"floor\" role=\"unmovable\">" BALL "<visual mesh=\"cube\"/></body></bodies>\n"),
     {"warning 2:9: \"cube\" is 0.173 µm across"}},
    {"open-mesh",
     SCENE("<assets><mesh name=\"o\" file=\"open.off\"/><spheres name=\"ball\" file=\"ball.spheres\" "
           "source=\"o\"/></assets>\n"
           "<bodies>\n<body name=\"floor\" role=\"unmovable\">" BALL "<visual mesh=\"o\"/></body></bodies>\n"),
     {"note 2:9: \"o\" is not a closed surface: 4 open"}},
    {"inside-out",
     SCENE("<assets><mesh name=\"i\" file=\"inside.off\"/><spheres name=\"ball\" file=\"ball.spheres\" "
           "source=\"i\"/></assets>\n"
           "<bodies>\n<body name=\"floor\" role=\"unmovable\">" BALL "<visual mesh=\"i\"/></body></bodies>\n"),
     {"note 2:9: \"i\" faces inward in its file"}},
    {"stale",
     SCENE(
         "<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\" source=\"cube\" "
         "source_hash=\"0000000000000000\"/></assets>\n<bodies>\n" FLOOR STAND "</bodies>\n"),
     {"warning 2:44: \"ball\" is stale: \"cube\""}},
    {"stale-frozen",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\" "
           "source=\"cube\" source_hash=\"0000000000000000\" frozen=\"true\"/></assets>\n<bodies>\n" FLOOR STAND
           "</bodies>\n"),
     {"note 2:44: \"ball\" is stale: \"cube\""}},
    {"overlap",
     BODIES(FLOOR "<body name=\"stone\" position=\"0.02 -0.1 0\">" STONE BALL "</body>\n"),
     {"warning 5:1: \"stone\" and \"floor\" overlap by 80 mm"}},
    {"small-overlap",
     BODIES(FLOOR "<body name=\"stone\" position=\"0 -0.01 0\">" STONE BALL "</body>\n"),
     {"note 5:1: \"stone\" and \"floor\" overlap by 10 mm"}},
    {"overlap-as-felt", /* not by 60 mm, as its radius would have it */
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/><spheres "
           "name=\"felt\" file=\"felt.spheres\"/></assets>\n"
           "<bodies>\n" FLOOR "<body name=\"stone\" position=\"0 -0.01 0\">" STONE
           "<collision spheres=\"felt\"/></body>\n</bodies>\n"),
     {"note 5:1: \"stone\" and \"floor\" overlap by 9.95 mm", "note 5:95: the weights of the spheres of \"stone\""}},
    {"weights-of-a-field", /* summed: nothing is said of them */
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/><spheres "
           "name=\"felt\" file=\"felt.spheres\"/></assets>\n"
           "<bodies>\n" FLOOR "<body name=\"stone\" position=\"0 -0.01 0\">" STONE
           "<collision spheres=\"felt\" surface=\"depth_field\"/></body>\n</bodies>\n"),
     {"note 5:1: \"stone\" and \"floor\" overlap by 9.95 mm"}},
    {"weights-of-a-soft-body",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/><spheres "
           "name=\"felt\" file=\"felt.spheres\"/></assets>\n"
           "<bodies>\n" FLOOR
           "<body name=\"skin\" position=\"0 0.3 0\"><mechanical geometry=\"cube\"><mass_spring_net/>"
           "</mechanical><collision spheres=\"felt\"/></body>\n</bodies>\n"),
     {"note 5:97: the weights of the spheres of \"skin\" are not used"}},
    {"overlap-in-a-group",
     BODIES("<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\"><collision spheres=\"ball\" "
            "group=\"1\"/></body>\n"
            "<body name=\"stone\" position=\"0.02 -0.1 0\">" STONE
            "<collision spheres=\"ball\" group=\"1\"/></body>\n"),
     {"note 5:1: \"stone\" is held by nothing"}},
    {"loose",
     BODIES("<body name=\"floor\" role=\"unmovable\" position=\"1 -1 0\">" BALL "</body>\n" STAND),
     {"note 5:1: \"stone\" is held by nothing"}},
    {"fluid-overlaps",
     SCENE(ASSETS "<bodies>\n" FLOOR FLUID("0 -0.05 0") "</bodies>\n"),
     {"warning 5:1: \"blood\" and \"floor\" overlap by"}},
    {"fluid-beside",
     SCENE(ASSETS "<bodies>\n" FLOOR FLUID("0.5 0.02 0") "</bodies>\n"),
     {"note 5:1: \"blood\" is held by nothing"}},
    {"fluid-implicit",
     SCENE("<solver time_step=\"0.0001\"/>\n" ASSETS "<bodies>\n" FLOOR
           "<body name=\"blood\" position=\"0 0.02 0\"><mechanical geometry=\"cube\" "
           "integrator=\"tr_bdf2\"><lennard_jones "
           "particles=\"60\"/></mechanical><collision/></body>\n</bodies>\n"),
     {"warning 6:40: particles of \"blood\" have no Jacobian that tr_bdf2 could use"}},
    {"fluid-ignores-scene",
     SCENE("<solver integrator=\"tr_bdf2\" error_tolerance=\"1e-5\"/>\n" ASSETS
           "<bodies>\n" FLOOR FLUID("0 0.02 0") "</bodies>\n"),
     {"warning 2:1: error_tolerance is not used",
      "note 6:40: the scene's integrator tr_bdf2 is not used for \"blood\""}},
    {"step-too-large",
     SCENE("<solver integrator=\"symplectic_euler\" time_step=\"0.05\"/>\n<assets><spheres name=\"ball\" "
           "file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>" BALL
           "</body></bodies>\n"),
     {"fault 6:1: a step of 0.05 s is too large for symplectic_euler"}},
    {"comes-too-fast",
     SCENE("<solver time_step=\"0.02\"/>\n" ASSETS "<bodies>\n" FLOOR "<body name=\"high\" position=\"0 1 0\">" STONE
           "<collision spheres=\"ball\" stiffness=\"1\"/></body>\n"
           "<body name=\"calm\" position=\"0 2 0\"><mechanical geometry=\"cube\" "
           "integrator=\"implicit_euler\"><rigid_body/>"
           "</mechanical><collision spheres=\"ball\" stiffness=\"1e7\"/></body>\n</bodies>\n"),
     {"warning 6:1: \"high\" comes at up to 4.43 m/s", "warning 7:1: \"calm\" comes at up to 4.2 m/s"}},
    {"error-tolerance-unused",
     SCENE("<solver error_tolerance=\"1e-6\"/>\n" ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n"),
     {"warning 2:1: error_tolerance is not used"}},
    {"explicit-equations",
     SCENE("<solver integrator=\"verlet\" linear=\"cholesky\"/>\n" ASSETS "<bodies>\n" FLOOR STAND "</bodies>\n"),
     {"note 2:1: every body is integrated explicitly"}},
    {"static-and-free",
     BODIES(FLOOR
            "<body name=\"stone\"><mechanical geometry=\"cube\" integrator=\"static\" substeps=\"4\"><rigid_body/>"
            "</mechanical>" BALL "</body>\n"),
     {"warning 5:20: substeps of \"stone\" gain nothing", "warning 5:20: \"stone\" is integrated by static, but"}},
    {"depth-field-of-net",
     BODIES(FLOOR "<body name=\"stone\"><mechanical geometry=\"cube\"><mass_spring_net/></mechanical>"
                  "<collision spheres=\"ball\" surface=\"depth_field\"/></body>\n"),
     {"warning 5:79: the depth field of \"stone\" is not used"}},
    {"alone-in-group",
     BODIES(FLOOR "<body name=\"stone\">" STONE "<collision spheres=\"ball\" group=\"3\"/></body>\n"),
     {"note 5:74: \"stone\" is alone in group 3"}},
    {"wide-margin",
     BODIES(FLOOR "<body name=\"stone\">" STONE "<collision spheres=\"ball\" margin=\"0.2\"/></body>\n"),
     {"warning 5:74: the margin of \"stone\" is 0.2 m, more than the radius"}},
    {"self-of-unmovable",
     BODIES("<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\"><collision spheres=\"ball\" "
            "self=\"true\"/></body>\n" STAND),
     {"note 4:57: the spheres of \"floor\" do not move"}},
    {"too-fast",
     BODIES(FLOOR "<body name=\"stone\" velocity=\"3 0 4\">" STONE
                  "<collision spheres=\"ball\" stiffness=\"2000\" damping=\"0\"/></body>\n"),
     {"warning 5:1: \"stone\" comes at up to 5 m/s, and a single contact, as with \"floor\", stops it up to "}},
    {"nearly-too-fast",
     BODIES(FLOOR "<body name=\"stone\" velocity=\"0.6 0 0.8\">" STONE
                  "<collision spheres=\"ball\" stiffness=\"2000\" damping=\"1000\"/></body>\n"),
     {"note 5:1: \"stone\" comes at up to 1 m/s, and a single contact, as with \"floor\", stops it up to "}},
    {"not-too-fast",
     BODIES(FLOOR "<body name=\"stone\" velocity=\"0.06 0 0.08\">" STONE
                  "<collision spheres=\"ball\" stiffness=\"2000\" damping=\"1000\"/></body>\n"),
     {NULL}},
    {"spheres-away",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" "
           "file=\"away.spheres\"/></assets>\n"
           "<bodies>\n" FLOOR STAND "</bodies>\n"),
     {"note 5:74: 1 of the 2 spheres of \"stone\" lie away from its geometry"}},
    {"spheres-far",
     SCENE("<assets><spheres name=\"ball\" file=\"far.spheres\"/><tetrahedra name=\"cells\" "
           "file=\"cube.mesh\"/></assets>\n"
           "<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>" BALL
           "</body></bodies>\n"),
     {"warning 5:88: 1 of the 2 spheres of \"organ\" lie away from its geometry, and follow it as on a lever: up to "}},
    {"drawn-off",
     SCENE("<assets><spheres name=\"ball\" file=\"ball.spheres\"/><mesh name=\"wide\" file=\"wide.off\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>" BALL
           "\n<visual mesh=\"wide\"/></body></bodies>\n"),
     {"warning 6:1: 100% of the vertices drawn for \"organ\" lie off its geometry, by up to 86.6 mm at (-0.1 -0.1 "
      "-0.1) "
      "m, and swing up to "}},
    {"not-drawn",
     SCENE("<assets><spheres name=\"ball\" file=\"ball.spheres\"/><mesh name=\"wide\" file=\"wide.off\"/>"
           "<mesh name=\"sheet\" file=\"sheet.off\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"net\"><mechanical geometry=\"sheet\"><mass_spring_net/></mechanical>" BALL
           "\n<visual mesh=\"wide\"/></body></bodies>\n"),
     {"warning 6:1: \"net\" is not drawn: of its mesh, point 0: the point lies 0.1 m off a flat net"}},
    {"material",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\" material=\"spleen\"><neo_hookean_tetrahedra/>"
           "</mechanical>" BALL "</body></bodies>\n"),
     {NULL}},
    {"beyond-material",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\" material=\"spleen\">\n"
           "<neo_hookean_tetrahedra young_modulus=\"5000\" density=\"1200\"/></mechanical>" BALL "</body></bodies>\n"),
     {"warning 7:1: young_modulus=\"5000\" lies outside of what was measured of Spleen: 1100 to 4700 Pa (AJR.10.5449"}},
    {"region",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical><regions>"
           "<region name=\"knot\" centre=\"0 0 0\" radius=\"0.04\" stiffness_scale=\"20\" density_scale=\"1.1\"/>"
           "<region name=\"fat\" centre=\"0.05 0.05 0.05\" radius=\"0.06\" material=\"fat\"/></regions>" BALL
           "</body></bodies>\n"),
     {NULL}},
    {"region-of-nothing",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>\n<regions>"
           "<region name=\"knot\" centre=\"1 0 0\" radius=\"0.04\"/></regions>" BALL "</body></bodies>\n"),
     {"fault 7:10: the region \"knot\" holds the middle of no element"}},
    {"region-painted",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>\n<regions>"
           "<region name=\"scar\" centre=\"1 0 0\" radius=\"0.04\" stiffness_scale=\"20\">"
           "<dab centre=\"0 0 0\" radius=\"0.04\"/></region></regions>" BALL "</body></bodies>\n"),
     {NULL}},
    {"region-painted-beside",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>\n<regions>"
           "<region name=\"scar\" centre=\"1 0 0\" radius=\"0.04\"><dab centre=\"0 2 0\" radius=\"0.04\"/></region>"
           "</regions>" BALL "</body></bodies>\n"),
     {"fault 7:10: the painted region \"scar\" holds the middle of no element"}},
    {"region-of-net",
     BODIES(FLOOR "<body name=\"stone\">" STONE "\n<regions><region name=\"knot\" centre=\"0 0 0\"/></regions>" BALL
                  "</body>\n"),
     {"fault 6:1: rigid_body has no regions; expected tetrahedra or finite differences"}},
    {"root-of-stone",
     SCENE("<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<curve name=\"line\" file=\"line.curve\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"stone\">\n<mechanical geometry=\"cube\" root=\"line\"><rigid_body/></mechanical>" BALL
           "</body></bodies>\n"),
     {"fault 6:1: root=\"line\" is the root of a mesentery, and rigid_body has none"}},
    {"region-of-unknown-density",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>\n<regions>"
           "<region name=\"knot\" centre=\"0 0 0\" radius=\"0.1\" material=\"small_intestine\"/></regions>" BALL
           "</body></bodies>\n"),
     {"fault 7:10: material=\"small_intestine\" does not tell the region its density"}},
    {"material-of-nothing",
     BODIES(FLOOR "<body name=\"stone\"><mechanical geometry=\"cube\" material=\"small_intestine\"><rigid_body/>"
                  "</mechanical>" BALL "</body>\n"),
     {"note 5:20: material=\"small_intestine\" says nothing to rigid_body"}},
    {"locking",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra poisson_ratio=\"0.48\"/>"
           "</mechanical>" BALL "</body></bodies>\n"),
     {"warning 6:49: linear elements with a Poisson's ratio above 0.45 are much too stiff"}},
    {"not-locking",
     SCENE("<solver integrator=\"implicit_euler\"/>\n<assets><spheres name=\"ball\" file=\"ball.spheres\"/>"
           "<tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
           "<body name=\"organ\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra poisson_ratio=\"0.48\" "
           "element=\"quadratic\"/></mechanical>" BALL "</body></bodies>\n"),
     {NULL}},
    {"cannot-run",
     SCENE(ASSETS "<bodies>\n" FLOOR
                  "<body name=\"stone\"><mechanical geometry=\"cube\"><corotational_tetrahedra/></mechanical>" BALL
                  "</body>\n</bodies>\n"),
     {"fault 5:20: geometry=\"cube\" is a <mesh>; corotational_tetrahedra needs tetrahedra; generate them"}},
};

static void test_mistake(gconstpointer data) {
  const Mistake *one = data;
  g_autofree char *said = check_text(one->text);
  guint lines = 0, expected = 0;
  for (const char *c = said; *c; c++) lines += *c == '\n';
  for (guint i = 0; i < G_N_ELEMENTS(one->says) && one->says[i]; i++) {
    const char *found = strstr(said, one->says[i]);
    if (!found || (found != said && found[-1] != '\n')) g_error("\"%s\" is not said, but:\n%s", one->says[i], said);
    expected++;
  }
  g_assert_cmpuint(lines, ==, expected); /* and nothing else */
}

/* Implicit integration takes the same step. */
static void test_step_of_implicit(void) {
  g_autofree char *said = check_text(
      SCENE("<solver integrator=\"implicit_euler\" time_step=\"0.05\"/>\n<assets><spheres name=\"ball\" "
            "file=\"ball.spheres\"/><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n" FLOOR
            "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>" BALL
            "</body></bodies>\n"));
  g_assert_cmpstr(said, ==, "");
}

/* A material gives the values that the author leaves out, and no others; a file keeps what was written. */
static void test_material(void) {
  static const char text[] =
      SCENE("<assets><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n<bodies>\n<body name=\"organ\">"
            "<mechanical geometry=\"cells\" material=\"kidney\"><neo_hookean_tetrahedra density=\"1111\"/>"
            "</mechanical></body></bodies>\n");
  g_autofree char *folder = fixture_scene_folder_new(text);
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  SporeObject *mechanical = spore_document_by_path(document, "bodies/organ/mechanical");
  SporeObject *model = spore_object_child(mechanical, 0);
  g_assert_cmpstr(spore_object_tissue(model)->name, ==, "kidney");
  g_assert_cmpfloat(spore_object_number(model, "young_modulus"), ==, 5000);
  g_assert_cmpfloat(spore_object_number(model, "poisson_ratio"), ==, 0.45);
  g_assert_cmpfloat(spore_object_number(model, "density"), ==, 1111);
  g_assert_cmpfloat(spore_object_number(model, "stiffness_damping"), ==, 0.00082);
  g_assert_true(spore_document_set_text(document, mechanical, "material", "uterus", &error));
  g_assert_cmpfloat(spore_object_number(model, "stiffness_damping"), ==,
                    0.01); /* nobody measured it: the model's own */
  g_assert_cmpfloat(spore_object_number(model, "young_modulus"), ==, 6380);
  spore_document_undo(document);
  g_autofree char *written = fixture_format(document);
  g_assert_nonnull(strstr(written, "material=\"kidney\">"));
  g_assert_nonnull(strstr(written, "<neo_hookean_tetrahedra density=\"1111\"/>"));
  g_assert_true(spore_document_set_text(document, mechanical, "material", "none", &error));
  g_assert_null(spore_object_tissue(model));
  g_assert_cmpfloat(spore_object_number(model, "young_modulus"), ==, 5000); /* the model's own */
  g_assert_false(spore_document_set_text(document, mechanical, "material", "livr", &error));
  g_assert_nonnull(strstr(error->message, "liver"));
  g_clear_error(&error);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* Every figure of a tissue is one that each model with that parameter takes, and lies within its own range. */
static void test_tissues(void) {
  guint filled = 0;
  SporeModelRegistry registry = spore_schema_registry(fixture_model_schema());
  for (const SporeTissue *tissue = spore_tissues; tissue->name; tissue++)
    for (const SporeTissueQuantity *one = tissue->quantities; one->name; one++) {
      g_assert_cmpuint(strlen(one->source), >, 0);
      if (one->maximum > one->minimum) {
        g_assert_cmpfloat(one->typical.number[0], >=, one->minimum);
        g_assert_cmpfloat(one->typical.number[0], <=, one->maximum);
      }
      for (gsize i = 0; registry[i]; i++) {
        int index = spore_parameter_find(&registry[i]->parameters, one->name);
        SporeError fault = SPORE_ERROR_INIT;
        if (index < 0 || strcmp(registry[i]->name, "smoke") == 0) continue; /* smoke is of no tissue */
        g_assert_cmpstr(registry[i]->parameters.parameters[index].unit, ==, one->unit);
        if (!spore_parameter_check(&registry[i]->parameters.parameters[index], &one->typical, &fault))
          g_error("%s: %s", registry[i]->name, fault.message);
        filled++;
      }
    }
  g_assert_cmpuint(filled, >, 100);
}

/* As many bodies, assets and references as fit: in a time that grows with their number alone. */
static void test_large(void) {
  GString *text = g_string_new("<spore version=\"1.0\"><assets>");
  for (int i = 0; i < 2000; i++) g_string_append_printf(text, "<spheres name=\"s%d\" file=\"ball.spheres\"/>", i);
  g_string_append(text, "</assets><bodies>");
  for (int i = 0; i < 2000; i++)
    g_string_append_printf(
        text, "<body name=\"b%d\" role=\"unmovable\" position=\"%d 0 0\"><collision spheres=\"s%d\"/></body>", i, i, i);
  g_string_append(text, "</bodies></spore>");
  g_autofree char *said = check_text(text->str);
  g_assert_cmpstr(said, ==, "");
  g_string_free(text, TRUE);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/check/good", test_good);
  g_test_add_func("/check/own-spheres", test_own_spheres);
  for (guint i = 0; i < G_N_ELEMENTS(mistakes); i++) {
    g_autofree char *path = g_strconcat("/check/", mistakes[i].name, NULL);
    g_test_add_data_func(path, &mistakes[i], test_mistake);
  }
  g_test_add_func("/check/step-of-implicit", test_step_of_implicit);
  g_test_add_func("/check/tissues", test_tissues);
  g_test_add_func("/check/fills", test_material);
  g_test_add_func("/check/large", test_large);
  return g_test_run();
}
