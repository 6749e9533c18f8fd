/* Pairs of particles that are near each other, for forces of short reach: a Verlet list of clusters.
 *
 * Particles are sorted into columns and, along them, into clusters of SPORE_LANES (after S. Pall and B. Hess, "A
 * flexible algorithm for calculating pair interactions on SIMD architectures", 2013). A row group is two particles of a
 * cluster, which meet whole clusters. Each pair is listed once, however its clusters lie. There are two
 * lists: the near one, which forces go through, is good until a particle has moved by half a thin skin, and then is
 * picked out of the wide one, which takes longer to make and lasts longer (after S. Pall, A. Zhmurov, P. Bauer et al.,
 * "Heterogeneous parallelization and acceleration of molecular dynamics simulations in GROMACS", 2020). Which pairs
 * they hold, and in which order, follows from the positions at these times alone. */
#ifndef SPORE_MODELS_PARTICLES_CLUSTER_LIST_H
#define SPORE_MODELS_PARTICLES_CLUSTER_LIST_H

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

/* Row groups and the clusters that they meet. */
typedef struct SporeClusterPairs {
  double reach;         /* m: pairs nearer than this are there */
  uint32_t *group_runs; /* first run of each row group, and their number */
  size_t run_count, run_capacity, entry_count, entry_capacity;
  SporeClusterRun *runs;
  uint32_t *entries; /* clusters */
} SporeClusterPairs;

typedef struct SporeClusterRecord SporeClusterRecord;
typedef struct SporeClusterColumn SporeClusterColumn;

typedef struct SporeClusterList {
  size_t particle_count;
  double box[3]; /* m: period along each axis; 0: none */
  double reach;  /* m: of the forces */

  size_t cluster_count;
  uint32_t *particle; /* SPORE_LANES a cluster: SPORE_NO_PARTICLE where there is none */
  double *x;          /* SPORE_CLUSTER_DOUBLES a cluster: x of all its particles, y, z; far off where there is none */
  double *f;          /* the same for the forces */
  double *wide_at;    /* x when the wide pairs were found */
  double *near_at;    /* x when the near pairs were picked out */
  double *offset;     /* x minus q of the same particle, whole periods; NULL: nowhere periodic */
  double *bounds;     /* 6 x particle_count: least x of each cluster, then y, z, then the greatest */

  SporeClusterPairs wide, near;
  size_t candidate_capacity;
  uint32_t *candidates; /* clusters whose bounds are near those of one */

  bool made;
  uint64_t rebuilds; /* ever */
  SporeClusterRecord *records, *sorting;
  size_t column_count;
  SporeClusterColumn *columns;
} SporeClusterList;

/* Nothing is asked of the positions. reach: of the forces, m. False: no memory. */
bool spore_cluster_list_init(SporeClusterList *list, size_t particle_count, const double box[3], double reach);
/* m: how far two clusters may be from each other and still be in the list. */
double spore_cluster_reach(double reach);
void spore_cluster_list_clear(SporeClusterList *list);

/* Takes positions (particle_count x 3) into x and makes the list anew where it has to. Allocates nothing, more room for
 * more pairs than ever before apart. False: a position is not finite, or no memory; the list is not made then. */
bool spore_cluster_list_update(SporeClusterList *list, const double *q);
/* Room for twice as many pairs as the list holds: how many there are varies as a fluid flows. False: no memory. */
bool spore_cluster_list_spare(SporeClusterList *list);
/* f of each particle (particle_count x 3) += list->f. */
void spore_cluster_list_add_forces(const SporeClusterList *list, double *f);

/* cluster_kernels.c */
/* Positions of all clusters from q; the greatest squared way from near_at. */
SPORE_DECLARE_KERNEL(double, spore_cluster_move, SporeClusterList *list, const double *q);
/* The greatest squared way from wide_at. */
SPORE_DECLARE_KERNEL(double, spore_cluster_way, const SporeClusterList *list);
/* Those of the clusters from..to-1 whose bounds are in the wide list's reach of those of `cluster`, moved back by
 * image. Returns their number. */
SPORE_DECLARE_KERNEL(size_t, spore_cluster_search, const SporeClusterList *list, size_t cluster, const double image[3],
                     size_t from, size_t to, uint32_t *found);
/* Those of count clusters of which a particle is nearer than `far` to one of the row group's. */
SPORE_DECLARE_KERNEL(size_t, spore_cluster_refine, const SporeClusterList *list, double far, size_t group,
                     const double image[3], const uint32_t *clusters, size_t count, uint32_t *found);

#endif
