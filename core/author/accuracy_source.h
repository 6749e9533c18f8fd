/* The worlds that an accuracy study (core/measure/accuracy.h) makes of a document. */
#ifndef SPORE_AUTHOR_ACCURACY_SOURCE_H
#define SPORE_AUTHOR_ACCURACY_SOURCE_H

#include "core/measure/accuracy.h"
#include "core/scene/compile.h"

/* A document that is run by other methods, steps, levels and stretches of its input; the document itself is never
 * changed. For one thread. */
typedef struct SporeAccuracySource SporeAccuracySource;

/* All borrowed. simulation: of the document as it is, with this input. pool, input and cancel as for
 * spore_simulation_new. body: whose method and level are varied; NULL: of all that physics moves. */
SporeAccuracySource *spore_accuracy_source_new(SporeDocument *document, const SporeSimulation *simulation,
                                               SporePool *pool, const SporeTrack *input, const SporeCancel *cancel,
                                               const char *body);
void spore_accuracy_source_free(SporeAccuracySource *source);
/* Makes the sets of spheres that the study asks for by these factors: core/author/sphere_sets.h. FALSE with a GError.
 */
gboolean spore_accuracy_source_vary_spheres(SporeAccuracySource *source, const double *factors, gsize count,
                                            const SporeProgress *progress, GError **error);
/* Bodies that keep their level at every level of a study; NULL at the end, borrowed. */
void spore_accuracy_source_keep(SporeAccuracySource *source, const char *const *bodies);
/* The study's way to the document, valid as long as the source is. The choice of a world is a SporeVariation. */
SporeAccuracyScene spore_accuracy_source_scene(SporeAccuracySource *source);

#endif
