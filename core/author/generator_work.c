/* A run of a generator: prepared from a body or a label map, run, compared with the document, and applied. */
#include "core/author/generator_work.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/scene/generated.h"

/* Options. */

SporeObject *spore_generate_target(SporeDocument *document, SporeObject *body, SporeGenerateKind kind) {
  return spore_generators[kind]->target(document, body);
}

void spore_generate_set_initial(SporeGenerateOptions *options) {
  SporeParameterTable table = spore_generator_table(spore_generators[options->kind]);
  spore_parameters_set_initial(&table, &options->fields);
}

SporeGenerateOptions spore_generate_options_of(SporeDocument *document, SporeObject *body, SporeGenerateKind kind) {
  SporeGenerateOptions options = {.kind = kind};
  SporeObject *asset = spore_generate_target(document, body, kind);
  if (asset) spore_object_fields(asset, &options.fields);
  else spore_generate_set_initial(&options);
  return options;
}

size_t spore_generate_get_count(const SporeGenerateOptions *options) {
  const SporeGeneratorType *generator = spore_generators[options->kind];
  SporeParameterTable table = spore_generator_table(generator);
  int count = generator->count ? spore_parameter_find(&table, generator->count) : -1;
  return count < 0 ? 0 : (size_t)spore_parameter_load(&table.parameters[count], &options->fields).number[0];
}

void spore_generate_set_count(SporeGenerateOptions *options, size_t count) {
  const SporeGeneratorType *generator = spore_generators[options->kind];
  SporeParameterTable table = spore_generator_table(generator);
  int place = generator->count ? spore_parameter_find(&table, generator->count) : -1;
  if (place < 0 || spore_generate_get_count(options) == count) return;
  const SporeValue value = {.type = SPORE_INTEGER, .number = {(double)count}};
  spore_parameter_store(&table.parameters[place], &value, &options->fields);
  spore_generator_choose_way(generator, spore_generator_way(generator, generator->count), &options->fields);
}

guint spore_generate_place_count(const SporeGenerateOptions *options) {
  const SporeGeneratorPlaces *places = spore_generators[options->kind]->places;
  guint count = 0;
  while (places && places->options[count]) count++;
  return count;
}

/* The parameter of a place of the options. */
static const SporeParameter *place_of(const SporeGenerateOptions *options, guint k) {
  const SporeGeneratorType *generator = spore_generators[options->kind];
  SporeParameterTable table = spore_generator_table(generator);
  return &table.parameters[spore_parameter_find(&table, generator->places->options[k])];
}

gboolean spore_generate_get_places(const SporeGenerateOptions *options, double places[SPORE_GENERATOR_PLACES][3]) {
  gboolean given = FALSE;
  for (guint k = 0; k < spore_generate_place_count(options); k++) {
    const SporeValue value = spore_parameter_load(place_of(options, k), &options->fields);
    memcpy(places[k], value.number, sizeof places[k]);
    given = given || memcmp(places[k], places[0], sizeof places[k]) != 0;
  }
  return given;
}

void spore_generate_set_places(SporeGenerateOptions *options, double places[SPORE_GENERATOR_PLACES][3]) {
  for (guint k = 0; k < spore_generate_place_count(options); k++) {
    SporeValue value = {.type = SPORE_VECTOR};
    if (places) memcpy(value.number, places[k], sizeof places[k]);
    spore_parameter_store(place_of(options, k), &value, &options->fields);
  }
}

SporeGenerateOptions spore_generate_by_number(const SporeGenerateOptions *options) {
  SporeGenerateOptions copy = *options;
  spore_generate_set_count(&copy, 0);
  return copy;
}

gboolean spore_generate_differ_by_number(const SporeGenerateOptions *a, const SporeGenerateOptions *b) {
  if (a->kind != b->kind) return FALSE;
  SporeGenerateOptions x = spore_generate_by_number(a), y = spore_generate_by_number(b);
  SporeParameterTable table = spore_generator_table(spore_generators[a->kind]);
  for (size_t i = 0; i < table.count; i++) {
    const SporeParameter *parameter = &table.parameters[i];
    if (!spore_generator_takes(spore_generators[a->kind], parameter)) continue;
    SporeValue one = spore_parameter_load(parameter, &x.fields), other = spore_parameter_load(parameter, &y.fields);
    if (!spore_value_equal(&one, &other)) return FALSE;
  }
  return TRUE;
}

/* Work. */

SporeObject *spore_generate_source(SporeDocument *document, SporeObject *body, SporeGenerateKind kind, GError **error) {
  return spore_edit_generator_source(document, body, spore_generate_target(document, body, kind), error);
}

static SporeGenerateWork *new_of_labels(const SporeGenerateOptions *options) {
  SporeGenerateWork *work = g_atomic_rc_box_new0(SporeGenerateWork);
  work->options = *options;
  work->source = g_strdup(spore_label_source_file(options->labels));
  spore_label_source_ref(options->labels);
  return work;
}

static gboolean same_regions(const SporeGenerateWork *work, const SporeObject *asset) {
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  gsize count;
  return spore_edit_generator_regions(asset, regions, &count, NULL) && count == work->own_region_count &&
         memcmp(regions, work->regions, count * sizeof *regions) == 0;
}

static bool copy_cells(SporeTetrahedralMesh *copy, const SporeTetrahedralMesh *cells, SporeError *error) {
  if (!spore_tetrahedral_mesh_allocate(copy, cells->vertex_count, cells->tetrahedron_count, error)) return false;
  memcpy(copy->vertices, cells->vertices, 3 * cells->vertex_count * sizeof *cells->vertices);
  memcpy(copy->tetrahedra, cells->tetrahedra, 4 * cells->tetrahedron_count * sizeof *cells->tetrahedra);
  return true;
}

SporeGenerateWork *spore_generate_work_new(SporeDocument *document, SporeObject *body,
                                           const SporeGenerateOptions *options, GError **error) {
  if (options->kind == SPORE_GENERATE_LABELS) return new_of_labels(options);
  SporeObject *asset = spore_generate_source(document, body, options->kind, error);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, error) : NULL;
  if (!mesh) return NULL;
  SporeGenerateWork *work = g_atomic_rc_box_new0(SporeGenerateWork);
  SporeError failure = SPORE_ERROR_INIT;
  work->options = *options;
  work->body = spore_object_id(body);
  work->source = g_strdup(spore_object_name(asset));
  work->source_hash = spore_document_asset_hash(document, asset);
  SporeObject *target = spore_generate_target(document, body, options->kind);
  if (spore_edit_generator_regions(target, work->regions, &work->region_count, error)) {
    work->own_region_count = work->region_count;
    const SporeTetrahedralMesh *cells =
        options->kind == SPORE_GENERATE_SPHERES ? spore_edit_body_cells(document, body) : NULL;
    if (spore_triangle_mesh_copy(&work->mesh, mesh, &failure) && (!cells || copy_cells(&work->cells, cells, &failure)))
      return work;
    spore_error_propagate(&failure, error);
  }
  spore_generate_work_unref(work);
  return NULL;
}

static void clear_work(gpointer data) {
  SporeGenerateWork *work = data;
  g_free(work->source);
  g_free(work->source_hash);
  spore_triangle_mesh_clear(&work->mesh);
  spore_tetrahedral_mesh_clear(&work->cells);
  spore_sphere_set_clear(&work->spheres);
  spore_spheres_quality_clear(&work->spheres_quality);
  spore_tetrahedral_mesh_clear(&work->tetrahedra);
  g_clear_pointer(&work->label_report.labels, g_array_unref);
  g_clear_pointer(&work->surroundings, g_array_unref);
  g_clear_pointer(&work->options.labels, spore_label_source_unref);
  spore_curve_clear(&work->curve);
  spore_curve_clear(&work->root);
  spore_free(work->curve_way);
  spore_triangle_mesh_clear(&work->surface);
  spore_free(work->surface_distance);
}

SporeGenerateWork *spore_generate_work_ref(SporeGenerateWork *work) { return g_atomic_rc_box_acquire(work); }

void spore_generate_work_unref(gpointer data) { g_atomic_rc_box_release_full(data, clear_work); }

gboolean spore_generate_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  return spore_generators[work->options.kind]->run(work, progress, error);
}

SporeObject *spore_generate_work_body(const SporeGenerateWork *work, SporeDocument *document) {
  SporeObject *body = spore_document_by_id(document, work->body);
  SporeObject *asset = body ? spore_generate_source(document, body, work->options.kind, NULL) : NULL;
  if (!asset || g_strcmp0(spore_object_name(asset), work->source) != 0 ||
      !same_regions(work, spore_generate_target(document, body, work->options.kind)))
    return NULL;
  g_autofree char *hash = spore_document_asset_hash(document, asset);
  return g_strcmp0(hash, work->source_hash) == 0 ? body : NULL;
}

gboolean spore_generate_work_holds(const SporeGenerateWork *work, SporeDocument *document) {
  return work->options.kind == SPORE_GENERATE_LABELS || spore_generate_work_body(work, document);
}

gboolean spore_generate_work_apply(const SporeGenerateWork *work, SporeDocument *document, GError **error) {
  if (!spore_generate_work_holds(work, document))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, work->source,
        _("the mesh or its regions changed meanwhile and the result was dropped; generate it again"));
  SporeObject *body = spore_document_by_id(document, work->body); /* none where it came from a file */
  return spore_generators[work->options.kind]->apply(work, document, body, error);
}
