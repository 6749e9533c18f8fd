/* Attempts at the exercise of a scene, as lines of a file. */
#include "ui/document/attempts.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"
#include "core/scene/error.h"
#include "ui/document/scene-place.h"

#define FOLDER_MODE 0700
#define FILE_MODE 0600
#define CELLS 6

SporeAttempt spore_attempt_of(const SporeExerciseState *state) {
  return (SporeAttempt){.when = g_get_real_time() / G_USEC_PER_SEC,
                        .steps = state->steps,
                        .steps_done = state->steps_done,
                        .time_s = state->time_s,
                        .score = state->score,
                        .passed = state->passed};
}

static char *place_of(const char *scene, const char *extension) {
  return spore_scene_place(scene, "attempts", extension);
}

static char *file_of(const char *scene) { return place_of(scene, ".csv"); }

static char *line_of(const SporeAttempt *attempt) {
  g_autoptr(GDateTime) when = g_date_time_new_from_unix_utc(attempt->when);
  g_autofree char *date = g_date_time_format_iso8601(when);
  char time_s[SPORE_NUMBER_TEXT], score[SPORE_NUMBER_TEXT];
  spore_number_format(attempt->time_s, time_s);
  spore_number_format(attempt->score, score);
  return g_strdup_printf("%s,%llu,%llu,%s,%s,%s\n", date, (unsigned long long)attempt->steps,
                         (unsigned long long)attempt->steps_done, time_s, score, attempt->passed ? "pass" : "fail");
}

static gboolean read_number(const char *text, double *number) {
  gsize length = spore_number_read(text, strlen(text), number);
  return length > 0 && text[length] == '\0' && isfinite(*number);
}

static gboolean read_line(const char *line, SporeAttempt *attempt) {
  g_auto(GStrv) cells = g_strsplit(line, ",", -1);
  if (g_strv_length(cells) != CELLS) return FALSE;
  g_autoptr(GTimeZone) utc = g_time_zone_new_utc();
  g_autoptr(GDateTime) when = g_date_time_new_from_iso8601(cells[0], utc);
  attempt->when = when ? g_date_time_to_unix(when) : 0;
  attempt->passed = g_str_equal(cells[5], "pass");
  return when && g_ascii_string_to_unsigned(cells[1], 10, 0, G_MAXUINT32, &attempt->steps, NULL) &&
         g_ascii_string_to_unsigned(cells[2], 10, 0, attempt->steps, &attempt->steps_done, NULL) &&
         read_number(cells[3], &attempt->time_s) && read_number(cells[4], &attempt->score) &&
         (attempt->passed || g_str_equal(cells[5], "fail"));
}

GArray *spore_attempts_read(const char *scene) {
  GArray *attempts = g_array_new(FALSE, FALSE, sizeof(SporeAttempt));
  g_autofree char *file = scene ? file_of(scene) : NULL, *text = NULL;
  if (!file || !g_file_get_contents(file, &text, NULL, NULL)) return attempts;
  g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
  for (char **line = lines; *line; line++) {
    SporeAttempt attempt;
    if (read_line(*line, &attempt)) g_array_append_val(attempts, attempt);
  }
  return attempts;
}

static gboolean fail(const char *file, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_FILE, file, _("the attempt could not be kept: %s"), g_strerror(errno));
}

/* A line that was cut off ends here. */
static gboolean needs_end(int descriptor) {
  char last = '\n';
  off_t size = lseek(descriptor, 0, SEEK_END);
  return size > 0 && pread(descriptor, &last, 1, size - 1) == 1 && last != '\n';
}

gboolean spore_attempts_add(const char *scene, const SporeAttempt *attempt, GError **error) {
  g_autofree char *file = file_of(scene), *folder = g_path_get_dirname(file), *line = line_of(attempt);
  if (g_mkdir_with_parents(folder, FOLDER_MODE) != 0) return fail(folder, error);
  int descriptor = open(file, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, FILE_MODE);
  if (descriptor < 0) return fail(file, error);
  g_autofree char *text = g_strconcat(needs_end(descriptor) ? "\n" : "", line, NULL);
  gssize size = (gssize)strlen(text), written = write(descriptor, text, strlen(text));
  gboolean whole = written == size || fail(file, error);
  close(descriptor);
  return whole;
}

/* Input. */

char *spore_attempts_track_file(const char *scene, const SporeAttempt *attempt) {
  g_autofree char *folder = place_of(scene, ""), *name = g_strdup_printf("%lld.track", (long long)attempt->when);
  return g_build_filename(folder, name, NULL);
}

SporeTrack *spore_attempts_read_track(const char *file, GError **error) {
  g_autofree char *text = NULL;
  gsize size;
  g_autoptr(GError) cause = NULL;
  if (!g_file_get_contents(file, &text, &size, &cause)) {
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("the recorded input cannot be read: %s"), cause->message);
    return NULL;
  }
  SporeError fault = SPORE_ERROR_INIT;
  SporeTrack *track = g_new0(SporeTrack, 1);
  if (spore_track_parse(track, file, text, size, &fault)) return track;
  spore_error_propagate(&fault, error);
  g_free(track);
  return NULL;
}

static int by_time(gconstpointer one, gconstpointer other) {
  gint64 a = g_ascii_strtoll(*(const char *const *)one, NULL, 10),
         b = g_ascii_strtoll(*(const char *const *)other, NULL, 10);
  return (a > b) - (a < b);
}

/* Takes away the oldest, so that one more has room. */
static void make_room(const char *folder) {
  g_autoptr(GDir) entries = g_dir_open(folder, 0, NULL);
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  for (const char *name; entries && (name = g_dir_read_name(entries));)
    if (g_str_has_suffix(name, ".track")) g_ptr_array_add(names, g_strdup(name));
  g_ptr_array_sort(names, by_time);
  for (guint i = 0; i + SPORE_ATTEMPTS_WITH_TRACKS <= names->len; i++) {
    g_autofree char *file = g_build_filename(folder, names->pdata[i], NULL);
    g_unlink(file);
  }
}

gboolean spore_attempts_add_track(const char *scene, const SporeAttempt *attempt, const SporeTrack *input,
                                  GError **error) {
  g_autofree char *file = spore_attempts_track_file(scene, attempt), *folder = g_path_get_dirname(file);
  gsize size;
  if (g_mkdir_with_parents(folder, FOLDER_MODE) != 0) return fail(folder, error);
  char *text = spore_track_format(input, &size);
  if (!text)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, file, "%s",
                             _("not enough memory for the recorded input; close something or shorten it"));
  make_room(folder);
  gboolean written = spore_write_file(file, text, size, error);
  spore_free(text);
  return written;
}
