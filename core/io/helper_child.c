/* The child's side of helper processes; needs libc alone. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <signal.h>
#include <unistd.h>

#include "core/io/helper.h"
#include "core/io/helper_wire.h"

#define ANSWER_FILE 3

/* Exit status where the parent is gone or sent nonsense: nobody can receive a message. */
#define STATUS_NO_PARENT 4

static void write_all(const void *content, size_t size) {
  const char *at = content;
  while (size) {
    ssize_t written = write(ANSWER_FILE, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(STATUS_NO_PARENT);
    at += written;
    size -= (size_t)written;
  }
}

static bool read_all(void *content, size_t size) {
  char *at = content;
  while (size) {
    ssize_t got = read(STDIN_FILENO, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= (size_t)got;
  }
  return true;
}

static void send_frame(SporeFrameType type, const void *head, size_t head_size, const void *body, size_t body_size) {
  SporeFrame frame = {SPORE_FRAME_MAGIC, type, head_size + body_size};
  write_all(&frame, sizeof frame);
  write_all(head, head_size);
  write_all(body, body_size);
}

static size_t text_size(const char *text, size_t most) { return text ? strnlen(text, most) : 0; }

void spore_helper_start(int argc, char **argv) {
  unsigned long long memory = argc == 3 ? strtoull(argv[1], NULL, 10) : 0;
  unsigned long long processor_s = argc == 3 ? strtoull(argv[2], NULL, 10) : 0;
  if (!memory || !processor_s) {
    fprintf(stderr, "%s: a part of SPORE, started by it and not by hand\n", argv[0]);
    _exit(2);
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  /* Libraries may print, but only frames may reach the parent. */
  if (dup2(STDOUT_FILENO, ANSWER_FILE) < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) _exit(STATUS_NO_PARENT);
  const char *missing = NULL;
  if (!spore_sandbox_enter(memory, processor_s, &missing))
    send_frame(SPORE_FRAME_NOTE, missing, text_size(missing, SPORE_FRAME_TEXT), NULL, 0);
}

gboolean spore_helper_read_request(void **content, gsize *size) {
  SporeFrame frame;
  if (!read_all(&frame, sizeof frame) || frame.magic != SPORE_FRAME_MAGIC || frame.type != SPORE_FRAME_REQUEST ||
      frame.size > SIZE_MAX / 2)
    return FALSE;
  void *memory = malloc(frame.size ? frame.size : 1);
  if (!memory || !read_all(memory, frame.size)) {
    free(memory);
    return FALSE;
  }
  *content = memory;
  *size = frame.size;
  return TRUE;
}

void spore_helper_send_progress(double fraction, const char *stage) {
  send_frame(SPORE_FRAME_PROGRESS, &fraction, sizeof fraction, stage, text_size(stage, 256));
}

void spore_helper_send_error(SporeErrorCode code, const char *message, const char *detail) {
  char text[SPORE_FRAME_TEXT - 4];
  size_t message_size = text_size(message, 1000), detail_size = text_size(detail, 1000);
  memcpy(text, message, message_size);
  text[message_size] = '\0';
  if (detail_size) memcpy(text + message_size + 1, detail, detail_size);
  uint32_t number = (uint32_t)code;
  send_frame(SPORE_FRAME_ERROR, &number, sizeof number, text, message_size + 1 + detail_size);
}

void spore_helper_send_answer(const void *content, gsize size) {
  send_frame(SPORE_FRAME_ANSWER, content, size, NULL, 0);
}
