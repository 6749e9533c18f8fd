/* Strain, stress and shape of a body's elements at a state, for pictures. Each element is computed by itself: strain
 * from its corners, stress from the forces on its nodes that the body's own model gives. Nothing here reads what a
 * running step changes, so that a viewer computes them on its own thread. */
#ifndef SPORE_SIM_CELL_FIELDS_H
#define SPORE_SIM_CELL_FIELDS_H

#include "core/body/model.h"

/* The elements of a body apart from each other, at the state that they took last. */
typedef struct SporeCellFields SporeCellFields;

/* fields: of the model's type. Any thread may ask, while a world moves the model. To be freed by
 * spore_cell_fields_free. NULL with the error: the model's type has no slot `apart`, or no memory. */
SporeCellFields *spore_cell_fields_new(const SporeModel *model, const void *fields, SporeError *error);
/* NULL is allowed. */
void spore_cell_fields_free(SporeCellFields *cells);
/* Number of elements. */
size_t spore_cell_fields_count(const SporeCellFields *cells);
/* Takes other values of the material's parameters. */
bool spore_cell_fields_retune(SporeCellFields *cells, const void *fields, SporeError *error);
/* Takes the state of the body: q as its model has it. corners: 4 nodes of each element where cuts have split nodes,
 * in the order of its mesh, as in SporeCuts; NULL: no cut can. */
void spore_cell_fields_take(SporeCellFields *cells, const uint32_t *corners, const double *q);

/* The largest eigenvalue of Green's strain E = (F^T F - I) / 2 in each element, with F the gradient of its four
 * corners against rest. Below 0 where an element is shorter in all directions. strain: one an element. */
void spore_cell_fields_strain(const SporeCellFields *cells, double *strain);
/* Von Mises' stress of Cauchy's stress in each element, Pa: (3/2 s:s)^1/2 with s = sigma - tr sigma / 3 I. sigma is the
 * mean over the element, from the elastic forces f of the model on the element's nodes at x and its volume v:
 * sigma = -1/v sum f x^T (what the forces do in any virtual strain). Coagulated tissue counts as it was before heat.
 * Not a number where an element is flat or inside out. stress: one an element. */
void spore_cell_fields_stress(const SporeCellFields *cells, double *stress);
/* The shape of each element now: spore_tetrahedron_quality of its corners, degrees; 0 where it is flat or inside out.
 * shape: one an element. */
void spore_cell_fields_shape(const SporeCellFields *cells, double *shape);
/* From elements to the nodes of the body: the least of the elements that hold a node. values, nodes: as below. */
void spore_cell_fields_least(const SporeCellFields *cells, const double *values, size_t node_count, double *nodes);
/* From elements to the nodes of the body: the mean of the elements that hold a node, by their volumes at rest. Values
 * that are not numbers do not count. values: one an element; nodes: node_count; not a number where no element says. */
void spore_cell_fields_spread(const SporeCellFields *cells, const double *values, size_t node_count, double *nodes);

/* The larger principal Green's strain in the plane of each triangle of a surface, as the mean at its vertices by area
 * at rest: of bodies that have no elements. rest, now: vertex_count x 3, m. strain: vertex_count; 0 where no triangle
 * with an area is. */
void spore_surface_strain(const double *rest, const double *now, size_t vertex_count, const uint32_t *triangles,
                          size_t triangle_count, double *strain);
/* Green's strain along a line of points, (l^2 / l0^2 - 1) / 2 of each piece, at a point the mean of the pieces that
 * meet there. rest: `stride` doubles a point, of which 3 are its place; now: 3 a point; count: at least 2. */
void spore_line_strain(const double *rest, size_t stride, const double *now, size_t count, double *strain);

#endif
