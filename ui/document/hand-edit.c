/* Editing by hand: spheres, points of a curve and regions, changed one at a time. */
#include "ui/document/hand-edit.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/author/generated_edits.h"
#include "core/author/region_edits.h"
#include "core/scene/region.h"

static gboolean is_of(SporeObject *object, const char *element) {
  return object && g_str_equal(spore_object_type(object)->element, element);
}

static SporeObject *asset_of_body(SporeDocument *document, SporeObject *body) {
  SporeObject *spheres = spore_edit_body_spheres(document, body);
  return spheres ? spheres : spore_edit_body_curve(document, body);
}

static gboolean has(SporeDocument *document, SporeObject *body, const SporeObject *asset) {
  return spore_edit_body_spheres(document, body) == asset || spore_edit_body_curve(document, body) == asset ||
         spore_edit_body_tetrahedra(document, body) == asset;
}

static SporeObject *body_of_asset(SporeDocument *document, SporeObject *asset) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (has(document, body, asset)) return body;
  }
  return NULL;
}

static void copy_points(SporeHandEdit *edit, const double *points, const double *weights, gsize count) {
  g_free(edit->points);
  g_free(edit->weights);
  edit->weights = weights ? g_memdup2(weights, count * sizeof *weights) : NULL;
  edit->points = g_memdup2(points, 4 * count * sizeof *points);
  edit->count = count;
  if (edit->chosen >= count) edit->chosen = G_MAXSIZE;
}

static gboolean load_regions(SporeHandEdit *edit, SporeObject *holder) {
  gsize count = spore_object_child_count(holder);
  g_autofree double *balls = g_new(double, MAX(4 * count, 1));
  for (guint i = 0; i < count; i++) spore_region_read_ball(spore_object_child(holder, i), balls + 4 * i);
  edit->kind = SPORE_HAND_REGIONS;
  copy_points(edit, balls, NULL, count);
  return TRUE;
}

static gboolean load(SporeHandEdit *edit, SporeDocument *document, SporeObject *asset) {
  gboolean is_curve = is_of(asset, "curve");
  edit->kind = is_curve ? SPORE_HAND_CURVE : SPORE_HAND_SPHERES;
  const SporeCurve *curve = is_curve ? spore_document_curve(document, asset, NULL) : NULL;
  const SporeSphereSet *set = is_curve ? NULL : spore_document_spheres(document, asset, NULL);
  if (curve) copy_points(edit, curve->points, NULL, curve->count);
  if (set) copy_points(edit, set->spheres, set->weights, set->count), edit->level = set->level;
  return curve || set;
}

gboolean spore_hand_edit_open(SporeHandEdit *edit, SporeDocument *document, SporeObject *selected) {
  gboolean itself = is_of(selected, "spheres") || is_of(selected, "curve");
  SporeObject *body = itself ? body_of_asset(document, selected) : selected;
  while (body && !is_of(body, "body")) body = spore_object_parent(body);
  SporeObject *asset = itself ? selected : body ? asset_of_body(document, body) : NULL;
  if (!asset || !body || spore_object_id(asset) != edit->asset || edit->kind == SPORE_HAND_REGIONS)
    spore_hand_edit_close(edit);
  if (!asset || !body || !load(edit, document, asset)) return FALSE;
  edit->asset = spore_object_id(asset);
  edit->body = spore_object_id(body);
  return TRUE;
}

gboolean spore_hand_edit_open_regions(SporeHandEdit *edit, SporeDocument *document, SporeObject *holder) {
  SporeObject *body = spore_object_parent(holder);
  if (!is_of(body, "body")) body = body_of_asset(document, holder);
  if (!body || spore_object_id(holder) != edit->asset || edit->kind != SPORE_HAND_REGIONS) spore_hand_edit_close(edit);
  if (!body || !load_regions(edit, holder)) return FALSE;
  edit->asset = spore_object_id(holder);
  edit->body = spore_object_id(body);
  return TRUE;
}

void spore_hand_edit_close(SporeHandEdit *edit) {
  g_free(edit->points);
  g_free(edit->weights);
  *edit = (SporeHandEdit){.chosen = G_MAXSIZE};
}

gsize spore_hand_edit_pick(const SporeHandEdit *edit, SporeVec3 origin, SporeVec3 direction) {
  gsize picked = G_MAXSIZE;
  double nearest = HUGE_VAL;
  for (gsize i = 0; i < edit->count; i++) {
    const double *sphere = edit->points + 4 * i;
    SporeVec3 to = spore_vec3_sub(spore_vec3_load(sphere), origin);
    double along = spore_vec3_dot(to, direction);
    double inside = sphere[3] * sphere[3] - (spore_vec3_dot(to, to) - along * along);
    double t = inside >= 0 ? along - sqrt(inside) : -1;
    if (t >= 0 && t < nearest) nearest = t, picked = i;
  }
  return picked;
}

static double usual_radius(const SporeHandEdit *edit) {
  double sum = 0;
  if (edit->chosen < edit->count) return edit->points[4 * edit->chosen + 3];
  for (gsize i = 0; i < edit->count; i++) sum += edit->points[4 * i + 3];
  return edit->count ? sum / (double)edit->count : 0.005;
}

void spore_hand_edit_add(SporeHandEdit *edit, SporeVec3 place, double r) {
  gsize at = edit->kind == SPORE_HAND_CURVE && edit->chosen < edit->count ? edit->chosen + 1 : edit->count;
  const double sphere[4] = {place.x, place.y, place.z, r > 0 ? r : usual_radius(edit)};
  edit->points = g_renew(double, edit->points, 4 * (edit->count + 1));
  memmove(edit->points + 4 * (at + 1), edit->points + 4 * at, 4 * (edit->count - at) * sizeof(double));
  memcpy(edit->points + 4 * at, sphere, sizeof sphere);
  if (edit->weights) { /* of spheres, which are added at the end */
    edit->weights = g_renew(double, edit->weights, edit->count + 1);
    edit->weights[edit->count] = edit->chosen < edit->count ? edit->weights[edit->chosen] : 1;
  }
  edit->count++;
  edit->chosen = at;
}

gboolean spore_hand_edit_remove(SporeHandEdit *edit) {
  if (edit->chosen >= edit->count || edit->count <= (edit->kind == SPORE_HAND_CURVE ? 2 : 1)) return FALSE;
  gsize after = edit->count - edit->chosen - 1;
  memmove(edit->points + 4 * edit->chosen, edit->points + 4 * (edit->chosen + 1), 4 * after * sizeof(double));
  if (edit->weights) memmove(edit->weights + edit->chosen, edit->weights + edit->chosen + 1, after * sizeof(double));
  edit->count--;
  edit->chosen = G_MAXSIZE;
  return TRUE;
}

static char *format(const SporeHandEdit *edit, gsize *size, SporeError *error) {
  SporeCurve curve = {.count = edit->count, .points = edit->points};
  SporeSphereSet set = {.count = edit->count, .spheres = edit->points, .weights = edit->weights, .level = edit->level};
  if (edit->kind == SPORE_HAND_CURVE)
    return spore_curve_validate(&curve, error) ? spore_curve_format(&curve, size) : NULL;
  return spore_sphere_set_validate(&set, error) ? spore_spheres_format(&set, size) : NULL;
}

static gboolean write_points(SporeHandEdit *edit, SporeDocument *document, SporeObject *asset, GError **error) {
  gsize size;
  SporeError failure = SPORE_ERROR_INIT;
  char *text = format(edit, &size, &failure);
  if (!text) return spore_error_propagate(&failure, error);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *file = spore_content_file_name(spore_object_name(asset),
                                                  edit->kind == SPORE_HAND_CURVE ? "curve" : "spheres", text, size);
  const char *source = spore_object_text(asset, "source");
  spore_document_put_blob(document, file, content);
  return spore_document_set_text(document, asset, "file", file, error) &&
         (!source || !*source || spore_document_set_text(document, asset, "edited", "true", error));
}

gboolean spore_hand_edit_write_region(SporeHandEdit *edit, SporeDocument *document, GError **error) {
  SporeObject *holder = spore_document_by_id(document, edit->asset);
  if (!holder || edit->chosen >= MIN(edit->count, spore_object_child_count(holder))) return FALSE;
  const double *ball = edit->points + 4 * edit->chosen;
  if (spore_edit_place_region(document, spore_object_child(holder, (guint)edit->chosen), ball, ball[3], error))
    return TRUE;
  load_regions(edit, holder);
  return FALSE;
}

gboolean spore_hand_edit_commit(SporeHandEdit *edit, SporeDocument *document, const char *label, GError **error) {
  if (edit->kind == SPORE_HAND_REGIONS) return spore_hand_edit_write_region(edit, document, error);
  SporeObject *asset = spore_document_by_id(document, edit->asset);
  if (!asset) return FALSE;
  spore_document_begin(document, label);
  gboolean done = write_points(edit, document, asset, error);
  if (done) {
    spore_document_end(document);
  } else {
    spore_document_abort(document);
    load(edit, document, asset);
  }
  return done;
}
