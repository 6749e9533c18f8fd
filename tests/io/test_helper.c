/* Helpers: whatever the child does, the parent ends with an answer or a clear message, and nothing of the child stays.
 */
#include <errno.h>
#include <string.h>
#include <sys/wait.h>

#include "core/base/profile.h"
#include "core/io/helper.h"

#define PROBE "helper_probe"

static const SporeHelperLimits usual = {.time_s = 60, .memory = (guint64)2 << 30, .output = 64 << 20};

static guint open_files(void) {
  guint count = 0;
  GDir *folder = g_dir_open("/proc/self/fd", 0, NULL);
  while (g_dir_read_name(folder)) count++;
  g_dir_close(folder);
  return count;
}

/* The answer as text, or NULL with *message. g_free both. */
static char *ask_within(const char *request, const SporeHelperLimits *limits, const SporeProgress *progress, int *code,
                        char **message) {
  GBytes *bytes = g_bytes_new(request, strlen(request));
  GError *error = NULL;
  guint files = open_files();
  GBytes *answer = spore_helper_run(PROBE, "organ.stl", bytes, limits, progress, &error);
  g_bytes_unref(bytes);
  g_assert_cmpuint(open_files(), ==, files);
  g_assert_true(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD); /* nothing runs on, nothing is left to reap */
  *message = NULL;
  if (!answer) {
    g_assert_nonnull(error);
    g_assert_true(error->domain == SPORE_ERROR);
    *code = error->code;
    *message = g_strdup(error->message);
    g_error_free(error);
    return NULL;
  }
  g_assert_no_error(error);
  char *text = g_strndup(g_bytes_get_data(answer, NULL), g_bytes_get_size(answer));
  g_bytes_unref(answer);
  return text;
}

static void check_fails(const char *request, const SporeHelperLimits *limits, const SporeProgress *progress, int code,
                        const char *words) {
  char *message;
  int got = 0;
  char *answer = ask_within(request, limits, progress, &got, &message);
  g_assert_null(answer);
  g_assert_nonnull(strstr(message, words));
  g_assert_true(g_str_has_prefix(message, "organ.stl: "));
  g_assert_null(strchr(message, '\n'));
  g_assert_cmpint(got, ==, code);
  g_free(message);
}

static char *ask(const char *request) {
  char *message;
  int code = 0;
  char *answer = ask_within(request, &usual, NULL, &code, &message);
  g_assert_cmpstr(message, ==, NULL);
  return answer;
}

static void test_echo(void) {
  char *answer = ask("echo and more");
  g_assert_cmpstr(answer, ==, "echo and more");
  g_free(answer);
}

/* More than any pipe holds, both ways. */
static void test_large_request(void) {
  gsize size = 20 << 20;
  char *content = g_malloc(size);
  for (gsize i = 0; i < size; i++) content[i] = (char)(i * 2654435761u >> 13);
  memcpy(content, "echo", 4);
  GBytes *request = g_bytes_new_take(content, size);
  GError *error = NULL;
  GBytes *answer = spore_helper_run(PROBE, NULL, request, &usual, NULL, &error);
  g_assert_no_error(error);
  g_assert_true(g_bytes_equal(answer, request));
  g_bytes_unref(answer);
  g_bytes_unref(request);
}

static void test_chatter(void) {
  char *answer = ask("chatter");
  g_assert_cmpstr(answer, ==, "chatter");
  g_free(answer);
}

typedef struct {
  guint calls, staged;
  double last;
  gboolean falls;
  guint cancel_at; /* call number; 0: never */
} Watch;

static bool watch(void *data, double fraction, const char *stage) {
  Watch *seen = data;
  seen->calls++;
  if (fraction < seen->last || fraction > 1 || !(fraction >= 0)) seen->falls = TRUE;
  seen->last = fraction;
  if (stage && strcmp(stage, "stirring") == 0) seen->staged++;
  return seen->calls != seen->cancel_at;
}

static void test_progress(void) {
  Watch seen = {0};
  SporeProgress progress = {watch, &seen};
  char *message;
  int code = 0;
  char *answer = ask_within("progress", &usual, &progress, &code, &message);
  g_assert_cmpstr(answer, ==, "progress");
  g_assert_cmpuint(seen.staged, >, 1);
  g_assert_false(seen.falls);
  g_free(answer);
}

static void test_strange_progress(void) {
  Watch seen = {0};
  SporeProgress progress = {watch, &seen};
  char *message;
  int code = 0;
  char *answer = ask_within("strange", &usual, &progress, &code, &message);
  g_assert_cmpstr(answer, ==, "strange");
  g_assert_false(seen.falls); /* a fraction that is no number is passed over */
  g_free(answer);
}

static void test_error(void) {
  check_fails("error", &usual, NULL, SPORE_ERROR_INPUT, "it is wrong; expected right (line 7)");
}

static void test_crash(void) { check_fails("crash", &usual, NULL, SPORE_ERROR_INPUT, "crashed"); }

static void test_leave(void) {
  check_fails("leave", &usual, NULL, SPORE_ERROR_INPUT, "ended without an answer (status 7)");
}

static void test_hang(void) {
  SporeHelperLimits limits = usual;
  limits.time_s = 0.3;
  check_fails("hang", &limits, NULL, SPORE_ERROR_INPUT, "longer than 0.3 s");
}

static void test_quiet(void) { check_fails("quiet", &usual, NULL, SPORE_ERROR_INPUT, "helper " PROBE " crashed"); }

static void test_flood(void) {
  SporeHelperLimits limits = usual;
  limits.time_s = 0.3;
  check_fails("flood", &limits, NULL, SPORE_ERROR_INPUT, "longer than 0.3 s");
}

static void test_too_large(void) {
  SporeHelperLimits limits = usual;
  limits.output = 1 << 20;
  check_fails("large", &limits, NULL, SPORE_ERROR_INPUT, "2097152 bytes; expected at most 1048576");
}

static void test_lies(void) {
  check_fails("garbage", &usual, NULL, SPORE_ERROR_INTERNAL, "wrong answer");
  check_fails("short", &usual, NULL, SPORE_ERROR_INPUT, "without an answer");
  check_fails("stage", &usual, NULL, SPORE_ERROR_INPUT, "18446744073709551615 bytes");
}

/* The child would run for a minute; cancelling must not wait for it. */
static void test_cancel(void) {
  Watch seen = {.cancel_at = 3};
  SporeProgress progress = {watch, &seen};
  guint64 started = spore_clock_ns();
  check_fails("hang", &usual, &progress, SPORE_ERROR_CANCELLED, "cancelled");
  g_assert_cmpuint(seen.calls, ==, 3);
  g_assert_cmpuint(spore_clock_ns() - started, <, (guint64)10 * 1000000000);
}

static void test_forbidden(void) {
  char *answer = ask("forbidden");
  char **lines = g_strsplit(g_strstrip(answer), "\n", -1);
  g_assert_cmpuint(g_strv_length(lines), ==, 12);
  for (char **line = lines; *line; line++) {
    int number = atoi(strrchr(*line, ':') + 1);
    g_test_message("%s", *line);
    g_assert_true(number == EPERM || number == EACCES || number == EAGAIN || number == EMFILE);
  }
  g_strfreev(lines);
  g_free(answer);
}

static void test_memory(void) {
#ifdef __SANITIZE_ADDRESS__
  g_test_skip("the sanitizer needs all of the address space");
#else
  SporeHelperLimits limits = usual;
  limits.memory = (guint64)1 << 30;
  char *message;
  int code = 0;
  char *answer = ask_within("memory", &limits, NULL, &code, &message);
  g_assert_cmpstr(answer, ==, "refused");
  g_free(answer);
#endif
}

static void test_missing(void) {
  GBytes *request = g_bytes_new_static("echo", 4);
  GError *error = NULL;
  g_assert_null(spore_helper_run("spore-nothing", "organ.stl", request, &usual, NULL, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_UNSUPPORTED);
  g_assert_nonnull(strstr(error->message, "spore-nothing is missing"));
  g_error_free(error);
  g_bytes_unref(request);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/helper/echo", test_echo);
  g_test_add_func("/helper/large-request", test_large_request);
  g_test_add_func("/helper/chatter", test_chatter);
  g_test_add_func("/helper/progress", test_progress);
  g_test_add_func("/helper/strange-progress", test_strange_progress);
  g_test_add_func("/helper/error", test_error);
  g_test_add_func("/helper/crash", test_crash);
  g_test_add_func("/helper/leave", test_leave);
  g_test_add_func("/helper/hang", test_hang);
  g_test_add_func("/helper/quiet", test_quiet);
  g_test_add_func("/helper/flood", test_flood);
  g_test_add_func("/helper/too-large", test_too_large);
  g_test_add_func("/helper/lies", test_lies);
  g_test_add_func("/helper/cancel", test_cancel);
  g_test_add_func("/helper/forbidden", test_forbidden);
  g_test_add_func("/helper/memory", test_memory);
  g_test_add_func("/helper/missing", test_missing);
  return g_test_run();
}
