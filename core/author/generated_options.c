#include "core/author/generated_options.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"

SporeObject *spore_edit_generator_source(SporeDocument *document, SporeObject *body, SporeObject *target,
                                         GError **error) {
  SporeObject *shown = spore_edit_visual_mesh(document, body, NULL);
  if (shown && shown != target) return shown;
  const char *source = target ? spore_object_text(target, "source") : NULL;
  SporeObject *mesh = source ? spore_document_find(document, "mesh", source) : NULL;
  return mesh ? mesh : spore_edit_visual_mesh(document, body, error);
}

const char *spore_region_element(const SporeObjectType *holder) {
  for (guint i = 0; i < holder->children->len; i++) {
    const SporeObjectType *child = g_ptr_array_index(holder->children, i);
    if (spore_parameter_find(child->table, "centre") >= 0 && spore_parameter_find(child->table, "radius") >= 0)
      return child->element;
  }
  return NULL;
}

/* The last of a region's own parameters is what shall be there. */
static void read_region(const SporeObject *object, SporeGenerateRegion *region) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  const SporeValue *centre = spore_object_value(object, (guint)spore_parameter_find(table, "centre"));
  memcpy(region->centre, centre->number, sizeof region->centre);
  region->radius = spore_object_number(object, "radius");
  region->value = spore_object_value(object, (guint)table->count - 1)->number[0];
}

gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error) {
  *count = 0;
  for (guint i = 0; asset && i < spore_object_child_count(asset); i++) {
    if (*count == SPORE_GENERATE_REGIONS)
      return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(asset),
                               _("it has more than %d regions; a generator takes no more; delete some"),
                               SPORE_GENERATE_REGIONS);
    read_region(spore_object_child(asset, i), &regions[(*count)++]);
  }
  return TRUE;
}

/* Spheres from tetrahedra are those of their surface, balanced. */
static SporeSpheresMode mode_named(const char *name) {
  for (int i = 0; i < SPORE_SPHERES_MODE_COUNT; i++)
    if (g_strcmp0(name, spore_spheres_mode_names[i]) == 0) return (SporeSpheresMode)i;
  return SPORE_SPHERES_BALANCED;
}

int spore_edit_spheres_method(SporeSpheresMode mode) {
  int method = 0;
  while (strcmp(spore_sphere_methods[method], spore_spheres_mode_names[mode]) != 0) method++;
  return method;
}

SporeSpheresOptions spore_edit_spheres_options(const SporeSpheresFields *fields, const SporeGenerateRegion *regions,
                                               gsize count) {
  const SporeSpheresAims aims = {fields->coverage, fields->outside, fields->tolerance, fields->depth_error};
  return (SporeSpheresOptions){
      .mode = mode_named(spore_sphere_methods[fields->method]),
      .count = spore_spheres_hardest_aim(&aims, &(SporeSpheresReport){0}, NULL) ? 0 : (size_t)fields->count,
      .aims = aims,
      .seed = (uint64_t)fields->seed,
      .regions = regions,
      .region_count = count};
}

SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count) {
  return (SporeTetrahedraOptions){.method = fields->method ? (SporeTetrahedraMethod)(fields->method - 1)
                                                           : SPORE_TETRAHEDRA_METHODS,
                                  .cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                  .size = fields->size,
                                  .tolerance = fields->tolerance,
                                  .curvature = fields->curvature,
                                  .fill = fields->fill,
                                  .gap = fields->gap,
                                  .regions = regions,
                                  .region_count = count};
}

SporeCentrelineOptions spore_edit_centreline_options(const SporeCurveFields *fields) {
  SporeCentrelineOptions options = {.points = (size_t)fields->points, .tolerance = fields->tolerance};
  memcpy(options.ends[0], fields->first_place, sizeof options.ends[0]);
  memcpy(options.ends[1], fields->last_place, sizeof options.ends[1]);
  options.ends_given = memcmp(options.ends[0], options.ends[1], sizeof options.ends[0]) != 0;
  return options;
}

SporeSimplifyOptions spore_edit_surface_options(const SporeMeshFields *fields) {
  return (SporeSimplifyOptions){(size_t)fields->nodes, fields->nodes ? 0 : fields->size,
                                fields->keep_angle * G_PI / 180};
}
