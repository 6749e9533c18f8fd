/* glTF: a text (JSON) that describes arrays of numbers, and these arrays. What changes its shape has a morph target for
 * each key after the first; the weights of these lead from key to key. */
#include "core/io/gltf_write.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/surface_split.h"
#include "core/math/colour.h"
#include "core/scene/error.h"

/* Constants of the format. */
#define FLOAT 5126
#define UNSIGNED_INT 5125
#define ARRAY_BUFFER 34962
#define ELEMENT_ARRAY_BUFFER 34963
#define MAGIC 0x46546C67u
#define CHUNK_JSON 0x4E4F534Au
#define CHUNK_BINARY 0x004E4942u
#define MOST_BYTES 0x7fffffffu /* readers count in signed numbers */

#define ROUGHNESS_DRY 0.9
#define ROUGHNESS_WET 0.25

/* A file under way: the lists of its description, each element behind a comma, and the numbers. */
typedef struct Writer {
  GString *views, *accessors, *meshes, *materials, *nodes, *samplers, *channels;
  guint view_count, sampler_count; /* an accessor has the number of its view */
  GPtrArray *pictures;             /* of GBytes, borrowed; their views stand behind those of the accessors */
  GByteArray *numbers;
  const SporeCancel *cancel;
  gboolean too_large;
} Writer;

/* Asked before each piece of work. */
static gboolean goes_on(const Writer *writer) { return !writer->too_large && !spore_cancel_asked(writer->cancel); }

static void separate(GString *list) {
  if (list->len) g_string_append_c(list, ',');
}

static void append_number(GString *text, double value) {
  char number[G_ASCII_DTOSTR_BUF_SIZE];
  g_string_append(text, g_ascii_formatd(number, sizeof number, "%.9g", value));
}

static void append_numbers(GString *text, const double *values, gsize count) {
  for (gsize i = 0; i < count; i++) {
    if (i) g_string_append_c(text, ',');
    append_number(text, values[i]);
  }
}

/* Floats and indices alike: all have the size of a word, whose lowest byte the format puts first. */
static void append_words(GByteArray *file, const guint32 *words, gsize count) {
  for (gsize i = 0; i < count; i++) {
    guint32 word = GUINT32_TO_LE(words[i]);
    g_byte_array_append(file, (const guint8 *)&word, sizeof word);
  }
}

/* Adds `bytes` of numbers; returns the number of their accessor. bounds: 6 numbers, least and largest; NULL: none. */
static guint add_accessor(Writer *writer, gconstpointer data, gsize bytes, gsize count, int component, const char *type,
                          int target, const float *bounds, guint width) {
  if (writer->numbers->len + bytes > MOST_BYTES) writer->too_large = TRUE;
  if (writer->too_large) return 0;
  separate(writer->views);
  g_string_append_printf(writer->views, "{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%zu", writer->numbers->len,
                         bytes);
  if (target) g_string_append_printf(writer->views, ",\"target\":%d", target);
  g_string_append_c(writer->views, '}');
  append_words(writer->numbers, data, bytes / sizeof(guint32));
  separate(writer->accessors);
  g_string_append_printf(writer->accessors, "{\"bufferView\":%u,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
                         writer->view_count, component, count, type);
  for (guint side = 0; bounds && side < 2; side++) {
    g_string_append(writer->accessors, side ? ",\"max\":[" : ",\"min\":[");
    for (guint k = 0; k < width; k++) {
      if (k) g_string_append_c(writer->accessors, ',');
      append_number(writer->accessors, (double)bounds[side * width + k]);
    }
    g_string_append_c(writer->accessors, ']');
  }
  g_string_append_c(writer->accessors, '}');
  return writer->view_count++;
}

/* Rows of `width` floats, with their bounds where asked. */
static guint add_floats(Writer *writer, const float *rows, gsize count, guint width, int target, gboolean bounded) {
  static const char *const types[] = {NULL, "SCALAR", "VEC2", "VEC3", "VEC4"};
  float bounds[8];
  for (guint k = 0; bounded && k < width; k++) {
    bounds[k] = bounds[width + k] = rows[k];
    for (gsize i = 0; i < count; i++) {
      bounds[k] = fminf(bounds[k], rows[i * width + k]);
      bounds[width + k] = fmaxf(bounds[width + k], rows[i * width + k]);
    }
  }
  return add_accessor(writer, rows, count * width * sizeof *rows, count, FLOAT, types[width], target,
                      bounded ? bounds : NULL, width);
}

/* Surfaces. */

/* Unit normals at vertices, as floats; of a vertex without a triangle any. g_free. */
static float *normals_of(const double *vertices, const SporeTriangleMesh *mesh) {
  g_autofree double *normals = g_new(double, 3 * mesh->vertex_count);
  float *rounded = g_new(float, 3 * mesh->vertex_count);
  spore_triangle_mesh_normals(vertices, mesh->vertex_count, mesh->triangles, mesh->triangle_count, normals);
  for (gsize i = 0; i < mesh->vertex_count; i++) {
    SporeVec3 unit = spore_vec3_normalise(spore_vec3_load(normals + 3 * i), spore_vec3(0, 1, 0));
    rounded[3 * i] = (float)unit.x, rounded[3 * i + 1] = (float)unit.y, rounded[3 * i + 2] = (float)unit.z;
  }
  return rounded;
}

/* Adds rows of 3 numbers of the mesh's vertices, for each vertex that the split has of them. */
static guint add_rows(Writer *writer, const SporeSurfaceSplit *split, const float *rows, gboolean bounded) {
  g_autofree float *spread = g_new(float, 3 * split->count + 1);
  for (gsize i = 0; i < split->count; i++)
    memcpy(spread + 3 * i, rows + 3 * (gsize)split->vertices[i], 3 * sizeof *rows);
  return add_floats(writer, spread, split->count, 3, ARRAY_BUFFER, bounded);
}

static void add_target(Writer *writer, const SporeGltfBody *body, const SporeSurfaceSplit *split, guint key,
                       const float *base, const float *normals) {
  const SporeTriangleMesh *mesh = &body->surface.mesh;
  const float *frame = body->keys->keys->pdata[key];
  gsize count = 3 * mesh->vertex_count;
  g_autofree double *vertices = g_new(double, count);
  g_autofree float *moved = g_new(float, count);
  for (gsize i = 0; i < count; i++) vertices[i] = (double)frame[i], moved[i] = frame[i] - base[i];
  g_autofree float *turned = normals_of(vertices, mesh);
  for (gsize i = 0; i < count; i++) turned[i] -= normals[i];
  guint place = add_rows(writer, split, moved, TRUE), turn = add_rows(writer, split, turned, FALSE);
  g_string_append_printf(writer->meshes, "%s{\"POSITION\":%u,\"NORMAL\":%u}", key > 1 ? "," : "", place, turn);
}

static guint target_count(const SporeGltfBody *body) {
  return body->keys && body->keys->keys->len > 1 ? body->keys->keys->len - 1 : 0;
}

static void add_mesh(Writer *writer, const SporeGltfBody *body, gsize number) {
  const SporeTriangleMesh *mesh = &body->surface.mesh;
  gsize count = 3 * mesh->vertex_count;
  g_autofree float *base = g_new(float, count);
  for (gsize i = 0; i < count; i++) base[i] = (float)mesh->vertices[i];
  g_autofree float *normals = normals_of(mesh->vertices, mesh);
  SporeSurfaceSplit split;
  spore_surface_split_init(&split, &body->surface);
  guint place = add_rows(writer, &split, base, TRUE), normal = add_rows(writer, &split, normals, FALSE);
  guint corners = add_accessor(writer, split.triangles, 3 * mesh->triangle_count * sizeof *split.triangles,
                               3 * mesh->triangle_count, UNSIGNED_INT, "SCALAR", ELEMENT_ARRAY_BUFFER, NULL, 1);
  separate(writer->meshes);
  g_string_append_printf(writer->meshes,
                         "{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u",
                         body->surface.name, place, normal);
  if (split.places)
    g_string_append_printf(writer->meshes, ",\"TEXCOORD_0\":%u",
                           add_floats(writer, split.places, split.count, 2, ARRAY_BUFFER, FALSE));
  g_string_append_printf(writer->meshes, "},\"indices\":%u,\"material\":%zu", corners, number);
  guint targets = target_count(body);
  if (targets) g_string_append(writer->meshes, ",\"targets\":[");
  for (guint key = 1; key <= targets && goes_on(writer); key++) add_target(writer, body, &split, key, base, normals);
  spore_surface_split_clear(&split);
  g_string_append(writer->meshes, targets ? "]}]}" : "}]}");
}

/* The number of the picture, which is written once for all bodies that wear it. */
static guint add_picture(Writer *writer, GBytes *picture) {
  guint number = 0;
  while (number < writer->pictures->len && !g_bytes_equal(writer->pictures->pdata[number], picture)) number++;
  if (number == writer->pictures->len) g_ptr_array_add(writer->pictures, picture);
  return number;
}

static void add_material(Writer *writer, const SporeNamedSurface *surface) {
  double colour[4] = {0, 0, 0, surface->opacity};
  for (int k = 0; k < 3; k++) colour[k] = spore_linear_light(surface->colour[k]);
  separate(writer->materials);
  g_string_append_printf(writer->materials,
                         "{\"name\":\"%s\",\"doubleSided\":true,%s\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
                         "\"roughnessFactor\":",
                         surface->name, surface->opacity < 1 ? "\"alphaMode\":\"BLEND\"," : "");
  append_number(writer->materials, ROUGHNESS_DRY + (ROUGHNESS_WET - ROUGHNESS_DRY) * surface->wetness);
  g_string_append(writer->materials, ",\"baseColorFactor\":[");
  append_numbers(writer->materials, colour, 4);
  g_string_append_c(writer->materials, ']');
  if (surface->picture)
    g_string_append_printf(writer->materials, ",\"baseColorTexture\":{\"index\":%u}",
                           add_picture(writer, surface->picture));
  g_string_append(writer->materials, "}}");
}

/* x y z w. */
static void rotation_of(SporePose pose, double rotation[4]) {
  SporeQuat q = spore_quat_normalise(pose.orientation);
  rotation[0] = q.x, rotation[1] = q.y, rotation[2] = q.z, rotation[3] = q.w;
}

static void add_node(Writer *writer, const SporeGltfBody *body, gsize number) {
  double rotation[4], position[3];
  rotation_of(body->pose, rotation);
  spore_vec3_store(position, body->pose.position);
  separate(writer->nodes);
  g_string_append_printf(writer->nodes, "{\"name\":\"%s\",\"mesh\":%zu,\"translation\":[", body->surface.name, number);
  append_numbers(writer->nodes, position, 3);
  g_string_append(writer->nodes, "],\"rotation\":[");
  append_numbers(writer->nodes, rotation, 4);
  g_string_append(writer->nodes, "]}");
}

/* Motion. */

static void add_channel(Writer *writer, guint input, guint output, gsize node, const char *path) {
  separate(writer->samplers);
  g_string_append_printf(writer->samplers, "{\"input\":%u,\"output\":%u,\"interpolation\":\"LINEAR\"}", input, output);
  separate(writer->channels);
  g_string_append_printf(writer->channels, "{\"sampler\":%u,\"target\":{\"node\":%zu,\"path\":\"%s\"}}",
                         writer->sampler_count++, node, path);
}

static guint add_times(Writer *writer, const GArray *times) {
  g_autofree float *rounded = g_new(float, times->len);
  for (guint i = 0; i < times->len; i++) rounded[i] = (float)g_array_index(times, double, i);
  return add_floats(writer, rounded, times->len, 1, 0, TRUE);
}

/* A turn and its opposite quaternion are one: each is written as the one near the last. */
static void add_poses(Writer *writer, const SporeGltfBody *body, gsize node, guint times) {
  guint count = body->poses->len;
  g_autofree float *places = g_new(float, 3 * count), *turns = g_new(float, 4 * count);
  double last[4] = {0};
  for (guint i = 0; i < count; i++) {
    const SporePose pose = g_array_index(body->poses, SporePose, i);
    double turn[4], along = 0;
    rotation_of(pose, turn);
    for (int k = 0; k < 4; k++) along += turn[k] * last[k];
    for (int k = 0; k < 4; k++) {
      last[k] = along < 0 ? -turn[k] : turn[k];
      turns[4 * i + (guint)k] = (float)last[k];
    }
    places[3 * i] = (float)pose.position.x, places[3 * i + 1] = (float)pose.position.y;
    places[3 * i + 2] = (float)pose.position.z;
  }
  add_channel(writer, times, add_floats(writer, places, count, 3, 0, FALSE), node, "translation");
  add_channel(writer, times, add_floats(writer, turns, count, 4, 0, FALSE), node, "rotation");
}

/* At each key the weight of its target is 1, and all others are 0. */
static void add_weights(Writer *writer, const SporeGltfBody *body, gsize node) {
  gsize targets = target_count(body), keys = targets + 1;
  g_autofree float *weights = g_new0(float, keys *targets);
  for (gsize key = 1; key < keys; key++) weights[key * targets + key - 1] = 1;
  guint input = add_times(writer, body->keys->times);
  add_channel(writer, input, add_floats(writer, weights, keys * targets, 1, 0, FALSE), node, "weights");
}

static void add_motion(Writer *writer, const SporeGltfBody *bodies, gsize count, const GArray *times) {
  gint input = -1;
  for (gsize i = 0; i < count; i++) {
    if (target_count(&bodies[i])) add_weights(writer, &bodies[i], i);
    if (!bodies[i].poses) continue;
    if (input < 0) input = (gint)add_times(writer, times);
    add_poses(writer, &bodies[i], i, (guint)input);
  }
}

/* The file. */

/* Puts the pictures behind the numbers. Each begins where a word does. */
static void add_pictures(Writer *writer) {
  for (guint i = 0; i < writer->pictures->len; i++) {
    gsize size;
    gconstpointer bytes = g_bytes_get_data(writer->pictures->pdata[i], &size);
    if (writer->numbers->len + size > MOST_BYTES) writer->too_large = TRUE;
    if (writer->too_large) return;
    separate(writer->views);
    g_string_append_printf(writer->views, "{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%zu}", writer->numbers->len,
                           size);
    g_byte_array_append(writer->numbers, bytes, (guint)size);
    g_byte_array_append(writer->numbers, (const guint8 *)"\0\0\0", (4 - size % 4) % 4);
  }
}

/* Each texture is its picture, repeated beyond its borders. */
static void describe_pictures(const Writer *writer, GString *text) {
  guint count = writer->pictures->len;
  for (guint i = 0; i < count; i++) g_string_append_printf(text, "%s{\"source\":%u}", i ? "," : ",\"textures\":[", i);
  for (guint i = 0; i < count; i++)
    g_string_append_printf(text, "%s{\"mimeType\":\"image/png\",\"bufferView\":%u}", i ? "," : "],\"images\":[",
                           writer->view_count + i);
  if (count) g_string_append_c(text, ']');
}

static GString *describe(const Writer *writer, gsize count) {
  GString *text =
      g_string_new("{\"asset\":{\"version\":\"2.0\",\"generator\":\"SPORE\"},\"scene\":0,\"scenes\":[{\"nodes\":[");
  for (gsize i = 0; i < count; i++) g_string_append_printf(text, "%s%zu", i ? "," : "", i);
  g_string_append_printf(text, "]}],\"nodes\":[%s],\"meshes\":[%s],\"materials\":[%s],\"accessors\":[%s],",
                         writer->nodes->str, writer->meshes->str, writer->materials->str, writer->accessors->str);
  g_string_append_printf(text, "\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%u}]", writer->views->str,
                         writer->numbers->len);
  describe_pictures(writer, text);
  if (writer->channels->len)
    g_string_append_printf(text, ",\"animations\":[{\"name\":\"run\",\"samplers\":[%s],\"channels\":[%s]}]",
                           writer->samplers->str, writer->channels->str);
  g_string_append_c(text, '}');
  while (text->len % 4) g_string_append_c(text, ' ');
  return text;
}

static GByteArray *join(const GString *text, const GByteArray *numbers) {
  guint32 text_bytes = (guint32)text->len;
  const guint32 head[] = {MAGIC, 2, 12 + 8 + text_bytes + 8 + numbers->len, text_bytes, CHUNK_JSON};
  const guint32 chunk[] = {numbers->len, CHUNK_BINARY};
  GByteArray *file = g_byte_array_new();
  append_words(file, head, G_N_ELEMENTS(head));
  g_byte_array_append(file, (const guint8 *)text->str, text_bytes);
  append_words(file, chunk, G_N_ELEMENTS(chunk));
  g_byte_array_append(file, numbers->data, numbers->len);
  return file;
}

static void refuse(const Writer *writer, GError **error) {
  if (writer->too_large)
    spore_error_raise(error, SPORE_ERROR_INPUT, "--every",
                      _("the file would be larger than 2 GiB; expected fewer moments; ask for some that lie farther "
                        "apart"));
  else spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL, _("interrupted; nothing was written"));
}

GByteArray *spore_gltf_format(const SporeGltfBody *bodies, gsize count, const GArray *times, const SporeCancel *cancel,
                              GError **error) {
  Writer writer = {.numbers = g_byte_array_new(), .pictures = g_ptr_array_new(), .cancel = cancel};
  GString **const lists[] = {&writer.views, &writer.accessors, &writer.meshes,  &writer.materials,
                             &writer.nodes, &writer.samplers,  &writer.channels};
  for (gsize i = 0; i < G_N_ELEMENTS(lists); i++) *lists[i] = g_string_new(NULL);
  for (gsize i = 0; i < count && goes_on(&writer); i++) {
    add_material(&writer, &bodies[i].surface);
    add_mesh(&writer, &bodies[i], i);
    add_node(&writer, &bodies[i], i);
  }
  add_motion(&writer, bodies, count, times);
  add_pictures(&writer);
  GString *text = goes_on(&writer) ? describe(&writer, count) : NULL;
  GByteArray *file = text ? join(text, writer.numbers) : NULL;
  if (text) g_string_free(text, TRUE);
  else refuse(&writer, error);
  for (gsize i = 0; i < G_N_ELEMENTS(lists); i++) g_string_free(*lists[i], TRUE);
  g_byte_array_unref(writer.numbers);
  g_ptr_array_unref(writer.pictures);
  return file;
}
