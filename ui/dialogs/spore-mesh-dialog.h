/* Asks for the argument of an operation on a mesh, and shows the figures that the mesh has now. */
#ifndef SPORE_UI_DIALOGS_SPORE_MESH_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_MESH_DIALOG_H

#include <gtk/gtk.h>

#include "core/generate/surface/surface.h"

/* A spin button over the range of the operation's argument, named by its label; NULL where it takes none. */
GtkWidget *spore_operation_spin_new(const SporeMeshOperation *operation);
/* "5000 triangles, pieces: 2, open edges: 30, non-manifold edges: 0, 120 cm³". g_free. */
char *spore_figures_text(const SporeMeshFigures *figures);

/* A dialog that responds GTK_RESPONSE_ACCEPT when the operation is to be applied to the mesh of that name. */
GtkWidget *spore_mesh_dialog_new(GtkWindow *parent, const SporeMeshOperation *operation, const char *name,
                                 const SporeMeshFigures *figures);
/* The chosen argument; 0 where the operation takes none. */
double spore_mesh_dialog_get_argument(GtkWidget *dialog);

/* Decimating an imported mesh that is too heavy: the label of the button (g_free), and what it says. */
char *spore_lighten_label(void);
const char *spore_lighten_doc(void);

#endif
