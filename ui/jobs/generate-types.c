#include "ui/jobs/generate-types.h"

#include <math.h>

#include "core/scene/generated.h"

const SporeGenerateType *spore_generate_type(SporeGenerateKind kind) {
  static const SporeGenerateType *const types[SPORE_GENERATE_KIND_COUNT] = {
      [SPORE_GENERATE_SPHERES] = &spore_generate_spheres, [SPORE_GENERATE_TETRAHEDRA] = &spore_generate_tetrahedra,
      [SPORE_GENERATE_CURVE] = &spore_generate_curve,     [SPORE_GENERATE_SURFACE] = &spore_generate_surface,
      [SPORE_GENERATE_LABELS] = &spore_generate_labels,
  };
  return types[kind];
}

/* Options. */

const SporeParameterTable *spore_generate_table(SporeDocument *document, SporeGenerateKind kind) {
  const SporeObject *assets = spore_document_section(document, "assets");
  return spore_object_type_child(spore_object_type(assets), spore_generate_type(kind)->generator->element)->table;
}

SporeObject *spore_generate_target(SporeDocument *document, SporeObject *body, SporeGenerateKind kind) {
  return spore_generate_type(kind)->generator->target(document, body);
}

SporeGenerateOptions spore_generate_options_of(SporeDocument *document, SporeObject *body, SporeGenerateKind kind) {
  SporeGenerateOptions options = {.kind = kind};
  SporeObject *asset = spore_generate_target(document, body, kind);
  if (asset) spore_object_fields(asset, &options.fields);
  else spore_parameters_set_initial(spore_generate_table(document, kind), &options.fields);
  return options;
}

size_t spore_generate_get_count(const SporeGenerateOptions *options) {
  const SporeGeneratorType *generator = spore_generate_type(options->kind)->generator;
  SporeParameterTable table = spore_generator_table(generator);
  int count = generator->count ? spore_parameter_find(&table, generator->count) : -1;
  return count < 0 ? 0 : (size_t)spore_parameter_load(&table.parameters[count], &options->fields).number[0];
}

void spore_generate_set_count(SporeGenerateOptions *options, size_t count) {
  const SporeGeneratorType *generator = spore_generate_type(options->kind)->generator;
  SporeParameterTable table = spore_generator_table(generator);
  int place = generator->count ? spore_parameter_find(&table, generator->count) : -1;
  if (place < 0 || spore_generate_get_count(options) == count) return;
  const SporeValue value = {.type = SPORE_INTEGER, .number = {(double)count}};
  spore_parameter_store(&table.parameters[place], &value, &options->fields);
  spore_generator_choose_way(generator, spore_generator_way(generator, generator->count), &options->fields);
}

SporeGenerateOptions spore_generate_by_number(const SporeGenerateOptions *options) {
  SporeGenerateOptions copy = *options;
  spore_generate_set_count(&copy, 0);
  return copy;
}

gboolean spore_generate_differ_by_number(const SporeParameterTable *table, const SporeGenerateOptions *a,
                                         const SporeGenerateOptions *b) {
  if (a->kind != b->kind) return FALSE;
  SporeGenerateOptions x = spore_generate_by_number(a), y = spore_generate_by_number(b);
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (!spore_generator_takes(spore_generate_type(a->kind)->generator, parameter)) continue;
    SporeValue one = spore_parameter_load(parameter, &x.fields), other = spore_parameter_load(parameter, &y.fields);
    if (!spore_value_equal(&one, &other)) return FALSE;
  }
  return TRUE;
}

/* Services for the kinds. */

double *spore_generate_scaled(const double *values, gsize count, gsize stride, double scale) {
  double *copy = g_new(double, count);
  for (gsize i = 0; i < count; i++) copy[i] = scale * fabs(values[stride * i]);
  return copy;
}

void spore_generate_show_surface(const SporeTriangleMesh *mesh, float *places, SporeStageCandidate *candidate) {
  candidate->vertex_count = mesh->vertex_count;
  candidate->triangle_count = mesh->triangle_count;
  candidate->vertices = g_memdup2(mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  candidate->triangles = g_memdup2(mesh->triangles, 3 * mesh->triangle_count * sizeof(guint32));
  candidate->vertex_values = places;
}

void spore_generate_show_spheres(const SporeSphereSet *set, float *places, SporeStageCandidate *candidate) {
  candidate->sphere_count = set->count;
  candidate->spheres = g_memdup2(set->spheres, 4 * set->count * sizeof(double));
  spore_spheres_radii(set, candidate->spheres + 3, 4);
  candidate->sphere_values = places;
}

void spore_generate_show_triangles(double *corners, gsize count, float *places, SporeStageCandidate *candidate) {
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

void spore_generate_show_cells(const SporeTetrahedralMesh *mesh, float *places, SporeStageCandidate *candidate) {
  SporeCellFaces faces;
  if (spore_cell_faces(mesh, &candidate->view, &faces, NULL)) {
    float *of_faces = g_new(float, faces.triangle_count);
    for (gsize i = 0; i < faces.triangle_count; i++) of_faces[i] = places[faces.cells[i]];
    double *corners = g_memdup2(faces.vertices, 9 * faces.triangle_count * sizeof(double));
    spore_generate_show_triangles(corners, faces.triangle_count, of_faces, candidate);
  }
  spore_cell_faces_clear(&faces);
  g_free(places);
}
