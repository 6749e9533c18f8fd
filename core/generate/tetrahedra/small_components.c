/* Drops small pieces of cells that are disconnected where the surface is connected. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"
#include "core/mesh/edit.h"

#define SMALL 0.02 /* of the volume: pieces above this share are kept */

/* A piece of the cells. */
typedef struct Piece {
  double volume;
  uint32_t of; /* the piece of the surface at this piece */
  bool small;
} Piece;

static double volume_of(const SporeTetrahedralMesh *mesh, size_t t) {
  SporeVec3 p[4];
  for (size_t k = 0; k < 4; k++) p[k] = spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * t + k]);
  SporeVec3 across = spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0]));
  return fabs(spore_vec3_dot(across, spore_vec3_sub(p[3], p[0]))) / 6;
}

/* A piece belongs to the piece of the surface nearest to its first corner. */
static void measure(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, const uint32_t *pieces,
                    const uint32_t *surface_pieces, Piece *found) {
  size_t known = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    Piece *piece = found + pieces[t];
    if (pieces[t] == known) {
      uint32_t triangle = 0;
      known++;
      spore_bvh_distance(work->tree, spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * t]), NULL, &triangle);
      piece->of = surface_pieces[triangle];
    }
    piece->volume += volume_of(mesh, t);
  }
}

/* Marks small pieces whose piece of the surface has a larger piece. Returns the share of the volume in marked pieces.
 */
static double mark(Piece *found, size_t count) {
  double all = 0, small = 0;
  for (size_t i = 0; i < count; i++) all += found[i].volume;
  for (size_t i = 0; i < count; i++) {
    for (size_t k = 0; k < count && !found[i].small; k++)
      found[i].small = found[i].volume < SMALL * all && found[k].of == found[i].of && found[k].volume > found[i].volume;
    if (found[i].small) small += found[i].volume;
  }
  return all > 0 ? small / all : 0;
}

static void drop(SporeTetrahedralMesh *mesh, const uint32_t *pieces, const Piece *found) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    if (found[pieces[t]].small) continue;
    if (mesh->labels) mesh->labels[kept] = mesh->labels[t];
    memmove(mesh->tetrahedra + 4 * kept++, mesh->tetrahedra + 4 * t, 4 * sizeof *mesh->tetrahedra);
  }
  mesh->tetrahedron_count = kept;
}

bool spore_tetrahedra_drop_small(const SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh,
                                 SporeTetrahedraReport *report, SporeError *error) {
  uint32_t *pieces = NULL, *surface_pieces = NULL;
  if (!spore_tetrahedral_mesh_pieces(mesh, &pieces, &report->pieces, error)) return false;
  bool done = spore_triangle_mesh_pieces(&work->surface, &surface_pieces, &report->pieces_given, error);
  Piece *found = done ? SPORE_NEW_ARRAY(Piece, report->pieces) : NULL;
  if (done && !found) done = spore_mesh_no_memory(error);
  report->small_components = 0;
  if (done && report->pieces > 1) {
    size_t count = report->pieces;
    measure(work, mesh, pieces, surface_pieces, found);
    report->small_components = mark(found, count);
    for (size_t i = 0; i < count; i++) report->pieces -= found[i].small;
    drop(mesh, pieces, found);
    done = spore_tetrahedral_mesh_drop_unused(mesh, error);
  }
  spore_free(found);
  spore_free(surface_pieces);
  spore_free(pieces);
  return done;
}
