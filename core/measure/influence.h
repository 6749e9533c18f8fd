/* Physical or effect: how much an element of a scene matters to the rest of it, from runs with it, without it, and with
 * half the step. Criteria: the outcome is essentially the same (Carlson and Hodgins 1997), and no other body behaves in
 * another way (Meseure et al. 2003, section 6). */
#ifndef SPORE_MEASURE_INFLUENCE_H
#define SPORE_MEASURE_INFLUENCE_H

#include "core/measure/trial.h"

/* How far two runs are apart, of which one may lack bodies that the other has. */
typedef struct SporeInfluence {
  double rms;   /* root mean square distance of points of the bodies that both runs followed, each by the length of
                   its body, and each body with the same weight; INFINITY: one of the runs did not end */
  double worst; /* of any of these points at any time */
  uint32_t worst_body; /* the body that the point is of; SPORE_NO_BODY: no body was followed */
  double force;        /* root mean square difference of the forces on bodies that devices move, N */
  double score;        /* distance of the scores of the scene's exercise; 0: there is none */
  size_t steps;        /* of the exercise: how many one run alone did */
  size_t step;         /* the first of these */
} SporeInfluence;

/* Compares two trials whose looks were at the same times. Bodies that only one of them followed are left out. Particles
 * that come and go are compared as spore_trial_difference does. */
SporeInfluence spore_influence_between(const SporeTrialPoints *points, const SporeTrial *trial,
                                       const SporeTrialPoints *other_points, const SporeTrial *other);
/* How far a point of the body moved from where it was at the start, by the length of the body; `followed`: index in
 * points->bodies. */
double spore_influence_own_motion(const SporeTrialPoints *points, const SporeTrial *trial, size_t followed);

/* What to do with an element. */
typedef enum SporeVerdict {
  SPORE_VERDICT_PHYSICAL, /* others feel it, or nothing would be saved */
  SPORE_VERDICT_STILL,    /* it hardly moves, and others feel it alike where it stands still */
  SPORE_VERDICT_COARSE,   /* at a coarser level nobody feels a difference */
  SPORE_VERDICT_EFFECT,   /* nothing else changes without it: what is seen of it is enough */
  SPORE_VERDICT_COUNT
} SporeVerdict;
extern const char *const spore_verdict_names[]; /* "physical", "still", "coarse", "effect", NULL */

/* A cheaper form of an element, tried. */
typedef struct SporeForm {
  bool tried;
  bool left_out; /* there is no effect for it: it was not there at all */
  SporeInfluence influence;
  double saved_us; /* of a step, CPU time */
} SporeForm;

/* What is known of an element. */
typedef struct SporeEvidence {
  double floor;       /* what the step's own error, or a start that is a little off, does to the other bodies, as
                         SporeInfluence.rms; what lies below cannot be told from it */
  double force_floor; /* the same of the forces, N */
  double score_floor; /* the same of the exercise's score */
  SporeTrialEvents events_floor; /* the same of what is counted */
  double step_us;                /* of the scene as it is, CPU time */
  double own_motion;
  const char *held;    /* an instrument or a link by that name acts on it, which is a veto; NULL: none */
  bool alone;          /* nothing else moves by physics, and no exercise tells whether an effect will do: a veto */
  const char *awaited; /* a step of the exercise that is done to it, and that the run never did: a veto; NULL: none */
  bool chaotic;        /* noise alone moves bodies too far to tell, and no exercise tells either: a veto */
  bool events;         /* without it something else breaks, tears or is cut: a veto */
  SporeForm forms[SPORE_VERDICT_COUNT]; /* by the verdict that they lead to */
} SporeEvidence;

/* The cheapest form that nobody feels and that saves something worth. */
SporeVerdict spore_evidence_verdict(const SporeEvidence *evidence);
/* A noise floor above this tells nothing. */
#define SPORE_EVIDENCE_TELLING 0.1
/* Share of a step that a form must save. */
#define SPORE_EVIDENCE_WORTH 0.02
/* How far a body that may stand still moves at most, by its length. */
#define SPORE_EVIDENCE_STILL 0.01

#endif
