#include "core/linalg/block_band.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/block_band_kernels.h"

#define NONE UINT32_MAX

static uint32_t place_of(const uint32_t *place, uint32_t i) { return place ? place[i] : i; }

/* The half-bandwidth of the pattern when place[i] is where block i stands; NULL: in its own order. */
static size_t width_of(const SporeBlockMatrix *pattern, const uint32_t *place) {
  size_t width = 0;
  for (size_t i = 0; i < pattern->block_count; i++)
    for (uint32_t k = pattern->row_start[i]; k < pattern->row_start[i + 1]; k++) {
      uint32_t a = place_of(place, (uint32_t)i), b = place_of(place, pattern->column[k]);
      size_t apart = a > b ? a - b : b - a;
      if (apart > width) width = apart;
    }
  return width;
}

static uint32_t degree_of(const SporeBlockMatrix *pattern, uint32_t i) {
  return pattern->row_start[i + 1] - pattern->row_start[i];
}

/* Goes through what hangs together with `root`, nearest first, and of a block's neighbours those of least degree first.
 * sequence: from `start` on; mark: to be `stamp` where it has been. Returns the end of the sequence. */
static size_t walk(const SporeBlockMatrix *pattern, uint32_t root, uint32_t *sequence, size_t start, uint32_t *mark,
                   uint32_t stamp) {
  assert(root < pattern->block_count && start < pattern->block_count);
  assert(mark[root] != stamp);
  size_t end = start;
  sequence[end++] = root;
  mark[root] = stamp;
  for (size_t head = start; head < end; head++) {
    uint32_t i = sequence[head];
    size_t first = end;
    for (uint32_t k = pattern->row_start[i]; k < pattern->row_start[i + 1]; k++) {
      uint32_t next = pattern->column[k];
      if (mark[next] == stamp) continue;
      mark[next] = stamp;
      size_t at = end++;
      for (; at > first && degree_of(pattern, sequence[at - 1]) > degree_of(pattern, next); at--)
        sequence[at] = sequence[at - 1];
      sequence[at] = next;
    }
  }
  return end;
}

/* Cuthill and McKee's order: each part from a block that is far from others, found by walking twice. What reversing it
 * spares a sparse factor is nothing to a band. */
static bool order_by_distance(const SporeBlockMatrix *pattern, uint32_t *place) {
  size_t n = pattern->block_count, end = 0;
  uint32_t *sequence = SPORE_NEW_ARRAY(uint32_t, n), *mark = SPORE_NEW_ARRAY(uint32_t, n);
  for (uint32_t i = 0; sequence && mark && i < n; i++) {
    if (mark[i] > 0) continue;
    size_t start = end;
    end = walk(pattern, i, sequence, start, mark, 1);
    walk(pattern, sequence[end - 1], sequence, start, mark, 2);
    walk(pattern, sequence[end - 1], sequence, start, mark, 3);
  }
  for (size_t i = 0; sequence && i < n; i++) place[sequence[i]] = (uint32_t)i;
  bool made = sequence && mark;
  spore_free(sequence);
  spore_free(mark);
  return made;
}

/* Where the column that stands at `at` is eliminated. */
static size_t column_of(const SporeBlockBand *band, size_t at) {
  assert(at < band->block_count);
  if (at < band->top) return at;
  if (at < band->block_count - band->bottom) return at + band->bottom;
  return band->top + (band->block_count - 1 - at);
}

static void fill_in(SporeBlockBand *band, const SporeBlockMatrix *pattern, const uint32_t *place) {
  size_t n = band->block_count, width = band->width;
  for (uint32_t i = 0; i < n; i++) band->order[column_of(band, place_of(place, i))] = i;
  for (size_t e = 0; e < n * (width + 1); e++) band->entries[e] = (SporeBandEntry){NONE, band->order[e / (width + 1)]};
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = pattern->row_start[i]; k < pattern->row_start[i + 1]; k++) {
      uint32_t row = pattern->column[k];
      uint32_t a = place_of(place, i), b = place_of(place, row);
      size_t column = column_of(band, a);
      if (column_of(band, b) < column) continue;
      size_t apart = b > a ? b - a : a - b;
      band->entries[column * (width + 1) + apart] = (SporeBandEntry){k, row};
    }
}

/* In arrays that are there. */
static void lay_out(SporeBlockBand *band, const SporeBlockMatrix *pattern, const uint32_t *place) {
  assert(pattern->block_count > 0 && pattern->block_count <= band->block_room);
  assert(band->width >= 1 && band->width <= SPORE_BAND_WIDEST);
  size_t n = pattern->block_count, width = band->width, between = width < n ? width : n;
  band->block_count = n;
  band->top = (n - between + 1) / 2;
  band->bottom = n - between - band->top;
  fill_in(band, pattern, place);
  double side = 3 * (double)(width + 1);
  band->factor_flops = 3 * side * side * (double)n;
  band->solve_flops = 4 * 3 * side * (double)n;
}

static bool build(SporeBlockBand *band, const SporeBlockMatrix *pattern, const uint32_t *place) {
  assert(pattern->block_room >= pattern->block_count);
  size_t room = pattern->block_room, width = band->width;
  band->block_room = room;
  band->order = SPORE_NEW_ARRAY(uint32_t, room);
  band->entries = SPORE_NEW_ARRAY(SporeBandEntry, room * (width + 1));
  band->values = SPORE_NEW_ARRAY(double, 12 * room * (width + 1));
  band->work = SPORE_NEW_ARRAY(double, 4 * room);
  if (!band->order || !band->entries || !band->values || !band->work) return false;
  lay_out(band, pattern, place);
  return true;
}

bool spore_block_band_lay_out(SporeBlockBand *band, const SporeBlockMatrix *pattern) {
  bool fits = pattern->block_count <= band->block_room && width_of(pattern, NULL) == band->width;
  band->block_count = 0;
  if (fits) lay_out(band, pattern, NULL);
  return fits;
}

bool spore_block_band_create(SporeBlockBand *band, const SporeBlockMatrix *pattern) {
  size_t n = pattern->block_count, most = (2 * SPORE_BAND_WIDEST + 1) * n;
  *band = (SporeBlockBand){0};
  if (n == 0 || pattern->row_start[n] > most) return true;
  uint32_t *place = SPORE_NEW_ARRAY(uint32_t, n);
  bool made = place;
  for (uint32_t i = 0; made && i < n; i++) place[i] = i;
  if (made && width_of(pattern, place) > SPORE_BAND_WIDEST) made = order_by_distance(pattern, place);
  size_t width = made ? width_of(pattern, place) : 0;
  band->width = width > 0 ? width : 1;
  if (made && width <= SPORE_BAND_WIDEST) made = build(band, pattern, place);
  spore_free(place);
  if (!made || width > SPORE_BAND_WIDEST) spore_block_band_clear(band);
  return made;
}

void spore_block_band_clear(SporeBlockBand *band) {
  void *arrays[] = {band->order, band->entries, band->values, band->work};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  *band = (SporeBlockBand){0};
}

bool spore_block_band_factorise(SporeBlockBand *band, const SporeBlockMatrix *matrix, const double *diagonal,
                                const uint8_t *held) {
  assert(band->block_count > 0 && band->block_count == matrix->block_count);
  return SPORE_KERNEL(spore_band_factorise)(band, matrix, diagonal, held);
}

void spore_block_band_solve(SporeBlockBand *band, const double *b, double *x) {
  assert(band->block_count > 0);
  assert(b && x);
  SPORE_KERNEL(spore_band_solve)(band, b, x);
}
