/* Makes bodies of the tetrahedra of a label map, joined by seams where organs share faces. */
#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/author/anatomy.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"

#define FACE_NODES 3

/* The label map's asset in the scene; a missing asset is made. NULL with an error. */
static SporeObject *keep_map(SporeDocument *document, const char *name, const SporeLabelBodies *organs,
                             GError **error) {
  gsize size;
  gconstpointer bytes = g_bytes_get_data(organs->content, &size);
  const char *extension = size >= 4 && memcmp(bytes, "NRRD", 4) == 0 ? "nrrd"
                          : g_str_has_suffix(organs->file, ".gz")    ? "nii.gz"
                                                                     : "nii";
  g_autofree char *file = spore_content_file_name(name, extension, bytes, size);
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; i < spore_object_child_count(assets); i++) {
    SporeObject *asset = spore_object_child(assets, i);
    if (!g_str_equal(spore_object_type(asset)->element, "label_map")) continue;
    g_autoptr(GBytes) there = spore_document_read_asset(document, spore_object_text(asset, "file"), NULL);
    if (there && g_bytes_equal(there, organs->content)) return asset;
  }
  g_autofree char *map_name = g_strdup_printf("%s_labels", name);
  SporeObject *asset = spore_document_insert(document, assets, "label_map", map_name, G_MAXUINT, error);
  spore_document_put_blob(document, file, organs->content);
  return asset && spore_document_set_text(document, asset, "file", file, error) ? asset : NULL;
}

/* The asset that was made earlier from that map under that name. */
static SporeObject *made_earlier(SporeDocument *document, const char *name, const SporeGeneratedFrom *from) {
  SporeObject *asset = from ? spore_document_find(document, "tetrahedra", name) : NULL;
  return asset && g_strcmp0(spore_object_text(asset, "source"), from->source) == 0 ? asset : NULL;
}

static SporeObject *body_made_of(SporeDocument *document, const SporeObject *asset) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (spore_edit_body_tetrahedra(document, body) == asset) return body;
  }
  return NULL;
}

static SporeObject *add_asset(SporeDocument *document, const char *name, const SporeTetrahedralMesh *mesh,
                              const SporeGeneratedFrom *from, GError **error) {
  gsize size;
  char *text = spore_medit_format(mesh, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *file = spore_content_file_name(name, "mesh", text, size);
  spore_document_put_blob(document, file, content);
  SporeObject *asset = made_earlier(document, name, from);
  if (!asset)
    asset = spore_document_insert(document, spore_document_section(document, "assets"), "tetrahedra", name, G_MAXUINT,
                                  error);
  if (!asset || !spore_document_set_text(document, asset, "file", file, error)) return NULL;
  return !from || spore_edit_remember_source(document, asset, from, error) ? asset : NULL;
}

/* Makes an asset of these tetrahedra and, where `made` is not NULL, a body in *made. from NULL: the source is not
 * stored. */
static gboolean add(SporeDocument *document, const char *name, const SporeTetrahedralMesh *mesh,
                    const SporeGeneratedFrom *from, gboolean body_too, SporeObject **made, GError **error) {
  SporeObject *asset = add_asset(document, name, mesh, from, error);
  if (!asset || !body_too) return asset != NULL;
  SporeObject *body = body_made_of(document, asset);
  if (made) *made = body;
  if (body) return TRUE;
  body = spore_document_insert(document, spore_document_section(document, "bodies"), "body", name, G_MAXUINT, error);
  SporeObject *mechanical = body ? spore_edit_child_or_new(document, body, "mechanical", error) : NULL;
  if (made) *made = body;
  return mechanical && spore_document_set_text(document, mechanical, "geometry", spore_object_name(asset), error) &&
         spore_edit_give_usual_model(document, body, SPORE_GEOMETRY_TETRAHEDRA, error);
}

/* The cells of one organ and their nodes. Arrays from g_new. */
static SporeTetrahedralMesh extract(const SporeTetrahedralMesh *mesh, guint32 label) {
  SporeTetrahedralMesh part = {0};
  g_autofree guint32 *place =
      g_new(guint32, mesh->vertex_count); /* new index of each node plus one; 0: the organ lacks the node */
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

static gboolean add_organ(SporeDocument *document, const SporeLabelBodies *organs, gsize i,
                          const SporeGeneratedFrom *from, SporeObject **made, GError **error) {
  g_autofree char *name = spore_organ_name(organs->names[i]);
  SporeTetrahedralMesh part = extract(organs->mesh, organs->labels[i]);
  const SporeObject *bodies = spore_document_section(document, "bodies");
  const guint before = spore_object_child_count(bodies);
  gboolean done = add(document, name, &part, from, TRUE, made, error);
  const gboolean is_new = done && spore_object_child_count(bodies) > before;
  if (is_new && organs->guessed && organs->guessed[i])
    done = spore_document_set_text(document, *made, "name_guessed", "true", error);
  if (done && is_new) done = spore_edit_use_anatomy(document, *made, organs->names[i], organs->labels[i], error);
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

static gboolean is_seam_of(const SporeObject *link, const SporeObject *a, const SporeObject *b) {
  return g_str_equal(spore_object_type(link)->element, "seam") && spore_object_reference(link, "body_a") == a &&
         spore_object_reference(link, "body_b") == b;
}

static gboolean add_seam(SporeDocument *document, const SporeObject *a, const SporeObject *b, GError **error) {
  const SporeObject *links = spore_document_section(document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++)
    if (is_seam_of(spore_object_child(links, i), a, b)) return TRUE;
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

static gboolean add_organs(SporeDocument *document, const SporeLabelBodies *organs, const SporeGeneratedFrom *from,
                           GError **error) {
  g_autofree SporeObject **bodies = g_new0(SporeObject *, organs->count);
  for (gsize i = 0; i < organs->count; i++)
    if (!add_organ(document, organs, i, from, &bodies[i], error)) return FALSE;
  return organs->use != SPORE_LABELS_LINKED || add_seams(document, organs, bodies, error);
}

static gboolean add_all(SporeDocument *document, const SporeLabelBodies *organs, const char *name,
                        const SporeGeneratedFrom *from, GError **error) {
  if (organs->use == SPORE_LABELS_LINKED || organs->use == SPORE_LABELS_BODIES)
    return add_organs(document, organs, from, error);
  return add(document, name, organs->mesh, from, organs->use == SPORE_LABELS_ONE_BODY, NULL, error);
}

static gboolean use_labels(SporeDocument *document, const SporeLabelBodies *organs, const char *name, GError **error) {
  if (!organs->content) return add_all(document, organs, name, NULL, error);
  SporeObject *map = keep_map(document, name, organs, error);
  if (!map) return FALSE;
  g_autofree char *hash = spore_document_asset_hash(document, map);
  const SporeGeneratedFrom from = {.source = spore_object_name(map), .source_hash = hash, .fields = organs->fields};
  return add_all(document, organs, name, &from, error);
}

gboolean spore_edit_use_labels(SporeDocument *document, const SporeLabelBodies *organs, GError **error) {
  g_autofree char *base = g_path_get_basename(organs->file);
  base[strcspn(base, ".")] = '\0';
  g_autofree char *name = spore_organ_name(base);
  spore_document_begin(document, _("Generate tetrahedra"));
  return spore_edit_finish(document, use_labels(document, organs, name, error));
}

SporeObject *spore_edit_body_label_map(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_body_tetrahedra(document, body);
  const char *source = asset ? spore_object_text(asset, "source") : NULL;
  if (!source || spore_edit_visual_mesh(document, body, NULL)) return NULL;
  return spore_document_find(document, "label_map", source);
}
