/* Films a run: steps simulations from moment to moment and draws them. */
#ifndef SPORE_UI_RENDER_FILMING_H
#define SPORE_UI_RENDER_FILMING_H

#include "core/base/progress.h"
#include "ui/render/reel.h"
#include "ui/render/panes.h"

#define SPORE_FILMING_MOST 2 /* simulations side by side */

/* Of a single picture, to_s is the moment, and from_s, fps and speed say nothing. */
typedef struct SporeFilming {
  const char *file;        /* as spore_reel_kind */
  int width, height;       /* of each simulation's picture, pixels */
  double from_s, to_s;     /* simulated time; to_s > from_s >= 0 */
  double fps, speed;       /* pictures a second; simulated seconds a second: 1 is real time, .5 slow motion */
  const char *camera;      /* NULL: see spore_stage_camera */
  SporeStageOptions shown; /* what is drawn */
  SporeClip clip;          /* what is hidden */
  gboolean light;          /* the room, see SporeRenderOptions */
  gboolean legends;        /* whether pictures carry them */
  const char *ports;       /* whose reach is shown, see spore_stage_find_ports; NULL: none */
  guint count;             /* of simulations, at most SPORE_FILMING_MOST: at time 0, borrowed, and run to the end */
  SporeDocument *documents[SPORE_FILMING_MOST];
  SporeSimulation *simulations[SPORE_FILMING_MOST];
  void (*before_step)(gpointer data, guint simulation); /* NULL: nothing is done before a step */
  gpointer data;                                        /* for before_step */
  const SporeCancel *cancel;                            /* NULL: nobody ends it; else what the simulations have, too */
} SporeFilming;

/* What came of it. */
typedef struct SporeFilmed {
  int width, height; /* of the whole picture */
  guint64 pictures;
  double length_s;   /* of the film; 0: a single picture */
  char *gl_renderer; /* g_free */
  char *legends;     /* see spore_panes_legends; g_free */
  double field_end;
  guint legends_left_out; /* of the last picture, which has no room for them */
  GError *no_legends;     /* why there are none, though they were asked for; g_clear_error. NULL: there are */
} SporeFilmed;

/* Writes the file, whole or not at all. FALSE with a GError; SPORE_ERROR_CANCELLED where cancel or progress asked. */
gboolean spore_filming_run(const SporeFilming *filming, const SporeProgress *progress, SporeFilmed *filmed,
                           GError **error);

#endif
