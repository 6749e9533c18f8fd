/* The generator of surfaces and walls: its options, which are attributes of <mesh>. */
#include "core/author/generator.h"

#include <math.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/scene/length_unit.h"
#include "core/scene/schema_tables.h"

static const char *const frames[] = {"Y_UP", "RAS", "LPS", NULL};

static const SporeParameter mesh_parameters[] = {
    NAME(SporeMeshFields, N_("Name by which bodies and generators refer to the mesh.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeMeshFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of the surface mesh, inside the scene's folder.")},
    {.name = "unit",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = spore_length_units,
     FIELD(SporeMeshFields, unit),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Unit of the numbers in the mesh file.")},
    {.name = "frame",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = frames,
     FIELD(SporeMeshFields, frame),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Axes of the mesh file: Y_UP as in the scene, RAS or LPS for medical images.")},
    {.name = "source",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh",
     FIELD(SporeMeshFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh that this one was generated from, with fewer nodes or a wall; none: made elsewhere.")},
    {.name = "nodes",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     10000000,
     .initial = {300},
     FIELD(SporeMeshFields, nodes),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of nodes to generate at most; 0: as many as the size takes, or with a wall all.")},
    {.name = "size",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     FIELD(SporeMeshFields, size),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Length of edges to generate, where the number of nodes is 0.")},
    {.name = "keep_angle",
     .type = SPORE_REAL,
     .unit = "deg",
     1,
     360,
     .initial = {60},
     FIELD(SporeMeshFields, keep_angle),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Edges at which the surface turns by more are kept; 360: none.")},
    {.name = "wall",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     FIELD(SporeMeshFields, wall),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Thickness of the wall that makes the organ hollow; 0: it stays as it is.")},
    {.name = "wall_detail",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     SPORE_MOST_WALL_DETAIL,
     FIELD(SporeMeshFields, wall_detail),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How near the wall is to its thickness: twice as much halves the largest error, in more triangles; 0: "
               "16, for an error below 5 %.")},
    GENERATED(SporeMeshFields),
};

static const SporeElement elements[] = {
    {"mesh", N_("Mesh"), N_("A surface of triangles."), TABLE(mesh_parameters, SporeMeshFields)},
    {NULL},
};

SporeSimplifyOptions spore_edit_surface_options(const SporeMeshFields *fields) {
  return (SporeSimplifyOptions){(size_t)fields->nodes, fields->nodes ? 0 : fields->size,
                                fields->keep_angle * G_PI / 180};
}

static const char *const uses[] = {"model", "visual_mesh", "asset", NULL}; /* as SporeSurfaceUse */
static const SporeParameter purpose = SPORE_GENERATOR_PURPOSE(
    uses, N_("What Apply makes: what the body's model is built from, the mesh that the body shows and generators start "
             "from (a wall, to be filled with tetrahedra), or an asset alone."));

const SporeGeneratorType spore_generator_surface = {
    .name = "surface",
    .command = "surface",
    .element = "mesh",
    .elements = elements,
    .count = "nodes",
    .ways = "nodes | size",
    .purpose = &purpose,
    .target = spore_edit_body_surface,
};
