/* Blood on the surface of a body. The simulation knows how much each of many places on the body's collision spheres
 * is stained; a vertex shows what the places nearest to it have, as both lay at rest. On a closed surface these are
 * places on the vertex's side: the outside of a bowl is clean though blood stands in it. */
#include <math.h>
#include <string.h>

#include "ui/render/stage_body.h"

#define NEAR 4        /* places that a vertex is stained by */
#define CELLS_MOST 64 /* cells along an axis */
#define SIDE 0.5      /* cosine between a vertex's normal and the way out of a place: above, they are on one side */
#define BEYOND 8      /* cells: where none is so near on a vertex's side, places of the other side will do */

struct SporeStageStain {
  gsize vertex_count, place_count, place_start; /* start: in the stains of snapshots */
  const double *vertices;                       /* vertex_count x 3, at rest, borrowed */
  const double *places;                         /* place_count x 3, at rest; of the world */
  const float *out;                             /* place_count x 3; likewise */
  guint32 *near;                                /* vertex_count x NEAR; NULL: nothing was stained yet */
  float *share;                                 /* of each, which add up to 1 */
  float *amount;                                /* place_count, as shown */
  guint32 *twins;                               /* of each vertex that is drawn now; NULL: the vertex itself */
  guint64 shown;                                /* SporeSnapshot.stained */
  gboolean anew;                                /* the surface does not show `amount` yet */
  gboolean closed;                              /* the surface at the start */
  const guint32 *first; /* of each sphere the first of its places, of the world; NULL: a surface is stained */
};

/* Places by cells of a grid around them. */
typedef struct Cells {
  double lower[3], side;
  int count[3];
  guint32 *first, *next; /* of each cell; of each place; G_MAXUINT32: none */
} Cells;

static gsize cell_of(const Cells *cells, const int *at) {
  return ((gsize)at[2] * (gsize)cells->count[1] + (gsize)at[1]) * (gsize)cells->count[0] + (gsize)at[0];
}

static void find_cell(const Cells *cells, const double *point, int *at) {
  for (int k = 0; k < 3; k++)
    at[k] = (int)CLAMP(floor((point[k] - cells->lower[k]) / cells->side), 0, cells->count[k] - 1);
}

static Cells sort_places(const SporeStageStain *stain) {
  Cells cells = {.lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
  double upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, longest = 0;
  gsize total = 1;
  for (gsize i = 0; i < 3 * stain->place_count; i++) {
    cells.lower[i % 3] = fmin(cells.lower[i % 3], stain->places[i]);
    upper[i % 3] = fmax(upper[i % 3], stain->places[i]);
  }
  for (int k = 0; k < 3; k++) longest = fmax(longest, upper[k] - cells.lower[k]);
  cells.side = fmax(longest / CELLS_MOST, G_MINDOUBLE);
  for (int k = 0; k < 3; k++) total *= (gsize)(cells.count[k] = 1 + (int)((upper[k] - cells.lower[k]) / cells.side));
  cells.first = g_malloc(total * sizeof *cells.first);
  cells.next = g_new(guint32, stain->place_count);
  memset(cells.first, 0xff, total * sizeof *cells.first);
  for (gsize i = 0; i < stain->place_count; i++) {
    int at[3];
    find_cell(&cells, stain->places + 3 * i, at);
    guint32 *first = &cells.first[cell_of(&cells, at)];
    cells.next[i] = *first;
    *first = (guint32)i;
  }
  return cells;
}

/* The nearest places found so far, and the one behind them. */
typedef struct Nearest {
  guint count;
  guint32 place[NEAR + 1];
  double gap[NEAR + 1]; /* m */
} Nearest;

static void meet(Nearest *nearest, const double *place, guint32 index, const double *vertex) {
  double gap = spore_vec3_distance(spore_vec3_load(place), spore_vec3_load(vertex));
  guint at = nearest->count;
  if (at > NEAR && !(gap < nearest->gap[NEAR])) return;
  at = MIN(at, NEAR);
  for (; at > 0 && gap < nearest->gap[at - 1]; at--)
    nearest->gap[at] = nearest->gap[at - 1], nearest->place[at] = nearest->place[at - 1];
  nearest->gap[at] = gap;
  nearest->place[at] = index;
  nearest->count = MIN(nearest->count + 1, NEAR + 1);
}

/* The places of a cell, all of them and those on the side of the normal; normal: NULL: there are no sides. */
static void meet_cell(const SporeStageStain *stain, const Cells *cells, const int *at, const double *vertex,
                      const double *normal, Nearest *any, Nearest *beside) {
  for (guint32 i = cells->first[cell_of(cells, at)]; i != G_MAXUINT32; i = cells->next[i]) {
    const float *out = stain->out + 3 * (gsize)i;
    meet(any, stain->places + 3 * (gsize)i, i, vertex);
    if (!normal || normal[0] * (double)out[0] + normal[1] * (double)out[1] + normal[2] * (double)out[2] > SIDE)
      meet(beside, stain->places + 3 * (gsize)i, i, vertex);
  }
}

/* Looks into cells farther and farther away. */
static Nearest find_nearest(const SporeStageStain *stain, const Cells *cells, const double *vertex,
                            const double *normal) {
  Nearest any = {0}, beside = {0};
  int middle[3], at[3];
  find_cell(cells, vertex, middle);
  for (int far = 1; beside.count == 0 && far <= CELLS_MOST && !(any.count > 0 && far > BEYOND); far++)
    for (at[0] = MAX(middle[0] - far, 0); at[0] <= MIN(middle[0] + far, cells->count[0] - 1); at[0]++)
      for (at[1] = MAX(middle[1] - far, 0); at[1] <= MIN(middle[1] + far, cells->count[1] - 1); at[1]++)
        for (at[2] = MAX(middle[2] - far, 0); at[2] <= MIN(middle[2] + far, cells->count[2] - 1); at[2]++) {
          int apart = MAX(MAX(ABS(at[0] - middle[0]), ABS(at[1] - middle[1])), ABS(at[2] - middle[2]));
          if (far == 1 || apart == far) meet_cell(stain, cells, at, vertex, normal, &any, &beside);
        }
  return beside.count > 0 ? beside : any;
}

/* Shares fall to 0 toward the place that is one too many, so that none jumps from vertex to vertex. */
static void fill_shares(SporeStageStain *stain, gsize vertex, const Nearest *nearest) {
  double sum = 0, share[NEAR] = {0};
  guint count = MIN(nearest->count, NEAR);
  double end = nearest->count > NEAR ? nearest->gap[NEAR] : 2 * nearest->gap[count - 1] - nearest->gap[0];
  double reach = fmax(end - nearest->gap[0], G_MINDOUBLE);
  for (guint k = 0; k < count; k++) {
    double part = k == 0 ? 1 : fmax((end - nearest->gap[k]) / reach, 0);
    sum += share[k] = part * part;
  }
  for (guint k = 0; k < NEAR; k++) {
    stain->near[NEAR * vertex + k] = nearest->place[k < count ? k : 0];
    stain->share[NEAR * vertex + k] = (float)(share[k] / sum);
  }
}

static void find_shares(SporeStageStain *stain, const SporeStageBody *body) {
  Cells cells = sort_places(stain);
  gboolean sides = stain->closed && (body->whole_triangles || body->surface.count == stain->vertex_count);
  g_autofree double *normals = sides ? g_new(double, 3 * stain->vertex_count) : NULL;
  const guint32 *triangles = body->whole_triangles ? body->whole_triangles : body->triangles;
  if (sides)
    spore_triangle_mesh_normals(stain->vertices, stain->vertex_count, triangles,
                                body->whole_triangles ? body->whole_count : body->triangle_count, normals);
  stain->near = g_new(guint32, NEAR * stain->vertex_count);
  stain->share = g_new(float, NEAR * stain->vertex_count);
  stain->amount = g_new0(float, stain->place_count);
  for (gsize v = 0; v < stain->vertex_count; v++) {
    Nearest nearest = find_nearest(stain, &cells, stain->vertices + 3 * v, sides ? normals + 3 * v : NULL);
    fill_shares(stain, v, &nearest);
  }
  g_free(cells.first);
  g_free(cells.next);
}

static gboolean is_clean(const float *amount, gsize count) {
  for (gsize i = 0; i < count; i++)
    if (amount[i] > 0) return FALSE;
  return TRUE;
}

static float stain_of(const SporeStageStain *stain, gsize vertex) {
  gsize twin = stain->twins ? stain->twins[vertex] : vertex;
  float sum = 0;
  if (twin >= stain->vertex_count) return 0;
  for (gsize k = NEAR * twin; k < NEAR * (twin + 1); k++) sum += stain->share[k] * stain->amount[stain->near[k]];
  return sum;
}

/* Each sphere has the mean of its places. */
static void stain_spheres(SporeStage *stage, const SporeStageBody *body, const float *amount) {
  const guint32 *first = body->stain->first;
  g_autofree float *values = g_new0(float, body->centres.count);
  for (gsize s = 0; s < body->centres.count; s++) {
    for (guint32 i = first[s]; i < first[s + 1]; i++) values[s] += amount[i];
    values[s] /= (float)MAX(first[s + 1] - first[s], 1);
  }
  spore_renderer_stain_spheres(stage->renderer, body->spheres_handle, values);
}

void spore_stage_body_stain(SporeStage *stage, SporeStageBody *body, const SporeSnapshot *snapshot) {
  SporeStageStain *stain = body->stain;
  if (!stain || !(stain->first ? body->spheres_handle : body->surface_handle) || stain->shown == snapshot->stained)
    return;
  const float *amount = snapshot->stain + stain->place_start;
  gsize size = stain->place_count * sizeof *amount;
  stain->shown = snapshot->stained;
  if (stain->first) {
    stain_spheres(stage, body, amount);
    return;
  }
  if (!stain->near && is_clean(amount, stain->place_count)) return;
  if (!stain->near) find_shares(stain, body);
  if (!stain->anew && memcmp(stain->amount, amount, size) == 0) return;
  memcpy(stain->amount, amount, size);
  stain->anew = FALSE;
  g_autofree float *values = g_new(float, body->surface.count);
  for (gsize v = 0; v < body->surface.count; v++) values[v] = stain_of(stain, v);
  spore_renderer_stain_surface(stage->renderer, body->surface_handle, values);
}

void spore_stage_body_keep_stain(SporeStage *stage, SporeStageBody *body, const SporeWorld *world,
                                 const double *vertices) {
  SporeStainPlaces places = spore_world_stain_places(world, body->world_body);
  if (places.count == 0) return;
  SporeStageStain *stain = body->stain = g_new0(SporeStageStain, 1);
  stain->vertex_count = body->surface.count;
  stain->vertices = vertices;
  stain->place_count = places.count;
  stain->place_start = places.start;
  stain->places = places.rest;
  stain->out = places.out;
  stain->closed = spore_renderer_fills_surface(stage->renderer, body->surface_handle);
  stain->anew = TRUE;
}

void spore_stage_body_keep_spheres_stain(SporeStageBody *body, const SporeWorld *world) {
  SporeStainPlaces places = spore_world_stain_places(world, body->world_body);
  if (places.count == 0 || body->stain || spore_world_body_sphere_count(world, body->world_body) != body->centres.count)
    return;
  SporeStageStain *stain = body->stain = g_new0(SporeStageStain, 1);
  stain->place_count = places.count;
  stain->place_start = places.start;
  stain->first = places.first;
}

void spore_stage_body_stain_anew(SporeStageBody *body, const guint32 *twins) {
  SporeStageStain *stain = body->stain;
  if (!stain) return;
  stain->shown = 0;
  stain->anew = TRUE;
  if (!twins) return;
  g_free(stain->twins);
  stain->twins = g_memdup2(twins, body->surface.count * sizeof *twins);
}

void spore_stage_body_free_stain(SporeStageBody *body) {
  SporeStageStain *stain = body->stain;
  if (!stain) return;
  g_free(stain->near);
  g_free(stain->share);
  g_free(stain->amount);
  g_free(stain->twins);
  g_free(stain);
}
