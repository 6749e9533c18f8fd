/* A mirrored copy is the image of the body to the point: its mesh, its cells, its links to the scene; its original
 * stays. */
#include <math.h>

#include "core/author/mirror_edits.h"
#include "core/author/placement.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

static const char organs[] =
    "<spore version=\"1.0\"><assets><mesh name=\"left_cube\" file=\"wide.off\"/><tetrahedra name=\"cells\" "
    "file=\"cube.mesh\"/><spheres name=\"balls\" file=\"away.spheres\"/></assets><bodies>"
    "<body name=\"ovary_left\" position=\"0.3 0.1 0\" rotation=\"0.2 0.4 0.6\" velocity=\"1 2 3\" spin=\"1 2 3\">"
    "<mechanical geometry=\"cells\"><corotational_tetrahedra young_modulus=\"4000\"/></mechanical>"
    "<regions><region name=\"core\" centre=\"0.01 0.02 0.03\" radius=\"0.1\">"
    "<dab centre=\"0.02 0 0\" radius=\"0.04\"/></region></regions>"
    "<collision spheres=\"balls\" group=\"1\"/><visual mesh=\"left_cube\" colour=\"0.1 0.2 0.3\"/></body>"
    "<body name=\"wall\" role=\"unmovable\" position=\"-0.5 0 0\"><visual mesh=\"left_cube\"/></body>"
    "<body name=\"probe\" role=\"active\"/></bodies><links>"
    "<pin name=\"hold_left\" body=\"ovary_left\" point=\"0.31 0.1 0\" radius=\"0.08\"/>"
    "<spring name=\"cord\" body_a=\"ovary_left\" point_a=\"0.3 0.1 0\" body_b=\"wall\" point_b=\"0 0 0\"/>"
    "</links></spore>\n";

static SporeVec3 vertex(const FixtureScene *scene, const SporeObject *body, gsize i) {
  SporeObject *asset = spore_object_reference(spore_object_child_of(body, "visual"), "mesh");
  const SporeTriangleMesh *mesh = spore_document_mesh(scene->document, asset, NULL);
  return spore_pose_apply(spore_body_pose(body), spore_vec3_load(mesh->vertices + 3 * i));
}

/* About every axis, each vertex in the scene is the image of its original, and no mesh or cell is inside out. */
static void test_image(void) {
  for (int axis = 0; axis < 3; axis++) {
    FixtureScene scene = fixture_scene_new(organs);
    g_autofree char *before = fixture_format(scene.document);
    g_autoptr(GError) error = NULL;
    SporeObject *body = spore_document_find(scene.document, "body", "ovary_left");
    SporeObject *copy = spore_edit_mirror(scene.document, body, axis, 0.05, &error);
    g_assert_no_error(error);
    g_assert_cmpstr(spore_object_name(copy), ==, "ovary_right");
    for (gsize i = 0; i < 4; i++) {
      double at[3], image[3];
      spore_vec3_store(at, vertex(&scene, body, i));
      spore_vec3_store(image, vertex(&scene, copy, i));
      for (int k = 0; k < 3; k++) g_assert_cmpfloat_with_epsilon(image[k], k == axis ? 0.1 - at[k] : at[k], 1e-9);
    }
    SporeObject *pin = spore_document_find(scene.document, "pin", "hold_right");
    g_assert_cmpstr(spore_object_text(pin, "body"), ==, "ovary_right");
    if (axis == 0) {
      g_assert_cmpfloat_with_epsilon(spore_object_vector(pin, "point").x, -0.21, 1e-12);
      g_assert_cmpfloat(spore_object_vector(copy, "velocity").x, ==, -1);
      g_assert_cmpfloat(spore_object_vector(copy, "spin").x, ==, 1);
      g_assert_cmpfloat(spore_object_vector(copy, "spin").y, ==, -2);
      SporeObject *region = spore_object_child(spore_object_child_of(copy, "regions"), 0);
      g_assert_cmpfloat(spore_object_vector(region, "centre").x, ==, -0.01);
      g_assert_cmpfloat(spore_object_vector(spore_object_child(region, 0), "centre").x, ==, -0.02);
    }
    g_assert_cmpfloat(spore_object_vector(spore_object_child_of(copy, "visual"), "colour").x, ==, 0.1);
    g_assert_cmpfloat(spore_object_number(spore_body_model_object(copy), "young_modulus"), ==, 4000);
    g_assert_cmpuint(spore_object_child_count(spore_document_section(scene.document, "links")), ==, 3);
    g_autoptr(SporeSimulation) simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
    g_assert_no_error(error); /* cells that are inside out are refused */
    spore_document_undo(scene.document);
    g_autofree char *after = fixture_format(scene.document);
    g_assert_cmpstr(after, ==, before);
    fixture_scene_free(&scene);
  }
}

/* The middle of what no device moves; an instrument is refused. */
static void test_middle(void) {
  FixtureScene scene = fixture_scene_new(organs);
  GError *error = NULL;
  double lower[3], upper[3];
  spore_body_box(scene.document, spore_document_find(scene.document, "body", "ovary_left"), lower, upper);
  g_assert_cmpfloat_with_epsilon(spore_scene_middle(scene.document, 0), 0.5 * (upper[0] - 0.6), 1e-9);
  SporeObject *probe = spore_document_find(scene.document, "body", "probe");
  g_assert_null(spore_edit_mirror(scene.document, probe, 0, 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "add another one from the library");
  g_assert_false(spore_document_can_undo(scene.document));
  fixture_scene_free(&scene);
}

/* A plain copy stands beside with the meshes of the body, and with a pin and its point of its own. */
static void test_copy(void) {
  FixtureScene scene = fixture_scene_new(organs);
  g_autofree char *before = fixture_format(scene.document);
  g_autoptr(GPtrArray) bodies = g_ptr_array_new();
  g_autoptr(GError) failure = NULL;
  GError *error = NULL;
  SporeObject *body = spore_document_find(scene.document, "body", "ovary_left");
  g_ptr_array_add(bodies, body);
  double lower[3], upper[3];
  spore_body_box(scene.document, body, lower, upper);
  SporeVec3 offset = spore_copy_offset(scene.document, bodies);
  g_assert_cmpfloat(offset.x, >, upper[0] - lower[0]);
  g_autoptr(GPtrArray) copies = spore_edit_copy(scene.document, bodies, offset, &failure);
  g_assert_no_error(failure);
  SporeObject *copy = copies->pdata[0];
  g_assert_cmpstr(spore_object_name(copy), ==, "ovary_left-2");
  for (gsize i = 0; i < 4; i++)
    g_assert_cmpfloat(spore_vec3_distance(vertex(&scene, copy, i), spore_vec3_add(vertex(&scene, body, i), offset)), <,
                      1e-9);
  SporeObject *pin = spore_document_find(scene.document, "pin", "hold_left-2");
  g_assert_cmpstr(spore_object_text(pin, "body"), ==, "ovary_left-2");
  g_assert_cmpfloat_with_epsilon(spore_object_vector(pin, "point").x, 0.31 + offset.x, 1e-12);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(scene.document, "links")), ==, 3);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(scene.document, "assets")), ==, 3);
  spore_document_undo(scene.document);
  bodies->pdata[0] = spore_document_find(scene.document, "body", "probe");
  g_assert_null(spore_edit_copy(scene.document, bodies, offset, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "an instrument is not copied");
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  fixture_scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mirror/image", test_image);
  g_test_add_func("/mirror/middle", test_middle);
  g_test_add_func("/mirror/copy", test_copy);
  return g_test_run();
}
