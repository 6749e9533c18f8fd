/* The inspector: every parameter of the selected object, made from its table. */
#include "ui/panels/spore-inspector.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/region_edits.h"
#include "core/author/patient_positions.h"
#include "core/author/port_edits.h"
#include "core/scene/generated.h"
#include "ui/document/body-marks.h"
#include "ui/document/mapping-report.h"
#include "ui/document/measured-facts.h"
#include "ui/jobs/generate-types.h"
#include "ui/jobs/spore-sphere-measures.h"
#include "ui/jobs/spore-swing-measures.h"
#include "ui/panels/asset-facts.h"
#include "ui/panels/batch.h"
#include "ui/panels/level-list.h"
#include "ui/panels/region-list.h"
#include "ui/panels/spore-generator-box.h"
#include "ui/panels/spore-model-choice.h"
#include "ui/panels/spore-property-row.h"
#include "ui/panels/spore-section-list.h"

#define MOST_COUNT 1e6 /* largest number of the box; a larger number is an option of the panel */

struct _SporeInspector {
  GtkBox parent;
  GtkWidget *title, *subtitle, *sections;
  SporeEditorDocument *document;
  guint rebuild, refresh;
  GtkWidget *port_facts, *mesh_facts, *generators[SPORE_GENERATORS_MOST], *model, *preset, *swing_facts, *mapping_facts,
      *measured_facts;
  SporeSphereMeasures *measures;
  SporeSwingMeasures *swings;
  SporeMappingReport mapping;
  char *mesh_hash, *mesh_text; /* of the last mesh: its content, and its figures in words */
};

G_DEFINE_FINAL_TYPE(SporeInspector, spore_inspector, GTK_TYPE_BOX)

enum { MARKS_CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static SporeDocument *document_of(SporeInspector *self) { return spore_editor_document_get(self->document); }

static SporeSectionList *sections_of(SporeInspector *self) { return SPORE_SECTION_LIST(self->sections); }

static void queue_refresh(SporeInspector *self);

/* Rows. */

/* What an importer said of the object, or a command made, is shown where it stands, to be taken back; nobody says it by
 * hand. */
static gboolean is_absent_remark(const SporeObject *object, const SporeParameter *parameter) {
  if (strcmp(parameter->name, "name_guessed") == 0)
    return !(object && spore_object_number(object, parameter->name) != 0);
  static const char *const made[] = {"texture_places", "kept_pose", NULL}; /* files that commands make */
  return g_strv_contains(made, parameter->name) && !(object && spore_object_text(object, parameter->name));
}

/* One row for each parameter of the table. object: NULL: it does not exist yet. */
static void add_rows(SporeInspector *self, GtkBox *box, const char *path, const SporeObjectType *type,
                     const SporeObject *object) {
  for (gsize i = 0; i < type->table->count; i++) {
    if (is_absent_remark(object, &type->table->parameters[i])) continue;
    GtkWidget *row = spore_property_row_new(self->document, path, type, (guint)i);
    gtk_container_add(GTK_CONTAINER(box), row);
    g_ptr_array_add(spore_section_rows(box), row);
  }
}

static void add_object(SporeInspector *self, GtkBox *box, SporeObject *object) {
  g_autofree char *path = spore_object_path(object);
  add_rows(self, box, path, spore_object_type(object), object);
}

/* A unit of the body, which may not exist yet: the first change of a row makes the unit. */
static void add_unit(SporeInspector *self, GtkBox *box, SporeObject *body, const char *element) {
  const SporeObjectType *type = spore_object_type_child(spore_object_type(body), element);
  g_autofree char *parent = spore_object_path(body);
  g_autofree char *path = g_strconcat(parent, "/", element, NULL);
  if (type) add_rows(self, box, path, type, NULL);
}

/* Facts. */

/* A mesh may be large, so its figures are kept. */
static void show_mesh_facts(SporeInspector *self, SporeObject *body) {
  g_autoptr(GError) error = NULL;
  SporeObject *asset = spore_edit_visual_mesh(document_of(self), body, NULL);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document_of(self), asset, &error) : NULL;
  g_autofree char *hash = mesh ? spore_document_asset_hash(document_of(self), asset) : NULL;
  if (!hash || g_strcmp0(hash, self->mesh_hash) != 0) {
    g_free(self->mesh_text);
    self->mesh_text = mesh ? spore_mesh_facts(mesh) : NULL;
    g_free(self->mesh_hash);
    self->mesh_hash = g_steal_pointer(&hash);
  }
  const char *none = error ? error->message : _("No mesh is shown");
  gtk_label_set_text(GTK_LABEL(self->mesh_facts), self->mesh_text ? self->mesh_text : none);
}

/* Facts of what the body has of a kind. */
static char *facts_of(SporeInspector *self, SporeObject *body, SporeObject *asset, SporeGenerateKind kind) {
  g_autofree char *text = spore_asset_facts(document_of(self), body, asset, kind);
  if (!asset) return g_steal_pointer(&text);
  gboolean spheres = kind == SPORE_GENERATE_SPHERES;
  const SporeSpheresReport *report =
      spheres ? spore_sphere_measures_get(self->measures, document_of(self), body, asset) : NULL;
  g_autofree char *quality = spheres ? spore_spheres_facts(report) : g_strdup("");
  return g_strconcat(text, quality, NULL);
}

static guint last_count(SporeObject *asset, const char *property, guint otherwise) {
  return asset ? (guint)spore_object_number(asset, property) : otherwise;
}

static void show_generated(SporeInspector *self, SporeObject *body, SporeGenerateKind kind) {
  SporeObject *asset = spore_generate_target(document_of(self), body, kind);
  SporeGenerated generated = asset ? spore_generated_state(document_of(self), asset) : SPORE_GENERATED_NOT;
  g_autofree char *path = asset ? spore_object_path(asset) : NULL;
  g_autofree char *text = facts_of(self, body, asset, kind);
  g_autofree char *remarks = asset ? spore_asset_remarks(document_of(self), asset) : g_strdup("");
  SporeGeneratorState state = {.asset = path,
                               .remarks = remarks,
                               .count = last_count(asset, spore_generators[kind]->count, 0),
                               .generated = generated != SPORE_GENERATED_NOT,
                               .stale = generated == SPORE_GENERATED_SOURCE_CHANGED ||
                                        generated == SPORE_GENERATED_OPTIONS_CHANGED,
                               .frozen = asset && spore_generated_is(asset, "frozen")};
  spore_generator_box_set_result(SPORE_GENERATOR_BOX(self->generators[kind]), text, state);
}

static void show_mapping(SporeInspector *self, SporeObject *body) {
  gboolean holds = spore_mapping_report_holds(&self->mapping, document_of(self), body);
  const char *why = self->mapping.body == spore_object_id(body)
                        ? _("The scene has changed since it was measured")
                        : _("How well what is drawn and felt follows what moves it: not measured yet");
  g_autofree char *text = holds ? spore_mapping_report_text(&self->mapping) : g_strdup(why);
  gtk_label_set_text(GTK_LABEL(self->mapping_facts), text);
}

/* Measured only while it is seen. The figure of the scene before a change stays, grey, until the new one is there. */
static void show_swing(SporeInspector *self, SporeObject *body) {
  if (!gtk_widget_get_mapped(self->swing_facts)) return;
  const char *text = spore_swing_measures_text(self->swings, document_of(self), body);
  if (text) gtk_label_set_text(GTK_LABEL(self->swing_facts), text);
  gtk_widget_set_sensitive(self->swing_facts, text != NULL);
}

static void show_measured(SporeInspector *self) {
  g_autofree char *text = spore_measured_sentence(self->document);
  g_autofree char *source = spore_measured_source(document_of(self));
  GtkStyleContext *style = gtk_widget_get_style_context(self->measured_facts);
  if (spore_editor_document_get_measured(self->document) == SPORE_MEASURED_STALE)
    gtk_style_context_add_class(style, "stale");
  else gtk_style_context_remove_class(style, "stale");
  gtk_label_set_text(GTK_LABEL(self->measured_facts), text ? text : "");
  gtk_widget_set_tooltip_text(self->measured_facts, source);
}

/* What is reached through ports: of the selected organ, instrument or port. */
static void show_ports(SporeInspector *self) {
  SporeObject *selected = spore_editor_document_selected(self->document);
  g_autofree char *text = selected ? spore_port_sentences(document_of(self), selected) : NULL;
  gtk_label_set_text(GTK_LABEL(self->port_facts), text ? text : "");
}

static void show_facts(SporeInspector *self) {
  if (self->port_facts) show_ports(self);
  if (self->measured_facts) show_measured(self);
  SporeObject *body = spore_editor_document_selected_body(self->document);
  if (!body || !self->model) return;
  SporeObject *model = spore_body_model_object(body);
  show_mesh_facts(self, body);
  for (SporeGenerateKind kind = 0; spore_generators[kind]; kind++)
    if (self->generators[kind]) show_generated(self, body, kind);
  spore_model_choice_set_model(SPORE_MODEL_CHOICE(self->model), model);
  if (self->preset) spore_model_choice_set_model(SPORE_MODEL_CHOICE(self->preset), model);
  if (self->swing_facts) show_swing(self, body);
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

/* Regions of other tissue: for models that use them, and for models that do not but have some. */
static void add_regions(SporeInspector *self, SporeObject *body, SporeObject *model) {
  const SporeModelType *type = spore_object_type(model)->model;
  const SporeObject *regions = spore_object_child_of(body, "regions");
  if (!(type && type->regions) && !regions) return;
  const SporeObjectType *holder = spore_object_type_child(spore_object_type(body), "regions");
  g_autofree char *parent = spore_object_path(body);
  g_autofree char *path = g_strconcat(parent, "/regions", NULL);
  GtkBox *box = spore_section_list_add(sections_of(self), _("Regions"), path, regions);
  if (!box) return;
  spore_fill_region_list(box, self->document, path, holder,
                         _("All of it is of one tissue: a region is a part of another stiffness, density or tissue"),
                         spore_section_rows(box));
}

/* Regions where a generated asset shall be finer. */
static void add_generator_regions(SporeInspector *self, GtkBox *box, SporeObject *asset, const char *empty) {
  const char *source = asset ? spore_object_text(asset, "source") : NULL;
  if (!asset || (!source && !spore_object_child_count(asset))) return;
  g_autofree char *path = spore_object_path(asset);
  spore_fill_region_list(box, self->document, path, spore_object_type(asset), empty, spore_section_rows(box));
}

static void add_mapping(SporeInspector *self, const char *path) {
  GtkBox *box = spore_section_list_add(sections_of(self), _("Mapping"), path, NULL);
  if (!box) return;
  g_set_weak_pointer(&self->mapping_facts, spore_section_fact_new(box));
  GtkWidget *measure = gtk_button_new_with_label(_("Measure mapping"));
  gtk_widget_set_halign(measure, GTK_ALIGN_START);
  gtk_widget_set_tooltip_text(measure, _("Compile the scene and measure how far vertices and spheres lie off"));
  gtk_actionable_set_action_name(GTK_ACTIONABLE(measure), "win.measure-mapping");
  gtk_container_add(GTK_CONTAINER(box), measure);
}

static void add_visual(SporeInspector *self, SporeObject *body, const char *path) {
  GtkBox *box = spore_section_list_add(sections_of(self), _("Visual mesh"), path, NULL);
  if (!box) return;
  g_set_weak_pointer(&self->mesh_facts, spore_section_fact_new(box));
  GtkWidget *lay = spore_action_button_new(_("Choose a picture…"), "win.lay-picture-dialog",
                                           _("Lay a PNG or JPEG over the organ, whose mesh has to say where its "
                                             "corners lie in one (UV)"));
  gtk_widget_set_halign(lay, GTK_ALIGN_START);
  gtk_container_add(GTK_CONTAINER(box), lay);
  add_unit(self, box, body, "visual");
}

static void add_generator(SporeInspector *self, GtkBox *box, SporeGenerateKind kind, SporeObject *body) {
  const SporeGeneratorType *type = spore_generators[kind];
  SporeParameterTable table = spore_generator_table(type);
  const SporeParameter *count = &table.parameters[spore_parameter_find(&table, type->count)];
  g_autofree char *action = g_strconcat("preview-", type->name, NULL);
  guint now = last_count(spore_generate_target(document_of(self), body, kind), type->count, (guint)count->initial[0]);
  g_set_weak_pointer(&self->generators[kind],
                     spore_generator_box_new(action, _(type->offer), now, (guint)MIN(count->maximum, MOST_COUNT)));
  gtk_container_add(GTK_CONTAINER(box), self->generators[kind]);
}

/* The generators that are offered with this unit of a body. */
static void add_generators(SporeInspector *self, GtkBox *box, SporeObject *body, const char *unit) {
  for (SporeGenerateKind kind = 0; spore_generators[kind]; kind++)
    if (g_strcmp0(spore_generators[kind]->unit, unit) == 0) add_generator(self, box, kind, body);
}

static void add_collision(SporeInspector *self, SporeObject *body, const char *path) {
  SporeObject *asset = spore_edit_body_spheres(document_of(self), body);
  GtkBox *box = spore_section_list_add(sections_of(self), _("Collision spheres"), path, asset);
  if (!box) return;
  add_generators(self, box, body, "collision");
  add_unit(self, box, body, "collision");
  add_generator_regions(self, box, asset,
                        _("Spheres lie as densely everywhere: in a region they lie denser, or less so"));
}

static void add_mechanical(SporeInspector *self, SporeObject *body, const char *path) {
  SporeDocument *document = document_of(self);
  SporeObject *asset = spore_edit_body_tetrahedra(document, body);
  GtkBox *box = spore_section_list_add(sections_of(self), _("Mechanical unit"), path, asset);
  if (!box) return;
  gtk_container_add(GTK_CONTAINER(box), spore_soft_button_new());
  g_set_weak_pointer(&self->model, spore_model_choice_new(spore_document_schema(document)));
  gtk_container_add(GTK_CONTAINER(box), self->model);
  add_generators(self, box, body, "mechanical");
  add_unit(self, box, body, "mechanical");
  g_set_weak_pointer(&self->swing_facts, spore_section_fact_new(box));
  g_signal_connect_object(self->swing_facts, "map", G_CALLBACK(queue_refresh), self, G_CONNECT_SWAPPED);
  add_generator_regions(self, box, asset,
                        _("Tetrahedra are as large everywhere: in a region they are of a size of their own"));
}

static void add_model(SporeInspector *self, SporeObject *model) {
  const SporeModelType *type = spore_object_type(model)->model;
  g_autofree char *path = spore_object_path(model);
  GtkBox *box =
      spore_section_list_add(sections_of(self), type ? _(type->label) : spore_object_type(model)->element, path, NULL);
  if (!box) return;
  if (type) gtk_widget_set_tooltip_text(GTK_WIDGET(box), _(type->doc));
  GtkWidget *preset = type ? spore_model_choice_new_of_presets(type) : NULL;
  g_set_weak_pointer(&self->preset, preset);
  if (preset) gtk_container_add(GTK_CONTAINER(box), preset);
  add_object(self, box, model);
}

/* Of what may be an effect. NULL: it has no such form, or the section is folded. */
static GtkBox *add_fidelity(SporeInspector *self, SporeObject *holder) {
  if (!spore_object_type_child(spore_object_type(holder), "fidelity")) return NULL;
  g_autofree char *path = spore_object_path(holder);
  SporeObject *unit = spore_object_child_of(holder, "fidelity");
  GtkBox *box = spore_section_list_add(sections_of(self), _("Fidelity"), path, unit);
  if (box) add_unit(self, box, holder, "fidelity");
  return box;
}

static void add_body(SporeInspector *self, SporeObject *body) {
  g_autofree char *path = spore_object_path(body);
  GtkBox *own = spore_section_list_add(sections_of(self), _("Body"), path, NULL);
  if (own) g_set_weak_pointer(&self->port_facts, spore_section_fact_new(own));
  if (own) add_object(self, own, body);
  add_visual(self, body, path);
  add_collision(self, body, path);
  add_mechanical(self, body, path);
  SporeObject *model = spore_body_model_object(body);
  if (model) {
    add_model(self, model);
    add_regions(self, body, model);
    add_mapping(self, path);
  }
  GtkBox *fidelity = add_fidelity(self, body);
  if (fidelity) spore_add_level_list(fidelity, self->document, body, spore_section_rows(fidelity));
}

/* Of gravity: the positions of a patient. */
static void add_patient(GtkBox *box) {
  g_autoptr(GMenu) menu = g_menu_new();
  for (const SporePatientPosition *one = spore_patient_positions; one->name; one++) {
    g_autoptr(GMenuItem) item = g_menu_item_new(_(one->label), NULL);
    g_menu_item_set_action_and_target(item, "win.patient", "s", one->name);
    g_menu_append_item(menu, item);
  }
  GtkWidget *button = gtk_menu_button_new();
  gtk_button_set_label(GTK_BUTTON(button), _("The patient lies…"));
  gtk_widget_set_tooltip_text(button, _("Turns gravity, in the axes that RAS and LPS files are imported to: x to the "
                                        "patient's right, y to the head, z to the back"));
  gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(button), G_MENU_MODEL(menu));
  gtk_widget_set_halign(button, GTK_ALIGN_START);
  gtk_container_add(GTK_CONTAINER(box), button);
  gtk_widget_show(button);
}

/* An object alone. */
static void add_one(SporeInspector *self, SporeObject *object) {
  g_autofree char *path = spore_object_path(object);
  GtkBox *box = spore_section_list_add(sections_of(self), _(spore_object_type(object)->label), path, NULL);
  if (box && spore_object_name(object)) g_set_weak_pointer(&self->port_facts, spore_section_fact_new(box));
  if (box) add_object(self, box, object);
  if (box && g_str_equal(spore_object_type(object)->element, "environment")) add_patient(box);
  add_fidelity(self, object);
}

/* What was measured is told, not edited. */
static void add_measured(SporeInspector *self, SporeObject *measured) {
  g_autofree char *path = spore_object_path(measured);
  GtkBox *box = spore_section_list_add(sections_of(self), _(spore_object_type(measured)->label), path, NULL);
  if (box) g_set_weak_pointer(&self->measured_facts, spore_section_fact_new(box));
}

/* Sections of the scene that hold settings rather than objects. */
static void add_settings(SporeInspector *self, SporeObject *object) {
  for (guint i = 0; i < spore_object_child_count(object); i++) {
    SporeObject *child = spore_object_child(object, i);
    if (spore_object_name(child)) continue;
    if (g_str_equal(spore_object_type(child)->element, "measured")) add_measured(self, child);
    else if (spore_object_type(child)->table->count > 0) add_one(self, child);
    add_settings(self, child);
  }
}

static void show_title(SporeInspector *self, const char *title, const char *subtitle) {
  gtk_label_set_text(GTK_LABEL(self->title), title);
  gtk_label_set_text(GTK_LABEL(self->subtitle), subtitle);
  gtk_widget_set_visible(self->subtitle, *subtitle != '\0');
}

/* Several bodies. */
static void add_several(SporeInspector *self, const GPtrArray *bodies) {
  g_autofree char *title = g_strdup_printf(ngettext("%u body", "%u bodies", bodies->len), bodies->len);
  g_autofree char *names = spore_batch_names(bodies);
  show_title(self, title, names);
  spore_add_batch(sections_of(self), self->document, bodies);
}

static gboolean rebuild(gpointer data) {
  SporeInspector *self = data;
  self->rebuild = 0;
  g_clear_handle_id(&self->refresh, g_source_remove);
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  SporeObject *selected = spore_editor_document_selected(self->document);
  SporeObject *body = spore_editor_document_selected_body(self->document);
  spore_section_list_begin(sections_of(self));
  if (bodies->len > 1) {
    add_several(self, bodies);
  } else if (body) {
    show_title(self, spore_object_name(body), "");
    add_body(self, body);
  } else if (selected && spore_object_name(selected)) {
    show_title(self, spore_object_name(selected), _(spore_object_type(selected)->label));
    add_one(self, selected);
  } else {
    show_title(self, _("Scene"), _("Select an organ to see its units"));
    add_settings(self, spore_document_root(document_of(self)));
  }
  spore_section_list_end(sections_of(self));
  show_facts(self);
  spore_section_list_refresh(sections_of(self));
  g_signal_emit(self, signals[MARKS_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

static gboolean refresh(gpointer data) {
  SporeInspector *self = data;
  self->refresh = 0;
  spore_section_list_refresh(sections_of(self));
  show_facts(self);
  g_signal_emit(self, signals[MARKS_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

static void queue_refresh(SporeInspector *self) {
  if (!self->refresh && !self->rebuild) self->refresh = g_idle_add_full(G_PRIORITY_HIGH_IDLE, refresh, self, NULL);
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

static void measured(SporeInspector *self) {
  if (self->document) queue_refresh(self);
}

static void release_swings(SporeInspector *self) {
  if (self->swings) g_signal_handlers_disconnect_by_data(self->swings, self);
  g_clear_object(&self->swings);
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
  release_swings(self); /* figures are of one document */
  self->swings = spore_swing_measures_new();
  g_signal_connect_object(self->swings, "measured", G_CALLBACK(measured), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "studied", G_CALLBACK(queue_refresh), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(queue_rebuild), self, G_CONNECT_SWAPPED);
  spore_section_list_begin(sections_of(self)); /* rows of the document before are not kept */
  spore_section_list_end(sections_of(self));
  rebuild(self);
}

static void spore_inspector_dispose(GObject *object) {
  SporeInspector *self = SPORE_INSPECTOR(object);
  release_document(self);
  if (self->measures) g_signal_handlers_disconnect_by_data(self->measures, self);
  g_clear_object(&self->measures);
  release_swings(self);
  G_OBJECT_CLASS(spore_inspector_parent_class)->dispose(object);
}

static void spore_inspector_finalize(GObject *object) {
  SporeInspector *self = SPORE_INSPECTOR(object);
  g_free(self->mesh_hash);
  g_free(self->mesh_text);
  spore_mapping_report_clear(&self->mapping);
  G_OBJECT_CLASS(spore_inspector_parent_class)->finalize(object);
}

static void spore_inspector_class_init(SporeInspectorClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_inspector_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_inspector_finalize;
  signals[MARKS_CHANGED] =
      g_signal_new("marks-changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  g_type_ensure(SPORE_TYPE_SECTION_LIST);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-inspector.ui");
  gtk_widget_class_bind_template_child(widget, SporeInspector, title);
  gtk_widget_class_bind_template_child(widget, SporeInspector, subtitle);
  gtk_widget_class_bind_template_child(widget, SporeInspector, sections);
}

static void spore_inspector_init(SporeInspector *self) {
  self->measures = spore_sphere_measures_new();
  g_signal_connect_object(self->measures, "measured", G_CALLBACK(measured), self, G_CONNECT_SWAPPED);
  gtk_widget_init_template(GTK_WIDGET(self));
}
