/* Describes the bodies of a document to a world: geometry, model, regions, levels of detail and collision spheres. */
#include "core/scene/compile_private.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/fidelity.h"
#include "core/scene/kept_pose.h"
#include "core/scene/level_settings.h"
#include "core/scene/region.h"
#include "core/scene/sheet_corners.h"

static gboolean is_solid(SporeCompiler *compiler, const SporeObject *mechanical, const SporeObject *asset,
                         const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  SporeError fault = SPORE_ERROR_INIT;
  if (spore_triangle_mesh_report_solid(mesh, &report, &fault)) return TRUE;
  g_autofree char *name = g_strdup_printf("\"%s\"", spore_object_name(asset));
  spore_error_at(&fault, name);
  return spore_compiler_pass_on(compiler, mechanical, &fault);
}

/* The kind of asset that each kind of geometry needs, and the words for it in messages. */
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
static gboolean refuse_geometry(SporeCompiler *compiler, const SporeObject *mechanical, const SporeModelType *type,
                                const SporeObject *asset) {
  const GeometryWords *words = geometry_words(type->geometry);
  if (!asset) return spore_compiler_refuse(compiler, mechanical, _(words->missing), type->name);
  return spore_compiler_refuse(compiler, mechanical, _(words->wrong), spore_object_name(asset),
                               spore_object_type(asset)->element, type->name);
}
#pragma GCC diagnostic pop

/* Finds the geometry of a model, named by the mechanical unit or by one of its levels of detail. corners: room for
 * those of a sheet, 4 x 3. FALSE with a message when the asset is missing or of the wrong kind. */
static gboolean find_geometry(SporeCompiler *compiler, const SporeObject *mechanical, const SporeModelType *type,
                              double corners[12], SporeGeometry *geometry) {
  SporeObject *asset;
  if (type->geometry == SPORE_GEOMETRY_NONE) return TRUE;
  if (!spore_compiler_resolve(compiler, mechanical, "geometry", &asset)) return FALSE;
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
    geometry->corners = spore_sheet_corners(asset, corners) ? corners : NULL;
  }
  if (!geometry->surface) return FALSE;
  return type->geometry != SPORE_GEOMETRY_SOLID || is_solid(compiler, mechanical, asset, geometry->surface);
}

/* Finds the root of what holds the body, which the mechanical unit names. */
static gboolean find_root(SporeCompiler *compiler, const SporeObject *mechanical, const SporeModelType *type,
                          SporeGeometry *geometry) {
  SporeObject *asset;
  if (!spore_compiler_resolve(compiler, mechanical, "root", &asset)) return FALSE;
  if (!asset) return TRUE;
  if (!type->root)
    return spore_compiler_refuse(compiler, mechanical,
                                 _("root=\"%s\" is the root of a mesentery, and %s has none; expected it of an "
                                   "intestine alone; take root out"),
                                 spore_object_name(asset), type->name);
  geometry->root = spore_document_curve(compiler->document, asset, compiler->error);
  return geometry->root != NULL;
}

/* Regions. */

/* Multiplies *scale by the ratio of the tissue's value to the model's own value of a parameter. */
static gboolean scale_by_tissue(SporeCompiler *compiler, const SporeObject *region, const SporeObject *model,
                                const SporeTissue *tissue, const char *name, double *scale) {
  const SporeTissueQuantity *quantity = spore_tissue_find(tissue, name);
  if (!quantity || spore_parameter_find(spore_object_type(model)->table, name) < 0)
    return spore_compiler_refuse(
        compiler, region,
        _("material=\"%s\" does not tell the region its %s; expected a tissue of which that is known; choose "
          "another or set a factor"),
        tissue->name, name);
  *scale *= quantity->typical.number[0] / spore_object_number(model, name);
  return TRUE;
}

static gboolean describe_region(SporeCompiler *compiler, const SporeObject *object, const SporeObject *model,
                                SporeRegion *region) {
  SporeRegionFields fields;
  if (!spore_region_check_balls(object, compiler->error)) return FALSE;
  guint count;
  g_autofree double *balls = spore_region_balls(object, &count);
  spore_object_fields(object, &fields);
  *region = (SporeRegion){.ball_count = count,
                          .balls = spore_compiler_keep(compiler, 4 * count * sizeof(double)),
                          .stiffness = fields.stiffness_scale,
                          .density = fields.density_scale};
  memcpy(region->balls, balls, 4 * count * sizeof *balls);
  const SporeTissue *tissue = fields.material > 0 ? &spore_tissues[fields.material - 1] : NULL;
  return !tissue || (scale_by_tissue(compiler, object, model, tissue, "young_modulus", &region->stiffness) &&
                     scale_by_tissue(compiler, object, model, tissue, "density", &region->density));
}

/* Describes the regions of a body for `model`. */
static gboolean find_regions(SporeCompiler *compiler, const SporeObject *body, const SporeObject *model,
                             SporeRegions *regions) {
  const SporeObject *unit = spore_object_child_of(body, "regions");
  guint count = unit ? spore_object_child_count(unit) : 0;
  if (count == 0) return TRUE;
  if (!spore_object_type(model)->model->regions)
    return spore_compiler_refuse(
        compiler, unit,
        _("%s has no regions; expected tetrahedra or finite differences; choose one of those or take the "
          "regions out"),
        spore_object_type(model)->element);
  *regions = (SporeRegions){count, spore_compiler_keep(compiler, count * sizeof(SporeRegion))};
  for (guint i = 0; i < count; i++)
    if (!describe_region(compiler, spore_object_child(unit, i), model, &regions->regions[i])) return FALSE;
  return TRUE;
}

/* Refuses a region in which the finest model has no node: that is a mistake of the author. */
static gboolean check_regions(SporeCompiler *compiler, const SporeObject *body, const SporeRegions *regions) {
  for (guint i = 0; i < regions->count; i++) {
    const SporeObject *region = spore_object_child(spore_object_child_of(body, "regions"), i);
    if (regions->regions[i].elements == 0)
      return spore_compiler_refuse(
          compiler, region,
          regions->regions[i].ball_count > 1
              ? _("the painted region \"%s\" holds the middle of no element; expected one within %g m of its centre or "
                  "in one of its dabs, in the body's frame; paint it with a wider brush")
              : _("the region \"%s\" holds the middle of no element; expected one within %g m of its centre, in the "
                  "body's frame; move it or make it larger"),
          spore_object_name(region), regions->regions[i].balls[3]);
  }
  return TRUE;
}

/* Describes what a model of a body is made from. unit: what names its geometry, the mechanical unit or one of the
 * levels of detail. */
static gboolean describe_model(SporeCompiler *compiler, const SporeObject *model, const SporeObject *unit,
                               SporeModelRecipe *recipe) {
  const SporeModelType *type = spore_object_type(model)->model;
  const SporeObject *mechanical = spore_object_parent(model);
  SporeRegions *regions = spore_compiler_keep(compiler, sizeof *regions);
  double *corners = spore_compiler_keep(compiler, 12 * sizeof *corners);
  void *fields = spore_compiler_keep(compiler, type->parameters.size);
  *recipe = (SporeModelRecipe){type, {.regions = regions, .cancel = compiler->cancel}, fields};
  spore_object_fields(model, fields);
  return find_geometry(compiler, unit, type, corners, &recipe->geometry) &&
         find_root(compiler, mechanical, type, &recipe->geometry) &&
         find_regions(compiler, spore_object_parent(mechanical), model, regions);
}

static gboolean make_model(SporeCompiler *compiler, const SporeObject *body, SporeBodyDescription *description,
                           SporeModelRecipe *recipe) {
  const SporeObject *object = spore_body_model_object(body);
  if (!object)
    return spore_compiler_refuse(
        compiler, body,
        _("the passive body \"%s\" has no mechanical model; expected one to move it; choose a model "
          "or make its role unmovable"),
        spore_object_name(body));
  const SporeObject *mechanical = spore_object_parent(object);
  if (!describe_model(compiler, object, mechanical, recipe)) return FALSE;
  SporeError fault = SPORE_ERROR_INIT;
  description->model = spore_model_create(recipe->type, &recipe->geometry, recipe->fields, &fault);
  description->integrator = (SporeIntegratorKind)((int)spore_object_number(mechanical, "integrator") - 1);
  description->substeps = (size_t)spore_object_number(mechanical, "substeps");
  if (!description->model) return spore_compiler_pass_on(compiler, object, &fault);
  if (check_regions(compiler, body, recipe->geometry.regions)) return TRUE;
  recipe->type->destroy(description->model);
  description->model = NULL;
  return FALSE;
}

/* Makes one level of detail: the body's model with the settings that differ. */
static gboolean make_level(SporeCompiler *compiler, const SporeObject *model, SporeObject *level,
                           SporeModelRecipe *recipe, SporeModel **made) {
  SporeLodFields level_fields;
  SporeError fault = SPORE_ERROR_INIT;
  spore_object_fields(level, &level_fields);
  const SporeObject *from = level_fields.geometry ? level : spore_object_parent(model);
  if (!describe_model(compiler, model, from, recipe)) return FALSE;
  if (spore_level_settings_apply(&recipe->type->parameters, level_fields.settings, (void *)recipe->fields, &fault))
    *made = spore_model_create(recipe->type, &recipe->geometry, recipe->fields, &fault);
  return *made || spore_compiler_pass_on(compiler, level, &fault);
}

gboolean spore_compiler_visual(SporeCompiler *compiler, const SporeObject *body, const SporeTriangleMesh **mesh) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = NULL;
  *mesh = NULL;
  if (visual && !spore_compiler_resolve(compiler, visual, "mesh", &asset)) return FALSE;
  if (asset) *mesh = spore_document_mesh(compiler->document, asset, compiler->error);
  return *mesh || !asset;
}

/* Finds the drawn vertices of the body. */
static gboolean find_surface(SporeCompiler *compiler, const SporeObject *body, SporeLodDescription *levels) {
  const SporeTriangleMesh *mesh;
  if (!spore_compiler_visual(compiler, body, &mesh)) return FALSE;
  if (mesh) levels->surface = mesh->vertices, levels->surface_count = mesh->vertex_count;
  return TRUE;
}

static gboolean add_levels(SporeCompiler *compiler, const SporeObject *body, SporeBodyDescription *description,
                           SporeModelRecipe recipes[SPORE_LOD_COUNT]) {
  const SporeObject *fidelity = spore_object_child_of(body, "fidelity"), *model = spore_body_model_object(body);
  SporeLodDescription *levels = &description->lod;
  SporeFidelityFields fields;
  /* A model that the role leaves unused leaves its levels unused; check says so. */
  if (!fidelity || (model && !description->model)) return TRUE;
  spore_object_fields(fidelity, &fields);
  levels->first = (SporeLodGrade)fields.level;
  levels->tolerance = fields.level_tolerance;
  levels->rule = (SporeLodRule){.by = (SporeLodCause)fields.automatic,
                                .tool_distance = fields.tool_distance,
                                .view_distance = fields.view_distance,
                                .wait_s = fields.level_wait};
  for (int k = 0; k < SPORE_LOD_FINE; k++) {
    SporeObject *level = spore_object_child_of(fidelity, spore_lod_names[k]);
    if (level && !model)
      return spore_compiler_refuse(compiler, level,
                                   _("the body does not move by physics, so that it has no levels; take them out"));
    if (level && !make_level(compiler, model, level, &recipes[k], &levels->model[k])) return FALSE;
  }
  if (levels->first != SPORE_LOD_FINE && !levels->model[levels->first])
    return spore_compiler_refuse(compiler, fidelity,
                                 _("level=\"%s\", and there is no such level; expected <%s> in it; add it, or take "
                                   "level fine"),
                                 spore_lod_names[levels->first], spore_lod_names[levels->first]);
  gboolean any = levels->model[SPORE_LOD_COARSE] || levels->model[SPORE_LOD_MEDIUM];
  return !any || find_surface(compiler, body, levels);
}

gboolean spore_body_has_own_spheres(const SporeObject *body) {
  const SporeObject *collision = spore_object_child_of(body, "collision"), *model = spore_body_model_object(body);
  return (int)spore_object_number(body, "role") == SPORE_PASSIVE && collision && model &&
         !spore_object_text(collision, "spheres") && spore_object_type(model)->model->spheres;
}

#define ALL_OF_IT 0.9 /* of the particles of a fluid: how many there are is known only once the surface is filled */

gboolean spore_body_is_kept_back(SporeDocument *document, const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body), *effects = spore_document_section(document, "effects");
  double kept = 0;
  if (!model || !spore_object_type(model)->model->particles) return FALSE;
  for (guint i = 0; i < spore_object_child_count(effects); i++) {
    const SporeObject *emitter = spore_object_child(effects, i);
    if (spore_object_reference(emitter, "body") == body) kept += spore_object_number(emitter, "reserve");
  }
  return kept > 0 && kept >= ALL_OF_IT * spore_object_number(model, "particles");
}

SporePose spore_body_pose(const SporeObject *body) {
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  return (SporePose){spore_vec3_load(fields.position),
                     spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation))};
}

static gboolean add_own_spheres(SporeCompiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  if (!spore_body_has_own_spheres(body)) return TRUE;
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  SporeError fault = SPORE_ERROR_INIT;
  g_ptr_array_add(compiler->spheres, set);
  description->spheres = set;
  return description->model->type->spheres(description->model, set, &fault) ||
         spore_compiler_pass_on(compiler, body, &fault);
}

static gboolean add_collision(SporeCompiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  const SporeObject *collision = spore_object_child_of(body, "collision");
  spore_parameters_set_initial(&spore_contact_parameters, &description->contact);
  if (!collision) return TRUE;
  SporeCollisionFields fields;
  SporeObject *spheres;
  spore_object_fields(collision, &fields);
  description->contact = fields.contact;
  if (!spore_compiler_resolve(compiler, collision, "spheres", &spheres)) return FALSE;
  if (spheres) description->spheres = spore_document_spheres(compiler->document, spheres, compiler->error);
  return !spheres || description->spheres;
}

/* Finds the pose that the body was kept in. One that is stale is left out; check says so. */
static gboolean find_start(SporeCompiler *compiler, const SporeObject *body, SporeBodyDescription *description) {
  const SporeModel *level =
      description->lod.first == SPORE_LOD_FINE ? NULL : description->lod.model[description->lod.first];
  const SporeModel *model = level ? level : description->model; /* a body without levels has but one model */
  const SporePose frame = {description->pose.position, spore_quat_normalise(description->pose.orientation)};
  SporeKeptPoseState state;
  double *q;
  g_autoptr(GError) fault = NULL;
  if (description->role == SPORE_UNMOVABLE) return TRUE;
  if (!spore_kept_pose_read(compiler->document, body, model, frame, &state, &q, &description->start_count, &fault))
    return spore_compiler_refuse(compiler, body, "%s", fault->message);
  description->start = q;
  if (q) g_ptr_array_add(compiler->kept, q);
  return TRUE;
}

gboolean spore_compiler_add_body(SporeCompiler *compiler, SporeObject *body) {
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  SporeBodyDescription description = {
      .name = fields.name,
      .role = (SporeRole)fields.role,
      .integrator = SPORE_INTEGRATOR_DEFAULT,
      .pose = {spore_vec3_load(fields.position), spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation))},
      .velocity = spore_vec3_load(fields.velocity),
      .spin = spore_vec3_load(fields.spin)};
  SporeModelRecipe recipes[SPORE_LOD_COUNT] = {0};
  if (!add_collision(compiler, body, &description)) return FALSE;
  if (description.role == SPORE_PASSIVE && !make_model(compiler, body, &description, &recipes[SPORE_LOD_FINE]))
    return FALSE;
  description.effect = spore_fidelity_is_effect(compiler->document, body);
  gboolean added = add_own_spheres(compiler, body, &description) && add_levels(compiler, body, &description, recipes) &&
                   find_start(compiler, body, &description);
  g_ptr_array_add(compiler->objects, body);
  g_array_append_val(compiler->bodies, description);
  g_array_append_vals(compiler->recipes, recipes, SPORE_LOD_COUNT);
  return added;
}
