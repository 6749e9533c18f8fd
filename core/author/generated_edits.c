/* Puts the result of a generator into the document: it becomes an asset of a body and remembers how it was made. */
#include "core/author/generated_edits.h"

#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/scene/generated.h"
#include "core/author/edits.h"
#include "core/author/region_edits.h"
#include "core/author/sheet_body.h"
#include "core/scene/sheet_corners.h"

/* What a body uses. */

SporeObject *spore_edit_body_spheres(SporeDocument *document, SporeObject *body) {
  return spore_edit_used_asset(document, body, "collision", "spheres", "spheres");
}

SporeObject *spore_edit_body_tetrahedra(SporeDocument *document, SporeObject *body) {
  return spore_edit_used_asset(document, body, "mechanical", "geometry", "tetrahedra");
}

const SporeTetrahedralMesh *spore_edit_body_cells(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_body_tetrahedra(document, body);
  return asset ? spore_document_tetrahedra(document, asset, NULL) : NULL;
}

static SporeObject *generated(SporeObject *asset) {
  const char *source = asset ? spore_object_text(asset, "source") : NULL;
  return source && *source ? asset : NULL;
}

/* Whether a mesh is the patch of a sheet. */
static gboolean is_patch(const SporeObject *mesh) {
  double corners[12];
  return spore_sheet_corners(mesh, corners);
}

/* An asset of that element that was generated from the mesh that the body shows. */
static SporeObject *made_of_shown(SporeDocument *document, SporeObject *body, const char *element) {
  SporeObject *mesh = spore_edit_visual_mesh(document, body, NULL);
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; mesh && i < spore_object_child_count(assets); i++) {
    SporeObject *asset = spore_object_child(assets, i);
    if (g_str_equal(spore_object_type(asset)->element, element) && generated(asset) && !is_patch(asset) &&
        g_str_equal(spore_object_text(asset, "source"), spore_object_name(mesh)))
      return asset;
  }
  return NULL;
}

SporeObject *spore_edit_body_curve(SporeDocument *document, SporeObject *body) {
  SporeObject *used = spore_edit_used_asset(document, body, "mechanical", "geometry", "curve");
  return used ? used : made_of_shown(document, body, "curve");
}

SporeObject *spore_edit_body_sheet(SporeDocument *document, SporeObject *body) {
  SporeObject *used = generated(spore_edit_used_asset(document, body, "mechanical", "geometry", "mesh"));
  return used && is_patch(used) ? used : NULL;
}

/* A generated mesh that is no patch. */
static SporeObject *generated_surface(SporeObject *mesh) {
  mesh = generated(mesh);
  return mesh && !is_patch(mesh) ? mesh : NULL;
}

SporeObject *spore_edit_body_surface(SporeDocument *document, SporeObject *body) {
  SporeObject *used = generated_surface(spore_edit_used_asset(document, body, "mechanical", "geometry", "mesh"));
  if (!used) used = generated_surface(spore_edit_visual_mesh(document, body, NULL));
  return used ? used : made_of_shown(document, body, "mesh");
}

/* Assets. */

static gboolean remember_option(SporeDocument *document, SporeObject *asset, guint property, const void *fields,
                                GError **error) {
  SporeValue value = spore_parameter_load(&spore_object_type(asset)->table->parameters[property], fields);
  return spore_value_equal(&value, &spore_object_type(asset)->initial[property])
             ? spore_document_unset(document, asset, property, error)
             : spore_document_set(document, asset, property, &value, error);
}

static gboolean remember_options(SporeDocument *document, SporeObject *asset, const void *fields, GError **error) {
  const SporeParameterTable *table = spore_object_type(asset)->table;
  gboolean done = TRUE;
  for (guint i = 0; done && i < table->count; i++)
    if (spore_generated_is_option(&table->parameters[i])) done = remember_option(document, asset, i, fields, error);
  return done;
}

/* Adds a region to the asset. The last of a region's own parameters is its setting (density, size). */
static gboolean add_region(SporeDocument *document, SporeObject *asset, const SporeGenerateRegion *given,
                           GError **error) {
  const char *element = spore_region_element(spore_object_type(asset));
  SporeObject *region = spore_document_insert(document, asset, element, "region", G_MAXUINT, error);
  if (!region) return FALSE;
  const SporeParameterTable *table = spore_object_type(region)->table;
  const SporeValue centre = {.type = SPORE_VECTOR, .number = {given->centre[0], given->centre[1], given->centre[2]}};
  const SporeValue radius = {.type = SPORE_REAL, .number = {given->radius}};
  const SporeValue value = {.type = SPORE_REAL, .number = {given->value}};
  return spore_document_set(document, region, (guint)spore_parameter_find(table, "centre"), &centre, error) &&
         spore_document_set(document, region, (guint)spore_parameter_find(table, "radius"), &radius, error) &&
         spore_document_set(document, region, (guint)table->count - 1, &value, error);
}

static gboolean add_regions(SporeDocument *document, SporeObject *asset, const SporeGeneratedFrom *from,
                            GError **error) {
  for (gsize i = 0; i < from->region_count; i++)
    if (!add_region(document, asset, &from->regions[i], error)) return FALSE;
  return TRUE;
}

static gboolean unset(SporeDocument *document, SporeObject *object, const char *property, GError **error) {
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  return spore_document_unset(document, object, (guint)index, error);
}

gboolean spore_edit_remember_source(SporeDocument *document, SporeObject *asset, const SporeGeneratedFrom *from,
                                    GError **error) {
  if (!spore_generated_may_change(asset, error) || !remember_options(document, asset, from->fields, error) ||
      !add_regions(document, asset, from, error))
    return FALSE;
  g_autofree char *options_hash = spore_generated_options_hash(asset);
  return spore_document_set_text(document, asset, "source", from->source, error) &&
         spore_document_set_text(document, asset, "source_hash", from->source_hash, error) &&
         spore_document_set_text(document, asset, "options_hash", options_hash, error) &&
         unset(document, asset, "edited", error);
}

/* The content of an asset's file; owns the text. */
typedef struct {
  const char *element, *suffix, *extension;
  char *text;
  gsize size;
} Content;

/* Stores the content in the asset that the body uses, where the same generator made it, else in a new asset. NULL:
 * refused. */
static SporeObject *keep(SporeDocument *document, SporeObject *body, SporeObject *used, const SporeGeneratedFrom *from,
                         const Content *content, GError **error) {
  g_autoptr(GBytes) bytes = g_bytes_new_take(content->text, content->size);
  g_autofree char *name = g_strdup_printf("%s_%s", spore_object_name(body), content->suffix);
  SporeObject *asset = generated(used);
  if (!asset)
    asset = spore_document_insert(document, spore_document_section(document, "assets"), content->element, name,
                                  G_MAXUINT, error);
  if (!asset) return NULL;
  g_autofree char *file =
      spore_content_file_name(spore_object_name(asset), content->extension, content->text, content->size);
  spore_document_put_blob(document, file, bytes);
  return spore_document_set_text(document, asset, "file", file, error) &&
                 spore_edit_remember_source(document, asset, from, error)
             ? asset
             : NULL;
}

/* Lets a unit of the body refer to the asset. */
static gboolean use(SporeDocument *document, SporeObject *body, const char *unit, const char *property,
                    const SporeObject *asset, GError **error) {
  SporeObject *part = spore_edit_child_or_new(document, body, unit, error);
  return part && spore_document_set_text(document, part, property, spore_object_name(asset), error);
}

/* Kinds. */

gboolean spore_edit_use_spheres(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeSphereSet *set, GError **error) {
  Content content = {.element = "spheres", .suffix = "spheres", .extension = "spheres"};
  content.text = spore_spheres_format(set, &content.size);
  spore_document_begin(document, _("Generate spheres"));
  SporeObject *asset = keep(document, body, spore_edit_body_spheres(document, body), from, &content, error);
  return spore_edit_finish(document, asset && use(document, body, "collision", "spheres", asset, error));
}

gboolean spore_edit_use_tetrahedra(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                   const SporeTetrahedralMesh *mesh, GError **error) {
  Content content = {.element = "tetrahedra", .suffix = "tetrahedra", .extension = "mesh"};
  content.text = spore_medit_format(mesh, &content.size);
  spore_document_begin(document, _("Generate tetrahedra"));
  SporeObject *asset = keep(document, body, spore_edit_body_tetrahedra(document, body), from, &content, error);
  return spore_edit_finish(document, asset && use(document, body, "mechanical", "geometry", asset, error) &&
                                         spore_edit_give_usual_model(document, body, SPORE_GEOMETRY_TETRAHEDRA, error));
}

gboolean spore_edit_use_curve(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                              const SporeCurve *curve, const SporeCentrelineBodyOptions *options, GError **error) {
  SporeObject *source = spore_document_find(document, "mesh", from->source);
  const SporeTriangleMesh *mesh = source ? spore_document_mesh(document, source, error) : NULL;
  if (!mesh) return FALSE;
  bool carried = options && spore_centreline_carries(curve, mesh);
  Content content = {.element = "curve", .suffix = "line", .extension = "curve"};
  content.text = spore_curve_format(curve, &content.size);
  spore_document_begin(document, _("Generate middle line"));
  SporeObject *asset = keep(document, body, spore_edit_body_curve(document, body), from, &content, error);
  return spore_edit_finish(document,
                           asset && (!options || spore_centreline_body_fill(document, body, asset, curve, options,
                                                                            carried ? source : NULL, error)));
}

gboolean spore_edit_use_surface(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                                const SporeTriangleMesh *mesh, SporeSurfaceUse where, GError **error) {
  Content content = {.element = "mesh", .suffix = "surface", .extension = "off"};
  content.text = spore_off_format(mesh, &content.size);
  spore_document_begin(document, _("Generate surface"));
  SporeObject *asset = keep(document, body, spore_edit_body_surface(document, body), from, &content, error);
  gboolean done = asset != NULL;
  if (done && where == SPORE_SURFACE_MODEL)
    done = spore_edit_give_usual_model(document, body, SPORE_GEOMETRY_SURFACE, error) &&
           use(document, body, "mechanical", "geometry", asset, error);
  if (done && where == SPORE_SURFACE_SHOWN) done = use(document, body, "visual", "mesh", asset, error);
  return spore_edit_finish(document, done);
}

gboolean spore_edit_use_sheet(SporeDocument *document, SporeObject *body, const SporeGeneratedFrom *from,
                              const SporeTriangleMesh *patch, const SporeSheetReport *report, SporeSheetUse where,
                              GError **error) {
  Content content = {.element = "mesh", .suffix = "patch", .extension = "off"};
  const SporeMeshFields *fields = from->fields;
  SporeObject *used = spore_edit_body_sheet(document, body);
  content.text = spore_off_format(patch, &content.size);
  spore_document_begin(document, _("Generate spline sheet"));
  SporeObject *owner = body;
  if (!used && where == SPORE_SHEET_BODY) owner = spore_sheet_body_beside(document, body, error);
  SporeObject *asset = owner ? keep(document, owner, used, from, &content, error) : NULL;
  if (!owner) g_free(content.text);
  return spore_edit_finish(document,
                           asset && (where == SPORE_SHEET_ASSET ||
                                     spore_sheet_body_fill(document, owner, asset, report, fields->smoothing, error)));
}
