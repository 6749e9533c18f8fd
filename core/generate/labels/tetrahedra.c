/* Tetrahedra of all organs of a label map: size of the lattice, fit of borders, removal of spikes, coarsening. */
#include "core/generate/labels/labels.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/generate/labels/private.h"
#include "core/mesh/common.h"

#define MOST_CELLS 2000000u
#define CELLS_A_VOLUME 12 /* in a cube of the lattice */
#define ATTEMPTS 3        /* at the wanted number of cells */
#define NEAR_ENOUGH 0.03
#define FINE 24.0 /* cells of the lattice for each wanted cell, if 5000 or fewer are wanted */
#define USUAL 5000.0
#define LEAST_FINE 2.0
#define CELL 0.12 /* volume of a cell whose edges have length 1 */
#define SPIKE_ROUNDS 3
#define TURNS 2          /* of moving the borders */
#define MOST_SPIKES 20   /* an organ of at most so many cells keeps all of them */
#define KEPT 0.9         /* of its share: what an organ keeps of the cells, where the weights differ */
#define LEAST_ANGLE 11.0 /* degrees */
#define BORDER_TURNS 8   /* of moving the borders of the coarser cells, and then the points */
#define ROUNDS 2         /* of moving, for each turn */
#define NEAR 0.02        /* edges: distances beyond count more than by their squares */
#define MOST_GROWTH 0.15 /* edges: largest shift of a border for the volume */
#define LABELS 65536

typedef struct Meshing {
  const SporeLabelTetrahedraOptions *options;
  SporeLabelField field;
  bool wanted[65536];
  double volumes[65536];     /* of the voxels of each label */
  double weights[65536];     /* cells of each label for its volume, relative to the others */
  size_t kept[65536];        /* the fewest cells of each label */
  double lower[3], upper[3]; /* of the wanted voxels */
  double volume, weighted_volume;
  double edge;
  SporeProgressShare stage; /* the current stage */
} Meshing;

/* A cell with three or four faces against one other organ (or outside) is a spike. The cell is given to that organ, so
 * that no border folds back on itself. */
static bool remove_spikes(SporeTetrahedralMesh *mesh, SporeError *error) {
  g_autofree size_t *cells = g_new0(size_t, 65536);
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) cells[mesh->labels[c]]++;
  for (int round = 0; round < SPIKE_ROUNDS; round++) {
    uint32_t *across;
    size_t kept = 0;
    if (!spore_tetrahedral_mesh_neighbours(mesh, &across)) return spore_generate_no_memory(error);
    for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
      uint32_t own = mesh->labels[c], label[4], winner = own;
      for (int k = 0; k < 4; k++) {
        uint32_t other = across[4 * c + (size_t)k];
        label[k] = other == UINT32_MAX ? 0 : mesh->labels[other];
      }
      for (int k = 0; k < 2 && cells[own] > MOST_SPIKES; k++) { /* any three of the four include one of the first two */
        int same = 0;
        for (int i = 0; i < 4; i++) same += label[i] == label[k];
        if (same >= 3 && label[k] != own) winner = label[k];
      }
      mesh->labels[c] = winner;
    }
    for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
      if (!mesh->labels[c]) continue;
      memmove(mesh->tetrahedra + 4 * kept, mesh->tetrahedra + 4 * c, 4 * sizeof *mesh->tetrahedra);
      mesh->labels[kept++] = mesh->labels[c];
    }
    mesh->tetrahedron_count = kept;
    spore_free(across);
  }
  return true;
}

/* Measures the volumes of the wanted labels, and the box in space around the wanted voxels' index box. False: no voxel
 * is wanted. */
static bool measure_map(Meshing *m, const SporeLabelMap *map) {
  size_t low[3] = {SIZE_MAX, SIZE_MAX, SIZE_MAX}, high[3] = {0, 0, 0}, index = 0;
  double voxel = spore_label_map_voxel_volume(map);
  for (size_t k = 0; k < map->size[2]; k++)
    for (size_t j = 0; j < map->size[1]; j++)
      for (size_t i = 0; i < map->size[0]; i++) {
        uint16_t label = map->labels[index++];
        if (!m->wanted[label]) continue;
        m->volumes[label] += voxel;
        m->volume += voxel;
        m->weighted_volume += m->weights[label] * voxel;
        low[0] = MIN(low[0], i), low[1] = MIN(low[1], j), low[2] = MIN(low[2], k);
        high[0] = MAX(high[0], i), high[1] = MAX(high[1], j), high[2] = MAX(high[2], k);
      }
  for (int r = 0; r < 3; r++) m->lower[r] = HUGE_VAL, m->upper[r] = -HUGE_VAL;
  for (int corner = 0; corner < 8; corner++) {
    double at[3];
    for (int r = 0; r < 3; r++) at[r] = corner >> r & 1 ? (double)high[r] + 0.5 : (double)low[r] - 0.5;
    SporeVec3 p = spore_label_map_place(map, at[0], at[1], at[2]);
    const double x[3] = {p.x, p.y, p.z};
    for (int r = 0; r < 3; r++) m->lower[r] = fmin(m->lower[r], x[r]), m->upper[r] = fmax(m->upper[r], x[r]);
  }
  return m->volume > 0;
}

/* Makes a lattice of about the wanted number of cells. */
static bool make_cells(Meshing *m, SporeTetrahedralMesh *mesh, SporeError *error) {
  SporeProgress progress = spore_progress_of_share(&m->stage);
  double wanted = (double)m->options->cells;
  wanted *= fmin(fmax(FINE * sqrt(USUAL / fmax(wanted, 1)), LEAST_FINE), FINE);
  size_t count = 0;
  m->edge = m->options->cells ? cbrt(CELLS_A_VOLUME * m->volume / wanted) : m->options->size;
  for (int attempt = 0; m->options->cells && attempt < ATTEMPTS; attempt++) {
    m->stage.share = 0.12;
    if (!spore_label_lattice(&m->field, m->lower, m->upper, m->edge, NULL, &count, &progress, error)) return false;
    m->stage.done += m->stage.share;
    if (fabs((double)count / wanted - 1) < NEAR_ENOUGH) break;
    m->edge *= cbrt(fmax((double)count, 1) / wanted);
  }
  m->stage.share = 0.12;
  if (!spore_label_lattice(&m->field, m->lower, m->upper, m->edge, mesh, &count, &progress, error)) return false;
  m->stage.done += m->stage.share;
  if (count > MOST_CELLS)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("that makes %zu cells; expected at most %u; ask for fewer or larger ones"), count,
                           MOST_CELLS);
  return remove_spikes(mesh, error) && spore_tetrahedral_mesh_drop_unused(mesh, error);
}

/* A cell that the border could not pass is given to the label that now wins the cell. Small organs keep their cells. */
static void relabel(const Meshing *m, SporeTetrahedralMesh *mesh) {
  size_t kept = 0;
  g_autofree size_t *cells = g_new0(size_t, 65536);
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) cells[mesh->labels[c]]++;
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
    const uint32_t *cell = mesh->tetrahedra + 4 * c;
    SporeVec3 corner[4];
    for (int k = 0; k < 4; k++) corner[k] = spore_mesh_vertex(mesh->vertices, cell[k]);
    uint32_t own = mesh->labels[c], label = spore_label_of_cell(&m->field, corner);
    if (cells[own] <= MOST_SPIKES) label = own;
    cells[own] -= label != own;
    if (!label) continue;
    memmove(mesh->tetrahedra + 4 * kept, cell, 4 * sizeof *cell);
    mesh->labels[kept++] = label;
  }
  mesh->tetrahedron_count = kept;
}

/* What each label keeps of the cells where the weights differ: nearly its share. Where they are alike, the borders say
 * where cells are needed: a thin layer needs more than its volume. */
static void share_cells(Meshing *m) {
  double least = HUGE_VAL, most = 0;
  for (size_t i = 0; i < LABELS; i++)
    if (m->volumes[i] > 0) least = fmin(least, m->weights[i]), most = fmax(most, m->weights[i]);
  for (size_t i = 0; i < LABELS && least < most; i++)
    m->kept[i] = (size_t)(KEPT * (double)m->options->cells * m->weights[i] * m->volumes[i] / m->weighted_volume);
}

/* Moves the borders to their places. points: filled if the mesh is to be coarsened. */
static bool fit(Meshing *m, SporeTetrahedralMesh *mesh, SporeLabelPoints *points, SporeError *error) {
  for (int turn = 0; turn < TURNS; turn++) {
    SporeProgress progress = spore_progress_of_share(&m->stage);
    m->stage.share = 0.1;
    if (turn) {
      relabel(m, mesh);
      if (!remove_spikes(mesh, error) || !spore_tetrahedral_mesh_drop_unused(mesh, error)) return false;
    }
    bool wanted = turn + 1 == TURNS && m->options->cells;
    if (!spore_label_fit(&m->field, mesh, m->edge, m->volumes, wanted ? points : NULL, &progress, error)) return false;
    m->stage.done += m->stage.share;
  }
  return true;
}

static void measure_label(const SporeTetrahedralMesh *mesh, SporeLabelFigures *figures) {
  g_autofree guint32 *cells = g_new(guint32, 4 * mesh->tetrahedron_count);
  for (size_t c = 0; c < mesh->tetrahedron_count; c++)
    if (mesh->labels[c] == figures->label) memcpy(cells + 4 * figures->cells++, mesh->tetrahedra + 4 * c, 16);
  SporeTetrahedralMesh part = {.vertex_count = mesh->vertex_count,
                               .tetrahedron_count = figures->cells,
                               .vertices = mesh->vertices,
                               .tetrahedra = cells};
  SporeTetrahedraQuality quality = {0};
  if (figures->cells) spore_tetrahedral_mesh_quality(&part, &quality);
  figures->volume = quality.volume;
  figures->min_dihedral_deg = quality.min_dihedral_deg;
}

static bool measure(const Meshing *m, const SporeTetrahedralMesh *mesh, SporeLabelTetrahedraReport *report,
                    SporeError *error) {
  g_autoptr(GArray) labels = NULL, voxels = NULL;
  uint32_t *across;
  if (!spore_tetrahedral_mesh_neighbours(mesh, &across)) return spore_generate_no_memory(error);
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++)
    report->shared_faces += across[i] != UINT32_MAX && mesh->labels[i / 4] < mesh->labels[across[i]];
  spore_free(across);
  spore_tetrahedral_mesh_quality(mesh, &report->quality);
  spore_label_map_list(m->field.map, &labels, &voxels);
  report->labels = g_array_new(FALSE, FALSE, sizeof(SporeLabelFigures));
  for (guint i = 0; i < labels->len; i++) {
    guint16 label = g_array_index(labels, guint16, i);
    if (!m->wanted[label]) continue;
    SporeLabelFigures figures = {.label = label,
                                 .voxel_volume = (double)g_array_index(voxels, guint64, i) *
                                                 spore_label_map_voxel_volume(m->field.map)};
    measure_label(mesh, &figures);
    g_array_append_val(report->labels, figures);
  }
  report->edge = m->edge;
  return true;
}

static bool check(Meshing *m, const SporeLabelMap *map, const SporeProgress *progress, SporeError *error) {
  const SporeLabelTetrahedraOptions *options = m->options;
  if (!options->cells && !(options->size > 0 && isfinite(options->size)))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the cells' size is %g m; expected a length above 0, or a number of cells; give one of "
                             "them"),
                           options->size);
  for (guint label = 1; label < 65536; label++) m->wanted[label] = options->label_count == 0;
  for (size_t i = 0; i < LABELS; i++) m->weights[i] = 1;
  for (size_t i = 0; i < options->label_count; i++) {
    m->wanted[options->labels[i]] = options->labels[i] > 0;
    if (options->weights) m->weights[options->labels[i]] = options->weights[i];
  }
  if (!measure_map(m, map))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("no voxel has a label that is wanted; expected some; give labels that there are"));
  double cells = options->cells ? (double)options->cells : CELLS_A_VOLUME * m->volume / pow(options->size, 3);
  if (cells > MOST_CELLS)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("that makes about %.0f cells; expected at most %u; ask for fewer or larger ones"), cells,
                           MOST_CELLS);
  double voxels = m->volume / spore_label_map_voxel_volume(map);
  return spore_label_check_specks(map, m->wanted, (size_t)ceil(cells), voxels / fmax(cells, 1), progress, error);
}

gboolean spore_label_tetrahedra(const char *place, const SporeLabelMap *map, const SporeLabelTetrahedraOptions *options,
                                SporeTetrahedralMesh *result, SporeLabelTetrahedraReport *report,
                                const SporeProgress *progress, GError **error) {
  g_autofree Meshing *m = g_new0(Meshing, 1);
  SporeError failure = SPORE_ERROR_INIT;
  guint64 started = spore_clock_ns();
  *result = (SporeTetrahedralMesh){0};
  *report = (SporeLabelTetrahedraReport){0};
  m->options = options;
  m->stage.whole = progress;
  m->stage.share = 0.02;
  SporeProgress part = spore_progress_of_share(&m->stage);
  bool done = check(m, map, &part, &failure);
  m->stage.done = m->stage.share, m->stage.share = 0.1;
  part = spore_progress_of_share(&m->stage);
  done = done && spore_label_field_create(&m->field, map, m->wanted, &part, &failure);
  m->stage.done += m->stage.share;
  done = done && make_cells(m, result, &failure);
  if (done && !result->tetrahedron_count)
    done = spore_error_set(&failure, SPORE_ERROR_INPUT, NULL,
                           _("the organs are finer than the cells: there is not one; expected larger organs; ask for "
                             "more or smaller cells"));
  SporeLabelPoints points = {0};
  done = done && fit(m, result, &points, &failure);
  part = spore_progress_of_share(&m->stage);
  m->stage.share = 1 - m->stage.done;
  share_cells(m);
  done = done &&
         (!options->cells ||
          spore_label_coarsen(result, &points, options->cells, cbrt(m->volume / (CELL * (double)options->cells)),
                              m->kept, m->volumes, &part, &failure)) &&
         spore_tetrahedral_mesh_validate(result, &failure) && measure(m, result, report, &failure);
  spore_label_points_clear(&points);
  spore_label_field_clear(&m->field);
  report->seconds = 1e-9 * (double)(spore_clock_ns() - started);
  if (done) return TRUE;
  spore_tetrahedral_mesh_clear(result);
  g_clear_pointer(&report->labels, g_array_unref);
  spore_error_at(&failure, place);
  return spore_error_propagate(&failure, error);
}

/* Coarsening that keeps the borders where the map has them. */

/* Volume of each label's cells and area of its border. */
static bool measure_borders(const SporeTetrahedralMesh *mesh, double *volume, double *area) {
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
  double growth[LABELS], step[LABELS]; /* outward shift of the label's points: total, and in this turn, m */
} Balance;

/* Moves the points outward of each label by its missing volume over the area of its border, within bounds. */
static void give_way(SporeLabelPoints *points, Balance *b, const double *wanted, double most) {
  for (int label = 1; label < LABELS; label++) {
    if (!(b->area[label] > 0)) continue;
    double growth = b->growth[label] + (wanted[label] - b->volume[label]) / b->area[label];
    growth = fmax(-most, fmin(most, growth));
    b->step[label] = growth - b->growth[label];
    b->growth[label] = growth;
  }
  for (size_t i = 0; i < points->points.count; i++) {
    const uint16_t *between = points->between + 2 * i; /* equal labels: the point stays */
    double way = b->step[between[0]] - b->step[between[1]];
    for (size_t k = 0; k < 3; k++) points->points.places[3 * i + k] += way * points->normal[3 * i + k];
  }
}

bool spore_label_coarsen(SporeTetrahedralMesh *mesh, SporeLabelPoints *points, size_t cells, double size,
                         const size_t *kept, const double *volumes, const SporeProgress *progress, SporeError *error) {
  const SporeSizing sizing = {.count = {1, 1, 1}, .spacing = 1, .size = &size};
  Balance *balance = SPORE_NEW(Balance);
  bool done = balance != NULL || spore_mesh_no_memory(error);
  done = done && spore_tetrahedra_coarsen(mesh, NULL, &points->points, &sizing, cells, kept, LEAST_ANGLE,
                                          spore_coarsen_limits, progress, error);
  for (int turn = 0; done && turn < BORDER_TURNS; turn++) {
    if (turn && !(done = measure_borders(mesh, balance->volume, balance->area) || spore_mesh_no_memory(error))) break;
    done = spore_progress_step(progress, 1, _("fitting the borders"), error);
    if (!done) break;
    if (turn) give_way(points, balance, volumes, MOST_GROWTH * size);
    done = spore_tetrahedra_approach(mesh, NULL, &points->points, ROUNDS, NEAR * size, LEAST_ANGLE, error);
  }
  spore_free(balance);
  return done && spore_tetrahedral_mesh_drop_unused(mesh, error);
}
