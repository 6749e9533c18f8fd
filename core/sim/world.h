/* The world: a scene compiled for running. Flat arrays sized exactly; a step allocates, locks and prints nothing (room
 * for more contacts than ever before apart).
 *
 * Threads: one thread steps a world. Other threads read spore_world_snapshot_acquire (one reader) and write
 * spore_world_post (one writer). */
#ifndef SPORE_SIM_WORLD_H
#define SPORE_SIM_WORLD_H

#include "core/base/profile.h"
#include "core/base/threads.h"
#include "core/collide/sphere.h"
#include "core/haptic/device.h"
#include "core/integrate/solver.h"
#include "core/body/model.h"
#include "core/sim/link/link_type.h"
#include "core/sim/tool/tool_type.h"

typedef struct SporeWorld SporeWorld;

typedef enum SporeRole { SPORE_UNMOVABLE, SPORE_ACTIVE, SPORE_PASSIVE } SporeRole;

/* Contact law of a body; two bodies in contact take the harmonic sum of stiffness and damping (springs in series)
 * and the smaller friction. The table is spore_contact_parameters. */
typedef enum SporeSurface {
  SPORE_SURFACE_SPHERES,    /* each sphere by itself */
  SPORE_SURFACE_DEPTH_FIELD /* all spheres as one: core/collide/depth_field.h */
} SporeSurface;

typedef struct SporeContactFields {
  double stiffness; /* N/m, each sphere's */
  double damping;   /* N s/m */
  double friction;  /* Coulomb coefficient */
  bool self;        /* spheres of this body collide with each other, those that touch at rest excepted */
  double margin;    /* m: pairs are looked after in a step from so far apart, for each body that has it */
  int64_t group;    /* bodies of one group never collide with each other; 0: of none */
  int surface;      /* SporeSurface, of an unmovable or active body: what passive ones feel */
} SporeContactFields;
extern const SporeParameterTable spore_contact_parameters;

/* How finely a body is made. */
typedef enum SporeLevelGrade { SPORE_LEVEL_COARSE, SPORE_LEVEL_MEDIUM, SPORE_LEVEL_FINE } SporeLevelGrade;
#define SPORE_LEVEL_COUNT 3
extern const char *const spore_level_names[]; /* as in the file, NULL at the end */

/* The same body less finely made, to change to while it runs. */
typedef struct SporeLevelsDescription {
  SporeModel *model[SPORE_LEVEL_FINE]; /* of the body's own type, owned like that; NULL: there is no such level */
  SporeLevelGrade first;               /* at time 0 */
  double tolerance;                    /* m: a change that moves a point of the body further is refused */
  size_t surface_count;
  const double *surface; /* points besides spheres and nodes that the error is measured on, 3 each; borrowed */
} SporeLevelsDescription;

typedef struct SporeBodyDescription {
  const char *name;
  SporeRole role;
  SporeModel *model;              /* passive: owned by the world once spore_world_create succeeded; else NULL */
  SporeLevelsDescription levels;  /* besides that model, which is the level `fine` */
  SporeIntegratorKind integrator; /* passive; SPORE_INTEGRATOR_DEFAULT: the world's */
  size_t substeps;                /* of its integrator in a step; 0: the world's */
  SporePose pose;                 /* of the body's frame at time 0 */
  SporeVec3 velocity, spin;       /* at time 0 */
  const SporeSphereSet *spheres;  /* body's frame at rest; borrowed; NULL: no collision unit */
  SporeContactFields contact;
} SporeBodyDescription;

/* Where particles of a fluid come from while it runs: a wound that bleeds. The fluid keeps `reserve` of its particles
 * back at time 0; those, and what suction takes away, come out again. The table is spore_emitter_parameters. */
typedef struct SporeEmitterFields {
  double rate;     /* particles a second, at most: none comes where one still is */
  double speed;    /* m/s */
  double radius;   /* m, of the mouth */
  double start;    /* s */
  int64_t reserve; /* particles */
  int trigger;     /* SporeFlowTrigger; button: of the device that moves the source */
} SporeEmitterFields;
extern const SporeParameterTable spore_emitter_parameters;

typedef struct SporeEmitterDescription {
  const char *name;
  uint32_t body;              /* the fluid */
  uint32_t source;            /* body that the mouth is in; SPORE_NO_BODY: the world */
  SporeVec3 point, direction; /* world, at time 0 */
  SporeEmitterFields fields;
} SporeEmitterDescription;

typedef struct SporeWorldDescription {
  size_t body_count, link_count, tool_count, emitter_count;
  const SporeToolDescription *tools;
  const SporeEmitterDescription *emitters;
  const SporeBodyDescription *bodies;
  const SporeLinkDescription *links;
  SporeVec3 gravity; /* m/s^2 */
  SporeSolverFields solver;
} SporeWorldDescription;

/* Names are copied. On failure the models still belong to the caller. Refuses: no memory, a pin that holds nothing, a
 * link on a body without degrees of freedom at both ends, non-finite values; place is "bodies/NAME" or "links/NAME".
 */
SporeWorld *spore_world_create(const SporeWorldDescription *description, SporePool *pool, SporeError *error);
void spore_world_free(SporeWorld *world);

/* One step of solver.time_step. See world.c: it reads as the list in the architecture. */
void spore_world_step(SporeWorld *world);
/* Back to time 0, bit for bit. */
void spore_world_reset(SporeWorld *world);

/* Input of an active body; borrowed; NULL leaves it where it is. */
void spore_world_set_device(SporeWorld *world, uint32_t body, SporeDevice *device);

/* What the device of an active body was taken to say in the last step (after the guard), and at what simulated time;
 * for recording. NULL: it has none, or that has not spoken yet. */
const SporeDeviceState *spore_world_input(const SporeWorld *world, uint32_t body, double *time_s);

size_t spore_world_body_count(const SporeWorld *world);
uint32_t spore_world_find_body(const SporeWorld *world, const char *name); /* SPORE_NO_BODY: none */
const char *spore_world_body_name(const SporeWorld *world, uint32_t body);
SporeRole spore_world_body_role(const SporeWorld *world, uint32_t body);
/* The body whose device moves the active body: the shaft for a jaw, else itself; SPORE_NO_BODY for one not active. */
uint32_t spore_world_hand(const SporeWorld *world, uint32_t body);
const SporeModel *spore_world_body_model(const SporeWorld *world, uint32_t body); /* NULL: none */
uint64_t spore_world_step_count(const SporeWorld *world);
double spore_world_time_s(const SporeWorld *world);
const SporeSpheres *spore_world_spheres(const SporeWorld *world); /* as of the last step's map phase */
/* Radii that a set's spheres have as balls, in the world as to whom checks or draws it: those of one with weights reach
 * out only as far as their sum is felt. set->count of them, each `stride` numbers behind the one before. False: no
 * memory; they are those of the set then. */
bool spore_spheres_radii(const SporeSphereSet *set, double *radius, size_t stride);
size_t spore_world_body_sphere_count(const SporeWorld *world, uint32_t body);
size_t spore_world_dof(const SporeWorld *world); /* velocity components that physics moves */
/* Body's state, for measuring and carrying over; valid until the next step. A body without a model has the 7 + 6 of a
 * pose. */
const double *spore_world_q(const SporeWorld *world, uint32_t body);
const double *spore_world_v(const SporeWorld *world, uint32_t body);
/* Overwrites a body's state (carry-over, tests). Counts must match its model. */
void spore_world_set_state(SporeWorld *world, uint32_t body, const double *q, const double *v);
/* Puts a body at a level that it has, with its state at time 0; set its state next. */
void spore_world_set_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

/* Mapping of points given in the body's frame at rest, whatever its role; for viewers and measuring.
 * Feed it with the body's part of a snapshot: snapshot->q + spore_world_q_offset(world, body). */
bool spore_world_map(const SporeWorld *world, uint32_t body, const double *points, size_t count, SporeMapping *mapping,
                     SporeError *error);
size_t spore_world_q_offset(const SporeWorld *world, uint32_t body);
/* Its first tetrahedron in a snapshot's cuts; SIZE_MAX: it is of none that can be parted. */
size_t spore_world_corner_start(const SporeWorld *world, uint32_t body);
size_t spore_world_v_offset(const SporeWorld *world, uint32_t body);

/* Levels of a body. Those that there are, their models and that of time 0 never change; any thread may ask for them. */
SporeLevelGrade spore_world_first_level(const SporeWorld *world, uint32_t body);
const SporeModel *spore_world_level_model(const SporeWorld *world, uint32_t body, SporeLevelGrade level); /* or NULL */
/* spore_world_map at a level. */
bool spore_world_map_level(const SporeWorld *world, uint32_t body, SporeLevelGrade level, const double *points,
                           size_t count, SporeMapping *mapping, SporeError *error);
/* The same of what is drawn of the body (SporeModelType.carry). */
bool spore_world_map_drawn(const SporeWorld *world, uint32_t body, SporeLevelGrade level, const SporeTriangleMesh *mesh,
                           SporeMapping *mapping, SporeError *error);
typedef struct SporeLevelState {
  SporeLevelGrade level;     /* now */
  uint64_t changes, refused; /* since time 0 */
  double error;              /* m: how far the changes moved a sphere, a node or a point of the surface at most */
  double energy;             /* J: own energy (kinetic and internal) that a change added at most; negative: all lost */
  double momentum;           /* N s: by which a change missed the momentum of a free body at most, and the angular one
                                about its centre over its extent */
} SporeLevelState;
/* False: the body has but one level. */
bool spore_world_level_state(const SporeWorld *world, uint32_t body, SporeLevelState *state);
/* Bytes of the mappings, matrices and states that having levels takes, without models and factors. */
size_t spore_world_level_memory(const SporeWorld *world, uint32_t body);

/* Lines that get knots where they bend while it runs. */
typedef struct SporeLineState {
  size_t made, points, peak, reserve; /* control points: at time 0, now, at most so far, that there may be */
  uint64_t inserted, removed;         /* since time 0 */
  size_t memory_bytes;                /* that the reserve takes in the world */
  double look_us, change_us; /* that looking at its bends takes a step in the mean, and a change of its points */
} SporeLineState;
/* False: the body is none such. */
bool spore_world_line_state(const SporeWorld *world, uint32_t body, SporeLineState *state);

/* Links, without the pins, in the order of the description: what they did in the last step. */
typedef struct SporeLinkState {
  const char *name;
  SporeVec3 force; /* on body_a, N */
  double load;     /* what its points feel together, N: what strength is compared with */
  double drift;    /* how far the points that are to be together were apart at most when the step began, m; 0 for a
                      spring */
  double along;    /* of a body's own line: where on it the point is, 0 at its start to 1 at its end, by its spans */
  bool broken;     /* or slipped off; for good, until reset */
} SporeLinkState;
size_t spore_world_link_count(const SporeWorld *world);
SporeLinkState spore_world_link_state(const SporeWorld *world, size_t link);

/* Tools, in the order of the description. */
size_t spore_world_tool_count(const SporeWorld *world);
SporeToolState spore_world_tool_state(const SporeWorld *world, size_t tool);

/* Particles of a body that are in the world: not kept back, taken away or dissolved. Those stand so far off that they
 * are told by it. */
size_t spore_world_particle_count(const SporeWorld *world, uint32_t body);
#define SPORE_PARTICLES_OUT_M 500.
static inline bool spore_particle_is_out(const double *position) { return position[0] > SPORE_PARTICLES_OUT_M; }

/* Energy, J. */
typedef struct SporeEnergy {
  double kinetic, internal, gravity, contact;
} SporeEnergy;
SporeEnergy spore_world_energy(const SporeWorld *world);

/* Bits of q, v, step and time. */
uint64_t spore_world_hash(const SporeWorld *world);

/* Plan: which stages this world runs, and why; which it leaves out, and why. */
typedef struct SporePlanStage {
  const char *name; /* "detect" */
  bool included;
  const char *reason;               /* translated */
  size_t items;                     /* what it works on: spheres, pairs, links, degrees of freedom */
  const SporeProfilePhase *profile; /* NULL when left out */
} SporePlanStage;
typedef struct SporePlanLeftOut {
  const char *what, *reason; /* translated; owned by the world */
} SporePlanLeftOut;
typedef struct SporePlan {
  size_t stage_count, left_out_count;
  const SporePlanStage *stages;
  const SporePlanLeftOut *left_out;
} SporePlan;
const SporePlan *spore_world_plan(const SporeWorld *world);

/* How a body that physics moves is integrated and solved now, and who says so. */
typedef enum SporeMethodSource {
  SPORE_SOURCE_BODY,      /* its mechanical unit */
  SPORE_SOURCE_SCENE,     /* the solver section */
  SPORE_SOURCE_AUTOMATIC, /* left open: chosen by itself, and for nonlinear and linear anew as the work of steps tells
                           */
  SPORE_SOURCE_MONITOR    /* a safer one than the scene says */
} SporeMethodSource;
typedef struct SporeChoice {
  const char *name; /* as in the file; NULL: nothing is to be solved, the body is integrated explicitly */
  SporeMethodSource source;
} SporeChoice;
typedef struct SporeMethod {
  SporeChoice integrator, nonlinear, linear;
  size_t substeps;
  SporeMethodSource substeps_source;
} SporeMethod;
/* False: physics does not move the body. */
bool spore_world_body_method(const SporeWorld *world, uint32_t body, SporeMethod *method);
const SporeProfilePhase *spore_world_profile(const SporeWorld *world); /* of whole steps */

/* Monitor: what went wrong, and what was done about it. Counts are of steps, or of islands in them where several are
 * solved in one. Of message_count messages the last are kept: number i, from 0, at i % SPORE_MONITOR_MESSAGES. */
#define SPORE_MONITOR_MESSAGES 64
typedef struct SporeMonitorMessage {
  uint64_t step;
  char text[256]; /* names body and cause, translated */
} SporeMonitorMessage;
typedef struct SporeMonitor {
  uint64_t recoveries;       /* steps taken again from the last good state, implicitly and in smaller ones */
  uint64_t substeps;         /* extra steps that this cost */
  uint64_t not_finite;       /* taken again for that; what cannot be mended is frozen */
  uint64_t too_fast;         /* the same, above maximum_speed */
  uint64_t energy;           /* the same, where an explicit step made energy without bound; implicit from then on */
  uint64_t not_converged;    /* solver ended above its tolerance; taken again where it did by far, or gained energy */
  uint64_t deep_contacts;    /* contacts deeper than the smaller sphere's radius: said, and let be */
  uint64_t soft_contacts;    /* contacts at rest that hold less than half of what they should: said, and let be */
  uint64_t over_budget;      /* steps that took longer than the budget: said, and let be */
  uint64_t held_inputs;      /* device states refused (not finite, or a jump) */
  uint64_t shortened_forces; /* that would have given a hand more energy than it gave */
  uint64_t broken_links;     /* that held too much, or slipped off their line */
  uint64_t lost_holds;       /* of jaws, the same */
  uint64_t torn_springs;     /* of nets, strained more than they bear, and what went with those */
  uint64_t message_count;    /* ever */
  SporeMonitorMessage messages[SPORE_MONITOR_MESSAGES];
} SporeMonitor;
const SporeMonitor *spore_world_monitor(const SporeWorld *world);
/* Time that a step may take, us of the clock; 0: any. A longer one is counted and said, and changes nothing else. */
void spore_world_set_budget(SporeWorld *world, double budget_us);
/* Whether an explicit step is too long for the body to lie in a pile of its like, or for particles on what holds them.
 */
typedef struct SporePileLimit {
  double share;    /* of its contacts' stiffness that the step leaves */
  size_t substeps; /* that leave enough; more than SPORE_SUBSTEPS_MAXIMUM are too many */
  double damping;  /* of its contacts that leaves enough, N s/m; 0: none does */
  bool implicit;   /* an implicit integrator would do as well */
} SporePileLimit;
bool spore_world_pile_sinks(const SporeWorld *world, uint32_t body, SporePileLimit *limit);
/* "take ...", translated. */
void spore_pile_remedy(const SporePileLimit *limit, char *text, size_t size);
/* The monitor integrates the body implicitly, which the scene does not. */
bool spore_world_body_made_safer(const SporeWorld *world, uint32_t body);
bool spore_world_body_frozen(const SporeWorld *world, uint32_t body);
bool spore_world_body_asleep(const SporeWorld *world, uint32_t body);

/* What a step leaves for between the steps, where memory may be taken: a body that scissors parted is solved by
 * conjugate gradients alone until its new pattern is analysed here, when nothing was cut for 16 steps. To be called
 * after each step, or never. True: something was done. */
bool spore_world_tidy(SporeWorld *world);

/* Counts of the last step. */
typedef struct SporeStepCounts {
  size_t contacts, islands; /* of bodies that are awake */
  size_t sleeping;          /* bodies asleep during the step */
  size_t newton_iterations, linear_iterations, force_evaluations;
  double residual; /* worst relative residual of the islands' solves; 0 for explicit ones */
} SporeStepCounts;
SporeStepCounts spore_world_counts(const SporeWorld *world);

/* Snapshot: published at the end of each step through a triple buffer, never blocking either side. */
typedef struct SporeSnapshotContact {
  SporeVec3 point, force; /* on sphere a */
  uint32_t sphere_a, sphere_b;
} SporeSnapshotContact;
/* What all tools have done so far, as SporeToolState. */
typedef struct SporeToolCounts {
  size_t cut, pierced, stitches;
} SporeToolCounts;
/* Knots of lines whose knots come and go: see spore_snapshot_knots. */
typedef struct SporeLines {
  uint64_t number; /* another one: some differ */
  size_t break_count;
  double *breaks;
  uint32_t *span_count; /* a body; NULL: there is no such line */
} SporeLines;
typedef struct SporeSnapshot {
  uint64_t step;
  double time_s;
  size_t q_count, v_count;
  const double *q, *v;  /* all bodies, by spore_world_q_offset and _v_offset */
  uint8_t *level;       /* body_count, of SporeLevelGrade: q and v are of; NULL: each body has but one */
  double *reaction;     /* body_count x 6: force (N) and torque about the body's origin (N m) from contacts and links */
  size_t contact_count; /* total of bodies that are awake; at most contact_capacity are listed */
  size_t contact_capacity;
  SporeSnapshotContact *contacts;
  SporeCuts cuts;   /* since time 0 */
  uint64_t cut_run; /* another number: they began anew */
  SporeLines lines;
  SporeStepCounts counts;
  SporeToolCounts tools;
  SporeEnergy energy;     /* of this state, or of the first one after the snapshot before was acquired */
  uint64_t message_count; /* of the monitor, and its messages */
  SporeMonitorMessage messages[SPORE_MONITOR_MESSAGES];
  double step_us;
} SporeSnapshot;
/* spore_world_hash of the state that is shown. */
uint64_t spore_snapshot_hash(const SporeSnapshot *snapshot);
/* Knots of the body's line in the snapshot, of which its q is; no spans: they never change. And the rows of a mapping
 * of spore_world_map, which is of the knots of time 0, for others; false: no memory. */
SporeSplineKnots spore_snapshot_knots(const SporeWorld *world, const SporeSnapshot *snapshot, uint32_t body);
bool spore_world_follow_knots(const SporeWorld *world, uint32_t body, SporeSplineKnots knots, SporeMapping *mapping);
/* The newest snapshot; stays valid until the next call. Never NULL: before the first step it is time 0. */
const SporeSnapshot *spore_world_snapshot_acquire(SporeWorld *world);

/* Commands: applied at the start of the next step. False: the queue (1024) is full. */
typedef enum SporeCommandKind {
  SPORE_COMMAND_GRAVITY, /* vector */
  SPORE_COMMAND_PULL,    /* pulls the material point of `body` nearest to `point` toward `vector`, stiffness in number;
                            the point is chosen on the first PULL after a RELEASE */
  SPORE_COMMAND_RELEASE, /* ends a pull on `body` */
  SPORE_COMMAND_RETUNE, /* model of `body` takes `fields` (parameters.size bytes; freed by the world with spore_free) */
  SPORE_COMMAND_CONTACT, /* contact law of `body`: contact */
  SPORE_COMMAND_THAW,    /* a frozen body moves again */
  SPORE_COMMAND_LEVEL    /* `body` changes to `level`, or the monitor says why not */
} SporeCommandKind;
typedef struct SporeCommand {
  SporeCommandKind kind;
  uint32_t body;
  SporeVec3 point, vector;
  double number;
  void *fields;
  SporeContactFields contact;
  SporeLevelGrade level;
} SporeCommand;
bool spore_world_post(SporeWorld *world, const SporeCommand *command);

#endif
