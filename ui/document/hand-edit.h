/* Spheres of a body, points of its curve, or its regions, changed one at a time by hand. No GTK: what the viewport's
 * gestures do. */
#ifndef SPORE_UI_DOCUMENT_HAND_EDIT_H
#define SPORE_UI_DOCUMENT_HAND_EDIT_H

#include "core/scene/document.h"

typedef enum SporeHandEditKind { SPORE_HAND_SPHERES, SPORE_HAND_CURVE, SPORE_HAND_REGIONS } SporeHandEditKind;

typedef struct SporeHandEdit {
  guint32 asset, body;    /* ids; 0: nothing to edit. asset: for regions, the object that holds them */
  SporeHandEditKind kind; /* points of a curve are in its order */
  gsize count;
  double *points; /* count x 4: x y z r, in the body's axes; what is shown, committed or not */
  double
      *weights; /* count, of a set that has them; NULL: it has none. A new sphere gets that of the chosen one, or 1 */
  double level; /* m, of a set with weights */
  gsize chosen; /* G_MAXSIZE: none */
} SporeHandEdit;

/* Opens the spheres of the selected object (an asset, a body, or part of a body), else its curve, also where the curve
 * is only the middle line of what the body shows. The choice is kept where the object stays the same. FALSE: nothing to
 * edit. */
gboolean spore_hand_edit_open(SporeHandEdit *edit, SporeDocument *document, SporeObject *selected);
/* Opens the regions of the object, in the same way. */
gboolean spore_hand_edit_open_regions(SporeHandEdit *edit, SporeDocument *document, SporeObject *holder);
void spore_hand_edit_close(SporeHandEdit *edit);
/* The nearest sphere or point that the ray meets, in the body's axes; G_MAXSIZE: none. */
gsize spore_hand_edit_pick(const SporeHandEdit *edit, SporeVec3 origin, SporeVec3 direction);
/* Adds a sphere or point of radius r (0: the radius of the chosen one, else the mean) at the place, and chooses it. In
 * a curve it comes after the chosen point. Regions are objects, and are added and removed by their own edits. */
void spore_hand_edit_add(SporeHandEdit *edit, SporeVec3 place, double r);
/* Removes the chosen one. FALSE: a curve keeps at least two points, a set at least one sphere. */
gboolean spore_hand_edit_remove(SporeHandEdit *edit);
/* Writes the chosen region to the document at once. A gesture that does this repeatedly keeps a group of the document
 * open, so that the gesture is one undo step. */
gboolean spore_hand_edit_write_region(SporeHandEdit *edit, SporeDocument *document, GError **error);
/* Writes the edited values to the asset, as one undo step called `label` (translated), and marks the asset as edited.
 * FALSE: the values are not valid, and the edit is undone. */
gboolean spore_hand_edit_commit(SporeHandEdit *edit, SporeDocument *document, const char *label, GError **error);

#endif
