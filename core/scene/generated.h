/* Generated data (spheres, tetrahedra, curves, surfaces): an asset remembers how its data were made. When source or
 * options change, the data become stale. Stale data are kept until somebody generates them again. */
#ifndef SPORE_SCENE_GENERATED_H
#define SPORE_SCENE_GENERATED_H

#include "core/scene/document.h"

typedef enum SporeGenerated {
  SPORE_GENERATED_NOT, /* made elsewhere, or by hand */
  SPORE_GENERATED_FRESH,
  SPORE_GENERATED_SOURCE_CHANGED, /* the content of its source has changed since */
  SPORE_GENERATED_OPTIONS_CHANGED /* the options of the asset have changed since */
} SporeGenerated;

/* Data without a hash of their options count as made with the present options. */
SporeGenerated spore_generated_state(SporeDocument *document, SporeObject *asset);
/* Hash of the options, of the asset and of its regions, that differ from their defaults: 16 hex digits, what
 * options_hash holds. g_free. */
char *spore_generated_options_hash(const SporeObject *asset);
/* Whether a parameter of a generated asset is an option of its generator. */
gboolean spore_generated_is_option(const SporeParameter *parameter);
/* Whether the asset has the remark, "frozen" or "edited". FALSE for elements without remarks. */
gboolean spore_generated_is(const SporeObject *asset, const char *remark);
/* FALSE with a message and its remedy where the asset is frozen. */
gboolean spore_generated_may_change(const SporeObject *asset, GError **error);

#endif
