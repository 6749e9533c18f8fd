/* Saves a scene: blobs and assets first, the scene last, all of them or none. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/io/bundle.h"
#include "core/io/file_batch.h"
#include "core/io/scene_format.h"
#include "core/io/scene_xml.h"
#include "core/scene/needs.h"

/* Whether the file is a device or a pipe (/dev/stdout), which can neither be replaced nor taken back. */
static gboolean is_stream(const char *file) {
  struct stat status;
  return stat(file, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

/* The folder of the file, or the nearest folder above it that exists. g_free. */
static char *nearest_folder(const char *file) {
  char *folder = g_path_get_dirname(file);
  while (access(folder, F_OK) != 0 && errno == ENOENT && strcmp(folder, ".") != 0 && strcmp(folder, "/") != 0) {
    char *above = g_path_get_dirname(folder);
    g_free(folder);
    folder = above;
  }
  return folder;
}

gboolean spore_file_may_be_written(const char *file, gboolean makes_folders, GError **error) {
  g_autofree char *target = spore_file_target(file);
  g_autofree char *folder = makes_folders ? nearest_folder(target) : g_path_get_dirname(target);
  gboolean there = access(target, F_OK) == 0;
  if (!there || !is_stream(target)) {
    g_autofree char *inside = g_build_filename(folder, ".", NULL); /* a file is no folder */
    if (faccessat(AT_FDCWD, inside, W_OK | X_OK, AT_EACCESS) != 0) return spore_file_refuse(errno, file, error);
  }
  return !there || faccessat(AT_FDCWD, target, W_OK, AT_EACCESS) == 0 || spore_file_refuse(errno, file, error);
}

static gboolean write_stream(const char *file, const char *content, gsize size, GError **error) {
  int descriptor = open(file, O_WRONLY | O_CLOEXEC | O_NOCTTY);
  gboolean done = descriptor >= 0;
  while (done && size > 0) {
    ssize_t written = write(descriptor, content, size);
    if (written > 0) content += written, size -= (gsize)written;
    else done = written < 0 && errno == EINTR;
  }
  int fault = errno;
  if (descriptor >= 0) close(descriptor);
  return done || spore_error_raise(error, SPORE_ERROR_FILE, file,
                                   _("cannot be written: %s; expected a file, or a device that "
                                     "takes it; choose another place"),
                                   g_strerror(fault));
}

gboolean spore_write_file(const char *file, const void *content, gsize size, GError **error) {
  if (is_stream(file)) return write_stream(file, content, size, error);
  SporeFileBatch *batch = spore_file_batch_new();
  gboolean done = spore_file_batch_add_path(batch, file, content, size, error) && spore_file_batch_commit(batch, error);
  spore_file_batch_free(batch);
  return done;
}

/* Assets. */

static gboolean same_folder(const SporeDocument *document, const char *scene) {
  if (!document->file) return FALSE;
  g_autofree char *folder = g_path_get_dirname(document->file), *new_folder = g_path_get_dirname(scene);
  struct stat one, other;
  return stat(folder, &one) == 0 && stat(new_folder, &other) == 0 && one.st_dev == other.st_dev &&
         one.st_ino == other.st_ino;
}

typedef enum Found { FOUND_NOTHING, FOUND_SAME, FOUND_OTHER } Found;

/* Compares a file with the one that is already at the target. */
static Found compare_target(const SporeDocument *document, const char *scene, const char *file, GBytes *content) {
  g_autofree char *folder = g_path_get_dirname(scene);
  g_autofree char *target = g_build_filename(folder, file, NULL);
  struct stat status;
  if (lstat(target, &status) != 0) return FOUND_NOTHING;
  if (!S_ISREG(status.st_mode) || (gsize)status.st_size != g_bytes_get_size(content)) return FOUND_OTHER;
  g_autoptr(GMappedFile) mapped = g_mapped_file_new(target, FALSE, NULL);
  if (!mapped) return FOUND_OTHER;
  g_autoptr(GBytes) old = g_mapped_file_get_bytes(mapped);
  return g_bytes_equal(old, content) ? FOUND_SAME : FOUND_OTHER;
}

static gboolean save_asset(SporeDocument *document, SporeFileBatch *batch, int directory, const char *scene,
                           const char *file, gboolean stays, GError **error) {
  if (stays && !g_hash_table_contains(document->blobs, file)) return TRUE;
  g_autoptr(GError) missing = NULL;
  g_autoptr(GBytes) content = spore_document_read_asset(document, file, &missing);
  if (!content) return TRUE; /* unreadable in the old place too; `spore check` reports it */
  Found found = compare_target(document, scene, file, content);
  if (found == FOUND_SAME) return TRUE;
  g_autofree char *folder = g_path_get_dirname(scene);
  g_autofree char *place = g_build_filename(folder, file, NULL);
  if (found == FOUND_OTHER && !stays)
    return spore_error_raise(error, SPORE_ERROR_FILE, place, "%s",
                             _("this file is there already, with other content; expected a folder where it is free; "
                               "choose another folder or move the file"));
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  return spore_file_batch_add(batch, directory, place, file, bytes, size, error);
}

static gboolean save_assets(SporeDocument *document, SporeFileBatch *batch, const char *scene, GHashTable *files,
                            GError **error) {
  int directory = spore_file_open_folder(scene, error);
  if (directory < 0) return FALSE;
  gboolean stays = same_folder(document, scene), done = TRUE;
  GHashTableIter iterator;
  gpointer file;
  g_hash_table_iter_init(&iterator, files);
  while (done && g_hash_table_iter_next(&iterator, &file, NULL))
    done = save_asset(document, batch, directory, scene, file, stays, error);
  close(directory);
  return done;
}

/* The scene. */

/* Refuses a required property without a value: the file could not be read again. */
static gboolean check_required(const SporeObject *object, GError **error) {
  const SporeParameterTable *table = object->type->table;
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (!parameter->required || object->slots[i].set || !object->parent) continue;
    g_autofree char *path = spore_object_path(object);
    return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                             _("%s is not set; expected a value before saving; set it, or "
                               "remove the object"),
                             parameter->name);
  }
  for (guint i = 0; i < object->children->len; i++)
    if (!check_required(spore_object_child(object, i), error)) return FALSE;
  return TRUE;
}

/* Updates the document after the files are written. */
static void settle(SporeDocument *document, const char *file, GHashTable *files, const GArray *places) {
  GHashTableIter iterator;
  gpointer asset;
  g_hash_table_iter_init(&iterator, files);
  while (g_hash_table_iter_next(&iterator, &asset, NULL)) g_hash_table_remove(document->blobs, asset);
  if (!same_folder(document, file)) spore_document_keep_assets(document, files);
  for (guint i = 0; i < places->len; i++) {
    const SporeObjectPlace *place = &g_array_index(places, SporeObjectPlace, i);
    place->object->line = place->line, place->object->column = place->column;
  }
  spore_document_set_file(document, file);
  spore_document_mark_saved(document);
}

gboolean spore_scene_save(SporeDocument *document, const char *file, GError **error) {
  if (spore_bundle_is_name(file))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, "%s",
                             _("a bundle is not edited; nothing was changed; save the scene under a name that ends in "
                               ".spore, and make a bundle of it with spore export"));
  if (!check_required(document->root, error)) return FALSE;
  g_autoptr(GHashTable) files = spore_document_files(document);
  g_autoptr(GArray) places = g_array_new(FALSE, FALSE, sizeof(SporeObjectPlace));
  gsize size;
  g_autofree char *text = spore_scene_format_places(document, &size, places);
  SporeFileBatch *batch = spore_file_batch_new();
  gboolean done = save_assets(document, batch, file, files, error) &&
                  spore_file_batch_add_path(batch, file, text, size, error) && spore_file_batch_commit(batch, error);
  spore_file_batch_free(batch);
  if (done) settle(document, file, files, places);
  return done;
}
