/* What the advisor says of the scene: which bodies nobody would miss the physics of. */
#ifndef SPORE_UI_PANELS_SPORE_ADVICE_H
#define SPORE_UI_PANELS_SPORE_ADVICE_H

#include <gtk/gtk.h>

/* A SporeFindingBox. */
GtkWidget *spore_advice_box_new(void);

#endif
