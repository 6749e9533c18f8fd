/* A helper that misbehaves in the way that the request names. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/io/helper.h"
#include "core/io/helper_wire.h"

#define FRAMES 3 /* the file that frames go to */

static size_t request_size;

static void echo(const char *request) { spore_helper_send_answer(request, request_size); }

static void chatter(const char *request) {
  for (int i = 0; i < 10000; i++) printf("libraries print what they like, %d\n", i), fprintf(stderr, "and complain\n");
  fflush(stdout);
  echo(request);
}

static void progress(const char *request) {
  for (int i = 0; i <= 10; i++) {
    spore_helper_send_progress(i / 10., "stirring");
    usleep(30000);
  }
  echo(request);
}

static void strange_progress(const char *request) {
  spore_helper_send_progress(0. / (double)(request[0] - 's'), "not\na number\xff");
  usleep(100000);
  echo(request);
}

static void say_error(const char *request) {
  spore_helper_send_error(SPORE_ERROR_INPUT, "it is wrong; expected right", "line 7");
}

static void crash(const char *request) {
  signal(SIGSEGV, SIG_DFL); /* a sanitizer would turn it into an exit */
  *(volatile int *)(uintptr_t)(request[0] - 'c' + 8) = 1;
}

static void hang(const char *request) {
  for (;;) sleep(1);
}

static void close_and_hang(const char *request) {
  close(FRAMES);
  hang(request);
}

static void leave(const char *request) { _exit(7); }

static void flood(const char *request) {
  for (;;) spore_helper_send_progress(0.5, "again");
}

static void large(const char *request) {
  size_t size = 2 << 20;
  char *answer = calloc(size, 1);
  if (answer) spore_helper_send_answer(answer, size);
  free(answer);
}

static void write_frames(const void *bytes, size_t size) {
  if (write(FRAMES, bytes, size) < 0) _exit(9);
}

static void garbage(const char *request) { write_frames("this is no frame, and was never one", 35); }

/* Says that it will send more than it does. */
static void cut_short(const char *request) {
  SporeFrame frame = {SPORE_FRAME_MAGIC, SPORE_FRAME_ANSWER, 1000};
  write_frames(&frame, sizeof frame);
  write_frames("short", 5);
}

/* A progress message larger than any room for it. */
static void long_stage(const char *request) {
  SporeFrame frame = {SPORE_FRAME_MAGIC, SPORE_FRAME_PROGRESS, UINT64_MAX};
  write_frames(&frame, sizeof frame);
  hang(request);
}

static void memory(const char *request) {
  void *block = malloc((size_t)1 << 32);
  char answer[32];
  int length = snprintf(answer, sizeof answer, "%s", block ? "given" : "refused");
  free(block);
  spore_helper_send_answer(answer, (size_t)length);
}

static int fork_once(void) {
  pid_t process = fork();
  if (process == 0) _exit(0);
  return process < 0 ? -1 : 0;
}

/* Tries what a decoder has no business with; answers "what:errno" for each, 0 where it worked. */
static void forbidden(const char *request) {
  char answer[1024];
  int length = 0;
#define TRY(what)                                                                                                      \
  length +=                                                                                                            \
      snprintf(answer + length, sizeof answer - (size_t)length, "%s:%d\n", #what, (errno = 0, (what) < 0) ? errno : 0)
  TRY(open("/etc/passwd", O_RDONLY));
  TRY(open("/proc/self/mem", O_RDWR));
  TRY(open("spore-probe-was-here", O_RDWR | O_CREAT, 0600));
  TRY(unlink("spore-probe-was-here"));
  TRY(socket(AF_INET, SOCK_STREAM, 0));
  TRY(socket(AF_UNIX, SOCK_STREAM, 0));
  TRY(fork_once());
  TRY(execl("/bin/true", "true", (char *)NULL));
  TRY(kill(getppid(), 0));
  TRY((int)ptrace(PTRACE_ATTACH, getppid(), NULL, NULL));
  TRY(setrlimit(RLIMIT_NOFILE, &(struct rlimit){1000, 1000}));
  TRY(chdir("/"));
#undef TRY
  spore_helper_send_answer(answer, (size_t)length);
}

static const struct {
  const char *name;
  void (*act)(const char *request);
} acts[] = {{"echo", echo},       {"chatter", chatter},  {"progress", progress}, {"strange", strange_progress},
            {"error", say_error}, {"crash", crash},      {"hang", hang},         {"quiet", close_and_hang},
            {"leave", leave},     {"flood", flood},      {"large", large},       {"garbage", garbage},
            {"short", cut_short}, {"stage", long_stage}, {"memory", memory},     {"forbidden", forbidden}};

int main(int argc, char **argv) {
  spore_helper_start(argc, argv);
  void *content;
  if (!spore_helper_read_request(&content, &request_size)) _exit(1);
  for (size_t i = 0; i < sizeof acts / sizeof *acts; i++) {
    size_t length = strlen(acts[i].name);
    if (request_size >= length && memcmp(content, acts[i].name, length) == 0) acts[i].act(content);
  }
  _exit(0);
}
