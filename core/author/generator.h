/* Generators: each has the asset that it makes, the table of its options, and the functions that run it. */
#ifndef SPORE_AUTHOR_GENERATOR_H
#define SPORE_AUTHOR_GENERATOR_H

#include "core/generate/centreline/centreline.h"
#include "core/generate/sheet/sheet.h"
#include "core/generate/spheres/spheres.h"
#include "core/generate/surface/surface.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* The structures of the options of the generators that ship: attributes of the assets. */
typedef struct SporeMeshFields {
  const char *name, *file;
  int unit, frame; /* as core/io/mesh_import.h counts them */
  const char *source, *source_hash, *options_hash;
  bool frozen, edited;
  int64_t nodes;
  double size, keep_angle, wall; /* m, degrees, m */
  int64_t wall_detail;
  double first_corner[3], second_corner[3], third_corner[3], fourth_corner[3], inside[3]; /* m; all corners the same:
                                                                                             the sheet's own */
  int64_t control_points;      /* of a sheet; 0: by the tolerance */
  double tolerance, smoothing; /* m */
} SporeMeshFields;

typedef struct SporeSpheresFields {
  const char *name, *file, *source, *source_hash, *options_hash;
  bool frozen, edited;
  int method;                                       /* index in the table's choices */
  double coverage, outside, tolerance, depth_error; /* targets; all 0: by count */
  int64_t count, seed;
} SporeSpheresFields;

typedef struct SporeTetrahedraFields {
  const char *name, *file, *source, *source_hash, *options_hash;
  bool frozen, edited;
  int method; /* index in the table's choices: 0 the first that does it, else SporeTetrahedraMethod + 1 */
  int64_t cells;
  double size, tolerance, curvature, gap; /* size 0: by cells */
  bool fill, hollow;
  int pieces; /* index in the table's choices: all of them as one solid, the largest alone */
} SporeTetrahedraFields;

typedef struct SporeCurveFields {
  const char *name, *file, *source, *source_hash, *options_hash;
  bool frozen, edited;
  int64_t points;
  double tolerance;                     /* of the radius */
  double first_place[3], last_place[3]; /* m; the same: the organ's own ends */
  int64_t root_degree;                  /* of the root proposed for an intestine's mesentery; 0: no root */
} SporeCurveFields;

/* The use of a result, as a choice: names ended by NULL, and their meaning (N_). */
#define SPORE_GENERATOR_PURPOSE(names, meaning)                                                                        \
  {                                                                                                                    \
    .name = "make", .type = SPORE_CHOICE, .unit = "", .minimum = -HUGE_VAL, .maximum = HUGE_VAL, .choices = (names),   \
    .doc = (meaning)                                                                                                   \
  }

/* Options of a generator that are places on the organ, m in its axes, picked by hand in turn. All the same: those that
 * the generator finds itself. */
#define SPORE_GENERATOR_PLACES 4 /* at most */
typedef struct SporeGeneratorPlaces {
  const char *const *options;  /* ended by NULL */
  const char *const *hints;    /* what to click on, one an option; N_ */
  const char *pick, *pick_doc; /* "Pick ends"; N_ */
  const char *automatic_doc;   /* what places of its own are; N_ */
  gboolean asked;              /* where the generator finds none, they are asked for */
} SporeGeneratorPlaces;

typedef struct SporeGenerateWork SporeGenerateWork; /* generator_work.h */
typedef struct SporeGeneratorType {
  const char *name;    /* of the editor's actions: generate-NAME, preview-NAME */
  const char *command; /* spore COMMAND */
  const char *element; /* of the asset that it makes, whose table says the options (spore_generated_is_option) */
  const SporeElement *elements; /* the asset and its regions, ended by no name; NULL: those of another generator */
  const char *const *only;      /* names of the options that it takes; NULL: all of the asset's */
  const char *count;            /* the option that says how many; NULL: none */
  /* Ways to say how fine the result shall be, of which one is chosen: options separated by blanks, ways by " | ". The
   * options of the other ways are then 0, which is "not asked for". NULL: there is one way. */
  const char *ways;
  const SporeParameter *purpose; /* a choice, the use of the result (a field of int at 0); NULL: always the same use */
  SporeObject *(*target)(SporeDocument *document, SporeObject *body); /* asset that the body uses, or NULL */

  const char *shows;           /* what the result is, for drawing */
  const char *title, *working; /* "Spheres of %s", "Generating spheres"; N_ */
  const char *count_label;     /* N_ */
  const char *unit;  /* of a body, where the editor offers the generator: "collision", "mechanical"; NULL: nowhere */
  const char *offer; /* "Number of spheres", beside the number there; N_ */
  const SporeGeneratorPlaces *places; /* NULL: none */
  gboolean (*run)(SporeGenerateWork *work, const SporeProgress *progress, GError **error);
  /* Puts the result into the document, as one undo step. FALSE: nothing was changed. */
  gboolean (*apply)(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error);
  char *(*facts)(const SporeGenerateWork *work); /* text for people, one fact a line; g_free */
  /* The error (%) of a result of that number; NULL: it is not measured. */
  gboolean (*error_of)(const SporeGenerateWork *work, size_t count, double *error_percent,
                       const SporeProgress *progress, GError **error);
} SporeGeneratorType;

extern const SporeGeneratorType spore_generator_surface, spore_generator_spheres, spore_generator_tetrahedra,
    spore_generator_curve, spore_generator_labels, spore_generator_sheet;
#define SPORE_GENERATORS_MOST 32
#define SPORE_GENERATOR_FIELDS 512                         /* bytes that the fields of an asset take, at most */
extern const SporeGeneratorType *const spore_generators[]; /* all of them, ended by NULL */
/* The elements that the generators bring, for spore_schema_new. */
const SporeElement *const *spore_generator_elements(void);

/* The table of the fields of its asset. */
SporeParameterTable spore_generator_table(const SporeGeneratorType *type);
/* Whether the generator takes this option of its asset. */
gboolean spore_generator_takes(const SporeGeneratorType *type, const SporeParameter *parameter);
/* The way that an option belongs to, from 0; -1: to none. */
int spore_generator_way(const SporeGeneratorType *type, const char *option);
/* Sets the options of all other ways to 0 in the asset's fields, where 0 is allowed. */
void spore_generator_choose_way(const SporeGeneratorType *type, int way, void *fields);

/* Converts fields to the options of the generators, which borrow the regions. */
SporeSpheresOptions spore_edit_spheres_options(const SporeSpheresFields *fields, const SporeGenerateRegion *regions,
                                               gsize count);
SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count);
SporeCentrelineOptions spore_edit_centreline_options(const SporeCurveFields *fields);
SporeSimplifyOptions spore_edit_surface_options(const SporeMeshFields *fields);
SporeSheetOptions spore_edit_sheet_options(const SporeMeshFields *fields);

/* The mesh asset that the generated asset `target` (NULL: nothing yet) is made from. It is the mesh that the body
 * shows. Where the body shows nothing or the generated mesh itself, it is the source that the generated asset
 * remembers. NULL with an error: there is none. */
SporeObject *spore_edit_generator_source(SporeDocument *document, SporeObject *body, SporeObject *target,
                                         GError **error);
/* Element of the regions that this kind of object holds: "region" of `regions`; NULL: it holds none. */
const char *spore_region_element(const SporeObjectType *holder);
/* Collects the balls of the regions of an asset (NULL: of none). regions has room for SPORE_GENERATE_REGIONS. FALSE
 * with an error: the asset has more. */
gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error);

#endif
