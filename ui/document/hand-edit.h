/* Spheres of a body, points of its curve, or its regions, changed one at a time by hand. No GTK: what the viewport's
 * gestures do. */
#ifndef SPORE_UI_DOCUMENT_HAND_EDIT_H
#define SPORE_UI_DOCUMENT_HAND_EDIT_H

#include "core/scene/document.h"

typedef enum SporeHandEditKind { SPORE_HAND_SPHERES, SPORE_HAND_CURVE, SPORE_HAND_REGIONS } SporeHandEditKind;

typedef struct SporeHandEdit {
  guint32 asset, body;    /* ids; 0: there is nothing to edit. asset: of regions what holds them */
  SporeHandEditKind kind; /* points of a curve are in its order */
  gsize count;
  double *points; /* count x 4: x y z r, in the body's axes; what is shown, committed or not */
  double
      *weights; /* count, of a set that has them; NULL: it has none. A new sphere gets that of the chosen one, or 1 */
  double level; /* m, of a set with weights */
  gsize chosen; /* G_MAXSIZE: none */
} SporeHandEdit;

/* Takes what the selected object (an asset, or a body or part of one) offers: its spheres, else its curve, be it only
 * the line in the middle of what the body shows. Goes on with
 * what is chosen where it is the same. FALSE: it offers nothing. */
gboolean spore_hand_edit_open(SporeHandEdit *edit, SporeDocument *document, SporeObject *selected);
/* Takes the regions that the object holds; the same otherwise. */
gboolean spore_hand_edit_open_regions(SporeHandEdit *edit, SporeDocument *document, SporeObject *holder);
void spore_hand_edit_close(SporeHandEdit *edit);
/* Nearest that the ray meets, in the body's axes; G_MAXSIZE: none. */
gsize spore_hand_edit_pick(const SporeHandEdit *edit, SporeVec3 origin, SporeVec3 direction);
/* A copy of radius r (0: of the chosen one, else of the mean) at the place, which is then chosen. Of a curve it comes
 * after the chosen point. Not for regions, which are objects: they are added and removed by their own edits. */
void spore_hand_edit_add(SporeHandEdit *edit, SporeVec3 place, double r);
/* FALSE: a curve has no fewer than two points, a set no fewer than one. */
gboolean spore_hand_edit_remove(SporeHandEdit *edit);
/* Of regions: what is shown of the chosen one becomes its own at once. A gesture that does so again and again holds a
 * group of the document open, so that it is one undo step. */
gboolean spore_hand_edit_write_region(SporeHandEdit *edit, SporeDocument *document, GError **error);
/* What is shown becomes the asset's, as one undo step called `label` (translated), and is remarked as edited. FALSE: it
 * is not sound, and what is shown is taken back. */
gboolean spore_hand_edit_commit(SporeHandEdit *edit, SporeDocument *document, const char *label, GError **error);

#endif
