/* What a scene shows, as arrays: the surfaces, tetrahedra, lines and points of its bodies at a moment of a run. For
 * files that other programs read. */
#ifndef SPORE_SCENE_DRAWING_H
#define SPORE_SCENE_DRAWING_H

#include "core/scene/compile.h"

/* In a liquid at rest, neighbours are where attraction and repulsion balance: 2^(1/6) of the width of their spheres
 * apart. */
#define SPORE_LIQUID_SPACING 1.12

typedef enum SporePartKind {
  SPORE_PART_SURFACE, /* triangles */
  SPORE_PART_CELLS,   /* tetrahedra */
  SPORE_PART_LINE,    /* one line through all points in turn, with radii */
  SPORE_PART_POINTS   /* spheres: particles, or what stands for a body without a mesh */
} SporePartKind;

/* One thing to draw of a body. A body has one part that shows it. Beside this part it may have another one, which is
 * what physics moves: tetrahedra under a finer surface, or the line in the middle of a tube. */
typedef struct SporeDrawnPart {
  SporePartKind kind;
  guint32 body;     /* index in the world */
  const char *name; /* of the body; borrowed from the world */
  gboolean shows;   /* the part shows the body */
  gboolean moves;   /* FALSE: the body is unmovable, and the part is the same at all moments */
  gboolean framed;  /* the points go with the body's frame, and do so always */
  gboolean liquid;  /* of points: drawn as the skin around them */
  gboolean smoke;   /* of points: drawn as puffs */
  double colour[3]; /* sRGB, 0..1 */
  double wetness;   /* 0..1 */
  double opacity;   /* 0..1 */

  /* At the moment of the last spore_drawing_update. */
  SporePose frame;                /* of a framed part */
  gsize count;                    /* points; particles that are out of the world are not among them */
  double *positions, *velocities; /* count x 3, world, m and m/s */
  double *radii;                  /* count, m, of a line or points; else NULL */
  gsize element_count;            /* triangles or tetrahedra */
  guint32 *elements;              /* element_count x 3 or 4 */
  gboolean cut;                   /* elements or points are others than at time 0, since the body was cut or torn */
  GBytes *picture;                /* of a surface: PNG that lies over it (core/scene/texture.h); NULL: none */
  float *places;                  /* then where: of the corners of the triangles, x 3 x 2 */
  double *rest;                   /* of cells: count x 3, world: at rest, where the body stands at time 0 */
  struct SporePartSource *source; /* private */
} SporeDrawnPart;

/* The drawing of a simulation. Borrows the document and the simulation. */
typedef struct SporeDrawing SporeDrawing;

/* All parts of all bodies, by bodies, at time 0 or wherever the world stands. NULL with the error: an asset cannot be
 * read, or there is no memory. */
SporeDrawing *spore_drawing_new(SporeDocument *document, const SporeSimulation *simulation, GError **error);
void spore_drawing_free(SporeDrawing *drawing);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeDrawing, spore_drawing_free)
/* Moves all parts to the newest snapshot of the world, which this function acquires. FALSE: no memory. */
gboolean spore_drawing_update(SporeDrawing *drawing, GError **error);
/* The simulation that is drawn. */
const SporeSimulation *spore_drawing_simulation(const SporeDrawing *drawing);
guint spore_drawing_part_count(const SporeDrawing *drawing);
/* Part i; owned by the drawing. */
const SporeDrawnPart *spore_drawing_part(const SporeDrawing *drawing, guint i);

/* The part as triangles, as it is shown: the boundary of tetrahedra, the tube around a line, the skin of a liquid, a
 * ball for each other point. Only vertices that triangles use. *mesh: spore_triangle_mesh_clear; empty where nothing is
 * left to show. FALSE: no memory. */
gboolean spore_drawn_part_mesh(const SporeDrawnPart *part, SporeTriangleMesh *mesh, GError **error);
/* The same, and which of the part's points each vertex is. *points: mesh->vertex_count, g_free; NULL: the vertices are
 * no points of the part, as of tubes, balls and skins. */
gboolean spore_drawn_part_mesh_of_points(const SporeDrawnPart *part, SporeTriangleMesh *mesh, guint32 **points,
                                         GError **error);
/* The same as the first with vertices in the frame of a framed part. */
gboolean spore_drawn_part_local_mesh(const SporeDrawnPart *part, SporeTriangleMesh *mesh, GError **error);

#endif
