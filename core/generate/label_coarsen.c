#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/label_parts.h"
#include "core/generate/tetrahedra_improve.h"
#include "core/mesh/common.h"

#define LEAST_ANGLE 11.0 /* degrees */
#define TURNS 8          /* of moving the borders of the coarser cells, and the points after it */
#define ROUNDS 2         /* of moving, a turn */
#define NEAR 0.02        /* edges: distances beyond count more than by their squares */
#define MOST_GROWTH 0.15 /* edges: how far a border gives way for the volume */
#define LABELS 65536

/* Volume of each label's cells and area of its border. */
static bool measure(const SporeTetrahedralMesh *mesh, double *volume, double *area) {
  uint32_t *across;
  if (!spore_tetrahedral_mesh_neighbours(mesh, &across)) return false;
  for (int label = 0; label < LABELS; label++) volume[label] = area[label] = 0;
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) {
    const uint32_t *cell = mesh->tetrahedra + i / 4 * 4, label = mesh->labels[i / 4];
    SporeVec3 p[4];
    for (int k = 0; k < 4; k++) p[k] = spore_mesh_vertex(mesh->vertices, cell[k]);
    if (i % 4 == 0) volume[label] += spore_vec3_volume(p[0], p[1], p[2], p[3]) / 6;
    if (across[i] != UINT32_MAX && mesh->labels[across[i]] == label) continue;
    const uint8_t *face = spore_tetrahedron_faces[i % 4];
    area[label] += spore_vec3_length(spore_mesh_area_vector(p[face[0]], p[face[1]], p[face[2]]));
  }
  spore_free(across);
  return true;
}

typedef struct Balance {
  double volume[LABELS], area[LABELS]; /* of each label's cells, m^3; of its border, m^2 */
  double growth[LABELS], step[LABELS]; /* how far its points were moved outward, and are now, m */
} Balance;

/* Moves the points as far outward of each label as its volume lacks, within bounds. */
static void give_way(SporeLabelPoints *points, Balance *b, const double *wanted, double most) {
  for (int label = 1; label < LABELS; label++) {
    if (!(b->area[label] > 0)) continue;
    double growth = b->growth[label] + (wanted[label] - b->volume[label]) / b->area[label];
    growth = fmax(-most, fmin(most, growth));
    b->step[label] = growth - b->growth[label];
    b->growth[label] = growth;
  }
  for (size_t i = 0; i < points->points.count; i++) {
    const uint16_t *between = points->between + 2 * i; /* alike: stays */
    double way = b->step[between[0]] - b->step[between[1]];
    for (size_t k = 0; k < 3; k++) points->points.places[3 * i + k] += way * points->normal[3 * i + k];
  }
}

bool spore_label_coarsen(SporeTetrahedralMesh *mesh, SporeLabelPoints *points, size_t cells, double size,
                         const double *volumes, const SporeProgress *progress, SporeError *error) {
  const SporeSizing sizing = {.count = {1, 1, 1}, .spacing = 1, .size = &size};
  Balance *balance = SPORE_NEW(Balance);
  bool done = balance != NULL || spore_mesh_no_memory(error);
  done = done && spore_tetrahedra_coarsen(mesh, NULL, &points->points, &sizing, cells, LEAST_ANGLE, progress, error);
  for (int turn = 0; done && turn < TURNS; turn++) {
    if (turn && !(done = measure(mesh, balance->volume, balance->area) || spore_mesh_no_memory(error))) break;
    done = spore_progress(progress, 1, _("fitting the borders")) ||
           spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
    if (!done) break;
    if (turn) give_way(points, balance, volumes, MOST_GROWTH * size);
    done = spore_tetrahedra_approach(mesh, NULL, &points->points, ROUNDS, NEAR * size, LEAST_ANGLE, error);
  }
  spore_free(balance);
  return done && spore_tetrahedral_mesh_drop_unused(mesh, error);
}
