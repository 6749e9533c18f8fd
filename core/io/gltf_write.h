/* glTF 2.0 in one binary file (.glb): bodies with materials, and how they move. */
#ifndef SPORE_IO_GLTF_WRITE_H
#define SPORE_IO_GLTF_WRITE_H

#include "core/base/cancel.h"
#include "core/io/motion_keys.h"
#include "core/io/surface_write.h"
#include "core/math/quat.h"

/* A body of the file. A body with poses moves as a whole: its surface lies in its frame. Else the surface lies in the
 * world, and a body with keys changes its shape. */
typedef struct SporeGltfBody {
  SporeNamedSurface surface;
  SporePose pose;        /* of a body with poses, or one that stands in a pose: the first */
  GArray *poses;         /* of SporePose, one at each time; NULL: it stands */
  SporeMotionKeys *keys; /* of the surface's vertices; the first is the surface; NULL: it keeps its shape */
} SporeGltfBody;

/* The content of the file. times: of the poses, s. g_byte_array_unref. NULL with a GError: the file would be larger
 * than its format allows, or it was cancelled. cancel: NULL: nothing does. */
GByteArray *spore_gltf_format(const SporeGltfBody *bodies, gsize count, const GArray *times, const SporeCancel *cancel,
                              GError **error);

#endif
