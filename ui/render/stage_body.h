/* Inside the stage: one body of the document and what is drawn of it. */
#ifndef SPORE_UI_RENDER_STAGE_BODY_H
#define SPORE_UI_RENDER_STAGE_BODY_H

#include "ui/render/stage.h"

/* Points that follow the body's degrees of freedom. */
typedef struct SporeStagePoints {
  SporeMapping mapping;
  gsize count;
  double *positions; /* count x 3, world, m */
} SporeStagePoints;

/* How blood is seen on a surface: stage_stain.c. */
typedef struct SporeStageStain SporeStageStain;
/* Colours of a field: stage_field.c. */
typedef struct SporeStageShade SporeStageShade;

typedef struct SporeStageBody {
  guint32 object;     /* id */
  guint32 world_body; /* SPORE_NO_BODY: not simulated */
  gboolean moves;
  SporeLodGrade level; /* of q and of all mappings */
  gsize q_offset, q_count;
  double *q; /* configuration that is shown */

  SporeStagePoints surface;
  gsize triangle_count;
  const guint32 *triangles; /* triangle_count x 3; borrowed from the document, or own_triangles */
  uint32_t *own_triangles;
  const guint32 *whole_triangles; /* before the first cut; NULL: there was no cut */
  gsize whole_count;
  SporeSurfaceStyle style;
  guint texture; /* of the renderer; 0: the surface has none */
  float *places; /* in the texture: of the mesh's triangles before the first cut, x 3 x 2 */
  /* Of tetrahedra that may be divided: see stage_divide.c. */
  const SporeTetrahedralMesh *cells; /* borrowed from the document; NULL: they cannot be divided */
  guint64 lines;                     /* number of the knots that the mappings belong to, see SporeLines */
  gsize corner_start;                /* in the cuts of snapshots */
  guint64 divided;                   /* the count of divisions that is shown */
  const double *rest;                /* of the visual mesh, borrowed; NULL: the surface is the tetrahedra's own */
  SporeMapping whole_surface;        /* before the first division */
  uint32_t *surface_places, *centre_places;
  guint inside_handle;  /* of the faces that were inside */
  guint surface_handle; /* handles: 0 is none */

  SporeStageStain *stain;                 /* of the surface; NULL: the body cannot be stained */
  SporeStageShade *shade;                 /* while a field is shown; NULL: none */
  const double *rest_surface, *rest_axis; /* of surface and tube as they were built: 3 and 4 a point; borrowed */
  gsize rest_count;                       /* of rest_surface */

  SporeStagePoints axis; /* of the tube that is the surface */
  double *rest_tube;     /* vertices of the tube at rest: surface.count x 3; NULL: there is none */
  SporeCurve tube;       /* the axis as it is shown, with its radii; without points: there is none */

  SporeStagePoints centres;
  gboolean particles; /* a model's own spheres, one at each of its particles */
  gboolean liquid;    /* the surface is the skin around the centres, made anew as they move */
  double *spheres;    /* centres.count x 4, world */
  gsize shown;        /* number of centres and spheres in the world; they come first */
  gboolean solid;     /* the spheres are drawn as the body itself */
  float *fits;        /* place of each sphere's error on the scale; NULL: the spheres show no error */
  double fit_high;    /* m: end of the scale of the spheres' errors; 0: the spheres show no error */
  guint spheres_handle;

  const SporeModel *smoke; /* shown by its puffs alone; NULL: the body is no smoke */
  SporePuff *puffs;        /* smoke->node_count */
  guint puffs_handle;

  SporeStagePoints nodes;
  gsize edge_count;
  uint32_t *edges;  /* edge_count x 2 */
  double *segments; /* edge_count x 6, world */
  guint wire_handle;
} SporeStageBody;

struct SporeStage {
  SporeRenderer *renderer;
  SporeDocument *document;
  const SporeSimulation *simulation; /* that the bodies were built for; NULL: none */
  SporeStageOptions options;
  GArray *port_lines;    /* handles, guint; see stage_ports.c */
  GHashTable *selection; /* ids of bodies, as pointers */
  GHashTable *hidden;    /* ids of bodies that are not shown, as pointers; borrowed; NULL: all are */
  SporeClip clip;        /* what is not picked */
  GPtrArray *bodies;     /* SporeStageBody * */
  GPtrArray *fits;       /* see stage_fit.c */
  void (*found)(gpointer data);
  gpointer found_data;
  GHashTable *textures; /* checksum of a PNG -> its SporeStageTexture; see stage_texture.c */
  GArray *squeezes;     /* SporeSqueeze of the snapshot that is shown */
  GArray *lenses;       /* SporeLensState of the snapshot that is shown, one a camera of the scene */
  guint contact_handle;
  GArray *links;                              /* see stage_links.c */
  guint link_handles[SPORE_STAGE_LINK_KINDS]; /* 0: no link of that kind */
  gboolean marks_links;
  gsize cut_count; /* of the snapshot that is shown, with its cut_run */
  guint64 cut_run;
  GArray *contacts;                     /* double: segments of the contacts shown */
  double touch_end;                     /* N: of the scale of forces on spheres that is shown; 0: none is */
  double contact_longest, contact_most; /* m: no line is longer; N: the largest force shown */
  const SporeStageCandidate *candidate; /* NULL: none */
  guint candidate_handles[5];           /* spheres, the marked one, surface, edges, lines; 0: none */
  double field_end;                     /* of the scale of colours that is shown; 0: none is */
  const SporeStageMarks *marks;         /* NULL: none */
  guint marks_handle;
  guint32 painted;        /* id of the body on which a region is shown; 0: none */
  GArray *painted_values; /* float, one a vertex of its surface: above 0 in the region */
};

/* Whether the user has not hidden the body. */
static inline gboolean spore_stage_shows(const SporeStage *stage, guint32 object) {
  return !stage->hidden || !g_hash_table_contains(stage->hidden, GUINT_TO_POINTER(object));
}

/* Builds what is drawn of a body, at time 0. Assets that cannot be read are left out. level: NULL for the level at time
 * 0. */
SporeStageBody *spore_stage_body_new(SporeStage *stage, SporeObject *object, const SporeSimulation *simulation,
                                     const SporeLodGrade *level);
/* Updates the mappings of a line whose knots were inserted or removed, by the knots of the snapshot. */
void spore_stage_body_follow_knots(SporeStageBody *body, const SporeSimulation *simulation,
                                   const SporeSnapshot *snapshot);
void spore_stage_body_free(SporeStage *stage, SporeStageBody *body);
/* Moves everything that the options show to the configuration body->q. */
void spore_stage_body_place(SporeStage *stage, SporeStageBody *body);
/* Lets the colours of liquids run into each other where they meet. Once they are placed. */
void spore_stage_mix_liquids(SporeStage *stage);
void spore_stage_body_show(SporeStage *stage, SporeStageBody *body);
gboolean spore_stage_body_shows_spheres(const SporeStage *stage, const SporeStageBody *body);

/* Links of the document, and of the simulation that the stage is of. rebuild: after clear. snapshot NULL: of time 0. */
GArray *spore_stage_links_new(void);
void spore_stage_links_clear(SporeStage *stage);
void spore_stage_links_rebuild(SporeStage *stage);
void spore_stage_show_links(SporeStage *stage, const SporeSnapshot *snapshot);

/* Draws the candidate or the marks again, where their body is at the start. */
void spore_stage_place_candidate(SporeStage *stage);
void spore_stage_place_marks(SporeStage *stage);

/* Shows a new surface in place of the last one; takes its triangles. */
void spore_stage_body_show_surface(SporeStage *stage, SporeStageBody *body, const SporeTriangleMesh *mesh);
/* Makes what is drawn follow the divided tetrahedra, and draws the faces that were inside. Positions are set by place.
 * */
void spore_stage_body_divide(SporeStage *stage, SporeStageBody *body, const SporeCuts *cuts);
/* Reads the texture that the visual unit names; what is wrong with the texture is said once. */
void spore_stage_body_find_texture(SporeStage *stage, SporeStageBody *body, const SporeObject *visual);
/* Lays the texture over the surface that was just added. places: of its triangles; NULL: nothing is laid. */
void spore_stage_body_lay_texture(SporeStage *stage, SporeStageBody *body, const double *vertices, const float *places);
/* The errors of a set's spheres in the mesh that the set was made from. NULL: there is none, or it is not measured yet;
 * the stage keeps the result. */
#define SPORE_STAGE_FIT_SCALE 0.02 /* of the diagonal: the error that has the last colour of the scale */
typedef struct SporeStageFit {
  double high;    /* m: the error that has the last colour of the scale */
  float places[]; /* place of each sphere's error on the scale, 0..1 */
} SporeStageFit;
const SporeStageFit *spore_stage_fit(SporeStage *stage, SporeObject *asset, const SporeSphereSet *set);
/* Colours spheres by the forces of the snapshot's contacts, where contacts and spheres are shown. */
void spore_stage_show_touch(SporeStage *stage, const SporeSnapshot *snapshot);
/* Colours spheres by their errors again. */
void spore_stage_drop_touch(SporeStage *stage);
/* The least of 1, 2 and 5 times a power of ten that is not less than the value, above 0, but for rounding. */
double spore_stage_round_up(double value);
GPtrArray *spore_stage_fits_new(void);
void spore_stage_fits_free(GPtrArray *fits);
/* The stage's textures: none at first; those that no body has had since the last call are removed. */
GHashTable *spore_stage_textures_new(void);
void spore_stage_drop_textures(SporeStage *stage);
/* Gets the surface ready for stains. vertices: of the surface at rest, borrowed. */
void spore_stage_body_keep_stain(SporeStage *stage, SporeStageBody *body, const SporeWorld *world,
                                 const double *vertices);
/* The same of spheres that are drawn as the body itself. */
void spore_stage_body_keep_spheres_stain(SporeStageBody *body, const SporeWorld *world);
/* Shows the stains of the snapshot on the surface, or the spheres. */
void spore_stage_body_stain(SporeStage *stage, SporeStageBody *body, const SporeSnapshot *snapshot);
/* The surface is another one: it is stained anew. twins: the vertex of the surface at the start that each of its
 * vertices was made from; NULL: the vertices stay. Copied. */
void spore_stage_body_stain_anew(SporeStageBody *body, const guint32 *twins);
void spore_stage_body_free_stain(SporeStageBody *body);
/* Colours the surfaces by the field of the options, as the snapshot has it; computes nothing where there is none. */
void spore_stage_show_field(SporeStage *stage, const SporeSnapshot *snapshot);
/* Gives the surfaces their own colours again, and frees what the field took. */
void spore_stage_drop_field(SporeStage *stage);
void spore_stage_body_free_shade(SporeStageBody *body);
/* Gives a surface the colours of its field again, or its own look. */
void spore_stage_body_recolour(const SporeStage *stage, const SporeStageBody *body);
/* Removes the triangles that the cuts of the snapshot go through. */
void spore_stage_body_cut(SporeStage *stage, SporeStageBody *body, const SporeCuts *cuts);

#endif
