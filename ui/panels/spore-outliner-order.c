/* Rows of the outliner moved within their list: by keys and by dragging. What stands below one heading may come from
 * several lists of the scene; a row stays in its own. */
#include <glib/gi18n.h>

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

/* Whether both rows stand below one heading and are of one list. */
static gboolean are_alike(SporeOutliner *self, GtkTreePath *a, GtkTreePath *b) {
  const SporeObject *first = spore_outliner_object_at(self, a), *second = spore_outliner_object_at(self, b);
  g_autoptr(GtkTreePath) above_a = gtk_tree_path_copy(a), above_b = gtk_tree_path_copy(b);
  if (!first || !second || spore_object_parent(first) != spore_object_parent(second)) return FALSE;
  return gtk_tree_path_get_depth(a) > 1 && gtk_tree_path_up(above_a) && gtk_tree_path_up(above_b) &&
         gtk_tree_path_compare(above_a, above_b) == 0;
}

static void reorder(SporeOutliner *self, const GArray *ids, SporeObject *target, gboolean after) {
  g_autoptr(GError) error = NULL;
  if (!spore_edit_reorder(spore_editor_document_get(self->document), ids, target, after, &error))
    spore_report(GTK_WIDGET(self), error);
}

/* By keys. */

/* The row before the first of those, or after the last. NULL: there is none of their list. gtk_tree_path_free. */
static GtkTreePath *neighbour(SporeOutliner *self, GList *rows, int by) {
  GtkTreePath *path = gtk_tree_path_copy(by < 0 ? rows->data : g_list_last(rows)->data);
  if (by > 0) gtk_tree_path_next(path);
  gboolean there = by > 0 || gtk_tree_path_prev(path);
  for (GList *row = rows; there && row; row = row->next) there = are_alike(self, path, row->data);
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

/* The row beside which the dragged one would land there. NULL: it cannot. */
static SporeObject *target_at(SporeOutliner *self, int x, int y, gboolean *after) {
  g_autoptr(GtkTreePath) path = NULL;
  GtkTreeViewDropPosition position;
  Row dragged = {self->dragged, NULL};
  if (!dragged.id || !gtk_tree_view_get_dest_row_at_pos(GTK_TREE_VIEW(self->tree), x, y, &path, &position)) return NULL;
  gtk_tree_model_foreach(GTK_TREE_MODEL(self->filtered), find_row, &dragged);
  gboolean alike = dragged.path && are_alike(self, dragged.path, path);
  if (dragged.path) gtk_tree_path_free(dragged.path);
  *after = position == GTK_TREE_VIEW_DROP_AFTER || position == GTK_TREE_VIEW_DROP_INTO_OR_AFTER;
  if (alike)
    gtk_tree_view_set_drag_dest_row(GTK_TREE_VIEW(self->tree), path,
                                    *after ? GTK_TREE_VIEW_DROP_AFTER : GTK_TREE_VIEW_DROP_BEFORE);
  return alike ? spore_outliner_object_at(self, path) : NULL;
}

/* The tree's own handler scrolls where the rows go on beyond the edge. */
static gboolean drag_moves(GtkWidget *tree, GdkDragContext *context, int x, int y, guint time, SporeOutliner *self) {
  gboolean after;
  if (gtk_drag_dest_find_target(tree, context, NULL) == GDK_NONE) return FALSE;
  GTK_WIDGET_GET_CLASS(tree)->drag_motion(tree, context, x, y, time);
  gboolean may = target_at(self, x, y, &after) != NULL;
  if (!may) gtk_tree_view_set_drag_dest_row(GTK_TREE_VIEW(tree), NULL, GTK_TREE_VIEW_DROP_BEFORE);
  gdk_drag_status(context, may ? GDK_ACTION_MOVE : 0, time);
  return TRUE;
}

static gboolean drag_drops(GtkWidget *tree, GdkDragContext *context, int x, int y, guint time, SporeOutliner *self) {
  gboolean after;
  if (gtk_drag_dest_find_target(tree, context, NULL) == GDK_NONE) return FALSE;
  SporeObject *target = target_at(self, x, y, &after);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  g_array_append_val(ids, self->dragged);
  gtk_drag_finish(context, target != NULL, FALSE, time);
  gtk_tree_view_set_drag_dest_row(GTK_TREE_VIEW(tree), NULL, GTK_TREE_VIEW_DROP_BEFORE);
  if (target) reorder(self, ids, target, after);
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
