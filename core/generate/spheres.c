#include "core/generate/spheres.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/spheres_parts.h"

#define CANDIDATES_LEAST 1500
#define CANDIDATES_PER_SPHERE 12

const char *const spore_spheres_mode_names[SPORE_SPHERES_MODE_COUNT + 1] = {[SPORE_SPHERES_BALANCED] = "balanced"};

static bool check_options(const SporeSpheresOptions *options, SporeError *error) {
  if (options->count > SPORE_SPHERES_MAXIMUM)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%zu spheres are too many; 1 to %u were expected; ask for fewer"), options->count,
                           SPORE_SPHERES_MAXIMUM);
  if (!options->count && !(options->tolerance > 0 && options->tolerance <= 1))
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("neither a count nor a tolerance in (0, 1] is given (the tolerance is %g); a fraction of the "
          "diagonal such as 0.003 was expected; give one of them"),
        options->tolerance);
  return true;
}

static bool store_balls(const SporeBalls *balls, SporeSphereSet *set, SporeError *error) {
  if (!spore_sphere_set_allocate(set, balls->count, error)) return false;
  for (size_t i = 0; i < balls->count; i++) {
    double *sphere = set->spheres + 4 * i;
    sphere[0] = balls->x[i], sphere[1] = balls->y[i], sphere[2] = balls->z[i], sphere[3] = balls->r[i];
  }
  return true;
}

static SporeProgressPart part_of(const SporeProgressPart *whole, double first, double share) {
  return (SporeProgressPart){whole->whole, whole->first + whole->share * first, whole->share * share};
}

/* Exactly `count` spheres in the solid, whatever the options say of their number, measured. */
static bool generate(const SporeSolid *solid, size_t count, const SporeSpheresOptions *options, SporeSphereSet *set,
                     SporeSpheresReport *report, const SporeProgressPart *progress, SporeError *error) {
  SporeRandom random = {options->seed ^ UINT64_C(0x9e3779b97f4a7c15)};
  SporeProgressPart sampling = part_of(progress, 0, 0.1), finding = part_of(progress, 0.1, 0.2),
                    fitting = part_of(progress, 0.3, 0.6), measuring = part_of(progress, 0.9, 0.1);
  SporeSamples samples = {0};
  SporeBalls candidates = {0}, balls = {0};
  size_t candidate_count = CANDIDATES_PER_SPHERE * count;
  if (candidate_count < CANDIDATES_LEAST) candidate_count = CANDIDATES_LEAST;
  *set = (SporeSphereSet){0};
  bool done = spore_samples_create(&samples, solid, count, &random, &sampling, error) &&
              spore_candidates_create(&candidates, solid, candidate_count, &random, &finding, error);
  if (done && !spore_balls_create(&balls, count)) done = spore_spheres_no_memory(error);
  done = done && spore_candidates_cover(&candidates, &samples, &balls, &finding, error) &&
         spore_spheres_fit(solid, &samples, &candidates, &balls, options->seed, &fitting, error) &&
         store_balls(&balls, set, error) && spore_solid_measure(solid, set, report, &measuring, error);
  spore_balls_clear(&balls);
  spore_balls_clear(&candidates);
  spore_samples_clear(&samples);
  if (!done) spore_sphere_set_clear(set);
  return done;
}

/* The smallest set found that meets the tolerance: the error falls about as a power of the count, so each trial goes
 * where a line through the last two in logarithms says, between the counts known to be too few and enough. */
static bool search(const SporeSolid *solid, const SporeSpheresOptions *options, SporeSphereSet *set,
                   SporeSpheresReport *report, const SporeProgress *progress, SporeError *error) {
  size_t few = 0, enough = 0, count = 16;
  double few_error = 0, enough_error = 0;
  for (int trial = 0;; trial++) {
    SporeProgressPart part = {progress, 1 - pow(0.8, trial), 0.2 * pow(0.8, trial)};
    SporeSphereSet tried;
    SporeSpheresReport measured;
    if (!generate(solid, count, options, &tried, &measured, &part, error)) return false;
    if (measured.distance_mean <= options->tolerance) {
      spore_sphere_set_clear(set);
      *set = tried, *report = measured;
      enough = count, enough_error = measured.distance_mean;
    } else {
      spore_sphere_set_clear(&tried);
      few = count, few_error = measured.distance_mean;
    }
    if (enough && enough - few <= 1 + enough / 50) return true;
    if (!enough && few >= SPORE_SPHERES_MAXIMUM)
      return spore_error_set(
          error, SPORE_ERROR_NUMERICAL, NULL,
          _("%u spheres still are %g of the diagonal away on average, over the tolerance of %g; give a "
            "larger tolerance"),
          SPORE_SPHERES_MAXIMUM, few_error, options->tolerance);
    double slope = few && enough ? log(enough_error / few_error) / log((double)enough / (double)few) : -0.6;
    double known = few ? (double)few : (double)enough, known_error = few ? few_error : enough_error;
    double guess = known * pow(options->tolerance / known_error, 1 / fmin(slope, -0.2));
    size_t low = few + 1, high = enough ? enough - 1 : SPORE_SPHERES_MAXIMUM;
    if (!few && guess > (double)enough / 2) guess = (double)enough / 2;
    if (few && enough && trial > 6) guess = sqrt((double)few * (double)enough);
    if (!enough) guess = fmax(guess, 1.2 * (double)few);
    count = guess < (double)low ? low : guess > (double)high ? high : (size_t)guess;
  }
}

bool spore_spheres_from_mesh(const SporeTriangleMesh *mesh, const SporeSpheresOptions *options, SporeSphereSet *set,
                             SporeSpheresReport *report, const SporeProgress *progress, SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  *set = (SporeSphereSet){0};
  *report = (SporeSpheresReport){0};
  if (!check_options(options, error) || !spore_solid_create(&solid, mesh, error)) return false;
  SporeProgressPart whole = {progress, 0, 1};
  bool done = options->count ? generate(&solid, options->count, options, set, report, &whole, error)
                             : search(&solid, options, set, report, progress, error);
  spore_solid_clear(&solid);
  if (!done) spore_sphere_set_clear(set);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}

/* The cells fill the solid inside their boundary, so the spheres are those of the boundary: fewer than one a cell, with
 * the error measured against the same solid. */
bool spore_spheres_from_tetrahedra(const SporeTetrahedralMesh *mesh, const SporeSpheresOptions *options,
                                   SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                                   SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  *set = (SporeSphereSet){0};
  *report = (SporeSpheresReport){0};
  if (!spore_tetrahedral_mesh_validate(mesh, error)) return false;
  if (!spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count))
    return spore_spheres_no_memory(error);
  bool done = spore_spheres_from_mesh(&boundary, options, set, report, progress, error);
  spore_free(boundary.triangles);
  return done;
}

bool spore_spheres_measure(const SporeTriangleMesh *mesh, const SporeSphereSet *set, SporeSpheresReport *report,
                           SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  SporeProgressPart none = {NULL, 0, 1};
  *report = (SporeSpheresReport){0};
  if (!spore_sphere_set_validate(set, error) || !spore_solid_create(&solid, mesh, error)) return false;
  bool done = spore_solid_measure(&solid, set, report, &none, error);
  spore_solid_clear(&solid);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}
