/* The list of problems: what checks find in the scene, and what a run had to mend. */
#include "ui/panels/spore-problems.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/fix.h"
#include "ui/jobs/works.h"
#include "ui/jobs/spore-job.h"

/* After the last change, so that typing is not held up. */
#define CHECK_DELAY_MS 400

struct _SporeProblems {
  GtkBox parent;
  GtkListStore *store;
  GtkWidget *tree, *fix;
  SporeEditorDocument *document;
  guint timer;
  SporeJob *job;    /* checks; NULL: none does */
  GPtrArray *found; /* of SporeDiagnostic *: run_count of the run, then those of the scene */
  guint run_count;
};

G_DEFINE_FINAL_TYPE(SporeProblems, spore_problems, GTK_TYPE_BOX)

static guint checked;

static const char *icon_of(SporeSeverity severity) {
  static const char *const icons[] = {"dialog-information-symbolic", "dialog-warning-symbolic",
                                      "dialog-error-symbolic"};
  return icons[severity];
}

/* The whole text, for which the columns have no room. Tooltips of rows are markup. */
static char *hint_of(const SporeDiagnostic *diagnostic) {
  const char *remedy = diagnostic->remedy ? diagnostic->remedy : "";
  return g_markup_printf_escaped("%s%s%s", diagnostic->message, *remedy ? "\n" : "", remedy);
}

const SporeDiagnostic *spore_problems_selected(SporeProblems *self) {
  g_autoptr(GtkTreePath) path = NULL;
  gtk_tree_view_get_cursor(GTK_TREE_VIEW(self->tree), &path, NULL);
  guint row = path ? (guint)gtk_tree_path_get_indices(path)[0] : G_MAXUINT;
  return row < self->found->len ? self->found->pdata[row] : NULL;
}

const SporeDiagnostic *spore_problems_fixable(SporeProblems *self, const char *text) {
  for (guint i = 0; i < self->found->len; i++) {
    const SporeDiagnostic *diagnostic = self->found->pdata[i];
    if (diagnostic->fix != SPORE_FIX_NONE && strstr(text, diagnostic->message)) return diagnostic;
  }
  return NULL;
}

/* The button does what the selected problem offers. */
static void cursor_changed(SporeProblems *self) {
  const SporeDiagnostic *selected = spore_problems_selected(self);
  g_autofree char *label = selected ? spore_fix_label(selected) : NULL;
  gtk_widget_set_visible(self->fix, label != NULL);
  if (label) gtk_button_set_label(GTK_BUTTON(self->fix), label);
}

static void show(SporeProblems *self) {
  gtk_list_store_clear(self->store);
  for (guint i = 0; i < self->found->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(self->found, i);
    g_autofree char *hint = hint_of(diagnostic);
    gtk_list_store_insert_with_values(self->store, NULL, -1, 0, diagnostic->object, 1, icon_of(diagnostic->severity), 2,
                                      diagnostic->message, 3, diagnostic->remedy, 4, diagnostic->place, 5, hint, -1);
  }
  cursor_changed(self);
  g_signal_emit(self, checked, 0, self->found);
}

static gboolean check(gpointer data);

static void checked_through(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeProblems *self = owner;
  SporeCheckWork *work = data;
  if (self->job != job) return; /* of another scene */
  g_clear_object(&self->job);
  if (self->timer) return; /* the scene has changed since, and is checked again */
  if (spore_document_revision(spore_editor_document_get(self->document)) != work->revision) {
    check(self);
    return;
  }
  g_ptr_array_set_size(self->found, (gint)self->run_count);
  g_ptr_array_extend_and_steal(self->found, g_steal_pointer(&work->found));
  show(self);
}

/* One check at a time: changes during a check are checked when it is done. */
static gboolean check(gpointer data) {
  SporeProblems *self = data;
  self->timer = 0;
  if (!self->job)
    self->job = spore_job_start(_("Checking the scene"), spore_check_work_run,
                                spore_check_work_new(spore_editor_document_get(self->document)), spore_check_work_free,
                                checked_through, G_OBJECT(self));
  return G_SOURCE_REMOVE;
}

void spore_problems_add_run(SporeProblems *self, guint64 step, const char *text) {
  SporeDiagnostic *diagnostic = g_new0(SporeDiagnostic, 1);
  const char *colon = strstr(text, ": "), *remedy = strrchr(text, ';');
  g_autofree char *name = colon ? g_strndup(text, (gsize)(colon - text)) : g_strdup("");
  SporeObject *body = spore_document_find(spore_editor_document_get(self->document), "body", name);
  diagnostic->severity = SPORE_WARNING;
  diagnostic->object = body ? spore_object_id(body) : 0;
  diagnostic->message = remedy ? g_strndup(text, (gsize)(remedy - text)) : g_strdup(text);
  diagnostic->remedy = g_strdup(remedy ? remedy + 1 + strspn(remedy + 1, " ") : "");
  diagnostic->place = g_strdup_printf(_("step %llu"), (unsigned long long)step);
  g_ptr_array_insert(self->found, (gint)self->run_count++, diagnostic);
  show(self);
}

void spore_problems_clear_run(SporeProblems *self) {
  if (self->run_count == 0) return;
  g_ptr_array_remove_range(self->found, 0, self->run_count);
  self->run_count = 0;
  show(self);
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
  gtk_tree_view_set_cursor(tree, path, NULL, FALSE);
  spore_editor_document_select(self->document, id);
}

static void release_document(SporeProblems *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_problems_set_document(SporeProblems *self, SporeEditorDocument *document) {
  release_document(self);
  g_ptr_array_set_size(self->found, 0);
  self->run_count = 0;
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(queue_check), self, G_CONNECT_SWAPPED);
  queue_check(self);
}

static void spore_problems_dispose(GObject *object) {
  release_document(SPORE_PROBLEMS(object));
  G_OBJECT_CLASS(spore_problems_parent_class)->dispose(object);
}

static void spore_problems_finalize(GObject *object) {
  g_ptr_array_unref(SPORE_PROBLEMS(object)->found);
  G_OBJECT_CLASS(spore_problems_parent_class)->finalize(object);
}

static void spore_problems_class_init(SporeProblemsClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_problems_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_problems_finalize;
  checked = g_signal_new("checked", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 1,
                         G_TYPE_PTR_ARRAY);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-problems.ui");
  gtk_widget_class_bind_template_child(widget, SporeProblems, store);
  gtk_widget_class_bind_template_child(widget, SporeProblems, tree);
  gtk_widget_class_bind_template_child(widget, SporeProblems, fix);
  gtk_widget_class_bind_template_callback(widget, row_activated);
  gtk_widget_class_bind_template_callback(widget, cursor_changed);
}

static void free_diagnostic(gpointer data) { spore_diagnostic_free(data); }

static void spore_problems_init(SporeProblems *self) {
  self->found = g_ptr_array_new_with_free_func(free_diagnostic);
  gtk_widget_init_template(GTK_WIDGET(self));
}
