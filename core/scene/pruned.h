/* A scene without what its runs do not need. */
#ifndef SPORE_SCENE_PRUNED_H
#define SPORE_SCENE_PRUNED_H

#include "core/scene/document.h"

/* A copy of the document that runs to the same bits and looks the same, without what only its author needs: assets that
 * nothing reads when the scene runs or is drawn, levels of detail that no run changes to, tracks that move nothing,
 * settings of generators, figures of accuracy studies and comments. left_out: gets one sentence, translated, for each
 * file and each level (g_free). Free with spore_document_free. NULL with a GError. */
SporeDocument *spore_document_pruned(SporeDocument *document, GPtrArray *left_out, GError **error);

#endif
