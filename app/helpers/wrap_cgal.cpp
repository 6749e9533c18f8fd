#include "app/helpers/surface_cgal.hpp"

#include <CGAL/alpha_wrap_3.h>

bool spore_cgal_wrap(const SporeFlatMesh *surface, double alpha, double offset, SporeFlatMesh *result,
                     SporeHelperFailure *failure) {
  return spore::guarded(failure, [=] {
    spore::Surface wrap;
    CGAL::alpha_wrap_3(spore::points_of(*surface), spore::polygons_of(*surface), alpha, offset, wrap);
    wrap.collect_garbage();
    if (wrap.is_empty())
      throw spore::Refusal{SPORE_ERROR_NUMERICAL, N_("there is nothing to wrap; expected a surface; check the mesh"),
                           ""};
    *result = spore::flatten(wrap);
  });
}
