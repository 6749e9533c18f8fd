/* Keeps unsaved work in a folder for each window, and finds the work of a program that ended unexpectedly. */
#include "ui/document/recovery.h"

#include <errno.h>
#include <fcntl.h>
#include <gio/gio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/io/scene_xml.h"

#define FOLDER_MODE 0700
#define SCENE "scene.spore"
#define ORIGINAL "original"
#define LOCK "lock"

struct SporeRecovery {
  char *folder; /* NULL until something was kept */
  int lock;
  guint64 revision;
  SporeEditorDocument *document; /* the one kept last; not owned, only compared */
};

static char *root_folder(void) { return g_build_filename(g_get_user_state_dir(), "spore", "recovery", NULL); }

/* Open with the lock held, or -1: another process lives in there. */
static int lock_folder(const char *folder) {
  g_autofree char *file = g_build_filename(folder, LOCK, NULL);
  int lock = open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
  if (lock >= 0) close(lock);
  return -1;
}

/* Plain files and folders alone; links are removed, not followed. */
static void remove_tree(GFile *file) {
  g_autoptr(GFileEnumerator) children =
      g_file_enumerate_children(file, G_FILE_ATTRIBUTE_STANDARD_NAME, G_FILE_QUERY_INFO_NOFOLLOW_SYMLINKS, NULL, NULL);
  GFile *child;
  while (children && g_file_enumerator_iterate(children, NULL, &child, NULL, NULL) && child) remove_tree(child);
  g_file_delete(file, NULL, NULL);
}

static void remove_folder(const char *folder) {
  g_autoptr(GFile) file = g_file_new_for_path(folder);
  remove_tree(file);
}

SporeRecovery *spore_recovery_new(void) {
  SporeRecovery *recovery = g_new0(SporeRecovery, 1);
  recovery->lock = -1;
  return recovery;
}

void spore_recovery_forget(SporeRecovery *recovery) {
  if (recovery->folder) remove_folder(recovery->folder);
  if (recovery->lock >= 0) close(recovery->lock);
  recovery->lock = -1;
  recovery->document = NULL;
  g_clear_pointer(&recovery->folder, g_free);
}

void spore_recovery_free(SporeRecovery *recovery) {
  spore_recovery_forget(recovery);
  g_free(recovery);
}

static gboolean ensure_folder(SporeRecovery *recovery, GError **error) {
  if (recovery->folder) return TRUE;
  g_autofree char *root = root_folder();
  g_autofree char *name = g_uuid_string_random();
  g_autofree char *folder = g_build_filename(root, name, NULL);
  if (g_mkdir_with_parents(folder, FOLDER_MODE) != 0)
    return spore_error_raise(error, SPORE_ERROR_FILE, folder, "%s", g_strerror(errno));
  recovery->lock = lock_folder(folder);
  recovery->folder = g_steal_pointer(&folder);
  return TRUE;
}

void spore_recovery_adopt(SporeRecovery *recovery, const char *folder) {
  spore_recovery_forget(recovery);
  recovery->lock = lock_folder(folder);
  recovery->folder = g_strdup(folder);
}

/* Files are named by hash or imported once, so files of equal size have equal content. */
static gboolean keep_file(SporeRecovery *recovery, SporeDocument *document, const char *file, GError **error) {
  g_autoptr(GBytes) content = spore_document_read_asset(document, file, NULL);
  if (!content) return TRUE; /* missing in the scene too; the checks say so */
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  g_autofree char *path = g_build_filename(recovery->folder, file, NULL);
  g_autoptr(GMappedFile) kept = g_mapped_file_new(path, FALSE, NULL);
  if (kept && g_mapped_file_get_length(kept) == size) return TRUE;
  g_autofree char *folder = g_path_get_dirname(path);
  g_mkdir_with_parents(folder, FOLDER_MODE);
  return spore_write_file(path, bytes, size, error);
}

/* Every file that some object names. */
static gboolean keep_files(SporeRecovery *recovery, SporeDocument *document, SporeObject *object, GError **error) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (gsize i = 0; i < table->count; i++) {
    const char *file = table->parameters[i].type == SPORE_FILE ? spore_object_value(object, (guint)i)->text : NULL;
    if (file && *file && !keep_file(recovery, document, file, error)) return FALSE;
  }
  for (guint i = 0; i < spore_object_child_count(object); i++)
    if (!keep_files(recovery, document, spore_object_child(object, i), error)) return FALSE;
  return TRUE;
}

gboolean spore_recovery_keep(SporeRecovery *recovery, SporeEditorDocument *editor, GError **error) {
  SporeDocument *document = spore_editor_document_get(editor);
  if (!spore_editor_document_is_modified(editor)) {
    spore_recovery_forget(recovery);
    return TRUE;
  }
  if (recovery->document == editor && recovery->revision == spore_document_revision(document)) return TRUE;
  if (!ensure_folder(recovery, error) || !keep_files(recovery, document, spore_document_root(document), error))
    return FALSE;
  gsize size;
  g_autofree char *text = spore_scene_format(document, &size);
  g_autofree char *scene = g_build_filename(recovery->folder, SCENE, NULL);
  g_autofree char *original = g_build_filename(recovery->folder, ORIGINAL, NULL);
  const char *file = spore_editor_document_get_save_file(editor);
  if (!spore_write_file(original, file ? file : "", file ? strlen(file) : 0, error) ||
      !spore_write_file(scene, text, size, error))
    return FALSE;
  recovery->document = editor;
  recovery->revision = spore_document_revision(document);
  return TRUE;
}

/* Leftovers. */

static SporeLeftover *leftover_in(const char *folder, gint64 kept_s) {
  SporeLeftover *leftover = g_new0(SporeLeftover, 1);
  g_autofree char *original = g_build_filename(folder, ORIGINAL, NULL);
  leftover->folder = g_strdup(folder);
  leftover->kept_s = kept_s;
  leftover->scene = g_build_filename(folder, SCENE, NULL);
  if (g_file_get_contents(original, &leftover->original, NULL, NULL) && *leftover->original == '\0')
    g_clear_pointer(&leftover->original, g_free);
  return leftover;
}

static gint64 modified_time(const char *folder) {
  g_autofree char *scene = g_build_filename(folder, SCENE, NULL);
  g_autoptr(GFile) file = g_file_new_for_path(scene);
  g_autoptr(GFileInfo) info =
      g_file_query_info(file, G_FILE_ATTRIBUTE_TIME_MODIFIED, G_FILE_QUERY_INFO_NONE, NULL, NULL);
  return info ? (gint64)g_file_info_get_attribute_uint64(info, G_FILE_ATTRIBUTE_TIME_MODIFIED) : -1;
}

SporeLeftover *spore_leftover_find(const GPtrArray *passed_over) {
  g_autofree char *root = root_folder();
  g_autoptr(GDir) folders = g_dir_open(root, 0, NULL);
  g_autofree char *newest = NULL;
  gint64 newest_time = -1;
  for (const char *name; folders && (name = g_dir_read_name(folders));) {
    g_autofree char *folder = g_build_filename(root, name, NULL);
    if (g_ptr_array_find_with_equal_func((GPtrArray *)passed_over, folder, g_str_equal, NULL)) continue;
    gint64 time = modified_time(folder);
    int lock = time > newest_time ? lock_folder(folder) : -1;
    if (lock < 0) continue;
    close(lock);
    newest_time = time;
    g_free(newest);
    newest = g_steal_pointer(&folder);
  }
  return newest ? leftover_in(newest, newest_time) : NULL;
}

void spore_leftover_remove(const SporeLeftover *leftover) { remove_folder(leftover->folder); }

void spore_leftover_free(SporeLeftover *leftover) {
  if (!leftover) return;
  g_free(leftover->folder);
  g_free(leftover->scene);
  g_free(leftover->original);
  g_free(leftover);
}
