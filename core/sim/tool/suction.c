/* Suction: removes particles of fluids that come into its mouth. */
#include <assert.h>

#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

typedef struct SporeSuction {
  SporeTool tool;
  SporeSuctionFields fields;
  double due;   /* particles that may be taken away by now */
  size_t taken; /* so far */
} SporeSuction;

static void suck_from(SporeWorld *world, SporeSuction *suction, uint32_t index, SporeVec3 mouth) {
  assert(index < world->body_count && spore_body_is_fluid(&world->bodies[index]));
  SporeBody *body = &world->bodies[index];
  const double *state = spore_body_lies_still(body) ? world->state.q : world->state.next_q;
  for (size_t i = 0; i < body->block_count && suction->due >= 1; i++) {
    const double *q = state + body->q_offset + 3 * i;
    if (spore_vec3_distance(spore_vec3_load(q), mouth) > suction->fields.radius) continue;
    if (spore_body_lies_still(body)) {
      spore_world_wake(world, index); /* its particles are taken after the next step */
      return;
    }
    spore_world_take_particle(world, body, i);
    suction->due--;
    suction->taken++;
    body->marks.sucked++;
  }
}

static void exchange(SporeWorld *world, SporeTool *tool) {
  SporeSuction *suction = (SporeSuction *)tool;
  const SporeSuctionFields *fields = &suction->fields;
  suction->due = spore_flow_due(world, fields->rate, fields->trigger, tool->bodies[0], suction->due);
  if (suction->due < 1) return;
  SporeVec3 mouth = spore_pose_apply(spore_world_next_pose(world, tool->bodies[0]), tool->tip);
  for (uint32_t b = 0; b < world->body_count; b++)
    if (spore_body_is_fluid(&world->bodies[b]) && !world->bodies[b].frozen) suck_from(world, suction, b, mouth);
}

static const char *fault(const SporeWorld *world, const SporeToolDescription *from) {
  const SporeSuctionFields *fields = from->fields;
  return spore_tool_point_fault(fields->point);
}

static bool make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  SporeSuction *suction = (SporeSuction *)tool;
  suction->fields = *(const SporeSuctionFields *)from->fields;
  tool->tip = spore_world_to_frame(world, tool->bodies[0], spore_vec3_load(suction->fields.point));
  return true;
}

static void reset(SporeWorld *world, SporeTool *tool) {
  SporeSuction *suction = (SporeSuction *)tool;
  suction->due = 0;
  suction->taken = 0;
}

static void state(const SporeTool *tool, SporeToolState *now) { now->taken = ((const SporeSuction *)tool)->taken; }

static const SporeParameter rows[] = {
    SPORE_ROW_NAME(SporeSuctionFields, tool.name, N_("Name of the tool.")),
    SPORE_ROW_BODY(SporeSuctionFields, body, tool.body, N_("Active body that the tool moves: the tube.")),
    SPORE_ROW_DEVICE(SporeSuctionFields),
    SPORE_ROW_PLACE(SporeSuctionFields, point, N_("Middle of the mouth at the start, in the scene.")),
    SPORE_ROW_REAL(SporeSuctionFields, radius, "m", 1e-6, 1, 0.003,
                   N_("Radius of the mouth: what comes so near to its middle is taken.")),
    SPORE_ROW_REAL(SporeSuctionFields, rate, "1/s", 0, 1e9, 200, N_("Particles that it takes in a second, at most.")),
    SPORE_ROW_CHOICE(SporeSuctionFields, trigger, spore_flow_triggers,
                     N_("When it sucks: always, or while the device's first button is down.")),
};

const SporeToolType spore_suction = {.element = "suction",
                                     .label = N_("Suction"),
                                     .doc = N_("A tube that takes the particles of fluids away."),
                                     .parameters = SPORE_TABLE(rows, SporeSuctionFields),
                                     .takes_particles = true,
                                     .size = sizeof(SporeSuction),
                                     .make = make,
                                     .fault = fault,
                                     .reset = reset,
                                     .exchange = exchange,
                                     .state = state};
