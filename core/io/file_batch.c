/* Several files written together: each to a temporary file first, then all renamed, and all taken back where one fails.
 */
#include "core/io/file_batch.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/scene/beneath.h"

typedef struct Entry {
  int folder; /* of the batch's folders: the file's own */
  char *temporary, *name, *place;
  gboolean renamed, exchanged; /* exchanged: the old file now has the temporary name */
} Entry;

typedef struct MadeFolder {
  int parent;
  char *name;
} MadeFolder;

struct SporeFileBatch {
  GPtrArray *entries; /* of Entry * */
  GArray *folders;    /* of int: open, each once: there may be more files than a program may open */
  GArray *made;       /* of MadeFolder */
  gboolean committed;
  SporeFileBatch *next; /* of the open ones */
};

gboolean spore_file_refuse(int fault, const char *place, GError **error) {
  if (fault == EXDEV || fault == ELOOP)
    return spore_error_raise(error, SPORE_ERROR_FILE, place,
                             _("leads out of the scene's folder; nothing was changed; name a file inside it"));
  const char *remedy = _("choose another place");
  if (fault == ENOSPC || fault == EDQUOT || fault == EFBIG) remedy = _("free some space or choose another place");
  else if (fault == EACCES || fault == EPERM || fault == EROFS)
    remedy = _("check the permissions or choose another place");
  else if (fault == ENOENT) remedy = _("make the folder first");
  return spore_error_raise(error, SPORE_ERROR_FILE, place, _("cannot be written: %s; nothing was changed; %s"),
                           g_strerror(fault), remedy);
}

/* The batches that are open. A program that must end withdraws them, and does not wait for the lock then. */
G_LOCK_DEFINE_STATIC(open_batches);
static SporeFileBatch *open_batches;

/* A handler of signals meets batches between two pieces of work alone. Atomic. */
static int at_work;    /* pieces of work under way */
static gboolean ended; /* no more may begin */

static void begin_work(void) {
  g_atomic_int_inc(&at_work);
  while (g_atomic_int_get(&ended)) g_usleep(1000); /* until the program is over, or the handler has looked */
}

static void end_work(void) { g_atomic_int_add(&at_work, -1); }

SporeFileBatch *spore_file_batch_new(void) {
  SporeFileBatch *batch = g_new0(SporeFileBatch, 1);
  begin_work();
  batch->entries = g_ptr_array_new();
  batch->folders = g_array_new(FALSE, FALSE, sizeof(int));
  batch->made = g_array_new(FALSE, FALSE, sizeof(MadeFolder));
  G_LOCK(open_batches);
  batch->next = open_batches;
  open_batches = batch;
  G_UNLOCK(open_batches);
  end_work();
  return batch;
}

static void take_back(Entry *entry) {
  if (entry->exchanged) renameat2(entry->folder, entry->temporary, entry->folder, entry->name, RENAME_EXCHANGE);
  else if (entry->renamed) renameat(entry->folder, entry->name, entry->folder, entry->temporary);
  entry->exchanged = entry->renamed = FALSE;
}

/* Leaves the whole files or the old ones, and no temporary file or empty folder. Takes no memory. */
static void withdraw(SporeFileBatch *batch) {
  for (guint i = batch->entries->len; i > 0; i--) {
    Entry *entry = g_ptr_array_index(batch->entries, i - 1);
    if (!batch->committed) take_back(entry);
    unlinkat(entry->folder, entry->temporary, 0); /* a renamed file is gone already */
  }
  for (guint i = batch->made->len; i > 0 && !batch->committed; i--) {
    MadeFolder *folder = &g_array_index(batch->made, MadeFolder, i - 1);
    unlinkat(folder->parent, folder->name, AT_REMOVEDIR);
  }
}

void spore_file_batches_withdraw(void) {
  for (SporeFileBatch *batch = open_batches; batch; batch = batch->next) withdraw(batch);
}

gboolean spore_file_batches_end(void) {
  g_atomic_int_set(&ended, TRUE);
  if (g_atomic_int_get(&at_work) > 0) {
    g_atomic_int_set(&ended, FALSE);
    return FALSE;
  }
  spore_file_batches_withdraw();
  return TRUE;
}

void spore_file_batch_free(SporeFileBatch *batch) {
  begin_work();
  withdraw(batch);
  G_LOCK(open_batches);
  SporeFileBatch **link = &open_batches;
  while (*link != batch) link = &(*link)->next;
  *link = batch->next;
  G_UNLOCK(open_batches);
  end_work();
  for (guint i = 0; i < batch->entries->len; i++) {
    Entry *entry = g_ptr_array_index(batch->entries, i);
    g_free(entry->temporary), g_free(entry->name), g_free(entry->place);
    g_free(entry);
  }
  g_ptr_array_unref(batch->entries);
  for (guint i = 0; i < batch->folders->len; i++) close(g_array_index(batch->folders, int, i));
  g_array_unref(batch->folders);
  for (guint i = 0; i < batch->made->len; i++) {
    MadeFolder *folder = &g_array_index(batch->made, MadeFolder, i);
    close(folder->parent);
    g_free(folder->name);
  }
  g_array_unref(batch->made);
  g_free(batch);
}

/* Opens a folder below another folder, and makes it where it is missing. -1 with errno. */
static int open_folder(SporeFileBatch *batch, int directory, const char *path) {
  int folder = spore_open_beneath(directory, path, O_RDONLY | O_DIRECTORY, 0);
  if (folder >= 0 || errno != ENOENT || strcmp(path, ".") == 0) return folder;
  g_autofree char *above = g_path_get_dirname(path), *name = g_path_get_basename(path);
  int parent = open_folder(batch, directory, above);
  if (parent < 0) return -1;
  if (mkdirat(parent, name, 0777) == 0) {
    MadeFolder made = {parent, g_steal_pointer(&name)};
    g_array_append_val(batch->made, made);
  } else {
    int fault = errno;
    close(parent);
    if (fault != EEXIST) return errno = fault, -1;
  }
  return spore_open_beneath(directory, path, O_RDONLY | O_DIRECTORY, 0);
}

/* The same; the batch keeps it, and opens no folder twice. */
static int keep_folder(SporeFileBatch *batch, int directory, const char *path) {
  int opened = open_folder(batch, directory, path);
  struct stat one, other;
  for (guint i = 0; opened >= 0 && i < batch->folders->len; i++) {
    int kept = g_array_index(batch->folders, int, i);
    if (fstat(opened, &one) != 0 || fstat(kept, &other) != 0 || one.st_dev != other.st_dev ||
        one.st_ino != other.st_ino)
      continue;
    close(opened);
    return kept;
  }
  if (opened >= 0) g_array_append_val(batch->folders, opened);
  return opened;
}

/* errno, or 0. */
static int write_whole(int descriptor, const char *content, gsize size) {
  while (size > 0) {
    ssize_t written = write(descriptor, content, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    content += written, size -= (gsize)written;
  }
  return fsync(descriptor) == 0 ? 0 : errno;
}

static int write_temporary(const Entry *entry, const void *content, gsize size) {
  struct stat old;
  gboolean replaces = fstatat(entry->folder, entry->name, &old, AT_SYMLINK_NOFOLLOW) == 0;
  if (replaces && S_ISDIR(old.st_mode)) return EISDIR;
  if (replaces && !S_ISREG(old.st_mode) && !S_ISLNK(old.st_mode)) return EEXIST; /* a device must not be replaced */
  if (replaces && S_ISREG(old.st_mode) && faccessat(entry->folder, entry->name, W_OK, AT_EACCESS) != 0) return errno;
  int descriptor = openat(entry->folder, entry->temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  int fault = write_whole(descriptor, content, size);
  if (!fault && replaces && S_ISREG(old.st_mode) && fchmod(descriptor, old.st_mode & 07777) != 0) fault = errno;
  if (close(descriptor) != 0 && !fault) fault = errno;
  return fault;
}

static gboolean add(SporeFileBatch *batch, int directory, const char *place, const char *name, const void *content,
                    gsize size, GError **error) {
  g_autofree char *path = g_path_get_dirname(name);
  int folder = keep_folder(batch, directory, path);
  if (folder < 0) return spore_file_refuse(errno, place, error);
  Entry *entry = g_new0(Entry, 1);
  entry->folder = folder;
  entry->place = g_strdup(place);
  entry->name = g_path_get_basename(name);
  entry->temporary = g_strdup_printf(".spore-%d-%08x.tmp", (int)getpid(), g_random_int());
  g_ptr_array_add(batch->entries, entry);
  int fault = write_temporary(entry, content, size);
  return fault ? spore_file_refuse(fault, place, error) : TRUE;
}

gboolean spore_file_batch_add(SporeFileBatch *batch, int directory, const char *place, const char *name,
                              const void *content, gsize size, GError **error) {
  begin_work();
  gboolean added = add(batch, directory, place, name, content, size, error);
  end_work();
  return added;
}

gboolean spore_file_batch_let_run(SporeFileBatch *batch, GError **error) {
  const Entry *entry = g_ptr_array_index(batch->entries, batch->entries->len - 1);
  struct stat now;
  if (fstatat(entry->folder, entry->temporary, &now, AT_SYMLINK_NOFOLLOW) == 0 &&
      fchmodat(entry->folder, entry->temporary, (now.st_mode & 07777) | (now.st_mode & 0444) >> 2, 0) == 0)
    return TRUE;
  return spore_file_refuse(errno, entry->place, error);
}

char *spore_file_target(const char *file) {
  char *real = realpath(file, NULL);
  char *target = g_strdup(real ? real : file);
  free(real);
  return target;
}

int spore_file_open_folder(const char *file, GError **error) {
  g_autofree char *folder = g_path_get_dirname(file);
  int directory = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0)
    spore_error_raise(error, SPORE_ERROR_FILE, file,
                      _("the folder \"%s\" cannot be opened: %s; nothing was changed; choose "
                        "another place"),
                      folder, g_strerror(errno));
  return directory;
}

gboolean spore_file_batch_add_path(SporeFileBatch *batch, const char *file, const void *content, gsize size,
                                   GError **error) {
  g_autofree char *target = spore_file_target(file);
  g_autofree char *name = g_path_get_basename(target);
  int directory = spore_file_open_folder(target, error);
  if (directory < 0) return FALSE;
  gboolean done = spore_file_batch_add(batch, directory, file, name, content, size, error);
  close(directory);
  return done;
}

/* errno, or 0. */
static int rename_entry(Entry *entry) {
  if (renameat2(entry->folder, entry->temporary, entry->folder, entry->name, RENAME_EXCHANGE) == 0) {
    entry->exchanged = TRUE;
    return 0;
  }
  if (errno != ENOENT && errno != EINVAL && errno != ENOSYS)
    return errno; /* EINVAL: a file system that cannot exchange */
  if (renameat(entry->folder, entry->temporary, entry->folder, entry->name) != 0) return errno;
  entry->renamed = TRUE;
  return 0;
}

static gboolean commit(SporeFileBatch *batch, GError **error) {
  int fault = 0;
  guint renamed = 0;
  while (!fault && renamed < batch->entries->len) fault = rename_entry(g_ptr_array_index(batch->entries, renamed++));
  for (guint i = 0; !fault && i < batch->folders->len; i++)
    if (fsync(g_array_index(batch->folders, int, i)) != 0) fault = errno;
  batch->committed = !fault;
  if (!fault) return TRUE;
  for (guint i = renamed; i > 0; i--) take_back(g_ptr_array_index(batch->entries, i - 1));
  return spore_file_refuse(fault, ((Entry *)g_ptr_array_index(batch->entries, renamed - 1))->place, error);
}

gboolean spore_file_batch_commit(SporeFileBatch *batch, GError **error) {
  begin_work();
  gboolean committed = commit(batch, error);
  end_work();
  return committed;
}
