#include "ui/dialogs/spore-import-dialog.h"

#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "ui/jobs/spore-job.h"
#include "ui/jobs/works.h"
#include "ui/panels/report.h"

/* Organs and instruments lie between; outside a warning is given. */
#define SMALLEST_M 0.003
#define LARGEST_M 1.0
/* The unit is guessed so that the mesh becomes at least this large, and not larger than LARGEST_M. */
#define USUAL_M 0.02

struct _SporeImportDialog {
  GtkDialog parent;
  GtkWidget *file, *unit, *frame, *spinner, *preview, *warning, *accept;
  SporeJob *job;
  gboolean known;   /* the mesh was read */
  double extent[3]; /* in the file's own numbers and axes */
  gsize triangles;
};

G_DEFINE_FINAL_TYPE(SporeImportDialog, spore_import_dialog, GTK_TYPE_DIALOG)

/* Sizes along SPORE's axes: both patient frames turn z up. */
static void size_m(SporeImportDialog *self, double size[3]) {
  double scale = spore_length_unit_m[spore_import_dialog_get_unit(self)];
  gboolean patient = spore_import_dialog_get_frame(self) != 0;
  size[0] = scale * self->extent[0];
  size[1] = scale * self->extent[patient ? 2 : 1];
  size[2] = scale * self->extent[patient ? 1 : 2];
}

static void show_size(SporeImportDialog *self) {
  double size[3];
  if (!self->known) return;
  size_m(self, size);
  double largest = MAX(size[0], MAX(size[1], size[2]));
  g_autofree char *text = g_strdup_printf(_("%.4g × %.4g × %.4g mm (wide, high, deep), %zu triangles"), 1e3 * size[0],
                                          1e3 * size[1], 1e3 * size[2], self->triangles);
  gtk_label_set_text(GTK_LABEL(self->preview), text);
  gboolean odd = largest < SMALLEST_M || largest > LARGEST_M;
  gtk_label_set_text(GTK_LABEL(self->warning), largest > LARGEST_M
                                                   ? _("This is larger than a person's trunk. Is the unit right?")
                                                   : _("This is smaller than a fingernail. Is the unit right?"));
  gtk_widget_set_visible(self->warning, odd);
}

/* cm is rare in mesh files: mm, then m, then cm. */
static void guess_unit(SporeImportDialog *self) {
  static const int order[] = {2, 0, 1};
  double largest = MAX(self->extent[0], MAX(self->extent[1], self->extent[2]));
  for (gsize i = 0; i < G_N_ELEMENTS(order); i++) {
    double metres = largest * spore_length_unit_m[order[i]];
    if (metres < USUAL_M || metres > LARGEST_M) continue;
    gtk_combo_box_set_active(GTK_COMBO_BOX(self->unit), order[i]);
    return;
  }
}

static void decoded(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeImportDialog *self = owner;
  SporeImportWork *work = data;
  if (self->job != job) return; /* another file was chosen since, or the dialog is gone */
  g_clear_object(&self->job);
  gtk_spinner_stop(GTK_SPINNER(self->spinner));
  gtk_widget_hide(self->spinner);
  SporeMeshReport report;
  if (error || !spore_triangle_mesh_report(&work->mesh, &report, NULL)) {
    gtk_label_set_text(GTK_LABEL(self->preview), error ? error->message : _("not enough memory"));
    return;
  }
  self->known = TRUE;
  self->triangles = work->mesh.triangle_count;
  for (int i = 0; i < 3; i++) self->extent[i] = report.upper[i] - report.lower[i];
  guess_unit(self);
  if (work->frame_hint >= 0) gtk_combo_box_set_active(GTK_COMBO_BOX(self->frame), work->frame_hint);
  gtk_widget_set_sensitive(self->accept, TRUE);
  gtk_widget_grab_default(self->accept);
  show_size(self);
}

static void drop_job(SporeImportDialog *self) {
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
}

static void load(SporeImportDialog *self, const char *file) {
  drop_job(self);
  self->known = FALSE;
  gtk_widget_set_sensitive(self->accept, FALSE);
  gtk_widget_hide(self->warning);
  gtk_label_set_text(GTK_LABEL(self->preview), _("Reading…"));
  gtk_widget_show(self->spinner);
  gtk_spinner_start(GTK_SPINNER(self->spinner));
  /* In the file's own numbers: metres and Y up change nothing. */
  self->job = spore_job_start(_("Reading mesh"), spore_import_work_run, spore_import_work_new(file, 0, 0),
                              spore_import_work_free, decoded, G_OBJECT(self));
}

static void file_chosen(GtkFileChooser *chooser, SporeImportDialog *self) {
  g_autofree char *file = gtk_file_chooser_get_filename(chooser);
  if (file) load(self, file);
}

static void choice_changed(GtkComboBox *combo, SporeImportDialog *self) { show_size(self); }

static void spore_import_dialog_dispose(GObject *object) {
  drop_job(SPORE_IMPORT_DIALOG(object));
  G_OBJECT_CLASS(spore_import_dialog_parent_class)->dispose(object);
}

static void spore_import_dialog_class_init(SporeImportDialogClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_import_dialog_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-import-dialog.ui");
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, file);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, unit);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, frame);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, spinner);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, preview);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, warning);
  gtk_widget_class_bind_template_child(widget, SporeImportDialog, accept);
  gtk_widget_class_bind_template_callback(widget, file_chosen);
  gtk_widget_class_bind_template_callback(widget, choice_changed);
}

static void add_filter(SporeImportDialog *self) {
  static const char *const patterns[] = {"*.stl", "*.obj", "*.ply", "*.off", "*.gltf", "*.glb", NULL};
  GtkFileFilter *filter = gtk_file_filter_new(), *all = gtk_file_filter_new();
  gtk_file_filter_set_name(filter, _("Meshes"));
  for (int i = 0; patterns[i]; i++) {
    g_autofree char *upper = g_ascii_strup(patterns[i], -1);
    gtk_file_filter_add_pattern(filter, patterns[i]);
    gtk_file_filter_add_pattern(filter, upper);
  }
  gtk_file_filter_set_name(all, _("All files"));
  gtk_file_filter_add_pattern(all, "*");
  gtk_file_chooser_add_filter(GTK_FILE_CHOOSER(self->file), filter);
  gtk_file_chooser_add_filter(GTK_FILE_CHOOSER(self->file), all);
}

static void spore_import_dialog_init(SporeImportDialog *self) {
  gtk_widget_init_template(GTK_WIDGET(self));
  for (int i = 0; spore_length_units[i]; i++)
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(self->unit), spore_length_units[i]);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->unit), 2);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->frame), 0);
  spore_ignore_wheel(self->unit);
  spore_ignore_wheel(self->frame);
  add_filter(self);
  gtk_label_set_text(GTK_LABEL(self->preview), _("STL, OBJ, PLY, OFF, glTF or GLB"));
}

GtkWidget *spore_import_dialog_new(GtkWindow *parent, const char *file) {
  SporeImportDialog *self =
      g_object_new(SPORE_TYPE_IMPORT_DIALOG, "transient-for", parent, "use-header-bar", TRUE, NULL);
  if (file) {
    gtk_file_chooser_set_filename(GTK_FILE_CHOOSER(self->file), file);
    load(self, file);
  }
  return GTK_WIDGET(self);
}

char *spore_import_dialog_get_file(SporeImportDialog *self) {
  return gtk_file_chooser_get_filename(GTK_FILE_CHOOSER(self->file));
}

int spore_import_dialog_get_unit(SporeImportDialog *self) {
  return gtk_combo_box_get_active(GTK_COMBO_BOX(self->unit));
}

int spore_import_dialog_get_frame(SporeImportDialog *self) {
  return gtk_combo_box_get_active(GTK_COMBO_BOX(self->frame));
}
