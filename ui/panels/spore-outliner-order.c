/* Rows of the outliner moved within their list, and into folders: by keys and by dragging. What stands below one
 * heading may come from several lists of the scene; a row stays in its own. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/order_edits.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-outliner-private.h"

SporeObject *spore_outliner_object_at(SporeOutliner *self, GtkTreePath *path) {
  GtkTreeIter iter;
  guint id = 0;
  if (!self->document || !gtk_tree_model_get_iter(GTK_TREE_MODEL(self->filtered), &iter, path)) return NULL;
  gtk_tree_model_get(GTK_TREE_MODEL(self->filtered), &iter, COLUMN_ID, &id, -1);
  return id ? spore_document_by_id(spore_editor_document_get(self->document), id) : NULL;
}

char *spore_outliner_folder_at(SporeOutliner *self, GtkTreePath *path) {
  GtkTreeIter iter;
  guint id;
  char *name;
  if (gtk_tree_path_get_depth(path) != 2 || !gtk_tree_model_get_iter(GTK_TREE_MODEL(self->filtered), &iter, path))
    return NULL;
  gtk_tree_model_get(GTK_TREE_MODEL(self->filtered), &iter, COLUMN_ID, &id, COLUMN_NAME, &name, -1);
  if (id == 0) return name;
  g_free(name);
  return NULL;
}

/* Whether both rows stand below one heading and are of one list. */
static gboolean are_alike(SporeOutliner *self, GtkTreePath *a, GtkTreePath *b) {
  const SporeObject *first = spore_outliner_object_at(self, a), *second = spore_outliner_object_at(self, b);
  return first && second && spore_object_parent(first) == spore_object_parent(second) &&
         gtk_tree_path_get_depth(a) > 1 && gtk_tree_path_get_indices(a)[0] == gtk_tree_path_get_indices(b)[0];
}

static gboolean are_in_one_folder(SporeOutliner *self, GtkTreePath *a, GtkTreePath *b) {
  return are_alike(self, a, b) && g_strcmp0(spore_folder_of(spore_outliner_object_at(self, a)),
                                            spore_folder_of(spore_outliner_object_at(self, b))) == 0;
}

static void reorder(SporeOutliner *self, const GArray *ids, SporeObject *target, gboolean after) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GError) error = NULL;
  spore_document_begin(document, _("Change the order"));
  if (!spore_edit_finish(document, spore_edit_put_in_folder(document, ids, spore_folder_of(target), &error) &&
                                       spore_edit_reorder(document, ids, target, after, &error)))
    spore_report(GTK_WIDGET(self), error);
}

/* By keys. */

/* The row before the first of those, or after the last. NULL: there is none of their list. gtk_tree_path_free. */
static GtkTreePath *neighbour(SporeOutliner *self, GList *rows, int by) {
  GtkTreePath *path = gtk_tree_path_copy(by < 0 ? rows->data : g_list_last(rows)->data);
  if (by > 0) gtk_tree_path_next(path);
  gboolean there = by > 0 || gtk_tree_path_prev(path);
  for (GList *row = rows; there && row; row = row->next) there = are_in_one_folder(self, path, row->data);
  if (there) return path;
  gtk_tree_path_free(path);
  return NULL;
}

void spore_outliner_move(SporeOutliner *self, int by) {
  GList *rows = gtk_tree_selection_get_selected_rows(self->selection, NULL);
  GtkTreePath *path = rows ? neighbour(self, rows, by) : NULL;
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (GList *row = rows; path && row; row = row->next) {
    guint32 id = spore_object_id(spore_outliner_object_at(self, row->data));
    g_array_append_val(ids, id);
  }
  if (path) reorder(self, ids, spore_outliner_object_at(self, path), by > 0);
  else gtk_widget_error_bell(self->tree);
  if (path) gtk_tree_path_free(path);
  g_list_free_full(rows, (GDestroyNotify)gtk_tree_path_free);
}

/* By dragging. */

static void drag_begins(GtkWidget *tree, GdkDragContext *context, SporeOutliner *self) {
  g_autoptr(GtkTreePath) path = NULL;
  gtk_tree_view_get_cursor(GTK_TREE_VIEW(tree), &path, NULL);
  const SporeObject *object = path ? spore_outliner_object_at(self, path) : NULL;
  self->dragged = object ? spore_object_id(object) : 0;
}

typedef struct Row {
  guint32 id;
  GtkTreePath *path; /* NULL: not found */
} Row;

static gboolean find_row(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  Row *wanted = data;
  guint id;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  if (id != wanted->id) return FALSE;
  wanted->path = gtk_tree_path_copy(path);
  return TRUE;
}

/* Where the dragged row would land. */
typedef struct Landing {
  SporeObject *beside; /* NULL: not beside a row */
  gboolean after;
  char *folder; /* into which it would go; NULL: none is under the cursor */
} Landing;

static Landing landing_at(SporeOutliner *self, int x, int y) {
  g_autoptr(GtkTreePath) path = NULL;
  GtkTreeViewDropPosition position;
  Row dragged = {self->dragged, NULL};
  Landing landing = {NULL};
  GtkTreeView *tree = GTK_TREE_VIEW(self->tree);
  if (!dragged.id || !gtk_tree_view_get_dest_row_at_pos(tree, x, y, &path, &position)) return landing;
  gtk_tree_model_foreach(GTK_TREE_MODEL(self->filtered), find_row, &dragged);
  if (!dragged.path) return landing;
  g_autofree char *folder = spore_outliner_folder_at(self, path);
  gboolean below = gtk_tree_path_get_indices(dragged.path)[0] == gtk_tree_path_get_indices(path)[0];
  landing.after = position == GTK_TREE_VIEW_DROP_AFTER || position == GTK_TREE_VIEW_DROP_INTO_OR_AFTER;
  if (are_alike(self, dragged.path, path)) landing.beside = spore_outliner_object_at(self, path);
  else if (folder && below) landing.folder = g_steal_pointer(&folder);
  gtk_tree_path_free(dragged.path);
  if (landing.beside)
    gtk_tree_view_set_drag_dest_row(tree, path, landing.after ? GTK_TREE_VIEW_DROP_AFTER : GTK_TREE_VIEW_DROP_BEFORE);
  else if (landing.folder) gtk_tree_view_set_drag_dest_row(tree, path, GTK_TREE_VIEW_DROP_INTO_OR_AFTER);
  return landing;
}

/* The tree's own handler scrolls where the rows go on beyond the edge. */
static gboolean drag_moves(GtkWidget *tree, GdkDragContext *context, int x, int y, guint time, SporeOutliner *self) {
  if (gtk_drag_dest_find_target(tree, context, NULL) == GDK_NONE) return FALSE;
  GTK_WIDGET_GET_CLASS(tree)->drag_motion(tree, context, x, y, time);
  const Landing landing = landing_at(self, x, y);
  gboolean may = landing.beside || landing.folder;
  g_free(landing.folder);
  if (!may) gtk_tree_view_set_drag_dest_row(GTK_TREE_VIEW(tree), NULL, GTK_TREE_VIEW_DROP_BEFORE);
  gdk_drag_status(context, may ? GDK_ACTION_MOVE : 0, time);
  return TRUE;
}

static gboolean drag_drops(GtkWidget *tree, GdkDragContext *context, int x, int y, guint time, SporeOutliner *self) {
  if (gtk_drag_dest_find_target(tree, context, NULL) == GDK_NONE) return FALSE;
  const Landing landing = landing_at(self, x, y);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  g_autoptr(GError) error = NULL;
  g_array_append_val(ids, self->dragged);
  gtk_drag_finish(context, landing.beside || landing.folder, FALSE, time);
  gtk_tree_view_set_drag_dest_row(GTK_TREE_VIEW(tree), NULL, GTK_TREE_VIEW_DROP_BEFORE);
  if (landing.beside) reorder(self, ids, landing.beside, landing.after);
  if (landing.folder &&
      !spore_edit_put_in_folder(spore_editor_document_get(self->document), ids, landing.folder, &error))
    spore_report(GTK_WIDGET(self), error);
  g_free(landing.folder);
  return TRUE;
}

void spore_outliner_take_drags(SporeOutliner *self) {
  static const GtkTargetEntry targets[] = {{"SPORE_ROW", GTK_TARGET_SAME_WIDGET, 0}};
  GtkTreeView *tree = GTK_TREE_VIEW(self->tree);
  gtk_tree_view_enable_model_drag_source(tree, GDK_BUTTON1_MASK, targets, G_N_ELEMENTS(targets), GDK_ACTION_MOVE);
  gtk_tree_view_enable_model_drag_dest(tree, targets, G_N_ELEMENTS(targets), GDK_ACTION_MOVE);
  g_signal_connect(tree, "drag-begin", G_CALLBACK(drag_begins), self);
  g_signal_connect(tree, "drag-motion", G_CALLBACK(drag_moves), self);
  g_signal_connect(tree, "drag-drop", G_CALLBACK(drag_drops), self);
}
