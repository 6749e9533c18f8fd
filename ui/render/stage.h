/* The stage: surfaces and spheres of each body of a document, drawn where snapshots of the simulation put them. */
#ifndef SPORE_UI_RENDER_STAGE_H
#define SPORE_UI_RENDER_STAGE_H

#include "core/mesh/cell_faces.h"
#include "core/scene/compile.h"
#include "ui/render/renderer.h"

typedef struct SporeStage SporeStage;

/* What of a body's state colours its surface. */
typedef enum SporeStageField {
  SPORE_FIELD_NONE,
  SPORE_FIELD_STRAIN,   /* largest principal Green's strain */
  SPORE_FIELD_STRESS,   /* von Mises' stress of Cauchy's stress, by the body's own law, Pa */
  SPORE_FIELD_VELOCITY, /* speed, m/s */
  SPORE_FIELD_LEVEL,    /* level of detail, of bodies that have several */
  SPORE_FIELD_CELLS,    /* shape of the worst cell there as it is now (spore_tetrahedron_quality), degrees */
  SPORE_FIELD_COUNT
} SporeStageField;
extern const char *const spore_stage_field_names[]; /* by field, then NULL; for options and actions */

typedef struct SporeStageOptions {
  gboolean surfaces, spheres, tetrahedra, contacts, links;
  SporeStageField field;
  double field_end; /* at the end of the scale, which begins at 0; 0: the scale follows the state that is shown */
} SporeStageOptions;

/* What a generator or the Edit tool offers, shown in place of what the body has. Arrays are owned, in the body's axes
 * at the start, m. Counts of 0: none of that kind. */
typedef struct SporeStageCandidate {
  guint32 body; /* object id; 0: no body, and arrays are in the scene's axes */
  gsize sphere_count;
  double *spheres;      /* sphere_count x 4 */
  float *sphere_values; /* sphere_count, 0..1 of the scale of colours; NULL: plain */
  gsize chosen;         /* sphere that is marked; G_MAXSIZE: none */
  gsize vertex_count, triangle_count;
  double *vertices;     /* vertex_count x 3 */
  guint32 *triangles;   /* triangle_count x 3 */
  float *vertex_values; /* vertex_count, as sphere_values */
  SporeCellView view;   /* how cells are cut open; read by whoever fills the candidate */
  gsize line_count;
  double *lines;    /* line_count x 2 points x 3 */
  gsize edge_count; /* of the lines, the first so many are edges of triangles: thin, and hidden behind what is nearer */
} SporeStageCandidate;
void spore_stage_candidate_free(SporeStageCandidate *candidate);

/* Lines that mark something on a body before the body moves: 2 points of 3 each, in its axes at the start, m. */
typedef struct SporeStageMarks {
  guint32 body; /* object id */
  gsize count;
  double *segments;
} SporeStageMarks;

/* The arguments are borrowed. Without a simulation, bodies stand where the document puts them. */
SporeStage *spore_stage_new(SporeRenderer *renderer, SporeDocument *document);
void spore_stage_free(SporeStage *stage);
/* What takes longer to measure than a picture to draw is left out until a thread has measured it; then found is called
 * on the main thread, and the next rebuild shows it. Else it is measured at once. */
void spore_stage_measure_aside(SporeStage *stage, void (*found)(gpointer data), gpointer data);
/* Builds everything anew from the document (assets that cannot be read are skipped; check says why). */
void spore_stage_rebuild(SporeStage *stage, const SporeSimulation *simulation);
/* Moves the bodies to the state of the snapshot. */
void spore_stage_update(SporeStage *stage, const SporeSnapshot *snapshot);
void spore_stage_set_options(SporeStage *stage, const SporeStageOptions *options);
/* Whether links are drawn at time 0 whatever the options say, for whoever edits them. The next update shows it. */
void spore_stage_mark_links(SporeStage *stage, gboolean marked);
/* Borrowed until the next call; NULL: none. */
void spore_stage_set_candidate(SporeStage *stage, const SporeStageCandidate *candidate);
/* Borrowed until the next call; NULL: none. Hidden once simulated time has passed. */
void spore_stage_set_marks(SporeStage *stage, const SporeStageMarks *marks);
/* Colours what the balls hold of that body's surface at rest; balls: count x 4, centre and radius, in the body's frame,
 * m. body: object id; 0: none. To be called again after a rebuild. */
void spore_stage_set_painted(SporeStage *stage, guint32 body, const double *balls, gsize count);
/* One ball more of the same body. */
void spore_stage_add_painted(SporeStage *stage, const double ball[4]);
/* The scale that colours the spheres which are shown. It goes from 0 to these ends. The value of a sphere is the
 * difference between its radius and the depth of its centre in the mesh that it was made from. */
typedef struct SporeSphereScale {
  double high;  /* m; 0: meshes of different sizes have different ends, see share */
  double share; /* the end as a share of each mesh's diagonal; 0: no such spheres are shown */
} SporeSphereScale;
SporeSphereScale spore_stage_sphere_scale(const SporeStage *stage);
/* What one colour means, of a screen, 0..1. */
typedef struct SporeStageKey {
  double colour[3];
  char *text;
} SporeStageKey;
#define SPORE_STAGE_LINK_KINDS 8
/* What the colours of surfaces say; translated texts. */
typedef struct SporeStageLegend {
  char *label;   /* what is measured */
  char *low;     /* at the beginning of the scale */
  char *high;    /* at the end of the scale, with its unit. NULL: there is no scale, or no body has its colours */
  char *range;   /* what there is to say of the scale; NULL: nothing */
  char *without; /* the soft bodies of which it is not known, or another remark; NULL: none */
  gboolean tint; /* what is told is shown by the tint of tissue (spore_tint_colour) */
  guint key_count;
  SporeStageKey keys[SPORE_STAGE_LINK_KINDS];
  double end; /* SI */
} SporeStageLegend;
/* FALSE: no field is shown. To be freed by spore_stage_legend_clear. */
gboolean spore_stage_legend(const SporeStage *stage, SporeStageLegend *legend);
/* All of it in words, translated; g_free. */
char *spore_stage_legend_text(const SporeStageLegend *legend);
/* All legends of what is shown, each to be cleared; returns their number. */
#define SPORE_STAGE_LEGENDS 5 /* that a picture has at most, with that of the tint */
guint spore_stage_legends(const SporeStage *stage, SporeStageLegend legends[SPORE_STAGE_LEGENDS]);
/* Their words, a line each; g_free. */
char *spore_stage_legends_text(const SporeStage *stage);
/* The same of the spheres' errors (spore_stage_sphere_scale), of the lines of contact forces, and of links. */
gboolean spore_stage_sphere_legend(const SporeStage *stage, SporeStageLegend *legend);
gboolean spore_stage_contact_legend(const SporeStage *stage, SporeStageLegend *legend);
gboolean spore_stage_link_legend(const SporeStage *stage, SporeStageLegend *legend);
/* The end of the scale that is shown, SI; 0: none is. */
double spore_stage_field_end(const SporeStage *stage);
void spore_stage_legend_clear(SporeStageLegend *legend);
/* Hides bodies, by their objects' ids as pointers. Borrowed until the next call; call again when the set has changed.
 * NULL: none. What is hidden is not picked. */
void spore_stage_set_hidden(SporeStage *stage, GHashTable *hidden);
/* What the plane hides is not picked; see SporeRenderOptions, which has it drawn so. */
void spore_stage_set_clip(SporeStage *stage, const SporeClip *clip);
void spore_stage_set_selection(SporeStage *stage, const guint32 *object_ids, gsize count);
/* The scene's camera of that name (tools > camera); NULL: the first camera, else one that sees everything at this
 * aspect. Below 16:9 a camera of the scene opens wider, so that nothing is lost at the sides. FALSE with a GError when
 * no camera has that name. */
gboolean spore_stage_camera(const SporeStage *stage, const char *name, double aspect, SporeCamera *camera,
                            GError **error);
void spore_stage_bounds(const SporeStage *stage, double lower[3], double upper[3]);
/* Body object under a ray: id, 0 none; *point is the hit. */
guint32 spore_stage_pick(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point);
/* The same; the ray goes through bodies whose ids, as pointers, are in `skipped`; NULL: through none. */
guint32 spore_stage_pick_past(const SporeStage *stage, GHashTable *skipped, SporeVec3 origin, SporeVec3 direction,
                              SporeVec3 *point);
/* A place on a body as it is drawn, which goes with the body. */
typedef struct SporeStageHold {
  guint32 body;       /* object id */
  gboolean on_sphere; /* else on a triangle of its surface */
  gsize count;        /* of the spheres, or of the surface's vertices, when the place was picked */
  guint32 corners[3]; /* of the triangle; of the sphere, its number is the first */
  double at[3];       /* shares of the corners; on a sphere, m from its centre */
  double above;       /* m along the triangle's normal: a place where a plane cuts the body lies inside */
} SporeStageHold;
/* As pick; *hold is set where a body is met. */
guint32 spore_stage_pick_hold(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point,
                              SporeStageHold *hold);
/* Where the place is now. FALSE: the body is gone, or drawn with other triangles. */
gboolean spore_stage_held(const SporeStage *stage, const SporeStageHold *hold, SporeVec3 *point);
/* Where the place is while the body is at rest, in the body's frame. FALSE: likewise, or it lies on a sphere. */
gboolean spore_stage_held_at_rest(const SporeStage *stage, const SporeStageHold *hold, SporeVec3 *place);
/* The surface of a body as it is drawn: borrowed, read only, until the stage changes. FALSE: it shows none. */
gboolean spore_stage_surface(const SporeStage *stage, guint32 body, SporeTriangleMesh *surface);

#endif
