/* Textures of the stage's bodies. Each picture is decoded once for all bodies that wear it. */
#include "core/scene/texture.h"
#include "ui/render/stage_body.h"

typedef struct SporeStageTexture {
  guint handle;  /* of the renderer; 0: it cannot be drawn, which was said */
  gboolean worn; /* by a body, since textures were dropped last */
} SporeStageTexture;

GHashTable *spore_stage_textures_new(void) { return g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free); }

void spore_stage_drop_textures(SporeStage *stage) {
  GHashTableIter iterator;
  gpointer value;
  g_hash_table_iter_init(&iterator, stage->textures);
  while (g_hash_table_iter_next(&iterator, NULL, &value)) {
    SporeStageTexture *texture = value;
    if (!texture->worn) {
      if (texture->handle) spore_renderer_remove_texture(stage->renderer, texture->handle);
      g_hash_table_iter_remove(&iterator);
    } else {
      texture->worn = FALSE;
    }
  }
}

static guint find_texture(SporeStage *stage, const char *place, GBytes *picture) {
  g_autofree char *sum = g_compute_checksum_for_bytes(G_CHECKSUM_SHA256, picture);
  SporeStageTexture *texture = g_hash_table_lookup(stage->textures, sum);
  if (!texture) {
    g_autoptr(GError) error = NULL;
    texture = g_new0(SporeStageTexture, 1);
    texture->handle = spore_renderer_add_texture(stage->renderer, place, picture, &error);
    if (error) g_message("%s", error->message);
    g_hash_table_insert(stage->textures, g_steal_pointer(&sum), texture);
  }
  texture->worn = TRUE;
  return texture->handle;
}

void spore_stage_body_find_texture(SporeStage *stage, SporeStageBody *body, const SporeObject *visual) {
  SporeTexture texture;
  if (!spore_texture_read(stage->document, visual, &texture, NULL)) return; /* check says why */
  body->texture = find_texture(stage, spore_object_text(visual, "texture"), texture.picture);
  if (body->texture) body->places = g_steal_pointer(&texture.places);
  spore_texture_clear(&texture);
}

void spore_stage_body_lay_texture(SporeStage *stage, SporeStageBody *body, const double *vertices,
                                  const float *places) {
  if (body->texture && places)
    spore_renderer_lay_texture(stage->renderer, body->surface_handle, vertices, body->texture, places);
}
