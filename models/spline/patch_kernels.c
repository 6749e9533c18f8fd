/* Forces, energy and Jacobian of a sheet. */
#include <assert.h>
#include <string.h>

#include "core/math/simd_matrix.h"
#include "models/common/block_rows.h"
#include "models/spline/patch.h"

#define FUNCTIONS SPORE_PATCH_FUNCTIONS
#define POINTS SPORE_PATCH_POINTS
#define PAIRS SPORE_PATCH_PAIRS
#define TINY 1e-200

/* What multiplies the two energies, N/m and N m, and Poisson's ratio. */
typedef struct Material {
  double membrane, bending, poisson;
} Material;

SPORE_INLINE Material material_of(const SporePatch *patch) {
  double t = patch->thickness, membrane = patch->young * t / (1 - patch->poisson * patch->poisson);
  return (Material){membrane, membrane * t * t / 12, patch->poisson};
}

SPORE_INLINE void gather(const SporePatch *patch, size_t group, size_t lane, const double *x,
                         SporeVd3 nodes[FUNCTIONS]) {
  assert(group < patch->group_count && lane < SPORE_LANES);
  for (size_t k = 0; k < FUNCTIONS; k++)
    nodes[k] = spore_vd3_gather(x, patch->node + (group * FUNCTIONS + k) * SPORE_LANES + lane);
}

/* Derivatives at a Gauss point, and forces on them. */
typedef struct Five {
  SporeVd3 a[2], b[3];
} Five;

/* Node by node, so that each is loaded once for all five. */
SPORE_INLINE Five five_of(const SporePatchGauss *gauss, size_t lane, const SporeVd3 *nodes) {
  Five five;
  for (int e = 0; e < 2; e++) five.a[e] = spore_vd3_scale(spore_vd_load(gauss->first[e][0] + lane), nodes[0]);
  for (int e = 0; e < 3; e++) five.b[e] = spore_vd3_scale(spore_vd_load(gauss->second[e][0] + lane), nodes[0]);
  for (int k = 1; k < FUNCTIONS; k++) {
    for (int e = 0; e < 2; e++)
      five.a[e] = spore_vd3_add(five.a[e], spore_vd3_scale(spore_vd_load(gauss->first[e][k] + lane), nodes[k]));
    for (int e = 0; e < 3; e++)
      five.b[e] = spore_vd3_add(five.b[e], spore_vd3_scale(spore_vd_load(gauss->second[e][k] + lane), nodes[k]));
  }
  return five;
}

/* a1, a2, b1, b2, b3 of a Gauss point, x y z each. */
SPORE_INLINE void store_five(double (*to)[SPORE_LANES], size_t lane, const Five *five) {
  for (int e = 0; e < 5; e++) {
    SporeVd3 r = e < 2 ? five->a[e] : five->b[e - 2];
    spore_vd_store(to[3 * e] + lane, r.x), spore_vd_store(to[3 * e + 1] + lane, r.y);
    spore_vd_store(to[3 * e + 2] + lane, r.z);
  }
}
SPORE_INLINE Five load_five(double (*from)[SPORE_LANES], size_t lane) {
  Five five;
  for (int e = 0; e < 5; e++) {
    SporeVd3 r = {spore_vd_load(from[3 * e] + lane), spore_vd_load(from[3 * e + 1] + lane),
                  spore_vd_load(from[3 * e + 2] + lane)};
    if (e < 2) five.a[e] = r;
    else five.b[e - 2] = r;
  }
  return five;
}

/* Fills patch->damped, but where it is of that shape already. */
SPORE_INLINE void damp_along(const SporePatch *patch, const double *shape) {
  SporePatchShape *damped = patch->damped;
  size_t size = 3 * spore_patch_nodes(patch) * sizeof *shape;
  if (damped->ready && memcmp(damped->shape, shape, size) == 0) return;
  damped->ready = true;
  memcpy(damped->shape, shape, size);
  for (size_t group = 0; group < patch->group_count; group++)
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 s[FUNCTIONS];
      gather(patch, group, lane, shape, s);
      for (size_t point = group * POINTS; point < (group + 1) * POINTS; point++) {
        Five at = five_of(patch->gauss + point, lane, s);
        store_five(damped->at[point], lane, &at);
      }
    }
}

SPORE_INLINE void subtract_forces(const SporePatchGauss *gauss, size_t lane, const Five *by, SporeVd3 *sum) {
  for (int i = 0; i < FUNCTIONS; i++) {
    for (int k = 0; k < 2; k++)
      sum[i] = spore_vd3_sub(sum[i], spore_vd3_scale(spore_vd_load(gauss->first[k][i] + lane), by->a[k]));
    for (int k = 0; k < 3; k++)
      sum[i] = spore_vd3_sub(sum[i], spore_vd3_scale(spore_vd_load(gauss->second[k][i] + lane), by->b[k]));
  }
}

/* A symmetric 2x2 matrix a lane: 11, 22, 12. */
typedef struct Plane {
  SporeVd m[3];
} Plane;

/* Stress of a strain whose last entry is E12. */
SPORE_INLINE Plane stress_of(Material by, SporeVd scale, Plane e) {
  return (Plane){{scale * (e.m[0] + by.poisson * e.m[1]), scale * (e.m[1] + by.poisson * e.m[0]),
                  scale * (1 - by.poisson) * e.m[2]}};
}

SPORE_INLINE Plane strain_of(const Five *at) {
  return (Plane){{0.5 * (spore_vd3_dot(at->a[0], at->a[0]) - 1), 0.5 * (spore_vd3_dot(at->a[1], at->a[1]) - 1),
                  0.5 * spore_vd3_dot(at->a[0], at->a[1])}};
}

SPORE_INLINE void pull(const Plane *stress, const Five *at, Five *force) {
  force->a[0] = spore_vd3_add(spore_vd3_scale(stress->m[0], at->a[0]), spore_vd3_scale(stress->m[2], at->a[1]));
  force->a[1] = spore_vd3_add(spore_vd3_scale(stress->m[2], at->a[0]), spore_vd3_scale(stress->m[1], at->a[1]));
}

/* b_k less what it is at rest, of a sheet turned so. */
SPORE_INLINE void bends_of(const SporePatchGauss *gauss, size_t lane, const Five *at, bool curved, SporeVd3 bend[3]) {
  SporeVd3 normal = spore_vd3_cross(at->a[0], at->a[1]);
  for (int k = 0; k < 3; k++) {
    bend[k] = at->b[k];
    if (curved) bend[k] = spore_vd3_sub(bend[k], spore_vd3_scale(spore_vd_load(gauss->curvature[k] + lane), normal));
  }
}

SPORE_INLINE void moments_of(Material by, SporeVd scale, const SporeVd3 bend[3], SporeVd3 moment[3]) {
  moment[0] = spore_vd3_scale(scale, spore_vd3_add(bend[0], spore_vd3_scale(spore_vd_all(by.poisson), bend[1])));
  moment[1] = spore_vd3_scale(scale, spore_vd3_add(bend[1], spore_vd3_scale(spore_vd_all(by.poisson), bend[0])));
  moment[2] = spore_vd3_scale(2 * (1 - by.poisson) * scale, bend[2]);
}

/* sum over k of c_k moment_k: what pulls at the normal. */
SPORE_INLINE SporeVd3 normal_moment(const SporePatchGauss *gauss, size_t lane, const SporeVd3 moment[3]) {
  SporeVd3 sum = spore_vd3_scale(spore_vd_load(gauss->curvature[0] + lane), moment[0]);
  for (int k = 1; k < 3; k++)
    sum = spore_vd3_add(sum, spore_vd3_scale(spore_vd_load(gauss->curvature[k] + lane), moment[k]));
  return sum;
}

SPORE_INLINE Five elastic_forces(const SporePatch *patch, Material by, const SporePatchGauss *gauss, size_t lane,
                                 const Five *at) {
  SporeVd area = spore_vd_load(gauss->area + lane);
  Plane stress = stress_of(by, by.membrane * area, strain_of(at));
  Five force;
  SporeVd3 bend[3];
  pull(&stress, at, &force);
  bends_of(gauss, lane, at, patch->curved, bend);
  moments_of(by, by.bending * area, bend, force.b);
  if (!patch->curved) return force;
  SporeVd3 moment = normal_moment(gauss, lane, force.b);
  force.a[0] = spore_vd3_sub(force.a[0], spore_vd3_cross(at->a[1], moment));
  force.a[1] = spore_vd3_sub(force.a[1], spore_vd3_cross(moment, at->a[0]));
  return force;
}

/* How b_k.(a1 x a2) changes: with b_k by the normal, with a1 and a2 by these. */
SPORE_INLINE void tilt_of(const Five *at, int k, SporeVd3 tilt[2]) {
  tilt[0] = spore_vd3_cross(at->a[1], at->b[k]);
  tilt[1] = spore_vd3_cross(at->b[k], at->a[0]);
}

SPORE_INLINE void add_viscous(Material by, double viscous, const SporePatchGauss *gauss, size_t lane, const Five *at,
                              const Five *speed, Five *force) {
  SporeVd area = spore_vd_load(gauss->area + lane), membrane = viscous * by.membrane * area;
  SporeVd bending = viscous * by.bending * area;
  Plane rate = {{spore_vd3_dot(at->a[0], speed->a[0]), spore_vd3_dot(at->a[1], speed->a[1]),
                 0.5 * (spore_vd3_dot(at->a[0], speed->a[1]) + spore_vd3_dot(at->a[1], speed->a[0]))}};
  Plane stress = stress_of(by, membrane, rate);
  Five drag;
  pull(&stress, at, &drag);
  SporeVd3 normal = spore_vd3_cross(at->a[0], at->a[1]), tilt[3][2];
  SporeVd turn[3];
  for (int k = 0; k < 3; k++) {
    tilt_of(at, k, tilt[k]);
    turn[k] = bending * (spore_vd3_dot(normal, speed->b[k]) + spore_vd3_dot(tilt[k][0], speed->a[0]) +
                         spore_vd3_dot(tilt[k][1], speed->a[1]));
  }
  const SporeVd moment[3] = {turn[0] + by.poisson * turn[1], turn[1] + by.poisson * turn[0],
                             2 * (1 - by.poisson) * turn[2]};
  for (int k = 0; k < 3; k++) {
    force->b[k] = spore_vd3_add(force->b[k], spore_vd3_scale(moment[k], normal));
    for (int i = 0; i < 2; i++) drag.a[i] = spore_vd3_add(drag.a[i], spore_vd3_scale(moment[k], tilt[k][i]));
  }
  for (int i = 0; i < 2; i++) force->a[i] = spore_vd3_add(force->a[i], drag.a[i]);
}

/* Cells of the group that are none: behind the last. */
SPORE_INLINE size_t cells_of(const SporePatch *patch, size_t group) {
  assert(group < patch->group_count);
  size_t left = patch->cell_count - group * SPORE_LANES;
  return left < SPORE_LANES ? left : SPORE_LANES;
}

SPORE_INLINE Five moved(const Five *from, const Five *speed, double h) {
  SporeVd by = spore_vd_all(h);
  Five five;
  for (int e = 0; e < 2; e++) five.a[e] = spore_vd3_add(from->a[e], spore_vd3_scale(by, speed->a[e]));
  for (int e = 0; e < 3; e++) five.b[e] = spore_vd3_add(from->b[e], spore_vd3_scale(by, speed->b[e]));
  return five;
}

enum { ELASTIC, DAMPED_AT_Q, DAMPED_AT_SHAPE, MOVED_FROM_SHAPE };

/* The forces of a Gauss point. */
SPORE_INLINE Five point_forces(const SporePatch *patch, Material by, size_t point, size_t lane, const SporeVd3 *x,
                               const SporeVd3 *u, double h, int damped) {
  const SporePatchGauss *gauss = patch->gauss + point;
  Five at, speed, shape;
  if (damped) speed = five_of(gauss, lane, u);
  if (damped >= DAMPED_AT_SHAPE) shape = load_five(patch->damped->at[point], lane);
  if (damped == MOVED_FROM_SHAPE) at = moved(&shape, &speed, h);
  else at = five_of(gauss, lane, x);
  Five force = elastic_forces(patch, by, gauss, lane, &at);
  if (damped) add_viscous(by, patch->viscous, gauss, lane, damped == DAMPED_AT_Q ? &at : &shape, &speed, &force);
  return force;
}

SPORE_INLINE void add_forces(const SporePatch *patch, const double *q, const double *v, double h, int damped,
                             double *f) {
  Material by = material_of(patch);
  double pulls[FUNCTIONS][3 * SPORE_LANES];
  for (size_t group = 0; group < patch->group_count; group++) {
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[FUNCTIONS], u[FUNCTIONS], sum[FUNCTIONS] = {0};
      if (damped != MOVED_FROM_SHAPE) gather(patch, group, lane, q, x);
      if (damped) gather(patch, group, lane, v, u);
      for (size_t point = group * POINTS; point < (group + 1) * POINTS; point++) {
        Five force = point_forces(patch, by, point, lane, x, u, h, damped);
        subtract_forces(patch->gauss + point, lane, &force, sum);
      }
      for (int k = 0; k < FUNCTIONS; k++) spore_vd3_store(pulls[k] + 3 * lane, sum[k]);
    }
    for (size_t k = 0; k < FUNCTIONS; k++) {
      const uint32_t *node = patch->node + (group * FUNCTIONS + k) * SPORE_LANES;
      for (size_t i = 0; i < cells_of(patch, group); i++)
        for (size_t c = 0; c < 3; c++) f[3 * (size_t)node[i] + c] += pulls[k][3 * i + c];
    }
  }
}

void SPORE_LEVEL_NAME(spore_patch_force)(const SporePatch *patch, const double *q, const double *shape, const double *v,
                                         double h, double *f) {
  assert(f != q && f != v);
  assert(h >= 0);
  bool damped = patch->viscous > 0;
  if (damped && shape != q) damp_along(patch, shape);
  if (!damped) add_forces(patch, q, v, 0, ELASTIC, f);
  else if (shape == q) add_forces(patch, q, v, 0, DAMPED_AT_Q, f);
  else if (h > 0) add_forces(patch, q, v, h, MOVED_FROM_SHAPE, f);
  else add_forces(patch, q, v, 0, DAMPED_AT_SHAPE, f);
}

double SPORE_LEVEL_NAME(spore_patch_potential)(const SporePatch *patch, const double *q) {
  Material by = material_of(patch);
  double lanes[SPORE_LANES] = {0};
  for (size_t group = 0; group < patch->group_count; group++)
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[FUNCTIONS], bend[3], moment[3];
      SporeVd sum = spore_vd_load(lanes + lane);
      gather(patch, group, lane, q, x);
      for (size_t point = 0; point < POINTS; point++) {
        const SporePatchGauss *gauss = patch->gauss + group * POINTS + point;
        SporeVd area = spore_vd_load(gauss->area + lane);
        Five at = five_of(gauss, lane, x);
        Plane e = strain_of(&at), stress = stress_of(by, by.membrane * area, e);
        bends_of(gauss, lane, &at, patch->curved, bend);
        moments_of(by, by.bending * area, bend, moment);
        sum += stress.m[0] * e.m[0] + stress.m[1] * e.m[1] + 2 * stress.m[2] * e.m[2];
        for (int k = 0; k < 3; k++) sum += spore_vd3_dot(moment[k], bend[k]);
      }
      spore_vd_store(lanes + lane, sum);
    }
  return 0.5 * spore_lanes_sum(lanes);
}

/* Second derivatives by a1 and a2, and (of a curved sheet) by a_i and the sum h of bent[j] x_j; and what a viscous
 * sheet adds that is of rank three: rates of bending, each by a function's three numbers. */
typedef struct Stiffness {
  SporeVd33 a11, a22, a12;
  SporeVd3 by_bent[2]; /* the derivative by a_i and h is this x */
  SporeVd3 normal, tilt[3][2];
  SporeVd bending;
} Stiffness;

SPORE_INLINE void add_all(SporeVd33 *m, SporeVd all) { m->m[0] += all, m->m[4] += all, m->m[8] += all; }

SPORE_INLINE void add_scaled_outer(SporeVd33 *m, SporeVd by, SporeVd3 a, SporeVd3 b) {
  spore_vd33_add_outer(m, spore_vd3_scale(by, a), b);
}

/* Of strains: their rates squared. */
SPORE_INLINE void add_membrane(Material by, SporeVd scale, const Five *at, Stiffness *stiffness) {
  SporeVd3 one = at->a[0], two = at->a[1];
  SporeVd shear = 0.5 * (1 - by.poisson) * scale;
  add_scaled_outer(&stiffness->a11, scale, one, one);
  add_scaled_outer(&stiffness->a11, shear, two, two);
  add_scaled_outer(&stiffness->a22, scale, two, two);
  add_scaled_outer(&stiffness->a22, shear, one, one);
  add_scaled_outer(&stiffness->a12, by.poisson * scale, one, two);
  add_scaled_outer(&stiffness->a12, shear, two, one);
}

/* The part without negative eigenvalues; *limit: root of the product of what is left of them. */
SPORE_INLINE Plane without_negative(Plane s, SporeVd *limit) {
  SporeVd zero = {0}, mean = 0.5 * (s.m[0] + s.m[1]), half = 0.5 * (s.m[0] - s.m[1]);
  SporeVd root = spore_vd_sqrt(half * half + s.m[2] * s.m[2]);
  SporeVd high = mean + root, most = spore_vd_max(high, zero), least = spore_vd_max(mean - root, zero);
  SporeVd share = spore_vd_select(root > TINY, (most - least) / spore_vd_max(2 * root, spore_vd_all(TINY)), zero);
  *limit = spore_vd_sqrt(most * least);
  return (Plane){{most + share * (s.m[0] - high), most + share * (s.m[1] - high), share * s.m[2]}};
}

/* Of the stress as the sheet turns, and of how the normal turns against the moment, of which as much stays as keeps
 * the sum from being indefinite, unless it is to be whole: its eigenvalues are those of the stress, and between two of
 * them +-|moment|. */
SPORE_INLINE void add_geometric(Plane stress, SporeVd3 moment, bool whole, Stiffness *stiffness) {
  SporeVd limit, length = spore_vd_sqrt(spore_vd3_dot(moment, moment));
  Plane tension = without_negative(stress, &limit);
  if (whole) tension = stress, limit = length;
  add_all(&stiffness->a11, tension.m[0]);
  add_all(&stiffness->a22, tension.m[1]);
  add_all(&stiffness->a12, tension.m[2]);
  SporeVd share = spore_vd_min(limit / spore_vd_max(length, spore_vd_all(TINY)), spore_vd_all(1));
  SporeVd3 kept = spore_vd3_scale(share, moment);
  stiffness->a12.m[1] -= kept.z, stiffness->a12.m[2] += kept.y, stiffness->a12.m[3] += kept.z;
  stiffness->a12.m[5] -= kept.x, stiffness->a12.m[6] -= kept.y, stiffness->a12.m[7] += kept.x;
}

/* Of a curved sheet, whose bends follow the normal: the square of the normal's change, and that times b's. */
SPORE_INLINE void add_normal(Material by, SporeVd scale, const SporePatchGauss *gauss, size_t lane, const Five *at,
                             Stiffness *stiffness) {
  SporeVd c[3], square;
  for (int k = 0; k < 3; k++) c[k] = spore_vd_load(gauss->curvature[k] + lane);
  square = scale * (c[0] * c[0] + c[1] * c[1] + 2 * by.poisson * c[0] * c[1] + 2 * (1 - by.poisson) * c[2] * c[2]);
  SporeVd3 one = at->a[0], two = at->a[1];
  add_all(&stiffness->a11, square * spore_vd3_dot(two, two));
  add_scaled_outer(&stiffness->a11, -square, two, two);
  add_all(&stiffness->a22, square * spore_vd3_dot(one, one));
  add_scaled_outer(&stiffness->a22, -square, one, one);
  add_all(&stiffness->a12, -square * spore_vd3_dot(one, two));
  add_scaled_outer(&stiffness->a12, square, one, two);
  stiffness->by_bent[0] = spore_vd3_scale(-scale, two);
  stiffness->by_bent[1] = spore_vd3_scale(scale, one);
}

SPORE_INLINE void add_elastic(const SporePatch *patch, Material by, double scale, const SporePatchGauss *gauss,
                              size_t lane, const Five *at, bool whole, Stiffness *stiffness) {
  SporeVd area = scale * spore_vd_load(gauss->area + lane);
  SporeVd3 moment = {0}, bend[3], moments[3];
  add_membrane(by, by.membrane * area, at, stiffness);
  if (patch->curved) {
    bends_of(gauss, lane, at, true, bend);
    moments_of(by, by.bending * area, bend, moments);
    moment = normal_moment(gauss, lane, moments);
    add_normal(by, by.bending * area, gauss, lane, at, stiffness);
  }
  add_geometric(stress_of(by, by.membrane * area, strain_of(at)), moment, whole, stiffness);
}

SPORE_INLINE void add_viscosity(Material by, double scale, const SporePatchGauss *gauss, size_t lane, const Five *at,
                                Stiffness *stiffness) {
  SporeVd area = scale * spore_vd_load(gauss->area + lane);
  add_membrane(by, by.membrane * area, at, stiffness);
  stiffness->normal = spore_vd3_cross(at->a[0], at->a[1]);
  stiffness->bending = by.bending * area;
  for (int k = 0; k < 3; k++) tilt_of(at, k, stiffness->tilt[k]);
}

/* The rates of bending by a function. */
SPORE_INLINE void rates_of(const SporePatchGauss *gauss, size_t lane, int i, const Stiffness *stiffness,
                           SporeVd3 rate[3]) {
  SporeVd first[2];
  for (int e = 0; e < 2; e++) first[e] = spore_vd_load(gauss->first[e][i] + lane);
  for (int k = 0; k < 3; k++) {
    rate[k] = spore_vd3_scale(spore_vd_load(gauss->second[k][i] + lane), stiffness->normal);
    for (int e = 0; e < 2; e++) rate[k] = spore_vd3_add(rate[k], spore_vd3_scale(first[e], stiffness->tilt[k][e]));
  }
}

/* The derivatives by function j of the forces on a1, a2 and h. */
typedef struct Column {
  SporeVd33 a[2], bent;
} Column;

/* m += s [x], the matrix of the cross product. */
SPORE_INLINE void add_skew(SporeVd33 *m, SporeVd s, SporeVd3 x) {
  m->m[1] -= s * x.z, m->m[2] += s * x.y, m->m[3] += s * x.z;
  m->m[5] -= s * x.x, m->m[6] -= s * x.y, m->m[7] += s * x.x;
}

SPORE_INLINE Column column_of(const SporePatchGauss *gauss, size_t lane, int j, const Stiffness *stiffness,
                              bool curved) {
  SporeVd one = spore_vd_load(gauss->first[0][j] + lane), two = spore_vd_load(gauss->first[1][j] + lane);
  Column column = {0};
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      int e = 3 * r + c;
      column.a[0].m[e] = one * stiffness->a11.m[e] + two * stiffness->a12.m[e];
      column.a[1].m[e] = one * stiffness->a12.m[3 * c + r] + two * stiffness->a22.m[e];
    }
  if (!curved) return column;
  SporeVd bent = spore_vd_load(gauss->bent[j] + lane);
  for (int k = 0; k < 2; k++) add_skew(&column.a[k], bent, stiffness->by_bent[k]);
  add_skew(&column.bent, -one, stiffness->by_bent[0]);
  add_skew(&column.bent, -two, stiffness->by_bent[1]);
  return column;
}

SPORE_INLINE void add_column(const SporePatchGauss *gauss, size_t lane, int i, const Column *column, bool curved,
                             SporeVd33 *block) {
  SporeVd one = spore_vd_load(gauss->first[0][i] + lane), two = spore_vd_load(gauss->first[1][i] + lane);
  SPORE_UNROLL for (int e = 0; e < 9; e++) block->m[e] += one * column->a[0].m[e] + two * column->a[1].m[e];
  if (!curved) return;
  SporeVd bent = spore_vd_load(gauss->bent[i] + lane);
  SPORE_UNROLL for (int e = 0; e < 9; e++) block->m[e] += bent * column->bent.m[e];
}

/* Blocks of a part of a group, row by row as spore_block_add_rows takes them. */
typedef double Rows[3][4 * SPORE_WIDTH];

SPORE_INLINE void add_blocks(const SporePatch *patch, size_t group, size_t lane, Rows *rows, SporeBlockMatrix *matrix) {
  size_t cells = cells_of(patch, group);
  for (size_t part = 0; part < SPORE_WIDTH && lane + part < cells; part++) {
    size_t cell = group * SPORE_LANES + lane + part;
    for (int pair = 0; pair < PAIRS; pair++) {
      uint32_t upper = patch->upper[cell][pair], lower = patch->lower[cell][pair];
      spore_block_add_rows(matrix->values + 9 * (size_t)upper, rows[pair], part);
      double *turned = matrix->values + 9 * (size_t)lower;
      for (int r = 0; upper != lower && r < 3; r++)
        for (int c = 0; c < 3; c++) turned[3 * c + r] += rows[pair][r][4 * part + (size_t)c];
    }
  }
}

/* The stiffness of a part of a group at its Gauss points, with the rates of bending of each function and their moments
 * where it is viscous. */
typedef struct Part {
  Stiffness stiffness[POINTS];
  SporeVd3 rate[POINTS][FUNCTIONS][3];
} Part;

SPORE_INLINE SporeVd33 block_of(const SporePatch *patch, Material by, const SporePatchGauss *gauss, size_t lane, int i,
                                const Part *part, const Column column[POINTS], SporeVd3 moment[POINTS][3], bool drags) {
  SporeVd33 block = {0};
  for (int point = 0; point < POINTS; point++) {
    add_column(gauss + point, lane, i, &column[point], patch->curved, &block);
    for (int k = 0; drags && k < 3; k++) spore_vd33_add_outer(&block, part->rate[point][i][k], moment[point][k]);
  }
  return block;
}

/* Blocks (i, j), i <= j, of the part, in rows. */
SPORE_INLINE void make_blocks(const SporePatch *patch, Material by, size_t group, size_t lane, const Part *part,
                              double scale, bool drags, Rows *rows) {
  const SporePatchGauss *gauss = patch->gauss + group * POINTS;
  for (int j = 0; j < FUNCTIONS; j++) {
    Column column[POINTS];
    SporeVd3 moment[POINTS][3];
    for (int point = 0; point < POINTS; point++) {
      const Stiffness *stiffness = &part->stiffness[point];
      column[point] = column_of(gauss + point, lane, j, stiffness, patch->curved);
      if (drags) moments_of(by, stiffness->bending, part->rate[point][j], moment[point]);
    }
    for (int i = 0, pair = j; i <= j; i++, pair += FUNCTIONS - i) {
      SporeVd33 block = block_of(patch, by, gauss, lane, i, part, column, moment, drags);
      add_all(&block, scale * by.bending * spore_vd_load(patch->flat[group * PAIRS + (size_t)pair] + lane));
      for (int r = 0; r < 3; r++) spore_vd3_store_rows(rows[pair][r], spore_vd33_row(&block, r));
    }
  }
}

void SPORE_LEVEL_NAME(spore_patch_jacobian)(const SporePatch *patch, const SporeTangent *tangent,
                                            SporeBlockMatrix *matrix) {
  assert(tangent->stiffness_scale >= 0);
  assert(matrix->values);
  Material by = material_of(patch);
  double viscous = tangent->damping_scale * patch->viscous, scale = tangent->stiffness_scale;
  Rows rows[PAIRS];
  if (viscous > 0) damp_along(patch, tangent->shape);
  for (size_t group = 0; group < patch->group_count; group++)
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[FUNCTIONS];
      Part part;
      gather(patch, group, lane, tangent->q, x);
      for (int point = 0; point < POINTS; point++) {
        const SporePatchGauss *gauss = patch->gauss + group * POINTS + point;
        Stiffness *stiffness = &part.stiffness[point];
        *stiffness = (Stiffness){0};
        Five at = five_of(gauss, lane, x);
        add_elastic(patch, by, scale, gauss, lane, &at, tangent->whole, stiffness);
        if (!(viscous > 0)) continue;
        at = load_five(patch->damped->at[group * POINTS + (size_t)point], lane);
        add_viscosity(by, viscous, gauss, lane, &at, stiffness);
        for (int i = 0; i < FUNCTIONS; i++) rates_of(gauss, lane, i, stiffness, part.rate[point][i]);
      }
      make_blocks(patch, by, group, lane, &part, scale, viscous > 0, rows);
      add_blocks(patch, group, lane, rows, matrix);
    }
}
