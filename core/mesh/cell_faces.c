/* Finds the visible faces of a tetrahedral mesh that is cut open or whose cells are drawn apart. */
#include "core/mesh/cell_faces.h"

#include <assert.h>

#include "core/mesh/common.h"

static SporeVec3 corner_of(const SporeTetrahedralMesh *mesh, size_t cell, size_t corner) {
  assert(cell < mesh->tetrahedron_count && corner < 4);
  return spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * cell + corner]);
}

static SporeVec3 middle_of(const SporeTetrahedralMesh *mesh, size_t cell) {
  SporeVec3 sum = corner_of(mesh, cell, 0);
  for (size_t i = 1; i < 4; i++) sum = spore_vec3_add(sum, corner_of(mesh, cell, i));
  return spore_vec3_scale(0.25, sum);
}

static bool is_seen(const SporeTetrahedralMesh *mesh, const SporeCellView *view, uint32_t cell) {
  return cell != UINT32_MAX && !(spore_vec3_dot(view->direction, middle_of(mesh, cell)) > view->beyond);
}

static void add_face(const SporeTetrahedralMesh *mesh, const SporeCellView *view, size_t cell, size_t face,
                     SporeCellFaces *faces) {
  SporeVec3 middle = middle_of(mesh, cell);
  for (size_t i = 0; i < 3; i++) {
    SporeVec3 arm = spore_vec3_sub(corner_of(mesh, cell, spore_tetrahedron_faces[face][i]), middle);
    spore_vec3_store(faces->vertices + 9 * faces->triangle_count + 3 * i,
                     spore_vec3_add_scaled(middle, view->shrink, arm));
  }
  faces->cells[faces->triangle_count++] = (uint32_t)cell;
}

/* Goes through the visible faces. neighbours: NULL where all faces are wanted. Only counts the faces where no arrays
 * are allocated yet. */
static size_t go_through(const SporeTetrahedralMesh *mesh, const SporeCellView *view, const uint32_t *neighbours,
                         SporeCellFaces *faces) {
  size_t count = 0;
  for (size_t cell = 0; cell < mesh->tetrahedron_count; cell++) {
    if (!is_seen(mesh, view, (uint32_t)cell)) continue;
    for (size_t face = 0; face < 4; face++) {
      if (neighbours && is_seen(mesh, view, neighbours[4 * cell + face])) continue;
      if (faces->vertices) add_face(mesh, view, cell, face, faces);
      count++;
    }
  }
  return count;
}

bool spore_cell_faces(const SporeTetrahedralMesh *mesh, const SporeCellView *view, SporeCellFaces *faces,
                      SporeError *error) {
  uint32_t *neighbours = NULL;
  *faces = (SporeCellFaces){0};
  if (view->shrink >= 1 && !spore_tetrahedral_mesh_neighbours(mesh, &neighbours)) return spore_mesh_no_memory(error);
  size_t count = go_through(mesh, view, neighbours, faces);
  faces->vertices = SPORE_NEW_ARRAY(double, 9 * count);
  faces->cells = SPORE_NEW_ARRAY(uint32_t, count);
  bool done = faces->vertices && faces->cells;
  if (done) go_through(mesh, view, neighbours, faces);
  else spore_cell_faces_clear(faces);
  spore_free(neighbours);
  return done || spore_mesh_no_memory(error);
}

void spore_cell_faces_clear(SporeCellFaces *faces) {
  spore_free(faces->vertices);
  spore_free(faces->cells);
  *faces = (SporeCellFaces){0};
}
