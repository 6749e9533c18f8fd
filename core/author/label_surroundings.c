/* Surfaces of labels as bodies that do not move. */
#include "core/author/label_surroundings.h"

#include <glib/gi18n.h>

#include "core/author/anatomy.h"
#include "core/author/edits.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"

static void clear(gpointer data) {
  SporeLabelSurrounding *one = data;
  spore_triangle_mesh_clear(&one->surface.mesh);
  g_free(one->name);
}

GArray *spore_label_surroundings_new(void) {
  GArray *surroundings = g_array_new(FALSE, TRUE, sizeof(SporeLabelSurrounding));
  g_array_set_clear_func(surroundings, clear);
  return surroundings;
}

gboolean spore_label_surroundings_make(GArray *surroundings, const SporeLabelMap *map, const SporeProgress *progress,
                                       GError **error) {
  g_autofree SporeLabelSurface *surfaces = g_new0(SporeLabelSurface, surroundings->len);
  SporeLabelSurrounding *all = (SporeLabelSurrounding *)(void *)surroundings->data;
  SporeError failure = SPORE_ERROR_INIT;
  for (guint i = 0; i < surroundings->len; i++) surfaces[i].label = all[i].surface.label;
  if (!spore_label_surfaces(map, surfaces, surroundings->len, progress, &failure))
    return spore_error_propagate(&failure, error);
  for (guint i = 0; i < surroundings->len; i++) all[i].surface = surfaces[i];
  return TRUE;
}

static gboolean add(SporeDocument *document, SporeLabelSurrounding *one, GError **error) {
  if (!spore_mesh_tidy(one->name, &one->surface.mesh, error)) return FALSE;
  gsize size;
  char *text = spore_off_format(&one->surface.mesh, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *name = spore_organ_name(one->name), *file = spore_content_file_name(name, "off", text, size);
  SporeObject *body = spore_organ_insert(document, name, file, content, 0, 0, error); /* metres, SPORE's axes */
  return body && spore_edit_use_anatomy(document, body, one->name, one->surface.label, error) &&
         (!one->guessed || spore_document_set_text(document, body, "name_guessed", "true", error));
}

gboolean spore_edit_add_surroundings(SporeDocument *document, SporeLabelSurrounding *surroundings, gsize count,
                                     const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  gboolean done = TRUE;
  spore_document_begin(document, _("Add surroundings"));
  for (gsize i = 0; i < count && done; i++)
    done = (spore_progress_step(progress, (double)i / (double)count, _("adding the surroundings"), &failure) ||
            spore_error_propagate(&failure, error)) &&
           add(document, &surroundings[i], error);
  return spore_edit_finish(document, done);
}
