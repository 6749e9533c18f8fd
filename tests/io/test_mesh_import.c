/* Meshes from strangers' files: each format gives the same ball, and each kind of bad file one clear message. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/mesh_import.h"
#include "tests/io/mesh_files.h"
#include "tests/mesh/shapes.h"

#define RADIUS 0.05

static SporeTriangleMesh ball(size_t n) {
  SporeTriangleMesh mesh = {0};
  shape_ball(&mesh, RADIUS, n);
  return mesh;
}

static SporeMeshReport report_of(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_triangle_mesh_report(mesh, &report, &error));
  return report;
}

static void decode(const char *file, const void *content, gsize size, int unit, int frame, SporeTriangleMesh *mesh) {
  GError *error = NULL;
  gboolean done = spore_mesh_decode(file, file, content, size, unit, frame, mesh, NULL, &error);
  g_assert_no_error(error);
  g_assert_true(done);
}

/* Refused: one line that begins with the place and says `words`. */
static void check_refused(const char *file, const void *content, gsize size, const char *words) {
  SporeTriangleMesh mesh;
  GError *error = NULL;
  gboolean done = spore_mesh_decode(file, file, content, size, 0, 0, &mesh, NULL, &error);
  g_assert_false(done);
  g_assert_null(mesh.vertices);
  if (!strstr(error->message, words)) g_error("\"%s\" does not say \"%s\"", error->message, words);
  g_test_message("%s", error->message);
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_assert_true(g_str_has_prefix(error->message, file));
  g_assert_null(strchr(error->message, '\n'));
  g_error_free(error);
}

static void check_refused_file(const char *file, GByteArray *content, const char *words) {
  check_refused(file, content->data, content->len, words);
  g_byte_array_unref(content);
}

static void check_refused_text(const char *file, const char *text, const char *words) {
  check_refused(file, text, strlen(text), words);
}

/* The ball again: same numbers of vertices and triangles, closed, same volume. `stretch`: what the file does to it. */
static void check_ball(const char *file, GByteArray *content, double stretch) {
  SporeTriangleMesh given = ball(8), mesh;
  decode(file, content->data, content->len, 0, 0, &mesh);
  SporeMeshReport was = report_of(&given), is = report_of(&mesh);
  g_assert_cmpuint(mesh.vertex_count, ==, given.vertex_count);
  g_assert_cmpuint(mesh.triangle_count, ==, given.triangle_count);
  g_assert_true(is.closed);
  g_assert_cmpuint(is.components, ==, 1);
  g_assert_cmpfloat_with_epsilon(is.volume / was.volume, stretch, 1e-5);
  spore_triangle_mesh_clear(&given);
  spore_triangle_mesh_clear(&mesh);
  g_byte_array_unref(content);
}

static GByteArray *off(const SporeTriangleMesh *mesh) {
  gsize size;
  char *text = spore_off_format(mesh, &size);
  return g_byte_array_new_take((guint8 *)text, size);
}

static void test_off(void) {
  SporeTriangleMesh mesh = ball(8);
  check_ball("ball.off", off(&mesh), 1);
  check_ball("ball.stl", off(&mesh), 1); /* content decides, not the name */
  spore_triangle_mesh_clear(&mesh);
}

static void test_stl(void) {
  SporeTriangleMesh mesh = ball(8);
  check_ball("ball.stl", file_stl_text(&mesh), 1);
  check_ball("ball.stl", file_stl(&mesh), 1);
  check_ball("ball", file_stl(&mesh), 1);
  GByteArray *longer = file_stl(&mesh); /* some programs write a trailer */
  g_byte_array_append(longer, (const guint8 *)"made by", 7);
  check_ball("ball.stl", longer, 1);
  spore_triangle_mesh_clear(&mesh);
}

static void test_obj(void) {
  SporeTriangleMesh mesh = ball(8);
  check_ball("ball.obj", file_obj(&mesh, "# a comment\no ball\n"), 1);
  check_ball("ball.obj", file_obj(&mesh, "mtllib /etc/passwd\nmtllib ball.mtl\nusemtl root\n"), 1);
  spore_triangle_mesh_clear(&mesh);
}

static void test_ply(void) {
  SporeTriangleMesh mesh = ball(8);
  check_ball("ball.ply", file_ply_text(&mesh), 1);
  check_ball("ball.ply", file_ply(&mesh), 1);
  spore_triangle_mesh_clear(&mesh);
}

/* The node of these files doubles x: so the volume doubles, and the ball moves. */
/* Texts of glTF that assimp would expand or misread. */
static void test_gltf_text(void) {
#define ASSET "{\"asset\":{\"version\":\"2.0\"},"
  static const struct {
    const char *text, *words;
  } cases[] = {
      {ASSET "\"nodes\":[{\"children\":[1,1]},{}]}", "node 1 of the glTF text lies in more than one"},
      {ASSET "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}", "more than 256 others"},
      {ASSET "\"nodes\":[{\"children\":[0]}]}", "more than 256 others"},
      {ASSET "\"nodes\":[{\"children\":[2]},{}]}", "nodes 0 of the glTF text has children 2"},
      {ASSET "\"nodes\":[{\"children\":[-1]},{}]}", "children -1"},
      {ASSET "\"nodes\":[{}],\"scenes\":[{\"nodes\":[0,0]}]}", "in its scene twice"},
      {ASSET "\"nodes\":[{\"children\":[1]},{}],\"scenes\":[{\"nodes\":[1]}]}", "in its scene twice"},
      {ASSET "\"nodes\":[{\"mesh\":0}]}", "there are none"},
      {ASSET "\"nodes\":[],\"nodes\":[]}", "nodes twice"},
      {ASSET "\"\\u006eodes\":[]}", "an escape"},
      {ASSET "\"accessors\":[{\"byteOffset\":-12}]}", "accessors 0 of the glTF text has byteOffset -12"},
      {ASSET "\"accessors\":[{\"byteOffset\":1.5}]}", "byteOffset 1.5"},
      {ASSET "\"accessors\":[{},{\"count\":0}]}", "accessors 1 of the glTF text has count 0"},
      {ASSET "\"accessors\":[{\"count\":99999999999999999999}]}", "count 99999999999999999999"},
      {ASSET "\"bufferViews\":[{\"byteStride\":2147483648}]}",
       "byteStride 2147483648; expected a whole number from 4 to"},
      {ASSET "\"bufferViews\":[{\"byteOffset\":-4}]}", "byteOffset -4"},
      {ASSET "\"accessors\":[{\"count\":15000000}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}},"
             "{\"attributes\":{\"POSITION\":0}}]}]}",
       "more than 20000000"},
      {ASSET "\"accessors\":[{\"count\":15000000}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
             "\"nodes\":[{\"mesh\":0},{\"mesh\":0}]}",
       "more than 20000000"},
      {ASSET "\"meshes\":[[", "not the JSON of a mesh"},
      {ASSET "\"nodes\":[{} {}]}", "not the JSON of a mesh"},
      {ASSET "\"nodes\":{}}", "not the JSON of a mesh"},
      {ASSET "\"nodes", "not the JSON of a mesh"},
  };
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) check_refused_text("text.gltf", cases[i].text, cases[i].words);
  g_autoptr(GString) deep = g_string_new(ASSET "\"extras\":");
  for (int i = 0; i < 100000; i++) g_string_append_c(deep, '[');
  check_refused_text("deep.gltf", deep->str, "not the JSON of a mesh");
#undef ASSET
}

static void test_gltf(void) {
  SporeTriangleMesh mesh = ball(8), moved;
  check_ball("ball.gltf", file_gltf(&mesh, NULL), 2);
  check_ball("ball.glb", file_glb(&mesh), 2);
  GByteArray *file = file_glb(&mesh);
  decode("ball.glb", file->data, file->len, 0, 0, &moved);
  SporeMeshReport report = report_of(&moved);
  const double lower[3] = {1 - 2 * RADIUS, 2 - RADIUS, 3 - RADIUS};
  for (int axis = 0; axis < 3; axis++) g_assert_cmpfloat_with_epsilon(report.lower[axis], lower[axis], 1e-5);
  g_byte_array_unref(file);
  spore_triangle_mesh_clear(&moved);
  spore_triangle_mesh_clear(&mesh);
}

/* A quadrilateral and a pentagon become 2 and 3 triangles; the line is passed over. */
static void test_polygons(void) {
  static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2.5 2 0\nv 2 1 0\n"
                             "f 1 2 3 4\nf 5 6 7 8 9\nl 1 2\n";
  SporeTriangleMesh mesh;
  decode("polygons.obj", text, strlen(text), 0, 0, &mesh);
  g_assert_cmpuint(mesh.triangle_count, ==, 5);
  g_assert_cmpfloat_with_epsilon(report_of(&mesh).area, 2.5, 1e-6);
  spore_triangle_mesh_clear(&mesh);
}

/* Numbers that begin with their point, as some programs write them. */
static void test_points_first(void) {
  static const char text[] = "o ./.part\nv 0 0 0\nv .5 0 0\nv\t.5 +.5 -.25\nf 1 2 3\n";
  SporeTriangleMesh mesh;
  decode("points.obj", text, strlen(text), 0, 0, &mesh);
  g_assert_cmpuint(mesh.triangle_count, ==, 1);
  const double corner[] = {0.5, 0.5, -0.25};
  for (int i = 0; i < 3; i++) g_assert_cmpfloat_with_epsilon(mesh.vertices[6 + i], corner[i], 1e-9);
  spore_triangle_mesh_clear(&mesh);
}

/* One triangle with a corner on each axis, at 1, 2 and 3 units. */
static void check_axes(int unit, int frame, const double expected[9]) {
  static const char text[] = "OFF\n3 1 0\n1 0 0\n0 2 0\n0 0 3\n3 0 1 2\n";
  SporeTriangleMesh mesh;
  decode("axes.off", text, strlen(text), unit, frame, &mesh);
  for (int i = 0; i < 9; i++) g_assert_cmpfloat_with_epsilon(mesh.vertices[i], expected[i], 1e-12);
  spore_triangle_mesh_clear(&mesh);
}

static void test_units(void) {
  const double metres[] = {1, 1e-2, 1e-3, 1e-6, 0.0254};
  for (int unit = 0; spore_length_units[unit]; unit++) {
    const double m = metres[unit];
    check_axes(unit, 0, (const double[9]){m, 0, 0, 0, 2 * m, 0, 0, 0, 3 * m});
  }
}

static void test_frames(void) {
  check_axes(0, 0, (const double[9]){1, 0, 0, 0, 2, 0, 0, 0, 3});
  check_axes(0, 1, (const double[9]){1, 0, 0, 0, 0, -2, 0, 3, 0}); /* RAS: (x, z, -y) */
  check_axes(0, 2, (const double[9]){-1, 0, 0, 0, 0, 2, 0, 3, 0}); /* LPS: (-x, z, y) */
}

static void test_frame_hint(void) {
  static const char lps[] = "# SPACE=LPS\nv 0 0 0\n", ras[80] = "exported; space=RAS", none[] = "OFF\n";
  g_assert_cmpstr(spore_mesh_frames[spore_mesh_frame_hint(lps, sizeof lps)], ==, "LPS");
  g_assert_cmpstr(spore_mesh_frames[spore_mesh_frame_hint(ras, sizeof ras)], ==, "RAS");
  g_assert_cmpint(spore_mesh_frame_hint(none, sizeof none), ==, -1);
  g_assert_cmpint(spore_mesh_frame_hint("", 0), ==, -1);
}

static void test_large(void) {
  SporeTriangleMesh given = ball(58), mesh;
  g_assert_cmpuint(given.triangle_count, >=, 40000);
  GByteArray *file = file_stl(&given);
  decode("large.stl", file->data, file->len, 0, 0, &mesh);
  g_assert_cmpuint(mesh.triangle_count, ==, given.triangle_count);
  g_assert_cmpuint(mesh.vertex_count, ==, given.vertex_count);
  g_byte_array_unref(file);
  spore_triangle_mesh_clear(&given);
  spore_triangle_mesh_clear(&mesh);
}

static void test_not_a_mesh(void) {
  static const char bytes[] =
      "\0\1\2\3 binary rubbish \0\0 that is no mesh at all, and longer than any header of eighty bytes";
  check_refused("empty.stl", "", 0, "the file is empty");
  check_refused_text("letter.stl", "Dear colleague,\nplease find the organ below.\n", "this is text, but no mesh");
  check_refused_text("solid.stl", "solid advice: rest a lot\n", "this is text, but no mesh");
  check_refused_text("list.obj", "{\"a\": [1, 2]}", "this is text, but no mesh");
  check_refused("picture.obj", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16, "no mesh that SPORE knows");
  check_refused("rubbish.glb", bytes, sizeof bytes, "no mesh that SPORE knows");
  check_refused("rubbish.stl", bytes, sizeof bytes, "cut short");
}

static void test_truncated(void) {
  SporeTriangleMesh mesh = ball(8);
  GByteArray *(*const makers[])(const SporeTriangleMesh *) = {file_stl, file_stl_text, file_glb,
                                                              file_ply, file_ply_text, off};
  const char *const names[] = {"cut.stl", "text.stl", "cut.glb", "cut.ply", "text.ply", "cut.off"};
  for (gsize i = 0; i < G_N_ELEMENTS(makers); i++)
    for (int part = 1; part < 4; part++) {
      GByteArray *file = makers[i](&mesh);
      g_byte_array_set_size(file, file->len * (guint)part / 4);
      check_refused_file(names[i], file, names[i]);
    }
  spore_triangle_mesh_clear(&mesh);
}

static void test_not_finite(void) {
  SporeTriangleMesh mesh = ball(4);
  check_refused_text("nan.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
                     "nan.off:4:3: \"nan\" is not a coordinate");
  check_refused_text("inf.off", "OFF\n3 1 0\n0 0 0\n1 1e999 0\n0 1 0\n3 0 1 2\n", "finite number");
  mesh.vertices[3 * 5 + 1] = NAN;
  check_refused_file("nan.stl", file_stl(&mesh), "finite");
  check_refused_file("nan.stl", file_stl_text(&mesh), "finite");
  check_refused_file("nan.ply", file_ply(&mesh), "finite");
  check_refused_file("nan.glb", file_glb(&mesh), "finite");
  mesh.vertices[3 * 5 + 1] = INFINITY;
  check_refused_file("inf.stl", file_stl(&mesh), "finite");
  mesh.vertices[3 * 5 + 1] = 1e30;
  check_refused_file("far.stl", file_stl(&mesh), "vertex");
  spore_triangle_mesh_clear(&mesh);
}

static void test_index_out_of_range(void) {
  SporeTriangleMesh mesh = ball(4);
  mesh.triangles[7] = (uint32_t)mesh.vertex_count;
  check_refused_file("index.off", off(&mesh), "is not the index of a vertex");
  check_refused_file("index.obj", file_obj(&mesh, ""), "vertex that is not there");
  check_refused_file("index.ply", file_ply(&mesh), "face 2 names vertex 98 of 98");
  check_refused_file("index.ply", file_ply_text(&mesh), "face 2 names vertex 98 of 98");
  check_refused_file("index.gltf", file_gltf(&mesh, NULL), "vertex that is not there");
  check_refused_file("index.glb", file_glb(&mesh), "vertex that is not there");
  mesh.triangles[7] = 0xfffffff0u;
  check_refused_file("index.glb", file_glb(&mesh), "vertex that is not there");
  check_refused_file("index.ply", file_ply(&mesh), "face 2 names vertex -16 of 98");
  spore_triangle_mesh_clear(&mesh);
}

static void test_other_files(void) {
  SporeTriangleMesh mesh = ball(4);
  check_refused_file("outside.gltf", file_gltf(&mesh, "/etc/passwd"), "another file");
  check_refused_file("beside.gltf", file_gltf(&mesh, "buffer.bin"), "another file");
  spore_triangle_mesh_clear(&mesh);
}

static void test_no_surface(void) {
  check_refused_text("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n", "points");
  check_refused_text("line.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n", "no face has three corners");
  check_refused_text("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n", "collapses");
  check_refused_text("none.stl", "solid none\nfacet\nendsolid none\n", "none.stl");
  check_refused_text("empty.gltf", "{\"asset\":{\"version\":\"2.0\"}}", "empty.gltf");
}

/* Counts that promise what the file cannot hold are refused before memory is asked for. */
static void test_too_many(void) {
  check_refused_text("many.off", "OFF\n19999999 1 0\n0 0 0\n", "too short for a number of vertices of 19999999");
  check_refused_text("more.off", "OFF\n4000000000 1 0\n0 0 0\n", "from 0 to 20000000");
  check_refused_text("negative.off", "OFF\n-3 1 0\n0 0 0\n", "from 0 to 20000000");
  char head[84 + 50] = "binary";
  memcpy(head + 80, "\xff\xff\xff\xff", 4);
  check_refused("many.stl", head, sizeof head, "cut short");
}

/* A polygon of so many corners, in a text of the format. */
static char *polygon(const char *format, unsigned corners) {
  bool off = g_str_equal(format, "off");
  GString *text = g_string_new(off ? "OFF\n" : "");
  if (off) g_string_append_printf(text, "%u 1 0\n", corners);
  for (unsigned i = 0; i < corners; i++)
    g_string_append_printf(text, "%s%.9f %.9f 0\n", off ? "" : "v ", cos(2 * G_PI * i / corners),
                           sin(2 * G_PI * i / corners));
  if (off) g_string_append_printf(text, "%u", corners);
  else g_string_append(text, "f");
  for (unsigned i = 0; i < corners; i++) g_string_append_printf(text, " %u", off ? i : i + 1);
  g_string_append_c(text, '\n');
  return g_string_free(text, FALSE);
}

/* Cutting a face into triangles takes work by the square of its corners, so their number has a limit. */
static void test_large_faces(void) {
  static const char *const formats[] = {"off", "obj"};
  for (size_t i = 0; i < (SPORE_HAVE_ASSIMP ? G_N_ELEMENTS(formats) : 1); i++) {
    g_autofree char *file = g_strdup_printf("face.%s", formats[i]), *many = polygon(formats[i], 10001);
    check_refused_text(file, many, "10000");
    check_refused_text(file, many, "10001");
    unsigned corners = i == 0 ? 10000 : 1000;
    g_autofree char *few = polygon(formats[i], corners);
    SporeTriangleMesh mesh;
    GError *error = NULL;
    g_assert_true(spore_mesh_decode(file, file, few, strlen(few), 0, 0, &mesh, NULL, &error));
    g_assert_no_error(error);
    g_assert_cmpuint(mesh.triangle_count, ==, corners - 2);
    spore_triangle_mesh_clear(&mesh);
  }
}

static bool refuse(void *data, double fraction, const char *stage) { return false; }

static void test_cancel(void) {
  SporeTriangleMesh given = ball(8), mesh;
  GByteArray *file = file_stl(&given);
  GError *error = NULL;
  SporeProgress progress = {refuse, NULL};
  g_assert_false(spore_mesh_decode("ball.stl", "ball.stl", file->data, file->len, 0, 0, &mesh, &progress, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_error_free(error);
  g_byte_array_unref(file);
  spore_triangle_mesh_clear(&given);
}

/* Every byte of a GLB and a PLY may be wrong: an answer or a message, never more. */
static void test_damaged(void) {
  SporeTriangleMesh given = ball(2);
  GByteArray *(*const makers[])(const SporeTriangleMesh *) = {file_glb, file_ply, file_stl_text};
  GRand *random = g_rand_new_with_seed(7);
  for (int i = 0; i < 60; i++) {
    GByteArray *file = makers[i % 3](&given);
    for (int change = 0; change < 4; change++)
      file->data[g_rand_int_range(random, 0, (gint32)file->len)] = (guint8)g_rand_int_range(random, 0, 256);
    SporeTriangleMesh mesh;
    GError *error = NULL;
    if (spore_mesh_decode("damaged", "damaged", file->data, file->len, 0, 0, &mesh, NULL, &error)) {
      SporeError invalid = SPORE_ERROR_INIT;
      g_assert_true(spore_triangle_mesh_validate(&mesh, &invalid));
      spore_triangle_mesh_clear(&mesh);
    } else g_assert_nonnull(error);
    g_clear_error(&error);
    g_byte_array_unref(file);
  }
  g_rand_free(random);
  spore_triangle_mesh_clear(&given);
}

/* Says what is missing rather than fail somewhere inside. */
static void test_not_in_this_build(void) {
  SporeTriangleMesh given = ball(2), mesh;
  GByteArray *file = file_stl(&given);
  GError *error = NULL;
  g_assert_false(spore_mesh_decode("ball.stl", "ball.stl", file->data, file->len, 0, 0, &mesh, NULL, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_UNSUPPORTED);
  g_assert_nonnull(strstr(error->message, "ball.stl: this is STL, and this build of SPORE reads OFF and VTK alone"));
  g_error_free(error);
  g_byte_array_unref(file);
  spore_triangle_mesh_clear(&given);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh-import/off", test_off);
  g_test_add_func("/mesh-import/units", test_units);
  g_test_add_func("/mesh-import/frames", test_frames);
  g_test_add_func("/mesh-import/frame-hint", test_frame_hint);
  g_test_add_func("/mesh-import/not-a-mesh", test_not_a_mesh);
  g_test_add_func("/mesh-import/too-many", test_too_many);
  g_test_add_func("/mesh-import/large-faces", test_large_faces);
  if (SPORE_HAVE_ASSIMP) {
    g_test_add_func("/mesh-import/stl", test_stl);
    g_test_add_func("/mesh-import/obj", test_obj);
    g_test_add_func("/mesh-import/ply", test_ply);
    g_test_add_func("/mesh-import/gltf", test_gltf);
    g_test_add_func("/mesh-import/gltf-text", test_gltf_text);
    g_test_add_func("/mesh-import/polygons", test_polygons);
    g_test_add_func("/mesh-import/points-first", test_points_first);
    g_test_add_func("/mesh-import/large", test_large);
    g_test_add_func("/mesh-import/truncated", test_truncated);
    g_test_add_func("/mesh-import/not-finite", test_not_finite);
    g_test_add_func("/mesh-import/index-out-of-range", test_index_out_of_range);
    g_test_add_func("/mesh-import/other-files", test_other_files);
    g_test_add_func("/mesh-import/no-surface", test_no_surface);
    g_test_add_func("/mesh-import/cancel", test_cancel);
    g_test_add_func("/mesh-import/damaged", test_damaged);
  } else g_test_add_func("/mesh-import/not-in-this-build", test_not_in_this_build);
  return g_test_run();
}
