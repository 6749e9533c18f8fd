/* What the inspector says in words of a mesh and of generated assets. */
#ifndef SPORE_UI_PANELS_ASSET_FACTS_H
#define SPORE_UI_PANELS_ASSET_FACTS_H

#include "ui/jobs/works.h"

/* NULL: there is no memory to look. g_free. */
char *spore_mesh_facts(const SporeTriangleMesh *mesh);
/* Facts of the asset of a kind that a body has, a line each; asset NULL: what the body has instead. g_free. */
char *spore_asset_facts(SporeDocument *document, const SporeObject *body, SporeObject *asset, SporeGenerateKind kind);
/* The quality of spheres in words. All zero: not measured, and the text is empty. NULL: being measured. g_free. */
char *spore_spheres_facts(const SporeSpheresReport *report);
/* The state of the asset since it was generated: stale, edited, frozen; a line each, or "". g_free. */
char *spore_asset_remarks(SporeDocument *document, SporeObject *asset);

#endif
