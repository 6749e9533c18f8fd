/* spore export --format bundle: the scene with what its runs need, in one zip. */
#include <glib/gi18n.h>

#include "core/io/bundle.h"
#include "core/io/scene_xml.h"
#include "core/scene/pruned.h"
#include "ui/export/private.h"

static gsize text_size(const SporeDocument *document) {
  gsize size = 0;
  g_free(spore_scene_format(document, &size));
  return size;
}

static gboolean write_pruned(SporeExport *export, SporeDocument *pruned, GError **error) {
  g_autoptr(GByteArray) content = spore_bundle_format(pruned, export->output, export->progress, error);
  if (!content || !spore_export_write(export, content->data, content->len, error)) return FALSE;
  gsize before = text_size(export->document), after = text_size(pruned);
  if (before > after)
    spore_export_leave_out(export, g_strdup_printf(_("comments, settings of generators, figures of studies and what "
                                                     "named the rest: %zu bytes of the scene's text"),
                                                   before - after));
  return TRUE;
}

gboolean spore_export_bundle(SporeExport *export, GError **error) {
  if (export->input)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--input", "%s",
                             _("a bundle holds the tracks of its scene alone; expected no other input; give it to "
                               "spore run"));
  if (!spore_bundle_is_name(export->output))
    return spore_error_raise(error, SPORE_ERROR_INPUT, export->output, "%s",
                             _("this is no name of a bundle; expected one that ends in .sporez; correct it"));
  SporeDocument *pruned = spore_document_pruned(export->document, export->left_out, error);
  gboolean done = pruned && write_pruned(export, pruned, error);
  g_clear_pointer(&pruned, spore_document_free);
  return done;
}
