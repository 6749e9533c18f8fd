/* Parts of a drawing as triangles. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/drawing_private.h"

#define TUBE_SECTORS 16
#define BALL_RINGS 8
#define BALL_SECTORS 12

/* Copies the triangles with the vertices that they use, in their order. *points: which these are, g_free. */
static bool copy_used(const double *positions, gsize count, const guint32 *triangles, gsize triangle_count,
                      SporeTriangleMesh *mesh, guint32 **points, SporeError *fault) {
  g_autofree guint32 *number = g_new0(guint32, count + 1);
  gsize used = 0;
  for (gsize i = 0; i < 3 * triangle_count; i++) number[triangles[i]] = 1;
  for (gsize i = 0; i < count; i++) used += number[i];
  *mesh = (SporeTriangleMesh){0};
  if (!used) return true;
  if (!spore_triangle_mesh_allocate(mesh, used, triangle_count, fault)) return false;
  *points = g_new(guint32, used);
  used = 0;
  for (gsize i = 0; i < count; i++) {
    if (!number[i]) continue;
    memcpy(mesh->vertices + 3 * used, positions + 3 * i, 3 * sizeof *positions);
    (*points)[used] = (guint32)i;
    number[i] = (guint32)used++;
  }
  for (gsize i = 0; i < 3 * triangle_count; i++) mesh->triangles[i] = number[triangles[i]];
  return true;
}

static bool boundary_of(const SporeDrawnPart *part, const double *positions, SporeTriangleMesh *mesh, guint32 **points,
                        SporeError *fault) {
  const SporeTetrahedralMesh cells = {.vertex_count = part->count,
                                      .tetrahedron_count = part->element_count,
                                      .vertices = (double *)positions,
                                      .tetrahedra = part->elements};
  uint32_t *triangles = NULL;
  gsize count = 0;
  bool done = spore_tetrahedral_mesh_boundary(&cells, &triangles, &count);
  if (!done) spore_error_set(fault, SPORE_ERROR_MEMORY, NULL, _("not enough memory for its drawn vertices"));
  done = done && copy_used(positions, part->count, triangles, count, mesh, points, fault);
  spore_free(triangles);
  return done;
}

static bool tube_of(const SporeDrawnPart *part, const double *positions, SporeTriangleMesh *mesh, SporeError *fault) {
  g_autofree double *rows = g_new(double, 4 * part->count);
  for (gsize i = 0; i < part->count; i++) {
    memcpy(rows + 4 * i, positions + 3 * i, 3 * sizeof *rows);
    rows[4 * i + 3] = part->radii[i];
  }
  const SporeCurve curve = {part->count, rows};
  return spore_curve_tube(&curve, TUBE_SECTORS, mesh, fault);
}

/* Adds a ball of rings of triangles between two poles, outward. */
static void add_ball(SporeTriangleMesh *mesh, const double *centre, double radius, guint32 first, guint32 *triangle) {
  double *vertex = mesh->vertices + 3 * (gsize)first;
  guint32 last = first + 1 + (BALL_RINGS - 1) * BALL_SECTORS;
  SporeVec3 middle = spore_vec3_load(centre);
  spore_vec3_store(vertex, spore_vec3_add(middle, spore_vec3(0, radius, 0)));
  spore_vec3_store(mesh->vertices + 3 * (gsize)last, spore_vec3_add(middle, spore_vec3(0, -radius, 0)));
  for (guint32 ring = 1; ring < BALL_RINGS; ring++)
    for (guint32 k = 0; k < BALL_SECTORS; k++) {
      double polar = G_PI * ring / BALL_RINGS, turn = 2 * G_PI * k / BALL_SECTORS;
      SporeVec3 way = {sin(polar) * cos(turn), cos(polar), sin(polar) * sin(turn)};
      spore_vec3_store(vertex += 3, spore_vec3_add(middle, spore_vec3_scale(radius, way)));
    }
  for (guint32 k = 0; k < BALL_SECTORS; k++) {
    guint32 next = (k + 1) % BALL_SECTORS, below = last - BALL_SECTORS;
    const guint32 poles[] = {first, first + 1 + next, first + 1 + k, last, below + k, below + next};
    memcpy(triangle, poles, sizeof poles);
    triangle += 6;
    for (guint32 ring = first + 1; ring < below; ring += BALL_SECTORS) {
      guint32 under = ring + BALL_SECTORS;
      const guint32 both[] = {ring + k, ring + next, under + k, ring + next, under + next, under + k};
      memcpy(triangle, both, sizeof both);
      triangle += 6;
    }
  }
}

static bool balls_of(const SporeDrawnPart *part, const double *positions, SporeTriangleMesh *mesh, SporeError *fault) {
  const gsize vertices = 2 + (BALL_RINGS - 1) * BALL_SECTORS, triangles = 2 * (BALL_RINGS - 1) * BALL_SECTORS;
  *mesh = (SporeTriangleMesh){0};
  if (!part->count) return true;
  if (!spore_triangle_mesh_allocate(mesh, vertices * part->count, triangles * part->count, fault)) return false;
  for (gsize i = 0; i < part->count; i++)
    add_ball(mesh, positions + 3 * i, part->radii[i], (guint32)(vertices * i), mesh->triangles + 3 * triangles * i);
  return true;
}

static gboolean make_mesh(const SporeDrawnPart *part, const double *positions, SporeTriangleMesh *mesh,
                          guint32 **points, GError **error) {
  *points = NULL;
  SporeError fault = SPORE_ERROR_INIT;
  bool done = false;
  switch (part->kind) {
  case SPORE_PART_SURFACE:
    done = copy_used(positions, part->count, part->elements, part->element_count, mesh, points, &fault);
    break;
  case SPORE_PART_CELLS:
    done = boundary_of(part, positions, mesh, points, &fault);
    break;
  case SPORE_PART_LINE:
    done = tube_of(part, positions, mesh, &fault);
    break;
  case SPORE_PART_POINTS:
    done = part->liquid ? spore_particle_skin(positions, part->count,
                                              part->count ? 2 * SPORE_LIQUID_SPACING * part->radii[0] : 0, mesh, &fault)
                        : balls_of(part, positions, mesh, &fault);
    break;
  }
  return done || spore_drawn_part_refuse(part, &fault, error);
}

gboolean spore_drawn_part_mesh_of_points(const SporeDrawnPart *part, SporeTriangleMesh *mesh, guint32 **points,
                                         GError **error) {
  return make_mesh(part, part->positions, mesh, points, error);
}

gboolean spore_drawn_part_mesh(const SporeDrawnPart *part, SporeTriangleMesh *mesh, GError **error) {
  g_autofree guint32 *points = NULL;
  return make_mesh(part, part->positions, mesh, &points, error);
}

gboolean spore_drawn_part_local_mesh(const SporeDrawnPart *part, SporeTriangleMesh *mesh, GError **error) {
  g_autofree guint32 *points = NULL;
  g_assert(part->framed);
  return make_mesh(part, part->source->points, mesh, &points, error);
}
