/* Fills a closed surface with tetrahedra by the Delaunay refinement of CGAL. */
#include "app/helpers/surface_cgal.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/make_mesh_3.h>

namespace PMP = CGAL::Polygon_mesh_processing;
namespace with = CGAL::parameters;

namespace {

using spore::Kernel;
using spore::Point;
using Domain = CGAL::Polyhedral_mesh_domain_3<spore::Surface, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr double sliver_angle = 12;    /* degrees, asked of the optimisers */
constexpr int samples = 20000;         /* of the surface, from which refinement starts */
constexpr double cover_distance = 1.5; /* of the local size: distance between the points that refinement starts from */

/* The size at a point, times a factor. All criteria follow one field, so that meshes at different scales look alike. */
struct Field {
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = Domain::Index;
  const SporeSizing *sizing;
  double factor;
  FT at(const Point &p) const {
    const double x[3] = {p.x(), p.y(), p.z()};
    return factor * spore_sizing_at(sizing, x);
  }
  FT operator()(const Point_3 &p, int, const Index &) const { return at(p); }
};

Criteria criteria_of(const SporeSizing &sizing) {
  const Field size = {&sizing, 1}, distance = {&sizing, 0.1};
  return Criteria(with::facet_angle = 25, with::facet_size = size, with::facet_distance = distance,
                  with::cell_radius_edge_ratio = 2, with::cell_size = size);
}

/* Points spread over the surface in proportion to area, in random order. */
std::vector<Point> samples_of(const spore::Surface &surface) {
  std::vector<double> area_before;
  std::vector<spore::Surface::Face_index> faces;
  double area = 0;
  const auto corner = [&](spore::Surface::Halfedge_index h) { return surface.point(surface.target(h)); };
  for (auto face : surface.faces()) {
    const auto h = surface.halfedge(face);
    area_before.push_back(area);
    faces.push_back(face);
    area += std::sqrt(CGAL::squared_area(corner(h), corner(surface.next(h)), corner(surface.prev(h))));
  }
  std::vector<Point> points;
  CGAL::Random &random = CGAL::get_default_random();
  for (int i = 0; i < samples && area > 0; i++) {
    const auto after = std::upper_bound(area_before.begin(), area_before.end(), area * random.get_double());
    const auto h = surface.halfedge(faces[static_cast<std::size_t>(after - area_before.begin()) - 1]);
    double u = random.get_double(), v = random.get_double();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Point a = corner(h);
    points.push_back(a + u * (corner(surface.next(h)) - a) + v * (corner(surface.prev(h)) - a));
  }
  return points;
}

/* Points of the surface, at least a distance apart that follows the sizing. Refinement starts from all over the
 * surface, so it misses no thin part. */
void insert_cover(const spore::Surface &surface, const Domain &domain, const Field &size, Complex &mesh) {
  std::vector<std::pair<Point, Domain::Index>> hit;
  domain.construct_initial_points_object()(std::back_inserter(hit), 1);
  if (hit.empty()) return;
  std::vector<Point> taken;
  const auto weighted = mesh.triangulation().geom_traits().construct_weighted_point_3_object();
  for (const Point &point : samples_of(surface)) {
    const double distance = cover_distance * size.at(point);
    bool near = false;
    for (const Point &other : taken)
      if ((near = CGAL::squared_distance(other, point) < distance * distance)) break;
    if (near) continue;
    taken.push_back(point);
    const auto vertex = mesh.triangulation().insert(weighted(point));
    mesh.set_dimension(vertex, 2);
    mesh.set_index(vertex, hit.front().second);
  }
}

void refine(const spore::Surface &surface, const Domain &domain, const SporeSizing &sizing, std::size_t most_vertices,
            Complex &mesh) {
  CGAL::Mesh_error_code status = CGAL::CGAL_MESH_3_NO_ERROR;
  insert_cover(surface, domain, {&sizing, 1}, mesh);
  CGAL::refine_mesh_3(
      mesh, domain, criteria_of(sizing), with::no_perturb(), with::no_exude(), with::no_reset_c3t3(),
      with::mesh_3_options(with::maximal_number_of_vertices = most_vertices, with::pointer_to_error_code = &status));
  if (status != CGAL::CGAL_MESH_3_NO_ERROR)
    throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                         N_("it takes many more nodes than were expected; expected a smoother surface or larger "
                            "cells; simplify it, or ask for fewer cells"),
                         ""};
}

SporeFlatMesh flattened(const Complex &mesh) {
  const auto &traits = mesh.triangulation().geom_traits();
  std::unordered_map<Complex::Vertex_handle, uint32_t> number;
  std::vector<double> vertices;
  std::vector<uint32_t> corners;
  for (auto cell = mesh.cells_in_complex_begin(); cell != mesh.cells_in_complex_end(); ++cell)
    for (int i = 0; i < 4; i++) {
      const auto known = number.emplace(cell->vertex(i), static_cast<uint32_t>(number.size()));
      corners.push_back(known.first->second);
      if (!known.second) continue;
      const Point p = traits.construct_point_3_object()(cell->vertex(i)->point());
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    }
  SporeFlatMesh flat = {vertices.size() / 3, corners.size() / 4, spore::allocate<double>(vertices.size()),
                        spore::allocate<uint32_t>(corners.size())};
  std::copy(vertices.begin(), vertices.end(), flat.vertices);
  std::copy(corners.begin(), corners.end(), flat.corners);
  return flat;
}

} // namespace

bool spore_cgal_mesh(const SporeFlatMesh *flat, const SporeSizing *sizing, SporeTetrahedraFinish finish,
                     std::size_t most_vertices, void (*progress)(double, const char *), SporeFlatMesh *result,
                     SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    spore::Surface surface;
    PMP::polygon_soup_to_polygon_mesh(spore::points_of(*flat), spore::polygons_of(*flat), surface);
    const Domain domain(surface, &CGAL::get_default_random());
    Complex mesh;
    progress(0, N_("refining the cells"));
    refine(surface, domain, *sizing, most_vertices, mesh);
    progress(0.5, N_("bettering the cells"));
    if (finish & SPORE_TETRAHEDRA_SMOOTH) CGAL::odt_optimize_mesh_3(mesh, domain, with::max_iteration_number = 50);
    if (finish & SPORE_TETRAHEDRA_PERTURB) CGAL::perturb_mesh_3(mesh, domain, with::sliver_bound = sliver_angle);
    if (finish & SPORE_TETRAHEDRA_EXUDE) CGAL::exude_mesh_3(mesh, with::sliver_bound = sliver_angle);
    if (!mesh.number_of_cells_in_complex())
      throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                           N_("no cell fits in; expected cells finer than the walls; ask for more cells "
                              "or a smaller size"),
                           ""};
    *result = flattened(mesh);
  });
}
