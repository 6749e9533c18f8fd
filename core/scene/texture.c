/* Textures of bodies: sizes of pictures, places of corners, and places for another form of a mesh. */
#include "core/scene/texture.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/bvh.h"

#define HEAD "spore-places 1\n"
#define FARTHEST 1e6 /* repeats of the picture */
#define INWARD 0.02  /* share of the way from a corner to the middle of its triangle, to tell the sides of a seam */
#define SEAM 2.0     /* so many times farther off in the picture than the corner is from the middle */

static guint32 big_endian(const guint8 *bytes) {
  return (guint32)bytes[0] << 24 | (guint32)bytes[1] << 16 | (guint32)bytes[2] << 8 | bytes[3];
}

/* Whether the chunks follow each other up to the end mark. */
static gboolean is_whole(const guint8 *bytes, gsize size) {
  for (gsize at = 8; size - at >= 12;) {
    gsize length = big_endian(bytes + at);
    if (memcmp(bytes + at + 4, "IEND", 4) == 0) return TRUE;
    if (length > size - at - 12) return FALSE;
    at += 12 + length;
  }
  return FALSE;
}

gboolean spore_texture_size(const char *place, GBytes *content, int *width, int *height, GError **error) {
  static const guint8 signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
  gsize size;
  const guint8 *bytes = g_bytes_get_data(content, &size);
  if (size > SPORE_TEXTURE_BYTES_MAXIMUM)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("the picture has over 64 MiB; expected less; make it smaller"));
  if (size < sizeof signature + 8 || memcmp(bytes, signature, sizeof signature) != 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place, _("this is no PNG; expected one; convert the picture"));
  guint32 sides[2] = {big_endian(bytes + sizeof signature), big_endian(bytes + sizeof signature + 4)};
  for (int i = 0; i < 2; i++)
    if (sides[i] < 1 || sides[i] > SPORE_TEXTURE_SIDE_MAXIMUM)
      return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                               _("the picture has %u x %u pixels; expected 1 to %d a side; make it smaller"), sides[0],
                               sides[1], SPORE_TEXTURE_SIDE_MAXIMUM);
  if (!is_whole(bytes, size))
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("the picture is cut off; expected a whole PNG; copy or convert it again"));
  *width = (int)sides[0], *height = (int)sides[1];
  return TRUE;
}

char *spore_texture_places_format(const float *places, gsize count, gsize *size) {
  GString *text = g_string_new(HEAD);
  char number[G_ASCII_DTOSTR_BUF_SIZE];
  for (gsize i = 0; i < 2 * count; i++) {
    g_string_append(text, g_ascii_formatd(number, sizeof number, "%.7g", (double)places[i]));
    g_string_append_c(text, i % 2 ? '\n' : ' ');
  }
  *size = text->len;
  return g_string_free(text, FALSE);
}

static gboolean fail_count(const char *place, gsize line, gsize count, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                           _("line %zu: expected exactly %zu lines of places, one for each corner of the mesh's "
                             "triangles; import mesh and texture again"),
                           line, count);
}

/* Two finite numbers and the end of the line. *at moves to the next line. */
static gboolean read_row(const char **at, const char *end, float *place) {
  for (int k = 0; k < 2; k++) {
    char *stop;
    while (*at < end && (**at == ' ' || **at == '\t')) (*at)++;
    if (*at == end || g_ascii_isspace(**at)) return FALSE;
    double value = g_ascii_strtod(*at, &stop);
    if (stop == *at || stop > end || !(fabs(value) <= FARTHEST)) return FALSE;
    place[k] = (float)value;
    *at = stop;
  }
  while (*at < end && (**at == ' ' || **at == '\t' || **at == '\r')) (*at)++;
  if (*at < end && **at != '\n') return FALSE;
  if (*at < end) (*at)++;
  return TRUE;
}

static gboolean read_rows(const char *place, const char *at, const char *end, gsize count, float *places,
                          GError **error) {
  for (gsize i = 0; i < count; i++) {
    if (at >= end) return fail_count(place, i + 2, count, error);
    if (!read_row(&at, end, places + 2 * i))
      return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                               _("line %zu: expected two numbers up to %g, u and v; import mesh and texture again"),
                               i + 2, FARTHEST);
  }
  while (at < end && g_ascii_isspace(*at)) at++;
  return at == end || fail_count(place, count + 2, count, error);
}

float *spore_texture_places_parse(const char *place, const char *text, gsize size, gsize count, GError **error) {
  if (size < strlen(HEAD) || memcmp(text, HEAD, strlen(HEAD)) != 0) {
    spore_error_raise(error, SPORE_ERROR_INPUT, place,
                      _("line 1: expected spore-places 1; name a file of places in a texture"));
    return NULL;
  }
  g_autofree char *ended = g_strndup(text, size); /* numbers end at its end */
  float *places = SPORE_NEW_ARRAY(float, 2 * count + 1);
  if (!places) {
    spore_error_raise(error, SPORE_ERROR_MEMORY, place, _("there is not enough memory for its places"));
    return NULL;
  }
  if (read_rows(place, ended + strlen(HEAD), ended + size, count, places, error)) return places;
  spore_free(places);
  return NULL;
}

/* The texture of a unit. */

static GBytes *read_picture(SporeDocument *document, const char *file, GError **error) {
  int width, height;
  g_autoptr(GBytes) content = spore_document_read_asset(document, file, error);
  return content && spore_texture_size(file, content, &width, &height, error) ? g_steal_pointer(&content) : NULL;
}

static float *read_places(SporeDocument *document, const char *file, const SporeObject *asset, GError **error) {
  const SporeTriangleMesh *mesh = spore_document_mesh(document, (SporeObject *)asset, error);
  g_autoptr(GBytes) content = mesh ? spore_document_read_asset(document, file, error) : NULL;
  if (!content) return NULL;
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  return spore_texture_places_parse(file, text, size, 3 * mesh->triangle_count, error);
}

gboolean spore_texture_read(SporeDocument *document, const SporeObject *visual, SporeTexture *texture, GError **error) {
  const char *picture = spore_object_text(visual, "texture"), *places = spore_object_text(visual, "texture_places");
  const char *mesh = spore_object_text(visual, "mesh");
  SporeObject *asset = mesh ? spore_document_find(document, "mesh", mesh) : NULL;
  g_autofree char *where = spore_object_where(visual);
  *texture = (SporeTexture){0};
  if (!picture) return FALSE;
  if (!places || !asset)
    return spore_error_raise(error, SPORE_ERROR_INPUT, where,
                             _("a texture needs a mesh and texture_places as well; expected all three; import the mesh "
                               "with its texture"));
  texture->picture = read_picture(document, picture, error);
  texture->places = texture->picture ? read_places(document, places, asset, error) : NULL;
  if (texture->places) return TRUE;
  spore_texture_clear(texture);
  return FALSE;
}

void spore_texture_clear(SporeTexture *texture) {
  g_clear_pointer(&texture->picture, g_bytes_unref);
  g_clear_pointer(&texture->places, spore_free);
}

/* Transfer. */

/* Shares of the corners of a triangle at the point of its plane that is nearest to p: they sum to 1. */
static void shares_of(const SporeVec3 corner[3], SporeVec3 p, double share[3]) {
  SporeVec3 a = spore_vec3_sub(corner[1], corner[0]), b = spore_vec3_sub(corner[2], corner[0]);
  SporeVec3 c = spore_vec3_sub(p, corner[0]);
  double aa = spore_vec3_dot(a, a), ab = spore_vec3_dot(a, b), bb = spore_vec3_dot(b, b);
  double ac = spore_vec3_dot(a, c), bc = spore_vec3_dot(b, c), whole = aa * bb - ab * ab;
  share[1] = whole > 0 ? (bb * ac - ab * bc) / whole : 0;
  share[2] = whole > 0 ? (aa * bc - ab * ac) / whole : 0;
  share[0] = 1 - share[1] - share[2];
}

static void corners_of(const SporeTriangleMesh *mesh, gsize triangle, SporeVec3 corner[3]) {
  for (int k = 0; k < 3; k++)
    corner[k] = spore_vec3_load(mesh->vertices + 3 * (gsize)mesh->triangles[3 * triangle + (gsize)k]);
}

/* A mesh with places. */
typedef struct Source {
  SporeBvh *bvh;
  const SporeTriangleMesh *mesh;
  const float *places;
} Source;

/* Where p lies in the picture, by the triangle. */
static void place_in(const Source *source, uint32_t triangle, SporeVec3 p, double place[2]) {
  SporeVec3 corner[3];
  double share[3];
  corners_of(source->mesh, triangle, corner);
  shares_of(corner, p, share);
  for (int k = 0; k < 2; k++) {
    place[k] = 0;
    for (int c = 0; c < 3; c++) place[k] += share[c] * source->places[6 * (gsize)triangle + (gsize)(2 * c + k)];
  }
}

static double between(const double a[2], const double b[2]) { return hypot(a[0] - b[0], a[1] - b[1]); }

/* Places of one triangle. Where a corner's own triangle and the triangle in the middle say very different places, a
 * seam lies between them: the one in the middle is right. */
static void place_triangle(const Source *source, const SporeVec3 corner[3], float *places) {
  SporeVec3 middle = spore_vec3_scale(1.0 / 3, spore_vec3_add(spore_vec3_add(corner[0], corner[1]), corner[2]));
  uint32_t home = 0;
  double centre[2];
  spore_bvh_distance(source->bvh, middle, NULL, &home);
  place_in(source, home, middle, centre);
  for (gsize k = 0; k < 3; k++) {
    uint32_t nearest = home;
    double place[2], by_home[2];
    spore_bvh_distance(source->bvh, spore_vec3_add_scaled(corner[k], INWARD, spore_vec3_sub(middle, corner[k])), NULL,
                       &nearest);
    place_in(source, nearest, corner[k], place);
    place_in(source, home, corner[k], by_home);
    gboolean beyond = nearest != home && between(place, by_home) > SEAM * between(by_home, centre);
    for (gsize c = 0; c < 2; c++) places[2 * k + c] = (float)(beyond ? by_home[c] : place[c]);
  }
}

float *spore_texture_places_transfer(const SporeTriangleMesh *from, const float *from_places,
                                     const SporeTriangleMesh *to, SporeError *error) {
  const Source source = {spore_bvh_create(from, error), from, from_places};
  if (!source.bvh) return NULL;
  float *places = SPORE_NEW_ARRAY(float, 6 * to->triangle_count + 1);
  if (!places) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, "%s", _("there is not enough memory for its places"));
  for (gsize t = 0; places && t < to->triangle_count; t++) {
    SporeVec3 corner[3];
    corners_of(to, t, corner);
    place_triangle(&source, corner, places + 6 * t);
  }
  spore_bvh_free(source.bvh);
  return places;
}
