/* Puts results of generators into the scene, each as one undo step. No GTK. */
#ifndef SPORE_AUTHOR_GENERATED_EDITS_H
#define SPORE_AUTHOR_GENERATED_EDITS_H

#include "core/author/generator.h"
#include "core/author/centreline_body.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* Where generated data come from. */
typedef struct SporeGeneratedFrom {
  const char *source, *source_hash;   /* name of the mesh asset, and its hash then */
  const void *fields;                 /* fields of the asset's table: the options among them are stored */
  const SporeGenerateRegion *regions; /* region_count regions, which are added to the asset's own */
  gsize region_count;
} SporeGeneratedFrom;

/* Sphere, tetrahedra or curve asset in use by the body, or NULL. */
SporeObject *spore_edit_body_spheres(SporeDocument *document, SporeObject *body);
SporeObject *spore_edit_body_tetrahedra(SporeDocument *document, SporeObject *body);
/* Its tetrahedra; NULL: it has none, or they cannot be read. Borrowed from the document. */
const SporeTetrahedralMesh *spore_edit_body_cells(SporeDocument *document, SporeObject *body);
/* The curve that the body is made of, else a curve that was generated from the mesh it shows. */
SporeObject *spore_edit_body_curve(SporeDocument *document, SporeObject *body);
/* The patch with corners that the body is made of. */
SporeObject *spore_edit_body_sheet(SporeDocument *document, SporeObject *body);
/* A generated mesh that the body is made of or shows, else a mesh that was generated from the mesh it shows; no patch
 * with corners. */
SporeObject *spore_edit_body_surface(SporeDocument *document, SporeObject *body);

/* The result becomes an asset of the body and replaces its earlier generated asset. With tetrahedra or a surface, a
 * body without a model gets the usual model for them. */
gboolean spore_edit_use_spheres(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeSphereSet *set, GError **error);
gboolean spore_edit_use_tetrahedra(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                   const SporeTetrahedralMesh *mesh, GError **error);
/* options NULL: only the asset is made. Else the body becomes a thread, tube or intestine along the curve, with the
 * links that hold it. */
gboolean spore_edit_use_curve(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                              const SporeCurve *curve, const SporeCentrelineBodyOptions *options, GError **error);
typedef enum SporeSurfaceUse { SPORE_SURFACE_MODEL, SPORE_SURFACE_SHOWN, SPORE_SURFACE_ASSET } SporeSurfaceUse;
gboolean spore_edit_use_surface(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeTriangleMesh *mesh, SporeSurfaceUse use, GError **error);
/* The patch of a sheet, and where it is used: by a new body beside the organ, or by the organ's body. A body that is
 * such a sheet already gets the new patch in any case but the last. The report's corners have to be among the fields.
 */
typedef enum SporeSheetUse { SPORE_SHEET_BODY, SPORE_SHEET_MODEL, SPORE_SHEET_ASSET } SporeSheetUse;
gboolean spore_edit_use_sheet(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                              const SporeTriangleMesh *patch, const SporeSheetReport *report, SporeSheetUse use,
                              GError **error);

/* Stores in the asset its source and its options. Its file must be set before. FALSE with an error: the asset is
 * frozen. */
gboolean spore_edit_remember_source(SporeDocument *document, SporeObject *asset, const SporeGeneratedFrom *from,
                                    GError **error);

/* Tetrahedra of several organs. */
typedef enum SporeLabelUse {
  SPORE_LABELS_LINKED, /* bodies, with a seam between each two that share faces */
  SPORE_LABELS_BODIES,
  SPORE_LABELS_ONE_BODY,
  SPORE_LABELS_ASSET
} SporeLabelUse;
typedef struct SporeLabelBodies {
  const char *file; /* label map file that they came from: its name is given to what all organs share */
  GBytes *content;  /* content of that file. The scene keeps the file, to notice when it changes; NULL: the scene does
                       not keep it */
  const SporeTetrahedraFields *fields; /* how they were made; NULL: not known */
  const SporeTetrahedralMesh *mesh;
  const guint32 *labels; /* count, each of which some cell has */
  char *const *names;    /* count */
  gsize count;
  SporeLabelUse use;
  const gboolean *guessed; /* count: whether the name is a guess; NULL: none is */
} SporeLabelBodies;
/* Makes new assets, and bodies with their usual model that show the tetrahedra's own surface. Where the scene has the
 * same label map already, new tetrahedra replace earlier ones of the same name from that map, and their bodies stay. */
gboolean spore_edit_use_labels(SporeDocument *document, const SporeLabelBodies *organs, GError **error);

/* The label map from which the tetrahedra of a body without a drawn mesh were generated; NULL: there is none. */
SporeObject *spore_edit_body_label_map(SporeDocument *document, SporeObject *body);

#endif
