/* Wanted edge lengths of a mesh, which vary from place to place: values at the nodes of a regular grid. Needs libc
 * alone. */
#ifndef SPORE_MESH_SIZING_H
#define SPORE_MESH_SIZING_H

#include <stddef.h>

#define SPORE_SIZING_NODES 64      /* along an axis at most */
#define SPORE_SIZING_GRADATION 0.4 /* largest growth of the size with distance */

/* One value (count 1 x 1 x 1) is a size that is the same everywhere. */
typedef struct SporeSizing {
  size_t count[3];
  double lower[3], spacing;
  double *size; /* x runs fastest */
} SporeSizing;

static inline double spore_sizing_between(double a, double b, double t) { return a + t * (b - a); }

/* The size at p, interpolated between the eight nodes around p; outside of the grid as at its border. */
static inline double spore_sizing_at(const SporeSizing *sizing, const double p[3]) {
  size_t low[3], step[3];
  double t[3];
  for (int k = 0; k < 3; k++) {
    double x = sizing->count[k] > 1 ? (p[k] - sizing->lower[k]) / sizing->spacing : 0;
    double most = (double)(sizing->count[k] - 1);
    x = x > 0 ? (x < most ? x : most) : 0;
    low[k] = (size_t)x;
    if (low[k] + 1 >= sizing->count[k] && low[k]) low[k]--;
    t[k] = x - (double)low[k];
    step[k] = sizing->count[k] > 1;
  }
  double value[4];
  for (size_t i = 0; i < 4; i++) {
    size_t y = low[1] + (i & 1) * step[1], z = low[2] + (i >> 1) * step[2];
    const double *row = sizing->size + (z * sizing->count[1] + y) * sizing->count[0] + low[0];
    value[i] = spore_sizing_between(row[0], row[step[0]], t[0]);
  }
  return spore_sizing_between(spore_sizing_between(value[0], value[1], t[1]),
                              spore_sizing_between(value[2], value[3], t[1]), t[2]);
}

#endif
