/* Joins a label map's header with the separate file of its voxels, since the readers take one file. */
#include <string.h>

#include "core/io/beside.h"
#include "core/io/label_map.h"

#define MOST_BYTES ((gsize)1 << 30)
#define MOST_HEADER ((gsize)1 << 20)
#define NIFTI_HEADER 348
#define NIFTI_MAGIC 344
#define NIFTI_START 108 /* of its vox_offset, a float */
#define NIFTI_DATA 352

/* Joins the header with the voxels of the file `name`. A list of files is none. */
static GBytes *join_beside(const char *file, const char *name, const void *header, gsize size, GError **error) {
  return spore_beside_read(file, g_str_has_prefix(name, "LIST") ? "" : name, header, size, MOST_BYTES, error);
}

/* The value of a line "data file: NAME"; NULL: it is another line. */
static const char *data_file_of(const char *line) {
  static const char *const keys[] = {"data file:", "datafile:"};
  for (gsize i = 0; i < G_N_ELEMENTS(keys); i++)
    if (g_ascii_strncasecmp(line, keys[i], strlen(keys[i])) == 0) return line + strlen(keys[i]);
  return NULL;
}

/* Joins the header, without the line that names the file of the voxels, with these voxels. */
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
  return join_beside(file, name, header->str, header->len, error);
}

/* Joins a .hdr with its .img to a .nii. The header's offset then counts from the start of the .img. */
static GBytes *join_nifti(const char *file, const char *bytes, GError **error) {
  g_autofree char *base = g_path_get_basename(file), *name = NULL;
  char header[NIFTI_DATA] = {0};
  gint32 length;
  guint32 start;
  float at;
  memcpy(header, bytes, NIFTI_HEADER);
  memcpy(&length, bytes, sizeof length);
  memcpy(&start, bytes + NIFTI_START, sizeof start);
  if (length != NIFTI_HEADER) start = GUINT32_SWAP_LE_BE(start);
  memcpy(&at, &start, sizeof at);
  at += NIFTI_DATA;
  memcpy(&start, &at, sizeof start);
  if (length != NIFTI_HEADER) start = GUINT32_SWAP_LE_BE(start);
  memcpy(header + NIFTI_START, &start, sizeof start);
  memcpy(header + NIFTI_MAGIC, "n+1", 4);
  char *dot = strrchr(base, '.');
  if (dot) *dot = '\0';
  name = g_strdup_printf("%s.img", base);
  return join_beside(file, name, header, sizeof header, error);
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
