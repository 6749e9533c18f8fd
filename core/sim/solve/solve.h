/* Solving. The bodies that move are sorted into islands: bodies that contacts and links couple in this step. Each
 * island is integrated by itself, on any thread, by the integrator of its bodies. A step that went wrong is taken again
 * (recovery). An island at rest sleeps.
 *
 * "Local vectors" hold the states of islands one after the other, where the bodies of an island do not lie next to each
 * other in the world's vectors. c and c2 are the coefficients of an implicit step's matrix M + c D + c2 K. */
#ifndef SPORE_SIM_SOLVE_H
#define SPORE_SIM_SOLVE_H

#include "core/integrate/integrator.h"
#include "core/linalg/block_cholesky.h"
#include "core/sim/contact/contact.h"

/* How a body is integrated. */
typedef struct SporeBodyMethod {
  SporeIntegratorKind integrator; /* now */
  SporeIntegratorKind chosen;     /* by the scene or the world; the monitor may since have taken a safer one */
  size_t substeps;                /* of the integrator in a step */
  SporeMethodSource integrator_source, substeps_source;
} SporeBodyMethod;

/* Blocks of a body that stand still: first those that pins hold, then particles out of the world and spare nodes. */
typedef struct SporeHeldBlocks {
  uint32_t *blocks; /* ascending within each of the two parts */
  size_t count, pin_count;
  uint8_t *flags; /* one a block: it stands still; for the factor; NULL: the body has no factor */
} SporeHeldBlocks;

/* The linearisation that a step began with: none, a new one, or one kept from an earlier step. */
typedef enum SporeStart { SPORE_START_NONE, SPORE_START_NEW, SPORE_START_KEPT } SporeStart;

/* Whether the matrix of a body is factorised, how long a linearisation is kept, and the measured work that led to
 * this choice: see preconditioner.c. */
typedef struct SporeFactorChoice {
  bool factorised; /* the present choice */
  bool needed;     /* conjugate gradients alone did not solve a step: a factor is needed; of a rigid body: of its small
                      island */
  bool stuck;      /* Newton's method with conjugate gradients did not solve a step: the exact tangent is needed,
                      and only a factor can use it */
  uint32_t votes, patience; /* steps in which work was counted; number of such steps before the choice may change */
  double present, other;    /* work of the counted steps; estimate of their work with the other choice */
  uint32_t steps;           /* since the choice last changed */
  double iterations;        /* of conjugate gradients in a Newton iteration, before the choice changed */
  SporeStart start;         /* linearisation that the present step began with */
  uint64_t made;            /* number of the step in which that linearisation was made */
  uint32_t keep;            /* steps for which a linearisation is kept */
  uint32_t calm, trial;     /* steps in which keeping it went well; number of such steps before `keep` grows */
  double fresh;             /* iterations of a step with a new linearisation */
  double excess;            /* iterations above that of the steps that kept the linearisation */
  uint32_t factors;         /* made in the present step */
  double linear;            /* among couplings: conjugate gradient iterations in a Newton iteration with a new factor */
  double debt;              /* among couplings: work above that since the factor was made */
} SporeFactorChoice;

typedef struct SporeCoupledRoom SporeCoupledRoom; /* see coupled_factor.c */

/* Matrix of a body, and the factor of that matrix. */
typedef struct SporePreconditioner {
  SporeBlockMatrix
      matrix; /* M + c D + c2 K of the model alone, without couplings; empty where the model has no Jacobian */
  double matrix_c, matrix_c2;   /* c and c2 of the assembled matrix; 0: not assembled */
  SporeTangentForm matrix_form; /* what it took of the stiffness */
  uint64_t matrix_step;         /* number of the step in which the matrix was assembled */
  SporeBlockCholesky factor;    /* without blocks: this body is never factorised */
  bool factor_ready;            /* the factor may be used: it belongs to the present matrix, or is kept */
  bool factor_alone;            /* the factor was made without couplings */
  uint64_t factors_made;        /* tells the numbers of one factor from those of another */
  double bare_c, bare_c2;       /* c and c2 of the numbers of such a factor, whatever the present matrix is; 0: none */
  bool factor_kept;             /* among couplings: the factor also serves later matrices with the same c and c2 */
  double *rows;                 /* of a rigid body: its rows of the factor of a small island; NULL: of another body */
  SporeCoupledRoom *coupled;    /* for the couplings of an island that the body is the first of; NULL: no matrix */
  uint32_t first_row;           /* first entry of these rows that is not zero */
  double turning[9];            /* of a rigid body: what the load of links adds to A against turning */
  double rounding_soft, rounding_stiff; /* squares, of the last preconditioner: see spore_island_rounding */
  SporeFactorChoice choice;
} SporePreconditioner;

/* What multistep integrators know of the last step of a body (see SporeHistory): integrator, length, and number of the
 * step for which the history is valid. */
typedef struct SporeBodyHistory {
  SporeIntegratorKind kind;
  double step_s;
  uint64_t step;
} SporeBodyHistory;

/* Steps between two looks: at the energy and the error of explicit bodies, and at the forces that solvers evaluate. */
#define SPORE_STEPS_BETWEEN_LOOKS 64

/* Energy of all that physics moves, watched for growth: see energy_watch.c. J. */
typedef struct SporeEnergyWatch {
  bool started;
  uint32_t steps;        /* since the watch began */
  SporeEnergy energy;    /* when the watch began */
  double had, change;    /* at work: when the watch began; the largest change seen since */
  double work, turnover; /* of what drives: sum of the work since then, and of its size */
} SporeEnergyWatch;

/* Until a way of recovery that did not help is tried again: see recovery.c. */
typedef struct SporePause {
  uint32_t left, length;
} SporePause;

/* Rest and sleep of a body: see sleep.c. */
typedef struct SporeBodySleep {
  bool asleep;
  uint32_t next;      /* next body in the ring of bodies that fell asleep together */
  uint64_t steps;     /* steps in a row in which the body was at rest */
  double speed, spin; /* m/s and 1/s: slower than both, the body is at rest */
  double energy;      /* J, of the contacts of a sleeping island: kept with the first body of that island */
} SporeBodySleep;

/* The equations that an island solved last in a step, kept so that stage `verify` can evaluate them again: two, since a
 * step of TR-BDF2 solves two. Their vectors lie in SporeSolve.kept_q and so on, in buffer 2 set + i % 2 for the i-th,
 * beside the last evaluation of their forces. */
#define SPORE_EQUATIONS 2
typedef struct SporeKeptEquations {
  size_t count;        /* solved in this attempt at the step, kept or not */
  size_t set;          /* 0 or 1: recovery keeps those of its best attempt in the other set */
  double balance_load; /* load of the balance of forces that an attempt at this step sought; 0: none did */
  struct {
    double c, load; /* see SporeEquation */
    double at_s;    /* since the step began: where prescribed ends are */
    bool shaped;    /* viscous forces are those of the shape qa */
    bool apart;     /* explicit bodies take part by their mass only: see multirate.c */
    bool evaluated; /* there is an evaluation of its forces */
    uint64_t laws;  /* of that evaluation: see spore_island_system_laws */
  } kept[SPORE_EQUATIONS];
} SporeKeptEquations;

/* What stage `verify` finds. Residuals are norms (r.M^-1 r)^1/2 as parts of the equation's load. */
typedef struct SporeVerdict {
  double residual; /* the larger of the kept equations; 0: the island solved none */
  double rounding; /* that of the state's own digits; measured only where the residual is above the tolerance, else 0 */
  uint32_t body;   /* with the largest part of the residual; SPORE_NO_BODY: none */
} SporeVerdict;

#define SPORE_LEAST_GRAVITY 0.01 /* m/s^2: the load of weightless bodies is at least so much, or rounding would be */

/* An island: where its bodies, contacts and springs lie, how it is integrated, and what came of that. */
typedef struct SporeIsland {
  size_t body_start, body_count;             /* in island_bodies */
  size_t contact_start, contact_count;       /* in SporeContactSystem.order */
  size_t lanes_start;                        /* in SporeContactSystem.lanes */
  size_t spring_start, spring_count;         /* in SporeLinkSystem.order */
  size_t q_start, q_count, v_start, v_count; /* in the local vectors */
  /* A step takes the island from q0, v0 to q1, v1: set by spore_island_gather. */
  const double *q0, *v0;
  double *q1, *v1;
  bool in_place; /* q1 and v1 lie in next_q and next_v */
  SporeIntegratorKind integrator;
  SporeIntegratorKind taken; /* by the first attempt at this step */
  size_t substeps;           /* of the integrator */
  bool multirate;            /* its bodies have different integrators or substeps: see multirate.c */
  double gravity_momentum;   /* (M g . g)^(1/2), a scale for residuals */
  double least_force;        /* where there is no gravity, the same of SPORE_LEAST_GRAVITY; else 0 */
  SporeHistory history;      /* in the local vectors */
  uint32_t attempts;         /* made at this step */
  SporeKeptEquations equations;
  /* What came of the step. */
  SporeStepResult result;
  SporeVerdict verdict;
  SporeTrouble trouble;            /* the worst that was met, corrected or not */
  uint32_t offender;               /* body in which the trouble was met */
  bool made_safer;                 /* this step took a safer integrator, for good */
  double drift_s;                  /* the longest that its bodies moved free of force at once */
  double error;                    /* of an explicit step: how far two of half its size are from it; 0: not looked at */
  bool frictionless;               /* this step was taken without friction, since with friction none was found */
  const SporeIntegrator *stand_in; /* took this step for the bodies with other integrators; NULL: none */
  uint64_t mending_substeps;       /* substeps that recovery took; 0: it was not needed */
  size_t kept_count;               /* bodies not frozen by this step: they come first in the island */
  bool rests, falls_asleep;
} SporeIsland;

/* The solver's part of a world. */
typedef struct SporeSolve {
  uint32_t *parent;        /* union-find over bodies */
  uint32_t *island_of;     /* one a body: index of its island; SPORE_NO_BODY: the body does not move */
  uint32_t *island_bodies; /* bodies that move, island by island */
  size_t island_count;
  SporeIsland *islands;   /* body_count: room for as many */
  SporeSite *local_sites; /* one a body: where it begins in the part of the local vectors that is its island's */
  double *local_q0, *local_v0, *local_q1, *local_v1;
  double *best_q, *best_v; /* like the local vectors: the best attempt of recovery at a step that went wrong */
  double *history_a, *history_b, *local_history_a, *local_history_b; /* as v and local_v0 */
  double *kept_q[2 * SPORE_EQUATIONS], *kept_va[2 * SPORE_EQUATIONS], *kept_v[2 * SPORE_EQUATIONS]; /* likewise */
  SporeEvaluation evaluated[2 * SPORE_EQUATIONS];                                                   /* likewise */
  double *still;            /* zeros: velocity of the largest body at rest */
  double *scratch;          /* of the integrators */
  size_t scratch_per_block; /* doubles of scratch a block */
  double
      *precondition; /* 9 doubles a block, in the order of the local vectors: diagonal blocks of the preconditioner */
  double *lanes;     /* SPORE_LANES vectors like local_v0, island by island: see coupled_factor.c */
  size_t sleeping_count; /* bodies asleep */
  SporeEnergyWatch watch;
} SporeSolve;

void spore_solve_clear(SporeSolve *solve);
bool spore_world_create_solve(SporeWorld *world); /* makes the vectors above; false: no memory */

/* islands.c */
/* Stage: sorts the bodies that move into islands. An island whose bodies lie next to each other is integrated from one
 * pair of world vectors to the other; the state of any other is gathered in the local vectors. */
void spore_world_find_islands(SporeWorld *world);
/* Sets where the bodies of the island lie in its vectors, and brings their last good state there. */
void spore_island_gather(SporeWorld *world, SporeIsland *island);
/* Keeps the history of this step for the integrator's next step. */
void spore_island_remember(SporeWorld *world, const SporeIsland *island);
/* Stage: writes the results of all islands into the next state. */
void spore_world_accept(SporeWorld *world);
/* Stage: makes the next state the last good one. */
void spore_world_advance(SporeWorld *world);

/* sleep.c */
void spore_world_create_sleep(SporeWorld *world);
/* Stage: wakes bodies that something moving touches, or is linked to. */
void spore_world_wake_touched(SporeWorld *world);
/* Whether the step just taken left the island at rest. */
bool spore_island_rests(const SporeWorld *world, const SporeIsland *island);
/* Sends the island to sleep if it has rested for long enough: it has velocity 0 in the next state then. */
void spore_island_let_sleep(SporeWorld *world, SporeIsland *island);
/* Keeps the contact energy of an island that falls asleep. To be called when the island's last state is the world's. */
void spore_island_keep_energy(SporeWorld *world, const SporeIsland *island);
/* Wakes the body, and all bodies that fell asleep together with it. */
void spore_world_wake(SporeWorld *world, uint32_t body);
void spore_world_wake_all(SporeWorld *world);

/* preconditioner.c */
/* Makes the matrix of the body, zero, if the body's model has a Jacobian. False: no memory. */
bool spore_body_create_matrix(SporeBody *body, SporeError *error);
/* Makes the factors of all bodies that may be factorised. False: no memory. */
bool spore_world_create_factors(SporeWorld *world, SporeError *error);
/* Makes the factor of the body anew, for its present pattern. False: no memory; the body has no factor then. */
bool spore_body_create_factor(const SporeWorld *world, SporeBody *body, SporeError *error);
/* Forgets what earlier steps have left with the solver. To be called after the body was changed from outside. */
void spore_body_forget_steps(SporeWorld *world, SporeBody *body);
/* The same after the body's model was changed; also wakes the body. */
void spore_body_changed_model(SporeWorld *world, uint32_t body);
/* Starts the choice of a preconditioner anew. */
void spore_body_reset_choice(const SporeWorld *world, SporeBody *body);
/* Estimated work of the body's factor, and of a solution by it. */
double spore_body_factor_work(const SporeBody *body);
double spore_body_solve_work(const SporeBody *body);
/* Estimated work of a linearisation, and of a conjugate gradient iteration, for this body: in floating-point operations
 * as a product with its matrix makes them. */
double spore_body_linearisation_work(const SporeBody *body);
double spore_body_iteration_work(const SporeBody *body);
/* The same of an iteration of conjugate gradients without a factor. */
double spore_body_gradient_work(const SporeBody *body);
/* Chooses anew how each body of the island is preconditioned, from the work of the step just taken (island->result).
 * True: the step failed for lack of a factor, and should be taken again. */
bool spore_island_choose(SporeWorld *world, const SporeIsland *island);

/* island_factor.c */
/* The most bodies of an island of rigid bodies whose matrix is factorised as a whole. */
#define SPORE_SMALL_ISLAND 20
/* Room for the body's part of such a factor, if the body is rigid. False: no memory. */
bool spore_body_create_rows(SporeBody *body);

/* coupled_factor.c: makes room for the couplings of an island with each body that has a matrix. False: no memory. */
bool spore_world_create_coupled_rooms(SporeWorld *world);
/* What earlier steps left there is of no use any more. */
void spore_coupled_room_forget(SporeCoupledRoom *room);
/* Whether a body has such room: without one, nothing is coupled, and the world needs no lanes. */
bool spore_world_has_coupled_rooms(const SporeWorld *world);

/* integrate.c */
/* Stage: integrates the islands, each on its own and on any thread. */
void spore_world_integrate(SporeWorld *world);
/* What all attempts of recovery at one step may still take. */
typedef struct SporeEffort {
  size_t iterations; /* nonlinear iterations left; a part of a step takes at least one */
  size_t linear;     /* linear iterations left, of a step whose first attempt was hopeless; 0: as many as it takes */
  double hopeless;   /* relative residual: an attempt with a larger one is given up */
  size_t patience;   /* times the iterations, nonlinear and linear, that a part may take otherwise; 0: no more */
  bool given_up;     /* the attempt ended early: q1 and v1 are the state after some of its parts */
} SporeEffort;
/* Takes the island through one step of the world in `substeps` parts, from its q0 and v0 to q1 and v1. Overwrites the
 * island's part of the local vectors. effort: counted down; NULL for the first attempt, each part of which may take as
 * many iterations as the scene allows. */
SporeStepResult spore_island_advance(SporeWorld *world, SporeIsland *island, SporeIntegratorKind kind, size_t substeps,
                                     SporeEffort *effort);
/* Why the body would take its next step implicitly, though its method is explicit, by what touches and ties it now; and
 * *resolving: see SporeMethod. To be called between steps: sorts the bodies into islands. */
SporeCoupled spore_body_coupled(SporeWorld *world, uint32_t body, size_t *resolving);

/* impact.c */
/* How far the impacts of a passive body are followed. */
SporeImpacts spore_body_impacts(const SporeWorld *world, uint32_t body);
/* Whether the island is of one or two rigid bodies, without links, in an impact that its own method does not follow;
 * then *part_s is the step that follows it. */
bool spore_island_strikes(SporeWorld *world, SporeIsland *island, double *part_s);
/* Takes the island through one step in parts of that length. Its contacts end as they are found there, with their mean
 * force. */
SporeStepResult spore_island_advance_impact(SporeWorld *world, SporeIsland *island, double part_s);

/* multirate.c: one step of an island whose bodies move by several methods, or have contacts or links that their
 * explicit method does not resolve. */
SporeStepResult spore_island_advance_multirate(SporeWorld *world, SporeIsland *island);
/* Doubles of scratch that this takes a block. */
size_t spore_multirate_scratch(void);

/* verify.c */
/* Stage: evaluates the equations that the islands solved, apart from the solver, each island on any thread. */
void spore_world_verify(SporeWorld *world);

/* recovery.c */
/* Looks at the result of a step. Sets island->trouble and, where there is any, island->offender. */
void spore_island_examine(SporeWorld *world, SporeIsland *island);
/* Corrects a step in trouble, or accepts it. island->trouble is the worst that was met, also after it was corrected. */
void spore_island_recover(SporeWorld *world, SporeIsland *island);

/* islands.c: whether a hopeless step (see recovery.c) of the body, or of a body of the island, would now be the next
 * one in a row, pauses apart. */
bool spore_body_is_hopeless(const SporeWorld *world, const SporeBody *body);
bool spore_island_is_hopeless(const SporeWorld *world, const SporeIsland *island);

/* freezing.c */
/* Takes the body out of the island for good; for its terms it stands still. The attempts so far were made with the
 * body, so they are of no use, and the island's trouble says so. */
void spore_island_freeze(SporeWorld *world, SporeIsland *island, uint32_t body);
/* Lets a frozen body move again. */
void spore_body_thaw(SporeBody *body);

/* step_limit.c: whether a pin or a link holds the body. */
bool spore_body_is_held(const SporeWorld *world, uint32_t index);
/* False for a body that cannot be integrated as the scene asks; the error names the largest possible step
 * where the step is too large. */
bool spore_body_check_step(const SporeWorld *world, uint32_t body, SporeError *error);

/* energy_watch.c. Whether the world has steps that may make energy. Bodies by the static method have no energy that is
 * kept, and a world that has one is not watched. */
bool spore_world_may_gain_energy(const SporeWorld *world);
/* Begins the watch, if it must begin anew, from the state that the step begins in, once contacts and links are known.
 */
void spore_world_start_watch(SporeWorld *world);
/* Stage: counts explicit steps that made energy out of nothing as unsolved, and makes a body safer that made much. */
void spore_world_watch_energy(SporeWorld *world);

/* island_system.c */
/* Moves a body free of force for h seconds; q1 and v1 may be q0 and v. */
void spore_body_drift(const SporeBody *body, const double *q0, const double *v, double h, double *q1, double *v1);
/* Sets mass and mass_inverse of the body, at the last good state. */
void spore_body_set_mass(SporeWorld *world, const SporeBody *body);
/* The same at q, for the block of a frame alone: only this block depends on q. */
void spore_body_turn_mass(SporeWorld *world, const SporeBody *body, const double *q);

#endif
