/* Content of assets: found, read without leaving the folder, and decoded once for each content. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/scene/beneath.h"
#include "core/scene/document_private.h"

#define LARGEST_ASSET (G_GUINT64_CONSTANT(1) << 30) /* bytes */

/* A decoded asset. References are counted, because copies of a document share it. */
typedef struct Decoded {
  SporeTriangleMesh mesh;
  SporeSphereSet spheres;
  SporeTetrahedralMesh tetrahedra;
  SporeCurve curve;
  char hash[17];
} Decoded;

/* Where an asset's content was when it was last decoded. An unchanged place has unchanged content. */
typedef struct Located {
  char *place;
  const Decoded *decoded;
  GError *fault; /* set instead of `decoded`: content that cannot be decoded is not tried again */
} Located;

static void clear_decoded(gpointer data) {
  Decoded *decoded = data;
  spore_triangle_mesh_clear(&decoded->mesh);
  spore_sphere_set_clear(&decoded->spheres);
  spore_tetrahedral_mesh_clear(&decoded->tetrahedra);
  spore_curve_clear(&decoded->curve);
}

static void unref_decoded(gpointer data) { g_atomic_rc_box_release_full(data, clear_decoded); }

static void free_located(gpointer data) {
  Located *located = data;
  g_free(located->place);
  g_clear_error(&located->fault);
  g_free(located);
}

static void free_blob(gpointer data) {
  SporeBlob *blob = data;
  g_bytes_unref(blob->content);
  g_free(blob);
}

void spore_assets_init(SporeDocument *document) {
  document->blobs = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, free_blob);
  document->located = g_hash_table_new_full(NULL, NULL, NULL, free_located);
  document->decoded = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, unref_decoded);
}

void spore_assets_free(SporeDocument *document) {
  g_hash_table_unref(document->blobs);
  g_hash_table_unref(document->located);
  g_hash_table_unref(document->decoded);
}

void spore_document_set_readers(SporeDocument *document, const SporeAssetReaders *readers) {
  document->readers = *readers;
}

void spore_document_put_blob(SporeDocument *document, const char *file, GBytes *content) {
  SporeBlob *blob = g_new0(SporeBlob, 1);
  blob->content = g_bytes_ref(content);
  blob->serial = ++document->last_blob;
  g_hash_table_insert(document->blobs, g_strdup(file), blob);
}

/* Files. */

static gboolean say_why(int fault, const char *place, const char *file, GError **error) {
  if (fault == EXDEV || fault == ELOOP)
    return spore_error_raise(error, SPORE_ERROR_FILE, place,
                             _("\"%s\" leads out of the scene's folder; expected a file inside it; copy it there"),
                             file);
  if (fault == ENOMEM)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, place,
                             _("there is not enough memory to read \"%s\"; close other programs or make it smaller"),
                             file);
  if (fault == ENOENT || fault == ENOTDIR)
    return spore_error_raise(
        error, SPORE_ERROR_FILE, place,
        _("there is no file \"%s\" in the scene's folder; put it there, locate it (spore edit --locate) or "
          "correct the name"),
        file);
  return spore_error_raise(error, SPORE_ERROR_FILE, place, _("\"%s\" cannot be read: %s; check its permissions"), file,
                           g_strerror(fault));
}

int spore_document_open_asset(const SporeDocument *document, const char *place, const char *file, GError **error) {
  if (!document->file) {
    spore_error_raise(error, SPORE_ERROR_FILE, place,
                      _("\"%s\" is relative to the scene's folder, and the scene has none yet; save the scene first"),
                      file);
    return -1;
  }
  g_autofree char *folder = g_path_get_dirname(document->file);
  int directory = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) {
    say_why(errno, place, folder, error);
    return -1;
  }
  int descriptor = spore_open_beneath(directory, file, O_RDONLY | O_NONBLOCK | O_NOCTTY, 0);
  int fault = errno;
  close(directory);
  struct stat status;
  if (descriptor < 0) {
    say_why(fault, place, file, error);
  } else if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    spore_error_raise(error, SPORE_ERROR_FILE, place, _("\"%s\" is not a regular file; expected one; correct the name"),
                      file);
  } else if ((guint64)status.st_size > LARGEST_ASSET) {
    spore_error_raise(error, SPORE_ERROR_FILE, place, _("\"%s\" has over 1 GiB; expected less; reduce its resolution"),
                      file);
  } else {
    return descriptor;
  }
  if (descriptor >= 0) close(descriptor);
  return -1;
}

/* Reads the file up to the size limit, even if the file grows meanwhile. */
static GBytes *read_all(int descriptor, const char *place, const char *file, GError **error) {
  struct stat status;
  if (fstat(descriptor, &status) != 0) return say_why(errno, place, file, error), NULL;
  gsize capacity = (gsize)status.st_size + 1, size = 0;
  guint8 *content = spore_allocate(capacity, 1);
  if (!content) return say_why(ENOMEM, place, file, error), NULL;
  for (;;) {
    ssize_t got = read(descriptor, content + size, capacity - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      say_why(errno, place, file, error);
      spore_free(content);
      return NULL;
    }
    size += (gsize)got;
    if (got == 0 || size == capacity)
      return g_bytes_new_with_free_func(content, MIN(size, (gsize)status.st_size), spore_free, content);
  }
}

static GBytes *read_asset(const SporeDocument *document, const char *place, const char *file, GError **error) {
  const SporeBlob *blob = g_hash_table_lookup(document->blobs, file);
  if (blob) return g_bytes_ref(blob->content);
  int descriptor = spore_document_open_asset(document, place, file, error);
  if (descriptor < 0) return NULL;
  GBytes *content = read_all(descriptor, place, file, error);
  close(descriptor);
  return content;
}

GBytes *spore_document_read_asset(SporeDocument *document, const char *file, GError **error) {
  return read_asset(document, NULL, file, error);
}

gboolean spore_document_has_file(const SporeDocument *document, const char *file) {
  if (g_hash_table_contains(document->blobs, file)) return TRUE;
  int descriptor = spore_document_open_asset(document, NULL, file, NULL);
  if (descriptor >= 0) close(descriptor);
  return descriptor >= 0;
}

/* Moving. */

/* Keeps a file's content as a blob. A file that cannot be read is left out: it was unreadable in the old place too. */
static void keep_asset(SporeDocument *document, const char *file, GHashTable *moved) {
  if (!file || g_hash_table_contains(moved, file) || g_hash_table_contains(document->blobs, file)) return;
  g_autoptr(GBytes) content = read_asset(document, NULL, file, NULL);
  if (content) spore_document_put_blob(document, file, content);
}

static void keep_assets_of_steps(SporeDocument *document, const GPtrArray *steps, GHashTable *moved) {
  for (guint i = 0; i < steps->len; i++) {
    const SporeUndoStep *step = g_ptr_array_index(steps, i);
    for (guint k = 0; k < step->edits->len; k++) {
      const SporeEdit *edit = &g_array_index(step->edits, SporeEdit, k);
      if (edit->kind == SPORE_EDIT_SET && edit->slot.set && edit->slot.value.type == SPORE_FILE)
        keep_asset(document, edit->slot.value.text, moved);
    }
  }
}

void spore_document_keep_assets(SporeDocument *document, GHashTable *moved) {
  GHashTableIter iterator;
  gpointer value;
  g_hash_table_iter_init(&iterator, document->objects); /* detached ones too */
  while (g_hash_table_iter_next(&iterator, NULL, &value)) {
    const SporeObject *object = value;
    const SporeParameterTable *table = object->type->table;
    for (size_t i = 0; i < table->count; i++)
      if (table->parameters[i].type == SPORE_FILE && object->slots[i].set)
        keep_asset(document, object->slots[i].value.text, moved);
  }
  keep_assets_of_steps(document, document->undo, moved);
  keep_assets_of_steps(document, document->redo, moved);
}

static void share_blob(SporeDocument *to, const char *file, const SporeBlob *blob) {
  SporeBlob *shared = g_memdup2(blob, sizeof *blob);
  g_bytes_ref(shared->content);
  g_hash_table_insert(to->blobs, g_strdup(file), shared);
}

static void share_located(SporeDocument *to, gpointer id, const Located *located) {
  Located *shared = g_new0(Located, 1);
  shared->place = g_strdup(located->place);
  shared->decoded = located->decoded;
  shared->fault = located->fault ? g_error_copy(located->fault) : NULL;
  g_hash_table_insert(to->located, id, shared);
}

void spore_document_share_assets(SporeDocument *to, const SporeDocument *from) {
  GHashTableIter iterator;
  gpointer key, value;
  to->readers = from->readers;
  to->last_blob = from->last_blob;
  g_hash_table_iter_init(&iterator, from->blobs);
  while (g_hash_table_iter_next(&iterator, &key, &value)) share_blob(to, key, value);
  g_hash_table_iter_init(&iterator, from->decoded);
  while (g_hash_table_iter_next(&iterator, &key, &value))
    g_hash_table_insert(to->decoded, g_strdup(key), g_atomic_rc_box_acquire(value));
  g_hash_table_iter_init(&iterator, from->located);
  while (g_hash_table_iter_next(&iterator, &key, &value)) share_located(to, key, value);
}

/* Decoding. */

/* A text that is the same as long as the content is the same. g_free. */
static char *locate(const SporeDocument *document, const char *place, const char *file, const char *options,
                    GError **error) {
  const SporeBlob *blob = g_hash_table_lookup(document->blobs, file);
  if (blob) return g_strdup_printf("blob %" G_GUINT64_FORMAT " %s", blob->serial, options);
  int descriptor = spore_document_open_asset(document, place, file, error);
  if (descriptor < 0) return NULL;
  struct stat status = {0};
  fstat(descriptor, &status);
  close(descriptor);
  return g_strdup_printf("file %ju %ju %jd %jd.%ld %s", (uintmax_t)status.st_dev, (uintmax_t)status.st_ino,
                         (intmax_t)status.st_size, (intmax_t)status.st_mtim.tv_sec, status.st_mtim.tv_nsec, options);
}

/* content: the bytes of an asset that is not decoded here; else NULL. */
static void write_hash(Decoded *decoded, GBytes *content) {
  guint64 hash = SPORE_HASH_INIT;
  gsize size = 0;
  const void *bytes = content ? g_bytes_get_data(content, &size) : NULL;
  if (content) hash = spore_hash(hash, bytes, size);
  const SporeTriangleMesh *mesh = &decoded->mesh;
  const SporeTetrahedralMesh *tetrahedra = &decoded->tetrahedra;
  hash = spore_hash(hash, mesh->vertices, mesh->vertex_count * 3 * sizeof(double));
  hash = spore_hash(hash, mesh->triangles, mesh->triangle_count * 3 * sizeof(uint32_t));
  hash = spore_hash(hash, tetrahedra->vertices, tetrahedra->vertex_count * 3 * sizeof(double));
  hash = spore_hash(hash, tetrahedra->tetrahedra, tetrahedra->tetrahedron_count * 4 * sizeof(uint32_t));
  hash = spore_hash(hash, decoded->spheres.spheres, decoded->spheres.count * 4 * sizeof(double));
  if (decoded->spheres.weights) {
    hash = spore_hash(hash, decoded->spheres.weights, decoded->spheres.count * sizeof(double));
    hash = spore_hash(hash, &decoded->spheres.level, sizeof(double));
  }
  hash = spore_hash(hash, decoded->curve.points, decoded->curve.count * 4 * sizeof(double));
  g_snprintf(decoded->hash, sizeof decoded->hash, "%016" G_GINT64_MODIFIER "x", hash);
}

/* The path of a file as messages show it. g_free. */
static char *path_of(const SporeDocument *document, const char *file) {
  if (!document->file) return g_strdup(file);
  g_autofree char *folder = g_path_get_dirname(document->file);
  return strcmp(folder, ".") == 0 ? g_strdup(file) : g_build_filename(folder, file, NULL);
}

static Decoded *decode(SporeDocument *document, const SporeObject *asset, GBytes *content, GError **error) {
  const SporeAssetReaders *readers = &document->readers;
  const char *element = asset->type->element, *file = spore_object_text(asset, "file");
  g_autofree char *place = path_of(document, file);
  Decoded *decoded = g_atomic_rc_box_new0(Decoded);
  gboolean done,
      label_map = strcmp(element, "label_map") == 0; /* a label map is not decoded: its bytes alone are hashed */
  if (label_map) done = TRUE;
  else if (strcmp(element, "mesh") == 0 && readers->mesh)
    done = readers->mesh(place, file, content, (int)spore_object_number(asset, "unit"),
                         (int)spore_object_number(asset, "frame"), &decoded->mesh, error);
  else if (strcmp(element, "spheres") == 0 && readers->spheres)
    done = readers->spheres(place, file, content, &decoded->spheres, error);
  else if (strcmp(element, "tetrahedra") == 0 && readers->tetrahedra)
    done = readers->tetrahedra(place, file, content, &decoded->tetrahedra, error);
  else if (strcmp(element, "curve") == 0 && readers->curve)
    done = readers->curve(place, file, content, &decoded->curve, error);
  else
    done = spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, place,
                             _("no reader for %s here; expected a mesh, spheres, "
                               "tetrahedra or a curve; name one of these"),
                             element);
  if (done) {
    write_hash(decoded, label_map ? content : NULL);
    return decoded;
  }
  unref_decoded(decoded);
  return NULL;
}

/* The same for the same content: 128 bits and the size. A digest of a large mesh would hold a window, and nobody is
 * kept from making two files alike in a scene of their own. g_free. */
static char *key_of(GBytes *content, const char *options) {
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  guint64 first = spore_hash(SPORE_HASH_INIT, bytes, size), second = spore_hash(~SPORE_HASH_INIT, bytes, size);
  return g_strdup_printf("%016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x %zu %s", first, second, size, options);
}

static const Decoded *decode_content(SporeDocument *document, const SporeObject *asset, const char *place,
                                     const char *options, GError **error) {
  g_autoptr(GBytes) content = read_asset(document, place, spore_object_text(asset, "file"), error);
  if (!content) return NULL;
  g_autofree char *key = key_of(content, options);
  Decoded *decoded = g_hash_table_lookup(document->decoded, key);
  if (decoded) return decoded;
  decoded = decode(document, asset, content, error);
  if (decoded) g_hash_table_insert(document->decoded, g_steal_pointer(&key), decoded);
  return decoded;
}

/* Takes over place and fault. */
static const Located *remember(SporeDocument *document, const SporeObject *asset, char *place, const Decoded *decoded,
                               GError *fault) {
  Located *located = g_new0(Located, 1);
  located->place = place, located->decoded = decoded, located->fault = fault;
  g_hash_table_insert(document->located, GUINT_TO_POINTER(asset->id), located);
  return located;
}

static const Decoded *find(SporeDocument *document, const SporeObject *asset, GError **error) {
  g_autofree char *where = spore_object_where(asset);
  const char *file = spore_object_text(asset, "file"), *element = asset->type->element;
  if (!file) {
    spore_error_raise(error, SPORE_ERROR_INPUT, where,
                      _("the %s has no file; expected one inside the scene's folder; set it"), element);
    return NULL;
  }
  g_autofree char *options = strcmp(element, "mesh") != 0
                                 ? g_strdup(element)
                                 : g_strdup_printf("mesh %s %d %d", file, (int)spore_object_number(asset, "unit"),
                                                   (int)spore_object_number(asset, "frame"));
  g_autofree char *place = locate(document, where, file, options, error);
  if (!place) return NULL;
  const Located *known = g_hash_table_lookup(document->located, GUINT_TO_POINTER(asset->id));
  if (!known || strcmp(known->place, place) != 0) {
    GError *fault = NULL;
    const Decoded *decoded = decode_content(document, asset, where, options, &fault);
    if (fault && !g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_INPUT)) {
      g_propagate_error(error, fault);
      return NULL;
    }
    known = remember(document, asset, g_steal_pointer(&place), decoded, fault);
  }
  if (known->fault && error) *error = g_error_copy(known->fault);
  return known->decoded;
}

const SporeTriangleMesh *spore_document_mesh(SporeDocument *document, SporeObject *asset, GError **error) {
  const Decoded *decoded = find(document, asset, error);
  return decoded ? &decoded->mesh : NULL;
}

const SporeSphereSet *spore_document_spheres(SporeDocument *document, SporeObject *asset, GError **error) {
  const Decoded *decoded = find(document, asset, error);
  return decoded ? &decoded->spheres : NULL;
}

const SporeTetrahedralMesh *spore_document_tetrahedra(SporeDocument *document, SporeObject *asset, GError **error) {
  const Decoded *decoded = find(document, asset, error);
  return decoded ? &decoded->tetrahedra : NULL;
}

const SporeCurve *spore_document_curve(SporeDocument *document, SporeObject *asset, GError **error) {
  const Decoded *decoded = find(document, asset, error);
  return decoded ? &decoded->curve : NULL;
}

char *spore_document_asset_hash(SporeDocument *document, SporeObject *asset) {
  const Decoded *decoded = find(document, asset, NULL);
  return decoded ? g_strdup(decoded->hash) : NULL;
}
