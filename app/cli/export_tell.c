/* What an export tells: files that it wrote, and sentences of what is lost and left out. */
#include <glib/gi18n.h>

#include "app/cli/export.h"
#include "core/io/scene_xml.h"

#define FILES_SAID 4 /* one by one */

gboolean spore_export_write(SporeExport *export, const void *content, gsize size, GError **error) {
  if (!spore_write_file(export->output, content, size, error)) return FALSE;
  spore_export_wrote(export, export->output, size);
  return TRUE;
}

void spore_export_wrote(SporeExport *export, const char *file, gsize bytes) {
  const SporeExported exported = {g_strdup(file), bytes};
  g_array_append_val(export->written, exported);
}

void spore_export_lose(SporeExport *export, char *sentence) { g_ptr_array_add(export->lost, sentence); }

void spore_export_leave_out(SporeExport *export, char *sentence) { g_ptr_array_add(export->left_out, sentence); }

static void clear_exported(gpointer data) { g_free(((SporeExported *)data)->file); }

void spore_export_init(SporeExport *export) {
  export->written = g_array_new(FALSE, FALSE, sizeof(SporeExported));
  g_array_set_clear_func(export->written, clear_exported);
  export->lost = g_ptr_array_new_with_free_func(g_free);
  export->left_out = g_ptr_array_new_with_free_func(g_free);
}

void spore_export_clear(SporeExport *export) {
  g_array_unref(export->written);
  g_ptr_array_unref(export->lost);
  g_ptr_array_unref(export->left_out);
  g_clear_pointer(&export->document, spore_document_free);
}

/* A series is many files: people are told of the last one, which names the others. */
static void say_written(const SporeExport *export) {
  const SporeExported *all = (const SporeExported *)(gconstpointer) export->written->data;
  guint count = export->written->len;
  gsize bytes = 0;
  for (guint i = 0; i < count; i++) bytes += all[i].bytes;
  if (count > FILES_SAID) {
    spore_cli_say(export->cli, _("%s: with %u other files, %zu bytes\n"), all[count - 1].file, count - 1, bytes);
    return;
  }
  for (guint i = 0; i < count; i++) spore_cli_say(export->cli, _("%s: %zu bytes\n"), all[i].file, all[i].bytes);
}

static void report_written(const SporeExport *export) {
  SporeCli *cli = export->cli;
  spore_cli_open_array(cli, "written");
  for (guint i = 0; i < export->written->len; i++) {
    const SporeExported *exported = &g_array_index(export->written, SporeExported, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "file", exported->file);
    spore_cli_count(cli, "bytes", (gint64)exported->bytes);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  say_written(export);
}

/* label: translated, before each sentence. */
static void report_sentences(SporeCli *cli, const char *member, const GPtrArray *sentences, const char *label) {
  spore_cli_open_array(cli, member);
  for (guint i = 0; i < sentences->len; i++) {
    spore_cli_text(cli, NULL, sentences->pdata[i]);
    spore_cli_say(cli, "%s %s\n", label, (const char *)sentences->pdata[i]);
  }
  spore_cli_close_array(cli);
}

void spore_export_report(const SporeExport *export) {
  report_written(export);
  report_sentences(export->cli, "lost", export->lost, _("lost:"));
  report_sentences(export->cli, "left_out", export->left_out, _("left out:"));
}
