/* Inside the outliner: its state, and its files from the lowest up. */
#ifndef SPORE_UI_PANELS_SPORE_OUTLINER_PRIVATE_H
#define SPORE_UI_PANELS_SPORE_OUTLINER_PRIVATE_H

#include "ui/panels/spore-outliner.h"

enum {
  COLUMN_ID, /* of the object; 0: a heading, or a folder below one */
  COLUMN_NAME,
  COLUMN_BADGE,
  COLUMN_PROBLEM,
  COLUMN_NAMED,
  COLUMN_WEIGHT,
  COLUMN_KIND,
  COLUMN_EYE, /* icon; NULL: nothing that a view could hide */
  COLUMN_LOCK /* icon; NULL: nothing that could be locked */
};

struct _SporeOutliner {
  GtkBox parent;
  GtkWidget *filter, *tree, *menu; /* menu: the last one that was shown; NULL: none yet */
  GtkTreeStore *store;
  GtkTreeModelFilter *filtered;
  GtkTreeSelection *selection;
  GtkTreeViewColumn *column, *eye, *lock;
  GtkCellRenderer *name;
  SporeEditorDocument *document;
  guint rebuild;
  gboolean filling;
  GHashTable *badges;   /* id -> SporeSeverity + 1 */
  GHashTable *problems; /* id -> char *: what the badge stands for */
  GHashTable *hidden;   /* ids of bodies that are hidden in the view; the view's; NULL: not told yet */
  GHashTable *locked;   /* likewise, of bodies that are locked in the view */
  GHashTable *folded;   /* names of headings and folders that are folded; of char * */
  guint32 dragged;      /* id of the row that is dragged; 0: none, and so long the rows stay as they are */
};

/* spore-outliner-order.c: moving rows within their list. */
/* Lets rows be dragged. */
void spore_outliner_take_drags(SporeOutliner *self);
/* Object of the row, which the filter shows; NULL: a heading or a folder. */
SporeObject *spore_outliner_object_at(SporeOutliner *self, GtkTreePath *path);
/* Name of the folder that the row is; NULL: it is none. g_free. */
char *spore_outliner_folder_at(SporeOutliner *self, GtkTreePath *path);

/* spore-outliner-menu.c: the menu of the right button and of the Menu key. */
/* event: what asked for it; path: of the row. */
void spore_outliner_popup(SporeOutliner *self, const GdkEvent *event, GtkTreePath *path);

#endif
