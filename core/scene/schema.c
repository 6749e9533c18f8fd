/* Object types of a scene, made from the tables of the scene and from the registries of models, links and tools. */
#include "core/scene/schema.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/base/name.h"
#include "core/scene/schema_tables.h"

/* A type with what it owns. */
typedef struct SchemaType {
  SporeObjectType type;
  SporeParameterTable table;
  SporeParameter *parameters; /* NULL where the table is a model's own */
  SporeValue *initial;
} SchemaType;

struct SporeSchema {
  SporeModelRegistry registry;
  GPtrArray *types;         /* SchemaType *, root first */
  GHashTable *by_key;       /* element, or what tells it from others of that name -> SchemaType * */
  const char **integrators; /* "scene", then spore_integrator_names */
};

static void free_type(gpointer data) {
  SchemaType *entry = data;
  for (size_t i = 0; i < entry->table.count; i++) spore_value_clear(&entry->initial[i]);
  g_free(entry->initial);
  g_free(entry->parameters);
  g_ptr_array_unref(entry->type.children);
  g_free(entry);
}

static SchemaType *add_type(SporeSchema *schema, const char *element, const char *key, const char *label,
                            const char *doc) {
  SchemaType *entry = g_new0(SchemaType, 1);
  entry->type.element = element, entry->type.label = label, entry->type.doc = doc;
  entry->type.children = g_ptr_array_new();
  entry->type.table = &entry->table;
  g_ptr_array_add(schema->types, entry);
  entry->type.key = key ? key : element;
  gboolean is_new = g_hash_table_insert(schema->by_key, (gpointer)entry->type.key, entry);
  g_assert(is_new);
  return entry;
}

static void finish_table(SchemaType *entry, const SporeParameter *parameters, size_t count, size_t size) {
  entry->table = (SporeParameterTable){parameters, count, size};
  entry->initial = g_new0(SporeValue, count);
  for (size_t i = 0; i < count; i++)
    if (!spore_parameter_initial(&parameters[i], &entry->initial[i])) g_error("not enough memory");
  entry->type.initial = entry->initial;
}

/* An element's own parameters, then those of the kernel's table that it takes over. */
static void add_element(SporeSchema *schema, const SporeElement *element) {
  SchemaType *entry = add_type(schema, element->element, element->key, element->label, element->doc);
  entry->type.ordered = element->ordered, entry->type.single_child = element->single_child;
  size_t extra = element->extra ? element->extra->count : 0;
  entry->parameters = g_new0(SporeParameter, element->count + extra);
  for (size_t i = 0; i < element->count; i++) {
    entry->parameters[i] = element->parameters[i];
    if (element->parameters[i].type == SPORE_CHOICE && !element->parameters[i].choices)
      entry->parameters[i].choices = schema->integrators;
  }
  for (size_t i = 0; i < extra; i++) {
    SporeParameter *parameter = &entry->parameters[element->count + i];
    *parameter = element->extra->parameters[i];
    parameter->offset += element->extra_offset;
  }
  finish_table(entry, entry->parameters, element->count + extra, element->size);
}

/* An element of a kind that a registry lists, as a child of `parent`. */
static SchemaType *add_kind(SporeSchema *schema, const char *parent, const char *element, const char *label,
                            const char *doc, const SporeParameterTable *table) {
  SchemaType *entry = add_type(schema, element, NULL, label, doc);
  finish_table(entry, table->parameters, table->count, table->size);
  SchemaType *above = g_hash_table_lookup(schema->by_key, parent);
  g_ptr_array_add(above->type.children, &entry->type);
  return entry;
}

static void add_model(SporeSchema *schema, const SporeModelType *model) {
  add_kind(schema, "mechanical", model->name, model->label, model->doc, &model->parameters)->type.model = model;
}

static void add_link(SporeSchema *schema, const SporeLinkType *link) {
  add_kind(schema, "links", link->element, link->label, link->doc, &link->parameters);
}

/* What a tool that is also an effect says of that, by the tool's own table. */
static void add_tool(SporeSchema *schema, const SporeToolType *tool) {
  SchemaType *entry = add_kind(schema, "tools", tool->element, tool->label, tool->doc, &tool->parameters);
  g_autofree char *key = g_strdup_printf("%s/fidelity", tool->element);
  entry->type.ordered = TRUE; /* at most one of each child */
  if (tool->set_effect) g_ptr_array_add(entry->type.children, (gpointer)spore_schema_find(schema, key));
}

static void add_step(SporeSchema *schema, const SporeEventKind *step) {
  add_kind(schema, "exercise", step->element, step->label, step->doc, &step->parameters);
}

static void add_metric(SporeSchema *schema, const SporeMetricKind *metric) {
  add_kind(schema, "exercise", metric->element, metric->label, metric->doc, &metric->parameters);
}

static const char **integrator_choices(void) {
  size_t count = 0;
  while (spore_integrator_names[count]) count++;
  const char **choices = g_new0(const char *, count + 2);
  choices[0] = "scene";
  for (size_t i = 0; i < count; i++) choices[i + 1] = spore_integrator_names[i];
  return choices;
}

static void add_children(SporeSchema *schema, const SporeElement *element) {
  SchemaType *entry = g_hash_table_lookup(schema->by_key, element->key ? element->key : element->element);
  for (const char *const *child = element->children; child && *child; child++)
    g_ptr_array_add(entry->type.children, (gpointer)spore_schema_find(schema, *child));
}

static void add_elements(SporeSchema *schema, const SporeElement *elements) {
  for (; elements->element; elements++) add_element(schema, elements);
}

static void add_all_children(SporeSchema *schema, const SporeElement *elements) {
  for (; elements->element; elements++) add_children(schema, elements);
}

SporeSchema *spore_schema_new(SporeModelRegistry registry, const SporeElement *const *assets) {
  static const SporeElement *const parts[] = {spore_scene_elements, spore_body_elements, spore_link_elements,
                                              spore_tool_elements};
  SporeSchema *schema = g_new0(SporeSchema, 1);
  schema->registry = registry;
  schema->types = g_ptr_array_new_with_free_func(free_type);
  schema->by_key = g_hash_table_new(g_str_hash, g_str_equal);
  schema->integrators = integrator_choices();
  for (gsize p = 0; p < G_N_ELEMENTS(parts); p++) add_elements(schema, parts[p]);
  for (gsize p = 0; assets[p]; p++) add_elements(schema, assets[p]);
  for (gsize p = 0; p < G_N_ELEMENTS(parts); p++) add_all_children(schema, parts[p]);
  SchemaType *holder = g_hash_table_lookup(schema->by_key, "assets");
  for (gsize p = 0; assets[p]; p++) {
    add_all_children(schema, assets[p]);
    g_ptr_array_add(holder->type.children, (gpointer)spore_schema_find(schema, assets[p]->element));
  }
  ((SchemaType *)g_hash_table_lookup(schema->by_key, "collision"))->type.defaults = "contact";
  for (SporeModelRegistry model = registry; *model; model++) add_model(schema, *model);
  for (const SporeLinkType *const *link = spore_link_types; *link; link++) add_link(schema, *link);
  for (const SporeToolType *const *tool = spore_tool_types; *tool; tool++) add_tool(schema, *tool);
  for (const SporeEventKind *const *step = spore_event_kinds; *step; step++) add_step(schema, *step);
  for (const SporeMetricKind *const *metric = spore_metric_kinds; *metric; metric++) add_metric(schema, *metric);
  return schema;
}

void spore_schema_free(SporeSchema *schema) {
  if (!schema) return;
  g_hash_table_unref(schema->by_key);
  g_ptr_array_unref(schema->types);
  g_free(schema->integrators);
  g_free(schema);
}

SporeModelRegistry spore_schema_registry(const SporeSchema *schema) { return schema->registry; }

const SporeObjectType *spore_schema_root(const SporeSchema *schema) {
  return &((const SchemaType *)g_ptr_array_index(schema->types, 0))->type;
}

const SporeObjectType *spore_schema_find(const SporeSchema *schema, const char *key) {
  const SchemaType *entry = g_hash_table_lookup(schema->by_key, key);
  return entry ? &entry->type : NULL;
}

const SporeObjectType *spore_object_type_child(const SporeObjectType *parent, const char *element) {
  for (guint i = 0; i < parent->children->len; i++) {
    const SporeObjectType *child = g_ptr_array_index(parent->children, i);
    if (strcmp(child->element, element) == 0) return child;
  }
  return NULL;
}

const char *spore_object_type_nearest_child(const SporeObjectType *parent, const char *element) {
  g_autofree const char **names = g_new0(const char *, parent->children->len + 1);
  for (guint i = 0; i < parent->children->len; i++)
    names[i] = ((const SporeObjectType *)g_ptr_array_index(parent->children, i))->element;
  return spore_name_nearest(names, element);
}

/* Digits at the start of the text; 0: none, or more than four. */
static size_t count_digits(const char *text) {
  size_t count = strspn(text, "0123456789");
  return count <= 4 ? count : 0;
}

bool spore_format_version_check(const char *version, SporeError *error) {
  size_t major = count_digits(version), end = major;
  if (major > 0 && version[end] == '.') end += 1 + count_digits(version + end + 1);
  if (major == 0 || version[end] || version[end - 1] == '.' || (version[0] == '0' && major > 1))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("version=\"%.40s\" is not a version; expected major.minor; write version=\"%d.%d\""),
                           version, SPORE_FORMAT_MAJOR, SPORE_FORMAT_MINOR);
  int number = (int)g_ascii_strtoll(version, NULL, 10);
  if (number != SPORE_FORMAT_MAJOR)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        number > SPORE_FORMAT_MAJOR
            ? _("the file has format version %.40s; this SPORE reads %d.x; a newer SPORE opens it")
            : _("the file has format version %.40s, which never was; this SPORE reads %d.x; correct it"),
        version, SPORE_FORMAT_MAJOR);
  return true;
}
