/* 64-bit hash of bytes (FNV-1a folded by 8 bytes a round), the same on every machine of one byte order.
 * For state hashes and names by content; not against an adversary. */
#ifndef SPORE_BASE_HASH_H
#define SPORE_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

/* The seed of a hash that follows no other. */
#define SPORE_HASH_INIT UINT64_C(0xcbf29ce484222325)
/* Hash of `size` bytes; the seed is SPORE_HASH_INIT, or the hash of what came before them. */
uint64_t spore_hash(uint64_t seed, const void *bytes, size_t size);

#endif
