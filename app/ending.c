/* The end of a program that cannot go on: where GLib ends it, mostly for want of memory, there is one line, status 3,
 * and no half-written file. What the editor keeps for recovery stays, since nothing is tidied up. */
#include "app/ending.h"

#include <errno.h>
#include <glib/gi18n.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "core/io/file_batch.h"

#define STATUS_FAULT 3

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
  signal(SIGABRT, on_abort);
  signal(SIGXFSZ, SIG_IGN); /* a file that grows too large is an error of writing, and not the end */
  g_log_set_default_handler(end, NULL);
}

void spore_ending_translate(void) {
  g_strlcpy(no_memory, _(NO_MEMORY), sizeof no_memory);
  g_strlcpy(report_it, _(REPORT_IT), sizeof report_it);
  (void)(g_strerror)(ENOMEM); /* GLib keeps the text: later there may be no memory to convert it */
}
