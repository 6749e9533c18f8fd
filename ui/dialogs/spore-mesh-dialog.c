/* The dialog that asks for the argument of an operation on a mesh. */
#include "ui/dialogs/spore-mesh-dialog.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/organ_import.h"
#include "ui/panels/report.h"

#define TEXT_CHARS 72
#define ARGUMENT "spore-argument" /* the spin button, at its dialog */

GtkWidget *spore_operation_spin_new(const SporeMeshOperation *operation) {
  if (!operation->argument) return NULL;
  double step = operation->whole ? 1 : operation->minimum > 0 ? operation->usual / 10 : 0.1;
  GtkWidget *spin = gtk_spin_button_new_with_range(operation->minimum, operation->maximum, step);
  if (!operation->whole) gtk_spin_button_set_digits(GTK_SPIN_BUTTON(spin), (guint)ceil(-log10(operation->usual)) + 2);
  gtk_spin_button_set_value(GTK_SPIN_BUTTON(spin), operation->usual);
  gtk_widget_set_tooltip_text(spin, _(operation->doc));
  atk_object_set_name(gtk_widget_get_accessible(spin), _(operation->argument_label));
  spore_ignore_wheel(spin);
  return spin;
}

char *spore_figures_text(const SporeMeshFigures *figures) {
  return g_strdup_printf(_("%zu triangles, pieces: %zu, open edges: %zu, non-manifold edges: %zu, %.4g cm³"),
                         figures->triangles, figures->report.components, figures->report.boundary_edges,
                         figures->report.nonmanifold_edges, 1e6 * figures->report.volume);
}

char *spore_lighten_label(void) { return g_strdup_printf(_("Decimate to %u"), SPORE_IMPORT_TRIANGLES_ENOUGH); }

const char *spore_lighten_doc(void) {
  return _("Leave that many triangles, where the shape loses least. Spheres and tetrahedra fit as well; how far the "
           "surface moves is measured and shown");
}

GtkWidget *spore_mesh_dialog_new(GtkWindow *parent, const SporeMeshOperation *operation, const char *name,
                                 const SporeMeshFigures *figures) {
  GtkWidget *dialog =
      gtk_dialog_new_with_buttons(_(operation->label), parent, GTK_DIALOG_MODAL | GTK_DIALOG_USE_HEADER_BAR,
                                  _("_Cancel"), GTK_RESPONSE_CANCEL, _("_Apply"), GTK_RESPONSE_ACCEPT, NULL);
  GtkWidget *box = gtk_dialog_get_content_area(GTK_DIALOG(dialog)), *spin = spore_operation_spin_new(operation);
  g_autofree char *text = spore_figures_text(figures), *now = g_strdup_printf("%s: %s", name, text);
  GtkWidget *about = gtk_label_new(_(operation->doc)), *state = gtk_label_new(now);
  gtk_container_set_border_width(GTK_CONTAINER(box), 18);
  gtk_box_set_spacing(GTK_BOX(box), 12);
  for (int i = 0; i < 2; i++) {
    gtk_label_set_line_wrap(GTK_LABEL(i ? state : about), TRUE);
    gtk_label_set_max_width_chars(GTK_LABEL(i ? state : about), TEXT_CHARS);
    gtk_label_set_xalign(GTK_LABEL(i ? state : about), 0);
  }
  gtk_container_add(GTK_CONTAINER(box), about);
  /* The current number of triangles would change nothing. */
  if (operation == &spore_mesh_operations[SPORE_MESH_DECIMATE] && operation->usual >= (double)figures->triangles)
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(spin), floor(0.5 * (double)figures->triangles));
  if (spin) {
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 12);
    gtk_container_add(GTK_CONTAINER(row), spin);
    gtk_container_add(GTK_CONTAINER(row), gtk_label_new(_(operation->argument_label)));
    gtk_container_add(GTK_CONTAINER(box), row);
    g_object_set_data(G_OBJECT(dialog), ARGUMENT, spin);
    gtk_entry_set_activates_default(GTK_ENTRY(spin), TRUE);
  }
  gtk_container_add(GTK_CONTAINER(box), state);
  gtk_dialog_set_default_response(GTK_DIALOG(dialog), GTK_RESPONSE_ACCEPT);
  gtk_widget_show_all(box);
  return dialog;
}

double spore_mesh_dialog_get_argument(GtkWidget *dialog) {
  GtkWidget *spin = g_object_get_data(G_OBJECT(dialog), ARGUMENT);
  return spin ? gtk_spin_button_get_value(GTK_SPIN_BUTTON(spin)) : 0;
}
