#include "ui/jobs/quality.h"

#include <glib/gi18n.h>
#include <math.h>

/* Beyond the scale lies this share of the values, so that a few far ones do not make all others look alike. */
#define BEYOND 0.02

typedef enum { OUTSIDE_SHARE, DEPTH_ERROR, SURFACE_DISTANCE, RADIUS, LEAST_ANGLE } Measure;

static const char *const labels[] = {N_("Outside share"), N_("Depth error"), N_("Surface distance"), N_("Radius"),
                                     N_("Least angle")};
static const Measure of_spheres[] = {SURFACE_DISTANCE, OUTSIDE_SHARE, DEPTH_ERROR, RADIUS},
                     of_tetrahedra[] = {LEAST_ANGLE};

static Measure measure_of(SporeGenerateKind kind, gsize which) {
  return (kind == SPORE_GENERATE_SPHERES ? of_spheres : of_tetrahedra)[which];
}

gsize spore_quality_count(SporeGenerateKind kind) {
  return kind == SPORE_GENERATE_SPHERES ? G_N_ELEMENTS(of_spheres) : G_N_ELEMENTS(of_tetrahedra);
}

const char *spore_quality_label(SporeGenerateKind kind, gsize which) { return _(labels[measure_of(kind, which)]); }

static double *scaled(const double *values, gsize count, gsize stride, double scale) {
  double *copy = g_new(double, count);
  for (gsize i = 0; i < count; i++) copy[i] = scale * fabs(values[stride * i]);
  return copy;
}

static void measure_spheres(const SporeGenerateWork *work, Measure measure, SporeQuality *quality) {
  const SporeSpheresQuality *found = &work->spheres_quality;
  quality->unit = "mm";
  quality->count = found->sphere_count;
  switch (measure) {
  case OUTSIDE_SHARE:
    quality->unit = "%";
    quality->values = scaled(found->outside, quality->count, 1, 100);
    break;
  case DEPTH_ERROR:
    quality->values = scaled(found->depth_error, quality->count, 1, 1e3);
    break;
  case SURFACE_DISTANCE:
    quality->of_surface = TRUE;
    quality->count = found->vertex_count;
    quality->values = scaled(found->distance, quality->count, 1, 1e3);
    quality->weights = g_memdup2(found->area, quality->count * sizeof(double));
    break;
  default:
    quality->values = scaled(work->spheres.spheres + 3, quality->count, 4, 1e3);
  }
}

static void measure_tetrahedra(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->unit = "°";
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) {
    SporeTetrahedralMesh one = {work->tetrahedra.vertex_count, 1, work->tetrahedra.vertices,
                                work->tetrahedra.tetrahedra + 4 * i};
    SporeTetrahedraQuality found;
    spore_tetrahedral_mesh_quality(&one, &found);
    quality->values[i] = found.min_dihedral_deg;
  }
}

/* The next of 1, 2, 5 times a power of ten. */
static double round_up(double value) {
  double power = pow(10, floor(log10(value)));
  for (double step = 1; step <= 10; step = step == 2 ? 5 : 2 * step)
    if (value <= step * power * (1 + 1e-9)) return step * power;
  return 10 * power;
}

void spore_quality_of(const SporeGenerateWork *work, gsize which, SporeQuality *quality) {
  Measure measure = measure_of(work->options.kind, which);
  *quality = (SporeQuality){.label = _(labels[measure])};
  if (work->options.kind == SPORE_GENERATE_SPHERES && work->spheres_quality.sphere_count)
    measure_spheres(work, measure, quality);
  if (work->options.kind == SPORE_GENERATE_TETRAHEDRA) measure_tetrahedra(work, quality);
  double most = spore_quality_quantile(quality, 1 - BEYOND);
  quality->high = most > 0 ? round_up(most) : 1;
}

void spore_quality_clear(SporeQuality *quality) {
  g_free(quality->values);
  g_free(quality->weights);
  *quality = (SporeQuality){0};
}

double spore_quality_place(const SporeQuality *quality, gsize i) {
  return CLAMP((quality->values[i] - quality->low) / (quality->high - quality->low), 0, 1);
}

static double weight_of(const SporeQuality *quality, gsize i) { return quality->weights ? quality->weights[i] : 1; }

double spore_quality_mean(const SporeQuality *quality) {
  double sum = 0, weight = 0;
  for (gsize i = 0; i < quality->count; i++) {
    sum += weight_of(quality, i) * quality->values[i];
    weight += weight_of(quality, i);
  }
  return weight > 0 ? sum / weight : 0;
}

static int by_value(const void *a, const void *b, gpointer data) {
  const double *values = data, x = values[*(const guint32 *)a], y = values[*(const guint32 *)b];
  return (x > y) - (x < y);
}

double spore_quality_quantile(const SporeQuality *quality, double share) {
  if (!quality->count) return 0;
  g_autofree guint32 *order = g_new(guint32, quality->count);
  double whole = 0, sum = 0;
  for (gsize i = 0; i < quality->count; i++) {
    order[i] = (guint32)i;
    whole += weight_of(quality, i);
  }
  g_qsort_with_data(order, (int)quality->count, sizeof *order, by_value, quality->values);
  for (gsize i = 0; i < quality->count; i++) {
    sum += weight_of(quality, order[i]);
    if (sum >= share * whole) return quality->values[order[i]];
  }
  return quality->values[order[quality->count - 1]];
}
