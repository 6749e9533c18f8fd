/* What surrounds a line goes with frames along it: which place of the line it belongs to, twist, inserted knots. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/attach.h"
#include "core/body/mapping.h"

enum { SPANS = 6, NODES = SPANS + 3, ARMS = SPANS + 1, SECTORS = 12, RINGS = 41 };

/* A hairpin: two limbs 2 apart along x, joined by half a circle. The second one is thicker. */
static void make_hairpin(SporeCurve *curve, double thin, double thick) {
  g_assert_true(spore_curve_allocate(curve, 3 * RINGS, NULL));
  for (size_t i = 0; i < 3 * RINGS; i++) {
    double along = (double)(i % RINGS) / RINGS, angle = M_PI * along;
    SporeVec3 limb[3] = {{10 * along, 0, 0}, {10 + sin(angle), 1 - cos(angle), 0}, {10 - 10 * along, 2, 0}};
    spore_vec3_store(curve->points + 4 * i, limb[i / RINGS]);
    curve->points[4 * i + 3] = i < RINGS ? thin : i < 2 * RINGS ? thin + along * (thick - thin) : thick;
  }
}

/* The surface bulges toward the other limb, to which its vertices there are nearer; its edges tell. */
static void test_attach(void) {
  SporeCurve curve;
  SporeTriangleMesh tube;
  double torn;
  make_hairpin(&curve, 0.5, 0.7);
  g_assert_true(spore_curve_tube(&curve, SECTORS, &tube, NULL));
  for (size_t v = 0; v < 3 * RINGS * SECTORS; v++) {
    size_t ring = v / SECTORS;
    double *at = tube.vertices + 3 * v;
    if (ring > 10 && ring < 20 && at[1] > 0.2) at[1] += 0.8;
  }
  g_autofree uint32_t *place = g_new(uint32_t, tube.vertex_count);
  size_t nearer = 0, wrong = 0;
  for (size_t v = 0; v < 3 * RINGS * SECTORS; v++) {
    double y = tube.vertices[3 * v + 1], z = tube.vertices[3 * v + 2];
    if (v / SECTORS < RINGS) nearer += y * y + z * z - 0.25 > (y - 2) * (y - 2) + z * z - 0.49;
  }
  g_assert_cmpuint(nearer, >, 20);
  g_assert_true(spore_curve_attach(&curve, &tube, place, &torn));
  for (size_t v = 0; v < 3 * RINGS * SECTORS; v++) wrong += labs((long)place[v] - (long)(v / SECTORS)) > 4;
  g_test_message("%zu vertices nearer to the other limb, %zu go with it, %.3g of the edges torn", nearer, wrong, torn);
  g_assert_cmpuint(wrong, ==, 0);
  g_assert_cmpfloat(torn, ==, 0);
  /* Joined limbs are torn somewhere. */
  uint32_t bridge[3] = {5 * SECTORS, 6 * SECTORS, (3 * RINGS - 6) * SECTORS};
  memcpy(tube.triangles, bridge, sizeof bridge);
  g_assert_true(spore_curve_attach(&curve, &tube, place, &torn));
  g_assert_cmpfloat(torn, >, 0);
  spore_triangle_mesh_clear(&tube);
  spore_curve_clear(&curve);
}

static void test_attach_without_memory(void) {
  SporeCurve curve;
  SporeTriangleMesh tube;
  double torn;
  make_hairpin(&curve, 0.5, 0.5);
  g_assert_true(spore_curve_tube(&curve, 4, &tube, NULL));
  g_autofree uint32_t *place = g_new(uint32_t, tube.vertex_count);
  bool made = false;
  for (uint64_t n = 1; !made; n++) {
    spore_allocation_fail_at(n);
    made = spore_curve_attach(&curve, &tube, place, &torn);
    spore_allocation_fail_at(0);
    g_assert_cmpuint(n, <, 20);
  }
  spore_triangle_mesh_clear(&tube);
  spore_curve_clear(&curve);
}

/* Control points (and ends of arms, square to each other from knot to knot) of a straight line along x, as long as its
 * parameter. */
static void place_straight(double *q) {
  for (size_t i = 0; i < NODES; i++) {
    double sum = 0; /* Greville's abscissa */
    for (int k = 1; k <= 3; k++) sum += fmin(fmax((double)i + k - 3, 0), SPANS);
    spore_vec3_store(q + 3 * i, spore_vec3(sum / 3, 0, 0));
  }
  for (size_t k = 0; k < ARMS; k++)
    spore_vec3_store(q + 3 * (NODES + k), k % 2 ? spore_vec3((double)k, 0, 1) : spore_vec3((double)k, 1, 0));
}

static SporeLine straight_line(double *q, double *radius) {
  for (size_t i = 0; i <= SPORE_LINE_SAMPLES * SPANS; i++) radius[i] = 0.5;
  place_straight(q);
  return (SporeLine){.knots = spore_spline_uniform(SPANS), .radius = radius, .arms = true, .q = q};
}

/* Arms turned evenly along the line: sections between them turn by their share. */
static void test_twist(void) {
  double q[3 * (NODES + ARMS)], radius[SPORE_LINE_SAMPLES * SPANS + 1], worst = 0;
  SporeLine line = straight_line(q, radius);
  double points[30], at[30];
  for (size_t i = 0; i < 10; i++)
    spore_vec3_store(points + 3 * i, spore_vec3(0.1 + 0.61 * (double)i, 0.3 * cos((double)i), 0.3 * sin((double)i)));
  SporeTriangleMesh cloud = {.vertex_count = 10, .vertices = points};
  SporeMapping mapping;
  g_assert_true(spore_mapping_init_frames(&mapping, &line, &cloud, NULL));
  double turn = 0.8; /* rad from knot to knot: more than half a turn from end to end */
  for (size_t k = 0; k < ARMS; k++) {
    double *end = q + 3 * (NODES + k), y = end[1], z = end[2], angle = turn * (double)k;
    end[1] = cos(angle) * y - sin(angle) * z;
    end[2] = sin(angle) * y + cos(angle) * z;
  }
  spore_mapping_positions(&mapping, q, at);
  for (size_t i = 0; i < 10; i++) {
    const double *p = points + 3 * i;
    double angle = turn * p[0];
    SporeVec3 expected = {p[0], cos(angle) * p[1] - sin(angle) * p[2], sin(angle) * p[1] + cos(angle) * p[2]};
    worst = fmax(worst, spore_vec3_distance(expected, spore_vec3_load(at + 3 * i)));
  }
  g_test_message("sections off by %.2e", worst);
  g_assert_cmpfloat(worst, <, 1e-14);
  spore_mapping_clear(&mapping);
}

static double knot(SporeSplineKnots knots, long i) { /* three more at either end */
  return spore_spline_break(knots, (size_t)CLAMP(i, 0, (long)knots.span_count));
}

/* The control point of the same line with other knots: its blossom (de Boor) at three of them. */
static SporeVec3 blossom(const double *q, const double u[3]) {
  SporeSplineKnots knots = spore_spline_uniform(SPANS);
  long span = (long)spore_spline_span(knots, u[1]);
  SporeVec3 d[4];
  for (long j = 0; j < 4; j++) d[j] = spore_vec3_load(q + 3 * (span + j));
  for (long r = 0; r < 3; r++)
    for (long j = 3; j > r; j--) {
      double low = knot(knots, span + j - 3), high = knot(knots, span + j - r);
      double part = (u[r] - low) / (high - low);
      d[j] = spore_vec3_add_scaled(d[j - 1], part, spore_vec3_sub(d[j], d[j - 1]));
    }
  return d[3];
}

/* A knot amid the third span: the line stays, and so does what surrounds it. */
static void test_follow(void) {
  static const double breaks[SPANS + 2] = {0, 1, 2, 2.5, 3, 4, 5, 6};
  const SporeSplineKnots finer = {SPANS + 1, breaks};
  double q[3 * (NODES + ARMS)], radius[SPORE_LINE_SAMPLES * SPANS + 1], more[3 * (NODES + ARMS + 2)];
  SporeLine line = straight_line(q, radius);
  GRand *random = g_rand_new_with_seed(1);
  double points[60], before[60], behind[60], worst = 0;
  for (size_t i = 0; i < 60; i++) points[i] = i % 3 ? g_rand_double_range(random, -1, 1) : (double)i / 10;
  SporeTriangleMesh cloud = {.vertex_count = 20, .vertices = points};
  SporeMapping mapping;
  g_assert_true(spore_mapping_init_frames(&mapping, &line, &cloud, NULL));
  for (size_t i = 0; i < 3 * (NODES + ARMS); i++) q[i] += g_rand_double_range(random, -0.2, 0.2);
  spore_mapping_positions(&mapping, q, before);
  for (long i = 0; i <= NODES; i++) {
    double u[3];
    for (long k = 0; k < 3; k++) u[k] = knot(finer, i + k - 2);
    spore_vec3_store(more + 3 * i, blossom(q, u));
  }
  for (size_t k = 0; k <= ARMS; k++) /* that of the new knot is nowhere */
    memcpy(more + 3 * (NODES + 1 + k), q + 3 * (NODES + k - (k > 2)), 3 * sizeof *q);
  spore_line_frames_follow(mapping.frames, finer);
  spore_mapping_positions(&mapping, more, behind);
  for (size_t i = 0; i < 60; i++) worst = fmax(worst, fabs(before[i] - behind[i]));
  g_test_message("a knot more moves what surrounds the line by %.2e", worst);
  g_assert_cmpfloat(worst, <, 1e-13);
  spore_mapping_clear(&mapping);
  g_rand_free(random);
}

enum { LONG = 20, BENT_RINGS = 201 };

/* A straight line along x that is bent about its middle, more and more, to `angle` between its halves: round, with this
 * radius, and sharp where the radius is 0. */
static SporeVec3 bent_at(double along, double radius, double angle) {
  double half = 0.5 * LONG, first = half - 0.5 * radius * angle, turn = radius > 0 ? (along - first) / radius : 0;
  if (radius > 0 && turn > 0 && turn < angle)
    return spore_vec3(first + radius * sin(turn), radius * (1 - cos(turn)), 0);
  if (along <= (radius > 0 ? first : half)) return spore_vec3(along, 0, 0);
  double on = along - (radius > 0 ? first + radius * angle : half);
  return spore_vec3((radius > 0 ? first : half) + radius * sin(angle) + on * cos(angle),
                    radius * (1 - cos(angle)) + on * sin(angle), 0);
}

static void place_bent(double *q, double radius, double angle) {
  for (size_t i = 0; i < LONG + 3; i++) {
    double sum = 0;
    for (int k = 1; k <= 3; k++) sum += fmin(fmax((double)i + k - 3, 0), LONG);
    spore_vec3_store(q + 3 * i, bent_at(sum / 3, radius, angle));
  }
}

/* Triangles of a tube that look toward the line inside of their rings. */
static size_t count_inverted(const SporeMapping *mapping, const SporeTriangleMesh *tube, const double *q, double *at) {
  size_t inverted = 0;
  spore_mapping_positions(mapping, q, at);
  for (size_t t = 0; t < tube->triangle_count; t++) {
    SporeVec3 p[3], middle = {0, 0, 0}, inside = {0, 0, 0};
    for (size_t k = 0; k < 3; k++) {
      uint32_t n = tube->triangles[3 * t + k];
      if (n >= BENT_RINGS * SECTORS) goto next; /* of a cap */
      p[k] = spore_vec3_load(at + 3 * (size_t)n);
      middle = spore_vec3_add_scaled(middle, 1.0 / 3, p[k]);
      for (size_t s = 0; s < SECTORS; s++)
        inside = spore_vec3_add_scaled(inside, 1.0 / (3 * SECTORS),
                                       spore_vec3_load(at + 3 * ((size_t)n / SECTORS * SECTORS + s)));
    }
    SporeVec3 normal = spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0]));
    inverted += spore_vec3_dot(normal, spore_vec3_sub(middle, inside)) < 0;
  next:;
  }
  return inverted;
}

/* Frames by the line's own tangents, as they would be without chords. */
static void forget_chords(SporeMapping *mapping) {
  SporeLineFrames *frames = mapping->frames;
  for (size_t k = 0; k < frames->station_count; k++) frames->stations[k].spread = 1e-4;
  for (size_t i = 0; i < frames->point_count; i++) frames->points[i].spread = 1e-4;
  spore_line_frames_follow(frames, spore_spline_uniform(LONG));
}

/* Corners and bends that are sharper than the tube is thick do not turn its skin inside out at any time; where the bend
 * comes back on itself, so that the tube's walls meet, at most a quarter to a half of what turned before does. */
static void test_sharp_bends(void) {
  double q[3 * (LONG + 3)], radius[SPORE_LINE_SAMPLES * LONG + 1];
  for (size_t i = 0; i <= SPORE_LINE_SAMPLES * LONG; i++) radius[i] = 1;
  SporeCurve curve;
  SporeTriangleMesh tube;
  g_assert_true(spore_curve_allocate(&curve, BENT_RINGS, NULL));
  for (size_t i = 0; i < BENT_RINGS; i++) {
    spore_vec3_store(curve.points + 4 * i, spore_vec3((double)LONG * (double)i / (BENT_RINGS - 1), 0, 0));
    curve.points[4 * i + 3] = 1;
  }
  g_assert_true(spore_curve_tube(&curve, SECTORS, &tube, NULL));
  g_autofree double *at = g_new(double, 3 * tube.vertex_count);
  const SporeLine line = {.knots = spore_spline_uniform(LONG), .radius = radius, .q = q};
  static const struct {
    double radius, angle, share; /* share: at most, of what turns without chords */
  } bends[] = {{0, M_PI / 2, 0}, {0.5, 2 * M_PI / 3, 0}, {0, 2 * M_PI / 3, 0.25}, {0.8, M_PI, 0.5}, {4, M_PI, 0}};
  for (size_t b = 0; b < G_N_ELEMENTS(bends); b++) {
    size_t with = 0, without = 0;
    for (int chords = 0; chords < 2; chords++) {
      SporeMapping mapping;
      place_bent(q, 0, 0);
      g_assert_true(spore_mapping_init_frames(&mapping, &line, &tube, NULL));
      if (!chords) forget_chords(&mapping);
      for (int stage = 0; stage <= 20; stage++) {
        place_bent(q, bends[b].radius, bends[b].angle * stage / 20);
        *(chords ? &with : &without) += count_inverted(&mapping, &tube, q, at);
      }
      spore_mapping_clear(&mapping);
    }
    g_test_message("radius %g, %.0f degrees: %zu triangles inside out by tangents, %zu by chords", bends[b].radius,
                   bends[b].angle * 180 / M_PI, without, with);
    g_assert_cmpfloat((double)with, <=, bends[b].share * (double)without);
    g_assert_true((without > 0) == (bends[b].radius < 1));
  }
  spore_triangle_mesh_clear(&tube);
  spore_curve_clear(&curve);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/line_frames/attach", test_attach);
  g_test_add_func("/line_frames/attach_without_memory", test_attach_without_memory);
  g_test_add_func("/line_frames/twist", test_twist);
  g_test_add_func("/line_frames/follow", test_follow);
  g_test_add_func("/line_frames/sharp_bends", test_sharp_bends);
  return g_test_run();
}
