/* Regions of bodies and generated assets: added, placed, removed and drawn. */
#include "core/author/region_edits.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/mesh/common.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/body/region.h"
#include "core/scene/region.h"

#define PART 0.125 /* of the diagonal: radius of a new region */
#define LEAST_M 1e-4
#define RING_SEGMENTS 48
#define CROSS_PART 0.3 /* of a dab's radius: half of its cross */
#define NOTHING_M 1e-7 /* smaller differences are rounding */

static gboolean set_numbers(SporeDocument *document, SporeObject *object, const char *property, const double *numbers,
                            gsize count, GError **error) {
  g_autoptr(GString) text = g_string_new(NULL);
  for (gsize i = 0; i < count; i++) {
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_formatd(number, sizeof number, "%.4g", fabs(numbers[i]) < NOTHING_M ? 0 : numbers[i]);
    g_string_append_printf(text, i ? " %s" : "%s", number);
  }
  return spore_document_set_text(document, object, property, text->str, error);
}

static gboolean set_ball(SporeDocument *document, SporeObject *region, const double centre[3], double radius,
                         GError **error) {
  return set_numbers(document, region, "centre", centre, 3, error) &&
         set_numbers(document, region, "radius", &radius, 1, error);
}

/* Points of an organ, `stride` doubles apart. */
typedef struct Points {
  const double *first;
  gsize count, stride;
} Points;

static SporeVec3 nearest(const Points *points, SporeVec3 place) {
  SporeVec3 best = place;
  double least = HUGE_VAL;
  for (gsize i = 0; i < points->count; i++) {
    SporeVec3 p = spore_vec3_load(points->first + points->stride * i);
    double distance = spore_vec3_distance(p, place);
    if (distance < least) least = distance, best = p;
  }
  return best;
}

/* Middles of cells; g_free. */
static double *middles_of(const SporeTetrahedralMesh *cells) {
  double *middles = g_new0(double, 3 * cells->tetrahedron_count);
  for (gsize i = 0; i < 12 * cells->tetrahedron_count; i++)
    middles[3 * (i / 12) + i % 3] += 0.25 * cells->vertices[3 * cells->tetrahedra[i / 3] + i % 3];
  return middles;
}

/* A point of the organ near its middle, in its frame. The middle of the box of a bent organ may lie outside of the
 * organ. */
static gboolean find_middle(SporeDocument *document, SporeObject *body, SporeObject *holder, SporeVec3 *middle,
                            double *radius, GError **error) {
  gboolean of_spheres = g_str_equal(spore_object_type(holder)->element, "spheres");
  SporeObject *asset = of_spheres ? holder : spore_edit_body_tetrahedra(document, body);
  const SporeSphereSet *set = of_spheres ? spore_document_spheres(document, asset, error) : NULL;
  if (of_spheres && !set) return FALSE;
  const SporeTetrahedralMesh *cells = asset && !set ? spore_document_tetrahedra(document, asset, NULL) : NULL;
  SporeObject *visual = set || cells ? NULL : spore_edit_visual_mesh(document, body, error);
  const SporeTriangleMesh *mesh = visual ? spore_document_mesh(document, visual, error) : NULL;
  if (!set && !cells && !mesh) return FALSE;
  g_autofree double *middles = cells ? middles_of(cells) : NULL;
  Points points = set     ? (Points){set->spheres, set->count, 4}
                  : cells ? (Points){middles, cells->tetrahedron_count, 3}
                          : (Points){mesh->vertices, mesh->vertex_count, 3};
  double lower[3], upper[3], box[3];
  double diagonal = cells ? spore_mesh_bounds(cells->vertices, cells->vertex_count, 3, lower, upper)
                          : spore_mesh_bounds(points.first, points.count, points.stride, lower, upper);
  for (int i = 0; i < 3; i++) box[i] = 0.5 * (lower[i] + upper[i]);
  *middle = mesh ? spore_vec3_load(box) : nearest(&points, spore_vec3_load(box));
  *radius = fmax(PART * diagonal, LEAST_M);
  return TRUE;
}

/* Sets the size of a new region of finer cells to half the present edge length. Other regions have no size. */
static gboolean set_size(SporeDocument *document, SporeObject *region, GError **error) {
  if (spore_parameter_find(spore_object_type(region)->table, "size") < 0) return TRUE;
  const SporeTetrahedralMesh *cells = spore_document_tetrahedra(document, spore_object_parent(region), NULL);
  if (!cells || !cells->tetrahedron_count) return TRUE;
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(cells, &quality);
  double half =
      0.5 * cbrt(6 * sqrt(2) * quality.volume /
                 (double)cells->tetrahedron_count); /* edge length of regular tetrahedra of that mean volume, halved */
  return !(half > 0) || set_numbers(document, region, "size", &half, 1, error);
}

/* name: NULL: a free one. */
static SporeObject *insert_region(SporeDocument *document, const char *path, const char *name, GError **error) {
  SporeObject *holder = spore_edit_object_or_unit(document, path, error);
  if (!holder) return NULL;
  const char *element = spore_region_element(spore_object_type(holder));
  if (element) return spore_document_insert(document, holder, element, name ? name : "region", G_MAXUINT, error);
  spore_error_raise(error, SPORE_ERROR_INPUT, path,
                    _("it has no regions; expected the regions of a body, spheres or tetrahedra; name one of those"));
  return NULL;
}

static SporeObject *add_region(SporeDocument *document, SporeObject *body, const char *path, GError **error) {
  double centre[3], radius;
  SporeVec3 middle;
  SporeObject *region = insert_region(document, path, NULL, error);
  if (!region || !find_middle(document, body, spore_object_parent(region), &middle, &radius, error)) return NULL;
  spore_vec3_store(centre, middle);
  return set_ball(document, region, centre, radius, error) && set_size(document, region, error) ? region : NULL;
}

SporeObject *spore_edit_add_region(SporeDocument *document, SporeObject *body, const char *holder, GError **error) {
  spore_document_begin(document, _("Add region"));
  SporeObject *region = add_region(document, body, holder, error);
  return spore_edit_finish(document, region != NULL) ? region : NULL;
}

/* Painting. */

static gboolean remove_dabs(SporeDocument *document, SporeObject *region, GError **error) {
  for (guint i = spore_object_child_count(region); i-- > 0;)
    if (!spore_document_remove(document, spore_object_child(region, i), error)) return FALSE;
  return TRUE;
}

static gboolean set_balls(SporeDocument *document, SporeObject *region, const double *balls, gsize count,
                          GError **error) {
  if (!remove_dabs(document, region, error) || !set_ball(document, region, balls, balls[3], error)) return FALSE;
  for (gsize i = 1; i < count; i++) {
    SporeObject *dab = spore_document_insert(document, region, "dab", NULL, G_MAXUINT, error);
    if (!dab || !set_ball(document, dab, balls + 4 * i, balls[4 * i + 3], error)) return FALSE;
  }
  return spore_region_check_balls(region, error);
}

gboolean spore_edit_paint_region(SporeDocument *document, SporeObject *region, const double *balls, gsize count,
                                 GError **error) {
  spore_document_begin(document, _("Paint region"));
  return spore_edit_finish(document, set_balls(document, region, balls, count, error));
}

SporeObject *spore_edit_add_painted_region(SporeDocument *document, const char *holder, const char *name,
                                           const double *balls, gsize count, GError **error) {
  spore_document_begin(document, _("Paint region"));
  SporeObject *region = insert_region(document, holder, name, error);
  gboolean done = region && set_balls(document, region, balls, count, error) && set_size(document, region, error);
  return spore_edit_finish(document, done) ? region : NULL;
}

static gboolean remove_region(SporeDocument *document, SporeObject *region, GError **error) {
  SporeObject *holder = spore_object_parent(region);
  gboolean unit = !spore_object_name(holder); /* `regions` of a body, not an asset */
  return spore_document_remove(document, region, error) &&
         (!unit || spore_object_child_count(holder) || spore_document_remove(document, holder, error));
}

gboolean spore_region_is(const SporeObject *object) {
  SporeObject *holder = spore_object_parent(object);
  const char *element = holder ? spore_region_element(spore_object_type(holder)) : NULL;
  return element && strcmp(spore_object_type(object)->element, element) == 0;
}

gboolean spore_region_is_dab(const SporeObject *object) {
  SporeObject *holder = spore_object_parent(object);
  return holder && spore_region_is(holder);
}

SporeObject *spore_edit_find_region(SporeDocument *document, const char *path, GError **error) {
  SporeObject *region = spore_document_by_path(document, path);
  if (region && spore_region_is(region)) return region;
  spore_error_raise(error, SPORE_ERROR_INPUT, path, _("there is no such region; choose one of the list"));
  return NULL;
}

gboolean spore_edit_remove_region(SporeDocument *document, const char *path, GError **error) {
  SporeObject *region = spore_edit_find_region(document, path, error);
  if (!region) return FALSE;
  spore_document_begin(document, _("Delete region"));
  return spore_edit_finish(document, remove_region(document, region, error));
}

gboolean spore_edit_place_region(SporeDocument *document, SporeObject *region, const double centre[3], double radius,
                                 GError **error) {
  spore_document_begin(document, _("Place region"));
  return spore_edit_finish(document, set_ball(document, region, centre, radius, error));
}

static void add_segment(GArray *segments, SporeVec3 from, SporeVec3 to) {
  double segment[6];
  spore_vec3_store(segment, from);
  spore_vec3_store(segment + 3, to);
  g_array_append_val(segments, segment);
}

static SporeVec3 along(SporeVec3 centre, int axis, double way) {
  double place[3];
  spore_vec3_store(place, centre);
  place[axis % 3] += way;
  return spore_vec3_load(place);
}

static SporeVec3 on_ring(SporeVec3 centre, double radius, int axis, int step) {
  double angle = 2 * G_PI * step / RING_SEGMENTS;
  return along(along(centre, axis + 1, radius * cos(angle)), axis + 2, radius * sin(angle));
}

static void mark_ball(GArray *segments, const double ball[4], gboolean dab) {
  SporeVec3 centre = spore_vec3_load(ball);
  for (int axis = 0; axis < 3; axis++) {
    if (dab)
      add_segment(segments, along(centre, axis, -CROSS_PART * ball[3]), along(centre, axis, CROSS_PART * ball[3]));
    for (int i = 0; !dab && i < RING_SEGMENTS; i++)
      add_segment(segments, on_ring(centre, ball[3], axis, i), on_ring(centre, ball[3], axis, i + 1));
  }
}

double *spore_region_marks(const SporeObject *holder, gsize *count) {
  const char *element = spore_region_element(spore_object_type(holder));
  GArray *segments = g_array_new(FALSE, FALSE, 6 * sizeof(double));
  for (guint i = 0; element && i < spore_object_child_count(holder); i++) {
    const SporeObject *region = spore_object_child(holder, i);
    guint balls;
    g_autofree double *all = spore_region_balls(region, &balls);
    for (guint b = 0; b < balls; b++) mark_ball(segments, all + 4 * b, balls > 1);
  }
  *count = segments->len;
  return (double *)(void *)g_array_free(segments, FALSE);
}

/* Facts. */

/* The box around balls. */
static void bound_balls(const double *balls, guint count, double lower[3], double upper[3]) {
  for (int k = 0; k < 3; k++) {
    lower[k] = HUGE_VAL, upper[k] = -HUGE_VAL;
    for (guint b = 0; b < count; b++) {
      lower[k] = fmin(lower[k], balls[4 * b + k] - balls[4 * b + 3]);
      upper[k] = fmax(upper[k], balls[4 * b + k] + balls[4 * b + 3]);
    }
  }
}

/* Tetrahedra of the body that the region holds. FALSE: it is not a region of a body that has some. */
static gboolean count_cells(SporeDocument *document, const SporeObject *region, gsize *held, gsize *all) {
  SporeObject *body = spore_object_parent(spore_object_parent(region));
  gboolean of_body = body && g_str_equal(spore_object_type(body)->element, "body");
  SporeObject *asset = of_body ? spore_edit_body_tetrahedra(document, body) : NULL;
  const SporeTetrahedralMesh *cells = asset ? spore_document_tetrahedra(document, asset, NULL) : NULL;
  if (!cells) return FALSE;
  double lower[3], upper[3];
  guint count;
  g_autofree double *balls = spore_region_balls(region, &count), *middles = middles_of(cells);
  bound_balls(balls, count, lower, upper);
  *held = 0, *all = cells->tetrahedron_count;
  for (const double *m = middles; m < middles + 3 * *all; m += 3) {
    gboolean near = TRUE;
    for (int k = 0; k < 3; k++) near = near && m[k] > lower[k] && m[k] < upper[k];
    *held += near && spore_balls_hold(balls, count, spore_vec3_load(m));
  }
  return TRUE;
}

char *spore_region_facts(SporeDocument *document, const SporeObject *region) {
  gsize held, all;
  guint dabs = spore_object_child_count(region);
  g_autofree char *painted =
      dabs ? g_strdup_printf(ngettext("Painted with %u dab.", "Painted with %u dabs.", dabs), dabs) : NULL;
  if (!count_cells(document, region, &held, &all)) return g_steal_pointer(&painted);
  g_autofree char *holds = g_strdup_printf(_("Holds %zu of %zu tetrahedra."), held, all);
  return painted ? g_strdup_printf("%s %s", painted, holds) : g_steal_pointer(&holds);
}
