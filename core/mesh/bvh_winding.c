/* Winding numbers. */
#include <math.h>

#include "core/mesh/bvh_node.h"

/* A sum of angles, kept as a product of complex numbers of about unit length and a number of full turns. A query then
 * needs only one atan2. */
typedef struct Angle {
  double real, imaginary;
  int turns;
} Angle;

static void angle_add(Angle *angle, double real, double imaginary) {
  double size = fabs(real) + fabs(imaginary);
  if (!(size > 0)) return; /* p lies on an edge or a corner: the angle is not defined */
  real /= size;
  imaginary /= size;
  double r = angle->real * real - angle->imaginary * imaginary, i = angle->real * imaginary + angle->imaginary * real;
  if (angle->imaginary > 0 && imaginary > 0) angle->turns += i < 0;
  else if (angle->imaginary < 0 && imaginary < 0) angle->turns -= i > 0;
  double scale = 1 / (fabs(r) + fabs(i));
  angle->real = r * scale;
  angle->imaginary = i * scale;
}

/* Half the solid angle of the triangle seen from p is that of the complex number (van Oosterom and Strackee 1983). */
static void add_triangle(Angle *angle, SporeVec3 p, const double *corners) {
  SporeVec3 a = spore_vec3_sub(spore_vec3_load(corners), p), b = spore_vec3_sub(spore_vec3_load(corners + 3), p),
            c = spore_vec3_sub(spore_vec3_load(corners + 6), p);
  double la = spore_vec3_length(a), lb = spore_vec3_length(b), lc = spore_vec3_length(c);
  angle_add(angle, la * lb * lc + spore_vec3_dot(a, b) * lc + spore_vec3_dot(b, c) * la + spore_vec3_dot(c, a) * lb,
            spore_vec3_dot(a, spore_vec3_cross(b, c)));
}

/* Integral of x.n/|x|^3 over a far cluster: expansion about its centre to the first order, r = centre - p. */
static double far_field(const SporeBvhMoment *m, SporeVec3 r, double r2) {
  const double *f = m->first;
  double inverse2 = 1 / r2, inverse3 = inverse2 / sqrt(r2);
  double trace = f[0] + f[4] + f[8];
  double quadratic = r.x * (f[0] * r.x + f[1] * r.y + f[2] * r.z) + r.y * (f[3] * r.x + f[4] * r.y + f[5] * r.z) +
                     r.z * (f[6] * r.x + f[7] * r.y + f[8] * r.z);
  return inverse3 * (spore_vec3_dot(r, m->dipole) + trace - 3 * quadratic * inverse2);
}

double spore_bvh_winding(const SporeBvh *bvh, SporeVec3 p) {
  uint32_t stack[SPORE_BVH_DEPTH];
  int waiting = 0;
  Angle angle = {1, 0, 0};
  double far = 0;
  stack[waiting++] = 0;
  while (waiting) {
    uint32_t index = stack[--waiting];
    const SporeBvhMoment *m = bvh->moments + index;
    SporeVec3 r = spore_vec3_sub(m->centre, p);
    double r2 = spore_vec3_dot(r, r);
    if (r2 > m->far_squared) {
      far += far_field(m, r, r2);
      continue;
    }
    const SporeBvhNode *node = bvh->nodes + index;
    for (uint32_t i = node->first; i < node->first + node->count; i++)
      add_triangle(&angle, p, bvh->corners + 9 * (size_t)i);
    if (node->count) continue;
    stack[waiting++] = node->first;
    stack[waiting++] = index + 1;
  }
  double near = 2 * (atan2(angle.imaginary, angle.real) + 2 * M_PI * angle.turns);
  return (near + far) / (4 * M_PI);
}
