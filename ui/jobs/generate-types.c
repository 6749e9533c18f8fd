/* How the results of generators are measured, coloured and drawn: a section for each kind of result, and the table. */
#include "ui/jobs/generate-types.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generated_edits.h"
#include "core/author/label_surroundings.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/mesh/bvh.h"
#include "core/scene/generated.h"

/* What several kinds share. */

/* The absolute values of every stride-th value, times scale; g_free. */
static double *scaled(const double *values, gsize count, gsize stride, double scale) {
  double *copy = g_new(double, count);
  for (gsize i = 0; i < count; i++) copy[i] = scale * fabs(values[stride * i]);
  return copy;
}

/* Copies a surface into a candidate, with a place on the scale for each vertex (taken). */
static void show_surface(const SporeTriangleMesh *mesh, float *places, SporeStageCandidate *candidate) {
  candidate->vertex_count = mesh->vertex_count;
  candidate->triangle_count = mesh->triangle_count;
  candidate->vertices = g_memdup2(mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  candidate->triangles = g_memdup2(mesh->triangles, 3 * mesh->triangle_count * sizeof(guint32));
  candidate->vertex_values = places;
}

static void show_spheres(const SporeSphereSet *set, float *places, SporeStageCandidate *candidate) {
  candidate->sphere_count = set->count;
  candidate->spheres = g_memdup2(set->spheres, 4 * set->count * sizeof(double));
  spore_spheres_radii(set, candidate->spheres + 3, 4);
  candidate->sphere_values = places;
}

/* count triangles of three corners each (count x 3 x 3, m) with one place on the scale for each triangle; takes both.
 */
static void show_triangles(double *corners, gsize count, float *places, SporeStageCandidate *candidate) {
  candidate->vertex_count = 3 * count;
  candidate->triangle_count = count;
  candidate->vertices = corners;
  candidate->triangles = g_new(guint32, 3 * count);
  candidate->vertex_values = g_new(float, 3 * count);
  for (gsize i = 0; i < 3 * count; i++) {
    candidate->triangles[i] = (guint32)i;
    candidate->vertex_values[i] = places[i / 3];
  }
  g_free(places);
}

/* The outside of cells, as the candidate's view cuts them open. Each face has the colour of its cell. */
static void show_cells(const SporeTetrahedralMesh *mesh, float *places, SporeStageCandidate *candidate) {
  SporeCellFaces faces;
  if (spore_cell_faces(mesh, &candidate->view, &faces, NULL)) {
    float *of_faces = g_new(float, faces.triangle_count);
    for (gsize i = 0; i < faces.triangle_count; i++) of_faces[i] = places[faces.cells[i]];
    double *corners = g_memdup2(faces.vertices, 9 * faces.triangle_count * sizeof(double));
    show_triangles(corners, faces.triangle_count, of_faces, candidate);
  }
  spore_cell_faces_clear(&faces);
  g_free(places);
}

/* Sphere sets from a surface. */

static void show_sphere_set(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_spheres(&work->spheres, places, candidate);
}

static void show_mesh(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_surface(&work->mesh, places, candidate);
}

static void measure_distance_of_spheres(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeSpheresQuality *found = &work->spheres_quality;
  quality->count = found->vertex_count;
  quality->values = scaled(found->distance, quality->count, 1, 1e3);
  quality->weights = g_memdup2(found->area, quality->count * sizeof(double));
}

static void measure_outside(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = scaled(work->spheres_quality.outside, quality->count, 1, 100);
}

static void measure_depth(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = scaled(work->spheres_quality.depth_error, quality->count, 1, 1e3);
}

static void measure_radius_of_spheres(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres.count;
  quality->values = scaled(work->spheres.spheres + 3, quality->count, 4, 1e3);
}

static const SporeGenerateQuality spheres_qualities[] = {
    {N_("Surface distance"), "mm", FALSE, measure_distance_of_spheres, show_mesh},
    {N_("Outside share"), "%", FALSE, measure_outside, show_sphere_set},
    {N_("Depth error"), "mm", FALSE, measure_depth, show_sphere_set},
    {N_("Radius"), "mm", FALSE, measure_radius_of_spheres, show_sphere_set},
};

static const SporeGenerateType spheres_type = {
    .shows = "spheres",
    .counts = (const size_t[]){8, 16, 32, 64, 128, 256, 512, 0},
    .error_label = N_("Depth error"),
    .worth = 1,
    .qualities = spheres_qualities,
    .quality_count = G_N_ELEMENTS(spheres_qualities),
};

/* Tetrahedra in a surface. */

static void measure_cells(const SporeGenerateWork *work, SporeQuality *quality,
                          double (*figure)(const SporeTetrahedraQuality *found)) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) {
    SporeTetrahedralMesh one = {work->tetrahedra.vertex_count, 1, work->tetrahedra.vertices,
                                work->tetrahedra.tetrahedra + 4 * i};
    SporeTetrahedraQuality found;
    spore_tetrahedral_mesh_quality(&one, &found);
    quality->values[i] = figure(&found);
  }
}

static double angle(const SporeTetrahedraQuality *found) { return found->min_dihedral_deg; }
static double radius_ratio(const SporeTetrahedraQuality *found) { return found->worst_radius_ratio; }
static double volume(const SporeTetrahedraQuality *found) { return 1e9 * found->volume; }

/* Least angle between faces of each tetrahedron, degrees. */
static void measure_dihedral_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, angle);
}
static void measure_ratios(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, radius_ratio);
}
static void measure_volumes(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, volume);
}

/* Faces between organs are inside, and seen where the mesh is cut open. */
static void show_tetrahedra(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_cells(&work->tetrahedra, places, candidate);
}

static const SporeGenerateQuality tetrahedra_qualities[] = {
    {N_("Least angle"), "°", FALSE, measure_dihedral_angles, show_tetrahedra},
    {N_("Radius ratio"), "", FALSE, measure_ratios, show_tetrahedra},
    {N_("Volume"), "mm³", FALSE, measure_volumes, show_tetrahedra},
};

static const SporeGenerateType tetrahedra_type = {
    .shows = "tetrahedra",
    .counts = (const size_t[]){300, 600, 1200, 2500, 5000, 10000, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .cells = TRUE,
    .qualities = tetrahedra_qualities,
    .quality_count = G_N_ELEMENTS(tetrahedra_qualities),
};

/* The middle line of a tubular organ. */

static SporeVec3 point(const SporeCurve *curve, gsize i) { return spore_vec3_load(curve->points + 4 * i); }

/* Each point stands for half of the line to either side of it. */
static void measure_radius_of_curve(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = scaled(curve->points + 3, quality->count, 4, 1e3);
  quality->weights = g_new0(double, quality->count);
  for (gsize i = 0; i + 1 < curve->count; i++) {
    double half = 0.5 * spore_vec3_distance(point(curve, i), point(curve, i + 1));
    quality->weights[i] += half;
    quality->weights[i + 1] += half;
  }
}

/* The angle by which the line turns at each point. */
static void measure_bend(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = g_new0(double, quality->count);
  for (gsize i = 1; i + 1 < curve->count; i++) {
    SporeVec3 before = spore_vec3_sub(point(curve, i), point(curve, i - 1));
    SporeVec3 after = spore_vec3_sub(point(curve, i + 1), point(curve, i));
    double across = spore_vec3_length(spore_vec3_cross(before, after)), along = spore_vec3_dot(before, after);
    quality->values[i] = 180 / G_PI * atan2(across, along);
  }
}

static void draw(const SporeCurve *curve, double *lines) {
  for (gsize i = 0; i + 1 < curve->count; i++) {
    spore_vec3_store(lines + 6 * i, point(curve, i));
    spore_vec3_store(lines + 6 * i + 3, point(curve, i + 1));
  }
}

/* The line and, of an intestine, the root of its mesentery. */
static void show_curve(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  const SporeSphereSet balls = {.count = work->curve.count, .spheres = work->curve.points};
  show_spheres(&balls, places, candidate);
  gboolean rooted = work->options.purpose == SPORE_CENTRELINE_INTESTINE + 1 && work->root.count > 0;
  gsize root_count = rooted ? work->root.count - 1 : 0;
  candidate->line_count = work->curve.count - 1 + root_count;
  candidate->lines = g_new(double, 6 * candidate->line_count);
  draw(&work->curve, candidate->lines);
  if (rooted) draw(&work->root, candidate->lines + 6 * (work->curve.count - 1));
}

/* What the line does not follow is far from it. */
static void measure_way_to_curve(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->mesh.vertex_count;
  quality->values = scaled(work->curve_way, quality->count, 1, 1e3);
}

static const SporeGenerateQuality curve_qualities[] = {
    {N_("Radius"), "mm", FALSE, measure_radius_of_curve, show_curve},
    {N_("Bend"), "°", FALSE, measure_bend, show_curve},
    {N_("Way to the line"), "mm", FALSE, measure_way_to_curve, show_mesh},
};

static const SporeGenerateType curve_type = {
    .shows = "curve",
    .qualities = curve_qualities,
    .quality_count = G_N_ELEMENTS(curve_qualities),
};

/* A surface of fewer, well-shaped triangles, and hollow organs with a wall. */

/* Adds the edges of a mesh, drawn over the coloured surface. Other lines are added after all edges. */
static void show_edges(const SporeTriangleMesh *mesh, SporeStageCandidate *candidate) {
  gsize before = candidate->line_count;
  candidate->edge_count = candidate->line_count = before + 3 * mesh->triangle_count;
  candidate->lines = g_renew(double, candidate->lines, 6 * candidate->line_count);
  for (gsize h = 0; h < 3 * mesh->triangle_count; h++) {
    const guint32 *corners = mesh->triangles + 3 * (h / 3);
    for (gsize k = 0; k < 2; k++)
      memcpy(candidate->lines + 6 * (before + h) + 3 * k, mesh->vertices + 3 * corners[(h + k) % 3],
             3 * sizeof(double));
  }
}

static void measure_distance_of_surface(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->mesh.vertex_count;
  quality->values = scaled(work->surface_distance, quality->count, 1, 1e3);
}

static void show_given_surface(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_surface(&work->mesh, places, candidate);
  show_edges(&work->surface, candidate);
}

static double least_angle(const SporeTriangleMesh *mesh, gsize t) {
  double least = 180;
  for (gsize k = 0; k < 3; k++) {
    SporeVec3 corner[3];
    for (gsize j = 0; j < 3; j++)
      corner[j] = spore_vec3_load(mesh->vertices + 3 * mesh->triangles[3 * t + (k + j) % 3]);
    SporeVec3 a = spore_vec3_sub(corner[1], corner[0]), b = spore_vec3_sub(corner[2], corner[0]);
    least = fmin(least, 180 / G_PI * atan2(spore_vec3_length(spore_vec3_cross(a, b)), spore_vec3_dot(a, b)));
  }
  return least;
}

static void measure_triangle_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->surface.triangle_count;
  quality->values = g_new(double, quality->count);
  for (gsize t = 0; t < quality->count; t++) quality->values[t] = least_angle(&work->surface, t);
}

static void show_made_surface(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  const SporeTriangleMesh *mesh = &work->surface;
  double *corners = g_new(double, 9 * mesh->triangle_count);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++)
    memcpy(corners + 3 * i, mesh->vertices + 3 * (gsize)mesh->triangles[i], 3 * sizeof(double));
  show_triangles(corners, mesh->triangle_count, places, candidate);
  show_edges(mesh, candidate);
}

static const SporeGenerateQuality surface_qualities[] = {
    {N_("Surface distance"), "mm", FALSE, measure_distance_of_surface, show_given_surface},
    {N_("Least angle"), "°", FALSE, measure_triangle_angles, show_made_surface},
};

static const SporeGenerateType surface_type = {
    .shows = "surface",
    .counts = (const size_t[]){50, 100, 200, 400, 800, 1600, 3200, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .qualities = surface_qualities,
    .quality_count = G_N_ELEMENTS(surface_qualities),
};

/* Spline sheets: the patch by its distance, among the edges of the organ. */

static void measure_distance_of_sheet(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->surface.vertex_count;
  quality->values = scaled(work->surface_distance, quality->count, 1, 1e3);
}

/* The ends of side h % 3 of triangle h / 3, in turn or against it. */
static guint64 side_key(const SporeTriangleMesh *mesh, gsize h, gboolean against) {
  guint64 from = mesh->triangles[h], to = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
  return against ? to << 32 | from : from << 32 | to;
}

/* Adds the sides that have a triangle on one side alone. */
static void add_border(const SporeTriangleMesh *mesh, SporeStageCandidate *candidate) {
  g_autoptr(GHashTable) sides = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  for (gsize h = 0; h < 3 * mesh->triangle_count; h++) {
    const guint64 key = side_key(mesh, h, FALSE);
    g_hash_table_add(sides, g_memdup2(&key, sizeof key));
  }
  candidate->lines = g_renew(double, candidate->lines, 6 * (candidate->line_count + 3 * mesh->triangle_count));
  for (gsize h = 0; h < 3 * mesh->triangle_count; h++) {
    const guint64 key = side_key(mesh, h, TRUE);
    if (g_hash_table_contains(sides, &key)) continue;
    double *line = candidate->lines + 6 * candidate->line_count++;
    memcpy(line, mesh->vertices + 3 * (key & G_MAXUINT32), 3 * sizeof *line);
    memcpy(line + 3, mesh->vertices + 3 * (key >> 32), 3 * sizeof *line);
  }
}

static void show_patch(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_surface(&work->surface, places, candidate);
  show_edges(&work->mesh, candidate);
  add_border(&work->surface, candidate);
}

static const SporeGenerateQuality sheet_qualities[] = {
    {N_("Distance from the sheet"), "mm", FALSE, measure_distance_of_sheet, show_patch},
};

static const SporeGenerateType sheet_type = {
    .shows = "sheet",
    .counts = (const size_t[]){6, 8, 12, 16, 24, 32, 48, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .qualities = sheet_qualities,
    .quality_count = G_N_ELEMENTS(sheet_qualities),
};

/* Tetrahedra of all organs of a label map. */

static const SporeLabelFigures *figures_of(const SporeGenerateWork *work, guint i) {
  return &g_array_index(work->label_report.labels, SporeLabelFigures, i);
}

/* Place of a label in the report. */
static guint place_of(const SporeGenerateWork *work, guint32 label) {
  guint i = 0;
  while (i + 1 < work->label_report.labels->len && figures_of(work, i)->label != label) i++;
  return i;
}

static void measure_organs(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) quality->values[i] = place_of(work, work->tetrahedra.labels[i]) + 1;
}

/* The soft organs, among the edges of what stands around them. */
static void show_organs(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  show_tetrahedra(work, places, candidate);
  for (guint i = 0; work->surroundings && i < work->surroundings->len; i++)
    show_edges(&g_array_index(work->surroundings, SporeLabelSurrounding, i).surface.mesh, candidate);
}

static const SporeGenerateQuality labels_qualities[] = {
    {N_("Organ"), "", TRUE, measure_organs, show_organs},
    {N_("Least angle"), "°", FALSE, measure_dihedral_angles, show_organs},
};

static const SporeGenerateType labels_type = {
    .shows = "labels",
    .cells = TRUE,
    .qualities = labels_qualities,
    .quality_count = G_N_ELEMENTS(labels_qualities),
};

/* The table. */

const SporeGenerateType *spore_generate_type(SporeGenerateKind kind) {
  static const SporeGenerateType *const types[] = {&spheres_type, &tetrahedra_type, &curve_type,
                                                   &surface_type, &sheet_type,      &labels_type};
  gsize i = 0;
  while (i + 1 < G_N_ELEMENTS(types) && strcmp(types[i]->shows, spore_generators[kind]->shows) != 0) i++;
  return types[i];
}
