/* A run of a generator as data: what goes in, what comes out, where it started from. Any thread; no GTK. */
#ifndef SPORE_AUTHOR_GENERATOR_WORK_H
#define SPORE_AUTHOR_GENERATOR_WORK_H

#include "core/author/generated_edits.h"
#include "core/author/generator.h"
#include "core/author/label_source.h"
#include "core/generate/labels/labels.h"

/* A generator by its place in spore_generators; these are known by name. */
typedef enum SporeGenerateKind {
  SPORE_GENERATE_SPHERES,
  SPORE_GENERATE_TETRAHEDRA,
  SPORE_GENERATE_SURFACE,
  SPORE_GENERATE_CURVE,
  SPORE_GENERATE_LABELS /* of a file instead of a body */
} SporeGenerateKind;

/* Copied as it is: of the fields those that say how to generate count, and none of those is a text. */
typedef struct SporeGenerateOptions {
  SporeGenerateKind kind;
  union {
    SporeSpheresFields spheres;
    SporeTetrahedraFields tetrahedra;
    SporeCurveFields curve;
    SporeMeshFields surface;
    char room[SPORE_GENERATOR_FIELDS];            /* of others */
  } fields;                                       /* of the asset of that kind */
  int purpose;                                    /* what becomes of the result, of the kind's */
  SporeLabelSource *labels;                       /* of LABELS; borrowed */
  guint64 unwanted[SPORE_LABEL_SOURCE_MOST / 64]; /* bits: its labels that are left out */
} SporeGenerateOptions;
/* Whether the i-th label of the options is to be meshed. */
gboolean spore_generate_wants_label(const SporeGenerateOptions *options, gsize i);
void spore_generate_want_label(SporeGenerateOptions *options, gsize i, gboolean wanted);
/* The asset of the body that a generator of this kind makes, or NULL. */
SporeObject *spore_generate_target(SporeDocument *document, SporeObject *body, SporeGenerateKind kind);
/* As spore_edit_generator_source says. */
SporeObject *spore_generate_source(SporeDocument *document, SporeObject *body, SporeGenerateKind kind, GError **error);
/* The usual options of that kind. */
void spore_generate_set_initial(SporeGenerateOptions *options);
/* Those of the asset, else the usual ones. */
SporeGenerateOptions spore_generate_options_of(SporeDocument *document, SporeObject *body, SporeGenerateKind kind);
/* How many to make; nothing where the kind does not ask. */
size_t spore_generate_get_count(const SporeGenerateOptions *options);
/* By number from now on, where it is another number. */
void spore_generate_set_count(SporeGenerateOptions *options, size_t count);

/* What generators share: where they started from, to be compared when they are through. Counted references. */
struct SporeGenerateWork {
  SporeGenerateOptions options;
  guint32 body; /* object id */
  char *source; /* name of the mesh asset */
  char *source_hash;
  gsize region_count, own_region_count; /* own: of the asset; the others are new to it */
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  SporeTriangleMesh mesh;
  SporeSphereSet spheres;                  /* out, or in for measuring */
  SporeSpheresReport spheres_report;       /* out */
  SporeSpheresQuality spheres_quality;     /* out */
  SporeTetrahedralMesh tetrahedra;         /* out */
  SporeTetrahedraReport tetrahedra_report; /* out */
  SporeLabelTetrahedraReport label_report; /* out, with tetrahedra */
  SporeCurve curve;                        /* out */
  SporeCentrelineReport curve_report;      /* out */
  SporeTriangleMesh surface;               /* out: with a wall, all around it */
  SporeSurfaceReport surface_report;       /* out; zero where it was not thinned */
  SporeWallReport wall_report;             /* out; zero without a wall */
  double *surface_distance;                /* out: a vertex of the given mesh, to the outer surface made, m */
};
/* Copies the mesh that it is made from, and the regions of the asset; or holds the label map (body NULL). NULL with an
 * error: there is no mesh, or there are too many regions. */
SporeGenerateWork *spore_generate_work_new(SporeDocument *document, SporeObject *body,
                                           const SporeGenerateOptions *options, GError **error);
gboolean spore_generate_work_run(gpointer work, const SporeProgress *progress, GError **error);
SporeGenerateWork *spore_generate_work_ref(SporeGenerateWork *work);
void spore_generate_work_unref(gpointer work);
/* Whether the document still is what the work began with. */
gboolean spore_generate_work_holds(const SporeGenerateWork *work, SporeDocument *document);
/* The body, where it still has the mesh and the regions that the work began with; NULL: the document moved on. */
SporeObject *spore_generate_work_body(const SporeGenerateWork *work, SporeDocument *document);
/* The result becomes the body's, as one undo step; the options are remembered. */
gboolean spore_generate_work_apply(const SporeGenerateWork *work, SporeDocument *document, GError **error);

/* What the result came from, for the asset to remember. Borrows the work. */
SporeGeneratedFrom spore_generate_work_from(const SporeGenerateWork *work);
/* By number alone, as the error is measured against the number: no other way counts. */
SporeGenerateOptions spore_generate_by_number(const SporeGenerateOptions *options);
/* Whether both ask for the same but for how many. */
gboolean spore_generate_differ_by_number(const SporeGenerateOptions *a, const SporeGenerateOptions *b);

#endif
