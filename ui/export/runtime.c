/* spore export --format runtime: the compiled scene in one file. */
#include <glib/gi18n.h>

#include "core/base/memory.h"
#include "core/scene/compile_runtime.h"
#include "core/scene/needs.h"
#include "ui/export/private.h"

static void leave_textures(SporeExport *export) {
  g_autoptr(GArray) needs = spore_document_texture_needs(export->document);
  for (guint i = 0; i < needs->len; i++) {
    const SporeTextureNeed *need = &g_array_index(needs, SporeTextureNeed, i);
    spore_export_leave_out(
        export, g_strdup_printf(_("%s: %zu bytes; a texture, and the file draws none"), need->file, need->bytes));
  }
}

gpointer spore_export_format_runtime(SporeExport *export, gsize *size, GError **error) {
  g_autoptr(GPtrArray) undrawn = g_ptr_array_new_with_free_func(g_free);
  gpointer content =
      spore_document_format_runtime(export->document, export->input, export->cancel, undrawn, size, error);
  for (guint i = 0; i < undrawn->len; i++)
    spore_export_lose(export, g_strdup_printf(_("%s: it has no visual mesh, and what SPORE draws in place of one "
                                                "is not in the file"),
                                              (const char *)undrawn->pdata[i]));
  spore_export_leave_out(
      export, g_strdup(_("comments, metadata, settings of generators, colours and names of tissues, unused assets")));
  leave_textures(export);
  return content;
}

gboolean spore_export_runtime(SporeExport *export, GError **error) {
  gsize bytes = 0;
  gpointer content = spore_export_format_runtime(export, &bytes, error);
  gboolean done = content && spore_export_write(export, content, bytes, error);
  spore_free(content);
  return done;
}
