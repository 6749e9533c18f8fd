/* Kinds of steps of an exercise: the events that make a step done. Each kind has its own parameters; event_kinds.c
 * lists them. */
#ifndef SPORE_EXERCISE_EVENT_H
#define SPORE_EXERCISE_EVENT_H

#include "core/sim/world.h"

/* Elements of the instruments that a step or a metric may name. */
#define SPORE_INSTRUMENT_ELEMENTS "probe|grasper|clamp|scissors|suction|bipolar|needle"
/* Elements of all steps. */
#define SPORE_STEP_ELEMENTS                                                                                            \
  "touched|grasped|lifted|clamped|coagulated|cut|pierced|sucked|passed_through|reached|held|bagged"

/* Parameters of every kind of step; a kind's table has some of them. Names are those of the scene's file. */
typedef struct SporeEventFields {
  const char *name, *after, *tool, *body, *container, *hint;
  double point[3], direction[3]; /* world, m */
  double radius, height;         /* m */
  double time;                   /* s: how long the event must go on without a break */
  double share;                  /* of the body */
  int64_t count;                 /* of what the tool does */
  bool stays;                    /* it has to last until the steps that wait for it are done */
} SporeEventFields;

struct SporeExercise;
struct SporeStepRun;
/* A kind of step. */
typedef struct SporeEventKind {
  const char *element;            /* name in the file: "grasped" */
  const char *label;              /* for people, translatable */
  const char *doc;                /* one sentence, translatable */
  SporeParameterTable parameters; /* of SporeEventFields */
  bool needs_body;                /* it means nothing without a body */
  bool lasting;                   /* what happened cannot be undone: early is an error */
  /* Whether the event is there after the last step, by an instrument; SPORE_NO_PART: by none. */
  bool (*happens)(const struct SporeExercise *exercise, struct SporeStepRun *step, const SporeWorld *world,
                  uint32_t instrument);
} SporeEventKind;

extern const SporeEventKind *const spore_event_kinds[]; /* NULL at the end */
/* The kind of that element; NULL: there is none. */
const SporeEventKind *spore_event_kind_find(const char *element);
/* Whether an instrument of that element ("probe") can do it. */
bool spore_event_kind_allows(const SporeEventKind *kind, const char *tool);

#endif
