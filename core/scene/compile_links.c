#include "core/scene/compile_private.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/seam.h"

static gboolean add_pin(SporeCompiler *compiler, const SporeObject *object) {
  SporePinFields fields;
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name,
                               .kind = SPORE_LINK_PIN,
                               .body_b = SPORE_NO_BODY,
                               .point_a = spore_vec3_load(fields.point),
                               .radius = fields.radius};
  if (!spore_compiler_body_index(compiler, object, "body", &link.body_a)) return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return spore_compiler_refuse(compiler, object, _("the pin \"%s\" has no body; expected the name of one; set it"),
                                 fields.name);
  g_array_append_val(compiler->links, link);
  return TRUE;
}

static gboolean set_bodies(SporeCompiler *compiler, const SporeObject *object, SporeLinkDescription *link) {
  return spore_compiler_body_index(compiler, object, "body_a", &link->body_a) &&
         spore_compiler_body_index(compiler, object, "body_b", &link->body_b);
}

static gboolean add_spring(SporeCompiler *compiler, const SporeObject *object) {
  SporeSpringFields fields;
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name,
                               .kind = SPORE_LINK_SPRING,
                               .point_a = spore_vec3_load(fields.point_a),
                               .point_b = spore_vec3_load(fields.point_b),
                               .stiffness = fields.stiffness,
                               .damping = fields.damping,
                               .rest_length = fields.rest_length,
                               .strength = fields.strength};
  if (!set_bodies(compiler, object, &link)) return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return spore_compiler_refuse(
        compiler, object, _("the spring \"%s\" has no body_a; expected the name of a body; set it"), fields.name);
  g_array_append_val(compiler->links, link);
  return TRUE;
}

static const struct {
  const char *element;
  SporeLinkKind kind;
} joint_kinds[] = {{"ball", SPORE_LINK_BALL},
                   {"hinge", SPORE_LINK_HINGE},
                   {"weld", SPORE_LINK_WELD},
                   {"slide", SPORE_LINK_SLIDE},
                   {"port", SPORE_LINK_PORT}};

static gboolean add_joint(SporeCompiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  SporeLinkFields fields = {0};
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name,
                               .point_a = spore_vec3_load(fields.point),
                               .direction = spore_vec3_load(fields.direction),
                               .length = fields.length,
                               .friction = fields.friction,
                               .ends = fields.ends,
                               .stiffness = fields.joint.stiffness,
                               .damping = fields.joint.damping,
                               .strength = fields.joint.strength};
  for (gsize i = 0; i < G_N_ELEMENTS(joint_kinds); i++)
    if (strcmp(element, joint_kinds[i].element) == 0) link.kind = joint_kinds[i].kind;
  if (!set_bodies(compiler, object, &link)) return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return spore_compiler_refuse(compiler, object,
                                 _("the link \"%s\" has no body_a; expected the name of a body; set it"), fields.name);
  g_array_append_val(compiler->links, link);
  return TRUE;
}

/* What it holds at each point is a ball joint; all of them together have its stiffness and strength. */
static gboolean add_seam(SporeCompiler *compiler, const SporeObject *object) {
  SporeLinkFields fields = {0};
  SporeSeamSide sides[2];
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name, .kind = SPORE_LINK_BALL, .damping = fields.joint.damping};
  if (!set_bodies(compiler, object, &link)) return FALSE;
  if (link.body_a == SPORE_NO_BODY || link.body_b == SPORE_NO_BODY)
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
  link.stiffness = fields.joint.stiffness / points->len;
  link.strength = fields.joint.strength / points->len;
  if (link.damping > 0) link.damping /= points->len;
  for (guint i = 0; i < points->len; i++) {
    link.point_a = g_array_index(points, SporeVec3, i);
    g_array_append_val(compiler->links, link);
  }
  return TRUE;
}

gboolean spore_compiler_add_link(SporeCompiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  if (strcmp(element, "pin") == 0) return add_pin(compiler, object);
  if (strcmp(element, "seam") == 0) return add_seam(compiler, object);
  return strcmp(element, "spring") == 0 ? add_spring(compiler, object) : add_joint(compiler, object);
}
