/* What a run of a scene depends on, as one number. */
#ifndef SPORE_SCENE_RUN_HASH_H
#define SPORE_SCENE_RUN_HASH_H

#include "core/scene/document.h"

/* Hash of everything that a run of the scene, and what a step costs, follows from: the values in force of solver,
 * environment, bodies, links, effects, tools and devices, with their names, a body's integrator and
 * substeps as they come out, and the content of the assets and of the
 * tracks that they refer to. What is shown alone is not in it: metadata, units, cameras, what bodies look like,
 * comments, and how an asset was generated. An asset that cannot be read counts by its name. Reads the files that the
 * document has not decoded yet. */
guint64 spore_document_run_hash(SporeDocument *document);
/* The same without which bodies are physical and which are effects, and what was advised on that: what advice is found
 * for. */
guint64 spore_document_advice_hash(SporeDocument *document);

#endif
