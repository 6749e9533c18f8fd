/* Tools: what instruments do besides being there, and particles that come into the world and leave it. */
#ifndef SPORE_SIM_TOOL_H
#define SPORE_SIM_TOOL_H

#include "core/sim/state/state.h"
#include "core/sim/tool/needle.h"

/* A sphere between jaws, tied to one of them by a spring. */
typedef enum SporeHoldState { SPORE_HOLD_FREE, SPORE_HOLD_TIED, SPORE_HOLD_LOST } SporeHoldState;
typedef struct SporeHold {
  SporeHoldState state;
  uint32_t sphere; /* of the world */
} SporeHold;

typedef struct SporeJaw {
  uint32_t body;
  SporePose closed; /* in the frame of the tool's body */
  double side;      /* 1, -1: how it opens about the axis */
} SporeJaw;

typedef struct SporeTool {
  char *name;
  SporeToolKind kind;
  uint32_t body;
  SporeVec3 hinge, axis; /* in its frame */
  SporeJaw jaws[2];
  SporeJawFields fields;
  SporeVec3 point; /* of suction and scissors, in its frame */
  size_t cut;      /* by scissors */
  SporeBipolarFields bipolar;
  SporeNeedle *needle; /* NULL: it is none */
  size_t coagulated;   /* by bipolar, in the last step */
  SporeSuctionFields suction;
  double due;        /* particles that suction may take away by now */
  size_t taken;      /* by suction */
  size_t hold_start; /* its terms in springs, fields.holds of them */
  SporeHold *holds;
  double opening, squeeze, held_at; /* rad, N m; opening at which it began to hold; negative: holds nothing */
  double stroke;                    /* rad, opening at which it began to close */
  bool latched;                     /* of a clamp */
} SporeTool;

typedef struct SporeEmitter {
  uint32_t body, source;
  SporeVec3 point, direction; /* in the frame of the source */
  SporeEmitterFields fields;
  double due; /* particles that may come by now */
  uint64_t tries;
} SporeEmitter;

typedef struct SporeToolSystem {
  size_t count, emitter_count;
  SporeTool *all;
  SporeEmitter *emitters;
  SporeToolCounts counts; /* of all tools since time 0, for snapshots */
} SporeToolSystem;

/* tools.c */
bool spore_world_create_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Springs that all tools take to hold with. */
size_t spore_tools_hold_count(const SporeWorldDescription *description);
void spore_world_reset_tools(SporeWorld *world);
void spore_world_clear_tools(SporeWorld *world);
/* Stage: tools act on what the last step did. */
void spore_world_use_tools(SporeWorld *world);
/* Stage, after the step: holds that bear too much tear away. */
void spore_world_tear_holds(SporeWorld *world);
/* Adds what the jaws of all tools feel to what their devices are told. */
void spore_world_feed_back_tools(SporeWorld *world);

/* particles.c: particles that leave the world and come back. */
bool spore_world_create_particles(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Stage: what suction takes, and emitters give. The next state is written by then, but not the last good one yet. */
void spore_world_exchange_particles(SporeWorld *world);
/* Whether anything may take or give particles. */
bool spore_world_exchanges_particles(const SporeWorld *world);
/* After a body's state was set from outside: which of its particles are out of the world. */
void spore_body_find_parked(SporeBody *body, const double *q);
void spore_world_reset_particles(SporeWorld *world);

/* scissors.c: the blades, half of the angle each, went with their body from the last state to its target, and closed
 * from one opening to another. */
void spore_scissors_cut(SporeWorld *world, SporeTool *tool, double from, double to);

/* bipolar.c. Room for coagulation in models, where the world has something that heats. False: no memory. */
bool spore_world_create_coagulation(SporeWorld *world);
void spore_bipolar_use(SporeWorld *world, SporeTool *tool);

/* needle.c */
size_t spore_needle_term_count(const SporeToolDescription *from);
const char *spore_needle_fault(const SporeWorld *world, const SporeToolDescription *from);
bool spore_needle_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from);
void spore_needle_clear(SporeNeedle *needle);
void spore_needle_reset(SporeWorld *world, SporeTool *tool);
void spore_needle_use(SporeWorld *world, SporeTool *tool);
size_t spore_needle_stitch_count(const SporeNeedle *needle);

/* jaws.c: from what the last step did to where the jaws are to be. */
const char *spore_jaws_fault(const SporeWorld *world, const SporeToolDescription *from);
bool spore_jaws_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from);
void spore_jaws_use(SporeWorld *world, SporeTool *tool);
void spore_jaws_let_go(SporeWorld *world, SporeTool *tool);
/* After a step: holds that bear too much tear away. */
void spore_jaws_tear(SporeWorld *world, SporeTool *tool);
/* Adds what the jaws feel to what the device is told. */
void spore_jaws_feed_back(SporeWorld *world, const SporeTool *tool);

static inline bool spore_tool_has_jaws(const SporeTool *tool) { return tool->kind <= SPORE_TOOL_SCISSORS; }
static inline bool spore_tool_kind_holds(SporeToolKind kind) { return kind <= SPORE_TOOL_CLAMP; }

#endif
