/* Writes bundles: the scene, then its files by name, deflated, without dates and owners, so that the same scene gives
 * the same bytes. */
#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/bundle.h"
#include "core/io/bundle_locale.h"
#include "core/io/bundle_names.h"
#include "core/io/scene_xml.h"
#include "core/scene/needs.h"

#define SCENE_NAME "scene.spore"
#define CHUNK (1u << 18) /* bytes between two looks whether to go on */

typedef struct Writer {
  SporeDocument *document;
  const char *place;
  const SporeProgress *progress;
  struct archive *archive;
  GByteArray *content;
  guint64 done, total; /* bytes: how far, and of all files together */
} Writer;

static gboolean refuse_room(const char *place, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                           _("the scene and its files have over %u MiB; expected less in a bundle; leave out meshes or "
                             "make them coarser"),
                           SPORE_BUNDLE_BYTES >> 20);
}

/* libarchive hands over what is packed. */
static la_ssize_t take(struct archive *archive, void *data, const void *bytes, size_t size) {
  GByteArray *content = data;
  if (size > SPORE_BUNDLE_BYTES - content->len) {
    archive_set_error(archive, EFBIG, "too large");
    return -1;
  }
  g_byte_array_append(content, bytes, (guint)size);
  return (la_ssize_t)size;
}

static gboolean pass_on(const Writer *writer, GError **error) {
  int fault = archive_errno(writer->archive);
  if (fault == EFBIG) return refuse_room(writer->place, error);
  const char *reason = archive_error_string(writer->archive);
  return spore_error_raise(error, fault == ENOMEM ? SPORE_ERROR_MEMORY : SPORE_ERROR_FILE, writer->place,
                           _("the bundle cannot be made (%s); nothing was written; close other programs, or try again"),
                           reason ? reason : "zip");
}

static gboolean write_head(Writer *writer, const char *name, gsize size) {
  struct archive_entry *entry = archive_entry_new();
  if (!entry) return FALSE;
  archive_entry_set_pathname(entry, name);
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  archive_entry_set_size(entry, (la_int64_t)size);
  int written = archive_write_header(writer->archive, entry);
  archive_entry_free(entry);
  return written == ARCHIVE_OK;
}

static gboolean write_bytes(Writer *writer, const char *bytes, gsize size, GError **error) {
  while (size > 0) {
    gsize part = MIN(size, CHUNK);
    if (archive_write_data(writer->archive, bytes, part) != (la_ssize_t)part) return pass_on(writer, error);
    bytes += part, size -= part;
    writer->done += part;
    SporeError cancelled = SPORE_ERROR_INIT;
    double fraction = (double)writer->done / (double)MAX(writer->total, 1);
    if (!spore_progress_step(writer->progress, fraction, _("Writing the bundle"), &cancelled))
      return spore_error_propagate(&cancelled, error);
  }
  return TRUE;
}

static gboolean write_entry(Writer *writer, const char *name, const void *bytes, gsize size, GError **error) {
  if (!write_head(writer, name, size)) return pass_on(writer, error);
  return write_bytes(writer, bytes, size, error);
}

static gboolean write_scene(Writer *writer, GError **error) {
  gsize size;
  g_autofree char *text = spore_scene_format(writer->document, &size);
  return write_entry(writer, SCENE_NAME, text, size, error);
}

static gboolean write_file(Writer *writer, const char *name, GError **error) {
  g_autoptr(GBytes) content = spore_document_read_asset(writer->document, name, error);
  if (!content) return FALSE;
  gsize size = 0;
  const void *bytes = g_bytes_get_data(content, &size);
  return write_entry(writer, name, bytes, size, error);
}

static int compare(gconstpointer a, gconstpointer b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* The names of the files in their order, borrowed; NULL with the error where one cannot be in a bundle. */
static GPtrArray *names_of(Writer *writer, GError **error) {
  g_autoptr(GHashTable) files = spore_document_files(writer->document);
  g_autoptr(GPtrArray) names = g_ptr_array_new();
  GHashTableIter iterator;
  gpointer name;
  g_hash_table_iter_init(&iterator, files);
  while (g_hash_table_iter_next(&iterator, &name, NULL)) g_ptr_array_add(names, name);
  g_ptr_array_sort(names, compare);
  for (guint i = 0; i < names->len; i++) {
    g_autoptr(GBytes) content = NULL;
    if (!spore_bundle_check_name(writer->place, names->pdata[i], error) ||
        !(content = spore_document_read_asset(writer->document, names->pdata[i], error)))
      return NULL;
    writer->total += g_bytes_get_size(content);
  }
  if (writer->total <= SPORE_BUNDLE_BYTES) return g_steal_pointer(&names);
  refuse_room(writer->place, error);
  return NULL;
}

static gboolean write_all(Writer *writer, const GPtrArray *names, GError **error) {
  struct archive *archive = writer->archive;
  if (archive_write_set_format_zip(archive) != ARCHIVE_OK ||
      archive_write_zip_set_compression_deflate(archive) != ARCHIVE_OK ||
      archive_write_set_bytes_per_block(archive, 0) != ARCHIVE_OK ||
      archive_write_open(archive, writer->content, NULL, take, NULL) != ARCHIVE_OK)
    return pass_on(writer, error);
  gboolean done = write_scene(writer, error);
  for (guint i = 0; done && i < names->len; i++) done = write_file(writer, names->pdata[i], error);
  return done && (archive_write_close(archive) == ARCHIVE_OK || pass_on(writer, error));
}

static gboolean pack(Writer *writer, GError **error) {
  g_autoptr(GPtrArray) names = names_of(writer, error);
  if (!names) return FALSE;
  writer->archive = archive_write_new();
  if (!writer->archive)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, writer->place, "%s",
                             _("there is not enough memory for the bundle; close other programs"));
  gboolean done = write_all(writer, names, error);
  archive_write_free(writer->archive);
  return done;
}

/* What is handed out can be opened again. */
static gboolean check(const Writer *writer, GError **error) {
  SporeDocument *again = spore_bundle_parse(spore_document_schema(writer->document), writer->place,
                                            writer->content->data, writer->content->len, writer->progress, error);
  gboolean done = again != NULL;
  g_clear_pointer(&again, spore_document_free);
  return done;
}

GByteArray *spore_bundle_format(SporeDocument *document, const char *place, const SporeProgress *progress,
                                GError **error) {
  Writer writer = {.document = document, .place = place, .progress = progress, .content = g_byte_array_new()};
  SporeBundleLocale locale = spore_bundle_locale_begin();
  gboolean done = pack(&writer, error);
  spore_bundle_locale_end(locale);
  if (done && check(&writer, error)) return writer.content;
  g_byte_array_unref(writer.content);
  return NULL;
}
