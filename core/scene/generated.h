/* Generated data (spheres, tetrahedra, curves, surfaces): what an asset remembers of how it was made. Nothing is thrown
 * away when that is no longer so: the data are stale, and stay until somebody generates them anew. */
#ifndef SPORE_SCENE_GENERATED_H
#define SPORE_SCENE_GENERATED_H

#include "core/scene/document.h"

typedef enum SporeGenerated {
  SPORE_GENERATED_NOT, /* made elsewhere, or by hand */
  SPORE_GENERATED_FRESH,
  SPORE_GENERATED_SOURCE_CHANGED, /* what it was made from has other content now */
  SPORE_GENERATED_OPTIONS_CHANGED /* made with other options than the asset has now */
} SporeGenerated;

/* Data that remember no hash of their options are held to be made with those they have. */
SporeGenerated spore_generated_state(SporeDocument *document, SporeObject *asset);
/* Of all parameters, the asset's and those of its regions, that are no default and say how to generate: 16 hex digits,
 * what options_hash holds. g_free. */
char *spore_generated_options_hash(const SporeObject *asset);
/* Whether a parameter of an asset says how to generate it. */
gboolean spore_generated_is_option(const SporeParameter *parameter);
/* remark: "frozen" or "edited". FALSE too for elements that have none. */
gboolean spore_generated_is(const SporeObject *asset, const char *remark);
/* FALSE with a message and its remedy where the asset is frozen. */
gboolean spore_generated_may_change(const SporeObject *asset, GError **error);

#endif
