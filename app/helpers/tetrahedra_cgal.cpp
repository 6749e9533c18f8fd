#include "app/helpers/surface_cgal.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/make_mesh_3.h>

namespace PMP = CGAL::Polygon_mesh_processing;
namespace with = CGAL::parameters;

namespace {

using spore::Kernel;
using Domain = CGAL::Polyhedral_mesh_domain_3<spore::Surface, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Progress = void (*)(double, const char *);

constexpr double least_angle = 10;  /* degrees, wanted */
constexpr double sliver_angle = 14; /* degrees, asked of the optimisers */
constexpr int most_sizes = 7;       /* meshes made to hit the number of cells */
constexpr double size_tolerance = 0.1;

/* All criteria follow one length, the circumradius bound of cells, so that meshes of two lengths look alike. */
Criteria criteria_of(double length) {
  return Criteria(with::facet_angle = 25, with::facet_size = length, with::facet_distance = 0.15 * length,
                  with::cell_radius_edge_ratio = 2, with::cell_size = length);
}

Complex refined(const Domain &domain, double length) {
  return CGAL::make_mesh_3<Complex>(domain, criteria_of(length), with::no_perturb(), with::no_exude());
}

double smallest_angle(const Complex &mesh) {
  double least = 180;
  const auto &triangulation = mesh.triangulation();
  for (auto cell = mesh.cells_in_complex_begin(); cell != mesh.cells_in_complex_end(); ++cell) {
    spore::Point p[4];
    for (int i = 0; i < 4; i++) p[i] = triangulation.geom_traits().construct_point_3_object()(cell->vertex(i)->point());
    static const int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    for (const int *e : edges)
      least = std::min(least, std::abs(CGAL::approximate_dihedral_angle(p[e[0]], p[e[1]], p[e[2]], p[e[3]])));
  }
  return least;
}

/* The length that gives about `cells`: secant steps on the logarithm of the number, which is nearly a line of slope -3
 * (solid) to -2 (thin wall). Too few cells for the shape cannot be had; the nearest is taken. */
double length_for(const Domain &domain, std::size_t cells, double volume, Progress progress) {
  double length = std::cbrt(volume / (0.12 * static_cast<double>(cells))) * 0.62, best = length, best_gap = 1e300;
  double known_length = 0, known_count = 0, slope = -2.8;
  for (int i = 0; i < most_sizes; i++) {
    progress(0.1 + 0.4 * i / most_sizes, N_("finding the size of the cells"));
    const double count =
        static_cast<double>(std::max<std::size_t>(refined(domain, length).number_of_cells_in_complex(), 1));
    const double gap = std::log(count / static_cast<double>(cells));
    if (std::abs(gap) < best_gap) best_gap = std::abs(gap), best = length;
    if (best_gap < size_tolerance) break;
    if (known_length > 0 && std::abs(std::log(length / known_length)) > 1e-3)
      slope = std::log(count / known_count) / std::log(length / known_length);
    slope = std::clamp(slope, -4.0, -1.0);
    known_length = length, known_count = count;
    length *= std::exp(std::clamp(-gap / slope, -1.0, 1.0));
  }
  return best;
}

/* Ways to better a mesh, tried in turn until the angles are wide enough. None depends on the clock. */
Complex bettered(const Domain &domain, double length, int way) {
  Complex mesh = refined(domain, way == 2 ? 0.97 * length : length);
  if (way != 1) CGAL::odt_optimize_mesh_3(mesh, domain, with::max_iteration_number = 50);
  CGAL::perturb_mesh_3(mesh, domain, with::sliver_bound = sliver_angle);
  CGAL::exude_mesh_3(mesh, with::sliver_bound = sliver_angle);
  return mesh;
}

Complex best_of(const Domain &domain, double length, Progress progress) {
  Complex best;
  double best_angle = -1;
  for (int way = 0; way < 3 && best_angle < least_angle; way++) {
    progress(0.5 + 0.15 * way, N_("meshing and bettering the cells"));
    Complex mesh = bettered(domain, length, way);
    const double angle = mesh.number_of_cells_in_complex() ? smallest_angle(mesh) : -1;
    if (angle > best_angle) best_angle = angle, best.swap(mesh);
  }
  return best;
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
      const spore::Point p = traits.construct_point_3_object()(cell->vertex(i)->point());
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    }
  SporeFlatMesh flat = {vertices.size() / 3, corners.size() / 4, spore::allocate<double>(vertices.size()),
                        spore::allocate<uint32_t>(corners.size())};
  std::copy(vertices.begin(), vertices.end(), flat.vertices);
  std::copy(corners.begin(), corners.end(), flat.corners);
  return flat;
}

} // namespace

bool spore_cgal_tetrahedra(const SporeFlatMesh *mesh, std::size_t cells, double size, Progress progress,
                           SporeFlatMesh *result, SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    spore::Surface surface;
    PMP::polygon_soup_to_polygon_mesh(spore::points_of(*mesh), spore::polygons_of(*mesh), surface);
    const Domain domain(surface, &CGAL::get_default_random());
    const double length = cells ? length_for(domain, cells, std::abs(PMP::volume(surface)), progress) : 0.7 * size;
    const Complex best = best_of(domain, length, progress);
    if (!best.number_of_cells_in_complex())
      throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                           N_("no cell fits in; expected cells finer than the walls; ask for more cells "
                              "or a smaller size"),
                           ""};
    *result = flattened(best);
  });
}
