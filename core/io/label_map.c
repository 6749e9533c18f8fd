/* Decoding of label maps in the volume helper, and what is asked of a decoded map. */
#include "core/io/label_map.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/helper.h"
#include "core/io/volume_wire.h"

const SporeHelperLimits spore_label_map_limits = {
    .time_s = 60, .memory = G_GUINT64_CONSTANT(6) << 30, .output = (1 << 29) + 4096};

gboolean spore_label_map_is(const char *file, const void *content, gsize size) {
  const guchar *bytes = content;
  if (size >= 5 && memcmp(bytes, "NRRD0", 5) == 0) return TRUE;
  if (size >= 8 && memcmp(bytes + 4, "n+2", 4) == 0) return TRUE;
  if (size >= 348 && (memcmp(bytes + 344, "n+1", 4) == 0 || memcmp(bytes + 344, "ni1", 4) == 0)) return TRUE;
  if (size >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b) return TRUE; /* no mesh format that SPORE reads is gzip */
  g_autofree char *name = g_ascii_strdown(file, -1);
  return g_str_has_suffix(name, ".nii") || g_str_has_suffix(name, ".nrrd") || g_str_has_suffix(name, ".nii.gz") ||
         g_str_has_suffix(name, ".hdr"); /* Analyze, and NIfTI-2 in two files: their reader tells the user what to do */
}

void spore_label_map_clear(SporeLabelMap *map) {
  spore_free(map->labels);
  *map = (SporeLabelMap){0};
}

double spore_label_map_voxel_volume(const SporeLabelMap *map) {
  const double *a = map->axes;
  return fabs(spore_vec3_dot(spore_vec3(a[0], a[4], a[8]),
                             spore_vec3_cross(spore_vec3(a[1], a[5], a[9]), spore_vec3(a[2], a[6], a[10]))));
}

/* Turns RAS (x right, y front, z up) to SPORE's axes: y is up, and z points to the user, who stands in front. */
static void turn_axes(const double ras[12], double axes[12]) {
  for (int k = 0; k < 4; k++) {
    axes[k] = ras[k];
    axes[4 + k] = ras[8 + k];
    axes[8 + k] = -ras[4 + k];
  }
}

/* The helper is not trusted: its counts must agree to the byte with what it sent, and its axes must span a space. */
static gboolean read_answer(const char *place, GBytes *answer, SporeLabelMap *map, GError **error) {
  gsize size;
  const char *bytes = g_bytes_get_data(answer, &size);
  SporeVolumeAnswer head = {0};
  guint64 voxels = 1;
  if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
  gboolean sane = TRUE;
  for (int i = 0; i < 3; i++) {
    sane = sane && head.size[i] > 0 && head.size[i] <= SPORE_VOLUME_VOXELS / voxels;
    voxels *= sane ? head.size[i] : 1;
  }
  for (int i = 0; i < 12; i++) sane = sane && isfinite(head.axes[i]);
  if (!sane || size != sizeof head + voxels * sizeof(guint16))
    return spore_error_raise(error, SPORE_ERROR_INTERNAL, place,
                             _("the volume helper gave a wrong answer; expected labels; report this"));
  for (int i = 0; i < 3; i++) map->size[i] = head.size[i];
  turn_axes(head.axes, map->axes);
  map->labels = SPORE_NEW_ARRAY(uint16_t, voxels);
  if (!map->labels)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, place,
                             _("there is not enough memory to read it; close other programs"));
  memcpy(map->labels, bytes + sizeof head, voxels * sizeof(guint16));
  if (spore_label_map_voxel_volume(map) > 0) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INTERNAL, place,
                           _("the volume helper gave a wrong answer; expected labels; report this"));
}

gboolean spore_label_map_readable(const char *place, GError **error) {
  return SPORE_HAVE_VOLUMES ||
         spore_error_raise(
             error, SPORE_ERROR_UNSUPPORTED, place,
             _("this is a volume, and this build of SPORE reads none; expected a mesh; install zlib1g-dev and build "
               "SPORE again, or give a surface"));
}

gboolean spore_label_map_decode(const char *place, const void *content, gsize size, SporeLabelMap *map,
                                const SporeProgress *progress, GError **error) {
  *map = (SporeLabelMap){0};
  if (!spore_label_map_readable(place, error)) return FALSE;
  GBytes *request = g_bytes_new_static(content, size);
  GBytes *answer = spore_helper_run("spore-volume", place, request, &spore_label_map_limits, progress, error);
  g_bytes_unref(request);
  if (!answer) return FALSE;
  gboolean done = read_answer(place, answer, map, error);
  g_bytes_unref(answer);
  if (!done) spore_label_map_clear(map);
  return done;
}

void spore_label_map_list(const SporeLabelMap *map, GArray **labels, GArray **voxels) {
  g_autofree guint64 *count = g_new0(guint64, 65536);
  *labels = g_array_new(FALSE, FALSE, sizeof(guint16));
  *voxels = g_array_new(FALSE, FALSE, sizeof(guint64));
  for (size_t i = 0; i < map->size[0] * map->size[1] * map->size[2]; i++) count[map->labels[i]]++;
  for (guint label = 1; label < 65536; label++) {
    guint16 value = (guint16)label;
    if (!count[label]) continue;
    g_array_append_val(*labels, value);
    g_array_append_val(*voxels, count[label]);
  }
}
