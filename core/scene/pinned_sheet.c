/* Which places of a sheet stand still where a pin holds some of the sheet's control points. */
#include "core/scene/pinned_sheet.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/constraint/pin.h"
#include "core/scene/schema_fields.h"

#define MOST_SAMPLES 500 /* that are looked at together */
#define CLOSE_LOOKS 3
#define CLOSE 0.03      /* of the radius */
#define NEGLIGIBLE 1e-9 /* weight */

/* A sheet and its pin, in the world. */
typedef struct Pinned {
  const SporeModel *model;
  SporePose pose;
  SporeVec3 centre;
  double radius;
  uint8_t *held; /* one a control point */
} Pinned;

static double depth_of(const Pinned *pinned, const double *sample) {
  return pinned->radius - spore_vec3_distance(spore_pose_apply(pinned->pose, spore_vec3_load(sample)), pinned->centre);
}

/* Whether all control points that weigh on point i are held. */
static gboolean stands_still(const Pinned *pinned, const SporeMapping *mapping, gsize i) {
  for (uint32_t k = mapping->row_start[i]; k < mapping->row_start[i + 1]; k++)
    if (fabs(mapping->weight[k]) > NEGLIGIBLE && !pinned->held[mapping->block[k]]) return FALSE;
  return TRUE;
}

/* Looks at samples at a depth from `least` to `most` within the radius, evenly spread where there are many. FALSE:
 * there are none, or there is no memory. */
static gboolean look_at(const Pinned *pinned, const double *samples, gsize count, double least, double most,
                        SporePinnedSheet *measured) {
  g_autoptr(GArray) chosen = g_array_new(FALSE, FALSE, 3 * sizeof(double));
  gsize found = 0;
  for (int pass = 0; pass < 2; pass++) { /* the first counts */
    gsize stride = found / MOST_SAMPLES + 1, index = 0;
    for (gsize i = 0; i < count; i++) {
      double depth = depth_of(pinned, samples + 3 * i);
      if (!(depth >= least && depth <= most)) continue;
      if (pass == 0) found++;
      else if (index++ % stride == 0) g_array_append_vals(chosen, samples + 3 * i, 1);
    }
  }
  SporeMapping mapping;
  const double *points = (const double *)(const void *)chosen->data;
  if (chosen->len == 0) return FALSE;
  if (!pinned->model->type->map(pinned->model, points, chosen->len, NULL, &mapping, NULL)) return FALSE;
  for (gsize i = 0; i < chosen->len; i++) {
    if (stands_still(pinned, &mapping, i)) measured->still = TRUE;
    else measured->moves_m = fmax(measured->moves_m, depth_of(pinned, points + 3 * i));
  }
  spore_mapping_clear(&mapping);
  return TRUE;
}

/* First everywhere, then closely where the deepest place that moves was found. */
static gboolean measure_samples(const Pinned *pinned, const double *samples, gsize count, SporePinnedSheet *measured) {
  double farthest = 0;
  for (gsize i = 0; i < count; i++) farthest = fmax(farthest, -depth_of(pinned, samples + 3 * i));
  measured->free_m = farthest;
  double most = pinned->radius;
  if (!look_at(pinned, samples, count, 0, most, measured)) return FALSE;
  for (int i = 0; i < CLOSE_LOOKS; i++)
    look_at(pinned, samples, count, measured->moves_m, measured->moves_m + CLOSE * most, measured);
  return TRUE;
}

/* Notes the nodes that the pin holds; their number. */
static size_t hold(const SporeObject *pin, const double *nodes, size_t count, uint8_t *held) {
  SporeLinkDescription fields = {0};
  spore_object_fields(pin, &fields);
  return spore_pin_select(nodes, count, fields.point_a, fields.radius, held);
}

static void hold_by_others(SporeObject *pin, const double *nodes, size_t count, uint8_t *held) {
  SporeObject *links = spore_object_parent(pin);
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    SporeObject *other = spore_object_child(links, i);
    gboolean same = spore_object_type(other) == spore_object_type(pin) &&
                    spore_object_reference(other, "body") == spore_object_reference(pin, "body");
    if (same && other != pin) hold(other, nodes, count, held);
  }
}

/* The sheets among the models are those of control points alone that have samples and no line. */
static gboolean is_sheet(const SporeModel *model) {
  return model->type->samples && !model->type->line && spore_model_is_nodal(model);
}

gboolean spore_pinned_sheet_measure(const SporeSimulation *simulation, SporeObject *pin, SporePinnedSheet *measured) {
  SporeObject *body = spore_object_reference(pin, "body");
  guint32 index = body ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
  const SporeModel *model = index == SPORE_NO_BODY ? NULL : spore_world_body_model(simulation->world, index);
  if (!model || !is_sheet(model)) return FALSE;
  SporeLinkDescription fields = {0};
  spore_object_fields(pin, &fields);
  g_autofree uint8_t *held = g_new0(uint8_t, model->node_count);
  const double *nodes = spore_world_q(simulation->world, index);
  *measured = (SporePinnedSheet){.held = hold(pin, nodes, model->node_count, held)};
  hold_by_others(pin, nodes, model->node_count, held);
  const Pinned pinned = {model, spore_body_pose(body), fields.point_a, fields.radius, held};
  double *samples = NULL;
  size_t count, seen;
  gboolean done =
      model->type->samples(model, &samples, &count, &seen) && measure_samples(&pinned, samples, count, measured);
  spore_free(samples);
  return done;
}
