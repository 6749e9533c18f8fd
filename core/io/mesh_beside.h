/* What a mesh file keeps in files beside it and names there: the materials of OBJ, and pictures of OBJ and glTF. */
#ifndef SPORE_IO_MESH_BESIDE_H
#define SPORE_IO_MESH_BESIDE_H

#include <glib.h>
#include <stdbool.h>

/* A picture that the file names. */
typedef struct SporeMeshPicture {
  char *name;      /* as it stands in the file */
  GBytes *content; /* of its file; NULL: it cannot be read */
  char *reason;    /* then why: "what; remedy", translated */
} SporeMeshPicture;

/* A material of OBJ. */
typedef struct SporeMeshMaterial {
  char *name;
  double colour[3];           /* sRGB, 0 to 1 */
  bool coloured;              /* the file says the colour */
  double opacity;             /* 0 to 1; 0: the file does not say it */
  bool mapped;                /* a picture says it, which is not read */
  guint picture;              /* number in `pictures`, from 1; 0: none */
  double scale[2], offset[2]; /* a place in the picture is that of the mesh (from below) times scale, and offset */
} SporeMeshMaterial;

typedef struct SporeMeshBeside {
  GPtrArray *pictures;  /* of SporeMeshPicture */
  GPtrArray *materials; /* of SporeMeshMaterial */
  char *reason; /* why materials cannot be read: "what; remedy", translated; NULL: they are, or there are none */
  gsize room;   /* bytes that more pictures may have */
  guint worn;   /* number in `pictures` that all of the mesh wears, from 1; 0: what its materials say */
} SporeMeshBeside;

/* Reads what the content of `file` names: regular files in its folder or below (core/io/beside.h), a picture of at most
 * 64 MiB, all together 1 GiB at most. Never NULL. */
SporeMeshBeside *spore_mesh_beside_new(void);
SporeMeshBeside *spore_mesh_beside_read(const char *file, GBytes *content);
void spore_mesh_beside_free(SporeMeshBeside *beside);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeMeshBeside, spore_mesh_beside_free)

/* Lets all of the mesh wear a picture, PNG or JPEG. */
void spore_mesh_beside_wear(SporeMeshBeside *beside, GBytes *picture);

/* For its parts: reads the picture whose file is `path`, once. Its number, from 1; 0: there are too many. */
guint spore_mesh_beside_picture(SporeMeshBeside *beside, const char *file, const char *name, const char *path);
/* The error's message without the file that it begins with. g_free. */
char *spore_mesh_beside_reason(const char *file, const GError *error);
/* Reads the texts of materials that the text of an OBJ names. */
void spore_mesh_beside_materials(SporeMeshBeside *beside, const char *file, const char *text, gsize size);
/* Reads such a text (Wavefront MTL: newmtl, Kd, d or Tr, and map_Kd). folder: that its pictures are named from, "" or
 * with a slash at its end. */
void spore_mesh_beside_describe(SporeMeshBeside *beside, const char *file, const char *folder, const char *text,
                                gsize size);
/* Reads the pictures that the JSON of a glTF names. */
void spore_mesh_beside_images(SporeMeshBeside *beside, const char *file, const char *text, gsize size);

#endif
