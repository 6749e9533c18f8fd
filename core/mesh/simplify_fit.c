/* Moves points so that the largest distance between a simplified surface and its original decreases. Each point is
 * attracted by the farthest places around it, the more the farther they are. */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/simplify_parts.h"

#define ROUNDS 24
#define IDLE 8             /* the fit ends after so many rounds without gain */
#define NEAR 0.3           /* of the largest distance: nearer places do not attract */
#define POWER 4            /* power of the distance in the attraction */
#define STIFF 0.05         /* of the attraction: stiffness against moves along the surface */
#define PART 0.6           /* share of its way that a point moves in a round */
#define LEAST_QUALITY 0.3  /* least quality of a triangle that gets worse */
#define PARTS 4            /* of a side, between points that are looked at */
#define POINTS 15          /* of a triangle, then */
#define MOST_SAMPLES 50000 /* of each surface */

typedef struct Draw {
  SporeMat3 square;
  SporeVec3 way;
  double weight;
} Draw;

/* A place of the surface, and the vector from there to the nearest point of the other surface. */
typedef struct Gap {
  uint32_t corner[3];
  double share[3]; /* of the corners, in the place */
  SporeVec3 way;
} Gap;

typedef struct Fit {
  SporeShell *shell;
  SporeShellNeighbours near;
  const SporeTriangleMesh *original;
  SporeBvh *tree; /* of the original, as it lies in the shell */
  double *points; /* its vertices there, and middles of its triangles */
  size_t point_count;
  uint32_t *triangles;
  Gap *gaps;
  size_t gap_count;
  Draw *draws;
  double *best; /* places of the points at the least distance so far */
} Fit;

static void shares_of(const SporeShell *shell, Gap *gap, SporeVec3 p) {
  SporeVec3 a = spore_shell_at(shell, gap->corner[0]), b = spore_shell_at(shell, gap->corner[1]),
            c = spore_shell_at(shell, gap->corner[2]), n = spore_mesh_area_vector(a, b, c);
  double square = spore_vec3_dot(n, n);
  gap->share[1] = square > 0 ? spore_vec3_dot(spore_mesh_area_vector(a, p, c), n) / square : 1. / 3;
  gap->share[2] = square > 0 ? spore_vec3_dot(spore_mesh_area_vector(a, b, p), n) / square : 1. / 3;
  gap->share[0] = 1 - gap->share[1] - gap->share[2];
}

/* From points of the original. False: no memory. */
static bool add_gaps_to(Fit *fit, SporeError *error) {
  size_t count = 0, stride = fit->point_count / MOST_SAMPLES + 1;
  for (uint32_t t = 0; t < fit->shell->triangle_count; t++) {
    const uint32_t *n = fit->shell->corner + 3 * (size_t)t;
    if (n[0] != SPORE_SHELL_NONE) memcpy(fit->triangles + 3 * count++, n, 3 * sizeof *n);
  }
  const SporeTriangleMesh now = {fit->shell->vertex_count, count, fit->shell->x, fit->triangles};
  SporeBvh *tree = spore_bvh_create(&now, error);
  if (!tree) return false;
  for (size_t i = 0; i < fit->point_count; i += stride) {
    SporeVec3 foot, p = spore_vec3_load(fit->points + 3 * i);
    uint32_t triangle;
    Gap *gap = &fit->gaps[fit->gap_count++];
    spore_bvh_distance(tree, p, &foot, &triangle);
    memcpy(gap->corner, fit->triangles + 3 * (size_t)triangle, sizeof gap->corner);
    shares_of(fit->shell, gap, foot);
    gap->way = spore_vec3_sub(p, foot);
  }
  spore_bvh_free(tree);
  return true;
}

static void add_gap_from(Fit *fit, const uint32_t corner[3], int i, int j) {
  SporeVec3 foot, p = {0, 0, 0};
  Gap *gap = &fit->gaps[fit->gap_count++];
  *gap = (Gap){
      {corner[0], corner[1], corner[2]}, {(double)(PARTS - i - j) / PARTS, (double)i / PARTS, (double)j / PARTS}, p};
  for (int k = 0; k < 3; k++) p = spore_vec3_add_scaled(p, gap->share[k], spore_shell_at(fit->shell, corner[k]));
  spore_bvh_distance(fit->tree, p, &foot, NULL);
  gap->way = spore_vec3_sub(foot, p);
}

/* From points of the triangles and of their sides. */
static void add_gaps_from(Fit *fit) {
  size_t stride = POINTS * 2 * fit->shell->live / MOST_SAMPLES + 1;
  for (uint32_t t = 0; t < fit->shell->triangle_count; t++) {
    const uint32_t *n = fit->shell->corner + 3 * (size_t)t;
    if (n[0] == SPORE_SHELL_NONE || t % stride) continue;
    for (int i = 0; i <= PARTS; i++)
      for (int j = 0; i + j <= PARTS; j++) add_gap_from(fit, n, i, j);
  }
}

static double largest(const Fit *fit) {
  double far = 0;
  for (size_t i = 0; i < fit->gap_count; i++) far = fmax(far, spore_vec3_length(fit->gaps[i].way));
  return far;
}

static void draw(Fit *fit, double far) {
  memset(fit->draws, 0, fit->shell->vertex_count * sizeof *fit->draws);
  for (size_t i = 0; i < fit->gap_count; i++) {
    const Gap *gap = &fit->gaps[i];
    double length = spore_vec3_length(gap->way);
    if (!(length > NEAR * far)) continue;
    SporeMat3 along = spore_mat3_scale(1 / (length * length), spore_mat3_outer(gap->way, gap->way));
    for (int k = 0; k < 3; k++) {
      Draw *its = &fit->draws[gap->corner[k]];
      double weight = pow(length / far, POWER) * fmax(gap->share[k], 0);
      its->square = spore_mat3_add(its->square, spore_mat3_scale(weight, along));
      its->way = spore_vec3_add_scaled(its->way, weight, gap->way);
      its->weight += weight;
    }
  }
}

/* False: no memory. */
static bool move_points(Fit *fit, double far) {
  for (uint32_t v = 0; v < fit->shell->vertex_count; v++) {
    Draw *its = &fit->draws[v];
    SporeMat3 inverse;
    if (fit->shell->head[v] == SPORE_SHELL_NONE || fit->shell->kind[v] != SPORE_SHELL_SMOOTH || !(its->weight > 0))
      continue;
    for (int k = 0; k < 3; k++) its->square.m[4 * k] += STIFF * its->weight;
    if (!spore_mat3_invert(its->square, &inverse)) continue;
    SporeVec3 move = spore_mat3_apply(inverse, its->way);
    double length = spore_vec3_length(move);
    if (length > far) move = spore_vec3_scale(far / length, move);
    SporeVec3 x = spore_vec3_add_scaled(spore_shell_at(fit->shell, v), PART, move);
    if (spore_shell_moved_quality(fit->shell, v, x, SPORE_SHELL_NONE) < LEAST_QUALITY ||
        spore_shell_move_crosses(&fit->near, fit->shell, v, x))
      continue;
    spore_vec3_store(fit->shell->x + 3 * (size_t)v, x);
    if (!spore_shell_neighbours_add_ring(&fit->near, fit->shell, v)) return false;
  }
  return true;
}

static bool fit_rounds(Fit *fit, const SporeProgress *progress, SporeError *error) {
  double best = HUGE_VAL;
  size_t size = 3 * fit->shell->vertex_count * sizeof(double);
  for (int round = 0, idle = 0; round < ROUNDS && idle < IDLE; round++) {
    if (!spore_progress_step(progress, (double)round / ROUNDS, _("lowering the largest distance"), error)) return false;
    fit->gap_count = 0;
    if (!add_gaps_to(fit, error)) return false;
    add_gaps_from(fit);
    double far = largest(fit);
    idle = far < best ? 0 : idle + 1;
    if (far < best) memcpy(fit->best, fit->shell->x, size), best = far;
    if (!(far > 0)) break;
    draw(fit, far);
    if (!move_points(fit, far)) return spore_mesh_no_memory(error);
  }
  memcpy(fit->shell->x, fit->best, size);
  return true;
}

/* The original in the shell's coordinates. */
static void add_points(Fit *fit) {
  const SporeTriangleMesh *mesh = fit->original;
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
    fit->points[i] = (mesh->vertices[i] - fit->shell->middle[i % 3]) / fit->shell->diagonal;
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
    for (size_t e = 0; e < 3; e++)
      fit->points[3 * (mesh->vertex_count + i / 3) + e] += fit->points[3 * (size_t)mesh->triangles[i] + e] / 3;
}

/* Mean length of edges, as equilateral triangles of this area have. */
static double edge_of(const SporeShell *shell) {
  double area = 0;
  for (uint32_t t = 0; t < shell->triangle_count; t++)
    if (shell->corner[3 * (size_t)t] != SPORE_SHELL_NONE) area += 0.5 * spore_vec3_length(spore_shell_normal(shell, t));
  return sqrt(area / (sqrt(3) / 2 * (double)(shell->live + 1)));
}

bool spore_shell_fit(SporeShell *shell, const SporeTriangleMesh *original, const SporeProgress *progress,
                     SporeError *error) {
  Fit fit = {.shell = shell, .original = original};
  fit.point_count = original->vertex_count + original->triangle_count;
  fit.points = SPORE_NEW_ARRAY(double, 3 * fit.point_count);
  fit.triangles = SPORE_NEW_ARRAY(uint32_t, 3 * shell->triangle_count);
  fit.gaps = SPORE_NEW_ARRAY(Gap, fit.point_count + POINTS * shell->triangle_count);
  fit.draws = SPORE_NEW_ARRAY(Draw, shell->vertex_count);
  fit.best = SPORE_NEW_ARRAY(double, 3 * shell->vertex_count);
  bool done = (fit.points && fit.triangles && fit.gaps && fit.draws && fit.best &&
               spore_shell_neighbours_create(&fit.near, shell, edge_of(shell))) ||
              spore_mesh_no_memory(error);
  if (done) add_points(&fit);
  const SporeTriangleMesh there = {original->vertex_count, original->triangle_count, fit.points, original->triangles};
  if (done) fit.tree = spore_bvh_create(&there, error);
  done = done && fit.tree && fit_rounds(&fit, progress, error);
  spore_bvh_free(fit.tree);
  spore_shell_neighbours_clear(&fit.near);
  spore_free(fit.points);
  spore_free(fit.triangles);
  spore_free(fit.gaps);
  spore_free(fit.draws);
  spore_free(fit.best);
  return done;
}
