#include "core/scene/length_unit.h"
#include "core/scene/schema_tables.h"

static const char *const frames[] = {"Y_UP", "RAS", "LPS", NULL};
const char *const spore_sphere_methods[] = {"balanced", "tetrahedra", "bounding", "weighted", NULL};
static const char *const tetrahedra_methods[] = {"automatic", "direct", "repaired", "wrapped", "voxels", NULL};

/* What generated data remember (core/scene/generated.h); the other parameters of their element are the options. */
#define GENERATED(Type)                                                                                                \
  {.name = "source_hash",                                                                                              \
   .type = SPORE_TEXT,                                                                                                 \
   .unit = "",                                                                                                         \
   FIELD(Type, source_hash),                                                                                           \
   .change = SPORE_CHANGE_LIVE,                                                                                        \
   .doc = N_("Hash of the source's content at the time of generation; when it differs, the data are stale.")},         \
      {.name = "options_hash",                                                                                         \
       .type = SPORE_TEXT,                                                                                             \
       .unit = "",                                                                                                     \
       FIELD(Type, options_hash),                                                                                      \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc = N_("Hash of the options at the time of generation; when it differs, the data are stale.")},              \
      {.name = "frozen",                                                                                               \
       .type = SPORE_BOOLEAN,                                                                                          \
       .unit = "",                                                                                                     \
       FIELD(Type, frozen),                                                                                            \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc =                                                                                                          \
           N_("Whether the data stay as they are, whatever becomes of their source: nothing generates them anew.")},   \
  {                                                                                                                    \
    .name = "edited", .type = SPORE_BOOLEAN, .unit = "", FIELD(Type, edited), .change = SPORE_CHANGE_LIVE,             \
    .doc = N_("Whether the data were edited by hand since they were generated.")                                       \
  }

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

/* What generated spheres are to reach; 0: it is not asked for. */
#define SPHERES_AIM(aim, most, words)                                                                                  \
  {                                                                                                                    \
    .name = #aim, .type = SPORE_REAL, .unit = "", 0, most, .initial = {0}, FIELD(SporeSpheresFields, aim),             \
    .change = SPORE_CHANGE_LIVE, .doc = words                                                                          \
  }

static const SporeParameter spheres_parameters[] = {
    NAME(SporeSpheresFields, N_("Name by which collision units refer to the spheres.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeSpheresFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc =
         N_("File of the spheres, inside the scene's folder: x y z r a line, of a centre and its radius, m; or x y z "
            "r w with a weight, which a depth field as surface then uses; # begins a comment.")},
    {.name = "source",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh|tetrahedra",
     FIELD(SporeSpheresFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Asset that the spheres were generated from; none: made by hand.")},
    {.name = "method",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = spore_sphere_methods,
     FIELD(SporeSpheresFields, method),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How the spheres are generated.")},
    {.name = "count",
     .type = SPORE_INTEGER,
     .unit = "",
     1,
     5000,
     .initial = {100},
     FIELD(SporeSpheresFields, count),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of spheres to generate; counts where coverage, outside, tolerance and depth error are 0.")},
    SPHERES_AIM(coverage, 0.9999,
                N_("Share of the inside that has to lie in spheres: as few spheres as reach it, and "
                   "what else is asked for, are generated; 0: not asked for.")),
    SPHERES_AIM(outside, 100,
                N_("Volume of the spheres outside that is let pass, as a share of the mesh's volume; 0: any.")),
    SPHERES_AIM(tolerance, 0.5,
                N_("Mean distance between mesh and spheres that is let pass, as a share of the diagonal; 0: any.")),
    SPHERES_AIM(depth_error, 1,
                N_("Mean error of the depth inside that is let pass, as a share of the largest depth; 0: any.")),
    {.name = "seed",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     2147483647,
     .initial = {1},
     FIELD(SporeSpheresFields, seed),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Start of the random numbers of generation; the same seed gives the same spheres.")},
    GENERATED(SporeSpheresFields),
};

/* A ball that a generator does something of its own in. */
#define BALL(Type)                                                                                                     \
  NAME(Type, N_("Name of the region.")),                                                                               \
      {.name = "centre",                                                                                               \
       .type = SPORE_VECTOR,                                                                                           \
       .unit = "m",                                                                                                    \
       -POSITION_M,                                                                                                    \
       POSITION_M,                                                                                                     \
       FIELD(Type, centre),                                                                                            \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc = N_("Middle of the region, in the axes of the mesh.")},                                                   \
  {                                                                                                                    \
    .name = "radius", .type = SPORE_REAL, .unit = "m", 1e-6, POSITION_M, .initial = {0.01}, FIELD(Type, radius),       \
    .change = SPORE_CHANGE_LIVE, .doc = N_("Radius of the region.")                                                    \
  }

static const SporeParameter sphere_region_parameters[] = {
    BALL(SporeSphereRegionFields),
    {.name = "density",
     .type = SPORE_REAL,
     .unit = "",
     1.0 / 16,
     16,
     .initial = {4},
     FIELD(SporeSphereRegionFields, density),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How many times as many spheres lie in a volume there; where regions overlap, the largest holds.")},
};

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
     .choices = tetrahedra_methods,
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

static const SporeParameter curve_parameters[] = {
    NAME(SporeCurveFields, N_("Name by which bodies refer to the curve.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeCurveFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of the curve, inside the scene's folder: x y z r a line, of a point and the radius there, m; # "
               "begins a comment.")},
    {.name = "source",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh",
     FIELD(SporeCurveFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh that the curve is the middle line of; none: made elsewhere.")},
    {.name = "points",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     100000,
     FIELD(SporeCurveFields, points),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of points to generate, evenly along the line; 0: as many as the tolerance takes.")},
    {.name = "tolerance",
     .type = SPORE_REAL,
     .unit = "",
     0.0001,
     0.9,
     .initial = {0.02},
     FIELD(SporeCurveFields, tolerance),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How far straight pieces may leave the line, of the radius, where the number of points is 0.")},
    {.name = "first_place",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeCurveFields, first_place),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Place in or on the organ where the line begins; the same as the last place: at the organ's end.")},
    {.name = "last_place",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeCurveFields, last_place),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Place in or on the organ where the line ends; the same as the first place: at the organ's end.")},
    GENERATED(SporeCurveFields),
};

const SporeElement spore_asset_elements[] = {
    {"assets", N_("Assets"), N_("Files that the scene is made from."),
     .children = CHILDREN("mesh", "spheres", "tetrahedra", "curve", "label_map")},
    {"mesh", N_("Mesh"), N_("A surface of triangles."), TABLE(mesh_parameters, SporeMeshFields)},
    {"spheres", N_("Spheres"), N_("A set of spheres that fills a shape, for collision."),
     TABLE(spheres_parameters, SporeSpheresFields), .children = CHILDREN("sphere_region")},
    {"sphere_region", N_("Region"), N_("A ball in which the generated spheres lie denser, or less so."),
     TABLE(sphere_region_parameters, SporeSphereRegionFields)},
    {"tetrahedra", N_("Tetrahedra"), N_("A volume cut into tetrahedra."),
     TABLE(tetrahedra_parameters, SporeTetrahedraFields), .children = CHILDREN("cell_region")},
    {"cell_region", N_("Region"), N_("A ball in which the generated tetrahedra are smaller."),
     TABLE(cell_region_parameters, SporeCellRegionFields)},
    {"curve", N_("Curve"), N_("The middle line of a thread or a tube, with its radius along it."),
     TABLE(curve_parameters, SporeCurveFields)},
    {"label_map", N_("Label map"), N_("What each voxel of an image belongs to: organs are generated from it."),
     TABLE(label_map_parameters, SporeLabelMapFields)},
    {NULL},
};
