/* Finite differences of the displacement on a regular lattice, written as the gradient of an energy.
 *
 * The eight corners of a cell have eight modes. A mode is the sum over the corners, each times the product of some of
 * the signs that tell on which side of the cell's middle the corner lies. The mode without a sign is the mean. The
 * modes with one sign are the central differences at the middle of the cell, so F. The modes with two or three signs
 * tell how the differences vary within the cell. With W the modes of more than one sign, in units of the root mean
 * square of the strain over the cell:
 *   U = sum over cells of volume (law(F) + modulus / 2 (|W_ij|^2 + |W_jk|^2 + |W_ki|^2 + |W_ijk|^2))
 * F^T F and the lengths of W do not change when the cell is rotated, so momentum and angular momentum are exact; for
 * small strains the forces are central differences of Navier's equation (lambda + mu) grad div u + mu laplace u, to
 * second order. Differences at the middle alone would leave W without stiffness (Flanagan and Belytschko 1981, "A
 * uniform strain hexahedron and quadrilateral with orthogonal hourglass control"); shear and volume that vary within a
 * cell would make the cell too stiff (Belytschko and Bindeman 1993, "Assumed strain stabilization of the eight node
 * hexahedral element"). W has the stiffness of bending instead. In a bent bar the length varies by W, and the width
 * varies too, by Poisson's ratio nu times as much; with young / (1 + nu^2) both together have Young's modulus. A bar of
 * a single cell across does not vary in width and bends 1 + nu^2 times too far.
 *
 * The viscous force is that of tetrahedra (models/tetrahedra/tetrahedra.h), and acts along the rates of F^T W, which do
 * not change when the cell is rotated. A cell that the surface cuts has the stiffness and mass of its share inside, so
 * that the part outside has neither weight nor stiffness, and the surface is free as it should be. */
#ifndef SPORE_MODELS_GRID_LATTICE_H
#define SPORE_MODELS_GRID_LATTICE_H

#include "core/body/mapping.h"
#include "core/body/region.h"
#include "models/grid/voxels.h"
#include "models/tetrahedra/tetrahedra.h"

#define SPORE_LATTICE_MODES 7

/* Cells that follow one another along the grid's axis 2. The nodes of a row of corners have numbers that follow one
 * another, too. */
typedef struct SporeLatticeRun {
  uint32_t row[4];            /* nodes at the first cell's corners 0, 2, 4, 6 */
  uint32_t count;             /* cells, 1..SPORE_LANES */
  double volume[SPORE_LANES]; /* m^3 of the cell that lies inside, times how much stiffer it is than the body; 0 behind
                                 the last */
} SporeLatticeRun;

/* Corner c of a cell lies on the upper side along the grid's axis 0 where c & 4, 1 where c & 2, 2 where c & 1. Mode m,
 * 1..7, has the signs of those axes that are set in m: mode_scale[m] times the sum of sign times corner. Slab i holds
 * the cells i along axis 0: no two even ones have a node in common, nor two odd ones. */
typedef struct SporeLattice {
  SporeVoxels voxels;
  size_t node_count, run_count;
  double mode_scale[SPORE_LATTICE_MODES + 1]; /* 1/m */
  double *rest;                               /* node_count x 3, m */
  uint32_t *node;       /* (size[0] + 1) x (size[1] + 1) x (size[2] + 1) places: the node there, or UINT32_MAX */
  uint32_t *slab_start; /* size[0] + 1: its first run */
  SporeLatticeRun *runs;
  uint32_t (*blocks)[64]; /* run x SPORE_LANES: where corner pair 8 a + b lies in the model's matrix */
} SporeLattice;

/* Takes the voxels over, also where it fails. False: no memory. */
bool spore_lattice_create(SporeLattice *lattice, SporeVoxels *voxels);
void spore_lattice_clear(SporeLattice *lattice);
/* Node of corner c of a cell. */
uint32_t spore_lattice_corner(const SporeLattice *lattice, size_t i, size_t j, size_t k, unsigned corner);
bool spore_lattice_pattern(const SporeLattice *lattice, SporeBlockPattern *pattern);
/* In a matrix of that pattern. */
void spore_lattice_find_blocks(SporeLattice *lattice, const SporeBlockMatrix *matrix);
/* mass += `total` (kg), spread over the corners of cells by what of them lies inside, times what regions (NULL: none)
 * say; cells become as much stiffer as those say: to be called once. */
void spore_lattice_add_mass(SporeLattice *lattice, double total, const SporeRegions *regions, double *mass);
/* A point follows the corners of its cell by trilinear weights; one in no cell the nearest cell, extended affinely. The
 * nodes in their order give the identity. */
bool spore_lattice_map(const SporeLattice *lattice, const double *points, size_t count, const SporeCancel *cancel,
                       SporeMapping *mapping, SporeError *error);

/* The largest stretch at the middle of a cell, less 1. */
double spore_lattice_strain(const SporeLattice *lattice, const double *q);

/* f += forces of a slab, the viscous ones with F and W as they are in shape. */
SPORE_DECLARE_KERNEL(void, spore_lattice_force, const SporeLattice *lattice, size_t slab, SporeElasticity elasticity,
                     const double *q, const double *shape, const double *v, double *f);
/* Energy of all, J. */
SPORE_DECLARE_KERNEL(double, spore_lattice_potential, const SporeLattice *lattice, SporeElasticity elasticity,
                     const double *q);
/* matrix += stiffness_scale (-df/dq) + damping_scale (-df/dv) of a slab, without what is negative in it. */
SPORE_DECLARE_KERNEL(void, spore_lattice_jacobian, const SporeLattice *lattice, size_t slab, SporeElasticity elasticity,
                     const double *q, const double *shape, double stiffness_scale, double damping_scale,
                     SporeBlockMatrix *matrix);

#endif
