/* Files that the scene names and that are not there: the offer to locate them, and doing so. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/author/locate.h"
#include "core/scene/check.h"
#include "ui/spore-window-private.h"

static char *list_of(const GPtrArray *files) {
  g_autoptr(GString) text = g_string_new(NULL);
  for (guint i = 0; i < files->len; i++) g_string_append_printf(text, i ? ", %s" : "%s", (char *)files->pdata[i]);
  return g_strdup(text->str);
}

/* Of all diagnostics, only whether one of them is about a missing file. */
static gboolean any_missing(const GPtrArray *diagnostics) {
  for (guint i = 0; i < diagnostics->len; i++)
    if (((const SporeDiagnostic *)diagnostics->pdata[i])->fix == SPORE_FIX_LOCATE) return TRUE;
  return FALSE;
}

void spore_window_offer_to_locate(SporeWindow *self, const GPtrArray *diagnostics) {
  guint before = self->missing;
  g_autoptr(GPtrArray) files =
      any_missing(diagnostics) ? spore_missing_files(spore_editor_document_get(self->document)) : g_ptr_array_new();
  g_autofree char *list = list_of(files);
  g_autofree char *text = g_strdup_printf(ngettext("%u file of the scene is not in its folder: %s",
                                                   "%u files of the scene are not in its folder: %s", files->len),
                                          files->len, list);
  self->missing = files->len;
  gtk_label_set_text(GTK_LABEL(self->missing_text), text);
  if (files->len == 0) gtk_widget_hide(self->missing_bar);
  else if (files->len != before) gtk_widget_show(self->missing_bar);
  if ((before == 0) != (files->len == 0)) spore_window_update_actions(self);
}

/* Locating. */

static void tell_located(SporeWindow *self, const GPtrArray *found) {
  g_autoptr(GPtrArray) taken = g_ptr_array_new();
  for (guint i = 0; i < found->len; i++) {
    const SporeLocatedFile *file = found->pdata[i];
    if (file->refused) spore_window_log(self, _("%s was not located: %s"), file->missing, file->refused);
    else spore_window_log(self, _("%s was located: %s"), file->missing, file->place);
    if (!file->refused) g_ptr_array_add(taken, file->missing);
  }
  g_autofree char *list = list_of(taken);
  g_autofree char *text = g_strdup_printf(
      ngettext("%u file was found there: %s", "%u files were found there: %s", taken->len), taken->len, list);
  spore_window_complain_while(self, SPORE_CAUSE_EDIT, text, _("Undo"), "win.undo");
}

static void located(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  SporeLocateWork *work = data;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  if (spore_locate_work_apply(work, spore_editor_document_get(self->document), &failure))
    tell_located(self, spore_locate_work_found(work));
  else spore_window_failed(self, failure);
}

static void locate(SporeWindow *self, const char *missing, const char *file) {
  spore_window_start_job(self, _("Locating files"), spore_locate_work_run,
                         spore_locate_work_new(spore_editor_document_get(self->document), missing, file),
                         spore_locate_work_free, located);
}

/* A missing file that the object, or what belongs to it, names; NULL: none. Borrowed from `missing`. */
static const char *missing_of(const SporeObject *object, const GPtrArray *missing) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  guint index;
  for (guint i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_FILE && spore_object_is_set(object, i) &&
        g_ptr_array_find_with_equal_func((GPtrArray *)missing, spore_object_value(object, i)->text, g_str_equal,
                                         &index))
      return missing->pdata[index];
  for (guint i = 0; i < spore_object_child_count(object); i++) {
    const char *below = missing_of(spore_object_child(object, i), missing);
    if (below) return below;
  }
  return NULL;
}

void spore_window_ask_to_locate(SporeWindow *self) {
  g_autoptr(GPtrArray) missing = spore_missing_files(spore_editor_document_get(self->document));
  const SporeObject *selected = spore_editor_document_selected(self->document);
  const char *wanted = selected ? missing_of(selected, missing) : NULL;
  if (missing->len == 0) return;
  if (!wanted) wanted = missing->pdata[0];
  const char *dot = strrchr(wanted, '.');
  g_autofree char *title = g_strdup_printf(_("Where is “%s”?"), wanted);
  g_autofree char *upper = dot ? g_ascii_strup(dot, -1) : NULL;
  g_autofree char *patterns = dot ? g_strdup_printf("*%s *%s", dot, upper) : g_strdup("*");
  g_autofree char *file = spore_window_choose_to_open(self, title, patterns, _("Files of its kind"));
  if (file) locate(self, wanted, file);
}

static void act_locate(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *missing, *file;
  g_variant_get(parameter, "(&s&s)", &missing, &file);
  locate(data, missing, file);
}

static void act_locate_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_ask_to_locate(data);
}

void spore_window_add_locate_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"locate", act_locate, "(ss)"},
      {"locate-dialog", act_locate_dialog},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
