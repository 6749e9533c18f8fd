#include "ui/panels/spore-problems.h"

/* After the last change, so that typing is not held up. */
#define CHECK_DELAY_MS 400

struct _SporeProblems {
  GtkScrolledWindow parent;
  GtkListStore *store;
  GtkWidget *tree;
  SporeEditorDocument *document;
  guint timer;
};

G_DEFINE_FINAL_TYPE(SporeProblems, spore_problems, GTK_TYPE_SCROLLED_WINDOW)

static guint checked;

static const char *icon_of(SporeSeverity severity) {
  static const char *const icons[] = {"dialog-information-symbolic", "dialog-warning-symbolic",
                                      "dialog-error-symbolic"};
  return icons[severity];
}

static gboolean check(gpointer data) {
  SporeProblems *self = data;
  self->timer = 0;
  g_autoptr(GPtrArray) diagnostics = spore_document_check(spore_editor_document_get(self->document));
  gtk_list_store_clear(self->store);
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(diagnostics, i);
    gtk_list_store_insert_with_values(self->store, NULL, -1, 0, diagnostic->object, 1, icon_of(diagnostic->severity), 2,
                                      diagnostic->message, 3, diagnostic->remedy, 4, diagnostic->place, -1);
  }
  g_signal_emit(self, checked, 0, diagnostics);
  return G_SOURCE_REMOVE;
}

static void queue_check(SporeProblems *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  self->timer = g_timeout_add(CHECK_DELAY_MS, check, self);
}

static void row_activated(GtkTreeView *tree, GtkTreePath *path, GtkTreeViewColumn *column, SporeProblems *self) {
  GtkTreeIter iter;
  guint id;
  if (!gtk_tree_model_get_iter(GTK_TREE_MODEL(self->store), &iter, path)) return;
  gtk_tree_model_get(GTK_TREE_MODEL(self->store), &iter, 0, &id, -1);
  spore_editor_document_select(self->document, id);
}

static void release_document(SporeProblems *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_problems_set_document(SporeProblems *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(queue_check), self, G_CONNECT_SWAPPED);
  queue_check(self);
}

static void spore_problems_dispose(GObject *object) {
  release_document(SPORE_PROBLEMS(object));
  G_OBJECT_CLASS(spore_problems_parent_class)->dispose(object);
}

static void spore_problems_class_init(SporeProblemsClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_problems_dispose;
  checked = g_signal_new("checked", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 1,
                         G_TYPE_PTR_ARRAY);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-problems.ui");
  gtk_widget_class_bind_template_child(widget, SporeProblems, store);
  gtk_widget_class_bind_template_child(widget, SporeProblems, tree);
  gtk_widget_class_bind_template_callback(widget, row_activated);
}

static void spore_problems_init(SporeProblems *self) { gtk_widget_init_template(GTK_WIDGET(self)); }
