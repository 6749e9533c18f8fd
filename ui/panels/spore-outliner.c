/* The outliner: organs, instruments, cameras, effects, links and assets of the scene as a tree. */
#include "ui/panels/spore-outliner-private.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/order_edits.h"
#include "core/scene/check.h"
#include "core/sim/world.h"
#include "ui/panels/report.h"

G_DEFINE_FINAL_TYPE(SporeOutliner, spore_outliner, GTK_TYPE_BOX)

/* Filling. */

static const char *badge_of(SporeOutliner *self, guint32 id) {
  int severity = GPOINTER_TO_INT(g_hash_table_lookup(self->badges, GUINT_TO_POINTER(id))) - 1;
  if (severity == SPORE_FAULT) return "dialog-error-symbolic";
  return severity == SPORE_WARNING ? "dialog-warning-symbolic" : NULL;
}

/* Beside the name: an instrument's body, tool and view may have names that are alike. Of bodies it says nothing. */
static const char *kind_of(const SporeObject *object) {
  const SporeObjectType *type = spore_object_type(object);
  return g_str_equal(type->element, "body") ? NULL : _(type->label);
}

static gboolean is_in(GHashTable *ids, const SporeObject *object) {
  return ids && g_hash_table_contains(ids, GUINT_TO_POINTER(spore_object_id(object)));
}

static const char *eye_of(SporeOutliner *self, const SporeObject *object) {
  if (!g_str_equal(spore_object_type(object)->element, "body")) return NULL;
  return is_in(self->hidden, object) ? "view-conceal-symbolic" : "view-reveal-symbolic";
}

static const char *lock_of(SporeOutliner *self, const SporeObject *object) {
  if (!g_str_equal(spore_object_type(object)->element, "body")) return NULL;
  return is_in(self->locked, object) ? "changes-prevent-symbolic" : "changes-allow-symbolic";
}

static void add_object(SporeOutliner *self, GtkTreeIter *group, SporeObject *object) {
  guint32 id = spore_object_id(object);
  const char *problem = g_hash_table_lookup(self->problems, GUINT_TO_POINTER(id));
  gtk_tree_store_insert_with_values(self->store, NULL, group, -1, COLUMN_ID, id, COLUMN_NAME, spore_object_name(object),
                                    COLUMN_BADGE, badge_of(self, id), COLUMN_PROBLEM, problem, COLUMN_NAMED, TRUE,
                                    COLUMN_WEIGHT, PANGO_WEIGHT_NORMAL, COLUMN_KIND, kind_of(object), COLUMN_EYE,
                                    eye_of(self, object), COLUMN_LOCK, lock_of(self, object), -1);
}

static void add_group(SporeOutliner *self, const char *title, guint32 id, GtkTreeIter *group) {
  gtk_tree_store_insert_with_values(self->store, group, NULL, -1, COLUMN_ID, id, COLUMN_NAME, title, COLUMN_NAMED,
                                    FALSE, COLUMN_WEIGHT, PANGO_WEIGHT_BOLD, -1);
}

static void add_section(SporeOutliner *self, GtkTreeIter *group, const char *element) {
  SporeObject *section = spore_document_section(spore_editor_document_get(self->document), element);
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *object = spore_object_child(section, i);
    if (spore_object_name(object)) add_object(self, group, object);
  }
}

static void add_tools(SporeOutliner *self, GtkTreeIter *group, gboolean cameras) {
  SporeObject *section = spore_document_section(spore_editor_document_get(self->document), "tools");
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *tool = spore_object_child(section, i);
    if (g_str_equal(spore_object_type(tool)->element, "camera") == cameras) add_object(self, group, tool);
  }
}

/* The row of a body's folder, which stands where its first body would; the heading where it has none. */
static GtkTreeIter row_above(SporeOutliner *self, GtkTreeIter *group, const SporeObject *body, GHashTable *folders) {
  const char *folder = spore_folder_of(body);
  GtkTreeIter *known = folder ? g_hash_table_lookup(folders, folder) : NULL, row;
  if (!folder) return *group;
  if (known) return *known;
  gtk_tree_store_insert_with_values(self->store, &row, group, -1, COLUMN_ID, 0, COLUMN_NAME, folder, COLUMN_NAMED, TRUE,
                                    COLUMN_WEIGHT, PANGO_WEIGHT_NORMAL, COLUMN_KIND, _("Folder"), -1);
  g_hash_table_insert(folders, g_strdup(folder), gtk_tree_iter_copy(&row));
  return row;
}

static void free_iter(gpointer data) { gtk_tree_iter_free(data); }

static void add_bodies(SporeOutliner *self, GtkTreeIter *group, gboolean active) {
  SporeObject *section = spore_document_section(spore_editor_document_get(self->document), "bodies");
  g_autoptr(GHashTable) folders = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, free_iter);
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *body = spore_object_child(section, i);
    if ((spore_object_number(body, "role") == SPORE_ACTIVE) != active) continue;
    GtkTreeIter above = row_above(self, group, body, folders);
    add_object(self, &above, body);
  }
}

/* Icons of a folder: what its bodies are, all of them. */
static gboolean update_folder(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  GtkTreeIter child;
  guint id;
  gboolean hidden = TRUE, locked = TRUE;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  if (id || gtk_tree_path_get_depth(path) != 2 || !gtk_tree_model_iter_children(model, &child, iter)) return FALSE;
  do {
    gtk_tree_model_get(model, &child, COLUMN_ID, &id, -1);
    hidden = hidden && self->hidden && g_hash_table_contains(self->hidden, GUINT_TO_POINTER(id));
    locked = locked && self->locked && g_hash_table_contains(self->locked, GUINT_TO_POINTER(id));
  } while (gtk_tree_model_iter_next(model, &child));
  gtk_tree_store_set(self->store, iter, COLUMN_EYE, hidden ? "view-conceal-symbolic" : "view-reveal-symbolic",
                     COLUMN_LOCK, locked ? "changes-prevent-symbolic" : "changes-allow-symbolic", -1);
  return FALSE;
}

/* What is folded stays so; while something is filtered, all that matches is seen. */
static gboolean fold(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  g_autofree char *name = NULL;
  gtk_tree_model_get(model, iter, COLUMN_NAME, &name, -1);
  if (gtk_tree_model_iter_has_child(model, iter) && name && g_hash_table_contains(self->folded, name))
    gtk_tree_view_collapse_row(GTK_TREE_VIEW(self->tree), path);
  return FALSE;
}

static void unfold(SporeOutliner *self) {
  gtk_tree_view_expand_all(GTK_TREE_VIEW(self->tree));
  if (*gtk_entry_get_text(GTK_ENTRY(self->filter)) == '\0')
    gtk_tree_model_foreach(GTK_TREE_MODEL(self->filtered), fold, self);
}

static void row_folded(GtkTreeView *tree, GtkTreeIter *iter, GtkTreePath *path, SporeOutliner *self) {
  char *name;
  if (self->filling) return;
  gtk_tree_model_get(GTK_TREE_MODEL(self->filtered), iter, COLUMN_NAME, &name, -1);
  g_hash_table_add(self->folded, name);
}

static void row_unfolded(GtkTreeView *tree, GtkTreeIter *iter, GtkTreePath *path, SporeOutliner *self) {
  g_autofree char *name = NULL;
  if (self->filling) return;
  gtk_tree_model_get(GTK_TREE_MODEL(self->filtered), iter, COLUMN_NAME, &name, -1);
  g_hash_table_remove(self->folded, name);
}

static void fill(SporeOutliner *self) {
  GtkTreeIter group;
  gtk_tree_store_clear(self->store);
  add_group(self, _("Scene"), spore_object_id(spore_document_root(spore_editor_document_get(self->document))), &group);
  add_group(self, _("Organs"), 0, &group);
  add_bodies(self, &group, FALSE);
  add_group(self, _("Instruments"), 0, &group);
  add_bodies(self, &group, TRUE);
  add_tools(self, &group, FALSE);
  add_section(self, &group, "devices");
  add_group(self, _("Cameras"), 0, &group);
  add_tools(self, &group, TRUE);
  add_group(self, _("Effects"), 0, &group);
  add_section(self, &group, "effects");
  add_group(self, _("Links"), 0, &group);
  add_section(self, &group, "links");
  add_group(self, _("Assets"), 0, &group);
  add_section(self, &group, "assets");
  gtk_tree_model_foreach(GTK_TREE_MODEL(self->store), update_folder, self);
  unfold(self);
}

/* Selection, both ways. */

static gboolean select_if(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  guint id;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  if (!spore_editor_document_is_selected(self->document, id)) return FALSE;
  gtk_tree_selection_select_iter(self->selection, iter);
  if (id == spore_editor_document_get_selection(self->document))
    gtk_tree_view_scroll_to_cell(GTK_TREE_VIEW(self->tree), path, NULL, FALSE, 0, 0);
  return FALSE;
}

static void show_selection(SporeOutliner *self) {
  self->filling = TRUE;
  gtk_tree_selection_unselect_all(self->selection);
  gtk_tree_model_foreach(GTK_TREE_MODEL(self->filtered), select_if, self);
  self->filling = FALSE;
}

static void collect(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer ids) {
  guint id = 0;
  GtkTreeIter child;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  if (id) g_array_append_val((GArray *)ids, id);
  if (id || !gtk_tree_model_iter_children(model, &child, iter)) return;
  do { /* of a folder, its bodies */
    gtk_tree_model_get(model, &child, COLUMN_ID, &id, -1);
    g_array_append_val((GArray *)ids, id);
  } while (gtk_tree_model_iter_next(model, &child));
}

/* The first selected object stays the first where it is still selected. */
static void row_selected(GtkTreeSelection *selection, SporeOutliner *self) {
  if (self->filling || !self->document) return;
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  gtk_tree_selection_selected_foreach(selection, collect, ids);
  const guint32 first = spore_editor_document_get_selection(self->document);
  for (guint i = 1; i < ids->len; i++) {
    if (g_array_index(ids, guint32, i) != first) continue;
    g_array_remove_index(ids, i);
    g_array_prepend_val(ids, first);
  }
  spore_editor_document_select_several(self->document, (const guint32 *)(gpointer)ids->data, ids->len);
}

static gboolean may_select(GtkTreeSelection *selection, GtkTreeModel *model, GtkTreePath *path, gboolean selected,
                           gpointer data) {
  GtkTreeIter iter;
  guint id = 0;
  if (gtk_tree_model_get_iter(model, &iter, path)) gtk_tree_model_get(model, &iter, COLUMN_ID, &id, -1);
  return id != 0 || gtk_tree_path_get_depth(path) == 2;
}

/* Arrow keys go on from the selected row. */
static gboolean put_cursor(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  guint id;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  if (!id || id != spore_editor_document_get_selection(self->document)) return FALSE;
  gtk_tree_view_set_cursor(GTK_TREE_VIEW(self->tree), path, NULL, FALSE);
  return TRUE;
}

static gboolean rebuild(gpointer data) {
  SporeOutliner *self = data;
  self->rebuild = 0;
  gboolean editing;
  g_object_get(self->name, "editing", &editing, NULL);
  if (self->dragged || editing) return G_SOURCE_REMOVE; /* the end of that queues it again */
  self->filling = TRUE;
  fill(self);
  gtk_tree_model_foreach(GTK_TREE_MODEL(self->filtered), put_cursor, self);
  self->filling = FALSE;
  show_selection(self);
  return G_SOURCE_REMOVE;
}

static void queue_rebuild(SporeOutliner *self) {
  if (!self->rebuild && self->document) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE, rebuild, self, NULL);
}

static void drag_ends(GtkWidget *tree, GdkDragContext *context, SporeOutliner *self) {
  self->dragged = 0;
  queue_rebuild(self);
}

/* Only names, roles, folders and the objects that exist are shown here. */
static void document_changed(SporeOutliner *self, int kind, guint id, guint property) {
  SporeObject *object =
      kind == SPORE_DOCUMENT_SET ? spore_document_by_id(spore_editor_document_get(self->document), id) : NULL;
  const SporeParameter *parameter = object ? &spore_object_type(object)->table->parameters[property] : NULL;
  if (!parameter || parameter->type == SPORE_NAME || g_str_equal(parameter->name, "role") ||
      g_str_equal(parameter->name, "folder"))
    queue_rebuild(self);
}

/* Filter. */

static gboolean matches(GtkTreeModel *model, GtkTreeIter *iter, const char *wanted) {
  g_autofree char *name = NULL;
  gtk_tree_model_get(model, iter, COLUMN_NAME, &name, -1);
  g_autofree char *folded = name ? g_utf8_casefold(name, -1) : NULL;
  return folded && strstr(folded, wanted);
}

/* Groups stay, so that the user sees where a match belongs. */
static gboolean row_visible(GtkTreeModel *model, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  const char *text = gtk_entry_get_text(GTK_ENTRY(self->filter));
  GtkTreeIter parent;
  if (*text == '\0' || !gtk_tree_model_iter_parent(model, &parent, iter)) return TRUE;
  g_autofree char *wanted = g_utf8_casefold(text, -1);
  GtkTreeIter child;
  gboolean more = gtk_tree_model_iter_children(model, &child, iter); /* of a folder */
  for (; more; more = gtk_tree_model_iter_next(model, &child))
    if (matches(model, &child, wanted)) return TRUE;
  return matches(model, iter, wanted);
}

static void filter_changed(GtkSearchEntry *entry, SporeOutliner *self) {
  self->filling = TRUE;
  gtk_tree_model_filter_refilter(self->filtered);
  unfold(self);
  self->filling = FALSE;
  if (self->document) show_selection(self);
}

void spore_outliner_focus_filter(SporeOutliner *self) { gtk_widget_grab_focus(self->filter); }

/* Renaming and removing. */

static void name_edited(GtkCellRendererText *cell, const char *path, const char *text, SporeOutliner *self) {
  GtkTreeIter iter;
  guint id;
  queue_rebuild(self); /* what was put off meanwhile */
  if (!gtk_tree_model_get_iter_from_string(GTK_TREE_MODEL(self->filtered), &iter, path)) return;
  gtk_tree_model_get(GTK_TREE_MODEL(self->filtered), &iter, COLUMN_ID, &id, -1);
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *object = spore_document_by_id(document, id);
  g_autoptr(GError) error = NULL;
  g_autoptr(GtkTreePath) row = gtk_tree_path_new_from_string(path);
  g_autofree char *folder = spore_outliner_folder_at(self, row);
  if (folder && *text && !g_str_equal(folder, text) && !spore_edit_rename_folder(document, folder, text, &error))
    spore_report(GTK_WIDGET(self), error);
  if (!object || g_strcmp0(spore_object_name(object), text) == 0) return;
  if (!spore_document_rename(document, object, text, &error)) spore_report(GTK_WIDGET(self), error);
}

/* The name can be edited from here on alone: else a click on a selected row would begin that, and a drag of it not. */
static void edit_name(SporeOutliner *self, GtkTreePath *path) {
  g_object_set(self->name, "editable", TRUE, NULL);
  gtk_tree_view_set_cursor_on_cell(GTK_TREE_VIEW(self->tree), path, self->column, self->name, TRUE);
  g_object_set(self->name, "editable", FALSE, NULL);
}

void spore_outliner_rename(SporeOutliner *self) {
  GList *rows = gtk_tree_selection_get_selected_rows(self->selection, NULL);
  g_autoptr(GtkTreePath) cursor = NULL;
  gtk_widget_grab_focus(self->tree);
  gtk_tree_view_get_cursor(GTK_TREE_VIEW(self->tree), &cursor, NULL);
  g_autofree char *folder = cursor ? spore_outliner_folder_at(self, cursor) : NULL;
  if (folder) {
    self->filling = TRUE; /* its bodies stay selected */
    edit_name(self, cursor);
    self->filling = FALSE;
    g_list_free_full(rows, (GDestroyNotify)gtk_tree_path_free);
    return;
  }
  if (rows && !rows->next) edit_name(self, rows->data);
  g_list_free_full(rows, (GDestroyNotify)gtk_tree_path_free);
}

/* Left folds the row, or goes to the one above it; Right unfolds it. */
static void walk(SporeOutliner *self, gboolean in) {
  GtkTreeView *tree = GTK_TREE_VIEW(self->tree);
  g_autoptr(GtkTreePath) path = NULL;
  gtk_tree_view_get_cursor(tree, &path, NULL);
  if (!path) return;
  if (in) gtk_tree_view_expand_row(tree, path, FALSE);
  else if (!gtk_tree_view_collapse_row(tree, path) && gtk_tree_path_get_depth(path) > 1 && gtk_tree_path_up(path))
    gtk_tree_view_set_cursor(tree, path, NULL, FALSE);
}

static gboolean tree_key(GtkWidget *tree, GdkEventKey *event, SporeOutliner *self) {
  gboolean alt = event->state & GDK_MOD1_MASK;
  gboolean plain = !(event->state & gtk_accelerator_get_default_mod_mask());
  if (event->keyval == GDK_KEY_F2) spore_outliner_rename(self);
  else if (plain && event->keyval == GDK_KEY_Left) walk(self, FALSE);
  else if (plain && event->keyval == GDK_KEY_Right) walk(self, TRUE);
  else if (alt && event->keyval == GDK_KEY_Up) spore_outliner_move(self, -1);
  else if (alt && event->keyval == GDK_KEY_Down) spore_outliner_move(self, 1);
  else if (event->keyval == GDK_KEY_Delete) spore_activate(tree, "delete", NULL);
  else if (event->keyval == GDK_KEY_a && event->state & GDK_CONTROL_MASK) spore_activate(tree, "select-organs", NULL);
  else return GDK_EVENT_PROPAGATE;
  return GDK_EVENT_STOP;
}

/* The eyes and locks. */

static gboolean update_icons(GtkTreeModel *model, GtkTreePath *path, GtkTreeIter *iter, gpointer data) {
  SporeOutliner *self = data;
  guint id;
  gtk_tree_model_get(model, iter, COLUMN_ID, &id, -1);
  SporeObject *object = id ? spore_document_by_id(spore_editor_document_get(self->document), id) : NULL;
  if (object)
    gtk_tree_store_set(self->store, iter, COLUMN_EYE, eye_of(self, object), COLUMN_LOCK, lock_of(self, object), -1);
  return FALSE;
}

static void take_ids(SporeOutliner *self, GHashTable **of, GHashTable *ids) {
  g_hash_table_ref(ids);
  g_clear_pointer(of, g_hash_table_unref);
  *of = ids;
  if (self->document) gtk_tree_model_foreach(GTK_TREE_MODEL(self->store), update_icons, self);
  if (self->document) gtk_tree_model_foreach(GTK_TREE_MODEL(self->store), update_folder, self);
}

void spore_outliner_set_hidden(SporeOutliner *self, GHashTable *hidden) { take_ids(self, &self->hidden, hidden); }

void spore_outliner_set_locked(SporeOutliner *self, GHashTable *locked) { take_ids(self, &self->locked, locked); }

static gboolean tree_menu(GtkWidget *tree, SporeOutliner *self) {
  g_autoptr(GtkTreePath) path = NULL;
  gtk_tree_view_get_cursor(GTK_TREE_VIEW(tree), &path, NULL);
  if (path) spore_outliner_popup(self, NULL, path);
  return path != NULL;
}

/* The eye or lock of a folder: all of its bodies get what they are not all. */
static void toggle_folder(SporeOutliner *self, GtkTreePath *path, const char *action, GHashTable *ids) {
  GtkTreeModel *model = GTK_TREE_MODEL(self->filtered);
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GPtrArray) out = g_ptr_array_new(), in = g_ptr_array_new();
  GtkTreeIter iter, child;
  gboolean more = gtk_tree_model_get_iter(model, &iter, path) && gtk_tree_model_iter_children(model, &child, &iter);
  for (; more; more = gtk_tree_model_iter_next(model, &child)) {
    guint id;
    gtk_tree_model_get(model, &child, COLUMN_ID, &id, -1);
    SporeObject *body = spore_document_by_id(document, id);
    if (body) g_ptr_array_add(is_in(ids, body) ? in : out, body);
  }
  const GPtrArray *wrong = out->len ? out : in;
  for (guint i = 0; i < wrong->len; i++) {
    g_autofree char *of_body = spore_object_path(wrong->pdata[i]);
    spore_activate(self->tree, action, g_variant_new_string(of_body));
  }
}

/* A click on an eye hides the body or shows it, one on a lock locks it or frees it; neither selects. Two clicks on a
 * name rename. */
static gboolean tree_pressed(GtkWidget *tree, GdkEventButton *event, SporeOutliner *self) {
  g_autoptr(GtkTreePath) path = NULL;
  GtkTreeViewColumn *column;
  if (!gtk_tree_view_get_path_at_pos(GTK_TREE_VIEW(tree), (int)event->x, (int)event->y, &path, &column, NULL, NULL))
    return GDK_EVENT_PROPAGATE;
  if (event->type == GDK_2BUTTON_PRESS && event->button == GDK_BUTTON_PRIMARY && column == self->column) {
    spore_outliner_rename(self);
    return GDK_EVENT_STOP;
  }
  if (event->type != GDK_BUTTON_PRESS) return GDK_EVENT_PROPAGATE;
  if (event->button == GDK_BUTTON_SECONDARY) {
    gtk_widget_grab_focus(tree);
    spore_outliner_popup(self, (const GdkEvent *)event, path);
    return GDK_EVENT_STOP;
  }
  SporeObject *object = spore_outliner_object_at(self, path);
  const char *action = column == self->eye ? "hide-or-show" : column == self->lock ? "lock-or-unlock" : NULL;
  g_autofree char *folder = spore_outliner_folder_at(self, path);
  if (event->button == GDK_BUTTON_PRIMARY && action && folder) {
    toggle_folder(self, path, action, column == self->eye ? self->hidden : self->locked);
    return GDK_EVENT_STOP;
  }
  if (event->button != GDK_BUTTON_PRIMARY || !action || !object || !eye_of(self, object)) return GDK_EVENT_PROPAGATE;
  g_autofree char *of_body = spore_object_path(object);
  spore_activate(tree, action, g_variant_new_string(of_body));
  return GDK_EVENT_STOP;
}

/* What a row says when the mouse rests on it: what the row has no room for. More than that would lie over its
 * neighbours for nothing. */

static gboolean is_cut(SporeOutliner *self, GtkTreeModel *model, GtkTreeIter *iter) {
  int natural, width;
  gtk_tree_view_column_cell_set_cell_data(self->column, model, iter, FALSE, FALSE);
  gtk_cell_renderer_get_preferred_width(GTK_CELL_RENDERER(self->name), self->tree, NULL, &natural);
  return gtk_tree_view_column_cell_get_position(self->column, GTK_CELL_RENDERER(self->name), NULL, &width) &&
         natural > width;
}

static gboolean tree_tooltip(GtkWidget *tree, int x, int y, gboolean by_keyboard, GtkTooltip *tooltip,
                             SporeOutliner *self) {
  g_autoptr(GtkTreePath) path = NULL;
  g_autofree char *name = NULL, *problem = NULL;
  GtkTreeModel *model;
  GtkTreeIter iter;
  if (!gtk_tree_view_get_tooltip_context(GTK_TREE_VIEW(tree), &x, &y, by_keyboard, &model, &path, &iter)) return FALSE;
  gtk_tree_model_get(model, &iter, COLUMN_NAME, &name, COLUMN_PROBLEM, &problem, -1);
  if (!is_cut(self, model, &iter)) g_clear_pointer(&name, g_free);
  g_autofree char *text = g_strconcat(name ? name : "", name && problem ? "\n" : "", problem, NULL);
  gtk_tooltip_set_text(tooltip, text);
  gtk_tree_view_set_tooltip_row(GTK_TREE_VIEW(tree), tooltip, path);
  return *text != '\0';
}

/* Life. */

static void release_document(SporeOutliner *self) {
  g_clear_handle_id(&self->rebuild, g_source_remove);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_outliner_set_document(SporeOutliner *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_hash_table_remove_all(self->badges);
  g_hash_table_remove_all(self->problems);
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(show_selection), self, G_CONNECT_SWAPPED);
  rebuild(self);
}

static guint32 named_ancestor(SporeDocument *document, guint32 id) {
  SporeObject *object = id ? spore_document_by_id(document, id) : NULL;
  while (object && !spore_object_name(object)) object = spore_object_parent(object);
  return object ? spore_object_id(object) : 0;
}

void spore_outliner_set_problems(SporeOutliner *self, GPtrArray *diagnostics) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_hash_table_remove_all(self->badges);
  g_hash_table_remove_all(self->problems);
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(diagnostics, i);
    gpointer id = GUINT_TO_POINTER(named_ancestor(document, diagnostic->object));
    int badge = (int)diagnostic->severity + 1;
    if (!id || badge <= GPOINTER_TO_INT(g_hash_table_lookup(self->badges, id))) continue;
    g_hash_table_insert(self->badges, id, GINT_TO_POINTER(badge));
    g_hash_table_insert(self->problems, id, g_strdup(diagnostic->message));
  }
  queue_rebuild(self);
}

static void spore_outliner_dispose(GObject *object) {
  SporeOutliner *self = SPORE_OUTLINER(object);
  release_document(self);
  g_clear_pointer(&self->badges, g_hash_table_unref);
  g_clear_pointer(&self->problems, g_hash_table_unref);
  g_clear_pointer(&self->folded, g_hash_table_unref);
  g_clear_pointer(&self->hidden, g_hash_table_unref);
  g_clear_pointer(&self->locked, g_hash_table_unref);
  G_OBJECT_CLASS(spore_outliner_parent_class)->dispose(object);
}

static void spore_outliner_class_init(SporeOutlinerClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_outliner_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-outliner.ui");
  gtk_widget_class_bind_template_child(widget, SporeOutliner, filter);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, tree);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, store);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, filtered);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, selection);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, column);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, eye);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, lock);
  gtk_widget_class_bind_template_child(widget, SporeOutliner, name);
  gtk_widget_class_bind_template_callback(widget, filter_changed);
  gtk_widget_class_bind_template_callback(widget, row_selected);
  gtk_widget_class_bind_template_callback(widget, tree_tooltip);
  gtk_widget_class_bind_template_callback(widget, name_edited);
  gtk_widget_class_bind_template_callback(widget, tree_key);
  gtk_widget_class_bind_template_callback(widget, tree_pressed);
  gtk_widget_class_bind_template_callback(widget, tree_menu);
}

static void spore_outliner_init(SporeOutliner *self) {
  self->badges = g_hash_table_new(NULL, NULL);
  self->problems = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  self->folded = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
  gtk_widget_init_template(GTK_WIDGET(self));
  g_signal_connect(self->tree, "row-collapsed", G_CALLBACK(row_folded), self);
  g_signal_connect(self->tree, "row-expanded", G_CALLBACK(row_unfolded), self);
  gtk_tree_model_filter_set_visible_func(self->filtered, row_visible, self, NULL);
  spore_outliner_take_drags(self);
  g_signal_connect(self->tree, "drag-end", G_CALLBACK(drag_ends), self);
  g_signal_connect_swapped(self->name, "editing-canceled", G_CALLBACK(queue_rebuild), self);
  gtk_tree_selection_set_select_function(self->selection, may_select, self, NULL);
}
