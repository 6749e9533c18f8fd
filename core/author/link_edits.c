/* Ties links to picked places. Which bodies and places a link has is read from the table of its kind. */
#include "core/author/link_edits.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/addition.h"
#include "core/author/edits.h"
#include "core/mesh/common.h"
#include "core/scene/compile.h"
#include "core/sim/link/link_type.h"

#define LEAST_AXIS_M 1e-4 /* ends that are nearer than this give no direction */
#define HELD_PART                                                                                                      \
  0.1 /* radius of what a pin holds around the node nearest to a click, as a part of the body's diagonal */

gboolean spore_link_is(const SporeObject *object) {
  const SporeObject *parent = object ? spore_object_parent(object) : NULL;
  return parent && g_str_equal(spore_object_type(parent)->element, "links");
}

/* The parameter that names the body of an end; NULL: the kind has no such end. */
static const SporeParameter *body_of_end(const SporeObjectType *type, guint end) {
  for (gsize i = 0; i < type->table->count; i++)
    if (type->table->parameters[i].type == SPORE_REFERENCE && end-- == 0) return &type->table->parameters[i];
  return NULL;
}

guint spore_link_end_count(const SporeObjectType *type) {
  guint count = 0;
  while (count < SPORE_LINK_MOST_ENDS && body_of_end(type, count)) count++;
  return count;
}

const char *spore_link_end_doc(const SporeObjectType *type, guint end) { return _(body_of_end(type, end)->doc); }

static gboolean has(const SporeObjectType *type, const char *property) {
  return spore_parameter_find(type->table, property) >= 0;
}

/* The end at which a link that holds at one place holds: where the other body's line goes through, or the first. */
static guint end_of_point(const SporeObjectType *type, guint count) {
  const SporeLinkType *kind = spore_link_type_find(type->element);
  return kind && kind->line == SPORE_LINE_OF_BODY_A && count > 1 ? 1 : 0;
}

static gboolean refuse(const SporeObjectType *type, const char *message, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, _(type->label), "%s", message);
}

/* What the schema cannot say of the ends. */
static gboolean check_ends(const SporeObjectType *type, const SporeLinkEnd *ends, guint count, GError **error) {
  if (!count || !ends[0].body)
    return refuse(type, _("the first end is of no body; the scene alone cannot be tied; click on a body first"), error);
  if (count > 1 && ends[0].body == ends[1].body)
    return refuse(type, _("both ends are of one body; click on another body, or beside all bodies for the scene"),
                  error);
  if (!spore_link_type_find(type->element) && (count < 2 || !ends[1].body))
    return refuse(type, _("a seam joins two bodies, and one was given; click on the second one, too"), error);
  return TRUE;
}

static gboolean write_bodies(SporeDocument *document, SporeObject *link, const SporeLinkEnd *ends, guint count,
                             GError **error) {
  const SporeObjectType *type = spore_object_type(link);
  for (guint end = 0; end < spore_link_end_count(type); end++) {
    const SporeParameter *parameter = body_of_end(type, end);
    SporeObject *body = end < count ? ends[end].body : NULL;
    gboolean done = body ? spore_document_set_text(document, link, parameter->name, spore_object_name(body), error)
                         : spore_document_unset(document, link, (guint)(parameter - type->table->parameters), error);
    if (!done) return FALSE;
  }
  return TRUE;
}

static gboolean write_places(SporeDocument *document, SporeObject *link, const SporeLinkEnd *ends, guint count,
                             GError **error) {
  const SporeObjectType *type = spore_object_type(link);
  SporeVec3 first = ends[0].place, last = ends[count - 1].place;
  SporeVec3 along = spore_vec3_sub(last, first);
  if (has(type, "point_b") && (!spore_edit_set_vector(document, link, "point_a", first, error) ||
                               !spore_edit_set_vector(document, link, "point_b", last, error)))
    return FALSE;
  if (has(type, "point") &&
      !spore_edit_set_vector(document, link, "point", ends[end_of_point(type, count)].place, error))
    return FALSE;
  return !has(type, "direction") || spore_vec3_length(along) < LEAST_AXIS_M ||
         spore_edit_set_vector(document, link, "direction", spore_vec3_scale(1 / spore_vec3_length(along), along),
                               error);
}

static gboolean write_ends(SporeDocument *document, SporeObject *link, const SporeLinkEnd *ends, guint count,
                           GError **error) {
  return write_bodies(document, link, ends, count, error) && write_places(document, link, ends, count, error);
}

static const SporeTriangleMesh *shown_mesh(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
  return asset ? spore_document_mesh(document, asset, NULL) : NULL;
}

static gboolean middle_of(SporeDocument *document, SporeObject *body, SporeVec3 *middle) {
  const SporeTriangleMesh *mesh = body ? shown_mesh(document, body) : NULL;
  SporeVec3 sum = {0, 0, 0};
  if (!mesh || !mesh->vertex_count) return FALSE;
  for (gsize i = 0; i < mesh->vertex_count; i++) sum = spore_vec3_add(sum, spore_vec3_load(mesh->vertices + 3 * i));
  *middle = spore_pose_apply(spore_body_pose(body), spore_vec3_scale(1.0 / (double)mesh->vertex_count, sum));
  return TRUE;
}

static double nearest_of(const double *vertices, gsize count, gsize stride, SporeVec3 place) {
  double nearest = HUGE_VAL;
  for (gsize i = 0; i < count; i++)
    nearest = fmin(nearest, spore_vec3_distance(spore_vec3_load(vertices + stride * i), place));
  return count ? nearest : 0;
}

/* How far the place, in the body's axes, is from what a pin holds there: from the nearest node, or from the middle of
 * what is rigid and has no nodes. */
static double way_to_node(SporeDocument *document, SporeObject *body, const SporeTriangleMesh *shown, SporeVec3 place) {
  const SporeObject *model = spore_body_model_object(body);
  SporeObject *cells = spore_edit_used_asset(document, body, "mechanical", "geometry", "tetrahedra");
  SporeObject *curve = spore_edit_used_asset(document, body, "mechanical", "geometry", "curve");
  const SporeTetrahedralMesh *tetrahedra = cells ? spore_document_tetrahedra(document, cells, NULL) : NULL;
  const SporeCurve *line = curve ? spore_document_curve(document, curve, NULL) : NULL;
  SporeVec3 middle;
  if (tetrahedra) return nearest_of(tetrahedra->vertices, tetrahedra->vertex_count, 3, place);
  if (line) return nearest_of(line->points, line->count, 4, place);
  if (model && !spore_object_type(model)->model->jacobian && middle_of(document, body, &middle))
    return spore_vec3_distance(spore_pose_apply_inverse(spore_body_pose(body), middle), place);
  return nearest_of(shown->vertices, shown->vertex_count, 3, place);
}

/* A click says where a pin holds, not how much: a part of the body's size around the nearest node. */
static gboolean set_radius(SporeDocument *document, SporeObject *link, const SporeLinkEnd *end, GError **error) {
  const SporeTriangleMesh *mesh = has(spore_object_type(link), "radius") ? shown_mesh(document, end->body) : NULL;
  if (!mesh) return TRUE;
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  SporeVec3 place = spore_pose_apply_inverse(spore_body_pose(end->body), end->place);
  double radius = HELD_PART * spore_mesh_diagonal(mesh->vertices, mesh->vertex_count, 3);
  g_ascii_formatd(text, sizeof text, "%.4f", radius + way_to_node(document, end->body, mesh, place));
  return spore_document_set_text(document, link, "radius", text, error);
}

SporeObject *spore_edit_add_link(SporeDocument *document, const char *element, const SporeLinkEnd *ends, guint count,
                                 GError **error) {
  const SporeObject *links = spore_document_section(document, "links");
  const SporeObjectType *type = spore_object_type_child(spore_object_type(links), element);
  if (type && !check_ends(type, ends, count, error)) return NULL;
  g_autofree char *path = type ? g_strdup_printf("links/%s:%s_%s", element, spore_object_name(ends[0].body), element)
                               : g_strdup_printf("links/%s", element);
  spore_document_begin(document, _("Add link"));
  SporeObject *link = spore_edit_add(document, path, error);
  gboolean done = link && write_ends(document, link, ends, count, error) && set_radius(document, link, &ends[0], error);
  return spore_edit_finish(document, done) ? link : NULL;
}

gboolean spore_edit_tie_link(SporeDocument *document, SporeObject *link, const SporeLinkEnd *ends, guint count,
                             GError **error) {
  if (!check_ends(spore_object_type(link), ends, count, error)) return FALSE;
  spore_document_begin(document, _("Tie link elsewhere"));
  return spore_edit_finish(document, write_ends(document, link, ends, count, error));
}

guint spore_link_places(SporeDocument *document, const SporeObject *link, SporeVec3 places[SPORE_LINK_MOST_ENDS]) {
  const SporeObjectType *type = spore_object_type(link);
  guint count = spore_link_end_count(type);
  gboolean apart = has(type, "point_b"), found = apart || has(type, "point");
  for (guint end = 0; end < count; end++) {
    SporeObject *body = spore_object_reference(link, body_of_end(type, end)->name);
    if (end == 0 && !body) return 0;
    if (found) places[end] = spore_object_vector(link, !apart ? "point" : end ? "point_b" : "point_a");
    else if (!middle_of(document, body, &places[end])) return 0;
  }
  return count;
}
