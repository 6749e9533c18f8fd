/* Checks and repairs surfaces with CGAL: holes, debris, self-intersections and orientation. */
#include "app/helpers/surface_cgal.hpp"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

namespace PMP = CGAL::Polygon_mesh_processing;
using spore::Surface;

namespace {

/* As a share of the volume of all parts; smaller parts are debris. */
constexpr double least_part = 1e-6;

void require_sound(const Surface &surface) {
  if (surface.is_empty() || !CGAL::is_closed(surface))
    throw spore::Refusal{SPORE_ERROR_INPUT, N_("the surface is not closed; expected one without holes; fill them"), ""};
  if (PMP::does_self_intersect(surface))
    throw spore::Refusal{SPORE_ERROR_INPUT,
                         N_("the surface intersects itself; expected one that does not; mend or wrap it"), ""};
  if (!PMP::does_bound_a_volume(surface))
    throw spore::Refusal{SPORE_ERROR_INPUT,
                         N_("the surface bounds no volume; expected parts that lie apart or in each "
                            "other, turned alike; orient it"),
                         ""};
}

void turn_outward(Surface &surface) {
  if (CGAL::is_closed(surface)) PMP::orient_to_bound_a_volume(surface);
}

Surface stitched(const SporeFlatMesh &mesh) {
  auto points = spore::points_of(mesh);
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto &polygon : spore::polygons_of(mesh)) polygons.emplace_back(polygon.begin(), polygon.end());
  PMP::repair_polygon_soup(points, polygons);
  PMP::orient_polygon_soup(points, polygons); /* doubles vertices where sheets meet */
  Surface surface;
  PMP::polygon_soup_to_polygon_mesh(points, polygons, surface);
  PMP::stitch_borders(surface);
  PMP::duplicate_non_manifold_vertices(surface);
  return surface;
}

void fill_holes(Surface &surface) {
  std::vector<Surface::Halfedge_index> borders;
  PMP::extract_boundary_cycles(surface, std::back_inserter(borders));
  for (auto border : borders) {
    std::vector<Surface::Face_index> patch;
    PMP::triangulate_hole(surface, border, std::back_inserter(patch));
  }
}

/* Removes parts that are still open, and debris. */
void keep_volumes(Surface &surface) {
  auto part_of = surface.add_property_map<Surface::Face_index, std::size_t>("f:part", 0).first;
  const std::size_t count = PMP::connected_components(surface, part_of);
  std::vector<double> volume(count, 0);
  std::vector<bool> open(count, false);
  for (auto face : surface.faces()) {
    const auto first = surface.halfedge(face);
    for (auto halfedge : surface.halfedges_around_face(first))
      if (surface.is_border(surface.opposite(halfedge))) open[part_of[face]] = true;
    const auto corner = [&](Surface::Halfedge_index halfedge) {
      return surface.point(surface.target(halfedge)) - CGAL::ORIGIN;
    };
    const auto second = surface.next(first);
    volume[part_of[face]] +=
        CGAL::scalar_product(corner(first), CGAL::cross_product(corner(second), corner(surface.next(second)))) / 6;
  }
  double whole = 0;
  for (std::size_t i = 0; i < count; i++)
    if (!open[i]) whole += std::abs(volume[i]);
  std::vector<std::size_t> removed;
  for (std::size_t i = 0; i < count; i++)
    if (open[i] || std::abs(volume[i]) <= least_part * whole) removed.push_back(i);
  PMP::remove_connected_components(surface, removed, part_of);
  surface.remove_property_map(part_of);
}

Surface repaired(const SporeFlatMesh &mesh) {
  Surface surface = stitched(mesh);
  PMP::remove_degenerate_faces(surface);
  fill_holes(surface);
  keep_volumes(surface);
  if (PMP::does_self_intersect(surface)) {
    PMP::experimental::remove_self_intersections(surface, CGAL::parameters::preserve_genus(false));
    fill_holes(surface);
    keep_volumes(surface);
  }
  turn_outward(surface);
  surface.collect_garbage();
  return surface;
}

} // namespace

bool spore_cgal_check(const SporeFlatMesh *mesh, SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    const auto polygons = spore::polygons_of(*mesh);
    if (!PMP::is_polygon_soup_a_polygon_mesh(polygons))
      throw spore::Refusal{SPORE_ERROR_INPUT,
                           N_("triangles meet in more than pairs, or are turned against each other; "
                              "expected a closed, oriented surface; repair it"),
                           ""};
    Surface surface;
    PMP::polygon_soup_to_polygon_mesh(spore::points_of(*mesh), polygons, surface);
    turn_outward(surface);
    require_sound(surface);
  });
}

bool spore_cgal_repair(const SporeFlatMesh *mesh, SporeFlatMesh *result, SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    const Surface surface = repaired(*mesh);
    require_sound(surface);
    *result = spore::flatten(surface);
  });
}
