/* Attempts at an exercise are kept beside each other, one file for each scene, and nothing that is there is lost. */
#include <glib/gstdio.h>
#include <string.h>

#include "core/scene/error.h"
#include "ui/document/attempts.h"

static const SporeAttempt first = {1700000000, 5, 5, 8.125, 1.0 / 3, TRUE}, second = {1700000060, 5, 2, 600, 0, FALSE};

static void add(const char *scene, const SporeAttempt *attempt) {
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_attempts_add(scene, attempt, &error));
  g_assert_no_error(error);
}

static void assert_same(const GArray *attempts, guint index, const SporeAttempt *expected) {
  const SporeAttempt *found = &g_array_index(attempts, SporeAttempt, index);
  g_assert_cmpint(found->when, ==, expected->when);
  g_assert_cmpuint(found->steps, ==, expected->steps);
  g_assert_cmpuint(found->steps_done, ==, expected->steps_done);
  g_assert_cmpfloat(found->time_s, ==, expected->time_s);
  g_assert_cmpfloat(found->score, ==, expected->score);
  g_assert_cmpint(found->passed, ==, expected->passed);
}

static guint count(const char *scene) {
  g_autoptr(GArray) attempts = spore_attempts_read(scene);
  return attempts->len;
}

static char *folder(void) { return g_build_filename(g_get_user_data_dir(), "spore", "attempts", NULL); }

/* The one file in the folder. g_free. */
static char *only_file(void) {
  g_autofree char *path = folder();
  g_autoptr(GDir) entries = g_dir_open(path, 0, NULL);
  char *file = g_build_filename(path, g_dir_read_name(entries), NULL);
  g_assert_null(g_dir_read_name(entries));
  return file;
}

static void remove_whole(const char *path) {
  g_autoptr(GDir) entries = g_dir_open(path, 0, NULL);
  for (const char *name; entries && (name = g_dir_read_name(entries));) {
    g_autofree char *file = g_build_filename(path, name, NULL);
    remove_whole(file);
  }
  g_remove(path);
}

static void forget(void) {
  g_autofree char *path = folder();
  g_autoptr(GDir) entries = g_dir_open(path, 0, NULL);
  for (const char *name; entries && (name = g_dir_read_name(entries));) {
    g_autofree char *file = g_build_filename(path, name, NULL);
    g_remove(file);
  }
}

static void test_kept(void) {
  add("/a/scene.spore", &first);
  add("/a/b/../scene.spore", &second);
  g_autoptr(GArray) attempts = spore_attempts_read("/a/scene.spore");
  g_assert_cmpuint(attempts->len, ==, 2);
  assert_same(attempts, 0, &first);
  assert_same(attempts, 1, &second);
  g_assert_cmpuint(count("/b/scene.spore"), ==, 0);
  g_assert_cmpuint(count(NULL), ==, 0);
  forget();
}

/* A line that was cut off, and lines of others, cost themselves alone. */
static void test_damaged(void) {
  add("scene.spore", &first);
  g_autofree char *file = only_file(), *text = NULL;
  g_assert_true(g_file_get_contents(file, &text, NULL, NULL));
  g_autofree char *more =
      g_strconcat(text, "2023-11-14T22:13:20Z,5,6,1,1,pass\n", "2023-11-14T22:13:20Z,5,5,nan,1,pass\n",
                  "2023-11-14T22:13:20Z,5,5,1,1,perhaps\n,,,,,\n\xff\n2023-11-14T22:13", NULL);
  g_assert_true(g_file_set_contents(file, more, -1, NULL));
  g_assert_cmpuint(count("scene.spore"), ==, 1);
  add("scene.spore", &second);
  g_autoptr(GArray) attempts = spore_attempts_read("scene.spore");
  g_assert_cmpuint(attempts->len, ==, 2);
  assert_same(attempts, 1, &second);
  forget();
}

/* A file in the place of the folder. */
static void test_no_room(void) {
  g_autofree char *path = folder();
  GError *error = NULL;
  g_rmdir(path);
  g_assert_true(g_file_set_contents(path, "", 0, NULL));
  g_assert_false(spore_attempts_add("scene.spore", &first, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_FILE);
  g_assert_nonnull(strstr(error->message, "could not be kept"));
  g_clear_error(&error);
  g_remove(path);
}

static guint count_tracks(const char *scene, gint64 first_when, guint attempts) {
  guint there = 0;
  for (guint i = 0; i < attempts; i++) {
    const SporeAttempt attempt = {.when = first_when + i};
    g_autofree char *file = spore_attempts_track_file(scene, &attempt);
    there += g_file_test(file, G_FILE_TEST_IS_REGULAR);
  }
  return there;
}

/* What was recorded comes back; of the newest attempts alone; and those of another scene stay. */
static void test_tracks(void) {
  enum { MORE = 3, ATTEMPTS = SPORE_ATTEMPTS_WITH_TRACKS + MORE, WHEN = 999999990 }; /* 9 digits, then 10 */
  const SporeDeviceState state = {.position = {1, 2, 3}, .orientation = {1, 0, 0, 0}};
  SporeTrack track = {0}, read = {0};
  g_autoptr(GError) error = NULL;
  spore_track_append(spore_track_add_channel(&track, "rod"), 0.25, &state);
  const SporeAttempt other = {.when = 5};
  g_assert_true(spore_attempts_add_track("/other.spore", &other, &track, &error));
  for (guint i = 0; i < ATTEMPTS; i++) {
    const SporeAttempt attempt = {.when = WHEN + i};
    g_assert_true(spore_attempts_add_track("/scene.spore", &attempt, &track, &error));
  }
  g_assert_no_error(error);
  g_assert_cmpuint(count_tracks("/scene.spore", WHEN, MORE), ==, 0);
  g_assert_cmpuint(count_tracks("/scene.spore", WHEN, ATTEMPTS), ==, SPORE_ATTEMPTS_WITH_TRACKS);
  g_autofree char *file = spore_attempts_track_file("/other.spore", &other), *text = NULL;
  gsize size;
  SporeError fault = SPORE_ERROR_INIT;
  g_assert_true(g_file_get_contents(file, &text, &size, NULL));
  g_assert_true(spore_track_parse(&read, file, text, size, &fault));
  g_assert_cmpfloat(spore_track_channel(&read, "rod")->states[0].position[2], ==, 3);
  spore_track_clear(&read);
  spore_track_clear(&track);
}

int main(int argc, char **argv) {
  g_autofree char *data = g_dir_make_tmp("spore-attempts-XXXXXX", NULL);
  g_setenv("XDG_DATA_HOME", data, TRUE); /* before GLib reads it */
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/attempts/kept", test_kept);
  g_test_add_func("/attempts/damaged", test_damaged);
  g_test_add_func("/attempts/no_room", test_no_room);
  g_test_add_func("/attempts/tracks", test_tracks);
  int status = g_test_run();
  remove_whole(data);
  return status;
}
