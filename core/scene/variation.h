/* A scene varied: the same document with other methods, steps, levels, stiffnesses and masses, compiled for running. */
#ifndef SPORE_SCENE_VARIATION_H
#define SPORE_SCENE_VARIATION_H

#include "core/scene/compile.h"

/* What differs of one body, instead of what the variation says of all. NULL: as the scene says. */
typedef struct SporeBodySetting {
  const char *body, *integrator, *level;
} SporeBodySetting;

/* What differs from the scene. All zero is the scene as it is. */
typedef struct SporeVariation {
  const char *body; /* the passive body that the method, level and factors are of; NULL: all of them */
  const char
      *integrator; /* by name. It is taken in one part a step, whatever substeps the scene says. NULL: the scene's */
  const char *nonlinear, *linear;   /* of the scene's solver, by name; NULL: the scene's */
  const char *level;                /* that bodies which have it begin at; NULL: the scene's */
  double dt_s;                      /* 0: the scene's */
  double tolerance;                 /* relative residual of implicit steps; 0: the scene's */
  gboolean awake;                   /* no body sleeps */
  double stiffness, mass;           /* factors on what the models of the bodies say; 0: 1 */
  double contact;                   /* factor on the stiffness of the contact law of every body; 0: 1 */
  const char *still;                /* a passive body that stands still instead; NULL: none */
  const char *effect;               /* name of what is an effect; NULL: as the scene says */
  const char *effect_section;       /* that it is in: "tools", "effects"; NULL: "bodies" */
  gboolean physical;                /* physics moves all other passive bodies, and all other tools are physical */
  const char *left_out;             /* a passive body that is not there, nor what ties it; NULL: none */
  const SporeBodySetting *settings; /* setting_count */
  gsize setting_count;
  const char *const *kept; /* bodies that keep their level, NULL at the end; NULL: none do */
  gboolean every_second;   /* stiffness and mass are of the second, fourth, ... passive body alone */
} SporeVariation;

/* Sets in the document itself what the variation says, as commands. Values are held within the ranges of their
 * parameters. FALSE with a GError, and the document half changed: no such body, integrator, solver or level, or no body
 * that the integrator can move. */
gboolean spore_variation_set(SporeDocument *document, const SporeVariation *variation, GError **error);

/* Compiles a varied copy of the document, which stays as it is. No level follows the clock in it. The other arguments
 * are those of spore_simulation_new. NULL with a GError: as spore_variation_set, or the scene cannot run so. */
SporeSimulation *spore_variation_make(SporeDocument *document, const SporeVariation *variation, SporePool *pool,
                                      const SporeTrack *input, const SporeCancel *cancel, GError **error);

/* Sends the variation's factors on stiffness and contacts to a running simulation of the document. TRUE: some body took
 * one; a model whose parameters cannot change while it runs does not. */
gboolean spore_variation_apply(SporeDocument *document, const SporeVariation *variation, SporeSimulation *simulation);

#endif
