/* Tools: actions of instruments on tissue; and particles that come into the world and leave it. */
#ifndef SPORE_SIM_TOOL_H
#define SPORE_SIM_TOOL_H

#include "core/sim/state/state.h"
#include "core/sim/tool/tool_type.h"

/* Base of every tool: the first member of the tool's own structure. */
typedef struct SporeTool {
  const SporeToolType *type;
  char *name;
  uint32_t bodies[SPORE_TOOL_BODIES]; /* as in the description */
  size_t spring_start, spring_count;  /* in the world's springs */
} SporeTool;

typedef struct SporeEmitter {
  uint32_t body, source;
  SporeVec3 point, direction; /* in the frame of the source */
  SporeEmitterFields fields;
  double due;     /* particles that may come out now */
  uint64_t tries; /* state of the random numbers for places in the mouth */
} SporeEmitter;

typedef struct SporeToolSystem {
  size_t count, emitter_count;
  SporeTool **all;
  SporeEmitter *emitters;
  SporeToolCounts counts; /* of all tools since time 0, for snapshots */
} SporeToolSystem;

/* tools.c */
bool spore_world_create_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Number of springs that all tools need for holding. */
size_t spore_tools_spring_count(const SporeWorldDescription *description);
void spore_world_reset_tools(SporeWorld *world);
void spore_world_clear_tools(SporeWorld *world);
/* Stages: tools act on the state after the last step; after the step, overloaded holds tear away. */
void spore_world_use_tools(SporeWorld *world);
void spore_world_tear_holds(SporeWorld *world);
/* Adds forces on the tools' other bodies to the feedback of the devices. */
void spore_world_feed_back_tools(SporeWorld *world);
/* A direction in the world at time 0, in the frame of a body. */
SporeVec3 spore_tool_direction(const SporeWorld *world, uint32_t body, const double direction[3]);
/* Whether the first button of the device that moves the body is down. */
bool spore_tool_button(const SporeWorld *world, uint32_t body);

/* particles.c: particles that leave the world and come back. */
bool spore_world_create_particles(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Stage: particles dissolve, suction takes particles, and emitters give some. The next state is written, but is not the
 * last good one yet. */
void spore_world_exchange_particles(SporeWorld *world);
/* Whether anything may take or give particles. */
bool spore_world_exchanges_particles(const SporeWorld *world);
/* Finds which of the body's particles are out of the world, after its state was set from outside. */
void spore_body_find_parked(SporeBody *body, const double *q);
void spore_world_reset_particles(SporeWorld *world);
bool spore_body_is_fluid(const SporeBody *body);
/* Takes a particle out of the world, in the next state. */
void spore_world_take_particle(SporeWorld *world, SporeBody *body, size_t particle);
/* Pose, in the next state, of a body that keeps its shape; SPORE_NO_BODY: the identity. */
SporePose spore_world_next_pose(const SporeWorld *world, uint32_t body);
extern const char *const spore_flow_triggers[3]; /* choices of `trigger`, NULL at the end */
/* Number of particles that a flow of `rate` a second may move now; `due`: the number that was left before. */
double spore_flow_due(const SporeWorld *world, double rate, int trigger, uint32_t body, double due);

#endif
