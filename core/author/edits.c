/* Edits of a body in one undo step each: its model, presets, a pin, a property by its path. */
#include "core/author/edits.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/math/quat.h"
#include "core/scene/compile.h"
#include "core/scene/generated.h"
#include "core/sim/world.h"

/* Radius of a new pin, as a part of the organ's diagonal. */
#define PIN_PART 0.3

gboolean spore_edit_finish(SporeDocument *document, gboolean done) {
  if (done) spore_document_end(document);
  else spore_document_abort(document);
  return done;
}

SporeObject *spore_edit_child_or_new(SporeDocument *document, SporeObject *parent, const char *element,
                                     GError **error) {
  SporeObject *child = spore_object_child_of(parent, element);
  return child ? child : spore_document_insert(document, parent, element, NULL, G_MAXUINT, error);
}

/* Back to the default, by name. */
static gboolean unset(SporeDocument *document, SporeObject *object, const char *property, GError **error) {
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  return spore_document_unset(document, object, (guint)index, error);
}

gboolean spore_edit_set_vector(SporeDocument *document, SporeObject *object, const char *property, SporeVec3 v,
                               GError **error) {
  char text[3][G_ASCII_DTOSTR_BUF_SIZE];
  const double component[3] = {v.x, v.y, v.z};
  for (int i = 0; i < 3; i++) g_ascii_formatd(text[i], sizeof text[i], "%.4f", component[i]);
  g_autofree char *joined = g_strjoin(" ", text[0], text[1], text[2], NULL);
  return spore_document_set_text(document, object, property, joined, error);
}

/* What a body uses. */

SporeObject *spore_edit_used_asset(SporeDocument *document, SporeObject *body, const char *unit, const char *property,
                                   const char *element) {
  SporeObject *part = spore_object_child_of(body, unit);
  const char *name = part ? spore_object_text(part, property) : NULL;
  return name && *name ? spore_document_find(document, element, name) : NULL;
}

gboolean spore_edit_is_used(const SporeDocument *document, const SporeObject *object) {
  const SporeObject *root = spore_document_root(document);
  for (guint s = 0; s < spore_object_child_count(root); s++)
    if (spore_object_refers_to(spore_object_child(root, s), object)) return TRUE;
  return FALSE;
}

SporeObject *spore_edit_put_asset(SporeDocument *document, const char *element, const char *name, const char *extension,
                                  char *text, gsize size, GError **error) {
  g_autofree char *file = spore_content_file_name(name, extension, text, size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; i < spore_object_child_count(assets); i++) {
    SporeObject *asset = spore_object_child(assets, i);
    if (g_str_equal(spore_object_type(asset)->element, element) &&
        g_strcmp0(spore_object_text(asset, "file"), file) == 0)
      return asset;
  }
  spore_document_put_blob(document, file, content);
  SporeObject *asset = spore_document_insert(document, assets, element, name, G_MAXUINT, error);
  return asset && spore_document_set_text(document, asset, "file", file, error) ? asset : NULL;
}

SporeObject *spore_edit_visual_mesh(SporeDocument *document, SporeObject *body, GError **error) {
  SporeObject *mesh = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
  if (!mesh) {
    g_autofree char *path = spore_object_path(body);
    spore_error_raise(error, SPORE_ERROR_INPUT, path,
                      _("the body shows no mesh; a generator needs a surface; choose one under Visual mesh"));
  }
  return mesh;
}

/* Models. */

/* The geometry that a model needs, where the body has one; NULL: leave the geometry as it is. */
static const char *geometry_for(SporeDocument *document, SporeObject *body, SporeGeometryKind kind) {
  if (kind == SPORE_GEOMETRY_SURFACE || kind == SPORE_GEOMETRY_SOLID) {
    if (spore_edit_used_asset(document, body, "mechanical", "geometry", "mesh")) return NULL;
    SporeObject *mesh = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
    return mesh ? spore_object_name(mesh) : NULL;
  }
  if (kind == SPORE_GEOMETRY_NONE) return NULL;
  const char *element = kind == SPORE_GEOMETRY_CURVE ? "curve" : "tetrahedra";
  if (spore_edit_used_asset(document, body, "mechanical", "geometry", element)) return NULL;
  /* A geometry that was generated earlier from the drawn mesh, and left unused when the body got another model. */
  SporeObject *mesh = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; mesh && i < spore_object_child_count(assets); i++) {
    SporeObject *asset = spore_object_child(assets, i);
    if (g_str_equal(spore_object_type(asset)->element, element) &&
        g_strcmp0(spore_object_text(asset, "source"), spore_object_name(mesh)) == 0)
      return spore_object_name(asset);
  }
  return NULL;
}

/* Sets the role: a model makes an unmovable body passive, and without a model the body is unmovable again. A body that
 * a device moves stays active. */
static gboolean set_role(SporeDocument *document, SporeObject *body, SporeRole role, GError **error) {
  if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE) return TRUE;
  return role == SPORE_PASSIVE ? unset(document, body, "role", error)
                               : spore_document_set_text(document, body, "role", "unmovable", error);
}

static gboolean set_model(SporeDocument *document, SporeObject *body, const char *model, GError **error) {
  SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  if (!set_role(document, body, *model ? SPORE_PASSIVE : SPORE_UNMOVABLE, error)) return FALSE;
  if (*model == '\0') return !mechanical || spore_document_remove(document, mechanical, error);
  if (!mechanical) mechanical = spore_document_insert(document, body, "mechanical", NULL, G_MAXUINT, error);
  if (!mechanical) return FALSE;
  SporeObject *old = spore_body_model_object(body);
  if (old && g_str_equal(spore_object_type(old)->element, model)) return TRUE;
  if (old && !spore_document_remove(document, old, error)) return FALSE;
  SporeObject *new = spore_document_insert(document, mechanical, model, NULL, G_MAXUINT, error);
  if (!new) return FALSE;
  const SporeModelType *type = spore_object_type(new)->model;
  const char *geometry = type ? geometry_for(document, body, type->geometry) : NULL;
  return !geometry || spore_document_set_text(document, mechanical, "geometry", geometry, error);
}

gboolean spore_edit_set_model(SporeDocument *document, SporeObject *body, const char *model, GError **error) {
  spore_document_begin(document, _("Choose model"));
  return spore_edit_finish(document, set_model(document, body, model, error));
}

gboolean spore_edit_give_usual_model(SporeDocument *document, SporeObject *body, SporeGeometryKind kind,
                                     GError **error) {
  SporeModelRegistry type = spore_schema_registry(spore_document_schema(document));
  while (*type && (*type)->geometry != kind) type++;
  return !*type || spore_body_model_object(body) || set_model(document, body, (*type)->name, error);
}

static gboolean use_preset(SporeDocument *document, SporeObject *model, const char *name, GError **error) {
  const SporePreset *preset = spore_object_type(model)->model->presets;
  while (preset && preset->name && strcmp(preset->name, name) != 0) preset++;
  if (!preset || !preset->name)
    return spore_error_raise(error, SPORE_ERROR_INPUT, NULL, _("there is no preset “%s”; choose one of the list"),
                             name);
  for (const char *const *setting = preset->settings; *setting; setting += 2)
    if (!spore_document_set_text(document, model, setting[0], setting[1], error)) return FALSE;
  return TRUE;
}

gboolean spore_edit_use_preset(SporeDocument *document, SporeObject *body, const char *name, GError **error) {
  SporeObject *model = spore_body_model_object(body);
  if (!model) return spore_error_raise(error, SPORE_ERROR_INPUT, NULL, _("the body has no model; choose one first"));
  spore_document_begin(document, _("Use preset"));
  return spore_edit_finish(document, use_preset(document, model, name, error));
}

/* Pin. */

static void grow(double lower[3], double upper[3], SporeVec3 p, double r) {
  const double x[3] = {p.x, p.y, p.z};
  for (int i = 0; i < 3; i++) {
    lower[i] = fmin(lower[i], x[i] - r);
    upper[i] = fmax(upper[i], x[i] + r);
  }
}

/* The vertex that lies farthest behind and below (organs hang on the body wall there), and the size of the mesh. */
static SporeVec3 hold_point(const double *vertices, gsize count, SporePose pose, double *extent) {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  SporeVec3 best = {0, 0, 0};
  double least = HUGE_VAL;
  for (gsize i = 0; i < count; i++) {
    SporeVec3 p = spore_pose_apply(pose, spore_vec3_load(vertices + 3 * i));
    grow(lower, upper, p, 0);
    if (p.y + p.z >= least) continue;
    least = p.y + p.z;
    best = p;
  }
  *extent = spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
  return best;
}

static SporeObject *insert_pin(SporeDocument *document, SporeObject *body, SporeVec3 point, double radius,
                               GError **error) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  g_autofree char *name = g_strdup_printf("%s_pin", spore_object_name(body));
  SporeObject *pin =
      spore_document_insert(document, spore_document_section(document, "links"), "pin", name, G_MAXUINT, error);
  g_ascii_formatd(text, sizeof text, "%.4f", radius);
  gboolean done = pin && spore_document_set_text(document, pin, "body", spore_object_name(body), error) &&
                  spore_edit_set_vector(document, pin, "point", point, error) &&
                  spore_document_set_text(document, pin, "radius", text, error);
  return done ? pin : NULL;
}

/* Vertices of the mesh that the body shows, else of its cells. NULL with an error: it has neither. Borrowed. */
static const double *vertices_of(SporeDocument *document, SporeObject *body, gsize *count, GError **error) {
  SporeObject *cells = spore_edit_used_asset(document, body, "mechanical", "geometry", "tetrahedra");
  SporeObject *shown = spore_edit_visual_mesh(document, body, cells ? NULL : error);
  const SporeTriangleMesh *mesh = shown ? spore_document_mesh(document, shown, error) : NULL;
  const SporeTetrahedralMesh *solid = cells && !shown ? spore_document_tetrahedra(document, cells, error) : NULL;
  *count = mesh ? mesh->vertex_count : solid ? solid->vertex_count : 0;
  return mesh ? mesh->vertices : solid ? solid->vertices : NULL;
}

SporeObject *spore_edit_add_pin(SporeDocument *document, SporeObject *body, GError **error) {
  gsize count;
  const double *vertices = vertices_of(document, body, &count, error);
  if (!vertices) return NULL;
  if ((SporeRole)spore_object_number(body, "role") != SPORE_PASSIVE) {
    g_autofree char *path = spore_object_path(body);
    spore_error_raise(error, SPORE_ERROR_INPUT, path,
                      _("the body does not fall, and needs no pin; expected one that physics moves; give it a model "
                        "first, tetrahedra for instance"));
    return NULL;
  }
  double extent;
  SporeVec3 point = hold_point(vertices, count, spore_body_pose(body), &extent);
  spore_document_begin(document, _("Hold organ"));
  SporeObject *pin = insert_pin(document, body, point, PIN_PART * extent, error);
  spore_edit_finish(document, pin != NULL);
  return pin;
}

gboolean spore_edit_set_colour(SporeDocument *document, SporeObject *body, const double colour[3], GError **error) {
  char one[3][G_ASCII_DTOSTR_BUF_SIZE];
  for (int k = 0; k < 3; k++) g_ascii_formatd(one[k], sizeof one[k], "%.3f", colour[k]);
  g_autofree char *text = g_strjoin(" ", one[0], one[1], one[2], NULL);
  SporeObject *visual = spore_edit_child_or_new(document, body, "visual", error);
  return visual && spore_document_set_text(document, visual, "colour", text, error);
}

/* By path. */

SporeObject *spore_edit_object_or_unit(SporeDocument *document, const char *path, GError **error) {
  SporeObject *object = spore_document_by_path(document, path);
  if (object) return object;
  const char *slash = strrchr(path, '/');
  g_autofree char *parent_path = slash ? g_strndup(path, (gsize)(slash - path)) : NULL;
  SporeObject *parent = parent_path ? spore_document_by_path(document, parent_path) : NULL;
  if (parent && spore_object_type(parent)->ordered && spore_object_type_child(spore_object_type(parent), slash + 1))
    return spore_document_insert(document, parent, slash + 1, NULL, G_MAXUINT, error);
  spore_error_raise(error, SPORE_ERROR_INPUT, path, _("no such object; choose one from the outliner"));
  return NULL;
}

static gboolean change_property(SporeDocument *document, SporeObject *object, const char *property, const char *text,
                                GError **error) {
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  if (index < 0) {
    g_autofree char *path = spore_object_path(object);
    const char *near = spore_parameter_nearest(spore_object_type(object)->table, property);
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, _("unknown property “%s”; the nearest is “%s”"), property,
                             near ? near : "—");
  }
  if (!text) return spore_document_unset(document, object, (guint)index, error);
  if (spore_object_type(object)->table->parameters[index].type == SPORE_NAME)
    return spore_document_rename(document, object, text, error);
  return spore_document_set_text(document, object, property, text, error);
}

gboolean spore_edit_set_property(SporeDocument *document, const char *path, const char *property, const char *text,
                                 GError **error) {
  g_autofree char *label = g_strdup_printf(text ? _("Set %s") : _("Reset %s"), property);
  spore_document_begin(document, label);
  SporeObject *object = spore_edit_object_or_unit(document, path, error);
  return spore_edit_finish(document, object && change_property(document, object, property, text, error));
}

gboolean spore_edit_set_property_of_all(SporeDocument *document, char *const *paths, const char *property,
                                        const char *text, GError **error) {
  g_autofree char *label = g_strdup_printf(text ? _("Set %s") : _("Reset %s"), property);
  gboolean done = TRUE;
  spore_document_begin(document, label);
  for (; done && *paths; paths++) done = spore_edit_set_property(document, *paths, property, text, error);
  return spore_edit_finish(document, done);
}
