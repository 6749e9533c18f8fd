/* Solving: islands of coupled bodies, their integration by the methods of their bodies, preconditioners, recovery of
 * steps that went wrong, and sleep. */
#ifndef SPORE_SIM_SOLVE_H
#define SPORE_SIM_SOLVE_H

#include "core/integrate/integrator.h"
#include "core/linalg/block_cholesky.h"
#include "core/sim/contact/contact.h"

/* How a body is integrated. */
typedef struct SporeBodyMethod {
  SporeIntegratorKind integrator; /* now */
  SporeIntegratorKind chosen;     /* by the scene; the monitor may have taken a safer one */
  size_t substeps;                /* of the integrator in a step */
  SporeMethodSource integrator_source, substeps_source;
} SporeBodyMethod;

/* Blocks of a body that do not move: those that pins hold, then particles and spare nodes out of the world. */
typedef struct SporeHeldBlocks {
  uint32_t *blocks; /* ascending within each of the two parts */
  size_t count, pin_count;
  uint8_t *flags; /* one a block, for the factor; NULL: no factor */
} SporeHeldBlocks;

typedef enum SporeStart { SPORE_START_NONE, SPORE_START_NEW, SPORE_START_KEPT } SporeStart;

/* Whether the matrix of a body is factorised, how long a linearisation is kept, and the counted work that led to this
 * choice: see preconditioner.c. */
typedef struct SporeFactorChoice {
  bool factorised, needed;  /* needed: conjugate gradients alone did not solve a step */
  bool stuck;               /* Newton's method did not converge with them; only a factor takes the whole tangent */
  uint32_t votes, patience; /* steps in which work was counted; steps after which it is compared */
  double present, other;    /* work of those steps, and estimated work of the other choice */
  uint32_t steps;           /* since the last change */
  double iterations;        /* conjugate gradients a Newton iteration before the change */
  SporeStart start;         /* whether the present step began with a linearisation of an earlier step */
  uint64_t made;            /* step of the linearisation that the present step began with */
  uint32_t keep;            /* steps that a linearisation is kept */
  uint32_t calm, trial;     /* steps in which keeping served; number of them after which it may be kept longer */
  double fresh, excess;     /* iterations of a step with a new linearisation; work of later steps above these */
  uint32_t factors;         /* made in the present step */
  double linear, debt;      /* among couplings: conjugate gradients a Newton iteration with a new factor; work above
                               that since the factor was made */
} SporeFactorChoice;

/* Matrix of a body, its factor, and the choice between factor and diagonal blocks. */
typedef struct SporePreconditioner {
  SporeBlockMatrix matrix;              /* M + c D + c2 K of the model alone; empty where that is M */
  double matrix_c, matrix_c2;           /* as assembled; 0: not assembled */
  uint64_t matrix_step;                 /* step in which it was assembled */
  SporeBlockCholesky factor;            /* no blocks: a factor is not worth its cost for this body */
  bool factor_ready;                    /* the factor is of the current matrix, or is kept */
  bool factor_alone;                    /* the factor was made without couplings */
  bool factor_kept;                     /* with couplings: it serves later matrices of the same c and c2 too */
  double rounding_soft, rounding_stiff; /* squares, of the last preconditioner: see spore_island_system_rounding */
  SporeFactorChoice choice;
} SporePreconditioner;

/* History of an integrator, see SporeHistory: its method, and the only step that may use it. */
typedef struct SporeBodyHistory {
  SporeIntegratorKind kind;
  double step_s;
  uint64_t step;
} SporeBodyHistory;

/* Energy of a body that is watched for growth: see energy_watch.c. J. */
typedef struct SporeEnergyWatch {
  bool started;
  uint32_t steps;     /* since the watch began */
  double own, height; /* kinetic plus strain energy, and that of gravity, when it began */
  double given;       /* by contacts and links since then */
} SporeEnergyWatch;

/* Rest and sleep of a body: see sleep.c. */
typedef struct SporeBodySleep {
  bool asleep;
  uint32_t next;      /* in the ring of bodies that fell asleep together */
  uint64_t steps;     /* consecutive ones in which the body was at rest */
  double speed, spin; /* m/s and 1/s: below these the body is at rest */
  double energy;      /* of sleeping contacts, J; kept with the first body of an island */
} SporeBodySleep;

typedef struct SporeIsland {
  size_t body_start, body_count;             /* in island_bodies */
  size_t contact_start, contact_count;       /* in the contacts' order */
  size_t lanes_start;                        /* in the contacts' lanes */
  size_t spring_start, spring_count;         /* in the springs' order */
  size_t q_start, q_count, v_start, v_count; /* in the local vectors */
  /* States before and after the step: see spore_island_gather. */
  const double *q0, *v0;
  double *q1, *v1;
  bool in_place; /* q1 and v1 are parts of next_q and next_v */
  SporeIntegratorKind integrator;
  size_t substeps;         /* of the integrator */
  bool multirate;          /* its bodies move by several methods: see multirate.c */
  double gravity_momentum; /* (M g . g)^1/2 */
  SporeHistory history;    /* in the local vectors */
  uint32_t attempts;       /* at this step */
  /* Result of the step. */
  SporeStepResult result;
  SporeTrouble trouble;      /* the worst, corrected or not */
  uint32_t offender;         /* body that had the trouble */
  bool made_safer;           /* this step changed the integrator */
  uint64_t mending_substeps; /* of recovery; 0: none was needed */
  size_t kept_count;         /* bodies behind these were frozen in this step */
  bool rests, falls_asleep;
} SporeIsland;

typedef struct SporeSolve {
  uint32_t *parent;        /* union-find over bodies */
  uint32_t *island_of;     /* by body; SPORE_NO_BODY: it does not move */
  uint32_t *island_bodies; /* bodies that move, island by island */
  size_t island_count;
  SporeIsland *islands;   /* body_count */
  SporeSite *local_sites; /* where bodies begin in their island's part of the local vectors */
  double *local_q0, *local_v0, *local_q1, *local_v1;
  double *best_q, *best_v; /* the same, of the best attempt at a step that went wrong */
  double *history_a, *history_b, *local_history_a, *local_history_b; /* sized as v and local_v0 */
  double *still;                                                     /* zeros: velocity of the largest body at rest */
  double *scratch;                                                   /* of the integrators */
  size_t scratch_per_block;                                          /* doubles of scratch a block */
  double *precondition;                                              /* 9 doubles a block, as local_v0 */
  size_t sleeping_count;                                             /* bodies asleep */
} SporeSolve;

void spore_solve_clear(SporeSolve *solve);
bool spore_world_create_solve(SporeWorld *world); /* the vectors above; false: no memory */

/* islands.c */
/* Stage: sorts the bodies that move into islands. An island whose bodies lie next to each other is integrated from one
 * pair of world vectors to the other; the state of any other is gathered in the local vectors. */
void spore_world_find_islands(SporeWorld *world);
/* Places the bodies of an island in its vectors, with their last good state. */
void spore_island_gather(SporeWorld *world, SporeIsland *island);
/* Keeps the history of the integrator for the next step. */
void spore_island_remember(SporeWorld *world, const SporeIsland *island);
/* Stage: writes the solved states into the next state. */
void spore_world_accept(SporeWorld *world);
/* Stage: makes the next state the last good one. */
void spore_world_advance(SporeWorld *world);

/* sleep.c */
void spore_world_create_sleep(SporeWorld *world);
/* Stage: wakes bodies that a moving body touches or is linked to. */
void spore_world_wake_touched(SporeWorld *world);
/* Whether the step just taken left the island at rest. */
bool spore_island_rests(const SporeWorld *world, const SporeIsland *island);
/* Puts an island to sleep that has rested for long enough, in the next state. */
void spore_island_let_sleep(SporeWorld *world, SporeIsland *island);
/* Keeps the energy of the contacts of an island that falls asleep, once its last state is the world's. */
void spore_island_keep_energy(SporeWorld *world, const SporeIsland *island);
/* Wakes the body, and those that fell asleep with it. */
void spore_world_wake(SporeWorld *world, uint32_t body);
void spore_world_wake_all(SporeWorld *world);

/* preconditioner.c */
/* An empty matrix of the body's model, where that has a Jacobian. False: no memory. */
bool spore_body_create_matrix(SporeBody *body, SporeError *error);
bool spore_world_create_factors(SporeWorld *world, SporeError *error);
/* Makes the factor of the body anew. False: no memory, and no factor. */
bool spore_body_create_factor(const SporeWorld *world, SporeBody *body, SporeError *error);
/* Drops history, matrix and choices of earlier steps, after the body was changed from outside. */
void spore_body_forget_steps(const SporeWorld *world, SporeBody *body);
/* The same after the body's model was changed; wakes the body. */
void spore_body_changed_model(SporeWorld *world, uint32_t body);
void spore_body_reset_choice(const SporeWorld *world, SporeBody *body);
/* Work of a linearisation and of an iteration of this body, in operations of a product with its matrix. */
double spore_body_linearisation_work(const SporeBody *body);
double spore_body_iteration_work(const SporeBody *body);
/* Chooses the preconditioner of each body of the island anew, by the result of its step. True: the step failed without
 * a factor, and should be taken again. */
bool spore_island_choose(SporeWorld *world, const SporeIsland *island);

/* integrate.c */
/* Stage: integrates the islands, each on its own and on any thread. */
void spore_world_integrate(SporeWorld *world);
/* Limits of all attempts at a step that went wrong, together. */
typedef struct SporeEffort {
  size_t iterations; /* nonlinear ones left; a part of a step takes one at least */
  double hopeless;   /* an attempt is given up after a part that misses more than this of the load */
  bool given_up;     /* q1 and v1 are those of some part of the step */
} SporeEffort;
/* One step of the world in `substeps` parts, from q0 and v0 of the island to q1 and v1. Overwrites the local vectors.
 * effort: counted down; NULL: a first attempt, where each part may take as many iterations as the scene allows. */
SporeStepResult spore_island_advance(SporeWorld *world, SporeIsland *island, SporeIntegratorKind kind, size_t substeps,
                                     SporeEffort *effort);

/* multirate.c: one step of an island whose bodies have several methods. */
SporeStepResult spore_island_advance_multirate(SporeWorld *world, SporeIsland *island);
/* Doubles of scratch a block. */
size_t spore_multirate_scratch(void);

/* recovery.c */
/* Sets island->trouble and, where there is any, island->offender. */
void spore_island_examine(SporeWorld *world, SporeIsland *island);
/* Corrects or accepts a step in trouble. Sets island->trouble to the worst trouble. */
void spore_island_recover(SporeWorld *world, SporeIsland *island);

/* step_limit.c: refuses a body that cannot be integrated as the scene asks. The message gives the largest step. */
bool spore_body_check_step(const SporeWorld *world, uint32_t body, SporeError *error);

/* energy_watch.c: false: island->offender has more energy after the step than is possible. */
bool spore_island_energy_holds(SporeWorld *world, SporeIsland *island);

/* island_system.c */
/* Motion of a body free of force; q1 and v1 may be q0 and v. */
void spore_body_drift(const SporeBody *body, const double *q0, const double *v, double h, double *q1, double *v1);
/* Mass and its inverse, of the body at the world's q. */
void spore_body_set_mass(SporeWorld *world, const SporeBody *body);
/* The same at q, for a frame that has turned. */
void spore_body_turn_mass(SporeWorld *world, const SporeBody *body, const double *q);

#endif
