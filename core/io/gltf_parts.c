/* Parts of a glTF that most programs write to files of their own. Buffers are put into the text itself; pictures are
 * kept apart. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/beside.h"
#include "core/io/json_scan.h"
#include "core/io/mesh_beside.h"
#include "core/io/mesh_import.h"

#define MOST_BYTES ((gsize)1 << 30) /* of all buffers together */

typedef struct Embedding {
  const char *file;
  GError **error;
  SporeJson json;
  const char *copied; /* up to here the text is in `text` */
  GString *text;      /* NULL: nothing had to be changed yet */
  gsize bytes;        /* of buffers so far */
} Embedding;

static gboolean is(SporeJsonText text, const char *name) {
  return text.length == strlen(name) && memcmp(text.text, name, text.length) == 0;
}

/* The file that a URI names. "./" before the name is passed over. g_free; NULL: it is no name of a file. */
static char *file_of(SporeJsonText uri) {
  if (memchr(uri.text, '\\', uri.length)) return NULL;
  g_autofree char *coded = g_strndup(uri.text, uri.length);
  return g_uri_unescape_string(g_str_has_prefix(coded, "./") ? coded + 2 : coded, NULL);
}

static gboolean fail_buffer(Embedding *embedding, const char *name, gsize size, guint64 wanted) {
  return spore_error_raise(embedding->error, SPORE_ERROR_INPUT, embedding->file,
                           _("its buffer \"%s\" has %zu bytes, and %llu were said; expected the whole file; copy or "
                             "export both files again"),
                           name, size, (unsigned long long)wanted);
}

/* Writes the bytes of the buffer's file in the place of its URI. Bytes behind the length that is said are padding. */
static gboolean embed(Embedding *embedding, SporeJsonText uri, guint64 length) {
  g_autofree char *name = file_of(uri);
  g_autoptr(GBytes) content =
      spore_beside_read(embedding->file, name ? name : "", NULL, 0, MOST_BYTES - embedding->bytes, embedding->error);
  if (!content) return FALSE;
  gsize size;
  const guchar *bytes = g_bytes_get_data(content, &size);
  if (length > size) return fail_buffer(embedding, name, size, length);
  g_autofree char *coded = g_base64_encode(bytes, (gsize)length);
  embedding->bytes += size;
  if (!embedding->text) embedding->text = g_string_new(NULL);
  g_string_append_len(embedding->text, embedding->copied, uri.text - embedding->copied);
  g_string_append(embedding->text, "data:application/octet-stream;base64,");
  g_string_append(embedding->text, coded);
  embedding->copied = uri.text + uri.length;
  return TRUE;
}

/* Lengths that are no whole number are left to the check of the whole text. */
static guint64 read_length(SporeJson *json) {
  SporeJsonText scalar = {"", 0};
  guint64 value = 0;
  while (json->at < json->end && g_ascii_isspace(*json->at)) json->at++;
  if (!spore_json_scalar(json, &scalar)) return 0;
  for (gsize i = 0; i < scalar.length && g_ascii_isdigit(scalar.text[i]) && i < 18; i++)
    value = 10 * value + (guint64)(scalar.text[i] - '0');
  return value;
}

/* Reads an object with a URI. FALSE: it names no other file. */
static gboolean read_uri(SporeJson *json, SporeJsonText *uri, guint64 *length) {
  SporeJsonText key;
  gsize count = 0;
  *uri = (SporeJsonText){NULL, 0}, *length = 0;
  if (!spore_json_take(json, '{')) spore_json_fail(json);
  while (spore_json_next_member(json, &count, &key))
    if (is(key, "uri") && !uri->text) spore_json_string(json, uri);
    else if (is(key, "byteLength")) *length = read_length(json);
    else spore_json_skip(json, 2);
  return !json->bad && uri->text && !(uri->length >= 5 && memcmp(uri->text, "data:", 5) == 0);
}

/* Goes to the first item of the text's list of that name. FALSE: there is no such list any more. */
static gboolean find_list(SporeJson *json, gsize *members, const char *name) {
  SporeJsonText key;
  while (spore_json_next_member(json, members, &key)) {
    if (is(key, name) && spore_json_take(json, '[')) return TRUE;
    spore_json_skip(json, 0);
  }
  return FALSE;
}

static gboolean read_text(Embedding *embedding) {
  SporeJson *json = &embedding->json;
  SporeJsonText uri;
  gsize members = 0;
  guint64 length;
  if (!spore_json_take(json, '{')) return TRUE;
  while (find_list(json, &members, "buffers"))
    for (gsize buffers = 0; spore_json_next_item(json, ']', &buffers);)
      if (read_uri(json, &uri, &length) && !embed(embedding, uri, length)) return FALSE;
  return TRUE;
}

void spore_mesh_beside_images(SporeMeshBeside *beside, const char *file, const char *text, gsize size) {
  SporeJson json = {text, text + size, FALSE};
  SporeJsonText uri;
  gsize members = 0;
  guint64 unused;
  if (!spore_json_take(&json, '{')) return;
  while (find_list(&json, &members, "images"))
    for (gsize images = 0; spore_json_next_item(&json, ']', &images);)
      if (read_uri(&json, &uri, &unused)) {
        g_autofree char *name = g_strndup(uri.text, uri.length), *path = file_of(uri);
        spore_mesh_beside_picture(beside, file, name, path ? path : name);
      }
}

GBytes *spore_mesh_whole(const char *file, GBytes *content, GError **error) {
  gsize size;
  const char *bytes = g_bytes_get_data(content, &size);
  Embedding embedding = {.file = file, .error = error, .json = {bytes, bytes + size, FALSE}, .copied = bytes};
  gboolean done = !size || read_text(&embedding);
  if (done && !embedding.text) return g_bytes_ref(content);
  if (done) g_string_append_len(embedding.text, embedding.copied, bytes + size - embedding.copied);
  if (done) return g_string_free_to_bytes(embedding.text);
  if (embedding.text) g_string_free(embedding.text, TRUE);
  return NULL;
}
