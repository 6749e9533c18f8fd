/* Label maps: volumes in which each voxel holds the number of the organ it belongs to. */
#ifndef SPORE_IO_LABEL_MAP_H
#define SPORE_IO_LABEL_MAP_H

#include <glib.h>
#include <stdint.h>

#include "core/base/progress.h"
#include "core/io/helper.h"
#include "core/math/vec3.h"
#include "core/scene/error.h"

#define SPORE_LABEL_MAP_KEPT ((gsize)64 << 20) /* bytes: a larger label map is not stored in a scene */

typedef struct SporeLabelMap {
  size_t size[3];
  uint16_t *labels; /* size[0] x size[1] x size[2], the first index fastest; 0: nothing */
  double axes[12];  /* 3 x 4: from indices (i, j, k, 1) of a voxel's middle to SPORE's axes, m */
} SporeLabelMap;

/* Whether the content (for gzip: the name) is that of a volume, NIfTI or NRRD. */
gboolean spore_label_map_is(const char *file, const void *content, gsize size);
/* The content, joined with the voxels where the header names another file for them: NRRD's "data file", the .img of a
 * NIfTI-1 .hdr. That must be one regular file in the same folder. Other content is returned as it is. g_bytes_unref;
 * NULL with an error. */
GBytes *spore_label_map_whole(const char *file, GBytes *content, GError **error);
extern const SporeHelperLimits spore_label_map_limits; /* of the helpers that read label maps */
/* Whether this build reads label maps; else an error. */
gboolean spore_label_map_readable(const char *place, GError **error);
/* Decodes NIfTI-1 and -2 in one file, plain or gzip, and NRRD with attached raw or gzip data, in a helper process.
 * Place and size of voxels come from the header (sform, else qform, else voxel sizes; NRRD's space), in mm where the
 * header has no unit. Refuses with a message a file that is cut short, is impossible, is too large, or holds values
 * other than labels from 0 to 65535. */
gboolean spore_label_map_decode(const char *place, const void *content, gsize size, SporeLabelMap *map,
                                const SporeProgress *progress, GError **error);
void spore_label_map_clear(SporeLabelMap *map);

/* The labels above 0 that occur, ascending (GArray of guint16), and the number of voxels of each (GArray of guint64).
 */
void spore_label_map_list(const SporeLabelMap *map, GArray **labels, GArray **voxels);
/* Names of labels in a file (NRRD as 3D Slicer writes it): label -> char *; empty where the file has none.
 * g_hash_table_unref. */
GHashTable *spore_label_map_names(const void *content, gsize size);
/* The name of a label, or a name made of its number. g_free. */
char *spore_label_map_name(GHashTable *names, guint16 label);
double spore_label_map_voxel_volume(const SporeLabelMap *map); /* m^3 */

static inline SporeVec3 spore_label_map_place(const SporeLabelMap *map, double i, double j, double k) {
  const double *a = map->axes;
  return spore_vec3(a[0] * i + a[1] * j + a[2] * k + a[3], a[4] * i + a[5] * j + a[6] * k + a[7],
                    a[8] * i + a[9] * j + a[10] * k + a[11]);
}

#endif
