/* Coarsens a fine mesh where that costs least, so that the few cells left are as near to the original as possible. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/text.h"
#include "core/generate/common/collapse.h"
#include "core/generate/common/common.h"
#include "core/mesh/common.h"

#define MOST_PASSES 100
#define NEXT_LIMIT 1.3
#define NEXT_SHARE 0.95  /* of the cells: a pass that leaves more is followed by one with a larger limit */
#define STUCK_SHARE 0.99 /* of the cells: a pass at the largest limit that leaves more is the last */
#define OUTER_COST 0.15  /* cost of an edge of the wanted length on the skin */
#define INNER_COST 0.05  /* the same inside */
#define MARGIN 3         /* degrees above `least`: the quality that is kept */

const double spore_coarsen_limits[2] = {0.02, 4};

typedef struct {
  double cost;
  uint32_t a, b;
} Edge;

static int cheaper_first(const void *a, const void *b) {
  const Edge *x = a, *y = b;
  if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
  return x->a != y->a ? (x->a < y->a ? -1 : 1) : x->b < y->b ? -1 : x->b > y->b;
}

/* Edges whose cost by length is below `limit`, cheapest first. NULL: no memory. */
static Edge *list_edges(const SporeStars *stars, const SporeSizing *sizing, double usual, double limit, size_t *count) {
  const SporeTetrahedralMesh *mesh = stars->mesh;
  uint32_t *ends;
  size_t all;
  if (!spore_edges_of_tetrahedra(mesh->tetrahedra, mesh->tetrahedron_count, &ends, &all)) return NULL;
  Edge *edges = SPORE_NEW_ARRAY(Edge, all);
  *count = 0;
  for (size_t e = 0; edges && e < all; e++) {
    SporeVec3 a = spore_mesh_vertex(mesh->vertices, ends[2 * e]),
              b = spore_mesh_vertex(mesh->vertices, ends[2 * e + 1]);
    const double middle[3] = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)};
    double share = spore_vec3_distance(a, b) / spore_sizing_at(sizing, middle);
    bool outer = stars->outer[ends[2 * e]] && stars->outer[ends[2 * e + 1]];
    double cost = (outer ? OUTER_COST : INNER_COST) * share * share * usual;
    if (cost < limit) edges[(*count)++] = (Edge){cost, ends[2 * e], ends[2 * e + 1]};
  }
  spore_free(ends);
  if (edges) qsort(edges, *count, sizeof *edges, cheaper_first);
  return edges;
}

static void drop_gone(SporeTetrahedralMesh *mesh) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    if (mesh->tetrahedra[4 * t] == UINT32_MAX) continue;
    memmove(mesh->tetrahedra + 4 * kept, mesh->tetrahedra + 4 * t, 4 * sizeof *mesh->tetrahedra);
    if (mesh->labels) mesh->labels[kept] = mesh->labels[t];
    kept++;
  }
  mesh->tetrahedron_count = kept;
}

typedef struct {
  SporeTetrahedralMesh *mesh;
  const SporeBvh *surface;
  SporeSkinPoints *points;
  const SporeSizing *sizing;
  size_t cells;
  const size_t *kept;
  double usual, limit, floor;
} Coarsening;

/* Cells of each label. NULL: no memory. */
static size_t *count_labels(const SporeTetrahedralMesh *mesh) {
  uint32_t most = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) most = mesh->labels[t] > most ? mesh->labels[t] : most;
  size_t *count = SPORE_NEW_ARRAY(size_t, (size_t)most + 1);
  for (size_t t = 0; count && t < mesh->tetrahedron_count; t++) count[mesh->labels[t]]++;
  return count;
}

/* One pass of collapses; false: no memory. */
static bool collapse_all(Coarsening *c, SporeError *error) {
  SporeStars stars = {0};
  SporeSkin skin = {0};
  SporeCollapse *collapse = SPORE_NEW(SporeCollapse);
  size_t count = 0, left = c->mesh->tetrahedron_count, *cells_of_labels = NULL;
  Edge *edges = NULL;
  bool done = (collapse && (!c->kept || (cells_of_labels = count_labels(c->mesh)))) || spore_mesh_no_memory(error);
  done = done && spore_stars_create(&stars, c->mesh, c->mesh->labels, error) &&
         spore_skin_create(&skin, c->mesh, c->points, error);
  if (done)
    *collapse = (SporeCollapse){.stars = &stars,
                                .skin = &skin,
                                .points = c->points,
                                .surface = c->surface,
                                .kept = c->kept,
                                .left = cells_of_labels,
                                .floor = c->floor,
                                .limit = c->limit};
  done = done && spore_collapse_create(collapse, error);
  if (done && !(edges = list_edges(&stars, c->sizing, c->usual, c->limit, &count))) done = spore_mesh_no_memory(error);
  for (size_t e = 0; done && e < count && left > c->cells; e++)
    if (spore_collapse_edge(collapse, edges[e].a, edges[e].b)) left -= collapse->dying_count;
  if (collapse) spore_collapse_clear(collapse);
  spore_free(collapse);
  spore_free(cells_of_labels);
  spore_free(edges);
  spore_skin_clear(&skin);
  spore_stars_clear(&stars);
  drop_gone(c->mesh);
  return done;
}

static bool better(SporeTetrahedralMesh *mesh, const SporeBvh *surface, double goal, SporeError *error) {
  SporeStars stars;
  if (!spore_stars_create(&stars, mesh, mesh->labels, error)) return false;
  spore_stars_smooth(&stars, surface, goal);
  long flipped = spore_stars_flip(&stars, mesh->labels ? &mesh->labels : NULL, goal, error);
  spore_stars_clear(&stars);
  return flipped >= 0;
}

static double largest_size(const SporeSizing *sizing) {
  double most = 0;
  for (size_t i = 0; i < sizing->count[0] * sizing->count[1] * sizing->count[2]; i++)
    most = fmax(most, sizing->size[i]);
  return most;
}

bool spore_tetrahedra_coarsen(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points,
                              const SporeSizing *sizing, size_t cells, const size_t *kept, double least,
                              const double *limits, const SporeProgress *progress, SporeError *error) {
  const double first = (double)mesh->tetrahedron_count, usual = largest_size(sizing), most = limits[1] * usual;
  Coarsening c = {mesh, surface, points, sizing, cells, kept, usual, limits[0] * usual, least + MARGIN};
  for (int pass = 0; pass < MOST_PASSES && mesh->tetrahedron_count > cells; pass++) {
    double before = (double)mesh->tetrahedron_count;
    if (!spore_progress_step(progress, log(first / before) / log(first / (double)cells), _("making the cells fewer"),
                             error))
      return false;
    if (!collapse_all(&c, error) || !better(mesh, surface, c.floor + MARGIN, error)) return false;
    if (!(c.limit < most) && (double)mesh->tetrahedron_count > STUCK_SHARE * before) break;
    if ((double)mesh->tetrahedron_count > NEXT_SHARE * before) c.limit = fmin(c.limit * NEXT_LIMIT, most);
  }
  return true;
}
