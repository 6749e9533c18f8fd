/* The library of instruments: one table, from which the geometry, the bodies, the tool, the menu of the editor and the
 * help of the command line follow. Lengths in m. The axes of an instrument: its shaft ends at the origin and comes from
 * +y, what it works with lies toward -y, jaws open about x. */
#ifndef SPORE_AUTHOR_INSTRUMENTS_H
#define SPORE_AUTHOR_INSTRUMENTS_H

#include <glib.h>

#include "core/math/vec3.h"

/* What is at the end of the shaft. */
typedef enum SporeInstrumentHead {
  SPORE_HEAD_BALL,   /* around the end of the shaft */
  SPORE_HEAD_MOUTH,  /* the shaft is a tube */
  SPORE_HEAD_JAWS,   /* two bodies that press */
  SPORE_HEAD_BLADES, /* two bodies that are seen; what they cut they do not push away */
  SPORE_HEAD_PRONGS, /* fixed to the shaft */
  SPORE_HEAD_ARC,    /* a needle: half a circle, and no shaft */
  SPORE_HEAD_HOOP,   /* a ring of wire that holds a bag, whose mouth is toward +z */
  SPORE_HEAD_LENS    /* a camera looks out of the end of the shaft */
} SporeInstrumentHead;

/* What an instrument is made of. Each part is a body. */
typedef enum SporeInstrumentPart {
  SPORE_PART_SHAFT, /* what the device moves */
  SPORE_PART_JAW_A,
  SPORE_PART_JAW_B,
} SporeInstrumentPart;

typedef struct SporeInstrumentKind {
  const char *name;    /* on the command line, and the beginning of the names of its bodies */
  const char *label;   /* for people, translatable (N_) */
  const char *purpose; /* what it does, a few words that go after the label, translatable (N_) */
  const char *tool;    /* element of the scene's file */
  SporeInstrumentHead head;
  double radius;      /* of the shaft, or of a needle's wire */
  double head_length; /* of jaws, blades, prongs and a hoop, beyond the shaft; 0 for the others */
  double head_radius; /* of the ball, of jaws, blades and prongs at the shaft, of the arc, of the mouth of a bag */
  double clearance;   /* from what it works with to what it points at, where there is room */
  double look_rad;    /* between a camera's view and its shaft */
  const char *fluid;  /* of the library of fluids, what comes out of it; NULL: nothing */
  const char *mode;   /* of the tool's fidelity; NULL: it has none */
  const char *const *settings; /* of the tool: name, text, ..., NULL; where they differ from their defaults */
} SporeInstrumentKind;

extern const SporeInstrumentKind spore_instruments[]; /* the one with the name NULL ends it */

/* The instrument of that name, or NULL. */
const SporeInstrumentKind *spore_instrument_find(const char *name);
/* Whether it consists of a shaft and two jaws or blades; else it is one body. */
gboolean spore_instrument_has_jaws(const SporeInstrumentKind *instrument);
/* With what it touches, cuts, sucks, heats or pierces, in its axes. */
SporeVec3 spore_instrument_tip(const SporeInstrumentKind *instrument);

/* What is drawn of a part. length: of the shaft. The text of an OFF mesh, closed, of *size bytes. g_free. */
char *spore_instrument_mesh(const SporeInstrumentKind *instrument, SporeInstrumentPart part, double length,
                            gsize *size);
/* What is felt of a part: the text of a set of spheres. NULL: nothing is felt of it. g_free. */
char *spore_instrument_spheres(const SporeInstrumentKind *instrument, SporeInstrumentPart part, double length,
                               gsize *size);

#endif
