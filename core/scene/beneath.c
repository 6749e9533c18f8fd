/* Opens files by relative names, and refuses every name that leads out of the folder. */
#include "core/scene/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <glib.h>
#include <linux/openat2.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

int spore_open_beneath(int directory, const char *path, int flags, mode_t mode) {
  struct open_how how = {.flags = (guint64)(flags | O_CLOEXEC),
                         .mode = flags & O_CREAT ? mode : 0,
                         .resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS};
  long descriptor;
  do descriptor = syscall(SYS_openat2, directory, path, &how, sizeof how);
  while (descriptor < 0 &&
         (errno == EAGAIN || errno == EINTR)); /* EAGAIN: another process renamed a folder of the path meanwhile */
  if (descriptor < 0 && errno == ENOSYS) return spore_open_beneath_walking(directory, path, flags, mode);
  return (int)descriptor;
}

int spore_open_beneath_walking(int directory, const char *path, int flags, mode_t mode) {
  if (path[0] == '/' || path[0] == '\0') return errno = path[0] ? EXDEV : ENOENT, -1;
  g_auto(GStrv) parts = g_strsplit(path, "/", -1);
  int at = directory;
  for (char **part = parts; *part; part++) {
    gboolean last = part[1] == NULL;
    int next = -1;
    if (strcmp(*part, "..") == 0) errno = EXDEV;
    else if (last) next = openat(at, **part ? *part : ".", flags | O_NOFOLLOW | O_CLOEXEC, mode);
    else next = openat(at, **part ? *part : ".", O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    int fault = errno;
    if (at != directory) close(at);
    if (next < 0) return errno = fault, -1;
    at = next;
  }
  return at;
}
