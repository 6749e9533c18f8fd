/* Two parameters for each vertex of an open sheet, by mean value weights. */
#include "core/mesh/sheet_parameters.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/sheet_outline.h"

#define SETTLED 1e-14     /* change of a parameter in a sweep */
#define SWEEPS 2000       /* at most, */
#define SWEEPS_EACH 40    /* and as many more for each vertex along a side */
#define LOST 100          /* a change after which sweeps do not settle */
#define LEAST_EXCESS 0.05 /* by which a sweep goes further, but for one that does not at all */

typedef enum Settled { IS_SETTLED, IS_UNSETTLED, IS_CANCELLED, HAS_NO_ROOM } Settled;

static SporeVec3 vertex_at(const SporeTriangleMesh *mesh, uint32_t i) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)i);
}

/* Neighbours of each vertex and what they weigh. */
typedef struct Means {
  size_t *start; /* vertex_count + 1 */
  uint32_t *neighbour;
  double *weight;
  bool *fixed;
} Means;

/* Mean value weights of a triangle's corner c for the other two. */
static void corner_weights(const SporeTriangleMesh *mesh, const uint32_t *corners, size_t c, double weight[2]) {
  assert(c < 3);
  SporeVec3 at = vertex_at(mesh, corners[c]), side[2];
  for (size_t k = 0; k < 2; k++) side[k] = spore_vec3_sub(vertex_at(mesh, corners[(c + 1 + k) % 3]), at);
  double length[2] = {spore_vec3_length(side[0]), spore_vec3_length(side[1])};
  double area = spore_vec3_length(spore_vec3_cross(side[0], side[1]));
  double tangent = area / (length[0] * length[1] + spore_vec3_dot(side[0], side[1])); /* of half the angle */
  for (size_t k = 0; k < 2; k++) weight[k] = tangent / length[k];
}

static bool make_means(Means *means, const SporeSheetOutline *outline) {
  const SporeTriangleMesh *mesh = outline->mesh;
  size_t n = mesh->vertex_count;
  *means = (Means){SPORE_NEW_ARRAY(size_t, n + 1), SPORE_NEW_ARRAY(uint32_t, 6 * mesh->triangle_count),
                   SPORE_NEW_ARRAY(double, 6 * mesh->triangle_count), SPORE_NEW_ARRAY(bool, n)};
  if (!means->start || !means->neighbour || !means->weight || !means->fixed) return false;
  for (size_t i = 0; i < outline->count; i++) means->fixed[outline->vertex[i]] = true;
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) means->start[mesh->triangles[i]] += 2;
  for (size_t i = 0, sum = 0; i <= n; i++) sum += means->start[i], means->start[i] = sum; /* ends, and then starts */
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
    const uint32_t *corners = mesh->triangles + i / 3 * 3;
    size_t c = i % 3, place = means->start[corners[c]] -= 2;
    corner_weights(mesh, corners, c, means->weight + place);
    for (size_t k = 0; k < 2; k++) means->neighbour[place + k] = corners[(c + 1 + k) % 3];
  }
  return true;
}

/* One sweep: each vertex to the mean of its neighbours, and a little further. Returns the largest change. */
static double sweep(const Means *means, size_t vertex_count, double further, double *parameters) {
  double change = 0;
  for (size_t i = 0; i < vertex_count; i++) {
    double mean[2] = {0, 0}, sum = 0;
    if (means->fixed[i] || means->start[i] == means->start[i + 1]) continue;
    for (size_t k = means->start[i]; k < means->start[i + 1]; k++) {
      const double *there = parameters + 2 * (size_t)means->neighbour[k];
      sum += means->weight[k];
      for (size_t e = 0; e < 2; e++) mean[e] += means->weight[k] * there[e];
    }
    for (size_t e = 0; e < 2; e++) {
      double step = further * (mean[e] / sum - parameters[2 * i + e]);
      change = fmax(change, fabs(step));
      parameters[2 * i + e] += step;
    }
  }
  return change;
}

/* Whether sweeps that go so much further settle. Parameters lie between 0 and 1: a change beyond LOST never does. */
static Settled relax(const Means *means, size_t vertex_count, double further, double *parameters,
                     const SporeCancel *cancel) {
  double change = 1;
  for (size_t i = 0; i < vertex_count; i++)
    if (!means->fixed[i]) parameters[2 * i] = parameters[2 * i + 1] = 0;
  for (size_t n = 0; n < SWEEPS + SWEEPS_EACH * (size_t)sqrt((double)vertex_count) && change > SETTLED; n++) {
    if (spore_cancel_asked(cancel)) return IS_CANCELLED;
    change = sweep(means, vertex_count, further, parameters);
    if (!(change < LOST)) return IS_UNSETTLED;
  }
  return change > SETTLED ? IS_UNSETTLED : IS_SETTLED;
}

/* Successive over-relaxation, by the factor that is the best for equal weights. Mean value weights are not symmetric,
 * and may need a smaller one; that of 1 always settles, but slowly. */
static Settled settle(const Means *means, size_t vertex_count, double *parameters, const SporeCancel *cancel) {
  double excess = 2 / (1 + sin(M_PI / sqrt((double)vertex_count))) - 1;
  Settled settled = relax(means, vertex_count, 1 + excess, parameters, cancel);
  while (settled == IS_UNSETTLED && excess > 0) {
    excess = excess > LEAST_EXCESS ? 0.9 * excess : 0;
    settled = relax(means, vertex_count, 1 + excess, parameters, cancel);
  }
  return settled;
}

/* Whether every triangle has kept its side. */
static bool unfolded(const SporeTriangleMesh *mesh, const double *parameters) {
  bool positive = false, negative = false;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    const double *a = parameters + 2 * (size_t)n[0], *b = parameters + 2 * (size_t)n[1],
                 *c = parameters + 2 * (size_t)n[2];
    double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    negative = negative || !(area > 0), positive = positive || !(area < 0);
  }
  return positive != negative;
}

static Settled set_inside(const SporeSheetOutline *outline, double *parameters, const SporeCancel *cancel) {
  Means means = {0};
  Settled settled = HAS_NO_ROOM;
  if (make_means(&means, outline)) settled = settle(&means, outline->mesh->vertex_count, parameters, cancel);
  spore_free(means.start);
  spore_free(means.neighbour);
  spore_free(means.weight);
  spore_free(means.fixed);
  return settled;
}

static bool set_parameters(SporeSheetOutline *outline, const double *corners, double *parameters,
                           const SporeCancel *cancel, SporeError *error) {
  if (!spore_sheet_outline_square(outline, corners, parameters, error)) return false;
  Settled settled = set_inside(outline, parameters, cancel);
  if (settled == IS_CANCELLED) return false;
  if (settled == HAS_NO_ROOM)
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
  if (settled == IS_SETTLED && unfolded(outline->mesh, parameters)) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the sheet folds over itself and cannot be laid out flat; a spline needs triangles that all "
                           "look one way; straighten the mesh or use a mass-spring net"));
}

bool spore_sheet_parameters(const SporeTriangleMesh *mesh, const double *corners, double *parameters,
                            const SporeCancel *cancel, SporeError *error) {
  SporeSheetOutline outline;
  bool good =
      spore_sheet_outline_create(&outline, mesh, error) && set_parameters(&outline, corners, parameters, cancel, error);
  spore_sheet_outline_clear(&outline);
  return good;
}
