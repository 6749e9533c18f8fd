/* A scaled body is the image of the body to the point: its mesh, its cells, its spheres, what is tied to it; what
 * others use stays, and generated data stay fresh. */
#include <math.h>

#include "core/author/placement.h"
#include "core/author/scale_edits.h"
#include "core/scene/compile.h"
#include "core/scene/generated.h"
#include "tests/scene/fixture.h"

static const char organs[] =
    "<spore version=\"1.0\"><assets><mesh name=\"skin\" file=\"wide.off\" unit=\"cm\"/><tetrahedra name=\"cells\" "
    "file=\"cube.mesh\"><cell_region name=\"fine\" centre=\"0.01 0 0\" radius=\"0.02\" size=\"0.003\"/></tetrahedra>"
    "<spheres name=\"balls\" file=\"away.spheres\"/></assets><bodies>"
    "<body name=\"ovary\" position=\"0.3 0.1 0\" rotation=\"0.2 0.4 0.6\">"
    "<mechanical geometry=\"cells\"><corotational_tetrahedra young_modulus=\"4000\"/></mechanical>"
    "<regions><region name=\"core\" centre=\"0.01 0.02 0.03\" radius=\"0.1\">"
    "<dab centre=\"0.02 0 0\" radius=\"0.04\"/></region></regions>"
    "<collision spheres=\"balls\" group=\"1\"/><visual mesh=\"skin\" colour=\"0.1 0.2 0.3\"/></body>"
    "<body name=\"wall\" role=\"unmovable\" position=\"-0.5 0 0\"><visual mesh=\"skin\"/></body>"
    "<body name=\"probe\" role=\"active\"/></bodies><links>"
    "<pin name=\"hold\" body=\"ovary\" point=\"0.31 0.1 0\" radius=\"0.08\"/>"
    "<spring name=\"cord\" body_a=\"ovary\" point_a=\"0.3 0.1 0\" body_b=\"wall\" point_b=\"0 0 0\" "
    "rest_length=\"0.1\"/>"
    "</links></spore>\n";

static SporeObject *named(const FixtureScene *scene, const char *elements, const char *name) {
  return spore_document_find(scene->document, elements, name);
}

static SporeVec3 vertex(const FixtureScene *scene, const char *body, gsize i) {
  SporeObject *asset = spore_object_reference(spore_object_child_of(named(scene, "body", body), "visual"), "mesh");
  const SporeTriangleMesh *mesh = spore_document_mesh(scene->document, asset, NULL);
  return spore_pose_apply(spore_body_pose(named(scene, "body", body)), spore_vec3_load(mesh->vertices + 3 * i));
}

static void remember(const FixtureScene *scene, const char *element, const char *name) {
  SporeObject *asset = named(scene, element, name);
  g_autofree char *hash = spore_document_asset_hash(scene->document, named(scene, "mesh", "skin"));
  g_autofree char *options = spore_generated_options_hash(asset);
  g_assert_true(spore_document_set_text(scene->document, asset, "source", "skin", NULL));
  g_assert_true(spore_document_set_text(scene->document, asset, "source_hash", hash, NULL));
  g_assert_true(spore_document_set_text(scene->document, asset, "options_hash", options, NULL));
}

static FixtureScene scene_with(GPtrArray **bodies, const char *body) {
  FixtureScene scene = fixture_scene_new(organs);
  *bodies = g_ptr_array_new();
  g_ptr_array_add(*bodies, named(&scene, "body", body));
  return scene;
}

static void assert_near(SporeVec3 at, SporeVec3 expected) {
  if (spore_vec3_distance(at, expected) > 2e-6)
    g_error("%g %g %g, expected %g %g %g", at.x, at.y, at.z, expected.x, expected.y, expected.z);
}

static void assert_scaled(const FixtureScene *scene, SporeVec3 middle, const SporeVec3 *before) {
  for (gsize i = 0; i < 4; i++) {
    SporeVec3 way = spore_vec3_sub(before[i], middle);
    assert_near(vertex(scene, "ovary", i), spore_vec3_add_scaled(middle, 2.5, way));
    assert_near(vertex(scene, "wall", i), before[4 + i]);
  }
  const SporeObject *pin = named(scene, "pin", "hold"), *cord = named(scene, "spring", "cord");
  assert_near(spore_object_vector(pin, "point"),
              spore_vec3_add_scaled(middle, 2.5, spore_vec3_sub(spore_vec3(0.31, 0.1, 0), middle)));
  g_assert_cmpfloat_with_epsilon(spore_object_number(pin, "radius"), 0.2, 1e-12);
  assert_near(spore_object_vector(cord, "point_b"), spore_vec3(0, 0, 0));
  g_assert_cmpfloat(spore_object_number(cord, "rest_length"), ==, 0.1); /* ties what is not scaled */
  const SporeObject *region = spore_object_child(spore_object_child_of(named(scene, "body", "ovary"), "regions"), 0);
  assert_near(spore_object_vector(region, "centre"), spore_vec3(0.025, 0.05, 0.075));
  g_assert_cmpfloat_with_epsilon(spore_object_number(region, "radius"), 0.25, 1e-12);
  assert_near(spore_object_vector(spore_object_child(region, 0), "centre"), spore_vec3(0.05, 0, 0));
  g_assert_cmpfloat_with_epsilon(spore_object_number(spore_object_child(region, 0), "radius"), 0.1, 1e-12);
  g_assert_cmpfloat_with_epsilon(
      spore_object_number(spore_object_child(named(scene, "tetrahedra", "cells"), 0), "size"), 0.0075, 1e-12);
}

/* Each vertex in the scene is the image of the one before; the wall, which shows the same mesh, keeps it. */
static void test_image(void) {
  GPtrArray *bodies;
  FixtureScene scene = scene_with(&bodies, "ovary");
  remember(&scene, "tetrahedra", "cells");
  g_autofree char *start = fixture_format(scene.document);
  g_autoptr(GError) error = NULL;
  SporeVec3 before[8];
  for (gsize i = 0; i < 4; i++) before[i] = vertex(&scene, "ovary", i), before[4 + i] = vertex(&scene, "wall", i);
  double radius = spore_document_spheres(scene.document, named(&scene, "spheres", "balls"), NULL)->spheres[3];
  g_autoptr(SporePlacement) placement = spore_placement_new(scene.document, bodies);
  g_assert_true(spore_edit_scale(scene.document, bodies, 2.5, &error));
  g_assert_no_error(error);
  assert_scaled(&scene, spore_placement_middle(placement), before);
  const SporeSphereSet *balls = spore_document_spheres(scene.document, named(&scene, "spheres", "balls"), NULL);
  g_assert_cmpfloat_with_epsilon(balls->spheres[3], 2.5 * radius, 1e-9);
  g_assert_cmpint(spore_generated_state(scene.document, named(&scene, "tetrahedra", "cells")), ==,
                  SPORE_GENERATED_FRESH);
  g_assert_cmpstr(spore_object_text(named(&scene, "tetrahedra", "cells"), "source"), ==, "skin-2");
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  spore_document_undo(scene.document);
  g_autofree char *end = fixture_format(scene.document);
  g_assert_cmpstr(end, ==, start);
  g_ptr_array_unref(bodies);
  fixture_scene_free(&scene);
}

/* Together with the wall nothing is copied, and the spring between both grows. */
static void test_together(void) {
  GPtrArray *bodies;
  FixtureScene scene = scene_with(&bodies, "ovary");
  g_ptr_array_add(bodies, named(&scene, "body", "wall"));
  g_assert_true(spore_edit_scale(scene.document, bodies, 0.5, NULL));
  g_assert_null(named(&scene, "mesh", "skin-2"));
  g_assert_cmpfloat_with_epsilon(spore_object_number(named(&scene, "spring", "cord"), "rest_length"), 0.05, 1e-12);
  g_ptr_array_unref(bodies);
  fixture_scene_free(&scene);
}

static void refused(const FixtureScene *scene, const GPtrArray *bodies, double factor, const char *says) {
  GError *error = NULL;
  g_autofree char *before = fixture_format(scene->document);
  g_assert_false(spore_edit_scale(scene->document, bodies, factor, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
  g_autofree char *after = fixture_format(scene->document);
  g_assert_cmpstr(after, ==, before);
}

static void test_refused(void) {
  GPtrArray *bodies;
  FixtureScene scene = scene_with(&bodies, "ovary");
  refused(&scene, bodies, 0, "no factor to scale by");
  refused(&scene, bodies, NAN, "no factor to scale by");
  g_assert_true(spore_edit_may_scale(scene.document, bodies, NULL));
  remember(&scene, "spheres", "balls");
  g_assert_true(spore_document_set_text(scene.document, named(&scene, "spheres", "balls"), "frozen", "true", NULL));
  g_assert_false(spore_edit_may_scale(scene.document, bodies, NULL));
  refused(&scene, bodies, 2, "unfreeze it first");
  bodies->pdata[0] = named(&scene, "body", "probe");
  refused(&scene, bodies, 2, "an instrument is not scaled");
  g_ptr_array_unref(bodies);
  fixture_scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/scale/image", test_image);
  g_test_add_func("/scale/together", test_together);
  g_test_add_func("/scale/refused", test_refused);
  return g_test_run();
}
