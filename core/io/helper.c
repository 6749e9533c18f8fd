/* The parent's side of helper processes. Nothing that a child sends is trusted: every frame is checked before memory is
 * taken for it. */
#include "core/io/helper.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/io/helper_wire.h"

#define POLL_MS 20         /* time until cancelling is noticed */
#define DEATH_S 1.0        /* time for a child to end after it closed its output */
#define COMPLAINT_KEPT 500 /* bytes of the child's printed text that are kept for the log */

typedef struct {
  const char *program, *place;
  const SporeHelperLimits *limits;
  GError **error;
  pid_t process;
  int request_file, answer_file, complaint_file; /* -1: closed */

  SporeFrame request_head;
  const char *request;
  gsize request_sent; /* bytes, of head and body */

  SporeFrame head; /* of the frame that is coming in */
  gsize head_filled, body_filled;
  char *body;

  double fraction;
  char stage[256];
  char complaint[COMPLAINT_KEPT + 1];
  gsize complaint_filled;
  GBytes *answer;
  gboolean failed; /* *error is set */
} HelperRun;

char *spore_helper_path(const char *program) {
  char *beside = g_file_read_link("/proc/self/exe", NULL);
  char *folder = beside ? g_path_get_dirname(beside) : NULL;
  const char *const folders[] = {g_getenv("SPORE_HELPERS"), folder, SPORE_HELPER_FOLDER};
  char *path = NULL;
  for (gsize i = 0; i < G_N_ELEMENTS(folders) && !path; i++) {
    if (!folders[i] || !*folders[i]) continue;
    path = g_build_filename(folders[i], program, NULL);
    if (access(path, X_OK) != 0) g_clear_pointer(&path, g_free);
  }
  g_free(folder);
  g_free(beside);
  return path;
}

static void close_file(int *file) {
  if (*file >= 0) close(*file);
  *file = -1;
}

static gboolean fail(HelperRun *run, SporeErrorCode code, const char *format, ...) G_GNUC_PRINTF(3, 4);
static gboolean fail(HelperRun *run, SporeErrorCode code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  spore_error_raise(run->error, code, run->place, "%s", message);
  g_free(message);
  run->failed = TRUE;
  return FALSE;
}

/* The child has a process group of its own, so that Ctrl-C reaches the parent alone, and the parent ends the child in
 * order. */
static int spawn(HelperRun *run, const char *path, int request, int answer, int complaint) {
  char memory[32], seconds[32];
  g_snprintf(memory, sizeof memory, "%" G_GUINT64_FORMAT, run->limits->memory);
  g_snprintf(seconds, sizeof seconds, "%.0f", ceil(run->limits->time_s) + 1);
  char *arguments[] = {(char *)path, memory, seconds, NULL};
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  sigaddset(&usual, SIGINT);
  sigaddset(&usual, SIGTERM);
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, request, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, complaint, STDERR_FILENO);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  int status = posix_spawn(&run->process, path, &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return status;
}

static gboolean start(HelperRun *run, const char *path) {
  int request[2] = {-1, -1}, answer[2] = {-1, -1}, complaint[2] = {-1, -1};
  int status = 0;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, request) || pipe2(answer, O_CLOEXEC) ||
      pipe2(complaint, O_CLOEXEC))
    status = errno;
  if (!status) status = spawn(run, path, request[1], answer[1], complaint[1]);
  close_file(&request[1]);
  close_file(&answer[1]);
  close_file(&complaint[1]);
  run->request_file = request[0];
  run->answer_file = answer[0];
  run->complaint_file = complaint[0];
  if (!status) return TRUE;
  return fail(run, SPORE_ERROR_FILE, _("the helper %s does not start (%s); expected a program; install SPORE again"),
              path, g_strerror(status));
}

/* Sends as much of the request as the child accepts now. */
static void send_request(HelperRun *run) {
  gsize head_left = sizeof run->request_head - MIN(run->request_sent, sizeof run->request_head);
  gsize body_sent = run->request_sent - (sizeof run->request_head - head_left);
  const char *from = head_left ? (const char *)&run->request_head + run->request_sent : run->request + body_sent;
  gsize left = head_left ? head_left : (gsize)run->request_head.size - body_sent;
  ssize_t sent = left ? send(run->request_file, from, left, MSG_NOSIGNAL | MSG_DONTWAIT) : 0;
  if (sent < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (sent > 0) run->request_sent += (gsize)sent;
  /* A child that stops reading reports the reason on its own output, or dies. */
  if (sent < 0 || run->request_sent == sizeof run->request_head + run->request_head.size)
    close_file(&run->request_file);
}

/* The child's text as one line of valid UTF-8. g_free. */
static char *clean_text(const char *text, gsize size) {
  char *clean = g_utf8_make_valid(text, (gssize)size);
  for (char *c = clean; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
  return g_strstrip(clean);
}

static void take_progress(HelperRun *run) {
  double fraction;
  if (run->head.size < sizeof fraction) return;
  memcpy(&fraction, run->body, sizeof fraction);
  if (isfinite(fraction)) run->fraction = CLAMP(fraction, 0, 1);
  char *stage = clean_text(run->body + sizeof fraction, run->head.size - sizeof fraction);
  g_strlcpy(run->stage, *stage ? _(stage) : "", sizeof run->stage);
  g_free(stage);
}

static void take_error(HelperRun *run) {
  guint32 code = SPORE_ERROR_INTERNAL;
  if (run->head.size > sizeof code) memcpy(&code, run->body, sizeof code);
  if (code <= SPORE_ERROR_NONE || code > SPORE_ERROR_INTERNAL) code = SPORE_ERROR_INTERNAL;
  gsize text_size = run->head.size - MIN(run->head.size, sizeof code);
  const char *text = run->body + sizeof code;
  gsize message_size = strnlen(text, text_size), rest = text_size - MIN(text_size, message_size + 1);
  char *message = clean_text(text, message_size), *detail = clean_text(rest ? text + message_size + 1 : "", rest);
  if (!*message)
    fail(run, SPORE_ERROR_INTERNAL, _("the helper %s failed and does not say why; check the input, and report this"),
         run->program);
  else if (*detail) fail(run, (SporeErrorCode)code, "%s (%s)", _(message), detail);
  else fail(run, (SporeErrorCode)code, "%s", _(message));
  g_free(message);
  g_free(detail);
}

static void take_frame(HelperRun *run) {
  switch ((SporeFrameType)run->head.type) {
  case SPORE_FRAME_PROGRESS:
    take_progress(run);
    break;
  case SPORE_FRAME_ERROR:
    take_error(run);
    break;
  case SPORE_FRAME_ANSWER:
    run->answer = g_bytes_new_with_free_func(run->body, run->head.size, spore_free, run->body);
    run->body = NULL;
    break;
  case SPORE_FRAME_NOTE: {
    char *note = clean_text(run->body, run->head.size);
    g_debug("%s runs without: %s", run->program, note);
    g_free(note);
    break;
  }
  case SPORE_FRAME_REQUEST:
    break;
  }
  g_clear_pointer(&run->body, spore_free);
  run->head_filled = run->body_filled = 0;
}

/* Checks the head of a frame that has arrived, and takes memory for the body. */
static gboolean open_frame(HelperRun *run) {
  guint64 most = run->head.type == SPORE_FRAME_ANSWER ? run->limits->output : SPORE_FRAME_TEXT;
  if (run->head.magic != SPORE_FRAME_MAGIC || run->head.type <= SPORE_FRAME_REQUEST ||
      run->head.type > SPORE_FRAME_ANSWER)
    return fail(run, SPORE_ERROR_INTERNAL, _("the helper %s gave a wrong answer; check the input, and report this"),
                run->program);
  if (run->head.size > most)
    return fail(run, SPORE_ERROR_INPUT,
                _("the result has %llu bytes; expected at most %llu; give a smaller input or ask for less"),
                (unsigned long long)run->head.size, (unsigned long long)most);
  run->body = SPORE_NEW_ARRAY(char, run->head.size);
  if (!run->body)
    return fail(run, SPORE_ERROR_MEMORY, _("there is not enough memory for the result; close other programs"));
  return TRUE;
}

/* Reads the bytes that have arrived. */
static void receive(HelperRun *run) {
  gboolean in_head = run->head_filled < sizeof run->head;
  char *to = in_head ? (char *)&run->head + run->head_filled : run->body + run->body_filled;
  gsize left = in_head ? sizeof run->head - run->head_filled : run->head.size - run->body_filled;
  ssize_t got = read(run->answer_file, to, left);
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (got <= 0) {
    close_file(&run->answer_file);
    return;
  }
  *(in_head ? &run->head_filled : &run->body_filled) += (gsize)got;
  if (in_head && (run->head_filled < sizeof run->head || !open_frame(run))) return;
  if (run->body_filled == run->head.size) take_frame(run);
}

static void receive_complaint(HelperRun *run) {
  char text[1024];
  ssize_t got = read(run->complaint_file, text, sizeof text);
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (got <= 0) {
    close_file(&run->complaint_file);
    return;
  }
  gsize kept = MIN((gsize)got, COMPLAINT_KEPT - run->complaint_filled);
  memcpy(run->complaint + run->complaint_filled, text, kept);
  run->complaint_filled += kept;
}

/* Waits a short time until the child can be written to or read from, and does so. */
static void converse(HelperRun *run) {
  struct pollfd files[] = {{.fd = run->answer_file, .events = POLLIN},
                           {.fd = run->complaint_file, .events = POLLIN},
                           {.fd = run->request_file, .events = POLLOUT}};
  if (poll(files, G_N_ELEMENTS(files), POLL_MS) <= 0) return;
  if (files[0].revents) receive(run);
  if (files[1].revents) receive_complaint(run);
  if (files[2].revents) send_request(run);
}

static double seconds_since(guint64 start_ns) { return 1e-9 * (double)(spore_clock_ns() - start_ns); }

/* Exchanges data until there is an answer or an error, or the child has closed its output. */
static void attend(HelperRun *run, const SporeProgress *progress) {
  guint64 started = spore_clock_ns(), reported = 0;
  while (!run->answer && !run->failed && run->answer_file >= 0) {
    converse(run);
    if (seconds_since(started) > run->limits->time_s)
      fail(run, SPORE_ERROR_INPUT, _("it took longer than %g s and was stopped; give a smaller or simpler input"),
           run->limits->time_s);
    else if (!reported || seconds_since(reported) * 1000 >= POLL_MS) {
      reported = spore_clock_ns();
      if (!spore_progress(progress, run->fraction, *run->stage ? run->stage : NULL))
        fail(run, SPORE_ERROR_CANCELLED, _("cancelled"));
    }
  }
}

/* Ends the child. *status is the status of a child that ended by itself. */
static gboolean reap(HelperRun *run, int *status) {
  guint64 started = spore_clock_ns();
  if (run->answer || run->failed) kill(run->process, SIGKILL);
  for (;;) {
    pid_t ended = waitpid(run->process, status, WNOHANG);
    if (ended == run->process) return TRUE;
    if (ended < 0 && errno != EINTR) return FALSE;
    if (seconds_since(started) > DEATH_S) kill(run->process, SIGKILL);
    g_usleep(1000);
  }
}

static void explain_death(HelperRun *run, int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    fail(run, SPORE_ERROR_INPUT, _("it took longer than %g s and was stopped; give a smaller or simpler input"),
         run->limits->time_s);
  else if (WIFSIGNALED(status))
    fail(run, SPORE_ERROR_INPUT,
         _("the helper %s crashed on it (%s); expected a sound input; export or repair it, or give another format"),
         run->program, strsignal(WTERMSIG(status)));
  else
    fail(run, SPORE_ERROR_INPUT,
         _("the helper %s ended without an answer (status %d); expected a sound input; export or repair it, or give "
           "another format"),
         run->program, WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

GBytes *spore_helper_run(const char *program, const char *place, GBytes *request, const SporeHelperLimits *limits,
                         const SporeProgress *progress, GError **error) {
  HelperRun run = {.program = program, .place = place, .limits = limits, .error = error};
  gsize size;
  run.request = g_bytes_get_data(request, &size);
  run.request_head = (SporeFrame){SPORE_FRAME_MAGIC, SPORE_FRAME_REQUEST, size};
  run.request_file = run.answer_file = run.complaint_file = -1;
  char *path = spore_helper_path(program);
  if (!path) {
    fail(&run, SPORE_ERROR_UNSUPPORTED,
         _("the helper program %s is missing; expected it beside spore or in %s; install SPORE whole, or name its "
           "folder in "
           "SPORE_HELPERS"),
         program, SPORE_HELPER_FOLDER);
    return NULL;
  }
  if (start(&run, path)) {
    int status = 0;
    attend(&run, progress);
    gboolean known = reap(&run, &status);
    if (!run.answer && !run.failed) explain_death(&run, known ? status : 0);
  }
  if (run.complaint_filled) g_debug("%s: %s", program, run.complaint);
  close_file(&run.request_file);
  close_file(&run.answer_file);
  close_file(&run.complaint_file);
  spore_free(run.body);
  g_free(path);
  return run.answer;
}
