/* Simplifying as far as a limit allows. */
#include <math.h>

#include "core/mesh/common.h"
#include "core/mesh/simplify_parts.h"

#define MOST_PARTS 12 /* that a triangle's side is cut into */

/* How far a triangle (m) is off, on its inside and on its first side; above `enough`, that may be said too soon. */
static double off_triangle(const SporeSurfaceLimit *limit, const SporeVec3 corner[3], double enough) {
  SporeVec3 one = spore_vec3_sub(corner[1], corner[0]), other = spore_vec3_sub(corner[2], corner[0]);
  double far = 0, longest = fmax(spore_vec3_distance(corner[1], corner[2]),
                                 fmax(spore_vec3_length(one), spore_vec3_length(other)));
  int parts = (int)fmin(fmax(ceil(longest / limit->spacing), 2), MOST_PARTS);
  /* Middles of the parts first: they are farthest off, most often; then corners of parts, but those of the last side
   * that a triangle beside it looks at. */
  for (int pass = 0; pass < 2; pass++)
    for (int i = pass; i < parts; i++)
      for (int j = 0; i + j < parts && far <= enough; j++) {
        double at = pass ? 0 : 1. / 3;
        SporeVec3 p = spore_vec3_add_scaled(corner[0], (i + at) / parts, one);
        far = fmax(far, limit->off(limit->data, spore_vec3_add_scaled(p, (j + at) / parts, other)));
      }
  return far;
}

static SporeVec3 in_metres(const SporeShell *shell, SporeVec3 x) {
  return spore_vec3_add_scaled(spore_vec3_load(shell->middle), shell->diagonal, x);
}

/* How far the triangles around a vertex are off with it at x; those that have `except` too are left out. */
static double off_ring(const SporeShell *shell, const SporeSurfaceLimit *limit, uint32_t vertex, SporeVec3 x,
                       uint32_t except, double enough) {
  double far = limit->off(limit->data, in_metres(shell, x));
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE && far <= enough; c = shell->next[c]) {
    uint32_t n[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    if (n[0] == except || n[1] == except) continue;
    const SporeVec3 corner[3] = {in_metres(shell, x), in_metres(shell, spore_shell_at(shell, n[0])),
                                 in_metres(shell, spore_shell_at(shell, n[1]))};
    far = fmax(far, off_triangle(limit, corner, enough));
  }
  return far;
}

static double off_collapsed(const SporeShell *shell, const SporeSurfaceLimit *limit, uint32_t a, uint32_t b,
                            SporeVec3 x, double enough) {
  double far = off_ring(shell, limit, a, x, b, enough);
  return far > enough ? far : fmax(far, off_ring(shell, limit, b, x, a, enough));
}

bool spore_shell_limit_allows(const SporeShell *shell, const SporeSurfaceLimit *limit, uint32_t a, uint32_t b,
                              SporeVec3 x) {
  if (off_collapsed(shell, limit, a, b, x, limit->most) <= limit->most) return true;
  double now = fmax(off_ring(shell, limit, a, spore_shell_at(shell, a), SPORE_SHELL_NONE, HUGE_VAL),
                    off_ring(shell, limit, b, spore_shell_at(shell, b), SPORE_SHELL_NONE, HUGE_VAL));
  return now > limit->most && off_collapsed(shell, limit, a, b, x, now) <= now;
}

bool spore_triangle_mesh_thin(SporeTriangleMesh *mesh, const SporeSurfaceLimit *limit, const SporeProgress *progress,
                              SporeError *error) {
  SporeShell shell;
  SporeTriangleMesh thin = {0};
  if (!spore_shell_create(&shell, mesh)) return spore_mesh_no_memory(error);
  bool done = spore_shell_collapse_to(&shell, 4, limit, progress, error) && spore_shell_mesh(&shell, &thin, error);
  spore_shell_clear(&shell);
  if (!done) return false;
  spore_triangle_mesh_clear(mesh);
  *mesh = thin;
  return true;
}
