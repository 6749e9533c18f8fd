/* A window on one scene.
 *
 * Its actions are the whole of what menus, keys and buttons do, and may be driven over D-Bus (org.gtk.Actions on
 * /org/spore/Editor/window/N). Parameters in brackets, s: text, u: number.
 *
 *   files       new, new-from [s template: organ, thread, fluid, net, instrument or effect], open [s path],
 *               open-dialog, open-demo, import [s path, s unit, s frame], import-dialog,
 *               import-dialog-with [as paths], save, save-as [s path], save-as-dialog, save-recording [s path],
 *               save-recording-dialog, keep-recording (in the scene), repeat-recording [s path],
 *               repeat-recording-dialog, save-picture [s path], save-picture-dialog,
 *               save-film [s path], save-film-dialog, save-numbers [s path], save-numbers-dialog, save-plot [s path],
 *               save-plot-dialog, export [s format, s path, d time, s, d time between moments, s], export-dialog,
 *               close, locate [s missing file, as the scene names it, s path], locate-dialog
 *   edit        fix (the selected problem), undo, redo, select [s path], rename [s name], rename-dialog, delete,
 *               fix-said (the problem that the message tells of),
 *               delete-alone (assets and steps of the exercise stay), keep-along (what the last delete took besides),
 *               rename-row (of the outliner, folders too), new-folder (of the selected bodies),
 *               put-in-folder [s folder, "": none], move-row [i -1 or 1] (of what is selected, in its list),
 *               set-property [s path, s name, s value],
 *               unset-property [s path, s name], set-model [s element], use-preset [s name],
 *               add-instrument [s kind of the library] (its places are picked), lead [s body; state: the instrument
 *               that is led], lead-next, add-fluid [s kind of the library] (its place is picked), add-pin,
 *               add-region [s path of what holds it], place-region [s path] (in the view), paint-region [s path of a
 * region, or of what holds them] (likewise), remove-region [s path], add-level [s "coarse" or "medium"] (to the
 * selected body), remove-level [s path], add-link [s element], tie-link (the selected one), pick-back, pick-done,
 *               patient [s position; state, "": none], gizmo [s "none", "move", "turn" or "scale"; state] (of what is
 *               selected), align [s "x-least", "y-middle", "z-greatest" or the like] (the others with the first),
 *               mirror [s "x-scene", "y-own" or the like] (a copy of the selected body, in the middle of either),
 *               duplicate (the selected bodies)
 *   generators  generate-K [u count] (at once), preview-K [u count] (0: as before) for K of spheres, tetrahedra, curve,
 *               surface; preview-labels [s path], preview-labels-dialog, make-labels; pick-places (state),
 *               automatic-places; apply-generated, cancel-job
 *   mesh        change-mesh [s operation, d argument], change-mesh-dialog [s operation]: of the selected mesh or body;
 *               lay-picture [s path], lay-picture-dialog: over the selected body; measure-mapping: of it
 *   study       measure-accuracy, choose-point [u index in the report], apply-point, save-study [s path, which ends in
 *               .html, .csv or .svg], save-study-dialog [s ".html", ".csv" or ".svg"], save-plan [s path],
 *               save-plan-dialog
 *   exercise    add-step [s element], aim-step, add-metric [s element], move-part [i -1 or 1], remove-part (the
 *               selected one), set-threshold [s path, s "good" or "pass", s number and unit], skip-to-step,
 *               repeat-attempt [x when it ended, s since 1970],
 *               film-attempts [s path, ax when they ended, s since 1970: one, or two side by side],
 *               film-attempts-dialog [ax],
 *               save-exercise [s path, which ends in .html, .csv or .json], save-exercise-dialog [s suffix]
 *   simulation  play, pause, play-pause, step, reset, step-back, go-to [d time, s], replay, stay (where it is, on its
 *               way to another time), bookmark, keep-pose (the scene begins as it is now), forget-pose,
 *               speed [s factor, "0": as fast as it goes; state],
 *               plot [s quantity], watch [s BODY@X,Y,Z], forget-points
 *   view        tool [s "select", "probe" or "edit"; state], show-surfaces, show-spheres, show-tetrahedra,
 *               show-contacts, show-links, show-reach, show-figures (state), box-select (state: of the next drag),
 *               colours [s "none", "strain", "stress", "velocity", "level" or "cells"; state],
 *               keep-scale (state: of the colours), frame,
 *               view [s "camera", "front", "back", "right", "left", "top" or "bottom"],
 *               show-outliner, show-inspector, show-problems, show-tab [s name of a tab below the view],
 *               present (state), show-guide (state: the steps of the
 *               exercise while present is on), filter, hide, isolate (the selected bodies),
 *               hide-or-show [s path of a body], show-all, lock (the selected bodies, or frees them),
 *               lock-or-unlock [s path of a body], unlock-all, measure [s "distance", "angle" or "volume"],
 *               swap-views (to the scene's camera and back), second-view (state: the other one, too),
 *               turn-optic [d degrees] (of the camera that is selected, looked through, or the first),
 *               wipe-lens (of the same),
 *               clear-measures, cut [s "none", "view", "x", "y" or "z"; state], cut-other-side (state)
 *   others      search (for any of these), open-menu, report [s message], close-message (the one that is shown);
 *               of the application:
 *               preferences, reset-preferences, look, language, turning, wheel, pictures, keeping [s choice,
 *               see document/preferences.c; state], new-window, about, quit
 *
 * Paths are those of objects: "bodies/liver/collision". */
#ifndef SPORE_UI_SPORE_WINDOW_H
#define SPORE_UI_SPORE_WINDOW_H

#include <gtk/gtk.h>

#include "core/scene/schema.h"

G_BEGIN_DECLS

#define SPORE_TYPE_WINDOW spore_window_get_type()
G_DECLARE_FINAL_TYPE(SporeWindow, spore_window, SPORE, WINDOW, GtkApplicationWindow)

/* schema: borrowed. scenes: folder of the scenes that ship, where the demo is. */
SporeWindow *spore_window_new(GtkApplication *application, const SporeSchema *schema, const char *scenes);
/* Reads the scene without holding up the window. */
void spore_window_open(SporeWindow *self, const char *file);
/* What makes the pictures of the view, or why nothing is drawn. */
const char *spore_window_get_renderer(SporeWindow *self);
/* TRUE: nothing was made or opened in this window. */
gboolean spore_window_is_fresh(SporeWindow *self);
/* Offers what a dead owner left, if any, one after the other, the newest first. */
void spore_window_offer_recovery(SporeWindow *self);

G_END_DECLS
#endif
