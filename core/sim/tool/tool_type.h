/* Kinds of tools: the name of a tool, its parameters, and its functions. registry.c lists the kinds; each is a file of
 * its own. */
#ifndef SPORE_SIM_TOOL_TYPE_H
#define SPORE_SIM_TOOL_TYPE_H

#include "core/base/parameter.h"
#include "core/body/model.h"

#define SPORE_TOOL_BODIES 3 /* most bodies that the parameters of a tool refer to */

struct SporeWorld;
struct SporeTool;
typedef struct SporeToolType SporeToolType;

/* A tool of a world that is to be made. Its parts are active bodies: the device moves the first, the tool the rest. */
typedef struct SporeToolDescription {
  const SporeToolType *type;
  uint32_t bodies[SPORE_TOOL_BODIES]; /* in the order of the type's parameters; SPORE_NO_BODY: none */
  const void *fields; /* the structure of type->parameters, which begins with SporeToolFields; borrowed */
} SporeToolDescription;

/* First member of the fields of every kind. Names of bodies and devices are those of the scene's file; a world goes by
 * the description's bodies. */
typedef struct SporeToolFields {
  const char *name, *body, *device;
} SporeToolFields;

/* Actions of a tool, now and so far. */
typedef struct SporeToolState {
  const char *name;
  double opening;    /* rad */
  double squeeze;    /* torque against closing, on the jaw where it is more, N m */
  size_t held, lost; /* spheres that it holds; that tore away since it last opened */
  size_t taken;      /* particles that suction took away so far */
  size_t cut;        /* ties that scissors cut so far */
  size_t pierced;    /* surfaces that a needle pierced so far */
  size_t stitches;   /* places that it or its thread goes through now */
  size_t coagulated; /* ties and elements that bipolar coagulated in the last step */
} SporeToolState;

struct SporeToolType {
  const char *element; /* as in the file: "grasper" */
  const char *label;   /* for people, translatable (N_) */
  const char *doc;     /* one sentence, translatable (N_) */
  SporeParameterTable parameters;
  bool cuts, heats, takes_particles; /* models make room for these actions */

  /* Required. */
  size_t size; /* bytes of the tool's own structure, whose first member is a SporeTool */
  /* Fills the tool, whose base is set and whose springs have room. False: no memory. */
  bool (*make)(struct SporeWorld *world, struct SporeTool *tool, const SporeToolDescription *from);

  /* Optional. */
  /* Number of springs that the tool needs for holding. NULL: none. */
  size_t (*spring_count)(const void *fields);
  /* The fault of the description (translated: what, what was expected, what to do); NULL: it has none. */
  const char *(*fault)(const struct SporeWorld *world, const SporeToolDescription *from);
  void (*clear)(struct SporeTool *tool);
  /* Back to time 0. */
  void (*reset)(struct SporeWorld *world, struct SporeTool *tool);
  /* Acts on the state after the last step, between reading the devices and mapping the spheres. */
  void (*use)(struct SporeWorld *world, struct SporeTool *tool);
  /* Takes particles out of the next state. */
  void (*exchange)(struct SporeWorld *world, struct SporeTool *tool);
  /* After the step: overloaded holds tear away. */
  void (*tear)(struct SporeWorld *world, struct SporeTool *tool);
  /* Adds forces on the tool's other bodies to the feedback of the device. */
  void (*feed_back)(struct SporeWorld *world, const struct SporeTool *tool);
  /* Adds the tool's actions, now and so far, to the state. */
  void (*state)(const struct SporeTool *tool, SporeToolState *state);
};

/* How the jaws of graspers, clamps and scissors close and hold. */
typedef enum SporeTrigger {
  SPORE_TRIGGER_GRIP,  /* opening is the device's grip angle */
  SPORE_TRIGGER_BUTTON /* closed while the first button is down */
} SporeTrigger;
typedef struct SporeJawFields {
  SporeToolFields tool;
  const char *jaw_a, *jaw_b;
  double hinge[3], axis[3]; /* world, at time 0: jaw_a opens by turning about the axis, jaw_b against it */
  double tip[3];            /* of scissors: end of the closed blades; world, at time 0 */
  double opening;           /* rad, between the jaws, at most */
  double speed;             /* rad/s */
  double torque;            /* N m about the hinge, on each jaw, at most */
  double stiffness;         /* N/m, of each hold */
  double strength;          /* N: a hold lets go above */
  int64_t holds;            /* spheres that can be held at a time */
  int trigger;              /* SporeTrigger */
} SporeJawFields;

typedef enum SporeFlowTrigger { SPORE_FLOW_ALWAYS, SPORE_FLOW_BUTTON } SporeFlowTrigger;
typedef struct SporeSuctionFields {
  SporeToolFields tool;
  double point[3]; /* middle of the mouth; world, at time 0 */
  double radius;   /* m, of the mouth */
  double rate;     /* particles a second, at most */
  int trigger;     /* SporeFlowTrigger */
} SporeSuctionFields;

typedef struct SporeBipolarFields {
  SporeToolFields tool;
  double point[3];   /* between the tips; world, at time 0 */
  double radius;     /* m, about the point */
  double rate;       /* 1/s: the part of the tissue there that coagulates in a second */
  double least;      /* part of their length that coagulated tissue keeps */
  double stiffening; /* its stiffness against what it was */
} SporeBipolarFields;

typedef struct SporeNeedleFields {
  SporeToolFields tool;
  const char *thread;
  double tip[3], middle[3], swage[3]; /* on the needle's arc, which ends at the swage, where the thread begins */
  double force;                       /* N of the tip, that pierces */
  double depth;                       /* m that the tip pushes a surface before it, at most */
  double stiffness; /* N/m, of each place that needle or thread goes through, and of the thread's end at the needle */
  double friction;  /* Coulomb coefficient there */
  double strength;  /* N: a stitch tears out above; 0: never */
  int64_t stitches; /* places at a time */
  bool knot;        /* the thread's other end does not go through */
} SporeNeedleFields;

/* Indices in SporeToolDescription.bodies, besides the first. */
enum { SPORE_TOOL_JAW_A = 1, SPORE_TOOL_JAW_B = 2, SPORE_TOOL_THREAD = 1 };

extern const SporeToolType
    spore_grasper; /* two jaws on a hinge close while the device says so, and hold what they press */
extern const SporeToolType spore_clamp;    /* the same, and stays closed until the second button opens it */
extern const SporeToolType spore_scissors; /* blades that cut what they close on along their way; they need no jaws */
extern const SporeToolType spore_suction;  /* takes the particles of fluids away that come into its mouth */
extern const SporeToolType spore_bipolar;  /* coagulates tissue near its point while the first button is down */
extern const SporeToolType spore_needle;   /* pierces what its tip is pushed through, and draws its thread after it */

extern const SporeToolType *const spore_tool_types[];           /* NULL at the end */
const SporeToolType *spore_tool_type_find(const char *element); /* NULL: there is none */

#endif
