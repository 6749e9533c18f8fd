/* Inserts an imported mesh into a document, as an asset and a body that shows the asset. */
#include "core/io/organ.h"

#include <string.h>

#include "core/base/hash.h"
#include "core/io/mesh_import.h"

char *spore_organ_name(const char *text) {
  g_autofree char *plain = g_utf8_validate(text, -1, NULL) ? g_str_to_ascii(text, "C") : g_strdup(text);
  GString *name = g_string_new(NULL);
  gboolean says = FALSE; /* whether there is any letter or digit */
  for (const char *c = plain; *c; c++) {
    says = says || g_ascii_isalnum(*c);
    g_string_append_c(name, g_ascii_isalnum(*c) || *c == '_' || *c == '-' || *c == '.' ? *c : '_');
  }
  if (!says) g_string_assign(name, "organ");
  if (name->len == 0 || !(g_ascii_isalpha(name->str[0]) || name->str[0] == '_')) g_string_prepend(name, "organ_");
  return g_string_free(name, FALSE);
}

static char *stem_of(const char *file) {
  g_autofree char *base = g_path_get_basename(file);
  char *dot = strrchr(base, '.');
  if (dot && dot != base) *dot = '\0';
  return spore_organ_name(base);
}

char *spore_content_file_name(const char *name, const char *extension, gconstpointer content, gsize size) {
  guint64 hash = spore_hash(SPORE_HASH_INIT, content, size);
  return g_strdup_printf("%s-%08x.%s", name, (guint)(hash ^ hash >> 32), extension);
}

static gboolean file_taken(SporeDocument *document, const char *file, GBytes *content) {
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; i < spore_object_child_count(assets); i++) {
    SporeObject *asset = spore_object_child(assets, i);
    if (g_strcmp0(spore_object_text(asset, "file"), file) != 0) continue;
    g_autoptr(GBytes) held = spore_document_read_asset(document, file, NULL);
    if (!held || !g_bytes_equal(held, content)) return TRUE;
  }
  const char *scene = spore_document_file(document);
  if (!scene) return FALSE;
  g_autofree char *folder = g_path_get_dirname(scene);
  g_autofree char *path = g_build_filename(folder, file, NULL);
  if (!g_file_test(path, G_FILE_TEST_EXISTS)) return FALSE;
  g_autoptr(GBytes) held = spore_document_read_asset(document, file, NULL);
  return !held || !g_bytes_equal(held, content);
}

/* The file's own name where no other asset has it, else the name with a hash of the content. */
static char *asset_file(SporeDocument *document, const char *file, GBytes *content) {
  g_autofree char *base = g_path_get_basename(file);
  g_autofree char *stem = stem_of(file);
  const char *dot = strrchr(base, '.');
  const char *extension = dot && dot[1] ? dot + 1 : "mesh";
  char *plain = g_strdup_printf("%s.%s", stem, extension);
  if (!file_taken(document, plain, content)) return plain;
  g_free(plain);
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  return spore_content_file_name(stem, extension, bytes, size);
}

SporeObject *spore_organ_insert(SporeDocument *document, const char *name, const char *file, GBytes *content, int unit,
                                int frame, GError **error) {
  g_autofree char *stem = name ? spore_organ_name(name) : stem_of(file);
  g_autofree char *kept = asset_file(document, file, content);
  SporeObject *assets = spore_document_section(document, "assets"),
              *bodies = spore_document_section(document, "bodies");
  spore_document_put_blob(document, kept, content);
  SporeObject *mesh = spore_document_insert(document, assets, "mesh", stem, G_MAXUINT, error);
  if (!mesh || !spore_document_set_text(document, mesh, "file", kept, error) ||
      !spore_document_set_text(document, mesh, "unit", spore_length_units[unit], error) ||
      !spore_document_set_text(document, mesh, "frame", spore_mesh_frames[frame], error))
    return NULL;
  SporeObject *body = spore_document_insert(document, bodies, "body", stem, G_MAXUINT, error);
  if (!body) return NULL;
  SporeObject *visual = spore_document_insert(document, body, "visual", NULL, G_MAXUINT, error);
  gboolean done = visual && spore_document_set_text(document, visual, "mesh", spore_object_name(mesh), error) &&
                  spore_document_set_text(document, body, "role", "unmovable", error);
  return done ? body : NULL;
}
