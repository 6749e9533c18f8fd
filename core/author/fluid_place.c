/* Finds room on and over the surfaces of organs. */
#include "core/author/fluid_place.h"

#include <math.h>

#include "core/author/edits.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"

#define LOOKS_UP 0.3 /* cosine: a surface that leans no more than this carries what lies on it */
#define FARTHEST 4   /* radii of a ball: how far over its place it is looked for */
#define TRIES 64     /* of the middle of a ball */
#define STEP 0.05    /* m/m: the least way from one try to the next, as a part of the radius */

/* Bodies. */

static gboolean is_active(const SporeObject *body) {
  return (SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE;
}

static const SporeTriangleMesh *shown_mesh(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
  return asset ? spore_document_mesh(document, asset, NULL) : NULL;
}

static const SporeSphereSet *felt_spheres(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_used_asset(document, body, "collision", "spheres", "spheres");
  return asset ? spore_document_spheres(document, asset, NULL) : NULL;
}

/* The nearest place, if it is nearer than *least. */
static void look_at(SporeDocument *document, SporeObject *body, SporeVec3 point, double *least,
                    SporeSurfacePlace *place) {
  const SporeTriangleMesh *mesh = shown_mesh(document, body);
  SporeBvh *bvh = mesh ? spore_bvh_create(mesh, NULL) : NULL;
  SporePose pose = spore_body_pose(body);
  SporeVec3 nearest;
  guint32 triangle;
  double distance =
      bvh ? spore_bvh_distance(bvh, spore_pose_apply_inverse(pose, point), &nearest, &triangle) : HUGE_VAL;
  if (distance < *least) {
    const guint32 *corners = mesh->triangles + 3 * (gsize)triangle;
    SporeVec3 normal = spore_mesh_area_vector(spore_mesh_vertex(mesh->vertices, corners[0]),
                                              spore_mesh_vertex(mesh->vertices, corners[1]),
                                              spore_mesh_vertex(mesh->vertices, corners[2]));
    normal = spore_vec3_normalise(normal, (SporeVec3){0, 1, 0});
    *least = distance;
    *place = (SporeSurfacePlace){body, spore_pose_apply(pose, nearest), spore_quat_rotate(pose.orientation, normal),
                                 spore_mesh_diagonal(mesh->vertices, mesh->vertex_count, 3)};
  }
  spore_bvh_free(bvh);
}

gboolean spore_surface_nearest(SporeDocument *document, SporeObject *body, SporeVec3 point, SporeSurfacePlace *place) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  double least = HUGE_VAL;
  if (body) look_at(document, body, point, &least, place);
  for (guint i = 0; !body && i < spore_object_child_count(bodies); i++)
    if (!is_active(spore_object_child(bodies, i)))
      look_at(document, spore_object_child(bodies, i), point, &least, place);
  return isfinite(least);
}

/* How far the ball at `centre`, world, has to go away from the body's spheres, m; below 0: it is clear of them. */
static double within_spheres(SporeDocument *document, SporeObject *body, SporeVec3 centre, double radius) {
  const SporeSphereSet *set = felt_spheres(document, body);
  SporeVec3 at = spore_pose_apply_inverse(spore_body_pose(body), centre);
  double deepest = -HUGE_VAL;
  for (gsize i = 0; set && i < set->count; i++)
    deepest = fmax(deepest,
                   set->spheres[4 * i + 3] + radius - spore_vec3_distance(spore_vec3_load(set->spheres + 4 * i), at));
  return deepest;
}

double spore_surface_clear(SporeDocument *document, const SporeSurfacePlace *place, double radius) {
  double way = radius;
  for (int i = 0; i < TRIES; i++) {
    double deep = within_spheres(document, place->body, spore_vec3_add_scaled(place->at, way, place->outward), radius);
    if (deep <= 0) break;
    way += fmax(deep, STEP * radius);
  }
  return way;
}

/* Obstacles. */

typedef struct Obstacle {
  SporeObject *body;
  SporePose pose;
  SporeBvh *surface; /* NULL: it shows none */
  gboolean around;   /* it is closed, and the place is inside of it: a cavity */
} Obstacle;

static void clear_obstacle(gpointer obstacle) { spore_bvh_free(((Obstacle *)obstacle)->surface); }

static gboolean is_inside(const Obstacle *obstacle, SporeVec3 at) {
  return spore_bvh_inside(obstacle->surface, spore_pose_apply_inverse(obstacle->pose, at));
}

/* beside: a point just outside of the surface that the ball is put on. */
static GArray *find_obstacles(SporeDocument *document, SporeVec3 beside) {
  GArray *obstacles = g_array_new(FALSE, FALSE, sizeof(Obstacle));
  const SporeObject *bodies = spore_document_section(document, "bodies");
  g_array_set_clear_func(obstacles, clear_obstacle);
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    const SporeTriangleMesh *mesh = shown_mesh(document, body);
    Obstacle obstacle = {body, spore_body_pose(body), mesh ? spore_bvh_create(mesh, NULL) : NULL, FALSE};
    if (obstacle.surface) obstacle.around = is_inside(&obstacle, beside);
    g_array_append_val(obstacles, obstacle);
  }
  return obstacles;
}

/* How far the ball reaches into what is nearest, m; below 0: it is clear of everything. */
static double reaches_into(SporeDocument *document, const GArray *obstacles, SporeVec3 centre, double radius) {
  double deepest = -HUGE_VAL;
  for (guint i = 0; i < obstacles->len; i++) {
    const Obstacle *obstacle = &g_array_index(obstacles, Obstacle, i);
    SporeVec3 at = spore_pose_apply_inverse(obstacle->pose, centre);
    deepest = fmax(deepest, within_spheres(document, obstacle->body, centre, radius));
    if (!obstacle->surface) continue;
    deepest = fmax(deepest, radius - spore_bvh_distance(obstacle->surface, at, NULL, NULL));
    if (is_inside(obstacle, centre) != obstacle->around) deepest = fmax(deepest, STEP * radius);
  }
  return deepest;
}

static SporeVec3 way_out(const SporeDocument *document, const SporeSurfacePlace *place) {
  SporeEnvironmentFields fields;
  spore_object_fields(spore_document_section(document, "environment"), &fields);
  SporeVec3 up = spore_vec3_normalise(spore_vec3_scale(-1, spore_vec3_load(fields.gravity)), place->outward);
  return spore_vec3_dot(up, place->outward) > LOOKS_UP ? up : place->outward;
}

gboolean spore_surface_room(SporeDocument *document, const SporeSurfacePlace *place, double radius, SporeVec3 *middle) {
  SporeVec3 beside = spore_vec3_add_scaled(place->at, STEP * radius, place->outward);
  g_autoptr(GArray) obstacles = find_obstacles(document, beside);
  SporeVec3 out = way_out(document, place);
  double way = radius, deep = HUGE_VAL;
  for (int i = 0; i < TRIES && way <= FARTHEST * radius && deep > 0; i++) {
    *middle = spore_vec3_add_scaled(place->at, way, out);
    deep = reaches_into(document, obstacles, *middle, radius);
    way += fmax(deep, STEP * radius);
  }
  return deep <= 0;
}
