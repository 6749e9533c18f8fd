/* The scene as it stands, and the gestures on it.
 *
 * Left selects bodies and links, Ctrl+left pulls tissue, left beside the bodies and middle orbit, with Shift they pan,
 * the wheel zooms to the cursor, right opens a menu; M measures a distance; H hides the selected body, I shows it
 * alone, A shows all; E shows or hides the steps of the exercise; F frames, 1, 3, 7 look along the axes, 0 through the
 * scene's camera and with it, X there and back, V shows both, Escape takes a drag back. With the Lead tool, left moves
 * the instrument and takes it from its track, Shift+left turns it, the wheel moves it in depth, right closes its jaws
 * and presses its pedal; with Shift let go, they stay so; Ctrl+right opens what stays closed by itself. N and P choose
 * the instrument, arrows and Page Up and Down move it, C closes it, O opens it. With the Edit tool, left drags
 * the port of the selected instrument, and picks and
 * moves spheres and points of curves, and the chosen one's handle resizes it; the wheel and +, - resize, arrows move, N
 * and P go on, Insert adds, Delete deletes. So it does with regions, by their handles; left on the organ puts the
 * chosen one there.
 *
 * Signals
 *   picked (u body, p place)   where a click met that body while picking: const SporeVec3 *, world, m; body 0: beside
 * all bodies, as far away as the last anchor
 *   pointed (u body, p place)  where the cursor meets that body while picking: as in "picked"
 *   places-moved (p places)    a picked place was dragged elsewhere: const SporeViewportPlaces *
 *   measuring ()               a measure began, went on, was made or removed */
#ifndef SPORE_UI_VIEWPORT_SPORE_VIEWPORT_H
#define SPORE_UI_VIEWPORT_SPORE_VIEWPORT_H

#include <gtk/gtk.h>

#include "core/scene/gauge.h"
#include "ui/jobs/quality.h"
#include "ui/render/stage.h"
#include "ui/sim/spore-player.h"

G_BEGIN_DECLS

#define SPORE_TYPE_VIEWPORT spore_viewport_get_type()
G_DECLARE_FINAL_TYPE(SporeViewport, spore_viewport, SPORE, VIEWPORT, GtkOverlay)

/* Places picked on a body, shown as numbered handles. */
typedef struct SporeViewportPlaces {
  guint32 body; /* object id */
  guint count;
  double at[SPORE_GENERATOR_PLACES][3]; /* in the body's axes, m */
} SporeViewportPlaces;

typedef enum { SPORE_VIEWPORT_TOOL_SELECT, SPORE_VIEWPORT_TOOL_PROBE, SPORE_VIEWPORT_TOOL_EDIT } SporeViewportTool;

/* Handles over the picture by which what is selected is moved, turned or scaled. */
typedef enum { SPORE_GIZMO_NONE, SPORE_GIZMO_MOVE, SPORE_GIZMO_TURN, SPORE_GIZMO_SCALE } SporeGizmo;

/* What a user is used to, for all scenes. All zero: as nobody chose. */
typedef struct SporeViewportHabits {
  gboolean middle_turns_alone; /* a drag of the left button beside the bodies does not turn the view */
  gboolean wheel_goes_away;    /* upward */
  enum { SPORE_PICTURES_AUTOMATIC, SPORE_PICTURES_FINE, SPORE_PICTURES_PLAIN } pictures;
} SporeViewportHabits;
void spore_viewport_set_habits(SporeViewport *self, const SporeViewportHabits *habits);

void spore_viewport_set_document(SporeViewport *self, SporeEditorDocument *document, SporePlayer *player);
/* A scene is being opened: the welcome is hidden. */
void spore_viewport_set_waiting(SporeViewport *self, gboolean waiting);
/* The view is shown alone, to others than its author: it says what it is not for, and what is for an author is not
 * drawn. */
void spore_viewport_set_presented(SporeViewport *self, gboolean presented);
/* Puts the large controls in the middle of the view's foot; takes them. */
void spore_viewport_set_controls(SporeViewport *self, GtkWidget *controls);
void spore_viewport_set_tool(SporeViewport *self, SporeViewportTool tool);
/* Shown with the Select tool, while the scene is at its start. */
void spore_viewport_set_gizmo(SporeViewport *self, SporeGizmo gizmo);
/* Uses the Edit tool on all regions of the object that holds this one, which is chosen first. */
void spore_viewport_edit_region(SporeViewport *self, SporeObject *region);
/* Leads the next instrument, round and round. */
void spore_viewport_lead_next(SporeViewport *self);
gboolean spore_viewport_edits_regions(SporeViewport *self);
/* Paints on the body, until another tool or body is chosen. path: of a region, which is painted further, or of what
 * holds regions (spore_edit_add_region): the first stroke then adds one. */
void spore_viewport_begin_brush(SporeViewport *self, SporeObject *body, const char *path);
gboolean spore_viewport_has_brush(SporeViewport *self);
/* Whether a port of what is selected is shown, which the Edit tool moves. */
gboolean spore_viewport_has_ports(SporeViewport *self);
/* Whether the Edit tool has something to edit. */
gboolean spore_viewport_has_edited(SporeViewport *self);
/* While boxing, the next drag draws a box that selects bodies; when it ends, or is given up, win.box-select is toggled.
 */
void spore_viewport_set_boxing(SporeViewport *self, gboolean boxing);
/* While picking, a click of the left button, or the space bar for the middle of the view, emits "picked" instead of
 * selecting. */
void spore_viewport_set_picking(SporeViewport *self, gboolean picking);
/* The instrument that the Lead tool leads: the selected one, else the one before, else the first. NULL: none. */
SporeObject *spore_viewport_get_led(SporeViewport *self);
/* Shows the places; count 0: none. They can be dragged over the body's surface. */
void spore_viewport_set_places(SporeViewport *self, const SporeViewportPlaces *places);
/* Marks places that are picked so far (at most 2), each with a line to the cursor. */
void spore_viewport_set_anchors(SporeViewport *self, const SporeVec3 *places, guint count);
/* Shows the line along which an instrument would lie; count 0: none. SPORE_OUTLINE_POINTS at most. Goes with the next
 * anchors. */
void spore_viewport_set_outline(SporeViewport *self, const SporeVec3 *points, guint count);
/* The key that does this in the view; action: detailed, "win.view::top". 0: none does. */
guint spore_viewport_key_of(const char *action);
/* Scenes to begin with, for the button of the empty view, and their pictures, which are shown where there is room.
 * Takes pictures. */
void spore_viewport_set_templates(SporeViewport *self, GMenuModel *templates, GtkWidget *pictures);
/* Scenes of before, for the button of the empty view, which is there while there are any. To be called after each
 * change. */
void spore_viewport_set_recent(SporeViewport *self, GMenuModel *recent);
/* The kinds of links, for the view's button and menu. */
void spore_viewport_set_link_menu(SporeViewport *self, GMenuModel *kinds);
/* The kinds of fluids, for the view's menu. */
void spore_viewport_set_fluid_menu(SporeViewport *self, GMenuModel *kinds);
/* The kinds of instruments, as those of links, and the instruments that can be led. */
void spore_viewport_set_instrument_menu(SporeViewport *self, GMenuModel *kinds, GMenuModel *led);
/* Lays messages over the foot of the view, below the figures: the picture and its tools stay where they are. */
void spore_viewport_set_messages(SporeViewport *self, GtkWidget *messages);
/* keep_scale: the end of the scale of colours stays where it is; that of `options` is not read. */
void spore_viewport_set_options(SporeViewport *self, const SporeStageOptions *options, gboolean keep_scale);
/* Shows all ports that instruments pass through with what they reach, and tints what none of them reaches; with a port
 * or an instrument selected, what that does not reach. */
void spore_viewport_set_reach(SporeViewport *self, gboolean shown);
/* Whether the corner shows what a step costs, contacts, solver and energy, too. */
void spore_viewport_set_figures(SporeViewport *self, gboolean figures);
/* Shows a candidate over the scene, with the legend of its colours (read during the call; without values: no legend).
 * Takes the candidate; NULL: none. */
void spore_viewport_set_candidate(SporeViewport *self, SporeStageCandidate *candidate, const SporeQuality *legend);
/* Shows marks on a body; takes the segments. */
void spore_viewport_set_marks(SporeViewport *self, SporeStageMarks marks);
/* Hides bodies, or all others; shows all. bodies: of SporeObject *. Of the view alone; another document shows all. */
void spore_viewport_hide(SporeViewport *self, const GPtrArray *bodies);
void spore_viewport_isolate(SporeViewport *self, const GPtrArray *bodies);
void spore_viewport_show_all(SporeViewport *self);
void spore_viewport_hide_or_show(SporeViewport *self, const SporeObject *body);
GHashTable *spore_viewport_get_hidden(SporeViewport *self); /* set of ids as pointers; the view's own */
guint spore_viewport_hidden_count(SporeViewport *self);
/* Locks the bodies (of SporeObject *), or frees them where all of them are locked. A locked body is neither selected
 * nor pulled in the view, and stays as it is there; the outliner and the inspector have it as before. */
void spore_viewport_lock_or_unlock(SporeViewport *self, const GPtrArray *bodies);
void spore_viewport_unlock_all(SporeViewport *self);
GHashTable *spore_viewport_get_locked(SporeViewport *self); /* set of ids as pointers; the view's own */
/* Whether one of the selected bodies is locked. */
gboolean spore_viewport_is_locked(SporeViewport *self);
/* The next clicks on bodies measure; Escape goes back. What is measured follows the bodies, is listed in the view, and
 * can be removed there. Another document has none. */
void spore_viewport_measure(SporeViewport *self, const SporeGauge *gauge);
/* What the next click is for, translated, g_free; NULL: clicks do not measure. */
char *spore_viewport_measure_hint(SporeViewport *self);
guint spore_viewport_measure_count(SporeViewport *self);
/* Removes all, and ends measuring. */
void spore_viewport_clear_measures(SporeViewport *self);
/* A plane across what is shown hides what lies before it: "x", "y" or "z" along these axes, "view" always before the
 * eye, anything else none. A slider in the view moves it. */
void spore_viewport_set_cut(SporeViewport *self, const char *name);
/* Whether it hides the other side. */
void spore_viewport_turn_cut(SporeViewport *self, gboolean turned);
void spore_viewport_frame(SporeViewport *self);
/* Frames the scene at the next rebuild, when the last change is visible. */
void spore_viewport_frame_soon(SporeViewport *self);
/* "front", "right", "top", or "camera": through spore_viewport_scene_camera, following it; without a camera, the whole
 * scene. */
void spore_viewport_view(SporeViewport *self, const char *view);
/* Draws the other view, too, small in a corner: what spore_viewport_swap_views would show large. */
void spore_viewport_set_second_view(SporeViewport *self, gboolean on);
/* From the outside to the scene's camera, which is followed, and back to where the view was outside, even if the view
 * was moved meanwhile. */
void spore_viewport_swap_views(SporeViewport *self);
/* The camera of the scene that is selected, else the one that the view looks through, else the first; NULL: there is
 * none. */
SporeObject *spore_viewport_scene_camera(SporeViewport *self);
/* Writes the scene as the view shows it, without the grid and what is written over it, as a PNG. FALSE with a GError.
 */
gboolean spore_viewport_save_picture(SporeViewport *self, const char *file, GError **error);
/* How long the last picture took, ms. */
double spore_viewport_get_draw_ms(SporeViewport *self);
/* GL_RENDERER, or why nothing is drawn. */
const char *spore_viewport_get_renderer(SporeViewport *self);

G_END_DECLS
#endif
