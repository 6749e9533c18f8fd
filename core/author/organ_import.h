/* Imports mesh files as bodies of a scene: reads, divides or joins, and repairs them. For `spore import` and the
 * editor. */
#ifndef SPORE_AUTHOR_ORGAN_IMPORT_H
#define SPORE_AUTHOR_ORGAN_IMPORT_H

#include <glib.h>

#include "core/generate/surface/surface.h"
#include "core/scene/document.h"

typedef enum SporeImportDivision {
  SPORE_IMPORT_FILES,  /* a body for each file */
  SPORE_IMPORT_MERGED, /* one body of all files */
  SPORE_IMPORT_PARTS,  /* one for each part that a file names; for each connected piece where it names none */
  SPORE_IMPORT_PIECES  /* one for each connected piece */
} SporeImportDivision;

typedef struct SporeImportOptions {
  int unit; /* index into spore_length_units; -1: guessed of each file, by its size; metres where glTF says so */
  /* Where unit is -1: 1 + index of the unit of files that do not say theirs; 0: it is guessed. */
  guint silent_unit;
  int frame; /* into spore_mesh_frames; -1: what the file says, else Y_UP */
  SporeImportDivision division;
  gboolean lenient; /* a file that cannot be read is left out, and said; where none can, that is an error */
  struct {
    bool wanted;
    double argument;
  } operations[SPORE_MESH_OPERATIONS];
} SporeImportOptions;

/* A file to import. */
typedef struct SporeImportFile {
  char *file;
  GBytes *content;
  int unit, frame;   /* taken */
  int frame_said;    /* by the file itself, or -1 */
  guint parts;       /* that the file names */
  bool joined;       /* the parts were joined without a request for it */
  bool label_map;    /* each label became a body */
  char *undescribed; /* why its materials, which lie beside it, are not read: "what; remedy", translated; or NULL */
  bool overruled;    /* a label map: the given unit or axes were ignored, because its header says them */
} SporeImportFile;

/* A picture and the mesh that wore it in the file, shared by the bodies that were made of the mesh. */
typedef struct SporeImportTexture {
  GBytes *picture; /* PNG; NULL: it cannot be read, and the places are kept for another one */
  SporeTriangleMesh mesh;
  float *places; /* mesh.triangle_count x 3 x 2 */
} SporeImportTexture;

/* A body that will be inserted. */
typedef struct SporeImportBody {
  char *name;
  char *group;                   /* as SporeMeshPart.group; "" for a body of several parts */
  const SporeImportFile *source; /* NULL: several */
  double colour[3];              /* as SporeMeshPart.colour */
  bool coloured;
  double opacity;              /* as SporeMeshPart.opacity */
  SporeImportTexture *texture; /* NULL: none */
  float *places;               /* then of the corners of the mesh's triangles, x 3 x 2 */
  char *untextured, *unclear;  /* as of SporeMeshPart */
  bool changed;                /* its mesh differs from the mesh in the file */
  SporeTriangleMesh mesh;      /* m, SPORE's axes */
  SporeMeshFigures as_read;    /* after division or joining */
  GArray *changes;             /* SporeMeshChange, in the order done */
} SporeImportBody;

typedef struct SporeImport {
  GPtrArray *files;    /* of SporeImportFile * */
  GPtrArray *bodies;   /* of SporeImportBody * */
  GPtrArray *left_out; /* of char *: why a file was left out */
} SporeImport;

/* spore_anatomy_doubt of a body whose mesh is closed. */
char *spore_import_doubt(const SporeImportBody *body);

/* Measured on an organ 150 mm across (300 spheres, 5000 tetrahedra): from 50,000 to a million triangles both fits are
 * as good (spheres .09 % of the diagonal off, tetrahedra .4 %), a fit takes 3.4 to 6.8 s at 100,000, 6 to 9.9 s at
 * 200,000, 10 to 13 s at 400,000 and 23 to 26 s at a million. A million triangles decimated to 100,000 move by .04 % of
 * the diagonal, less than either fit. */
#define SPORE_IMPORT_TRIANGLES_MANY 250000u
#define SPORE_IMPORT_TRIANGLES_ENOUGH 100000u

/* That the body has more triangles than SPORE_IMPORT_TRIANGLES_MANY, and why SPORE_IMPORT_TRIANGLES_ENOUGH do: NULL, or
 * "what; remedy", translated. g_free. */
char *spore_import_burden(const SporeImportBody *body);

#define SPORE_IMPORT_BODIES_MAXIMUM 500u

/* Reads files. files: NULL-terminated paths of regular files, meshes or label maps. Each label of a map becomes a body
 * (its surface, smoothed at the same volume). NULL with an error; cancelled by progress. Any thread. */
SporeImport *spore_import_read(char *const *files, const SporeImportOptions *options, const SporeProgress *progress,
                               GError **error);
/* Content of a regular file of at most 1 GiB; NULL with an error. */
GBytes *spore_import_read_content(const char *file, GError **error);
void spore_import_free(SporeImport *import);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeImport, spore_import_free)

/* Inserts a mesh asset and a body that shows it for each body of the import. An unchanged mesh keeps the file's own
 * content, unit and frame; a changed mesh becomes OFF in metres and SPORE's axes, named by its content. Beside it lie
 * its picture and the places of its corners in the picture, where it has one. The caller opens the group that makes one
 * undo step: on FALSE objects inserted before the failure stay. *bodies (may be NULL): the objects, GPtrArray. */
gboolean spore_import_insert(SporeDocument *document, const SporeImport *import, GPtrArray **bodies, GError **error);

/* A remark about a file that the checks of the scene do not make: NULL, or "what; remedy", translated. g_free. */
char *spore_import_remark(const SporeImportFile *file);

#endif
