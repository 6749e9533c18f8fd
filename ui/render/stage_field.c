/* Strain, stress, velocity and the shape of cells as colours of the surfaces of soft bodies. All of it is computed from
 * snapshots, on the thread that draws, and only while it is shown. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/body/cell_fields.h"
#include "core/scene/fidelity.h"
#include "core/scene/level_settings.h"
#include "core/scene/schema_fields.h"
#include "ui/render/stage_body.h"

#define MOMENT_S 1e-6 /* over which points that follow frames are moved along v */
#define GOOD_CELL_DEG 60.0
#define NAMES_SHOWN 2u /* bodies that a legend names */

const char *const spore_stage_field_names[] = {"none", "strain", "stress", "velocity", "level", "cells", NULL};

/* What is measured; the scale's end is never less than `least`, so that rounding at rest shows nothing. */
static const struct {
  const char *label;
  double least;
} fields[SPORE_FIELD_COUNT] = {
    {NULL, 0},           {N_("Largest strain (Green)"), 0.01},    {N_("Stress, von Mises (Cauchy)"), 1},
    {N_("Speed"), 1e-3}, {N_("Level of detail"), SPORE_LOD_FINE}, {N_("Least angle of the worst cell"), GOOD_CELL_DEG}};

/* Of a body, while colours are shown. */
struct SporeStageShade {
  SporeCellFields *cells; /* NULL: none */
  void *parameters;       /* that the cells have; of the model's type */
  gsize count;            /* of the surface's vertices; 0: this body cannot be coloured so */
  double *values;         /* not a number: not known there */
  gsize node_count;       /* of the faces inside */
  double *nodes;          /* NULL: not known */
};

static void free_shade(SporeStageBody *body) {
  SporeStageShade *shade = body->shade;
  if (!shade) return;
  spore_cell_fields_free(shade->cells);
  g_free(shade->parameters);
  g_free(shade->values);
  g_free(shade->nodes);
  g_clear_pointer(&body->shade, g_free);
}

void spore_stage_body_free_shade(SporeStageBody *body) { free_shade(body); }

#define RIGID_ROOM 7 /* doubles of a rigid body's configuration */

/* A soft body with a surface: physics moves it, and more than a frame. NULL: it is none. Of the model only what never
 * changes is read: the world may be stepping. */
static const SporeModel *soft_model(const SporeStage *stage, const SporeStageBody *body) {
  if (!stage->simulation || body->world_body == SPORE_NO_BODY || !body->surface_handle || body->liquid) return NULL;
  const SporeModel *model = spore_world_lod_model(stage->simulation->world, body->world_body, body->level);
  return model && (model->q_room > RIGID_ROOM || stage->options.field == SPORE_FIELD_LEVEL) ? model : NULL;
}

/* Elements. */

/* The parameters that the document gives the model, g_free; NULL: they are of another model. */
static void *find_parameters(const SporeStage *stage, const SporeStageBody *body, const SporeModel *model) {
  const SporeObject *object = spore_document_by_id(stage->document, body->object);
  const SporeObject *element = object ? spore_body_model_object(object) : NULL;
  if (!element || spore_object_type(element)->model != model->type) return NULL;
  void *parameters = g_malloc0(model->type->parameters.size);
  spore_object_fields(element, parameters);
  const SporeObject *fidelity = spore_object_child_of(object, "fidelity");
  const SporeObject *level = fidelity ? spore_object_child_of(fidelity, spore_lod_names[body->level]) : NULL;
  SporeError fault = SPORE_ERROR_INIT;
  if (level)
    spore_level_settings_apply(&model->type->parameters, spore_object_text(level, "settings"), parameters, &fault);
  return parameters;
}

/* Makes the elements of the body, or gives those that are there the parameters of now. FALSE: it has none. */
static gboolean ready_cells(const SporeStage *stage, const SporeStageBody *body, const SporeModel *model) {
  SporeStageShade *shade = body->shade;
  if (!model->type->apart) return FALSE;
  g_autofree void *parameters = find_parameters(stage, body, model);
  gboolean same =
      parameters && shade->parameters && memcmp(parameters, shade->parameters, model->type->parameters.size) == 0;
  if (!parameters || same) return shade->cells != NULL;
  if (!shade->cells) shade->cells = spore_cell_fields_new(model, parameters, NULL);
  else spore_cell_fields_retune(shade->cells, parameters, NULL);
  g_free(shade->parameters);
  shade->parameters = g_steal_pointer(&parameters);
  return shade->cells != NULL;
}

/* From nodes to the points of the surface. */
static void carry(const SporeMapping *mapping, const double *nodes, double *values) {
  for (gsize i = 0; i < mapping->point_count; i++) {
    double sum = 0;
    if (mapping->kind == SPORE_MAPPING_IDENTITY) sum = nodes[i];
    else
      for (guint32 k = mapping->row_start[i]; k < mapping->row_start[i + 1]; k++)
        sum += mapping->weight[k] * nodes[mapping->block[k]];
    values[i] = sum;
  }
}

static gboolean shade_by_cells(const SporeStage *stage, const SporeStageBody *body, const SporeModel *model,
                               const SporeSnapshot *snapshot) {
  const SporeMapping *mapping = &body->surface.mapping;
  SporeStageShade *shade = body->shade;
  if ((mapping->kind != SPORE_MAPPING_IDENTITY && mapping->kind != SPORE_MAPPING_LINEAR) ||
      !ready_cells(stage, body, model))
    return FALSE;
  gsize start = spore_world_corner_start(stage->simulation->world, body->world_body);
  gboolean splits = start != SIZE_MAX && body->level == SPORE_LOD_FINE;
  g_autofree double *cells = g_new(double, spore_cell_fields_count(shade->cells));
  spore_cell_fields_take(shade->cells, splits ? snapshot->cuts.corners + 4 * start : NULL,
                         snapshot->q + body->q_offset);
  shade->node_count = body->q_count / 3;
  shade->nodes = g_new(double, shade->node_count);
  if (stage->options.field == SPORE_FIELD_CELLS) {
    spore_cell_fields_shape(shade->cells, cells);
    spore_cell_fields_least(shade->cells, cells, shade->node_count, shade->nodes);
  } else {
    if (stage->options.field == SPORE_FIELD_STRESS) spore_cell_fields_stress(shade->cells, cells);
    else spore_cell_fields_strain(shade->cells, cells);
    spore_cell_fields_spread(shade->cells, cells, shade->node_count, shade->nodes);
  }
  carry(mapping, shade->nodes, shade->values);
  return TRUE;
}

/* Surfaces and lines. */

/* Of a tube, whose vertices are rings around the points of the axis, and then its two ends. */
static void carry_rings(const SporeStageBody *body, const double *axis, double *values) {
  gsize rings = body->tube.count, sectors = (body->surface.count - 2) / rings;
  for (gsize i = 0; i < rings * sectors; i++) values[i] = axis[i / sectors];
  values[rings * sectors] = axis[0];
  values[rings * sectors + 1] = axis[rings - 1];
}

/* Without elements: how far the surface that is drawn is stretched in its plane, or the axis of a tube along itself. */
static gboolean shade_by_surface(const SporeStageBody *body) {
  double *values = body->shade->values;
  if (body->tube.count) {
    g_autofree double *axis = g_new(double, body->tube.count);
    spore_line_strain(body->rest_axis, 4, body->axis.positions, body->tube.count, axis);
    carry_rings(body, axis, values);
    return TRUE;
  }
  if (!body->rest_surface || body->rest_count != body->surface.count) return FALSE;
  spore_surface_strain(body->rest_surface, body->surface.positions, body->surface.count, body->triangles,
                       body->triangle_count, values);
  return TRUE;
}

/* Velocities. */

static void speeds_of(const double *velocity, gsize count, double *values) {
  for (gsize i = 0; i < count; i++) values[i] = spore_vec3_length(spore_vec3_load(velocity + 3 * i));
}

/* Points that follow frames along a line: where they are a moment later. */
static void move_along(const SporeStageBody *body, const SporeModel *model, const double *v, double *velocity) {
  const SporeMapping *mapping = &body->surface.mapping;
  g_autofree double *later = g_memdup2(body->q, body->q_count * sizeof(double));
  for (gsize i = 0; i < MIN(body->q_count, 3 * model->block_room); i++) later[i] += MOMENT_S * v[i];
  spore_mapping_positions(mapping, later, velocity);
  for (gsize i = 0; i < 3 * body->surface.count; i++)
    velocity[i] = (velocity[i] - body->surface.positions[i]) / MOMENT_S;
}

static gboolean shade_by_velocity(const SporeStage *stage, const SporeStageBody *body, const SporeModel *model,
                                  const SporeSnapshot *snapshot) {
  const double *v = snapshot->v + spore_world_v_offset(stage->simulation->world, body->world_body);
  SporeStageShade *shade = body->shade;
  const SporeStagePoints *points = body->tube.count ? &body->axis : &body->surface;
  g_autofree double *velocity = g_new(double, 3 * points->count), *speeds = g_new(double, points->count);
  if (points->mapping.kind == SPORE_MAPPING_FRAMES) {
    if (model->q_room != 3 * model->block_room) return FALSE; /* only of nodes is q' = v */
    move_along(body, model, v, velocity);
  } else {
    spore_mapping_velocities(&points->mapping, body->q, v, velocity);
  }
  speeds_of(velocity, points->count, speeds);
  if (body->tube.count) carry_rings(body, speeds, shade->values);
  else memcpy(shade->values, speeds, points->count * sizeof *speeds);
  if (!body->inside_handle) return TRUE;
  shade->node_count = body->q_count / 3;
  shade->nodes = g_new(double, shade->node_count);
  speeds_of(v, shade->node_count, shade->nodes);
  return TRUE;
}

/* Levels of detail. */

static gboolean has_levels(const SporeStage *stage, const SporeStageBody *body) {
  for (int level = 0; level < SPORE_LOD_FINE && body->world_body != SPORE_NO_BODY; level++)
    if (spore_world_lod_model(stage->simulation->world, body->world_body, (SporeLodGrade)level)) return TRUE;
  return FALSE;
}

static gboolean shade_by_level(const SporeStage *stage, const SporeStageBody *body) {
  for (gsize i = 0; i < body->surface.count; i++) body->shade->values[i] = body->level;
  return has_levels(stage, body);
}

/* All bodies. */

static gboolean measure(const SporeStage *stage, SporeStageBody *body, const SporeModel *model,
                        const SporeSnapshot *snapshot) {
  switch (stage->options.field) {
  case SPORE_FIELD_STRAIN:
    return shade_by_cells(stage, body, model, snapshot) || shade_by_surface(body);
  case SPORE_FIELD_STRESS:
  case SPORE_FIELD_CELLS:
    return shade_by_cells(stage, body, model, snapshot);
  case SPORE_FIELD_LEVEL:
    return shade_by_level(stage, body);
  default:
    return shade_by_velocity(stage, body, model, snapshot);
  }
}

/* Fills the values of the body; none where it cannot be coloured. */
static void shade_body(const SporeStage *stage, SporeStageBody *body, const SporeSnapshot *snapshot) {
  const SporeModel *model = soft_model(stage, body);
  if (!model) {
    free_shade(body);
    return;
  }
  if (!body->shade) body->shade = g_new0(SporeStageShade, 1);
  SporeStageShade *shade = body->shade;
  g_clear_pointer(&shade->nodes, g_free);
  shade->values = g_renew(double, shade->values, body->surface.count);
  shade->count = measure(stage, body, model, snapshot) ? body->surface.count : 0;
}

static double largest(const double *values, gsize count, double most) {
  for (gsize i = 0; i < count; i++)
    if (values[i] > most) most = values[i];
  return most;
}

static double find_end(const SporeStage *stage) {
  double most = fields[stage->options.field].least;
  if (stage->options.field == SPORE_FIELD_LEVEL) return most;
  if (stage->options.field_end > 0) return stage->options.field_end;
  if (stage->options.field == SPORE_FIELD_CELLS) return most; /* there is a good end, whatever the state */
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (body->shade && spore_stage_shows(stage, body->object))
      most = largest(body->shade->values, body->shade->count, most);
  }
  return spore_stage_round_up(most);
}

static void colour(const SporeStage *stage, guint handle, const double *values, gsize count) {
  g_autofree float *places = values ? g_new(float, count) : NULL;
  for (gsize i = 0; places && i < count; i++)
    places[i] = isnan(values[i]) ? -1 : (float)CLAMP(values[i] / stage->field_end, 0, 1);
  spore_renderer_value_surface(stage->renderer, handle, places);
}

void spore_stage_body_recolour(const SporeStage *stage, const SporeStageBody *body) {
  const SporeStageShade *shade = body->shade;
  if (body->object == stage->painted) return;
  gboolean known = shade && shade->count > 0;
  if (body->surface_handle) colour(stage, body->surface_handle, known ? shade->values : NULL, known ? shade->count : 0);
  if (body->inside_handle)
    colour(stage, body->inside_handle, known ? shade->nodes : NULL, known ? shade->node_count : 0);
}

void spore_stage_show_field(SporeStage *stage, const SporeSnapshot *snapshot) {
  if (stage->options.field == SPORE_FIELD_NONE) return;
  for (guint i = 0; i < stage->bodies->len; i++) shade_body(stage, stage->bodies->pdata[i], snapshot);
  stage->field_end = find_end(stage);
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_recolour(stage, stage->bodies->pdata[i]);
}

void spore_stage_drop_field(SporeStage *stage) {
  stage->field_end = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = stage->bodies->pdata[i];
    if (!body->shade) continue;
    free_shade(body);
    spore_stage_body_recolour(stage, body);
  }
}

/* The legend. */

static char *figure_of(SporeStageField field, double value) {
  switch (field) {
  case SPORE_FIELD_STRAIN:
    return g_strdup_printf("%.3g %%", 100 * value);
  case SPORE_FIELD_STRESS:
    return value >= 1e6   ? g_strdup_printf("%.3g MPa", value / 1e6)
           : value >= 1e3 ? g_strdup_printf("%.3g kPa", value / 1e3)
                          : g_strdup_printf("%.3g Pa", value);
  case SPORE_FIELD_CELLS:
    return g_strdup_printf("%.3g°", value);
  default:
    return value < 1 ? g_strdup_printf("%.3g mm/s", value * 1e3) : g_strdup_printf("%.3g m/s", value);
  }
}

/* Soft bodies that are shown and have no colour, by name: the first of them, and how many more. NULL: none. */
static char *name_uncoloured(const SporeStage *stage) {
  g_autoptr(GString) names = g_string_new(NULL);
  guint count = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    const SporeObject *object = spore_document_by_id(stage->document, body->object);
    if (!object || !body->shade || body->shade->count || !spore_stage_shows(stage, body->object)) continue;
    if (count++ < NAMES_SHOWN) g_string_append_printf(names, "%s%s", count > 1 ? ", " : "", spore_object_name(object));
  }
  if (count > NAMES_SHOWN) g_string_append_printf(names, " +%u", count - NAMES_SHOWN);
  return count ? g_strdup(names->str) : NULL;
}

static gboolean any_coloured(const SporeStage *stage) {
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (body->shade && body->shade->count && spore_stage_shows(stage, body->object)) return TRUE;
  }
  return FALSE;
}

double spore_stage_field_end(const SporeStage *stage) { return any_coloured(stage) ? stage->field_end : 0; }

/* Only bodies with several levels have colours: what others are drawn in says nothing. */
static void describe_levels(const SporeStage *stage, SporeStageLegend *legend) {
  legend->end = SPORE_LOD_FINE;
  legend->low = g_strdup(_("coarse"));
  if (any_coloured(stage)) legend->high = g_strdup(_("fine"));
  else if (stage->field_end > 0) legend->without = g_strdup(_("nothing here has several levels"));
  else legend->without = g_strdup(_("known once the scene runs"));
}

gboolean spore_stage_legend(const SporeStage *stage, SporeStageLegend *legend) {
  SporeStageField field = stage->options.field;
  *legend = (SporeStageLegend){0};
  if (field == SPORE_FIELD_NONE) return FALSE;
  legend->label = g_strdup(_(fields[field].label));
  if (field == SPORE_FIELD_LEVEL) {
    describe_levels(stage, legend);
    return TRUE;
  }
  g_autofree char *without = name_uncoloured(stage);
  legend->low = g_strdup("0");
  legend->high = any_coloured(stage) ? figure_of(field, stage->field_end) : NULL;
  gboolean fixed = stage->options.field_end > 0 || field == SPORE_FIELD_CELLS;
  if (legend->high) legend->range = g_strdup(fixed ? _("fixed scale") : _("scale follows the state"));
  if (without)
    legend->without = field == SPORE_FIELD_STRESS  ? g_strdup_printf(_("no stress in its law: %s"), without)
                      : field == SPORE_FIELD_CELLS ? g_strdup_printf(_("without cells: %s"), without)
                                                   : g_strdup_printf(_("not known of: %s"), without);
  else if (!(stage->field_end > 0)) legend->without = g_strdup(_("known once the scene runs"));
  else if (!legend->high) legend->without = g_strdup(_("nothing here is soft"));
  legend->end = stage->field_end;
  return TRUE;
}

char *spore_stage_legend_text(const SporeStageLegend *legend) {
  g_autofree char *scale = legend->high ? g_strdup_printf(_("%s to %s"), legend->low, legend->high) : NULL;
  g_autofree char *range = scale && legend->range ? g_strdup_printf("%s (%s)", scale, legend->range) : NULL;
  g_autoptr(GString) keys = g_string_new(NULL);
  for (guint i = 0; i < legend->key_count; i++)
    g_string_append_printf(keys, "%s%s", i ? ", " : "", legend->keys[i].text);
  const char *first = range ? range : scale ? scale : legend->key_count ? keys->str : legend->range;
  return g_strdup_printf("%s: %s%s%s", legend->label, first ? first : "", first && legend->without ? "; " : "",
                         legend->without ? legend->without : "");
}

void spore_stage_legend_clear(SporeStageLegend *legend) {
  g_free(legend->label);
  g_free(legend->low);
  g_free(legend->high);
  g_free(legend->range);
  g_free(legend->without);
  for (guint i = 0; i < legend->key_count; i++) g_free(legend->keys[i].text);
  *legend = (SporeStageLegend){0};
}
