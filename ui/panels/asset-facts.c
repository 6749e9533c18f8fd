/* What the inspector says in words of a mesh and of generated assets. */
#include "ui/panels/asset-facts.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/compile.h"
#include "core/scene/generated.h"
#include "ui/document/asset-readers.h"

char *spore_mesh_facts(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  if (!spore_editor_mesh_report(mesh, &report)) return NULL;
  return g_strdup_printf(_("%zu triangles, %.3g × %.3g × %.3g mm, %s"), mesh->triangle_count,
                         1e3 * (report.upper[0] - report.lower[0]), 1e3 * (report.upper[1] - report.lower[1]),
                         1e3 * (report.upper[2] - report.lower[2]), report.closed ? _("closed") : _("not closed"));
}

/* The figures of the asset in words; NULL with an error: the asset cannot be read. */

static char *count_spheres(SporeDocument *document, SporeObject *asset, GError **error) {
  const SporeSphereSet *set = spore_document_spheres(document, asset, error);
  return set ? g_strdup_printf(_("%zu spheres"), set->count) : NULL;
}

static char *tell_tetrahedra(SporeDocument *document, SporeObject *asset, GError **error) {
  const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(document, asset, error);
  SporeTetrahedraQuality quality;
  if (!mesh) return NULL;
  spore_tetrahedral_mesh_quality(mesh, &quality);
  return g_strdup_printf(_("%zu tetrahedra, %.3g ml\nLeast angle %.1f°, mean %.1f°"), mesh->tetrahedron_count,
                         1e6 * quality.volume, quality.min_dihedral_deg, quality.mean_dihedral_deg);
}

static char *tell_curve(SporeDocument *document, SporeObject *asset, GError **error) {
  const SporeCurve *curve = spore_document_curve(document, asset, error);
  return curve ? g_strdup_printf(_("%zu points, %.1f mm long"), curve->count, 1e3 * spore_curve_length(curve)) : NULL;
}

static char *tell_surface(SporeDocument *document, SporeObject *asset, GError **error) {
  const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, error);
  return mesh ? g_strdup_printf(_("%zu nodes, %zu triangles"), mesh->vertex_count, mesh->triangle_count) : NULL;
}

static const struct {
  const char *shows; /* as a generator says */
  char *(*tell)(SporeDocument *document, SporeObject *asset, GError **error);
  const char *none; /* N_ */
} kinds[] = {
    {"spheres", count_spheres, N_("No spheres yet: the body touches nothing")},
    {"tetrahedra", tell_tetrahedra, N_("No tetrahedra yet")},
    {"curve", tell_curve, N_("No middle line yet")},
    {"surface", tell_surface, N_("No generated surface yet")},
};

char *spore_asset_facts(SporeDocument *document, const SporeObject *body, SporeObject *asset, SporeGenerateKind kind) {
  g_autoptr(GError) error = NULL;
  if (!asset && kind == SPORE_GENERATE_SPHERES && spore_body_has_own_spheres(body))
    return g_strdup(_("The model's own spheres"));
  gsize i = 0;
  while (i + 1 < G_N_ELEMENTS(kinds) && strcmp(kinds[i].shows, spore_generators[kind]->shows) != 0) i++;
  if (!asset) return g_strdup(_(kinds[i].none));
  char *text = kinds[i].tell(document, asset, &error);
  return text ? text : g_strdup(error->message);
}

char *spore_spheres_facts(const SporeSpheresReport *report) {
  if (!report) return g_strdup(_(", measuring…"));
  if (!(report->coverage > 0)) return g_strdup("");
  return g_strdup_printf(_("\nCoverage %.1f %%, outside %.1f %%\nDepth error %.1f %%, distance %.2f %%"),
                         100 * report->coverage, 100 * report->outside, 100 * spore_spheres_felt_error(report),
                         100 * report->distance_mean);
}

char *spore_asset_remarks(SporeDocument *document, SporeObject *asset) {
  const char *lines[4] = {NULL};
  int count = 0;
  SporeGenerated generated = spore_generated_state(document, asset);
  SporeObject *source = generated == SPORE_GENERATED_SOURCE_CHANGED ? spore_object_reference(asset, "source") : NULL;
  gboolean labels = source && g_str_equal(spore_object_type(source)->element, "label_map");
  if (source)
    lines[count++] = labels ? _("Stale: the label map has changed since") : _("Stale: the mesh has changed since");
  if (generated == SPORE_GENERATED_OPTIONS_CHANGED) lines[count++] = _("Stale: the options have changed since");
  if (spore_generated_is(asset, "edited")) lines[count++] = _("Edited by hand");
  if (spore_generated_is(asset, "frozen"))
    lines[count++] = _("Frozen: nothing generates it again; it may be edited by hand");
  return g_strjoinv("\n", (char **)lines);
}
