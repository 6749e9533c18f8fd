/* Nodes, masses and rest shapes of the elements of a mesh. */
#include "models/tetrahedra/elements.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/tetrahedra/map.h"
#include "models/tetrahedra/slabs.h"

#define SLAB 480 /* tetrahedra: what is worth a thread's while, some 7 us of forces */
#define SLABS_MAXIMUM 16
#define FLAT 1e-12 /* six volumes against the longest edge cubed: below, a tetrahedron is flat */

/* Nodes. */

static double longest_edge(const SporeTetrahedralMesh *mesh, const uint32_t *corners) {
  double longest = 0;
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < a; b++)
      longest = fmax(longest, spore_vec3_distance(spore_vec3_load(mesh->vertices + 3 * (size_t)corners[a]),
                                                  spore_vec3_load(mesh->vertices + 3 * (size_t)corners[b])));
  return longest;
}

static bool refuse_element(size_t t, double volume, double edge, SporeError *error) {
  char place[64];
  snprintf(place, sizeof place, "tetrahedron %zu", t);
  return spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("its volume at rest is %g m^3 with edges up to %g m; a positive volume was expected, or it "
                           "has no stiffness to compute; generate the tetrahedra again or remove this one"),
                         volume, edge);
}

bool spore_tetrahedra_check_mesh(const SporeTetrahedralMesh *mesh, SporeError *error) {
  if (!mesh || mesh->tetrahedron_count == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("there are no tetrahedra; this model needs a tetrahedral mesh; generate one from the "
                             "surface"));
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
    if (!isfinite(mesh->vertices[i]))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("vertex %zu is not finite; every coordinate must be a number; mend the mesh"), i / 3);
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++)
    if (mesh->tetrahedra[i] >= mesh->vertex_count)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("tetrahedron %zu names vertex %u of %zu; every corner must exist; mend the mesh"), i / 4,
                             mesh->tetrahedra[i], mesh->vertex_count);
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    SporeVec3 gradient[3];
    double six_volumes = spore_tetrahedron_gradients(mesh->vertices, mesh->tetrahedra + 4 * t, gradient);
    double edge = longest_edge(mesh, mesh->tetrahedra + 4 * t);
    if (!(six_volumes > FLAT * edge * edge * edge)) return refuse_element(t, six_volumes / 6, edge, error);
  }
  return true;
}

/* The node on the middle of an edge, by bisection in the sorted edges. */
static uint32_t middle_of(const uint32_t *edges, size_t count, uint32_t a, uint32_t b) {
  assert(count > 0);
  uint64_t wanted = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
  size_t low = 0, high = count;
  while (high - low > 1) {
    size_t at = (low + high) / 2;
    if (((uint64_t)edges[2 * at] << 32 | edges[2 * at + 1]) <= wanted) low = at;
    else high = at;
  }
  return (uint32_t)low;
}

static void set_middles(SporeTetrahedronNodes *nodes, const uint32_t *edges, size_t count) {
  assert(nodes->per_element == 10);
  static const uint8_t pairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  const SporeTetrahedralMesh *mesh = &nodes->mesh;
  for (size_t e = 0; e < count; e++)
    for (size_t k = 0; k < 3; k++)
      nodes->rest[3 * (mesh->vertex_count + e) + k] =
          0.5 * (mesh->vertices[3 * (size_t)edges[2 * e] + k] + mesh->vertices[3 * (size_t)edges[2 * e + 1] + k]);
  for (size_t t = 0; t < mesh->tetrahedron_count; t++)
    for (size_t e = 0; e < 6; e++) {
      const uint32_t *corners = mesh->tetrahedra + 4 * t;
      nodes->nodes[10 * t + 4 + e] =
          (uint32_t)mesh->vertex_count + middle_of(edges, count, corners[pairs[e][0]], corners[pairs[e][1]]);
    }
}

static bool find_factors(SporeTetrahedronNodes *nodes, const SporeRegions *regions) {
  const SporeTetrahedralMesh *mesh = &nodes->mesh;
  if (!regions || regions->count == 0) return true;
  nodes->factors = SPORE_NEW_ARRAY(SporeRegionFactors, mesh->tetrahedron_count);
  for (size_t t = 0; nodes->factors && t < mesh->tetrahedron_count; t++) {
    SporeVec3 sum = {0, 0, 0};
    for (size_t k = 0; k < 4; k++)
      sum = spore_vec3_add(sum, spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->tetrahedra[4 * t + k]));
    nodes->factors[t] = spore_regions_at(regions, spore_vec3_scale(0.25, sum));
  }
  return nodes->factors != NULL;
}

bool spore_tetrahedron_nodes_create(SporeTetrahedronNodes *nodes, const SporeTetrahedralMesh *mesh, bool middles,
                                    const SporeRegions *regions) {
  assert(mesh->tetrahedron_count > 0);
  uint32_t *edges = NULL;
  size_t edge_count = 0, tetrahedra = mesh->tetrahedron_count, per = middles ? 10 : 4;
  *nodes = (SporeTetrahedronNodes){.per_element = per};
  if (!spore_tetrahedral_mesh_allocate(&nodes->mesh, mesh->vertex_count, tetrahedra, NULL)) return false;
  memcpy(nodes->mesh.vertices, mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  memcpy(nodes->mesh.tetrahedra, mesh->tetrahedra, 4 * tetrahedra * sizeof(uint32_t));
  if (middles && !spore_edges_of_tetrahedra(mesh->tetrahedra, tetrahedra, &edges, &edge_count)) return false;
  nodes->count = mesh->vertex_count + edge_count;
  nodes->rest = SPORE_NEW_ARRAY(double, 3 * nodes->count);
  nodes->nodes = SPORE_NEW_ARRAY(uint32_t, per * tetrahedra);
  bool made = nodes->rest && nodes->nodes;
  if (made) {
    memcpy(nodes->rest, mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
    for (size_t t = 0; t < tetrahedra; t++)
      memcpy(nodes->nodes + per * t, mesh->tetrahedra + 4 * t, 4 * sizeof(uint32_t));
    if (middles) set_middles(nodes, edges, edge_count);
  }
  spore_free(edges);
  return made && find_factors(nodes, regions);
}

bool spore_tetrahedron_nodes_part(SporeTetrahedronNodes *apart, const SporeTetrahedronNodes *whole) {
  size_t per = whole->per_element, elements = whole->mesh.tetrahedron_count, count = per * elements;
  *apart = (SporeTetrahedronNodes){.count = count, .per_element = per};
  if (!spore_tetrahedral_mesh_allocate(&apart->mesh, count, elements, NULL)) return false;
  apart->rest = SPORE_NEW_ARRAY(double, 3 * count);
  apart->nodes = SPORE_NEW_ARRAY(uint32_t, count);
  if (whole->factors) apart->factors = SPORE_NEW_ARRAY(SporeRegionFactors, elements);
  if (!apart->rest || !apart->nodes || (whole->factors && !apart->factors)) return false;
  if (whole->factors) memcpy(apart->factors, whole->factors, elements * sizeof *whole->factors);
  for (size_t i = 0; i < count; i++) {
    apart->nodes[i] = (uint32_t)i;
    memcpy(apart->rest + 3 * i, whole->rest + 3 * (size_t)whole->nodes[i], 3 * sizeof(double));
    if (i % per < 4) apart->mesh.tetrahedra[4 * (i / per) + i % per] = (uint32_t)i;
  }
  memcpy(apart->mesh.vertices, apart->rest, 3 * count * sizeof(double));
  return true;
}

void spore_tetrahedron_nodes_clear(SporeTetrahedronNodes *nodes) {
  spore_tetrahedral_mesh_clear(&nodes->mesh);
  spore_free(nodes->rest);
  spore_free(nodes->nodes);
  spore_free(nodes->factors);
  *nodes = (SporeTetrahedronNodes){0};
}

void spore_tetrahedron_nodes_add_mass(const SporeTetrahedronNodes *nodes, double density, double *masses) {
  assert(density > 0 && masses);
  const SporeTetrahedralMesh *mesh = &nodes->mesh;
  bool middles = nodes->per_element > 4;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    SporeVec3 gradient[3];
    double mass = density / 6 * spore_tetrahedron_gradients(mesh->vertices, mesh->tetrahedra + 4 * t, gradient) *
                  spore_tetrahedron_factors(nodes, t).density;
    for (size_t a = 0; a < nodes->per_element; a++)
      masses[nodes->nodes[nodes->per_element * t + a]] += mass * (!middles ? 0.25 : a < 4 ? 1.0 / 36 : 4.0 / 27);
  }
}

bool spore_tetrahedron_nodes_pattern(const SporeTetrahedronNodes *nodes, SporeBlockPattern *pattern) {
  size_t per = nodes->per_element;
  for (size_t t = 0; t < nodes->mesh.tetrahedron_count; t++)
    for (size_t a = 0; a < per; a++)
      for (size_t b = 0; b < a; b++)
        if (!spore_block_pattern_add(pattern, nodes->nodes[per * t + a], nodes->nodes[per * t + b])) return false;
  return true;
}

/* Lanes. */

static void set_element(SporeTetrahedra *tetrahedra, size_t at, size_t lane, const uint32_t *nodes,
                        const SporeVec3 gradient[3], double volume) {
  assert(at < tetrahedra->batch_count && lane < SPORE_LANES);
  SporeTetrahedronBatch *batch = tetrahedra->batches + at;
  for (int k = 0; k < 4; k++) batch->node[k][lane] = nodes[k];
  for (int k = 0; tetrahedra->middles && k < 6; k++) tetrahedra->middles[at].node[k][lane] = nodes[4 + k];
  for (int k = 0; k < 3; k++) {
    batch->inverse[3 * k][lane] = gradient[k].x;
    batch->inverse[3 * k + 1][lane] = gradient[k].y;
    batch->inverse[3 * k + 2][lane] = gradient[k].z;
  }
  batch->volume[lane] = volume;
}

static size_t batches_for(size_t count) { return (count + SPORE_LANES - 1) / SPORE_LANES; }

static bool allocate(SporeTetrahedra *tetrahedra, const SporeSlabs *slabs, size_t per_element) {
  tetrahedra->slab_count = slabs->count;
  tetrahedra->slab_start = SPORE_NEW_ARRAY(uint32_t, slabs->count + 1);
  if (!tetrahedra->slab_start) return false;
  for (size_t s = 0; s < slabs->count; s++)
    tetrahedra->slab_start[s + 1] =
        tetrahedra->slab_start[s] + (uint32_t)batches_for(slabs->start[s + 1] - slabs->start[s]);
  size_t batches = tetrahedra->batch_count = tetrahedra->slab_start[slabs->count];
  tetrahedra->lanes = SPORE_NEW_ARRAY(uint8_t, batches);
  tetrahedra->batches = SPORE_NEW_ARRAY(SporeTetrahedronBatch, batches);
  tetrahedra->blocks = SPORE_NEW_ARRAY(uint32_t, batches * SPORE_LANES * per_element * per_element);
  if (per_element > 4 && !(tetrahedra->middles = SPORE_NEW_ARRAY(SporeMiddleBatch, batches))) return false;
  return tetrahedra->lanes && tetrahedra->batches && tetrahedra->blocks;
}

/* Rest shape of a slab's elements. */
static void set_slab(SporeTetrahedra *tetrahedra, const SporeTetrahedronNodes *nodes, size_t slab,
                     const uint32_t *order, size_t count) {
  assert(slab < tetrahedra->slab_count);
  size_t start = tetrahedra->slab_start[slab], batches = tetrahedra->slab_start[slab + 1] - start;
  for (size_t i = 0; i < count; i++) {
    const uint32_t *of = nodes->nodes + nodes->per_element * order[i];
    SporeVec3 gradient[3];
    double volume = spore_tetrahedron_gradients(nodes->rest, of, gradient) / 6;
    size_t at = start + i % batches, lane = tetrahedra->lanes[at]++;
    set_element(tetrahedra, at, lane, of, gradient, volume * spore_tetrahedron_factors(nodes, order[i]).stiffness);
    for (size_t free = lane; lane == 0 && ++free < SPORE_LANES;) /* until others come: the same without a volume */
      set_element(tetrahedra, at, free, of, gradient, 0);
  }
}

bool spore_tetrahedra_create(SporeTetrahedra *tetrahedra, const SporeTetrahedronNodes *nodes) {
  assert(nodes->per_element == 4 || nodes->per_element == 10);
  const SporeTetrahedralMesh *mesh = &nodes->mesh;
  size_t wanted = mesh->tetrahedron_count / SLAB;
  wanted = wanted < 1 ? 1 : wanted < SLABS_MAXIMUM ? wanted : SLABS_MAXIMUM;
  SporeSlabs slabs;
  *tetrahedra = (SporeTetrahedra){0};
  if (!spore_slabs_create(&slabs, mesh->tetrahedra, mesh->tetrahedron_count, mesh->vertex_count, wanted)) return false;
  bool made = allocate(tetrahedra, &slabs, nodes->per_element);
  for (size_t s = 0; made && s < slabs.count; s++)
    set_slab(tetrahedra, nodes, s, slabs.order + slabs.start[s], slabs.start[s + 1] - slabs.start[s]);
  spore_slabs_clear(&slabs);
  return made;
}

void spore_tetrahedra_clear(SporeTetrahedra *tetrahedra) {
  spore_free(tetrahedra->slab_start);
  spore_free(tetrahedra->lanes);
  spore_free(tetrahedra->batches);
  spore_free(tetrahedra->middles);
  spore_free(tetrahedra->blocks);
  *tetrahedra = (SporeTetrahedra){0};
}

static uint32_t node_of(const SporeTetrahedra *tetrahedra, size_t batch, size_t lane, size_t a) {
  assert(batch < tetrahedra->batch_count && lane < SPORE_LANES);
  return a < 4 ? tetrahedra->batches[batch].node[a][lane] : tetrahedra->middles[batch].node[a - 4][lane];
}

void spore_tetrahedra_find_blocks(SporeTetrahedra *tetrahedra, const SporeBlockMatrix *matrix) {
  assert(matrix->block_count > 0);
  size_t per = tetrahedra->middles ? 10 : 4;
  uint32_t *place = tetrahedra->blocks;
  for (size_t n = 0; n < tetrahedra->batch_count; n++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++)
      for (size_t a = 0; a < per; a++)
        for (size_t b = 0; b < per; b++)
          *place++ = (uint32_t)spore_block_matrix_find(matrix, node_of(tetrahedra, n, lane, a),
                                                       node_of(tetrahedra, n, lane, b));
}
