/* A document, and what runs of it, put before the camera: surfaces and spheres of each body, following snapshots. */
#ifndef SPORE_UI_RENDER_STAGE_H
#define SPORE_UI_RENDER_STAGE_H

#include "core/mesh/cell_faces.h"
#include "core/scene/compile.h"
#include "ui/render/renderer.h"

typedef struct SporeStage SporeStage;

typedef struct SporeStageOptions {
  gboolean surfaces, spheres, tetrahedra, contacts;
} SporeStageOptions;

/* What may come of a generator or of a hand: shown in place of what the body has of it. Arrays owned, in the body's
 * axes at the start, m; counts of 0: none of that kind. */
typedef struct SporeStageCandidate {
  guint32 body; /* object id; 0: of none, in the scene's axes */
  gsize sphere_count;
  double *spheres;      /* sphere_count x 4 */
  float *sphere_values; /* sphere_count, 0..1 of the scale of colours; NULL: plain */
  gsize chosen;         /* sphere that is marked; G_MAXSIZE: none */
  gsize vertex_count, triangle_count;
  double *vertices;     /* vertex_count x 3 */
  guint32 *triangles;   /* triangle_count x 3 */
  float *vertex_values; /* vertex_count, as sphere_values */
  SporeCellView view;   /* how cells are to be seen: told to who fills the candidate */
  gsize line_count;
  double *lines;      /* line_count x 2 points x 3 */
  gboolean are_edges; /* the lines are those of triangles: thin, and hidden where something stands before them */
} SporeStageCandidate;
void spore_stage_candidate_free(SporeStageCandidate *candidate);

/* Lines that point something out on a body before it moves: 2 points of 3 each, in its axes at the start, m. */
typedef struct SporeStageMarks {
  guint32 body; /* object id */
  gsize count;
  double *segments;
} SporeStageMarks;

/* All borrowed. simulation may be NULL: bodies stand where the document puts them. */
SporeStage *spore_stage_new(SporeRenderer *renderer, SporeDocument *document);
void spore_stage_free(SporeStage *stage);
/* Builds everything anew from the document (assets that cannot be read are skipped; check says why). */
void spore_stage_rebuild(SporeStage *stage, const SporeSimulation *simulation);
/* Moves what moves. */
void spore_stage_update(SporeStage *stage, const SporeSnapshot *snapshot);
void spore_stage_set_options(SporeStage *stage, const SporeStageOptions *options);
/* Borrowed until the next call; NULL: none. */
void spore_stage_set_candidate(SporeStage *stage, const SporeStageCandidate *candidate);
/* Borrowed until the next call; NULL: none. Not seen once time has gone on. */
void spore_stage_set_marks(SporeStage *stage, const SporeStageMarks *marks);
/* End of the scale, which begins at 0, by which the spheres that are shown are coloured: how far their radius is off
 * the depth of their centre in the mesh that they were made from. */
typedef struct SporeSphereScale {
  double high;  /* m; 0: meshes of more than one size have it at different lengths, see share */
  double share; /* the same of each mesh's diagonal; 0: no spheres with such colours are shown */
} SporeSphereScale;
SporeSphereScale spore_stage_sphere_scale(const SporeStage *stage);
void spore_stage_set_selection(SporeStage *stage, guint32 object_id);
/* The scene's camera of that name (tools > camera); NULL: its first, else one that sees everything at this aspect.
 * Below 16:9 a camera of the scene opens wider, so that nothing is lost at the sides.
 * FALSE with a GError when there is none of that name. */
gboolean spore_stage_camera(const SporeStage *stage, const char *name, double aspect, SporeCamera *camera,
                            GError **error);
gboolean spore_stage_has_camera(const SporeStage *stage);
void spore_stage_bounds(const SporeStage *stage, double lower[3], double upper[3]);
/* Body object under a ray: id, 0 none; *point is the hit. */
guint32 spore_stage_pick(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point);

#endif
