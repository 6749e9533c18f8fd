#include "ui/panels/spore-inspector.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/compile.h"
#include "core/scene/generated.h"
#include "ui/document/body-marks.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "ui/document/mapping-report.h"
#include "core/author/region_edits.h"
#include "ui/jobs/spore-job.h"
#include "ui/jobs/works.h"
#include "ui/panels/region-list.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-generator-box.h"
#include "ui/panels/spore-property-row.h"

#define DEFAULT_SPHERES 100
#define DEFAULT_CELLS 1000
#define DEFAULT_NODES 300
#define MOST_CELLS 1000000

struct _SporeInspector {
  GtkBox parent;
  GtkWidget *title, *subtitle, *sections;
  SporeEditorDocument *document;
  guint rebuild, refresh;
  GPtrArray *rows; /* SporePropertyRow *, borrowed from the widget tree */
  int placed;      /* sections that a rebuild has been through */
  GtkWidget *mesh_facts, *spheres_box, *tetrahedra_box, *curve_box, *surface_box, *model, *preset, *mapping_facts;
  gboolean filling;
  GHashTable *collapsed; /* set of section titles that the user closed */

  /* How good the spheres are: measured apart, kept by content of mesh and spheres. */
  GHashTable *reports; /* char * -> SporeSpheresReport * */
  char *measured_key;  /* now being measured, or NULL */
  SporeMappingReport mapping;
};

G_DEFINE_FINAL_TYPE(SporeInspector, spore_inspector, GTK_TYPE_BOX)

enum { MARKS_CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static SporeDocument *document_of(SporeInspector *self) { return spore_editor_document_get(self->document); }

/* Sections. */

static void section_toggled(GtkExpander *expander, GParamSpec *spec, SporeInspector *self) {
  const char *title = gtk_widget_get_name(GTK_WIDGET(expander));
  if (gtk_expander_get_expanded(expander)) g_hash_table_remove(self->collapsed, title);
  else g_hash_table_add(self->collapsed, g_strdup(title));
}

/* What tells one section from another: title, path of what it shows, and what holds the regions that it lists (may be
 * NULL) with their names. */
static char *key_of(const char *title, const char *path, const SporeObject *holder) {
  GString *key = g_string_new(title);
  g_string_append_printf(key, "|%s", path);
  if (!holder) return g_string_free(key, FALSE);
  g_autofree char *held = spore_object_path(holder);
  gboolean generated = spore_parameter_find(spore_object_type(holder)->table, "source") >= 0;
  const char *source = generated ? spore_object_text(holder, "source") : NULL;
  g_string_append_printf(key, "|%s|%s", held, source ? source : "");
  for (guint i = 0; i < spore_object_child_count(holder); i++)
    g_string_append_printf(key, "|%s", spore_object_name(spore_object_child(holder, i)));
  return g_string_free(key, FALSE);
}

static GtkWidget *find_section(SporeInspector *self, const char *key) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self->sections));
  for (GList *section = sections; section; section = section->next)
    if (g_str_equal(g_object_get_data(section->data, "key"), key)) return section->data;
  return NULL;
}

static GPtrArray *rows_of(GtkBox *box) {
  return g_object_get_data(G_OBJECT(gtk_widget_get_parent(GTK_WIDGET(box))), "rows");
}

static GtkWidget *new_section(SporeInspector *self, const char *title, const char *key) {
  GtkWidget *expander = gtk_expander_new(title);
  gtk_widget_set_name(expander, title);
  gtk_expander_set_expanded(GTK_EXPANDER(expander), !g_hash_table_contains(self->collapsed, title));
  g_signal_connect(expander, "notify::expanded", G_CALLBACK(section_toggled), self);
  gtk_style_context_add_class(gtk_widget_get_style_context(expander), "section");
  g_object_set_data_full(G_OBJECT(expander), "key", g_strdup(key), g_free);
  g_object_set_data_full(G_OBJECT(expander), "rows", g_ptr_array_new(), (GDestroyNotify)g_ptr_array_unref);
  gtk_container_add(GTK_CONTAINER(self->sections), expander);
  return expander;
}

/* The box to fill; NULL: it stays as it is, since it shows the same. Making widgets takes long. */
static GtkBox *add_section(SporeInspector *self, const char *title, const char *path, const SporeObject *holder) {
  g_autofree char *key = key_of(title, path, holder);
  GtkWidget *old = find_section(self, key), *section = old ? old : new_section(self, title, key);
  gtk_box_reorder_child(GTK_BOX(self->sections), section, self->placed++);
  if (old) return NULL;
  GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2);
  gtk_style_context_add_class(gtk_widget_get_style_context(box), "section-body");
  gtk_container_add(GTK_CONTAINER(section), box);
  return GTK_BOX(box);
}

/* Those that the rebuild has not come to show something that is not selected any more. */
static void drop_old_sections(SporeInspector *self) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self->sections));
  for (GList *old = g_list_nth(sections, (guint)self->placed); old; old = old->next) gtk_widget_destroy(old->data);
}

static void collect_rows(SporeInspector *self) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self->sections));
  g_ptr_array_set_size(self->rows, 0);
  for (GList *section = sections; section; section = section->next) {
    GPtrArray *rows = g_object_get_data(section->data, "rows");
    for (guint i = 0; i < rows->len; i++) g_ptr_array_add(self->rows, rows->pdata[i]);
  }
}

/* One row a parameter of the table. */
static void add_rows(SporeInspector *self, GtkBox *box, const char *path, const SporeObjectType *type) {
  for (gsize i = 0; i < type->table->count; i++) {
    GtkWidget *row = spore_property_row_new(self->document, path, type, (guint)i);
    gtk_container_add(GTK_CONTAINER(box), row);
    g_ptr_array_add(rows_of(box), row);
  }
}

static void add_object(SporeInspector *self, GtkBox *box, SporeObject *object) {
  g_autofree char *path = spore_object_path(object);
  add_rows(self, box, path, spore_object_type(object));
}

/* A unit of the body, there or not: the first change of a row makes it. */
static void add_unit(SporeInspector *self, GtkBox *box, SporeObject *body, const char *element) {
  const SporeObjectType *type = spore_object_type_child(spore_object_type(body), element);
  g_autofree char *parent = spore_object_path(body);
  g_autofree char *path = g_strconcat(parent, "/", element, NULL);
  if (type) add_rows(self, box, path, type);
}

static GtkWidget *add_fact(GtkBox *box) {
  GtkWidget *label = gtk_label_new(NULL);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_label_set_max_width_chars(GTK_LABEL(label), 40);
  gtk_style_context_add_class(gtk_widget_get_style_context(label), "dim-label");
  gtk_style_context_add_class(gtk_widget_get_style_context(label), "result");
  gtk_container_add(GTK_CONTAINER(box), label);
  return label;
}

/* Facts. */

static void show_mesh_facts(SporeInspector *self, SporeObject *body) {
  g_autoptr(GError) error = NULL;
  SporeObject *asset = spore_edit_visual_mesh(document_of(self), body, NULL);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document_of(self), asset, &error) : NULL;
  SporeMeshReport report;
  if (!mesh || !spore_triangle_mesh_report(mesh, &report, NULL)) {
    gtk_label_set_text(GTK_LABEL(self->mesh_facts), error ? error->message : _("No mesh is shown"));
    return;
  }
  g_autofree char *text =
      g_strdup_printf(_("%zu triangles, %.3g × %.3g × %.3g mm, %s"), mesh->triangle_count,
                      1e3 * (report.upper[0] - report.lower[0]), 1e3 * (report.upper[1] - report.lower[1]),
                      1e3 * (report.upper[2] - report.lower[2]), report.closed ? _("closed") : _("not closed"));
  gtk_label_set_text(GTK_LABEL(self->mesh_facts), text);
}

/* What became of the asset since it was generated, a line each. */
static void append_state(SporeInspector *self, SporeObject *asset, GString *text) {
  SporeGenerated generated = spore_generated_state(document_of(self), asset);
  SporeObject *source = generated == SPORE_GENERATED_SOURCE_CHANGED ? spore_object_reference(asset, "source") : NULL;
  gboolean labels = source && g_str_equal(spore_object_type(source)->element, "label_map");
  if (source)
    g_string_append(text,
                    labels ? _("\nStale: the label map has changed since") : _("\nStale: the mesh has changed since"));
  if (generated == SPORE_GENERATED_OPTIONS_CHANGED) g_string_append(text, _("\nStale: the options have changed since"));
  if (spore_generated_is(asset, "edited")) g_string_append(text, _("\nEdited by hand"));
  if (spore_generated_is(asset, "frozen"))
    g_string_append(text, _("\nFrozen: nothing generates it again; it may be edited by hand"));
}

static guint last_count(SporeObject *asset, const char *property, guint otherwise) {
  return asset ? (guint)spore_object_number(asset, property) : otherwise;
}

static void show_state(SporeInspector *self, GtkWidget *box, const char *text, SporeObject *asset, const char *count) {
  SporeGenerated generated = asset ? spore_generated_state(document_of(self), asset) : SPORE_GENERATED_NOT;
  g_autofree char *path = asset ? spore_object_path(asset) : NULL;
  SporeGeneratorState state = {.asset = path,
                               .count = last_count(asset, count, 0),
                               .generated = generated != SPORE_GENERATED_NOT,
                               .stale = generated == SPORE_GENERATED_SOURCE_CHANGED ||
                                        generated == SPORE_GENERATED_OPTIONS_CHANGED,
                               .frozen = asset && spore_generated_is(asset, "frozen")};
  spore_generator_box_set_result(SPORE_GENERATOR_BOX(box), text, state);
}

static gboolean refresh(gpointer data);

static void queue_refresh(SporeInspector *self) {
  if (!self->refresh && !self->rebuild) self->refresh = g_idle_add_full(G_PRIORITY_HIGH_IDLE, refresh, self, NULL);
}

static void measured(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeInspector *self = owner;
  SporeGenerateWork *work = data;
  char *key = g_steal_pointer(&self->measured_key);
  /* What cannot be measured is kept too (all zero), so that it is not tried again and again. */
  g_hash_table_replace(self->reports, key, g_memdup2(&work->spheres_report, sizeof work->spheres_report));
  if (self->document) queue_refresh(self);
}

/* NULL while it is being measured. */
static const SporeSpheresReport *report_of(SporeInspector *self, SporeObject *body, SporeObject *asset,
                                           const SporeSphereSet *set) {
  SporeObject *mesh = spore_edit_visual_mesh(document_of(self), body, NULL);
  if (!mesh) return NULL;
  g_autofree char *mesh_hash = spore_document_asset_hash(document_of(self), mesh);
  g_autofree char *set_hash = spore_document_asset_hash(document_of(self), asset);
  g_autofree char *key = g_strconcat(mesh_hash ? mesh_hash : "", set_hash, NULL);
  const SporeSpheresReport *report = g_hash_table_lookup(self->reports, key);
  if (report || self->measured_key) return report;
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_SPHERES};
  SporeGenerateWork *work = spore_generate_work_new(document_of(self), body, &options, NULL);
  if (!work) return NULL;
  if (!spore_sphere_set_allocate(&work->spheres, set->count, NULL)) {
    spore_generate_work_unref(work);
    return NULL;
  }
  memcpy(work->spheres.spheres, set->spheres, set->count * 4 * sizeof(double));
  if (set->weights && spore_sphere_set_add_weights(&work->spheres, NULL))
    memcpy(work->spheres.weights, set->weights, set->count * sizeof(double)), work->spheres.level = set->level;
  self->measured_key = g_steal_pointer(&key);
  g_object_unref(spore_job_start(_("Measuring spheres"), spore_measure_work_run, work, spore_generate_work_unref,
                                 measured, G_OBJECT(self)));
  return NULL;
}

static void show_spheres(SporeInspector *self, SporeObject *body) {
  SporeObject *asset = spore_edit_body_spheres(document_of(self), body);
  g_autoptr(GError) error = NULL;
  const SporeSphereSet *set = asset ? spore_document_spheres(document_of(self), asset, &error) : NULL;
  if (!set) {
    const char *none =
        spore_body_has_own_spheres(body) ? _("The model's own spheres") : _("No spheres yet: the body touches nothing");
    show_state(self, self->spheres_box, error ? error->message : none, NULL, "count");
    return;
  }
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu spheres"), set->count);
  const SporeSpheresReport *report = report_of(self, body, asset, set);
  if (report && report->coverage > 0)
    g_string_append_printf(text, _("\nCoverage %.1f %%, outside %.1f %%\nDepth error %.1f %%, distance %.2f %%"),
                           100 * report->coverage, 100 * report->outside, 100 * spore_spheres_felt_error(report),
                           100 * report->distance_mean);
  else if (self->measured_key) g_string_append(text, _(", measuring…"));
  append_state(self, asset, text);
  show_state(self, self->spheres_box, text->str, asset, "count");
  g_string_free(text, TRUE);
}

static void show_tetrahedra(SporeInspector *self, SporeObject *body) {
  SporeObject *asset = spore_edit_body_tetrahedra(document_of(self), body);
  g_autoptr(GError) error = NULL;
  const SporeTetrahedralMesh *mesh = asset ? spore_document_tetrahedra(document_of(self), asset, &error) : NULL;
  if (!mesh) {
    show_state(self, self->tetrahedra_box, error ? error->message : _("No tetrahedra yet"), NULL, "cells");
    return;
  }
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(mesh, &quality);
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu tetrahedra, %.3g ml\nLeast angle %.1f°, mean %.1f°"), mesh->tetrahedron_count,
                         1e6 * quality.volume, quality.min_dihedral_deg, quality.mean_dihedral_deg);
  append_state(self, asset, text);
  show_state(self, self->tetrahedra_box, text->str, asset, "cells");
  g_string_free(text, TRUE);
}

static void show_curve(SporeInspector *self, SporeObject *body) {
  SporeObject *asset = spore_edit_body_curve(document_of(self), body);
  g_autoptr(GError) error = NULL;
  const SporeCurve *curve = asset ? spore_document_curve(document_of(self), asset, &error) : NULL;
  if (!curve) {
    show_state(self, self->curve_box, error ? error->message : _("No middle line yet"), NULL, "points");
    return;
  }
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu points, %.1f mm long"), curve->count, 1e3 * spore_curve_length(curve));
  append_state(self, asset, text);
  show_state(self, self->curve_box, text->str, asset, "points");
  g_string_free(text, TRUE);
}

static void show_surface(SporeInspector *self, SporeObject *body) {
  SporeObject *asset = spore_edit_body_surface(document_of(self), body);
  g_autoptr(GError) error = NULL;
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document_of(self), asset, &error) : NULL;
  if (!mesh) {
    show_state(self, self->surface_box, error ? error->message : _("No generated surface yet"), NULL, "nodes");
    return;
  }
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu nodes, %zu triangles"), mesh->vertex_count, mesh->triangle_count);
  append_state(self, asset, text);
  show_state(self, self->surface_box, text->str, asset, "nodes");
  g_string_free(text, TRUE);
}

static void show_mapping(SporeInspector *self, SporeObject *body) {
  gboolean holds = spore_mapping_report_holds(&self->mapping, document_of(self), body);
  const char *why = self->mapping.body == spore_object_id(body)
                        ? _("The scene has changed since it was measured")
                        : _("How well what is drawn and felt follows what moves it: not measured yet");
  g_autofree char *text = holds ? spore_mapping_report_text(&self->mapping) : g_strdup(why);
  gtk_label_set_text(GTK_LABEL(self->mapping_facts), text);
}

static void show_model(SporeInspector *self, SporeObject *body) {
  SporeObject *model = spore_edit_body_model(body);
  self->filling = TRUE;
  gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->model), model ? spore_object_type(model)->element : "");
  self->filling = FALSE;
}

/* Whether the model has the preset's values. */
static gboolean has_preset(SporeObject *model, const SporePreset *preset) {
  const SporeParameterTable *table = spore_object_type(model)->table;
  gboolean same = TRUE;
  for (const char *const *setting = preset->settings; *setting && same; setting += 2) {
    SporeValue value = {0};
    int index = spore_parameter_find(table, setting[0]);
    same = index >= 0 && spore_parameter_parse(&table->parameters[index], setting[1], &value, NULL) &&
           spore_value_equal(&value, spore_object_value(model, (guint)index));
    spore_value_clear(&value);
  }
  return same;
}

static void show_preset(SporeInspector *self, SporeObject *model) {
  const SporePreset *preset = model ? spore_object_type(model)->model->presets : NULL;
  while (preset && preset->name && !has_preset(model, preset)) preset++;
  self->filling = TRUE;
  gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->preset), preset && preset->name ? preset->name : "");
  self->filling = FALSE;
}

static void show_facts(SporeInspector *self) {
  SporeObject *body = spore_editor_document_selected_body(self->document);
  if (!body || !self->model) return;
  show_mesh_facts(self, body);
  show_spheres(self, body);
  show_tetrahedra(self, body);
  show_curve(self, body);
  show_surface(self, body);
  show_model(self, body);
  if (self->preset) show_preset(self, spore_edit_body_model(body));
  if (self->mapping_facts) show_mapping(self, body);
}

SporeStageMarks spore_inspector_get_marks(SporeInspector *self) {
  SporeObject *body = self->document ? spore_editor_document_selected_body(self->document) : NULL;
  if (!body) return (SporeStageMarks){0};
  SporeStageMarks marks = {.body = spore_object_id(body)};
  marks.segments = spore_body_marks(document_of(self), body, &self->mapping, &marks.count);
  return marks;
}

void spore_inspector_set_mapping(SporeInspector *self, SporeMappingReport *report) {
  spore_mapping_report_clear(&self->mapping);
  self->mapping = *report;
  *report = (SporeMappingReport){0};
  SporeObject *body = spore_editor_document_selected_body(self->document);
  if (body && self->mapping_facts) show_mapping(self, body);
  g_signal_emit(self, signals[MARKS_CHANGED], 0);
}

/* What is selected. */

static void model_chosen(GtkComboBox *combo, SporeInspector *self) {
  const char *id = gtk_combo_box_get_active_id(combo);
  if (id && !self->filling) spore_activate(GTK_WIDGET(self), "set-model", g_variant_new_string(id));
}

/* A line of `box` with a list to choose from. */
static GtkComboBoxText *add_choice(GtkBox *box, const char *text) {
  GtkWidget *line = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *label = gtk_label_new(text);
  GtkWidget *combo = gtk_combo_box_text_new();
  spore_ignore_wheel(combo);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), combo);
  gtk_widget_set_hexpand(label, TRUE);
  gtk_style_context_add_class(gtk_widget_get_style_context(line), "generator");
  gtk_container_add(GTK_CONTAINER(line), label);
  gtk_container_add(GTK_CONTAINER(line), combo);
  gtk_container_add(GTK_CONTAINER(box), line);
  return GTK_COMBO_BOX_TEXT(combo);
}

static void add_model_choice(SporeInspector *self, GtkBox *box) {
  GtkComboBoxText *combo = add_choice(box, _("Model"));
  g_set_weak_pointer(&self->model, GTK_WIDGET(combo));
  gtk_combo_box_text_append(combo, "", _("None"));
  SporeModelRegistry registry = spore_schema_registry(spore_document_schema(document_of(self)));
  for (; *registry; registry++) gtk_combo_box_text_append(combo, (*registry)->name, _((*registry)->label));
  g_signal_connect(combo, "changed", G_CALLBACK(model_chosen), self);
}

static void preset_chosen(GtkComboBox *combo, SporeInspector *self) {
  const char *id = gtk_combo_box_get_active_id(combo);
  if (id && *id && !self->filling) spore_activate(GTK_WIDGET(self), "use-preset", g_variant_new_string(id));
}

static void add_preset_choice(SporeInspector *self, GtkBox *box, SporeObject *model) {
  const SporePreset *preset = spore_object_type(model)->model->presets;
  if (!preset) return;
  GtkComboBoxText *combo = add_choice(box, _("Preset"));
  g_set_weak_pointer(&self->preset, GTK_WIDGET(combo));
  gtk_combo_box_text_append(combo, "", _("Own values"));
  for (; preset->name; preset++) {
    g_autofree char *text = g_strdup_printf("%s (%s)", _(preset->label), preset->source);
    gtk_combo_box_text_append(combo, preset->name, text);
  }
  g_signal_connect(combo, "changed", G_CALLBACK(preset_chosen), self);
}

/* Parts of other tissue, for models that know of such, and for those that do not but have been given some. */
static void add_regions(SporeInspector *self, SporeObject *body, SporeObject *model) {
  const SporeModelType *type = spore_object_type(model)->model;
  const SporeObject *regions = spore_object_child_of(body, "regions");
  if (!(type && type->regions) && !regions) return;
  const SporeObjectType *holder = spore_object_type_child(spore_object_type(body), "regions");
  g_autofree char *parent = spore_object_path(body);
  g_autofree char *path = g_strconcat(parent, "/regions", NULL);
  GtkBox *box = add_section(self, _("Regions"), path, regions);
  if (!box) return;
  spore_fill_region_list(box, self->document, path, holder,
                         _("All of it is of one tissue: a region is a part of another stiffness, density or tissue"),
                         rows_of(box));
}

/* Of what a generator made: where it shall be finer. */
static void add_generator_regions(SporeInspector *self, GtkBox *box, SporeObject *asset, const char *empty) {
  const char *source = asset ? spore_object_text(asset, "source") : NULL;
  if (!asset || (!source && !spore_object_child_count(asset))) return;
  g_autofree char *path = spore_object_path(asset);
  spore_fill_region_list(box, self->document, path, spore_object_type(asset), empty, rows_of(box));
}

static void add_mapping(SporeInspector *self, const char *path) {
  GtkBox *box = add_section(self, _("Mapping"), path, NULL);
  if (!box) return;
  g_set_weak_pointer(&self->mapping_facts, add_fact(box));
  GtkWidget *measure = gtk_button_new_with_label(_("Measure mapping"));
  gtk_widget_set_halign(measure, GTK_ALIGN_START);
  gtk_widget_set_tooltip_text(measure,
                              _("Compile the scene and measure how far vertices and spheres are carried wrong"));
  gtk_actionable_set_action_name(GTK_ACTIONABLE(measure), "win.measure-mapping");
  gtk_container_add(GTK_CONTAINER(box), measure);
}

static void add_visual(SporeInspector *self, SporeObject *body, const char *path) {
  GtkBox *box = add_section(self, _("Visual mesh"), path, NULL);
  if (!box) return;
  g_set_weak_pointer(&self->mesh_facts, add_fact(box));
  add_unit(self, box, body, "visual");
}

/* A box of a generator; *place: where it is kept. */
static void add_generator(GtkBox *box, GtkWidget **place, const char *action, const char *label, guint count,
                          guint most) {
  g_set_weak_pointer(place, spore_generator_box_new(action, label, count, most));
  gtk_container_add(GTK_CONTAINER(box), *place);
}

static void add_collision(SporeInspector *self, SporeObject *body, const char *path) {
  SporeObject *asset = spore_edit_body_spheres(document_of(self), body);
  GtkBox *box = add_section(self, _("Collision spheres"), path, asset);
  if (!box) return;
  add_generator(box, &self->spheres_box, "preview-spheres", _("Number of spheres"),
                last_count(asset, "count", DEFAULT_SPHERES), SPORE_SPHERES_MAXIMUM);
  add_unit(self, box, body, "collision");
  add_generator_regions(self, box, asset,
                        _("Spheres lie as densely everywhere: in a region they lie denser, or less so"));
}

static void add_mechanical(SporeInspector *self, SporeObject *body, const char *path) {
  SporeDocument *document = document_of(self);
  SporeObject *asset = spore_edit_body_tetrahedra(document, body);
  GtkBox *box = add_section(self, _("Mechanical unit"), path, asset);
  if (!box) return;
  add_model_choice(self, box);
  add_generator(box, &self->tetrahedra_box, "preview-tetrahedra", _("Number of tetrahedra"),
                last_count(asset, "cells", DEFAULT_CELLS), MOST_CELLS);
  add_generator(box, &self->surface_box, "preview-surface", _("Nodes of a surface"),
                last_count(spore_edit_body_surface(document, body), "nodes", DEFAULT_NODES), MOST_CELLS);
  add_generator(box, &self->curve_box, "preview-curve", _("Points of the middle line"),
                last_count(spore_edit_body_curve(document, body), "points", 0), SPORE_CENTRELINE_MOST_POINTS);
  add_unit(self, box, body, "mechanical");
  add_generator_regions(self, box, asset,
                        _("Tetrahedra are as large everywhere: in a region they are of a size of their own"));
}

static void add_model(SporeInspector *self, SporeObject *model) {
  const SporeModelType *type = spore_object_type(model)->model;
  g_autofree char *path = spore_object_path(model);
  GtkBox *box = add_section(self, type ? _(type->label) : spore_object_type(model)->element, path, NULL);
  if (!box) return;
  if (type) gtk_widget_set_tooltip_text(GTK_WIDGET(box), _(type->doc));
  if (type) add_preset_choice(self, box, model);
  add_object(self, box, model);
}

static void add_body(SporeInspector *self, SporeObject *body) {
  g_autofree char *path = spore_object_path(body);
  GtkBox *own = add_section(self, _("Body"), path, NULL);
  if (own) add_object(self, own, body);
  add_visual(self, body, path);
  add_collision(self, body, path);
  add_mechanical(self, body, path);
  SporeObject *model = spore_edit_body_model(body);
  if (model) {
    add_model(self, model);
    add_regions(self, body, model);
    add_mapping(self, path);
  }
  GtkBox *fidelity = add_section(self, _("Fidelity"), path, NULL);
  if (fidelity) add_unit(self, fidelity, body, "fidelity");
}

/* An object alone. */
static void add_one(SporeInspector *self, SporeObject *object) {
  g_autofree char *path = spore_object_path(object);
  GtkBox *box = add_section(self, _(spore_object_type(object)->label), path, NULL);
  if (box) add_object(self, box, object);
}

/* Sections of the scene that hold settings rather than objects. */
static void add_settings(SporeInspector *self, SporeObject *object) {
  for (guint i = 0; i < spore_object_child_count(object); i++) {
    SporeObject *child = spore_object_child(object, i);
    if (spore_object_name(child)) continue;
    if (spore_object_type(child)->table->count > 0) add_one(self, child);
    add_settings(self, child);
  }
}

static void show_title(SporeInspector *self, const char *title, const char *subtitle) {
  gtk_label_set_text(GTK_LABEL(self->title), title);
  gtk_label_set_text(GTK_LABEL(self->subtitle), subtitle);
  gtk_widget_set_visible(self->subtitle, *subtitle != '\0');
}

static gboolean rebuild(gpointer data) {
  SporeInspector *self = data;
  self->rebuild = 0;
  self->placed = 0;
  g_clear_handle_id(&self->refresh, g_source_remove);
  SporeObject *selected = spore_editor_document_selected(self->document);
  SporeObject *body = spore_editor_document_selected_body(self->document);
  if (body) {
    show_title(self, spore_object_name(body), "");
    add_body(self, body);
  } else if (selected && spore_object_name(selected)) {
    show_title(self, spore_object_name(selected), _(spore_object_type(selected)->label));
    add_one(self, selected);
  } else {
    show_title(self, _("Scene"), _("Select an organ to see its units"));
    add_settings(self, spore_document_root(document_of(self)));
  }
  drop_old_sections(self);
  collect_rows(self);
  gtk_widget_show_all(self->sections);
  show_facts(self);
  for (guint i = 0; i < self->rows->len; i++) spore_property_row_refresh(g_ptr_array_index(self->rows, i));
  g_signal_emit(self, signals[MARKS_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

static gboolean refresh(gpointer data) {
  SporeInspector *self = data;
  self->refresh = 0;
  for (guint i = 0; i < self->rows->len; i++) spore_property_row_refresh(g_ptr_array_index(self->rows, i));
  show_facts(self);
  g_signal_emit(self, signals[MARKS_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

static void queue_rebuild(SporeInspector *self) {
  if (!self->rebuild) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE, rebuild, self, NULL);
}

static void document_changed(SporeInspector *self, int kind, guint id, guint property) {
  SporeObject *object = kind == SPORE_DOCUMENT_SET ? spore_document_by_id(document_of(self), id) : NULL;
  if (!object || spore_object_type(object)->table->parameters[property].type == SPORE_NAME)
    queue_rebuild(self); /* paths and candidates may differ */
  else queue_refresh(self);
}

static void release_document(SporeInspector *self) {
  g_clear_handle_id(&self->rebuild, g_source_remove);
  g_clear_handle_id(&self->refresh, g_source_remove);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_inspector_set_document(SporeInspector *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(queue_rebuild), self, G_CONNECT_SWAPPED);
  rebuild(self);
}

static void spore_inspector_dispose(GObject *object) {
  SporeInspector *self = SPORE_INSPECTOR(object);
  release_document(self);
  self->rows->len = 0;
  G_OBJECT_CLASS(spore_inspector_parent_class)->dispose(object);
}

static void spore_inspector_finalize(GObject *object) {
  SporeInspector *self = SPORE_INSPECTOR(object);
  g_ptr_array_unref(self->rows);
  g_hash_table_unref(self->collapsed);
  g_hash_table_unref(self->reports);
  g_free(self->measured_key);
  spore_mapping_report_clear(&self->mapping);
  G_OBJECT_CLASS(spore_inspector_parent_class)->finalize(object);
}

static void spore_inspector_class_init(SporeInspectorClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_inspector_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_inspector_finalize;
  signals[MARKS_CHANGED] =
      g_signal_new("marks-changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-inspector.ui");
  gtk_widget_class_bind_template_child(widget, SporeInspector, title);
  gtk_widget_class_bind_template_child(widget, SporeInspector, subtitle);
  gtk_widget_class_bind_template_child(widget, SporeInspector, sections);
}

static void spore_inspector_init(SporeInspector *self) {
  self->rows = g_ptr_array_new();
  self->collapsed = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
  self->reports = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
  gtk_widget_init_template(GTK_WIDGET(self));
}
