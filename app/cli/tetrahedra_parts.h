/* spore tetrahedra: the parts of a mesh file, by name. */
#ifndef SPORE_CLI_TETRAHEDRA_PARTS_H
#define SPORE_CLI_TETRAHEDRA_PARTS_H

#include "app/cli/cli.h"
#include "core/generate/tetrahedra/tetrahedra.h"

/* Adds the member "parts": what each piece of the surface is to the solid. */
void spore_cli_report_parts(SporeCli *cli, const SporeTetrahedraReport *report);
/* Keeps the triangles of the wanted parts, whose names `wanted` lists between commas. parts, names: as
 * spore_mesh_decode_tagged gives them; parts goes with the triangles. FALSE: a name is not that of a part. */
gboolean spore_cli_keep_parts(const char *file, const char *wanted, SporeTriangleMesh *mesh, guint32 *parts,
                              char **names, GError **error);

#endif
