/* What SPORE and its tetrahedra helper say to each other. Native byte order; lengths in diagonals of the surface. */
#ifndef SPORE_GENERATE_TETRAHEDRA_WIRE_H
#define SPORE_GENERATE_TETRAHEDRA_WIRE_H

#include <stdint.h>

typedef enum SporeTetrahedraMethod {
  SPORE_TETRAHEDRA_DIRECT,
  SPORE_TETRAHEDRA_REPAIRED,
  SPORE_TETRAHEDRA_WRAPPED,
  SPORE_TETRAHEDRA_METHODS
} SporeTetrahedraMethod;

/* vertex_count x 3 doubles and triangle_count x 3 uint32_t follow. */
typedef struct SporeTetrahedraRequest {
  uint64_t method, cells; /* cells 0: by size */
  double size;
  uint64_t vertex_count, triangle_count;
} SporeTetrahedraRequest;

/* vertex_count x 3 doubles and tetrahedron_count x 4 uint32_t follow. */
typedef struct SporeTetrahedraAnswer {
  uint64_t vertex_count, tetrahedron_count;
} SporeTetrahedraAnswer;

#endif
