/* Draws simulations side by side into one picture, without a window. */
#include "ui/render/panes.h"

#include "ui/render/legend.h"
#include "ui/render/stage_ports.h"

/* What draws one simulation: the renderer draws all that it holds, so that each has its own. */
typedef struct Pane {
  SporeDocument *document;
  SporeSimulation *simulation;
  SporeRenderer *renderer;
  SporeStage *stage;
  char *camera;
  SporeStageLegend reach; /* of the tint; without a label: there is none */
} Pane;

struct SporePanes {
  int width, height; /* of a pane */
  SporeClip clip;
  gboolean light, legends;
  guint left_out;  /* legends of the last picture */
  GError *no_text; /* why none can be drawn; NULL: they can, as far as is known */
  SporeOffscreen *offscreen;
  GPtrArray *row; /* of Pane */
  guint8 *pixels; /* of all panes */
};

static void free_pane(gpointer data) {
  Pane *pane = data;
  if (pane->stage) spore_stage_free(pane->stage);
  spore_renderer_free(pane->renderer);
  g_free(pane->camera);
  spore_stage_legend_clear(&pane->reach);
  g_free(pane);
}

SporePanes *spore_panes_new(int width, int height, GError **error) {
  SporeOffscreen *offscreen = spore_offscreen_new(error);
  if (!offscreen) return NULL;
  SporePanes *panes = g_new0(SporePanes, 1);
  panes->width = width, panes->height = height;
  panes->offscreen = offscreen;
  panes->row = g_ptr_array_new_with_free_func(free_pane);
  return panes;
}

void spore_panes_set_clip(SporePanes *panes, const SporeClip *clip) { panes->clip = *clip; }

void spore_panes_set_light(SporePanes *panes, gboolean light) { panes->light = light; }

void spore_panes_set_legends(SporePanes *panes, gboolean legends) { panes->legends = legends; }

void spore_panes_free(SporePanes *panes) {
  if (!panes) return;
  g_ptr_array_unref(panes->row);
  spore_offscreen_free(panes->offscreen);
  g_clear_error(&panes->no_text);
  g_free(panes->pixels);
  g_free(panes);
}

static gboolean find_camera(const SporePanes *panes, const Pane *pane, SporeCamera *camera, GError **error) {
  return spore_stage_camera(pane->stage, pane->camera, (double)panes->width / panes->height, camera, error);
}

gboolean spore_panes_add(SporePanes *panes, SporeDocument *document, SporeSimulation *simulation, const char *camera,
                         const SporeStageOptions *shown, GError **error) {
  SporeRenderer *renderer = spore_renderer_new(panes->offscreen, error);
  if (!renderer) return FALSE;
  Pane *pane = g_new0(Pane, 1);
  g_ptr_array_add(panes->row, pane);
  pane->document = document;
  pane->simulation = simulation;
  pane->renderer = renderer;
  pane->camera = g_strdup(camera);
  pane->stage = spore_stage_new(renderer, document);
  spore_stage_set_options(pane->stage, shown);
  spore_stage_rebuild(pane->stage, simulation);
  panes->pixels = g_realloc(panes->pixels, (gsize)spore_panes_width(panes) * (gsize)panes->height * 4);
  SporeCamera found;
  return find_camera(panes, pane, &found, error);
}

gboolean spore_panes_show_ports(SporePanes *panes, const char *name, GError **error) {
  for (guint i = 0; i < panes->row->len; i++) {
    Pane *pane = panes->row->pdata[i];
    g_autoptr(GArray) found = spore_stage_find_ports(pane->document, name, error);
    if (!found) return FALSE;
    g_autofree SporeStagePort *ports = g_new(SporeStagePort, found->len);
    for (guint k = 0; k < found->len; k++) ports[k] = (SporeStagePort){g_array_index(found, SporePortReach, k), TRUE};
    spore_stage_set_ports(pane->stage, ports, found->len);
    spore_stage_legend_clear(&pane->reach);
    spore_stage_reach_legend(found->len, spore_object_name(ports[0].reach.port), &pane->reach);
  }
  return TRUE;
}

char *spore_panes_legends(const SporePanes *panes, double *field_end) {
  const Pane *first = panes->row->pdata[0];
  *field_end = spore_stage_field_end(first->stage);
  return spore_stage_legends_text(first->stage);
}

int spore_panes_width(const SporePanes *panes) { return panes->width * (int)panes->row->len; }
const char *spore_panes_renderer(const SporePanes *panes) { return spore_offscreen_renderer(panes->offscreen); }

guint spore_panes_legends_left_out(const SporePanes *panes, GError **error) {
  if (!panes->no_text) return panes->left_out;
  g_propagate_error(error, g_error_copy(panes->no_text));
  return G_MAXUINT;
}

/* Not to be able to write is no reason to have no picture. */
static void draw_legends(SporePanes *panes, const Pane *pane, guint8 *pixels, gsize stride) {
  SporeStageLegend legends[SPORE_STAGE_LEGENDS];
  guint own = spore_stage_legends(pane->stage, legends), count = own;
  if (pane->reach.label) legends[count++] = pane->reach;
  guint left_out = spore_legends_draw(legends, count, panes->light, pixels, panes->width, panes->height, stride,
                                      panes->no_text ? NULL : &panes->no_text);
  if (!panes->no_text) panes->left_out += left_out;
  for (guint i = 0; i < own; i++) spore_stage_legend_clear(&legends[i]);
}

const guint8 *spore_panes_draw(SporePanes *panes, GError **error) {
  const SporeRenderOptions how = {
      .width = panes->width, .height = panes->height, .antialias = TRUE, .light = panes->light, .clip = panes->clip};
  gsize stride = (gsize)spore_panes_width(panes) * 4;
  panes->left_out = 0;
  for (guint i = 0; i < panes->row->len; i++) {
    Pane *pane = panes->row->pdata[i];
    SporeCamera camera;
    guint8 *pixels = panes->pixels + i * (gsize)panes->width * 4;
    spore_stage_update(pane->stage, spore_world_snapshot_acquire(pane->simulation->world));
    if (!find_camera(panes, pane, &camera, error) ||
        !spore_renderer_draw(pane->renderer, &camera, &how, pixels, stride, error))
      return NULL;
    if (panes->legends) draw_legends(panes, pane, pixels, stride);
  }
  return panes->pixels;
}
