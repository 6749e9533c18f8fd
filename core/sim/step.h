/* The step of a world: its schedule, made of the table in step.c, and commands that a step begins with. */
#ifndef SPORE_SIM_STEP_H
#define SPORE_SIM_STEP_H

#include <stdatomic.h>

#include "core/sim/world.h"

#define SPORE_STAGE_COUNT 29
#define SPORE_LEFT_OUT_MAXIMUM 10
#define SPORE_COMMAND_CAPACITY 1024

/* A stage of the step. */
typedef struct SporeStageType {
  const char *name;
  bool (*needed)(const SporeWorld *world);
  void (*run)(SporeWorld *world);
  size_t (*items)(const SporeWorld *world); /* what the stage works on; NULL: nothing to count */
  const char *why, *why_not;                /* why a world needs it, and why not; translatable (N_) */
  double fixed_us, item_us;                 /* an estimate, of a machine of 2024 */
  double (*work)(const SporeWorld *world);  /* the rest of the estimate, us; NULL: none */
} SporeStageType;

typedef struct SporeSchedule {
  SporePlan plan;
  SporePlanStage plan_stages[SPORE_STAGE_COUNT];
  SporePlanLeftOut left_out[SPORE_LEFT_OUT_MAXIMUM];
  uint8_t run[SPORE_STAGE_COUNT]; /* the stages that the world needs, in order: what a step calls */
  size_t run_count;
  bool unpruned; /* every stage runs: see SporeWorldDescription */
  bool stale;    /* something that a stage depends on has begun or ended: the schedule is to be made again */
  SporeProfilePhase profiles[SPORE_STAGE_COUNT];
  SporeProfilePhase profile; /* of whole steps */
  double step_us;            /* of the step before */
  double budget_us;          /* 0: none */
  bool cancelled;            /* a step was, since time 0 */
} SporeSchedule;

typedef struct SporeCommands {
  SporeCommand *ring;              /* SPORE_COMMAND_CAPACITY */
  _Atomic size_t written, applied; /* ever */
} SporeCommands;

/* step.c */
/* Makes the schedule. A step does so by itself where the schedule is stale. */
void spore_world_make_plan(SporeWorld *world);

/* command.c. Stage: applies the commands that were posted. */
void spore_world_apply_commands(SporeWorld *world);
void spore_commands_clear(SporeCommands *commands);

/* devices.c. Stages: active bodies follow their devices; force and torque on each body from contacts and links;
 * devices are told what their bodies feel. */
void spore_world_read_devices(SporeWorld *world);
void spore_world_add_reactions(SporeWorld *world);
void spore_world_feed_back(SporeWorld *world);

#endif
