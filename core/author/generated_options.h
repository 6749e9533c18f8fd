/* What a generator is asked for by the asset that it makes: its attributes, its regions, and where it starts from. */
#ifndef SPORE_AUTHOR_GENERATED_OPTIONS_H
#define SPORE_AUTHOR_GENERATED_OPTIONS_H

#include "core/generate/centreline.h"
#include "core/generate/spheres.h"
#include "core/generate/surface.h"
#include "core/generate/tetrahedra.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* A region of the generated asset: a ball, and what shall be there. */
typedef struct SporeGenerateRegion {
  double centre[3], radius; /* m */
  double value;             /* density of spheres, edge length of cells (m) */
} SporeGenerateRegion;
#define SPORE_GENERATE_REGIONS 64 /* at most */

/* The mesh asset that what the body uses (target, NULL: nothing yet) is made from: what the body shows; where that is
 * what was generated, or nothing, what the generated asset came from. NULL with an error: there is none. */
SporeObject *spore_edit_generator_source(SporeDocument *document, SporeObject *body, SporeObject *target,
                                         GError **error);
/* Of an asset, or of none (NULL); regions: room for SPORE_GENERATE_REGIONS. FALSE with an error: there are more. */
gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error);

/* room: of as many regions as are given; the options borrow it. */
SporeSpheresOptions spore_edit_spheres_options(const SporeSpheresFields *fields, const SporeGenerateRegion *regions,
                                               gsize count, SporeSpheresRegion *room);
SporeTetrahedraOptions spore_edit_tetrahedra_options(const SporeTetrahedraFields *fields,
                                                     const SporeGenerateRegion *regions, gsize count,
                                                     SporeTetrahedraRegion *room);
SporeCentrelineOptions spore_edit_centreline_options(const SporeCurveFields *fields);
SporeSimplifyOptions spore_edit_surface_options(const SporeMeshFields *fields);
/* Index among the asset's methods. */
int spore_edit_spheres_method(SporeSpheresMode mode);

#endif
