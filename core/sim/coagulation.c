/* Bipolar forceps: heat shrinks tissue near their tips, for good. */
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define REAL(field, unit_text, least_value, most, start, text)                                                         \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REAL, .unit = unit_text, .minimum = least_value, .maximum = most,                    \
    .initial = {start}, .offset = offsetof(SporeBipolarFields, field), .change = SPORE_CHANGE_REBUILD, .doc = text     \
  }

static const SporeParameter parameters[] = {
    REAL(radius, "m", 1e-6, 1, 0.003, N_("How far from its point it coagulates.")),
    REAL(rate, "1/s", 0, 1000, 0.5, N_("Part of its length that tissue there loses in a second.")),
    REAL(least, "", 0.1, 1, 0.6, N_("Part of its length that coagulated tissue keeps.")),
};
const SporeParameterTable spore_bipolar_parameters = {parameters, sizeof parameters / sizeof *parameters,
                                                      sizeof(SporeBipolarFields)};

void spore_bipolar_use(SporeWorld *world, SporeTool *tool) {
  const SporeBody *holder = &world->bodies[tool->body];
  tool->shrunk = 0;
  if (!holder->has_input || !(holder->input.buttons & 1u)) return;
  const double *q = world->q + holder->q_offset;
  SporeVec3 point = spore_pose_apply((SporePose){spore_vec3_load(q), spore_quat_load(q + 3)}, tool->point);
  double factor = exp(-tool->bipolar.rate * world->solver.time_step);
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!body->model || !body->model->type->shrink) continue;
    size_t count = body->model->type->shrink(body->model, world->q + body->q_offset, point, tool->bipolar.radius,
                                             factor, tool->bipolar.least);
    if (count > 0) spore_body_changed_model(world, b);
    tool->shrunk += count;
  }
}
