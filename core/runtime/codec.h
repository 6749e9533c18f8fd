/* Writes structures by their tables of rows, and reads them again. */
#ifndef SPORE_RUNTIME_CODEC_H
#define SPORE_RUNTIME_CODEC_H

#include "core/runtime/rows.h"

/* Memory that is freed together. */
typedef struct SporeArena {
  void **blocks;
  size_t count, capacity;
} SporeArena;
/* count x size zeroed bytes; NULL: no memory. */
void *spore_arena_allocate(SporeArena *arena, size_t count, size_t size);
void spore_arena_clear(SporeArena *arena);

/* Where writing or reading is. */
typedef struct SporeCodec {
  bool writing;
  uint8_t *bytes;        /* written so far, from spore_allocate */
  const uint8_t *source; /* to be read */
  size_t at, size;       /* size: of `source`, or what `bytes` has room for */
  SporeModelRegistry registry;
  const size_t *body_count; /* reading: of the world; bodies lie below it */
  SporeArena *arena;        /* reading: what pointers point to */
  SporeError *error;
} SporeCodec;

/* Writes the structure, or reads it over zeroed memory. False with the error. */
bool spore_codec_record(SporeCodec *codec, const SporeRowTable *table, void *structure);

#endif
