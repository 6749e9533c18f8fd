/* Links of a document, described to the world that is to be made. */
#include "core/scene/compile_private.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/seam.h"

/* The bodies that the type's parameters refer to: the first must be set. */
static gboolean find_bodies(SporeCompiler *compiler, const SporeObject *object, SporeLinkDescription *link) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  guint32 *bodies[] = {&link->body_a, &link->body_b};
  guint count = 0;
  link->body_b = SPORE_NO_BODY;
  for (gsize i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (parameter->type != SPORE_REFERENCE) continue;
    if (!spore_compiler_body_index(compiler, object, parameter->name, bodies[count])) return FALSE;
    if (count++ == 0 && link->body_a == SPORE_NO_BODY)
      return spore_compiler_refuse(compiler, object,
                                   _("the link \"%s\" has no %s; expected the name of a body; set it"),
                                   spore_object_name(object), parameter->name);
  }
  return TRUE;
}

/* A seam holds its bodies at each point by a ball joint; all of them together have its stiffness and strength. */
static gboolean add_seam(SporeCompiler *compiler, const SporeObject *object) {
  SporeSeamFields fields = {0};
  SporeSeamSide sides[2];
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name, .type = &spore_link_ball, .damping = fields.damping};
  if (!find_bodies(compiler, object, &link)) return FALSE;
  if (link.body_b == SPORE_NO_BODY)
    return spore_compiler_refuse(
        compiler, object, _("the seam \"%s\" joins two bodies, and names fewer; set body_a and body_b"), fields.name);
  for (int i = 0; i < 2; i++) {
    const SporeBodyDescription *body =
        &g_array_index(compiler->bodies, SporeBodyDescription, i ? link.body_b : link.body_a);
    sides[i] = (SporeSeamSide){body->model, body->pose};
  }
  g_autoptr(GArray) points = g_array_new(FALSE, FALSE, sizeof(SporeVec3));
  spore_seam_find(&sides[0], &sides[1], fields.distance, points);
  if (!points->len)
    return spore_compiler_refuse(
        compiler, object,
        _("the seam \"%s\" holds nothing: no node of \"%s\" lies within %g m of one of \"%s\"; move them "
          "together, or make its distance larger"),
        fields.name, fields.body_a, fields.distance, fields.body_b);
  link.stiffness = fields.stiffness / points->len;
  link.strength = fields.strength / points->len;
  if (link.damping > 0) link.damping /= points->len;
  for (guint i = 0; i < points->len; i++) {
    link.point_a = g_array_index(points, SporeVec3, i);
    g_array_append_val(compiler->links, link);
  }
  return TRUE;
}

gboolean spore_compiler_add_link(SporeCompiler *compiler, const SporeObject *object) {
  const SporeLinkType *type = spore_link_type_find(spore_object_type(object)->element);
  if (!type) return add_seam(compiler, object);
  SporeLinkDescription link = {0};
  spore_object_fields(object, &link);
  link.type = type;
  if (!find_bodies(compiler, object, &link)) return FALSE;
  g_array_append_val(compiler->links, link);
  return TRUE;
}
