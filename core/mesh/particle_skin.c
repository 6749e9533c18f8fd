/* Surface around particles. It lies where the distance to the weighted mean of the surrounding particles, minus a
 * particle's radius, vanishes (Zhu and Bridson 2005: flat where particles lie flat). The distance is sampled on a
 * lattice, near particles only, and meshed by surface nets (Gibson 1998): a vertex in each cell that the surface
 * crosses, a square across each crossed edge. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/common.h"
#include "core/mesh/mesh.h"

/* In distances between neighbours. Every lattice point next to an inner one must have been reached by a particle:
 * REACH >= RADIUS + sqrt(3) STEP. */
#define STEP 0.5
#define RADIUS 0.55
#define REACH 1.5
#define NEAR                                                                                                           \
  0.95 /* a place without a particle within this distance is outside: the mean of two distant particles is no particle \
        */

#define KEY_BITS 21
#define KEY_HALF (1 << (KEY_BITS - 1))
#define EMPTY UINT64_MAX

typedef struct Sample {
  uint64_t key;                            /* lattice coordinates, KEY_BITS each */
  double weight, mean[3], nearness, value; /* nearness: 1 - square of (distance of the nearest particle / reach) */
  uint32_t vertex;                         /* of the cell whose lowest corner this is */
} Sample;

typedef struct Lattice {
  size_t mask, used; /* slots - 1, slots a power of two */
  Sample *samples;
  double step;
} Lattice;

static uint64_t key_of(const int64_t place[3]) {
  uint64_t key = 0;
  for (int i = 0; i < 3; i++) key = key << KEY_BITS | (uint64_t)(place[i] + KEY_HALF);
  return key;
}

static void place_of(uint64_t key, int64_t place[3]) {
  for (int i = 2; i >= 0; i--, key >>= KEY_BITS) place[i] = (int64_t)(key & ((1u << KEY_BITS) - 1)) - KEY_HALF;
}

/* The sample, or the empty slot where it belongs. */
static Sample *slot_of(const Lattice *lattice, uint64_t key) {
  size_t slot = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & lattice->mask;
  while (lattice->samples[slot].key != EMPTY && lattice->samples[slot].key != key) slot = (slot + 1) & lattice->mask;
  return &lattice->samples[slot];
}

static bool reserve(Lattice *lattice, size_t slots) {
  Lattice bigger = {slots - 1, lattice->used, SPORE_NEW_ARRAY(Sample, slots), lattice->step};
  if (!bigger.samples) return false;
  for (size_t s = 0; s < slots; s++) bigger.samples[s].key = EMPTY;
  for (size_t s = 0; lattice->samples && s <= lattice->mask; s++)
    if (lattice->samples[s].key != EMPTY) *slot_of(&bigger, lattice->samples[s].key) = lattice->samples[s];
  spore_free(lattice->samples);
  *lattice = bigger;
  return true;
}

static const Sample *neighbour(const Lattice *lattice, const Sample *sample, int x, int y, int z) {
  int64_t place[3];
  place_of(sample->key, place);
  place[0] += x, place[1] += y, place[2] += z;
  return slot_of(lattice, key_of(place));
}

static void add_particle(Lattice *lattice, const double *centre, double reach) {
  int64_t low[3], high[3], place[3];
  for (int i = 0; i < 3; i++) {
    low[i] = (int64_t)ceil((centre[i] - reach) / lattice->step);
    high[i] = (int64_t)floor((centre[i] + reach) / lattice->step);
  }
  for (place[0] = low[0]; place[0] <= high[0]; place[0]++)
    for (place[1] = low[1]; place[1] <= high[1]; place[1]++)
      for (place[2] = low[2]; place[2] <= high[2]; place[2]++) {
        double square = 0;
        for (int i = 0; i < 3; i++) square += pow((double)place[i] * lattice->step - centre[i], 2);
        double near = 1 - square / (reach * reach), weight = near * near * near;
        if (near <= 0) continue;
        uint64_t key = key_of(place);
        Sample *sample = slot_of(lattice, key);
        lattice->used += sample->key == EMPTY;
        sample->key = key;
        sample->weight += weight;
        sample->nearness = fmax(sample->nearness, near);
        for (int i = 0; i < 3; i++) sample->mean[i] += weight * centre[i];
      }
}

/* Whether the lattice has coordinates for the particle. Other particles are left out. */
static bool within(const double *centre, double step) {
  for (int i = 0; i < 3; i++)
    if (!(fabs(centre[i] / step) < KEY_HALF - 16)) return false;
  return true;
}

static void evaluate(Lattice *lattice, double spacing) {
  for (size_t s = 0; s <= lattice->mask; s++) {
    Sample *sample = &lattice->samples[s];
    if (sample->key == EMPTY) continue;
    int64_t place[3];
    place_of(sample->key, place);
    double square = 0;
    for (int i = 0; i < 3; i++) square += pow((double)place[i] * lattice->step - sample->mean[i] / sample->weight, 2);
    double nearest = REACH * spacing * sqrt(1 - sample->nearness);
    sample->value = fmax(sqrt(square) - RADIUS * spacing, nearest - NEAR * spacing);
  }
}

/* Values at the corners of the cell above a sample, x fastest; false where the surface does not cross it. */
static bool crossed(const Lattice *lattice, const Sample *sample, double value[8]) {
  int inside = 0;
  for (int c = 0; c < 8; c++) {
    const Sample *corner = neighbour(lattice, sample, c & 1, c >> 1 & 1, c >> 2);
    value[c] = corner->key == EMPTY ? lattice->step : corner->value;
    inside += value[c] < 0;
  }
  return inside > 0 && inside < 8;
}

/* Vertex of a cell: the mean of the points at which the surface crosses the cell's edges. */
static void cell_vertex(const Lattice *lattice, const Sample *sample, const double value[8], double *vertex) {
  double sum[3] = {0};
  int crossings = 0;
  for (int a = 0; a < 8; a++)
    for (int axis = 0; axis < 3; axis++) {
      int b = a | 1 << axis;
      if (b == a || (value[a] < 0) == (value[b] < 0)) continue;
      for (int i = 0; i < 3; i++) sum[i] += i == axis ? value[a] / (value[a] - value[b]) : a >> i & 1;
      crossings++;
    }
  int64_t place[3];
  place_of(sample->key, place);
  for (int i = 0; i < 3; i++) vertex[i] = lattice->step * ((double)place[i] + sum[i] / crossings);
}

static void add_square(const Lattice *lattice, const Sample *sample, int axis, SporeTriangleMesh *mesh) {
  assert(axis >= 0 && axis < 3);
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  uint32_t corner[4];
  for (int c = 0; c < 4; c++) { /* the four cells about the edge, counter-clockwise about the axis */
    int back[3] = {0};
    back[u] = c == 0 || c == 3 ? -1 : 0;
    back[v] = c < 2 ? -1 : 0;
    corner[c] = neighbour(lattice, sample, back[0], back[1], back[2])->vertex;
  }
  bool outward = sample->value < 0;
  const uint32_t split[6] = {corner[0], corner[outward ? 1 : 2], corner[outward ? 2 : 1],
                             corner[0], corner[outward ? 2 : 3], corner[outward ? 3 : 2]};
  memcpy(mesh->triangles + 3 * mesh->triangle_count, split, sizeof split);
  mesh->triangle_count += 2;
}

/* Counts when vertices or triangles are NULL, else fills. */
static void make_mesh(Lattice *lattice, SporeTriangleMesh *mesh) {
  double value[8];
  mesh->vertex_count = mesh->triangle_count = 0;
  for (size_t s = 0; s <= lattice->mask; s++) {
    Sample *sample = &lattice->samples[s];
    if (sample->key == EMPTY || !crossed(lattice, sample, value)) continue;
    if (mesh->vertices) cell_vertex(lattice, sample, value, mesh->vertices + 3 * mesh->vertex_count);
    sample->vertex = (uint32_t)mesh->vertex_count++;
  }
  for (size_t s = 0; s <= lattice->mask; s++) {
    const Sample *sample = &lattice->samples[s];
    if (sample->key == EMPTY) continue;
    for (int axis = 0; axis < 3; axis++) {
      const Sample *next = neighbour(lattice, sample, axis == 0, axis == 1, axis == 2);
      if (next->key == EMPTY || (sample->value < 0) == (next->value < 0)) continue;
      if (mesh->triangles) add_square(lattice, sample, axis, mesh);
      else mesh->triangle_count += 2;
    }
  }
}

/* Largest number of new lattice points by one particle. */
#define MOST_NEW 343

static bool lattice_init(Lattice *lattice, const double *centres, size_t count, double spacing) {
  *lattice = (Lattice){.step = STEP * spacing};
  if (!reserve(lattice, 2048)) return false;
  for (size_t p = 0; p < count; p++) {
    if (!within(centres + 3 * p, lattice->step)) continue;
    if (2 * (lattice->used + MOST_NEW) > lattice->mask && !reserve(lattice, 2 * (lattice->mask + 1))) return false;
    add_particle(lattice, centres + 3 * p, REACH * spacing);
  }
  evaluate(lattice, spacing);
  return true;
}

bool spore_particle_skin(const double *centres, size_t count, double spacing, SporeTriangleMesh *mesh,
                         SporeError *error) {
  assert(count == 0 || (spacing > 0 && centres));
  Lattice lattice;
  SporeTriangleMesh size = {0}, made = {0};
  if (count == 0) {
    *mesh = made;
    return true;
  }
  if (!lattice_init(&lattice, centres, count, spacing)) {
    spore_free(lattice.samples);
    return spore_mesh_no_memory(error);
  }
  make_mesh(&lattice, &size);
  bool done =
      size.vertex_count == 0 || spore_triangle_mesh_allocate(&made, size.vertex_count, size.triangle_count, error);
  if (done && size.vertex_count) make_mesh(&lattice, &made);
  spore_free(lattice.samples);
  if (done) *mesh = made;
  return done;
}
