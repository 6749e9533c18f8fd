/* Levels of detail of a body: what describes them to a world, and what a world tells of them. */
#ifndef SPORE_SIM_LOD_TYPE_H
#define SPORE_SIM_LOD_TYPE_H

#include "core/body/model.h"

/* Levels of detail of a body. */
typedef enum SporeLodGrade { SPORE_LOD_COARSE, SPORE_LOD_MEDIUM, SPORE_LOD_FINE } SporeLodGrade;
#define SPORE_LOD_COUNT 3                   /* number of levels of detail */
extern const char *const spore_lod_names[]; /* as in the file, NULL at the end */

/* What changes the level of a body. */
typedef enum SporeLodCause {
  SPORE_LOD_BY_HAND,     /* a command, and nothing else */
  SPORE_LOD_BY_ERROR,    /* the estimated error of a level, as the body is bent now */
  SPORE_LOD_BY_DISTANCE, /* how near tools and eyes are */
  SPORE_LOD_BY_TIME      /* the time that steps take, so that two runs may differ */
} SporeLodCause;
extern const char *const spore_lod_cause_names[]; /* as in the file, NULL at the end */

/* How a body changes its level by itself. */
typedef struct SporeLodRule {
  SporeLodCause by;
  double tool_distance; /* m: fine where an active body is nearer, medium up to twice as far; 0: tools do not count */
  double view_distance; /* m: the same of eyes */
  double wait_s;        /* simulated, from one change to the next at least */
} SporeLodRule;

/* The same body made less finely. A running world can change the body to such a level. */
typedef struct SporeLodDescription {
  SporeModel
      *model[SPORE_LOD_FINE]; /* of the same type as the body's model, and owned as that is; NULL: no such level */
  SporeLodGrade first;        /* the level at time 0 */
  double tolerance;           /* m: a change that moves a point of the body further than this is refused */
  SporeLodRule rule;
  size_t surface_count;
  const double *surface; /* surface_count x 3, body's frame at rest, borrowed: points that the error of a change is
                            measured on, besides spheres and nodes */
} SporeLodDescription;

/* A place that somebody looks from. */
typedef struct SporeEyeDescription {
  uint32_t body;   /* the rigid or active body that the eye moves with; SPORE_NO_BODY: it stands still */
  SporeVec3 point; /* world, at time 0, m */
  SporeVec3 sight; /* the way it looks, at time 0; of length 1 */
  double lens;     /* radius of the front lens, m; 0: nothing wets it */
  double haze_s;   /* how long smoke hazes the view, until a third is left, s; 0: smoke is seen by its puffs alone */
} SporeEyeDescription;

/* Level of detail of a body, and what changes of level did since time 0. */
typedef struct SporeLodState {
  SporeLodGrade level; /* now */
  uint64_t changes;    /* of level that were made */
  uint64_t refused;    /* changes of level that were refused */
  double error;        /* m: largest distance by which a change moved a sphere, a node or a point of the surface */
  double energy;   /* J: largest gain of the body's own energy (kinetic and internal) by a change; negative: each lost
                      some */
  double momentum; /* N s: largest error that a change made in the momentum of a free body, or in its angular momentum
                      about its centre divided by its extent */
} SporeLodState;

/* A change of level that was made. */
typedef struct SporeLodChange {
  uint32_t body;
  SporeLodGrade from, to;
  double time_s; /* simulated */
  SporeLodCause by;
  double figure; /* why: of BY_ERROR the estimated error of the coarser of the two levels, m; of BY_DISTANCE how far the
                    nearest tool or eye that counts is, m; of BY_TIME what a step took before, us; else 0 */
} SporeLodChange;
#define SPORE_LOD_LOG 256 /* changes that a world keeps: the last ones */

#endif
