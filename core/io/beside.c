/* Reads a file in the same folder or below, and nothing outside that folder. */
#include "core/io/beside.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/memory.h"

/* The head followed by the bytes of the file; NULL with the reason, an errno: ENXIO for what is no regular file or too
 * large. */
static GBytes *join(const void *head, gsize size, int file, gsize most, int *reason) {
  struct stat info;
  gsize have = 0;
  gssize got = 1;
  *reason = ENXIO;
  if (fstat(file, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size < 0 || (guint64)info.st_size > most)
    return NULL;
  *reason = ENOMEM;
  const gsize wanted = (gsize)info.st_size;
  char *whole = SPORE_NEW_ARRAY(char, size + wanted);
  if (!whole) return NULL;
  if (size) memcpy(whole, head, size);
  while (have < wanted && got > 0)
    if ((got = read(file, whole + size + have, wanted - have)) > 0) have += (gsize)got;
  *reason = errno;
  if (got >= 0) return g_bytes_new_with_free_func(whole, size + have, spore_free, whole);
  spore_free(whole);
  return NULL;
}

/* Whether the name is a path that leads down, step by step. */
static gboolean leads_down(const char *name) {
  g_auto(GStrv) steps = g_strsplit(name, "/", -1);
  for (char **step = steps; *step; step++)
    if (!**step || g_str_equal(*step, ".") || g_str_equal(*step, "..")) return FALSE;
  return *steps && !strchr(name, '\\');
}

/* Opens the file without following a link or waiting for a pipe. -1: errno says why. */
static int open_below(const char *file, const char *name) {
  g_autofree char *folder = g_path_get_dirname(file);
  g_auto(GStrv) steps = g_strsplit(name, "/", -1);
  int at = open(folder, O_RDONLY | O_CLOEXEC | O_DIRECTORY);
  for (char **step = steps; *step && at >= 0; step++) {
    int next =
        openat(at, *step, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | (step[1] ? O_DIRECTORY : 0));
    int reason = errno;
    close(at);
    at = next;
    errno = reason;
  }
  return at;
}

GBytes *spore_beside_read(const char *file, const char *name, const void *head, gsize size, gsize most,
                          GError **error) {
  if (!leads_down(name)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, file,
                      _("a part of it is said to be in \"%s\"; expected the path of a file in the same folder or below "
                        "it; put it there, or save all in one file"),
                      name);
    return NULL;
  }
  int part = open_below(file, name);
  int reason = errno;
  GBytes *whole = part >= 0 ? join(head, size, part, most, &reason) : NULL;
  if (part >= 0) close(part);
  if (whole) return whole;
  if (reason == ENOMEM)
    spore_error_raise(error, SPORE_ERROR_MEMORY, file,
                      _("there is not enough memory to import it; close other programs"));
  else if (reason == ENOENT)
    spore_error_raise(error, SPORE_ERROR_FILE, file,
                      _("its other file \"%s\" is not there; expected it in the same folder; copy both files"), name);
  else if (reason != ELOOP && reason != ENXIO)
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("its other file \"%s\" cannot be read (%s); check it"), name,
                      g_strerror(reason));
  else
    spore_error_raise(error, SPORE_ERROR_FILE, file,
                      _("its other file \"%s\" is no regular file, or has over %zu bytes; expected a smaller one in "
                        "the same folder; copy it there, or make it smaller"),
                      name, most);
  return NULL;
}
