/* Distance of points from the meshes, the curve and the spheres of a body. */
#include "core/scene/body_shape.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/mesh/common.h"
#include "core/scene/schema_fields.h"

/* Mean length of the triangles' edges, each taken once a triangle. */
static double mean_edge(const SporeTriangleMesh *mesh) {
  double sum = 0;
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++) {
    uint32_t from = mesh->triangles[i], to = mesh->triangles[i % 3 < 2 ? i + 1 : i - 2];
    sum += spore_vec3_distance(spore_mesh_vertex(mesh->vertices, from), spore_mesh_vertex(mesh->vertices, to));
  }
  return mesh->triangle_count > 0 ? sum / (3 * (double)mesh->triangle_count) : 0;
}

static gboolean take_surface(SporeShape *shape, const SporeTriangleMesh *mesh) {
  shape->surface = mesh && mesh->triangle_count > 0 ? spore_bvh_create(mesh, NULL) : NULL;
  if (!shape->surface) return FALSE;
  shape->size = spore_mesh_diagonal(mesh->vertices, mesh->vertex_count, 3);
  shape->edge = mean_edge(mesh);
  return TRUE;
}

static gboolean take_boundary(SporeShape *shape, const SporeTetrahedralMesh *cells) {
  if (!cells) return FALSE;
  SporeTriangleMesh boundary = {cells->vertex_count, 0, cells->vertices, NULL};
  gboolean taken = spore_tetrahedral_mesh_boundary(cells, &boundary.triangles, &boundary.triangle_count) &&
                   take_surface(shape, &boundary);
  spore_free(boundary.triangles);
  return taken;
}

static gboolean take_curve(SporeShape *shape, const SporeCurve *curve) {
  double length = 0;
  if (!curve || curve->count < 2) return FALSE;
  for (gsize i = 1; i < curve->count; i++)
    length += spore_vec3_distance(spore_vec3_load(curve->points + 4 * i), spore_vec3_load(curve->points + 4 * i - 4));
  shape->curve = curve;
  shape->size = spore_mesh_diagonal(curve->points, curve->count, 4);
  shape->edge = length / (double)(curve->count - 1);
  return TRUE;
}

gboolean spore_shape_of_geometry(SporeDocument *document, const SporeObject *body, SporeGeometryKind kind,
                                 SporeShape *shape) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  SporeObject *asset = mechanical ? spore_object_reference(mechanical, "geometry") : NULL;
  *shape = (SporeShape){.kind = kind};
  if (!asset || kind == SPORE_GEOMETRY_NONE) return FALSE;
  if (kind == SPORE_GEOMETRY_TETRAHEDRA) return take_boundary(shape, spore_document_tetrahedra(document, asset, NULL));
  if (kind == SPORE_GEOMETRY_CURVE) return take_curve(shape, spore_document_curve(document, asset, NULL));
  return take_surface(shape, spore_document_mesh(document, asset, NULL));
}

static gboolean shape_of_drawn(SporeDocument *document, const SporeObject *body, SporeShape *shape) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = visual ? spore_object_reference(visual, "mesh") : NULL;
  *shape = (SporeShape){.kind = SPORE_GEOMETRY_SURFACE};
  return asset && take_surface(shape, spore_document_mesh(document, asset, NULL));
}

void spore_shape_clear(SporeShape *shape) {
  spore_bvh_free(shape->surface);
  *shape = (SporeShape){0};
}

/* Outside the tube around a curve. axis: gets the point on the curve from which that is measured. */
static double outside_curve(const SporeCurve *curve, SporeVec3 p, SporeVec3 *nearest, SporeVec3 *axis) {
  double least = INFINITY;
  for (gsize i = 1; i < curve->count; i++) {
    const double *from = curve->points + 4 * (i - 1), *to = from + 4;
    SporeVec3 a = spore_vec3_load(from), side = spore_vec3_sub(spore_vec3_load(to), a);
    double along = spore_vec3_dot(spore_vec3_sub(p, a), side) / spore_vec3_dot(side, side);
    along = fmin(fmax(along, 0), 1);
    double radius = from[3] + along * (to[3] - from[3]);
    SporeVec3 middle = spore_vec3_add_scaled(a, along, side);
    double distance = spore_vec3_distance(p, middle);
    if (distance - radius >= least) continue;
    least = distance - radius;
    *axis = middle;
    if (nearest && least > 0) *nearest = spore_vec3_add_scaled(middle, radius / distance, spore_vec3_sub(p, middle));
  }
  if (nearest && least <= 0) *nearest = p;
  return fmax(least, 0);
}

double spore_shape_outside(const SporeShape *shape, SporeVec3 p, SporeVec3 *nearest) {
  SporeVec3 axis;
  if (shape->curve) return outside_curve(shape->curve, p, nearest, &axis);
  double outside = fmax(-spore_bvh_depth(shape->surface, p), 0);
  if (!nearest) return outside;
  *nearest = p;
  if (outside > 0) spore_bvh_distance(shape->surface, p, nearest, NULL);
  return outside;
}

/* Keeps what has the point within its bounds, or is nearest to them. */
static void take_nearer(SporeBodyPlace *place, const SporeBodyPlace *other) {
  if (other->outside - other->allowed < place->outside - place->allowed) *place = *other;
}

/* Whether the body can carry the point: a straight line carries none beside it, a net none deep inside. */
static bool carries(const SporeWorld *world, guint32 body, SporeVec3 at) {
  double point[3];
  SporeMapping mapping = {0};
  spore_vec3_store(point, spore_pose_apply_inverse(spore_world_start_pose(world, body), at));
  bool carried = spore_world_map(world, body, point, 1, &mapping, NULL);
  spore_mapping_clear(&mapping);
  return carried;
}

/* A point that a body of this shape carries, near p: on the surface, or on the line itself. */
static SporeVec3 anchor(const SporeShape *shape, SporeVec3 p) {
  SporeVec3 place = p;
  if (shape->curve) outside_curve(shape->curve, p, NULL, &place);
  else spore_bvh_distance(shape->surface, p, &place, NULL);
  return place;
}

static void look_at_shape(SporeShape *shape, const SporeWorld *world, guint32 body, SporeVec3 at,
                          SporeBodyPlace *place) {
  SporePose pose = spore_world_start_pose(world, body);
  SporeVec3 p = spore_pose_apply_inverse(pose, at);
  SporeBodyPlace found = {.allowed = shape->edge};
  found.outside = spore_shape_outside(shape, p, &found.nearest);
  found.nearest = spore_pose_apply(pose, found.nearest);
  if (!carries(world, body, found.nearest)) found.nearest = spore_pose_apply(pose, anchor(shape, p));
  take_nearer(place, &found);
  spore_shape_clear(shape);
}

static void look_at_spheres(const SporeWorld *world, guint32 body, SporeVec3 at, SporeBodyPlace *place) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  SporeBodyPlace found = {.outside = INFINITY};
  double sum = 0, count = 0;
  for (gsize i = 0; i < spheres->count; i++) {
    if (spheres->body[i] != body) continue;
    SporeVec3 centre = spore_vec3_load(spheres->centre + 3 * i);
    double distance = spore_vec3_distance(at, centre), outside = fmax(distance - spheres->radius[i], 0);
    sum += spheres->radius[i];
    count++;
    if (outside >= found.outside) continue;
    found.outside = outside;
    found.nearest =
        outside > 0 ? spore_vec3_add_scaled(centre, spheres->radius[i] / distance, spore_vec3_sub(at, centre)) : at;
  }
  if (count == 0) return;
  found.allowed = sum / count;
  take_nearer(place, &found);
}

gboolean spore_body_find_place(const SporeSimulation *simulation, SporeDocument *document, guint32 body, SporeVec3 at,
                               SporeBodyPlace *place) {
  const SporeWorld *world = simulation->world;
  const SporeObject *object = spore_document_by_id(document, simulation->body_object[body]);
  const SporeModel *model = spore_world_body_model(world, body);
  SporeShape shape;
  *place = (SporeBodyPlace){.outside = INFINITY};
  if (model && spore_shape_of_geometry(document, object, model->type->geometry, &shape))
    look_at_shape(&shape, world, body, at, place);
  if (shape_of_drawn(document, object, &shape)) look_at_shape(&shape, world, body, at, place);
  if (!(place->outside < INFINITY)) look_at_spheres(world, body, at, place);
  place->carried = carries(world, body, at);
  return place->outside < INFINITY;
}
