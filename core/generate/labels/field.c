/* Shares of labels at any place: voxels blurred by one voxel, interpolated between voxel centres. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/private.h"

#define BLUR 1.0 /* voxels: a smaller value leaves terraces, a larger one rounds off small parts */
#define REACH 3  /* voxels */
#define WIDTH (2 * REACH + 1)
#define GAIN 2.0 /* own label of a voxel that would lose by a margin wins by this many times the margin */
#define ALL_LABELS 65536
#define ROWS_A_REPORT 8

/* Shares of all labels around one voxel. */
typedef struct Gathering {
  double share[ALL_LABELS];
  uint16_t label[WIDTH * WIDTH * WIDTH];
  int count;
  double weight[WIDTH];
} Gathering;

static void set_inverse(SporeLabelField *field) {
  const double *a = field->map->axes;
  SporeVec3 i = {a[0], a[4], a[8]}, j = {a[1], a[5], a[9]}, k = {a[2], a[6], a[10]}, origin = {a[3], a[7], a[11]};
  double volume = spore_vec3_dot(i, spore_vec3_cross(j, k));
  const SporeVec3 rows[3] = {spore_vec3_cross(j, k), spore_vec3_cross(k, i), spore_vec3_cross(i, j)};
  for (int r = 0; r < 3; r++) {
    SporeVec3 row = spore_vec3_scale(1 / volume, rows[r]);
    field->inverse[4 * r] = row.x, field->inverse[4 * r + 1] = row.y, field->inverse[4 * r + 2] = row.z;
    field->inverse[4 * r + 3] = -spore_vec3_dot(row, origin);
  }
}

static uint16_t label_of(const SporeLabelField *field, int64_t i, int64_t j, int64_t k) {
  const size_t *n = field->map->size;
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return 0;
  uint16_t label = field->map->labels[((size_t)k * n[1] + (size_t)j) * n[0] + (size_t)i];
  return field->wanted[label] ? label : 0;
}

/* Marks the voxels of a row near a border: the voxel, or the one before or after it in the row, touches another label
 * (by a face, an edge or a corner) or lies at the rim of the map. Returns their number. */
static size_t mark_row(const SporeLabelMap *map, size_t j, size_t k, uint8_t *differs, uint8_t *near) {
  const size_t *n = map->size;
  const uint16_t *own = map->labels + (k * n[1] + j) * n[0];
  size_t count = 0;
  bool rim = j == 0 || k == 0 || j + 1 == n[1] || k + 1 == n[2];
  memset(differs, rim, n[0]);
  for (int step = 0; step < 9 && !rim; step++) {
    const uint16_t *other = map->labels + ((k + (size_t)(step / 3) - 1) * n[1] + j + (size_t)(step % 3) - 1) * n[0];
    for (size_t i = 0; i < n[0]; i++) differs[i] |= other[i] != own[i];
  }
  differs[0] = differs[n[0] - 1] = 1;
  for (size_t i = 0; i + 1 < n[0]; i++)
    if (own[i] != own[i + 1]) differs[i] = differs[i + 1] = 1;
  for (size_t i = 0; i < n[0]; i++) {
    near[i] = differs[i] || (i > 0 && differs[i - 1]) || (i + 1 < n[0] && differs[i + 1]);
    count += near[i];
  }
  return count;
}

static void gather(const SporeLabelField *field, Gathering *g, int64_t i, int64_t j, int64_t k) {
  g->count = 0;
  for (int z = 0; z < WIDTH; z++)
    for (int y = 0; y < WIDTH; y++) {
      double across = g->weight[z] * g->weight[y];
      for (int x = 0; x < WIDTH; x++) {
        uint16_t label = label_of(field, i + x - REACH, j + y - REACH, k + z - REACH);
        if (g->share[label] == 0) g->label[g->count++] = label;
        g->share[label] += across * g->weight[x];
      }
    }
}

/* Margin by which the voxel's own label wins; below 0: the label loses. */
static double margin(const Gathering *g, uint16_t own) {
  double most = 0;
  if (own == 0) return g->share[0] - 0.5;
  for (int i = 0; i < g->count; i++)
    if (g->label[i] != own && g->label[i] != 0) most = fmax(most, g->share[g->label[i]]);
  return fmin(0.5 - g->share[0], g->share[own] - most);
}

/* Keeps the largest shares, scaled to a sum of 1. Empties the gathering. */
static void keep(Gathering *g, uint16_t own, SporeLabelShare shares[SPORE_LABEL_SHARES]) {
  double lost = margin(g, own), sum = 0, back = lost < 0 ? fmin(-(1 + GAIN) * lost / (0.5 - lost), 1) : 0;
  if (g->share[own] == 0) g->label[g->count++] = own;
  for (int i = 0; i < g->count; i++) g->share[g->label[i]] *= 1 - back;
  g->share[own] += back;
  for (int s = 0; s < SPORE_LABEL_SHARES; s++) {
    uint16_t best = g->label[0];
    for (int i = 1; i < g->count; i++)
      if (g->share[g->label[i]] > g->share[best]) best = g->label[i];
    shares[s] = (SporeLabelShare){best, (float)g->share[best]};
    sum += g->share[best];
    g->share[best] = 0;
  }
  for (int s = 0; s < SPORE_LABEL_SHARES; s++) shares[s].share = (float)(shares[s].share / sum);
  for (int i = 0; i < g->count; i++) g->share[g->label[i]] = 0;
}

typedef struct Making {
  SporeLabelField *field;
  Gathering gathering;
  uint8_t *differs, *near; /* of a row */
} Making;

static void fill_row(Making *m, size_t j, size_t k, size_t at) {
  SporeLabelField *field = m->field;
  for (size_t i = 0; i < field->map->size[0]; i++) {
    if (!m->near[i]) continue;
    field->column[at] = (uint32_t)i;
    gather(field, &m->gathering, (int64_t)i, (int64_t)j, (int64_t)k);
    keep(&m->gathering, label_of(field, (int64_t)i, (int64_t)j, (int64_t)k), field->shares[at++]);
  }
}

/* One pass over the rows: to count the voxels, or with `fill` to fill in their shares. */
static bool pass_over(Making *m, bool fill, const SporeProgress *progress, SporeError *error) {
  SporeLabelField *field = m->field;
  const size_t *n = field->map->size;
  for (size_t row = 0; row < n[1] * n[2]; row++) {
    if (row % ROWS_A_REPORT == 0 && !spore_progress_step(progress, 0.5 * (fill + (double)row / (double)(n[1] * n[2])),
                                                         _("smoothing the labels"), error))
      return false;
    size_t j = row % n[1], k = row / n[1], count = mark_row(field->map, j, k, m->differs, m->near);
    if (fill) fill_row(m, j, k, field->row[row]);
    else field->row[row + 1] = field->row[row] + count;
  }
  return true;
}

static bool no_memory(SporeError *error) { return spore_generate_no_memory(error); }

static bool fill(Making *m, const SporeProgress *progress, SporeError *error) {
  SporeLabelField *field = m->field;
  const size_t *n = field->map->size;
  double sum = 0;
  for (int i = 0; i < WIDTH; i++) sum += m->gathering.weight[i] = exp(-0.5 * pow((i - REACH) / BLUR, 2));
  for (int i = 0; i < WIDTH; i++) m->gathering.weight[i] /= sum;
  field->row = SPORE_NEW_ARRAY(size_t, n[1] * n[2] + 1);
  m->differs = SPORE_NEW_ARRAY(uint8_t, n[0]);
  m->near = SPORE_NEW_ARRAY(uint8_t, n[0]);
  if (!field->row || !m->differs || !m->near) return no_memory(error);
  if (!pass_over(m, false, progress, error)) return false;
  size_t count = field->row[n[1] * n[2]];
  field->column = SPORE_NEW_ARRAY(uint32_t, count);
  field->shares = (SporeLabelShare(*)[SPORE_LABEL_SHARES])SPORE_NEW_ARRAY(SporeLabelShare, SPORE_LABEL_SHARES * count);
  return field->column && field->shares ? pass_over(m, true, progress, error) : no_memory(error);
}

bool spore_label_field_create(SporeLabelField *field, const SporeLabelMap *map, const bool *wanted,
                              const SporeProgress *progress, SporeError *error) {
  *field = (SporeLabelField){.map = map, .wanted = wanted};
  set_inverse(field);
  Making *m = SPORE_NEW_ARRAY(Making, 1);
  if (!m) return no_memory(error);
  m->field = field;
  bool done = fill(m, progress, error);
  spore_free(m->differs);
  spore_free(m->near);
  spore_free(m);
  if (!done) spore_label_field_clear(field);
  return done;
}

void spore_label_field_clear(SporeLabelField *field) {
  spore_free(field->row);
  spore_free(field->column);
  spore_free(field->shares);
  *field = (SporeLabelField){0};
}

/* The shares of a voxel; NULL: the voxel has its own label only. */
static const SporeLabelShare *find(const SporeLabelField *field, int64_t i, int64_t j, int64_t k) {
  const size_t *n = field->map->size;
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return NULL;
  size_t row = (size_t)k * n[1] + (size_t)j, low = field->row[row], high = field->row[row + 1];
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (field->column[middle] < (uint32_t)i) low = middle + 1;
    else high = middle;
  }
  return low < field->row[row + 1] && field->column[low] == (uint32_t)i ? field->shares[low] : NULL;
}

int spore_label_add(SporeLabelShare *shares, int count, SporeLabelShare one) {
  for (int s = 0; s < count; s++) {
    if (shares[s].label != one.label) continue;
    shares[s].share += one.share;
    return count;
  }
  shares[count] = one;
  return count + 1;
}

int spore_label_field_shares(const SporeLabelField *field, SporeVec3 p, SporeLabelShare shares[SPORE_LABEL_MOST]) {
  const double *m = field->inverse;
  int64_t at[3];
  double part[3];
  int count = 0;
  for (int r = 0; r < 3; r++) {
    double index = m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
    at[r] = (int64_t)floor(index);
    part[r] = index - (double)at[r];
  }
  for (int c = 0; c < 8; c++) {
    int x = c & 1, y = c >> 1 & 1, z = c >> 2;
    float weight = (float)((x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]));
    const SporeLabelShare *of = find(field, at[0] + x, at[1] + y, at[2] + z);
    if (!of)
      count =
          spore_label_add(shares, count, (SporeLabelShare){label_of(field, at[0] + x, at[1] + y, at[2] + z), weight});
    for (int s = 0; of && s < SPORE_LABEL_SHARES && of[s].share > 0; s++)
      count = spore_label_add(shares, count, (SporeLabelShare){of[s].label, weight * of[s].share});
  }
  return count;
}

uint16_t spore_label_winner(const SporeLabelShare *shares, int count) {
  uint16_t best = 0;
  double most = 0, all = 0, nothing = 0;
  for (int i = 0; i < count; i++) {
    all += (double)shares[i].share;
    if (shares[i].label == 0) nothing += (double)shares[i].share;
    else if ((double)shares[i].share > most || ((double)shares[i].share == most && shares[i].label > best))
      most = (double)shares[i].share, best = shares[i].label;
  }
  return nothing > 0.5 * all ? 0 : best;
}
