/* Tetrahedra of several organs at once from a label map, with shared faces where they touch. */
#ifndef SPORE_GENERATE_LABELS_LABELS_H
#define SPORE_GENERATE_LABELS_LABELS_H

#include "core/io/label_map.h"
#include "core/mesh/mesh.h"

typedef struct SporeLabelTetrahedraOptions {
  size_t cells;           /* approximate number wanted for all labels together; 0: `size` is used instead */
  double size;            /* m, edge of the lattice's cubes, when cells is 0 */
  const uint16_t *labels; /* wanted labels; all others count as nothing */
  size_t label_count;     /* 0: all above 0 */
  const double *weights;  /* label_count: cells of each label for its volume, relative to the others; NULL: all alike */
} SporeLabelTetrahedraOptions;

typedef struct SporeLabelFigures {
  uint16_t label;
  size_t cells;
  double volume, voxel_volume; /* m^3: of the label's cells, of the label's voxels */
  double min_dihedral_deg;
} SporeLabelFigures;

typedef struct SporeLabelTetrahedraReport {
  GArray *labels; /* of SporeLabelFigures, ascending; g_array_unref */
  SporeTetrahedraQuality quality;
  size_t shared_faces; /* between two organs */
  double edge;         /* m, of the lattice's cubes */
  double seconds;
} SporeLabelTetrahedraReport;

/* Each cell of a body-centred cubic lattice takes the label with the largest share in the cell. The shares are the
 * voxels' labels, blurred by one voxel; layers of one voxel survive the blur. Vertices between labels then move to
 * where the shares are equal (against nothing: where nothing has one half). Moves keep dihedral angles at least 15
 * degrees from 0 and from 180. Cells that the border could not pass are relabelled. For a wanted number of cells the
 * lattice has up to 24 times as many. The lattice is coarsened where this moves the borders least, with no angle below
 * 11 degrees, and with weights each label keeps nearly its share by volume and weight; the borders then shift slightly
 * to restore each label's volume. So every cell is sound, and organs share the faces between them. result->labels has
 * the organ of each tetrahedron. An organ finer than the lattice may have no cell: the figures show this. FALSE:
 * nothing to mesh, too many cells, no memory, cancelled. */
gboolean spore_label_tetrahedra(const char *place, const SporeLabelMap *map, const SporeLabelTetrahedraOptions *options,
                                SporeTetrahedralMesh *result, SporeLabelTetrahedraReport *report,
                                const SporeProgress *progress, GError **error);

/* The closed surface of one label at the voxels' resolution (marching tetrahedra, corners halfway between voxels). */
bool spore_label_surface(const SporeLabelMap *map, uint16_t label, SporeTriangleMesh *surface,
                         const SporeProgress *progress, SporeError *error);

/* The surface of one label among others, smooth and of few triangles. */
typedef struct SporeLabelSurface {
  uint16_t label;          /* given */
  SporeTriangleMesh mesh;  /* m, closed, outward; spore_triangle_mesh_clear */
  size_t triangles_before; /* before it was made of fewer */
  double off; /* voxels, along the map's axes: the largest distance from its points, half a voxel apart, to the faces of
                 its voxels, and from the middles of those to it */
} SporeLabelSurface;
#define SPORE_LABEL_SURFACE_OFF 0.5 /* voxels: the most that `off` may be */

/* The surfaces of the labels given (each once, above 0), in one pass over the map. Borders between them are smoothed
 * together, within .45 of a voxel; then each surface is made of as few triangles as stay within half a voxel. False
 * with an error: no memory, too many faces, a label that no voxel has, cancelled; no mesh is left. */
bool spore_label_surfaces(const SporeLabelMap *map, SporeLabelSurface *surfaces, size_t count,
                          const SporeProgress *progress, SporeError *error);

#endif
