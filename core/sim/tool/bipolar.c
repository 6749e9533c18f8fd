/* Bipolar forceps: heat shrinks and stiffens tissue near their tips for good. The tissue changes no faster than `rate`
 * allows, so that its energy grows little in a step. */
#include <assert.h>

#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

typedef struct SporeBipolar {
  SporeTool tool;
  SporeBipolarFields fields;
  size_t coagulated; /* ties and elements, in the last step */
} SporeBipolar;

static bool heats(const SporeBody *body) { return body->model && body->model->type->heat; }

/* Marks the model as changed. One step changes it little, so the choice of its preconditioner stays. */
static void warm(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  SporeFactorChoice choice = world->bodies[index].preconditioner.choice;
  spore_body_changed_model(world, index);
  world->bodies[index].preconditioner.choice = choice;
}

static void use(SporeWorld *world, SporeTool *tool) {
  assert(tool->bodies[0] < world->body_count);
  SporeBipolar *bipolar = (SporeBipolar *)tool;
  const SporeBody *holder = &world->bodies[tool->bodies[0]];
  bipolar->coagulated = 0;
  if (!spore_tool_button(world, tool->bodies[0], SPORE_FIRST_BUTTON)) return;
  const double *q = world->state.q + holder->q_offset;
  SporeVec3 point = spore_pose_apply(spore_pose_load(q), tool->tip);
  const SporeBipolarFields *fields = &bipolar->fields;
  const SporeHeat heat = {point, fields->radius, fields->rate * world->solver.time_step, 1 - fields->least,
                          fields->stiffening};
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!heats(body)) continue;
    size_t count = body->model->type->heat->coagulate(body->model, world->state.q + body->q_offset, &heat);
    if (count > 0) warm(world, b);
    bipolar->coagulated += count;
    world->bodies[b].marks.coagulated += count;
  }
}

static const char *fault(const SporeWorld *world, const SporeToolDescription *from) {
  const SporeBipolarFields *fields = from->fields;
  return spore_tool_point_fault(fields->point);
}

static bool make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  SporeBipolar *bipolar = (SporeBipolar *)tool;
  bipolar->fields = *(const SporeBipolarFields *)from->fields;
  tool->tip = spore_world_to_frame(world, tool->bodies[0], spore_vec3_load(bipolar->fields.point));
  return true;
}

static void reset(SporeWorld *world, SporeTool *tool) { ((SporeBipolar *)tool)->coagulated = 0; }

static void state(const SporeTool *tool, SporeToolState *now) {
  now->coagulated = ((const SporeBipolar *)tool)->coagulated;
}

static const SporeParameter rows[] = {
    SPORE_ROW_NAME(SporeBipolarFields, tool.name, N_("Name of the tool.")),
    SPORE_ROW_BODY(SporeBipolarFields, body, tool.body, N_("Active body that the tool moves: the forceps.")),
    SPORE_ROW_DEVICE(SporeBipolarFields),
    SPORE_ROW_PLACE(SporeBipolarFields, point, N_("Where it heats, between its tips, at the start, in the scene.")),
    SPORE_ROW_REAL(SporeBipolarFields, radius, "m", 1e-6, 1, 0.003, N_("How far from its point it coagulates.")),
    SPORE_ROW_REAL(SporeBipolarFields, rate, "1/s", 0, 10, 0.5,
                   N_("Part of the tissue there that coagulates in a second.")),
    SPORE_ROW_REAL(SporeBipolarFields, least, "", 0.1, 1, 0.8,
                   N_("Part of its length that coagulated tissue keeps: 0.88 of liver heated to 60 degrees Celsius, "
                      "0.78 at 95 (Rossmann et al. 2014, Physiological Measurement 35).")),
    SPORE_ROW_REAL(SporeBipolarFields, stiffening, "", 1, 100, 7,
                   N_("Stiffness of coagulated tissue against what it was: 46 kPa instead of 6.6 were measured in "
                      "liver beside an electrode.")),
};

const SporeToolType spore_bipolar = {
    .element = "bipolar",
    .label = N_("Bipolar forceps"),
    .doc = N_("Forceps that coagulate nets and tetrahedra while the first button is down: these shrink and stiffen "
              "there, for good."),
    .parameters = SPORE_TABLE(rows, SporeBipolarFields),
    .heats = true,
    .size = sizeof(SporeBipolar),
    .make = make,
    .fault = fault,
    .reset = reset,
    .use = use,
    .state = state};
