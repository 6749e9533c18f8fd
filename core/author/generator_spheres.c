/* The generator of sphere sets: its options, which are attributes of <spheres>. */
#include "core/author/generator.h"

#include <string.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/author/verdict.h"
#include "core/scene/schema_tables.h"

static const char *const methods[] = {"balanced", "tetrahedra", "bounding", "weighted", NULL};

/* A target of generated spheres; 0: not asked for. */
#define SPHERES_TARGET(target, most, words)                                                                            \
  {                                                                                                                    \
    .name = #target, .type = SPORE_REAL, .unit = "", 0, most, .initial = {0}, FIELD(SporeSpheresFields, target),       \
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
     .choices = methods,
     FIELD(SporeSpheresFields, method),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_(
         "What the spheres are good at: balanced fits the depth inside and is truest in light contact; bounding covers "
         "all "
         "of the mesh, with little outside; weighted gives the spheres weights whose sum fits the depth more closely; "
         "tetrahedra puts one round each tetrahedron of a soft organ, as the paper does, whatever the number.")},
    {.name = "count",
     .type = SPORE_INTEGER,
     .unit = "",
     1,
     5000,
     .initial = {100},
     FIELD(SporeSpheresFields, count),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of spheres to generate; counts where coverage, outside, tolerance and depth error are 0.")},
    SPHERES_TARGET(coverage, 0.9999,
                   N_("Share of the inside that has to lie in spheres: as few spheres as reach it, and "
                      "what else is asked for, are generated; 0: not asked for.")),
    SPHERES_TARGET(outside, 100,
                   N_("Volume of the spheres outside that is let pass, as a share of the mesh's volume; 0: any.")),
    SPHERES_TARGET(tolerance, 0.5,
                   N_("Mean distance between mesh and spheres that is let pass, as a share of the diagonal; 0: any.")),
    SPHERES_TARGET(depth_error, 1,
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

typedef struct SporeSphereRegionFields {
  const char *name;
  double centre[3], radius, density;
} SporeSphereRegionFields;

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

static const SporeElement elements[] = {
    {"spheres", N_("Spheres"), N_("A set of spheres that fills a shape, for collision."),
     TABLE(spheres_parameters, SporeSpheresFields), .children = CHILDREN("sphere_region")},
    {"sphere_region", N_("Region"), N_("A ball in which the generated spheres lie denser, or less so."),
     TABLE(sphere_region_parameters, SporeSphereRegionFields), .children = CHILDREN("dab")},
    {NULL},
};

static SporeSpheresMode mode_named(const char *name) {
  for (int i = 0; i < SPORE_SPHERES_MODE_COUNT; i++)
    if (g_strcmp0(name, spore_spheres_mode_names[i]) == 0) return (SporeSpheresMode)i;
  return SPORE_SPHERES_BALANCED;
}

SporeSpheresOptions spore_edit_spheres_options(const SporeSpheresFields *fields, const SporeGenerateRegion *regions,
                                               gsize count) {
  const SporeSpheresTargets targets = {fields->coverage, fields->outside, fields->tolerance, fields->depth_error};
  return (SporeSpheresOptions){
      .mode = mode_named(methods[fields->method]),
      .count = spore_spheres_hardest_target(&targets, &(SporeSpheresReport){0}, NULL) ? 0 : (size_t)fields->count,
      .targets = targets,
      .seed = (uint64_t)fields->seed,
      .each_cell = strcmp(methods[fields->method], "tetrahedra") == 0,
      .regions = regions,
      .region_count = count};
}

static SporeSpheresOptions options_of(const SporeGenerateWork *work) {
  return spore_edit_spheres_options(&work->options.fields.spheres, work->regions, work->region_count);
}

static bool make(const SporeGenerateWork *work, const SporeSpheresOptions *options, SporeSphereSet *set,
                 SporeSpheresReport *report, const SporeProgress *progress, SporeError *failure) {
  if (options->each_cell && work->cells.tetrahedron_count)
    return spore_spheres_of_cells(&work->cells, &work->mesh, set, report, failure);
  return spore_spheres_from_mesh(&work->mesh, options, set, report, progress, failure);
}

/* The other way for an organ that has tetrahedra: its errors are shown beside those of the way that was chosen. Where
 * each cell has no sphere, for there are too many, nothing is shown. */
static bool measure_other(SporeGenerateWork *work, SporeSpheresOptions other, const SporeProgress *progress,
                          SporeError *failure) {
  SporeSphereSet set;
  other.each_cell = !other.each_cell;
  if (!work->cells.tetrahedron_count || work->cells.tetrahedron_count > SPORE_SPHERES_MAXIMUM) return true;
  if (!make(work, &other, &set, &work->other_report, progress, failure)) return false;
  work->other_count = set.count;
  spore_sphere_set_clear(&set);
  return true;
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSpheresOptions options = options_of(work);
  return (make(work, &options, &work->spheres, &work->spheres_report, progress, &failure) &&
          measure_other(work, options, progress, &failure) &&
          spore_spheres_quality(&work->mesh, &work->spheres, &work->spheres_quality, progress, &failure)) ||
         spore_error_propagate(&failure, error);
}

static gboolean error_of(const SporeGenerateWork *work, size_t count, double *error_percent,
                         const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSpheresOptions options = options_of(work);
  SporeSpheresReport report;
  SporeSphereSet set;
  options.count = count;
  options.each_cell = false;
  if (!spore_spheres_from_mesh(&work->mesh, &options, &set, &report, progress, &failure))
    return spore_error_propagate(&failure, error);
  spore_sphere_set_clear(&set);
  *error_percent = 100 * spore_spheres_felt_error(&report);
  return TRUE;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = spore_generate_work_from(work);
  return spore_edit_use_spheres(document, body, &from, &work->spheres, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeSpheresReport *spheres = &work->spheres_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text,
                         _("%zu spheres in %.1f s\nCoverage %.1f %%, outside %.1f %%\n"
                           "Depth error %.1f %%, distance %.2f %%"),
                         work->spheres.count, spheres->seconds, 100 * spheres->coverage, 100 * spheres->outside,
                         100 * spore_spheres_felt_error(spheres), 100 * spheres->distance_mean);
  const SporeSpheresOptions options = options_of(work);
  g_autofree char *verdict = spore_spheres_verdict(&options, spheres, work->spheres.count);
  if (verdict) g_string_append_printf(text, "\n%s", verdict);
  if (work->other_count) {
    g_autofree char *other = spore_spheres_other_text(options.each_cell, work->other_count, &work->other_report);
    g_string_append_printf(text, "\n%s", other);
  }
  return g_string_free(text, FALSE);
}

const SporeGeneratorType spore_generator_spheres = {
    .name = "spheres",
    .command = "spheres",
    .element = "spheres",
    .elements = elements,
    .count = "count",
    .ways = "count | coverage outside tolerance depth_error",
    .target = spore_edit_body_spheres,
    .shows = "spheres",
    .title = N_("Spheres of %s"),
    .working = N_("Generating spheres"),
    .count_label = N_("Spheres"),
    .unit = "collision",
    .offer = N_("Number of spheres"),
    .error_of = error_of,
    .run = run,
    .apply = apply,
    .facts = facts,
};
