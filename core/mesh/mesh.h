/* Triangle meshes, tetrahedral meshes, sphere sets and curves: flat arrays in metres, owned by the structure. */
#ifndef SPORE_MESH_MESH_H
#define SPORE_MESH_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/error.h"
#include "core/math/vec3.h"

/* A surface of triangles, open or closed. */
typedef struct SporeTriangleMesh {
  size_t vertex_count, triangle_count;
  double *vertices;    /* vertex_count x 3 */
  uint32_t *triangles; /* triangle_count x 3, counter-clockwise seen from outside */
  bool reoriented;     /* so only since it was read: its file has some the other way round */
} SporeTriangleMesh;

/* A solid of tetrahedra. */
typedef struct SporeTetrahedralMesh {
  size_t vertex_count, tetrahedron_count;
  double *vertices;     /* vertex_count x 3 */
  uint32_t *tetrahedra; /* tetrahedron_count x 4, positive volume: (b-a) x (c-a) . (d-a) > 0 */
  uint32_t *labels;     /* tetrahedron_count: of which organ each is; NULL: of one */
} SporeTetrahedralMesh;

/* Spheres that stand for a body where it is touched. */
typedef struct SporeSphereSet {
  size_t count;
  double *spheres; /* count x 4: x y z r */
  /* count, above 0, of the depth sum_i w_i max(0, r_i - distance to centre i) - level; NULL: it has none */
  double *weights;
  double level; /* m, of a set with weights, 0 or more: where the sum is no more than this, nothing is felt */
} SporeSphereSet;

/* The middle line of something long and thin, from one end to the other, with its radius at each point. */
typedef struct SporeCurve {
  size_t count;
  double *points; /* count x 4: x y z r */
} SporeCurve;

/* All arrays from spore_allocate; the *_clear functions free them and zero the structure. Counts above
 * SPORE_MESH_MAXIMUM are refused everywhere. */
#define SPORE_MESH_MAXIMUM 20000000u

/* A mesh of so many zeroed vertices and triangles. False: no memory, or too many; the mesh is then empty. */
bool spore_triangle_mesh_allocate(SporeTriangleMesh *mesh, size_t vertices, size_t triangles, SporeError *error);
/* *to is overwritten. False: no memory; *to is then empty. */
bool spore_triangle_mesh_copy(SporeTriangleMesh *to, const SporeTriangleMesh *from, SporeError *error);
/* Frees the arrays and zeroes the mesh. */
void spore_triangle_mesh_clear(SporeTriangleMesh *mesh);
/* A mesh of so many zeroed vertices and tetrahedra, without labels. False: no memory, or too many; it is then empty. */
bool spore_tetrahedral_mesh_allocate(SporeTetrahedralMesh *mesh, size_t vertices, size_t tetrahedra, SporeError *error);
/* Frees the arrays and zeroes the mesh. */
void spore_tetrahedral_mesh_clear(SporeTetrahedralMesh *mesh);
/* A set of so many zeroed spheres without weights. False: no memory, or too many; the set is then empty. */
bool spore_sphere_set_allocate(SporeSphereSet *set, size_t count, SporeError *error);
/* Weights of 0, to be filled. */
bool spore_sphere_set_add_weights(SporeSphereSet *set, SporeError *error);
/* Frees the arrays and zeroes the set. */
void spore_sphere_set_clear(SporeSphereSet *set);
/* A curve of so many zeroed points. False: no memory, or too many; the curve is then empty. */
bool spore_curve_allocate(SporeCurve *curve, size_t count, SporeError *error);
/* Frees the points and zeroes the curve. */
void spore_curve_clear(SporeCurve *curve);

/* Finite coordinates (|x| <= 1e9 m), indices in range, at least one element; for tetrahedra positive volume above
 * 1e-12 of the cubed longest edge; for spheres r > 0, and weights above 0 and at most 1000, without which there is no
 * level; for curves r > 0, two points or more and no two neighbours in the same place. The message names the first
 * offending element (0-based). */
bool spore_triangle_mesh_validate(const SporeTriangleMesh *mesh, SporeError *error);
/* See spore_triangle_mesh_validate. */
bool spore_tetrahedral_mesh_validate(const SporeTetrahedralMesh *mesh, SporeError *error);
/* See spore_triangle_mesh_validate. */
bool spore_sphere_set_validate(const SporeSphereSet *set, SporeError *error);
/* See spore_triangle_mesh_validate. */
bool spore_curve_validate(const SporeCurve *curve, SporeError *error);

/* Length of the straight pieces, m. */
double spore_curve_length(const SporeCurve *curve);
/* The surface of the tube around the curve, `sectors` corners around, closed by a point at each end, outward. Its rings
 * do not twist against each other. *mesh is overwritten. */
bool spore_curve_tube(const SporeCurve *curve, size_t sectors, SporeTriangleMesh *mesh, SporeError *error);

/* The closed surface around particles whose neighbours are `spacing` (m) apart: one over those that are near each
 * other, drops around others; nothing of particles that are not finite or farther than a million spacings from the
 * origin. centres: count x 3. *mesh is overwritten; empty without particles. */
bool spore_particle_skin(const double *centres, size_t count, double spacing, SporeTriangleMesh *mesh,
                         SporeError *error);

/* Merges vertices nearer than `relative` of the bounding box diagonal (1e-6 is usual), drops triangles that
 * collapse, exact duplicates (whichever way they turn) and unused vertices. In place; order of what stays is kept.
 * Refused, mesh untouched, when nothing would be left. */
bool spore_triangle_mesh_weld(SporeTriangleMesh *mesh, double relative, SporeError *error);
/* The same; tags (one a triangle; NULL: none) go with the triangles that stay. */
bool spore_triangle_mesh_weld_tagged(SporeTriangleMesh *mesh, double relative, uint32_t *tags, SporeError *error);

/* Size and faults of a triangle mesh. */
typedef struct SporeMeshReport {
  double lower[3], upper[3], diagonal; /* m */
  double area, volume;                 /* m^2, signed m^3 (meaningful when closed) */
  /* components: sets of triangles joined by edges */
  size_t components, boundary_edges, nonmanifold_edges, misoriented_edges, degenerate_triangles;
  bool closed; /* no boundary edge, no non-manifold edge, oriented alike */
} SporeMeshReport;
/* Fills *report. False: no memory. */
bool spore_triangle_mesh_report(const SporeTriangleMesh *mesh, SporeMeshReport *report, SporeError *error);

/* The report of a mesh that a solid can be made of: valid, closed, with one outside, around a volume, whichever way its
 * triangles face. False with what is wrong and the remedy. */
bool spore_triangle_mesh_report_solid(const SporeTriangleMesh *mesh, SporeMeshReport *report, SporeError *error);

/* Makes neighbouring triangles turn the same way and closed components outward; the wall of a cavity (a closed
 * component inside another one that came turned the other way) looks into the cavity. False only without memory. */
bool spore_triangle_mesh_orient(SporeTriangleMesh *mesh, SporeError *error);

/* Area-weighted unit vertex normals, vertex_count x 3. */
void spore_triangle_mesh_normals(const double *vertices, size_t vertex_count, const uint32_t *triangles,
                                 size_t triangle_count, double *normals);

/* areas[i] += a third of the triangles around vertex i, m^2; returns the area of all. */
double spore_triangle_mesh_share_area(const SporeTriangleMesh *mesh, double *areas);

/* Unique undirected edges, pairs (smaller, larger), sorted. *edges from spore_allocate. */
bool spore_edges_of_triangles(const uint32_t *triangles, size_t count, uint32_t **edges, size_t *edge_count);
/* The same of tetrahedra. */
bool spore_edges_of_tetrahedra(const uint32_t *tetrahedra, size_t count, uint32_t **edges, size_t *edge_count);

/* The corners of the face opposite each corner of a tetrahedron, counter-clockwise seen from outside. */
extern const uint8_t spore_tetrahedron_faces[4][3];

/* Outer triangles of a tetrahedral mesh, outward, indexing its vertices. *triangles from spore_allocate. */
bool spore_tetrahedral_mesh_boundary(const SporeTetrahedralMesh *mesh, uint32_t **triangles, size_t *triangle_count);

/* For each tetrahedron those across its faces, in the order of the corners opposite; UINT32_MAX: none.
 * tetrahedron_count x 4, from spore_allocate. */
bool spore_tetrahedral_mesh_neighbours(const SporeTetrahedralMesh *mesh, uint32_t **neighbours);

/* Which piece each tetrahedron belongs to, from 0 in the order of their first one: those of a piece hang together by
 * common vertices. *pieces from spore_allocate. False only without memory. */
bool spore_tetrahedral_mesh_pieces(const SporeTetrahedralMesh *mesh, uint32_t **pieces, size_t *count,
                                   SporeError *error);

/* Vertices that are in no tetrahedron go, the order of the others is kept. False only without memory. */
bool spore_tetrahedral_mesh_drop_unused(SporeTetrahedralMesh *mesh, SporeError *error);

/* Size and shape of the cells of a tetrahedral mesh. */
typedef struct SporeTetrahedraQuality {
  double volume;                              /* m^3 */
  double min_dihedral_deg, mean_dihedral_deg; /* least of all; mean of each tetrahedron's least */
  double worst_radius_ratio;                  /* R / 3r, 1 is regular */
} SporeTetrahedraQuality;
/* One figure for the shape of a cell, to compare: its least dihedral angle (degrees), or 150 over its R / 3r where that
 * is less, as it is of needles; below 0 where its volume is not above 0. */
double spore_tetrahedron_quality(const SporeVec3 corner[4]);
/* Fills *quality, of all cells. */
void spore_tetrahedral_mesh_quality(const SporeTetrahedralMesh *mesh, SporeTetrahedraQuality *quality);

#endif
