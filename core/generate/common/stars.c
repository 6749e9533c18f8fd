/* The cells around each vertex, and the movement of vertices with the quality of their cells. */
#include "core/generate/common/stars.h"

#include <math.h>

#include "core/mesh/common.h"

static void corners_of(const SporeTetrahedralMesh *mesh, size_t cell, SporeVec3 p[4]) {
  for (int k = 0; k < 4; k++) p[k] = spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * cell + (size_t)k]);
}

static void fill(SporeStars *stars) {
  const SporeTetrahedralMesh *mesh = stars->mesh;
  size_t corners = 4 * mesh->tetrahedron_count;
  for (size_t i = 0; i < corners; i++) stars->first[mesh->tetrahedra[i] + 2]++;
  for (size_t v = 0; v < mesh->vertex_count; v++) stars->first[v + 2] += stars->first[v + 1];
  for (size_t i = 0; i < corners; i++) /* first[v + 1] runs from the beginning of v's cells to their end */
    stars->cells[stars->first[mesh->tetrahedra[i] + 1]++] = (uint32_t)(i / 4);
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    SporeVec3 p[4];
    corners_of(mesh, t, p);
    stars->quality[t] = spore_tetrahedron_quality(p);
  }
}

static void mark_interfaces(SporeStars *stars) {
  for (size_t v = 0; v < stars->mesh->vertex_count; v++)
    for (size_t i = stars->first[v]; i < stars->first[v + 1]; i++)
      if (stars->labels[stars->cells[i]] != stars->labels[stars->cells[stars->first[v]]]) stars->outer[v] = true;
}

bool spore_stars_create(SporeStars *stars, SporeTetrahedralMesh *mesh, const uint32_t *labels, SporeError *error) {
  uint32_t *boundary = NULL;
  size_t count = 0;
  *stars = (SporeStars){.mesh = mesh,
                        .labels = labels,
                        .first = SPORE_NEW_ARRAY(size_t, mesh->vertex_count + 2),
                        .cells = SPORE_NEW_ARRAY(uint32_t, 4 * mesh->tetrahedron_count),
                        .quality = SPORE_NEW_ARRAY(double, mesh->tetrahedron_count),
                        .outer = SPORE_NEW_ARRAY(bool, mesh->vertex_count)};
  if (!stars->first || !stars->cells || !stars->quality || !stars->outer ||
      !spore_tetrahedral_mesh_boundary(mesh, &boundary, &count)) {
    spore_stars_clear(stars);
    return spore_mesh_no_memory(error);
  }
  fill(stars);
  for (size_t i = 0; i < 3 * count; i++) stars->outer[boundary[i]] = true;
  spore_free(boundary);
  if (labels) mark_interfaces(stars);
  return true;
}

void spore_stars_clear(SporeStars *stars) {
  spore_free(stars->first);
  spore_free(stars->cells);
  spore_free(stars->quality);
  spore_free(stars->outer);
  *stars = (SporeStars){0};
}

double spore_stars_quality_at(const SporeStars *stars, uint32_t v, SporeVec3 p, double floor) {
  double least = 180;
  for (size_t i = stars->first[v]; i < stars->first[v + 1] && least > floor; i++) {
    SporeVec3 corner[4];
    corners_of(stars->mesh, stars->cells[i], corner);
    for (int k = 0; k < 4; k++)
      if (stars->mesh->tetrahedra[4 * (size_t)stars->cells[i] + (size_t)k] == v) corner[k] = p;
    least = fmin(least, spore_tetrahedron_quality(corner));
  }
  return least;
}

void spore_stars_move(SporeStars *stars, uint32_t v, SporeVec3 p) {
  spore_vec3_store(stars->mesh->vertices + 3 * (size_t)v, p);
  for (size_t i = stars->first[v]; i < stars->first[v + 1]; i++) {
    SporeVec3 corner[4];
    corners_of(stars->mesh, stars->cells[i], corner);
    stars->quality[stars->cells[i]] = spore_tetrahedron_quality(corner);
  }
}

double spore_stars_edge(const SporeStars *stars, uint32_t v) {
  double sum = 0;
  SporeVec3 p = spore_mesh_vertex(stars->mesh->vertices, v);
  size_t count = stars->first[v + 1] - stars->first[v];
  for (size_t i = stars->first[v]; i < stars->first[v + 1]; i++)
    for (int k = 0; k < 4; k++)
      sum +=
          spore_vec3_distance(p, spore_mesh_vertex(stars->mesh->vertices,
                                                   stars->mesh->tetrahedra[4 * (size_t)stars->cells[i] + (size_t)k]));
  return count ? sum / (3 * (double)count) : 0;
}
