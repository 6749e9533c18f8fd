/* Checks of assets: whether each can be read, is used, has a likely size and is up to date. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/common.h"
#include "core/scene/check_private.h"
#include "core/scene/generated.h"

#define METRES 0 /* index into spore_length_units: generated assets are in metres */
#define SLIVER_DEG 5.0

/* unit: of the asset's file. */
static void check_size(SporeCheck *check, SporeObject *asset, double diagonal_m, int unit) {
  g_autofree char *doubt = spore_length_doubt(diagonal_m, unit);
  if (!doubt) return;
  g_autofree char *length = spore_length_text(diagonal_m);
  g_autofree char *remedy = g_strdup_printf(_("if it is an organ or a tool, its unit is wrong: %s"), doubt);
  spore_check_say(check, SPORE_WARNING, asset, remedy, _("\"%s\" is %s across"), spore_object_name(asset), length);
}

/* Whether the mesh is that of a body which is a sheet: such a mesh has a border. */
static gboolean is_sheet(const SporeCheck *check, const SporeObject *asset) {
  const GPtrArray *users = g_hash_table_lookup(check->users, asset);
  for (guint i = 0; users && i < users->len; i++) {
    const SporeObject *user = users->pdata[i];
    if (!g_str_equal(spore_object_type(user)->element, "mechanical") || spore_object_child_count(user) == 0) continue;
    const char *model = spore_object_type(spore_object_child(user, 0))->element;
    if (g_str_equal(model, "mass_spring_net") || g_str_equal(model, "spline_2d")) return TRUE;
  }
  return FALSE;
}

static gboolean check_mesh(SporeCheck *check, SporeObject *asset, GError **error) {
  const SporeTriangleMesh *mesh = spore_document_mesh(check->document, asset, error);
  if (!mesh) return FALSE;
  SporeMeshReport report;
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_triangle_mesh_report(mesh, &report, &fault)) return spore_error_propagate(&fault, error);
  check_size(check, asset, report.diagonal, (int)spore_object_number(asset, "unit"));
  if (mesh->reoriented)
    spore_check_say(check, SPORE_NOTE, asset, _("nothing, or export it again, facing outward"),
                    _("\"%s\" faces inward in its file, wholly or in part: its triangles are turned outward"),
                    spore_object_name(asset));
  if (!report.closed && !is_sheet(check, asset) &&
      spore_check_is_used(check, asset, "mechanical|spheres|tetrahedra")) /* used for more than drawing */
    spore_check_say(
        check, SPORE_NOTE, asset, _("tetrahedra can still be generated: the surface is repaired or wrapped then"),
        _("\"%s\" is not a closed surface: %zu open, %zu non-manifold and %zu misoriented edges"),
        spore_object_name(asset), report.boundary_edges, report.nonmanifold_edges, report.misoriented_edges);
  return TRUE;
}

/* Notes tetrahedra in several pieces. Only its own pins hold a piece that is separate, and a drawn mesh tears where the
 * piece moves away. */
static gboolean check_pieces(SporeCheck *check, SporeObject *asset, const SporeTetrahedralMesh *mesh, GError **error) {
  uint32_t *pieces;
  size_t count;
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_tetrahedral_mesh_pieces(mesh, &pieces, &count, &fault)) return spore_error_propagate(&fault, error);
  spore_free(pieces);
  SporeObject *source = spore_object_reference(asset, "source");
  const SporeTriangleMesh *surface = count > 1 && source ? spore_document_mesh(check->document, source, NULL) : NULL;
  SporeMeshReport report;
  gboolean fewer = surface && spore_triangle_mesh_report(surface, &report, &fault) && report.components < count;
  if (count > 1 && !mesh->labels)
    spore_check_say(check, fewer ? SPORE_WARNING : SPORE_NOTE, asset,
                    fewer ? _("generate them again with more cells") : _("pin each of them, or tie them together"),
                    _("\"%s\" is in %zu pieces that share no node: those that nothing holds move by themselves"),
                    spore_object_name(asset), count);
  return TRUE;
}

static gboolean check_tetrahedra(SporeCheck *check, SporeObject *asset, GError **error) {
  const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(check->document, asset, error);
  if (!mesh) return FALSE;
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(mesh, &quality);
  check_size(check, asset, spore_mesh_diagonal(mesh->vertices, mesh->vertex_count, 3), METRES);
  if (quality.min_dihedral_deg < SLIVER_DEG)
    spore_check_say(check, SPORE_WARNING, asset, _("generate them again with another number of cells"),
                    _("\"%s\" has slivers: the flattest tetrahedron has an angle of %.2g degrees; expected over %g"),
                    spore_object_name(asset), quality.min_dihedral_deg, SLIVER_DEG);
  return check_pieces(check, asset, mesh, error);
}

static gboolean check_spheres(SporeCheck *check, SporeObject *asset, GError **error) {
  const SporeSphereSet *set = spore_document_spheres(check->document, asset, error);
  if (set && set->count > 1) check_size(check, asset, spore_mesh_diagonal(set->spheres, set->count, 4), METRES);
  return set != NULL;
}

static gboolean check_curve(SporeCheck *check, SporeObject *asset, GError **error) {
  const SporeCurve *curve = spore_document_curve(check->document, asset, error);
  if (curve) check_size(check, asset, spore_mesh_diagonal(curve->points, curve->count, 4), METRES);
  return curve != NULL;
}

/* A simulation does not read the label map: it is enough that the file is there. */
static gboolean check_label_map(SporeCheck *check, SporeObject *asset, GError **error) {
  g_autoptr(GBytes) content = spore_document_read_asset(check->document, spore_object_text(asset, "file"), error);
  return content != NULL;
}

/* Whether a body has the asset, whose mesh it would be made from again. */
static gboolean is_made_of_a_body(const SporeCheck *check, const SporeObject *asset) {
  return spore_check_is_used(check, asset, "mechanical|collision|visual") && !spore_generated_is(asset, "edited");
}

static void check_fresh(SporeCheck *check, SporeObject *asset) {
  SporeGenerated generated = spore_generated_state(check->document, asset);
  SporeObject *source = spore_object_reference(asset, "source");
  if (generated == SPORE_GENERATED_FRESH || generated == SPORE_GENERATED_NOT) return;
  gboolean frozen = spore_generated_is(asset, "frozen");
  SporeSeverity severity = frozen ? SPORE_NOTE : SPORE_WARNING;
  const char *remedy = frozen ? _("nothing, or take \"frozen\" away and generate it again") : _("generate it again");
  if (generated == SPORE_GENERATED_SOURCE_CHANGED)
    spore_check_say(check, severity, asset, remedy, _("\"%s\" is stale: \"%s\", which it was made from, has changed"),
                    spore_object_name(asset), spore_object_name(source));
  else
    spore_check_say(check, severity, asset, remedy, _("\"%s\" is stale: its options have changed since it was made"),
                    spore_object_name(asset));
  if (!frozen && is_made_of_a_body(check, asset)) spore_check_offer(check, SPORE_FIX_GENERATE);
}

static void check_asset(SporeCheck *check, SporeObject *asset) {
  const char *element = spore_object_type(asset)->element;
  g_autoptr(GError) error = NULL;
  gboolean used = spore_check_is_used(check, asset, NULL), done;
  if (strcmp(element, "mesh") == 0) done = check_mesh(check, asset, &error);
  else if (strcmp(element, "tetrahedra") == 0) done = check_tetrahedra(check, asset, &error);
  else if (strcmp(element, "curve") == 0) done = check_curve(check, asset, &error);
  else if (strcmp(element, "label_map") == 0) done = check_label_map(check, asset, &error);
  else done = check_spheres(check, asset, &error);
  if (!done) spore_check_say_error(check, used ? SPORE_FAULT : SPORE_WARNING, asset, error);
  if (!used) {
    spore_check_say(check, SPORE_NOTE, asset, _("remove it, or name it in a body"), _("nothing uses the %s \"%s\""),
                    element, spore_object_name(asset));
    spore_check_offer(check, SPORE_FIX_REMOVE);
  }
  if (strcmp(element, "mesh") != 0 && strcmp(element, "label_map") != 0) check_fresh(check, asset);
}

void spore_check_assets(SporeCheck *check) { spore_check_each(check, "assets", NULL, check_asset); }
