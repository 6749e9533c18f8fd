#include "models/corotation.h"

#include <math.h>
#include <stdbool.h>

#define LANES SPORE_LANES
typedef double Lanes[LANES];

/* Where the polar decomposition by iteration would be slow or go to a reflection: det F against (|F|^2 / 3)^(3/2). */
#define NEARLY_FLAT 0.05
#define ITERATIONS 20

static void gather(const SporeTetrahedronBatch *batch, const double *x, Lanes edge[9]) {
  for (int i = 0; i < LANES; i++) {
    const double *origin = x + 3 * (size_t)batch->node[0][i];
    for (int k = 0; k < 3; k++) {
      const double *corner = x + 3 * (size_t)batch->node[k + 1][i];
      for (int axis = 0; axis < 3; axis++) edge[3 * axis + k][i] = corner[axis] - origin[axis];
    }
  }
}

/* c = a b */
static void multiply(const Lanes a[restrict 9], const Lanes b[restrict 9], Lanes c[restrict 9]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      for (int i = 0; i < LANES; i++)
        c[3 * row + column][i] =
            a[3 * row][i] * b[column][i] + a[3 * row + 1][i] * b[3 + column][i] + a[3 * row + 2][i] * b[6 + column][i];
}

static void cofactor(const Lanes a[restrict 9], Lanes c[restrict 9], double determinant[restrict LANES]) {
  for (int row = 0; row < 3; row++) {
    int r1 = 3 * ((row + 1) % 3), r2 = 3 * ((row + 2) % 3);
    for (int column = 0; column < 3; column++) {
      int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
      for (int i = 0; i < LANES; i++)
        c[3 * row + column][i] = a[r1 + c1][i] * a[r2 + c2][i] - a[r1 + c2][i] * a[r2 + c1][i];
    }
  }
  for (int i = 0; i < LANES; i++) determinant[i] = a[0][i] * c[0][i] + a[1][i] * c[1][i] + a[2][i] * c[2][i];
}

/* Lanes that the iteration must not touch are taken out: they iterate on the identity. */
static void set_aside(const Lanes f[9], size_t count, Lanes r[9], bool aside[LANES]) {
  Lanes c[9], determinant;
  cofactor(f, c, determinant);
  for (int i = 0; i < LANES; i++) {
    double square = 0;
    for (int k = 0; k < 9; k++) square += f[k][i] * f[k][i];
    bool good = determinant[i] > NEARLY_FLAT * (square / 3) * sqrt(square / 3) && square < 1e100 && square > 1e-100;
    aside[i] = !good || (size_t)i >= count;
    for (int k = 0; k < 9; k++) r[k][i] = aside[i] ? k % 4 == 0 : f[k][i] / sqrt(square / 3);
  }
}

/* R of F = R S by Newton's iteration X <- (X + X^-T) / 2 (Higham 1986), quadratic from any F with positive
 * determinant; what it cannot do goes to the general decomposition. */
static void polar(const Lanes f[9], size_t count, Lanes r[9]) {
  bool aside[LANES];
  set_aside(f, count, r, aside);
  for (int iteration = 0; iteration < ITERATIONS; iteration++) {
    Lanes c[9], determinant, change = {0};
    cofactor(r, c, determinant);
    for (int i = 0; i < LANES; i++) determinant[i] = 0.5 / determinant[i];
    for (int k = 0; k < 9; k++)
      for (int i = 0; i < LANES; i++) {
        double next = 0.5 * r[k][i] + c[k][i] * determinant[i];
        change[i] += (next - r[k][i]) * (next - r[k][i]);
        r[k][i] = next;
      }
    double greatest = 0;
    for (int i = 0; i < LANES; i++) greatest = fmax(greatest, change[i]);
    if (greatest < 1e-17) break; /* the error after this round is its square */
  }
  for (int i = 0; i < LANES; i++) {
    if (!aside[i] || (size_t)i >= count) continue;
    SporeMat3 gradient, rotation, stretch;
    for (int k = 0; k < 9; k++) gradient.m[k] = f[k][i];
    spore_mat3_polar(gradient, &rotation, &stretch);
    for (int k = 0; k < 9; k++) r[k][i] = rotation.m[k];
  }
}

/* P += eta F (2 mu E' + lambda tr E' I) */
static void add_viscous(const SporeTetrahedronBatch *batch, SporeElasticity elasticity, const Lanes f[9],
                        const double *v, Lanes stress[9]) {
  Lanes edge[9], rate[9], strain[9], viscous[9];
  gather(batch, v, edge);
  multiply(edge, batch->inverse, rate);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      for (int i = 0; i < LANES; i++) {
        double ab =
            f[row][i] * rate[column][i] + f[3 + row][i] * rate[3 + column][i] + f[6 + row][i] * rate[6 + column][i];
        double ba =
            f[column][i] * rate[row][i] + f[3 + column][i] * rate[3 + row][i] + f[6 + column][i] * rate[6 + row][i];
        strain[3 * row + column][i] = elasticity.viscosity * elasticity.mu * (ab + ba);
      }
  /* The diagonal holds 2 mu E'_ii eta; tr E' lambda eta is therefore their sum times lambda / (2 mu). */
  double ratio = 0.5 * elasticity.lambda / elasticity.mu;
  for (int i = 0; i < LANES; i++) {
    double volumetric = ratio * (strain[0][i] + strain[4][i] + strain[8][i]);
    strain[0][i] += volumetric, strain[4][i] += volumetric, strain[8][i] += volumetric;
  }
  multiply(f, strain, viscous);
  for (int k = 0; k < 9; k++)
    for (int i = 0; i < LANES; i++) stress[k][i] += viscous[k][i];
}

static void elastic_stress(SporeElasticity elasticity, const Lanes f[restrict 9], const Lanes r[restrict 9],
                           Lanes stress[restrict 9]) {
  Lanes factor; /* lambda (tr S - 3) - 2 mu, with tr S = R : F */
  for (int i = 0; i < LANES; i++) factor[i] = -3;
  for (int k = 0; k < 9; k++)
    for (int i = 0; i < LANES; i++) factor[i] += r[k][i] * f[k][i];
  for (int i = 0; i < LANES; i++) factor[i] = elasticity.lambda * factor[i] - 2 * elasticity.mu;
  for (int k = 0; k < 9; k++)
    for (int i = 0; i < LANES; i++) stress[k][i] = 2 * elasticity.mu * f[k][i] + factor[i] * r[k][i];
}

void spore_corotation_force(const SporeTetrahedronBatch *batch, size_t count, SporeElasticity elasticity,
                            const double *q, const double *v, double *f) {
  Lanes edge[9], gradient[9], rotation[9], stress[9], pull[9];
  gather(batch, q, edge);
  multiply(edge, batch->inverse, gradient);
  polar(gradient, count, rotation);
  elastic_stress(elasticity, gradient, rotation, stress);
  if (elasticity.viscosity > 0) add_viscous(batch, elasticity, gradient, v, stress);
  for (int axis = 0; axis < 3; axis++)
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < LANES; i++)
        pull[3 * axis + k][i] = -batch->volume[i] * (stress[3 * axis][i] * batch->inverse[3 * k][i] +
                                                     stress[3 * axis + 1][i] * batch->inverse[3 * k + 1][i] +
                                                     stress[3 * axis + 2][i] * batch->inverse[3 * k + 2][i]);
  for (size_t i = 0; i < count; i++) {
    double *origin = f + 3 * (size_t)batch->node[0][i];
    for (int k = 0; k < 3; k++) {
      double *corner = f + 3 * (size_t)batch->node[k + 1][i];
      for (int axis = 0; axis < 3; axis++) {
        corner[axis] += pull[3 * axis + k][i];
        origin[axis] -= pull[3 * axis + k][i];
      }
    }
  }
}

static SporeMat3 gradient_of(const SporeTetrahedronBatch *batch, size_t lane, const double *q, SporeMat3 *inverse) {
  SporeMat3 edge;
  const double *origin = q + 3 * (size_t)batch->node[0][lane];
  for (int k = 0; k < 3; k++) {
    const double *corner = q + 3 * (size_t)batch->node[k + 1][lane];
    for (int axis = 0; axis < 3; axis++) edge.m[3 * axis + k] = corner[axis] - origin[axis];
  }
  for (int k = 0; k < 9; k++) inverse->m[k] = batch->inverse[k][lane];
  return spore_mat3_multiply(edge, *inverse);
}

double spore_corotation_potential(const SporeTetrahedronBatch *batch, size_t lane, SporeElasticity elasticity,
                                  const double *q) {
  SporeMat3 inverse, rotation, stretch, f = gradient_of(batch, lane, q, &inverse);
  spore_mat3_polar(f, &rotation, &stretch);
  double square = 0, volumetric = spore_mat3_trace(stretch) - 3;
  for (int k = 0; k < 9; k++) square += (f.m[k] - rotation.m[k]) * (f.m[k] - rotation.m[k]);
  return batch->volume[lane] * (elasticity.mu * square + 0.5 * elasticity.lambda * volumetric * volumetric);
}

/* The stiffness of F is 2 mu I + lambda vec(R) vec(R)^T + sum over the three twists of c_k vec(Q_k) vec(Q_k)^T, where
 * Q_k = R [s_k]x / sqrt 2, s_k an eigenvector of S, and c_k = (lambda (tr S - 3) - 2 mu) 2 / (the other two stretches).
 * 2 mu + c_k is the eigenvalue of that twist; it is clamped to be no less than 0. */
typedef struct Twists {
  SporeMat3 rotation;
  SporeVec3 axis[3];
  double coefficient[3];
} Twists;

static Twists twists_of(SporeMat3 f, SporeElasticity elasticity) {
  Twists twists;
  SporeMat3 stretch, axes;
  double value[3];
  spore_mat3_polar(f, &twists.rotation, &stretch);
  spore_mat3_eigen_symmetric(stretch, value, &axes);
  double factor = elasticity.lambda * (value[0] + value[1] + value[2] - 3) - 2 * elasticity.mu;
  for (int k = 0; k < 3; k++) {
    double others = fmax(value[(k + 1) % 3] + value[(k + 2) % 3], 1e-6);
    twists.axis[k] = spore_mat3_column(axes, k);
    twists.coefficient[k] = fmax(2 * factor / others, -2 * elasticity.mu);
  }
  return twists;
}

static void add_block(double block[9], double scale, SporeMat3 a) {
  for (int k = 0; k < 9; k++) block[k] += scale * a.m[k];
}

/* Gradients of the four corners' weights. */
static void corner_gradients(SporeMat3 inverse, SporeVec3 gradient[4]) {
  gradient[0] = (SporeVec3){0, 0, 0};
  for (int k = 0; k < 3; k++) {
    gradient[k + 1] = spore_vec3_load(inverse.m + 3 * k);
    gradient[0] = spore_vec3_sub(gradient[0], gradient[k + 1]);
  }
}

static void add_stiffness(const Twists *twists, SporeElasticity elasticity, double scale, const SporeVec3 gradient[4],
                          double blocks[10][9]) {
  SporeVec3 along[4], twisted[3][4];
  for (int a = 0; a < 4; a++) {
    along[a] = spore_mat3_apply(twists->rotation, gradient[a]);
    for (int k = 0; k < 3; k++)
      twisted[k][a] = spore_mat3_apply(twists->rotation, spore_vec3_cross(twists->axis[k], gradient[a]));
  }
  for (int a = 0, n = 0; a < 4; a++)
    for (int b = a; b < 4; b++, n++) {
      double same = scale * 2 * elasticity.mu * spore_vec3_dot(gradient[a], gradient[b]);
      add_block(blocks[n], same, spore_mat3_identity());
      add_block(blocks[n], scale * elasticity.lambda, spore_mat3_outer(along[a], along[b]));
      for (int k = 0; k < 3; k++)
        add_block(blocks[n], scale * 0.5 * twists->coefficient[k], spore_mat3_outer(twisted[k][a], twisted[k][b]));
    }
}

/* -df/dv of the viscous force between corners a and b, with F b_a the carried gradients:
 * V eta (mu (b_a . b_b) F F^T + mu (F b_b)(F b_a)^T + lambda (F b_a)(F b_b)^T) */
static void add_viscosity(SporeMat3 f, SporeElasticity elasticity, double scale, const SporeVec3 gradient[4],
                          double blocks[10][9]) {
  SporeMat3 square = spore_mat3_multiply(f, spore_mat3_transpose(f));
  SporeVec3 carried[4];
  for (int a = 0; a < 4; a++) carried[a] = spore_mat3_apply(f, gradient[a]);
  for (int a = 0, n = 0; a < 4; a++)
    for (int b = a; b < 4; b++, n++) {
      add_block(blocks[n], scale * elasticity.mu * spore_vec3_dot(gradient[a], gradient[b]), square);
      add_block(blocks[n], scale * elasticity.mu, spore_mat3_outer(carried[b], carried[a]));
      add_block(blocks[n], scale * elasticity.lambda, spore_mat3_outer(carried[a], carried[b]));
    }
}

void spore_corotation_jacobian(const SporeTetrahedronBatch *batch, size_t lane, SporeElasticity elasticity,
                               const double *q, double stiffness_scale, double damping_scale, double blocks[10][9]) {
  SporeMat3 inverse, f = gradient_of(batch, lane, q, &inverse);
  SporeVec3 gradient[4];
  double volume = batch->volume[lane], viscous = damping_scale * elasticity.viscosity * volume;
  corner_gradients(inverse, gradient);
  for (int n = 0; n < 10; n++)
    for (int k = 0; k < 9; k++) blocks[n][k] = 0;
  if (stiffness_scale != 0) {
    Twists twists = twists_of(f, elasticity);
    add_stiffness(&twists, elasticity, stiffness_scale * volume, gradient, blocks);
  }
  if (viscous != 0) add_viscosity(f, elasticity, viscous, gradient, blocks);
}
