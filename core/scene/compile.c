#include "core/scene/compile.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/name.h"
#include "core/scene/level_settings.h"
#include "core/scene/schema_fields.h"
#include "core/scene/seam.h"

/* What is being put together. */
typedef struct Compiler {
  SporeDocument *document;
  GPtrArray *objects; /* body objects, by index in the world */
  GArray *bodies;     /* of SporeBodyDescription */
  GArray *links;      /* of SporeLinkDescription */
  GArray *tools;      /* of SporeToolDescription */
  GArray *emitters;   /* of SporeEmitterDescription */
  GPtrArray *spheres; /* of SporeSphereSet: models' own */
  GError **error;
} Compiler;

/* Messages. */

static gboolean refuse(Compiler *compiler, const SporeObject *object, const char *format, ...) G_GNUC_PRINTF(3, 4);
static gboolean refuse(Compiler *compiler, const SporeObject *object, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  g_autofree char *where = spore_object_where(object);
  return spore_error_raise(compiler->error, SPORE_ERROR_INPUT, where, "%s", message);
}

/* Nearest name among the objects that a reference may name, or NULL. */
static const char *nearest_name(const SporeDocument *document, const char *elements, const char *name) {
  g_autoptr(GPtrArray) names = g_ptr_array_new();
  const SporeObject *root = spore_document_root(document);
  for (guint s = 0; s < spore_object_child_count(root); s++) {
    const SporeObject *section = spore_object_child(root, s);
    for (guint i = 0; i < spore_object_child_count(section); i++) {
      const char *other = spore_object_name(spore_object_child(section, i));
      if (other && spore_document_find(document, elements, other)) g_ptr_array_add(names, (gpointer)other);
    }
  }
  g_ptr_array_add(names, NULL);
  return spore_name_nearest((const char *const *)names->pdata, name);
}

/* The object that a reference names. FALSE: it names nothing that is there; *target NULL: it is not set. */
static gboolean resolve(Compiler *compiler, const SporeObject *object, const char *property, SporeObject **target) {
  const char *name = spore_object_text(object, property);
  *target = spore_object_reference(object, property);
  if (!name || *target) return TRUE;
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  const char *elements = spore_object_type(object)->table->parameters[index].references;
  const char *nearest = nearest_name(compiler->document, elements, name);
  if (nearest)
    return refuse(compiler, object, _("%s=\"%s\" names nothing; expected the name of a <%s>; did you mean \"%s\"?"),
                  property, name, elements, nearest);
  return refuse(compiler, object,
                _("%s=\"%s\" names nothing; expected the name of a <%s>; add one or correct the name"), property, name,
                elements);
}

/* Bodies. */

static gboolean is_solid(Compiler *compiler, const SporeObject *mechanical, const SporeObject *asset,
                         const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  SporeError fault = SPORE_ERROR_INIT;
  return spore_triangle_mesh_report_solid(mesh, &report, &fault) ||
         refuse(compiler, mechanical, "\"%s\": %s", spore_object_name(asset), fault.message);
}

/* The kind of asset that each kind of geometry asks for, and how messages tell of it. */
typedef struct GeometryWords {
  const char *element, *missing, *wrong;
} GeometryWords;

static const GeometryWords *geometry_words(SporeGeometryKind kind) {
  static const GeometryWords mesh = {
      "mesh", N_("%s has no geometry; expected a mesh; name one here"),
      N_("geometry=\"%s\" is a <%s>; %s needs a mesh; name the one that it was made from")};
  static const GeometryWords tetrahedra = {
      "tetrahedra", N_("%s has no geometry; expected tetrahedra; generate them and name them here"),
      N_("geometry=\"%s\" is a <%s>; %s needs tetrahedra; generate them from the mesh and name those here")};
  static const GeometryWords curve = {
      "curve", N_("%s has no geometry; expected a curve; make one and name it here"),
      N_("geometry=\"%s\" is a <%s>; %s needs a curve; make one along it and name that here")};
  return kind == SPORE_GEOMETRY_TETRAHEDRA ? &tetrahedra : kind == SPORE_GEOMETRY_CURVE ? &curve : &mesh;
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
static gboolean refuse_geometry(Compiler *compiler, const SporeObject *mechanical, const SporeModelType *type,
                                const SporeObject *asset) {
  const GeometryWords *words = geometry_words(type->geometry);
  if (!asset) return refuse(compiler, mechanical, _(words->missing), type->name);
  return refuse(compiler, mechanical, _(words->wrong), spore_object_name(asset), spore_object_type(asset)->element,
                type->name);
}
#pragma GCC diagnostic pop

/* What the model is to be built from, as `mechanical`, or a level of it, says. Fails with a message when the asset is
 * missing or of the wrong kind. */
static gboolean find_geometry(Compiler *compiler, const SporeObject *mechanical, const SporeModelType *type,
                              SporeGeometry *geometry) {
  SporeObject *asset;
  if (type->geometry == SPORE_GEOMETRY_NONE) return TRUE;
  if (!resolve(compiler, mechanical, "geometry", &asset)) return FALSE;
  const char *element = geometry_words(type->geometry)->element;
  if (!asset || strcmp(spore_object_type(asset)->element, element) != 0)
    return refuse_geometry(compiler, mechanical, type, asset);
  switch (type->geometry) {
  case SPORE_GEOMETRY_TETRAHEDRA:
    geometry->tetrahedra = spore_document_tetrahedra(compiler->document, asset, compiler->error);
    return geometry->tetrahedra != NULL;
  case SPORE_GEOMETRY_CURVE:
    geometry->curve = spore_document_curve(compiler->document, asset, compiler->error);
    return geometry->curve != NULL;
  default:
    geometry->surface = spore_document_mesh(compiler->document, asset, compiler->error);
  }
  if (!geometry->surface) return FALSE;
  return type->geometry != SPORE_GEOMETRY_SOLID || is_solid(compiler, mechanical, asset, geometry->surface);
}

/* The object of a body's model, or NULL. */
static SporeObject *model_object(const SporeObject *body) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  return mechanical && spore_object_child_count(mechanical) > 0 ? spore_object_child(mechanical, 0) : NULL;
}

/* Regions. */

/* By how much the region's tissue differs from what the model has of a parameter. */
static gboolean scale_by_tissue(Compiler *compiler, const SporeObject *region, const SporeObject *model,
                                const SporeTissue *tissue, const char *name, double *scale) {
  const SporeTissueQuantity *quantity = spore_tissue_find(tissue, name);
  if (!quantity || spore_parameter_find(spore_object_type(model)->table, name) < 0)
    return refuse(compiler, region,
                  _("material=\"%s\" does not tell the region its %s; expected a tissue of which that is known; choose "
                    "another or set a factor"),
                  tissue->name, name);
  *scale *= quantity->typical.number[0] / spore_object_number(model, name);
  return TRUE;
}

static gboolean describe_region(Compiler *compiler, const SporeObject *object, const SporeObject *model,
                                SporeRegion *region) {
  SporeRegionFields fields;
  spore_object_fields(object, &fields);
  *region = (SporeRegion){.centre = spore_vec3_load(fields.centre),
                          .radius = fields.radius,
                          .stiffness = fields.stiffness_scale,
                          .density = fields.density_scale};
  const SporeTissue *tissue = fields.material > 0 ? &spore_tissues[fields.material - 1] : NULL;
  return !tissue || (scale_by_tissue(compiler, object, model, tissue, "young_modulus", &region->stiffness) &&
                     scale_by_tissue(compiler, object, model, tissue, "density", &region->density));
}

/* *regions: what `model` is to be given; free its regions. */
static gboolean find_regions(Compiler *compiler, const SporeObject *body, const SporeObject *model,
                             SporeRegions *regions) {
  const SporeObject *unit = spore_object_child_of(body, "regions");
  guint count = unit ? spore_object_child_count(unit) : 0;
  if (count == 0) return TRUE;
  if (!spore_object_type(model)->model->regions)
    return refuse(compiler, unit,
                  _("%s has no regions; expected tetrahedra or finite differences; choose one of those or take the "
                    "regions out"),
                  spore_object_type(model)->element);
  *regions = (SporeRegions){count, g_new0(SporeRegion, count)};
  for (guint i = 0; i < count; i++)
    if (!describe_region(compiler, spore_object_child(unit, i), model, &regions->regions[i])) return FALSE;
  return TRUE;
}

/* A region that the finest model has nothing in is a mistake. */
static gboolean check_regions(Compiler *compiler, const SporeObject *body, const SporeRegions *regions) {
  for (guint i = 0; i < regions->count; i++) {
    const SporeObject *region = spore_object_child(spore_object_child_of(body, "regions"), i);
    if (regions->regions[i].elements == 0)
      return refuse(
          compiler, region,
          _("the region \"%s\" holds the middle of no element; expected one within %g m of its centre, in the "
            "body's frame; move it or make it larger"),
          spore_object_name(region), regions->regions[i].radius);
  }
  return TRUE;
}

static gboolean make_model(Compiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  const SporeObject *object = model_object(body);
  if (!object)
    return refuse(compiler, body,
                  _("the passive body \"%s\" has no mechanical model; expected one to move it; choose a model "
                    "or make its role unmovable"),
                  spore_object_name(body));
  const SporeObject *mechanical = spore_object_parent(object);
  const SporeModelType *type = spore_object_type(object)->model;
  SporeRegions regions = {0};
  SporeGeometry geometry = {.regions = &regions};
  gboolean described =
      find_geometry(compiler, mechanical, type, &geometry) && find_regions(compiler, body, object, &regions);
  g_autofree SporeRegion *owned = regions.regions;
  if (!described) return FALSE;
  SporeError fault = SPORE_ERROR_INIT;
  g_autofree void *fields = g_malloc0(MAX(type->parameters.size, 1));
  spore_object_fields(object, fields);
  description->model = type->create(&geometry, fields, &fault);
  description->integrator = (SporeIntegratorKind)((int)spore_object_number(mechanical, "integrator") - 1);
  description->substeps = (size_t)spore_object_number(mechanical, "substeps");
  if (description->model && check_regions(compiler, body, &regions)) return TRUE;
  if (description->model) {
    type->destroy(description->model);
    description->model = NULL;
    return FALSE;
  }
  return refuse(compiler, object, "%s%s%s", fault.place, *fault.place ? ": " : "", fault.message);
}

/* One level: the body's model with what differs. */
static gboolean make_level(Compiler *compiler, const SporeObject *model, SporeObject *level, SporeModel **made) {
  const SporeModelType *type = spore_object_type(model)->model;
  SporeRegions regions = {0};
  SporeGeometry geometry = {.regions = &regions};
  SporeLevelFields level_fields;
  SporeError fault = SPORE_ERROR_INIT;
  spore_object_fields(level, &level_fields);
  const SporeObject *from = level_fields.geometry ? level : spore_object_parent(model);
  const SporeObject *body = spore_object_parent(spore_object_parent(model));
  gboolean described = find_geometry(compiler, from, type, &geometry) && find_regions(compiler, body, model, &regions);
  g_autofree SporeRegion *owned = regions.regions;
  if (!described) return FALSE;
  g_autofree void *fields = g_malloc0(MAX(type->parameters.size, 1));
  spore_object_fields(model, fields);
  if (spore_level_settings_apply(&type->parameters, level_fields.settings, fields, &fault))
    *made = type->create(&geometry, fields, &fault);
  return *made || refuse(compiler, level, "%s%s%s", fault.place, *fault.place ? ": " : "", fault.message);
}

/* Points of the body that are seen. */
static gboolean find_surface(Compiler *compiler, const SporeObject *body, SporeLevelsDescription *levels) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = NULL;
  if (!visual) return TRUE;
  if (!resolve(compiler, visual, "mesh", &asset)) return FALSE;
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(compiler->document, asset, compiler->error) : NULL;
  if (mesh) levels->surface = mesh->vertices, levels->surface_count = mesh->vertex_count;
  return mesh || !asset;
}

static gboolean add_levels(Compiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  const SporeObject *fidelity = spore_object_child_of(body, "fidelity"), *model = model_object(body);
  SporeLevelsDescription *levels = &description->levels;
  SporeFidelityFields fields;
  if (!fidelity) return TRUE;
  spore_object_fields(fidelity, &fields);
  levels->first = (SporeLevelGrade)fields.level;
  levels->tolerance = fields.level_tolerance;
  for (int k = 0; k < SPORE_LEVEL_FINE; k++) {
    SporeObject *level = spore_object_child_of(fidelity, spore_level_names[k]);
    if (level && !model)
      return refuse(compiler, level, _("the body does not move by physics, so that it has no levels; take them out"));
    if (level && !make_level(compiler, model, level, &levels->model[k])) return FALSE;
  }
  if (levels->first != SPORE_LEVEL_FINE && !levels->model[levels->first])
    return refuse(compiler, fidelity,
                  _("level=\"%s\", and there is no such level; expected <%s> in it; add it, or take "
                    "level fine"),
                  spore_level_names[levels->first], spore_level_names[levels->first]);
  gboolean any = levels->model[SPORE_LEVEL_COARSE] || levels->model[SPORE_LEVEL_MEDIUM];
  return !any || find_surface(compiler, body, levels);
}

gboolean spore_body_has_own_spheres(const SporeObject *body) {
  const SporeObject *collision = spore_object_child_of(body, "collision"), *model = model_object(body);
  return (int)spore_object_number(body, "role") == SPORE_PASSIVE && collision && model &&
         !spore_object_text(collision, "spheres") && spore_object_type(model)->model->spheres;
}

SporePose spore_body_pose(const SporeObject *body) {
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  return (SporePose){spore_vec3_load(fields.position),
                     spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation))};
}

static void free_spheres(gpointer data) {
  spore_sphere_set_clear(data);
  g_free(data);
}

static gboolean add_own_spheres(Compiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  if (!spore_body_has_own_spheres(body)) return TRUE;
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  SporeError fault = SPORE_ERROR_INIT;
  g_ptr_array_add(compiler->spheres, set);
  description->spheres = set;
  return description->model->type->spheres(description->model, set, &fault) ||
         refuse(compiler, body, "%s", fault.message);
}

static gboolean add_collision(Compiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  const SporeObject *collision = spore_object_child_of(body, "collision");
  spore_parameters_set_initial(&spore_contact_parameters, &description->contact);
  if (!collision) return TRUE;
  SporeCollisionFields fields;
  SporeObject *spheres;
  spore_object_fields(collision, &fields);
  description->contact = fields.contact;
  if (!resolve(compiler, collision, "spheres", &spheres)) return FALSE;
  if (spheres) description->spheres = spore_document_spheres(compiler->document, spheres, compiler->error);
  return !spheres || description->spheres;
}

static gboolean add_body(Compiler *compiler, SporeObject *body) {
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  SporeBodyDescription description = {
      .name = fields.name,
      .role = (SporeRole)fields.role,
      .integrator = SPORE_INTEGRATOR_DEFAULT,
      .pose = {spore_vec3_load(fields.position), spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation))},
      .velocity = spore_vec3_load(fields.velocity),
      .spin = spore_vec3_load(fields.spin)};
  if (!add_collision(compiler, body, &description)) return FALSE;
  if (description.role == SPORE_PASSIVE && !make_model(compiler, body, &description)) return FALSE;
  gboolean added = add_own_spheres(compiler, body, &description) && add_levels(compiler, body, &description);
  g_ptr_array_add(compiler->objects, body);
  g_array_append_val(compiler->bodies, description);
  return added;
}

/* Links. */

static gboolean body_index(Compiler *compiler, const SporeObject *object, const char *property, guint32 *index) {
  SporeObject *body;
  *index = SPORE_NO_BODY;
  if (!resolve(compiler, object, property, &body)) return FALSE;
  guint found;
  if (body && g_ptr_array_find(compiler->objects, body, &found)) *index = found;
  return TRUE;
}

static gboolean add_pin(Compiler *compiler, const SporeObject *object) {
  SporePinFields fields;
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name,
                               .kind = SPORE_LINK_PIN,
                               .body_b = SPORE_NO_BODY,
                               .point_a = spore_vec3_load(fields.point),
                               .radius = fields.radius};
  if (!body_index(compiler, object, "body", &link.body_a)) return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return refuse(compiler, object, _("the pin \"%s\" has no body; expected the name of one; set it"), fields.name);
  g_array_append_val(compiler->links, link);
  return TRUE;
}

static gboolean add_spring(Compiler *compiler, const SporeObject *object) {
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
  if (!body_index(compiler, object, "body_a", &link.body_a) || !body_index(compiler, object, "body_b", &link.body_b))
    return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return refuse(compiler, object, _("the spring \"%s\" has no body_a; expected the name of a body; set it"),
                  fields.name);
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

static gboolean add_joint(Compiler *compiler, const SporeObject *object) {
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
  if (!body_index(compiler, object, "body_a", &link.body_a) || !body_index(compiler, object, "body_b", &link.body_b))
    return FALSE;
  if (link.body_a == SPORE_NO_BODY)
    return refuse(compiler, object, _("the link \"%s\" has no body_a; expected the name of a body; set it"),
                  fields.name);
  g_array_append_val(compiler->links, link);
  return TRUE;
}

/* What it holds at each point is a ball joint; all of them together have its stiffness and strength. */
static gboolean add_seam(Compiler *compiler, const SporeObject *object) {
  SporeLinkFields fields = {0};
  SporeSeamSide sides[2];
  spore_object_fields(object, &fields);
  SporeLinkDescription link = {.name = fields.name, .kind = SPORE_LINK_BALL, .damping = fields.joint.damping};
  if (!body_index(compiler, object, "body_a", &link.body_a) || !body_index(compiler, object, "body_b", &link.body_b))
    return FALSE;
  if (link.body_a == SPORE_NO_BODY || link.body_b == SPORE_NO_BODY)
    return refuse(compiler, object, _("the seam \"%s\" joins two bodies, and names fewer; set body_a and body_b"),
                  fields.name);
  for (int i = 0; i < 2; i++) {
    const SporeBodyDescription *body =
        &g_array_index(compiler->bodies, SporeBodyDescription, i ? link.body_b : link.body_a);
    sides[i] = (SporeSeamSide){body->model, body->pose};
  }
  g_autoptr(GArray) points = g_array_new(FALSE, FALSE, sizeof(SporeVec3));
  spore_seam_find(&sides[0], &sides[1], fields.distance, points);
  if (!points->len)
    return refuse(compiler, object,
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

static gboolean add_link(Compiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  if (strcmp(element, "pin") == 0) return add_pin(compiler, object);
  if (strcmp(element, "seam") == 0) return add_seam(compiler, object);
  return strcmp(element, "spring") == 0 ? add_spring(compiler, object) : add_joint(compiler, object);
}

/* Tools that do more than touch. */

static gboolean add_jaws(Compiler *compiler, const SporeObject *object, SporeToolKind kind) {
  SporeJawToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = kind,
                               .hinge = spore_vec3_load(fields.hinge),
                               .axis = spore_vec3_load(fields.axis),
                               .point = spore_vec3_load(fields.tip),
                               .jaws = fields.jaws};
  if (!body_index(compiler, object, "body", &tool.body) || !body_index(compiler, object, "jaw_a", &tool.jaw_a) ||
      !body_index(compiler, object, "jaw_b", &tool.jaw_b))
    return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_suction(Compiler *compiler, const SporeObject *object) {
  SporeSuctionToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_SUCTION,
                               .point = spore_vec3_load(fields.point),
                               .suction = fields.suction};
  if (!body_index(compiler, object, "body", &tool.body)) return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_bipolar(Compiler *compiler, const SporeObject *object) {
  SporeBipolarToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_BIPOLAR,
                               .point = spore_vec3_load(fields.point),
                               .bipolar = fields.bipolar};
  if (!body_index(compiler, object, "body", &tool.body)) return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_needle(Compiler *compiler, const SporeObject *object) {
  SporeNeedleToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_NEEDLE,
                               .point = spore_vec3_load(fields.tip),
                               .middle = spore_vec3_load(fields.middle),
                               .swage = spore_vec3_load(fields.swage),
                               .needle = fields.needle};
  if (!body_index(compiler, object, "body", &tool.body) || !body_index(compiler, object, "thread", &tool.thread))
    return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_emitter(Compiler *compiler, const SporeObject *object) {
  SporeWoundFields fields = {0};
  spore_object_fields(object, &fields);
  SporeEmitterDescription emitter = {.name = fields.name,
                                     .point = spore_vec3_load(fields.point),
                                     .direction = spore_vec3_load(fields.direction),
                                     .fields = fields.emitter};
  if (!body_index(compiler, object, "body", &emitter.body) || !body_index(compiler, object, "source", &emitter.source))
    return FALSE;
  g_array_append_val(compiler->emitters, emitter);
  return TRUE;
}

static gboolean add_tool(Compiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  if (strcmp(element, "grasper") == 0) return add_jaws(compiler, object, SPORE_TOOL_GRASPER);
  if (strcmp(element, "clamp") == 0) return add_jaws(compiler, object, SPORE_TOOL_CLAMP);
  if (strcmp(element, "scissors") == 0) return add_jaws(compiler, object, SPORE_TOOL_SCISSORS);
  if (strcmp(element, "bipolar") == 0) return add_bipolar(compiler, object);
  if (strcmp(element, "suction") == 0) return add_suction(compiler, object);
  if (strcmp(element, "needle") == 0) return add_needle(compiler, object);
  return TRUE;
}

/* Input. */

static gboolean copy_channel(Compiler *compiler, SporeTrack *track, const SporeTrackChannel *from, const char *name) {
  SporeTrackChannel *channel = spore_track_add_channel(track, name);
  for (size_t i = 0; channel && i < from->count; i++)
    if (!spore_track_append(channel, from->time_s[i], &from->states[i])) channel = NULL;
  return channel || spore_error_raise(compiler->error, SPORE_ERROR_MEMORY, NULL, "%s",
                                      _("not enough memory for the recorded input; close something or shorten it"));
}

/* The channel that drives `body`: the one of its name, or the only one there is. */
static const SporeTrackChannel *channel_for(const SporeTrack *track, const char *body) {
  const SporeTrackChannel *channel = spore_track_channel(track, body);
  return !channel && track->channel_count == 1 ? &track->channels[0] : channel;
}

static gboolean add_track(Compiler *compiler, SporeTrack *merged, const SporeObject *device, const char *body) {
  const char *file = spore_object_text(device, "file");
  g_autoptr(GError) unreadable = NULL;
  g_autoptr(GBytes) content = file ? spore_document_read_asset(compiler->document, file, &unreadable) : NULL;
  if (!content)
    return refuse(compiler, device, "%s", unreadable ? unreadable->message : _("the track has no file; set it"));
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  SporeTrack track = {0};
  SporeError fault = SPORE_ERROR_INIT;
  gboolean done;
  if (!spore_track_parse(&track, file, text, size, &fault)) {
    done = refuse(compiler, device, "%s: %s", fault.place, fault.message);
  } else {
    const SporeTrackChannel *channel = channel_for(&track, body);
    done = channel ? copy_channel(compiler, merged, channel, body)
                   : refuse(compiler, device,
                            _("the track has no channel \"%s\"; expected one of the body's name; record it "
                              "or rename the channel"),
                            body);
  }
  spore_track_clear(&track);
  return done;
}

static gboolean add_input(Compiler *compiler, SporeTrack *merged, const SporeTrack *input, const SporeObject *probe) {
  SporeObject *body, *device;
  if (spore_parameter_find(spore_object_type(probe)->table, "device") < 0) return TRUE;
  if (!resolve(compiler, probe, "body", &body) || !resolve(compiler, probe, "device", &device)) return FALSE;
  if (!body) return TRUE; /* `check` says it */
  const char *name = spore_object_name(body);
  if ((int)spore_object_number(body, "role") != SPORE_ACTIVE)
    return refuse(compiler, probe,
                  _("the tool's body \"%s\" is not active; expected role=\"active\"; change its role or choose "
                    "another body"),
                  name);
  if (!device || strcmp(spore_object_type(device)->element, "track") != 0) return TRUE;
  if (input && spore_track_channel(input, name)) return TRUE;
  if (spore_track_channel(merged, name))
    return refuse(compiler, probe, _("two tools move the body \"%s\"; expected one; remove one"), name);
  return add_track(compiler, merged, device, name);
}

static gboolean merge_input(Compiler *compiler, SporeTrack *merged, const SporeTrack *input) {
  for (size_t i = 0; input && i < input->channel_count; i++) {
    const char *name = input->channels[i].name;
    const SporeObject *body = spore_document_find(compiler->document, "body", name);
    if (!body || (int)spore_object_number(body, "role") != SPORE_ACTIVE)
      return spore_error_raise(
          compiler->error, SPORE_ERROR_INPUT, NULL,
          _("the input track moves \"%s\"; expected the name of an active body of the scene; rename the "
            "channel or use the track's own scene"),
          name);
    if (!copy_channel(compiler, merged, &input->channels[i], name)) return FALSE;
  }
  const SporeObject *tools = spore_document_section(compiler->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (!add_input(compiler, merged, input, spore_object_child(tools, i))) return FALSE;
  return TRUE;
}

/* Devices that play the merged track. */
static gboolean open_devices(Compiler *compiler, SporeSimulation *simulation) {
  SporeTrack *track = simulation->track;
  for (size_t i = 0; i < track->channel_count; i++) {
    SporeDevice *device = spore_track_device_create(&track->channels[i]);
    if (!device)
      return spore_error_raise(compiler->error, SPORE_ERROR_MEMORY, NULL, "%s",
                               _("not enough memory for the recorded input; close something or shorten it"));
    g_ptr_array_add(simulation->devices, device);
    spore_world_set_device(simulation->world, spore_world_find_body(simulation->world, track->channels[i].name),
                           device);
  }
  if (track->channel_count == 0) g_clear_pointer(&simulation->track, g_free);
  return TRUE;
}

/* The whole. */

static gboolean describe(Compiler *compiler) {
  SporeObject *bodies = spore_document_section(compiler->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    if (!add_body(compiler, spore_object_child(bodies, i))) return FALSE;
  SporeObject *links = spore_document_section(compiler->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++)
    if (!add_link(compiler, spore_object_child(links, i))) return FALSE;
  SporeObject *tools = spore_document_section(compiler->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (!add_tool(compiler, spore_object_child(tools, i))) return FALSE;
  SporeObject *effects = spore_document_section(compiler->document, "effects");
  for (guint i = 0; i < spore_object_child_count(effects); i++)
    if (!add_emitter(compiler, spore_object_child(effects, i))) return FALSE;
  return TRUE;
}

static void destroy_models(const Compiler *compiler) {
  for (guint i = 0; i < compiler->bodies->len; i++) {
    const SporeBodyDescription *body = &g_array_index(compiler->bodies, SporeBodyDescription, i);
    SporeModel *const models[] = {body->model, body->levels.model[SPORE_LEVEL_COARSE],
                                  body->levels.model[SPORE_LEVEL_MEDIUM]};
    for (gsize k = 0; k < G_N_ELEMENTS(models); k++)
      if (models[k]) models[k]->type->destroy(models[k]);
  }
}

/* The kernel says paths; the author wants the line of the file. */
static gboolean say_in_scene(Compiler *compiler, const SporeError *fault) {
  SporeObject *object = *fault->place ? spore_document_by_path(compiler->document, fault->place) : NULL;
  if (!object) return spore_error_propagate(fault, compiler->error);
  g_autofree char *where = spore_object_where(object);
  return spore_error_raise(compiler->error, fault->code, where, "%s", fault->message);
}

static SporeWorld *create_world(Compiler *compiler, SporePool *pool) {
  SporeEnvironmentFields environment;
  SporeWorldDescription description = {.body_count = compiler->bodies->len,
                                       .link_count = compiler->links->len,
                                       .tool_count = compiler->tools->len,
                                       .emitter_count = compiler->emitters->len,
                                       .emitters = (const SporeEmitterDescription *)(void *)compiler->emitters->data,
                                       .bodies = (const SporeBodyDescription *)(void *)compiler->bodies->data,
                                       .links = (const SporeLinkDescription *)(void *)compiler->links->data,
                                       .tools = (const SporeToolDescription *)(void *)compiler->tools->data};
  spore_object_fields(spore_document_section(compiler->document, "environment"), &environment);
  spore_object_fields(spore_document_section(compiler->document, "solver"), &description.solver);
  description.gravity = spore_vec3_load(environment.gravity);
  SporeError fault = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, pool, &fault);
  if (!world) say_in_scene(compiler, &fault);
  return world;
}

static void close_device(gpointer data) {
  SporeDevice *device = data;
  device->type->close(device);
}

static SporeSimulation *assemble(Compiler *compiler, SporePool *pool, const SporeTrack *input) {
  SporeSimulation *simulation = g_new0(SporeSimulation, 1);
  simulation->devices = g_ptr_array_new_with_free_func(close_device);
  simulation->track = g_new0(SporeTrack, 1);
  gboolean done = describe(compiler) && merge_input(compiler, simulation->track, input);
  if (done) simulation->world = create_world(compiler, pool);
  if (!simulation->world) destroy_models(compiler);
  simulation->body_object = g_new0(guint32, MAX(compiler->objects->len, 1));
  for (guint i = 0; i < compiler->objects->len; i++)
    simulation->body_object[i] = spore_object_id(g_ptr_array_index(compiler->objects, i));
  if (simulation->world && open_devices(compiler, simulation)) return simulation;
  spore_simulation_free(simulation);
  return NULL;
}

SporeSimulation *spore_simulation_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                      GError **error) {
  Compiler compiler = {.document = document, .error = error};
  compiler.objects = g_ptr_array_new();
  compiler.bodies = g_array_new(FALSE, TRUE, sizeof(SporeBodyDescription));
  compiler.links = g_array_new(FALSE, TRUE, sizeof(SporeLinkDescription));
  compiler.tools = g_array_new(FALSE, TRUE, sizeof(SporeToolDescription));
  compiler.emitters = g_array_new(FALSE, TRUE, sizeof(SporeEmitterDescription));
  compiler.spheres = g_ptr_array_new_with_free_func(free_spheres);
  SporeSimulation *simulation = assemble(&compiler, pool, input);
  g_ptr_array_unref(compiler.objects);
  g_array_unref(compiler.bodies);
  g_array_unref(compiler.links);
  g_array_unref(compiler.tools);
  g_array_unref(compiler.emitters);
  g_ptr_array_unref(compiler.spheres);
  return simulation;
}

void spore_simulation_free(SporeSimulation *simulation) {
  if (!simulation) return;
  if (simulation->world) spore_world_free(simulation->world);
  g_ptr_array_unref(simulation->devices); /* after the world that borrows them, before the track that they borrow */
  if (simulation->track) spore_track_clear(simulation->track);
  g_free(simulation->track);
  g_free(simulation->body_object);
  g_free(simulation);
}

guint32 spore_simulation_body_of(const SporeSimulation *simulation, SporeObject *object) {
  while (object && strcmp(spore_object_type(object)->element, "body") != 0) object = spore_object_parent(object);
  if (!object) return SPORE_NO_BODY;
  size_t count = spore_world_body_count(simulation->world);
  for (guint32 i = 0; i < count; i++)
    if (simulation->body_object[i] == spore_object_id(object)) return i;
  return SPORE_NO_BODY;
}

/* While it runs. */

static gboolean same_state(const SporeModel *a, const SporeModel *b) {
  if (!a || !b) return a == b;
  return a->type == b->type && a->q_count == b->q_count && a->block_count == b->block_count;
}

/* The line has the knots of time 0. */
static gboolean has_first_knots(const SporeWorld *world, guint32 body) {
  SporeLineState line;
  return !spore_world_line_state(world, body, &line) || line.points == line.made;
}

/* The same level, where there still is one. */
static void carry_level(SporeWorld *to, guint32 body, const SporeWorld *from, guint32 old) {
  SporeLevelState state;
  if (!spore_world_level_state(from, old, &state) || !spore_world_level_model(to, body, state.level)) return;
  spore_world_set_level(to, body, state.level);
}

void spore_simulation_carry_over(SporeSimulation *to, const SporeSimulation *from) {
  size_t count = spore_world_body_count(to->world);
  for (guint32 i = 0; i < count; i++) {
    SporeRole role = spore_world_body_role(to->world, i);
    guint32 old = spore_world_find_body(from->world, spore_world_body_name(to->world, i));
    if (old == SPORE_NO_BODY || role == SPORE_UNMOVABLE || spore_world_body_role(from->world, old) != role) continue;
    carry_level(to->world, i, from->world, old);
    if (has_first_knots(from->world, old) &&
        same_state(spore_world_body_model(to->world, i), spore_world_body_model(from->world, old)))
      spore_world_set_state(to->world, i, spore_world_q(from->world, old), spore_world_v(from->world, old));
  }
}

static gboolean holds_text(const SporeParameterTable *table) {
  for (size_t i = 0; i < table->count; i++)
    if (table->parameters[i].type >= SPORE_TEXT) return TRUE;
  return FALSE;
}

static gboolean retune(SporeSimulation *simulation, SporeObject *object, guint32 body) {
  const SporeModel *model = spore_world_body_model(simulation->world, body);
  const SporeModelType *type = spore_object_type(object)->model;
  if (!model) return TRUE; /* unmovable and active bodies have none */
  if (model->type != type || !type->retune || holds_text(&type->parameters)) return FALSE;
  void *fields = spore_allocate(1, type->parameters.size);
  if (!fields) return FALSE;
  spore_object_fields(object, fields);
  SporeCommand command = {.kind = SPORE_COMMAND_RETUNE, .body = body, .fields = fields};
  if (spore_world_post(simulation->world, &command)) return TRUE;
  spore_free(fields);
  return FALSE;
}

static gboolean post_contact(SporeSimulation *simulation, const SporeObject *collision, guint32 body) {
  SporeCollisionFields fields;
  spore_object_fields(collision, &fields);
  SporeCommand command = {.kind = SPORE_COMMAND_CONTACT, .body = body, .contact = fields.contact};
  return spore_world_post(simulation->world, &command);
}

/* The default contact law changed: every body that has a collision unit hears it. */
static gboolean post_contacts(SporeSimulation *simulation, SporeDocument *document) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *collision = spore_object_child_of(spore_object_child(bodies, i), "collision");
    guint32 body = spore_simulation_body_of(simulation, spore_object_child(bodies, i));
    if (collision && (body == SPORE_NO_BODY || !post_contact(simulation, collision, body))) return FALSE;
  }
  return TRUE;
}

static gboolean post_gravity(SporeSimulation *simulation, const SporeObject *environment) {
  SporeEnvironmentFields fields;
  spore_object_fields(environment, &fields);
  SporeCommand command = {.kind = SPORE_COMMAND_GRAVITY, .vector = spore_vec3_load(fields.gravity)};
  return spore_world_post(simulation->world, &command);
}

static gboolean post_level(SporeSimulation *simulation, const SporeObject *fidelity) {
  SporeCommand command = {.kind = SPORE_COMMAND_LEVEL,
                          .body = spore_simulation_body_of(simulation, (SporeObject *)fidelity)};
  SporeFidelityFields fields;
  spore_object_fields(fidelity, &fields);
  command.level = (SporeLevelGrade)fields.level;
  return command.body != SPORE_NO_BODY && spore_world_post(simulation->world, &command);
}

gboolean spore_simulation_apply(SporeSimulation *simulation, SporeDocument *document, SporeObject *object,
                                guint property) {
  const SporeObjectType *type = spore_object_type(object);
  if (type->table->parameters[property].change != SPORE_CHANGE_LIVE) return FALSE;
  if (strcmp(type->element, "environment") == 0) return post_gravity(simulation, object);
  if (strcmp(type->element, "contact") == 0) return post_contacts(simulation, document);
  if (strcmp(type->element, "solver") == 0) return FALSE;
  if (strcmp(type->element, "fidelity") == 0 && strcmp(type->table->parameters[property].name, "level") == 0)
    return post_level(simulation, object);
  if (!type->model && strcmp(type->element, "collision") != 0) return TRUE; /* only shown, or used when generating */
  guint32 body = spore_simulation_body_of(simulation, object);
  if (body == SPORE_NO_BODY) return FALSE;
  return type->model ? retune(simulation, object, body) : post_contact(simulation, object, body);
}
