/* What SPORE and its import helper say to each other. Native byte order: both run on the same machine. */
#ifndef SPORE_IO_IMPORT_WIRE_H
#define SPORE_IO_IMPORT_WIRE_H

#include <stdint.h>

/* Corners of a face at most. Cutting a face into triangles takes work by the square of its corners. */
#define SPORE_FACE_CORNERS_MAXIMUM 10000

/* How much of the look is wanted. */
enum {
  SPORE_IMPORT_SHAPE,   /* no pictures */
  SPORE_IMPORT_APART,   /* each part wears one picture */
  SPORE_IMPORT_TOGETHER /* all parts wear one picture together */
};

/* material_count SporeImportMaterial, picture_count SporeImportPicture, the file's bytes, and the bytes of each picture
 * follow. */
typedef struct SporeImportRequest {
  uint64_t format; /* SporeMeshFormat, never OFF */
  uint64_t size;   /* of the file */
  uint64_t material_count, picture_count;
  uint64_t look; /* SPORE_IMPORT_SHAPE ... */
  uint64_t worn; /* number from 1 of the picture that all of it wears, whatever its materials say; 0: as they say */
} SporeImportRequest;

/* A material of OBJ, which is described in a file beside the mesh. */
typedef struct SporeImportMaterial {
  float colour[3];           /* sRGB from 0 to 1; used where coloured */
  uint32_t coloured;         /* the file says the colour */
  float opacity;             /* 0 to 1; 0: the file does not say it */
  uint32_t mapped;           /* a picture says it, which is not read */
  uint32_t picture;          /* number of the picture from 1; 0: it wears none */
  float scale[2], offset[2]; /* a place in the picture is that of the mesh (from below) times scale, and offset */
  char name[128];            /* cut to fit */
} SporeImportMaterial;

/* A picture in a file beside the mesh. */
typedef struct SporeImportPicture {
  uint64_t size;  /* 0: it cannot be read */
  char name[256]; /* as a glTF says it, cut to fit */
} SporeImportPicture;

/* What a part wears. */
enum {
  SPORE_IMPORT_BARE,
  SPORE_IMPORT_WORN,     /* one picture, or one made of its pictures and colours */
  SPORE_IMPORT_SMALLER,  /* one made of its pictures, some of which were halved to fit */
  SPORE_IMPORT_PARTLY,   /* one made of its pictures, without some that are not there */
  SPORE_IMPORT_MIXED,    /* more than one picture can be made of */
  SPORE_IMPORT_UNPLACED, /* a picture that its corners have no places in */
  SPORE_IMPORT_UNKNOWN   /* a picture that is not there, or too large */
};

/* What of its opacity a part does not show, as bits. */
enum {
  SPORE_IMPORT_OPACITIES = 1,
  /* its materials differ in it */ SPORE_IMPORT_OPACITY_MAP = 2 /* a picture says it */
};

/* A sub-mesh: its number of triangles. The triangles of the parts follow each other. */
typedef struct SporeImportPart {
  uint64_t triangle_count; /* > 0 */
  float colour[3];         /* the base colour of its material, sRGB from 0 to 1; used where coloured */
  uint32_t coloured;       /* the file says the colour */
  float opacity;           /* 0 to 1 */
  uint32_t unclear;        /* SPORE_IMPORT_OPACITIES, SPORE_IMPORT_OPACITY_MAP */
  uint32_t dress;          /* SPORE_IMPORT_BARE ...; the colour is what the picture is multiplied by */
  uint32_t picture;        /* number of the picture from 1 where it is worn, else 0 */
  uint32_t missing;        /* number from 1 of a picture of the request that is not part of it; 0: none */
  char name[64];           /* name of its node or mesh, cut to fit; empty: it has none */
  char group[192];         /* names of the nodes that it lies in, outermost first, between slashes; may be empty */
} SporeImportPart;

/* A picture of the answer. */
typedef struct SporeImportTaken {
  uint64_t size;   /* of its bytes */
  uint64_t beside; /* number from 1 of the picture of the request; 0: it is in the file itself, or made of several */
} SporeImportTaken;

/* Pictures of an answer at most, and bytes of each. */
#define SPORE_IMPORT_PICTURES_MAXIMUM 500
#define SPORE_IMPORT_PICTURE_BYTES (UINT64_C(64) << 20)

/* part_count SporeImportPart, vertex_count x 3 doubles and triangle_count x 3 uint32_t follow. Where there are
 * pictures: of each corner of each triangle its place in the picture, 2 floats from the upper left corner; then a
 * SporeImportTaken for each picture; then the pictures. */
typedef struct SporeImportAnswer {
  uint64_t part_count, vertex_count, triangle_count;
  uint64_t passed_over; /* points and lines */
  uint64_t picture_count;
} SporeImportAnswer;

#endif
