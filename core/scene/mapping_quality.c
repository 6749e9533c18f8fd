/* Measures how well drawn vertices and collision spheres follow the geometry that moves them. */
#include "core/scene/mapping_quality.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/body_shape.h"

#define ON 1e-6 /* of the size: numbers in files are rounded */

const char *const spore_mapped_unit_names[] = {"visual", "collision", NULL};

/* Points of a unit; radius 0 of vertices. */
typedef struct Points {
  const double *first;
  gsize count, stride;
  const SporeTriangleMesh *mesh; /* the drawn mesh; NULL: the points are spheres */
} Points;

static SporeVec3 point(const Points *points, gsize i) { return spore_vec3_load(points->first + points->stride * i); }

static gboolean find_points(SporeDocument *document, const SporeObject *body, SporeMappedUnit unit, Points *points) {
  static const char *const properties[] = {"mesh", "spheres"};
  const SporeObject *object = spore_object_child_of(body, spore_mapped_unit_names[unit]);
  SporeObject *asset = object ? spore_object_reference(object, properties[unit]) : NULL;
  if (asset && unit == SPORE_MAPPED_VISUAL) {
    const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, NULL);
    if (mesh) *points = (Points){mesh->vertices, mesh->vertex_count, 3, mesh};
  } else if (asset) {
    const SporeSphereSet *set = spore_document_spheres(document, asset, NULL);
    if (set) *points = (Points){set->spheres, set->count, 4, NULL};
  }
  return points->count > 0;
}

/* How far p lies off: of an open surface on either side. */
static double off_shape(const SporeShape *shape, SporeVec3 p) {
  if (shape->kind == SPORE_GEOMETRY_SURFACE) return spore_bvh_distance(shape->surface, p, NULL, NULL);
  return spore_shape_outside(shape, p, NULL);
}

static void measure_places(const SporeShape *shape, const Points *points, SporeMappingQuality *quality) {
  quality->size = shape->size;
  for (gsize i = 0; i < points->count; i++) {
    double off = off_shape(shape, point(points, i)), radius = points->stride > 3 ? points->first[4 * i + 3] : 0;
    quality->off += off > ON * shape->size;
    quality->apart += radius > 0 && off > radius;
    if (off <= quality->farthest) continue;
    quality->farthest = off;
    quality->place = point(points, i);
  }
}

static gboolean measure_motion(const SporeModel *model, const Points *points, SporeMappingQuality *quality,
                               GError **error) {
  g_autofree double *places = g_new(double, 3 * points->count);
  SporeError fault = SPORE_ERROR_INIT;
  SporeMapping mapping = {0};
  quality->framed = points->mesh && model->type->line && model->type->line->map_drawn;
  for (gsize i = 0; i < points->count; i++) spore_vec3_store(places + 3 * i, point(points, i));
  gboolean done = (quality->framed ? model->type->line->map_drawn(model, points->mesh, &mapping, &fault)
                                   : model->type->map(model, places, points->count, NULL, &mapping, &fault)) &&
                  spore_mapping_measure(model, &mapping, places, &quality->error, &fault);
  if (done && quality->framed) quality->crowd_place = point(points, quality->error.crowd_point);
  spore_mapping_clear(&mapping);
  return done || spore_error_propagate(&fault, error);
}

gboolean spore_mapping_quality_measure(const SporeSimulation *simulation, SporeDocument *document, SporeObject *body,
                                       SporeMappedUnit unit, SporeMappingQuality *quality, GError **error) {
  Points points = {0};
  SporeShape shape = {0};
  guint32 index = spore_simulation_body_of(simulation, body);
  *quality = (SporeMappingQuality){0};
  if (index == SPORE_NO_BODY || spore_world_body_role(simulation->world, index) != SPORE_PASSIVE) return FALSE;
  const SporeModel *model = spore_world_body_model(simulation->world, index);
  if (model->type->particles || !find_points(document, body, unit, &points)) return FALSE;
  quality->count = points.count;
  if (!measure_motion(model, &points, quality, error)) return FALSE;
  if (spore_shape_of_geometry(document, body, model->type->geometry, &shape)) measure_places(&shape, &points, quality);
  spore_shape_clear(&shape);
  return TRUE;
}
