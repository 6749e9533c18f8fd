/* The library of fluids: each comes to stand where it is asked to, clear of the tissue, and makes a scene that check
 * has nothing against and that runs. */
#include "core/author/fluid_edits.h"
#include "core/author/fluid_place.h"
#include "core/author/instrument_edits.h"
#include "core/author/removal.h"
#include "core/scene/check.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

/* Tissue that can be cut, its top at y = 0.05; a wall that is felt, and a lid far over it. */
static const char organs[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/><tetrahedra name=\"cells\" "
    "file=\"cube.mesh\"/><spheres name=\"ball\" file=\"ball.spheres\"/></assets><bodies>"
    "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>"
    "<visual mesh=\"cube\"/></body>"
    "<body name=\"wall\" role=\"unmovable\" position=\"0.5 0 0\"><collision spheres=\"ball\"/>"
    "<visual mesh=\"cube\"/></body>"
    "<body name=\"lid\" role=\"unmovable\" position=\"0.5 5 0\"><visual mesh=\"cube\"/></body>"
    "</bodies><links><pin name=\"hold\" body=\"organ\" point=\"0 -0.05 0\" radius=\"0.08\"/></links></spore>\n";

static const SporeVec3 on_organ = {0.01, 0.051, 0}, on_wall = {0.51, 0.051, 0};

static SporeObject *add(const FixtureScene *scene, const char *kind, SporeVec3 place) {
  g_autoptr(GError) error = NULL;
  SporeObject *added = spore_edit_add_fluid(scene->document, spore_fluid_find(kind), NULL, NULL, place, &error);
  g_assert_no_error(error);
  return added;
}

/* How many diagnostics name the object, or a part of it. */
static guint said_of(const FixtureScene *scene, const char *name) {
  g_autoptr(GPtrArray) found = spore_document_check(scene->document, NULL);
  guint count = 0;
  for (guint i = 0; i < found->len; i++) {
    const SporeDiagnostic *one = found->pdata[i];
    if (!strstr(one->message, name) && !strstr(one->message, "fluid")) continue;
    g_test_message("%s", one->message);
    count++;
  }
  return count;
}

/* Particles in the world at time 0 and at that time. */
static void run(const FixtureScene *scene, const char *fluid, double time_s, gsize *at_start, gsize *at_end) {
  g_autoptr(GError) error = NULL;
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(scene->document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  SporeObject *body = spore_document_find(scene->document, "body", fluid);
  guint32 index = spore_simulation_body_of(simulation, body);
  *at_start = spore_world_particle_count(simulation->world, index);
  while (spore_world_time_s(simulation->world) < time_s) spore_world_step(simulation->world);
  *at_end = spore_world_particle_count(simulation->world, index);
}

/* What comes out from the start does so out of the surface, of tissue and of what is unmovable; all of it is kept back,
 * and nothing is said of a fluid that is not there yet. */
static void test_flows(void) {
  static const char *const kinds[][2] = {{"bleeding", "blood"}, {"steam", "steam"}};
  const SporeVec3 places[] = {on_organ, on_wall};
  for (gsize i = 0; i < 4; i++) {
    FixtureScene scene = fixture_scene_new(organs);
    g_autofree char *before = fixture_format(scene.document);
    SporeObject *emitter = add(&scene, kinds[i % 2][0], places[i / 2]);
    SporeVec3 point = spore_object_vector(emitter, "point");
    g_assert_cmpstr(spore_object_text(emitter, "source"), ==, i / 2 ? "wall" : "organ");
    g_assert_cmpfloat_with_epsilon(spore_object_vector(emitter, "direction").y, 1, 1e-3);
    g_assert_cmpfloat_with_epsilon(point.x, places[i / 2].x, 1e-3);
    g_assert_cmpfloat(point.y, >, 0.05);
    g_assert_cmpfloat(point.y, <, 0.06);
    g_assert_cmpuint(said_of(&scene, kinds[i % 2][1]), ==, 0);
    gsize at_start, at_end;
    run(&scene, kinds[i % 2][1], 0.3, &at_start, &at_end);
    g_assert_cmpuint(at_start, ==, 0);
    g_assert_cmpuint(at_end, >, 0);
    spore_document_undo(scene.document);
    g_autofree char *after = fixture_format(scene.document);
    g_assert_cmpstr(after, ==, before);
    fixture_scene_free(&scene);
  }
}

/* Two that are kept back are not in each other's way, one that is poured into a wall is; far off there is no organ. */
static void test_two(void) {
  FixtureScene scene = fixture_scene_new(organs);
  GError *error = NULL;
  add(&scene, "bleeding", on_wall);
  add(&scene, "bleeding", on_wall);
  g_assert_cmpuint(said_of(&scene, "overlap"), ==, 0);
  SporeObject *poured = add(&scene, "pool", on_wall);
  g_assert_cmpuint(said_of(&scene, "overlap"), ==, 0);
  g_assert_true(spore_document_set_text(scene.document, poured, "position", "0.5 0.05 0", NULL));
  g_assert_cmpuint(said_of(&scene, "overlap"), >, 0);
  g_assert_null(
      spore_edit_add_fluid(scene.document, spore_fluid_find("pool"), NULL, NULL, (SporeVec3){9, 9, 9}, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "no organ is near");
  fixture_scene_free(&scene);
}

/* A wound is dry until it is cut; what cannot be cut has none. */
static void test_wound(void) {
  FixtureScene scene = fixture_scene_new(organs);
  GError *error = NULL;
  SporeObject *emitter = add(&scene, "wound", on_organ);
  g_assert_cmpstr(spore_object_text(emitter, "source"), ==, "organ");
  g_assert_cmpuint(said_of(&scene, "blood"), ==, 0);
  gsize at_start, at_end;
  run(&scene, "blood", 0.3, &at_start, &at_end);
  g_assert_cmpuint(at_end, ==, 0);
  spore_document_undo(scene.document);
  g_assert_null(spore_edit_add_fluid(scene.document, spore_fluid_find("wound"), NULL, NULL, on_wall, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "make it soft first");
  g_assert_false(spore_document_can_undo(scene.document));
  fixture_scene_free(&scene);
}

/* What is poured lies over the place, clear of the wall's spheres and surface, whole in the world; under a lid there is
 * less of it, and where the lid lies on the organ there is none. */
static void test_pool(void) {
  FixtureScene scene = fixture_scene_new(organs);
  gsize all, less, at_end;
  SporeVec3 middle = spore_object_vector(add(&scene, "pool", on_wall), "position");
  g_assert_cmpfloat_with_epsilon(middle.x, on_wall.x, 1e-3);
  g_assert_cmpfloat(middle.y, >, 0.06);
  g_assert_cmpuint(said_of(&scene, "blood"), ==, 0);
  run(&scene, "blood", 0.001, &all, &at_end);
  g_assert_cmpuint(all, >=, 80);
  g_assert_cmpuint(at_end, ==, all);
  spore_document_undo(scene.document);
  SporeObject *lid = spore_document_find(scene.document, "body", "lid");
  g_assert_true(spore_document_set_text(scene.document, lid, "position", "0.5 0.12 0", NULL));
  add(&scene, "pool", on_wall);
  run(&scene, "blood", 0, &less, &at_end);
  g_test_message("%zu particles in the open, %zu under a lid", all, less);
  g_assert_cmpuint(less, <, all / 2);
  spore_document_undo(scene.document);
  g_assert_true(spore_document_set_text(scene.document, lid, "position", "0.5 0.102 0", NULL));
  GError *error = NULL;
  SporeObject *wall = spore_document_find(scene.document, "body", "wall");
  g_assert_null(spore_edit_add_fluid(scene.document, spore_fluid_find("pool"), NULL, wall, on_wall, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "there is no room over this place");
  fixture_scene_free(&scene);
}

/* Steam of coagulation comes out of the bipolar instrument that is nearest; without one it is refused. */
static void test_coagulation(void) {
  FixtureScene scene = fixture_scene_new(organs);
  GError *error = NULL;
  const SporeFluidKind *kind = spore_fluid_find("coagulation");
  g_assert_null(spore_edit_add_fluid(scene.document, kind, NULL, NULL, on_organ, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "add bipolar forceps first");
  const SporeVec3 entry = {0, 0.3, 0}, other = {0.5, 0.3, 0};
  const SporeInstrumentKind *bipolar = spore_instrument_find("bipolar");
  g_assert_nonnull(
      spore_edit_add_instrument(scene.document, bipolar, "far", (SporeInstrumentPlaces){&other, &on_wall}, NULL));
  g_assert_nonnull(
      spore_edit_add_instrument(scene.document, bipolar, "near", (SporeInstrumentPlaces){&entry, &on_organ}, NULL));
  SporeObject *emitter = add(&scene, "coagulation", on_organ);
  g_assert_cmpstr(spore_object_text(emitter, "source"), ==, "near");
  g_assert_cmpuint(said_of(&scene, "steam"), ==, 0);
  g_assert_null(spore_fluid_find("bleding"));
  fixture_scene_free(&scene);
}

/* Water comes out of the end of a suction tube along the shaft, of the one that is nearest or of an irrigator, and goes
 * with it when it is deleted; without a tube it is refused. */
static void test_irrigation(void) {
  FixtureScene scene = fixture_scene_new(organs);
  GError *error = NULL;
  const SporeFluidKind *kind = spore_fluid_find("irrigation");
  g_assert_null(spore_edit_add_fluid(scene.document, kind, NULL, NULL, on_organ, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "add a suction tube first");
  const SporeVec3 entry = {0.01, 0.3, 0}, other = {0.51, 0.3, 0};
  const SporeInstrumentPlaces far = {&other, &on_wall}, near = {&entry, &on_organ};
  spore_edit_add_instrument(scene.document, spore_instrument_find("suction"), "near", near, NULL);
  spore_edit_add_instrument(scene.document, spore_instrument_find("suction"), "far", far, NULL);
  g_assert_cmpstr(spore_object_text(add(&scene, "irrigation", on_organ), "source"), ==, "near");
  spore_document_undo(scene.document);
  g_autofree char *before = fixture_format(scene.document);
  SporeObject *body = spore_edit_add_instrument(scene.document, spore_instrument_find("irrigator"), "jet", near, NULL);
  SporeObject *emitter = spore_document_find(scene.document, "emitter", "jet_irrigation");
  g_assert_true(spore_object_reference(emitter, "source") == body);
  g_assert_cmpfloat_with_epsilon(spore_object_vector(emitter, "direction").y, -1, 1e-3);
  g_assert_cmpfloat(spore_object_vector(emitter, "point").y, <, spore_object_vector(body, "position").y);
  g_assert_cmpuint(said_of(&scene, "water"), ==, 0);
  gsize at_start, at_end;
  run(&scene, "water", 0.05, &at_start, &at_end); /* no button is down */
  g_assert_cmpuint(at_start + at_end, ==, 0);
  g_assert_true(spore_document_set_text(scene.document, emitter, "trigger", "always", NULL));
  run(&scene, "water", 0.1, &at_start, &at_end);
  double volume = 0.1 * spore_object_number(emitter, "flow"), each = 0.004 * 0.004 * 0.004;
  g_test_message("%zu drops in 0.1 s", at_end);
  g_assert_cmpfloat_with_epsilon((double)at_end * each, volume, 0.1 * volume);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  guint32 id = spore_object_id(body);
  g_array_append_val(ids, id);
  g_assert_true(spore_document_set_text(scene.document, emitter, "trigger", "second_button", NULL));
  g_assert_true(spore_edit_delete(scene.document, ids, FALSE, NULL, NULL));
  g_autofree char *after = fixture_format(scene.document);
  g_assert_null(spore_document_find(scene.document, "body", "water"));
  g_assert_null(strstr(after, "jet"));
  g_assert_nonnull(strstr(before, "near"));
  fixture_scene_free(&scene);
}

/* A shorter step needs fewer substeps, and one that is short enough none of its own. */
static void test_substeps(void) {
  static const char *const steps[] = {"0.004", "0.002", "0.0001"};
  double substeps[3];
  for (gsize i = 0; i < 3; i++) {
    FixtureScene scene = fixture_scene_new(organs);
    g_assert_true(spore_document_set_text(scene.document, spore_document_section(scene.document, "solver"), "time_step",
                                          steps[i], NULL));
    SporeObject *body = add(&scene, "pool", on_wall);
    substeps[i] = spore_object_number(spore_object_child_of(body, "mechanical"), "substeps");
    fixture_scene_free(&scene);
  }
  g_assert_cmpfloat(substeps[1], >, 1);
  g_assert_cmpfloat(substeps[0], >, 1.8 * substeps[1]);
  g_assert_cmpfloat(substeps[2], ==, 0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/fluids/flows", test_flows);
  g_test_add_func("/fluids/two", test_two);
  g_test_add_func("/fluids/wound", test_wound);
  g_test_add_func("/fluids/pool", test_pool);
  g_test_add_func("/fluids/coagulation", test_coagulation);
  g_test_add_func("/fluids/irrigation", test_irrigation);
  g_test_add_func("/fluids/substeps", test_substeps);
  return g_test_run();
}
