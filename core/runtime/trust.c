/* Checks a scene that was read from a file, before models and world are made from it. */
#include "core/runtime/trust.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/name.h"
#include "core/base/text.h"

#define UNIT 1e-3 /* an orientation is of unit length to this */

static bool refuse(SporeError *error, const char *what) {
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the file is damaged: %s; expected what `spore export --format runtime` writes; export the "
                           "scene again"),
                         what);
}

static bool is_unit(const double w[4]) {
  return fabs(sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3]) - 1) < UNIT;
}

/* Geometry. Arrays come before what looks into them. */

static bool trust_triangles(const SporeTriangleMesh *mesh, SporeError *error) {
  if (!mesh->vertices || !mesh->triangles) return refuse(error, _("a surface lacks its vertices or triangles"));
  return spore_triangle_mesh_validate(mesh, error);
}

static bool trust_tetrahedra(const SporeTetrahedralMesh *mesh, SporeError *error) {
  if (!mesh->vertices || !mesh->tetrahedra) return refuse(error, _("a solid lacks its vertices or tetrahedra"));
  return spore_tetrahedral_mesh_validate(mesh, error);
}

static bool trust_curve(const SporeCurve *curve, SporeError *error) {
  return curve->points ? spore_curve_validate(curve, error) : refuse(error, _("a curve lacks its points"));
}

static bool trust_spheres(const SporeSphereSet *set, SporeError *error) {
  return set->spheres ? spore_sphere_set_validate(set, error) : refuse(error, _("a sphere set lacks its spheres"));
}

static bool trust_regions(const SporeRegions *regions, SporeError *error) {
  if (regions->count > 0 && !regions->regions) return refuse(error, _("regions are missing"));
  for (size_t i = 0; i < regions->count; i++) {
    const SporeRegion *region = &regions->regions[i];
    if (region->ball_count > 0 && !region->balls) return refuse(error, _("the balls of a region are missing"));
    if (!(region->stiffness > 0 && region->density > 0)) return refuse(error, _("a region's factors are not above 0"));
  }
  return true;
}

/* The geometry that models of the type are built from is there, and no other. */
static bool has_geometry(const SporeModelRecipe *recipe) {
  const SporeGeometry *geometry = &recipe->geometry;
  const SporeGeometryKind kind = recipe->type->geometry;
  bool surface = kind == SPORE_GEOMETRY_SURFACE || kind == SPORE_GEOMETRY_SOLID;
  return surface == (geometry->surface != NULL) &&
         (kind == SPORE_GEOMETRY_TETRAHEDRA) == (geometry->tetrahedra != NULL) &&
         (kind == SPORE_GEOMETRY_CURVE) == (geometry->curve != NULL) && (surface || !geometry->corners) &&
         (recipe->type->root || !geometry->root) &&
         (recipe->type->regions || !geometry->regions || geometry->regions->count == 0);
}

static bool trust_recipe(const SporeModelRecipe *recipe, SporeError *error) {
  const SporeGeometry *geometry = &recipe->geometry;
  SporeMeshReport report;
  if (!recipe->type) return true;
  if (!has_geometry(recipe)) return refuse(error, _("a model has other geometry than its kind takes"));
  return (!geometry->surface || trust_triangles(geometry->surface, error)) &&
         (recipe->type->geometry != SPORE_GEOMETRY_SOLID ||
          spore_triangle_mesh_report_solid(geometry->surface, &report, error)) &&
         (!geometry->tetrahedra || trust_tetrahedra(geometry->tetrahedra, error)) &&
         (!geometry->curve || trust_curve(geometry->curve, error)) &&
         (!geometry->root || trust_curve(geometry->root, error)) &&
         (!geometry->regions || trust_regions(geometry->regions, error));
}

/* Bodies, links and visuals. */

/* Whether another body before this one has its name. Scenes have tens of bodies. */
static bool name_is_taken(const SporeWorldDescription *world, size_t body) {
  for (size_t i = 0; i < body; i++)
    if (strcmp(world->bodies[i].name, world->bodies[body].name) == 0) return true;
  return false;
}

static bool trust_body(const SporeRuntimeScene *scene, size_t i, SporeError *error) {
  const SporeBodyDescription *body = &scene->world.bodies[i];
  const SporeModelRecipe *recipes = &scene->recipes[SPORE_LOD_COUNT * i];
  if (!body->name || !spore_name_is_valid(body->name) || name_is_taken(&scene->world, i))
    return refuse(error, _("a body has no name of its own"));
  const SporeQuat o = body->pose.orientation;
  if (!is_unit((const double[4]){o.w, o.x, o.y, o.z})) return refuse(error, _("an orientation is not of unit length"));
  if ((body->role == SPORE_PASSIVE) != (recipes[SPORE_LOD_FINE].type != NULL))
    return refuse(error, _("a body's role does not fit its model"));
  for (int level = 0; level < SPORE_LOD_COUNT; level++) {
    if (recipes[level].type && recipes[level].type != recipes[SPORE_LOD_FINE].type)
      return refuse(error, _("a level of detail is of another kind than its body"));
    if (!trust_recipe(&recipes[level], error)) return false;
  }
  const SporeLodDescription *lod = &body->lod;
  if (!(lod->tolerance >= 0 && lod->rule.tool_distance >= 0 && lod->rule.view_distance >= 0 && lod->rule.wait_s >= 0))
    return refuse(error, _("a level's rule has a negative number"));
  bool levels =
      recipes[SPORE_LOD_COARSE].type || recipes[SPORE_LOD_MEDIUM].type; /* else there is nothing to begin at */
  if (levels && !recipes[lod->first].type) return refuse(error, _("a body begins at a level that it does not have"));
  if (lod->surface_count > 0 && !lod->surface) return refuse(error, _("a level's surface is missing"));
  if ((body->start_count > 0) != (body->start != NULL)) return refuse(error, _("a body's beginning is missing"));
  return !body->spheres || trust_spheres(body->spheres, error);
}

/* The numbers that a link of this kind reads, by its parameters. */
static bool trust_link(const SporeLinkDescription *link, SporeError *error) {
  if (!link->type || !link->name || link->body_a == SPORE_NO_BODY)
    return refuse(error, _("a link lacks its name, kind or body"));
  const SporeParameterTable *table = &link->type->parameters;
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (parameter->type >= SPORE_TEXT) continue;
    const SporeValue value = spore_parameter_load(parameter, link);
    if (!spore_parameter_check(parameter, &value, error)) return false;
  }
  return true;
}

static bool trust_visual(const SporeRuntimeVisual *visual, SporeError *error) {
  if (visual->body == SPORE_NO_BODY || !visual->mesh) return refuse(error, _("a visual mesh or its body is missing"));
  return trust_triangles(visual->mesh, error);
}

static bool trust_world(const SporeRuntimeScene *scene, SporeError *error) {
  const SporeWorldDescription *world = &scene->world;
  if ((world->body_count && !(world->bodies && scene->recipes)) || (world->link_count && !world->links) ||
      (world->tool_count && !world->tools) || (world->emitter_count && !world->emitters) ||
      (world->eye_count && !world->eyes) || (scene->visual_count && !scene->visuals))
    return refuse(error, _("what is counted is missing"));
  for (size_t i = 0; i < world->body_count; i++)
    if (!trust_body(scene, i, error)) return false;
  for (size_t i = 0; i < world->link_count; i++)
    if (!trust_link(&world->links[i], error)) return false;
  for (size_t i = 0; i < world->tool_count; i++)
    if (!world->tools[i].type || !((const SporeToolFields *)world->tools[i].fields)->name)
      return refuse(error, _("a tool lacks its name or kind"));
  for (size_t i = 0; i < world->emitter_count; i++)
    if (!world->emitters[i].name || world->emitters[i].body == SPORE_NO_BODY)
      return refuse(error, _("an emitter lacks its name or body"));
  for (size_t i = 0; i < scene->visual_count; i++)
    if (!trust_visual(&scene->visuals[i], error)) return false;
  return true;
}

/* Recorded input. */

static bool drives(const SporeWorldDescription *world, const char *name) {
  for (size_t i = 0; i < world->body_count; i++)
    if (strcmp(world->bodies[i].name, name) == 0) return world->bodies[i].role == SPORE_ACTIVE;
  return false;
}

static bool trust_track(const SporeRuntimeScene *scene, SporeError *error) {
  const SporeTrack *track = &scene->track;
  if (track->channel_count && !track->channels) return refuse(error, _("recorded input is missing"));
  for (size_t i = 0; i < track->channel_count; i++) {
    const SporeTrackChannel *channel = &track->channels[i];
    if (!channel->name || !drives(&scene->world, channel->name))
      return refuse(error, _("recorded input moves what is no active body"));
    if (channel->count && !(channel->time_s && channel->states))
      return refuse(error, _("the samples of recorded input are missing"));
    for (size_t k = 0; k < channel->count; k++) {
      if (!(channel->time_s[k] >= 0 && (k == 0 || channel->time_s[k] > channel->time_s[k - 1])))
        return refuse(error, _("the times of recorded input are out of order"));
      if (!is_unit(channel->states[k].orientation)) return refuse(error, _("an orientation is not of unit length"));
    }
  }
  return true;
}

/* The exercise. */

static bool is_part(uint32_t index, size_t count) { return index == SPORE_NO_PART || index < count; }

static bool has_parameter(const SporeParameterTable *table, const char *name) {
  return spore_parameter_find(table, name) >= 0;
}

static bool trust_instruments(const SporeExerciseDescription *exercise, const SporeWorldDescription *world,
                              SporeError *error) {
  for (size_t i = 0; i < exercise->instrument_count; i++)
    if (exercise->instruments[i].bodies[0] == SPORE_NO_BODY ||
        !is_part(exercise->instruments[i].tool, world->tool_count))
      return refuse(error, _("an instrument of the exercise lacks its body or tool"));
  return true;
}

/* A step without a body needs an instrument, unless it is about a body alone. */
static bool trust_step(const SporeExerciseDescription *exercise, size_t i, SporeError *error) {
  const SporeExerciseStep *step = &exercise->steps[i];
  if (!step->kind || !step->fields.name || !spore_name_is_valid(step->fields.name))
    return refuse(error, _("a step lacks its name or kind"));
  if (!is_part(step->instrument, exercise->instrument_count) || !is_part(step->after, exercise->step_count))
    return refuse(error, _("a step names an instrument or a step that is not there"));
  bool lacks = step->body == SPORE_NO_BODY && (step->kind->needs_body || step->instrument == SPORE_NO_PART);
  if (lacks || has_parameter(&step->kind->parameters, "container") != (step->container != SPORE_NO_BODY))
    return refuse(error, _("a step lacks its body, instrument or container"));
  return true;
}

/* NULL: the body has no model. */
static const SporeModelType *model_type(const SporeRuntimeScene *scene, uint32_t body) {
  return scene->recipes[SPORE_LOD_COUNT * (size_t)body + SPORE_LOD_FINE].type;
}

static bool is_fluid(const SporeRuntimeScene *scene, uint32_t body) {
  const SporeModelType *type = model_type(scene, body);
  return type && type->particles;
}

static bool knows_strain(const SporeRuntimeScene *scene, uint32_t body) {
  const SporeModelType *type = model_type(scene, body);
  return type && type->strain;
}

static bool trust_metric(const SporeRuntimeScene *scene, const SporeExerciseMetric *metric, SporeError *error) {
  const SporeExerciseDescription *exercise = &scene->exercise;
  if (!metric->kind || !metric->fields.name || !spore_name_is_valid(metric->fields.name))
    return refuse(error, _("a metric lacks its name or kind"));
  if (!is_part(metric->instrument, exercise->instrument_count) || !is_part(metric->view, exercise->view_count))
    return refuse(error, _("a metric names an instrument or a camera that is not there"));
  if ((metric->kind->needs_body && metric->body == SPORE_NO_BODY) ||
      (metric->kind->needs_view && metric->view == SPORE_NO_PART) ||
      (metric->kind->needs_fluid && !is_fluid(scene, metric->body)) ||
      (metric->kind->needs_strain && !knows_strain(scene, metric->body)))
    return refuse(error, _("a metric lacks its body, fluid, tissue or camera"));
  return true;
}

static bool trust_exercise(const SporeRuntimeScene *scene, SporeError *error) {
  const SporeExerciseDescription *exercise = &scene->exercise;
  if ((exercise->instrument_count && !exercise->instruments) || (exercise->view_count && !exercise->views) ||
      (exercise->step_count && !exercise->steps) || (exercise->metric_count && !exercise->metrics))
    return refuse(error, _("parts of the exercise are missing"));
  bool sound = trust_instruments(exercise, &scene->world, error);
  for (size_t i = 0; sound && i < exercise->step_count; i++) sound = trust_step(exercise, i, error);
  for (size_t i = 0; sound && i < exercise->metric_count; i++)
    sound = trust_metric(scene, &exercise->metrics[i], error);
  return sound;
}

bool spore_runtime_trust(const SporeRuntimeScene *scene, SporeError *error) {
  return trust_world(scene, error) && trust_track(scene, error) && trust_exercise(scene, error);
}
