/* A middle line beside a known one, in the organ of both. Arguments: the organ's mesh (any format that is imported,
 * mm), the line that is known and the line that is judged (F.curve, m; radii are not read). Both are smoothed over one
 * local radius: the distance to the surface from the known line, after that was moved to the middle of the organ's
 * sections. The answer is JSON on a line: both lengths (m), the share of the known line within the local radius of the
 * other, and the mean distance, in local radii, of the moved known line from the other and from itself as it was. */
#include <glib.h>
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/generate/centreline/private.h"
#include "core/io/mesh_import.h"

#define MILLIMETRE 2 /* of spore_length_units */
#define SPACING 0.25 /* of points, in mean radii */
#define ROUNDS 6     /* of centring */
#define REACH 2.0    /* of a section, in radii */
#define RIM 2.0      /* radii at each end that are not centred: a cap has no sections */

static SporeVec3 at(const SporeCurve *line, size_t i) { return spore_vec3_load(line->points + 4 * i); }

static SporeCurve read_line(const char *file) {
  g_autofree char *text = NULL;
  gsize size;
  SporeCurve line;
  g_autoptr(GError) error = NULL;
  if (!g_file_get_contents(file, &text, &size, &error) || !spore_curve_parse(file, text, size, &line, &error))
    g_error("%s", error->message);
  return line;
}

/* Points evenly spaced, about `step` m apart; their radii are 0. */
static SporeCurve respaced(const SporeCurve *line, double step) {
  SporeCurve even;
  double whole = spore_curve_length(line), walked = 0;
  size_t gaps = (size_t)fmax(2, ceil(whole / step)), from = 0;
  g_assert_true(spore_curve_allocate(&even, gaps + 1, NULL));
  for (size_t i = 0; i <= gaps; i++) {
    double wanted = whole * (double)i / (double)gaps, piece;
    while (walked + (piece = spore_vec3_distance(at(line, from), at(line, from + 1))) < wanted &&
           from + 2 < line->count)
      walked += piece, from++;
    double part = fmin((wanted - walked) / piece, 1);
    SporeVec3 way = spore_vec3_sub(at(line, from + 1), at(line, from));
    spore_vec3_store(even.points + 4 * i, spore_vec3_add_scaled(at(line, from), part, way));
  }
  return even;
}

/* The mean over `width` (m) along the line, less at the ends, which stay. */
static void smooth(SporeCurve *line, const double *width) {
  g_autofree double *mean = g_new(double, 3 * line->count);
  double step = spore_curve_length(line) / (double)(line->count - 1);
  for (size_t i = 0; i < line->count; i++) {
    size_t half = MIN((size_t)lround(0.5 * width[i] / step), MIN(i, line->count - 1 - i));
    SporeVec3 sum = {0, 0, 0};
    for (size_t k = i - half; k <= i + half; k++) sum = spore_vec3_add(sum, at(line, k));
    spore_vec3_store(mean + 3 * i, spore_vec3_scale(1 / (2. * (double)half + 1), sum));
  }
  for (size_t i = 0; i < line->count; i++) spore_vec3_store(line->points + 4 * i, spore_vec3_load(mean + 3 * i));
}

static void set_radii(SporeCurve *line, const SporeSolid *solid) {
  for (size_t i = 0; i < line->count; i++) line->points[4 * i + 3] = spore_bvh_depth(solid->bvh, at(line, i));
}

static double mean_radius(const SporeCurve *line) {
  double sum = 0;
  for (size_t i = 0; i < line->count; i++) sum += fmax(line->points[4 * i + 3], 0);
  return sum / (double)line->count;
}

/* Moves the points to the middle of their sections; the ends, and points outside, stay. */
static void centre(SporeCurve *line, const SporeSolid *solid, double usual) {
  g_autofree double *width = g_new(double, line->count);
  for (size_t i = 0; i < line->count; i++) width[i] = usual;
  size_t rim = (size_t)ceil(RIM / SPACING);
  for (int round = 0; round < ROUNDS; round++) {
    SporeCurve before = *line;
    g_autofree double *kept = g_memdup2(line->points, 4 * line->count * sizeof(double));
    before.points = kept;
    for (size_t i = rim; i + rim < line->count; i++) {
      double depth = spore_bvh_depth(solid->bvh, at(&before, i));
      SporeVec3 across =
          spore_vec3_normalise(spore_vec3_sub(at(&before, i + 2), at(&before, i - 2)), spore_vec3(1, 0, 0));
      if (depth > 0)
        spore_vec3_store(line->points + 4 * i, spore_section_middle(solid, at(&before, i), across, REACH * depth));
    }
    smooth(line, width);
  }
}

static double distance_to(const SporeCurve *line, SporeVec3 p) {
  double least = HUGE_VAL;
  for (size_t i = 1; i < line->count; i++) {
    SporeVec3 a = at(line, i - 1), d = spore_vec3_sub(at(line, i), a);
    double square = spore_vec3_dot(d, d), part = square > 0 ? spore_vec3_dot(spore_vec3_sub(p, a), d) / square : 0;
    least = fmin(least, spore_vec3_distance(p, spore_vec3_add_scaled(a, fmin(fmax(part, 0), 1), d)));
  }
  return least;
}

/* Radii of the nearest point of another line. */
static double *radii_beside(const SporeCurve *line, const SporeCurve *other) {
  double *radii = g_new(double, line->count);
  for (size_t i = 0; i < line->count; i++) {
    double least = HUGE_VAL;
    for (size_t k = 0; k < other->count; k++) {
      double distance = spore_vec3_distance(at(line, i), at(other, k));
      if (distance < least) least = distance, radii[i] = other->points[4 * k + 3];
    }
  }
  return radii;
}

int main(int argc, char **argv) {
  g_autofree char *content = NULL;
  gsize size;
  g_autoptr(GError) error = NULL;
  SporeTriangleMesh mesh;
  SporeSolid solid;
  g_assert_cmpint(argc, ==, 4);
  if (!g_file_get_contents(argv[1], &content, &size, &error) ||
      !spore_mesh_decode(argv[1], argv[1], content, size, MILLIMETRE, 0, &mesh, NULL, &error))
    g_error("%s", error->message);
  g_assert_true(spore_solid_create(&solid, &mesh, NULL));
  SporeCurve given = read_line(argv[2]), judged = read_line(argv[3]);
  set_radii(&given, &solid);
  double usual = mean_radius(&given), offset = 0, published = 0, within = 0;
  SporeCurve known = respaced(&given, SPACING * usual), moved = respaced(&given, SPACING * usual);
  SporeCurve ours = respaced(&judged, SPACING * usual);
  centre(&moved, &solid, usual);
  set_radii(&moved, &solid);
  for (size_t i = 0; i < moved.count; i++) moved.points[4 * i + 3] = fmax(moved.points[4 * i + 3], 0.35 * usual);
  g_autofree double *width = radii_beside(&known, &moved), *width_ours = radii_beside(&ours, &moved);
  smooth(&known, width);
  smooth(&ours, width_ours);
  for (size_t i = 0; i < moved.count; i++) {
    double radius = moved.points[4 * i + 3], away = distance_to(&ours, at(&moved, i));
    offset += away / radius / (double)moved.count;
    published += distance_to(&known, at(&moved, i)) / radius / (double)moved.count;
    within += (distance_to(&ours, at(&known, i)) <= radius) / (double)moved.count;
    if (g_getenv("LINE_VERBOSE") && distance_to(&ours, at(&known, i)) > radius)
      fprintf(stderr, "%.3f m: %.2f radii off, radius %.2f mm\n",
              spore_curve_length(&known) * (double)i / (double)moved.count, away / radius, 1e3 * radius);
  }
  printf("{\"known\": %.6g, \"length\": %.6g, \"within\": %.6g, \"offset\": %.6g, \"published_offset\": %.6g}\n",
         spore_curve_length(&known), spore_curve_length(&ours), within, offset, published);
  spore_curve_clear(&ours);
  spore_curve_clear(&moved);
  spore_curve_clear(&known);
  spore_curve_clear(&judged);
  spore_curve_clear(&given);
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&mesh);
  return 0;
}
