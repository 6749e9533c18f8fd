/* What is measured on a scene as it stands: the kinds, from places and surfaces, and how the figures read. */
#ifndef SPORE_SCENE_GAUGE_H
#define SPORE_SCENE_GAUGE_H

#include "core/math/vec3.h"
#include "core/mesh/mesh.h"
#include "core/scene/error.h"

#define SPORE_GAUGE_PLACES 3

typedef struct SporeGauge {
  const char *name, *label;                     /* label: translatable */
  guint place_count;                            /* 1 to SPORE_GAUGE_PLACES: clicks that it takes */
  const char *hints[SPORE_GAUGE_PLACES];        /* what to click on, translatable */
  double (*of_places)(const SporeVec3 *places); /* from place_count places, m; NULL: of the body at the one place */
  char *(*text)(double figure);                 /* with its unit; g_free */
} SporeGauge;

/* distance (m), angle (rad, at the second of three places), volume (m^3); NULL-terminated. */
extern const SporeGauge *const spore_gauges[];
/* NULL: no such kind. */
const SporeGauge *spore_gauge_find(const char *name);

/* The volume within a surface, m^3, whichever way its triangles look. FALSE with a GError: it is not closed, or there
 * is no memory. */
gboolean spore_gauge_volume(const SporeTriangleMesh *surface, double *volume, GError **error);

#endif
