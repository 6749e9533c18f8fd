/* Makes a body along a middle line of a tubular organ, in one step. */
#ifndef SPORE_AUTHOR_CENTRELINE_BODY_H
#define SPORE_AUTHOR_CENTRELINE_BODY_H

#include "core/scene/document.h"

typedef enum SporeCentrelineBody {
  SPORE_CENTRELINE_THREAD,    /* spline_1d, solid, held at both ends */
  SPORE_CENTRELINE_TUBE,      /* spline_1d with a wall, that resists twist, held at both ends */
  SPORE_CENTRELINE_INTESTINE, /* intestine, held at its mesentery's root */
  SPORE_CENTRELINE_BODIES
} SporeCentrelineBody;
extern const char *const spore_centreline_body_names[]; /* "thread", ...; ends with NULL */

typedef struct SporeCentrelineBodyOptions {
  SporeCentrelineBody body;
  size_t control_points;  /* 0: chosen by the line's length, thickness and bends */
  const SporeCurve *root; /* of an intestine's mesentery; NULL: none, it draws the intestine to its place at rest */
} SporeCentrelineBodyOptions;

/* Control points for a line: one each two radii, and as many as bends need. */
size_t spore_centreline_control_points(const SporeCurve *curve);

/* Whether a body along the line can carry the surface: at most the share SPORE_MAPPING_QUALITY_TORN of its edges leads
 * from one loop of the line to another. */
bool spore_centreline_carries(const SporeCurve *curve, const SporeTriangleMesh *mesh);

/* Turns an existing body into a body along the curve asset `line`: its model, collision unit and holds are replaced.
 * `mesh` is as below. FALSE with a GError: changes made before the failure stay. */
gboolean spore_centreline_body_fill(SporeDocument *document, SporeObject *body, SporeObject *line,
                                    const SporeCurve *curve, const SporeCentrelineBodyOptions *options,
                                    SporeObject *mesh, GError **error);

/* Inserts a curve asset (its file waits as a blob), a body of that kind with the model's own collision spheres along
 * the line, and the links that hold the body. mesh: object of a mesh asset that the body shows, or NULL: the body shows
 * its own skin. Returns the body. NULL with a GError: objects inserted before the failure stay, so call it inside a
 * group where that matters. */
SporeObject *spore_centreline_body_insert(SporeDocument *document, const char *name, const SporeCurve *curve,
                                          const SporeCentrelineBodyOptions *options, SporeObject *mesh, GError **error);

#endif
