/* Imports mesh files and label maps as bodies: reads, divides or joins, repairs, and inserts them into the scene. */
#include "core/author/organ_import.h"

#include <errno.h>
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

#include "core/author/anatomy.h"
#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/generate/labels/labels.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/mesh/edit.h"
#include "core/scene/texture.h"

#define LABEL_ROUNDS 100 /* rounds of smoothing: fewer rounds leave the terraces of the voxels */
#define MOST_BYTES ((goffset)1 << 30)

typedef struct Intake {
  const SporeImportOptions *options;
  SporeImport *import;
  guint file_count;
  SporeProgressShare step; /* the one at work */
} Intake;

static void free_file(SporeImportFile *file) {
  g_free(file->file);
  g_free(file->undescribed);
  g_clear_pointer(&file->content, g_bytes_unref);
  g_free(file);
}

static void clear_texture(SporeImportTexture *texture) {
  g_clear_pointer(&texture->picture, g_bytes_unref);
  spore_triangle_mesh_clear(&texture->mesh);
  spore_free(texture->places);
}

/* The body is drawn in its colour alone. */
static void drop_texture(SporeImportBody *body) {
  if (body->texture) g_rc_box_release_full(body->texture, (GDestroyNotify)clear_texture);
  body->texture = NULL;
  g_clear_pointer(&body->places, spore_free);
}

static void free_body(SporeImportBody *body) {
  drop_texture(body);
  g_free(body->untextured);
  g_free(body->unclear);
  g_free(body->name);
  g_free(body->group);
  spore_triangle_mesh_clear(&body->mesh);
  g_array_unref(body->changes);
  g_free(body);
}

void spore_import_free(SporeImport *import) {
  g_ptr_array_unref(import->bodies);
  g_ptr_array_unref(import->files);
  g_ptr_array_unref(import->left_out);
  g_free(import);
}

/* Only regular files are read: a pipe or a device might never end. */
GBytes *spore_import_read_content(const char *file, GError **error) {
  struct stat info;
  char *bytes = NULL;
  gsize size = 0;
  g_autoptr(GError) cause = NULL;
  if (stat(file, &info) != 0)
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("cannot be read (%s); expected a mesh; check the path"),
                      g_strerror(errno));
  else if (!S_ISREG(info.st_mode))
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("is not a regular file; expected a mesh; name such a file"));
  else if (info.st_size > MOST_BYTES)
    spore_error_raise(error, SPORE_ERROR_INPUT, file,
                      _("the file has over 1 GiB; expected a smaller one; decimate the mesh first"));
  else if (!g_file_get_contents(file, &bytes, &size, &cause))
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("cannot be read (%s); expected a mesh; check the path"),
                      cause->message);
  return bytes ? g_bytes_new_take(bytes, size) : NULL;
}

/* The picture of a part, or the places for one, with the mesh that wears it now; NULL: it has none. NULL with a
 * failure: no memory. */
static SporeImportTexture *texture_of(SporeMeshPart *part, SporeError *failure) {
  if (!part->places) return NULL;
  SporeTriangleMesh mesh;
  if (!spore_triangle_mesh_copy(&mesh, &part->mesh, failure)) return NULL;
  SporeImportTexture *texture = g_rc_box_new0(SporeImportTexture);
  texture->mesh = mesh;
  texture->picture = part->picture ? g_bytes_ref(part->picture) : NULL;
  texture->places = g_steal_pointer(&part->places);
  return texture;
}

/* Takes the mesh over. part: says group and colour; NULL: nothing says them. */
static void add_body(Intake *intake, const char *name, const SporeImportFile *source, const SporeMeshPart *part,
                     SporeImportTexture *texture, SporeTriangleMesh *mesh, bool changed) {
  SporeImportBody *body = g_new0(SporeImportBody, 1);
  body->name = g_strdup(name);
  body->group = g_strdup(part ? part->group : "");
  body->coloured = part && part->coloured;
  body->opacity = part ? part->opacity : 1;
  if (part) memcpy(body->colour, part->colour, sizeof body->colour);
  body->texture = texture ? g_rc_box_acquire(texture) : NULL;
  body->untextured = g_strdup(part ? part->untextured : NULL);
  body->unclear = g_strdup(part ? part->unclear : NULL);
  body->source = source;
  body->mesh = *mesh;
  body->changed = changed;
  body->changes = g_array_new(FALSE, FALSE, sizeof(SporeMeshChange));
  *mesh = (SporeTriangleMesh){0};
  g_ptr_array_add(intake->import->bodies, body);
}

static char *stem_of(const char *file) {
  char *base = g_path_get_basename(file), *dot = strrchr(base, '.');
  if (dot && dot != base) *dot = '\0';
  return base;
}

static gboolean too_many(const char *place, gsize count, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                           _("it falls into %zu pieces; expected at most %u bodies; import it as one, or remove the "
                             "small pieces first"),
                           count, SPORE_IMPORT_BODIES_MAXIMUM);
}

static gboolean add_pieces(Intake *intake, const char *name, const SporeImportFile *file, SporeMeshPart *part,
                           SporeImportTexture *texture, GError **error) {
  SporeTriangleMesh *mesh = &part->mesh;
  SporeError failure = SPORE_ERROR_INIT;
  uint32_t *pieces = NULL;
  gsize count = 0;
  gboolean done = spore_triangle_mesh_pieces(mesh, &pieces, &count, &failure) || spore_error_propagate(&failure, error);
  if (done && count > SPORE_IMPORT_BODIES_MAXIMUM) done = too_many(file->file, count, error);
  for (gsize p = 0; done && p < count && count > 1; p++) {
    SporeTriangleMesh piece;
    done = spore_triangle_mesh_extract(mesh, pieces, (uint32_t)p, &piece, &failure) ||
           spore_error_propagate(&failure, error);
    if (done) add_body(intake, name, file, part, texture, &piece, true);
  }
  if (done && count == 1) add_body(intake, name, file, part, texture, mesh, false);
  spore_free(pieces);
  return done;
}

/* Adds a body for each label. The staircase of voxels is smoothed away, and the volume stays. */
static gboolean add_labels(Intake *intake, SporeImportFile *file, const void *bytes, gsize size, GError **error) {
  SporeProgress progress = spore_progress_of_share(&intake->step);
  SporeError failure = SPORE_ERROR_INIT;
  SporeLabelMap map;
  if (!spore_label_map_decode(file->file, bytes, size, &map, &progress, error)) return FALSE;
  g_autoptr(GArray) labels = NULL, voxels = NULL;
  g_autoptr(GHashTable) names = spore_label_map_names(bytes, size);
  g_autofree char *stem = stem_of(file->file);
  spore_label_map_list(&map, &labels, &voxels);
  gboolean done = labels->len > 0 && labels->len <= SPORE_IMPORT_BODIES_MAXIMUM;
  if (!done)
    spore_error_raise(error, SPORE_ERROR_INPUT, file->file,
                      _("it has %u labels above 0; expected 1 to %u; is it a segmentation?"), labels->len,
                      SPORE_IMPORT_BODIES_MAXIMUM);
  for (guint i = 0; done && i < labels->len; i++) {
    guint16 label = g_array_index(labels, guint16, i);
    SporeTriangleMesh surface = {0};
    const char *said = g_hash_table_lookup(names, GUINT_TO_POINTER((guint)label));
    g_autofree char *name = said ? g_strdup(said) : g_strdup_printf("%s-%u", stem, label);
    done = (spore_label_surface(&map, label, &surface, &progress, &failure) &&
            spore_triangle_mesh_smooth(&surface, LABEL_ROUNDS, &progress, &failure)) ||
           spore_error_propagate(&failure, error);
    done = done && spore_mesh_tidy(name, &surface, error);
    if (done) add_body(intake, name, file, NULL, NULL, &surface, true);
    else spore_triangle_mesh_clear(&surface);
  }
  spore_label_map_clear(&map);
  return done;
}

/* Whether the format itself prescribes metres. */
static gboolean says_metres(const char *path, const char *bytes, gsize size) {
  g_autofree char *small = g_ascii_strdown(path, -1);
  return (size >= 4 && memcmp(bytes, "glTF", 4) == 0) || g_str_has_suffix(small, ".gltf");
}

/* The unit in which all parts together have the size of an organ or an instrument. */
static int guess_unit(const GPtrArray *parts) {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, diagonal = 0;
  for (guint p = 0; p < parts->len; p++) {
    const SporeTriangleMesh *mesh = &((const SporeMeshPart *)g_ptr_array_index(parts, p))->mesh;
    for (gsize i = 0; i < 3 * mesh->vertex_count; i++) {
      lower[i % 3] = fmin(lower[i % 3], mesh->vertices[i]);
      upper[i % 3] = fmax(upper[i % 3], mesh->vertices[i]);
    }
  }
  for (int k = 0; k < 3; k++) diagonal = hypot(diagonal, upper[k] - lower[k]);
  return MAX(spore_length_unit_guess(diagonal), 0);
}

/* The parts of a mesh file, in metres. Where no unit is given, the parts are read first to find their size. */
static GPtrArray *read_parts(Intake *intake, SporeImportFile *file, const void *bytes, gsize size, GError **error) {
  SporeProgress progress = spore_progress_of_share(&intake->step);
  gboolean named = intake->options->division == SPORE_IMPORT_PARTS;
  g_autoptr(SporeMeshBeside) beside = spore_mesh_beside_read(file->file, file->content);
  file->undescribed = g_strdup(beside->reason);
  file->unit = MAX(intake->options->unit, 0);
  g_autoptr(GPtrArray) parts = spore_mesh_decode_parts(file->file, bytes, size, beside, file->unit, file->frame, named,
                                                       &file->parts, &progress, error);
  if (!parts || intake->options->unit >= 0 || says_metres(file->file, bytes, size)) return g_steal_pointer(&parts);
  guint silent = intake->options->silent_unit;
  file->unit = silent ? (int)silent - 1 : guess_unit(parts);
  if (file->unit == 0) return g_steal_pointer(&parts);
  return spore_mesh_decode_parts(file->file, bytes, size, beside, file->unit, file->frame, named, &file->parts,
                                 &progress, error);
}

/* A body of each part, or of each piece, as the options divide the mesh. */
static gboolean add_parts(Intake *intake, const SporeImportFile *file, const GPtrArray *parts, GError **error) {
  SporeImportDivision division = intake->options->division;
  g_autofree char *stem = stem_of(file->file);
  gboolean done = TRUE;
  for (guint p = 0; done && p < parts->len; p++) {
    SporeMeshPart *part = g_ptr_array_index(parts, p);
    const char *name = *part->name ? part->name : stem;
    SporeError failure = SPORE_ERROR_INIT;
    SporeImportTexture *texture = texture_of(part, &failure);
    if (part->places && !texture) done = spore_error_propagate(&failure, error);
    else if (division == SPORE_IMPORT_PIECES || (division == SPORE_IMPORT_PARTS && parts->len == 1))
      done = add_pieces(intake, name, file, part, texture, error);
    else add_body(intake, name, file, part, texture, &part->mesh, parts->len > 1);
    if (texture) g_rc_box_release_full(texture, (GDestroyNotify)clear_texture);
  }
  if (done && intake->import->bodies->len > SPORE_IMPORT_BODIES_MAXIMUM)
    done = too_many(file->file, intake->import->bodies->len, error);
  return done;
}

static gboolean add_mesh(Intake *intake, SporeImportFile *file, const void *bytes, gsize size, GError **error) {
  file->frame_said = spore_mesh_frame_hint(bytes, size);
  file->frame = intake->options->frame >= 0 ? intake->options->frame : MAX(file->frame_said, 0);
  g_autoptr(GPtrArray) parts = read_parts(intake, file, bytes, size, error);
  if (!parts) return FALSE;
  file->joined = file->parts > 1 && intake->options->division == SPORE_IMPORT_FILES;
  return add_parts(intake, file, parts, error);
}

/* The content of the file, joined with the parts that it keeps in other files beside it. */
static GBytes *read_whole(const char *path, GError **error) {
  g_autoptr(GBytes) given = spore_import_read_content(path, error);
  g_autoptr(GBytes) map = given ? spore_label_map_whole(path, given, error) : NULL;
  return map ? spore_mesh_whole(path, map, error) : NULL;
}

/* One file's bodies. */
static gboolean add_file(Intake *intake, const char *path, GError **error) {
  SporeImportFile *file = g_new0(SporeImportFile, 1);
  g_ptr_array_add(intake->import->files, file);
  file->file = g_strdup(path);
  file->content = read_whole(path, error);
  if (!file->content) return FALSE;
  gsize size;
  const void *bytes = g_bytes_get_data(file->content, &size);
  if (!spore_label_map_is(path, bytes, size)) return add_mesh(intake, file, bytes, size, error);
  file->label_map = true;
  file->frame_said = -1;
  file->overruled = intake->options->frame > 0;
  return add_labels(intake, file, bytes, size, error);
}

/* One file's bodies, or a word on why it is left out. The last error stands where no file can be read. */
static gboolean take_file(Intake *intake, const char *path, GError **error) {
  SporeImport *import = intake->import;
  guint files = import->files->len, bodies = import->bodies->len;
  g_autoptr(GError) fault = NULL;
  if (add_file(intake, path, &fault)) return TRUE;
  gboolean of_the_file =
      g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_FILE) || g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_INPUT);
  gboolean last = import->left_out->len + files == intake->file_count - 1, none = last && files == 0;
  if (!intake->options->lenient || !of_the_file || none) {
    g_propagate_error(error, g_steal_pointer(&fault));
    return FALSE;
  }
  g_ptr_array_set_size(import->bodies, (gint)bodies);
  g_ptr_array_set_size(import->files, (gint)files);
  g_ptr_array_add(import->left_out, g_strdup(fault->message));
  return TRUE;
}

/* Joins all bodies into the first. */
static gboolean merge(SporeImport *import, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  if (import->bodies->len < 2) return TRUE;
  SporeImportBody *into = g_ptr_array_index(import->bodies, 0);
  for (guint i = 1; i < import->bodies->len; i++) {
    const SporeImportBody *from = g_ptr_array_index(import->bodies, i);
    if (!spore_triangle_mesh_append(&into->mesh, &from->mesh, &failure)) return spore_error_propagate(&failure, error);
  }
  if (into->texture) {
    g_free(into->untextured);
    into->untextured = g_strdup(_("merged bodies keep no picture; import it without merging"));
  }
  drop_texture(into);
  into->changed = true;
  into->source = NULL;
  g_ptr_array_set_size(import->bodies, 1);
  return spore_mesh_tidy(into->name, &into->mesh, error);
}

static gboolean mend(Intake *intake, SporeImportBody *body, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeProgress progress = spore_progress_of_share(&intake->step);
  bool done = spore_mesh_figures(&body->mesh, &body->as_read, &failure);
  for (int kind = 0; done && kind < SPORE_MESH_OPERATIONS; kind++) {
    if (!intake->options->operations[kind].wanted) continue;
    SporeMeshChange change;
    done = spore_mesh_operate(&body->mesh, (SporeMeshOperationKind)kind, intake->options->operations[kind].argument,
                              &change, &progress, &failure);
    if (done) g_array_append_val(body->changes, change);
    body->changed = true;
  }
  if (done && body->texture) {
    const SporeImportTexture *texture = body->texture;
    body->places = spore_texture_places_transfer(&texture->mesh, texture->places, &body->mesh, &failure);
    done = body->places != NULL;
  }
  if (!done) spore_error_at(&failure, body->name);
  return done || spore_error_propagate(&failure, error);
}

SporeImport *spore_import_read(char *const *files, const SporeImportOptions *options, const SporeProgress *progress,
                               GError **error) {
  g_autoptr(SporeImport) import = g_new0(SporeImport, 1);
  import->files = g_ptr_array_new_with_free_func((GDestroyNotify)free_file);
  import->bodies = g_ptr_array_new_with_free_func((GDestroyNotify)free_body);
  import->left_out = g_ptr_array_new_with_free_func(g_free);
  Intake intake = {.options = options, .import = import, .step.whole = progress};
  guint count = intake.file_count = g_strv_length((char **)files);
  for (guint i = 0; i < count; i++) {
    intake.step.done = 0.5 * i / count;
    intake.step.share = 0.5 / count;
    if (!take_file(&intake, files[i], error)) return NULL;
  }
  if (options->division == SPORE_IMPORT_MERGED && !merge(import, error)) return NULL;
  for (guint i = 0; i < import->bodies->len; i++) {
    intake.step.done = 0.5 + 0.5 * i / import->bodies->len;
    intake.step.share = 0.5 / import->bodies->len;
    if (!mend(&intake, g_ptr_array_index(import->bodies, i), error)) return NULL;
  }
  return g_steal_pointer(&import);
}

/* Draws the body in the colour and with the opacity that the file gives it. */
static gboolean paint(SporeDocument *document, SporeObject *made, const SporeImportBody *body, GError **error) {
  if (body->coloured && !spore_edit_set_colour(document, made, body->colour, error)) return FALSE;
  if (body->opacity >= 1) return TRUE;
  char opacity[G_ASCII_DTOSTR_BUF_SIZE];
  g_ascii_formatd(opacity, sizeof opacity, "%.3g", body->opacity);
  SporeObject *visual = spore_edit_child_or_new(document, made, "visual", error);
  return visual && spore_document_set_text(document, visual, "opacity", opacity, error);
}

static char *keep(SporeDocument *document, const SporeImportBody *body, const char *extension, GBytes *content) {
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  g_autofree char *name = spore_organ_name(body->name);
  char *file = spore_content_file_name(name, extension, bytes, size);
  spore_document_put_blob(document, file, content);
  return file;
}

/* Keeps the picture and the places of the body's corners beside the scene, named by their content. An unchanged mesh
 * has the places in its own file, for the day when a missing picture is found. */
static gboolean lay(SporeDocument *document, SporeObject *made, const SporeImportBody *body, GError **error) {
  SporeObject *visual = (SporeObject *)spore_object_child_of(made, "visual");
  if (!body->texture || (!body->texture->picture && !body->changed)) return TRUE;
  gsize size;
  char *text = spore_texture_places_format(body->places, 3 * body->mesh.triangle_count, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *places = keep(document, body, "places", content);
  g_autofree char *picture = body->texture->picture ? keep(document, body, "png", body->texture->picture) : NULL;
  return (!picture || spore_document_set_text(document, visual, "texture", picture, error)) &&
         spore_document_set_text(document, visual, "texture_places", places, error);
}

static SporeObject *insert_body(SporeDocument *document, const SporeImportBody *body, GError **error) {
  const SporeImportFile *source = body->source;
  if (!body->changed)
    return spore_organ_insert(document, NULL, source->file, source->content, source->unit, source->frame, error);
  gsize size;
  char *text = spore_off_format(&body->mesh, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *name = spore_organ_name(body->name), *file = spore_content_file_name(name, "off", text, size);
  return spore_organ_insert(document, name, file, content, 0, 0, error); /* metres, SPORE's axes */
}

gboolean spore_import_insert(SporeDocument *document, const SporeImport *import, GPtrArray **bodies, GError **error) {
  g_autoptr(GPtrArray) made = g_ptr_array_new();
  for (guint i = 0; i < import->bodies->len; i++) {
    SporeObject *body = insert_body(document, g_ptr_array_index(import->bodies, i), error);
    if (!body || !paint(document, body, g_ptr_array_index(import->bodies, i), error) ||
        !lay(document, body, g_ptr_array_index(import->bodies, i), error))
      return FALSE;
    g_ptr_array_add(made, body);
  }
  if (bodies) *bodies = g_steal_pointer(&made);
  return TRUE;
}

char *spore_import_remark(const SporeImportFile *file) {
  if (file->frame_said >= 0 && file->frame_said != file->frame)
    return g_strdup_printf(_("the file says that its axes are %s, and %s was taken; leave the axes to the file"),
                           spore_mesh_frames[file->frame_said], spore_mesh_frames[file->frame]);
  if (file->overruled)
    return g_strdup(_("the volume's header says its unit and axes, and they were taken; leave them to the file"));
  if (!file->joined) return g_strdup(file->undescribed);
  return g_strdup_printf(_("its %u parts were joined into one body; split it to have a body of each"), file->parts);
}

char *spore_import_doubt(const SporeImportBody *body) {
  const SporeMeshReport *report = &body->as_read.report;
  return report->closed ? spore_anatomy_doubt(body->name, fabs(report->volume)) : NULL;
}

char *spore_import_burden(const SporeImportBody *body) {
  gsize count = body->mesh.triangle_count;
  if (count <= SPORE_IMPORT_TRIANGLES_MANY) return NULL;
  return g_strdup_printf(_("it has %zu triangles, and spheres and tetrahedra fit as well from %u on, in less time; "
                           "decimate it to %u"),
                         count, SPORE_IMPORT_TRIANGLES_ENOUGH, SPORE_IMPORT_TRIANGLES_ENOUGH);
}
