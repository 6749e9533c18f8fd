/* The film of a specimen bag. No GTK. */
#ifndef SPORE_AUTHOR_INSTRUMENT_BAG_H
#define SPORE_AUTHOR_INSTRUMENT_BAG_H

#include "core/author/instruments.h"
#include "core/math/quat.h"
#include "core/scene/document.h"

/* Adds the bag of an instrument that ends in a hoop, a net that hangs toward -z of the instrument, and ties the rim to
 * the hoop. holder: the instrument's body, which stands at `pose`. Call it inside a group. Returns the bag's body,
 * named as the holder and "_film". NULL with a GError. */
SporeObject *spore_instrument_add_film(SporeDocument *document, const SporeInstrumentKind *instrument,
                                       const SporeObject *holder, SporePose pose, GError **error);

#endif
