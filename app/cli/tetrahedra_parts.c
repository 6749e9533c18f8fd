/* spore tetrahedra: the parts of a mesh file that are wanted, and what becomes of each. */
#include "app/cli/tetrahedra_parts.h"

#include <glib/gi18n.h>
#include <string.h>

void spore_cli_report_parts(SporeCli *cli, const SporeTetrahedraReport *report) {
  spore_cli_open_array(cli, "parts");
  for (size_t i = 0; i < report->piece_count; i++) {
    const SporeTetrahedraPiece *piece = report->piece + i;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", piece->name);
    spore_cli_text(cli, "role", spore_piece_role_names[piece->role]);
    spore_cli_text(cli, "wall", spore_piece_wall_names[piece->wall]);
    spore_cli_count(cli, "in", piece->in);
    spore_cli_count(cli, "triangles", (gint64)piece->triangles);
    spore_cli_count(cli, "holes", (gint64)piece->holes);
    spore_cli_count(cli, "open_edges", (gint64)piece->open_edges);
    spore_cli_number(cli, "area_m2", piece->area);
    spore_cli_number(cli, "inside_share", piece->inside_share);
    spore_cli_number(cli, "least_depth_m", piece->depth[0]);
    spore_cli_number(cli, "most_depth_m", piece->depth[1]);
    spore_cli_count(cli, "cells", (gint64)piece->cells);
    spore_cli_number(cli, "thickness_m", piece->thickness);
    spore_cli_count(cli, "merged_with", piece->merged);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

/* Marks the parts of that name. FALSE: there are none. */
static gboolean mark(const char *name, char **names, gboolean *marked) {
  gboolean found = FALSE;
  for (guint i = 0; names && names[i]; i++)
    if (strcmp(names[i], name) == 0) found = marked[i] = TRUE;
  return found;
}

/* Moves the triangles of the marked parts to the front. */
static void keep(SporeTriangleMesh *mesh, guint32 *parts, const gboolean *marked) {
  gsize kept = 0;
  for (gsize t = 0; t < mesh->triangle_count; t++) {
    if (!marked[parts[t]]) continue;
    memmove(mesh->triangles + 3 * kept, mesh->triangles + 3 * t, 3 * sizeof *mesh->triangles);
    parts[kept++] = parts[t];
  }
  mesh->triangle_count = kept;
}

gboolean spore_cli_keep_parts(const char *file, const char *wanted, SporeTriangleMesh *mesh, guint32 *parts,
                              char **names, GError **error) {
  g_auto(GStrv) asked = g_strsplit(wanted, ",", -1);
  g_autofree gboolean *marked = g_new0(gboolean, names ? g_strv_length(names) + 1 : 1);
  for (guint i = 0; asked[i]; i++) {
    const char *name = g_strstrip(asked[i]);
    if (mark(name, names, marked)) continue;
    g_autofree char *known = names ? g_strjoinv(", ", names) : g_strdup(_("none"));
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("there is no part \"%s\"; expected names of its parts (%s); correct --parts"), name,
                             known);
  }
  keep(mesh, parts, marked);
  SporeError failure = SPORE_ERROR_INIT;
  if (!mesh->triangle_count)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("the parts \"%s\" have no triangle that another part has not as well; expected a part "
                               "with a surface of its own; correct --parts"),
                             wanted);
  if (spore_triangle_mesh_weld_tagged(mesh, 0, parts, &failure)) return TRUE; /* drops vertices without triangles */
  spore_error_at(&failure, file);
  return spore_error_propagate(&failure, error);
}
