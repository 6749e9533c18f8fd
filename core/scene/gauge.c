/* Kinds of measures. */
#include "core/scene/gauge.h"

#include <glib/gi18n.h>

#include "core/scene/length_unit.h"

static double distance_of(const SporeVec3 *places) { return spore_vec3_distance(places[0], places[1]); }

/* By sine and cosine together, which is as precise near 0 and pi as between them; 0 where a side has no length. */
static double angle_of(const SporeVec3 *places) {
  SporeVec3 a = spore_vec3_sub(places[0], places[1]), b = spore_vec3_sub(places[2], places[1]);
  return atan2(spore_vec3_length(spore_vec3_cross(a, b)), spore_vec3_dot(a, b));
}

static char *angle_text(double angle_rad) { return g_strdup_printf("%.1f°", angle_rad * (180 / G_PI)); }

static char *volume_text(double volume_m3) {
  if (volume_m3 < 1e-7) return g_strdup_printf("%.3g mm³", 1e9 * volume_m3);
  return g_strdup_printf("%.4g cm³", 1e6 * volume_m3);
}

static const SporeGauge distance = {
    .name = "distance",
    .label = N_("Distance"),
    .place_count = 2,
    .hints = {N_("click on the first place"), N_("click on the second place")},
    .of_places = distance_of,
    .text = spore_length_text,
};

static const SporeGauge angle = {
    .name = "angle",
    .label = N_("Angle"),
    .place_count = 3,
    .hints = {N_("click on a place on its first side"), N_("click on its corner"),
              N_("click on a place on its other side")},
    .of_places = angle_of,
    .text = angle_text,
};

static const SporeGauge volume = {
    .name = "volume",
    .label = N_("Volume"),
    .place_count = 1,
    .hints = {N_("click on an organ")},
    .text = volume_text,
};

const SporeGauge *const spore_gauges[] = {&distance, &angle, &volume, NULL};

const SporeGauge *spore_gauge_find(const char *name) {
  for (const SporeGauge *const *gauge = spore_gauges; *gauge; gauge++)
    if (g_str_equal((*gauge)->name, name)) return *gauge;
  return NULL;
}

gboolean spore_gauge_volume(const SporeTriangleMesh *surface, double *volume_m3, GError **error) {
  SporeMeshReport report;
  SporeError failure = {0};
  if (!spore_triangle_mesh_report(surface, &report, &failure)) return spore_error_propagate(&failure, error);
  if (!report.closed || !surface->triangle_count)
    return spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                             _("the surface is not closed (%zu open, %zu non-manifold, %zu misoriented edges), so that "
                               "it has no volume; repair the mesh (menu Mesh), or generate a surface or tetrahedra"),
                             report.boundary_edges, report.nonmanifold_edges, report.misoriented_edges);
  *volume_m3 = fabs(report.volume);
  return TRUE;
}
