/* Label maps whose voxels lie in a file beside their header become one file, as the readers take them. */
#include <glib/gi18n.h>
#include <string.h>
#include <sys/stat.h>

#include "core/io/label_map.h"

#define MOST_BYTES ((goffset)1 << 30)
#define MOST_HEADER ((gsize)1 << 20)
#define NIFTI_HEADER 348
#define NIFTI_MAGIC 344
#define NIFTI_START 108 /* of its vox_offset, a float */
#define NIFTI_DATA 352

/* The voxels' file, in the header's own folder. */
static GBytes *read_beside(const char *file, const char *name, GError **error) {
  if (!*name || strpbrk(name, "/\\") || g_str_equal(name, "..") || g_str_has_prefix(name, "LIST")) {
    spore_error_raise(error, SPORE_ERROR_INPUT, file,
                      _("its voxels are said to be in \"%s\"; expected the name of one file in the same folder; put it "
                        "there, or save header and data together"),
                      name);
    return NULL;
  }
  g_autofree char *folder = g_path_get_dirname(file), *path = g_build_filename(folder, name, NULL), *bytes = NULL;
  g_autoptr(GError) cause = NULL;
  gsize size = 0;
  struct stat info;
  gboolean there = lstat(path, &info) == 0;
  if (!there || !S_ISREG(info.st_mode) || info.st_size > MOST_BYTES)
    spore_error_raise(error, SPORE_ERROR_FILE, file,
                      there
                          ? _("its voxels' file \"%s\" is no regular file, or has over 1 GiB; expected a smaller one "
                              "in the same folder; copy it there, or crop it")
                          : _("its voxels' file \"%s\" is not there; expected it in the same folder; copy both files"),
                      name);
  else if (!g_file_get_contents(path, &bytes, &size, &cause))
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("its voxels' file \"%s\" cannot be read (%s); check it"), name,
                      cause->message);
  return bytes ? g_bytes_new_take(g_steal_pointer(&bytes), size) : NULL;
}

static GBytes *joined(const void *header, gsize size, GBytes *data) {
  gsize data_size;
  const void *bytes = g_bytes_get_data(data, &data_size);
  GByteArray *whole = g_byte_array_new();
  g_byte_array_append(whole, header, (guint)size);
  g_byte_array_append(whole, bytes, (guint)data_size);
  return g_byte_array_free_to_bytes(whole);
}

/* Value of a line "data file: NAME"; NULL: it is another. */
static const char *data_file_of(const char *line) {
  static const char *const keys[] = {"data file:", "datafile:"};
  for (gsize i = 0; i < G_N_ELEMENTS(keys); i++)
    if (g_ascii_strncasecmp(line, keys[i], strlen(keys[i])) == 0) return line + strlen(keys[i]);
  return NULL;
}

/* The header without the line that names the voxels' file, then those. */
static GBytes *join_nrrd(const char *file, const char *bytes, gsize size, GError **error) {
  g_autofree char *text = g_strndup(bytes, MIN(size, MOST_HEADER)), *name = NULL;
  g_autoptr(GString) header = g_string_new(NULL);
  g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
  for (char **line = lines; *line && *g_strchomp(*line); line++) {
    const char *value = data_file_of(*line);
    if (!value) g_string_append_printf(header, "%s\n", *line);
    else if (!name) name = g_strstrip(g_strdup(value));
  }
  if (!name) return NULL;
  g_string_append_c(header, '\n');
  g_autoptr(GBytes) data = read_beside(file, name, error);
  return data ? joined(header->str, header->len, data) : NULL;
}

/* A .hdr with its .img: as a .nii. */
static GBytes *join_nifti(const char *file, const char *bytes, GError **error) {
  g_autofree char *base = g_path_get_basename(file), *name = NULL;
  char header[NIFTI_DATA] = {0};
  gint32 length;
  memcpy(header, bytes, NIFTI_HEADER);
  memcpy(&length, bytes, sizeof length);
  guint32 start;
  const float at = NIFTI_DATA;
  memcpy(&start, &at, sizeof start);
  if (length != NIFTI_HEADER) start = GUINT32_SWAP_LE_BE(start);
  memcpy(header + NIFTI_START, &start, sizeof start);
  memcpy(header + NIFTI_MAGIC, "n+1", 4);
  char *dot = strrchr(base, '.');
  if (dot) *dot = '\0';
  name = g_strdup_printf("%s.img", base);
  g_autoptr(GBytes) data = read_beside(file, name, error);
  return data ? joined(header, sizeof header, data) : NULL;
}

GBytes *spore_label_map_whole(const char *file, GBytes *content, GError **error) {
  gsize size;
  const char *bytes = g_bytes_get_data(content, &size);
  GError *cause = NULL;
  GBytes *whole = NULL;
  if (size >= 5 && memcmp(bytes, "NRRD0", 5) == 0) whole = join_nrrd(file, bytes, size, &cause);
  else if (size >= NIFTI_HEADER && memcmp(bytes + NIFTI_MAGIC, "ni1", 4) == 0) whole = join_nifti(file, bytes, &cause);
  if (cause) g_propagate_error(error, cause);
  return whole || cause ? whole : g_bytes_ref(content);
}
