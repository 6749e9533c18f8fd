/* Each fix that checks offer makes the problem go away, in one step of undo; none is offered where it would not help.
 */
#include <string.h>

#include "core/author/fix.h"
#include "tests/scene/fixture.h"

#define ASSETS                                                                                                         \
  "<mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/>"                              \
  "<tetrahedra name=\"cells\" file=\"cube.mesh\"/>"                                                                    \
  "<spheres name=\"old\" file=\"felt.spheres\" count=\"4\" source=\"cube\" source_hash=\"0000000000000000\"/>"         \
  "<spheres name=\"cold\" file=\"felt.spheres\" frozen=\"true\" source=\"cube\" source_hash=\"0000000000000000\"/>"
#define BALL "<collision spheres=\"ball\"/>"
#define FLOOR "<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\">" BALL "</body>"
#define RIGID "<mechanical geometry=\"cube\"><rigid_body/></mechanical>"
#define SOFT "<mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical>"
#define SEEN "<visual mesh=\"cube\"/>"
#define PIN "<links><pin name=\"p\" body=\"b\" point=\"0.05 0.05 0.05\" radius=\"0.02\"/></links>"

typedef struct Case {
  const char *name;
  const char *solver, *bodies, *rest; /* rest: links and later sections */
  const char *message;                /* a part of it */
  SporeFix fix;                       /* NONE: none is offered */
} Case;

static const Case cases[] = {
    {"unused", "", FLOOR, "", "nothing uses the tetrahedra", SPORE_FIX_REMOVE},
    {"falls", "", "<body name=\"b\">" RIGID BALL SEEN "</body>", "", "it falls", SPORE_FIX_HOLD},
    {"tolerance", "<solver error_tolerance=\"0.01\"/>", FLOOR "<body name=\"b\">" RIGID BALL "</body>", "",
     "error_tolerance is not used", SPORE_FIX_SET},
    {"explicit", "<solver integrator=\"verlet\" nonlinear=\"newton\"/>", FLOOR "<body name=\"b\">" RIGID BALL "</body>",
     "", "every body is integrated explicitly", SPORE_FIX_SET},
    {"substeps", "",
     "<body name=\"b\"><mechanical geometry=\"cells\" integrator=\"static\" substeps=\"4\"><neo_hookean_tetrahedra/>"
     "</mechanical>" BALL "</body>",
     PIN, "gain nothing", SPORE_FIX_SET},
    {"particles", "",
     FLOOR "<body name=\"b\"><mechanical geometry=\"cube\" integrator=\"implicit_euler\"><lennard_jones "
           "particles=\"60\"/></mechanical></body>",
     "", "have no Jacobian", SPORE_FIX_SET},
    {"margin", "", FLOOR "<body name=\"b\">" RIGID "<collision spheres=\"ball\" margin=\"0.06\"/></body>", "",
     "the margin of", SPORE_FIX_SET},
    {"texture", "", FLOOR "<body name=\"b\">" RIGID BALL "<visual mesh=\"cube\" texture_places=\"a\"/></body>", "",
     "has places in a texture", SPORE_FIX_SET},
    {"effect", "", "<body name=\"b\" role=\"unmovable\">" BALL "<fidelity mode=\"effect\"/></body>", "",
     "is to be an effect", SPORE_FIX_SET},
    {"step", "<solver time_step=\"0.02\"/>",
     "<body name=\"b\"><mechanical geometry=\"cells\" integrator=\"symplectic_euler\"><neo_hookean_tetrahedra "
     "young_modulus=\"1e6\"/></mechanical>" BALL "</body>",
     PIN, "is too large for", SPORE_FIX_SET},
    {"no-step", "<solver time_step=\"0.02\"/>",
     "<body name=\"b\"><mechanical geometry=\"cells\" integrator=\"symplectic_euler\"><neo_hookean_tetrahedra "
     "young_modulus=\"1e8\"/></mechanical>" BALL "</body>",
     PIN, "is too large for", SPORE_FIX_NONE},
    {"spheres", "", FLOOR "<body name=\"b\">" SOFT SEEN "</body>", "", "has no collision spheres", SPORE_FIX_GENERATE},
    {"no-spheres", "", FLOOR "<body name=\"b\">" SOFT "</body>", "", "has no collision spheres", SPORE_FIX_NONE},
    {"stale", "", FLOOR "<body name=\"b\">" RIGID "<collision spheres=\"old\"/>" SEEN "</body>", "", "\"old\" is stale",
     SPORE_FIX_GENERATE},
    {"frozen", "", FLOOR "<body name=\"b\">" RIGID "<collision spheres=\"cold\"/>" SEEN "</body>", "",
     "\"cold\" is stale", SPORE_FIX_NONE},
    {"no-model", "", "<body name=\"b\">" BALL "</body>", "", "has no mechanical model", SPORE_FIX_NONE},
};

static const SporeDiagnostic *find(const GPtrArray *found, const char *message) {
  for (guint i = 0; i < found->len; i++)
    if (strstr(((const SporeDiagnostic *)found->pdata[i])->message, message)) return found->pdata[i];
  return NULL;
}

static void apply(SporeDocument *document, const SporeDiagnostic *diagnostic) {
  g_autoptr(GError) error = NULL;
  SporeFixWork *work = spore_fix_work_new(document, diagnostic, &error);
  g_assert_no_error(error);
  g_assert_true(spore_fix_work_is_long(work) == (diagnostic->fix == SPORE_FIX_GENERATE));
  g_assert_true(spore_fix_work_run(work, NULL, &error));
  g_assert_true(spore_fix_work_apply(work, document, &error));
  g_assert_no_error(error);
  spore_fix_work_free(work);
}

static void test_case(gconstpointer data) {
  const Case *one = data;
  g_autofree char *text =
      g_strdup_printf("<spore version=\"1.0\">%s<assets>" ASSETS "</assets><bodies>%s</bodies>%s</spore>\n",
                      one->solver, one->bodies, one->rest);
  FixtureScene scene = fixture_scene_new(text);
  g_autoptr(GPtrArray) before = spore_document_check(scene.document, NULL);
  const SporeDiagnostic *found = find(before, one->message);
  g_autofree char *saved = fixture_format(scene.document);
  for (guint i = 0; !found && i < before->len; i++)
    g_printerr("# %s\n", ((const SporeDiagnostic *)before->pdata[i])->message);
  g_assert_nonnull(found);
  g_assert_cmpint(found->fix, ==, one->fix);
  if (one->fix != SPORE_FIX_NONE) {
    g_autofree char *label = spore_fix_label(found);
    g_assert_true(label && *label);
    apply(scene.document, found);
    g_autoptr(GPtrArray) after = spore_document_check(scene.document, NULL);
    g_assert_null(find(after, one->message));
    spore_document_undo(scene.document);
    g_autofree char *undone = fixture_format(scene.document);
    g_assert_cmpstr(undone, ==, saved);
  } else {
    g_autoptr(GError) error = NULL;
    g_assert_null(spore_fix_work_new(scene.document, found, &error));
    fixture_assert_error(error, SPORE_ERROR_INPUT, "there is no fix for this");
  }
  fixture_scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *path = g_strdup_printf("/fix/%s", cases[i].name);
    g_test_add_data_func(path, &cases[i], test_case);
  }
  return g_test_run();
}
