/* The generators of tetrahedra, in a surface and of a label map: their options, which are attributes of <tetrahedra>.
 */
#include "core/author/generator.h"

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/scene/schema_tables.h"

static const char *const methods[] = {"automatic", "direct", "repaired", "wrapped", "voxels", NULL};

static const SporeParameter tetrahedra_parameters[] = {
    NAME(SporeTetrahedraFields, N_("Name by which mechanical units refer to the tetrahedra.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeTetrahedraFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of the tetrahedra, inside the scene's folder.")},
    {.name = "source",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh|label_map",
     FIELD(SporeTetrahedraFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh or label map that the tetrahedra were generated from; none: made elsewhere.")},
    {.name = "method",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = methods,
     FIELD(SporeTetrahedraFields, method),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How the mesh is made ready: as it is, repaired, wrapped, or cut out of a lattice; automatic: the first "
               "of these that does it.")},
    {.name = "cells",
     .type = SPORE_INTEGER,
     .unit = "",
     1,
     10000000,
     .initial = {1000},
     FIELD(SporeTetrahedraFields, cells),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of tetrahedra to generate, about; counts where the size is 0.")},
    {.name = "size",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     .initial = {0},
     FIELD(SporeTetrahedraFields, size),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Length of their edges; 0: by their number.")},
    {.name = "tolerance",
     .type = SPORE_REAL,
     .unit = "",
     1e-5,
     1,
     .initial = {0.01},
     FIELD(SporeTetrahedraFields, tolerance),
     .change = SPORE_CHANGE_LIVE,
     .doc =
         N_("Distance to the mesh that is let pass, as a share of the diagonal: tetrahedra by number get finer where "
            "it is larger.")},
    {.name = "curvature",
     .type = SPORE_REAL,
     .unit = "deg",
     0,
     90,
     .initial = {0},
     FIELD(SporeTetrahedraFields, curvature),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("By how much the mesh may turn along an edge, 5 to 90: they get finer where it bends; 0: no matter.")},
    {.name = "fill",
     .type = SPORE_BOOLEAN,
     .unit = "",
     FIELD(SporeTetrahedraFields, fill),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Whether cavities inside are filled.")},
    {.name = "gap",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     .initial = {0},
     FIELD(SporeTetrahedraFields, gap),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Openings narrower than this are closed by wrapping; 0: those narrower than half an edge.")},
    GENERATED(SporeTetrahedraFields),
};

typedef struct SporeCellRegionFields {
  const char *name;
  double centre[3], radius, size;
} SporeCellRegionFields;

static const SporeParameter cell_region_parameters[] = {
    BALL(SporeCellRegionFields),
    {.name = "size",
     .type = SPORE_REAL,
     .unit = "m",
     1e-6,
     POSITION_M,
     .initial = {0.002},
     FIELD(SporeCellRegionFields, size),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Length of the edges in the region, where that is less than around it.")},
};

typedef struct SporeLabelMapFields {
  const char *name, *file;
} SporeLabelMapFields;

static const SporeParameter label_map_parameters[] = {
    NAME(SporeLabelMapFields, N_("Name by which tetrahedra refer to the label map.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeLabelMapFields, file),
     .required = true,
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("File of the label map (NIfTI, NRRD), inside the scene's folder.")},
};

static const SporeElement elements[] = {
    {"tetrahedra", N_("Tetrahedra"), N_("A volume cut into tetrahedra."),
     TABLE(tetrahedra_parameters, SporeTetrahedraFields), .children = CHILDREN("cell_region")},
    {"cell_region", N_("Region"), N_("A ball in which the generated tetrahedra are smaller."),
     TABLE(cell_region_parameters, SporeCellRegionFields)},
    {NULL},
};

static const SporeElement map_elements[] = {
    {"label_map", N_("Label map"), N_("What each voxel of an image belongs to: organs are generated from it."),
     TABLE(label_map_parameters, SporeLabelMapFields)},
    {NULL},
};

SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count) {
  return (SporeTetrahedraOptions){.method = fields->method ? (SporeTetrahedraMethod)(fields->method - 1)
                                                           : SPORE_TETRAHEDRA_METHODS,
                                  .cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                  .size = fields->size,
                                  .tolerance = fields->tolerance,
                                  .curvature = fields->curvature,
                                  .fill = fields->fill,
                                  .gap = fields->gap,
                                  .regions = regions,
                                  .region_count = count};
}

const SporeGeneratorType spore_generator_tetrahedra = {
    .name = "tetrahedra",
    .command = "tetrahedra",
    .element = "tetrahedra",
    .elements = elements,
    .count = "cells",
    .ways = "cells | size",
    .target = spore_edit_body_tetrahedra,
};

/* Of a file, not of what a body shows. */
static SporeObject *no_target(SporeDocument *document, SporeObject *body) { return NULL; }

static const char *const label_uses[] = {"linked_bodies", "bodies", "one_body", "asset", NULL}; /* as SporeLabelUse */
static const SporeParameter label_purpose = SPORE_GENERATOR_PURPOSE(
    label_uses,
    N_("What Apply makes: a body of each organ, linked where they share faces or free of each other, one body of all "
       "that hangs together at shared faces, or an asset alone."));

const SporeGeneratorType spore_generator_labels = {
    .name = "labels",
    .command = "tetrahedra",
    .element = "tetrahedra",
    .elements = map_elements,
    .only = (const char *const[]){"cells", "size", NULL},
    .count = "cells",
    .ways = "cells | size",
    .purpose = &label_purpose,
    .target = no_target,
};
