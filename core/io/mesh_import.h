/* Import of meshes from untrusted files, and text formats of spheres, curves and tetrahedra. */
#ifndef SPORE_IO_MESH_IMPORT_H
#define SPORE_IO_MESH_IMPORT_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/io/mesh_beside.h"
#include "core/mesh/mesh.h"
#include "core/scene/error.h"
#include "core/scene/length_unit.h"

/* Units (core/scene/length_unit.h) and frames by index, as in the file; NULL-terminated. Frame says what the file's
 * axes are: RAS and LPS are the patient frames of medical images, Y_UP that of most modelling programs. SPORE's axes
 * are x right, y up, z toward the user: Y_UP is the identity; RAS (x, y, z) -> (x, z, -y); LPS (x, y, z) -> (-x, z, y).
 */
extern const char *const spore_mesh_frames[]; /* Y_UP RAS LPS */

/* Decodes STL, OBJ, PLY, OFF, glTF (embedded), GLB or a surface of VTK. The content decides on the format; the
 * extension of `file` only decides where the content does not. OFF is read here. A helper process reads the other
 * formats; the process can open no file, reach no network and exceed no time limit. All sub-meshes are joined with
 * their node transforms applied. The mesh is then validated, welded (1e-6), turned outward, and unit and frame are
 * applied. place (usually the path) begins every message. `progress` can cancel. */
gboolean spore_mesh_decode(const char *place, const char *file, const void *content, gsize size, int unit, int frame,
                           SporeTriangleMesh *mesh, const SporeProgress *progress, GError **error);

/* The same, and of each triangle the part of the file that it came from. *parts: triangle_count numbers, spore_free;
 * *names: of each part, "" where it has none, g_strfreev. Both NULL where the file has no parts; a place
 * for them may be NULL. Of triangles that two parts have alike, the first part has the one that is kept. */
gboolean spore_mesh_decode_tagged(const char *place, const char *file, const void *content, gsize size, int unit,
                                  int frame, SporeTriangleMesh *mesh, guint32 **parts, char ***names,
                                  const SporeProgress *progress, GError **error);

/* The content with the buffers that a glTF text names put into it: regular files in the same folder, of at most 1 GiB
 * together. Other content is returned as it is. g_bytes_unref; NULL with an error. */
GBytes *spore_mesh_whole(const char *file, GBytes *content, GError **error);

/* A sub-mesh of a file: the meshes of one node of glTF or of one object of OBJ. */
typedef struct SporeMeshPart {
  char *name;       /* "": it has none */
  char *group;      /* names of the nodes that it lies in, outermost first, between slashes; "": there are none */
  double colour[3]; /* base colour of its material, sRGB from 0 to 1; of joined parts: of the largest */
  bool coloured;    /* the file says the colour */
  double opacity;   /* of its material, more than 0, to 1; of several materials, of most of it */
  SporeTriangleMesh mesh;
  GBytes *picture;  /* PNG that all of it wears (core/scene/texture.h), made of its pictures and colours where it has
                       several materials; NULL: none */
  float *places;    /* of the corners of the mesh's triangles in the picture, also in one that cannot be read, x 3 x 2;
                       spore_free; NULL: it wears none */
  char *untextured; /* what of its pictures is not taken as the file brings it, and why: "what; remedy", translated;
                       NULL: nothing */
  char *unclear;    /* what of its opacity is not taken, and what to do, as `untextured` */
} SporeMeshPart;
void spore_mesh_part_free(SporeMeshPart *part);
#define SPORE_MESH_PARTS_MAXIMUM 500u

/* As spore_mesh_decode; `apart` keeps the parts that the file names separate, else they are joined into one. beside:
 * what lies beside the file (core/io/mesh_beside.h), or NULL. *count: number of parts in the file, 1 where its format
 * has none. GPtrArray of SporeMeshPart *, at least one; NULL with an error. */
GPtrArray *spore_mesh_decode_parts(const char *file, const void *content, gsize size, const SporeMeshBeside *beside,
                                   int unit, int frame, gboolean apart, guint *count, const SporeProgress *progress,
                                   GError **error);

/* Validates, welds (1e-6) and turns outward a mesh that was put together after decoding, as each decoded mesh is. */
gboolean spore_mesh_tidy(const char *place, SporeTriangleMesh *mesh, GError **error);

/* The frame that the file itself names (3D Slicer writes SPACE=LPS or RAS into headers and comments): index, or -1. */
int spore_mesh_frame_hint(const void *content, gsize size);

/* Text formats, in memory; messages name the line. Sphere sets and curves: "x y z r" a line, metres, # comments.
 * Tetrahedra: Medit .mesh (ASCII). */
gboolean spore_spheres_parse(const char *place, const char *text, gsize size, SporeSphereSet *set, GError **error);
char *spore_spheres_format(const SporeSphereSet *set, gsize *size); /* g_free */
gboolean spore_curve_parse(const char *place, const char *text, gsize size, SporeCurve *curve, GError **error);
char *spore_curve_format(const SporeCurve *curve, gsize *size); /* g_free */
gboolean spore_medit_parse(const char *place, const char *text, gsize size, SporeTetrahedralMesh *mesh, GError **error);
char *spore_medit_format(const SporeTetrahedralMesh *mesh, gsize *size); /* g_free */
char *spore_gmsh_format(const SporeTetrahedralMesh *mesh, gsize *size);  /* .msh 2.2 ASCII */
char *spore_vtu_format(const SporeTetrahedralMesh *mesh, gsize *size);   /* VTK unstructured grid, ASCII */
char *spore_off_format(const SporeTriangleMesh *mesh, gsize *size);
char *spore_obj_format(const SporeTriangleMesh *mesh, gsize *size);

#endif
