/* What an export tells: files that it wrote, and sentences of what is lost and left out. */
#include <glib/gi18n.h>

#include "core/io/scene_xml.h"
#include "core/scene/kept_pose.h"
#include "ui/export/private.h"

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

guint spore_export_unsaid(const SporeExport *export, gsize *bytes) {
  guint count = export->written->len > FILES_SAID ? export->written->len - 1 : 0;
  *bytes = 0;
  for (guint i = 0; i < count; i++) *bytes += g_array_index(export->written, SporeExported, i).bytes;
  return count;
}

void spore_export_lose(SporeExport *export, char *sentence) { g_ptr_array_add(export->lost, sentence); }

void spore_export_lose_poses(SporeExport *export) {
  guint kept = spore_document_kept_poses(export->document);
  if (kept) spore_export_lose(export, g_strdup_printf(_("the kept poses of %u bodies: they begin as modelled"), kept));
}

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
  g_clear_pointer(&export->motions, g_array_unref);
}
