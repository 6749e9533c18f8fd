/* What the files of the stability study share. */
#ifndef SPORE_MEASURE_STABILITY_PRIVATE_H
#define SPORE_MEASURE_STABILITY_PRIVATE_H

#include "core/measure/stability.h"

/* What a device says in a case. */
typedef enum SporePushInput {
  SPORE_INPUT_AS_IT_IS,
  SPORE_INPUT_FAST,     /* what it says, ten times as fast */
  SPORE_INPUT_RUSH,     /* to and fro between its place and the nearest body, at 10 m/s */
  SPORE_INPUT_NAN,      /* every third time a position that is not a number */
  SPORE_INPUT_INFINITE, /* every third time an infinite position */
  SPORE_INPUT_JUMPS,    /* every 25 steps a metre further, or back */
  SPORE_INPUT_STOPS     /* nothing, from the middle of the run on */
} SporePushInput;

/* How bodies begin. */
typedef enum SporePushStart {
  SPORE_START_AS_IT_IS,
  SPORE_START_KNOCKED, /* each node with another velocity, 1 m/s or less a component */
  SPORE_START_FLAT,    /* bodies that deform are pressed flat, to a thousandth of their height */
  SPORE_START_POINT,   /* bodies that deform shrink to a millionth */
  SPORE_START_OVERLAP  /* one body lies where another does */
} SporePushStart;

/* What changes in the middle of the run. */
typedef enum SporePushJump {
  SPORE_JUMP_NONE,
  SPORE_JUMP_STIFFNESS,
  SPORE_JUMP_CONTACT,
  SPORE_JUMP_GRAVITY
} SporePushJump;

/* A case. */
typedef struct SporePush {
  const char *name, *label; /* label: translatable */
  bool quick;               /* also run where little time is given */
  bool deep;                /* bodies are deep in each other by the case itself */
  SporeStabilityChange change;
  SporePushInput input;
  SporePushStart start;
  SporePushJump jump;
} SporePush;
/* stability_cases.c: the first one changes nothing. */
extern const SporePush spore_pushes[];
extern const size_t spore_push_count;

/* What was seen in a run. */
typedef struct SporePushRun {
  size_t steps, wanted; /* taken, and to be taken */
  bool finite, judged;  /* judged: the energy could be */
  double gain;          /* largest gain of energy over start and work, as a part of the energy at work */
  uint32_t fastest;     /* body with the most kinetic energy when that was seen */
  double residual;      /* largest */
  size_t contacts;      /* most at once */
  double seconds;       /* of the clock */
  bool out_of_time;
} SporePushRun;

/* stability_run.c: runs the world from time 0, until `wanted` steps are taken, the world is cancelled or `until_ns` of
 * the clock. False: no memory. */
bool spore_push_run(const SporeStabilityScene *scene, SporeWorld *world, const SporePush *push, size_t wanted,
                    uint64_t until_ns, SporePushRun *run);
/* stability_verdict.c: judges the run, and writes the detail. */
SporeStabilityVerdict spore_push_judge(const SporeWorld *world, const SporePush *push, const SporePushRun *run,
                                       char *detail, size_t size);

/* stability_start.c. Whether the case can be had in this world. */
bool spore_start_is_possible(const SporeWorld *world, SporePushStart start);
/* Puts bodies where the case wants them. False: no memory. */
bool spore_start_put(SporeWorld *world, SporePushStart start);

/* stability_input.c: devices in front of those of a world. */
typedef struct SporePushDevices SporePushDevices;
/* Whether the world has an instrument that a device may move. */
bool spore_input_is_possible(const SporeWorld *world);
/* NULL: no memory. */
SporePushDevices *spore_push_devices_new(SporeWorld *world, SporePushInput input, size_t steps);
/* Gives the world its own devices back. */
void spore_push_devices_free(SporePushDevices *devices);

#endif
