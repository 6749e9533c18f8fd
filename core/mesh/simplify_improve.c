/* Flips edges and moves points so that the narrowest angles get wider. */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/simplify.h"
#include "core/mesh/simplify_parts.h"

#define ROUNDS 8
#define PART 0.5     /* share of the way to the centre of its neighbours that a point moves at once */
#define FAR 2        /* largest distance from the surface after a change, relative to the typical distance before */
#define BETTER 1.001 /* a flipped edge must widen the least angle by this factor */
#define GOOD 0.5     /* least quality after a point has moved, unless the quality was lower before */

static double least_angle(SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  SporeVec3 p[3] = {a, b, c};
  double least = HUGE_VAL;
  for (int k = 0; k < 3; k++) {
    SporeVec3 one = spore_vec3_sub(p[(k + 1) % 3], p[k]), other = spore_vec3_sub(p[(k + 2) % 3], p[k]);
    least = fmin(least, atan2(spore_vec3_length(spore_vec3_cross(one, other)), spore_vec3_dot(one, other)));
  }
  return least;
}

void spore_triangle_mesh_angles(const SporeTriangleMesh *mesh, double *least, double *mean) {
  *least = 180, *mean = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    double angle = least_angle(spore_mesh_vertex(mesh->vertices, n[0]), spore_mesh_vertex(mesh->vertices, n[1]),
                               spore_mesh_vertex(mesh->vertices, n[2])) *
                   180 / M_PI;
    *least = fmin(*least, angle);
    *mean += angle / (double)mesh->triangle_count;
  }
}

/* Flipping edges. */

/* Whether the triangles (a, b, c), (b, a, d) lie so flat that (c, d, b), (d, c, a) are as good a surface. */
static bool is_flat(SporeVec3 a, SporeVec3 b, SporeVec3 c, SporeVec3 d, double far) {
  SporeVec3 ab = spore_vec3_sub(b, a), cd = spore_vec3_sub(d, c), across = spore_vec3_cross(ab, cd);
  double apart = fabs(spore_vec3_dot(spore_vec3_sub(c, a), across)) / spore_vec3_length(across);
  if (!(apart <= far)) return false;
  SporeVec3 before = spore_vec3_add(spore_mesh_area_vector(a, b, c), spore_mesh_area_vector(b, a, d));
  double length = spore_vec3_length(before);
  SporeVec3 first = spore_mesh_area_vector(c, d, b), second = spore_mesh_area_vector(d, c, a);
  return spore_vec3_dot(first, before) > 0.5 * length * spore_vec3_length(first) &&
         spore_vec3_dot(second, before) > 0.5 * length * spore_vec3_length(second);
}

/* False: no memory. */
static bool flip_edge(SporeShell *shell, SporeShellNeighbours *near, uint32_t a, uint32_t b, double far) {
  uint32_t corners[2], between[2];
  if (spore_shell_between(shell, a, b, corners) != 2 || spore_shell_is_feature(shell, a, b)) return true;
  if (shell->corner[spore_shell_after(corners[0])] != b) {
    uint32_t swap = corners[0];
    corners[0] = corners[1], corners[1] = swap;
  }
  if (shell->corner[spore_shell_after(corners[0])] != b || shell->corner[spore_shell_before(corners[1])] != b)
    return true;
  uint32_t c = shell->corner[spore_shell_before(corners[0])], d = shell->corner[spore_shell_after(corners[1])];
  if (c == d || spore_shell_between(shell, c, d, between) > 0) return true;
  if (spore_shell_count(shell, a) <= 3 || spore_shell_count(shell, b) <= 3) return true;
  SporeVec3 p = spore_shell_at(shell, a), q = spore_shell_at(shell, b), r = spore_shell_at(shell, c),
            s = spore_shell_at(shell, d);
  double now = fmin(least_angle(p, q, r), least_angle(q, p, s)),
         then = fmin(least_angle(r, s, q), least_angle(s, r, p));
  const uint32_t made[2][3] = {{c, d, b}, {d, c, a}};
  if (!(then > BETTER * now) || !is_flat(p, q, r, s, far) || spore_shell_triangle_crosses(near, shell, made[0]) ||
      spore_shell_triangle_crosses(near, shell, made[1]))
    return true;
  spore_shell_flip(shell, corners);
  return spore_shell_neighbours_add(near, shell, corners[0] / 3) &&
         spore_shell_neighbours_add(near, shell, corners[1] / 3);
}

static bool flip_edges(SporeShell *shell, SporeShellNeighbours *near, double far) {
  for (uint32_t h = 0; h < 3 * shell->triangle_count; h++)
    if (shell->corner[3 * (size_t)(h / 3)] != SPORE_SHELL_NONE &&
        !flip_edge(shell, near, shell->corner[h], shell->corner[spore_shell_after(h)], far))
      return false;
  return true;
}

/* Moving points. */

/* The centre of the triangles around a vertex, weighted by their areas. */
static SporeVec3 centre_around(const SporeShell *shell, uint32_t vertex, SporeVec3 *normal) {
  SporeVec3 sum = {0, 0, 0}, at = spore_shell_at(shell, vertex);
  double weight = 0;
  *normal = spore_vec3(0, 0, 0);
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    SporeVec3 b = spore_shell_at(shell, shell->corner[spore_shell_after(c)]),
              d = spore_shell_at(shell, shell->corner[spore_shell_before(c)]), area = spore_mesh_area_vector(at, b, d);
    double size = spore_vec3_length(area);
    *normal = spore_vec3_add(*normal, area);
    sum = spore_vec3_add_scaled(sum, size / 3, spore_vec3_add(at, spore_vec3_add(b, d)));
    weight += size;
  }
  return weight > 0 ? spore_vec3_scale(1 / weight, sum) : at;
}

/* Moves a point along the surface towards the centre of its triangles, then across the surface to the optimum of its
 * planes. False: no memory. */
static bool move_point(SporeShell *shell, SporeShellNeighbours *near, const SporeQuadric *quadric, uint32_t vertex,
                       double far) {
  SporeVec3 normal, at = spore_shell_at(shell, vertex), to = centre_around(shell, vertex, &normal);
  SporeVec3 unit = spore_vec3_normalise(normal, spore_vec3(0, 0, 0)), step = spore_vec3_sub(to, at);
  step = spore_vec3_add_scaled(step, -spore_vec3_dot(step, unit), unit);
  SporeVec3 moved = spore_vec3_add_scaled(at, PART, step);
  double stiff = spore_vec3_dot(unit, spore_mat3_apply(quadric->a, unit)), now = spore_quadric_at(quadric, at);
  SporeVec3 slope = spore_vec3_add(spore_mat3_apply(quadric->a, moved), quadric->b);
  if (stiff > 1e-3 * quadric->weight) moved = spore_vec3_add_scaled(moved, -spore_vec3_dot(unit, slope) / stiff, unit);
  if (spore_quadric_at(quadric, moved) > fmax(now, quadric->weight * far * far)) return true;
  if (spore_shell_moved_quality(shell, vertex, moved, SPORE_SHELL_NONE) < GOOD ||
      spore_shell_move_crosses(near, shell, vertex, moved))
    return true;
  spore_vec3_store(shell->x + 3 * (size_t)vertex, moved);
  return spore_shell_neighbours_add_ring(near, shell, vertex);
}

/* Root of the mean square of how far points lie off the planes that they stand for. */
static double typical_distance(const SporeShell *shell, const SporeQuadric *quadric) {
  double sum = 0, weight = 0;
  for (uint32_t i = 0; i < shell->vertex_count; i++) {
    if (shell->head[i] == SPORE_SHELL_NONE || shell->kind[i] != SPORE_SHELL_SMOOTH) continue;
    sum += spore_quadric_at(&quadric[i], spore_shell_at(shell, i));
    weight += quadric[i].weight;
  }
  return weight > 0 ? sqrt(sum / weight) : 0;
}

bool spore_shell_improve(SporeShell *shell, const SporeQuadric *quadric, SporeShellNeighbours *near,
                         const SporeProgress *progress, SporeError *error) {
  double far = FAR * typical_distance(shell, quadric);
  bool room = true;
  for (int round = 0; room && round < ROUNDS; round++) {
    if (!spore_progress_step(progress, 0.5 + 0.5 * round / ROUNDS, _("widening angles"), error)) return false;
    room = flip_edges(shell, near, far);
    for (uint32_t i = 0; room && i < shell->vertex_count; i++)
      if (shell->head[i] != SPORE_SHELL_NONE && shell->kind[i] == SPORE_SHELL_SMOOTH)
        room = move_point(shell, near, &quadric[i], i, far);
  }
  return room || spore_mesh_no_memory(error);
}
