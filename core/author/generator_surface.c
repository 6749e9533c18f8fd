/* The generator of surfaces and walls, and the attributes of <mesh>: its options, and those of sheets. */
#include "core/author/generator.h"

#include <math.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/base/memory.h"
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
    {.name = "first_corner",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeMeshFields, first_corner),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Place on the surface that is the first corner of a spline sheet; all four corners the same: the sheet "
               "finds its own.")},
    {.name = "second_corner",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeMeshFields, second_corner),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Corner that comes after the first one around the sheet.")},
    {.name = "third_corner",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeMeshFields, third_corner),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Corner opposite to the first one.")},
    {.name = "fourth_corner",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeMeshFields, fourth_corner),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Corner opposite to the second one.")},
    {.name = "inside",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeMeshFields, inside),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Place on the part between the corners that becomes the sheet; 0 0 0: the smaller part, or the one that "
               "is whole.")},
    {.name = "control_points",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     SPORE_SHEET_MOST_POINTS,
     .initial = {12},
     FIELD(SporeMeshFields, control_points),
     .change = SPORE_CHANGE_LIVE,
     .doc =
         N_("Number of control points along the longer sides of the sheet, with as many across as their distance asks "
            "for; 0: as few as the tolerance takes.")},
    {.name = "tolerance",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     FIELD(SporeMeshFields, tolerance),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Distance that the sheet may have from the surface, where the number of control points is 0.")},
    {.name = "smoothing",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     FIELD(SporeMeshFields, smoothing),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Length of waves of the surface that the sheet follows to half their height, and shorter waves to less; "
               "0: none are smoothed.")},
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

static const char *const options_taken[] = {"nodes", "size", "keep_angle", "wall", "wall_detail", NULL};
static const char *const uses[] = {"model", "visual_mesh", "asset", NULL}; /* as SporeSurfaceUse */
static const SporeParameter purpose = SPORE_GENERATOR_PURPOSE(
    uses, N_("What Apply makes: what the body's model is built from, the mesh that the body shows and generators start "
             "from (a wall, to be filled with tetrahedra), or an asset alone."));

static bool make_wall(SporeGenerateWork *work, const SporeProgress *progress, SporeError *failure) {
  SporeTriangleMesh outer = work->surface, inner = {0};
  work->surface = (SporeTriangleMesh){0};
  const SporeMeshFields *fields = &work->options.fields.surface;
  bool done = spore_wall_inner(&outer, fields->wall, (double)fields->wall_detail, &inner, &work->wall_report, progress,
                               failure) &&
              spore_wall_solid(&outer, &inner, &work->surface, failure);
  work->wall_report.seconds *= done;
  spore_triangle_mesh_clear(&outer);
  spore_triangle_mesh_clear(&inner);
  return done;
}

/* Measures the distance of each vertex of the given mesh from the result. */
static bool measure(SporeGenerateWork *work, SporeError *failure) {
  work->surface_distance = SPORE_NEW_ARRAY(double, work->mesh.vertex_count);
  if (!work->surface_distance) return spore_error_set(failure, SPORE_ERROR_MEMORY, NULL, "%s", _("not enough memory"));
  SporeBvh *bvh = spore_bvh_create(&work->surface, failure);
  if (!bvh) return false;
  for (gsize i = 0; i < work->mesh.vertex_count; i++)
    work->surface_distance[i] = spore_bvh_distance(bvh, spore_vec3_load(work->mesh.vertices + 3 * i), NULL, NULL);
  spore_bvh_free(bvh);
  return true;
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSimplifyOptions options = spore_edit_surface_options(&work->options.fields.surface);
  gboolean thin = options.vertices > 0 || options.size > 0, wall = work->options.fields.surface.wall > 0;
  if (!thin && !wall)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->source,
                             _("nothing is asked for; expected a number of nodes, a size or a wall; give one of them"));
  bool done =
      thin ? spore_surface_from_mesh(&work->mesh, &options, &work->surface, &work->surface_report, progress, &failure)
           : spore_triangle_mesh_copy(&work->surface, &work->mesh, &failure);
  done = done && measure(work, &failure) && (!wall || make_wall(work, progress, &failure));
  if (done) return TRUE;
  spore_error_at(&failure, work->source);
  return spore_error_propagate(&failure, error);
}

static gboolean error_of(const SporeGenerateWork *work, size_t count, double *error_percent,
                         const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSimplifyOptions options = spore_edit_surface_options(&work->options.fields.surface);
  SporeTriangleMesh surface = {0};
  SporeSurfaceReport report;
  options.vertices = count;
  if (!spore_surface_from_mesh(&work->mesh, &options, &surface, &report, progress, &failure))
    return spore_error_propagate(&failure, error);
  spore_triangle_mesh_clear(&surface);
  *error_percent = 100 * report.hausdorff;
  return TRUE;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = spore_generate_work_from(work);
  return spore_edit_use_surface(document, body, &from, &work->surface, (SporeSurfaceUse)work->options.purpose, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeSurfaceReport *report = &work->surface_report;
  const SporeWallReport *wall = &work->wall_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu nodes, %zu triangles in %.1f s"), work->surface.vertex_count,
                         work->surface.triangle_count, report->seconds + wall->seconds);
  if (report->mean_angle_deg > 0)
    g_string_append_printf(text, _("\nDistance %.2f %%, edges %.2f mm\nLeast angle %.1f°, mean %.1f°"),
                           100 * report->hausdorff, 1e3 * report->edge_mean, report->min_angle_deg,
                           report->mean_angle_deg);
  if (wall->wall_volume > 0)
    g_string_append_printf(text,
                           _("\nWall %.2f mm (%.2f to %.2f), off by %.1f %%, %.3g ml\nLumen %.3g ml, pieces: %zu"),
                           1e3 * wall->thickness_mean, 1e3 * wall->thickness_min, 1e3 * wall->thickness_max,
                           100 * wall->error, 1e6 * wall->wall_volume, 1e6 * wall->lumen_volume, wall->pieces);
  return g_string_free(text, FALSE);
}

const SporeGeneratorType spore_generator_surface = {
    .name = "surface",
    .command = "surface",
    .element = "mesh",
    .elements = elements,
    .only = options_taken,
    .count = "nodes",
    .ways = "nodes | size",
    .purpose = &purpose,
    .target = spore_edit_body_surface,
    .shows = "surface",
    .title = N_("Surface of %s"),
    .working = N_("Generating a surface"),
    .count_label = N_("Nodes"),
    .unit = "mechanical",
    .offer = N_("Nodes of a surface"),
    .error_of = error_of,
    .run = run,
    .apply = apply,
    .facts = facts,
};
