/* Finds missing files again. What a file is for says how it is read; what was made from it, or its name, says whether
 * it is the same one. */
#include "core/author/locate.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/author/label_source.h"
#include "core/base/memory.h"
#include "core/haptic/track.h"
#include "core/io/file_content.h"
#include "core/io/organ.h"
#include "core/scene/texture.h"

#define LARGEST ((gsize)1 << 30) /* bytes; as of what a scene names */
#define HASH_DIGITS 8            /* in the name of a file that is named by its content */

/* A property that names the file. */
typedef struct Use {
  guint32 object; /* id */
  guint property;
} Use;

struct SporeLocateWork {
  SporeDocument *document; /* a copy, which gets each file that fits */
  char *missing, *file;
  GPtrArray *found; /* of Found * */
};

typedef struct Found {
  SporeLocatedFile told;
  char *name;      /* in the scene from now on */
  GBytes *content; /* to be saved as that; NULL: the file lies in the scene's folder */
} Found;

static void free_found(gpointer data) {
  Found *found = data;
  g_free(found->told.missing);
  g_free(found->told.place);
  g_free(found->told.refused);
  g_free(found->name);
  g_clear_pointer(&found->content, g_bytes_unref);
  g_free(found);
}

/* Properties that name files. */

/* Calls for each property of the object and of what it holds that names a file. */
static void each_file(SporeObject *object, void (*visit)(SporeObject *object, guint property, gpointer data),
                      gpointer data) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_FILE && spore_object_is_set(object, i)) visit(object, i, data);
  for (guint i = 0; i < spore_object_child_count(object); i++) each_file(spore_object_child(object, i), visit, data);
}

typedef struct Missing {
  SporeDocument *document;
  GPtrArray *files;
} Missing;

static void add_missing(SporeObject *object, guint property, gpointer data) {
  const Missing *missing = data;
  const char *file = spore_object_value(object, property)->text;
  if (g_ptr_array_find_with_equal_func(missing->files, file, g_str_equal, NULL)) return;
  if (!spore_document_has_file(missing->document, file)) g_ptr_array_add(missing->files, g_strdup(file));
}

GPtrArray *spore_missing_files(SporeDocument *document) {
  const Missing missing = {document, g_ptr_array_new_with_free_func(g_free)};
  each_file(spore_document_root(document), add_missing, (gpointer)&missing);
  return missing.files;
}

typedef struct Uses {
  const char *file;
  GArray *uses; /* of Use */
} Uses;

static void add_use(SporeObject *object, guint property, gpointer data) {
  const Uses *of = data;
  const Use use = {spore_object_id(object), property};
  if (g_str_equal(spore_object_value(object, property)->text, of->file)) g_array_append_val(of->uses, use);
}

/* g_array_unref. */
static GArray *uses_of(SporeDocument *document, const char *file) {
  const Uses of = {file, g_array_new(FALSE, FALSE, sizeof(Use))};
  each_file(spore_document_root(document), add_use, (gpointer)&of);
  return of.uses;
}

static gboolean rename_file(SporeDocument *document, const GArray *uses, const char *name, GError **error) {
  for (guint i = 0; i < uses->len; i++) {
    const Use *use = &g_array_index(uses, Use, i);
    SporeObject *object = spore_document_by_id(document, use->object);
    const SporeValue value = {.type = SPORE_FILE, .text = (char *)name};
    if (!spore_document_set(document, object, use->property, &value, error)) return FALSE;
  }
  return TRUE;
}

/* Whether a file is what the scene takes it for. */

static gboolean reads_track(const char *file, GBytes *content, GError **error) {
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  SporeTrack track = {0};
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_track_parse(&track, file, text, size, &fault)) return spore_error_propagate(&fault, error);
  spore_track_clear(&track);
  return TRUE;
}

/* Places of a texture are counted where their mesh is there. */
static gboolean reads_places(SporeDocument *document, const SporeObject *visual, const char *file, GBytes *content,
                             GError **error) {
  SporeObject *asset = spore_object_reference(visual, "mesh");
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, NULL) : NULL;
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  if (!mesh) return TRUE;
  float *places = spore_texture_places_parse(file, text, size, 3 * mesh->triangle_count, error);
  spore_free(places);
  return places != NULL;
}

/* A program that reads no label maps cannot tell. */
static gboolean reads_labels(const char *file, GBytes *content, const SporeProgress *progress, GError **error) {
  SporeLabelSource *source = spore_label_source_new_of(file, content);
  g_autoptr(GError) fault = NULL;
  gboolean done = spore_label_source_read(source, progress, &fault) != NULL ||
                  g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_UNSUPPORTED);
  spore_label_source_unref(source);
  if (!done) g_propagate_error(error, g_steal_pointer(&fault));
  return done;
}

static gboolean reads(SporeDocument *document, SporeObject *object, guint property, const char *place, GBytes *content,
                      const SporeProgress *progress, GError **error) {
  const char *element = spore_object_type(object)->element;
  int width, height;
  if (g_str_equal(element, "mesh")) return spore_document_mesh(document, object, error) != NULL;
  if (g_str_equal(element, "tetrahedra")) return spore_document_tetrahedra(document, object, error) != NULL;
  if (g_str_equal(element, "curve")) return spore_document_curve(document, object, error) != NULL;
  if (g_str_equal(element, "spheres")) return spore_document_spheres(document, object, error) != NULL;
  if (g_str_equal(element, "label_map")) return reads_labels(place, content, progress, error);
  if (g_str_equal(element, "track")) return reads_track(place, content, error);
  if (!g_str_equal(element, "visual")) return TRUE; /* a kept pose: it is read with its body */
  return g_str_equal(spore_object_type(object)->table->parameters[property].name, "texture")
             ? spore_texture_size(place, content, &width, &height, error)
             : reads_places(document, object, place, content, error);
}

/* The hash in the name of a file that is named by its content; NULL: there is none. One of decimal digits alone may be
 * a date. */
static const char *hash_in(const char *file) {
  const char *dash = strrchr(file, '-');
  if (!dash || strspn(dash + 1, "0123456789abcdef") != HASH_DIGITS || dash[1 + HASH_DIGITS] != '.') return NULL;
  return strspn(dash + 1, "0123456789") == HASH_DIGITS ? NULL : dash + 1;
}

static gboolean has_hash(const char *hash, GBytes *content) {
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  g_autofree char *name = spore_content_file_name("", "", bytes, size);
  return strncmp(name + 1, hash, HASH_DIGITS) == 0;
}

/* What was made from the asset knows the asset's hash. Of several things one may be stale; NULL: one of them fits, or
 * none knows. */
static SporeObject *made_from_another(SporeDocument *document, SporeObject *asset) {
  const SporeObject *assets = spore_document_section(document, "assets");
  SporeObject *another = NULL;
  g_autofree char *hash = spore_document_asset_hash(document, asset);
  for (guint i = 0; hash && i < spore_object_child_count(assets); i++) {
    SporeObject *made = spore_object_child(assets, i);
    if (spore_parameter_find(spore_object_type(made)->table, "source_hash") < 0) continue;
    const char *then = spore_object_text(made, "source_hash");
    if (!then || spore_object_reference(made, "source") != asset) continue;
    if (g_str_equal(then, hash)) return NULL;
    another = made;
  }
  return another;
}

static gboolean fits(SporeDocument *document, SporeObject *object, const Found *found, GBytes *content,
                     GError **error) {
  const char *missing = found->told.missing, *hash = hash_in(missing);
  if (hash && has_hash(hash, content)) return TRUE;
  if (hash)
    return spore_error_raise(error, SPORE_ERROR_INPUT, found->told.place,
                             _("its content is not that of \"%s\", whose name says it; expected that very file; choose "
                               "another one"),
                             missing);
  SporeObject *parent = spore_object_parent(object);
  gboolean asset = parent && g_str_equal(spore_object_type(parent)->element, "assets");
  const SporeObject *made = asset ? made_from_another(document, object) : NULL;
  return !made || spore_error_raise(error, SPORE_ERROR_INPUT, found->told.place,
                                    _("its content is not that of \"%s\" which \"%s\" was made from; expected that "
                                      "very file; choose another one, or give \"%s\" a new file"),
                                    missing, spore_object_name(made), spore_object_name(object));
}

/* Finding. */

/* "nii.gz" of what is packed. */
static const char *extension_of(const char *base) {
  const char *dot = strrchr(base, '.');
  if (!dot || dot == base) return "";
  if (!g_str_equal(dot, ".gz")) return dot + 1;
  const char *before = dot;
  while (before > base && before[-1] != '.') before--;
  return before > base + 1 ? before : dot + 1;
}

/* Name of the file inside the scene's folder; NULL: it lies elsewhere. g_free. */
static char *name_inside(SporeDocument *document, const char *place) {
  if (!spore_document_file(document)) return NULL;
  g_autofree char *scene = g_canonicalize_filename(spore_document_file(document), NULL);
  g_autofree char *folder = g_path_get_dirname(scene);
  g_autofree char *whole = g_canonicalize_filename(place, NULL);
  if (!g_str_has_prefix(whole, folder) || whole[strlen(folder)] != '/') return NULL;
  const char *name = whole + strlen(folder) + 1;
  return spore_document_has_file(document, name) ? g_strdup(name) : NULL;
}

static GBytes *read_file(const char *place, GError **error) {
  int fault;
  GByteArray *content = spore_file_content(place, LARGEST, &fault);
  if (content) return g_byte_array_free_to_bytes(content);
  spore_error_raise(error, SPORE_ERROR_FILE, place,
                    _("cannot be read (%s); expected the missing file, of at most 1 GiB; check the path"),
                    g_strerror(fault));
  return NULL;
}

static void name_found(const SporeLocateWork *work, Found *found, GBytes *content) {
  found->name = name_inside(work->document, found->told.place);
  if (found->name) return;
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  g_autofree char *base = g_path_get_basename(found->told.place);
  const char *extension = extension_of(base);
  g_autofree char *stem = g_strndup(base, strlen(base) - (*extension ? strlen(extension) + 1 : 0));
  g_autofree char *plain = spore_organ_name(stem);
  found->name = spore_content_file_name(plain, extension, bytes, size);
  found->content = g_bytes_ref(content);
}

/* What cannot be read was so far called by the name that it would have had. */
static void say_place(const Found *found, GError *error) {
  const char *name = strstr(error->message, found->name), *end = name ? name + strlen(found->name) : NULL;
  if (!name || *end != ':') return;
  char *said = g_strconcat(found->told.place, end, NULL);
  g_free(error->message);
  error->message = said;
}

static gboolean try_uses(const SporeLocateWork *work, const Found *found, const GArray *uses, GBytes *content,
                         const SporeProgress *progress, GError **error) {
  if (!rename_file(work->document, uses, found->name, error)) return FALSE;
  for (guint i = 0; i < uses->len; i++) {
    const Use *use = &g_array_index(uses, Use, i);
    SporeObject *object = spore_document_by_id(work->document, use->object);
    if (!reads(work->document, object, use->property, found->told.place, content, progress, error) ||
        !fits(work->document, object, found, content, error))
      return FALSE;
  }
  return TRUE;
}

/* Tries the file in the copy, which keeps it if it fits. */
static gboolean try_file(const SporeLocateWork *work, Found *found, const SporeProgress *progress, GError **error) {
  g_autoptr(GBytes) content = read_file(found->told.place, error);
  if (!content) return FALSE;
  name_found(work, found, content);
  if (found->content) spore_document_put_blob(work->document, found->name, content);
  g_autoptr(GArray) uses = uses_of(work->document, found->told.missing);
  spore_document_begin(work->document, _("Locate"));
  return spore_edit_finish(work->document, try_uses(work, found, uses, content, progress, error));
}

/* Where another missing file would lie if it lay beside the chosen one: in the same folder, or in the same way below
 * the folder that holds all. g_free; NULL: it does not. */
static char *place_beside(const SporeLocateWork *work, const char *missing) {
  g_autofree char *folder = g_path_get_dirname(work->file);
  g_autofree char *base = g_path_get_basename(missing);
  g_autofree char *beside = g_build_filename(folder, base, NULL);
  if (g_file_test(beside, G_FILE_TEST_IS_REGULAR)) return g_steal_pointer(&beside);
  if (!g_str_has_suffix(work->file, work->missing)) return NULL;
  g_autofree char *root = g_strndup(work->file, strlen(work->file) - strlen(work->missing));
  g_autofree char *below = g_build_filename(root, missing, NULL);
  return g_file_test(below, G_FILE_TEST_IS_REGULAR) ? g_steal_pointer(&below) : NULL;
}

SporeLocateWork *spore_locate_work_new(SporeDocument *document, const char *missing, const char *file) {
  SporeLocateWork *work = g_new0(SporeLocateWork, 1);
  work->document = spore_document_copy(document);
  work->missing = g_strdup(missing);
  work->file = g_strdup(file);
  work->found = g_ptr_array_new_with_free_func(free_found);
  return work;
}

void spore_locate_work_free(gpointer data) {
  SporeLocateWork *work = data;
  spore_document_free(work->document);
  g_free(work->missing);
  g_free(work->file);
  g_ptr_array_unref(work->found);
  g_free(work);
}

/* One of the missing files: the chosen one, or one that lies beside it. */
static gboolean find(SporeLocateWork *work, const char *missing, const SporeProgress *progress, GError **error) {
  gboolean chosen = g_str_equal(missing, work->missing);
  char *place = chosen ? g_strdup(work->file) : place_beside(work, missing);
  if (!place) return TRUE;
  Found *found = g_new0(Found, 1);
  found->told.missing = g_strdup(missing);
  found->told.place = place;
  g_ptr_array_add(work->found, found);
  g_autoptr(GError) fault = NULL;
  if (try_file(work, found, progress, &fault)) return TRUE;
  if (found->name) say_place(found, fault);
  if (chosen || g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_CANCELLED)) {
    g_propagate_error(error, g_steal_pointer(&fault));
    return FALSE;
  }
  found->told.refused = g_strdup(fault->message);
  return TRUE;
}

gboolean spore_locate_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeLocateWork *work = data;
  g_autoptr(GPtrArray) missing = spore_missing_files(work->document);
  SporeError fault = SPORE_ERROR_INIT;
  if (!g_ptr_array_find_with_equal_func(missing, work->missing, g_str_equal, NULL))
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->missing, "%s",
                             missing->len
                                 ? _("no such file is missing; expected one that the scene names and that is not "
                                     "there; `spore check` lists these")
                                 : _("no file of the scene is missing; expected one that is; there is nothing to do"));
  for (guint i = 0; i < missing->len; i++) {
    if (!spore_progress_step(progress, (double)i / missing->len, _("Reading assets"), &fault))
      return spore_error_propagate(&fault, error);
    if (!find(work, missing->pdata[i], progress, error)) return FALSE;
  }
  return TRUE;
}

const GPtrArray *spore_locate_work_found(const SporeLocateWork *work) { return work->found; }

static gboolean apply(const SporeLocateWork *work, SporeDocument *document, GError **error) {
  for (guint i = 0; i < work->found->len; i++) {
    const Found *found = work->found->pdata[i];
    if (found->told.refused) continue;
    g_autoptr(GArray) uses = uses_of(document, found->told.missing);
    if (uses->len == 0 || spore_document_has_file(document, found->told.missing))
      return spore_error_raise(error, SPORE_ERROR_INPUT, found->told.missing, "%s",
                               _("the file is not missing any more; the scene stays as it is"));
    if (found->content) spore_document_put_blob(document, found->name, found->content);
    if (!rename_file(document, uses, found->name, error)) return FALSE;
  }
  return TRUE;
}

gboolean spore_locate_work_apply(const SporeLocateWork *work, SporeDocument *document, GError **error) {
  spore_document_begin(document, _("Locate"));
  return spore_edit_finish(document, apply(work, document, error));
}
