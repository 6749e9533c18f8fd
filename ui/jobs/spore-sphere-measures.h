/* The quality of sets of spheres. Each set is measured once on a worker, and kept by the content of mesh and spheres.
 * No GTK.
 *
 * Signals
 *   measured ()   another one is known */
#ifndef SPORE_UI_JOBS_SPORE_SPHERE_MEASURES_H
#define SPORE_UI_JOBS_SPORE_SPHERE_MEASURES_H

#include <glib-object.h>

#include "ui/jobs/works.h"

G_BEGIN_DECLS

#define SPORE_TYPE_SPHERE_MEASURES spore_sphere_measures_get_type()
G_DECLARE_FINAL_TYPE(SporeSphereMeasures, spore_sphere_measures, SPORE, SPHERE_MEASURES, GObject)

SporeSphereMeasures *spore_sphere_measures_new(void);
/* The figures of the body's spheres against the mesh that it shows; borrowed until the next call. All zero: there is no
 * such mesh, or the set cannot be measured. NULL: not known yet; sets are measured one at a time. */
const SporeSpheresReport *spore_sphere_measures_get(SporeSphereMeasures *self, SporeDocument *document,
                                                    SporeObject *body, SporeObject *asset);

G_END_DECLS
#endif
