/* Tools: what instruments do besides touching. They hold, cut, suck, coagulate and sew. This room also takes particles
 * out of the world and puts them back: tools, emitters, and particles that dissolve. */
#ifndef SPORE_SIM_TOOL_H
#define SPORE_SIM_TOOL_H

#include "core/sim/state/state.h"
#include "core/sim/tool/seat.h"
#include "core/sim/tool/tool_type.h"

/* Base of every tool: the first member of the tool's own structure. */
typedef struct SporeTool {
  const SporeToolType *type;
  char *name;
  uint32_t bodies[SPORE_TOOL_BODIES]; /* as in the description */
  size_t spring_start, spring_count;  /* its springs in SporeLinkSystem.springs */
  SporeVec3 tip;                      /* where it acts, in the frame of its first body, m; `make` sets it */
  bool effect, effect_at_start;       /* it is an effect now; at time 0 */
} SporeTool;

/* A source of particles; see SporeEmitterDescription. */
typedef struct SporeEmitter {
  uint32_t body, source;
  SporeVec3 point, direction; /* in the frame of the source; where that deforms, beside the node, as at time 0 */
  SporeSeat seat;            /* of the mouth, by nodes of a source that deforms; without a point: the source is rigid */
  SporeEmitterFields fields; /* with the rate and the speed of its flow, where it has one */
  double due;                /* particles that the rate allows by now; whole ones are put */
  bool effect, effect_at_start; /* it is an effect now; at time 0 */
  SporeVec3 rest;               /* middle of the mouth, in the frame of the source at rest, m */
  double seeped, seen;          /* m^3 that came out as an effect; of it when stains were last looked at */
  bool bleeds;                  /* of a wound: it was cut, and not coagulated since */
  SporeBodyMarks marks;         /* of the source when that was found */
  uint64_t tries;               /* state of the random numbers by which places in the mouth are chosen */
} SporeEmitter;

/* All tools and emitters of a world. */
typedef struct SporeToolSystem {
  size_t count, emitter_count;
  SporeTool **all;
  SporeEmitter *emitters;
  SporeToolCounts counts; /* of all tools since time 0, for snapshots */
} SporeToolSystem;

/* tools.c */
/* Makes the tools, with room in the world and its models for what the tools do. */
bool spore_world_create_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Number of springs that all tools together need to hold tissue. */
size_t spore_tools_spring_count(const SporeWorldDescription *description);
void spore_world_reset_tools(SporeWorld *world);
void spore_world_clear_tools(SporeWorld *world);
/* Makes the tool an effect, or gives it back to physics, where its kind has both forms. */
void spore_world_set_tool_effect(SporeWorld *world, size_t tool, bool on);
/* Whether some tool moves the body as an effect, so that nothing feels it. */
bool spore_world_is_led_by_effect(const SporeWorld *world, uint32_t body);
/* The state of an active body was set from outside: its device is taken to stand there, and its tools follow. */
void spore_world_follow_tools(SporeWorld *world, uint32_t body);
/* Stage: tools act on the last good state. */
void spore_world_use_tools(SporeWorld *world);
/* Stage: releases holds whose force exceeds their strength. */
void spore_world_tear_holds(SporeWorld *world);
/* Adds to the commands of devices the forces on the other bodies of their tools, such as jaws. */
void spore_world_feed_back_tools(SporeWorld *world);
/* NULL: the point of the tool's file is finite; else the fault, translated. */
const char *spore_tool_point_fault(const double point[3]);
/* A direction of the world at time 0, as a unit vector in the frame of a body. */
SporeVec3 spore_tool_direction(const SporeWorld *world, uint32_t body, const double direction[3]);
/* Whether that button of the device that moves the body is down. */
bool spore_tool_button(const SporeWorld *world, uint32_t body, uint32_t button);

/* particles.c: particles that leave the world and come back. A particle out of the world is kept far away, at rest. */
bool spore_world_create_particles(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Stage: takes dissolved particles and those in the mouths of suction out of the world, and puts those of emitters into
 * it. All this is done in the next state, which the solver has written by then. */
void spore_world_exchange_particles(SporeWorld *world);
/* Whether anything in the world may take or put particles. */
bool spore_world_exchanges_particles(const SporeWorld *world);
/* Finds anew which particles of a body are out of the world, after q of the body was set from outside. */
void spore_body_find_parked(SporeBody *body, const double *q);
void spore_world_reset_particles(SporeWorld *world);
/* Whether the body is made of particles. */
bool spore_body_is_fluid(const SporeBody *body);
/* Takes a particle out of the world, in the next state. */
void spore_world_take_particle(SporeWorld *world, SporeBody *body, size_t particle);
extern const char *const spore_flow_triggers[3]; /* choices of `trigger`, NULL at the end */
/* Number of particles that a flow may move by now. rate: particles a second; due: what was left of this number before;
 * trigger: SporeFlowTrigger, of the device that moves the body. */
double spore_flow_due(const SporeWorld *world, double rate, int trigger, uint32_t body, double due);

/* mouth.c: where an emitter lets particles out. */
/* Pose of an unmovable, active or rigid body in the next state; SPORE_NO_BODY: the identity. */
SporePose spore_world_next_pose(const SporeWorld *world, uint32_t body);
/* Sets the mouth of an emitter, whose source is set: middle and way out, world, at time 0. */
void spore_emitter_set_mouth(const SporeWorld *world, SporeEmitter *emitter, SporeVec3 point, SporeVec3 direction);
/* The frame that the mouth is in, in the next state. */
SporePose spore_emitter_frame(const SporeWorld *world, const SporeEmitter *emitter);

#endif
