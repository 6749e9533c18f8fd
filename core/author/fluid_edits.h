/* Fluids of the library, put into a scene. No GTK. */
#ifndef SPORE_AUTHOR_FLUID_EDITS_H
#define SPORE_AUTHOR_FLUID_EDITS_H

#include "core/author/fluids.h"
#include "core/scene/document.h"

/* Adds a fluid at a place of the scene, m, as one undo step: the body of particles, the surface that they fill at the
 * start, and the emitter that they come out of, if the kind has one. What comes out of an organ comes out of its drawn
 * surface where that is nearest to the place, and goes with the organ; what is poured lies over it, clear of every
 * body, and is less where there is less room. Particles are as large as suits the organ, and have as many substeps as
 * the scene's step asks for. organ NULL: the one that is nearest; of a tool's mouth, the instrument. name NULL: that of
 * the kind. Returns the emitter; the body, where the kind has none. NULL with a GError: no organ shows a surface, the
 * organ cannot be cut, there is no such instrument, or no room. */
SporeObject *spore_edit_add_fluid(SporeDocument *document, const SporeFluidKind *kind, const char *name,
                                  SporeObject *organ, SporeVec3 place, GError **error);

#endif
