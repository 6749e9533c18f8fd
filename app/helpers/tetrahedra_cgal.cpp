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
using spore::Point;
using Domain = CGAL::Polyhedral_mesh_domain_3<spore::Surface, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Progress = void (*)(double, const char *);

constexpr double least_angle = 10;  /* degrees, wanted */
constexpr double sliver_angle = 12; /* degrees, asked of the optimisers */
constexpr int most_sizes = 8;       /* meshes made to hit the number of cells */
constexpr double size_tolerance = 0.1;
constexpr int rays = 4000;            /* that look for the surface */
constexpr double least_volume = 0.75; /* of the surface's: a mesh below lost a part that is thinner than its cells */

struct Solid {
  const Domain &domain;
  double volume;
  std::vector<std::pair<Point, Domain::Index>> found; /* by rays: points of the surface in random order */
};

/* All criteria follow one length, the circumradius bound of cells, so that meshes of two lengths look alike. */
Criteria criteria_of(double length) {
  return Criteria(with::facet_angle = 25, with::facet_size = length, with::facet_distance = 0.1 * length,
                  with::cell_radius_edge_ratio = 2, with::cell_size = length);
}

/* Points of the surface no nearer to each other than `distance`: refinement starts from all over it, and so misses no
 * thin part. */
void insert_cover(const Solid &solid, double distance, Complex &mesh) {
  std::vector<Point> taken;
  const auto weighted = mesh.triangulation().geom_traits().construct_weighted_point_3_object();
  for (const auto &[point, index] : solid.found) {
    bool near = false;
    for (const Point &other : taken) near = near || CGAL::squared_distance(other, point) < distance * distance;
    if (near) continue;
    taken.push_back(point);
    const auto vertex = mesh.triangulation().insert(weighted(point));
    mesh.set_dimension(vertex, 2);
    mesh.set_index(vertex, index);
  }
}

/* FALSE: it takes more than `most_vertices`. */
bool refine(const Solid &solid, double length, std::size_t most_vertices, Complex &mesh) {
  CGAL::Mesh_error_code status = CGAL::CGAL_MESH_3_NO_ERROR;
  insert_cover(solid, 1.5 * length, mesh);
  CGAL::refine_mesh_3(
      mesh, solid.domain, criteria_of(length), with::no_perturb(), with::no_exude(), with::no_reset_c3t3(),
      with::mesh_3_options(with::maximal_number_of_vertices = most_vertices, with::pointer_to_error_code = &status));
  return status == CGAL::CGAL_MESH_3_NO_ERROR;
}

double smallest_angle(const Complex &mesh) {
  double least = 180;
  const auto &triangulation = mesh.triangulation();
  for (auto cell = mesh.cells_in_complex_begin(); cell != mesh.cells_in_complex_end(); ++cell) {
    Point p[4];
    for (int i = 0; i < 4; i++) p[i] = triangulation.geom_traits().construct_point_3_object()(cell->vertex(i)->point());
    static const int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    for (const int *e : edges)
      least = std::min(least, std::abs(CGAL::approximate_dihedral_angle(p[e[0]], p[e[1]], p[e[2]], p[e[3]])));
  }
  return least;
}

double volume_of(const Complex &mesh) {
  double volume = 0;
  for (auto cell = mesh.cells_in_complex_begin(); cell != mesh.cells_in_complex_end(); ++cell)
    volume += mesh.triangulation().tetrahedron(cell).volume();
  return volume;
}

/* The length that gives about `cells`: secant steps on the logarithm of the number, which is nearly a line of slope -3
 * (solid) to -2 (thin wall). Where so few cells cannot make the shape, the fewest that do are taken. */
double length_for(const Solid &solid, std::size_t cells, Progress progress) {
  const std::size_t most_vertices = 3 * cells + 3000;
  double length = 1.25 * std::cbrt(solid.volume / static_cast<double>(cells)), best = 0, best_gap = 1e300;
  double known_length = 0, known_count = 0, slope = -2.8;
  for (int i = 0; i < most_sizes && best_gap > size_tolerance; i++) {
    progress(0.1 + 0.4 * i / most_sizes, N_("finding the size of the cells"));
    Complex mesh;
    if (!refine(solid, length, most_vertices, mesh)) {
      length *= 1.6;
      continue;
    }
    const double count = static_cast<double>(mesh.number_of_cells_in_complex());
    if (volume_of(mesh) < least_volume * solid.volume) {
      length *= 0.8;
      continue;
    }
    const double gap = std::log(count / static_cast<double>(cells));
    if (std::abs(gap) < best_gap) best_gap = std::abs(gap), best = length;
    if (known_length > 0 && std::abs(std::log(length / known_length)) > 1e-3)
      slope = std::log(count / known_count) / std::log(length / known_length);
    slope = std::clamp(slope, -4.0, -1.0);
    known_length = length, known_count = count;
    length *= std::exp(std::clamp(-gap / slope, -1.0, 1.0));
  }
  if (best == 0)
    throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                         N_("the surface is too thin or too creased for so few cells; expected cells "
                            "finer than its walls; ask for more, or simplify the surface"),
                         ""};
  return best;
}

/* Ways to better a mesh, tried in turn until the angles are wide enough. None depends on the clock. */
const struct {
  double length;
  bool smooth;
} ways[] = {{1, true}, {1, false}, {0.97, true}, {1.03, true}, {0.94, true}};

Complex best_of(const Solid &solid, double length, std::size_t most_vertices, Progress progress) {
  Complex best;
  double best_angle = -1, fraction = 0.5;
  for (const auto &way : ways) {
    progress(fraction, N_("meshing and bettering the cells"));
    fraction += 0.1;
    Complex mesh;
    if (!refine(solid, way.length * length, most_vertices, mesh) || !mesh.number_of_cells_in_complex()) continue;
    if (way.smooth) CGAL::odt_optimize_mesh_3(mesh, solid.domain, with::max_iteration_number = 50);
    CGAL::perturb_mesh_3(mesh, solid.domain, with::sliver_bound = sliver_angle);
    CGAL::exude_mesh_3(mesh, with::sliver_bound = sliver_angle);
    const double angle = mesh.number_of_cells_in_complex() ? smallest_angle(mesh) : -1;
    if (angle > best_angle) best_angle = angle, best.swap(mesh);
    if (best_angle >= least_angle) break;
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

bool spore_cgal_tetrahedra(const SporeFlatMesh *mesh, std::size_t cells, double size, Progress progress,
                           SporeFlatMesh *result, SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    spore::Surface surface;
    PMP::polygon_soup_to_polygon_mesh(spore::points_of(*mesh), spore::polygons_of(*mesh), surface);
    const Domain domain(surface, &CGAL::get_default_random());
    Solid solid = {domain, std::abs(PMP::volume(surface)), {}};
    domain.construct_initial_points_object()(std::back_inserter(solid.found), rays);
    const double length = cells ? length_for(solid, cells, progress) : 0.7 * size;
    const double expected = cells ? static_cast<double>(cells) : solid.volume / (0.12 * size * size * size);
    const Complex best = best_of(solid, length, static_cast<std::size_t>(10 * expected) + 10000, progress);
    if (!best.number_of_cells_in_complex())
      throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                           N_("no cell fits in; expected cells finer than the walls; ask for more cells "
                              "or a smaller size"),
                           ""};
    *result = flattened(best);
  });
}
