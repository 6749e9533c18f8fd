/* The dialog that imports meshes: files, unit, axes, bodies and repairs, and what comes of them. */
#include "ui/dialogs/spore-import-dialog.h"

#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "ui/dialogs/mesh-files.h"
#include "ui/dialogs/spore-mesh-dialog.h"
#include "ui/jobs/mesh-works.h"
#include "ui/jobs/spore-job.h"
#include "ui/panels/report.h"
#include "ui/spore-preferences.h"

#define SETTLE_MS 250 /* delay after a choice, before the files are read again */
#define CHOICE_LEAST_CHARS 12
#define CHOICE_CHARS 34
#define ARGUMENT_CHARS 18

enum {
  COLUMN_BODY,
  COLUMN_SIZE,
  COLUMN_TRIANGLES,
  COLUMN_PIECES,
  COLUMN_OPEN,
  COLUMN_TANGLED,
  COLUMN_VOLUME,
  COLUMN_MOVED
};

struct _SporeImportDialog {
  GtkDialog parent;
  guint silent_unit; /* see SporeImportOptions */
  GtkWidget *bodies, *unit, *frame, *division, *operations, *spinner, *state, *warning, *lighten, *accept, *together;
  GtkWidget *wanted[SPORE_MESH_OPERATIONS], *argument[SPORE_MESH_OPERATIONS]; /* argument: NULL where it takes none */
  GtkListStore *rows;
  GPtrArray *files; /* char *, NULL at the end */
  SporeJob *job;
  guint settling;
  SporeImport *import;
};

G_DEFINE_FINAL_TYPE(SporeImportDialog, spore_import_dialog, GTK_TYPE_DIALOG)

/* What was read. */

static char *change_text(gsize before, gsize after) {
  return before == after ? g_strdup_printf("%zu", before) : g_strdup_printf("%zu → %zu", before, after);
}

static void add_row(SporeImportDialog *self, const SporeImportBody *body) {
  SporeMeshFigures after = body->as_read;
  double moved = 0;
  for (guint i = 0; i < body->changes->len; i++) {
    const SporeMeshChange *change = &g_array_index(body->changes, SporeMeshChange, i);
    after = change->after;
    moved = MAX(moved, change->moved);
  }
  const SporeMeshReport *was = &body->as_read.report, *is = &after.report;
  g_autofree char *size = spore_length_text(was->diagonal);
  g_autofree char *triangles = change_text(body->as_read.triangles, after.triangles);
  g_autofree char *pieces = change_text(was->components, is->components);
  g_autofree char *open = change_text(was->boundary_edges, is->boundary_edges);
  g_autofree char *tangled = change_text(was->nonmanifold_edges, is->nonmanifold_edges);
  g_autofree char *before_cm3 = g_strdup_printf("%.4g", 1e6 * was->volume);
  g_autofree char *after_cm3 = g_strdup_printf("%.4g", 1e6 * is->volume);
  g_autofree char *volume =
      g_str_equal(before_cm3, after_cm3) ? g_strdup(before_cm3) : g_strdup_printf("%s → %s", before_cm3, after_cm3);
  g_autofree char *far = body->changes->len ? spore_length_text(moved < 1e-9 ? 0 : moved) : g_strdup("");
  gtk_list_store_insert_with_values(self->rows, NULL, -1, COLUMN_BODY, body->name, COLUMN_SIZE, size, COLUMN_TRIANGLES,
                                    triangles, COLUMN_PIECES, pieces, COLUMN_OPEN, open, COLUMN_TANGLED, tangled,
                                    COLUMN_VOLUME, volume, COLUMN_MOVED, far, -1);
}

/* The largest body of a file, or of all files; NULL: none. */
static const SporeImportBody *largest(const SporeImport *import, const SporeImportFile *file) {
  const SporeImportBody *found = NULL;
  for (guint i = 0; i < import->bodies->len; i++) {
    const SporeImportBody *body = g_ptr_array_index(import->bodies, i);
    if ((!body->source || body->source == file) &&
        (!found || body->as_read.report.diagonal > found->as_read.report.diagonal))
      found = body;
  }
  return found;
}

/* A file whose largest body has no plausible size for an organ; NULL: none. g_free. */
static char *doubt_of(const SporeImport *import) {
  for (guint i = 0; i < import->files->len; i++) {
    const SporeImportFile *file = g_ptr_array_index(import->files, i);
    const SporeImportBody *body = largest(import, file);
    double across = body ? body->as_read.report.diagonal : 0;
    g_autofree char *doubt = body ? spore_length_doubt(across, file->unit) : NULL;
    g_autofree char *length = spore_length_text(across);
    if (doubt) return g_strdup_printf(_("%s, %s across: is the unit right? %s"), body->name, length, doubt);
  }
  return NULL;
}

static void append_line(GString *text, const char *name, const char *said) {
  if (said) g_string_append_printf(text, "%s%s: %s", text->len ? "\n" : "", name, said);
}

/* Warnings for the user: about the unit, then from the files. */
static void show_warnings(SporeImportDialog *self) {
  g_autofree char *doubt = doubt_of(self->import);
  GString *text = g_string_new(doubt);
  gboolean heavy = FALSE;
  for (guint i = 0; i < self->import->files->len; i++) {
    const SporeImportFile *file = g_ptr_array_index(self->import->files, i);
    g_autofree char *remark = spore_import_remark(file), *base = g_path_get_basename(file->file);
    append_line(text, base, remark);
  }
  for (guint i = 0; i < self->import->bodies->len; i++) {
    const SporeImportBody *body = g_ptr_array_index(self->import->bodies, i);
    g_autofree char *size = spore_import_doubt(body), *burden = spore_import_burden(body);
    append_line(text, body->name, size);
    append_line(text, body->name, burden);
    append_line(text, body->name, body->untextured);
    append_line(text, body->name, body->unclear);
    heavy = heavy || burden;
  }
  for (guint i = 0; i < self->import->left_out->len; i++)
    g_string_append_printf(text, _("%sLeft out: %s"), text->len ? "\n" : "", (char *)self->import->left_out->pdata[i]);
  gtk_label_set_text(GTK_LABEL(self->warning), text->str);
  gtk_widget_set_visible(self->warning, text->len > 0);
  gtk_widget_set_visible(self->lighten, heavy);
  g_string_free(text, TRUE);
}

/* "2 bodies; the unit, mm, is guessed from the size" */
static char *state_of(SporeImportDialog *self, const char *count) {
  g_autoptr(GString) units = g_string_new(NULL);
  guint different = 0, known = 0;
  for (guint i = 0; i < self->import->files->len; i++) {
    const SporeImportFile *file = g_ptr_array_index(self->import->files, i);
    if (known & 1u << file->unit) continue;
    known |= 1u << file->unit;
    g_string_append_printf(units, different++ ? ", %s" : "%s", spore_length_units[file->unit]);
  }
  if (gtk_combo_box_get_active(GTK_COMBO_BOX(self->unit)) > 0) return g_strdup(count);
  if (self->silent_unit)
    return g_strdup_printf(_("%s; the unit, %s, is that of the preferences, or said by a file"), count, units->str);
  return g_strdup_printf(different > 1 ? _("%s; the units, %s, are guessed from the sizes")
                                       : _("%s; the unit, %s, is guessed from the size"),
                         count, units->str);
}

static void show_import(SporeImportDialog *self) {
  gtk_list_store_clear(self->rows);
  for (guint i = 0; i < self->import->bodies->len; i++) add_row(self, g_ptr_array_index(self->import->bodies, i));
  g_autofree char *count =
      g_strdup_printf(ngettext("%u body", "%u bodies", self->import->bodies->len), self->import->bodies->len);
  g_autofree char *text = state_of(self, count);
  gtk_label_set_text(GTK_LABEL(self->state), text);
  show_warnings(self);
  gtk_widget_set_sensitive(self->accept, TRUE);
  gtk_widget_set_visible(self->together, spore_import_dialog_get_label_map(self) != NULL);
  gtk_widget_grab_default(self->accept);
}

/* Reading. */

static void drop_work(SporeImportDialog *self) {
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  g_clear_handle_id(&self->settling, g_source_remove);
  g_clear_pointer(&self->import, spore_import_free);
  gtk_widget_set_sensitive(self->accept, FALSE);
  gtk_widget_hide(self->together);
  gtk_widget_hide(self->lighten);
  gtk_widget_hide(self->warning);
}

static void read_through(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeImportDialog *self = owner;
  SporeImportWork *work = data;
  if (self->job != job) return; /* the user has made another choice, or the dialog is closed */
  g_clear_object(&self->job);
  gtk_spinner_stop(GTK_SPINNER(self->spinner));
  if (error) {
    gtk_list_store_clear(self->rows);
    gtk_label_set_text(GTK_LABEL(self->state), error->message);
    return;
  }
  self->import = g_steal_pointer(&work->import);
  show_import(self);
}

static void read_options(SporeImportDialog *self, SporeImportOptions *options) {
  options->unit = gtk_combo_box_get_active(GTK_COMBO_BOX(self->unit)) - 1;
  options->silent_unit = self->silent_unit;
  options->frame = gtk_combo_box_get_active(GTK_COMBO_BOX(self->frame)) - 1;
  options->division = (SporeImportDivision)gtk_combo_box_get_active(GTK_COMBO_BOX(self->division));
  for (int i = 0; i < SPORE_MESH_OPERATIONS; i++) {
    options->operations[i].wanted = gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(self->wanted[i]));
    if (self->argument[i])
      options->operations[i].argument = gtk_spin_button_get_value(GTK_SPIN_BUTTON(self->argument[i]));
  }
}

static gboolean start_reading(gpointer data) {
  SporeImportDialog *self = data;
  SporeImportOptions options = {.lenient = TRUE};
  self->settling = 0;
  read_options(self, &options);
  gtk_label_set_text(GTK_LABEL(self->state), _("Reading…"));
  gtk_spinner_start(GTK_SPINNER(self->spinner));
  self->job = spore_job_start(_("Reading meshes"), spore_import_work_run,
                              spore_import_work_new((char *const *)self->files->pdata, &options),
                              spore_import_work_free, read_through, G_OBJECT(self));
  return G_SOURCE_REMOVE;
}

static void read_soon(SporeImportDialog *self) {
  drop_work(self);
  if (self->files->len > 1) self->settling = g_timeout_add(SETTLE_MS, start_reading, self);
  else gtk_list_store_clear(self->rows);
}

/* Choices. */

static void choice_changed(GtkWidget *widget, SporeImportDialog *self) { read_soon(self); }

/* Meshes of fewer triangles stay as they are. How far the surface moves is shown with the others. */
static void lighten(GtkButton *button, SporeImportDialog *self) {
  gtk_spin_button_set_value(GTK_SPIN_BUTTON(self->argument[SPORE_MESH_DECIMATE]), SPORE_IMPORT_TRIANGLES_ENOUGH);
  gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(self->wanted[SPORE_MESH_DECIMATE]), TRUE);
}

/* Of a folder, all meshes in it. */
static void add_file(SporeImportDialog *self, const char *file) {
  g_autoptr(GPtrArray) of_folder = spore_mesh_files_of_folder(file);
  for (guint i = 0; of_folder && i < of_folder->len; i++) add_file(self, of_folder->pdata[i]);
  if (!of_folder) g_ptr_array_insert(self->files, (int)self->files->len - 1, g_strdup(file)); /* before the NULL */
}

/* Begins where the last file lies, else at home. */
static void choose(SporeImportDialog *self, const char *title, GtkFileChooserAction action) {
  g_autoptr(GtkFileChooserNative) native =
      gtk_file_chooser_native_new(title, GTK_WINDOW(self), action, _("_Add"), _("_Cancel"));
  GtkFileChooser *chooser = GTK_FILE_CHOOSER(native);
  if (action == GTK_FILE_CHOOSER_ACTION_OPEN) spore_mesh_files_filter(chooser);
  const guint count = self->files->len - 1;
  g_autofree char *beside = count ? g_path_get_dirname(self->files->pdata[count - 1]) : NULL;
  gtk_file_chooser_set_current_folder(chooser, beside ? beside : g_get_home_dir());
  gtk_file_chooser_set_select_multiple(chooser, TRUE);
  if (gtk_native_dialog_run(GTK_NATIVE_DIALOG(native)) != GTK_RESPONSE_ACCEPT) return;
  GSList *chosen = gtk_file_chooser_get_filenames(chooser);
  for (GSList *file = chosen; file; file = file->next) add_file(self, file->data);
  g_slist_free_full(chosen, g_free);
  if (self->files->len - 1 > count) read_soon(self);
  else gtk_label_set_text(GTK_LABEL(self->state), _("There are no meshes in this folder"));
}

static void add_files(GtkButton *button, SporeImportDialog *self) {
  choose(self, _("Choose meshes"), GTK_FILE_CHOOSER_ACTION_OPEN);
}

static void add_folder(GtkButton *button, SporeImportDialog *self) {
  choose(self, _("Choose a folder of meshes"), GTK_FILE_CHOOSER_ACTION_SELECT_FOLDER);
}

static void clear_files(GtkButton *button, SporeImportDialog *self) {
  g_ptr_array_set_size(self->files, 0);
  g_ptr_array_add(self->files, NULL);
  gtk_label_set_text(GTK_LABEL(self->state), _("STL, OBJ, PLY, OFF, glTF, GLB or VTK; label maps: NIfTI, NRRD"));
  read_soon(self);
}

/* Making. */

static void spore_import_dialog_dispose(GObject *object) {
  SporeImportDialog *self = SPORE_IMPORT_DIALOG(object);
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  g_clear_handle_id(&self->settling, g_source_remove);
  g_clear_pointer(&self->import, spore_import_free);
  g_clear_pointer(&self->files, g_ptr_array_unref);
  G_OBJECT_CLASS(spore_import_dialog_parent_class)->dispose(object);
}

static void spore_import_dialog_class_init(SporeImportDialogClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_import_dialog_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-import-dialog.ui");
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, bodies);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, unit);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, frame);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, division);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, operations);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, spinner);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, state);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, warning);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, lighten);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, accept);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, together);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, rows);
  gtk_widget_class_bind_template_callback(widget, add_files);
  gtk_widget_class_bind_template_callback(widget, add_folder);
  gtk_widget_class_bind_template_callback(widget, clear_files);
  gtk_widget_class_bind_template_callback(widget, choice_changed);
  gtk_widget_class_bind_template_callback(widget, lighten);
}

static void add_operation(SporeImportDialog *self, int kind) {
  const SporeMeshOperation *operation = &spore_mesh_operations[kind];
  GtkGrid *grid = GTK_GRID(self->operations);
  self->wanted[kind] = gtk_check_button_new_with_label(_(operation->label));
  gtk_widget_set_tooltip_text(self->wanted[kind], _(operation->doc));
  g_signal_connect(self->wanted[kind], "toggled", G_CALLBACK(choice_changed), self);
  gtk_grid_attach(grid, self->wanted[kind], 0, kind, 1, 1);
  self->argument[kind] = spore_operation_spin_new(operation);
  if (self->argument[kind]) {
    GtkWidget *label = gtk_label_new(_(operation->argument_label));
    gtk_style_context_add_class(gtk_widget_get_style_context(label), "dim-label");
    gtk_label_set_xalign(GTK_LABEL(label), 0);
    gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
    gtk_label_set_max_width_chars(GTK_LABEL(label), ARGUMENT_CHARS);
    g_signal_connect(self->argument[kind], "value-changed", G_CALLBACK(choice_changed), self);
    g_object_bind_property(self->wanted[kind], "active", self->argument[kind], "sensitive", G_BINDING_SYNC_CREATE);
    gtk_grid_attach(grid, self->argument[kind], 1, kind, 1, 1);
    gtk_grid_attach(grid, label, 2, kind, 1, 1);
  }
}

static void add_columns(SporeImportDialog *self) {
  const char *const titles[] = {_("Body"),       _("Across"),       _("Triangles"),   _("Pieces"),
                                _("Open edges"), _("Non-manifold"), _("Volume, cm³"), _("Moved")};
  for (int i = 0; i < (int)G_N_ELEMENTS(titles); i++) {
    GtkCellRenderer *cell = gtk_cell_renderer_text_new();
    GtkTreeViewColumn *column = gtk_tree_view_column_new_with_attributes(titles[i], cell, "text", i, NULL);
    gtk_tree_view_column_set_resizable(column, TRUE);
    if (i == COLUMN_BODY) gtk_tree_view_column_set_expand(column, TRUE);
    else g_object_set(cell, "xalign", 1.0, NULL);
    gtk_tree_view_append_column(GTK_TREE_VIEW(self->bodies), column);
  }
}

static void spore_import_dialog_init(SporeImportDialog *self) {
  self->files = g_ptr_array_new_with_free_func(g_free);
  g_ptr_array_add(self->files, NULL);
  gtk_widget_init_template(GTK_WIDGET(self));
  gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(self->unit), _("Guessed for each file"));
  for (int i = 0; spore_length_units[i]; i++)
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(self->unit), spore_length_units[i]);
  for (int i = 0; i < SPORE_MESH_OPERATIONS; i++) add_operation(self, i);
  add_columns(self);
  g_autofree char *lighten = spore_lighten_label();
  gtk_button_set_label(GTK_BUTTON(self->lighten), lighten);
  gtk_widget_set_tooltip_text(self->lighten, spore_lighten_doc());
  gtk_widget_show_all(self->operations);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->unit), 0);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->frame), 0);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->division), SPORE_IMPORT_FILES);
  spore_combo_shrinks(self->unit, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  spore_combo_shrinks(self->frame, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  spore_combo_shrinks(self->division, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  spore_ignore_wheel(self->unit);
  spore_ignore_wheel(self->frame);
  spore_ignore_wheel(self->division);
  gtk_label_set_text(GTK_LABEL(self->state), _("STL, OBJ, PLY, OFF, glTF, GLB or VTK; label maps: NIfTI, NRRD"));
}

/* The unit of files that do not say theirs, as the user prefers it. */
static void follow_preference(SporeImportDialog *self, GtkApplication *application) {
  g_autofree char *unit = spore_preferences_state(application, "unit");
  for (guint i = 0; spore_length_units[i]; i++)
    if (g_str_equal(unit, spore_length_units[i])) self->silent_unit = i + 1;
  if (!self->silent_unit) return;
  g_autofree char *text = g_strdup_printf(_("%s, but where a file says its own"), unit);
  gtk_combo_box_text_remove(GTK_COMBO_BOX_TEXT(self->unit), 0);
  gtk_combo_box_text_prepend_text(GTK_COMBO_BOX_TEXT(self->unit), text);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->unit), 0);
}

GtkWidget *spore_import_dialog_new(GtkWindow *parent, const char *const *files) {
  SporeImportDialog *self =
      g_object_new(SPORE_TYPE_IMPORT_DIALOG, "transient-for", parent, "use-header-bar", TRUE, NULL);
  follow_preference(self, gtk_window_get_application(parent));
  for (; files && *files; files++) add_file(self, *files);
  read_soon(self);
  return GTK_WIDGET(self);
}

const char *spore_import_dialog_get_label_map(SporeImportDialog *self) {
  const GPtrArray *files = self->import ? self->import->files : NULL;
  const SporeImportFile *file = files && files->len == 1 ? files->pdata[0] : NULL;
  return file && file->label_map ? file->file : NULL;
}

SporeImport *spore_import_dialog_take(SporeImportDialog *self) { return g_steal_pointer(&self->import); }
