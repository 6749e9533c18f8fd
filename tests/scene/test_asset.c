/* Assets: read once per content, and never from outside the scene's folder. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/scene/beneath.h"
#include "fixture.h"

static int decoded; /* how often a reader ran */

/* A sphere set of one sphere a byte, so that content can be told apart. */
static gboolean read_spheres(const char *place, const char *file, GBytes *content, SporeSphereSet *set,
                             GError **error) {
  decoded++;
  gsize size;
  const char *bytes = g_bytes_get_data(content, &size);
  if (size > 0 && bytes[0] == '!') return spore_error_raise(error, SPORE_ERROR_INPUT, place, "bad content");
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_sphere_set_allocate(set, size, &fault)) return spore_error_propagate(&fault, error);
  for (gsize i = 0; i < 4 * size; i++) set->spheres[i] = bytes[i / 4];
  return TRUE;
}

static const SporeAssetReaders readers = {.spheres = read_spheres};

/* Loads a scene in the folder whose one asset, `s`, names `file`. */
static SporeDocument *load(const char *folder, const char *file) {
  g_autofree char *text = g_strdup_printf("<spore version=\"1.0\">\n  <assets>\n    <spheres name=\"s\" file=\"%s\"/>\n"
                                          "  </assets>\n</spore>\n",
                                          file);
  g_autofree char *path = fixture_write(folder, "scene.spore", text);
  GError *error = NULL;
  SporeDocument *document = spore_scene_load(fixture_schema(), path, &error);
  g_assert_no_error(error);
  spore_document_set_readers(document, &readers);
  decoded = 0;
  return document;
}

static void refuse(const char *folder, const char *file, const char *says) {
  SporeDocument *document = load(folder, file);
  GError *error = NULL;
  g_assert_null(spore_document_spheres(document, spore_document_by_path(document, "assets/s"), &error));
  g_test_message("%s", error->message);
  g_autofree char *place = g_strdup_printf("%s:3:5: ", spore_document_file(document));
  g_assert_true(g_str_has_prefix(error->message, place));
  g_assert_cmpint(spore_error_exit_status(error), ==, 2);
  fixture_assert_error(error, error->code, says);
  g_assert_null(spore_document_asset_hash(document, spore_document_by_path(document, "assets/s")));
  spore_document_free(document);
}

static void test_missing_and_irregular(void) {
  char *folder = fixture_folder_new();
  g_free(fixture_write(folder, "sub/inside", "abc"));
  g_autofree char *pipe = g_build_filename(folder, "pipe", NULL);
  g_assert_cmpint(mkfifo(pipe, 0600), ==, 0);
  refuse(folder, "missing", "there is no file \"missing\"");
  refuse(folder, "sub/inside/more", "there is no file");
  refuse(folder, "sub", "not a regular file");
  refuse(folder, "pipe", "not a regular file");
  fixture_folder_free(folder);
}

static void test_links(void) {
  char *folder = fixture_folder_new(), *outside = fixture_folder_new();
  g_autofree char *secret = fixture_write(outside, "secret", "abc");
  g_free(fixture_write(folder, "sub/inside", "abc"));
  g_autofree char *to_file = g_build_filename(folder, "to-file", NULL),
                  *to_folder = g_build_filename(folder, "to-folder", NULL);
  g_autofree char *up = g_build_filename(folder, "sub", "up", NULL), *within = g_build_filename(folder, "within", NULL);
  g_autofree char *magic = g_build_filename(folder, "magic", NULL);
  g_assert_cmpint(symlink(secret, to_file), ==, 0);
  g_assert_cmpint(symlink(outside, to_folder), ==, 0);
  g_assert_cmpint(symlink("../..", up), ==, 0);
  g_assert_cmpint(symlink("sub/inside", within), ==, 0);
  g_assert_cmpint(symlink("/proc/self/root", magic), ==, 0);
  refuse(folder, "to-file", "leads out of the scene's folder");
  refuse(folder, "to-folder/secret", "leads out of the scene's folder");
  refuse(folder, "sub/up/etc/passwd", "leads out of the scene's folder");
  refuse(folder, "magic/etc/passwd", "leads out of the scene's folder");
  SporeDocument *document = load(folder, "within");
  GError *error = NULL;
  g_assert_nonnull(spore_document_spheres(document, spore_document_by_path(document, "assets/s"), &error));
  g_assert_no_error(error);
  spore_document_free(document);
  fixture_folder_free(folder);
  fixture_folder_free(outside);
}

/* The way of older kernels: the same, but for links that stay inside. */
static void test_walking(void) {
  char *folder = fixture_folder_new();
  g_free(fixture_write(folder, "sub/inside", "abc"));
  g_autofree char *link = g_build_filename(folder, "link", NULL);
  g_assert_cmpint(symlink("sub", link), ==, 0);
  int directory = open(folder, O_PATH | O_DIRECTORY);
  int file = spore_open_beneath_walking(directory, "./sub//inside", O_RDONLY, 0);
  g_assert_cmpint(file, >=, 0);
  close(file);
  const struct {
    const char *path;
    int fault;
  } refused[] = {{"../x", EXDEV}, {"sub/../../x", EXDEV},   {"/etc/passwd", EXDEV},
                 {"link", ELOOP}, {"link/inside", ENOTDIR}, {"sub/missing", ENOENT},
                 {"", ENOENT}};
  for (guint i = 0; i < G_N_ELEMENTS(refused); i++) {
    g_assert_cmpint(spore_open_beneath_walking(directory, refused[i].path, O_RDONLY, 0), ==, -1);
    g_assert_cmpint(errno, ==, refused[i].fault);
  }
  close(directory);
  fixture_folder_free(folder);
}

static void test_no_folder(void) {
  SporeDocument *document =
      fixture_parse("<spore version=\"1.0\"><assets><spheres name=\"s\" file=\"f\"/></assets></spore>");
  GError *error = NULL;
  g_assert_null(spore_document_spheres(document, spore_document_by_path(document, "assets/s"), &error));
  fixture_assert_error(error, SPORE_ERROR_FILE, "save the scene first");
  spore_document_free(document);
}

static void test_too_large(void) {
  char *folder = fixture_folder_new();
  g_autofree char *path = fixture_write(folder, "large", "");
  g_assert_cmpint(truncate(path, ((off_t)1 << 30) + 1), ==, 0); /* a hole: takes no room */
  refuse(folder, "large", "over 1 GiB");
  fixture_folder_free(folder);
}

static void test_cache(void) {
  char *folder = fixture_folder_new();
  g_free(fixture_write(folder, "a", "abc"));
  SporeDocument *document = load(folder, "a");
  SporeObject *asset = spore_document_by_path(document, "assets/s");
  GError *error = NULL;
  const SporeSphereSet *first = spore_document_spheres(document, asset, &error);
  g_assert_cmpuint(first->count, ==, 3);
  g_assert_true(spore_document_spheres(document, asset, &error) == first);
  g_autofree char *hash = spore_document_asset_hash(document, asset);
  g_assert_cmpuint(strlen(hash), ==, 16);
  g_assert_cmpint(decoded, ==, 1);
  g_autoptr(GBytes) same = g_bytes_new_static("abc", 3), other = g_bytes_new_static("abcd", 4),
                    broken = g_bytes_new_static("!", 1);
  spore_document_put_blob(document, "a", same);
  g_assert_true(spore_document_spheres(document, asset, &error) == first); /* another place, the same content */
  g_assert_cmpint(decoded, ==, 1);
  spore_document_put_blob(document, "a", other);
  g_assert_cmpuint(spore_document_spheres(document, asset, &error)->count, ==, 4);
  g_autofree char *other_hash = spore_document_asset_hash(document, asset);
  g_assert_cmpstr(hash, !=, other_hash);
  g_assert_cmpuint(first->count, ==, 3); /* what was given out stays valid */
  spore_document_put_blob(document, "a", broken);
  decoded = 0;
  for (int i = 0; i < 3; i++) {
    g_assert_null(spore_document_spheres(document, asset, &error));
    fixture_assert_error(error, SPORE_ERROR_INPUT, "bad content");
  }
  g_assert_cmpint(decoded, ==, 1); /* not tried again and again */
  spore_document_free(document);
  fixture_folder_free(folder);
}

/* A copy for another thread shares what is decoded and waits, and goes its own way from there. */
static void test_copy(void) {
  GError *error = NULL;
  char *folder = fixture_scene_folder_new(
      "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets></spore>");
  SporeDocument *document = fixture_load(folder);
  SporeObject *assets = spore_document_section(document, "assets");
  SporeObject *ball = spore_document_insert(document, assets, "spheres", "ball", G_MAXUINT, &error);
  spore_document_set_text(document, ball, "file", "one.spheres", &error);
  g_autoptr(GBytes) content = g_bytes_new_static("0 0 0 1\n", 8);
  spore_document_put_blob(document, "one.spheres", content);
  const SporeTriangleMesh *mesh = spore_document_mesh(document, spore_object_child(assets, 0), &error);
  g_assert_no_error(error);
  SporeDocument *copy = spore_document_copy(document);
  g_autofree char *text = fixture_format(document), *copied = fixture_format(copy);
  g_assert_cmpstr(text, ==, copied);
  g_assert_cmpuint(spore_object_id(spore_document_by_path(copy, "assets/ball")), ==, spore_object_id(ball));
  g_assert_false(spore_document_can_undo(copy));
  SporeObject *cube = spore_document_by_path(copy, "assets/cube");
  g_assert_true(spore_document_mesh(copy, cube, &error) == mesh);
  g_autofree char *where = spore_object_where(cube), *before = spore_object_where(spore_object_child(assets, 0));
  g_assert_cmpstr(where, ==, before);
  SporeObject *more = spore_document_insert(copy, spore_document_section(copy, "assets"), "mesh", "more", 0, &error);
  g_assert_null(spore_document_by_id(document, spore_object_id(more)));
  spore_document_remove(document, ball, &error);
  spore_document_free(document);
  g_assert_cmpuint(mesh->triangle_count, ==, 12);
  g_assert_cmpuint(spore_document_spheres(copy, spore_document_by_path(copy, "assets/ball"), &error)->count, ==, 1);
  g_assert_no_error(error);
  spore_document_free(copy);
  fixture_folder_free(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/asset/missing-and-irregular", test_missing_and_irregular);
  g_test_add_func("/asset/links", test_links);
  g_test_add_func("/asset/walking", test_walking);
  g_test_add_func("/asset/no-folder", test_no_folder);
  g_test_add_func("/asset/too-large", test_too_large);
  g_test_add_func("/asset/cache", test_cache);
  g_test_add_func("/asset/copy", test_copy);
  return g_test_run();
}
