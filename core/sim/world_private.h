/* Inside of a world, for the files of core/sim.
 *
 * The last good state lies in `q` and `v`, body by body; a step only reads it, and writes the next one into `next_q`
 * and `next_v`. Both are buffers of the snapshots, so that to publish a state nothing is copied. A step sorts the
 * bodies that move into islands. An island whose bodies lie next to each other is integrated from the one pair of
 * vectors to the other; the state of any other is copied together into the local vectors, and back from there. */
#ifndef SPORE_SIM_WORLD_PRIVATE_H
#define SPORE_SIM_WORLD_PRIVATE_H

#include <stdatomic.h>

#include "core/base/triple.h"
#include "core/collide/depth_field.h"
#include "core/collide/grid.h"
#include "core/haptic/guard.h"
#include "core/integrate/integrator.h"
#include "core/linalg/block_cholesky.h"
#include "core/sim/contact_lanes.h"
#include "core/sim/coupling.h"
#include "core/sim/needle.h"
#include "core/sim/world.h"

#define SPORE_COMMAND_CAPACITY 1024
#define SPORE_POSE_Q 7 /* a body without a model: position, orientation; velocity, spin */
#define SPORE_POSE_BLOCKS 2
#define SPORE_STAGE_MAXIMUM 14
#define SPORE_LEFT_OUT_MAXIMUM 16

typedef enum SporeTrouble { /* worst last */
                            SPORE_TROUBLE_NONE,
                            SPORE_TROUBLE_NOT_CONVERGED,
                            SPORE_TROUBLE_ENERGY,
                            SPORE_TROUBLE_SPEED,
                            SPORE_TROUBLE_NOT_FINITE
} SporeTrouble;

typedef enum SporeStart { SPORE_START_NONE, SPORE_START_NEW, SPORE_START_KEPT } SporeStart;

/* Whether a body's matrix is factorised, how long a linearisation is kept, and what led to it: see factor.c. */
typedef struct SporeFactorChoice {
  bool factorised, needed; /* needed: conjugate gradients alone did not solve a step */
  bool stuck; /* nor did Newton's method with them, and there is a tangent that only a factor takes whole */
  uint32_t votes, patience; /* steps that work was counted in; how many it takes to judge */
  double present, other;    /* work that they took, and would have taken the other way */
  uint32_t steps;           /* since the last change */
  double iterations;        /* a Newton iteration, before the change */
  SporeStart start;         /* of the present step: whether it began with a linearisation of a step before */
  uint64_t made;            /* the step that the linearisation was of before the present step */
  uint32_t keep;            /* steps that a linearisation is kept */
  uint32_t calm, trial;     /* steps that this went well; after how many it may be kept longer */
  double fresh, excess;     /* iterations of a step with a new one; what those since then took above that */
  uint32_t factors;         /* made in the present step */
  double linear, debt; /* among couplings: conjugate gradients a Newton iteration with a new factor; their work above
                          that since it was made */
} SporeFactorChoice;

/* Energy of a body in explicit steps: see energy_watch.c. J. */
typedef struct SporeEnergyWatch {
  bool started;
  uint32_t steps;     /* since */
  double own, height; /* kinetic plus strain energy, and that of gravity, at the start */
  double given;       /* by contacts and links since */
} SporeEnergyWatch;

typedef struct SporeLevels SporeLevels; /* levels.h */
/* Of a body whose nodes a cut may divide: see division.c. */
typedef struct SporeDivision {
  bool possible, wanted, parted; /* wanted: something was opened in this step; parted: it is not whole */
  bool untidy;                   /* it was parted since its factor was made */
  uint64_t step;                 /* when it was parted */
  size_t corner_start;           /* in the cuts' corners, of a tetrahedron's four */
  SporeBlockPattern pattern;
  SporeBlockRoom room;
  uint8_t *pinned; /* block_count */
} SporeDivision;

/* Of a body whose knots come and go: see knots.c. */
typedef struct SporeLineKnots {
  bool changes;
  size_t break_start; /* in the world's lines */
  SporeLineState state;
  uint64_t looks, look_ns, changed, change_ns; /* of what was timed */
} SporeLineKnots;

/* A mapping onto such a body, and where its blocks are found anew. */
typedef struct SporeHang {
  uint32_t body;
  SporeMapping *mapping;
  uint32_t *places;
} SporeHang;

typedef struct SporeBody {
  char *name;
  SporeRole role;
  SporeModel *model;
  SporeLevels *levels;            /* NULL: it has but one */
  SporeLevelGrade level;          /* that all that depends on the model is of */
  bool altered;                   /* cut, torn or coagulated since time 0: it keeps its level */
  SporeIntegratorKind integrator; /* now */
  SporeIntegratorKind chosen;     /* by the scene; the monitor may have taken a safer one */
  size_t substeps;
  SporeSaidBy integrator_said_by, substeps_said_by;
  SporeContactFields contact;
  SporePose rest_pose;                             /* at time 0 */
  size_t q_offset, q_count, v_offset, block_count; /* v_offset in doubles */
  size_t q_most, block_most;                       /* that it may have had: behind its own it is 0 up to there */
  SporeMapping spheres;
  size_t sphere_start;
  SporeDepthField field; /* empty: its spheres are felt one by one */
  double total_mass;     /* kg, of a model */
  uint32_t *held;        /* blocks that pins hold still; behind them particles that are out of the world */
  size_t held_count, pin_count;
  double *whole_weight;   /* of its spheres' mapping, before anything cut it; NULL: nothing does */
  SporeDivision division; /* its pattern, room and pins are also those of a line */
  SporeLineKnots line;
  double parking_gap; /* m, between particles out of the world; 0: none ever are */

  bool frozen;
  /* Rest: see sleep.c. */
  bool asleep;
  uint32_t sleep_next;          /* the next of those that fell asleep together, round and round */
  uint64_t rest_steps;          /* in a row */
  double rest_speed, rest_spin; /* m/s and 1/s: at rest below */
  double sleep_energy;          /* of the contacts that sleep with it, kept with the first body of an island, J */
  uint64_t changed;  /* number of the state that its own last differed in from the one before: see snapshot.c */
  SporeTrouble told; /* the worst that the monitor has said of it */
  bool told_deep;    /* that it lies too deep in another */
  bool told_soft;    /* that its contacts hold too little */
  bool told_torn;    /* that it tears */
  uint64_t soft_since, soft_last; /* see soft_contact.c: number of the step, from 1 */
  SporeEnergyWatch watch;
  uint32_t pause, pauses; /* steps until smaller ones are tried again that did not help; how many that were last */
  bool noticed;           /* what its model had to mend was said */

  SporeBlockMatrix matrix;    /* M + c D + c2 K of the model alone; empty where that is M */
  double matrix_c, matrix_c2; /* as assembled; 0: not */
  uint64_t matrix_step;
  SporeBlockCholesky factor; /* without blocks: not worth it for this body */
  uint8_t *held_flags;       /* a block, for the factor */
  SporeFactorChoice choice;
  bool factor_ready, factor_alone;      /* the factor is that of the current A, or kept; no couplings were in it */
  bool factor_kept;                     /* among couplings: it preconditions later matrices of the same c and c2 too */
  double rounding_soft, rounding_stiff; /* squares, of the last preconditioner: see spore_group_rounding */

  /* What its integrator remembers of the step before, see SporeHistory: by which method, and for which step alone. */
  SporeIntegratorKind history_kind;
  double history_s;
  uint64_t history_step;

  SporeDevice *device;
  SporeGuard guard;
  SporeDeviceState input;
  SporeDeviceCommand command;
  SporePassivity passivity; /* of a device that pushes a hand */
  double input_time_s;
  bool has_input;
} SporeBody;

typedef struct SporeIsland {
  size_t body_start, body_count;             /* in island_bodies */
  size_t contact_start, contact_count;       /* in contact_order */
  size_t lanes_start;                        /* in contact_lanes */
  size_t spring_start, spring_count;         /* in spring_order */
  size_t q_start, q_count, v_start, v_count; /* in the local vectors */
  /* From where to where a step takes it: see spore_island_gather. */
  const double *q0, *v0;
  double *q1, *v1;
  bool in_place; /* q1 and v1 lie in next_q and next_v */
  SporeIntegratorKind integrator;
  size_t substeps;         /* of the integrator */
  bool mixed;              /* its bodies move by several methods: see mixed.c */
  double gravity_momentum; /* (M g . g)^1/2 */
  SporeHistory history;    /* in the local vectors */
  uint32_t attempts;       /* at this step */
  /* What came of it. */
  SporeStepResult result;
  SporeTrouble trouble;      /* that was met, mended or not */
  uint32_t offender;         /* the body that it was met in */
  bool made_safer;           /* its integrator was changed by this step */
  uint64_t mending_substeps; /* that the mending cost; 0: none needed */
  size_t kept_count;         /* bodies behind these were frozen by this step */
  bool rests, falls_asleep;
} SporeIsland;

/* A contact as a body feels it, and the pair that friction remembers it by. */
typedef struct SporeFelt {
  SporeContact contact;
  uint32_t grip_a, grip_b; /* spheres; of a body felt as one, the first */
  bool field_a, field_b;   /* the body is felt as one */
} SporeFelt;

typedef struct SporeGrip {
  uint32_t sphere_a, sphere_b;
  SporeVec3 stretch; /* m */
  SporeVec3 normal;  /* of the contact: a sphere may touch a body that is felt as one in several places */
} SporeGrip;

/* A link of the scene, its terms next to each other. */
typedef struct SporeLink {
  char *name;
  SporeLinkKind kind;
  size_t term_start, term_count; /* in springs */
  double strength;               /* N; infinite: it never breaks */
  bool broken;
  SporeVec3 base, along; /* slide, port: the line in the frame of the body at end b of its term */
  SporeRail rail;        /* the same, where that body deforms; without spans: none */
  bool told_sharp;       /* that the line bends too sharply where it runs */
  uint32_t sharp_steps;  /* in a row that it did */
  bool lost;             /* the state was set from outside: where its point is on the line is not known */
} SporeLink;

/* A port of the scene that an active body goes through. */
typedef struct SporePort {
  uint32_t body;
  SporeVec3 pivot;       /* world, m */
  SporeVec3 base, along; /* the line in the body's frame */
} SporePort;

/* A sphere between jaws, tied to one of them by a term. */
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

typedef struct SporeStage {
  void (*run)(SporeWorld *world);
  size_t (*items)(const SporeWorld *world);
  SporeProfilePhase profile;
} SporeStage;

typedef struct SporeSnapshots {
  SporeSnapshot buffers[3];
  SporeTriple triple;
  double *q[3], *v[3];        /* the buffers' own */
  uint64_t number[3], newest; /* of the state in each buffer; of the last one made */
  atomic_bool energy_wanted;  /* somebody looks */
} SporeSnapshots;

typedef struct SporeCommands {
  SporeCommand *ring;              /* SPORE_COMMAND_CAPACITY */
  _Atomic size_t written, applied; /* ever */
} SporeCommands;

struct SporeWorld {
  /* What a step does not change. */
  size_t body_count;
  SporeBody *bodies;
  SporeSolverFields solver;
  SporePool *pool;
  size_t q_count, v_count, dof; /* doubles */
  double *rest_q, *rest_v;      /* at time 0 */
  SporeSite *world_sites;       /* of the bodies in q and v */
  bool has_levels;              /* some body has */

  /* State. */
  uint64_t step;
  SporeVec3 gravity;
  const double *q, *v;         /* the last good state */
  double *next_q, *next_v;     /* the one that the step makes */
  double *target_q;            /* where active bodies are to be at the end of the step */
  double *mass, *mass_inverse; /* 9 a block, at 3 x the block's place in v */
  SporeSpheres spheres;
  double *reaction; /* body_count x 6 */
  SporeStepCounts counts;

  /* Terms. */
  SporeGrid *grid; /* NULL where nothing can touch */
  size_t missed;   /* contacts without room in the last step */
  size_t contact_count, contact_capacity;
  double *reach;   /* a sphere: its radius as the grid sees it, m */
  SporeFelt *felt; /* contact_capacity: what comes of the contacts found */
  SporeContactTerm *contacts;
  SporeContactLanes *contact_lanes; /* room for those of all islands */
  double *frames;                   /* SPORE_FRAME_DOUBLES a body: of rigid ones, at the last evaluation */
  size_t grip_count;                /* what friction held at the end of the last step, in the order of the pairs */
  SporeGrip *grips, *kept_grips;    /* kept_grips: scratch */
  size_t link_count, port_count, rail_count; /* rail_count: of links */
  SporeLink *links;
  SporePort *ports;
  SporeCuts cuts;
  uint64_t cut_run;
  size_t tearing_count; /* bodies that may tear */
  size_t hang_count;    /* on bodies that may be parted */
  size_t line_count;    /* bodies whose knots come and go */
  SporeLines lines;
  SporeHang *hangs;
  size_t tool_count, emitter_count;
  SporeTool *tools;
  SporeEmitter *emitters;
  size_t link_term_count, hold_count; /* springs of links; of tools, behind them; behind those one pull a body */
  SporeSpringTerm *springs;
  bool *spring_active;
  SporeMapping *spring_mappings;                       /* two a spring: end a, end b */
  SporeCoupling *contact_couplings, *spring_couplings; /* in the order of contact_order and spring_order */

  /* Islands. */
  uint32_t *parent;        /* union-find over bodies */
  uint32_t *island_of;     /* by body; SPORE_NO_BODY: it does not move */
  uint32_t *island_bodies; /* bodies that move, island by island */
  size_t island_count;
  SporeIsland *islands; /* body_count */
  uint32_t *contact_order, *spring_order;
  SporeSite *local_sites; /* of the bodies in their island's part of the local vectors */
  double *local_q0, *local_v0, *local_q1, *local_v1;
  double *best_q, *best_v; /* as these: of the attempts at a step that went wrong */
  double *history_a, *history_b, *local_history_a, *local_history_b; /* as v and local_v0 */
  double *still;   /* zeros: the velocity of the largest body, at rest */
  double *scratch; /* of the integrators, scratch_per_block doubles a block */
  size_t scratch_per_block;
  double *precondition; /* 9 a block, as local_v0 */

  SporeCommands commands;
  SporeSnapshots snapshots;
  SporeMonitor monitor;

  SporePlan plan;
  SporePlanStage plan_stages[SPORE_STAGE_MAXIMUM];
  SporeStage stages[SPORE_STAGE_MAXIMUM]; /* as plan_stages */
  SporeStage *run[SPORE_STAGE_MAXIMUM];   /* those included, in order: what a step calls */
  size_t run_count;
  size_t pull_count;     /* pulls held now */
  size_t sleeping_count; /* bodies */
  uint64_t mapped;       /* number of the state that the spheres were last mapped from */
  SporePlanLeftOut left_out[SPORE_LEFT_OUT_MAXIMUM];
  SporeProfilePhase profile;
  double step_us;     /* of the step before */
  double budget_us;   /* 0: none */
  SporeEnergy energy; /* the last one taken for a snapshot */
};

/* By physics, in this step. */
static inline bool spore_body_moves(const SporeBody *body) {
  return body->role == SPORE_PASSIVE && !body->frozen && !body->asleep;
}
/* Forces of its own do not depend on how it moves. */
static inline bool spore_body_is_static(const SporeBody *body) { return body->integrator == SPORE_INTEGRATOR_STATIC; }
/* What weight is to it, less what the air bears, m/s^2. */
static inline SporeVec3 spore_body_gravity(const SporeWorld *world, const SporeBody *body) {
  return spore_vec3_scale(1 - body->model->buoyancy, world->gravity);
}
static inline size_t spore_world_spring_count(const SporeWorld *world) {
  return world->link_term_count + world->hold_count + world->body_count;
}

/* compile.c: parts of spore_world_create. */
char *spore_copy_text(const char *text); /* NULL: no memory */
bool spore_world_compile_bodies(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
bool spore_world_compile_spheres(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
bool spore_world_allocate_vectors(SporeWorld *world, SporeError *error);
/* An empty matrix of the body's model, where that has a Jacobian. */
bool spore_body_make_matrix(SporeBody *body, SporeError *error);

/* Where the model's present level puts the centres of the set, which may be NULL, into body->spheres. */
bool spore_body_map_spheres(SporeWorld *world, uint32_t body, const SporeSphereSet *set, SporeError *error);

/* levels.c */
bool spore_levels_make(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error);
/* All that the levels that are not active need; after everything else of the world is compiled. */
bool spore_world_compile_levels(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_levels_free(SporeBody *body);
/* The models go back to the caller. */
void spore_levels_give_up(SporeBody *body);
/* Makes the level active, with its state at time 0 for that of the body. */
void spore_world_select_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);
/* Back to the levels of time 0. */
void spore_world_reset_levels(SporeWorld *world);
/* Calls it for each of the body's models. */
void spore_body_each_model(const SporeBody *body, void (*call)(SporeModel *model, void *user), void *user);

/* level_change.c: while it runs, at the start of a step. */
void spore_world_change_level(SporeWorld *world, uint32_t body, SporeLevelGrade level);

/* links.c */
/* The blocks of the body at its present level that pins hold still. */
bool spore_body_compile_pins(SporeWorld *world, const SporeWorldDescription *description, uint32_t body,
                             SporeError *error);
bool spore_world_compile_links(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);

/* joints.c: links that hold points together. */
size_t spore_link_term_count(const SporeLinkDescription *link);
/* What is wrong with the link, or NULL. */
const char *spore_link_fault(const SporeWorld *world, const SporeLinkDescription *link);
/* Fills the link, whose term_start is set, and its terms. */
bool spore_link_make(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error);
/* After a step: breaks what holds more than it can. */
void spore_world_break_links(SporeWorld *world);
void spore_world_mend_links(SporeWorld *world);
/* A world point at time 0 in the frame of a body; of what stands still, as it is. */
SporeVec3 spore_link_to_frame(const SporeWorld *world, uint32_t body, SporeVec3 at);
/* The material point of `body` that lies at `at` at time 0. */
bool spore_link_attach(SporeWorld *world, uint32_t body, SporeVec3 at, SporeMapping *mapping, SporeEnd *end,
                       SporeError *error);
SporeSpring spore_link_law(const SporeWorld *world, const SporeLinkDescription *link);
/* It holds no longer. */
void spore_link_release(SporeWorld *world, SporeLink *link);

/* slides.c: lines that links run along. */
static inline bool spore_link_runs_along(SporeLinkKind kind) {
  return kind == SPORE_LINK_SLIDE || kind == SPORE_LINK_PORT;
}
/* The line is that of a body that deforms. */
bool spore_link_is_railed(const SporeWorld *world, const SporeLinkDescription *link);
/* The straight line of a link that has its term; or a link along a body's own line, with its term. */
bool spore_link_make_line(const SporeWorld *world, SporeLink *link, const SporeLinkDescription *from,
                          SporeError *error);
bool spore_link_make_rail(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error);
/* The line follows its body, and the point on it the other end; or slips off. */
void spore_link_follow(SporeWorld *world, SporeLink *link);
/* The state was set from outside: what slides is sought again, and friction holds nothing of before. */
void spore_world_lose_rails(SporeWorld *world);

/* ports.c */
bool spore_port_make(const SporeWorld *world, SporePort *port, const SporeLinkDescription *from);
/* Turns where the active body is to be until the port's line goes through its pivot. */
void spore_port_aim(const SporeWorld *world, const SporePort *port);

/* tools.c */
bool spore_world_compile_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Room for the holds of all tools in springs. */
size_t spore_tools_hold_count(const SporeWorldDescription *description);
void spore_world_reset_tools(SporeWorld *world);
void spore_world_clear_tools(SporeWorld *world);
void spore_world_use_tools(SporeWorld *world);

/* particles.c: particles that leave the world and come back. */
bool spore_world_compile_particles(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Once the next state is written, but not the state yet: what suction takes, and emitters give. */
void spore_world_exchange_particles(SporeWorld *world);
/* Whether anything may take or give particles. */
bool spore_world_exchanges_particles(const SporeWorld *world);
/* After a body's state was set from outside: which of its particles are out of the world. */
void spore_body_find_parked(SporeBody *body, const double *q);
void spore_world_reset_particles(SporeWorld *world);

/* parting.c: bodies that lose ties between their nodes. */
static inline bool spore_body_can_part(const SporeBody *body) {
  /* What is seen follows what the finest level loses, and no other. */
  return body->model && body->model->type->cut && body->level == SPORE_LEVEL_FINE;
}
bool spore_world_compile_parting(SporeWorld *world);
void spore_world_mend_bodies(SporeWorld *world);
/* After it lost some: the spheres follow, and it is another model. */
void spore_body_parted(SporeWorld *world, uint32_t body);
/* After its model was changed: forgets what it remembers of steps before, and wakes it. */
void spore_body_changed_model(SporeWorld *world, uint32_t body);

/* division.c: tetrahedra whose nodes cuts divide. Nodes in reserve, before the world is laid out; what dividing needs,
 * behind links and tools; at the end of a step, of the state to come; as it was, at a reset. */
bool spore_world_reserve_division(const SporeWorldDescription *description, SporeError *error);
bool spore_world_compile_division(SporeWorld *world);
void spore_world_divide_bodies(SporeWorld *world);
void spore_world_mend_division(SporeWorld *world);
void spore_world_clear_division(SporeWorld *world);

/* The blocks that are held, from division.pinned: pins first, then spares. */
void spore_body_list_held(SporeBody *body);

/* knots.c: room, once links and tools are made; at the end of a step; as it was, at a reset. */
bool spore_world_compile_knots(SporeWorld *world);
void spore_world_change_knots(SporeWorld *world);
void spore_world_mend_knots(SporeWorld *world);

/* cutting.c: the blades, half of the angle each, went with their body from the last state to its target, and closed
 * from one opening to another. */
void spore_scissors_cut(SporeWorld *world, SporeTool *tool, double from, double to);
/* Room for it in models, where the world has something that heats. False: no memory. */
bool spore_world_compile_coagulation(SporeWorld *world);
void spore_bipolar_use(SporeWorld *world, SporeTool *tool);

/* needle.c */
size_t spore_needle_term_count(const SporeToolDescription *from);
const char *spore_needle_fault(const SporeWorld *world, const SporeToolDescription *from);
bool spore_needle_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from);
void spore_needle_clear(SporeNeedle *needle);
/* The thread's line has other knots. */
void spore_needle_take_knots(SporeWorld *world, const SporeTool *tool, SporeSplineKnots knots);
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

/* sense.c: the velocity that takes an active body to its target in one step. */
void spore_active_set_velocity(SporeWorld *world, uint32_t body);

static inline bool spore_tool_has_jaws(const SporeTool *tool) { return tool->kind <= SPORE_TOOL_SCISSORS; }
static inline bool spore_tool_kind_holds(SporeToolKind kind) { return kind <= SPORE_TOOL_CLAMP; }

/* pulls.c: commands take hold of a body. */
bool spore_world_make_pulls(SporeWorld *world);
void spore_world_pull(SporeWorld *world, const SporeCommand *command);
void spore_world_release(SporeWorld *world, uint32_t body);
/* Where the pull of a body holds it; false: nobody pulls. And holds it by the node next to there. */
bool spore_world_pulled_point(const SporeWorld *world, uint32_t body, SporeVec3 *point);
void spore_world_pull_by(SporeWorld *world, uint32_t body, SporeVec3 point);
/* Where the pull of a body lies in springs. */
size_t spore_world_pull_index(const SporeWorld *world, uint32_t body);

/* Stages, one file a kind. */
void spore_world_apply_commands(SporeWorld *world); /* command.c */
void spore_world_sense(SporeWorld *world);          /* sense.c */
void spore_world_feed_back(SporeWorld *world);
void spore_world_tear(SporeWorld *world);        /* parting.c */
void spore_world_map_spheres(SporeWorld *world); /* contacts.c */
void spore_world_detect(SporeWorld *world);
void spore_world_wake_up(SporeWorld *world);   /* sleep.c */
void spore_world_respond(SporeWorld *world);   /* contacts.c */
void spore_world_link(SporeWorld *world);      /* links.c */
void spore_world_group(SporeWorld *world);     /* islands.c */
void spore_world_integrate(SporeWorld *world); /* integrate.c */
void spore_world_react(SporeWorld *world);     /* react.c */
void spore_world_commit(SporeWorld *world);    /* commit.c */

/* contacts.c */
void spore_world_fill_end(const SporeWorld *world, SporeEnd *end);
bool spore_world_reserve_contacts(SporeWorld *world);

/* depth_contacts.c: bodies that are felt as one depth field. */
bool spore_world_compile_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* What comes of the contacts found, into world->felt, in the order of their grips; returns their number. */
size_t spore_world_feel(SporeWorld *world);

/* grips.c: contacts take over what their pairs held when the last step ended; what they hold when this one has. */
bool spore_grips_reserve(SporeWorld *world, size_t old_contacts, size_t contacts);
void spore_world_take_grips(SporeWorld *world);
void spore_world_keep_grips(SporeWorld *world);

/* islands.c: places of the bodies of an island in its vectors, and their last good state there. */
void spore_island_gather(SporeWorld *world, SporeIsland *island);
/* What the integrator remembers of this step, for the next. */
void spore_island_remember(SporeWorld *world, const SporeIsland *island);
/* dynamics.c: the island as the integrators see it. `group` lives as long as the dynamics. */
typedef struct SporeGroup {
  SporeWorld *world;
  const SporeIsland *island;
  const double *shape;   /* as q of the island: where viscous forces are taken; NULL: where each force is */
  double shape_s;        /* forces are asked for where nodes moved from there along v for so long; 0: anywhere */
  const double *given;   /* a constant force besides those of bodies and terms; NULL: none */
  bool apart;            /* explicit bodies are masses alone: see mixed.c */
  double start_s, now_s; /* after the world step's start: the integrator's step, and where prescribed ends are */
  size_t contact_couplings, spring_couplings; /* of the current A, first in their arrays: see fold.h */
  size_t dragging;                            /* contacts that the current A does not know all of: see their drag */
  bool driven;                                /* some end is moved by a device */
  bool frames;                                /* some contacts are evaluated by the frames of rigid bodies */
  bool asked_couples, couples;                /* see spore_group_couples */
  double softened_s;                          /* the step that terms are softened for; 0: they are not */
} SporeGroup;
/* Motion of a body free of force; q1 and v1 may be q0 and v. */
void spore_body_drift(const SporeBody *body, const double *q0, const double *v, double h, double *q1, double *v1);
SporeDynamics spore_group_dynamics(SporeGroup *group);
/* Whether a step of h seconds is short for all contacts of the island. */
bool spore_group_resolves_contacts(const SporeGroup *group, double h);
/* contact_lanes.c: when the island's forces were evaluated for the last time: what its contacts came to, into the
 * terms. */
void spore_group_keep_contacts(const SporeGroup *group);
/* Mass and its inverse at q, the body's own. */
/* Mass and its inverse at the world's q; and after that, of a frame that has turned. */
void spore_body_set_mass(SporeWorld *world, const SporeBody *body);
void spore_body_turn_mass(SporeWorld *world, const SporeBody *body, const double *q);

/* sleep.c */
void spore_world_compile_sleep(SporeWorld *world);
/* Whether the step just taken left the island at rest. */
bool spore_island_rests(const SporeWorld *world, const SporeIsland *island);
/* Sends an island to sleep that has rested for long enough: writes the next state. */
void spore_island_let_sleep(SporeWorld *world, SporeIsland *island);
/* Once the island's last state is the world's: remembers the energy of its contacts, which nobody will look for. */
void spore_island_keep_energy(SporeWorld *world, const SporeIsland *island);
/* The body, and those that fell asleep with it. */
void spore_world_wake(SporeWorld *world, uint32_t body);
void spore_world_wake_all(SporeWorld *world);

/* factor.c */
bool spore_world_compile_factors(SporeWorld *world, SporeError *error);
/* Anew. False: no memory, and no factor. */
bool spore_body_compile_factor(const SporeWorld *world, SporeBody *body, SporeError *error);
/* After it was changed from outside: nothing is left of the steps before. */
void spore_body_forget_steps(const SporeWorld *world, SporeBody *body);
void spore_body_reset_choice(const SporeWorld *world, SporeBody *body);
/* What the parts of a stage cost this body, in floating-point operations of the kind that a product with its matrix is
 * made of. */
double spore_body_linearisation_work(const SporeBody *body);
double spore_body_iteration_work(const SporeBody *body);
/* Chooses again how each body of the island is preconditioned, after a step that went like its result. True where the
 * step failed for want of a factor and should be taken again. */
bool spore_island_choose(SporeWorld *world, const SporeIsland *island);

/* integrate.c */
/* What attempts at a step that went wrong may still take, all together. */
typedef struct SporeEffort {
  size_t iterations; /* nonlinear ones left; a part of a step takes one at least */
  double hopeless;   /* a part that misses more than this of the load is not solved, and the attempt is given up */
  bool given_up;     /* q1 and v1 are those of some part of the step */
} SporeEffort;
/* One step of the world in `substeps` parts, from q0 and v0 of the island to q1 and v1; spoils the local vectors.
 * effort: counted down; NULL for a first attempt, whose parts take as many iterations each as the scene allows. */
SporeStepResult spore_island_advance(SporeWorld *world, SporeIsland *island, SporeIntegratorKind kind, size_t substeps,
                                     SporeEffort *effort);

/* mixed.c: one step of an island whose bodies choose differently. */
SporeStepResult spore_island_advance_mixed(SporeWorld *world, SporeIsland *island);
/* Scratch a block, doubles. */
size_t spore_mixed_scratch(void);

/* recover.c */
/* Sets island->trouble and, where there is any, island->offender. */
void spore_island_examine(SporeWorld *world, SporeIsland *island);
/* Mends or accepts a step in trouble: island->trouble is the worst that was met. */
void spore_island_recover(SporeWorld *world, SporeIsland *island);

/* monitor.c */
void spore_world_report(SporeWorld *world, const char *format, ...) __attribute__((format(printf, 2, 3)));
void spore_world_report_islands(SporeWorld *world);
/* A contact deeper than the smaller of its spheres. */
void spore_world_report_depth(SporeWorld *world, const SporeContactTerm *term);
/* soft_contact.c: says what contacts at rest do not hold for the length of the step. */
void spore_world_watch_contacts(SporeWorld *world);
/* A step that took longer than the budget. */
void spore_world_report_budget(SporeWorld *world);

/* energy.c: of a body at q, v; J. */
double spore_body_kinetic_energy(const SporeWorld *world, const SporeBody *body, const double *v);
double spore_body_gravity_energy(const SporeWorld *world, const SporeBody *body, const double *q);

/* energy_watch.c: false where a body of the island has more energy after the step than can be; island->offender. */
bool spore_island_energy_holds(SporeWorld *world, SporeIsland *island);

/* snapshot.c */
bool spore_snapshots_init(SporeWorld *world);
void spore_snapshots_clear(SporeSnapshots *snapshots);
/* A body whose part of the next state was written: number it. */
/* What the body leaves of its room in the next state. */
void spore_body_clear_rest(SporeWorld *world, const SporeBody *body);
void spore_body_mark_changed(const SporeWorld *world, SporeBody *body);
/* Fills what was not written of the next state from the last one, and makes it the state. */
void spore_world_advance_state(SporeWorld *world);
/* Shows the state to the reader; the next one can be written now. */
void spore_snapshot_publish(SporeWorld *world);

/* plan.c */
void spore_world_make_plan(SporeWorld *world); /* at create, and again when a pull begins or ends */
void spore_world_run_plan(SporeWorld *world);

/* step_limit.c */
bool spore_world_check_step(SporeWorld *world, SporeError *error);

#endif
