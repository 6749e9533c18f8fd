/* What an author does in one gesture is one step that undoes exactly, and unsaved work survives its owner. No display.
 */
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "core/author/generator.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "ui/document/asset-readers.h"
#include "core/scene/generated.h"
#include "ui/document/body-marks.h"
#include "core/author/edits.h"
#include "core/author/instrument_edits.h"
#include "core/author/generated_edits.h"
#include "ui/render/free_place.h"
#include "ui/document/hand-edit.h"
#include "ui/document/hands.h"
#include "ui/document/number-text.h"
#include "ui/jobs/loop-gaps.h"
#include "ui/document/labels.h"
#include "ui/document/mapping-report.h"
#include "core/author/mesh_edits.h"
#include "core/author/brush.h"
#include "core/author/region_edits.h"
#include "core/scene/region.h"
#include "ui/document/recovery.h"
#include "ui/jobs/mesh-works.h"
#include "ui/jobs/spore-job.h"
#include "ui/jobs/works.h"

static const char tetrahedron_off[] =
    "OFF\n4 4 0\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

static const char octahedron_off[] =
    "OFF\n6 8 0\n0.05 0 0\n-0.05 0 0\n0 0.05 0\n0 -0.05 0\n0 0 0.08\n0 0 -0.08\n3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n"
    "3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";

typedef struct {
  SporeSchema *schema;
  SporeEditorDocument *editor;
  SporeDocument *document; /* of the editor */
} Fixture;

static void set_up(Fixture *fixture, gconstpointer data) {
  fixture->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  fixture->document = spore_document_new(fixture->schema);
  spore_document_set_readers(fixture->document, &spore_editor_readers);
  fixture->editor = spore_editor_document_new(fixture->document);
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  g_object_unref(fixture->editor);
  spore_schema_free(fixture->schema);
}

/* Imports a file of that content, which is gone afterwards. */
static SporeObject *add_content(Fixture *fixture, const char *content) {
  GError *error = NULL;
  g_autofree char *folder = g_dir_make_tmp("spore-author-XXXXXX", NULL);
  g_autofree char *file = g_build_filename(folder, "my organ.off", NULL);
  char *files[] = {file, NULL};
  SporeImportOptions options = {.frame = -1};
  g_file_set_contents(file, content, -1, &error);
  SporeImportWork *work = spore_import_work_new(files, &options);
  spore_import_work_run(work, NULL, &error);
  g_assert_no_error(error);
  g_autoptr(GPtrArray) bodies = spore_edit_import(fixture->document, work->import, &error);
  SporeObject *body = bodies ? bodies->pdata[0] : NULL;
  g_assert_no_error(error);
  spore_import_work_free(work);
  g_remove(file);
  g_rmdir(folder);
  return body;
}

static SporeObject *add_organ(Fixture *fixture) { return add_content(fixture, tetrahedron_off); }

static char *text_of(Fixture *fixture) {
  gsize size;
  return spore_scene_format(fixture->document, &size);
}

/* The last edit goes and comes back as one step. */
static void assert_one_step(Fixture *fixture, const char *before) {
  g_autofree char *after = text_of(fixture);
  g_assert_cmpstr(after, !=, before);
  spore_document_undo(fixture->document);
  g_autofree char *undone = text_of(fixture);
  g_assert_cmpstr(undone, ==, before);
  spore_document_redo(fixture->document);
  g_autofree char *redone = text_of(fixture);
  g_assert_cmpstr(redone, ==, after);
}

static void test_add_organ(Fixture *fixture, gconstpointer data) {
  g_autofree char *before = text_of(fixture);
  SporeObject *body = add_organ(fixture);
  g_assert_cmpstr(spore_object_name(body), ==, "my_organ");
  SporeObject *mesh = spore_edit_visual_mesh(fixture->document, body, NULL);
  g_assert_nonnull(mesh);
  g_assert_cmpuint(spore_document_mesh(fixture->document, mesh, NULL)->triangle_count, ==, 4);
  g_assert_cmpint((int)spore_object_number(body, "role"), ==, SPORE_UNMOVABLE);
  assert_one_step(fixture, before);
}

/* Another file of the same name gets a name of its own; the same file is kept once. */
static void test_add_twice(Fixture *fixture, gconstpointer data) {
  SporeObject *first = add_organ(fixture), *second = add_organ(fixture);
  g_assert_cmpstr(spore_object_name(second), !=, spore_object_name(first));
  const char *file = spore_object_text(spore_edit_visual_mesh(fixture->document, first, NULL), "file");
  g_assert_cmpstr(spore_object_text(spore_edit_visual_mesh(fixture->document, second, NULL), "file"), ==, file);
  g_autofree char *other = g_strconcat(tetrahedron_off, "# another\n", NULL);
  SporeObject *third = add_content(fixture, other);
  g_assert_cmpstr(spore_object_text(spore_edit_visual_mesh(fixture->document, third, NULL), "file"), !=, file);
}

/* A changed mesh takes the place of the old one as one step, and a result that is out of date has no place. */
static void test_change_mesh(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *mesh = spore_edit_visual_mesh(fixture->document, add_content(fixture, octahedron_off), NULL);
  g_autofree char *before = text_of(fixture);
  double volume = 4. / 3 * 0.05 * 0.05 * 0.08;
  for (int i = 0; i < 2; i++) {
    SporeMeshWork *work = spore_mesh_work_new(fixture->document, mesh, SPORE_MESH_SMOOTH, 3, &error);
    g_assert_true(spore_mesh_work_run(work, NULL, &error));
    g_assert_cmpfloat_with_epsilon(work->change.after.report.volume, volume, 1e-9 * volume);
    g_assert_cmpfloat(work->change.moved, >, 0);
    g_assert_true(spore_mesh_work_asset(work, fixture->document) == mesh);
    g_assert_true(spore_edit_change_mesh(fixture->document, mesh, "Smooth", work->content, &error));
    g_assert_null(spore_mesh_work_asset(work, fixture->document));
    spore_mesh_work_free(work);
    if (i == 0) assert_one_step(fixture, before);
  }
  g_assert_cmpuint(spore_document_mesh(fixture->document, mesh, NULL)->triangle_count, ==, 8);
}

static const SporeSpheresFields spheres_fields = {.count = 1, .seed = 7};
static const SporeTetrahedraFields tetrahedra_fields = {.cells = 1, .tolerance = 0.01};
static const SporeGeneratedFrom from_organ = {"my_organ", "0123456789abcdef", &spheres_fields},
                                cells_from_organ = {"my_organ", "0", &tetrahedra_fields};

static void use_spheres(Fixture *fixture, SporeObject *body, double radius) {
  GError *error = NULL;
  double numbers[] = {0.02, 0.02, 0.02, radius};
  SporeSphereSet set = {1, numbers};
  spore_edit_use_spheres(fixture->document, body, &from_organ, &set, &error);
  g_assert_no_error(error);
}

static void test_use_spheres(Fixture *fixture, gconstpointer data) {
  SporeObject *body = add_organ(fixture);
  g_autofree char *before = text_of(fixture);
  use_spheres(fixture, body, 0.02);
  assert_one_step(fixture, before);
  /* Generated again: the same asset, other content, and undo brings the first back. */
  body = spore_document_by_path(fixture->document, "bodies/my_organ");
  SporeObject *asset = spore_edit_body_spheres(fixture->document, body);
  g_autofree char *first = text_of(fixture);
  use_spheres(fixture, body, 0.03);
  g_assert_true(spore_edit_body_spheres(fixture->document, body) == asset);
  g_assert_cmpfloat(spore_document_spheres(fixture->document, asset, NULL)->spheres[3], ==, 0.03);
  assert_one_step(fixture, first);
  spore_document_undo(fixture->document);
  g_assert_cmpfloat(spore_document_spheres(fixture->document, asset, NULL)->spheres[3], ==, 0.02);
}

/* Spheres by hand: each commit is one step and remarked; options that change later make the data stale; what is frozen
 * is not generated again, and what is not sound is refused. */
static void test_hand_edit(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeHandEdit edit = {.chosen = G_MAXSIZE};
  SporeObject *body = add_organ(fixture);
  g_assert_false(spore_hand_edit_open(&edit, fixture->document, body));
  use_spheres(fixture, body, 0.02);
  SporeObject *asset = spore_edit_body_spheres(fixture->document, body);
  g_assert_false(spore_generated_is(asset, "edited"));
  g_autofree char *before = text_of(fixture);
  g_assert_true(spore_hand_edit_open(&edit, fixture->document, body));
  g_assert_cmpuint(edit.count, ==, 1);
  g_assert_cmpuint(spore_hand_edit_pick(&edit, spore_vec3(0.02, 0.02, 1), spore_vec3(0, 0, -1)), ==, 0);
  g_assert_cmpuint(spore_hand_edit_pick(&edit, spore_vec3(0.05, 0.02, 1), spore_vec3(0, 0, -1)), ==, G_MAXSIZE);
  g_assert_false(spore_hand_edit_remove(&edit));
  spore_hand_edit_add(&edit, spore_vec3(0.01, 0, 0), 0);
  g_assert_true(spore_hand_edit_commit(&edit, fixture->document, "add", &error));
  g_assert_true(spore_generated_is(asset, "edited"));
  const SporeSphereSet *set = spore_document_spheres(fixture->document, asset, NULL);
  g_assert_cmpuint(set->count, ==, 2);
  g_assert_cmpfloat(set->spheres[7], ==, 0.02);
  assert_one_step(fixture, before);
  g_assert_true(spore_hand_edit_open(&edit, fixture->document, body));
  edit.points[3] = -1;
  g_assert_false(spore_hand_edit_commit(&edit, fixture->document, "resize", &error));
  g_assert_nonnull(error);
  g_clear_error(&error);
  g_assert_cmpfloat(edit.points[3], ==, 0.02);
  spore_hand_edit_close(&edit);

  g_autofree char *hash = spore_document_asset_hash(fixture->document, spore_object_reference(asset, "source"));
  spore_document_set_text(fixture->document, asset, "source_hash", hash, NULL);
  g_assert_cmpint(spore_generated_state(fixture->document, asset), ==, SPORE_GENERATED_FRESH);
  spore_document_set_text(fixture->document, asset, "count", "7", NULL);
  g_assert_cmpint(spore_generated_state(fixture->document, asset), ==, SPORE_GENERATED_OPTIONS_CHANGED);
  spore_document_set_text(fixture->document, asset, "frozen", "true", NULL);
  g_assert_false(spore_edit_use_spheres(fixture->document, body, &from_organ, set, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_clear_error(&error);
}

/* Weights stay with their spheres. */
static void test_hand_edit_weights(Fixture *fixture, gconstpointer data) {
  double numbers[] = {0, 0, 0, 0.02, 0.05, 0, 0, 0.03}, weights[] = {2, 3};
  SporeSphereSet set = {.count = 2, .spheres = numbers, .weights = weights};
  SporeHandEdit edit = {.chosen = G_MAXSIZE};
  SporeObject *body = add_organ(fixture);
  spore_edit_use_spheres(fixture->document, body, &from_organ, &set, NULL);
  g_assert_true(spore_hand_edit_open(&edit, fixture->document, body));
  edit.chosen = 1;
  spore_hand_edit_add(&edit, spore_vec3(0, 0.1, 0), 0);
  edit.chosen = 0;
  g_assert_true(spore_hand_edit_remove(&edit));
  g_assert_true(spore_hand_edit_commit(&edit, fixture->document, "change", NULL));
  const SporeSphereSet *now =
      spore_document_spheres(fixture->document, spore_edit_body_spheres(fixture->document, body), NULL);
  g_assert_cmpuint(now->count, ==, 2);
  g_assert_true(now->weights && now->weights[0] == 3 && now->weights[1] == 3);
  spore_hand_edit_close(&edit);
}

/* Tetrahedra bring their usual model to a body that has none, and leave one that was chosen. */
static void test_usual_model(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  double corners[12] = {0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01};
  uint32_t numbers[4] = {0, 1, 2, 3};
  SporeTetrahedralMesh mesh = {4, 1, corners, numbers};
  SporeObject *body = add_organ(fixture);
  g_assert_true(spore_edit_use_tetrahedra(fixture->document, body, &cells_from_organ, &mesh, &error));
  SporeObject *model = spore_body_model_object(body);
  g_assert_cmpstr(spore_object_type(model)->element, ==, "neo_hookean_tetrahedra");
  g_autofree char *made = text_of(fixture);
  g_assert_true(spore_edit_use_preset(fixture->document, body, "liver", &error));
  g_assert_cmpfloat(spore_object_number(model, "young_modulus"), ==, 5220);
  assert_one_step(fixture, made);
  g_assert_false(spore_edit_use_preset(fixture->document, body, "marble", &error));
  g_assert_nonnull(strstr(error->message, "marble"));
  g_clear_error(&error);
  g_assert_true(spore_edit_set_model(fixture->document, body, "corotational_tetrahedra", &error));
  g_assert_true(spore_edit_use_tetrahedra(fixture->document, body, &cells_from_organ, &mesh, &error));
  g_assert_cmpstr(spore_object_type(spore_body_model_object(body))->element, ==, "corotational_tetrahedra");
}

/* One tetrahedron, and so the body's own. */
static void use_tetrahedron(Fixture *fixture, SporeObject *body) {
  double corners[12] = {0, 0, 0, 0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.04};
  uint32_t numbers[4] = {0, 1, 2, 3};
  SporeTetrahedralMesh mesh = {4, 1, corners, numbers};
  spore_edit_use_tetrahedra(fixture->document, body, &cells_from_organ, &mesh, NULL);
}

/* A dab that adds little is left out, one that covers others takes their place, and the brush takes away what it meets.
 */
static void test_brush(void) {
  g_autoptr(GArray) balls = spore_brush_balls_new(NULL, 0);
  g_assert_true(spore_brush_paint(balls, spore_vec3(0, 0, 0), 0.01));
  g_assert_false(spore_brush_paint(balls, spore_vec3(0.004, 0, 0), 0.01));
  g_assert_true(spore_brush_paint(balls, spore_vec3(0.006, 0, 0), 0.01));
  g_assert_true(spore_brush_paint(balls, spore_vec3(0.1, 0, 0), 0.01));
  g_assert_cmpuint(balls->len, ==, 3);
  g_assert_true(spore_brush_paint(balls, spore_vec3(0.003, 0, 0), 0.02));
  g_assert_cmpuint(balls->len, ==, 2); /* the wide one covers the first two */
  g_assert_false(spore_brush_erase(balls, spore_vec3(0.05, 0, 0), 0.01));
  g_assert_true(spore_brush_erase(balls, spore_vec3(0.095, 0, 0), 0.01));
  g_assert_cmpuint(balls->len, ==, 1);
  g_assert_cmpfloat(g_array_index(balls, double, 3), ==, 0.02);
}

/* What is painted is one step, of a new region and of one that is there; what it holds is counted once. */
static void test_painted_region(Fixture *fixture, gconstpointer data) {
  const double balls[] = {0, 0, 0, 0.02, 0.01, 0.01, 0.01, 0.005, 0.011, 0.01, 0.01, 0.005};
  GError *error = NULL;
  SporeObject *body = add_organ(fixture);
  use_tetrahedron(fixture, body);
  g_autofree char *before = text_of(fixture);
  SporeObject *region =
      spore_edit_add_painted_region(fixture->document, "bodies/my_organ/regions", "scar", balls, 3, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_region_ball_count(region), ==, 3);
  g_autofree char *facts = spore_region_facts(fixture->document, region);
  g_assert_cmpstr(facts, ==, "Painted with 2 dabs. Holds 1 of 1 tetrahedra.");
  gsize count;
  g_autofree double *crosses = spore_region_marks(spore_object_parent(region), &count);
  g_assert_cmpuint(count, ==, 3 * 3);
  g_assert_cmpfloat_with_epsilon(crosses[3] - crosses[0], 2 * 0.3 * 0.02, 1e-12);
  g_autofree char *text = text_of(fixture);
  g_assert_nonnull(strstr(text, "<dab centre=\"0.011 0.01 0.01\" radius=\"0.005\"/>"));
  g_assert_true(spore_edit_paint_region(fixture->document, region, balls, 1, &error));
  g_autofree char *less = spore_region_facts(fixture->document, region);
  g_assert_cmpstr(less, ==, "Holds 1 of 1 tetrahedra.");
  spore_document_undo(fixture->document);
  g_autofree char *again = text_of(fixture);
  g_assert_cmpstr(again, ==, text);
  assert_one_step(fixture, before);
  g_autofree double *many = g_new0(double, 4 * (SPORE_REGION_BALLS + 1));
  for (guint i = 0; i <= SPORE_REGION_BALLS; i++) many[4 * i + 3] = 0.01;
  g_assert_null(spore_edit_add_painted_region(fixture->document, "bodies/my_organ/regions", NULL, many,
                                              SPORE_REGION_BALLS + 1, &error));
  g_assert_nonnull(strstr(error->message, "at most 1000"));
  g_clear_error(&error);
}

/* A region of a body is one step, and its holder comes and goes with it; each has rings of its own. */
static void test_regions(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  gsize count;
  SporeObject *body = add_organ(fixture);
  use_tetrahedron(fixture, body);
  g_autofree char *before = text_of(fixture);
  SporeObject *region = spore_edit_add_region(fixture->document, body, "bodies/my_organ/regions", &error);
  g_assert_no_error(error);
  g_assert_cmpstr(spore_object_name(region), ==, "region");
  g_assert_cmpfloat(spore_object_value(region, 1)->number[0], ==, 0.01); /* middle of the only cell */
  assert_one_step(fixture, before);
  body = spore_document_by_path(fixture->document, "bodies/my_organ");
  g_assert_nonnull(spore_edit_add_region(fixture->document, body, "bodies/my_organ/regions", &error));
  g_autofree double *rings = spore_region_marks(spore_object_child_of(body, "regions"), &count);
  g_assert_cmpuint(count, ==, 2 * 3 * 48);
  double radius =
      spore_object_number(spore_document_by_path(fixture->document, "bodies/my_organ/regions/region"), "radius");
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_vec3_load(rings + 6 * 100), spore_vec3(0.01, 0.01, 0.01)),
                                 radius, 1e-12);
  g_assert_false(spore_edit_remove_region(fixture->document, "bodies/my_organ", &error));
  g_assert_nonnull(strstr(error->message, "no such region"));
  g_clear_error(&error);
  g_assert_true(spore_edit_remove_region(fixture->document, "bodies/my_organ/regions/region", &error));
  g_assert_true(spore_edit_remove_region(fixture->document, "bodies/my_organ/regions/region-2", &error));
  g_assert_null(spore_object_child_of(body, "regions"));
  g_assert_null(spore_edit_add_region(fixture->document, body, "bodies/my_organ/visual", &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_clear_error(&error);
}

/* A region is an option of what is generated: data made without it are stale. */
static void test_regions_of_generated(Fixture *fixture, gconstpointer data) {
  SporeObject *body = add_organ(fixture);
  use_spheres(fixture, body, 0.02);
  SporeObject *asset = spore_edit_body_spheres(fixture->document, body);
  g_autofree char *hash = spore_document_asset_hash(fixture->document, spore_object_reference(asset, "source"));
  spore_document_set_text(fixture->document, asset, "source_hash", hash, NULL);
  g_autofree char *path = spore_object_path(asset);
  SporeObject *region = spore_edit_add_region(fixture->document, body, path, NULL);
  g_assert_cmpstr(spore_object_type(region)->element, ==, "sphere_region");
  g_assert_cmpint(spore_generated_state(fixture->document, asset), ==, SPORE_GENERATED_OPTIONS_CHANGED);
  g_autofree char *one = spore_generated_options_hash(asset);
  spore_document_set_text(fixture->document, region, "density", "2", NULL);
  g_autofree char *other = spore_generated_options_hash(asset);
  g_assert_cmpstr(one, !=, other);
  spore_document_rename(fixture->document, region, "neck", NULL);
  g_autofree char *renamed = spore_generated_options_hash(asset);
  g_assert_cmpstr(other, ==, renamed);
  use_tetrahedron(fixture, body);
  SporeObject *finer = spore_edit_add_region(fixture->document, body, "assets/my_organ_tetrahedra", NULL);
  g_assert_cmpstr(spore_object_type(finer)->element, ==, "cell_region");
  g_assert_cmpfloat_with_epsilon(spore_object_number(finer, "size"), 0.5 * cbrt(sqrt(2) * 0.04 * 0.04 * 0.04), 1e-5);
  g_assert_true(spore_edit_remove_region(fixture->document, "assets/my_organ_spheres/neck", NULL));
  g_assert_cmpint(spore_generated_state(fixture->document, asset), ==, SPORE_GENERATED_FRESH);
}

/* A gesture on a region changes the scene as it goes, and is one step; aborted, it leaves nothing. */
static void test_hand_edit_region(Fixture *fixture, gconstpointer data) {
  SporeHandEdit edit = {0};
  SporeObject *body = add_organ(fixture);
  use_tetrahedron(fixture, body);
  GError *error = NULL;
  SporeObject *one = spore_edit_add_region(fixture->document, body, "bodies/my_organ/regions", &error);
  SporeObject *two = spore_edit_add_region(fixture->document, body, "bodies/my_organ/regions", &error);
  g_assert_no_error(error);
  g_autofree char *before = text_of(fixture);
  g_assert_true(spore_hand_edit_open_regions(&edit, fixture->document, spore_object_parent(one)));
  g_assert_cmpint(edit.kind, ==, SPORE_HAND_REGIONS);
  g_assert_cmpuint(edit.count, ==, 2);
  g_assert_cmpuint(edit.body, ==, spore_object_id(body));
  edit.chosen = 1;
  for (int way = 0; way < 2; way++) {
    spore_document_begin(fixture->document, "drag");
    for (int i = 1; i < 4; i++) {
      edit.points[4] = 0.01 * i;
      edit.points[7] = 0.02 * i;
      g_assert_true(spore_hand_edit_write_region(&edit, fixture->document, &error));
      double ball[4];
      spore_region_read_ball(two, ball);
      g_assert_cmpfloat_with_epsilon(ball[0], 0.01 * i, 1e-12);
      g_assert_cmpfloat_with_epsilon(ball[3], 0.02 * i, 1e-12);
    }
    if (way == 0) spore_document_abort(fixture->document);
    else spore_document_end(fixture->document);
    if (way == 0) {
      g_autofree char *after = text_of(fixture);
      g_assert_cmpstr(before, ==, after);
    }
  }
  assert_one_step(fixture, before);
  edit.points[7] = -1; /* no radius */
  g_assert_false(spore_hand_edit_write_region(&edit, fixture->document, &error));
  g_assert_nonnull(error);
  g_clear_error(&error);
  g_assert_cmpfloat(edit.points[7], >, 0);
  spore_document_remove(fixture->document, spore_object_parent(one), NULL);
  g_assert_false(spore_hand_edit_write_region(&edit, fixture->document, &error));
  spore_hand_edit_close(&edit);
}

/* As the editor does it: on a copy of the scene. */
static void measure_mapping(Fixture *fixture, SporeObject *body, SporeMappingReport *report) {
  GError *error = NULL;
  SporeMappingWork *work = spore_mapping_work_new(fixture->document, body);
  g_assert_true(spore_mapping_work_run(work, NULL, &error));
  spore_mapping_report_clear(report);
  *report = work->report;
  work->report = (SporeMappingReport){0};
  spore_mapping_work_free(work);
}

static bool refuse(void *data, double fraction, const char *stage) { return false; }

static void test_mapping_is_cancelled(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *body = add_organ(fixture);
  use_tetrahedron(fixture, body);
  SporeMappingWork *work = spore_mapping_work_new(fixture->document, body);
  g_assert_false(spore_mapping_work_run(work, &(SporeProgress){.report = refuse}, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_clear_error(&error);
  spore_mapping_work_free(work);
}

/* The mesh around a tetrahedron is extrapolated where it lies outside; the report is of the document as it was. */
static void test_mapping_report(Fixture *fixture, gconstpointer data) {
  SporeMappingReport report = {0};
  SporeVec3 place;
  double size;
  SporeObject *body = add_organ(fixture);
  use_tetrahedron(fixture, body);
  g_assert_false(spore_mapping_report_holds(&report, fixture->document, body));
  measure_mapping(fixture, body, &report);
  g_assert_true(spore_mapping_report_holds(&report, fixture->document, body));
  g_autofree char *text = spore_mapping_report_text(&report);
  g_assert_cmpstr(report.trouble, ==, NULL);
  g_assert_true(report.known[SPORE_MAPPED_VISUAL] && !report.known[SPORE_MAPPED_COLLISION]);
  g_assert_true(spore_mapping_report_worst(&report, &place, &size));
  const SporeMappingQuality *quality = &report.quality[SPORE_MAPPED_VISUAL];
  g_assert_nonnull(strstr(text, "extrapolated"));
  g_assert_cmpuint(quality->off, >, 0);
  g_assert_cmpfloat(spore_vec3_distance(place, quality->place), ==, 0);
  gsize count;
  spore_edit_add_region(fixture->document, body, "bodies/my_organ/regions", NULL);
  g_autofree double *rings = spore_body_marks(fixture->document, body, &report, &count);
  g_assert_cmpuint(count, ==, 3 * 48); /* the report is of before the region */
  measure_mapping(fixture, body, &report);
  g_autofree double *marks = spore_body_marks(fixture->document, body, &report, &count);
  g_assert_cmpuint(count, ==, 3 * 48 + 3);
  spore_document_set_text(fixture->document, body, "position", "0 1 0", NULL);
  g_assert_false(spore_mapping_report_holds(&report, fixture->document, body));
  spore_edit_set_model(fixture->document, body, "", NULL);
  spore_document_set_text(fixture->document, body, "role", "passive", NULL);
  measure_mapping(fixture, body, &report);
  g_autofree char *trouble = spore_mapping_report_text(&report);
  g_assert_nonnull(strstr(trouble, "no mechanical model"));
  g_assert_false(spore_mapping_report_worst(&report, &place, &size));
  spore_mapping_report_clear(&report);
}

static void test_set_model(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *body = add_organ(fixture);
  g_autofree char *before = text_of(fixture);
  g_assert_true(spore_edit_set_model(fixture->document, body, "mass_spring_net", &error));
  g_assert_cmpstr(spore_object_type(spore_body_model_object(body))->element, ==, "mass_spring_net");
  g_assert_cmpstr(spore_object_text(spore_object_child_of(body, "mechanical"), "geometry"), ==, "my_organ");
  g_assert_cmpint((int)spore_object_number(body, "role"), ==, SPORE_PASSIVE);
  assert_one_step(fixture, before);
  g_autofree char *net = text_of(fixture);
  g_assert_false(spore_edit_set_model(fixture->document, body, "no_such_model", &error));
  g_assert_nonnull(error);
  g_clear_error(&error);
  g_autofree char *kept = text_of(fixture);
  g_assert_cmpstr(kept, ==, net);
  g_assert_true(spore_edit_set_model(fixture->document, body, "", &error));
  g_assert_null(spore_body_model_object(body));
  g_assert_cmpint((int)spore_object_number(body, "role"), ==, SPORE_UNMOVABLE);
}

static void test_probe_and_pin(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *body = add_organ(fixture);
  g_assert_null(spore_edit_add_pin(fixture->document, body, &error)); /* it does not move */
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_clear_error(&error);
  g_assert_true(spore_edit_set_model(fixture->document, body, "rigid_body", &error));
  g_autofree char *before = text_of(fixture);
  SporeObject *pin = spore_edit_add_pin(fixture->document, body, &error);
  g_assert_no_error(error);
  g_assert_cmpstr(spore_object_text(pin, "body"), ==, "my_organ");
  assert_one_step(fixture, before);
  g_autofree char *pinned = text_of(fixture);
  SporeObject *probe = spore_edit_add_instrument(fixture->document, spore_instrument_find("probe"), NULL,
                                                 (SporeInstrumentPlaces){0}, &error);
  g_assert_no_error(error);
  g_assert_cmpint((int)spore_object_number(probe, "role"), ==, SPORE_ACTIVE);
  int position = spore_parameter_find(spore_object_type(probe)->table, "position");
  g_assert_cmpfloat(spore_object_value(probe, (guint)position)->number[1], >, 0.1); /* above the highest point */
  assert_one_step(fixture, pinned);
  /* A second probe shares the mouse. */
  spore_edit_add_instrument(fixture->document, spore_instrument_find("probe"), NULL, (SporeInstrumentPlaces){0},
                            &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(fixture->document, "devices")), ==, 1);
}

/* Jaws go with their shaft, an organ with nobody; a tool is led by its body, what looks along by the one it looks from.
 */
static void test_hands(Fixture *fixture, gconstpointer data) {
  SporeObject *organ = add_organ(fixture), *tools = spore_document_section(fixture->document, "tools");
  const char *const kinds[] = {"probe", "clamp", "endoscope"};
  SporeObject *added[G_N_ELEMENTS(kinds)];
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++)
    added[i] = spore_edit_add_instrument(fixture->document, spore_instrument_find(kinds[i]), NULL,
                                         (SporeInstrumentPlaces){0}, NULL);
  g_autoptr(GPtrArray) hands = spore_hands(fixture->document);
  g_assert_cmpuint(hands->len, ==, G_N_ELEMENTS(kinds));
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++) {
    g_assert_true(hands->pdata[i] == added[i]);
    g_assert_true(spore_hand_of(fixture->document, spore_object_child_of(added[i], "visual")) == added[i]);
    g_assert_true(spore_hand_latches(fixture->document, added[i]) == g_str_equal(kinds[i], "clamp"));
    SporeObject *jaws[2];
    g_assert_true(spore_hand_jaws(fixture->document, added[i], jaws) == g_str_equal(kinds[i], "clamp"));
  }
  SporeObject *jaw = spore_document_find(fixture->document, "body", "clamp_1_jaw_b");
  SporeObject *clamp = spore_object_child_of(tools, "clamp"), *camera = spore_object_child_of(tools, "camera");
  g_assert_nonnull(jaw);
  g_assert_true(spore_hand_of(fixture->document, jaw) == added[1]);
  g_assert_true(spore_hand_of(fixture->document, clamp) == added[1]);
  g_assert_nonnull(camera);
  g_assert_true(spore_hand_of(fixture->document, camera) == added[2]);
  g_assert_null(spore_hand_of(fixture->document, organ));
  g_assert_null(spore_hand_of(fixture->document, tools));
  g_assert_null(spore_hand_of(fixture->document, NULL));
}

static void test_set_property(Fixture *fixture, gconstpointer data) {
  static const char *const refused[][3] = {
      {"bodies/none", "role", "active"},
      {"bodies/my_organ", "rolle", "active"},
      {"bodies/my_organ", "role", "lazy"},
      {"bodies/my_organ/collision", "stiffness", "-1"},
      {"bodies/my_organ/nothing", "stiffness", "1"},
  };
  GError *error = NULL;
  add_organ(fixture);
  g_autofree char *before = text_of(fixture);
  for (gsize i = 0; i < G_N_ELEMENTS(refused); i++) {
    g_assert_false(spore_edit_set_property(fixture->document, refused[i][0], refused[i][1], refused[i][2], &error));
    g_assert_nonnull(error);
    g_clear_error(&error);
    g_autofree char *after = text_of(fixture);
    g_assert_cmpstr(after, ==, before);
  }
  /* The unit is made by the first change. */
  g_assert_true(spore_edit_set_property(fixture->document, "bodies/my_organ/collision", "stiffness", "123", &error));
  assert_one_step(fixture, before);
  g_assert_true(spore_edit_set_property(fixture->document, "bodies/my_organ/collision", "stiffness", NULL, &error));
  g_assert_true(spore_edit_set_property(fixture->document, "bodies/my_organ", "name", "spleen", &error));
  g_assert_nonnull(spore_document_by_path(fixture->document, "bodies/spleen"));
}

static void test_selection(Fixture *fixture, gconstpointer data) {
  SporeObject *body = add_organ(fixture);
  SporeObject *visual = spore_object_child_of(body, "visual");
  spore_editor_document_select(fixture->editor, spore_object_id(visual));
  g_assert_true(spore_editor_document_selected_body(fixture->editor) == body);
  g_assert_true(spore_document_remove(fixture->document, body, NULL));
  g_assert_cmpuint(spore_editor_document_get_selection(fixture->editor), ==, 0);
}

/* Several objects are selected in the order of their choice; bodies count once; what goes is selected no more, and what
 * comes back is not. */
static void test_several_selected(Fixture *fixture, gconstpointer data) {
  SporeObject *first = add_organ(fixture), *second = add_organ(fixture);
  const guint32 one = spore_object_id(first), visual = spore_object_id(spore_object_child_of(first, "visual")),
                other = spore_object_id(second);
  const guint32 all[] = {one, visual};
  spore_editor_document_select_several(fixture->editor, all, 2);
  spore_editor_document_toggle(fixture->editor, other);
  g_assert_true(spore_editor_document_is_selected(fixture->editor, other));
  g_assert_cmpuint(spore_editor_document_get_selection(fixture->editor), ==, one);
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(fixture->editor);
  g_assert_cmpuint(bodies->len, ==, 2);
  g_assert_true(bodies->pdata[0] == first && bodies->pdata[1] == second);
  g_assert_true(spore_document_remove(fixture->document, first, NULL));
  gsize count;
  const guint32 *left = spore_editor_document_get_selected(fixture->editor, &count);
  g_assert_cmpuint(count, ==, 1);
  g_assert_cmpuint(left[0], ==, other);
  spore_document_undo(fixture->document);
  g_assert_false(spore_editor_document_is_selected(fixture->editor, one));
  spore_editor_document_toggle(fixture->editor, other);
  g_assert_null(spore_editor_document_selected(fixture->editor));
}

/* A property is set for all of several objects as one step, or for none of them. */
static void test_set_for_all(Fixture *fixture, gconstpointer data) {
  SporeObject *first = add_organ(fixture), *second = add_organ(fixture);
  g_autofree char *a = spore_object_path(first), *b = spore_object_path(second);
  g_autofree char *of_first = g_strconcat(a, "/visual", NULL), *of_second = g_strconcat(b, "/visual", NULL);
  char *const paths[] = {of_first, of_second, NULL}, *const wrong[] = {of_first, "bodies/nobody/visual", NULL};
  g_autoptr(GError) error = NULL;
  g_autofree char *before = text_of(fixture);
  g_assert_false(spore_edit_set_property_of_all(fixture->document, wrong, "wetness", "0.25", &error));
  g_assert_nonnull(error);
  g_clear_error(&error);
  g_autofree char *after = text_of(fixture);
  g_assert_cmpstr(after, ==, before);
  g_assert_true(spore_edit_set_property_of_all(fixture->document, paths, "wetness", "0.25", &error));
  g_assert_cmpfloat(spore_object_number(spore_object_child_of(first, "visual"), "wetness"), ==, 0.25);
  g_assert_cmpfloat(spore_object_number(spore_object_child_of(second, "visual"), "wetness"), ==, 0.25);
  assert_one_step(fixture, before);
}

/* Jobs. */

static gboolean work_until_cancelled(gpointer data, const SporeProgress *progress, GError **error) {
  for (int i = 0; i < 10000; i++) {
    if (!spore_progress(progress, i / 1e4, "waiting"))
      return spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "cancelled");
    g_usleep(1000);
  }
  return TRUE;
}

static gboolean work_at_once(gpointer data, const SporeProgress *progress, GError **error) {
  *(int *)data = 42;
  spore_progress(progress, 1, NULL);
  return TRUE;
}

static int deaf_released, deaf_ended;

/* Does not ask whether it was cancelled. */
static gboolean work_deaf(gpointer data, const SporeProgress *progress, GError **error) {
  for (int i = 0; i < 5000 && !g_atomic_int_get(&deaf_released); i++) g_usleep(1000);
  g_atomic_int_set(&deaf_ended, TRUE);
  return TRUE;
}

typedef struct {
  GMainLoop *loop;
  int code, value;
} Outcome;

static void work_done(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  Outcome *outcome = g_object_get_data(owner, "outcome");
  outcome->code = error ? error->code : 0;
  outcome->value = data ? *(int *)data : 0;
  g_main_loop_quit(outcome->loop);
}

static Outcome run_job(SporeJobWork work, gboolean cancel) {
  g_autoptr(GObject) owner = g_object_new(G_TYPE_OBJECT, NULL);
  Outcome outcome = {.loop = g_main_loop_new(NULL, FALSE)};
  g_object_set_data(owner, "outcome", &outcome);
  g_autoptr(SporeJob) job = spore_job_start("Work", work, g_new0(int, 1), g_free, work_done, owner);
  if (cancel) spore_job_cancel(job);
  g_main_loop_run(outcome.loop);
  g_assert_false(spore_job_is_running(job));
  g_main_loop_unref(outcome.loop);
  return outcome;
}

static void test_jobs(Fixture *fixture, gconstpointer data) {
  Outcome done = run_job(work_at_once, FALSE);
  g_assert_cmpint(done.code, ==, 0);
  g_assert_cmpint(done.value, ==, 42);
  g_assert_cmpint(run_job(work_until_cancelled, TRUE).code, ==, SPORE_ERROR_CANCELLED);
  /* Also where the work is through, or does not listen: nobody waits for it. */
  g_assert_cmpint(run_job(work_at_once, TRUE).code, ==, SPORE_ERROR_CANCELLED);
  g_assert_cmpint(run_job(work_deaf, TRUE).code, ==, SPORE_ERROR_CANCELLED);
  g_assert_false(g_atomic_int_get(&deaf_ended));
  g_atomic_int_set(&deaf_released, TRUE);
}

static void test_result_of_another_scene(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *body = add_organ(fixture);
  SporeGenerateOptions options = spore_generate_options_of(fixture->document, body, SPORE_GENERATE_SPHERES);
  SporeGenerateWork *work = spore_generate_work_new(fixture->document, body, &options, &error);
  g_assert_no_error(error);
  g_assert_true(spore_generate_work_body(work, fixture->document) == body);
  SporeObject *mesh = spore_edit_visual_mesh(fixture->document, body, NULL);
  g_assert_true(spore_document_set_text(fixture->document, mesh, "unit", "mm", NULL));
  g_assert_null(spore_generate_work_body(work, fixture->document));
  spore_document_undo(fixture->document);
  g_assert_true(spore_generate_work_body(work, fixture->document) == body);
  spore_document_undo(fixture->document);
  g_assert_null(spore_generate_work_body(work, fixture->document));
  spore_generate_work_unref(work);
}

static void test_import_refuses(Fixture *fixture, gconstpointer data) {
  g_autofree char *folder = g_dir_make_tmp("spore-import-XXXXXX", NULL);
  g_autofree char *empty = g_build_filename(folder, "empty.off", NULL);
  g_autofree char *missing = g_build_filename(folder, "missing.off", NULL);
  g_assert_true(g_file_set_contents(empty, "", 0, NULL));
  char *files[] = {folder, empty, missing};
  for (gsize i = 0; i < G_N_ELEMENTS(files); i++) {
    g_autoptr(GError) error = NULL;
    char *const one[] = {files[i], NULL};
    SporeImportWork *work = spore_import_work_new(one, &(SporeImportOptions){.frame = -1});
    g_assert_false(spore_import_work_run(work, NULL, &error));
    g_assert_true(g_str_has_prefix(error->message, files[i]));
    spore_import_work_free(work);
  }
  g_unlink(empty);
  g_rmdir(folder);
}

static void make_soft(Fixture *fixture) {
  SporeObject *body = add_organ(fixture);
  use_spheres(fixture, body, 0.02);
  g_assert_true(spore_edit_set_model(fixture->document, body, "mass_spring_net", NULL));
}

/* Recovery. The lock is held by this process, so that only what was given up is found. */

static void test_recovery(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeRecovery *recovery = spore_recovery_new();
  g_autoptr(GPtrArray) none = g_ptr_array_new(), that = g_ptr_array_new();
  g_assert_true(spore_recovery_keep(recovery, fixture->editor, &error)); /* nothing unsaved: nothing kept */
  g_assert_null(spore_leftover_find(none));
  make_soft(fixture);
  g_autofree char *text = text_of(fixture);
  g_assert_true(spore_recovery_keep(recovery, fixture->editor, &error));
  g_assert_no_error(error);
  g_assert_null(spore_leftover_find(none)); /* its owner lives */
  if (g_test_subprocess()) _exit(0);        /* and now it is dead */
  spore_recovery_free(recovery);
  g_assert_null(spore_leftover_find(none));

  g_test_trap_subprocess(NULL, 0, G_TEST_SUBPROCESS_DEFAULT);
  g_test_trap_assert_passed();
  SporeLeftover *leftover = spore_leftover_find(none);
  g_assert_nonnull(leftover);
  g_assert_null(leftover->original);
  g_ptr_array_add(that, leftover->folder);
  g_assert_null(spore_leftover_find(that));
  SporeDocument *recovered = spore_scene_load(fixture->schema, leftover->scene, &error);
  g_assert_no_error(error);
  gsize size;
  g_autofree char *again = spore_scene_format(recovered, &size);
  g_assert_cmpstr(again, ==, text);
  SporeObject *mesh = spore_document_find(recovered, "mesh", "my_organ");
  g_assert_nonnull(spore_document_mesh(recovered, mesh, &error));
  g_assert_no_error(error);
  spore_document_free(recovered);
  spore_leftover_remove(leftover);
  spore_leftover_free(leftover);
  g_assert_null(spore_leftover_find(none));
}

/* Translators find the names of the tables in po/labels.c. */

static void look_for_label(const char *labels, const char *name, GString *missing) {
  g_autofree char *label = spore_label_of_name(name);
  g_autofree char *marked = g_strdup_printf("N_(\"%s\")\n", label);
  if (!strstr(labels, marked) && !strstr(missing->str, marked)) g_string_append(missing, marked);
}

static void look_for_labels(const char *labels, const SporeObjectType *type, GString *missing) {
  for (gsize i = 0; i < type->table->count; i++) {
    const SporeParameter *parameter = &type->table->parameters[i];
    look_for_label(labels, parameter->name, missing);
    for (int k = 0; parameter->type == SPORE_CHOICE && parameter->choices[k]; k++)
      if (spore_name_is_word(parameter->choices[k])) look_for_label(labels, parameter->choices[k], missing);
  }
  for (guint i = 0; i < type->children->len; i++)
    look_for_labels(labels, g_ptr_array_index(type->children, i), missing);
}

static void test_labels(Fixture *fixture, gconstpointer data) {
  g_autofree char *labels = NULL;
  g_assert_true(g_file_get_contents(SPORE_LABELS, &labels, NULL, NULL));
  g_autoptr(GString) missing = g_string_new(NULL);
  look_for_labels(labels, spore_schema_root(fixture->schema), missing);
  if (missing->len) g_error("po/labels.c lacks these; add them:\n%s", missing->str);
}

/* Numbers as they are typed, with the decimal mark of the language, and shown with it. */
static void test_number_text(void) {
  static const struct {
    const char *typed, *mark, *read;
  } cases[] = {{"0,003", ",", "0.003"},         {" 0.003 ", ",", "0.003"}, {"1,5 0 2", ",", "1.5 0 2"},
               {"1, 2, 3", ",", "1  2  3"},     {"1,2,3", ",", "1 2 3"},   {"1.5,2,3", ",", "1.5 2 3"},
               {"1,5, 2, 3", ",", "1.5  2  3"}, {"1,000", ".", "1,000"},   {"1.5, 2, 3", ".", "1.5  2  3"},
               {"1,2,3", ".", "1 2 3"},         {"3,", ",", "3,"},         {"-1,5e-3", ",", "-1.5e-3"}};
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *read = spore_number_text_read(cases[i].typed, cases[i].mark);
    g_assert_cmpstr(read, ==, cases[i].read);
  }
  g_autofree char *shown = spore_number_text_show("0.003 1 2.5", ",");
  g_assert_cmpstr(shown, ==, "0,003 1 2,5");
}

/* Metres of the file and mm of the window: the point moves, so that no digit is lost or made up. */
static void test_length_text(void) {
  static const struct {
    const char *text;
    int digits;
    const char *shifted;
  } cases[] = {{"0.003", 3, "3"},         {"0.1234567890123456", 3, "123.4567890123456"},
               {"-1.5e-05", 3, "-0.015"}, {"0.06 0 -0.01", 3, "60 0 -10"},
               {"3", -3, "0.003"},        {"120", -3, "0.12"},
               {"2e-13", 3, "2e-10"},     {"1e300", 3, "1e303"},
               {"inf -", 3, "inf -"},     {"1.2.3", 3, "1.2.3"},
               {"0.0", -3, "0"},          {"", 3, ""}};
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *shifted = spore_number_text_shift(cases[i].text, cases[i].digits);
    g_assert_cmpstr(shifted, ==, cases[i].shifted);
  }
  static const struct {
    const char *typed, *left;
    int digits;
  } units[] = {
      {"3", "3", -3}, {"3 cm ", "3", -2}, {"0.003m", "0.003", 0}, {"1 2 3 µm", "1 2 3", -6}, {"5 in", "5 in", -3}};
  for (guint i = 0; i < G_N_ELEMENTS(units); i++) {
    g_autofree char *typed = g_strdup(units[i].typed);
    g_assert_cmpint(spore_number_text_cut_length(typed), ==, units[i].digits);
    g_assert_cmpstr(typed, ==, units[i].left);
  }
}

/* Radians of the file and degrees of the window: the degrees that people meant, and the same ones again. */
static void test_angle_text(void) {
  static const struct {
    const char *radians, *degrees;
  } shown[] = {{"0.5236", "30"},    {"0.523598775598298", "30"},
               {"0.7", "40.1"},     {"1.571 0 -1.571", "90 0 -90"},
               {"-3.1416", "-180"}, {"0.53", "30.37"},
               {"1e-3", "0.0573"},  {"100", "5729.58"},
               {"inf x", "inf x"},  {"", ""}};
  for (guint i = 0; i < G_N_ELEMENTS(shown); i++) {
    g_autofree char *degrees = spore_number_text_degrees(shown[i].radians);
    g_assert_cmpstr(degrees, ==, shown[i].degrees);
  }
  static const char *const typed[] = {"30", "-12.5", "0.1", "179.99", "0.0000001", "33.333333", "0 90 -45"};
  for (guint i = 0; i < G_N_ELEMENTS(typed); i++) {
    g_autofree char *radians = spore_number_text_radians(typed[i]);
    g_autofree char *degrees = spore_number_text_degrees(radians);
    g_assert_cmpstr(degrees, ==, typed[i]);
  }
  static const struct {
    const char *typed, *left;
    gboolean degrees;
  } units[] = {{"30", "30", TRUE}, {"30 ° ", "30", TRUE}, {"30deg", "30", TRUE}, {"0.5 rad", "0.5", FALSE}};
  for (guint i = 0; i < G_N_ELEMENTS(units); i++) {
    g_autofree char *text = g_strdup(units[i].typed);
    g_assert_cmpint(spore_number_text_cut_angle(text), ==, units[i].degrees);
    g_assert_cmpstr(text, ==, units[i].left);
  }
}

/* Flows of the file, m^3/s, and of the window, ml/min; l/min may be typed. */
static void test_flow_text(void) {
  static const struct {
    const char *file, *shown;
  } flows[] = {
      {"1.667e-5", "1000"}, {"0.000025", "1500"}, {"2e-6", "120"}, {"0", "0"}, {"1.6666666666666667e-05", "1000"}};
  for (guint i = 0; i < G_N_ELEMENTS(flows); i++) {
    g_autofree char *shown = spore_number_text_flow(flows[i].file);
    g_assert_cmpstr(shown, ==, flows[i].shown);
  }
  static const struct {
    const char *typed, *left;
    int digits;
  } typed[] = {{"800", "800", 0}, {"800 ml/min", "800", 0}, {"1.5 l/min ", "1.5", 3}};
  for (guint i = 0; i < G_N_ELEMENTS(typed); i++) {
    g_autofree char *text = g_strdup(typed[i].typed);
    g_assert_cmpint(spore_number_text_cut_flow(text), ==, typed[i].digits);
    g_assert_cmpstr(text, ==, typed[i].left);
    g_autofree char *millilitres = spore_number_text_shift(text, typed[i].digits);
    g_autofree char *file = spore_number_text_from_flow(millilitres), *shown = spore_number_text_flow(file);
    g_assert_cmpstr(shown, ==, millilitres);
    g_assert_cmpfloat_with_epsilon(g_ascii_strtod(file, NULL) * 60e6, g_ascii_strtod(millilitres, NULL), 1e-6);
  }
}

/* What was going on while the main loop did not come round is told: the work whose result was taken in, and by the
 * longest. */
static gboolean hold_loop(gpointer title) {
  gint64 start = g_get_monotonic_time();
  spore_gaps_enter(title);
  while (g_get_monotonic_time() - start <= 1000 * SPORE_GAP_TOLD_MS) continue;
  spore_gaps_leave(title);
  return G_SOURCE_REMOVE;
}

static const SporeGap *gap_of(const char *what) {
  guint count;
  const SporeGap *gaps = spore_gaps_told(&count);
  for (guint i = 0; i < count; i++)
    if (g_str_equal(gaps[i].what, what)) return &gaps[i];
  return NULL;
}

static void test_loop_gaps(void) {
  spore_gaps_enter("before it is watched");
  while (g_main_context_iteration(NULL, FALSE)) continue; /* what tests before left */
  spore_gaps_watch(FALSE);
  g_idle_add(hold_loop, (gpointer) "held");
  g_main_context_iteration(NULL, TRUE);
  g_assert_null(gap_of("held")); /* the turn ends with the next poll */
  g_main_context_iteration(NULL, FALSE);
  g_assert_nonnull(gap_of("held"));
  g_assert_cmpfloat(gap_of("held")->longest_ms, >, SPORE_GAP_TOLD_MS);
  g_assert_cmpuint(gap_of("held")->count, ==, 1);
}

/* Boxes are laid in a small view with tools above, figures below and a cube: each apart from all that lies there and
 * within the margin, from the lower right on; what has no room is refused. */
static void test_free_place(void) {
  SporePlace at[8] = {{12, 12, 332, 90}, {284, 12, 60, 60}, {12, 240, 150, 48}};
  SporeAround view = {.width = 356, .height = 300, .gap = 8, .margin = 12, .count = 3, .at = at};
  SporePlace box = {.width = 150, .height = 40};
  for (guint laid = 0; laid < 5; laid++) {
    g_assert_true(spore_free_place_find(&view, &box));
    g_assert_cmpint(box.x, >=, 12);
    g_assert_cmpint(box.x + box.width, <=, 344);
    g_assert_cmpint(box.y + box.height, <=, 288);
    for (guint i = 0; i < view.count; i++)
      g_assert_true(box.x + box.width + 8 <= at[i].x || at[i].x + at[i].width + 8 <= box.x ||
                    box.y + box.height + 8 <= at[i].y || at[i].y + at[i].height + 8 <= box.y);
    if (laid == 0) g_assert_cmpint(box.x + box.width + 1000 * (box.y + box.height), ==, 344 + 1000 * 288);
    at[view.count++] = box;
  }
  box = (SporePlace){.width = 150, .height = 80};
  g_assert_false(spore_free_place_find(&view, &box));
  view.count = 0;
  g_assert_true(spore_free_place_find(&view, &box));
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    void (*run)(Fixture *fixture, gconstpointer data);
  } tests[] = {
      {"add-organ", test_add_organ},
      {"change-mesh", test_change_mesh},
      {"add-twice", test_add_twice},
      {"use-spheres", test_use_spheres},
      {"hand-edit", test_hand_edit},
      {"hand-edit-region", test_hand_edit_region},
      {"hand-edit-weights", test_hand_edit_weights},
      {"usual-model", test_usual_model},
      {"regions", test_regions},
      {"painted-region", test_painted_region},
      {"regions-of-generated", test_regions_of_generated},
      {"mapping-report", test_mapping_report},
      {"set-model", test_set_model},
      {"probe-and-pin", test_probe_and_pin},
      {"hands", test_hands},
      {"set-property", test_set_property},
      {"selection", test_selection},
      {"several-selected", test_several_selected},
      {"set-for-all", test_set_for_all},
      {"jobs", test_jobs},
      {"mapping-is-cancelled", test_mapping_is_cancelled},
      {"result-of-another-scene", test_result_of_another_scene},
      {"import-refuses", test_import_refuses},
      {"recovery", test_recovery},
      {"labels", test_labels},
  };
  /* Before GLib reads it; a child of g_test_trap_subprocess shares the parent's. */
  g_autofree char *state = g_getenv("SPORE_TEST_STATE") ? NULL : g_dir_make_tmp("spore-author-XXXXXX", NULL);
  if (state) {
    g_setenv("SPORE_TEST_STATE", state, TRUE);
    g_setenv("XDG_STATE_HOME", state, TRUE);
  }
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(tests); i++) {
    g_autofree char *path = g_strconcat("/author/", tests[i].name, NULL);
    g_test_add(path, Fixture, NULL, set_up, tests[i].run, tear_down);
  }
  g_test_add_func("/author/brush", test_brush);
  g_test_add_func("/author/number-text", test_number_text);
  g_test_add_func("/author/angle-text", test_angle_text);
  g_test_add_func("/author/flow-text", test_flow_text);
  g_test_add_func("/author/loop-gaps", test_loop_gaps);
  g_test_add_func("/author/free-place", test_free_place);
  g_test_add_func("/author/length-text", test_length_text);
  int status = g_test_run();
  g_autofree char *recovery = state ? g_build_filename(state, "spore", "recovery", NULL) : NULL;
  g_autofree char *spore = state ? g_build_filename(state, "spore", NULL) : NULL;
  if (state) g_rmdir(recovery), g_rmdir(spore), g_rmdir(state);
  return status;
}
