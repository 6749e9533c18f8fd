#include "models/corotation.h"

#include "core/math/mat3.h"
#include "models/block_rows.h"

/* 3x3 matrices, one a lane, row-major. */
typedef struct Matrix {
  SporeVd m[9];
} Matrix;

#define UNROLL _Pragma("GCC unroll 9")

SPORE_INLINE Matrix multiply(const Matrix *a, const Matrix *b) {
  Matrix c;
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = 0; j < 3; j++) c.m[3 * i + j] =
      a->m[3 * i] * b->m[j] + a->m[3 * i + 1] * b->m[3 + j] + a->m[3 * i + 2] * b->m[6 + j];
  return c;
}

SPORE_INLINE Matrix cofactor(const Matrix *a) {
  Matrix c;
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = 0; j < 3; j++) {
    int r1 = 3 * ((i + 1) % 3), r2 = 3 * ((i + 2) % 3), c1 = (j + 1) % 3, c2 = (j + 2) % 3;
    c.m[3 * i + j] = a->m[r1 + c1] * a->m[r2 + c2] - a->m[r1 + c2] * a->m[r2 + c1];
  }
  return c;
}

SPORE_INLINE SporeVd product(const Matrix *a, const Matrix *b) { /* a : b */
  SporeVd rows[3];
  UNROLL for (int i = 0; i < 3; i++) rows[i] =
      a->m[3 * i] * b->m[3 * i] + a->m[3 * i + 1] * b->m[3 * i + 1] + a->m[3 * i + 2] * b->m[3 * i + 2];
  return rows[0] + rows[1] + rows[2];
}

/* A part of a batch as wide as the instruction set. */
typedef struct Part {
  const SporeTetrahedronBatch *batch;
  size_t index, lane; /* of the batch; the part's first in it */
  Matrix inverse;
  SporeVd volume;
} Part;

SPORE_INLINE Part part_of(const SporeTetrahedra *tetrahedra, size_t batch, size_t lane) {
  Part part = {.batch = tetrahedra->batches + batch, .index = batch, .lane = lane};
  UNROLL for (int k = 0; k < 9; k++) part.inverse.m[k] = spore_vd_load(part.batch->inverse[k] + lane);
  part.volume = spore_vd_load(part.batch->volume + lane);
  return part;
}

/* (x1 - x0, x2 - x0, x3 - x0) Dm^-1: F of positions, its rate of velocities. */
SPORE_INLINE Matrix gradient_of(const Part *part, const double *x) {
  SporeVd3 origin = spore_vd3_gather(x, part->batch->node[0] + part->lane);
  Matrix edges;
  UNROLL for (int k = 0; k < 3; k++) {
    SporeVd3 edge = spore_vd3_sub(spore_vd3_gather(x, part->batch->node[k + 1] + part->lane), origin);
    edges.m[k] = edge.x, edges.m[3 + k] = edge.y, edges.m[6 + k] = edge.z;
  }
  return multiply(&edges, &part->inverse);
}

typedef struct Rotation {
  Matrix r;
  SporeVd sum; /* of stretches, tr S */
} Rotation;

/* By the general decomposition, where stretches are so near to being opposite that the closed form has too few digits
 * left, or so far from 1 that it would overflow. */
static __attribute__((noinline)) void rotate_one_by_one(const Matrix *f, SporeVl lanes, Rotation *rotation) {
  for (int i = 0; i < SPORE_WIDTH; i++) {
    if (!lanes[i]) continue;
    SporeMat3 gradient, r, s;
    for (int k = 0; k < 9; k++) gradient.m[k] = f->m[k][i];
    spore_mat3_polar(gradient, &r, &s);
    for (int k = 0; k < 9; k++) rotation->r.m[k][i] = r.m[k];
    rotation->sum[i] = spore_mat3_trace(s);
  }
}

/* What the greatest root depends on: invariants of F^T F, and det F. */
typedef struct Invariants {
  SporeVd first, second, determinant;
} Invariants;

SPORE_INLINE Invariants invariants_of(const Matrix *f, const Matrix *c) {
  return (Invariants){product(f, f), product(c, c), f->m[0] * c->m[0] + f->m[1] * c->m[1] + f->m[2] * c->m[2]};
}

/* Parts whose roots are sought together: each round waits long for its own result, and not for the others'. */
#define TOGETHER 4

/* The greatest roots, by Newton's method from the right, where it is monotonous: no root is greater than (3 I)^1/2. A
 * lane that is done stays as it is, whatever its neighbours need. */
SPORE_INLINE void greatest_roots(const Invariants of[TOGETHER], SporeVd sum[TOGETHER], SporeVl failed[TOGETHER]) {
  UNROLL for (int n = 0; n < TOGETHER; n++) {
    sum[n] = spore_vd_sqrt(3 * of[n].first);
    failed[n] = (SporeVl){0} - 1;
  }
  SporeVl going = failed[0];
  for (int round = 0; round < 16 && spore_vl_any(going); round++) {
    going = (SporeVl){0};
    UNROLL for (int n = 0; n < TOGETHER; n++) {
      SporeVd twice = sum[n] * sum[n] - of[n].first;
      SporeVd value = twice * twice - (8 * of[n].determinant * sum[n] + 4 * of[n].second);
      SporeVd change = value / (4 * sum[n] * twice - 8 * of[n].determinant);
      sum[n] = spore_vd_select(failed[n], sum[n] - change, sum[n]);
      failed[n] &= spore_vd_abs(change) > 1e-9 * sum[n]; /* the error after this round is its square */
      going |= failed[n];
    }
  }
}

/* Some parts with their F, and what of the rotations takes longest. */
typedef struct Chunk {
  size_t count;
  Matrix gradient[TOGETHER], cofactor[TOGETHER];
  Invariants invariants[TOGETHER];
  SporeVd sum[TOGETHER];
  SporeVl failed[TOGETHER];
} Chunk;

SPORE_INLINE size_t part_count(const SporeTetrahedra *tetrahedra) {
  return tetrahedra->batch_count * (SPORE_LANES / SPORE_WIDTH);
}

SPORE_INLINE Part part_at(const SporeTetrahedra *tetrahedra, size_t index) {
  return part_of(tetrahedra, index / (SPORE_LANES / SPORE_WIDTH), index % (SPORE_LANES / SPORE_WIDTH) * SPORE_WIDTH);
}

SPORE_INLINE void begin_chunk(const SporeTetrahedra *tetrahedra, size_t first, const double *q, Chunk *chunk) {
  size_t left = part_count(tetrahedra) - first;
  chunk->count = left < TOGETHER ? left : TOGETHER;
  for (size_t n = 0; n < TOGETHER; n++) { /* behind the last part: that again */
    Part part = part_at(tetrahedra, first + (n < chunk->count ? n : chunk->count - 1));
    chunk->gradient[n] = gradient_of(&part, q);
    chunk->cofactor[n] = cofactor(&chunk->gradient[n]);
    chunk->invariants[n] = invariants_of(&chunk->gradient[n], &chunk->cofactor[n]);
  }
  greatest_roots(chunk->invariants, chunk->sum, chunk->failed);
}

/* R of F = R S from the root i: with II_S = s1 s2 + s2 s3 + s3 s1 and C = F^T F, the derivative of the quartic is
 * R = (F ((II_S + I) 1 - C) + i cof F) / (i II_S - J). */
SPORE_INLINE Rotation rotation_of(const Chunk *chunk, size_t n) {
  const Matrix *f = &chunk->gradient[n], *c = &chunk->cofactor[n];
  Invariants of = chunk->invariants[n];
  Rotation rotation = {.sum = chunk->sum[n]};
  SporeVd pairs = 0.5 * (rotation.sum * rotation.sum - of.first);
  SporeVd divisor = rotation.sum * pairs - of.determinant; /* (s1 + s2) (s2 + s3) (s3 + s1) */
  SporeVd inverse = 1 / divisor, by_cofactor = rotation.sum * inverse;
  Matrix factor;
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = i; j < 3; j++) {
    SporeVd entry = f->m[i] * f->m[j] + f->m[3 + i] * f->m[3 + j] + f->m[6 + i] * f->m[6 + j];
    factor.m[3 * i + j] = factor.m[3 * j + i] = inverse * (i == j ? pairs + of.first - entry : -entry);
  }
  rotation.r = multiply(f, &factor);
  UNROLL for (int k = 0; k < 9; k++) rotation.r.m[k] += by_cofactor * c->m[k];
  SporeVl failed = chunk->failed[n];
  failed |= ~((divisor > 0) & (divisor * divisor > 1e-6 * of.first * of.first * of.first) & (of.first > 1e-50) &
              (of.first < 1e50));
  if (__builtin_expect(spore_vl_any(failed), 0)) {
    Matrix gradient = *f;
    Rotation mended = rotation;
    rotate_one_by_one(&gradient, failed, &mended);
    rotation = mended;
  }
  return rotation;
}

/* P += eta F (2 mu E' + lambda tr E' I) */
SPORE_INLINE void add_viscous(const Part *part, SporeElasticity elasticity, const Matrix *f, const double *v,
                              Matrix *stress) {
  Matrix rate = gradient_of(part, v), strain, viscous;
  double mu = elasticity.viscosity * elasticity.mu, lambda = elasticity.viscosity * elasticity.lambda;
  SporeVd volumetric = lambda * product(f, &rate);
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = i; j < 3; j++) {
    SporeVd ab = f->m[i] * rate.m[j] + f->m[3 + i] * rate.m[3 + j] + f->m[6 + i] * rate.m[6 + j];
    SporeVd ba = f->m[j] * rate.m[i] + f->m[3 + j] * rate.m[3 + i] + f->m[6 + j] * rate.m[6 + i];
    strain.m[3 * i + j] = mu * (ab + ba);
    if (i == j) strain.m[3 * i + j] += volumetric;
    strain.m[3 * j + i] = strain.m[3 * i + j];
  }
  viscous = multiply(f, &strain);
  UNROLL for (int k = 0; k < 9; k++) stress->m[k] += viscous.m[k];
}

/* Lanes of the part that hold a tetrahedron. */
SPORE_INLINE size_t lanes_of(const SporeTetrahedra *tetrahedra, const Part *part) {
  size_t full = tetrahedra->count / tetrahedra->batch_count;
  size_t lanes = full + (part->index < tetrahedra->count % tetrahedra->batch_count);
  return lanes < part->lane ? 0 : lanes - part->lane < SPORE_WIDTH ? lanes - part->lane : SPORE_WIDTH;
}

typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));

/* f -= V P Dm^-T */
SPORE_INLINE void add_forces(const SporeTetrahedra *tetrahedra, const Part *part, const Matrix *stress, double *f) {
  double rows[4][4 * SPORE_WIDTH];
  SporeVd3 sum = {0};
  UNROLL for (int k = 0; k < 3; k++) {
    const SporeVd *b = part->inverse.m + 3 * k, *p = stress->m;
    SporeVd3 pull = {part->volume * (p[0] * b[0] + p[1] * b[1] + p[2] * b[2]),
                     part->volume * (p[3] * b[0] + p[4] * b[1] + p[5] * b[2]),
                     part->volume * (p[6] * b[0] + p[7] * b[1] + p[8] * b[2])};
    sum.x -= pull.x, sum.y -= pull.y, sum.z -= pull.z;
    spore_vd3_store_rows(rows[k + 1], pull);
  }
  spore_vd3_store_rows(rows[0], sum);
  for (size_t i = 0, lanes = lanes_of(tetrahedra, part); i < lanes; i++) UNROLL for (int a = 0; a < 4; a++) {
      double *corner = f + 3 * (size_t)part->batch->node[a][part->lane + i];
      const double *row = rows[a] + 4 * i;
      *(Two *)corner -= *(const Two *)row, corner[2] -= row[2];
    }
}

SPORE_INLINE Matrix elastic_stress(SporeElasticity elasticity, const Matrix *f, const Rotation *rotation) {
  Matrix stress;
  SporeVd factor = elasticity.lambda * (rotation->sum - 3) - 2 * elasticity.mu;
  UNROLL for (int k = 0; k < 9; k++) stress.m[k] = 2 * elasticity.mu * f->m[k] + factor * rotation->r.m[k];
  return stress;
}

void SPORE_LEVEL_NAME(spore_corotation_force)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                              const double *q, const double *shape, const double *v, double *f) {
  Chunk chunk;
  for (size_t first = 0; first < part_count(tetrahedra); first += TOGETHER) {
    begin_chunk(tetrahedra, first, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      Part part = part_at(tetrahedra, first + n);
      Matrix gradient = chunk.gradient[n];
      Rotation rotation = rotation_of(&chunk, n);
      Matrix stress = elastic_stress(elasticity, &gradient, &rotation);
      if (elasticity.viscosity > 0 && shape != q) gradient = gradient_of(&part, shape);
      if (elasticity.viscosity > 0) add_viscous(&part, elasticity, &gradient, v, &stress);
      add_forces(tetrahedra, &part, &stress, f);
    }
  }
}

double SPORE_LEVEL_NAME(spore_corotation_potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                                    const double *q) {
  double lanes[SPORE_LANES] = {0};
  Chunk chunk;
  for (size_t first = 0; first < part_count(tetrahedra); first += TOGETHER) {
    begin_chunk(tetrahedra, first, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      Part part = part_at(tetrahedra, first + n);
      Matrix strain = chunk.gradient[n];
      Rotation rotation = rotation_of(&chunk, n);
      SporeVd volumetric = rotation.sum - 3;
      UNROLL for (int k = 0; k < 9; k++) strain.m[k] -= rotation.r.m[k];
      SporeVd density = elasticity.mu * product(&strain, &strain) + 0.5 * elasticity.lambda * volumetric * volumetric;
      double *lane = lanes + part.lane;
      spore_vd_store(lane, spore_vd_load(lane) + part.volume * density);
    }
  }
  return spore_lanes_sum(lanes);
}

SPORE_INLINE SporeVd3 row_of(const Matrix *a, int i) {
  return (SporeVd3){a->m[3 * i], a->m[3 * i + 1], a->m[3 * i + 2]};
}
SPORE_INLINE SporeVd3 column_of(const Matrix *a, int j) { return (SporeVd3){a->m[j], a->m[3 + j], a->m[6 + j]}; }
SPORE_INLINE SporeVd3 apply(const Matrix *a, SporeVd3 x) {
  return (SporeVd3){a->m[0] * x.x + a->m[1] * x.y + a->m[2] * x.z, a->m[3] * x.x + a->m[4] * x.y + a->m[5] * x.z,
                    a->m[6] * x.x + a->m[7] * x.y + a->m[8] * x.z};
}
SPORE_INLINE SporeVd3 cross(SporeVd3 a, SporeVd3 b) {
  return (SporeVd3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
SPORE_INLINE SporeVd3 scale(SporeVd s, SporeVd3 a) { return (SporeVd3){s * a.x, s * a.y, s * a.z}; }
SPORE_INLINE SporeVd3 add(SporeVd3 a, SporeVd3 b) { return (SporeVd3){a.x + b.x, a.y + b.y, a.z + b.z}; }
SPORE_INLINE SporeVd3 choose(SporeVl mask, SporeVd3 a, SporeVd3 b) {
  return (SporeVd3){spore_vd_select(mask, a.x, b.x), spore_vd_select(mask, a.y, b.y), spore_vd_select(mask, a.z, b.z)};
}

/* a += b c^T */
SPORE_INLINE void add_outer(Matrix *a, SporeVd3 b, SporeVd3 c) {
  a->m[0] += b.x * c.x, a->m[1] += b.x * c.y, a->m[2] += b.x * c.z;
  a->m[3] += b.y * c.x, a->m[4] += b.y * c.y, a->m[5] += b.y * c.z;
  a->m[6] += b.z * c.x, a->m[7] += b.z * c.y, a->m[8] += b.z * c.z;
}

typedef struct Eigen {
  SporeVd value[3];
  SporeVd3 axis[3]; /* orthonormal */
} Eigen;

/* The root y >= cos(pi/6) of 4 y^3 - 3 y = r, 0 <= r <= 1: the cosine of a third of the angle. */
SPORE_INLINE SporeVd cosine_of_third(SporeVd r) {
  SporeVd y = 0.8660254037844386 + r * (0.16671 - 0.03274 * r);
  UNROLL for (int round = 0; round < 3; round++) y -= (y * (4 * y * y - 3) - r) / (12 * y * y - 3);
  return y;
}

/* The kernel of a symmetric matrix of rank 2, from the greatest column of its adjugate; any direction of one of less.
 */
SPORE_INLINE SporeVd3 kernel_of(const Matrix *a) {
  SporeVd3 x = row_of(a, 0), y = row_of(a, 1), z = row_of(a, 2);
  SporeVd3 best = cross(x, y), other = cross(y, z), third = cross(z, x);
  SporeVd square = spore_vd3_dot(best, best), other_square = spore_vd3_dot(other, other);
  SporeVl better = other_square > square;
  best = choose(better, other, best), square = spore_vd_max(other_square, square);
  other_square = spore_vd3_dot(third, third);
  better = other_square > square;
  best = choose(better, third, best), square = spore_vd_max(other_square, square);
  SporeVl none = ~(square > 1e-200);
  SporeVd length = spore_vd_sqrt(square);
  return choose(none, (SporeVd3){spore_vd_all(1), spore_vd_all(0), spore_vd_all(0)}, scale(1 / length, best));
}

/* Two axes that complete `axis` (Duff et al. 2017, "Building an orthonormal basis, revisited"). */
SPORE_INLINE void complete_basis(SporeVd3 axis, SporeVd3 *second, SporeVd3 *third) {
  SporeVd sign = spore_vd_select(axis.z < 0, spore_vd_all(-1), spore_vd_all(1));
  SporeVd a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
  *second = (SporeVd3){1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  *third = (SporeVd3){b, sign + axis.y * axis.y * a, -axis.y};
}

/* Of a symmetric matrix, without iteration: first the eigenvalue that lies apart from the other two, then those two in
 * the plane across its axis (Eberly 2014, "A robust eigensolver for 3x3 symmetric matrices"). */
SPORE_INLINE Eigen eigen_of(const Matrix *a) {
  SporeVd mean = (a->m[0] + a->m[4] + a->m[8]) * (1.0 / 3);
  Matrix b = *a;
  b.m[0] -= mean, b.m[4] -= mean, b.m[8] -= mean;
  SporeVd size = spore_vd_sqrt(product(&b, &b) * (1.0 / 6) + 1e-300), inverse = 1 / size;
  UNROLL for (int k = 0; k < 9; k++) b.m[k] *= inverse;
  SporeVd half = 0.5 * spore_vd3_dot(row_of(&b, 0), cross(row_of(&b, 1), row_of(&b, 2)));
  SporeVd sign = spore_vd_select(half < 0, spore_vd_all(-1), spore_vd_all(1));
  SporeVd apart = 2 * sign * cosine_of_third(spore_vd_min(spore_vd_abs(half), spore_vd_all(1)));
  Eigen eigen;
  Matrix shifted = b;
  shifted.m[0] -= apart, shifted.m[4] -= apart, shifted.m[8] -= apart;
  eigen.axis[0] = kernel_of(&shifted);
  SporeVd3 v, w;
  complete_basis(eigen.axis[0], &v, &w);
  SporeVd3 bv = apply(&b, v), bw = apply(&b, w);
  SporeVd vv = spore_vd3_dot(v, bv), vw = spore_vd3_dot(v, bw), ww = spore_vd3_dot(w, bw), difference = ww - vv;
  SporeVd turn = spore_vd_abs(difference) + spore_vd_sqrt(difference * difference + 4 * vw * vw) + 1e-300;
  SporeVd tangent = spore_vd_select(difference < 0, -2 * vw, 2 * vw) / turn;
  SporeVd cosine = 1 / spore_vd_sqrt(1 + tangent * tangent), sine = tangent * cosine;
  eigen.axis[1] = add(scale(cosine, v), scale(-sine, w));
  eigen.axis[2] = add(scale(sine, v), scale(cosine, w));
  eigen.value[0] = mean + size * apart;
  eigen.value[1] = mean + size * (vv - tangent * vw);
  eigen.value[2] = mean + size * (ww + tangent * vw);
  return eigen;
}

/* Blocks (a, b) of an element's matrix for corners 1 <= a <= b <= 3, at these places: 11 12 13 22 23 33. */
typedef struct Blocks {
  Matrix m[6];
} Blocks;

/* The stiffness of F is 2 mu I + lambda vec(R) vec(R)^T + sum over the three twists of c_k vec(Q_k) vec(Q_k)^T, where
 * Q_k = R [s_k]x / sqrt 2, s_k an eigenvector of S, and c_k = (lambda (tr S - 3) - 2 mu) 2 / (the other two stretches).
 * 2 mu + c_k is the eigenvalue of that twist; it is clamped to be no less than 0. */
SPORE_INLINE void add_stiffness(const Part *part, SporeElasticity elasticity, double by, const Matrix *f,
                                Rotation rotation, Blocks *blocks) {
  Matrix stretch;
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = i; j < 3; j++) {
    SporeVd3 ri = column_of(&rotation.r, i), rj = column_of(&rotation.r, j);
    stretch.m[3 * i + j] = 0.5 * (spore_vd3_dot(ri, column_of(f, j)) + spore_vd3_dot(rj, column_of(f, i)));
    stretch.m[3 * j + i] = stretch.m[3 * i + j];
  }
  Eigen eigen = eigen_of(&stretch);
  SporeVd volume = part->volume * by;
  SporeVd factor = elasticity.lambda * (rotation.sum - 3) - 2 * elasticity.mu;
  SporeVd3 gradient[3], along[3], twisted[3][3];
  UNROLL for (int a = 0; a < 3; a++) {
    gradient[a] = row_of(&part->inverse, a);
    along[a] = apply(&rotation.r, gradient[a]);
  }
  SporeVd coefficient[3];
  UNROLL for (int k = 0; k < 3; k++) {
    SporeVd others = spore_vd_max(eigen.value[(k + 1) % 3] + eigen.value[(k + 2) % 3], spore_vd_all(1e-6));
    coefficient[k] = volume * spore_vd_max(factor / others, spore_vd_all(-elasticity.mu));
    SporeVd3 axis = apply(&rotation.r, eigen.axis[k]);
    UNROLL for (int a = 0; a < 3; a++) twisted[k][a] = cross(axis, along[a]);
  }
  int n = 0;
  UNROLL for (int a = 0; a < 3; a++) {
    SporeVd3 left[4] = {scale(volume * elasticity.lambda, along[a]), scale(coefficient[0], twisted[0][a]),
                        scale(coefficient[1], twisted[1][a]), scale(coefficient[2], twisted[2][a])};
    UNROLL for (int b = a; b < 3; b++, n++) {
      SporeVd same = volume * (2 * elasticity.mu) * spore_vd3_dot(gradient[a], gradient[b]);
      add_outer(&blocks->m[n], left[0], along[b]);
      UNROLL for (int k = 0; k < 3; k++) add_outer(&blocks->m[n], left[k + 1], twisted[k][b]);
      UNROLL for (int i = 0; i < 9; i += 4) blocks->m[n].m[i] += same;
    }
  }
}

/* -df/dv of the viscous force between corners a and b, with F b_a the carried gradients:
 * V eta (mu (b_a . b_b) F F^T + mu (F b_b)(F b_a)^T + lambda (F b_a)(F b_b)^T) */
SPORE_INLINE void add_viscosity(const Part *part, SporeElasticity elasticity, double by, const Matrix *f,
                                Blocks *blocks) {
  SporeVd mu = part->volume * (by * elasticity.viscosity * elasticity.mu);
  SporeVd lambda = part->volume * (by * elasticity.viscosity * elasticity.lambda);
  SporeVd3 gradient[3], carried[3];
  Matrix square;
  UNROLL for (int i = 0; i < 3; i++) UNROLL for (int j = 0; j < 3; j++) square.m[3 * i + j] =
      spore_vd3_dot(row_of(f, i), row_of(f, j));
  UNROLL for (int a = 0; a < 3; a++) {
    gradient[a] = row_of(&part->inverse, a);
    carried[a] = apply(f, gradient[a]);
  }
  int n = 0;
  UNROLL for (int a = 0; a < 3; a++) UNROLL for (int b = a; b < 3; b++, n++) {
    SporeVd same = mu * spore_vd3_dot(gradient[a], gradient[b]);
    UNROLL for (int i = 0; i < 9; i++) blocks->m[n].m[i] += same * square.m[i];
    add_outer(&blocks->m[n], scale(mu, carried[b]), carried[a]);
    add_outer(&blocks->m[n], scale(lambda, carried[a]), carried[b]);
  }
}

typedef double BlockRows[3][4 * SPORE_WIDTH];

SPORE_INLINE void store_block(BlockRows *rows, const Matrix *block) {
  UNROLL for (int i = 0; i < 3; i++) spore_vd3_store_rows((*rows)[i], row_of(block, i));
}

SPORE_INLINE Matrix transposed(const Matrix *a) {
  return (Matrix){{a->m[0], a->m[3], a->m[6], a->m[1], a->m[4], a->m[7], a->m[2], a->m[5], a->m[8]}};
}

/* All 16 blocks of the elements' matrices. Rows and columns add up to nothing, which gives what belongs to corner 0. */
SPORE_INLINE void store_blocks(BlockRows rows[16], const Blocks *blocks) {
  static const int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Matrix corner = {0};
  UNROLL for (int a = 0; a < 3; a++) {
    Matrix column = {0}; /* block (0, a + 1) */
    UNROLL for (int b = 0; b < 3; b++) {
      Matrix block = blocks->m[place[a][b]], flipped = transposed(&block);
      if (b < a) block = flipped, flipped = blocks->m[place[a][b]];
      store_block(&rows[4 * (a + 1) + b + 1], &block);
      UNROLL for (int k = 0; k < 9; k++) column.m[k] -= flipped.m[k];
    }
    store_block(&rows[a + 1], &column);
    UNROLL for (int k = 0; k < 9; k++) corner.m[k] -= column.m[k];
    column = transposed(&column);
    store_block(&rows[4 * (a + 1)], &column);
  }
  store_block(&rows[0], &corner);
}

/* One element after the other, whatever the width. */
SPORE_INLINE void add_blocks(const SporeTetrahedra *tetrahedra, const Part *part, const Blocks *blocks,
                             SporeBlockMatrix *matrix) {
  BlockRows rows[16];
  store_blocks(rows, blocks);
  for (size_t i = 0, lanes = lanes_of(tetrahedra, part); i < lanes; i++)
    for (int pair = 0; pair < 16; pair++)
      spore_block_add_rows(matrix->values + 9 * (size_t)tetrahedra->blocks[part->index][part->lane + i][pair],
                           rows[pair], i);
}

void SPORE_LEVEL_NAME(spore_corotation_jacobian)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                                 const double *q, const double *shape, double stiffness_scale,
                                                 double damping_scale, SporeBlockMatrix *matrix) {
  double viscous = damping_scale * elasticity.viscosity;
  Chunk chunk;
  for (size_t first = 0; first < part_count(tetrahedra); first += TOGETHER) {
    begin_chunk(tetrahedra, first, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      Part part = part_at(tetrahedra, first + n);
      Matrix gradient = chunk.gradient[n];
      Blocks blocks = {0};
      if (stiffness_scale != 0) {
        Rotation rotation = rotation_of(&chunk, n);
        add_stiffness(&part, elasticity, stiffness_scale, &gradient, rotation, &blocks);
      }
      if (viscous != 0 && shape != q) gradient = gradient_of(&part, shape);
      if (viscous != 0) add_viscosity(&part, elasticity, damping_scale, &gradient, &blocks);
      add_blocks(tetrahedra, &part, &blocks, matrix);
    }
  }
}
