/* The world: a scene compiled for running. All arrays are flat, and get their size when the world is created. A step
 * allocates, locks and prints nothing, with one exception: it makes room where there are more contacts than ever
 * before.
 *
 * Threads: one thread steps a world. One other thread may read it by spore_world_snapshot_acquire, and one other thread
 * may change it by spore_world_post. All other functions belong to the thread that steps, unless they say otherwise.
 *
 * Arguments `body`, `link` and `tool` are indices, in the order of the description, and lie below the count of their
 * kind. Units are SI. */
#ifndef SPORE_SIM_WORLD_H
#define SPORE_SIM_WORLD_H

#include "core/base/cancel.h"
#include "core/base/profile.h"
#include "core/base/threads.h"
#include "core/collide/sphere.h"
#include "core/haptic/device.h"
#include "core/integrate/solver.h"
#include "core/body/model.h"
#include "core/sim/link/link_type.h"
#include "core/sim/lod/lod_type.h"
#include "core/sim/tool/tool_type.h"

/* A world; its structure is private. */
typedef struct SporeWorld SporeWorld;

/* What moves a body. */
typedef enum SporeRole {
  SPORE_UNMOVABLE, /* nothing: the body stays in its pose */
  SPORE_ACTIVE,    /* its device, or a tool: they prescribe its pose, and get the reaction force */
  SPORE_PASSIVE    /* physics: the body has a model */
} SporeRole;

/* What other bodies feel of an unmovable or active body. */
typedef enum SporeSurface {
  SPORE_SURFACE_SPHERES,    /* each sphere by itself */
  SPORE_SURFACE_DEPTH_FIELD /* all spheres as one smooth depth: core/collide/depth_field.h */
} SporeSurface;

/* Contact law of a body. The springs and dampers of two bodies in contact are in series (1/k = 1/k_a + 1/k_b), and the
 * smaller friction coefficient counts. */
typedef struct SporeContactFields {
  double stiffness; /* N/m, of each sphere */
  double damping;   /* N s/m, of each sphere */
  double friction;  /* Coulomb coefficient */
  bool self;        /* spheres of this body collide with each other, except those that touch at rest */
  double margin;    /* m: spheres nearer than the sum of both bodies' margins are contacts already */
  int64_t group;    /* bodies of one group never collide with each other; 0: the body is in no group */
  int surface;      /* SporeSurface; only of an unmovable or active body */
} SporeContactFields;
/* The parameters of SporeContactFields. */
extern const SporeParameterTable spore_contact_parameters;

/* A body of a world that is to be made. */
typedef struct SporeBodyDescription {
  const char *name; /* unique, not empty */
  SporeRole role;
  SporeModel *model;       /* of a passive body: owned by the world once spore_world_create succeeded; else NULL */
  SporeLodDescription lod; /* coarser levels of detail; `model` is the level SPORE_LOD_FINE */
  SporeIntegratorKind integrator; /* of a passive body; SPORE_INTEGRATOR_DEFAULT: as the world's solver says */
  size_t substeps;                /* of the integrator in a step; 0: as the world's solver says */
  SporePose pose;                 /* of the body's frame at time 0 */
  SporeVec3 velocity, spin;       /* at time 0, m/s and rad/s, world axes */
  bool effect;                    /* of a passive body: at time 0 it is moved by an effect, see SporeEffectForm */
  size_t start_count;             /* numbers of `start` */
  const double *start; /* the body's q at time 0, at which it stands still, without spare nodes. Links and all else are
                          made where the model puts the body (`pose`); the body is then set here. NULL: it begins where
                          the model puts it, with velocity and spin; an unmovable body has none */
  const SporeSphereSet *spheres; /* collision unit, body's frame at rest; borrowed; NULL: none */
  SporeContactFields contact;
} SporeBodyDescription;

/* How particles of a fluid come into the world while it runs: a wound that bleeds. The fluid has `reserve` of its
 * particles out of the world at time 0. The emitter puts these into the world, and those that suction took away. */
typedef struct SporeEmitterFields {
  double flow;     /* m^3/s; above 0, rate and speed follow from this and the mouth: see spore_emitter_parameters */
  double rate;     /* particles a second at most: no particle is put where another one still is */
  double speed;    /* m/s, of a new particle */
  double radius;   /* m, of the mouth */
  double start;    /* s, simulated time before which nothing comes */
  int64_t reserve; /* particles */
  int trigger;     /* SporeFlowTrigger; the button is that of the device that moves the source */
  double clamp_distance; /* m, of a wound: clamps that are closed nearer on the source stop it */
  int64_t clamps;        /* so many of them */
} SporeEmitterFields;
/* The parameters of SporeEmitterFields. */
extern const SporeParameterTable spore_emitter_parameters;

/* An emitter of a world that is to be made. */
typedef struct SporeEmitterDescription {
  const char *name;
  uint32_t body;              /* the fluid */
  uint32_t source;            /* the body that the mouth moves with; SPORE_NO_BODY: the world */
  SporeVec3 point, direction; /* middle of the mouth, m, and the way out of the mouth; world, at time 0 */
  SporeEmitterFields fields;
  bool effect; /* at time 0: what comes out is counted, and stains the source, and no particle comes out */
} SporeEmitterDescription;

/* All that a world is made from. The arrays are borrowed during spore_world_create. */
typedef struct SporeWorldDescription {
  size_t body_count, link_count, tool_count, emitter_count, eye_count;
  const SporeToolDescription *tools;
  const SporeEmitterDescription *emitters;
  const SporeEyeDescription *eyes;
  const SporeBodyDescription *bodies;
  const SporeLinkDescription *links;
  SporeVec3 gravity; /* m/s^2 */
  SporeSolverFields solver;
  const SporeCancel *cancel; /* ends making the world, and steps; borrowed as long as the world lives; NULL: none */
  bool unpruned; /* for measuring what pruning saves: every stage runs, no body sleeps, and spheres of unmovable bodies
                    are mapped and put in the grid at each step */
} SporeWorldDescription;

/* A world at time 0, to be freed by spore_world_free. Names are copied; the models belong to the world from then on.
 * pool: threads for long loops, borrowed as long as the world lives; NULL: the calling thread alone. The results do not
 * depend on the pool.
 * NULL with the error where there is no memory, where a number is not finite or out of its range, where a pin holds
 * nothing, where nothing that a link ties can move, where a body cannot be integrated as asked, or where it was
 * cancelled (SPORE_ERROR_CANCELLED). The error's place is "bodies/NAME", "links/NAME" or the like. The models still
 * belong to the caller then. */
SporeWorld *spore_world_create(const SporeWorldDescription *description, SporePool *pool, SporeError *error);
/* Frees the world and its models. Devices and the pool stay. NULL is allowed. */
void spore_world_free(SporeWorld *world);

/* One step of solver.time_step seconds. The stages of the step stand in one table, in step.c. A step that is cancelled
 * ends after a bounded piece of work, and so do all later steps before a reset: see spore_world_cancelled. */
void spore_world_step(SporeWorld *world);
/* Whether a step was cancelled since time 0. The state, its time and its number are those before that step. Commands
 * and instruments may have taken effect in part, so that only a reset makes the world go on. */
bool spore_world_cancelled(const SporeWorld *world);
/* Back to time 0: the state is the same to the bit. */
void spore_world_reset(SporeWorld *world);

/* Sets the device that moves an active body. The device is borrowed. NULL: the body stays where it is. */
void spore_world_set_device(SporeWorld *world, uint32_t body, SporeDevice *device);
/* The device that moves an active body; NULL: none. */
SporeDevice *spore_world_device(const SporeWorld *world, uint32_t body);

/* The input that the last step took from the device of an active body, for recording. The guard has checked that input.
 * *time_s: the simulated time of the input. NULL: the body has no device, or the device has not given any input yet. */
const SporeDeviceState *spore_world_input(const SporeWorld *world, uint32_t body, double *time_s);

/* What the device of an active body is told of the last step: the force and torque on the body, within the limits of
 * the guard, and the force on the grip. NULL: the body has no device. Valid until the next step. */
const SporeDeviceCommand *spore_world_feedback(const SporeWorld *world, uint32_t body);
/* Force (N) and torque (N m) of contacts and links on the body in the last step, 6 doubles.
 * Torques are about the origin of a frame; of a body of nodes, about where that origin was at time 0. A body asleep
 * keeps what it had when it fell asleep. Valid until the next step. */
const double *spore_world_reaction(const SporeWorld *world, uint32_t body);

/* Number of bodies. */
size_t spore_world_body_count(const SporeWorld *world);
/* Index of the body of that name; SPORE_NO_BODY: there is none. */
uint32_t spore_world_find_body(const SporeWorld *world, const char *name);
/* Name of the body; owned by the world. */
const char *spore_world_body_name(const SporeWorld *world, uint32_t body);
/* What moves the body. */
SporeRole spore_world_body_role(const SporeWorld *world, uint32_t body);
/* The body whose device moves the active body: the shaft for a jaw, else the body itself. SPORE_NO_BODY: the body is
 * not active. */
uint32_t spore_world_hand(const SporeWorld *world, uint32_t body);
/* Model of the body at its present level of detail; owned by the world. NULL: physics does not move the body. */
const SporeModel *spore_world_body_model(const SporeWorld *world, uint32_t body);
/* Number of steps since time 0. */
uint64_t spore_world_step_count(const SporeWorld *world);
/* Simulated time since time 0, s. */
double spore_world_time_s(const SporeWorld *world);
/* Spheres of all bodies, where the last step mapped them: from the state with which that step began. */
const SporeSpheres *spore_world_spheres(const SporeWorld *world);
/* Radius, m, at which each sphere of a set is felt when it touches something else. Without weights this is the radius
 * in the set. With weights, the depth is a weighted sum over spheres less the set's level; the radius at which that sum
 * begins to be felt is smaller than the radius in the set. Checks and pictures use these radii.
 * radius: set->count values, `stride` doubles from one to the next. False: no memory; the values are the radii in the
 * set then. */
bool spore_spheres_radii(const SporeSphereSet *set, double *radius, size_t stride);
/* Number of the body's collision spheres. */
size_t spore_world_body_sphere_count(const SporeWorld *world, uint32_t body);
/* Places on a body's spheres that a fluid may stain. */
typedef struct SporeStainPlaces {
  size_t start, count;   /* in the stains of snapshots */
  const double *rest;    /* count x 3, body's frame at rest, m; owned by the world, and never changed */
  const float *out;      /* count x 3: unit vectors out of the body; likewise */
  const uint32_t *first; /* of each sphere the first of its places, and one more; likewise */
} SporeStainPlaces;
SporeStainPlaces spore_world_stain_places(const SporeWorld *world, uint32_t body);
/* Mean stain of these places now, 0..1. A stain is seen and changes nothing else: state and hashes are without it. */
double spore_world_stained(const SporeWorld *world, uint32_t body);
/* What is on the lens of an eye, and before it; each 0..1. A lens is seen and changes nothing else, as a stain. */
typedef struct SporeLensState {
  float blood; /* share of the front that blood covers */
  float water; /* the same of water */
  float haze;  /* of the light from what the eye looks at, the share that smoke takes away */
} SporeLensState;
/* Number of lenses: one of each eye, in the order of the description. */
size_t spore_world_lens_count(const SporeWorld *world);
SporeLensState spore_world_lens(const SporeWorld *world, size_t lens);
/* The body that carries the lens; SPORE_NO_BODY: none does. */
uint32_t spore_world_lens_body(const SporeWorld *world, size_t lens);
/* Gives the lenses of `to` what is on those of `from`, where there are as many. */
void spore_world_carry_lenses(SporeWorld *to, const SporeWorld *from);
/* Gives a body of `to` the stain that body `old` of `from` has, where the places are the same. */
void spore_world_carry_stain(SporeWorld *to, uint32_t body, const SporeWorld *from, uint32_t old);
/* Whether spheres of the body collide with each other, as its contact law says now. */
bool spore_world_body_meets_itself(const SporeWorld *world, uint32_t body);
/* Number of velocity components that physics moves. */
size_t spore_world_dof(const SporeWorld *world);
/* Configuration of the body: q_count doubles of its model, see core/body/model.h. A body without a model has 7:
 * position and quaternion wxyz of its frame. Valid until the next step. */
const double *spore_world_q(const SporeWorld *world, uint32_t body);
/* Velocity of the body: 3 doubles a block of its model. A body without a model has 6: velocity and angular velocity,
 * world axes. Valid until the next step. */
const double *spore_world_v(const SporeWorld *world, uint32_t body);
/* Overwrites the state of a body, with as many numbers as spore_world_q and spore_world_v give. Lets the body move
 * again if it was frozen, wakes all bodies, and drops the contacts and the friction of the state before. A device that
 * moves the body is taken to stand there, so that its next input does not count as a jump, and jaws are as far open as
 * their bodies are. For carrying a state over to another world, and for tests. */
void spore_world_set_state(SporeWorld *world, uint32_t body, const double *q, const double *v);
/* Puts a body at a level of detail that it has, with the level's state at time 0. The caller sets the state next. */
void spore_world_set_lod(SporeWorld *world, uint32_t body, SporeLodGrade level);

/* Whether the body was cut, torn or coagulated since time 0, which its q does not tell. */
bool spore_world_body_altered(const SporeWorld *world, uint32_t body);

/* Makes the mapping of points to the body at its present level of detail, whatever its role; for viewers and measuring.
 * points: count x 3, body's frame at rest, m. The caller frees the mapping by spore_mapping_clear. A viewer evaluates
 * it at the body's part of a snapshot: snapshot->q + spore_world_q_offset(world, body). False: no memory, or a point
 * lies where the body cannot carry it. */
bool spore_world_map(const SporeWorld *world, uint32_t body, const double *points, size_t count, SporeMapping *mapping,
                     SporeError *error);
/* Pose of the body's frame at time 0. Any thread may ask. */
SporePose spore_world_start_pose(const SporeWorld *world, uint32_t body);
/* Where the body begins in q of a snapshot, in doubles. Any thread may ask. */
size_t spore_world_q_offset(const SporeWorld *world, uint32_t body);
/* Index of the body's first tetrahedron in SporeCuts.corners of a snapshot. SIZE_MAX: no cut can split nodes of the
 * body.
 */
size_t spore_world_corner_start(const SporeWorld *world, uint32_t body);
/* Where the body begins in v of a snapshot, in doubles. Any thread may ask. */
size_t spore_world_v_offset(const SporeWorld *world, uint32_t body);

/* Level of detail of the body at time 0. Any thread may ask. */
SporeLodGrade spore_world_first_lod(const SporeWorld *world, uint32_t body);
/* Model of the body at a level of detail; owned by the world. NULL: there is no such level. Any thread may ask. */
const SporeModel *spore_world_lod_model(const SporeWorld *world, uint32_t body, SporeLodGrade level);
/* As spore_world_map, at a level of detail that the body has. */
bool spore_world_map_lod(const SporeWorld *world, uint32_t body, SporeLodGrade level, const double *points,
                         size_t count, SporeMapping *mapping, SporeError *error);
/* As spore_world_map_lod, of the vertices of a mesh that is only drawn, where the model has a mapping of its own for
 * such meshes (SporeModelType.carry). mesh: body's frame at rest. */
bool spore_world_map_drawn(const SporeWorld *world, uint32_t body, SporeLodGrade level, const SporeTriangleMesh *mesh,
                           SporeMapping *mapping, SporeError *error);
/* Fills *state. False: the body has but one level. */
bool spore_world_lod_state(const SporeWorld *world, uint32_t body, SporeLodState *state);
/* Number of changes of level that were made since time 0, of all bodies. */
uint64_t spore_world_lod_change_count(const SporeWorld *world);
/* Change i, from 0; one of the last SPORE_LOD_LOG. */
SporeLodChange spore_world_lod_change(const SporeWorld *world, uint64_t i);
/* The rule by which the body changes its level by itself; BY_HAND: it does not. */
SporeLodRule spore_world_lod_rule(const SporeWorld *world, uint32_t body);
/* Whether the body may be cut or torn, which only its finest level can: by error and time it is not made coarser. */
bool spore_world_may_be_cut(const SporeWorld *world, uint32_t body);
/* Whether the same scene and input give the same bits: false where the level of some body follows the clock. */
bool spore_world_is_repeatable(const SporeWorld *world);
/* Bytes of the mappings, matrices and states that the levels of a body take, without models and factors. */
size_t spore_world_lod_memory(const SporeWorld *world, uint32_t body);

/* A line whose control points are inserted where it bends, and removed where it is straight again. */
typedef struct SporeLineState {
  size_t made, points, peak, reserve; /* control points: at time 0; now; at most so far; that there is room for */
  uint64_t inserted, removed;         /* control points, since time 0 */
  size_t memory_bytes;                /* of the room in the world */
  double look_us, change_us;          /* mean time of looking for bends in a step, and of a change of control points */
} SporeLineState;
/* Fills *state. False: the body is no such line. */
bool spore_world_line_state(const SporeWorld *world, uint32_t body, SporeLineState *state);

/* What a link did in the last step. */
typedef struct SporeLinkState {
  const char *name; /* owned by the world */
  SporeVec3 force;  /* on body_a, N */
  double load;      /* sum of the forces at the link's points, N: the link breaks where this exceeds its strength */
  double drift;     /* largest distance between points that the link holds together, when the step began, m; 0 for a
                       spring */
  double along;     /* of a link along the line of a body: the place of the point on that line, as a part of the line's
                       parameter: 0 at its start, 1 at its end */
  bool broken;      /* the link broke, or its point slipped off the line; lasts until reset */
} SporeLinkState;
/* Number of links, pins not counted. */
size_t spore_world_link_count(const SporeWorld *world);
/* Name of a link; owned by the world. Any thread may ask. */
const char *spore_world_link_name(const SporeWorld *world, size_t link);
/* State of a link, in the order of the description without the pins. */
SporeLinkState spore_world_link_state(const SporeWorld *world, size_t link);

/* Number of tools. */
size_t spore_world_tool_count(const SporeWorld *world);
/* Kind of a tool, in the order of the description. */
const SporeToolType *spore_world_tool_type(const SporeWorld *world, size_t tool);
/* State of a tool, in the order of the description. */
SporeToolState spore_world_tool_state(const SporeWorld *world, size_t tool);
/* Whether the tool is an effect now; and of emitter i, in the order of the description. */
bool spore_world_tool_is_effect(const SporeWorld *world, size_t tool);
size_t spore_world_emitter_count(const SporeWorld *world);
bool spore_world_emitter_is_effect(const SporeWorld *world, size_t emitter);
/* Where a tool acts now, m: the end of blades, the tip of a needle, the mouth of suction, the point that heats, or the
 * middle between the spheres of closed jaws that are farthest from the hinge. */
SporeVec3 spore_world_tool_tip(const SporeWorld *world, size_t tool);
/* Number of spheres of the body that the tool's jaws hold now. */
size_t spore_world_tool_holds(const SporeWorld *world, size_t tool, uint32_t body);
/* What tools have done to a body since time 0, whichever tool it was. */
typedef struct SporeBodyMarks {
  uint64_t cut;        /* ties */
  uint64_t coagulated; /* ties and elements, counted in each step in which they were heated */
  uint64_t pierced;    /* surfaces */
  uint64_t sucked;     /* particles */
  uint64_t poured;     /* particles that emitters put into the world */
  uint64_t seeped;     /* of a fluid: as many would have come out of emitters that are effects */
} SporeBodyMarks;
SporeBodyMarks spore_world_body_marks(const SporeWorld *world, uint32_t body);

/* Number of contacts in the last step, of bodies that are awake. */
size_t spore_world_contact_count(const SporeWorld *world);
/* Two bodies that met in the last step. */
typedef struct SporeTouch {
  uint32_t body_a, body_b;
  double force; /* normal, N; 0: their margins met, and they did not press */
} SporeTouch;
/* Contact i, below the count. */
SporeTouch spore_world_contact(const SporeWorld *world, size_t i);

/* Number of the body's particles that are in the world: neither in reserve, nor taken away, nor dissolved. */
size_t spore_world_particle_count(const SporeWorld *world, uint32_t body);
/* A particle out of the world is kept far away from everything: its x coordinate is larger than this, m. */
#define SPORE_PARTICLES_OUT_M 500.
/* Whether a particle is out of the world. position: 3 doubles, m. */
static inline bool spore_particle_is_out(const double *position) { return position[0] > SPORE_PARTICLES_OUT_M; }

/* Energy, J. */
typedef struct SporeEnergy {
  double kinetic;
  double internal; /* of the models, links, holds and pulls */
  double gravity;  /* sum of -m g . x over all nodes; x: position in the world */
  double contact;  /* of the contact springs */
} SporeEnergy;
/* Energy of the present state. */
SporeEnergy spore_world_energy(const SporeWorld *world);

/* Hash of the bits of q, v, step and time. */
uint64_t spore_world_hash(const SporeWorld *world);
/* The same of one body. */
uint64_t spore_world_body_hash(const SporeWorld *world, uint32_t body);

/* A stage of the step, in the world's plan. */
typedef struct SporePlanStage {
  const char *name;   /* "detect" */
  bool included;      /* the step runs the stage */
  const char *reason; /* why it is included or not; translated */
  double estimate_us; /* of a step, from counts, on a machine of 2024: of a quiet one, so that contacts that are not
                         there yet are not in it; 0 where it is not included */
  size_t items;       /* what the stage works on: spheres, pairs, links, degrees of freedom, ... */
  const SporeProfilePhase *profile; /* times that the stage took; NULL where it is not included */
} SporePlanStage;
/* Something that the world does without. */
typedef struct SporePlanLeftOut {
  const char *what, *reason; /* translated; owned by the world */
  const char *stages;        /* names of the stages that are left out, or that do less, with a space between */
} SporePlanLeftOut;
/* Which stages the step of a world runs, what the world does without, and why. */
typedef struct SporePlan {
  size_t stage_count, left_out_count;
  double estimate_us;           /* of a step: the sum over the stages */
  const SporePlanStage *stages; /* in the order of the step */
  const SporePlanLeftOut *left_out;
} SporePlan;
/* The plan; owned by the world. It changes where a command starts or ends a pull. */
const SporePlan *spore_world_plan(const SporeWorld *world);

/* Who chose a method. */
typedef enum SporeMethodSource {
  SPORE_SOURCE_BODY,      /* the body's mechanical unit */
  SPORE_SOURCE_SCENE,     /* the scene's solver section */
  SPORE_SOURCE_AUTOMATIC, /* the world, since the scene leaves it open; solvers are chosen anew as the work of steps
                             shows */
  SPORE_SOURCE_MONITOR    /* the monitor: a safer one than the scene's */
} SporeMethodSource;
/* A method and who chose it. */
typedef struct SporeChoice {
  const char *name; /* as in the file; NULL: the body is integrated explicitly, so that there is nothing to solve */
  SporeMethodSource source;
} SporeChoice;
/* What makes steps of a body with an explicit method implicit. Then implicit Euler moves the body; particles keep their
 * method, and their contacts alone are implicit. */
typedef enum SporeCoupled {
  SPORE_COUPLED_NEVER,    /* nothing: nothing ties the body or can touch it; or its method is implicit */
  SPORE_COUPLED_CONTACTS, /* contacts, in steps that do not resolve them */
  SPORE_COUPLED_LINKS,    /* links that a step does not resolve, or links with bodies of other methods */
} SporeCoupled;
/* How far impacts of a body are followed, so that it leaves them as fast at any step. */
typedef enum SporeImpacts {
  SPORE_IMPACTS_NONE,     /* nothing can touch the body, or it is not rigid: its own swings take more of an impact */
  SPORE_IMPACTS_FOLLOWED, /* in parts as short as the contacts need */
  SPORE_IMPACTS_LINKED,   /* not followed, since a link ties the body */
} SporeImpacts;
/* How a passive body is integrated and solved now. */
typedef struct SporeMethod {
  SporeChoice integrator, nonlinear, linear;
  size_t substeps;
  SporeMethodSource substeps_source;
  bool balances; /* static, and held by a pin or a link: each step finds a balance, one of several that there may be */
  SporeCoupled coupled;
  size_t resolving; /* coupled by links: as many substeps would resolve them; 0: no number of them does */
  SporeImpacts impacts;
  double margin; /* coupled by contacts: steps are implicit, too, in which spheres are so near, m, at most; 0: none */
} SporeMethod;
/* Work that a body takes on one core, s: estimated from counts of blocks, and from how long a block took on a machine
 * of 2024, so that every machine says the same. */
typedef struct SporeBodyWork {
  double make_s;   /* to make its matrix, and to analyse its factor */
  double factor_s; /* to factorise once; 0: it is never factorised */
  double step_s;   /* a step in which it moves, at the least: an iteration by the cheaper of the solvers that it has */
  double time_step_s; /* the world's: what a step may take in real time */
} SporeBodyWork;
/* Fills *work. False: the body is not integrated implicitly. */
bool spore_world_body_work(const SporeWorld *world, uint32_t body, SporeBodyWork *work);
/* Fills *method. False: physics does not move the body. */
bool spore_world_body_method(const SporeWorld *world, uint32_t body, SporeMethod *method);
/* The share of its energy that the body's method takes from its slowest swing in a second, 0..1, beside all damping
 * that the scene asks for: of a rigid body on a ball joint as it swings now, and of an elastic body that pins alone
 * hold in small swings about where it is. Takes memory, and as long as a factor. False: the swing is not known. */
bool spore_world_body_damping(const SporeWorld *world, uint32_t body, double *share);
/* Times of whole steps. */
const SporeProfilePhase *spore_world_profile(const SporeWorld *world);

#define SPORE_MONITOR_MESSAGES 64 /* that the monitor keeps: the last ones */
/* A message of the monitor. */
typedef struct SporeMonitorMessage {
  uint64_t step;  /* in which it was written */
  char text[256]; /* names the body and the cause; translated */
} SporeMonitorMessage;
/* Monitor: what went wrong since time 0, and what was done about it. A step is counted once for each island in which
 * the trouble was met. */
typedef struct SporeMonitor {
  uint64_t recoveries;       /* steps taken again from the last good state: implicitly, or in smaller parts */
  uint64_t substeps;         /* extra parts of steps that this took */
  uint64_t not_finite;       /* steps taken again since the result was not finite; where that does not help, the body is
                                frozen */
  uint64_t too_fast;         /* steps taken again since something was faster than maximum_speed */
  uint64_t energy;           /* looks that found more energy made out of nothing than there was; the body is integrated
                                implicitly from then on */
  uint64_t not_converged;    /* steps that were accepted with a residual above the tolerance (SporeStepCounts.residual);
                                taken again before where the residual is large or energy was gained; of three in a row
                                of which nothing was solved, the body that is pulled hardest is frozen */
  uint64_t deep_contacts;    /* contacts deeper than the radius of the smaller sphere; reported only */
  uint64_t over_budget;      /* steps that took longer than the budget; reported only */
  uint64_t held_inputs;      /* inputs of devices that were refused: not finite, or a jump */
  uint64_t shortened_forces; /* forces on a device that were reduced since they gave the hand more energy than it had
                                put in */
  uint64_t broken_links;     /* links that broke, or whose point slipped off its line */
  uint64_t lost_holds;       /* holds of jaws, and stitches, that tore away */
  uint64_t torn_springs;     /* springs of nets that tore by too much strain, and springs that tore with them */
  uint64_t message_count;    /* messages ever written */
  SporeMonitorMessage messages[SPORE_MONITOR_MESSAGES]; /* message i, from 0, is at i % SPORE_MONITOR_MESSAGES */
} SporeMonitor;
/* The monitor; owned by the world. */
const SporeMonitor *spore_world_monitor(const SporeWorld *world);
/* Why a step of a body does not count as solved. The sentences are in state/unsolved.c. */
typedef enum SporeUnsolvedCause {
  SPORE_UNSOLVED_RESIDUAL, /* figure: the relative residual */
  SPORE_UNSOLVED_ROUNDING, /* the same, where rounding alone explains it */
  SPORE_UNSOLVED_FRICTION, /* friction was left out; no figure */
  SPORE_UNSOLVED_RETAKEN,  /* a step that went wrong was taken again in smaller ones; no figure */
  SPORE_UNSOLVED_STOOD_IN, /* another integrator than the scene's took the step; no figure */
  SPORE_UNSOLVED_MODEL,    /* the model capped or mended something, or is not meant for its state; no figure */
  SPORE_UNSOLVED_SAFER,    /* another integrator than the scene's moves the body; no figure */
  SPORE_UNSOLVED_FROZEN,   /* the body stands still; no figure */
  SPORE_UNSOLVED_PASSED,   /* a contact did not hold the body; figure: its speed, m/s */
  SPORE_UNSOLVED_LEFT_OUT, /* contacts had no room; figure: number of contacts, of all bodies together */
  SPORE_UNSOLVED_ENERGY,   /* energy out of nothing, as a share of the energy at work */
  SPORE_UNSOLVED_HALVES,   /* how far a step and its halves are apart, as a share of the speed */
  SPORE_UNSOLVED_TURNED,   /* a frame turned further than its turning is followed; figure: in a step, rad */
  SPORE_UNSOLVED_CAUSES
} SporeUnsolvedCause;
/* Steps of a body that were not solved as the scene is written, by one cause. */
typedef struct SporeUnsolved {
  uint32_t body;
  SporeUnsolvedCause kind;
  uint64_t steps;             /* in which the cause was met, since time 0 */
  double worst;               /* the largest figure of the cause so far, in `unit` */
  const char *unit;           /* "": a ratio; NULL: the cause has no figure */
  const char *cause, *remedy; /* sentences without a full stop, translated */
} SporeUnsolved;
/* Number of entries: one a body and cause that was met since time 0. 0: every step was solved as the scene is written.
 */
size_t spore_world_unsolved_count(const SporeWorld *world);
/* Entry i, by bodies, and of one body by causes. i: below the count. */
SporeUnsolved spore_world_unsolved(const SporeWorld *world, size_t i);
/* Sets the time that a step may take, us of the clock; 0: any. A longer step is counted and reported; nothing else
 * changes. */
void spore_world_set_budget(SporeWorld *world, double budget_us);
/* How fast a body may come for a contact to hold it: within the depth of the smaller sphere's radius r, a contact of
 * stiffness k stops the mass m up to the speed r sqrt(k/m) (core/collide/response.h). */
typedef struct SporeStoppingSpeed {
  double stops;   /* m/s: any contact with `other` alone stops it, up to this speed */
  double moves;   /* m/s: its fastest sphere, now */
  uint32_t other; /* the body that stops it least of all */
} SporeStoppingSpeed;
/* False: physics does not move the body, or it can touch nothing. */
bool spore_world_stopping_speed(const SporeWorld *world, uint32_t body, SporeStoppingSpeed *stopping);
/* Whether the monitor integrates the body by a safer integrator than the scene's. */
bool spore_world_body_made_safer(const SporeWorld *world, uint32_t body);
/* Whether the monitor froze the body: it stands still until SPORE_COMMAND_THAW or a reset. */
bool spore_world_body_frozen(const SporeWorld *world, uint32_t body);
/* What a body of a model does while a special effect takes the place of its physics. */
typedef enum SporeEffectForm {
  SPORE_EFFECT_CARRIED, /* its particles go with the air, and dissolve */
  SPORE_EFFECT_POURED,  /* its drops fall, lie on what they meet, and pool */
  SPORE_EFFECT_SHAPED,  /* it keeps the shape of time 0, and gives way to what devices move */
  SPORE_EFFECT_STILL    /* it stands still */
} SporeEffectForm;
SporeEffectForm spore_model_effect_form(const SporeModel *model);
/* Whether an effect moves the passive body now. */
bool spore_world_body_is_effect(const SporeWorld *world, uint32_t body);
/* Time that the effect takes of a step, us, and that the body's physics would take without contacts and links, by
 * counts on a machine of 2024. False: no effect moves the body. */
bool spore_world_effect_work(const SporeWorld *world, uint32_t body, double *effect_us, double *physics_us);
/* Whether the body sleeps: it was at rest for long enough, and is not computed until something wakes it. */
bool spore_world_body_asleep(const SporeWorld *world, uint32_t body);

/* Work between two steps that may allocate. A body whose nodes or control points changed is solved by conjugate
 * gradients alone. When nothing changed for 16 steps, this function makes a factor of its new matrix. The caller calls
 * it after each step, or never. True: something was done. */
bool spore_world_tidy(SporeWorld *world);

/* Counts of the last step. */
typedef struct SporeStepCounts {
  size_t contacts, islands; /* of bodies that are awake */
  size_t sleeping;          /* bodies asleep during the step */
  size_t newton_iterations, linear_iterations, force_evaluations;
  double residual; /* largest relative residual of the equations that islands solved, evaluated again apart from the
                      solver; 0 for explicit ones */
  double contact_depth; /* m: of the deepest contact, when the step began; 0: no spheres overlap */
  double contact_force; /* N: sum of the normal forces of all contacts */
} SporeStepCounts;
/* Counts of the last step; all 0 before the first one. */
SporeStepCounts spore_world_counts(const SporeWorld *world);

/* A contact in a snapshot. */
typedef struct SporeSnapshotContact {
  SporeVec3 point, force;      /* world, m; force on sphere a, N */
  uint32_t sphere_a, sphere_b; /* indices in spore_world_spheres */
} SporeSnapshotContact;
/* A link in a snapshot. */
typedef struct SporeSnapshotLink {
  SporeVec3 a, b; /* world, m: the middles of the points at its ends, when the step began */
  double load;    /* N, as in SporeLinkState */
  bool broken;
} SporeSnapshotLink;
/* Tissue that an effect draws squeezed, between the jaws of a clamp. In its frame the jaws lie along x, from the hinge
 * at the origin, and close along z. */
typedef struct SporeSqueeze {
  uint32_t body;
  SporePose frame;              /* world, m */
  double length, width, height; /* m: of what is squeezed, from 0 along x; to both sides along y; to both along z */
  double ratio;                 /* what is left of its thickness there; beyond, ever more of it */
} SporeSqueeze;
/* What all tools together have done so far; see SporeToolState. */
typedef struct SporeToolCounts {
  size_t cut, pierced, stitches;
  double poured; /* m^3: out of emitters with a flow */
} SporeToolCounts;
/* Knots of the lines whose control points are inserted and removed; read them by spore_snapshot_knots. */
typedef struct SporeLines {
  uint64_t number;      /* changes whenever knots of any line change */
  size_t break_count;   /* room for the breaks of all lines */
  double *breaks;       /* break_count */
  uint32_t *span_count; /* one a body; NULL: the world has no such line */
} SporeLines;
/* A state of the world for a reader. Each step publishes one through a triple buffer; neither side waits for the other.
 * The arrays belong to the world. */
typedef struct SporeSnapshot {
  uint64_t step;
  double time_s;
  size_t q_count, v_count;
  const double *q, *v; /* all bodies; see spore_world_q_offset and spore_world_v_offset */
  uint8_t *level;   /* body_count, SporeLodGrade: the level of detail that q and v are of; NULL: bodies have but one */
  double *reaction; /* body_count x 6: force (N) and torque about the body's origin (N m) from contacts and links */
  size_t contact_count; /* of bodies that are awake; at most contact_capacity of these contacts are listed */
  size_t contact_capacity;
  SporeSnapshotContact *contacts;
  size_t link_count; /* as spore_world_link_count */
  SporeSnapshotLink *links;
  SporeCuts cuts;   /* since time 0 */
  uint64_t cut_run; /* changes whenever the list of cuts begins anew, by a reset */
  SporeLines lines;
  SporeStepCounts counts;
  SporeToolCounts tools;
  SporeEnergy energy; /* of this state, or of an earlier one: it is computed for the first step after a reader acquired
                         a snapshot */
  uint64_t stained;   /* changes whenever a stain changes; 0: nothing was ever stained */
  size_t stain_count;
  float *stain; /* stain_count, 0..1: how much of a fluid's colour each place has, see spore_world_stain_places */
  size_t lens_count;
  SporeLensState *lenses; /* lens_count */
  size_t squeeze_count;
  SporeSqueeze *squeezes; /* squeeze_count; see spore_squeeze_points */
  uint64_t message_count; /* as in SporeMonitor */
  SporeMonitorMessage messages[SPORE_MONITOR_MESSAGES];
  double step_us; /* time that the step took, us of the clock */
} SporeSnapshot;
/* Moves points of a body (point_count x 3, world, m) to where the squeezes draw them, which are those of a snapshot.
 * For pictures: nothing else knows of it. */
void spore_squeeze_points(const SporeSqueeze *squeezes, size_t count, uint32_t body, double *points,
                          size_t point_count);
/* spore_world_hash of the state in the snapshot. */
uint64_t spore_snapshot_hash(const SporeSnapshot *snapshot);
/* Knots of a body's line in the snapshot, to which the body's q in the snapshot belongs; breaks are borrowed from the
 * snapshot. Without spans: the knots of the body never change. */
SporeSplineKnots spore_snapshot_knots(const SporeWorld *world, const SporeSnapshot *snapshot, uint32_t body);
/* Adapts a mapping to these knots of the body's line. The mapping was made by spore_world_map or its like, for the
 * knots at time 0. Does nothing where `knots` has no spans. False: no memory. */
bool spore_world_follow_knots(const SporeWorld *world, uint32_t body, SporeSplineKnots knots, SporeMapping *mapping);
/* The newest snapshot. Valid until the next call; never NULL: before the first step it is that of time 0. For one
 * reader, on any thread. */
const SporeSnapshot *spore_world_snapshot_acquire(SporeWorld *world);

/* Kinds of commands, and the fields of SporeCommand that each uses. */
typedef enum SporeCommandKind {
  SPORE_COMMAND_GRAVITY, /* sets gravity to `vector`, m/s^2 */
  SPORE_COMMAND_PULL,    /* pulls the point of `body` that lies nearest to `point` toward `vector` (both world, m), by a
                            spring of stiffness `number`, N/m; the point of the body is chosen by the first PULL after a
                            RELEASE */
  SPORE_COMMAND_RELEASE, /* ends the pull on `body` */
  SPORE_COMMAND_RETUNE,  /* gives the model of `body` new parameters: `fields`, parameters.size bytes of its type, from
                            spore_allocate, freed by the world */
  SPORE_COMMAND_CONTACT, /* sets the contact law of `body` to `contact` */
  SPORE_COMMAND_THAW,    /* lets a frozen body move again */
  SPORE_COMMAND_LOD,     /* changes `body` to `level`; where that is refused, the monitor says why */
  SPORE_COMMAND_WIPE,    /* wipes the lens whose number is `number` */
  SPORE_COMMAND_TOOL_EFFECT,    /* makes the tool whose number is `number` an effect, or physical, as `effect` says */
  SPORE_COMMAND_EMITTER_EFFECT, /* the same of an emitter */
  SPORE_COMMAND_EFFECT /* moves `body` by an effect where `effect` is true, else by physics; where that is refused, the
                          monitor says why */
} SporeCommandKind;
/* A change of a running world. */
typedef struct SporeCommand {
  SporeCommandKind kind;
  uint32_t body;
  SporeVec3 point, vector;
  double number;
  void *fields;
  SporeContactFields contact;
  SporeLodGrade level;
  bool effect;
} SporeCommand;
/* Queues a command; the next step applies it when it begins. For one writer, on any thread. False: the queue is full
 * (1024 commands); `fields` still belong to the caller then. */
bool spore_world_post(SporeWorld *world, const SporeCommand *command);
/* Commands posted, and those of them that steps have applied, since the world was made. */
size_t spore_world_commands_posted(const SporeWorld *world);
size_t spore_world_commands_applied(const SporeWorld *world);

#endif
