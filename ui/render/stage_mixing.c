/* Liquids that meet: water that washes blood away is pink. Each liquid has a skin of its own, whose colour runs into
 * that of the others by how much dye of each lies around a vertex. */
#include <math.h>
#include <string.h>

#include "core/scene/drawing.h"
#include "ui/render/stage_body.h"

#define REACH 3.5     /* distances between neighbours: what is farther from a vertex does not colour it */
#define CELLS_MOST 48 /* along an axis */
#define LEAST_DYE 0.02

typedef struct Box {
  double lower[3], upper[3];
} Box;

/* A particle of some liquid. */
typedef struct Drop {
  const double *centre;
  double dye; /* its volume by its opacity, but for a factor: a little blood colours much water */
  guint body; /* index in the stage */
} Drop;

/* Drops by cells of a grid, each as wide as the reach or wider. */
typedef struct Grid {
  Box box;
  double side[3];
  int count[3];
  guint32 *first, *next; /* of each cell; of each drop; G_MAXUINT32: none */
} Grid;

static gboolean flows(const SporeStageBody *body) { return body->liquid && body->surface_handle && body->shown > 0; }

static double spacing_of(const SporeStageBody *body) { return 2 * SPORE_LIQUID_SPACING * body->spheres[3]; }

static Box box_of(const SporeStageBody *body, double margin) {
  Box box = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
  for (gsize i = 0; i < 3 * body->shown; i++) {
    box.lower[i % 3] = fmin(box.lower[i % 3], body->centres.positions[i] - margin);
    box.upper[i % 3] = fmax(box.upper[i % 3], body->centres.positions[i] + margin);
  }
  return box;
}

static gboolean lies_in(const Box *box, const double *point) {
  for (int k = 0; k < 3; k++)
    if (!(point[k] >= box->lower[k] && point[k] <= box->upper[k])) return FALSE;
  return TRUE;
}

/* Adds the drops of a body that lie in the box. */
static void collect(const SporeStageBody *body, guint index, const Box *box, GArray *drops) {
  const double opacity = fmax(1 - (double)body->style.clearness, LEAST_DYE);
  const Drop drop = {.dye = pow(body->spheres[3], 3) * opacity, .body = index};
  for (gsize i = 0; i < body->shown; i++) {
    const double *centre = body->centres.positions + 3 * i;
    if (!lies_in(box, centre)) continue;
    g_array_append_val(drops, drop);
    g_array_index(drops, Drop, drops->len - 1).centre = centre;
  }
}

static void find_cell(const Grid *grid, const double *point, int *at) {
  for (int k = 0; k < 3; k++)
    at[k] = (int)CLAMP(floor((point[k] - grid->box.lower[k]) / grid->side[k]), 0, grid->count[k] - 1);
}

static guint32 *cell(const Grid *grid, const int *at) {
  return &grid->first[((gsize)at[2] * (gsize)grid->count[1] + (gsize)at[1]) * (gsize)grid->count[0] + (gsize)at[0]];
}

static Grid sort_drops(const GArray *drops, Box box, double reach) {
  Grid grid = {.box = box};
  gsize cells = 1;
  for (int k = 0; k < 3; k++) {
    double length = box.upper[k] - box.lower[k];
    grid.count[k] = (int)CLAMP(length / reach, 1, CELLS_MOST);
    grid.side[k] = length / grid.count[k];
    cells *= (gsize)grid.count[k];
  }
  grid.first = g_malloc(cells * sizeof *grid.first);
  grid.next = g_new(guint32, drops->len);
  memset(grid.first, 0xff, cells * sizeof *grid.first);
  for (guint i = 0; i < drops->len; i++) {
    int at[3];
    find_cell(&grid, g_array_index(drops, Drop, i).centre, at);
    grid.next[i] = *cell(&grid, at);
    *cell(&grid, at) = i;
  }
  return grid;
}

/* Adds to amount, of each body of the stage, what lies around the point. */
static void weigh(const Grid *grid, const GArray *drops, const double *point, double reach, double *amount) {
  int middle[3], at[3];
  find_cell(grid, point, middle);
  for (at[0] = MAX(middle[0] - 1, 0); at[0] <= MIN(middle[0] + 1, grid->count[0] - 1); at[0]++)
    for (at[1] = MAX(middle[1] - 1, 0); at[1] <= MIN(middle[1] + 1, grid->count[1] - 1); at[1]++)
      for (at[2] = MAX(middle[2] - 1, 0); at[2] <= MIN(middle[2] + 1, grid->count[2] - 1); at[2]++)
        for (guint32 i = *cell(grid, at); i != G_MAXUINT32; i = grid->next[i]) {
          const Drop *drop = &g_array_index(drops, Drop, i);
          double gap = spore_vec3_distance(spore_vec3_load(drop->centre), spore_vec3_load(point)) / reach;
          double near = 1 - gap * gap;
          if (near > 0) amount[drop->body] += drop->dye * near * near * near;
        }
}

/* The mean look of the others, by their amounts. */
static SporeMixture look_of(const SporeStage *stage, guint index, const double *amount) {
  SporeMixture mixture = {0};
  double sum = 0, colour[3] = {0}, clearness = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    if (i == index || amount[i] <= 0) continue;
    const SporeSurfaceStyle *style = &((const SporeStageBody *)stage->bodies->pdata[i])->style;
    for (int k = 0; k < 3; k++) colour[k] += amount[i] * (double)style->colour[k];
    clearness += amount[i] * (double)style->clearness;
    sum += amount[i];
  }
  for (int k = 0; k < 3 && sum > 0; k++) mixture.colour[k] = (float)(colour[k] / sum);
  if (sum > 0) mixture.clearness = (float)(clearness / sum);
  return mixture;
}

/* drops: the body's own and others near them. */
static void colour_skin(SporeStage *stage, guint index, const GArray *drops, const Box *box, double reach) {
  const SporeStageBody *body = stage->bodies->pdata[index];
  guint count = stage->bodies->len;
  Grid grid = sort_drops(drops, *box, reach);
  g_autofree float *share = g_new0(float, body->surface.count);
  g_autofree double *amount = g_new(double, count), *all = g_new0(double, count);
  for (gsize v = 0; v < body->surface.count; v++) {
    const double *vertex = body->surface.positions + 3 * v;
    double sum = 0;
    if (!lies_in(box, vertex)) continue;
    memset(amount, 0, count * sizeof *amount);
    weigh(&grid, drops, vertex, reach, amount);
    for (guint i = 0; i < count; i++) sum += amount[i], all[i] += amount[i];
    if (sum > 0) share[v] = (float)(1 - amount[index] / sum);
  }
  const SporeMixture mixture = look_of(stage, index, all);
  spore_renderer_mix_surface(stage->renderer, body->surface_handle, share, &mixture);
  g_free(grid.first);
  g_free(grid.next);
}

static void mix_body(SporeStage *stage, guint index) {
  const SporeStageBody *body = stage->bodies->pdata[index];
  double reach = REACH * spacing_of(body);
  g_autoptr(GArray) drops = g_array_new(FALSE, FALSE, sizeof(Drop));
  Box box = box_of(body, reach);
  for (guint i = 0; i < stage->bodies->len; i++)
    if (i != index && flows(stage->bodies->pdata[i])) collect(stage->bodies->pdata[i], i, &box, drops);
  if (drops->len == 0) return;
  collect(body, index, &box, drops);
  colour_skin(stage, index, drops, &box, reach);
}

void spore_stage_mix_liquids(SporeStage *stage) {
  guint liquids = 0;
  for (guint i = 0; i < stage->bodies->len; i++) liquids += flows(stage->bodies->pdata[i]);
  for (guint i = 0; i < stage->bodies->len && liquids > 1; i++)
    if (flows(stage->bodies->pdata[i])) mix_body(stage, i);
}
