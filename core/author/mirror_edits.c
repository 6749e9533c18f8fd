/* Copies bodies, plain or mirrored. Where a point p of the body's frame is at R p + t, its image is at (M R M)(M p) + M
 * t, with M the mirror: so the copy's assets are mirrored in the body's frame, and its frame turns the other way. */
#include "core/author/mirror_edits.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/asset_stretch.h"
#include "core/author/edits.h"
#include "core/author/placement.h"
#include "core/base/memory.h"
#include "core/io/organ.h"
#include "core/scene/compile.h"
#include "core/scene/texture.h"

typedef struct Mirror {
  SporeDocument *document;
  SporeObject *body, *copy;
  int axis; /* NONE: a plain copy, which shares its assets */
  double at;
  SporeVec3 offset; /* of a plain copy, m */
} Mirror;

#define NONE (-1)
#define BESIDE 1.1        /* of the width of what is copied */
#define LEAST_BESIDE 0.01 /* m */

/* Values. */

static SporeVec3 flipped(const Mirror *mirror, SporeVec3 v) {
  double component[3];
  if (mirror->axis == NONE) return v;
  spore_vec3_store(component, v);
  component[mirror->axis] = -component[mirror->axis];
  return spore_vec3_load(component);
}

/* Of what has a sense of turning. */
static SporeVec3 flipped_turn(const Mirror *mirror, SporeVec3 v) {
  return mirror->axis == NONE ? v : spore_vec3_scale(-1, flipped(mirror, v));
}

static SporeVec3 image(const Mirror *mirror, SporeVec3 place) {
  double component[3];
  if (mirror->axis == NONE) return spore_vec3_add(place, mirror->offset);
  spore_vec3_store(component, place);
  component[mirror->axis] = 2 * mirror->at - component[mirror->axis];
  return spore_vec3_load(component);
}

/* Assets. */

/* "left" becomes "right", and the other way round; else what is added says it. A plain copy gets a number. g_free. */
static char *name_of_image(const Mirror *mirror, const char *name) {
  static const char *const sides[][2] = {{"left", "right"}, {"right", "left"}};
  if (mirror->axis == NONE) return g_strdup(name);
  for (gsize i = 0; i < G_N_ELEMENTS(sides); i++) {
    const char *found = strstr(name, sides[i][0]);
    if (found) return g_strdup_printf("%.*s%s%s", (int)(found - name), name, sides[i][1], found + strlen(sides[i][0]));
  }
  return g_strdup_printf("%s_mirrored", name);
}

static SporeObject *mirror_asset(const Mirror *mirror, SporeObject *asset, GError **error) {
  gsize size;
  const char *extension;
  double factors[3] = {1, 1, 1};
  if (mirror->axis == NONE) return asset;
  factors[mirror->axis] = -1;
  char *text = spore_asset_stretched(mirror->document, asset, factors, &extension, &size, error);
  g_autofree char *name = name_of_image(mirror, spore_object_name(asset));
  return text ? spore_edit_put_asset(mirror->document, spore_object_type(asset)->element, name, extension, text, size,
                                     error)
              : NULL;
}

/* Objects. */

/* Places of the body's own frame; lengths along the axes are vectors, too, but have no sign. */
static gboolean is_place(const SporeParameter *parameter) {
  return parameter->type == SPORE_VECTOR && g_strcmp0(parameter->unit, "m") == 0 && parameter->minimum < 0;
}

static gboolean copy_value(const Mirror *mirror, const SporeObject *from, SporeObject *to, guint property,
                           GError **error) {
  const SporeParameter *parameter = &spore_object_type(from)->table->parameters[property];
  SporeValue value = *spore_object_value(from, property);
  SporeObject *named = spore_object_asset(from, property);
  if (parameter->type == SPORE_NAME || !spore_object_is_set(from, property)) return TRUE;
  if (named) {
    SporeObject *asset = mirror_asset(mirror, named, error);
    return asset && spore_document_set_text(mirror->document, to, parameter->name, spore_object_name(asset), error);
  }
  if (is_place(parameter)) spore_vec3_store(value.number, flipped(mirror, spore_vec3_load(value.number)));
  return spore_document_set(mirror->document, to, property, &value, error);
}

static gboolean copy_values(const Mirror *mirror, const SporeObject *from, SporeObject *to, GError **error) {
  for (guint i = 0; i < spore_object_type(from)->table->count; i++)
    if (!copy_value(mirror, from, to, i, error)) return FALSE;
  return TRUE;
}

static gboolean copy_children(const Mirror *mirror, const SporeObject *from, SporeObject *to, GError **error) {
  for (guint i = 0; i < spore_object_child_count(from); i++) {
    const SporeObject *child = spore_object_child(from, i);
    SporeObject *made = spore_document_insert(mirror->document, to, spore_object_type(child)->element,
                                              spore_object_name(child), G_MAXUINT, error);
    if (!made || !copy_values(mirror, child, made, error) || !copy_children(mirror, child, made, error)) return FALSE;
  }
  return TRUE;
}

/* Textures: the picture stays, and each corner of the image has the place of what it is the image of. */

static float *mirror_places(const Mirror *mirror, const SporeTriangleMesh *from, const float *places,
                            const SporeTriangleMesh *to, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeTriangleMesh turned;
  float *made = NULL;
  if (spore_triangle_mesh_copy(&turned, from, &failure)) {
    for (gsize i = 0; i < turned.vertex_count; i++) turned.vertices[3 * i + (gsize)mirror->axis] *= -1;
    made = spore_texture_places_transfer(&turned, places, to, &failure);
  }
  spore_triangle_mesh_clear(&turned);
  if (!made) spore_error_propagate(&failure, error);
  return made;
}

static gboolean mirror_texture(const Mirror *mirror, GError **error) {
  const SporeObject *visual = spore_object_child_of(mirror->body, "visual");
  SporeObject *made = (SporeObject *)spore_object_child_of(mirror->copy, "visual");
  SporeTexture texture;
  if (!visual || !made || !spore_texture_read(mirror->document, visual, &texture, NULL))
    return TRUE; /* check says why */
  SporeDocument *document = mirror->document;
  const SporeTriangleMesh *from = spore_document_mesh(document, spore_object_reference(visual, "mesh"), error);
  const SporeTriangleMesh *to =
      from ? spore_document_mesh(document, spore_object_reference(made, "mesh"), error) : NULL;
  float *places = to ? mirror_places(mirror, from, texture.places, to, error) : NULL;
  spore_texture_clear(&texture);
  if (!places) return FALSE;
  gsize size;
  char *text = spore_texture_places_format(places, 3 * to->triangle_count, &size);
  spore_free(places);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *file = spore_content_file_name(spore_object_name(mirror->copy), "places", text, size);
  spore_document_put_blob(document, file, content);
  return spore_document_set_text(document, made, "texture_places", file, error);
}

static gboolean set_vector(const Mirror *mirror, SporeObject *object, const char *property, SporeVec3 v,
                           GError **error) {
  SporeValue value = {.type = SPORE_VECTOR};
  spore_vec3_store(value.number, v);
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  return spore_vec3_distance(spore_object_vector(object, property), v) == 0 ||
         spore_document_set(mirror->document, object, (guint)index, &value, error);
}

static gboolean place_copy(const Mirror *mirror, GError **error) {
  const SporeObject *body = mirror->body;
  return set_vector(mirror, mirror->copy, "position", image(mirror, spore_object_vector(body, "position")), error) &&
         set_vector(mirror, mirror->copy, "rotation", flipped_turn(mirror, spore_object_vector(body, "rotation")),
                    error) &&
         set_vector(mirror, mirror->copy, "velocity", flipped(mirror, spore_object_vector(body, "velocity")), error) &&
         set_vector(mirror, mirror->copy, "spin", flipped_turn(mirror, spore_object_vector(body, "spin")), error);
}

/* Links. */

static gboolean names_a_body(const SporeParameter *parameter) {
  return parameter->type == SPORE_REFERENCE && g_str_equal(parameter->references, "body");
}

/* Whether the link ties the body, and nothing but the scene to it. */
static gboolean is_own_link(const Mirror *mirror, const SporeObject *link) {
  const SporeParameterTable *table = spore_object_type(link)->table;
  gboolean own = FALSE;
  for (gsize i = 0; i < table->count; i++) {
    SporeObject *named =
        names_a_body(&table->parameters[i]) ? spore_object_reference(link, table->parameters[i].name) : NULL;
    if (named && named != mirror->body) return FALSE;
    own = own || named;
  }
  return own;
}

static gboolean copy_link(const Mirror *mirror, const SporeObject *link, GError **error) {
  const SporeObjectType *type = spore_object_type(link);
  g_autofree char *name = name_of_image(mirror, spore_object_name(link));
  SporeObject *copy =
      spore_document_insert(mirror->document, spore_object_parent(link), type->element, name, G_MAXUINT, error);
  for (guint i = 0; copy && i < type->table->count; i++) {
    const SporeParameter *parameter = &type->table->parameters[i];
    SporeValue value = *spore_object_value(link, i);
    gboolean done;
    if (parameter->type == SPORE_NAME || !spore_object_is_set(link, i)) continue;
    if (names_a_body(parameter)) value.text = (char *)spore_object_name(mirror->copy);
    if (parameter->type == SPORE_VECTOR) {
      SporeVec3 v = spore_vec3_load(value.number);
      spore_vec3_store(value.number, is_place(parameter) ? image(mirror, v) : flipped(mirror, v));
    }
    done = spore_document_set(mirror->document, copy, i, &value, error);
    if (!done) return FALSE;
  }
  return copy != NULL;
}

static gboolean copy_links(const Mirror *mirror, GError **error) {
  const SporeObject *links = spore_document_section(mirror->document, "links");
  guint count = spore_object_child_count(links); /* without the copies */
  for (guint i = 0; i < count; i++)
    if (is_own_link(mirror, spore_object_child(links, i)) && !copy_link(mirror, spore_object_child(links, i), error))
      return FALSE;
  return TRUE;
}

static SporeObject *copy_body(Mirror *mirror, GError **error) {
  const SporeObject *body = mirror->body;
  if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE) {
    spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(body), "%s",
                      mirror->axis == NONE ? _("an instrument is not copied; add another one from the library")
                                           : _("an instrument is not mirrored; add another one from the library"));
    return NULL;
  }
  g_autofree char *name = name_of_image(mirror, spore_object_name(body));
  mirror->copy = spore_document_insert(mirror->document, spore_object_parent(body), "body", name, G_MAXUINT, error);
  gboolean done = mirror->copy && copy_values(mirror, body, mirror->copy, error) &&
                  copy_children(mirror, body, mirror->copy, error) &&
                  (mirror->axis == NONE || mirror_texture(mirror, error)) && place_copy(mirror, error) &&
                  copy_links(mirror, error);
  return done ? mirror->copy : NULL;
}

SporeObject *spore_edit_mirror(SporeDocument *document, SporeObject *body, int axis, double at, GError **error) {
  Mirror mirror = {.document = document, .body = body, .axis = axis, .at = at};
  spore_document_begin(document, _("Mirror"));
  SporeObject *copy = copy_body(&mirror, error);
  return spore_edit_finish(document, copy != NULL) ? copy : NULL;
}

SporeVec3 spore_copy_offset(SporeDocument *document, const GPtrArray *bodies) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (guint i = 0; i < bodies->len; i++) {
    double lower[3], upper[3];
    spore_body_box(document, bodies->pdata[i], lower, upper);
    least = fmin(least, lower[0]);
    most = fmax(most, upper[0]);
  }
  return (SporeVec3){fmax(BESIDE * (most - least), LEAST_BESIDE), 0, 0};
}

GPtrArray *spore_edit_copy(SporeDocument *document, const GPtrArray *bodies, SporeVec3 offset, GError **error) {
  g_autoptr(GPtrArray) copies = g_ptr_array_new();
  gboolean done = TRUE;
  spore_document_begin(document, _("Copy"));
  for (guint i = 0; done && i < bodies->len; i++) {
    Mirror mirror = {.document = document, .body = bodies->pdata[i], .axis = NONE, .offset = offset};
    SporeObject *copy = copy_body(&mirror, error);
    if (copy) g_ptr_array_add(copies, copy);
    done = copy != NULL;
  }
  return spore_edit_finish(document, done) ? g_steal_pointer(&copies) : NULL;
}

double spore_scene_middle(SporeDocument *document, int axis) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    double lower[3], upper[3];
    if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE) continue;
    if (!spore_body_box(document, body, lower, upper)) continue;
    least = fmin(least, lower[axis]);
    most = fmax(most, upper[axis]);
  }
  return least <= most ? 0.5 * (least + most) : 0;
}
