/* A 64-bit hash of bytes. */
#include "core/base/hash.h"

#include <string.h>

#define FNV_PRIME UINT64_C(0x100000001b3)

/* Multiplying carries bits upward only; the shift brings the high half of a word back down. */
static inline uint64_t mix(uint64_t hash, uint64_t word) {
  hash = (hash ^ word) * FNV_PRIME;
  return hash ^ (hash >> 32);
}

uint64_t spore_hash(uint64_t seed, const void *bytes, size_t size) {
  const unsigned char *next = bytes;
  uint64_t hash = mix(seed, size), word;
  size_t left = size;
  for (; left >= sizeof word; left -= sizeof word, next += sizeof word) {
    memcpy(&word, next, sizeof word);
    hash = mix(hash, word);
  }
  for (; left > 0; left--, next++) hash = mix(hash, *next);
  return hash;
}
