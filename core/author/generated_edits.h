/* What generators made, taken into the scene: each one undo step. No GTK. */
#ifndef SPORE_AUTHOR_GENERATED_EDITS_H
#define SPORE_AUTHOR_GENERATED_EDITS_H

#include "core/author/generator.h"
#include "core/author/centreline_body.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* Where generated data come from. */
typedef struct SporeGeneratedFrom {
  const char *source, *source_hash;   /* name of the mesh asset, and its hash then */
  const void *fields;                 /* of the asset's table: those that say how to generate are remembered */
  const SporeGenerateRegion *regions; /* region_count, which become the asset's besides those that it has */
  gsize region_count;
} SporeGeneratedFrom;

/* Sphere, tetrahedra or curve asset in use by the body, or NULL. */
SporeObject *spore_edit_body_spheres(SporeDocument *document, SporeObject *body);
SporeObject *spore_edit_body_tetrahedra(SporeDocument *document, SporeObject *body);
/* The curve that the body is made of, else one that was made of the mesh it shows. */
SporeObject *spore_edit_body_curve(SporeDocument *document, SporeObject *body);
/* A generated mesh that the body is made of or shows, else one that was made of the mesh it shows. */
SporeObject *spore_edit_body_surface(SporeDocument *document, SporeObject *body);

/* What was generated becomes an asset of the body (its earlier generated one is replaced). With tetrahedra, a body that
 * has no model yet gets the usual one for them; with a surface, too. */
gboolean spore_edit_use_spheres(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeSphereSet *set, GError **error);
gboolean spore_edit_use_tetrahedra(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                   const SporeTetrahedralMesh *mesh, GError **error);
/* options NULL: the asset alone; else the body becomes a thread, tube or intestine along it, with what holds it. */
gboolean spore_edit_use_curve(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                              const SporeCurve *curve, const SporeCentrelineBodyOptions *options, GError **error);
typedef enum SporeSurfaceUse { SPORE_SURFACE_MODEL, SPORE_SURFACE_SHOWN, SPORE_SURFACE_ASSET } SporeSurfaceUse;
gboolean spore_edit_use_surface(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeTriangleMesh *mesh, SporeSurfaceUse use, GError **error);

/* The asset remembers what it was made from, and how; its file is set before. FALSE with an error: it is frozen. */
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
  const char *file; /* they came from: names what is of all */
  GBytes *content;  /* of that file, which the scene keeps, to tell when it changes; NULL: it does not */
  const SporeTetrahedraFields *fields; /* how they were made; NULL: not known */
  const SporeTetrahedralMesh *mesh;
  const guint32 *labels; /* count, each of which some cell has */
  char *const *names;    /* count */
  gsize count;
  SporeLabelUse use;
} SporeLabelBodies;
/* New assets, and bodies with their usual model, which show the tetrahedra's own surface; where the scene has the same
 * label map, tetrahedra of the same name that came from it become the new ones, and their bodies stay. */
gboolean spore_edit_use_labels(SporeDocument *document, const SporeLabelBodies *organs, GError **error);

/* The label map that the tetrahedra of a body came from which shows no mesh; NULL: it is not so. */
SporeObject *spore_edit_body_label_map(SporeDocument *document, SporeObject *body);

#endif
