/* What a user should know of tetrahedra that were made: what of the surface they do not show, what was asked for and
 * did not come, and what to do about it. One wording for the command line and the editor. */
#ifndef SPORE_GENERATE_TETRAHEDRA_REMARKS_H
#define SPORE_GENERATE_TETRAHEDRA_REMARKS_H

#include "core/generate/tetrahedra.h"

/* In the user's language, lines that end in a newline each; empty: nothing is to be said. g_free. */
char *spore_tetrahedra_remarks(const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                               const SporeTetrahedraReport *report);

#endif
