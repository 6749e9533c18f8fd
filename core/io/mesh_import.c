/* Import of mesh files: decoded in the import helper (OFF here), then checked, welded, turned outward and brought to
 * metres. */
#include "core/io/mesh_import.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/helper.h"
#include "core/io/import_wire.h"
#include "core/io/mesh_format.h"
#include "core/io/mesh_text.h"
#include "core/io/off.h"
#include "core/mesh/edit.h"
#include "core/scene/texture.h"

const char *const spore_mesh_frames[] = {"Y_UP", "RAS", "LPS", NULL};

#define WELD 1e-6 /* of the diagonal */

/* What the importer may take grows with the file, so that a small file cannot stand for gigabytes. Balls of 480,000
 * triangles take 1 (GLB, PLY) to 6 (OBJ) times the size of their file; a triangle of 3 bytes of indices takes 100. */
#define MEMORY_BASE (G_GUINT64_CONSTANT(512) << 20)
#define MEMORY_PER_BYTE 40
#define MEMORY_MOST (G_GUINT64_CONSTANT(6) << 30)

/* A picture takes its size in the request, in the helper's hands and in the answer. */
static SporeHelperLimits import_limits(gsize size, gsize pictures) {
  return (SporeHelperLimits){
      .time_s = 60,
      .memory = MIN(MEMORY_BASE + MEMORY_PER_BYTE * (guint64)size + 3 * (guint64)pictures, MEMORY_MOST),
      .output = 1 << 30};
}

static SporeVec3 to_spore_axes(SporeVec3 p, int frame) {
  switch (frame) {
  case 1:
    return spore_vec3(p.x, p.z, -p.y);
  case 2:
    return spore_vec3(-p.x, p.z, p.y);
  default:
    return p;
  }
}

static void apply_unit_and_frame(SporeTriangleMesh *mesh, int unit, int frame) {
  for (gsize i = 0; i < mesh->vertex_count; i++) {
    SporeVec3 p = spore_vec3_scale(spore_length_unit_m[unit], spore_vec3_load(mesh->vertices + 3 * i));
    spore_vec3_store(mesh->vertices + 3 * i, to_spore_axes(p, frame));
  }
}

/* A file to decode. */
typedef struct Given {
  const char *place, *file;
  const SporeMeshBeside *beside; /* NULL: nothing */
  int unit, frame;
  guint64 look; /* SPORE_IMPORT_SHAPE ... */
} Given;

/* A picture of the file. */
typedef struct RawPicture {
  GBytes *content;
  char *reason; /* why it cannot be taken: "what; remedy", translated; NULL: it can */
} RawPicture;

static void clear_picture(RawPicture *picture) {
  g_clear_pointer(&picture->content, g_bytes_unref);
  g_clear_pointer(&picture->reason, g_free);
}

/* The mesh as in the file: its triangles, and the part that each belongs to. */
typedef struct Raw {
  SporeTriangleMesh mesh;
  guint32 *part;    /* triangle_count; NULL: one part without a name */
  GArray *parts;    /* of SporeImportPart; NULL as well */
  GArray *pictures; /* of RawPicture; NULL: the file brings none */
  float *places;    /* then of the corners of its triangles, x 3 x 2 */
} Raw;

static void clear_raw(Raw *raw) {
  spore_triangle_mesh_clear(&raw->mesh);
  g_clear_pointer(&raw->part, spore_free);
  g_clear_pointer(&raw->parts, g_array_unref);
  g_clear_pointer(&raw->pictures, g_array_unref);
  g_clear_pointer(&raw->places, g_free);
}

static gboolean fail_memory(const char *place, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_MEMORY, place,
                           _("there is not enough memory to import it; close other programs"));
}

static gboolean fail_answer(const char *place, GError **error) {
  return spore_error_raise(
      error, SPORE_ERROR_INTERNAL, place,
      _("the import helper gave a wrong answer; expected a mesh; give another format, and report this"));
}

/* The triangles of the parts must add up to the triangles that were sent. missing: highest number of a picture beside
 * the file. */
static gboolean read_parts(const char *bytes, const SporeImportAnswer *head, guint missing, Raw *raw) {
  gsize triangle = 0;
  raw->parts = g_array_new(FALSE, FALSE, sizeof(SporeImportPart));
  for (guint64 p = 0; p < head->part_count; p++) {
    SporeImportPart part;
    memcpy(&part, bytes + p * sizeof part, sizeof part);
    if (part.triangle_count > head->triangle_count - triangle) return FALSE;
    if (part.picture > head->picture_count || part.missing > missing) return FALSE;
    part.name[sizeof part.name - 1] = part.group[sizeof part.group - 1] = '\0';
    g_array_append_val(raw->parts, part);
    for (guint64 t = 0; t < part.triangle_count; t++) raw->part[triangle++] = (guint32)p;
  }
  return triangle == head->triangle_count;
}

/* Takes a picture. Its reason stands for one that could not be read. FALSE: the answer is wrong. */
static gboolean take_picture(const char *bytes, gsize size, const SporeImportTaken *taken,
                             const SporeMeshBeside *beside, Raw *raw) {
  if (taken->size > size || (taken->beside && (!beside || taken->beside > beside->pictures->len))) return FALSE;
  const SporeMeshPicture *source = taken->beside ? beside->pictures->pdata[taken->beside - 1] : NULL;
  RawPicture picture = {g_bytes_new(bytes, taken->size), g_strdup(source ? source->reason : NULL)};
  g_array_append_val(raw->pictures, picture);
  return TRUE;
}

/* Places and pictures, which fill the rest of the answer. A place that is no number is the picture's corner. */
static gboolean read_pictures(const char *bytes, gsize size, const SporeImportAnswer *head,
                              const SporeMeshBeside *beside, Raw *raw) {
  if (head->picture_count == 0) return size == 0;
  gsize corners = 6 * head->triangle_count, before = corners * sizeof(float);
  if (head->picture_count > SPORE_IMPORT_PICTURES_MAXIMUM ||
      size < before + head->picture_count * sizeof(SporeImportTaken))
    return FALSE;
  raw->places = g_memdup2(bytes, before);
  for (gsize i = 0; raw->places && i < corners; i++)
    if (!(fabsf(raw->places[i]) <= 1e6f)) raw->places[i] = 0;
  gsize at = before + head->picture_count * sizeof(SporeImportTaken);
  raw->pictures = g_array_new(FALSE, FALSE, sizeof(RawPicture));
  g_array_set_clear_func(raw->pictures, (GDestroyNotify)clear_picture);
  for (guint64 p = 0; p < head->picture_count; p++) {
    SporeImportTaken taken;
    memcpy(&taken, bytes + before + p * sizeof taken, sizeof taken);
    if (!take_picture(bytes + at, size - at, &taken, beside, raw)) return FALSE;
    at += taken.size;
  }
  return at == size;
}

/* The helper is not trusted: its counts must agree to the byte with what it sent. */
static gboolean read_answer(const Given *given, GBytes *answer, Raw *raw, GError **error) {
  const char *place = given->place;
  gsize size;
  const char *bytes = g_bytes_get_data(answer, &size);
  SporeImportAnswer head = {0};
  if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
  if (head.vertex_count > SPORE_MESH_MAXIMUM || head.triangle_count > SPORE_MESH_MAXIMUM)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("the mesh has more than %u vertices or triangles; expected fewer; decimate it first"),
                             SPORE_MESH_MAXIMUM);
  gsize vertex_bytes = head.vertex_count * 3 * sizeof(double),
        triangle_bytes = head.triangle_count * 3 * sizeof(guint32),
        part_bytes = MIN(head.part_count, head.triangle_count) * sizeof(SporeImportPart);
  raw->part = SPORE_NEW_ARRAY(guint32, head.triangle_count);
  if (!raw->part) return fail_memory(place, error);
  gsize mesh_bytes = sizeof head + part_bytes + vertex_bytes + triangle_bytes;
  if (head.part_count > head.triangle_count || size < mesh_bytes ||
      !read_parts(bytes + sizeof head, &head, given->beside ? given->beside->pictures->len : 0, raw) ||
      !read_pictures(bytes + mesh_bytes, size - mesh_bytes, &head, given->beside, raw))
    return fail_answer(place, error);
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_triangle_mesh_allocate(&raw->mesh, head.vertex_count, head.triangle_count, &failure)) {
    spore_error_at(&failure, place);
    return spore_error_propagate(&failure, error);
  }
  memcpy(raw->mesh.vertices, bytes + sizeof head + part_bytes, vertex_bytes);
  memcpy(raw->mesh.triangles, bytes + sizeof head + part_bytes + vertex_bytes, triangle_bytes);
  if (head.passed_over)
    g_message(_("%s: %llu points and lines were passed over; only triangles are read"), place,
              (unsigned long long)head.passed_over);
  return TRUE;
}

static void append_material(GByteArray *request, const SporeMeshMaterial *from) {
  SporeImportMaterial material = {
      .coloured = from->coloured, .picture = from->picture, .opacity = (float)from->opacity, .mapped = from->mapped};
  for (int k = 0; k < 3; k++) material.colour[k] = (float)from->colour[k];
  for (int k = 0; k < 2; k++) material.scale[k] = (float)from->scale[k], material.offset[k] = (float)from->offset[k];
  g_strlcpy(material.name, from->name, sizeof material.name);
  g_byte_array_append(request, (const guint8 *)&material, sizeof material);
}

static void append_picture(GByteArray *request, const SporeMeshPicture *from) {
  SporeImportPicture picture = {.size = from->content ? g_bytes_get_size(from->content) : 0};
  g_strlcpy(picture.name, from->name, sizeof picture.name);
  g_byte_array_append(request, (const guint8 *)&picture, sizeof picture);
}

/* What stands before the bytes of the file. *pictures: bytes of all pictures. */
static GByteArray *begin_request(const Given *given, SporeMeshFormat format, gsize size, gsize *pictures) {
  const SporeMeshBeside *beside = given->beside;
  GByteArray *request = g_byte_array_new();
  SporeImportRequest head = {.format = format, .size = size, .look = given->look};
  if (beside) {
    head.material_count = beside->materials->len, head.picture_count = beside->pictures->len;
    head.worn = beside->worn;
  }
  *pictures = 0;
  g_byte_array_append(request, (const guint8 *)&head, sizeof head);
  for (guint64 i = 0; i < head.material_count; i++) append_material(request, beside->materials->pdata[i]);
  for (guint64 i = 0; i < head.picture_count; i++) {
    const SporeMeshPicture *picture = beside->pictures->pdata[i];
    append_picture(request, picture);
    *pictures += picture->content ? g_bytes_get_size(picture->content) : 0;
  }
  return request;
}

/* NULL: there is not enough memory. */
static GBytes *make_request(const Given *given, SporeMeshFormat format, const void *content, gsize size,
                            gsize *pictures) {
  const SporeMeshBeside *beside = given->beside;
  g_autoptr(GByteArray) begin = begin_request(given, format, size, pictures);
  gsize whole = begin->len + size + *pictures;
  char *request = spore_allocate(whole, 1), *at = request;
  if (!request) return NULL;
  memcpy(at, begin->data, begin->len);
  memcpy(at + begin->len, content, size);
  at += begin->len + size;
  for (guint i = 0; beside && i < beside->pictures->len; i++) {
    GBytes *picture = ((const SporeMeshPicture *)beside->pictures->pdata[i])->content;
    gsize length = 0;
    gconstpointer bytes = picture ? g_bytes_get_data(picture, &length) : NULL;
    if (length) memcpy(at, bytes, length);
    at += length;
  }
  return g_bytes_new_with_free_func(request, whole, spore_free, request);
}

static gboolean decode_in_helper(const Given *given, SporeMeshFormat format, const void *content, gsize size, Raw *raw,
                                 const SporeProgress *progress, GError **error) {
  if (!SPORE_HAVE_ASSIMP && format != SPORE_MESH_VTK && format != SPORE_MESH_VTP)
    return spore_error_raise(
        error, SPORE_ERROR_UNSUPPORTED, given->place,
        _("this is %s, and this build of SPORE reads OFF and VTK alone; expected one of these; convert the mesh, or "
          "install libassimp-dev and build SPORE again"),
        spore_mesh_format_names[format]);
  gsize pictures;
  GBytes *request = make_request(given, format, content, size, &pictures);
  if (!request) return fail_memory(given->place, error);
  const SporeHelperLimits limits = import_limits(size, pictures);
  g_autoptr(GBytes) answer = spore_helper_run("spore-import", given->place, request, &limits, progress, error);
  g_bytes_unref(request);
  return answer && read_answer(given, answer, raw, error);
}

/* Turns triangles that look inward. Only a surface without border, in which two triangles share each edge, has an
 * outside. Other surfaces are left as they are. */
static bool turn_outward(SporeTriangleMesh *mesh, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report(mesh, &report, error)) return false;
  if (report.boundary_edges + report.nonmanifold_edges > 0) return true;
  gsize size = 3 * mesh->triangle_count * sizeof *mesh->triangles;
  uint32_t *before = spore_allocate(size, 1);
  if (!before)
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, "%s",
                           _("there is not enough memory to import it; close other programs"));
  memcpy(before, mesh->triangles, size);
  bool done = spore_triangle_mesh_orient(mesh, error);
  mesh->reoriented = done && memcmp(before, mesh->triangles, size) != 0;
  spore_free(before);
  return done;
}

/* tags: one a triangle, or NULL. */
static gboolean tidy(const char *place, SporeTriangleMesh *mesh, guint32 *tags, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  if (spore_triangle_mesh_validate(mesh, &failure) && spore_triangle_mesh_weld_tagged(mesh, WELD, tags, &failure) &&
      turn_outward(mesh, &failure))
    return TRUE;
  spore_error_at(&failure, place);
  return spore_error_propagate(&failure, error);
}

gboolean spore_mesh_tidy(const char *place, SporeTriangleMesh *mesh, GError **error) {
  return tidy(place, mesh, NULL, error);
}

/* Decodes a mesh whose text is in its plain form. */
static gboolean decode_plain(const Given *given, const void *content, gsize size, Raw *raw,
                             const SporeProgress *progress, GError **error) {
  SporeMeshFormat format;
  if (!spore_mesh_format_find(given->place, given->file, content, size, &format, error)) return FALSE;
  size = spore_mesh_format_extent(format, content, size);
  return format == SPORE_MESH_OFF ? spore_off_parse(given->place, content, size, &raw->mesh, error)
                                  : decode_in_helper(given, format, content, size, raw, progress, error);
}

/* Decodes a mesh, in metres and in SPORE's axes. */
static gboolean decode(const Given *given, const void *content, gsize size, Raw *raw, const SporeProgress *progress,
                       GError **error) {
  g_assert(given->unit >= 0 && spore_length_units[given->unit] && given->frame >= 0 && given->frame < 3);
  const char *text = content;
  char *held = NULL;
  if (!spore_mesh_text(&text, &size, &held)) return fail_memory(given->place, error);
  gboolean done = decode_plain(given, text, size, raw, progress, error);
  spore_free(held);
  if (done) apply_unit_and_frame(&raw->mesh, given->unit, given->frame);
  return done;
}

/* Names of all parts, as valid UTF-8. */
static char **names_of(const Raw *raw) {
  char **names = g_new0(char *, raw->parts->len + 1);
  for (guint p = 0; p < raw->parts->len; p++)
    names[p] = g_utf8_make_valid(g_array_index(raw->parts, SporeImportPart, p).name, -1);
  return names;
}

gboolean spore_mesh_decode_tagged(const char *place, const char *file, const void *content, gsize size, int unit,
                                  int frame, SporeTriangleMesh *mesh, guint32 **parts, char ***names,
                                  const SporeProgress *progress, GError **error) {
  Raw raw = {0};
  const Given given = {place, file, NULL, unit, frame, SPORE_IMPORT_SHAPE};
  gboolean done = decode(&given, content, size, &raw, progress, error) && tidy(place, &raw.mesh, raw.part, error);
  *mesh = done ? raw.mesh : (SporeTriangleMesh){0};
  if (names) *names = done && raw.parts ? names_of(&raw) : NULL;
  if (parts) *parts = done ? g_steal_pointer(&raw.part) : NULL;
  if (done) raw.mesh = (SporeTriangleMesh){0};
  clear_raw(&raw);
  return done;
}

gboolean spore_mesh_decode(const char *place, const char *file, const void *content, gsize size, int unit, int frame,
                           SporeTriangleMesh *mesh, const SporeProgress *progress, GError **error) {
  return spore_mesh_decode_tagged(place  ? place
                                  : file ? file
                                         : "",
                                  file, content, size, unit, frame, mesh, NULL, NULL, progress, error);
}

void spore_mesh_part_free(SporeMeshPart *part) {
  g_free(part->name);
  g_free(part->group);
  spore_triangle_mesh_clear(&part->mesh);
  g_clear_pointer(&part->picture, g_bytes_unref);
  spore_free(part->places);
  g_free(part->untextured);
  g_free(part->unclear);
  g_free(part);
}

/* What the file says of that part; of the largest where it says nothing of the number. NULL: it says nothing. */
static const SporeImportPart *said_of(const Raw *raw, gboolean apart, guint32 number) {
  const SporeImportPart *said = NULL;
  for (guint p = 0; raw->parts && p < raw->parts->len; p++) {
    const SporeImportPart *one = &g_array_index(raw->parts, SporeImportPart, p);
    if (apart ? p == number : !said || one->triangle_count > said->triangle_count) said = one;
  }
  return said;
}

/* What of its opacity the part does not show; NULL: nothing. g_free. */
static char *why_unclear(const SporeImportPart *said) {
  if (said->unclear & SPORE_IMPORT_OPACITY_MAP)
    return g_strdup(_("a picture says its opacity (map_d), which is not read: it is as opaque as its material says; "
                      "give the body the opacity that it should have, or split it where that changes"));
  if (said->unclear & SPORE_IMPORT_OPACITIES)
    return g_strdup(_("its materials differ in opacity, and all of it has that of the largest; split it by material"));
  return NULL;
}

/* The helper is not trusted: a colour or an opacity that is none is left out. */
static void take_colour(const SporeImportPart *said, SporeMeshPart *part) {
  part->coloured = said && said->coloured;
  part->unclear = said ? why_unclear(said) : NULL;
  part->opacity = said && said->opacity > 0 && said->opacity < 1 ? (double)said->opacity : 1;
  for (int k = 0; k < 3 && said; k++) {
    part->colour[k] = said->colour[k];
    if (!(said->colour[k] >= 0 && said->colour[k] <= 1)) part->coloured = false;
  }
}

/* Of the pictures that one was made of: what is missing. g_free. */
static char *why_partly(const SporeMeshBeside *beside, guint32 missing) {
  const SporeMeshPicture *picture = missing ? beside->pictures->pdata[missing - 1] : NULL;
  if (picture && picture->reason)
    return g_strdup_printf(_("its picture %s is left out: %s"), picture->name, picture->reason);
  return picture
             ? g_strdup_printf(_("its picture %s cannot be decoded, and the colour of its material stands there; "
                                 "expected PNG or JPEG of at most 8192 pixels a side; convert the picture"),
                               picture->name)
             : g_strdup(_("one of its pictures is not in the file, cannot be decoded, or its corners have no places "
                          "in it (UV), and the colour of its material stands there; expected PNG or JPEG of at most "
                          "8192 pixels a side; export it as GLB with its pictures"));
}

/* What is to be said of what the part wears; NULL: nothing. g_free. */
static char *said_of_dress(const SporeMeshBeside *beside, const SporeImportPart *said) {
  switch (said->dress) {
  case SPORE_IMPORT_SMALLER:
    return g_strdup(_("its pictures were made smaller to lie in one of 22 million pixels; split it, or make the less "
                      "important ones smaller first"));
  case SPORE_IMPORT_PARTLY:
    return why_partly(beside, said->missing);
  case SPORE_IMPORT_MIXED:
    return g_strdup(_("its materials wear several pictures or colours that cannot be laid into one; expected at most "
                      "500 pictures, and a build of SPORE with libpng; split it, or give it fewer materials"));
  case SPORE_IMPORT_UNPLACED:
    return g_strdup(
        _("its corners have no places in its picture (UV); expected them; unwrap the mesh, and export it again"));
  case SPORE_IMPORT_UNKNOWN:
    return g_strdup(_("its picture is not in the file, or is too large; expected one of at most 64 MiB; export it as "
                      "GLB with its picture"));
  default:
    return NULL;
  }
}

/* Why the picture cannot be drawn; NULL: it can. g_free. */
static char *why_undrawn(const RawPicture *picture) {
  int width, height;
  g_autoptr(GError) error = NULL;
  if (picture->reason) return g_strdup(picture->reason);
  if (spore_texture_size("", picture->content, &width, &height, &error)) return NULL;
  return g_strdup(g_str_has_prefix(error->message, ": ") ? error->message + 2 : error->message);
}

/* The places of the triangles of a part; g_free. */
static float *places_of_part(const Raw *raw, const guint32 *pieces, guint32 number) {
  float *places = g_new(float, 6 * raw->mesh.triangle_count + 1);
  gsize count = 0;
  for (gsize t = 0; t < raw->mesh.triangle_count; t++)
    if (!pieces || pieces[t] == number) memcpy(places + 6 * count++, raw->places + 6 * t, 6 * sizeof *places);
  return places;
}

/* Takes the picture that the part wears, or why it has none. said: NULL: nothing. */
static void take_picture_of(const Raw *raw, const SporeMeshBeside *beside, const SporeImportPart *said,
                            SporeMeshPart *part) {
  const RawPicture *picture =
      said && said->picture ? &g_array_index(raw->pictures, RawPicture, said->picture - 1) : NULL;
  if (picture) part->untextured = why_undrawn(picture);
  if (picture && !part->untextured) part->picture = g_bytes_ref(picture->content);
  if (said && !part->untextured) part->untextured = said_of_dress(beside, said);
  if (part->untextured && !part->picture) part->coloured = false; /* the colour alone says little */
}

/* The part of that number; `pieces` NULL: the whole mesh. NULL with an error. */
static SporeMeshPart *take_part(const Given *given, Raw *raw, const guint32 *pieces, guint32 number, GError **error) {
  SporeMeshPart *part = g_new0(SporeMeshPart, 1);
  SporeError failure = SPORE_ERROR_INIT;
  SporeTriangleMesh rough = {0};
  const SporeImportPart *said = said_of(raw, pieces != NULL, number);
  part->name = g_utf8_make_valid(said && pieces ? said->name : "", -1);
  part->group = g_utf8_make_valid(said && pieces ? said->group : "", -1);
  take_colour(said, part);
  take_picture_of(raw, given->beside, said, part);
  g_autofree char *where = *part->name ? g_strdup_printf("%s: %s", given->place, part->name) : g_strdup(given->place);
  gboolean done = spore_triangle_mesh_validate(&raw->mesh, &failure); /* validated before its indices are used */
  g_autofree float *places = done && said && said->picture ? places_of_part(raw, pieces, number) : NULL;
  if (done && pieces) done = spore_triangle_mesh_extract(&raw->mesh, pieces, number, &part->mesh, &failure);
  else if (done) part->mesh = raw->mesh, raw->mesh = (SporeTriangleMesh){0};
  if (done && places) done = spore_triangle_mesh_copy(&rough, &part->mesh, &failure);
  if (done) {
    done = spore_mesh_tidy(where, &part->mesh, error);
    if (done && places) part->places = spore_texture_places_transfer(&rough, places, &part->mesh, &failure);
    if (done && places && !part->places)
      done = (spore_error_at(&failure, where), spore_error_propagate(&failure, error));
  } else {
    spore_error_at(&failure, where);
    spore_error_propagate(&failure, error);
  }
  spore_triangle_mesh_clear(&rough);
  if (done) return part;
  spore_mesh_part_free(part);
  return NULL;
}

GPtrArray *spore_mesh_decode_parts(const char *file, const void *content, gsize size, const SporeMeshBeside *beside,
                                   int unit, int frame, gboolean apart, guint *count, const SporeProgress *progress,
                                   GError **error) {
  Raw raw = {0};
  const Given given = {file, file, beside, unit, frame, apart ? SPORE_IMPORT_APART : SPORE_IMPORT_TOGETHER};
  g_autoptr(GPtrArray) parts = g_ptr_array_new_with_free_func((GDestroyNotify)spore_mesh_part_free);
  gboolean done = decode(&given, content, size, &raw, progress, error);
  *count = raw.parts ? raw.parts->len : 1;
  gboolean several = apart && *count > 1;
  if (done && *count > SPORE_MESH_PARTS_MAXIMUM && several)
    done = spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("the file has %u parts; expected at most %u bodies; import it as one"), *count,
                             SPORE_MESH_PARTS_MAXIMUM);
  for (guint p = 0; done && p < (several ? *count : 1); p++) {
    SporeMeshPart *part = take_part(&given, &raw, several ? raw.part : NULL, p, error);
    if (part) g_ptr_array_add(parts, part);
    done = part != NULL;
  }
  clear_raw(&raw);
  return done ? g_steal_pointer(&parts) : NULL;
}

int spore_mesh_frame_hint(const void *content, gsize size) {
  char *head = g_strndup(content, MIN(size, 4096));
  for (gsize i = 0; i < MIN(size, 4096); i++) head[i] = head[i] ? g_ascii_toupper(head[i]) : ' ';
  int hint = strstr(head, "SPACE=RAS") ? 1 : strstr(head, "SPACE=LPS") ? 2 : -1;
  g_free(head);
  return hint;
}
