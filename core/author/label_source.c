/* A label map as a source of tetrahedra: read once and shared. */
#include "core/author/label_source.h"

#include <glib/gi18n.h>

#include "core/author/organ_import.h"
#include "core/io/label_survey.h"

/* First and last voxel of a label along each of the map's axes. */
typedef struct Box {
  guint32 first[3], last[3];
} Box;

struct SporeLabelSource {
  char *file;
  GBytes *content; /* NULL: not read yet, or too large to keep */
  GMutex mutex;
  SporeLabelMap map;
  GArray *labels, *voxels; /* NULL: not read yet */
  Box *boxes;              /* one a label */
  GHashTable *names;       /* of label -> char * */
  gboolean guessed;        /* the names are guesses */
};

SporeLabelSource *spore_label_source_new(const char *file) {
  SporeLabelSource *source = g_atomic_rc_box_new0(SporeLabelSource);
  source->file = g_strdup(file);
  g_mutex_init(&source->mutex);
  return source;
}

SporeLabelSource *spore_label_source_new_of(const char *file, GBytes *content) {
  SporeLabelSource *source = spore_label_source_new(file);
  source->content = g_bytes_ref(content);
  return source;
}

GBytes *spore_label_source_content(const SporeLabelSource *source) { return source->content; }

SporeLabelSource *spore_label_source_ref(SporeLabelSource *source) { return g_atomic_rc_box_acquire(source); }

static void clear(gpointer data) {
  SporeLabelSource *source = data;
  g_free(source->file);
  g_clear_pointer(&source->content, g_bytes_unref);
  g_mutex_clear(&source->mutex);
  spore_label_map_clear(&source->map);
  g_clear_pointer(&source->labels, g_array_unref);
  g_clear_pointer(&source->voxels, g_array_unref);
  g_free(source->boxes);
  g_clear_pointer(&source->names, g_hash_table_unref);
}

void spore_label_source_unref(SporeLabelSource *source) { g_atomic_rc_box_release_full(source, clear); }

const char *spore_label_source_file(const SporeLabelSource *source) { return source->file; }

/* Guesses the names where the file has none. */
static void guess(SporeLabelSource *source) {
  g_autoptr(GArray) sizes = g_array_new(FALSE, FALSE, sizeof(SporeLabelSize));
  for (gsize i = 0; i < source->labels->len; i++) {
    const SporeLabelSize size = {spore_label_source_label(source, i), spore_label_source_volume(source, i)};
    g_array_append_val(sizes, size);
  }
  source->guessed = g_hash_table_size(source->names) == 0;
  if (!source->guessed) return;
  g_hash_table_unref(source->names);
  source->names = spore_label_guess((const SporeLabelSize *)(gconstpointer)sizes->data, sizes->len);
}

/* Fills the boxes of the labels. */
static gboolean measure_boxes(SporeLabelSource *source, const GArray *labels, const SporeProgress *progress,
                              GError **error) {
  const SporeLabelMap *map = &source->map;
  g_autofree guint16 *place = g_new0(guint16, G_MAXUINT16 + 1);
  source->boxes = g_new0(Box, labels->len);
  for (guint i = 0; i < labels->len; i++) {
    place[g_array_index(labels, guint16, i)] = (guint16)i;
    for (int a = 0; a < 3; a++) source->boxes[i].first[a] = G_MAXUINT32;
  }
  SporeError failure = SPORE_ERROR_INIT;
  gsize n = 0;
  for (guint32 k = 0; k < map->size[2]; k++) {
    if (!spore_progress_step(progress, 1, NULL, &failure)) return spore_error_propagate(&failure, error);
    for (guint32 j = 0; j < map->size[1]; j++)
      for (guint32 i = 0; i < map->size[0]; i++, n++) {
        const guint32 at[3] = {i, j, k};
        if (!map->labels[n]) continue;
        Box *box = &source->boxes[place[map->labels[n]]];
        for (int a = 0; a < 3; a++) box->first[a] = MIN(box->first[a], at[a]), box->last[a] = MAX(box->last[a], at[a]);
      }
  }
  return TRUE;
}

static gboolean decode(SporeLabelSource *source, const SporeProgress *progress, GError **error) {
  g_autoptr(GBytes) given =
      source->content ? g_bytes_ref(source->content) : spore_import_read_content(source->file, error);
  g_autoptr(GBytes) content = given ? spore_label_map_whole(source->file, given, error) : NULL;
  if (!content) return FALSE;
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  if (!spore_label_map_is(source->file, bytes, size))
    return spore_error_raise(error, SPORE_ERROR_INPUT, source->file,
                             _("this is no label map; expected NIfTI (.nii, .nii.gz) or NRRD; import a mesh instead"));
  if (!spore_label_map_decode(source->file, bytes, size, &source->map, progress, error)) return FALSE;
  g_autoptr(GArray) labels = NULL, voxels = NULL;
  spore_label_map_list(&source->map, &labels, &voxels);
  if (labels->len < 1 || labels->len > SPORE_LABEL_SOURCE_MOST) {
    spore_label_map_clear(&source->map);
    return spore_error_raise(error, SPORE_ERROR_INPUT, source->file,
                             _("it has %u labels above 0; expected 1 to %u; is it a segmentation?"), labels->len,
                             SPORE_LABEL_SOURCE_MOST);
  }
  if (!measure_boxes(source, labels, progress, error)) {
    spore_label_map_clear(&source->map);
    g_clear_pointer(&source->boxes, g_free);
    return FALSE;
  }
  if (!source->content && size <= SPORE_LABEL_MAP_KEPT) source->content = g_bytes_ref(content);
  source->names = spore_label_map_names(bytes, size);
  source->voxels = g_steal_pointer(&voxels);
  source->labels = g_steal_pointer(&labels);
  guess(source);
  return TRUE;
}

const SporeLabelMap *spore_label_source_read(SporeLabelSource *source, const SporeProgress *progress, GError **error) {
  g_mutex_lock(&source->mutex);
  gboolean done = source->labels || decode(source, progress, error);
  g_mutex_unlock(&source->mutex);
  return done ? &source->map : NULL;
}

gsize spore_label_source_count(const SporeLabelSource *source) { return source->labels->len; }

guint16 spore_label_source_label(const SporeLabelSource *source, gsize i) {
  return g_array_index(source->labels, guint16, i);
}

double spore_label_source_volume(const SporeLabelSource *source, gsize i) {
  return (double)g_array_index(source->voxels, guint64, i) * spore_label_map_voxel_volume(&source->map);
}

void spore_label_source_size(const SporeLabelSource *source, gsize i, double size[3]) {
  const double *axes = source->map.axes;
  for (int a = 0; a < 3; a++) {
    SporeVec3 step = spore_vec3(axes[a], axes[4 + a], axes[8 + a]);
    size[a] = spore_vec3_length(step) * (double)(source->boxes[i].last[a] - source->boxes[i].first[a] + 1);
  }
}

gboolean spore_label_source_is_guessed(const SporeLabelSource *source, gsize i) {
  return source->guessed &&
         g_hash_table_contains(source->names, GUINT_TO_POINTER((guint)spore_label_source_label(source, i)));
}

char *spore_label_source_name(const SporeLabelSource *source, gsize i) {
  return spore_label_map_name(source->names, spore_label_source_label(source, i));
}
