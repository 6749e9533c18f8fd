#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"

#define FACE_NODES 3

/* An asset of these tetrahedra, and where it is wanted a body made of them: *made, where that is not NULL. */
static gboolean add(SporeDocument *document, const char *name, const SporeTetrahedralMesh *mesh, gboolean body_too,
                    SporeObject **made, GError **error) {
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
  if (made) *made = body;
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

static gboolean add_organ(SporeDocument *document, const SporeLabelBodies *organs, gsize i, SporeObject **made,
                          GError **error) {
  g_autofree char *name = spore_organ_name(organs->names[i]);
  SporeTetrahedralMesh part = extract(organs->mesh, organs->labels[i]);
  gboolean done = add(document, name, &part, TRUE, made, error);
  g_free(part.vertices);
  g_free(part.tetrahedra);
  return done;
}

/* Seams. */

/* The organs of each node, as bits: `words` of 64 a node. g_free. */
static guint64 *organs_of_nodes(const SporeLabelBodies *organs, gsize words) {
  const SporeTetrahedralMesh *mesh = organs->mesh;
  guint64 *bits = g_new0(guint64, words * mesh->vertex_count);
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) {
    gsize organ = 0;
    while (organ < organs->count && organs->labels[organ] != mesh->labels[i]) organ++;
    if (organ == organs->count) continue;
    for (int k = 0; k < 4; k++) bits[words * mesh->tetrahedra[4 * i + k] + organ / 64] |= (guint64)1 << (organ % 64);
  }
  return bits;
}

static gsize shared_nodes(const guint64 *bits, gsize words, gsize node_count, gsize a, gsize b) {
  gsize shared = 0;
  for (gsize i = 0; i < node_count; i++)
    shared += bits[words * i + a / 64] >> (a % 64) & bits[words * i + b / 64] >> (b % 64) & 1;
  return shared;
}

static gboolean add_seam(SporeDocument *document, const SporeObject *a, const SporeObject *b, GError **error) {
  g_autofree char *name = g_strdup_printf("%s_%s", spore_object_name(a), spore_object_name(b));
  SporeObject *seam =
      spore_document_insert(document, spore_document_section(document, "links"), "seam", name, G_MAXUINT, error);
  return seam && spore_document_set_text(document, seam, "body_a", spore_object_name(a), error) &&
         spore_document_set_text(document, seam, "body_b", spore_object_name(b), error);
}

static gboolean add_seams(SporeDocument *document, const SporeLabelBodies *organs, SporeObject *const *bodies,
                          GError **error) {
  gsize words = organs->count / 64 + 1, node_count = organs->mesh->vertex_count;
  g_autofree guint64 *bits = organs_of_nodes(organs, words);
  for (gsize a = 0; a < organs->count; a++)
    for (gsize b = a + 1; b < organs->count; b++)
      if (shared_nodes(bits, words, node_count, a, b) >= FACE_NODES && !add_seam(document, bodies[a], bodies[b], error))
        return FALSE;
  return TRUE;
}

static gboolean add_organs(SporeDocument *document, const SporeLabelBodies *organs, GError **error) {
  g_autofree SporeObject **bodies = g_new0(SporeObject *, organs->count);
  for (gsize i = 0; i < organs->count; i++)
    if (!add_organ(document, organs, i, &bodies[i], error)) return FALSE;
  return organs->use != SPORE_LABELS_LINKED || add_seams(document, organs, bodies, error);
}

gboolean spore_edit_use_labels(SporeDocument *document, const SporeLabelBodies *organs, GError **error) {
  g_autofree char *base = g_path_get_basename(organs->file);
  base[strcspn(base, ".")] = '\0';
  g_autofree char *name = spore_organ_name(base);
  gboolean apart = organs->use == SPORE_LABELS_LINKED || organs->use == SPORE_LABELS_BODIES;
  spore_document_begin(document, _("Generate tetrahedra"));
  gboolean done = apart ? add_organs(document, organs, error)
                        : add(document, name, organs->mesh, organs->use == SPORE_LABELS_ONE_BODY, NULL, error);
  return spore_edit_finish(document, done);
}
