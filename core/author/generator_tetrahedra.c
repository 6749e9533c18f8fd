/* The generators of tetrahedra, in a surface and of a label map: their options, which are attributes of <tetrahedra>.
 */
#include "core/author/generator.h"

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/author/verdict.h"
#include "core/scene/schema_tables.h"

static const char *const methods[] = {"automatic", "direct", "repaired", "wrapped", "voxels", NULL};
/* In the order of their names. */
enum { PIECES_MERGED, PIECES_LARGEST, PIECES_APART };
static const char *const piece_choices[] = {"merged", "largest", "apart", NULL};

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
     .references = "mesh|label_map",
     FIELD(SporeTetrahedraFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh or label map that the tetrahedra were generated from; none: made elsewhere.")},
    {.name = "method",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = methods,
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
    {.name = "hollow",
     .type = SPORE_BOOLEAN,
     .unit = "",
     FIELD(SporeTetrahedraFields, hollow),
     .change = SPORE_CHANGE_LIVE,
     .doc =
         N_("Whether a closed piece inside another one, as a chamber in a heart, bounds a cavity; else it is left out, "
            "and what it encloses is solid.")},
    {.name = "pieces",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {0},
     .choices = piece_choices,
     FIELD(SporeTetrahedraFields, pieces),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Pieces of the mesh, as an organ and its vessels: merged into one solid; the largest alone with what "
               "lies inside it; or apart, each with cells of its own that share faces where pieces touch. Pieces too "
               "thin for "
               "the number of cells are then merged with one that they touch, those that cost the most cells first, "
               "and named.")},
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

typedef struct SporeCellRegionFields {
  const char *name;
  double centre[3], radius, size;
} SporeCellRegionFields;

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

static const SporeElement elements[] = {
    {"tetrahedra", N_("Tetrahedra"), N_("A volume cut into tetrahedra."),
     TABLE(tetrahedra_parameters, SporeTetrahedraFields), .children = CHILDREN("cell_region")},
    {"cell_region", N_("Region"), N_("A ball in which the generated tetrahedra are smaller."),
     TABLE(cell_region_parameters, SporeCellRegionFields), .children = CHILDREN("dab")},
    {NULL},
};

SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count) {
  return (SporeTetrahedraOptions){.method = fields->method ? (SporeTetrahedraMethod)(fields->method - 1)
                                                           : SPORE_TETRAHEDRA_METHODS,
                                  .cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                  .size = fields->size,
                                  .tolerance = fields->tolerance,
                                  .curvature = fields->curvature,
                                  .fill = fields->fill,
                                  .hollow = fields->hollow,
                                  .largest = fields->pieces == PIECES_LARGEST,
                                  .apart = fields->pieces == PIECES_APART,
                                  .gap = fields->gap,
                                  .regions = regions,
                                  .region_count = count};
}

static SporeTetrahedraOptions options_of(const SporeGenerateWork *work) {
  return spore_edit_tetrahedra_options(&work->options.fields.tetrahedra, work->regions, work->region_count);
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeTetrahedraOptions options = options_of(work);
  return spore_tetrahedra_from_mesh(work->source, &work->mesh, &options, &work->tetrahedra, &work->tetrahedra_report,
                                    progress, error);
}

static gboolean error_of(const SporeGenerateWork *work, size_t count, double *error_percent,
                         const SporeProgress *progress, GError **error) {
  SporeTetrahedraOptions options = options_of(work);
  SporeTetrahedralMesh mesh = {0};
  SporeTetrahedraReport report;
  options.cells = count;
  gboolean done = spore_tetrahedra_from_mesh(work->source, &work->mesh, &options, &mesh, &report, progress, error);
  spore_tetrahedral_mesh_clear(&mesh);
  if (done) *error_percent = 100 * report.hausdorff;
  return done;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = spore_generate_work_from(work);
  return spore_edit_use_tetrahedra(document, body, &from, &work->tetrahedra, error);
}

/* The method that the mesh needed, and how that method changed the mesh. */
static const char *method_text(SporeTetrahedraMethod method) {
  static const char *const texts[] = {N_("the mesh"), N_("the mesh repaired"), N_("a wrap of it"), N_("a lattice")};
  return _(texts[method]);
}

/* Appends the remarks of the command line, one a line. */
static void append_remarks(GString *text, const SporeGenerateWork *work) {
  SporeTetrahedraOptions options = options_of(work);
  g_autofree char *remarks = spore_tetrahedra_remarks(&work->tetrahedra, &options, &work->tetrahedra_report);
  if (*remarks) g_string_append_printf(text, "\n%s", g_strchomp(remarks));
}

static char *facts(const SporeGenerateWork *work) {
  const SporeTetrahedraReport *report = &work->tetrahedra_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu tetrahedra in %.1f s, of %s"), work->tetrahedra.tetrahedron_count,
                         report->seconds, method_text(report->method));
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Least angle %.1f°, mean %.1f°"), report->quality.min_dihedral_deg,
                         report->quality.mean_dihedral_deg);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Error %.2f %%, volume %+.1f %%"), 100 * report->hausdorff,
                         100 * report->volume_change);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Surface %+.1f %%"), 100 * report->area_change);
  g_autofree char *verdict = spore_tetrahedra_verdict(report);
  g_string_append_printf(text, "\n%s", verdict);
  append_remarks(text, work);
  for (int i = 0; i < SPORE_TETRAHEDRA_METHODS; i++)
    if (*report->refused[i]) {
      g_string_append_c(text, '\n');
      g_string_append_printf(text, _("Not %s: %s"), method_text((SporeTetrahedraMethod)i), report->refused[i]);
    }
  return g_string_free(text, FALSE);
}

const SporeGeneratorType spore_generator_tetrahedra = {
    .name = "tetrahedra",
    .command = "tetrahedra",
    .element = "tetrahedra",
    .elements = elements,
    .count = "cells",
    .ways = "cells | size",
    .target = spore_edit_body_tetrahedra,
    .shows = "tetrahedra",
    .title = N_("Tetrahedra of %s"),
    .working = N_("Generating tetrahedra"),
    .count_label = N_("Tetrahedra"),
    .unit = "mechanical",
    .offer = N_("Number of tetrahedra"),
    .error_of = error_of,
    .run = run,
    .apply = apply,
    .facts = facts,
};
