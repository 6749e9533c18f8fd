/* What SPORE and its import helper say to each other. Native byte order: both run on the same machine. */
#ifndef SPORE_IO_IMPORT_WIRE_H
#define SPORE_IO_IMPORT_WIRE_H

#include <stdint.h>

/* The file's bytes follow. */
typedef struct SporeImportRequest {
  uint64_t format; /* SporeMeshFormat, never OFF */
} SporeImportRequest;

/* vertex_count x 3 doubles and triangle_count x 3 uint32_t follow. */
typedef struct SporeImportAnswer {
  uint64_t vertex_count, triangle_count;
  uint64_t passed_over; /* points and lines */
} SporeImportAnswer;

#endif
