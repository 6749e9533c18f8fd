/* The library of fluids: what bleeds, what is poured, what rinses, what rises as steam. One table, from which the
 * bodies, the emitter, the menu of the editor and the help of the command line follow. */
#ifndef SPORE_AUTHOR_FLUIDS_H
#define SPORE_AUTHOR_FLUIDS_H

#include <glib.h>

/* What the mouth of an emitter is in. */
typedef enum SporeFluidMouth {
  SPORE_MOUTH_NONE,   /* no emitter: the fluid lies there from the start */
  SPORE_MOUTH_ORGAN,  /* the organ at the place */
  SPORE_MOUTH_TISSUE, /* the same, which has to be one that can be cut */
  SPORE_MOUTH_HEATER, /* the bipolar instrument that is nearest to the place */
  SPORE_MOUTH_TUBE    /* the suction tube, in the same way; it comes out along the shaft */
} SporeFluidMouth;

typedef struct SporeFluidKind {
  const char *name;                       /* on the command line, and the beginning of the emitter's name */
  const char *label;                      /* for people, translatable (N_) */
  const char *purpose;                    /* what it does, a few words that go after the label, translatable (N_) */
  const char *fluid;                      /* the beginning of the body's name */
  const char *model;                      /* element of the scene's file */
  const char *colour, *wetness, *opacity; /* as in the scene's file; opacity NULL: 1 */
  const char *mode;                       /* of its fidelity; NULL: physical */
  SporeFluidMouth mouth;
  unsigned particles;                                         /* about so many */
  const char *const *settings, *const *contact, *const *flow; /* of the model, of what is felt of it, of the emitter:
                                                name, text, ..., NULL; where they differ from their defaults. contact
                                                NULL: nothing feels it */
} SporeFluidKind;

extern const SporeFluidKind spore_fluids[]; /* the one with the name NULL ends it */

/* The kind of that name, or NULL. */
const SporeFluidKind *spore_fluid_find(const char *name);

#endif
