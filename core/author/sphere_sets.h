/* Sets of spheres varied: a copy of a document whose generated spheres are fewer or more. */
#ifndef SPORE_AUTHOR_SPHERE_SETS_H
#define SPORE_AUTHOR_SPHERE_SETS_H

#include "core/base/progress.h"
#include "core/scene/document.h"

#define SPORE_SPHERE_FACTOR_LEAST 0.02
#define SPORE_SPHERE_FACTOR_MOST 50.

/* A copy in which each set of spheres that was generated from a mesh, and that a body uses, is generated anew: `factor`
 * times as many as it has, by the other options of that set. Factor 1: a plain copy. body: whose set alone; NULL: all.
 * The document stays as it is. NULL with a GError: no such set, one is frozen or cannot be made, cancelled. */
SporeDocument *spore_sphere_sets_vary(SporeDocument *document, const char *body, double factor,
                                      const SporeProgress *progress, GError **error);

#endif
