/* A document as a runtime file. */
#ifndef SPORE_SCENE_COMPILE_RUNTIME_H
#define SPORE_SCENE_COMPILE_RUNTIME_H

#include "core/base/cancel.h"
#include "core/haptic/track.h"
#include "core/scene/document.h"

/* The content of a runtime file of the document (core/runtime/runtime.h), once its world could be made; *size: its
 * bytes. input: as by spore_simulation_new. undrawn: gets the names (g_free) of bodies that no visual mesh shows, which
 * the file cannot show either. Free with spore_free. NULL with the error. */
gpointer spore_document_format_runtime(SporeDocument *document, const SporeTrack *input, const SporeCancel *cancel,
                                       GPtrArray *undrawn, gsize *size, GError **error);

#endif
