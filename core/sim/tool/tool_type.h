/* Kinds of tools. A kind says what its tools are called, which parameters they have, and what they do. Each kind is one
 * file of this folder; registry.c lists the kinds. */
#ifndef SPORE_SIM_TOOL_TYPE_H
#define SPORE_SIM_TOOL_TYPE_H

#include "core/base/parameter.h"
#include "core/body/model.h"

#define SPORE_TOOL_BODIES 3 /* most bodies that the parameters of a tool refer to */

struct SporeWorld;
struct SporeTool;
struct SporeSqueeze;
/* A kind of tool. Defined below. */
typedef struct SporeToolType SporeToolType;

/* A tool of a world that is to be made. The device moves the first of its bodies, which is active. Jaws are active
 * bodies, too, and the tool moves them. */
typedef struct SporeToolDescription {
  const SporeToolType *type;
  uint32_t bodies[SPORE_TOOL_BODIES]; /* in the order of the type's parameters; SPORE_NO_BODY: none */
  const void *fields; /* the structure of type->parameters, which begins with SporeToolFields; borrowed */
  bool effect;        /* it is an effect at time 0; the type has that form */
} SporeToolDescription;

/* First member of the fields of every kind. `body` and `device` are names in the scene's file. A world does not read
 * these two: the bodies of a tool are those of SporeToolDescription. */
typedef struct SporeToolFields {
  const char *name, *body, *device;
} SporeToolFields;

/* What a tool does now, and what it has done since time 0. Fields that do not concern a kind are 0. */
typedef struct SporeToolState {
  const char *name;  /* owned by the world */
  double opening;    /* of jaws, rad */
  double squeeze;    /* torque against closing, on the jaw that feels more of it, N m */
  size_t held;       /* spheres that the jaws hold now */
  size_t lost;       /* spheres that tore away since the jaws last opened */
  size_t taken;      /* particles that suction has taken away */
  size_t cut;        /* ties that scissors have cut */
  size_t pierced;    /* surfaces that a needle has pierced */
  size_t stitches;   /* places that the needle or its thread goes through now */
  size_t coagulated; /* ties and elements that bipolar coagulated in the last step */
} SporeToolState;

/* A kind of tool: a table of slots. NULL in an optional slot: the tool has nothing to do there. */
struct SporeToolType {
  const char *element; /* name in the file: "grasper" */
  const char *label;   /* for people, translatable (N_) */
  const char *doc;     /* one sentence, translatable (N_) */
  SporeParameterTable parameters;
  bool cuts;            /* it cuts: models get room for that when the world is made */
  bool heats;           /* it heats: the same */
  bool takes_particles; /* it takes particles out of the world: fluids get room for that when the world is made */

  /* Required. */
  size_t size; /* bytes of the tool's own structure, whose first member is a SporeTool */
  /* Fills the rest of the tool; its SporeTool is set, and its springs have room. False: no memory. */
  bool (*make)(struct SporeWorld *world, struct SporeTool *tool, const SporeToolDescription *from);

  /* Optional. */
  /* Number of springs that the tool needs to hold tissue. NULL: 0. */
  size_t (*spring_count)(const void *fields);
  /* What is wrong with the description (translated: what is wrong, what was expected, what to do); NULL: nothing is. */
  const char *(*fault)(const struct SporeWorld *world, const SporeToolDescription *from);
  /* Frees what make allocated. */
  void (*clear)(struct SporeTool *tool);
  /* Back to time 0. */
  void (*reset)(struct SporeWorld *world, struct SporeTool *tool);
  /* The state of one of the tool's bodies was set from outside: what the tool knows of their poses follows. */
  void (*follow)(struct SporeWorld *world, struct SporeTool *tool);
  /* In the step, after devices were read and before spheres are mapped: the tool acts on the last good state. */
  void (*use)(struct SporeWorld *world, struct SporeTool *tool);
  /* In the step, after integration: takes particles out of the next state. */
  void (*exchange)(struct SporeWorld *world, struct SporeTool *tool);
  /* In the step, after integration: releases the holds whose force exceeds their strength. */
  void (*tear)(struct SporeWorld *world, struct SporeTool *tool);
  /* In the step: adds to the command of the first body's device what the tool's other bodies feel. */
  void (*feed_back)(struct SporeWorld *world, const struct SporeTool *tool);
  /* Fills the fields of the state that concern this kind. */
  void (*state)(const struct SporeTool *tool, SporeToolState *state);
  /* Number of spheres of a body that it holds. NULL: it holds nothing. */
  size_t (*holds)(const struct SporeWorld *world, const struct SporeTool *tool, uint32_t body);
  /* Whether it is closed on the body, so that no blood gets through, nearer than that to the place (world, m). NULL: it
   * never is. */
  bool (*pinches)(const struct SporeWorld *world, const struct SporeTool *tool, uint32_t body, SporeVec3 place,
                  double distance);
  /* The tool became an effect, or physical again, as tool->effect says. NULL: the kind has no form as an effect. */
  void (*set_effect)(struct SporeWorld *world, struct SporeTool *tool);
  /* What it draws squeezed; false: nothing. NULL: it never does. */
  bool (*squeeze)(const struct SporeWorld *world, const struct SporeTool *tool, struct SporeSqueeze *squeeze);
};

/* What closes jaws. */
typedef enum SporeTrigger {
  SPORE_TRIGGER_GRIP,  /* the device's grip angle is their opening */
  SPORE_TRIGGER_BUTTON /* they close while the first button is down */
} SporeTrigger;
/* Parameters of graspers, clamps and scissors: how their jaws close and hold. Points and axes: world, at time 0, m. */
typedef struct SporeJawFields {
  SporeToolFields tool;
  const char *jaw_a, *jaw_b; /* names of bodies, in the scene's file */
  double hinge[3];           /* a point of the hinge */
  double axis[3];            /* of the hinge: jaw_a opens by turning about it, and jaw_b by turning the other way */
  double tip[3];             /* of scissors: end of the closed blades */
  double opening;            /* rad, largest angle between the jaws */
  double speed;              /* rad/s, of closing and opening */
  double torque;             /* N m about the hinge, largest on each jaw */
  double stiffness;          /* N/m, of each hold */
  double strength;           /* N: a hold tears away above this force */
  int64_t holds;             /* largest number of spheres held at a time */
  int trigger;               /* SporeTrigger */
} SporeJawFields;

/* Buttons of a device, as bits. */
enum { SPORE_FIRST_BUTTON = 1, SPORE_SECOND_BUTTON = 2 };
/* When particles flow. Suction knows the first two. In this order they are in the file. */
typedef enum SporeFlowTrigger {
  SPORE_FLOW_ALWAYS,
  SPORE_FLOW_BUTTON,       /* while the first button is down */
  SPORE_FLOW_COAGULATION,  /* while the tool coagulates tissue */
  SPORE_FLOW_WOUND,        /* from a cut in the body until it is coagulated, and not while it is clamped */
  SPORE_FLOW_SECOND_BUTTON /* while the second button is down */
} SporeFlowTrigger;
/* Parameters of suction. */
typedef struct SporeSuctionFields {
  SporeToolFields tool;
  double point[3]; /* middle of the mouth; world, at time 0, m */
  double radius;   /* m, of the mouth */
  double rate;     /* particles a second, at most */
  int trigger;     /* SporeFlowTrigger */
} SporeSuctionFields;

/* Parameters of bipolar forceps. */
typedef struct SporeBipolarFields {
  SporeToolFields tool;
  double point[3];   /* between the tips; world, at time 0, m */
  double radius;     /* m: tissue nearer than this to the point is heated */
  double rate;       /* 1/s: coagulation, of 0 to 1, that the tissue gains in a second */
  double least;      /* part of its length that coagulated tissue keeps */
  double stiffening; /* stiffness of coagulated tissue over its stiffness before */
} SporeBipolarFields;

/* Parameters of a needle with its thread. The arc of the needle runs from the tip to the swage, where the thread
 * begins.
 */
typedef struct SporeNeedleFields {
  SporeToolFields tool;
  const char *thread;                 /* name of a body, in the scene's file */
  double tip[3], middle[3], swage[3]; /* points of the arc; world, at time 0, m */
  double force;                       /* N: the tip pierces a surface above this force */
  double depth;                       /* m: the tip pierces a surface that it has pushed in by more than this */
  double
      stiffness; /* N/m, of each place that the needle or the thread goes through, and of the thread's end at the swage
                  */
  double friction;  /* Coulomb coefficient of tissue against needle and thread */
  double strength;  /* N: a stitch tears out of the tissue above this force; 0: never */
  int64_t stitches; /* largest number of places that needle and thread go through at a time */
  bool knot;        /* the thread's other end has a knot, which does not go through tissue */
} SporeNeedleFields;

/* Indices in SporeToolDescription.bodies, besides 0. */
enum { SPORE_TOOL_JAW_A = 1, SPORE_TOOL_JAW_B = 2, SPORE_TOOL_THREAD = 1 };

extern const SporeToolType spore_grasper;  /* two jaws that close while the device says so, and hold what they press */
extern const SporeToolType spore_clamp;    /* the same, closed until the second button opens it */
extern const SporeToolType spore_scissors; /* blades that cut what they close on; they need no jaws */
extern const SporeToolType spore_suction;  /* takes the particles away that come into its mouth */
extern const SporeToolType spore_bipolar;  /* coagulates tissue near its point while the first button is down */
extern const SporeToolType spore_needle;   /* pierces tissue with its tip, and draws its thread through */

extern const SporeToolType *const spore_tool_types[]; /* all of them; NULL at the end */
/* The kind of that name in the file; NULL: there is none. */
const SporeToolType *spore_tool_type_find(const char *element);

#endif
