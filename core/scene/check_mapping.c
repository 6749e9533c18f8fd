/* Checks of what follows a body: drawn vertices and collision spheres that lie off the geometry that moves them. */
#include <glib/gi18n.h>

#include "core/scene/mapping_quality.h"
#include "core/scene/check_private.h"

/* Measured with 5 and with 443 tetrahedra that rest on such spheres: up to a leverage of 20.6 every step was solved;
 * from 25.7 on, some steps were not. */
#define WARNED_LEVERAGE 20.
#define WARNED_DISTANCE 0.05 /* of the geometry's size: a point that far off swings visibly */

static void check_spheres(SporeCheck *check, const SporeObject *body, const SporeMappingQuality *quality) {
  if (quality->apart == 0) return;
  spore_check_say(check, quality->error.leverage > WARNED_LEVERAGE ? SPORE_WARNING : SPORE_NOTE,
                  spore_object_child_of(body, "collision"), _("generate spheres from the same mesh as the geometry"),
                  _("%zu of the %zu spheres of \"%s\" lie away from its geometry, and follow it as on a lever: up to "
                    "%.3g times as far as what carries them"),
                  quality->apart, quality->count, spore_object_name(body), quality->error.leverage);
}

static void check_frames(SporeCheck *check, const SporeObject *body, const SporeMappingQuality *quality) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  if (quality->error.torn > 0)
    spore_check_say(check, quality->error.torn > SPORE_MAPPING_QUALITY_TORN ? SPORE_WARNING : SPORE_NOTE, visual,
                    _("draw a surface whose loops do not touch, or the body's own skin"),
                    _("%.3g%% of the edges drawn for \"%s\" lead from one loop of its line to another, and are torn "
                      "apart as these move"),
                    100 * quality->error.torn, spore_object_name(body));
  if (quality->error.crowd > 1)
    spore_check_say(check, SPORE_NOTE, visual,
                    _("draw a smoother surface or a smoother line; fewer control points make it smoother"),
                    _("the line of \"%s\" bends more sharply, over five radii, than the distance of %.3g%% of the "
                      "vertices drawn around "
                      "it, up to %.3g times, near (%.3g %.3g %.3g) m: where it bends on, the surface folds on the "
                      "inside"),
                    spore_object_name(body), 100 * quality->error.crowd_share, quality->error.crowd,
                    quality->crowd_place.x, quality->crowd_place.y, quality->crowd_place.z);
}

static void check_vertices(SporeCheck *check, const SporeObject *body, const SporeMappingQuality *quality) {
  if (quality->framed) {
    check_frames(check, body, quality);
    return;
  }
  if (quality->farthest <= WARNED_DISTANCE * quality->size && quality->error.leverage <= WARNED_LEVERAGE) return;
  g_autofree char *length = spore_length_text(quality->farthest);
  spore_check_say(check, SPORE_WARNING, spore_object_child_of(body, "visual"),
                  _("draw the mesh that the geometry was made from, or make the geometry again from the one that is "
                    "drawn, and finer"),
                  _("%.3g%% of the vertices drawn for \"%s\" lie off its geometry, by up to %s at (%.3g %.3g %.3g) m, "
                    "and swing up to %.3g times as far as what carries them"),
                  100 * (double)quality->off / (double)quality->count, spore_object_name(body), length,
                  quality->place.x, quality->place.y, quality->place.z, quality->error.leverage);
}

static void check_unit(SporeCheck *check, const SporeSimulation *simulation, SporeObject *body, SporeMappedUnit unit) {
  SporeMappingQuality quality;
  GError *error = NULL;
  if (spore_mapping_quality_measure(simulation, check->document, body, unit, &quality, &error)) {
    if (unit == SPORE_MAPPED_COLLISION) check_spheres(check, body, &quality);
    else check_vertices(check, body, &quality);
  } else if (error) { /* spheres that cannot be mapped have stopped the compilation before: this is the drawn mesh */
    g_prefix_error(&error, _("\"%s\" is not drawn: of its mesh, "), spore_object_name(body));
    spore_check_say_error(check, SPORE_WARNING, spore_object_child_of(body, spore_mapped_unit_names[unit]), error);
    g_error_free(error);
  }
}

void spore_check_mapping(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    for (int unit = 0; unit < SPORE_MAPPED_UNITS; unit++)
      check_unit(check, simulation, spore_object_child(bodies, i), (SporeMappedUnit)unit);
}
