/* How a cluster list sorts particles into columns and, along them, into clusters. */
#ifndef SPORE_MODELS_PARTICLES_CLUSTER_COLUMNS_H
#define SPORE_MODELS_PARTICLES_CLUSTER_COLUMNS_H

#include "models/particles/cluster_list.h"

struct SporeClusterRecord {
  uint64_t column; /* of its place along x, then y */
  double z;
  uint32_t particle;
};

struct SporeClusterColumn {
  uint64_t key;
  uint32_t start, end; /* clusters; the first may hold particles of the column before, too */
};

/* How space is laid out in columns along z. */
typedef struct SporeColumnGrid {
  double side[2], per_side[2];
  int64_t count[2]; /* of a period; 0: no period */
} SporeColumnGrid;

SporeColumnGrid spore_column_grid(const SporeClusterList *list);
/* Number of the column along an axis (0: x, 1: y); strangers at the far end of the world share one. */
int64_t spore_column_of(const SporeColumnGrid *columns, int axis, double x);
/* Particles into clusters: list->x, particle, bounds, columns. False: a position is not finite. */
bool spore_cluster_fill(SporeClusterList *list, const SporeColumnGrid *columns, const double *q);
/* Clusters start..end-1: those of the columns least..most along y, in row cx. */
void spore_cluster_row(const SporeClusterList *list, int64_t cx, int64_t least, int64_t most, size_t *start,
                       size_t *end);

#endif
