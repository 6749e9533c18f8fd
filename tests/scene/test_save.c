/* Saving: all files or none, and the document as before when it fails. */
#include <errno.h>
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fixture.h"

/* A scene with one mesh that waits as a blob of `size` bytes. */
static SporeDocument *scene_with_blob(gsize size) {
  SporeDocument *document = spore_document_new(fixture_schema());
  GError *error = NULL;
  SporeObject *assets = spore_document_section(document, "assets");
  SporeObject *mesh = spore_document_insert(document, assets, "mesh", "liver", 0, &error);
  spore_document_set_text(document, mesh, "file", "meshes/liver.off", &error);
  g_assert_no_error(error);
  char *content = g_malloc(size + 1);
  memset(content, 'x', size);
  g_autoptr(GBytes) bytes = g_bytes_new_take(content, size);
  spore_document_put_blob(document, "meshes/liver.off", bytes);
  spore_document_put_blob(document, "unused.off", bytes);
  return document;
}

static void save(SporeDocument *document, const char *folder, const char *name) {
  GError *error = NULL;
  g_autofree char *file = g_build_filename(folder, name, NULL);
  spore_scene_save(document, file, &error);
  g_assert_no_error(error);
}

static void fail_to_save(SporeDocument *document, const char *folder, const char *name, const char *says) {
  GError *error = NULL;
  g_autofree char *file = g_build_filename(folder, name, NULL);
  g_autofree char *before = fixture_format(document);
  gboolean modified = spore_document_is_modified(document);
  g_autofree char *old_file = g_strdup(spore_document_file(document));
  g_assert_false(spore_scene_save(document, file, &error));
  g_test_message("%s", error->message);
  g_assert_cmpint(spore_error_exit_status(error), ==, 2);
  fixture_assert_error(error, error->code, says);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
  g_assert_cmpstr(spore_document_file(document), ==, old_file);
  g_assert_cmpint(spore_document_is_modified(document), ==, modified);
}

static void assert_list(const char *folder, const char *names) {
  g_autofree char *list = fixture_list(folder);
  g_assert_cmpstr(list, ==, names);
}

static void test_first_save(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  g_assert_true(spore_document_is_modified(document));
  save(document, folder, "a.spore");
  g_assert_false(spore_document_is_modified(document));
  assert_list(folder, "a.spore meshes");
  g_autofree char *mesh = fixture_read(folder, "meshes/liver.off");
  g_assert_cmpstr(mesh, ==, "xxxxxxxxxx");
  g_autofree char *text = fixture_read(folder, "a.spore");
  g_autofree char *formatted = fixture_format(document);
  g_assert_cmpstr(text, ==, formatted);
  SporeObject *object = spore_document_by_path(document, "assets/liver");
  g_assert_cmpint(spore_object_line(object), ==, 4);
  g_assert_cmpint(spore_object_column(object), ==, 5);
  GError *error = NULL;
  g_autoptr(GBytes) content = spore_document_read_asset(document, "meshes/liver.off", &error);
  g_assert_no_error(error);
  g_assert_cmpuint(g_bytes_get_size(content), ==, 10);
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_places_are_those_of_the_file(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = fixture_parse("<!-- two\n     lines -->\n<spore version=\"1.0\"><bodies>\n\n<!-- c -->\n"
                                          "<body name=\"a\"\nrole=\"active\"><visual/></body></bodies></spore>");
  save(document, folder, "a.spore");
  g_autofree char *file = g_build_filename(folder, "a.spore", NULL);
  SporeDocument *again = spore_scene_load(fixture_schema(), file, NULL);
  const char *const paths[] = {"spore", "bodies", "bodies/a", "bodies/a/visual"};
  for (guint i = 0; i < G_N_ELEMENTS(paths); i++) {
    SporeObject *one = spore_document_by_path(document, paths[i]), *other = spore_document_by_path(again, paths[i]);
    g_assert_cmpint(spore_object_line(one), ==, spore_object_line(other));
    g_assert_cmpint(spore_object_column(one), ==, spore_object_column(other));
  }
  spore_document_free(document);
  spore_document_free(again);
  fixture_folder_free(folder);
}

static void test_keeps_permissions_and_links(void) {
  char *folder = fixture_folder_new();
  g_autofree char *real = fixture_write(folder, "real.spore", "old");
  g_autofree char *link = g_build_filename(folder, "link.spore", NULL);
  g_assert_cmpint(g_chmod(real, 0640), ==, 0);
  g_assert_cmpint(symlink("real.spore", link), ==, 0);
  SporeDocument *document = spore_document_new(fixture_schema());
  save(document, folder, "link.spore");
  struct stat status;
  g_assert_cmpint(lstat(link, &status), ==, 0);
  g_assert_true(S_ISLNK(status.st_mode));
  g_assert_cmpint(stat(real, &status), ==, 0);
  g_assert_cmpint(status.st_mode & 0777, ==, 0640);
  g_assert_cmpint(status.st_size, >, 10);
  assert_list(folder, "link.spore real.spore");
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_save_elsewhere_copies_assets(void) {
  char *folder = fixture_folder_new(), *other = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  save(document, other, "b.spore");
  g_autofree char *mesh = fixture_read(other, "meshes/liver.off");
  g_assert_cmpstr(mesh, ==, "xxxxxxxxxx");
  assert_list(other, "b.spore meshes");
  save(document, folder, "a.spore"); /* the same content is there: nothing stands in the way */
  g_free(fixture_write(other, "meshes/liver.off", "somebody else's"));
  fail_to_save(document, other, "b.spore", "there already, with other content");
  g_autofree char *kept = fixture_read(other, "meshes/liver.off");
  g_assert_cmpstr(kept, ==, "somebody else's");
  spore_document_free(document);
  fixture_folder_free(folder);
  fixture_folder_free(other);
}

/* What history alone names goes along to another folder: taken back before, or replaced by another file. */
static void test_save_elsewhere_keeps_history(void) {
  char *folder = fixture_folder_new(), *other = fixture_folder_new(), *third = fixture_folder_new();
  GError *error = NULL;
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  g_autoptr(GBytes) newer = g_bytes_new_static("newer", 5);
  spore_document_put_blob(document, "newer.off", newer);
  spore_document_set_text(document, spore_document_by_path(document, "assets/liver"), "file", "newer.off", &error);
  g_assert_no_error(error);
  save(document, folder, "a.spore");
  for (int i = 0; i < 3; i++) spore_document_undo(document); /* the second file, the first, the mesh */
  g_assert_null(spore_document_by_path(document, "assets/liver"));
  save(document, other, "b.spore");
  assert_list(other, "b.spore");
  g_free(fixture_write(folder, "meshes/liver.off", "changed there since"));
  spore_document_redo(document);
  spore_document_redo(document);
  save(document, other, "b.spore");
  g_autofree char *mesh = fixture_read(other, "meshes/liver.off");
  g_assert_cmpstr(mesh, ==, "xxxxxxxxxx");
  spore_document_redo(document);
  save(document, third, "c.spore");
  assert_list(third, "c.spore newer.off");
  spore_document_undo(document);
  save(document, third, "c.spore");
  assert_list(third, "c.spore meshes newer.off");
  spore_document_free(document);
  fixture_folder_free(folder);
  fixture_folder_free(other);
  fixture_folder_free(third);
}

static void test_changed_blob_replaces(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  g_autoptr(GBytes) content = g_bytes_new_static("new", 3);
  spore_document_put_blob(document, "meshes/liver.off", content);
  save(document, folder, "a.spore");
  g_autofree char *mesh = fixture_read(folder, "meshes/liver.off");
  g_assert_cmpstr(mesh, ==, "new");
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_missing_folder_and_directory_target(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  fail_to_save(document, folder, "missing/a.spore", "missing");
  assert_list(folder, "");
  g_free(fixture_write(folder, "a.spore/inside", ""));
  fail_to_save(document, folder, "a.spore", "Is a directory");
  assert_list(folder, "a.spore"); /* the folder of the mesh is gone again */
  g_free(fixture_write(folder, "meshes", "a file where a folder should be"));
  fail_to_save(document, folder, "b.spore", "meshes/liver.off");
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_unset_required(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = spore_document_new(fixture_schema());
  spore_document_insert(document, spore_document_section(document, "assets"), "mesh", "m", 0, NULL);
  fail_to_save(document, folder, "a.spore", "assets/m: file is not set");
  assert_list(folder, "");
  spore_document_free(document);
  fixture_folder_free(folder);
}

/* No byte beyond the limit can be written: as on a full disk. */
static void test_no_room(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  g_autofree char *before = fixture_read(folder, "a.spore");
  char *large = g_malloc(100000);
  memset(large, 'y', 100000);
  g_autoptr(GBytes) content = g_bytes_new_take(large, 100000);
  spore_document_put_blob(document, "meshes/liver.off", content);
  GError *error = NULL;
  SporeObject *body =
      spore_document_insert(document, spore_document_section(document, "bodies"), "body", "x", 0, &error);
  g_assert_nonnull(body);
  struct rlimit old, tight = {.rlim_cur = 4096};
  getrlimit(RLIMIT_FSIZE, &old);
  tight.rlim_max = old.rlim_max;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  fail_to_save(document, folder, "a.spore", "nothing was changed; free some space");
  setrlimit(RLIMIT_FSIZE, &old);
  g_autofree char *after = fixture_read(folder, "a.spore"), *mesh = fixture_read(folder, "meshes/liver.off");
  g_assert_cmpstr(after, ==, before);
  g_assert_cmpstr(mesh, ==, "xxxxxxxxxx");
  assert_list(folder, "a.spore meshes");
  g_autofree char *meshes = g_build_filename(folder, "meshes", NULL);
  assert_list(meshes, "liver.off");
  save(document, folder, "a.spore"); /* and with room it goes */
  spore_document_free(document);
  fixture_folder_free(folder);
}

/* A real full disk, where one can be made. */
static void test_full_disk(void) {
  char *folder = fixture_folder_new();
  if (mount("none", folder, "tmpfs", 0, "size=64k") != 0) {
    g_test_skip("needs the right to mount a small file system");
    fixture_folder_free(folder);
    return;
  }
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  char *large = g_malloc(100000);
  memset(large, 'y', 100000);
  g_autoptr(GBytes) content = g_bytes_new_take(large, 100000);
  spore_document_put_blob(document, "meshes/liver.off", content);
  fail_to_save(document, folder, "a.spore", "No space left on device");
  fail_to_save(document, folder, "new.spore", "No space left on device");
  assert_list(folder, "a.spore meshes");
  g_autofree char *mesh = fixture_read(folder, "meshes/liver.off");
  g_assert_cmpstr(mesh, ==, "xxxxxxxxxx");
  spore_document_free(document);
  g_assert_cmpint(umount(folder), ==, 0);
  fixture_folder_free(folder);
}

static void test_read_only(void) {
  char *folder = fixture_folder_new();
  SporeDocument *document = scene_with_blob(10);
  save(document, folder, "a.spore");
  if (geteuid() == 0 && mount(folder, folder, NULL, MS_BIND, NULL) == 0) {
    g_assert_cmpint(mount(NULL, folder, NULL, MS_BIND | MS_REMOUNT | MS_RDONLY, NULL), ==, 0);
    fail_to_save(document, folder, "a.spore", "check the permissions");
    g_assert_cmpint(umount(folder), ==, 0);
  } else if (geteuid() != 0) {
    g_chmod(folder, 0500);
    fail_to_save(document, folder, "a.spore", "check the permissions");
    g_chmod(folder, 0700);
  } else {
    g_test_skip("the superuser may write everywhere, and cannot mount here");
  }
  assert_list(folder, "a.spore meshes");
  spore_document_free(document);
  fixture_folder_free(folder);
}

/* The folder of an asset is a link that leads out: nothing is written there. */
static void test_link_out(void) {
  char *folder = fixture_folder_new(), *outside = fixture_folder_new();
  g_autofree char *link = g_build_filename(folder, "meshes", NULL);
  g_assert_cmpint(symlink(outside, link), ==, 0);
  SporeDocument *document = scene_with_blob(10);
  fail_to_save(document, folder, "a.spore", "leads out of the scene's folder");
  assert_list(outside, "");
  assert_list(folder, "meshes");
  spore_document_free(document);
  fixture_folder_free(folder);
  fixture_folder_free(outside);
}

static void test_write_file(void) {
  char *folder = fixture_folder_new();
  g_autofree char *file = fixture_write(folder, "a.txt", "old");
  GError *error = NULL;
  g_assert_true(spore_write_file(file, "new", 3, &error));
  g_autofree char *text = fixture_read(folder, "a.txt");
  g_assert_cmpstr(text, ==, "new");
  g_assert_false(spore_write_file("/proc/self/nothing/here", "new", 3, &error));
  fixture_assert_error(error, SPORE_ERROR_FILE, "/proc/self/nothing/here");
  assert_list(folder, "a.txt");
  fixture_folder_free(folder);
}

/* A device is written to, never replaced by a file. */
static void test_device(void) {
  struct stat before, after;
  GError *error = NULL;
  g_assert_cmpint(stat("/dev/null", &before), ==, 0);
  g_assert_true(spore_write_file("/dev/null", "new", 3, &error));
  g_assert_false(spore_write_file("/dev/full", "new", 3, &error));
  fixture_assert_error(error, SPORE_ERROR_FILE, "No space left on device");
  char *folder = fixture_folder_new();
  g_autofree char *pipe = g_build_filename(folder, "a.spore", NULL);
  g_assert_cmpint(mkfifo(pipe, 0600), ==, 0);
  SporeDocument *document = spore_document_new(fixture_schema());
  fail_to_save(document, folder, "a.spore", "File exists");
  g_assert_cmpint(stat("/dev/null", &after), ==, 0);
  g_assert_true(S_ISCHR(after.st_mode) && after.st_ino == before.st_ino);
  spore_document_free(document);
  fixture_folder_free(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/save/first-save", test_first_save);
  g_test_add_func("/save/places-are-those-of-the-file", test_places_are_those_of_the_file);
  g_test_add_func("/save/keeps-permissions-and-links", test_keeps_permissions_and_links);
  g_test_add_func("/save/elsewhere-copies-assets", test_save_elsewhere_copies_assets);
  g_test_add_func("/save/elsewhere-keeps-history", test_save_elsewhere_keeps_history);
  g_test_add_func("/save/changed-blob-replaces", test_changed_blob_replaces);
  g_test_add_func("/save/missing-folder-and-directory-target", test_missing_folder_and_directory_target);
  g_test_add_func("/save/unset-required", test_unset_required);
  g_test_add_func("/save/no-room", test_no_room);
  g_test_add_func("/save/full-disk", test_full_disk);
  g_test_add_func("/save/read-only", test_read_only);
  g_test_add_func("/save/link-out", test_link_out);
  g_test_add_func("/save/write-file", test_write_file);
  g_test_add_func("/save/device", test_device);
  return g_test_run();
}
