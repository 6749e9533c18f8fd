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
  uint32_t textured;       /* its material has a picture; the colour is what the picture is multiplied by */
  uint32_t picture;        /* number of the picture from 1, the same for all its triangles; 0: none that can be used */
  char name[64];           /* name of its node or mesh, cut to fit; empty: it has none */
  char group[192];         /* names of the nodes that it lies in, outermost first, between slashes; may be empty */
} SporeImportPart;

/* Pictures of an answer at most, and bytes of each. */
#define SPORE_IMPORT_PICTURES_MAXIMUM 500
#define SPORE_IMPORT_PICTURE_BYTES (UINT64_C(64) << 20)

/* part_count SporeImportPart, vertex_count x 3 doubles and triangle_count x 3 uint32_t follow. Where there are
 * pictures: of each corner of each triangle its place in the picture, 2 floats from the upper left corner; then the
 * size of each picture in bytes, uint64_t; then the pictures. */
typedef struct SporeImportAnswer {
  uint64_t part_count, vertex_count, triangle_count;
  uint64_t passed_over; /* points and lines */
  uint64_t picture_count;
} SporeImportAnswer;

#endif
