/* Inside the window: its state, and its files from the lowest up. Each calls only those before it; spore-window.c puts
 * them together. */
#ifndef SPORE_UI_SPORE_WINDOW_PRIVATE_H
#define SPORE_UI_SPORE_WINDOW_PRIVATE_H

#include "core/author/instrument_edits.h"
#include "core/author/link_edits.h"
#include "ui/document/recovery.h"
#include "ui/jobs/spore-generator.h"
#include "ui/jobs/spore-job.h"
#include "ui/panels/spore-accuracy.h"
#include "ui/panels/spore-exercise-guide.h"
#include "ui/panels/spore-exercise.h"
#include "ui/panels/spore-generator-panel.h"
#include "ui/panels/spore-inspector.h"
#include "ui/panels/spore-outliner.h"
#include "ui/panels/spore-plan.h"
#include "ui/panels/spore-plots.h"
#include "ui/panels/spore-timeline.h"
#include "ui/panels/spore-problems.h"
#include "ui/sim/spore-player.h"
#include "ui/spore-window.h"
#include "ui/viewport/spore-viewport.h"

/* What is made by picking: links, steps of an exercise, or instruments. */
typedef struct SporePickKind {
  guint (*count)(const SporeObjectType *type);                /* clicks that it takes */
  const char *(*doc)(const SporeObjectType *type, guint end); /* what is clicked on, translated */
  SporeObject *(*add)(SporeDocument *document, const char *name, const SporeLinkEnd *ends, guint count, GError **error);
  gboolean (*tie)(SporeDocument *document, SporeObject *object, const SporeLinkEnd *ends, guint count, GError **error);
  /* NULL, or the line along which it would lie, the last of the places being under the
   * cursor; SPORE_OUTLINE_POINTS at most. */
  guint (*outline)(SporeDocument *document, const char *name, const SporeVec3 *places, guint count, SporeVec3 *points);
  void (*added)(SporeWindow *self, guint count); /* NULL, or called when it stands and is selected */
  const char *first; /* hint before the first click, translatable: label, number of the click, of how many, doc */
  const char *later; /* hint after that, the same */
  gboolean anywhere; /* the first click may be beside all bodies */
} SporePickKind;

/* An object whose ends are being picked. */
typedef struct SporePickDraft {
  const SporePickKind *kind;
  const SporeObjectType *type; /* NULL: none */
  const char *name;            /* for `add`; NULL: the element of the type */
  const char *label;           /* for people, translatable; NULL: that of the type */
  guint32 object;              /* id of the one that gets other ends; 0: a new one */
  guint count;                 /* of the ends so far */
  guint32 bodies[2];           /* ids; 0: the scene */
  SporeVec3 places[2];         /* in the scene, m */
} SporePickDraft;

/* What a message is about; a message goes when that is over. */
typedef enum SporeCause {
  SPORE_CAUSE_LASTS = 0,          /* goes when the user closes it, or with the document */
  SPORE_CAUSE_EDIT = 1 << 0,      /* an edit was refused: until the scene is changed */
  SPORE_CAUSE_RUN = 1 << 1,       /* the scene is not at its start */
  SPORE_CAUSE_WORK = 1 << 2,      /* something is being worked on */
  SPORE_CAUSE_SELECTION = 1 << 3, /* nothing fit is selected: until something else is */
  SPORE_CAUSE_PICK = 1 << 4,      /* a click was refused: until the next one */
  SPORE_CAUSE_FILE = 1 << 5,      /* a file could not be written: until one is */
} SporeCause;

struct _SporeWindow {
  GtkApplicationWindow parent;
  GtkWidget *header, *play_button, *play_image, *speed_button, *menu_button, *messages, *message_bar, *message,
      *message_remedy, *recovery_bar, *recovery_text, *hold_bar, *hold_text, *hold_button, *missing_bar, *missing_text;
  SporeCause cause; /* of the message that is shown */
  GtkWidget *outliner, *viewport, *inspector, *problems, *plan, *accuracy, *plots, *timeline, *exercise, *guide,
      *controls, *large_play, *large_play_image, *generator_panel, *middle, *bottom, *tab_row, *tab_switcher, *tabs,
      *log, *hint, *job_box, *job_label, *job_bar;

  const SporeSchema *schema; /* borrowed from the application */
  char *scenes;              /* folder of the scenes that ship */
  SporeEditorDocument *document;
  SporePlayer *player;
  SporeGenerator *generator;
  SporeJob *job;
  SporeRecovery *recovery;
  SporeLeftover *leftover;
  GPtrArray *unreadable; /* of char *: folders of leftovers whose scene could not be read */
  guint autosave, monitor;
  guint64 monitored_step, monitor_seen;
  GMenu *mesh_operations; /* in the menu */
  GMenu *templates, *recent, *link_kinds, *instrument_kinds, *fluid_kinds, *menu, *speeds, *all_tabs,
      *hands; /* hands: the instruments that can be led */
  SporePickDraft draft;
  SporeViewportPlaces picked; /* on the organ, so far */
  SporeJob *look_job; /* the job whose look is shown, with serial and time of the look; borrowed, only compared */
  guint look_serial;
  gint64 look_time;
  gboolean framed_apart;    /* the view has moved to a candidate that belongs to no body */
  gboolean made_room;       /* the bottom was made taller for a study */
  GArray *deleted;          /* of guint32: ids of what was deleted last */
  guint64 deleted_revision; /* of the document, when something had gone along */
  GArray *loose;            /* of guint: ids of the bodies that fall unless they are held */
  guint missing;            /* files of the scene that are not there, as last checked */
  GArray *gaps_logged_ms;   /* of double: how long the window stood still, as the log has it */
  gboolean gaps_play;       /* gaps are told as those of playing */
  gboolean fresh, sure;     /* sure: the user has answered about unsaved changes */
};

/* spore-window-needs.c: what can be done. */
/* Enables the actions that can be done now. */
void spore_window_update_actions(SporeWindow *self);
/* Whether places on the organ can be picked for what the generator makes, and whether the user picks them now. */
gboolean spore_window_picks_places(SporeWindow *self);
gboolean spore_window_is_picking(SporeWindow *self);
/* Why the action cannot be done now, translated; NULL: it can, as far as is known here. */
const char *spore_window_missing(SporeWindow *self, const char *action);

/* spore-window-state.c: messages, the job that runs, enabled actions. */
void spore_window_complain(SporeWindow *self, const char *message);
/* A message that goes with its cause. remedy: label of a button for the action of the window,
 * with its target where it has one; both NULL: none. */
void spore_window_complain_while(SporeWindow *self, SporeCause cause, const char *message, const char *remedy,
                                 const char *action);
/* The problem with a fix that the message tells of; NULL: none is. Borrowed until the next check. */
const SporeDiagnostic *spore_window_said_problem(SporeWindow *self);
/* Gives the message that is shown the button of a fix, where it has none and the checks found its cause. */
void spore_window_offer_fix(SporeWindow *self);
/* Something else is being worked on. */
void spore_window_complain_work(SporeWindow *self);
/* What is over, of SporeCause: a message about that goes. */
void spore_window_mend(SporeWindow *self, guint causes);
void spore_window_log(SporeWindow *self, const char *format, ...) G_GNUC_PRINTF(2, 3);
/* Brings what lies in one of the bottom's tabs to the front. */
void spore_window_show_tab(SporeWindow *self, GtkWidget *what);
/* Shows an error, unless the user cancelled. TRUE: there was an error. */
gboolean spore_window_failed(SporeWindow *self, const GError *error);
/* A file was written, which is logged, or was not: says why, unless the user cancelled. error: NULL: it was. Returns
 * whether it was. */
gboolean spore_window_wrote(SporeWindow *self, const char *file, const GError *error);
/* Closes the message that lies on top. FALSE: there is none that can be closed. */
gboolean spore_window_close_message(SporeWindow *self);
/* Starts a job; only one runs at a time. FALSE, with data freed: another job is running, and the user is told. */
gboolean spore_window_start_job(SporeWindow *self, const char *title, SporeJobWork work, gpointer data,
                                GDestroyNotify free_data, SporeJobDone done);
/* Shows the progress of the running job, if any. */
void spore_window_show_job(SporeWindow *self);
/* The selected body, else the only body that shows a mesh; NULL: none, and the user is told. */
SporeObject *spore_window_body_to_work_on(SporeWindow *self);
/* How long the scene has been simulated, s; 0: not yet. */
double spore_window_played_s(SporeWindow *self);
gboolean spore_window_is_at_start(SporeWindow *self);
/* Editing in the view works on the scene at its start. FALSE: the user is told. */
gboolean spore_window_may_edit(SporeWindow *self);
void spore_window_show_hint(SporeWindow *self); /* what the current tool does */

/* spore-window-bodies.c: what is done to all that is selected. */
void spore_window_add_body_actions(SporeWindow *self);
/* Keeps what is locked and what is hidden for the next time that the scene's file is opened, or brings back what was
 * kept.
 */
void spore_window_keep_marks(SporeWindow *self);
void spore_window_restore_marks(SporeWindow *self);
/* bodies: of SporeObject *. */
void spore_window_select(SporeWindow *self, const GPtrArray *bodies);

/* spore-window-locate.c: missing files. */
void spore_window_add_locate_actions(SporeWindow *self);
/* Offers to locate what the checks found missing; of SporeDiagnostic *. An offer that was closed comes back when
 * another number of them is missing. */
void spore_window_offer_to_locate(SporeWindow *self, const GPtrArray *diagnostics);
/* Asks where a missing file is: one that the selection names, else the first. */
void spore_window_ask_to_locate(SporeWindow *self);

/* spore-window-picking.c: what is made by clicks in the view. */
void spore_window_add_pick_actions(SporeWindow *self);
/* Begins to pick the ends of a draft that has none yet. */
void spore_window_begin_pick(SporeWindow *self, SporePickDraft draft);
/* Forgets what is being picked, if anything is. */
void spore_window_end_pick(SporeWindow *self);
/* The same, also of the places on the organ that a generator begins from. */
void spore_window_stop_picking(SporeWindow *self);

/* spore-window-placement.c: moving, turning and aligning. */
void spore_window_add_placement_actions(SporeWindow *self);

/* spore-window-pose.c: what a run shows as the scene's beginning. */
void spore_window_add_pose_actions(SporeWindow *self);

/* spore-window-links.c: links. */
void spore_window_add_link_actions(SporeWindow *self);
/* An entry for each kind of link that the schema has. */
void spore_window_fill_link_menu(SporeWindow *self);

/* spore-window-fluids.c: fluids of the library. */
void spore_window_add_fluid_actions(SporeWindow *self);
/* An entry for each kind of fluid. */
void spore_window_fill_fluid_menu(SporeWindow *self);

/* spore-window-instruments.c: instruments of the library. */
void spore_window_add_instrument_actions(SporeWindow *self);
/* An entry for each kind of instrument. */
void spore_window_fill_instrument_menu(SporeWindow *self);
/* Says which instruments can be led, and which one is. */
void spore_window_show_hands(SporeWindow *self);

/* spore-window-exercise.c: steps and metrics of the exercise. */
void spore_window_add_exercise_actions(SporeWindow *self);

/* spore-window-generate.c: generators. */
void spore_window_add_generator_actions(SporeWindow *self);
/* Makes the generator for the current document, if there is one. */
void spore_window_set_generator(SporeWindow *self);
/* Tetrahedra of the organs of a label map. */
void spore_window_preview_labels(SporeWindow *self, const char *file);

/* spore-window-files.c: the document and its files. */
void spore_window_add_file_actions(SporeWindow *self);
/* Takes the document. */
void spore_window_set_document(SporeWindow *self, SporeDocument *document);
/* Lets go of the document and of what follows it. */
void spore_window_release_document(SporeWindow *self);
/* Asks about unsaved changes; TRUE: go on. */
gboolean spore_window_may_leave(SporeWindow *self);
/* Opens a scene that ships, as one that has no file yet. */
void spore_window_open_copy(SporeWindow *self, const char *file);
/* Opens what a dead owner left. FALSE: something else goes on, or the user stays with the scene. */
gboolean spore_window_recover(SporeWindow *self);
/* Asks for the name of a file to write. title, kind: translated; extension: added where it is missing; proposed: the
 * name to begin with. g_free; NULL: the user went back. */
char *spore_window_choose_to_save(SporeWindow *self, const char *title, const char *extension, const char *kind,
                                  const char *proposed);
/* Asks for a file to read. title, kind: translated; patterns: with blanks between. g_free; NULL: the user went back. */
char *spore_window_choose_to_open(SporeWindow *self, const char *title, const char *patterns, const char *kind);

/* spore-window-recent.c: scenes that were opened or saved last. */
void spore_window_remember(const char *file);
/* Keeps the menu of them as they are. */
void spore_window_follow_recent(SporeWindow *self);

/* spore-window-templates.c: scenes to begin with. */
void spore_window_add_template_actions(SporeWindow *self);
/* An entry for each. */
void spore_window_fill_template_menu(SporeWindow *self);

/* spore-window-fix.c: what mends a problem. */
void spore_window_add_fix_actions(SporeWindow *self);

/* spore-window-film.c: pictures of the view, and films of runs. */
void spore_window_add_film_actions(SporeWindow *self);

/* spore-window-export.c: the scene for other programs. */
void spore_window_add_export_actions(SporeWindow *self);

/* spore-window-mesh.c: importing meshes, and operations on them. */
void spore_window_add_mesh_actions(SporeWindow *self);
/* files: NULL-terminated, or NULL: none yet. */
void spore_window_show_import_dialog(SporeWindow *self, const char *const *files);

/* spore-window-tabs.c: the tabs below the view. */
void spore_window_add_tab_actions(SporeWindow *self);

/* spore-window-search.c: finding what can be done. */
void spore_window_add_search_action(SporeWindow *self);

/* spore-window-actions.c: scene, simulation and view. */
void spore_window_add_scene_actions(SporeWindow *self);

#endif
