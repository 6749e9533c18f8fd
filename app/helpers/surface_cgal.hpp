/* What the CGAL files share: the kernel, conversion between flat arrays and surface meshes, and exceptions. */
#ifndef SPORE_HELPERS_SURFACE_CGAL_HPP
#define SPORE_HELPERS_SURFACE_CGAL_HPP

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>

#include "app/helpers/cgal.h"

#define N_(text) text

namespace spore {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Polygon = std::array<std::size_t, 3>;

struct Refusal {
  SporeErrorCode code;
  const char *message;
  std::string detail;
};

template <class T> T *allocate(std::size_t count) {
  T *memory = static_cast<T *>(std::malloc((count ? count : 1) * sizeof(T)));
  if (!memory) throw std::bad_alloc();
  return memory;
}

inline std::vector<Point> points_of(const SporeFlatMesh &mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertex_count);
  for (std::size_t i = 0; i < mesh.vertex_count; i++)
    points.emplace_back(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]);
  return points;
}

inline std::vector<Polygon> polygons_of(const SporeFlatMesh &mesh) {
  std::vector<Polygon> polygons;
  polygons.reserve(mesh.cell_count);
  for (std::size_t i = 0; i < mesh.cell_count; i++)
    polygons.push_back({mesh.corners[3 * i], mesh.corners[3 * i + 1], mesh.corners[3 * i + 2]});
  return polygons;
}

/* `surface` has no garbage. */
inline SporeFlatMesh flatten(const Surface &surface) {
  SporeFlatMesh mesh = {surface.number_of_vertices(), surface.number_of_faces(),
                        allocate<double>(3 * surface.number_of_vertices()),
                        allocate<uint32_t>(3 * surface.number_of_faces())};
  std::size_t at = 0;
  for (auto vertex : surface.vertices())
    for (int axis = 0; axis < 3; axis++) mesh.vertices[at++] = surface.point(vertex)[axis];
  at = 0;
  for (auto face : surface.faces())
    for (auto vertex : surface.vertices_around_face(surface.halfedge(face)))
      mesh.corners[at++] = static_cast<uint32_t>(static_cast<std::size_t>(vertex));
  return mesh;
}

inline bool fail(SporeHelperFailure *failure, SporeErrorCode code, const char *message, const char *detail) {
  failure->code = code;
  failure->message = message;
  std::snprintf(failure->detail, sizeof failure->detail, "%s", detail);
  return false;
}

/* Runs `work` with a fixed seed for random numbers, and turns exceptions into failures. */
template <class Work> bool guarded(SporeHelperFailure *failure, Work work) {
  try {
    CGAL::get_default_random() = CGAL::Random(1);
    work();
    return true;
  } catch (const Refusal &refusal) {
    return fail(failure, refusal.code, refusal.message, refusal.detail.c_str());
  } catch (const std::bad_alloc &) {
    return fail(
        failure, SPORE_ERROR_MEMORY,
        N_("it needs more memory than it may have; expected fewer cells; ask for fewer, or decimate the surface"), "");
  } catch (const std::exception &exception) {
    return fail(failure, SPORE_ERROR_NUMERICAL, N_("the mesher gave up; expected a sounder surface; repair it"),
                exception.what());
  }
}

} // namespace spore

#endif
