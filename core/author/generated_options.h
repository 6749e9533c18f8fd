/* What a generator is asked for by the asset that it makes: its attributes, its regions, and where it starts from. */
#ifndef SPORE_AUTHOR_GENERATED_OPTIONS_H
#define SPORE_AUTHOR_GENERATED_OPTIONS_H

#include "core/generate/centreline/centreline.h"
#include "core/generate/spheres/spheres.h"
#include "core/generate/surface/surface.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* The mesh asset that what the body uses (target, NULL: nothing yet) is made from: what the body shows; where that is
 * what was generated, or nothing, what the generated asset came from. NULL with an error: there is none. */
SporeObject *spore_edit_generator_source(SporeDocument *document, SporeObject *body, SporeObject *target,
                                         GError **error);
/* Element of the regions that this kind of object holds: "region" of `regions`; NULL: it holds none. */
const char *spore_region_element(const SporeObjectType *holder);
/* Of an asset, or of none (NULL); regions: room for SPORE_GENERATE_REGIONS. FALSE with an error: there are more. */
gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error);

/* The options borrow the regions. */
SporeSpheresOptions spore_edit_spheres_options(const SporeSpheresFields *fields, const SporeGenerateRegion *regions,
                                               gsize count);
SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count);
SporeCentrelineOptions spore_edit_centreline_options(const SporeCurveFields *fields);
SporeSimplifyOptions spore_edit_surface_options(const SporeMeshFields *fields);
/* Index among the asset's methods. */
int spore_edit_spheres_method(SporeSpheresMode mode);

#endif
