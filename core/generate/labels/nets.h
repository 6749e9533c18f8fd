/* Nets between the voxels of different labels, all at once: the raw material of spore_label_surfaces. */
#ifndef SPORE_GENERATE_LABELS_NETS_H
#define SPORE_GENERATE_LABELS_NETS_H

#include "core/generate/labels/labels.h"

#define SPORE_LABEL_NET_SLACK 0.45 /* voxels: how far smoothing moves a node */

/* A face between two voxels of different labels. */
typedef struct SporeLabelFace {
  uint32_t node[4];  /* around the face, so that its normal points up the axis: from the first label to the second */
  uint16_t label[2]; /* of the lower and the upper voxel along the axis; 0: none that is wanted */
} SporeLabelFace;

/* Nodes are corners of voxels at which a wanted label ends; places are in indices of the map. */
typedef struct SporeLabelNet {
  size_t node_count, node_capacity, face_count, face_capacity;
  uint32_t *corner; /* node_count x 3: indices of the voxel above in all three axes; the corner is half a voxel below */
  float *moved;     /* node_count x 3: from the corner */
  SporeLabelFace *faces;
} SporeLabelNet;

/* wanted: 65536. Outside the map is nothing, so that every label is closed. False: no memory, too large, cancelled. */
bool spore_label_net_create(SporeLabelNet *net, const SporeLabelMap *map, const bool *wanted,
                            const SporeProgress *progress, SporeError *error);
void spore_label_net_clear(SporeLabelNet *net);
/* Smooths the nodes, each within a ball of SPORE_LABEL_NET_SLACK around its corner. So every point of a face moves by
 * no more than that, and the net and the voxels are nowhere farther apart. */
bool spore_label_net_smooth(SporeLabelNet *net, const SporeProgress *progress, SporeError *error);
/* The closed surface of one label, outward in index space, every edge between two triangles: where parts of the label
 * touch at an edge or a corner, each has nodes of its own. own: count faces that have the label. */
bool spore_label_net_surface(const SporeLabelNet *net, uint16_t label, const uint32_t *own, size_t count,
                             SporeTriangleMesh *surface, SporeError *error);

#endif
