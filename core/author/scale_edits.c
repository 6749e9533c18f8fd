/* Scales bodies. An asset that nothing else uses is changed where it stands; of one that others use, or that is the
 * source of such a one, the bodies get a copy. */
#include "core/author/scale_edits.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/asset_stretch.h"
#include "core/author/edits.h"
#include "core/author/placement.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/scene/compile.h"
#include "core/scene/generated.h"

/* An asset of the bodies. */
typedef struct Shape {
  SporeObject *asset, *scaled; /* scaled: the same, or the copy; NULL: not yet */
  gboolean shared;             /* what stays as it is uses it */
  SporeGenerated state;        /* before */
} Shape;

typedef struct Scaling {
  SporeDocument *document;
  GPtrArray *bodies; /* of SporeObject *: all that move */
  GArray *shapes;    /* of Shape */
  double factor;
} Scaling;

static const SporeParameterTable *table_of(const SporeObject *object) { return spore_object_type(object)->table; }

/* What the bodies use. */

static Shape *shape_of(const Scaling *scaling, const SporeObject *asset) {
  for (guint i = 0; i < scaling->shapes->len; i++) {
    Shape *shape = &g_array_index(scaling->shapes, Shape, i);
    if (shape->asset == asset) return shape;
  }
  return NULL;
}

static SporeObject *source_of(const SporeObject *asset) {
  return spore_parameter_find(table_of(asset), "source") >= 0 ? spore_object_reference(asset, "source") : NULL;
}

static void add_shape(Scaling *scaling, SporeObject *asset) {
  for (; asset && spore_asset_is_stretchable(asset) && !shape_of(scaling, asset); asset = source_of(asset)) {
    Shape shape = {.asset = asset, .state = spore_generated_state(scaling->document, asset)};
    g_array_append_val(scaling->shapes, shape);
  }
}

static void add_shapes(Scaling *scaling, const SporeObject *object) {
  for (guint i = 0; i < table_of(object)->count; i++) add_shape(scaling, spore_object_asset(object, i));
  for (guint i = 0; i < spore_object_child_count(object); i++) add_shapes(scaling, spore_object_child(object, i));
}

/* Whether the object goes on as it is. */
static gboolean stays(const Scaling *scaling, SporeObject *object) {
  const Shape *shape = shape_of(scaling, object);
  return shape ? shape->shared : !g_ptr_array_find(scaling->bodies, object, NULL);
}

static gboolean is_shared(const Scaling *scaling, const Shape *shape) {
  const SporeObject *root = spore_document_root(scaling->document);
  for (guint s = 0; s < spore_object_child_count(root); s++) {
    const SporeObject *section = spore_object_child(root, s);
    for (guint i = 0; i < spore_object_child_count(section); i++) {
      SporeObject *object = spore_object_child(section, i);
      if (stays(scaling, object) && spore_object_refers_to(object, shape->asset)) return TRUE;
    }
  }
  return FALSE;
}

static void find_shared(Scaling *scaling) {
  for (gboolean more = TRUE; more;) {
    more = FALSE;
    for (guint i = 0; i < scaling->shapes->len; i++) {
      Shape *shape = &g_array_index(scaling->shapes, Shape, i);
      if (!shape->shared && is_shared(scaling, shape)) shape->shared = more = TRUE;
    }
  }
}

/* Assets. */

/* A copy under another name, with what is set and with the regions. */
static gboolean copy_values(const Scaling *scaling, const SporeObject *from, SporeObject *to, GError **error) {
  for (guint i = 0; i < table_of(from)->count; i++)
    if (table_of(from)->parameters[i].type != SPORE_NAME && spore_object_is_set(from, i) &&
        !spore_document_set(scaling->document, to, i, spore_object_value(from, i), error))
      return FALSE;
  for (guint i = 0; i < spore_object_child_count(from); i++) {
    const SporeObject *child = spore_object_child(from, i);
    SporeObject *made = spore_document_insert(scaling->document, to, spore_object_type(child)->element,
                                              spore_object_name(child), G_MAXUINT, error);
    if (!made || !copy_values(scaling, child, made, error)) return FALSE;
  }
  return TRUE;
}

static SporeObject *copy_asset(const Scaling *scaling, const SporeObject *asset, GError **error) {
  SporeObject *copy =
      spore_document_insert(scaling->document, spore_object_parent(asset), spore_object_type(asset)->element,
                            spore_object_name(asset), G_MAXUINT, error);
  return copy && copy_values(scaling, asset, copy, error) ? copy : NULL;
}

/* Whether the parameter is a length or a place. */
static gboolean is_length(const SporeParameter *parameter) {
  return (parameter->type == SPORE_REAL || parameter->type == SPORE_VECTOR) && g_strcmp0(parameter->unit, "m") == 0;
}

static gboolean scale_lengths(const Scaling *scaling, SporeObject *object, GError **error) {
  for (guint i = 0; i < table_of(object)->count; i++) {
    SporeValue value = *spore_object_value(object, i);
    if (!is_length(&table_of(object)->parameters[i])) continue;
    for (int k = 0; k < 3; k++) value.number[k] *= scaling->factor;
    if (!spore_value_equal(&value, spore_object_value(object, i)) &&
        !spore_document_set(scaling->document, object, i, &value, error))
      return FALSE;
  }
  for (guint i = 0; i < spore_object_child_count(object); i++)
    if (!scale_lengths(scaling, spore_object_child(object, i), error)) return FALSE;
  return TRUE;
}

/* The content of what it was, so many times as large. */
static gboolean fill(const Scaling *scaling, const Shape *shape, SporeObject *scaled, GError **error) {
  gsize size;
  const char *extension;
  const double factors[3] = {scaling->factor, scaling->factor, scaling->factor};
  char *text = spore_asset_stretched(scaling->document, shape->asset, factors, &extension, &size, error);
  if (!text) return FALSE;
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *file = spore_content_file_name(spore_object_name(scaled), extension, text, size);
  gboolean mesh = spore_parameter_find(table_of(scaled), "unit") >= 0;
  spore_document_put_blob(scaling->document, file, content);
  return spore_document_set_text(scaling->document, scaled, "file", file, error) &&
         (!mesh || (spore_document_set_text(scaling->document, scaled, "unit", spore_length_units[0], error) &&
                    spore_document_set_text(scaling->document, scaled, "frame", spore_mesh_frames[0], error)));
}

/* What was generated from a source that is scaled, too, is as fresh as before. */
static gboolean remember(const Scaling *scaling, const Shape *shape, SporeObject *scaled, const Shape *source,
                         GError **error) {
  SporeDocument *document = scaling->document;
  if (shape->state == SPORE_GENERATED_NOT) return TRUE;
  if (!source) return spore_document_set_text(document, scaled, "edited", "true", error);
  if (!spore_document_set_text(document, scaled, "source", spore_object_name(source->scaled), error)) return FALSE;
  if (shape->state != SPORE_GENERATED_FRESH) return TRUE;
  g_autofree char *source_hash = spore_document_asset_hash(document, source->scaled);
  g_autofree char *options_hash = spore_generated_options_hash(scaled);
  return source_hash && spore_document_set_text(document, scaled, "source_hash", source_hash, error) &&
         spore_document_set_text(document, scaled, "options_hash", options_hash, error);
}

static gboolean scale_shape(const Scaling *scaling, Shape *shape, GError **error) {
  SporeObject *from = source_of(shape->asset);
  Shape *source = from ? shape_of(scaling, from) : NULL;
  if (shape->scaled) return TRUE;
  if (source && !scale_shape(scaling, source, error)) return FALSE;
  SporeObject *scaled = shape->shared ? copy_asset(scaling, shape->asset, error) : shape->asset;
  if (!scaled || !fill(scaling, shape, scaled, error) || !scale_lengths(scaling, scaled, error) ||
      !remember(scaling, shape, scaled, source, error))
    return FALSE;
  shape->scaled = scaled;
  return TRUE;
}

/* Bodies. */

static gboolean use_scaled(const Scaling *scaling, SporeObject *object, GError **error) {
  for (guint i = 0; i < table_of(object)->count; i++) {
    SporeObject *asset = spore_object_asset(object, i);
    const Shape *shape = asset ? shape_of(scaling, asset) : NULL;
    if (shape && shape->scaled != asset &&
        !spore_document_set_text(scaling->document, object, table_of(object)->parameters[i].name,
                                 spore_object_name(shape->scaled), error))
      return FALSE;
  }
  for (guint i = 0; i < spore_object_child_count(object); i++)
    if (!use_scaled(scaling, spore_object_child(object, i), error)) return FALSE;
  return TRUE;
}

/* How a body touches and how faithfully it is simulated is a matter of the hand that works on it, and stays. */
static gboolean scale_body(const Scaling *scaling, SporeObject *body, GError **error) {
  static const char *const units[] = {"mechanical", "regions"};
  for (gsize i = 0; i < G_N_ELEMENTS(units); i++) {
    SporeObject *unit = spore_object_child_of(body, units[i]);
    if (unit && !scale_lengths(scaling, unit, error)) return FALSE;
  }
  return use_scaled(scaling, body, error);
}

static void scaling_init(Scaling *scaling, SporeDocument *document, const SporePlacement *placement, double factor) {
  *scaling = (Scaling){document, spore_placement_bodies(placement), g_array_new(FALSE, FALSE, sizeof(Shape)), factor};
  for (guint i = 0; i < scaling->bodies->len; i++) add_shapes(scaling, scaling->bodies->pdata[i]);
  find_shared(scaling);
}

static void scaling_clear(Scaling *scaling) {
  g_ptr_array_unref(scaling->bodies);
  g_array_unref(scaling->shapes);
}

static gboolean may_scale(const Scaling *scaling, GError **error) {
  for (guint i = 0; i < scaling->bodies->len; i++) {
    const SporeObject *body = scaling->bodies->pdata[i];
    if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE)
      return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(body), "%s",
                               _("an instrument is not scaled; its size is that of the library; scale the organs "
                                 "instead"));
  }
  for (guint i = 0; i < scaling->shapes->len; i++)
    if (!spore_generated_may_change(g_array_index(scaling->shapes, Shape, i).asset, error)) return FALSE;
  return TRUE;
}

gboolean spore_edit_may_scale(SporeDocument *document, const GPtrArray *bodies, GError **error) {
  Scaling scaling;
  g_autoptr(SporePlacement) placement = spore_placement_new(document, bodies);
  scaling_init(&scaling, document, placement, 1);
  gboolean may = may_scale(&scaling, error);
  scaling_clear(&scaling);
  return may;
}

static gboolean scale_all(const Scaling *scaling, SporePlacement *placement, GError **error) {
  for (guint i = 0; i < scaling->shapes->len; i++)
    if (!scale_shape(scaling, &g_array_index(scaling->shapes, Shape, i), error)) return FALSE;
  for (guint i = 0; i < scaling->bodies->len; i++)
    if (!scale_body(scaling, scaling->bodies->pdata[i], error)) return FALSE;
  return spore_placement_scale(placement, scaling->factor, error);
}

gboolean spore_edit_scale(SporeDocument *document, const GPtrArray *bodies, double factor, GError **error) {
  Scaling scaling;
  if (!(factor >= SPORE_SCALE_LEAST && factor <= SPORE_SCALE_GREATEST))
    return spore_error_raise(error, SPORE_ERROR_INPUT, _("Scale"),
                             _("%g is no factor to scale by; choose one from %g to %g"), factor, SPORE_SCALE_LEAST,
                             SPORE_SCALE_GREATEST);
  g_autoptr(SporePlacement) placement = spore_placement_new(document, bodies);
  scaling_init(&scaling, document, placement, factor);
  spore_document_begin(document, _("Scale"));
  gboolean done = spore_edit_finish(document, may_scale(&scaling, error) && scale_all(&scaling, placement, error));
  scaling_clear(&scaling);
  return done;
}
