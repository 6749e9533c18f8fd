/* Inside the viewport: its state, and its files from the lowest up. Each calls only those before it. */
#ifndef SPORE_UI_VIEWPORT_SPORE_VIEWPORT_PRIVATE_H
#define SPORE_UI_VIEWPORT_SPORE_VIEWPORT_PRIVATE_H

#include "core/author/instrument_edits.h"
#include "core/author/placement.h"
#include "ui/document/hand-edit.h"
#include "ui/render/sharpness.h"
#include "ui/viewport/spore-viewport.h"

typedef struct SporeViewportMeasures SporeViewportMeasures;

typedef enum {
  DRAG_NONE,
  DRAG_ORBIT,
  DRAG_PAN,
  DRAG_PROBE,
  DRAG_PULL,
  DRAG_EDIT,
  DRAG_BRUSH,
  DRAG_PLACE,
  DRAG_GIZMO,
  DRAG_PORT,
  DRAG_BOX
} SporeDrag;

/* The picture of a view. */
typedef struct SporeViewportPicture {
  cairo_surface_t *pixels; /* the last that was drawn; NULL: none was */
  SporeCamera camera;      /* from which they were drawn */
  gboolean stale;          /* they are out of date */
  int width, height;       /* of the area that they fill; coarse ones have fewer pixels */
  gboolean coarse;         /* so that they are enlarged */
  SporeSharpness sharpness;
  guint rest; /* source that draws a sharp picture after a coarse one */
} SporeViewportPicture;

/* The picture that the renderer draws while the window goes on. */
typedef struct SporeViewportDrawing {
  SporeViewportPicture *of; /* NULL: none is being drawn */
  SporeCamera camera;
  int width, height; /* of the area, pixels */
  int coarseness;    /* how many pixels each way are drawn as one */
  gint64 since;
  guint look; /* source that looks whether it is drawn */
} SporeViewportDrawing;

/* What is painted on, and with what. */
typedef struct SporeViewportBrush {
  guint32 body, region; /* ids; body 0: nothing is painted on; region 0: the first stroke makes one */
  char *holder;         /* path of what holds the regions */
  double radius;        /* m */
  GArray *balls;        /* of the region, during a stroke (core/author/brush.h); NULL: none is under way */
  gboolean erases;
} SporeViewportBrush;

struct _SporeViewport {
  GtkOverlay parent;
  GtkRequisition pictures_size; /* pixels, while they are shown */
  GtkWidget *pictures;          /* of templates; NULL: none are set */
  GtkWidget *area, *foot, *template_button, *recent_button, *messages, *hud, *tools, *tool_row, *select_tool,
      *lead_tool, *edit_tool, *look_row, *overlays, *axes, *colours_button, *measure_list, *welcome, *beginnings,
      *failure, *link_button, *links_button, *instrument_button, *led_button, *measure_button, *cut_slider, *notice,
      *foot_row, *second, *second_area, *second_name, *large_name;
  int buttons_width; /* that the widest row of buttons takes in letters of the normal size */

  SporeEditorDocument *document;
  SporePlayer *player;
  SporeViewportTool tool;
  SporeViewportHabits habits;
  gboolean picking;
  gboolean boxing;      /* the next drag draws a box that selects */
  SporeVec3 anchors[2]; /* places that are picked so far */
  guint anchor_count;
  SporeVec3 outline[SPORE_OUTLINE_POINTS]; /* of an instrument that is being placed */
  guint outline_count;
  GArray *ports;                                           /* that are shown, see spore-viewport-ports.c */
  gboolean reach;                                          /* all ports are shown, and what none reaches */
  guint32 port_held;                                       /* id of the port that the drag moves */
  GArray *link_marks;                                      /* of the scene's links, see spore-viewport-links.c */
  GMenuModel *link_kinds, *instrument_kinds, *fluid_kinds; /* for menus */
  SporeStageOptions options;
  gboolean presented;
  gboolean light;   /* the windows are, and with them the room around the scene; not while the view is presented */
  gboolean figures; /* in the corner, those of an author, too */

  SporeHandEdit edit;    /* of the Edit tool */
  guint32 regions;       /* id of the object whose regions are edited; 0: spheres or a curve are edited */
  gboolean edit_resizes; /* the drag moves the handle on the rim, else the one in the middle */
  double edit_before[4]; /* the chosen sphere or point when the drag began */
  SporeViewportBrush brush;
  guint edit_timer;         /* wheel notches that are not committed yet */
  double axes_shown[3];     /* the camera's azimuth, elevation and roll, as the cube shows them */
  const char *pointed_view; /* of the face of the cube under the pointer; NULL: none */
  SporeGizmo gizmo;
  int gizmo_axis;            /* of the drag: 0 to 2, or 3: free */
  SporePlacement *placement; /* what the drag moves */
  SporePose motion;          /* by which it has moved it */
  double factor;             /* by which it will scale it */
  SporeViewportPlaces places;
  guint place_held; /* by the drag */
  SporeVec3 place_before;
  SporeViewportMeasures *measures;
  guint cut; /* number of the plane that cuts, from 1; 0: none does */
  gboolean cut_turned;
  double cut_box[2][3]; /* that the plane goes over: lower and upper corner, m */
  GHashTable *hidden;   /* ids of bodies that are not shown, as pointers */
  GHashTable *locked;   /* ids of bodies that are neither selected nor changed in the view, as pointers */
  SporeStageCandidate *candidate;
  SporeStageMarks marks;
  char *legend;      /* of the candidate's colours; NULL: none */
  char *legend_high; /* at the end of their scale, which begins at 0 */

  GTask *graphics; /* that prepares the renderer; borrowed; NULL: none does */
  SporeOffscreen *offscreen;
  SporeRenderer *renderer;
  SporeStage *stage;
  char *renderer_name;
  SporeViewportPicture picture, second_picture;
  SporeViewportDrawing drawing;
  gboolean told_drawing; /* to who asks for the view's description */
  gboolean told_coarse;  /* the corner says that the picture is coarse */
  gboolean second_on;
  guint rebuild, tick;
  gint64 hud_clock;
  guint64 shown_step;
  double draw_ms;

  SporeCamera camera;
  guint32 through;     /* id of the camera of the scene that the view looks through and follows; 0: none */
  SporeCamera outside; /* where the view was before it looked through the scene's camera */
  gboolean has_outside;
  gboolean strayed; /* the view was moved while it looked through the scene's camera: it is not the one outside */
  gboolean framed, waiting;

  SporeDrag drag;
  /* The left button was pressed beside all bodies, there, and has hardly moved: a drag turns the view, and a click
   * selects nothing. */
  gboolean beside;
  double pressed_x, pressed_y;
  double last_x, last_y;
  SporeCamera camera_before;
  guint32 led;                        /* id of the body that was led last; 0: none */
  guint32 body;                       /* of the world: held by the probe or pull drag */
  SporeDeviceState hand, hand_before; /* state of the hand that the mouse moves; the same when the drag began */
  SporeVec3 offset;                   /* from the cursor's point to the probe */
  SporeVec3 start, cursor;            /* pull: the point that was taken, and where the mouse has moved it */
};

/* spore-viewport-view.c: camera, candidate, welcome. */
void spore_viewport_redraw(SporeViewport *self);
/* Tells assistive technology whether the view shows what is there by now. */
void spore_viewport_tell_drawing(SporeViewport *self);
/* From where a scene is looked at that has no camera; its whole is not framed yet. */
SporeCamera spore_viewport_beginning(void);
/* TRUE: there is a body, or a candidate that stands for itself. */
gboolean spore_viewport_has_anything(SporeViewport *self);
/* The welcome is shown while nothing else is. */
void spore_viewport_show_welcome(SporeViewport *self);
/* To the size of the view; top: height of the tools above it. */
void spore_viewport_fit_welcome(SporeViewport *self, int top);
/* Goes where the scene's camera goes, as long as the view looks through it. */
void spore_viewport_follow_camera(SporeViewport *self);
/* Where nothing was to be seen before, the view goes to what is there now. */
void spore_viewport_look_afresh(SporeViewport *self);
/* The camera of the other view: the scene's while the view is outside, else the one outside. FALSE: the scene has none,
 * or there is nothing to see. */
gboolean spore_viewport_other_camera(SporeViewport *self, double aspect, SporeCamera *camera);
/* The view no longer looks through a camera of the scene. Called before the user moves the view. */
void spore_viewport_leave_scene_camera(SporeViewport *self);
void spore_viewport_clear_legend(SporeViewport *self);

/* The place under the cursor that is as far away as another one. */
SporeVec3 spore_viewport_under_cursor(SporeViewport *self, SporeVec3 through);
/* Where a place of the scene stands in the view, pixels. FALSE: behind the camera. */
gboolean spore_viewport_project(SporeViewport *self, SporeVec3 place, double *x, double *y);
/* Handles: discs of a fixed size on the screen, at places of the scene. */
void spore_viewport_draw_handle(SporeViewport *self, cairo_t *cr, SporeVec3 handle, gboolean filled);
/* Strokes the path, dark below bright: seen on any ground. colour: red, green, blue, opacity. */
void spore_viewport_stroke(cairo_t *cr, const double colour[4], double width);
/* Ground and letters of what is written on a ground of its own: dark with light letters, or the other way in a light
 * room. */
void spore_viewport_set_ground(SporeViewport *self, cairo_t *cr);
void spore_viewport_set_letters(SporeViewport *self, cairo_t *cr);
/* Marks the middle of the view, which is what the space bar picks. */
void spore_viewport_draw_cross(SporeViewport *self, cairo_t *cr);
/* Readable on any ground; x, y: its left upper corner, pixels. */
void spore_viewport_draw_text(SporeViewport *self, cairo_t *cr, const char *text, double x, double y);
gboolean spore_viewport_handle_is_at(SporeViewport *self, SporeVec3 handle, double x, double y);

/* spore-viewport-graphics.c: what draws is prepared on a thread, which takes a second where programs were never
 * compiled before. Then the view is drawn, or says why it cannot be. */
void spore_viewport_prepare_graphics(SporeViewport *self);
/* Returns when it is prepared, or cannot be; the main loop goes on meanwhile. */
void spore_viewport_wait_for_graphics(SporeViewport *self);

/* spore-viewport-picture.c: what is drawn of the stage. */
/* Whether pictures of the view are fine, by the user's choice or the graphics device. There is one. */
gboolean spore_viewport_is_fine(SporeViewport *self);
void spore_viewport_clear_picture(SporeViewportPicture *picture);
/* Draws the camera's picture where it is stale, and paints it over the area. There is a renderer. */
void spore_viewport_paint(SporeViewport *self, SporeViewportPicture *picture, const SporeCamera *camera,
                          GtkWidget *area, cairo_t *cr);
/* What is being drawn is not wanted any more, or the renderer is needed for something else. */
void spore_viewport_drop_drawing(SporeViewport *self);
/* Signal handler of the second view's drawing area. */
gboolean spore_viewport_draw_second(GtkWidget *area, cairo_t *cr, SporeViewport *self);
/* Its size follows that of the large picture. */
void spore_viewport_size_second(SporeViewport *self);

/* spore-viewport-places.c: places picked by hand. */
gboolean spore_viewport_places_press(SporeViewport *self, double x, double y); /* FALSE: no handle was there */
/* The cursor meets that body there, in the scene. */
void spore_viewport_places_motion(SporeViewport *self, guint32 body, SporeVec3 place);
void spore_viewport_places_release(SporeViewport *self, gboolean keep);
void spore_viewport_places_draw(SporeViewport *self, cairo_t *cr);

/* spore-viewport-links.c: links over the picture. */
GArray *spore_viewport_link_marks_new(void);
/* Reads where the scene's links are. */
void spore_viewport_links_refresh(SporeViewport *self);
void spore_viewport_links_draw(SporeViewport *self, cairo_t *cr);
/* Id of the link that is drawn there; 0: none. */
guint32 spore_viewport_link_at(SporeViewport *self, double x, double y);

/* spore-viewport-ports.c: what instruments reach through their ports. */
GArray *spore_viewport_ports_new(void);
/* Reads the ports that are to be shown. */
void spore_viewport_ports_refresh(SporeViewport *self);
void spore_viewport_ports_draw(SporeViewport *self, cairo_t *cr); /* handles and names */
/* What the tint says. FALSE: nothing is tinted. */
gboolean spore_viewport_reach_legend(SporeViewport *self, SporeStageLegend *legend);
gboolean spore_viewport_ports_press(SporeViewport *self, double x, double y); /* FALSE: no port was there */
/* body: what the cursor meets, at that place of the scene; 0: nothing. */
void spore_viewport_ports_motion(SporeViewport *self, guint32 body, SporeVec3 surface);
void spore_viewport_ports_release(SporeViewport *self, gboolean keep);

/* spore-viewport-box.c: a box that selects. */
gboolean spore_viewport_box_press(SporeViewport *self, const GdkEventButton *event); /* FALSE: none is asked for */
void spore_viewport_box_release(SporeViewport *self, gboolean keep);
void spore_viewport_box_draw(SporeViewport *self, cairo_t *cr);

/* spore-viewport-axes.c: the cube in the corner; signal handlers of its drawing area. */
gboolean spore_viewport_draw_axes(GtkWidget *axes, cairo_t *cr, SporeViewport *self);
gboolean spore_viewport_axes_press(GtkWidget *axes, GdkEventButton *event, SporeViewport *self);
gboolean spore_viewport_axes_point(GtkWidget *axes, GdkEvent *event, SporeViewport *self);
gboolean spore_viewport_axes_key(GtkWidget *axes, GdkEventKey *event, SporeViewport *self);
/* Draws the cube again where the camera has turned, and tells where the scene is seen from. */
void spore_viewport_tell_axes(SporeViewport *self);

/* spore-viewport-edit.c: the Edit tool. */
/* Shows what the selection offers to edit. */
void spore_viewport_edit_refresh(SporeViewport *self);
/* Commits what is edited, and closes it. */
void spore_viewport_edit_end(SporeViewport *self);
gboolean spore_viewport_edit_press(SporeViewport *self, double x, double y); /* FALSE: nothing to edit was there */
void spore_viewport_edit_motion(SporeViewport *self);
void spore_viewport_edit_release(SporeViewport *self, gboolean keep);
gboolean spore_viewport_edit_scroll(SporeViewport *self, double notches); /* FALSE: nothing is chosen */
gboolean spore_viewport_edit_key(SporeViewport *self, guint key);         /* FALSE: not its key */
void spore_viewport_edit_draw(SporeViewport *self, cairo_t *cr);          /* the handles */
/* Moves the chosen region to a click on the surface of that body. FALSE: no region moves. */
gboolean spore_viewport_edit_place(SporeViewport *self, guint32 body, SporeVec3 place);

/* spore-viewport-brush.c: painting regions. */
void spore_viewport_brush_draw(SporeViewport *self, cairo_t *cr); /* the brush under the cursor */
void spore_viewport_brush_show(SporeViewport *self);              /* what is painted, on a stage that was rebuilt */
/* FALSE: nothing is painted on, or it is not there. */
gboolean spore_viewport_brush_press(SporeViewport *self, double x, double y, gboolean erases);
void spore_viewport_brush_motion(SporeViewport *self, double from_x, double from_y); /* to last_x, last_y */
void spore_viewport_brush_release(SporeViewport *self, gboolean keep);
gboolean spore_viewport_brush_scroll(SporeViewport *self, double notches); /* FALSE: nothing is painted on */
gboolean spore_viewport_brush_key(SporeViewport *self, guint key);         /* FALSE: not its key */
gboolean spore_viewport_end_brush(SporeViewport *self);                    /* FALSE: nothing was painted on */

/* spore-viewport-gizmo.c: moving and turning what is selected. */
void spore_viewport_gizmo_draw(SporeViewport *self, cairo_t *cr);
gboolean spore_viewport_gizmo_press(SporeViewport *self, double x, double y); /* FALSE: no handle was there */
void spore_viewport_gizmo_motion(SporeViewport *self, GdkModifierType modifiers);
void spore_viewport_gizmo_release(SporeViewport *self, gboolean keep);
gboolean spore_viewport_gizmo_key(SporeViewport *self, guint key); /* FALSE: not its key */

/* spore-viewport-hiding.c: what is hidden, and the menu of the right button. */
/* Opens the menu of the selected body, or of no body. */
void spore_viewport_popup(SporeViewport *self, const GdkEvent *event, gboolean of_body);

/* spore-viewport-cut.c: the cut plane. */
SporeClip spore_viewport_clip(SporeViewport *self);
/* What the plane hides now is not picked. To be called before a pick: the picture may be older. */
void spore_viewport_clip_picking(SporeViewport *self);
void spore_viewport_cut_moved(GtkRange *slider, SporeViewport *self);

/* spore-viewport-measures.c: distances, angles and volumes. */
SporeViewportMeasures *spore_viewport_measures_new(void);
void spore_viewport_measures_free(SporeViewportMeasures *measures);
/* Removes all, and says nothing of it. */
void spore_viewport_measures_forget(SporeViewportMeasures *measures);
/* Gives the button a menu of what can be measured. */
void spore_viewport_measures_fill_menu(GtkMenuButton *button);
/* Takes the figures anew from what the stage shows. */
void spore_viewport_measures_follow(SporeViewport *self);
/* Whether clicks measure now. */
gboolean spore_viewport_measures_now(SporeViewport *self);
gboolean spore_viewport_measures_press(SporeViewport *self, double x, double y); /* FALSE: no body was there */
void spore_viewport_end_measuring(SporeViewport *self);
/* One click back, or no more measuring. FALSE: nothing was being measured. */
gboolean spore_viewport_measures_back(SporeViewport *self);
void spore_viewport_measures_draw(SporeViewport *self, cairo_t *cr);

/* spore-viewport-hand.c: the instrument that is led. */
/* What jaws and pedal do, as bits of a device's buttons. */
typedef enum { SPORE_HAND_RESTS = 0, SPORE_HAND_CLOSES = 1, SPORE_HAND_OPENS = 2 } SporeHandSqueeze;
/* Active body that the pointer leads, and its position (m); FALSE: none, or no simulation. */
gboolean spore_viewport_probe(SporeViewport *self, guint32 *body, SporeVec3 *position);
/* How far the jaws of the led instrument are open, rad. FALSE: it has none, or there is no simulation. */
gboolean spore_viewport_hand_opening(SporeViewport *self, double *opening);
gboolean spore_viewport_hand_press(SporeViewport *self); /* FALSE: nothing to lead */
void spore_viewport_hand_motion(SporeViewport *self);
/* Turns it about its end, as a ball under the cursor would roll; pixels. */
void spore_viewport_hand_turn(SporeViewport *self, double dx, double dy);
void spore_viewport_hand_take_back(SporeViewport *self); /* to where the drag began */
void spore_viewport_hand_deepen(SporeViewport *self, double notches);
/* Closes or opens the jaws, presses the first or the second pedal, or releases both. What stays closed by itself is
 * opened. */
void spore_viewport_hand_squeeze(SporeViewport *self, SporeHandSqueeze squeeze);
gboolean spore_viewport_hand_key(SporeViewport *self, guint key); /* FALSE: not its key */
void spore_viewport_hand_draw(SporeViewport *self, cairo_t *cr);  /* its name */

/* spore-viewport-gestures.c: mouse and keys. */
/* Signal handlers of the drawing area, named in the template. */
gboolean spore_viewport_button_press(GtkWidget *area, GdkEventButton *event, SporeViewport *self);
gboolean spore_viewport_button_release(GtkWidget *area, GdkEventButton *event, SporeViewport *self);
gboolean spore_viewport_motion(GtkWidget *area, GdkEventMotion *event, SporeViewport *self);
gboolean spore_viewport_scroll(GtkWidget *area, GdkEventScroll *event, SporeViewport *self);
gboolean spore_viewport_key_press(GtkWidget *area, GdkEventKey *event, SporeViewport *self);
/* Ends a drag without taking it back. */
void spore_viewport_end_drag(SporeViewport *self);

/* spore-viewport-legends.c: what colours mean. */
/* Lays the legends of what is shown beside all that lies over the picture. */
void spore_viewport_legends_draw(SporeViewport *self, cairo_t *cr, int width, int height);

/* spore-viewport-overlay.c: over the picture. */
void spore_viewport_overlay_draw(SporeViewport *self, cairo_t *cr, int width, int height);
/* The figures of the simulation, in a corner. */
void spore_viewport_overlay_update(SporeViewport *self);

#endif
