/* Opens bundles. libarchive reads the zip, from memory. What the zip says of its files is checked for all of them
 * before the first one is unpacked, and what is unpacked is held against what the zip said. */
#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/bundle.h"
#include "core/io/bundle_locale.h"
#include "core/io/bundle_names.h"
#include "core/io/file_content.h"
#include "core/io/scene_markup.h"
#include "core/io/scene_xml.h"
#include "core/scene/document_private.h"
#include "core/scene/needs.h"

#define CHUNK (1u << 20) /* bytes between two looks whether to go on */

typedef struct Bundle {
  const char *place; /* the bundle's file, which begins messages */
  const void *content;
  gsize size;
  const SporeProgress *progress;
  GHashTable *files;   /* name -> its size, a pointer to guint64: owned */
  guint64 total, done; /* bytes: of all files, and unpacked so far of those that are wanted */
  const char *scene;   /* among the names */
} Bundle;

static gboolean refuse(const Bundle *bundle, GError **error, const char *format, ...) G_GNUC_PRINTF(3, 4);
static gboolean refuse(const Bundle *bundle, GError **error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  return spore_error_raise(error, SPORE_ERROR_INPUT, bundle->place, "%s", message);
}

static gboolean refuse_memory(const Bundle *bundle, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_MEMORY, bundle->place, "%s",
                           _("there is not enough memory for the bundle; close other programs"));
}

/* What libarchive found. */
static gboolean pass_on(const Bundle *bundle, struct archive *archive, GError **error) {
  if (archive_errno(archive) == ENOMEM) return refuse_memory(bundle, error);
  const char *reason = archive_error_string(archive);
  return refuse(bundle, error, _("the bundle is damaged (%s); expected a sound zip; copy it again"),
                reason ? reason : "zip");
}

/* Going through the files. */

typedef gboolean (*Visit)(Bundle *bundle, struct archive *archive, struct archive_entry *entry, const char *name,
                          GHashTable *wanted, GError **error);

static gboolean is_folder(struct archive_entry *entry) { return archive_entry_filetype(entry) == AE_IFDIR; }

/* The name of a file or folder; folders without the slash at their end. g_free; NULL with the error. */
static char *name_of(const Bundle *bundle, struct archive_entry *entry, GError **error) {
  const char *path = archive_entry_pathname(entry);
  g_autofree char *name = g_strdup(path);
  if (name && is_folder(entry) && g_str_has_suffix(name, "/")) name[strlen(name) - 1] = '\0';
  return spore_bundle_check_name(bundle->place, name, error) ? g_steal_pointer(&name) : NULL;
}

static gboolean visit_all(Bundle *bundle, struct archive *archive, Visit visit, GHashTable *wanted, GError **error) {
  struct archive_entry *entry;
  for (;;) {
    int found = archive_read_next_header(archive, &entry);
    if (found == ARCHIVE_EOF) return TRUE;
    if (found != ARCHIVE_OK) return pass_on(bundle, archive, error);
    g_autofree char *name = name_of(bundle, entry, error);
    if (!name || !visit(bundle, archive, entry, name, wanted, error)) return FALSE;
  }
}

/* Calls `visit` for each entry of the zip. wanted: handed on. */
static gboolean go_through(Bundle *bundle, Visit visit, GHashTable *wanted, GError **error) {
  struct archive *archive = archive_read_new();
  if (!archive) return refuse_memory(bundle, error);
  gboolean done = archive_read_support_format_zip_seekable(archive) == ARCHIVE_OK &&
                  archive_read_open_memory(archive, bundle->content, bundle->size) == ARCHIVE_OK;
  if (!done) pass_on(bundle, archive, error);
  done = done && visit_all(bundle, archive, visit, wanted, error);
  archive_read_free(archive);
  return done;
}

/* The survey. */

static guint64 most_bytes(const Bundle *bundle) {
  guint64 by_ratio = MAX(SPORE_BUNDLE_ANY_RATIO, (guint64)bundle->size * SPORE_BUNDLE_RATIO);
  return MIN(by_ratio, SPORE_BUNDLE_BYTES);
}

/* Ways of packing that every zip program knows; the others come with decoders that nobody needs here. */
static gboolean is_usual(struct archive *archive) {
  const char *format = archive_format_name(archive);
  return format && (strstr(format, "(deflation)") || strstr(format, "(uncompressed)"));
}

static gboolean check_kind(const Bundle *bundle, struct archive *archive, struct archive_entry *entry, const char *name,
                           GError **error) {
  if (archive_entry_is_encrypted(entry))
    return refuse(bundle, error, _("\"%s\" is encrypted; expected a bundle without a password; make it again"), name);
  if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry) || archive_entry_symlink(entry))
    return refuse(bundle, error, _("\"%s\" is a link or a device; expected files alone; do not open the bundle"), name);
  if (!archive_entry_size_is_set(entry) || archive_entry_size(entry) < 0)
    return refuse(bundle, error, _("\"%s\" has no size; expected a sound zip; make the bundle again"), name);
  return is_usual(archive) ||
         refuse(bundle, error,
                _("\"%s\" is packed in an unusual way; expected deflated or stored files; make the "
                  "bundle again"),
                name);
}

/* Notes the file, and whether the bundle still holds no more than it may. */
static gboolean note(Bundle *bundle, const char *name, guint64 size, GError **error) {
  if (g_hash_table_contains(bundle->files, name))
    return refuse(bundle, error, _("\"%s\" is in the bundle twice; expected names that differ; make the bundle again"),
                  name);
  char *key = g_strdup(name);
  g_hash_table_insert(bundle->files, key, g_memdup2(&size, sizeof size));
  if (size > most_bytes(bundle) - bundle->total)
    return refuse(
        bundle, error,
        _("the bundle of %.3g MB unpacks to over %.3g MB; expected less of a bundle of that size; do not open "
          "it"),
        1e-6 * (double)bundle->size, 1e-6 * (double)most_bytes(bundle));
  bundle->total += size;
  if (!g_str_has_suffix(name, ".spore")) return TRUE;
  if (bundle->scene)
    return refuse(bundle, error, _("the bundle holds two scenes, \"%s\" and \"%s\"; expected one; make it again"),
                  bundle->scene, name);
  bundle->scene = key;
  return TRUE;
}

static gboolean survey_entry(Bundle *bundle, struct archive *archive, struct archive_entry *entry, const char *name,
                             GHashTable *folders, GError **error) {
  if (!is_folder(entry))
    return check_kind(bundle, archive, entry, name, error) &&
           note(bundle, name, (guint64)archive_entry_size(entry), error);
  g_hash_table_add(folders, g_strdup(name));
  return TRUE;
}

/* Whether none of the folders is a file, too. */
static gboolean check_folders(const Bundle *bundle, GHashTable *folders, GError **error) {
  GHashTableIter iterator;
  gpointer name;
  g_hash_table_iter_init(&iterator, folders);
  while (g_hash_table_iter_next(&iterator, &name, NULL))
    if (g_hash_table_contains(bundle->files, name))
      return refuse(bundle, error,
                    _("\"%s\" is a file and a folder; expected the one or the other; make the bundle again"),
                    (const char *)name);
  return spore_bundle_check_folders(bundle->place, bundle->files, error);
}

static gboolean survey(Bundle *bundle, GError **error) {
  g_autoptr(GHashTable) folders = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
  if (!go_through(bundle, survey_entry, folders, error) || !check_folders(bundle, folders, error)) return FALSE;
  if (!bundle->scene || strchr(bundle->scene, '/'))
    return refuse(bundle, error, "%s",
                  _("the bundle holds no scene; expected one .spore file, in no folder; make it with spore export"));
  const guint64 *size = g_hash_table_lookup(bundle->files, bundle->scene);
  return *size <= SPORE_LARGEST_SCENE ||
         refuse(bundle, error, _("the scene has over %u MiB; expected less; keep meshes in files of their own"),
                SPORE_LARGEST_SCENE >> 20);
}

/* Unpacking. */

static gboolean tell_progress(Bundle *bundle, gsize more, GError **error) {
  bundle->done += more;
  SporeError cancelled = SPORE_ERROR_INIT;
  double fraction = (double)bundle->done / (double)MAX(bundle->total, 1);
  return spore_progress_step(bundle->progress, fraction, _("Opening the bundle"), &cancelled) ||
         spore_error_propagate(&cancelled, error);
}

/* Fills `content`, of size + 1 bytes, with the file; one byte more than it should have is damage. */
static gboolean unpack_into(Bundle *bundle, struct archive *archive, const char *name, guint8 *content, gsize size,
                            GError **error) {
  gsize have = 0;
  for (;;) {
    la_ssize_t got = archive_read_data(archive, content + have, MIN(size + 1 - have, CHUNK));
    if (got < 0) return pass_on(bundle, archive, error);
    have += (gsize)got;
    if (!tell_progress(bundle, (gsize)got, error)) return FALSE;
    if (got == 0 && have == size) return TRUE;
    if (got == 0 || have > size)
      return refuse(bundle, error,
                    _("\"%s\" has another size than the bundle says; expected a sound zip; copy it again"), name);
  }
}

static gboolean unpack_entry(Bundle *bundle, struct archive *archive, struct archive_entry *entry, const char *name,
                             GHashTable *wanted, GError **error) {
  if (is_folder(entry) || !g_hash_table_contains(wanted, name)) return TRUE;
  gsize size = *(const guint64 *)g_hash_table_lookup(bundle->files, name);
  guint8 *content = spore_allocate(size + 1, 1);
  if (!content) return refuse_memory(bundle, error);
  if (!unpack_into(bundle, archive, name, content, size, error)) {
    spore_free(content);
    return FALSE;
  }
  g_hash_table_insert(wanted, g_strdup(name), g_bytes_new_with_free_func(content, size, spore_free, content));
  return TRUE;
}

static void free_bytes(gpointer content) {
  if (content) g_bytes_unref(content);
}

/* A set of names, each of which gets the content of the file. */
static GHashTable *wanted_new(void) { return g_hash_table_new_full(g_str_hash, g_str_equal, g_free, free_bytes); }

static SporeDocument *read_scene(Bundle *bundle, const SporeSchema *schema, GError **error) {
  g_autoptr(GHashTable) wanted = wanted_new();
  g_hash_table_insert(wanted, g_strdup(bundle->scene), NULL);
  if (!go_through(bundle, unpack_entry, wanted, error)) return NULL;
  gsize size = 0;
  const char *text = g_bytes_get_data(g_hash_table_lookup(wanted, bundle->scene), &size);
  SporeDocument *document = spore_scene_parse(schema, bundle->place, text, size, error);
  if (document) spore_document_set_bundle(document, bundle->place);
  return document;
}

static gboolean read_files(Bundle *bundle, SporeDocument *document, GError **error) {
  g_autoptr(GHashTable) wanted = wanted_new(), named = spore_document_files(document);
  GHashTableIter iterator;
  gpointer name, content;
  g_hash_table_iter_init(&iterator, named);
  while (g_hash_table_iter_next(&iterator, &name, NULL)) {
    if (!g_hash_table_contains(bundle->files, name))
      return refuse(bundle, error,
                    _("the scene names the file \"%s\", which is not in the bundle; expected all files of the scene; "
                      "make the bundle again"),
                    (const char *)name);
    g_hash_table_insert(wanted, g_strdup(name), NULL);
  }
  if (!go_through(bundle, unpack_entry, wanted, error)) return FALSE;
  g_hash_table_iter_init(&iterator, wanted);
  while (g_hash_table_iter_next(&iterator, &name, &content)) spore_document_put_blob(document, name, content);
  return TRUE;
}

static SporeDocument *open_bundle(Bundle *bundle, const SporeSchema *schema, GError **error) {
  if (!spore_bundle_check_table(bundle->place, bundle->content, bundle->size, error) || !survey(bundle, error))
    return NULL;
  SporeDocument *document = read_scene(bundle, schema, error);
  if (document && !read_files(bundle, document, error)) g_clear_pointer(&document, spore_document_free);
  return document;
}

SporeDocument *spore_bundle_parse(const SporeSchema *schema, const char *file, const void *content, gsize size,
                                  const SporeProgress *progress, GError **error) {
  Bundle bundle = {.place = file, .content = content, .size = size, .progress = progress};
  bundle.files = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
  SporeBundleLocale locale = spore_bundle_locale_begin();
  SporeDocument *document = open_bundle(&bundle, schema, error);
  spore_bundle_locale_end(locale);
  g_hash_table_unref(bundle.files);
  return document;
}

static void say_why(const char *file, int fault, GError **error) {
  if (fault == EFBIG)
    spore_error_raise(error, SPORE_ERROR_INPUT, file, _("the bundle has over %u MiB; expected less; leave out meshes"),
                      SPORE_BUNDLE_BYTES >> 20);
  else
    spore_error_raise(error, SPORE_ERROR_FILE, file,
                      _("cannot be read: %s; expected a .sporez file; correct the name, or check its permissions"),
                      g_strerror(fault));
}

SporeDocument *spore_bundle_load(const SporeSchema *schema, const char *file, const SporeProgress *progress,
                                 GError **error) {
  int fault = 0;
  g_autoptr(GByteArray) content = spore_file_content(file, SPORE_BUNDLE_BYTES, &fault);
  if (content) return spore_bundle_parse(schema, file, content->data, content->len, progress, error);
  say_why(file, fault, error);
  return NULL;
}
