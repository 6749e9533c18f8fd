/* What generators of the editor make of a body is one step, remembers how it was made, and starts again from what it
 * was made of. No display. */
#include <math.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/io/scene_xml.h"
#include "core/scene/generated.h"
#include "models/registry.h"
#include "ui/document/asset-readers.h"
#include "core/author/anatomy.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/label_choice.h"
#include "ui/jobs/generate-types.h"
#include "ui/jobs/spore-series.h"

#define LENGTH 0.08
#define RADIUS 0.005

typedef struct {
  SporeSchema *schema;
  SporeDocument *document;
  SporeObject *body; /* shows a tube along x */
} Fixture;

static void set_up(Fixture *fixture, gconstpointer data) {
  double points[] = {0, 0, 0, RADIUS, LENGTH / 2, 0, 0, RADIUS, LENGTH, 0, 0, RADIUS};
  SporeCurve line = {.count = 3, .points = points};
  SporeTriangleMesh mesh;
  g_assert_true(spore_curve_tube(&line, 24, &mesh, NULL));
  gsize size;
  char *text = spore_off_format(&mesh, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  spore_triangle_mesh_clear(&mesh);
  fixture->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  fixture->document = spore_document_new(fixture->schema);
  spore_document_set_readers(fixture->document, &spore_editor_readers);
  fixture->body = spore_organ_insert(fixture->document, "tube", "tube.off", content, 0, 0, NULL);
  g_assert_nonnull(fixture->body);
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  spore_document_free(fixture->document);
  spore_schema_free(fixture->schema);
}

static char *text_of(Fixture *fixture) {
  gsize size;
  return spore_scene_format(fixture->document, &size);
}

/* The last edit goes and comes back as one step. */
static void assert_one_step(Fixture *fixture, const char *before) {
  g_autofree char *after = text_of(fixture);
  spore_document_undo(fixture->document);
  g_autofree char *undone = text_of(fixture);
  g_assert_cmpstr(undone, ==, before);
  spore_document_redo(fixture->document);
  g_autofree char *redone = text_of(fixture);
  g_assert_cmpstr(redone, ==, after);
}

static SporeGenerateWork *run(Fixture *fixture, const SporeGenerateOptions *options) {
  GError *error = NULL;
  SporeGenerateWork *work = spore_generate_work_new(fixture->document, fixture->body, options, &error);
  g_assert_no_error(error);
  spore_generate_work_run(work, NULL, &error);
  g_assert_no_error(error);
  return work;
}

static void apply(Fixture *fixture, SporeGenerateWork *work) {
  GError *error = NULL;
  spore_generate_work_apply(work, fixture->document, &error);
  g_assert_no_error(error);
  spore_generate_work_unref(work);
}

/* Two ends are kept to; the body becomes a tube along the line, or a thread that shows itself, and pins do not pile up.
 */
static void test_middle_line(Fixture *fixture, gconstpointer data) {
  g_autofree char *before = text_of(fixture);
  SporeGenerateOptions options = spore_generate_options_of(fixture->document, fixture->body, SPORE_GENERATE_CURVE);
  g_assert_cmpfloat(options.fields.curve.tolerance, ==, 0.02);
  options.fields.curve.first_place[0] = 0.02;
  options.fields.curve.last_place[0] = 0.06;
  options.purpose = 1 + SPORE_CENTRELINE_TUBE;
  apply(fixture, run(fixture, &options));
  assert_one_step(fixture, before);
  SporeObject *asset = spore_edit_body_curve(fixture->document, fixture->body);
  double length = spore_curve_length(spore_document_curve(fixture->document, asset, NULL));
  g_assert_cmpfloat_with_epsilon(length, 0.04, 0.002);
  g_assert_cmpint(spore_generated_state(fixture->document, asset), ==, SPORE_GENERATED_FRESH);
  g_assert_cmpstr(spore_object_type(spore_body_model_object(fixture->body))->element, ==, "spline_1d");
  SporeObject *links = spore_document_section(fixture->document, "links");
  g_assert_cmpuint(spore_object_child_count(links), ==, 2);

  SporeGenerateOptions again = spore_generate_options_of(fixture->document, fixture->body, SPORE_GENERATE_CURVE);
  g_assert_cmpfloat(again.fields.curve.last_place[0], ==, 0.06);
  again.fields.curve.last_place[0] = again.fields.curve.first_place[0] = 0;
  again.purpose = 1 + SPORE_CENTRELINE_THREAD;
  apply(fixture, run(fixture, &again));
  g_assert_true(spore_edit_body_curve(fixture->document, fixture->body) == asset);
  length = spore_curve_length(spore_document_curve(fixture->document, asset, NULL));
  g_assert_cmpfloat_with_epsilon(length, LENGTH, 0.002);
  g_assert_cmpuint(spore_object_child_count(links), ==, 2);
  /* Where it shows no mesh any more, it still is known what it was made from. */
  SporeObject *visual = spore_object_child_of(fixture->body, "visual");
  spore_document_unset(fixture->document, visual, (guint)spore_parameter_find(spore_object_type(visual)->table, "mesh"),
                       NULL);
  g_assert_null(spore_edit_visual_mesh(fixture->document, fixture->body, NULL));
  SporeObject *source = spore_generate_source(fixture->document, fixture->body, SPORE_GENERATE_CURVE, NULL);
  g_assert_cmpstr(spore_object_name(source), ==, "tube");
}

/* Assets of curves. */
static guint count_curves(SporeDocument *document) {
  SporeObject *assets = spore_document_section(document, "assets");
  guint count = 0;
  for (guint i = 0; i < spore_object_child_count(assets); i++)
    count += g_str_equal(spore_object_type(spore_object_child(assets, i))->element, "curve");
  return count;
}

/* An intestine hangs from a root that is proposed, made anew with the line; a degree of 0 leaves it out. */
static void test_root(Fixture *fixture, gconstpointer data) {
  g_autofree char *before = text_of(fixture);
  SporeGenerateOptions options = spore_generate_options_of(fixture->document, fixture->body, SPORE_GENERATE_CURVE);
  options.purpose = 1 + SPORE_CENTRELINE_INTESTINE;
  apply(fixture, run(fixture, &options));
  assert_one_step(fixture, before);
  for (int degree = 2; degree >= 0; degree -= 2) {
    SporeObject *root = spore_object_reference(spore_object_child_of(fixture->body, "mechanical"), "root");
    g_assert_nonnull(root);
    const SporeCurve *curve = spore_document_curve(fixture->document, root, NULL);
    g_assert_cmpfloat_with_epsilon(spore_curve_length(curve), LENGTH, 0.01);
    g_assert_cmpuint(count_curves(fixture->document), ==, 2);
    options.fields.curve.root_degree = degree;
    SporeGenerateWork *work = run(fixture, &options);
    g_autofree char *facts = spore_generator_curve.facts(work);
    g_assert_true((strstr(facts, "\nRoot") != NULL) == (degree > 0));
    apply(fixture, work);
  }
  g_assert_null(spore_object_reference(spore_object_child_of(fixture->body, "mechanical"), "root"));
}

/* The pins of a body that stands elsewhere hold it there. */
static void test_pins_follow_pose(Fixture *fixture, gconstpointer data) {
  spore_document_set_text(fixture->document, fixture->body, "position", "0 1 0", NULL);
  SporeGenerateOptions options = spore_generate_options_of(fixture->document, fixture->body, SPORE_GENERATE_CURVE);
  options.purpose = 1 + SPORE_CENTRELINE_TUBE;
  apply(fixture, run(fixture, &options));
  SporeObject *pin = spore_object_child(spore_document_section(fixture->document, "links"), 0);
  int point = spore_parameter_find(spore_object_type(pin)->table, "point");
  g_assert_cmpfloat_with_epsilon(spore_object_value(pin, (guint)point)->number[1], 1, 1e-3);
}

/* A net of few nodes is what the model is built from; a wall is what is shown, and both are made of the tube again. */
static void test_surface(Fixture *fixture, gconstpointer data) {
  g_autofree char *before = text_of(fixture);
  SporeGenerateOptions options = spore_generate_options_of(fixture->document, fixture->body, SPORE_GENERATE_SURFACE);
  spore_generate_set_count(&options, 40);
  SporeGenerateWork *work = run(fixture, &options);
  g_assert_cmpuint(work->surface.vertex_count, ==, 40);
  for (gsize i = 0; i < work->mesh.vertex_count; i++)
    g_assert_cmpfloat(work->surface_distance[i], <=, work->surface_report.hausdorff * 1.5 * LENGTH);
  double few, many;
  g_assert_true(spore_generator_surface.error_of(work, 30, &few, NULL, NULL));
  g_assert_true(spore_generator_surface.error_of(work, 60, &many, NULL, NULL));
  g_assert_cmpfloat(many, <, few);
  apply(fixture, work);
  assert_one_step(fixture, before);
  SporeObject *net = spore_edit_body_surface(fixture->document, fixture->body);
  g_assert_cmpstr(spore_object_text(spore_object_child_of(fixture->body, "mechanical"), "geometry"), ==,
                  spore_object_name(net));
  g_assert_cmpint(spore_generated_state(fixture->document, net), ==, SPORE_GENERATED_FRESH);

  spore_generate_set_count(&options, 0);
  options.fields.surface.wall = 0.0015;
  options.purpose = SPORE_SURFACE_SHOWN;
  work = run(fixture, &options);
  double outer = M_PI * RADIUS * RADIUS, inner = M_PI * (RADIUS - 0.0015) * (RADIUS - 0.0015);
  g_assert_cmpfloat_with_epsilon(work->wall_report.lumen_volume / ((LENGTH - 0.003) * inner), 1, 0.06);
  g_assert_cmpfloat(work->wall_report.wall_volume, <, LENGTH * outer);
  apply(fixture, work);
  SporeObject *source = spore_generate_source(fixture->document, fixture->body, SPORE_GENERATE_SURFACE, NULL);
  g_assert_cmpstr(spore_object_name(source), ==, "tube");
  g_assert_true(spore_edit_visual_mesh(fixture->document, fixture->body, NULL) == net);
  options.fields.surface.wall = 0;
  work = spore_generate_work_new(fixture->document, fixture->body, &options, NULL);
  g_autoptr(GError) error = NULL;
  g_assert_false(spore_generate_work_run(work, NULL, &error));
  g_assert_nonnull(strstr(error->message, "nothing is asked for"));
  spore_generate_work_unref(work);
}

/* Two cells of two organs that share a face. */
static void test_labels(Fixture *fixture, gconstpointer data) {
  double vertices[15] = {0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01, 0.01, 0.01, 0.01};
  uint32_t cells[8] = {0, 1, 2, 3, 1, 2, 3, 4}, labels[2] = {3, 7};
  SporeTetrahedralMesh mesh = {5, 2, vertices, cells, labels};
  char *names[] = {(char *)"left lobe", (char *)"right lobe"};
  SporeLabelBodies organs = {"/tmp/two.nii.gz", NULL, NULL, &mesh, labels, names, 2, SPORE_LABELS_BODIES};
  g_autofree char *before = text_of(fixture);
  GError *error = NULL;
  spore_edit_use_labels(fixture->document, &organs, &error);
  g_assert_no_error(error);
  assert_one_step(fixture, before);
  for (int i = 0; i < 2; i++) {
    SporeObject *asset = spore_document_find(fixture->document, "tetrahedra", i ? "right_lobe" : "left_lobe");
    const SporeTetrahedralMesh *one = spore_document_tetrahedra(fixture->document, asset, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(one->vertex_count, ==, 4);
    g_assert_cmpuint(one->tetrahedron_count, ==, 1);
    for (int k = 0; k < 12; k++)
      g_assert_cmpfloat(one->vertices[3 * one->tetrahedra[k / 3] + k % 3], ==,
                        vertices[3 * cells[4 * i + k / 3] + (uint32_t)k % 3]);
  }
  g_assert_nonnull(spore_document_by_path(fixture->document, "bodies/right_lobe/mechanical/neo_hookean_tetrahedra"));
  organs.use = SPORE_LABELS_ONE_BODY;
  g_assert_true(spore_edit_use_labels(fixture->document, &organs, &error));
  SporeObject *both = spore_document_find(fixture->document, "tetrahedra", "two");
  g_assert_cmpuint(spore_document_tetrahedra(fixture->document, both, NULL)->tetrahedron_count, ==, 2);
  organs.use = SPORE_LABELS_ASSET;
  guint bodies = spore_object_child_count(spore_document_section(fixture->document, "bodies"));
  g_assert_true(spore_edit_use_labels(fixture->document, &organs, &error));
  g_assert_cmpuint(spore_object_child_count(spore_document_section(fixture->document, "bodies")), ==, bodies);
}

/* Organs hang together at the face that they share, and not where they share an edge alone. */
static void test_linked_labels(Fixture *fixture, gconstpointer data) {
  double vertices[21] = {0,    0,    0,    0.01, 0,    0,    0,    0.01, 0,    0,   0,
                         0.01, 0.01, 0.01, 0.01, 0.02, 0.01, 0.03, 0.01, 0.02, 0.03};
  uint32_t cells[12] = {0, 1, 2, 3, 1, 2, 3, 4, 3, 4, 5, 6}, labels[3] = {3, 7, 9};
  SporeTetrahedralMesh mesh = {7, 3, vertices, cells, labels};
  char *names[] = {(char *)"left lobe", (char *)"right lobe", (char *)"other"};
  SporeLabelBodies organs = {"/tmp/three.nii.gz", NULL, NULL, &mesh, labels, names, 3, SPORE_LABELS_LINKED};
  g_autofree char *before = text_of(fixture);
  GError *error = NULL;
  spore_edit_use_labels(fixture->document, &organs, &error);
  g_assert_no_error(error);
  SporeObject *links = spore_document_section(fixture->document, "links");
  g_assert_cmpuint(spore_object_child_count(links), ==, 1);
  SporeObject *seam = spore_document_by_path(fixture->document, "links/left_lobe_right_lobe");
  g_assert_cmpstr(spore_object_type(seam)->element, ==, "seam");
  SporeSimulation *simulation = spore_simulation_new(fixture->document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_world_link_count(simulation->world), ==, 3);
  spore_simulation_free(simulation);
  assert_one_step(fixture, before);
}

/* The scene keeps the map, and says when it or the options changed; made again, the organs are the same bodies. */
static void test_stale_labels(Fixture *fixture, gconstpointer data) {
  double vertices[15] = {0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01, 0.01, 0.01, 0.01};
  uint32_t cells[8] = {0, 1, 2, 3, 1, 2, 3, 4}, labels[2] = {3, 7};
  SporeTetrahedralMesh mesh = {5, 2, vertices, cells, labels};
  char *names[] = {(char *)"left lobe", (char *)"right lobe"};
  SporeTetrahedraFields fields;
  SporeParameterTable table = spore_generator_table(&spore_generator_labels);
  spore_parameters_set_initial(&table, &fields);
  fields.cells = 5000;
  g_autoptr(GBytes) content = g_bytes_new_static("voxels", 6), other = g_bytes_new_static("other voxels", 12);
  SporeLabelBodies organs = {"/tmp/two.nii.gz", content, &fields, &mesh, labels, names, 2, SPORE_LABELS_LINKED};
  g_autofree char *before = text_of(fixture);
  GError *error = NULL;
  spore_edit_use_labels(fixture->document, &organs, &error);
  g_assert_no_error(error);
  assert_one_step(fixture, before);
  SporeObject *map = spore_document_by_path(fixture->document, "assets/two_labels");
  SporeObject *left = spore_document_find(fixture->document, "tetrahedra", "left_lobe");
  SporeObject *body = spore_document_find(fixture->document, "body", "right_lobe");
  g_assert_cmpint(spore_generated_state(fixture->document, left), ==, SPORE_GENERATED_FRESH);
  g_assert_true(spore_edit_body_label_map(fixture->document, body) == map);
  spore_document_set_text(fixture->document, left, "cells", "3000", &error);
  g_assert_cmpint(spore_generated_state(fixture->document, left), ==, SPORE_GENERATED_OPTIONS_CHANGED);
  spore_document_put_blob(fixture->document, spore_object_text(map, "file"), other);
  g_assert_cmpint(spore_generated_state(fixture->document, left), ==, SPORE_GENERATED_SOURCE_CHANGED);
  g_autofree char *stale = text_of(fixture);
  organs.content = other;
  vertices[14] = 0.02;
  spore_edit_use_labels(fixture->document, &organs, &error);
  g_assert_no_error(error);
  assert_one_step(fixture, stale);
  g_assert_cmpint(spore_generated_state(fixture->document, left), ==, SPORE_GENERATED_FRESH);
  const guint counts[] = {4, 3, 1}; /* with the tube */
  const char *const sections[] = {"assets", "bodies", "links"};
  for (int i = 0; i < 3; i++)
    g_assert_cmpuint(spore_object_child_count(spore_document_section(fixture->document, sections[i])), ==, counts[i]);
  spore_document_set_text(fixture->document, left, "frozen", "true", &error);
  g_assert_false(spore_edit_use_labels(fixture->document, &organs, &error));
  g_assert_nonnull(strstr(error->message, "is frozen"));
  g_clear_error(&error);
}

static void test_wanted_labels(Fixture *fixture, gconstpointer data) {
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_LABELS};
  spore_label_choose(&options, 511, SPORE_LABEL_LEFT_OUT);
  spore_label_choose(&options, 64, SPORE_LABEL_LEFT_OUT);
  spore_label_choose(&options, 64, SPORE_LABEL_SOFT);
  spore_label_choose(&options, 63, SPORE_LABEL_LEFT_OUT);
  spore_label_choose(&options, 63, SPORE_LABEL_AROUND);
  for (gsize i = 0; i < SPORE_LABEL_SOURCE_MOST; i++)
    g_assert_cmpint(spore_label_choice(&options, i), ==,
                    i == 511  ? SPORE_LABEL_LEFT_OUT
                    : i == 63 ? SPORE_LABEL_AROUND
                              : SPORE_LABEL_SOFT);
}

/* What a name says counts from the beginning of one of its parts on. */
static void test_anatomy(Fixture *fixture, gconstpointer data) {
  static const struct {
    const char *name, *material;
  } names[] = {
      {"liver", "liver"}, {"Kidney left", "kidney"}, {"liver_vessels", NULL}, {"hepatic artery", "hepatic_artery"},
      {"delivery", NULL}, {"rib_left_4", NULL},      {"label_9", NULL},       {"small-bowel", "small_intestine"}};
  double colour[3], other[3];
  for (gsize i = 0; i < G_N_ELEMENTS(names); i++)
    g_assert_cmpstr(spore_anatomy_material(names[i].name), ==, names[i].material);
  static const struct {
    const char *name;
    double volume_ml;
    gboolean doubted;
  } sizes[] = {{"liver", 1500, FALSE},      {"Liver", 4500, TRUE},  {"liver", 1.5, TRUE},
               {"liver_tumor", 1.5, FALSE}, {"spleen", 900, FALSE}, {"left kidney", 1600, TRUE},
               {"left kidney", 150, FALSE}, {"thing", 1e6, FALSE},  {"liver_segment_1", 30, FALSE},
               {"brainstem", 30, FALSE}};
  for (guint i = 0; i < G_N_ELEMENTS(sizes); i++) {
    g_autofree char *doubt = spore_anatomy_doubt(sizes[i].name, 1e-6 * sizes[i].volume_ml);
    g_assert_true((doubt != NULL) == sizes[i].doubted);
    if (doubt) g_assert_nonnull(strstr(doubt, "; check the unit"));
  }
  spore_anatomy_colour("rib_left_4", 1, colour);
  spore_anatomy_colour("rib", 2, other);
  g_assert_cmpmem(colour, sizeof colour, other, sizeof other);
  spore_anatomy_colour("caribou", 2, other);
  g_assert_cmpint(memcmp(colour, other, sizeof colour), !=, 0);
  for (guint a = 1; a < 40; a++)
    for (guint b = 1; b <= 8 && b < a; b++) {
      spore_anatomy_colour("label", a, colour);
      spore_anatomy_colour("label", a - b, other);
      g_assert_cmpfloat(fabs(colour[0] - other[0]) + fabs(colour[1] - other[1]) + fabs(colour[2] - other[2]), >, 0.02);
      for (int k = 0; k < 3; k++) g_assert_true(colour[k] >= 0 && colour[k] <= 1);
    }
}

/* A name that somebody gives is a guess no more; in the same step, and other names stay guesses. */
static void test_guessed_name(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *body = spore_document_insert(fixture->document, spore_document_section(fixture->document, "bodies"),
                                            "body", "spleen", G_MAXUINT, &error);
  g_assert_true(spore_document_set_text(fixture->document, body, "name_guessed", "true", &error));
  g_assert_true(spore_document_rename(fixture->document, body, "spleen", &error)); /* the same: nothing is said */
  g_assert_cmpfloat(spore_object_number(body, "name_guessed"), ==, 1);
  g_assert_true(spore_document_rename(fixture->document, body, "kidney", &error));
  g_assert_cmpfloat(spore_object_number(body, "name_guessed"), ==, 0);
  spore_document_undo(fixture->document);
  g_assert_cmpstr(spore_object_name(body), ==, "spleen");
  g_assert_cmpfloat(spore_object_number(body, "name_guessed"), ==, 1);
}

/* Names that a file's header gives, told apart from what only looks like them. */
static void test_label_names(Fixture *fixture, gconstpointer data) {
  static const char text[] = "NRRD0004\nSegment12_Name:=liver\r\nSegment12_LabelValue:=3\nSegment1_LabelValue:=70000\n"
                             "Segment1_Name:=far\nSegment2_Name:=\nSegment2_LabelValue:=2\nSegment_Name:=x\n"
                             "Segment3_NameAutoGenerated:=1\nSegment3_LabelValue:=4\n\nSegment5_Name:=no\n";
  g_autoptr(GHashTable) names = spore_label_map_names(text, sizeof text - 1);
  g_assert_cmpuint(g_hash_table_size(names), ==, 1);
  g_assert_cmpstr(g_hash_table_lookup(names, GUINT_TO_POINTER(3)), ==, "liver");
  g_autoptr(GHashTable) none = spore_label_map_names("n+1", 3);
  g_assert_cmpuint(g_hash_table_size(none), ==, 0);
}

/* Every kind is found, has something to show, and its count is one of its options. */
static void test_kinds(Fixture *fixture, gconstpointer data) {
  for (SporeGenerateKind kind = 0; spore_generators[kind]; kind++) {
    const SporeGenerateType *type = spore_generate_type(kind);
    const SporeParameterTable kinds = spore_generator_table(spore_generators[kind]), *table = &kinds;
    g_assert_cmpuint(type->quality_count, >, 0);
    g_assert_cmpint(spore_parameter_find(table, spore_generators[kind]->count), >=, 0);
    SporeGenerateOptions options = {.kind = kind};
    spore_generate_set_count(&options, 17);
    g_assert_cmpuint(spore_generate_get_count(&options), ==, 17);
    const SporeParameter *count = &table->parameters[spore_parameter_find(table, spore_generators[kind]->count)];
    g_assert_cmpfloat(spore_parameter_load(count, &options.fields).number[0], ==, 17);
    for (gsize i = 0; type->counts && type->counts[i]; i++) g_assert_cmpuint(i, <, SPORE_SERIES_POINTS);
  }
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    void (*run)(Fixture *fixture, gconstpointer data);
  } tests[] = {
      {"kinds", test_kinds},
      {"middle-line", test_middle_line},
      {"root", test_root},
      {"pins-follow-pose", test_pins_follow_pose},
      {"surface", test_surface},
      {"labels", test_labels},
      {"linked-labels", test_linked_labels},
      {"stale-labels", test_stale_labels},
      {"wanted-labels", test_wanted_labels},
      {"anatomy", test_anatomy},
      {"guessed-name", test_guessed_name},
      {"label-names", test_label_names},
  };
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(tests); i++) {
    g_autofree char *path = g_strconcat("/generators/", tests[i].name, NULL);
    g_test_add(path, Fixture, NULL, set_up, tests[i].run, tear_down);
  }
  return g_test_run();
}
