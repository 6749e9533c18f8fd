/* Puts recordings into scenes. */
#include "core/author/track_edits.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/io/organ.h"

#define NAME "recording"

/* Leads the tool by the track, if its body was recorded. */
static gboolean lead(SporeDocument *document, SporeObject *tool, const SporeTrack *recording, const SporeObject *track,
                     GError **error) {
  const SporeParameterTable *table = spore_object_type(tool)->table;
  if (spore_parameter_find(table, "device") < 0 || spore_parameter_find(table, "body") < 0) return TRUE;
  const char *body = spore_object_text(tool, "body");
  if (!body || !spore_object_text(tool, "device") || !spore_track_channel(recording, body)) return TRUE;
  return spore_document_set_text(document, tool, "device", spore_object_name(track), error);
}

static gboolean lead_all(SporeDocument *document, const SporeTrack *recording, const SporeObject *track,
                         GError **error) {
  const SporeObject *tools = spore_document_section(document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (!lead(document, spore_object_child(tools, i), recording, track, error)) return FALSE;
  return TRUE;
}

static gboolean has_rows(const SporeTrack *recording) {
  for (size_t i = 0; i < recording->channel_count; i++)
    if (recording->channels[i].count > 0) return TRUE;
  return FALSE;
}

SporeObject *spore_edit_keep_track(SporeDocument *document, const SporeTrack *recording, GError **error) {
  size_t size;
  char *text = has_rows(recording) ? spore_track_format(recording, &size) : NULL;
  if (!text) {
    spore_error_raise(error, SPORE_ERROR_INPUT, NAME, "%s",
                      _("nothing was recorded; play, and lead an instrument first"));
    return NULL;
  }
  g_autoptr(GBytes) content = g_bytes_new(text, size);
  g_autofree char *file = spore_content_file_name(NAME, "track", text, size);
  spore_free(text);
  spore_document_begin(document, _("Keep recorded input"));
  spore_document_put_blob(document, file, content);
  SporeObject *track =
      spore_document_insert(document, spore_document_section(document, "devices"), "track", NAME, G_MAXUINT, error);
  gboolean done = track && spore_document_set_text(document, track, "file", file, error) &&
                  lead_all(document, recording, track, error);
  return spore_edit_finish(document, done) ? track : NULL;
}
