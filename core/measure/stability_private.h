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
  bool deep; /* by the case itself bodies come deep into each other, or faster than contacts can stop them */
  /* Where contacts alone fail, the case is run again as the program advises, with contacts so many times as stiff, or
   * steps so many times as small, as the case makes their load or their speed larger. 0: it makes neither larger, or
   * changes contacts or steps itself. */
  double stiffer_contacts, smaller_steps;
  SporeStabilityChange change;
  SporePushInput input;
  SporePushStart start;
  SporePushJump jump;
} SporePush;
/* stability_cases.c: the first one changes nothing. */
extern const SporePush spore_pushes[];
extern const size_t spore_push_count;

/* How long a run is. */
typedef struct SporePushLength {
  size_t steps;
  size_t most;       /* steps, where no instrument met anything in `steps`; 0: no more than these */
  uint64_t until_ns; /* of the clock: no step begins later */
} SporePushLength;

/* What was seen in a run. */
typedef struct SporePushRun {
  size_t steps;
  bool finite, judged; /* judged: the energy could be */
  double gain;         /* largest gain of energy over start and work, as a part of the energy at work, since the monitor
                          last moved a body by a safer method */
  double gain_before;  /* the same before that */
  uint32_t fastest;    /* body with the most kinetic energy when that was seen */
  size_t met_at;       /* step in which an instrument first felt a force; 0: none did */
  size_t contacts;     /* most at once */
  bool out_of_time;
} SporePushRun;

/* stability_run.c: runs the world from time 0, as long as that, or until the world is cancelled. False: no memory. */
bool spore_push_run(const SporeStabilityScene *scene, SporeWorld *world, const SporePush *push, SporePushLength length,
                    SporePushRun *run);
/* stability_verdict.c: judges the run, and writes the detail. */
SporeStabilityVerdict spore_push_judge(const SporeWorld *world, const SporePush *push, const SporePushRun *run,
                                       char *detail, size_t size);

/* Whether contacts that do not hold are all that fails the run, which is over. */
bool spore_push_fails_by_contacts(const SporeWorld *world, const SporePush *push, const SporePushRun *run);
/* Adds to the detail that with the remedy of the case the run is sound. */
void spore_push_add_remedy(const SporePush *push, char *detail, size_t size);

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
