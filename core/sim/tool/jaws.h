/* Jaws of graspers, clamps and scissors: two active bodies on a hinge of a third. */
#ifndef SPORE_SIM_JAWS_H
#define SPORE_SIM_JAWS_H

#include "core/base/parameter_rows.h"
#include "core/sim/tool/tool.h"

/* A sphere between jaws, tied to one of them by a spring; not tied where the tool is an effect. */
typedef enum SporeHoldState { SPORE_HOLD_FREE, SPORE_HOLD_TIED, SPORE_HOLD_LOST } SporeHoldState;
typedef struct SporeHold {
  SporeHoldState state;
  uint32_t sphere; /* of the world */
} SporeHold;

typedef struct SporeJaw {
  uint32_t body;    /* SPORE_NO_BODY: none, for scissors */
  SporePose closed; /* in the frame of the tool's body */
  double side;      /* 1, -1: direction in which it opens about the axis */
} SporeJaw;

/* What a clamp knows of itself as an effect; see clip.h. */
typedef struct SporeJawClip {
  bool set;        /* it sits on a body and goes along with it */
  bool leaving;    /* it opens, and is physical then */
  bool back;       /* the shaft is on its way back to its device */
  uint32_t body;   /* that it sits on */
  SporeSeat seat;  /* among the body's spheres */
  SporePose shaft; /* in the frame of the seat */
  double touched;  /* opening at which the jaws touched what is between them, rad */
} SporeJawClip;

typedef struct SporeJaws {
  SporeTool tool;
  SporeJawFields fields;
  SporeVec3 hinge, axis; /* in the frame of the tool's body */
  SporeJaw jaw[2];
  SporeVec3 along;             /* from the hinge to the tips, in the frame of the tool's body */
  double length, width, reach; /* of the jaws, m: along that; to either side of it; from the hinge to the farthest */
  bool latches, latched;       /* of a clamp */
  SporeHold *holds;            /* tool.spring_count */
  double opening;              /* rad */
  double squeeze;              /* torque against closing, N m */
  double held_at;              /* opening at which the jaws began to hold; negative: they hold nothing */
  double stroke;               /* opening at which they began to close, rad */
  SporeJawClip clip;           /* of a clamp */
} SporeJaws;

/* What is wrong with the jaws' bodies or hinge, or with the hinge alone; translated, or NULL. */
const char *spore_jaws_fault(const SporeWorld *world, const SporeToolDescription *from);
const char *spore_hinge_fault(const SporeJawFields *fields);
/* The slots of a SporeToolType that all jaws share. */
bool spore_jaws_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from);
void spore_jaws_clear(SporeTool *tool);
void spore_jaws_reset(SporeWorld *world, SporeTool *tool);
void spore_jaws_follow(SporeWorld *world, SporeTool *tool);
void spore_jaws_use(SporeWorld *world, SporeTool *tool);
void spore_jaws_feed_back(SporeWorld *world, const SporeTool *tool);
void spore_jaws_state(const SporeTool *tool, SporeToolState *state);

/* holds.c */
/* The frame of the hinge in the state, world: the jaws lie along x, and z is from one to the other. */
SporePose spore_jaws_frame(const SporeWorld *world, const SporeJaws *jaws);
/* Lets go of all that is held. */
void spore_jaws_let_go(SporeWorld *world, SporeJaws *jaws);
/* Holds the sphere, tied to that jaw, where it is not held yet and there is a hold for it. */
void spore_jaws_hold(SporeWorld *world, SporeJaws *jaws, uint32_t jaw, uint32_t sphere);
/* Ties the spheres that are held to the first jaw, at their present places. */
void spore_jaws_tie(SporeWorld *world, SporeJaws *jaws);
/* Holds the spheres that lie between both jaws: those of effects, tied; or those of all bodies, and ties none. Whether
 * there are any. */
bool spore_jaws_pinch(SporeWorld *world, SporeJaws *jaws, bool effects);

extern const char *const spore_jaw_triggers[3]; /* choices of `trigger`, NULL at the end */

/* Rows of every tool with jaws: `name` to `axis` come first, then rows of the tool's own, then the others. */
#define SPORE_JAW_BODY_ROWS                                                                                            \
  SPORE_ROW_NAME(SporeJawFields, tool.name, N_("Name of the tool.")),                                                  \
      SPORE_ROW_BODY(SporeJawFields, body, tool.body, N_("Active body that the tool moves: the shaft.")),              \
      SPORE_ROW_DEVICE(SporeJawFields),                                                                                \
      SPORE_ROW_BODY(SporeJawFields, jaw_a, jaw_a, N_("Active body of the first jaw, where it is when closed.")),      \
      SPORE_ROW_BODY(SporeJawFields, jaw_b, jaw_b, N_("Active body of the second jaw, where it is when closed.")),     \
      SPORE_ROW_PLACE(SporeJawFields, hinge, N_("Where the jaws are hinged at the start, in the scene.")),             \
      SPORE_ROW_DIRECTION(SporeJawFields, axis, 1, 0, 0,                                                               \
                          N_("Axis of the hinge at the start, in the scene: the first jaw opens by turning about it, " \
                             "the second against it."))
#define SPORE_JAW_ROWS                                                                                                 \
  SPORE_ROW_REAL(SporeJawFields, opening, "rad", 0.01, 3.1, 1, N_("Angle between the jaws when they are wide open.")), \
      SPORE_ROW_REAL(SporeJawFields, speed, "rad/s", 0.01, 100, 5,                                                     \
                     N_("How fast the angle between the jaws changes at most.")),                                      \
      SPORE_ROW_REAL(SporeJawFields, torque, "N m", 1e-6, 10, 0.02,                                                    \
                     N_("Torque with which each jaw closes at most; half of it holds what is between them.")),         \
      SPORE_ROW_REAL(SporeJawFields, stiffness, "N/m", 1e-3, 1e9, 500,                                                 \
                     N_("How firmly each sphere between the jaws is held.")),                                          \
      SPORE_ROW_REAL(SporeJawFields, strength, "N", 0, 1e6, 2,                                                         \
                     N_("Force above which a sphere tears away from the jaws.")),                                      \
      SPORE_ROW_COUNT(SporeJawFields, holds, 1, 1000, 32, N_("Spheres that the jaws can hold at a time.")),            \
      SPORE_ROW_CHOICE(SporeJawFields, trigger, spore_jaw_triggers,                                                    \
                       N_("What closes the jaws: grip, the device's own angle; button, its first button."))

#endif
