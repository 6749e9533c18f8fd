/* Whether what was generated is good, in words, and what to do where it is not. */
#ifndef SPORE_AUTHOR_VERDICT_H
#define SPORE_AUTHOR_VERDICT_H

#include <glib.h>

#include "core/generate/spheres/spheres.h"
#include "core/generate/tetrahedra/tetrahedra.h"

/* Spheres are good where what is felt is off by at most this share of the organ's depth: what 110 balanced spheres do
 * on compact organs, by our own measuring. Above SPORE_SPHERES_COARSE they are coarse. */
#define SPORE_SPHERES_GOOD 0.04
#define SPORE_SPHERES_COARSE 0.08
/* Tetrahedra are good with angles of at least this, and a surface nearer to the organ's than this share of its size. */
#define SPORE_CELLS_GOOD_ANGLE_DEG 10.0
#define SPORE_CELLS_GOOD_ERROR 0.02

/* Of so many spheres made with the options: one translated line without end; g_free. NULL: nothing can be said, as of a
 * set on an open surface, or nothing can be done, as about spheres round each tetrahedron. */
char *spore_spheres_verdict(const SporeSpheresOptions *options, const SporeSpheresReport *report, size_t count);
/* The same of tetrahedra. */
char *spore_tetrahedra_verdict(const SporeTetrahedraReport *report);
/* What spheres made the other way would be, in a translated line without end: fitted instead of one round each
 * tetrahedron, or that instead. g_free. */
char *spore_spheres_other_text(gboolean fitted, size_t count, const SporeSpheresReport *report);

#endif
