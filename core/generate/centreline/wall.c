/* The outer wall of a surface: inner walls are recognised by rays that do not reach the outside. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/private.h"

#define RAYS 24    /* per triangle and side */
#define RAY_STEP 7 /* their order: from steep to flat and again; coprime to RAYS */
#define HIDDEN 3   /* rays that reach the outside: with fewer a triangle is hidden */
#define OUTER 13   /* with this many a triangle is of the outer wall; at the mouth of a lumen half go out */
#define INNER_WALL                                                                                                     \
  0.1               /* hidden share of the surface above which there may be a lumen; a few loops that touch hide less */
#define ASTRAY 0.01 /* share of the surface seen from behind, above which triangles are turned */
#define INSIDE -1
#define REPORT_EACH 64

/* The i-th of `count` directions over the half space about n, evenly (Fibonacci's lattice). */
static SporeVec3 ray_of(SporeVec3 n, int i, int count) {
  SporeVec3 axis = fabs(n.x) < 0.6 ? spore_vec3(1, 0, 0) : spore_vec3(0, 1, 0);
  SporeVec3 u = spore_vec3_normalise(spore_vec3_cross(n, axis), axis), v = spore_vec3_cross(n, u);
  double height = (i + 0.5) / count, side = sqrt(1 - height * height), angle = 2 * M_PI * 0.6180339887498949 * i;
  SporeVec3 ray = spore_vec3_add_scaled(spore_vec3_scale(height, n), side * cos(angle), u);
  return spore_vec3_add_scaled(ray, side * sin(angle), v);
}

/* How many of the rays from p over the half space about n hit nothing; counts to OUTER. */
static int open_rays(const SporeBvh *bvh, SporeVec3 p, SporeVec3 n) {
  int open = 0;
  for (int i = 0; i < RAYS && open < OUTER; i++)
    open += !spore_bvh_ray(bvh, p, ray_of(n, RAY_STEP * i % RAYS, RAYS), NULL, NULL);
  return open;
}

/* The side from which most rays of a triangle reach the outside. */
typedef struct View {
  int open;    /* rays; INSIDE where the organ is on both sides */
  bool behind; /* seen from the side its normal points away from */
} View;

static View view_of(const SporeTriangleMesh *mesh, const SporeBvh *bvh, size_t t, double lift, double *area) {
  SporeVec3 corner[3];
  for (size_t k = 0; k < 3; k++) corner[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + k]);
  SporeVec3 across = spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
  SporeVec3 n = spore_vec3_normalise(across, spore_vec3(0, 0, 1));
  SporeVec3 middle = spore_vec3_scale(1. / 3, spore_vec3_add(corner[0], spore_vec3_add(corner[1], corner[2])));
  *area = 0.5 * spore_vec3_length(across);
  if (spore_bvh_inside(bvh, spore_vec3_add_scaled(middle, lift, n)) &&
      spore_bvh_inside(bvh, spore_vec3_add_scaled(middle, -lift, n)))
    return (View){INSIDE, false};
  int front = open_rays(bvh, spore_vec3_add_scaled(middle, lift, n), n);
  if (front >= OUTER) return (View){front, false};
  int back = open_rays(bvh, spore_vec3_add_scaled(middle, -lift, n), spore_vec3_scale(-1, n));
  return (View){back > front ? back : front, back > front};
}

/* The findings on the walls. Shares are of the area without walls that have the organ on both sides. */
typedef struct Walls {
  bool inside;   /* there are walls with the organ on both sides */
  double hidden; /* hidden share */
  double turned; /* share that is seen from the side its normals point away from */
} Walls;

static bool look(const SporeTriangleMesh *mesh, const SporeBvh *bvh, double lift, View *views, Walls *walls,
                 const SporeProgressPart *progress, SporeError *error) {
  double all = 0, unseen = 0, behind = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    double area;
    if (t % REPORT_EACH == 0 && !spore_progress_part(progress, (double)t / (double)mesh->triangle_count,
                                                     _("looking for the outer wall"), error))
      return false;
    views[t] = view_of(mesh, bvh, t, lift, &area);
    walls->inside = walls->inside || views[t].open == INSIDE;
    if (views[t].open == INSIDE) continue;
    all += area;
    unseen += views[t].open < HIDDEN ? area : 0;
    behind += views[t].open >= OUTER && views[t].behind ? area : 0;
  }
  if (all > 0) *walls = (Walls){walls->inside, unseen / all, behind / all};
  return true;
}

/* Keeps the triangles with at least `least` open rays, turned to the side from which they are seen. */
static bool keep(SporeTriangleMesh *kept, const SporeTriangleMesh *mesh, const View *views, int least,
                 SporeError *error) {
  size_t count = 0;
  if (!spore_triangle_mesh_copy(kept, mesh, error)) return false;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    if (views[t].open < least) continue;
    const uint32_t *corner = mesh->triangles + 3 * t;
    uint32_t *to = kept->triangles + 3 * count++;
    bool behind = views[t].open >= OUTER && views[t].behind;
    to[0] = corner[0], to[1] = corner[behind ? 2 : 1], to[2] = corner[behind ? 1 : 2];
  }
  kept->triangle_count = count;
  return true;
}

bool spore_outer_wall(const SporeTriangleMesh *mesh, const SporeBvh *bvh, SporeOuterWall *wall,
                      const SporeProgressPart *progress, SporeError *error) {
  SporeMeshReport report;
  Walls walls = {0};
  View *views = SPORE_NEW_ARRAY(View, mesh->triangle_count);
  *wall = (SporeOuterWall){0};
  bool done = views || spore_generate_no_memory(error);
  done = done && spore_triangle_mesh_report(mesh, &report, error) &&
         look(mesh, bvh, 1e-5 * report.diagonal, views, &walls, progress, error);
  if (done && (walls.inside || walls.turned > ASTRAY)) done = keep(&wall->solid, mesh, views, INSIDE + 1, error);
  if (done && walls.hidden > INNER_WALL) {
    wall->hidden = walls.hidden;
    done = keep(&wall->filled, mesh, views, OUTER, error);
  }
  if (!done) spore_outer_wall_clear(wall);
  spore_free(views);
  return done;
}

void spore_outer_wall_clear(SporeOuterWall *wall) {
  spore_triangle_mesh_clear(&wall->solid);
  spore_triangle_mesh_clear(&wall->filled);
  *wall = (SporeOuterWall){0};
}
