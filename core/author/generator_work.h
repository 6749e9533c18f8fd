/* A run of a generator as data: input, result, and the state of the document at its start. May be used on any thread;
 * no GTK. */
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
  SPORE_GENERATE_LABELS, /* of a file instead of a body */
  SPORE_GENERATE_SHEET
} SporeGenerateKind;

/* A plain value that may be copied: only the options among the fields count, and no option is a text. */
typedef struct SporeGenerateOptions {
  SporeGenerateKind kind;
  union {
    SporeSpheresFields spheres;
    SporeTetrahedraFields tetrahedra;
    SporeCurveFields curve;
    SporeMeshFields surface;           /* of a sheet too */
    char room[SPORE_GENERATOR_FIELDS]; /* of others */
  } fields;                            /* of the asset of that kind */
  int purpose;                         /* what becomes of the result, of the kind's */
  SporeLabelSource *labels;            /* of LABELS; borrowed */
  /* Bits: its labels that are not meshed, and those of them that become surfaces around the others. */
  guint64 unwanted[SPORE_LABEL_SOURCE_MOST / 64], around[SPORE_LABEL_SOURCE_MOST / 64];
  gboolean listing; /* of LABELS: the map is read alone, and nothing is made yet */
  gboolean chosen;  /* of LABELS: what becomes of the labels was proposed, or said */
} SporeGenerateOptions;
/* The asset of the body that a generator of this kind makes, or NULL. */
SporeObject *spore_generate_target(SporeDocument *document, SporeObject *body, SporeGenerateKind kind);
/* As spore_edit_generator_source says. */
SporeObject *spore_generate_source(SporeDocument *document, SporeObject *body, SporeGenerateKind kind, GError **error);
/* The usual options of that kind. */
void spore_generate_set_initial(SporeGenerateOptions *options);
/* The options of the asset, else the usual options. */
SporeGenerateOptions spore_generate_options_of(SporeDocument *document, SporeObject *body, SporeGenerateKind kind);
/* The number to make; 0 where this kind of generator has no number. */
size_t spore_generate_get_count(const SporeGenerateOptions *options);
/* Sets the number, and chooses the way "by number", where the number differs from the present one. */
void spore_generate_set_count(SporeGenerateOptions *options, size_t count);
/* How many places on the organ the options have; 0: this kind of generator has none. */
guint spore_generate_place_count(const SporeGenerateOptions *options);
/* places: that many, m. FALSE: they are all the same, which is "none given". */
gboolean spore_generate_get_places(const SporeGenerateOptions *options, double places[SPORE_GENERATOR_PLACES][3]);
/* places NULL: none given. */
void spore_generate_set_places(SporeGenerateOptions *options, double places[SPORE_GENERATOR_PLACES][3]);

/* What all generators share: the state they started from, for comparison when they have finished. References are
 * counted. */
struct SporeGenerateWork {
  SporeGenerateOptions options;
  guint32 body; /* object id */
  char *source; /* name of the mesh asset */
  char *source_hash;
  gsize region_count, own_region_count; /* balls; own: of the asset; the others are new to it */
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  SporeTriangleMesh mesh;
  SporeTetrahedralMesh cells;              /* of the organ, for spheres; empty: it has none */
  SporeSphereSet spheres;                  /* out, or in for measuring */
  SporeSpheresReport spheres_report;       /* out */
  SporeSpheresQuality spheres_quality;     /* out */
  SporeSpheresReport other_report;         /* out: of spheres made the other way, with cells */
  size_t other_count;                      /* of them; 0: they were not made */
  SporeTetrahedralMesh tetrahedra;         /* out */
  SporeTetrahedraReport tetrahedra_report; /* out */
  SporeLabelTetrahedraReport label_report; /* out, with tetrahedra */
  GArray *surroundings;                    /* out, of LABELS: of SporeLabelSurrounding; NULL: none */
  SporeCurve curve;                        /* out */
  SporeCentrelineReport curve_report;      /* out */
  SporeCurve root;                         /* out: of the mesentery of an intestine along the curve; empty: none */
  SporeCentrelineRoot root_report;         /* out, with root */
  double *curve_way;                       /* out: a vertex of the given mesh, to the line through the inside, m */
  SporeTriangleMesh surface;               /* out: with a wall, all around it; of a sheet, its patch */
  SporeSurfaceReport surface_report;       /* out; zero where it was not thinned */
  SporeWallReport wall_report;             /* out; zero without a wall */
  SporeSheetReport sheet_report;           /* out, with the patch */
  double *surface_distance;                /* out: a vertex of the given mesh, to the outer surface made; of a sheet, a
                                              vertex of the patch, to the sheet; m */
};
/* Copies the source mesh and the regions of the asset, or keeps a reference to the label map (body NULL). NULL with an
 * error: there is no mesh, or there are too many regions. */
SporeGenerateWork *spore_generate_work_new(SporeDocument *document, SporeObject *body,
                                           const SporeGenerateOptions *options, GError **error);
gboolean spore_generate_work_run(gpointer work, const SporeProgress *progress, GError **error);
SporeGenerateWork *spore_generate_work_ref(SporeGenerateWork *work);
void spore_generate_work_unref(gpointer work);
/* Whether source and regions in the document are still those that the work began with. */
gboolean spore_generate_work_holds(const SporeGenerateWork *work, SporeDocument *document);
/* The body, where it still has the mesh and the regions that the work began with; NULL: they have changed. */
SporeObject *spore_generate_work_body(const SporeGenerateWork *work, SporeDocument *document);
/* Puts the result into the document, as one undo step, and stores the options. */
gboolean spore_generate_work_apply(const SporeGenerateWork *work, SporeDocument *document, GError **error);

/* Source and options of the result, which the asset remembers. Borrows from the work. */
SporeGeneratedFrom spore_generate_work_from(const SporeGenerateWork *work);
/* The options with the number as the only way, since the error is measured against the number. */
SporeGenerateOptions spore_generate_by_number(const SporeGenerateOptions *options);
/* Whether both options are the same but for the number. */
gboolean spore_generate_differ_by_number(const SporeGenerateOptions *a, const SporeGenerateOptions *b);

#endif
