/* What the inspector says of a mesh and of what generators made, in words. */
#ifndef SPORE_UI_PANELS_ASSET_FACTS_H
#define SPORE_UI_PANELS_ASSET_FACTS_H

#include "ui/jobs/works.h"

/* NULL: there is no memory to look. g_free. */
char *spore_mesh_facts(const SporeTriangleMesh *mesh);
/* Of the asset that a body has of a kind; asset NULL: what it has instead. A line each; g_free. */
char *spore_asset_facts(SporeDocument *document, const SporeObject *body, SporeObject *asset, SporeGenerateKind kind);
/* How good spheres are; all zero: that could not be measured, and nothing is said. NULL: it is being measured. g_free.
 */
char *spore_spheres_facts(const SporeSpheresReport *report);
/* What became of the asset since it was generated: stale, edited, frozen; a line each, or "". g_free. */
char *spore_asset_remarks(SporeDocument *document, SporeObject *asset);

#endif
