/* Meshes: importing them, the operations on those that are in the scene, pictures laid over them, and how well they
 * follow what moves them. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "ui/dialogs/spore-import-dialog.h"
#include "ui/dialogs/spore-mesh-dialog.h"
#include "core/author/edits.h"
#include "core/author/mesh_edits.h"
#include "core/author/texture_edits.h"
#include "ui/jobs/works.h"
#include "ui/jobs/mesh-works.h"
#include "ui/spore-window-private.h"

/* Importing. */

/* One that is heavy is selected, and can be made lighter at once. */
static void offer_lightening(SporeWindow *self, const SporeImport *import) {
  const SporeImportBody *body = import->bodies->len == 1 ? g_ptr_array_index(import->bodies, 0) : NULL;
  g_autofree char *burden = body ? spore_import_burden(body) : NULL;
  if (!burden) return;
  g_autofree char *text = g_strdup_printf("%s: %s", body->name, burden), *label = spore_lighten_label();
  g_autofree char *action = g_strdup_printf(
      "win.change-mesh(('%s', %u.0))", spore_mesh_operations[SPORE_MESH_DECIMATE].name, SPORE_IMPORT_TRIANGLES_ENOUGH);
  spore_window_complain_while(self, SPORE_CAUSE_EDIT, text, label, action);
}

static void take_import(SporeWindow *self, const SporeImport *import) {
  g_autoptr(GError) failure = NULL;
  g_autoptr(GPtrArray) bodies = spore_edit_import(spore_editor_document_get(self->document), import, &failure);
  if (!bodies) {
    spore_window_failed(self, failure);
    return;
  }
  spore_window_select(self, bodies);
  for (guint i = 0; i < import->bodies->len; i++) {
    const SporeImportBody *made = g_ptr_array_index(import->bodies, i);
    spore_window_log(self, _("Imported %s: %zu triangles"), made->name, made->mesh.triangle_count);
  }
  offer_lightening(self, import);
}

static void imported(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  SporeImportWork *work = data;
  if (spore_window_failed(self, error) || !self->document) return;
  take_import(self, work->import);
}

static void import_answered(GtkDialog *dialog, int response, SporeWindow *self) {
  g_autoptr(SporeImport) import =
      response == GTK_RESPONSE_ACCEPT ? spore_import_dialog_take(SPORE_IMPORT_DIALOG(dialog)) : NULL;
  g_autofree char *labels = response == SPORE_RESPONSE_TOGETHER
                                ? g_strdup(spore_import_dialog_get_label_map(SPORE_IMPORT_DIALOG(dialog)))
                                : NULL;
  gtk_widget_destroy(GTK_WIDGET(dialog));
  if (import) take_import(self, import);
  if (labels) spore_window_preview_labels(self, labels);
}

void spore_window_show_import_dialog(SporeWindow *self, const char *const *files) {
  GtkWidget *dialog = spore_import_dialog_new(GTK_WINDOW(self), files);
  g_signal_connect_object(dialog, "response", G_CALLBACK(import_answered), self, 0);
  gtk_window_present(GTK_WINDOW(dialog));
}

static int index_of(const char *const *names, const char *name) {
  for (int i = 0; names[i]; i++)
    if (g_str_equal(names[i], name)) return i;
  return -1;
}

static void act_import(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *files[2] = {NULL, NULL}, *unit, *frame;
  g_variant_get(parameter, "(&s&s&s)", &files[0], &unit, &frame);
  SporeImportOptions options = {.unit = index_of(spore_length_units, unit),
                                .frame = index_of(spore_mesh_frames, frame)};
  if (options.unit < 0 || options.frame < 0) {
    spore_window_complain(data, _("The unit is one of m, cm, mm, um, in and the frame one of Y_UP, RAS, LPS"));
    return;
  }
  g_autofree char *base = g_path_get_basename(files[0]);
  g_autofree char *title = g_strdup_printf(_("Importing %s"), base);
  spore_window_start_job(data, title, spore_import_work_run, spore_import_work_new((char *const *)files, &options),
                         spore_import_work_free, imported);
}

static void act_import_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_show_import_dialog(data, NULL);
}

static void act_import_dialog_with(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree const char **files = g_variant_get_strv(parameter, NULL);
  spore_window_show_import_dialog(data, files);
}

/* Operations. */

/* The selected mesh asset, else the mesh of the body to work on; NULL: none, and the user is told. */
static SporeObject *asset_to_work_on(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *selected = spore_editor_document_selected(self->document);
  if (selected && g_str_equal(spore_object_type(selected)->element, "mesh")) return selected;
  SporeObject *body = spore_window_body_to_work_on(self);
  g_autoptr(GError) error = NULL;
  SporeObject *asset = body ? spore_edit_visual_mesh(document, body, &error) : NULL;
  if (error) spore_window_failed(self, error);
  return asset;
}

static void changed(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  SporeMeshWork *work = data;
  if (spore_window_failed(self, error) || !self->document) return;
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *asset = spore_mesh_work_asset(work, document);
  g_autoptr(GError) failure = NULL;
  if (!asset) {
    spore_window_log(self, _("The mesh changed meanwhile; the result was dropped"));
    return;
  }
  const char *label = _(spore_mesh_operations[work->operation].label);
  if (!spore_edit_change_mesh(document, asset, label, work->content, &failure)) {
    spore_window_failed(self, failure);
    return;
  }
  g_autofree char *before = spore_figures_text(&work->change.before), *after = spore_figures_text(&work->change.after);
  g_autofree char *moved = spore_length_text(work->change.moved < 1e-9 ? 0 : work->change.moved);
  spore_window_log(self, _("%s, %s:\n  before: %s\n  after: %s\n  moved by up to %s"), spore_object_name(asset), label,
                   before, after, moved);
  spore_window_show_tab(self, self->log);
}

static void start_change(SporeWindow *self, SporeObject *asset, int kind, double argument) {
  g_autoptr(GError) error = NULL;
  SporeMeshWork *work = spore_mesh_work_new(spore_editor_document_get(self->document), asset,
                                            (SporeMeshOperationKind)kind, argument, &error);
  if (!work) spore_window_failed(self, error);
  else
    spore_window_start_job(self, _(spore_mesh_operations[kind].label), spore_mesh_work_run, work, spore_mesh_work_free,
                           changed);
}

/* The operation with that name; -1: none, and the user is told. */
static int find_operation(SporeWindow *self, const char *name) {
  for (int kind = 0; kind < SPORE_MESH_OPERATIONS; kind++)
    if (g_str_equal(spore_mesh_operations[kind].name, name)) return kind;
  spore_window_complain(self, _("There is no such operation on a mesh; choose one of the menu"));
  return -1;
}

static void act_change_mesh(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *name;
  double argument;
  g_variant_get(parameter, "(&sd)", &name, &argument);
  int kind = find_operation(data, name);
  SporeObject *asset = kind >= 0 ? asset_to_work_on(data) : NULL;
  if (asset) start_change(data, asset, kind, argument);
}

/* What a dialog was opened for. */
typedef struct {
  SporeWindow *window; /* which outlives its dialogs */
  guint32 asset;
  int kind;
} Question;

static void mesh_answered(GtkWidget *dialog, int response, Question *question) {
  SporeDocument *document = spore_editor_document_get(question->window->document);
  SporeObject *asset = spore_document_by_id(document, question->asset); /* it may be gone meanwhile */
  double argument = spore_mesh_dialog_get_argument(dialog);
  SporeWindow *self = question->window;
  int kind = question->kind;
  gtk_widget_destroy(dialog); /* and the question with it */
  if (response == GTK_RESPONSE_ACCEPT && asset) start_change(self, asset, kind, argument);
}

static void free_question(gpointer data, GClosure *closure) { g_free(data); }

static void act_change_mesh_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  int kind = find_operation(self, g_variant_get_string(parameter, NULL));
  SporeObject *asset = kind >= 0 ? asset_to_work_on(self) : NULL;
  g_autoptr(GError) error = NULL;
  const SporeTriangleMesh *mesh =
      asset ? spore_document_mesh(spore_editor_document_get(self->document), asset, &error) : NULL;
  if (error) spore_window_failed(self, error);
  SporeMeshFigures figures;
  if (!mesh || !spore_mesh_figures(mesh, &figures, NULL)) return;
  Question *question = g_new(Question, 1);
  *question = (Question){self, spore_object_id(asset), kind};
  GtkWidget *dialog =
      spore_mesh_dialog_new(GTK_WINDOW(self), &spore_mesh_operations[kind], spore_object_name(asset), &figures);
  g_signal_connect_data(dialog, "response", G_CALLBACK(mesh_answered), question, free_question, 0);
  gtk_window_present(GTK_WINDOW(dialog));
}

/* Pictures. */

static void picture_found(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  if (!spore_texture_work_apply(data, spore_editor_document_get(self->document), &failure))
    spore_window_failed(self, failure);
}

static void lay_picture(SporeWindow *self, const char *file) {
  SporeObject *body = spore_window_body_to_work_on(self);
  g_autoptr(GError) error = NULL;
  SporeTextureWork *work =
      body ? spore_texture_work_new(spore_editor_document_get(self->document), body, file, &error) : NULL;
  if (work)
    spore_window_start_job(self, _("Laying a picture"), spore_texture_work_run, work, spore_texture_work_free,
                           picture_found);
  else if (error) spore_window_failed(self, error);
}

static void act_lay_picture(GSimpleAction *action, GVariant *parameter, gpointer data) {
  lay_picture(data, g_variant_get_string(parameter, NULL));
}

static void act_lay_picture_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = spore_window_choose_to_open(
      data, _("Choose a picture for the organ"), "*.png *.PNG *.jpg *.JPG *.jpeg *.JPEG", _("Pictures: PNG, JPEG"));
  if (file) lay_picture(data, file);
}

/* Mappings. */

static void mapping_measured(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  SporeMappingWork *work = data;
  if (spore_window_failed(self, error) || !self->document) return;
  spore_inspector_set_mapping(SPORE_INSPECTOR(self->inspector), &work->report);
}

static void act_measure_mapping(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  if (body)
    spore_window_start_job(self, _("Measuring the mapping"), spore_mapping_work_run,
                           spore_mapping_work_new(spore_editor_document_get(self->document), body),
                           spore_mapping_work_free, mapping_measured);
}

/* An entry for each operation. */
static void fill_menu(GMenu *menu) {
  for (int kind = 0; kind < SPORE_MESH_OPERATIONS; kind++) {
    g_autofree char *label = g_strdup_printf("%s…", _(spore_mesh_operations[kind].label));
    g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
    g_menu_item_set_action_and_target(item, "win.change-mesh-dialog", "s", spore_mesh_operations[kind].name);
    g_menu_append_item(menu, item);
  }
}

void spore_window_add_mesh_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"import", act_import, "(sss)"},
      {"import-dialog", act_import_dialog},
      {"import-dialog-with", act_import_dialog_with, "as"},
      {"change-mesh", act_change_mesh, "(sd)"},
      {"change-mesh-dialog", act_change_mesh_dialog, "s"},
      {"lay-picture", act_lay_picture, "s"},
      {"lay-picture-dialog", act_lay_picture_dialog},
      {"measure-mapping", act_measure_mapping},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  fill_menu(self->mesh_operations);
}
