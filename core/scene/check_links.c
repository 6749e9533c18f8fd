/* Links: that tie nothing, tie too often, or tie what is not there. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/schema_fields.h"

#define FAR_AWAY 0.5 /* of a body's size, outside it */

#define ALL_WAYS 6

/* The joint that the link is; NULL: a spring, pin or seam. */
static const SporeLinkType *joint_of(const SporeObject *link) {
  const SporeLinkType *type = spore_link_type_find(spore_object_type(link)->element);
  return type && type->is_joint ? type : NULL;
}

static void check_link(SporeCheck *check, SporeObject *link) {
  const char *property = strcmp(spore_object_type(link)->element, "pin") == 0 ? "body" : "body_a";
  if (!spore_object_text(link, property))
    spore_check_say(check, SPORE_FAULT, link, _("name a body, or remove the link"), _("the link \"%s\" has no %s"),
                    spore_object_name(link), property);
}

/* Physics moves it as a whole. */
static gboolean is_rigid(const SporeObject *body) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  return (SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE && mechanical &&
         spore_object_child_count(mechanical) > 0 &&
         strcmp(spore_object_type(spore_object_child(mechanical, 0))->element, "rigid_body") == 0;
}

/* What the link ties there; NULL: what physics does not move, which is all one. */
static const SporeObject *tied(const SporeObject *link, const char *property) {
  const SporeObject *body = spore_object_reference(link, property);
  return body && (SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE ? body : NULL;
}

static gboolean ties_the_same(const SporeObject *link, const SporeObject *other) {
  const SporeObject *a = tied(link, "body_a"), *b = tied(link, "body_b");
  const SporeObject *c = tied(other, "body_a"), *d = tied(other, "body_b");
  return (a == c && b == d) || (a == d && b == c);
}

/* Said of the link that is one too many. */
static void check_ways(SporeCheck *check, SporeObject *link) {
  const SporeLinkType *kind = joint_of(link);
  const SporeObject *a = kind ? tied(link, "body_a") : NULL, *b = kind ? tied(link, "body_b") : NULL;
  if ((!a && !b) || (a && !is_rigid(a)) || (b && !is_rigid(b))) return;
  const SporeObject *links = spore_document_section(check->document, "links");
  guint before = 0;
  for (guint i = 0; i < spore_object_child_count(links) && spore_object_child(links, i) != link; i++) {
    const SporeObject *other = spore_object_child(links, i);
    if (joint_of(other) && ties_the_same(link, other)) before += joint_of(other)->held_freedoms;
  }
  if (before > ALL_WAYS || before + kind->held_freedoms <= ALL_WAYS) return;
  spore_check_say(check, SPORE_WARNING, link, _("remove one of the links, or choose kinds that hold less"),
                  _("\"%s\" and the links before it hold %u of the 6 ways in which \"%s\" can move: how much each of "
                    "them bears is not determined"),
                  spore_object_name(link), before + kind->held_freedoms, spore_object_name(a ? a : b));
}

void spore_check_links(SporeCheck *check) {
  spore_check_each(check, "links", NULL, check_link);
  spore_check_each(check, "links", NULL, check_ways);
}

/* Points. */

static void grow(double lower[3], double upper[3], const double *point, double radius) {
  for (int k = 0; k < 3; k++) {
    lower[k] = fmin(lower[k], point[k] - radius);
    upper[k] = fmax(upper[k], point[k] + radius);
  }
}

/* Bounds of a body's nodes and spheres at the start. FALSE: it shows none. */
static gboolean body_bounds(const SporeWorld *world, guint32 body, double lower[3], double upper[3]) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  const SporeModel *model = spore_world_body_model(world, body);
  for (int k = 0; k < 3; k++) lower[k] = INFINITY, upper[k] = -INFINITY;
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == body) grow(lower, upper, spheres->centre + 3 * i, spheres->radius[i]);
  for (size_t i = 0; model && model->node_count > 1 && i < model->node_count; i++)
    grow(lower, upper, spore_world_q(world, body) + 3 * i, 0);
  return lower[0] <= upper[0];
}

typedef struct Points {
  SporeCheck *check;
  const SporeSimulation *simulation;
} Points;

static void check_point(const Points *points, SporeObject *link, const char *property, const double point[3]) {
  SporeObject *body = spore_object_reference(link, property);
  guint32 index = body ? spore_simulation_body_of(points->simulation, body) : SPORE_NO_BODY;
  double lower[3], upper[3], away = 0, size = 0;
  if (index == SPORE_NO_BODY || !body_bounds(points->simulation->world, index, lower, upper)) return;
  for (int k = 0; k < 3; k++) {
    double apart = fmax(0, fmax(lower[k] - point[k], point[k] - upper[k]));
    away += apart * apart;
    size += (upper[k] - lower[k]) * (upper[k] - lower[k]);
  }
  away = sqrt(away), size = sqrt(size);
  if (away <= FAR_AWAY * size) return;
  g_autofree char *far = spore_length_text(away), *across = spore_length_text(size);
  spore_check_say(points->check, SPORE_WARNING, link, _("move its point to the body, or choose another body"),
                  _("\"%s\" ties \"%s\" at a point that is %s outside it, while it is %s across: what is between "
                    "them counts as stiff"),
                  spore_object_name(link), spore_object_name(body), far, across);
}

static void check_points(const Points *points, SporeObject *link) {
  const SporeLinkType *type = spore_link_type_find(spore_object_type(link)->element);
  if (!type) return;
  SporeLinkDescription fields = {0};
  spore_object_fields(link, &fields);
  const SporeVec3 *at_b = type->is_joint ? &fields.point_a : &fields.point_b;
  const double a[3] = {fields.point_a.x, fields.point_a.y, fields.point_a.z}, b[3] = {at_b->x, at_b->y, at_b->z};
  if (type->point_on_a) check_point(points, link, "body_a", a);
  if (type->point_on_b) check_point(points, link, "body_b", b);
}

void spore_check_link_points(SporeCheck *check, const SporeSimulation *simulation) {
  const Points points = {check, simulation};
  const SporeObject *links = spore_document_section(check->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++) check_points(&points, spore_object_child(links, i));
}
