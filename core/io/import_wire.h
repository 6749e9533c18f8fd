/* What SPORE and its import helper say to each other. Native byte order: both run on the same machine. */
#ifndef SPORE_IO_IMPORT_WIRE_H
#define SPORE_IO_IMPORT_WIRE_H

#include <stdint.h>

/* Corners of a face at most. Cutting a face into triangles takes work by the square of its corners. */
#define SPORE_FACE_CORNERS_MAXIMUM 10000

/* The file's bytes follow. */
typedef struct SporeImportRequest {
  uint64_t format; /* SporeMeshFormat, never OFF */
} SporeImportRequest;

/* A sub-mesh: its number of triangles. The triangles of the parts follow each other. */
typedef struct SporeImportPart {
  uint64_t triangle_count; /* > 0 */
  float colour[3];         /* the base colour of its material, sRGB from 0 to 1; used where coloured */
  uint32_t coloured;       /* the file says the colour */
  char name[64];           /* name of its node or mesh, cut to fit; empty: it has none */
  char group[192];         /* names of the nodes that it lies in, outermost first, between slashes; may be empty */
} SporeImportPart;

/* part_count SporeImportPart, vertex_count x 3 doubles and triangle_count x 3 uint32_t follow. */
typedef struct SporeImportAnswer {
  uint64_t part_count, vertex_count, triangle_count;
  uint64_t passed_over; /* points and lines */
} SporeImportAnswer;

#endif
