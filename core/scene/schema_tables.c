#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/length_unit.h"
#include "core/scene/schema_fields.h"
#include "core/sim/tissue.h"

#define ANY -HUGE_VAL, HUGE_VAL
#define FIELD(Type, field) .offset = offsetof(Type, field)
#define NAME(Type, text)                                                                                               \
  { .name = "name", .type = SPORE_NAME, .unit = "", FIELD(Type, name), .required = true, .doc = text }
#define POSITION_M 1e6 /* beyond it a double no longer resolves a nanometre */

static const char *const frames[] = {"Y_UP", "RAS", "LPS", NULL};
const char *const spore_sphere_methods[] = {"balanced", "tetrahedra", "bounding", "weighted", NULL};
static const char *const tetrahedra_methods[] = {"automatic", "direct", "repaired", "wrapped", "voxels", NULL};
static const char *const roles[] = {"unmovable", "active", "passive", NULL};
static const char *const fidelities[] = {"physical", "effect", NULL};

static const SporeParameter root_parameters[] = {
    {.name = "version",
     .type = SPORE_TEXT,
     .unit = "",
     .initial_text = "1.0",
     FIELD(SporeRootFields, version),
     .required = true,
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Version of the file format, major.minor.")},
};

static const SporeParameter meta_parameters[] = {
    {.name = "title",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, title),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What the scene is called.")},
    {.name = "author",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, author),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Who made the scene.")},
    {.name = "description",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, description),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What the scene shows and where its data come from.")},
    {.name = "licence",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, licence),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Terms under which the scene may be used.")},
};

static const SporeParameter units_parameters[] = {
    {.name = "length",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {2},
     .choices = spore_length_units,
     FIELD(SporeUnitsFields, length),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Unit in which lengths are shown to people; the file itself is always in metres.")},
};

static const SporeParameter environment_parameters[] = {
    {.name = "gravity",
     .type = SPORE_VECTOR,
     .unit = "m/s^2",
     -1000,
     1000,
     .initial = {0, -9.81, 0},
     FIELD(SporeEnvironmentFields, gravity),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Acceleration of free fall; y points up.")},
};

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
     .references = "mesh",
     FIELD(SporeTetrahedraFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh that the tetrahedra were generated from; none: made elsewhere.")},
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

static const SporeParameter body_parameters[] = {
    NAME(SporeBodyFields, N_("Name by which links and tools refer to the body.")),
    {.name = "role",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {SPORE_PASSIVE},
     .choices = roles,
     FIELD(SporeBodyFields, role),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("unmovable stays where it is, active follows a device, passive is moved by physics.")},
    {.name = "position",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeBodyFields, position),
     .change = SPORE_CHANGE_RESTART,
     .doc = N_("Where the body's frame stands at the start.")},
    {.name = "rotation",
     .type = SPORE_VECTOR,
     .unit = "rad",
     -1000,
     1000,
     FIELD(SporeBodyFields, rotation),
     .change = SPORE_CHANGE_RESTART,
     .doc = N_("Rotation vector of the body's frame at the start: its direction is the axis, its length the angle.")},
    {.name = "velocity",
     .type = SPORE_VECTOR,
     .unit = "m/s",
     -1000,
     1000,
     FIELD(SporeBodyFields, velocity),
     .change = SPORE_CHANGE_RESTART,
     .doc = N_("Velocity at the start.")},
    {.name = "spin",
     .type = SPORE_VECTOR,
     .unit = "rad/s",
     -10000,
     10000,
     FIELD(SporeBodyFields, spin),
     .change = SPORE_CHANGE_RESTART,
     .doc = N_("Angular velocity at the start, about the scene's axes.")},
};

static const SporeParameter mechanical_parameters[] = {
    {.name = "geometry",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh|tetrahedra|curve",
     FIELD(SporeMechanicalFields, geometry),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Asset that the model is built from.")},
    {.name = "integrator",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0}, /* choices: see schema.c */
     FIELD(SporeMechanicalFields, integrator),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How the body's motion is integrated; scene: as the solver says.")},
    {.name = "substeps",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 0,
     .maximum = SPORE_SUBSTEPS_MAXIMUM,
     .initial = {0},
     FIELD(SporeMechanicalFields, substeps),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Parts that the body's motion over a step is integrated in; 0: as the solver says.")},
    {.name = "material",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = spore_material_names,
     FIELD(SporeMechanicalFields, material),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Tissue that the model's density, Young's modulus and Poisson's ratio are those of, where it does not "
               "set them itself; spore models --materials tells its figures and where they were measured.")},
};

static const SporeParameter region_parameters[] = {
    NAME(SporeRegionFields, N_("Name of the region.")),
    {.name = "centre",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeRegionFields, centre),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Middle of the region at rest, in the body's frame.")},
    {.name = "radius",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     .initial = {0.01},
     FIELD(SporeRegionFields, radius),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Elements whose middle is nearer than this to the centre are of the region.")},
    {.name = "stiffness_scale",
     .type = SPORE_REAL,
     .unit = "",
     1e-6,
     1e6,
     .initial = {1},
     FIELD(SporeRegionFields, stiffness_scale),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How many times as stiff as the body the region is; where regions overlap, their factors multiply.")},
    {.name = "density_scale",
     .type = SPORE_REAL,
     .unit = "",
     1e-3,
     1e3,
     .initial = {1},
     FIELD(SporeRegionFields, density_scale),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How many times as dense as the body the region is.")},
    {.name = "material",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = spore_material_names,
     FIELD(SporeRegionFields, material),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Tissue whose Young's modulus and density the region has, before the factors; none: the body's.")},
};

static const SporeParameter collision_parameters[] = {
    {.name = "spheres",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "spheres",
     FIELD(SporeCollisionFields, spheres),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Spheres with which the body collides; a fluid needs none, it has one at each particle.")},
};

static const SporeParameter visual_parameters[] = {
    {.name = "mesh",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh",
     FIELD(SporeVisualFields, mesh),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh that is drawn for the body.")},
    {.name = "colour",
     .type = SPORE_VECTOR,
     .unit = "",
     0,
     1,
     .initial = {0.75, 0.35, 0.32},
     FIELD(SporeVisualFields, colour),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Red, green and blue, as in sRGB.")},
    {.name = "wetness",
     .type = SPORE_REAL,
     .unit = "",
     0,
     1,
     .initial = {0.5},
     FIELD(SporeVisualFields, wetness),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How strongly a wet film shines on the surface.")},
};

static const SporeParameter fidelity_parameters[] = {
    {.name = "mode",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {SPORE_FIDELITY_PHYSICAL},
     .choices = fidelities,
     FIELD(SporeFidelityFields, mode),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Whether the body is to be simulated or shown as an effect.")},
    {.name = "level",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {SPORE_LEVEL_FINE},
     .choices = spore_level_names,
     FIELD(SporeFidelityFields, level),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How finely the body is made: fine as its mechanical unit says, coarse and medium as the levels beside "
               "this say. It may change while it runs.")},
    {.name = "level_tolerance",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     1,
     .initial = {1e-3},
     FIELD(SporeFidelityFields, level_tolerance),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How far a change of level may move any point of the body; one that would move it further is refused.")},
};

static const SporeParameter level_parameters[] = {
    {.name = "geometry",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh|tetrahedra|curve",
     FIELD(SporeLevelFields, geometry),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Mesh, tetrahedra or curve that the level is made from, in the same place; without one, the body's.")},
    {.name = "settings",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeLevelFields, settings),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Parameters of the model that differ at this level, apart by blanks: control_points=12.")},
};

static const SporeParameter pin_parameters[] = {
    NAME(SporePinFields, N_("Name of the pin.")),
    {.name = "body",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporePinFields, body),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body that is held.")},
    {.name = "point",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporePinFields, point),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Centre of what is held, in the scene.")},
    {.name = "radius",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     .initial = {0.005},
     FIELD(SporePinFields, radius),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Every part of the body nearer than this to the point at the start is held still.")},
};

static const SporeParameter spring_parameters[] = {
    NAME(SporeSpringFields, N_("Name of the spring.")),
    {.name = "body_a",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeSpringFields, body_a),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body at the first end.")},
    {.name = "body_b",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeSpringFields, body_b),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body at the second end; none: the end is fixed in the scene.")},
    {.name = "point_a",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeSpringFields, point_a),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Where the first end is tied at the start, in the scene.")},
    {.name = "point_b",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeSpringFields, point_b),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Where the second end is tied at the start, in the scene.")},
    {.name = "stiffness",
     .type = SPORE_REAL,
     .unit = "N/m",
     0,
     1e12,
     .initial = {100},
     FIELD(SporeSpringFields, stiffness),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force for each metre of stretch.")},
    {.name = "damping",
     .type = SPORE_REAL,
     .unit = "N s/m",
     0,
     1e9,
     .initial = {0.1},
     FIELD(SporeSpringFields, damping),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force against each metre per second of stretching.")},
    {.name = "rest_length",
     .type = SPORE_REAL,
     .unit = "m",
     -1,
     POSITION_M,
     .initial = {-1},
     FIELD(SporeSpringFields, rest_length),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Length at which the spring is slack; negative: its length at the start.")},
    {.name = "strength",
     .type = SPORE_REAL,
     .unit = "N",
     0,
     1e9,
     .initial = {0},
     FIELD(SporeSpringFields, strength),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force above which the spring breaks for good; 0: never.")},
};

static const char *const line_ends[] = {"stop", "slip_off", NULL};

#define LINK_BODY(field, text)                                                                                         \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REFERENCE, .unit = "", .references = "body", FIELD(SporeLinkFields, field),          \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define LINK_POINT(text)                                                                                               \
  {                                                                                                                    \
    .name = "point", .type = SPORE_VECTOR, .unit = "m", -POSITION_M, POSITION_M, FIELD(SporeLinkFields, point),        \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define LINK_DIRECTION(text)                                                                                           \
  {                                                                                                                    \
    .name = "direction", .type = SPORE_VECTOR, .unit = "", -POSITION_M, POSITION_M, .initial = {0, 1, 0},              \
    FIELD(SporeLinkFields, direction), .change = SPORE_CHANGE_REBUILD, .doc = text                                     \
  }
#define LINK_FRICTION                                                                                                  \
  {                                                                                                                    \
    .name = "friction", .type = SPORE_REAL, .unit = "", .maximum = 10, FIELD(SporeLinkFields, friction),               \
    .change = SPORE_CHANGE_REBUILD,                                                                                    \
    .doc = N_("Coulomb coefficient against running along the line: force for each newton that it holds across.")       \
  }
#define LINK_ENDS                                                                                                      \
  {                                                                                                                    \
    .name = "ends", .type = SPORE_CHOICE, .unit = "", .maximum = 1, .choices = line_ends,                              \
    FIELD(SporeLinkFields, ends), .change = SPORE_CHANGE_REBUILD,                                                      \
    .doc = N_("What happens at the ends of a thread's or tube's own line: stop, it is held there; slip_off, it is "    \
              "let go for good.")                                                                                      \
  }
#define LINK_LENGTH(text)                                                                                              \
  {                                                                                                                    \
    .name = "length", .type = SPORE_REAL, .unit = "m", 1e-6, POSITION_M, .initial = {0.01},                            \
    FIELD(SporeLinkFields, length), .change = SPORE_CHANGE_REBUILD, .doc = text                                        \
  }

static const SporeParameter ball_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the ball joint.")),
    LINK_BODY(body_a, N_("Body that is held.")),
    LINK_BODY(body_b, N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are held together at the start, in the scene.")),
};

static const SporeParameter hinge_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the hinge.")),
    LINK_BODY(body_a, N_("Body that turns.")),
    LINK_BODY(body_b, N_("Body that it turns on; none: the scene.")),
    LINK_POINT(N_("A point of the axis at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the axis at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the two points of the axis that are held: the longer, the stiffer.")),
};

static const SporeParameter weld_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the weld.")),
    LINK_BODY(body_a, N_("Body that is held.")),
    LINK_BODY(body_b, N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are joined at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the points that are held: the longer, the stiffer against turning.")),
};

static const SporeParameter seam_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the seam.")),
    LINK_BODY(body_a, N_("Body that is held, with nodes of its own.")),
    LINK_BODY(body_b, N_("Body that it is held at, with nodes of its own.")),
    {.name = "distance",
     .type = SPORE_REAL,
     .unit = "m",
     .minimum = 1e-9,
     .maximum = 1,
     .initial = {1e-6},
     FIELD(SporeLinkFields, distance),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("A node of one body and one of the other are held together where they lie no farther apart than this "
               "at the start.")},
};

static const SporeParameter slide_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the slide.")),
    LINK_BODY(body_a, N_("Body whose point slides.")),
    LINK_BODY(body_b, N_("Body that the line belongs to: a thread or a tube, along which the point runs however it "
                         "bends, or a rigid one; none: the scene.")),
    LINK_POINT(N_("Point that slides, where it is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the line at the start, in the scene; a thread or a tube has its own.")),
    LINK_FRICTION,
    LINK_ENDS,
};

static const SporeParameter port_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the port.")),
    LINK_BODY(body_a, N_("What goes through the port: an instrument with its shaft, or a thread or a tube.")),
    LINK_BODY(body_b, N_("Body that the port is in; none: the scene.")),
    LINK_POINT(N_("Where the port is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the shaft at the start, in the scene; a thread or a tube has its own.")),
    LINK_FRICTION,
    LINK_ENDS,
};

static const SporeParameter camera_parameters[] = {
    NAME(SporeCameraFields, N_("Name of the camera.")),
    {.name = "body",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeCameraFields, body),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Body that the camera moves with, such as an endoscope, rigid or active; none: it stands still.")},
    {.name = "position",
     .type = SPORE_VECTOR,
     .unit = "m",
     .minimum = -POSITION_M,
     .maximum = POSITION_M,
     .initial = {0, 0, 0.3},
     FIELD(SporeCameraFields, position),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Where the camera stands, with its body at the start.")},
    {.name = "target",
     .type = SPORE_VECTOR,
     .unit = "m",
     .minimum = -POSITION_M,
     .maximum = POSITION_M,
     FIELD(SporeCameraFields, target),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What it looks at, with its body at the start; up is the scene's y.")},
    {.name = "field_of_view",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = 0.05,
     .maximum = 2.8,
     .initial = {0.7},
     FIELD(SporeCameraFields, field_of_view),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Vertical field of view.")},
};

#define TOOL_BODY(Type, field, text)                                                                                   \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REFERENCE, .unit = "", .references = "body", FIELD(Type, field),                     \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define TOOL_DEVICE(Type)                                                                                              \
  {                                                                                                                    \
    .name = "device", .type = SPORE_REFERENCE, .unit = "", .references = "mouse|track", FIELD(Type, device),           \
    .change = SPORE_CHANGE_REBUILD, .doc = N_("Device that moves the tool.")                                           \
  }
#define TOOL_PLACE(Type, field, text)                                                                                  \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "m", -POSITION_M, POSITION_M, FIELD(Type, field),                    \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define TOOL_DIRECTION(Type, field, text)                                                                              \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "", -POSITION_M, POSITION_M, .initial = {1, 0, 0},                   \
    FIELD(Type, field), .change = SPORE_CHANGE_REBUILD, .doc = text                                                    \
  }

static const SporeParameter probe_parameters[] = {
    NAME(SporeProbeFields, N_("Name of the tool.")),
    TOOL_BODY(SporeProbeFields, body, N_("Active body that the tool moves.")),
    TOOL_DEVICE(SporeProbeFields),
};

#define JAW_TOOL                                                                                                       \
  NAME(SporeJawToolFields, N_("Name of the tool.")),                                                                   \
      TOOL_BODY(SporeJawToolFields, body, N_("Active body that the tool moves: the shaft.")),                          \
      TOOL_DEVICE(SporeJawToolFields),                                                                                 \
      TOOL_BODY(SporeJawToolFields, jaw_a, N_("Active body of the first jaw, where it is when closed.")),              \
      TOOL_BODY(SporeJawToolFields, jaw_b, N_("Active body of the second jaw, where it is when closed.")),             \
      TOOL_PLACE(SporeJawToolFields, hinge, N_("Where the jaws are hinged at the start, in the scene.")),              \
      TOOL_DIRECTION(SporeJawToolFields, axis,                                                                         \
                     N_("Axis of the hinge at the start, in the scene: the first jaw opens by turning about it, the "  \
                        "second against it."))

static const SporeParameter jaw_tool_parameters[] = {JAW_TOOL};

static const SporeParameter scissors_parameters[] = {
    JAW_TOOL,
    TOOL_PLACE(SporeJawToolFields, tip, N_("Where the blades end at the start, closed, in the scene.")),
};

static const SporeParameter suction_parameters[] = {
    NAME(SporeSuctionToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeSuctionToolFields, body, N_("Active body that the tool moves: the tube.")),
    TOOL_DEVICE(SporeSuctionToolFields),
    TOOL_PLACE(SporeSuctionToolFields, point, N_("Middle of the mouth at the start, in the scene.")),
};

static const SporeParameter bipolar_parameters[] = {
    NAME(SporeBipolarToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeBipolarToolFields, body, N_("Active body that the tool moves: the forceps.")),
    TOOL_DEVICE(SporeBipolarToolFields),
    TOOL_PLACE(SporeBipolarToolFields, point, N_("Where it heats, between its tips, at the start, in the scene.")),
};

static const SporeParameter needle_parameters[] = {
    NAME(SporeNeedleToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeNeedleToolFields, body, N_("Active body that the tool moves: the needle. It needs no spheres.")),
    TOOL_DEVICE(SporeNeedleToolFields),
    TOOL_BODY(SporeNeedleToolFields, thread, N_("Thread, a body along a curve that begins or ends at the swage.")),
    TOOL_PLACE(SporeNeedleToolFields, tip, N_("Its tip at the start, in the scene.")),
    TOOL_PLACE(SporeNeedleToolFields, middle, N_("A point between on its arc at the start, in the scene.")),
    TOOL_PLACE(SporeNeedleToolFields, swage, N_("Where it ends and the thread begins, at the start, in the scene.")),
};

static const SporeParameter emitter_parameters[] = {
    NAME(SporeWoundFields, N_("Name of the emitter.")),
    TOOL_BODY(SporeWoundFields, body, N_("Fluid that comes out.")),
    TOOL_BODY(SporeWoundFields, source, N_("Body that the mouth is in and moves with; none: the scene.")),
    TOOL_PLACE(SporeWoundFields, point, N_("Middle of the mouth at the start, in the scene.")),
    TOOL_DIRECTION(SporeWoundFields, direction, N_("Direction in which it comes out at the start, in the scene.")),
};

static const SporeParameter mouse_parameters[] = {
    NAME(SporeMouseFields, N_("Name by which tools refer to the mouse.")),
};

static const SporeParameter track_parameters[] = {
    NAME(SporeTrackFields, N_("Name by which tools refer to the track.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeTrackFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of recorded input, inside the scene's folder: a line spore-track 1, then for each active body a "
               "line device NAME and its rows of time (s), position (m), orientation (quaternion w x y z), grip and "
               "buttons; # begins a comment.")},
};

#define CHILDREN(...) ((const char *const[]){__VA_ARGS__, NULL})
#define TABLE(array, Type) .parameters = array, .count = G_N_ELEMENTS(array), .size = sizeof(Type)

#define JOINT .extra = &spore_joint_parameters, .extra_offset = offsetof(SporeLinkFields, joint)
#define JAWS .extra = &spore_jaw_parameters, .extra_offset = offsetof(SporeJawToolFields, jaws)

const SporeElement spore_scene_elements[] = {
    {"spore", N_("Scene"), N_("A scene: bodies, how they meet, and the tools that touch them."),
     TABLE(root_parameters, SporeRootFields), .ordered = TRUE,
     .children = CHILDREN("meta", "units", "environment", "solver", "defaults", "assets", "bodies", "links", "effects",
                          "tools", "devices", "exercise")},
    {"meta", N_("About"), N_("What the scene is and whose it is."), TABLE(meta_parameters, SporeMetaFields)},
    {"units", N_("Units"), N_("How quantities are shown to people."), TABLE(units_parameters, SporeUnitsFields)},
    {"environment", N_("Environment"), N_("What acts on every body."),
     TABLE(environment_parameters, SporeEnvironmentFields)},
    {"solver", N_("Solver"), N_("How the scene is moved forward in time."), .extra = &spore_solver_parameters,
     .size = sizeof(SporeSolverFields)},
    {"defaults", N_("Defaults"), N_("What objects start from."), .children = CHILDREN("contact"), .ordered = TRUE},
    {"contact", N_("Contact"), N_("Contact law of every body that does not set its own."),
     .extra = &spore_contact_parameters, .size = sizeof(SporeContactFields)},
    {"assets", N_("Assets"), N_("Files that the scene is made from."),
     .children = CHILDREN("mesh", "spheres", "tetrahedra", "curve")},
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
    {"bodies", N_("Bodies"), N_("Organs, instruments and surroundings."), .children = CHILDREN("body")},
    {"body", N_("Body"), N_("One thing in the scene, with its mechanical, collision and visual units."),
     TABLE(body_parameters, SporeBodyFields), .ordered = TRUE,
     .children = CHILDREN("mechanical", "regions", "collision", "visual", "fidelity")},
    {"mechanical", N_("Mechanical unit"), N_("How the body moves and deforms."),
     TABLE(mechanical_parameters, SporeMechanicalFields), .single_child = TRUE},
    {"regions", N_("Regions"), N_("Parts of the body that are of another stiffness or density."),
     .children = CHILDREN("region")},
    {"region", N_("Region"), N_("A part of a solid: a stiff knot, a soft patch, another tissue."),
     TABLE(region_parameters, SporeRegionFields)},
    {"collision", N_("Collision unit"), N_("How the body meets others."),
     TABLE(collision_parameters, SporeCollisionFields), .extra = &spore_contact_parameters,
     .extra_offset = offsetof(SporeCollisionFields, contact)},
    {"visual", N_("Visual unit"), N_("How the body looks."), TABLE(visual_parameters, SporeVisualFields)},
    {"fidelity", N_("Fidelity"), N_("How faithfully the body is simulated."),
     TABLE(fidelity_parameters, SporeFidelityFields), .ordered = TRUE, .children = CHILDREN("coarse", "medium")},
    {"coarse", N_("Coarse level"), N_("The body made with the fewest degrees of freedom."),
     TABLE(level_parameters, SporeLevelFields)},
    {"medium", N_("Medium level"), N_("The body made with fewer degrees of freedom."),
     TABLE(level_parameters, SporeLevelFields)},
    {"links", N_("Links"), N_("What ties bodies to each other and to the scene."),
     .children = CHILDREN("pin", "spring", "ball", "hinge", "weld", "seam", "slide", "port")},
    {"pin", N_("Pin"), N_("Holds part of a body still."), TABLE(pin_parameters, SporePinFields)},
    {"spring", N_("Spring"), N_("A damped spring between two bodies, or a body and the scene."),
     TABLE(spring_parameters, SporeSpringFields)},
    {"ball", N_("Ball joint"), N_("Holds a point of a body at another, or at the scene, and leaves it free to turn."),
     TABLE(ball_parameters, SporeLinkFields), JOINT},
    {"hinge", N_("Hinge"), N_("Leaves a body free to turn about an axis, and holds all else."),
     TABLE(hinge_parameters, SporeLinkFields), JOINT},
    {"weld", N_("Weld"), N_("Joins two bodies, or a body and the scene, as if they were one."),
     TABLE(weld_parameters, SporeLinkFields), JOINT},
    {"seam", N_("Seam"), N_("Joins two bodies that deform wherever their nodes meet, as organs that share faces."),
     TABLE(seam_parameters, SporeLinkFields), JOINT},
    {"slide", N_("Slide"),
     N_("Leaves a point of a body free to run along a line, straight or that of a thread, and holds it there."),
     TABLE(slide_parameters, SporeLinkFields), JOINT},
    {"port", N_("Port"),
     N_("Lets an instrument or a thread through at one point, as a trocar or a stitch does: it turns and slides "
        "there."),
     TABLE(port_parameters, SporeLinkFields), JOINT},
    {"effects", N_("Effects"), N_("What goes on besides what bodies do."), .children = CHILDREN("emitter")},
    {"emitter", N_("Emitter"), N_("A mouth that particles of a fluid come out of: a wound that bleeds."),
     TABLE(emitter_parameters, SporeWoundFields), .extra = &spore_emitter_parameters,
     .extra_offset = offsetof(SporeWoundFields, emitter)},
    {"tools", N_("Tools"), N_("What the user holds, and looks through."),
     .children = CHILDREN("probe", "grasper", "clamp", "scissors", "suction", "bipolar", "needle", "camera")},
    {"probe", N_("Probe"), N_("An active body moved by a device."), TABLE(probe_parameters, SporeProbeFields)},
    {"grasper", N_("Grasper"), N_("Two jaws that close on tissue and hold it."),
     TABLE(jaw_tool_parameters, SporeJawToolFields), JAWS},
    {"clamp", N_("Clamp"), N_("Two jaws that stay closed on what they took hold of, until the second button."),
     TABLE(jaw_tool_parameters, SporeJawToolFields), JAWS},
    {"scissors", N_("Scissors"),
     N_("Blades that cut nets and tetrahedra where they close; jaws are the bodies that are seen and felt of them, and "
        "may be left out."),
     TABLE(scissors_parameters, SporeJawToolFields), JAWS},
    {"suction", N_("Suction"), N_("A tube that takes the particles of fluids away."),
     TABLE(suction_parameters, SporeSuctionToolFields), .extra = &spore_suction_parameters,
     .extra_offset = offsetof(SporeSuctionToolFields, suction)},
    {"bipolar", N_("Bipolar forceps"),
     N_("Forceps that coagulate nets and tetrahedra while the first button is down: these shrink and stiffen there, "
        "for good."),
     TABLE(bipolar_parameters, SporeBipolarToolFields), .extra = &spore_bipolar_parameters,
     .extra_offset = offsetof(SporeBipolarToolFields, bipolar)},
    {"needle", N_("Needle"),
     N_("A curved needle that pierces nets, surfaces and tetrahedra, and draws a thread through them."),
     TABLE(needle_parameters, SporeNeedleToolFields), .extra = &spore_needle_parameters,
     .extra_offset = offsetof(SporeNeedleToolFields, needle)},
    {"camera", N_("Camera"), N_("A view of the scene."), TABLE(camera_parameters, SporeCameraFields)},
    {"devices", N_("Devices"), N_("Where input comes from."), .children = CHILDREN("mouse", "track")},
    {"mouse", N_("Mouse"), N_("The pointer on the screen."), TABLE(mouse_parameters, SporeMouseFields)},
    {"track", N_("Track"), N_("Recorded input, played back."), TABLE(track_parameters, SporeTrackFields)},
    {"exercise", N_("Exercise"), N_("What the trainee is asked to do.")},
};
const size_t spore_scene_element_count = G_N_ELEMENTS(spore_scene_elements);
