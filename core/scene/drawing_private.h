/* What the files of a drawing share: where a part comes from, and how the part follows its body. */
#ifndef SPORE_SCENE_DRAWING_PRIVATE_H
#define SPORE_SCENE_DRAWING_PRIVATE_H

#include "core/scene/drawing.h"
#include "core/scene/texture.h"

/* Where a part comes from. */
typedef struct SporePartSource {
  /* At rest, in the body's frame. */
  gsize count;
  const double *points; /* count x 3; borrowed from the document, or own_points */
  double *own_points;
  gsize whole_count;    /* elements before any cut */
  const guint32 *whole; /* borrowed from the document */
  SporeTexture texture; /* of a surface: places of the whole elements */
  double *radii;        /* count, of a line or points; NULL: none */

  SporeMapping mapping;
  gboolean mapped;
  SporeLodGrade level; /* that the mapping is of */
  guint64 knots;       /* number of the lines that the mapping is of */

  const SporeModel *particles; /* of points that may be out of the world; NULL: none may */
  /* Of tetrahedra that a cut may divide. */
  const SporeTetrahedralMesh *cells; /* borrowed from the document; NULL: no cut may */
  gsize corner_start;
  uint32_t *places; /* of the entries of the mapping: spore_mapping_find_places */
  guint64 parted;   /* that the mapping follows */
} SporePartSource;

struct SporeDrawing {
  SporeDocument *document;
  const SporeSimulation *simulation;
  GArray *parts; /* of SporeDrawnPart */
};

/* Appends the parts of a body, without anything that depends on the moment. */
gboolean spore_drawing_add_body(SporeDrawing *drawing, guint32 body, GError **error);
void spore_part_source_free(SporePartSource *source);
/* What a failure of the kernel says, with the body as its place. Returns FALSE. */
gboolean spore_drawn_part_refuse(const SporeDrawnPart *part, SporeError *fault, GError **error);

#endif
