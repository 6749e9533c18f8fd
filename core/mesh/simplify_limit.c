/* Simplifying as far as a limit allows. */
#include <math.h>

#include "core/mesh/common.h"
#include "core/mesh/simplify_parts.h"

#define MOST_PARTS 12 /* largest number of parts of a triangle's side */

static SporeVec3 in_metres(const SporeShell *shell, SporeVec3 x) {
  return spore_vec3_add_scaled(spore_vec3_load(shell->middle), shell->diagonal, x);
}

/* How far a place in a triangle is off; 0 where its corners tell that it is within the limit. Above: no farther from
 * the surface than from what is nearest to a corner. Below: where D is its distance, s_i from the place to corner i and
 * w_i the place's weights, corner i is within D + (along) + s_i^2 / (2 D) of what is nearest to the place; by weights
 * the parts along it cancel, so that D + sum(w_i s_i^2) / (2 D) is no less than the corners' mean depth. */
static double off_at(const SporeSurfaceLimit *limit, const SporeBvhKnown corner[3], const double weight[3]) {
  const SporeBvhKnown *beside = corner;
  SporeVec3 place = {0, 0, 0};
  double above = HUGE_VAL, mean = 0, spread = 0, least = 0;
  for (int k = 0; k < 3; k++) place = spore_vec3_add_scaled(place, weight[k], corner[k].place);
  if (limit->off) return limit->off(limit->data, place);
  for (int k = 0; k < 3; k++) {
    double gap = spore_vec3_distance(place, corner[k].nearest), apart = spore_vec3_distance(place, corner[k].place);
    if (gap < above) above = gap, beside = corner + k;
    mean += weight[k] * corner[k].depth;
    spread += weight[k] * apart * apart;
    least = fmax(least, corner[k].depth - apart);
  }
  double square = mean * mean - 2 * spread, below = square > 0 ? (mean + sqrt(square)) / 2 : 0;
  bool near = above <= limit->depth + limit->most && below >= limit->depth - limit->most;
  if (near && least > mean - below) return 0; /* neither the smaller root nor the other side of the surface applies */
  return fabs(limit->depth - spore_depth_cells_beside(limit->cells, place, beside).depth);
}

/* How far a triangle is off, in its inside and on its first side. Above `enough` the search may end early. */
static double off_triangle(const SporeSurfaceLimit *limit, const SporeBvhKnown corner[3], double enough) {
  double far = 0, longest = 0;
  for (int k = 0; k < 3; k++) longest = fmax(longest, spore_vec3_distance(corner[k].place, corner[(k + 1) % 3].place));
  int parts = (int)fmin(fmax(ceil(longest / limit->spacing), 2), MOST_PARTS);
  /* Centres of the parts come first: they are most often the farthest. Then come corners of the parts, without those of
   * the last side, which a neighbouring triangle looks at. */
  for (int pass = 0; pass < 2; pass++)
    for (int i = pass; i < parts; i++)
      for (int j = 0; i + j < parts && far <= enough; j++) {
        double at = pass ? 0 : 1. / 3, one = (i + at) / parts, other = (j + at) / parts;
        far = fmax(far, off_at(limit, corner, (const double[3]){1 - one - other, one, other}));
      }
  return far;
}

static SporeBvhKnown know(const SporeSurfaceLimit *limit, SporeVec3 place, const SporeBvhKnown *beside) {
  if (!limit->off) return spore_depth_cells_beside(limit->cells, place, beside);
  return (SporeBvhKnown){.place = place, .depth = limit->depth - limit->off(limit->data, place)};
}

static const SporeBvhKnown *look(const SporeShellLimit *work, const SporeShell *shell, uint32_t vertex,
                                 const SporeBvhKnown *beside) {
  SporeBvhKnown *known = &work->vertex[vertex];
  SporeVec3 place = in_metres(shell, spore_shell_at(shell, vertex));
  if (known->depth == 0) *known = know(work->limit, place, beside);
  return known;
}

static double off_vertex(const SporeShellLimit *work, const SporeBvhKnown *known) {
  return fabs(work->limit->depth - known->depth);
}

/* How far the triangles around a vertex are off when the vertex is moved; triangles that also have the vertex `except`
 * are left out. */
static double off_ring(const SporeShellLimit *work, const SporeShell *shell, uint32_t vertex,
                       const SporeBvhKnown *elsewhere, uint32_t except, double enough) {
  double far = off_vertex(work, elsewhere);
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE && far <= enough; c = shell->next[c]) {
    uint32_t n[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    if (n[0] == except || n[1] == except) continue;
    const SporeBvhKnown corner[3] = {*elsewhere, *look(work, shell, n[0], elsewhere),
                                     *look(work, shell, n[1], elsewhere)};
    far = fmax(far, off_triangle(work->limit, corner, enough));
  }
  return far;
}

static double off_collapsed(const SporeShellLimit *work, const SporeShell *shell, uint32_t a, uint32_t b,
                            const SporeBvhKnown *there, double enough) {
  double far = off_ring(work, shell, a, there, b, enough);
  return far > enough ? far : fmax(far, off_ring(work, shell, b, there, a, enough));
}

/* How far the triangles around a vertex are off at its present place. */
static double off_now(const SporeShellLimit *work, const SporeShell *shell, uint32_t vertex) {
  const SporeBvhKnown *here = look(work, shell, vertex, &work->last);
  double far = off_vertex(work, here);
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    double *off = &work->off[c / 3];
    SporeBvhKnown corner[3];
    for (size_t k = 0; k < 3; k++) corner[k] = *look(work, shell, shell->corner[c / 3 * 3 + k], here);
    if (*off < 0) *off = off_triangle(work->limit, corner, HUGE_VAL);
    far = fmax(far, *off);
  }
  return far;
}

bool spore_shell_limit_allows(SporeShellLimit *work, const SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x) {
  const SporeBvhKnown *here = look(work, shell, a, &work->last);
  work->last = know(work->limit, in_metres(shell, x), here);
  double most = work->limit->most, far = off_collapsed(work, shell, a, b, &work->last, most);
  if (far <= most) return true;
  double now = fmax(off_now(work, shell, a), off_now(work, shell, b));
  return now >= far && off_collapsed(work, shell, a, b, &work->last, now) <= now;
}

void spore_shell_limit_moved(const SporeShellLimit *work, const SporeShell *shell, uint32_t vertex) {
  work->vertex[vertex] = work->last;
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c]) work->off[c / 3] = -1;
}

bool spore_shell_limit_create(SporeShellLimit *work, const SporeShell *shell, const SporeSurfaceLimit *limit) {
  *work = (SporeShellLimit){.limit = limit,
                            .vertex = SPORE_NEW_ARRAY(SporeBvhKnown, shell->vertex_count),
                            .off = SPORE_NEW_ARRAY(double, shell->triangle_count)};
  for (uint32_t t = 0; work->off && t < shell->triangle_count; t++) work->off[t] = -1;
  return work->vertex && work->off;
}

void spore_shell_limit_clear(SporeShellLimit *work) {
  spore_free(work->vertex);
  spore_free(work->off);
}
