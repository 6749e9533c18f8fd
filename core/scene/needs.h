/* What a scene needs of the files that it names. */
#ifndef SPORE_SCENE_NEEDS_H
#define SPORE_SCENE_NEEDS_H

#include "core/scene/document.h"

/* What an asset is for, the strongest of its uses. */
typedef enum SporeAssetUse {
  SPORE_ASSET_UNUSED,    /* nothing names it */
  SPORE_ASSET_SOURCE,    /* another asset is generated from it; a scene that runs does not read it */
  SPORE_ASSET_DRAWN,     /* the visual unit of a body: a run without pictures does not need it */
  SPORE_ASSET_SIMULATED, /* the mechanical or collision unit of a body */
  SPORE_ASSET_USE_COUNT
} SporeAssetUse;
extern const char *const spore_asset_use_names[]; /* "unused", "source", "drawn", "simulated", NULL */

/* An asset and what it is for. */
typedef struct SporeAssetNeed {
  SporeObject *asset; /* of the document */
  SporeAssetUse use;
  gsize bytes; /* of its file; 0: the file cannot be read */
} SporeAssetNeed;

/* One SporeAssetNeed an asset, in the document's order; g_array_unref. */
GArray *spore_document_asset_needs(SporeDocument *document);

/* A file of textures (core/scene/texture.h): a picture, or the places of a mesh in one. It is drawn alone: a run reads
 * none. */
typedef struct SporeTextureNeed {
  const char *file;  /* borrowed until the next change of the document */
  gsize bytes;       /* 0: the file cannot be read */
  GPtrArray *bodies; /* of SporeObject *, that wear it; at least one */
} SporeTextureNeed;

/* One SporeTextureNeed a file, in the order of the bodies; g_array_unref. */
GArray *spore_document_texture_needs(SporeDocument *document);

/* The names of all files that the document's objects name: a set of texts, borrowed until the next change;
 * g_hash_table_unref. */
GHashTable *spore_document_files(const SporeDocument *document);

#endif
