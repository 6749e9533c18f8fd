/* Wraps a surface with CGAL: a closed surface around it, at a given distance. */
#include "app/helpers/surface_cgal.hpp"

#include <CGAL/alpha_wrap_3.h>

namespace {

/* Ends a wrap that exceeds its limit of points: the time of a wrap grows with them. */
struct Limit : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
  std::size_t *points_left;
  explicit Limit(std::size_t *room) : points_left(room) {}
  template <typename Wrapper, typename Place> void before_Steiner_point_insertion(const Wrapper &, const Place &) {
    if ((*points_left)-- == 0)
      throw spore::Refusal{SPORE_ERROR_NUMERICAL,
                           N_("a wrap as close as that has too many triangles; expected a smoother surface or wider "
                              "openings to close; simplify it, or give a wider gap"),
                           ""};
  }
};

} // namespace

bool spore_cgal_wrap(const SporeFlatMesh *surface, double alpha, double offset, std::size_t most_vertices,
                     SporeFlatMesh *result, SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    spore::Surface wrap;
    std::size_t points_left = most_vertices;
    CGAL::alpha_wrap_3(spore::points_of(*surface), spore::polygons_of(*surface), alpha, offset, wrap,
                       CGAL::parameters::default_values(), CGAL::parameters::visitor(Limit(&points_left)));
    wrap.collect_garbage();
    if (wrap.is_empty())
      throw spore::Refusal{SPORE_ERROR_NUMERICAL, N_("there is nothing to wrap; expected a surface; check the mesh"),
                           ""};
    *result = spore::flatten(wrap);
  });
}
