/* Instruments of the library, put into a scene. No GTK. */
#ifndef SPORE_AUTHOR_INSTRUMENT_EDITS_H
#define SPORE_AUTHOR_INSTRUMENT_EDITS_H

#include "core/author/instruments.h"
#include "core/scene/document.h"

/* Where an instrument stands at time 0; places in the scene, m. NULL: as said below. */
typedef struct SporeInstrumentPlaces {
  const SporeVec3 *entry;  /* its port: the shaft goes through there. NULL: it is free */
  const SporeVec3 *target; /* what its tip points at */
} SporeInstrumentPlaces;

/* Adds an instrument that the mouse moves, as one undo step: its bodies, their meshes and spheres, its tool, and a port
 * where it enters. name NULL: that of the instrument, and a number that is free. The tip stands on the way from the
 * entry to the target, the library's clearance before the target, or halfway where it is near. Without a target it
 * points at the nearest drawn vertex of the bodies that physics moves, else of all. Without an entry it stands above
 * the target, or above the highest point of the scene. A camera's view meets the target, and looks down from the shaft.
 * A needle has no port, and brings a thread. Returns the body that the mouse moves. NULL with a GError: the two places
 * are too near to each other. */
SporeObject *spore_edit_add_instrument(SporeDocument *document, const SporeInstrumentKind *instrument, const char *name,
                                       SporeInstrumentPlaces places, GError **error);

/* Turns the optic of the camera about its axis by so much, rad, as one undo step: from below towards the right, seen in
 * its picture. FALSE with a GError: the camera looks along its axis, so that a turn would change nothing. */
gboolean spore_edit_turn_optic(SporeDocument *document, SporeObject *camera, double by, GError **error);

#define SPORE_OUTLINE_POINTS 9

/* The line along which the instrument would lie there: from the end of its shaft, or of a needle, to its tip. Returns
 * how many points the line has, in the scene, m; 0: the two places are too near to each other. */
guint spore_instrument_outline(SporeDocument *document, const SporeInstrumentKind *instrument,
                               SporeInstrumentPlaces places, SporeVec3 points[SPORE_OUTLINE_POINTS]);

#endif
