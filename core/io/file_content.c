/* Reads a whole file, up to a limit, even if the file grows meanwhile. */
#include "core/io/file_content.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

/* errno, or 0. */
static int check(int descriptor, gsize largest) {
  struct stat status;
  if (fstat(descriptor, &status) != 0) return errno;
  if (S_ISDIR(status.st_mode)) return EISDIR;
  if (!S_ISREG(status.st_mode)) return EINVAL;
  return status.st_size > (off_t)largest ? EFBIG : 0;
}

/* errno, or 0. */
static int read_all(int descriptor, gsize largest, GByteArray *content) {
  guint8 block[65536];
  for (;;) {
    ssize_t got = read(descriptor, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return 0;
    if (content->len + (gsize)got > largest) return EFBIG;
    g_byte_array_append(content, block, (guint)got);
  }
}

GByteArray *spore_file_content(const char *file, gsize largest, int *fault) {
  int descriptor = open(file, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return *fault = errno, NULL;
  g_autoptr(GByteArray) content = g_byte_array_new();
  *fault = check(descriptor, largest);
  if (!*fault) *fault = read_all(descriptor, largest, content);
  close(descriptor);
  return *fault ? NULL : g_steal_pointer(&content);
}
