#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"

/* An asset of these tetrahedra, and where it is wanted a body made of them. */
static gboolean add(SporeDocument *document, const char *name, const SporeTetrahedralMesh *mesh, gboolean body_too,
                    GError **error) {
  gsize size;
  char *text = spore_medit_format(mesh, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *file = spore_content_file_name(name, "mesh", text, size);
  g_autofree char *cells = g_strdup_printf("%zu", mesh->tetrahedron_count);
  spore_document_put_blob(document, file, content);
  SporeObject *asset =
      spore_document_insert(document, spore_document_section(document, "assets"), "tetrahedra", name, G_MAXUINT, error);
  if (!asset || !spore_document_set_text(document, asset, "file", file, error) ||
      !spore_document_set_text(document, asset, "cells", cells, error) || !body_too)
    return asset && !body_too;
  SporeObject *body =
      spore_document_insert(document, spore_document_section(document, "bodies"), "body", name, G_MAXUINT, error);
  SporeObject *mechanical = body ? spore_edit_child_or_new(document, body, "mechanical", error) : NULL;
  return mechanical && spore_document_set_text(document, mechanical, "geometry", spore_object_name(asset), error) &&
         spore_edit_give_usual_model(document, body, SPORE_GEOMETRY_TETRAHEDRA, error);
}

/* The cells of one organ, with the nodes that they have. Arrays of g_new. */
static SporeTetrahedralMesh extract(const SporeTetrahedralMesh *mesh, guint32 label) {
  SporeTetrahedralMesh part = {0};
  g_autofree guint32 *place = g_new(guint32, mesh->vertex_count); /* of each node, 0 none, else one more */
  memset(place, 0, mesh->vertex_count * sizeof *place);
  part.vertices = g_new(double, 3 * mesh->vertex_count);
  part.tetrahedra = g_new(guint32, 4 * mesh->tetrahedron_count);
  for (gsize i = 0; i < 4 * mesh->tetrahedron_count; i++) {
    guint32 node = mesh->tetrahedra[i];
    if (mesh->labels[i / 4] != label) continue;
    if (!place[node]) {
      memcpy(part.vertices + 3 * part.vertex_count++, mesh->vertices + 3 * (gsize)node, 3 * sizeof(double));
      place[node] = (guint32)part.vertex_count;
    }
    part.tetrahedra[4 * part.tetrahedron_count + i % 4] = place[node] - 1;
    part.tetrahedron_count += i % 4 == 3;
  }
  return part;
}

static gboolean add_organ(SporeDocument *document, const SporeLabelBodies *organs, gsize i, GError **error) {
  g_autofree char *name = spore_organ_name(organs->names[i]);
  SporeTetrahedralMesh part = extract(organs->mesh, organs->labels[i]);
  gboolean done = add(document, name, &part, TRUE, error);
  g_free(part.vertices);
  g_free(part.tetrahedra);
  return done;
}

gboolean spore_edit_use_labels(SporeDocument *document, const SporeLabelBodies *organs, GError **error) {
  g_autofree char *base = g_path_get_basename(organs->file);
  base[strcspn(base, ".")] = '\0';
  g_autofree char *name = spore_organ_name(base);
  gboolean done = TRUE;
  spore_document_begin(document, _("Generate tetrahedra"));
  if (organs->use != SPORE_LABELS_BODIES)
    done = add(document, name, organs->mesh, organs->use == SPORE_LABELS_ONE_BODY, error);
  else
    for (gsize i = 0; done && i < organs->count; i++) done = add_organ(document, organs, i, error);
  return spore_edit_finish(document, done);
}
