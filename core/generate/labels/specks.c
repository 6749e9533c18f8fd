/* Refuses maps that fall apart into specks before any long work: runs of voxels along the rows, joined to pieces. */
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/private.h"

#define SPECKS_A_CELL 10 /* more specks than this for each cell are refused, where they hold half the volume */

/* Voxels first to end - 1 of a row, which have one label. Runs of one piece have one root: `up` leads there. */
typedef struct Run {
  uint32_t first, end, up;
  uint16_t label;
} Run;

typedef struct Runs {
  const SporeLabelMap *map;
  const bool *wanted;
  Run *run;
  size_t *row; /* the first run of each row; at the end, the count */
} Runs;

/* The runs of a row, into `runs` if that is not NULL; returns their number. */
static size_t find_runs(const Runs *r, size_t row, Run *runs) {
  const size_t width = r->map->size[0];
  const uint16_t *labels = r->map->labels + row * width;
  size_t count = 0;
  for (size_t i = 0, end; i < width; i = end) {
    for (end = i + 1; end < width && labels[end] == labels[i];) end++;
    if (!r->wanted[labels[i]]) continue;
    if (runs) runs[count] = (Run){(uint32_t)i, (uint32_t)end, (uint32_t)(runs - r->run + (ptrdiff_t)count), labels[i]};
    count++;
  }
  return count;
}

static uint32_t root_of(Run *run, uint32_t at) {
  while (run[at].up != at) at = run[at].up = run[run[at].up].up;
  return at;
}

/* Joins two runs of neighbouring rows if they touch by a face, an edge or a corner. */
static void join(Run *run, size_t a, size_t b) {
  if (run[a].first > run[b].end || run[b].first > run[a].end || run[a].label != run[b].label) return;
  uint32_t first = root_of(run, (uint32_t)a), second = root_of(run, (uint32_t)b);
  run[first > second ? first : second].up = first > second ? second : first;
}

static void join_rows(Runs *r, size_t one, size_t other) {
  size_t a = r->row[one], b = r->row[other];
  while (a < r->row[one + 1] && b < r->row[other + 1]) {
    join(r->run, a, b);
    if (r->run[a].end < r->run[b].end) {
      a++;
      continue;
    }
    if (r->run[a].end == r->run[b].end && a + 1 < r->row[one + 1]) join(r->run, a + 1, b); /* by a corner */
    b++;
  }
}

/* Joins all runs. */
static bool join_runs(Runs *r, const SporeProgress *progress, SporeError *error) {
  const size_t *n = r->map->size;
  for (size_t k = 0; k < n[2]; k++) {
    if (!spore_progress_step(progress, (double)k / (double)n[2], _("looking for specks"), error)) return false;
    for (size_t j = 0; j < n[1]; j++) {
      const size_t row = k * n[1] + j;
      find_runs(r, row, r->run + r->row[row]);
      if (j > 0) join_rows(r, row, row - 1);
      for (size_t other = j > 0 ? j - 1 : 0; k > 0 && other <= j + 1 && other < n[1]; other++)
        join_rows(r, row, (k - 1) * n[1] + other);
    }
  }
  return true;
}

/* Number of pieces of fewer voxels than `least`, their voxels, and the voxels of all. False: no memory. */
static bool weigh_pieces(Runs *r, double least, size_t *count, double *voxels, double *all) {
  const size_t runs = r->row[r->map->size[1] * r->map->size[2]];
  size_t *size = SPORE_NEW_ARRAY(size_t, runs);
  for (size_t i = 0; size && i < runs; i++) size[root_of(r->run, (uint32_t)i)] += r->run[i].end - r->run[i].first;
  *count = 0, *voxels = *all = 0;
  for (size_t i = 0; size && i < runs; i++) {
    *all += (double)size[i];
    if (!size[i] || (double)size[i] >= least) continue;
    ++*count;
    *voxels += (double)size[i];
  }
  spore_free(size);
  return size != NULL;
}

static bool judge(Runs *r, size_t cells, double least, const SporeProgress *progress, SporeError *error) {
  size_t specks;
  double voxels, all;
  if (!join_runs(r, progress, error)) return false;
  if (!weigh_pieces(r, least, &specks, &voxels, &all)) return spore_generate_no_memory(error);
  if (specks <= SPECKS_A_CELL * cells || voxels < 0.5 * all) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("%zu specks, each smaller than a cell, hold %.0f %% of the organs; expected organs that "
                           "hang together; clear the specks away, leave their labels out, or ask for more or smaller "
                           "cells"),
                         specks, 100 * voxels / all);
}

bool spore_label_check_specks(const SporeLabelMap *map, const bool *wanted, size_t cells, double least,
                              const SporeProgress *progress, SporeError *error) {
  const size_t rows = map->size[1] * map->size[2];
  Runs r = {.map = map, .wanted = wanted, .row = SPORE_NEW_ARRAY(size_t, rows + 1)};
  for (size_t row = 0; r.row && row < rows; row++) r.row[row + 1] = r.row[row] + find_runs(&r, row, NULL);
  bool few = r.row && r.row[rows] <= SPECKS_A_CELL * cells; /* there are no more pieces than runs */
  if (r.row && !few) r.run = SPORE_NEW_ARRAY(Run, r.row[rows]);
  bool done = few || (r.run ? judge(&r, cells, least, progress, error) : spore_generate_no_memory(error));
  spore_free(r.run);
  spore_free(r.row);
  return done;
}
