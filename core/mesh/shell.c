/* A surface while it is edited: its lists of corners, its features, and changes to it. */
#include "core/mesh/shell.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"

#define NONE SPORE_SHELL_NONE
#define LEAST_TURN 0.3 /* least cosine of the angle by which a triangle may turn when one of its corners moves */
#define SLIVER 0.1     /* quality below which a triangle's normal is not reliable */

void spore_shell_clear(SporeShell *shell) {
  spore_free(shell->x);
  spore_free(shell->corner);
  spore_free(shell->head);
  spore_free(shell->next);
  spore_free(shell->kind);
  spore_free(shell->feature);
  spore_free(shell->mark);
  *shell = (SporeShell){0};
}

static void hang(SporeShell *shell, uint32_t corner) {
  assert(corner < 3 * shell->triangle_count);
  uint32_t vertex = shell->corner[corner];
  shell->next[corner] = shell->head[vertex];
  shell->head[vertex] = corner;
}

static void unhang(SporeShell *shell, uint32_t corner) {
  assert(corner < 3 * shell->triangle_count);
  uint32_t *link = &shell->head[shell->corner[corner]];
  while (*link != corner) link = &shell->next[*link];
  *link = shell->next[corner];
}

static void fill(SporeShell *shell, const SporeTriangleMesh *mesh) {
  double lower[3], upper[3];
  shell->diagonal = spore_mesh_bounds(mesh->vertices, mesh->vertex_count, 3, lower, upper);
  for (int k = 0; k < 3; k++) shell->middle[k] = 0.5 * (lower[k] + upper[k]);
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
    shell->x[i] = (mesh->vertices[i] - shell->middle[i % 3]) / shell->diagonal;
  for (size_t i = 0; i < mesh->vertex_count; i++) shell->head[i] = NONE;
  memcpy(shell->corner, mesh->triangles, 3 * mesh->triangle_count * sizeof *shell->corner);
  for (uint32_t t = (uint32_t)mesh->triangle_count; t-- > 0;) {
    uint32_t *n = shell->corner + 3 * t;
    if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) n[0] = NONE;
    else
      for (uint32_t k = 3; k-- > 0;) hang(shell, 3 * t + k);
  }
  for (size_t i = 0; i < mesh->vertex_count; i++) shell->live += shell->head[i] != NONE;
}

bool spore_shell_create(SporeShell *shell, const SporeTriangleMesh *mesh) {
  size_t vertices = mesh->vertex_count, corners = 3 * mesh->triangle_count;
  *shell = (SporeShell){.vertex_count = vertices,
                        .triangle_count = mesh->triangle_count,
                        .x = SPORE_NEW_ARRAY(double, 3 * vertices),
                        .corner = SPORE_NEW_ARRAY(uint32_t, corners),
                        .head = SPORE_NEW_ARRAY(uint32_t, vertices),
                        .next = SPORE_NEW_ARRAY(uint32_t, corners),
                        .kind = SPORE_NEW_ARRAY(uint8_t, vertices),
                        .feature = SPORE_NEW_ARRAY(bool, corners),
                        .mark = SPORE_NEW_ARRAY(uint32_t, vertices)};
  bool made = shell->x && shell->corner && shell->head && shell->next && shell->kind && shell->feature && shell->mark;
  if (made) fill(shell, mesh);
  else spore_shell_clear(shell);
  return made;
}

bool spore_shell_mesh(const SporeShell *shell, SporeTriangleMesh *mesh, SporeError *error) {
  size_t triangles = 0;
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, shell->vertex_count), vertices = 0;
  for (size_t t = 0; t < shell->triangle_count; t++) triangles += shell->corner[3 * t] != NONE;
  if (!number) return spore_mesh_no_memory(error);
  bool made = spore_triangle_mesh_allocate(mesh, shell->live, triangles, error);
  for (uint32_t i = 0; made && i < shell->vertex_count; i++) {
    if (shell->head[i] == NONE) continue;
    for (int k = 0; k < 3; k++)
      mesh->vertices[3 * (size_t)vertices + k] = shell->middle[k] + shell->diagonal * shell->x[3 * (size_t)i + k];
    number[i] = vertices++;
  }
  uint32_t *to = mesh->triangles;
  for (size_t t = 0; made && t < shell->triangle_count; t++)
    for (size_t k = 0; k < 3 && shell->corner[3 * t] != NONE; k++) *to++ = number[shell->corner[3 * t + k]];
  spore_free(number);
  return made;
}

/* Features. */

static bool is_sharp(const SporeShell *shell, uint32_t one, uint32_t other, double angle) {
  SporeVec3 a = spore_shell_normal(shell, one / 3), b = spore_shell_normal(shell, other / 3);
  return atan2(spore_vec3_length(spore_vec3_cross(a, b)), spore_vec3_dot(a, b)) > angle;
}

/* Whether the lines of two feature edges that meet at a vertex turn there. */
static bool is_bend(const SporeShell *shell, uint32_t vertex, const uint32_t ends[2], double angle) {
  SporeVec3 at = spore_shell_at(shell, vertex), in = spore_vec3_sub(at, spore_shell_at(shell, ends[0])),
            out = spore_vec3_sub(spore_shell_at(shell, ends[1]), at);
  return atan2(spore_vec3_length(spore_vec3_cross(in, out)), spore_vec3_dot(in, out)) > angle;
}

/* degree: feature edges at each vertex; ends: the far ends of the first two. */
static void name_kinds(SporeShell *shell, const uint32_t *degree, const uint32_t *ends, double angle) {
  for (uint32_t i = 0; i < shell->vertex_count; i++) {
    bool line =
        degree[i] == 2 && shell->kind[i] != SPORE_SHELL_CORNER && !is_bend(shell, i, ends + 2 * (size_t)i, angle);
    shell->kind[i] = degree[i] == 0 ? SPORE_SHELL_SMOOTH : line ? SPORE_SHELL_LINE : SPORE_SHELL_CORNER;
  }
}

static void join(uint32_t a, uint32_t b, uint32_t *degree, uint32_t *ends) {
  if (degree[a] < 2) ends[2 * (size_t)a + degree[a]] = b;
  degree[a]++;
}

static void mark_features(SporeShell *shell, const SporeHalfEdges *halves, double angle, uint32_t *degree,
                          uint32_t *ends, SporeShellFeatures *features) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    uint32_t a = (uint32_t)(halves->edge[i] >> 32), b = (uint32_t)halves->edge[i];
    bool locked = end - i > 2, sharp = end - i == 2 && is_sharp(shell, halves->half[i], halves->half[i + 1], angle);
    features->locked += locked;
    features->creases += sharp;
    for (size_t j = i; j < end; j++) shell->feature[halves->half[j]] = locked || sharp || end - i == 1;
    if (locked) shell->kind[a] = shell->kind[b] = SPORE_SHELL_CORNER;
    if (end - i == 2 && !sharp) continue;
    join(a, b, degree, ends);
    join(b, a, degree, ends);
  }
}

bool spore_shell_find_features(SporeShell *shell, double angle, SporeShellFeatures *features) {
  SporeHalfEdges halves = {0};
  uint32_t *degree = SPORE_NEW_ARRAY(uint32_t, shell->vertex_count),
           *ends = SPORE_NEW_ARRAY(uint32_t, 2 * shell->vertex_count),
           *gone = SPORE_NEW_ARRAY(uint32_t, 3 * shell->triangle_count);
  bool made = degree && ends && gone;
  *features = (SporeShellFeatures){0};
  if (made) memcpy(gone, shell->corner, 3 * shell->triangle_count * sizeof *gone);
  for (size_t t = 0; made && t < shell->triangle_count; t++) /* sides from a to a are left out */
    if (gone[3 * t] == NONE) gone[3 * t] = gone[3 * t + 1] = gone[3 * t + 2] = 0;
  made = made && spore_half_edges_create(&halves, gone, shell->triangle_count);
  if (made) {
    memset(shell->kind, SPORE_SHELL_SMOOTH, shell->vertex_count);
    mark_features(shell, &halves, angle, degree, ends, features);
    name_kinds(shell, degree, ends, angle);
  }
  spore_half_edges_clear(&halves);
  spore_free(degree);
  spore_free(ends);
  spore_free(gone);
  return made;
}

/* Queries. */

SporeVec3 spore_shell_normal(const SporeShell *shell, uint32_t triangle) {
  const uint32_t *n = shell->corner + 3 * (size_t)triangle;
  SporeVec3 a = spore_shell_at(shell, n[0]);
  return spore_vec3_cross(spore_vec3_sub(spore_shell_at(shell, n[1]), a),
                          spore_vec3_sub(spore_shell_at(shell, n[2]), a));
}

double spore_shell_quality(SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  SporeVec3 ab = spore_vec3_sub(b, a), ac = spore_vec3_sub(c, a), bc = spore_vec3_sub(c, b);
  double sides = spore_vec3_dot(ab, ab) + spore_vec3_dot(ac, ac) + spore_vec3_dot(bc, bc);
  return sides > 0 ? 2 * sqrt(3) * spore_vec3_length(spore_vec3_cross(ab, ac)) / sides : 0;
}

/* The mean normal around, by area. */
static SporeVec3 normal_around(const SporeShell *shell, uint32_t vertex) {
  SporeVec3 sum = {0, 0, 0};
  for (uint32_t c = shell->head[vertex]; c != NONE; c = shell->next[c])
    sum = spore_vec3_add(sum, spore_shell_normal(shell, c / 3));
  return sum;
}

double spore_shell_moved_quality(const SporeShell *shell, uint32_t vertex, SporeVec3 x, uint32_t except) {
  SporeVec3 at = spore_shell_at(shell, vertex);
  double worst = 1;
  for (uint32_t c = shell->head[vertex]; c != NONE; c = shell->next[c]) {
    uint32_t n[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    if (n[0] == except || n[1] == except) continue;
    SporeVec3 b = spore_shell_at(shell, n[0]), d = spore_shell_at(shell, n[1]);
    double was = spore_shell_quality(at, b, d), quality = spore_shell_quality(x, b, d);
    SporeVec3 before = was < SLIVER ? normal_around(shell, vertex)
                                    : spore_vec3_cross(spore_vec3_sub(b, at), spore_vec3_sub(d, at)),
              after = spore_vec3_cross(spore_vec3_sub(b, x), spore_vec3_sub(d, x));
    double both = spore_vec3_length(before) * spore_vec3_length(after);
    if (!(spore_vec3_dot(before, after) >= LEAST_TURN * both)) return 0;
    if (quality < was) worst = fmin(worst, quality);
  }
  return worst;
}

size_t spore_shell_between(const SporeShell *shell, uint32_t a, uint32_t b, uint32_t corners[2]) {
  size_t count = 0;
  for (uint32_t c = shell->head[a]; c != NONE; c = shell->next[c]) {
    if (shell->corner[spore_shell_after(c)] != b && shell->corner[spore_shell_before(c)] != b) continue;
    if (count < 2) corners[count] = c;
    count++;
  }
  return count;
}

bool spore_shell_is_feature(const SporeShell *shell, uint32_t a, uint32_t b) {
  for (uint32_t c = shell->head[a]; c != NONE; c = shell->next[c]) {
    if (shell->corner[spore_shell_after(c)] == b && shell->feature[c]) return true;
    if (shell->corner[spore_shell_before(c)] == b && shell->feature[spore_shell_before(c)]) return true;
  }
  return false;
}

size_t spore_shell_count(const SporeShell *shell, uint32_t vertex) {
  size_t count = 0;
  for (uint32_t c = shell->head[vertex]; c != NONE; c = shell->next[c]) count++;
  return count;
}

uint32_t spore_shell_mark(SporeShell *shell, uint32_t vertex) {
  uint32_t mark = ++shell->marked;
  for (uint32_t c = shell->head[vertex]; c != NONE; c = shell->next[c])
    shell->mark[shell->corner[spore_shell_after(c)]] = shell->mark[shell->corner[spore_shell_before(c)]] = mark;
  return mark;
}

/* Changes. */

/* Passes the feature mark of a triangle that is removed on to its neighbours, whose two edges become one edge. */
static void pass_feature_on(SporeShell *shell, uint32_t a, uint32_t b, uint32_t c) {
  bool feature = spore_shell_is_feature(shell, b, c) || spore_shell_is_feature(shell, a, c);
  for (uint32_t h = shell->head[c]; feature && h != NONE; h = shell->next[h]) {
    uint32_t after = shell->corner[spore_shell_after(h)], before = shell->corner[spore_shell_before(h)];
    if (after == a || after == b) shell->feature[h] = true;
    if (before == a || before == b) shell->feature[spore_shell_before(h)] = true;
  }
}

static void remove_triangle(SporeShell *shell, uint32_t triangle) {
  for (uint32_t k = 0; k < 3; k++) unhang(shell, 3 * triangle + k);
  shell->corner[3 * (size_t)triangle] = NONE;
}

void spore_shell_collapse(SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x) {
  uint32_t corners[2];
  size_t count = spore_shell_between(shell, a, b, corners);
  for (size_t i = 0; i < count && i < 2; i++) {
    uint32_t t = corners[i] / 3, *n = shell->corner + 3 * (size_t)t, c = n[0] ^ n[1] ^ n[2] ^ a ^ b;
    pass_feature_on(shell, a, b, c);
    remove_triangle(shell, t);
    shell->live -= shell->head[c] == NONE;
  }
  while (shell->head[b] != NONE) {
    uint32_t c = shell->head[b];
    shell->head[b] = shell->next[c];
    shell->corner[c] = a;
    hang(shell, c);
  }
  spore_vec3_store(shell->x + 3 * (size_t)a, x);
  shell->live--;
}

void spore_shell_flip(SporeShell *shell, const uint32_t corners[2]) {
  uint32_t first = corners[0], second = corners[1], a = shell->corner[first];
  if (shell->corner[spore_shell_after(second)] == shell->corner[spore_shell_before(first)]) { /* b is before a there */
    first = corners[1], second = corners[0];
  }
  /* first: a -> b -> c; second: a -> d -> b. */
  uint32_t b = shell->corner[spore_shell_after(first)], c = shell->corner[spore_shell_before(first)],
           d = shell->corner[spore_shell_after(second)], one = 3 * (first / 3), other = 3 * (second / 3);
  bool bc = shell->feature[spore_shell_after(first)], ca = shell->feature[spore_shell_before(first)],
       ad = shell->feature[second], db = shell->feature[spore_shell_after(second)];
  for (uint32_t k = 0; k < 3; k++) unhang(shell, one + k), unhang(shell, other + k);
  const uint32_t corner[6] = {c, d, b, d, c, a};
  const bool feature[6] = {false, db, bc, false, ca, ad};
  for (uint32_t k = 0; k < 6; k++) {
    uint32_t at = k < 3 ? one + k : other + k - 3;
    shell->corner[at] = corner[k];
    shell->feature[at] = feature[k];
    hang(shell, at);
  }
}
