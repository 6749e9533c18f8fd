/* Gravity pulls where the patient's position says: each is held to axes that the import gives a patient's frame. */
#include <math.h>

#include "core/author/patient_positions.h"
#include "core/io/mesh_import.h"
#include "core/scene/schema_fields.h"
#include "tests/scene/fixture.h"

static SporeVec3 gravity_of(SporeDocument *document) {
  SporeEnvironmentFields fields;
  spore_object_fields(spore_document_section(document, "environment"), &fields);
  return spore_vec3_load(fields.gravity);
}

/* Where the import puts what lies in that direction of the patient: of a flat triangle whose normal it is. */
static SporeVec3 imported(const char *frame, double x, double y, double z) {
  const char *text = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  SporeTriangleMesh mesh = {0};
  GError *error = NULL;
  int index = 0;
  while (!g_str_equal(spore_mesh_frames[index], frame)) index++;
  g_assert_true(spore_mesh_decode("a.off", "a.off", text, strlen(text), 0, index, &mesh, NULL, &error));
  g_assert_no_error(error);
  g_assert_cmpuint(mesh.vertex_count, ==, 4);
  SporeVec3 origin = spore_vec3_load(mesh.vertices), out = {0, 0, 0};
  const double along[3] = {x, y, z};
  for (int k = 0; k < 3; k++)
    out = spore_vec3_add_scaled(out, along[k], spore_vec3_sub(spore_vec3_load(mesh.vertices + 3 * (k + 1)), origin));
  spore_triangle_mesh_clear(&mesh);
  return out;
}

static void assert_down(const char *position, double right, double front, double head) {
  GError *error = NULL;
  SporeDocument *document = fixture_parse("<spore version=\"1.0\"/>");
  g_assert_true(spore_edit_lay_patient(document, position, &error));
  g_assert_no_error(error);
  SporeVec3 down = spore_vec3_scale(1 / 9.81, gravity_of(document));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(down, imported("RAS", right, front, head)), 0, 2e-5);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(down, imported("LPS", -right, -front, head)), 0, 2e-5);
  g_assert_cmpstr(spore_patient_position_of(document)->name, ==, position);
  spore_document_free(document);
}

static void test_directions(void) {
  double sine = sin(G_PI / 12), cosine = cos(G_PI / 12);
  assert_down("supine", 0, -1, 0);
  assert_down("prone", 0, 1, 0);
  assert_down("left_lateral", -1, 0, 0);
  assert_down("right_lateral", 1, 0, 0);
  assert_down("trendelenburg", 0, -cosine, sine);
  assert_down("reverse_trendelenburg", 0, -cosine, -sine);
  assert_down("upright", 0, 0, -1);
}

static void test_one_step(void) {
  GError *error = NULL;
  SporeDocument *document = fixture_parse("<spore version=\"1.0\"><environment gravity=\"0 0 1.62\"/></spore>");
  g_assert_cmpstr(spore_patient_position_of(document)->name, ==, "supine");
  g_assert_true(spore_edit_lay_patient(document, "prone", &error));
  g_assert_cmpfloat_with_epsilon(gravity_of(document).z, -1.62, 1e-9); /* its strength stays */
  spore_document_undo(document);
  g_assert_cmpfloat(gravity_of(document).z, ==, 1.62);
  g_assert_false(spore_edit_lay_patient(document, "seated", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "supine, prone, left_lateral");
  g_assert_cmpfloat(gravity_of(document).z, ==, 1.62);
  spore_document_free(document);
  document = fixture_parse("<spore version=\"1.0\"><environment gravity=\"0 0 0\"/></spore>");
  g_assert_null(spore_patient_position_of(document));
  g_assert_true(spore_edit_lay_patient(document, "supine", &error));
  g_assert_cmpfloat_with_epsilon(gravity_of(document).z, 9.81, 1e-9);
  spore_document_free(document);
  document = fixture_parse("<spore version=\"1.0\"><environment gravity=\"0 -1 9\"/></spore>");
  g_assert_null(spore_patient_position_of(document));
  spore_document_free(document);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/patient/directions", test_directions);
  g_test_add_func("/patient/one-step", test_one_step);
  return g_test_run();
}
