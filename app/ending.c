/* The end of a program that cannot go on: where GLib ends it, mostly for want of memory, there is one line, status 3,
 * and no half-written file. What the editor keeps for recovery stays, since nothing is tidied up. */
#include "app/ending.h"

#include <errno.h>
#include <glib/gi18n.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "core/io/file_batch.h"

#define STATUS_FAULT 3
#ifdef __SANITIZE_ADDRESS__
#define SANITIZED true /* the sanitizer tells more of a fault */
#else
#define SANITIZED false
#endif

#define NO_MEMORY                                                                                                      \
  N_("there is not enough memory to go on; nothing is half-written; close other programs, or use fewer or coarser "    \
     "meshes")
#define REPORT_IT N_("this is a fault of SPORE; nothing is half-written; report it")

static char no_memory[512] = NO_MEMORY, report_it[512] = REPORT_IT; /* translated beforehand: that takes memory */

static void say(const char *text) {
  for (size_t left = strlen(text); left > 0;) {
    ssize_t written = write(STDERR_FILENO, text, left);
    if (written <= 0) return;
    text += written, left -= (size_t)written;
  }
}

/* Takes no memory. */
static void end(const char *domain, GLogLevelFlags level, const char *message, gpointer data) {
  if (!(level & (G_LOG_FLAG_FATAL | G_LOG_LEVEL_ERROR))) {
    g_log_default_handler(domain, level, message, data);
    return;
  }
  spore_file_batches_withdraw();
  gboolean memory = !message || strstr(message, "allocate") || strstr(message, "memory");
  if (!memory) say(message), say("; ");
  say(memory ? no_memory : report_it);
  say("\n");
  _exit(STATUS_FAULT);
}

/* Whoever aborts has said why: GLib's allocator of small blocks, which does not ask the log, or an assertion. */
static void on_abort(int number) {
  spore_file_batches_withdraw();
  _exit(STATUS_FAULT);
}

/* Where GLib formats a text and has no memory it says so, for which it formats a text: that ends at the end of the
 * stack, which cannot grow for want of memory long before its limit. */
#define SIGNAL_STACK_BYTES (64 * 1024)
#define LARGEST_STACK ((size_t)64 << 20)
#define PAGE_BYTES (64 * 1024) /* at least */
static char signal_stack[SIGNAL_STACK_BYTES];
static const char *stack_start;
static size_t stack_most;

static void on_fault(int number, siginfo_t *info, void *context) {
  const char *place = info->si_addr;
  signal(number, SIG_DFL);
  if (place < stack_start && (size_t)(stack_start - place) + PAGE_BYTES < stack_most) {
    spore_file_batches_withdraw();
    say(no_memory);
    say("\n");
    _exit(STATUS_FAULT);
  }
} /* else the same instruction ends the program */

static void catch_faults(const char *start) {
  const stack_t stack = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
  const struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_ONSTACK};
  struct rlimit limit;
  stack_start = start;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || sigaltstack(&stack, NULL) != 0) return;
  stack_most = limit.rlim_cur > LARGEST_STACK ? LARGEST_STACK : (size_t)limit.rlim_cur;
  sigaction(SIGSEGV, &action, NULL);
}

#define AGAIN_US 20000

/* A file that is being written is written to the end, and then taken back with all that do not stand yet. */
static void on_signal(int number) {
  static volatile sig_atomic_t asked;
  static const struct itimerval again = {.it_value = {.tv_usec = AGAIN_US}};
  if (number != SIGALRM) asked = number;
  if (!spore_file_batches_end()) {
    setitimer(ITIMER_REAL, &again, NULL);
    return;
  }
  signal(asked, SIG_DFL);
  raise(asked);
}

void spore_ending_on_signals(void) {
  static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGALRM};
  const struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) sigaction(signals[i], &action, NULL);
}

void spore_ending_prepare(void) {
  char here;
  signal(SIGABRT, on_abort);
  if (!SANITIZED) catch_faults(&here);
  signal(SIGXFSZ, SIG_IGN); /* a file that grows too large is an error of writing, and not the end */
  g_log_set_default_handler(end, NULL);
}

void spore_ending_translate(void) {
  g_strlcpy(no_memory, _(NO_MEMORY), sizeof no_memory);
  g_strlcpy(report_it, _(REPORT_IT), sizeof report_it);
  (void)(g_strerror)(ENOMEM); /* GLib keeps the text: later there may be no memory to convert it */
}
