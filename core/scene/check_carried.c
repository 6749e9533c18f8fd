#include <glib/gi18n.h>

#include "core/scene/carried.h"
#include "core/scene/check_private.h"

/* Tetrahedra of 5 and of 443 cells resting on such spheres: every step solved to 20.6, not all from 25.7 on. */
#define WARNED_LEVERAGE 20.
#define WARNED_DISTANCE 0.05 /* of the geometry's size: what lies so far off is seen to swing */

static void check_spheres(SporeCheck *check, const SporeObject *body, const SporeCarried *carried) {
  if (carried->apart == 0) return;
  spore_check_say(check, carried->error.leverage > WARNED_LEVERAGE ? SPORE_WARNING : SPORE_NOTE,
                  spore_object_child_of(body, "collision"), _("generate spheres from the same mesh as the geometry"),
                  _("%zu of the %zu spheres of \"%s\" lie away from its geometry, and follow it as on a lever: up to "
                    "%.3g times as far as what carries them"),
                  carried->apart, carried->count, spore_object_name(body), carried->error.leverage);
}

static void check_frames(SporeCheck *check, const SporeObject *body, const SporeCarried *carried) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  if (carried->error.torn > 0)
    spore_check_say(check, carried->error.torn > SPORE_CARRIED_TORN ? SPORE_WARNING : SPORE_NOTE, visual,
                    _("draw a surface whose loops do not touch, or the body's own skin"),
                    _("%.3g%% of the edges drawn for \"%s\" lead from one loop of its line to another, and are torn "
                      "apart as these move"),
                    100 * carried->error.torn, spore_object_name(body));
  if (carried->error.crowd > 1)
    spore_check_say(check, SPORE_NOTE, visual,
                    _("draw a smoother surface or a smoother line; fewer control points make it smoother"),
                    _("the line of \"%s\" bends more sharply than the distance of %.3g%% of the vertices drawn around "
                      "it, up to %.3g times, near (%.3g %.3g %.3g) m: where it bends on, the surface folds on the "
                      "inside"),
                    spore_object_name(body), 100 * carried->error.crowd_share, carried->error.crowd,
                    carried->crowd_place.x, carried->crowd_place.y, carried->crowd_place.z);
}

static void check_vertices(SporeCheck *check, const SporeObject *body, const SporeCarried *carried) {
  if (carried->framed) {
    check_frames(check, body, carried);
    return;
  }
  if (carried->farthest <= WARNED_DISTANCE * carried->size && carried->error.leverage <= WARNED_LEVERAGE) return;
  g_autofree char *length = spore_length_text(carried->farthest);
  spore_check_say(check, SPORE_WARNING, spore_object_child_of(body, "visual"),
                  _("draw the mesh that the geometry was made from, or make the geometry again from the one that is "
                    "drawn, and finer"),
                  _("%.3g%% of the vertices drawn for \"%s\" lie off its geometry, by up to %s at (%.3g %.3g %.3g) m, "
                    "and swing up to %.3g times as far as what carries them"),
                  100 * (double)carried->off / (double)carried->count, spore_object_name(body), length,
                  carried->place.x, carried->place.y, carried->place.z, carried->error.leverage);
}

static void check_unit(SporeCheck *check, const SporeSimulation *simulation, SporeObject *body, SporeCarriedUnit unit) {
  SporeCarried carried;
  GError *error = NULL;
  if (spore_carried_measure(simulation, check->document, body, unit, &carried, &error)) {
    if (unit == SPORE_CARRIED_COLLISION) check_spheres(check, body, &carried);
    else check_vertices(check, body, &carried);
  } else if (error) { /* the simulation exists: only what is drawn can be refused */
    g_prefix_error(&error, _("\"%s\" is not drawn: of its mesh, "), spore_object_name(body));
    spore_check_say_error(check, SPORE_WARNING, spore_object_child_of(body, spore_carried_units[unit]), error);
    g_error_free(error);
  }
}

void spore_check_carried(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    for (int unit = 0; unit < SPORE_CARRIED_COUNT; unit++)
      check_unit(check, simulation, spore_object_child(bodies, i), (SporeCarriedUnit)unit);
}
