/* Models: creation of their common part, and the check of a model type. */
#include "core/body/model.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

SporeModel *spore_model_create(const SporeModelType *type, const SporeGeometry *geometry, const void *fields,
                               SporeError *error) {
  assert(type && geometry && fields);
  SporeModel *model = type->create(geometry, fields, error);
  if (!spore_cancel_asked(geometry->cancel)) return model;
  if (model) type->destroy(model);
  spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  return NULL;
}

bool spore_model_init(SporeModel *model, const SporeModelType *type, size_t node_count, bool framed,
                      SporeError *error) {
  assert(type);
  size_t block_count = node_count + framed;
  *model = (SporeModel){
      .type = type, .q_count = 3 * node_count + (framed ? 4 : 0), .block_count = block_count, .node_count = node_count};
  model->q_room = model->q_count;
  model->block_room = block_count;
  model->block_mass = SPORE_NEW_ARRAY(double, block_count);
  if (model->block_mass) return true;
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a model of %zu blocks"),
                         block_count);
}

void spore_model_clear(SporeModel *model) {
  spore_free(model->block_mass);
  *model = (SporeModel){0};
}

void spore_model_mass(const SporeModel *model, const double *q, double *blocks) {
  assert(blocks);
  for (size_t i = 0; i < model->block_count; i++) {
    double m = model->block_mass[i];
    SporeMat3 block = i < model->node_count ? spore_mat3_diagonal(m, m, m) : model->type->inertia(model, q);
    memcpy(blocks + 9 * i, block.m, sizeof block.m);
  }
}

double spore_model_total_mass(const SporeModel *model) {
  double mass = 0;
  for (size_t i = 0; i < model->block_count; i++) mass += model->block_mass[i];
  return mass;
}

const SporeModelType *spore_model_type_find(SporeModelRegistry registry, const char *name) {
  assert(registry && name);
  for (; *registry; registry++)
    if (!strcmp((*registry)->name, name)) return *registry;
  return NULL;
}

static const char *missing_slot(const SporeModelType *type) {
  if (!type->label) return "label";
  if (!type->doc) return "doc";
  if (!type->create) return "create";
  if (!type->destroy) return "destroy";
  if (!type->place) return "place";
  if (!type->force) return "force";
  if (!type->potential) return "potential";
  if (!type->map) return "map";
  if (type->jacobian && !type->pattern) return "pattern";
  if (type->cut && !type->cut->cut) return "cut.cut";
  if (type->cut && !type->cut->tie && !type->cut->split) return "cut.tie";
  if (type->cut && type->cut->split && (!type->cut->corners || !type->settle)) return "cut.corners and settle";
  if (type->heat && (!type->heat->prepare || !type->heat->coagulate)) return "heat";
  if (type->adapt && (!type->adapt->weigh_nodes || !type->adapt->change_nodes || !type->settle)) return "adapt";
  if (type->line && !type->line->path) return "line.path";
  if (type->particles && !type->particles->carry) return "particles.carry";
  return NULL;
}

static bool check_parameter(const SporeParameterTable *table, size_t index, const char *place, SporeError *error) {
  assert(index < table->count);
  const SporeParameter *parameter = &table->parameters[index];
  if (!parameter->name || !parameter->unit || !parameter->doc)
    return spore_error_set(error, SPORE_ERROR_INTERNAL, place, _("parameter %zu has no name, unit or doc"), index);
  if (spore_parameter_find(table, parameter->name) != (int)index)
    return spore_error_set(error, SPORE_ERROR_INTERNAL, place, _("parameter %s is declared twice"), parameter->name);
  if (parameter->offset >= table->size)
    return spore_error_set(error, SPORE_ERROR_INTERNAL, place, _("parameter %s lies outside its structure"),
                           parameter->name);
  if (parameter->required) return true;
  SporeValue value = {0};
  bool good = spore_parameter_initial(parameter, &value) && spore_parameter_check(parameter, &value, error);
  spore_value_clear(&value);
  if (!good) spore_error_at(error, place);
  return good;
}

static bool check_preset(const SporeParameterTable *table, const SporePreset *preset, const char *place,
                         SporeError *error) {
  for (const char *const *setting = preset->settings; *setting; setting += 2) {
    int index = spore_parameter_find(table, setting[0]);
    if (index < 0 || !setting[1])
      return spore_error_set(error, SPORE_ERROR_INTERNAL, place, _("the preset %s sets %s, which is no parameter"),
                             preset->name, setting[0]);
    SporeValue value = {0};
    if (!spore_parameter_parse(&table->parameters[index], setting[1], &value, error)) {
      spore_error_at(error, place);
      return false;
    }
    spore_value_clear(&value);
  }
  return true;
}

bool spore_model_type_check(const SporeModelType *type, SporeError *error) {
  if (!type->name || !*type->name)
    return spore_error_set(error, SPORE_ERROR_INTERNAL, "models", _("a model has no name; every model needs one"));
  char place[128];
  snprintf(place, sizeof place, "models/%s", type->name);
  const char *slot = missing_slot(type);
  if (slot)
    return spore_error_set(error, SPORE_ERROR_INTERNAL, place,
                           _("the model has no `%s`; that slot is required; fill it"), slot);
  for (size_t i = 0; i < type->parameters.count; i++)
    if (!check_parameter(&type->parameters, i, place, error)) return false;
  for (const SporePreset *preset = type->presets; preset && preset->name; preset++)
    if (!check_preset(&type->parameters, preset, place, error)) return false;
  return true;
}

bool spore_model_matrix_create(const SporeModel *model, SporeBlockMatrix *matrix) {
  assert(matrix);
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, model->block_count);
  bool made =
      (!model->type->pattern || model->type->pattern(model, &pattern)) && spore_block_matrix_create(matrix, &pattern);
  spore_block_pattern_clear(&pattern);
  return made;
}
