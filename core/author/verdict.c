#include "core/author/verdict.h"

#include <glib/gi18n.h>
#include <math.h>

/* A bounding set is made to hold all of the organ, and is judged by that alone. */
static char *bounding_verdict(const SporeSpheresReport *report) {
  if (report->certified) return g_strdup(_("Good: all of the organ is inside, proven"));
  return g_strdup_printf(_("Not proven to hold all of the organ: %.1f %% is outside the spheres"),
                         100 * (1 - report->coverage));
}

char *spore_spheres_verdict(const SporeSpheresOptions *options, const SporeSpheresReport *report, size_t count) {
  const double error = spore_spheres_felt_error(report);
  if (options->each_cell) return NULL;
  if (options->mode == SPORE_SPHERES_BOUNDING) return bounding_verdict(report);
  if (!(error > 0)) return NULL;
  if (error <= SPORE_SPHERES_GOOD) return g_strdup(_("Good: instruments feel the organ where it is drawn"));
  /* The error falls as the square root of their number or a little faster (liver, spleen: 10 to 400 spheres). */
  double wanted = fmin(ceil((double)count * pow(error / SPORE_SPHERES_GOOD, 2) / 10) * 10, SPORE_SPHERES_MAXIMUM);
  return g_strdup_printf(error <= SPORE_SPHERES_COARSE ? _("Fair: about %.0f spheres would be good")
                                                       : _("Coarse: about %.0f spheres would be good"),
                         wanted);
}

char *spore_tetrahedra_verdict(const SporeTetrahedraReport *report) {
  if (report->quality.min_dihedral_deg < SPORE_CELLS_GOOD_ANGLE_DEG)
    return g_strdup(report->method == SPORE_TETRAHEDRA_VOXELS
                        ? _("Thin cells: they are solved slowly and less truly; try another number")
                        : _("Thin cells: they are solved slowly and less truly; try the method voxels"));
  if (report->hausdorff > SPORE_CELLS_GOOD_ERROR)
    return g_strdup(_("Coarse: more tetrahedra come nearer to the organ"));
  return g_strdup(_("Good: no thin cells, and near to the organ"));
}

char *spore_spheres_other_text(gboolean fitted, size_t count, const SporeSpheresReport *report) {
  return g_strdup_printf(fitted
                             ? _("Fitted instead: %zu spheres, coverage %.1f %%, outside %.1f %%, depth error %.1f %%, "
                                 "distance %.2f %%, %.1f s")
                             : _("One round each tetrahedron instead: %zu spheres, coverage %.1f %%, outside %.1f %%, "
                                 "depth error %.1f %%, distance %.2f %%, %.1f s"),
                         count, 100 * report->coverage, 100 * report->outside, 100 * spore_spheres_felt_error(report),
                         100 * report->distance_mean, report->seconds);
}
