/* Pairs of particles that are near each other, for forces of short reach: a Verlet list of clusters.
 *
 * Particles are sorted into columns and, along them, into clusters of SPORE_LANES (after S. Pall and B. Hess, "A
 * flexible algorithm for calculating pair interactions on SIMD architectures", 2013). A row group is two particles of a
 * cluster, which meet whole clusters. Each pair is listed once, however its clusters lie. The list stays good until a
 * particle has moved by half the skin; it then is made anew, and which pairs it holds, and in which order, follows from
 * the positions at that time alone. */
#ifndef SPORE_MODELS_CLUSTER_LIST_H
#define SPORE_MODELS_CLUSTER_LIST_H

#include <stdbool.h>

#include "core/math/simd.h"

#define SPORE_CLUSTER_ROWS 2
#define SPORE_CLUSTER_DOUBLES (3 * SPORE_LANES)
#define SPORE_CLUSTER_GROUPS (SPORE_LANES / SPORE_CLUSTER_ROWS) /* a cluster */
#define SPORE_NO_PARTICLE UINT32_MAX

/* Clusters that a row group meets, moved by `image`; `own`: the first of them is the group's own cluster. */
typedef struct SporeClusterRun {
  double image[3]; /* m */
  uint32_t start, end;
  bool own;
} SporeClusterRun;

typedef struct SporeClusterRecord SporeClusterRecord;
typedef struct SporeClusterColumn SporeClusterColumn;

typedef struct SporeClusterList {
  size_t particle_count;
  double box[3]; /* m: period along each axis; 0: none */
  double reach;  /* m: of the forces */
  double skin;   /* m */

  size_t cluster_count;
  uint32_t *particle; /* SPORE_LANES a cluster: SPORE_NO_PARTICLE where there is none */
  double *x;          /* SPORE_CLUSTER_DOUBLES a cluster: x of all its particles, y, z; far off where there is none */
  double *f;          /* the same for the forces */
  double *reference;  /* x when the list was made */
  double *offset;     /* x minus q of the same particle, whole periods; NULL: nowhere periodic */
  double *bounds;     /* 6 x particle_count: least x of each cluster, then y, z, then the greatest */

  uint32_t *group_runs; /* first run of each row group, and their number */
  size_t run_count, run_capacity, entry_count, entry_capacity;
  SporeClusterRun *runs;
  uint32_t *entries; /* clusters */
  size_t candidate_capacity;
  uint32_t *candidates; /* clusters whose bounds are near those of one */

  bool made;
  uint64_t rebuilds; /* ever */
  SporeClusterRecord *records, *sorting;
  size_t column_count;
  SporeClusterColumn *columns;
} SporeClusterList;

/* No particle is nearer than... nothing is asked of the positions. False: no memory. */
bool spore_cluster_list_init(SporeClusterList *list, size_t particle_count, const double box[3], double reach,
                             double skin);
void spore_cluster_list_clear(SporeClusterList *list);

/* Takes positions (particle_count x 3) into x and makes the list anew where it has to. Allocates nothing, more room for
 * more pairs than ever before apart. False: a position is not finite, or no memory; the list is not made then. */
bool spore_cluster_list_update(SporeClusterList *list, const double *q);
/* Room for twice as many pairs as the list holds: how many there are varies as a fluid flows. False: no memory. */
bool spore_cluster_list_spare(SporeClusterList *list);
/* f of each particle (particle_count x 3) += list->f. */
void spore_cluster_list_add_forces(const SporeClusterList *list, double *f);

/* cluster_kernels.c */
/* Positions of `clusters` clusters from q; the greatest squared way from the reference. */
SPORE_DECLARE_KERNEL(double, spore_cluster_move, SporeClusterList *list, const double *q);
/* Those of the clusters from..to-1 whose bounds are nearer than reach and skin to those of `cluster`, moved back by
 * image. Returns their number. */
SPORE_DECLARE_KERNEL(size_t, spore_cluster_search, const SporeClusterList *list, size_t cluster, const double image[3],
                     size_t from, size_t to, uint32_t *found);
/* Those of count clusters of which a particle is nearer than reach and skin to one of the row group's. */
SPORE_DECLARE_KERNEL(size_t, spore_cluster_refine, const SporeClusterList *list, size_t group, const double image[3],
                     const uint32_t *clusters, size_t count, uint32_t *found);

#endif
