/* A body along a middle line: a thread, a tube or an intestine, with what holds it. */
#include "core/author/centreline_body.h"

#include <math.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/mesh/attach.h"
#include "core/scene/mapping_quality.h"
#include "core/scene/compile.h"

const char *const spore_centreline_body_names[] = {"thread", "tube", "intestine", NULL};

#define LEAST_POINTS 8
#define MOST_POINTS 400
#define SPAN 2.0         /* approximate distance between control points, in mean radii */
#define WALL 0.25        /* of the mean radius */
#define BOWEL_WALL 0.002 /* m; the intestine's default wall, where its radius allows that wall */
#define TUBE_YOUNG 3e5   /* Pa: bowel along its axis (Terry et al. 2014), as the intestine */
#define STEP 0.25        /* distance, in mean radii, of the places along the line that vertices may belong to */
#define PIN 4.0          /* in radii of the end: a pin of this size also keeps the end from turning */
#define ROOT_PIN                                                                                                       \
  0.5 /* in mean radii: the place of the mesentery's frame is computed from the line, and the spline differs a little  \
         from the line */
#define WALL_DENSITY 1060 /* kg/m^3, both the intestine's by default */
#define CONTENT_DENSITY 300
#define STIFFNESS 400       /* N/m, of contacts */
#define BOWEL_STIFFNESS 800 /* N/m: holds a probe that pulls at a loop until the mesentery is taut */
#define SAG 0.5 /* in mean radii: how far the weight of a bowel stretches the mesentery that it hangs from */
#define GRAVITY 9.81

static SporeVec3 point(const SporeCurve *curve, size_t i) { return spore_vec3_load(curve->points + 4 * i); }

static double mean_radius(const SporeCurve *curve) {
  double sum = 0;
  for (size_t i = 1; i < curve->count; i++)
    sum += 0.5 * (curve->points[4 * i - 1] + curve->points[4 * i + 3]) *
           spore_vec3_distance(point(curve, i - 1), point(curve, i));
  return sum / spore_curve_length(curve);
}

size_t spore_centreline_control_points(const SporeCurve *curve) {
  double wanted = ceil(spore_curve_length(curve) / (SPAN * mean_radius(curve)));
  return (size_t)fmin(fmax(wanted, LEAST_POINTS), MOST_POINTS);
}

/* Divides the curve so finely that places along it can be distinguished. */
static bool divide(const SporeCurve *curve, SporeCurve *fine) {
  double step = STEP * mean_radius(curve);
  size_t count = 1, made = 0;
  for (size_t i = 1; i < curve->count; i++)
    count += (size_t)ceil(spore_vec3_distance(point(curve, i - 1), point(curve, i)) / step);
  if (!spore_curve_allocate(fine, count, NULL)) return false;
  for (size_t i = 1; i < curve->count; i++) {
    size_t parts = (size_t)ceil(spore_vec3_distance(point(curve, i - 1), point(curve, i)) / step);
    for (size_t k = 0; k < parts; k++, made++)
      for (size_t c = 0; c < 4; c++) {
        const double *from = curve->points + 4 * (i - 1);
        fine->points[4 * made + c] = from[c] + (double)k / (double)parts * (from[4 + c] - from[c]);
      }
  }
  for (size_t c = 0; c < 4; c++) fine->points[4 * made + c] = curve->points[4 * (curve->count - 1) + c];
  return true;
}

bool spore_centreline_carries(const SporeCurve *curve, const SporeTriangleMesh *mesh) {
  SporeCurve fine = {0};
  g_autofree guint32 *place = g_new(guint32, mesh->vertex_count);
  double torn = 1;
  bool known = divide(curve, &fine) && spore_curve_attach(&fine, mesh, place, &torn);
  spore_curve_clear(&fine);
  return known && torn <= SPORE_MAPPING_QUALITY_TORN;
}

static gboolean set_number(SporeDocument *document, SporeObject *object, const char *property, double value,
                           GError **error) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  return spore_document_set_text(document, object, property, g_ascii_formatd(text, sizeof text, "%.4g", value), error);
}

static gboolean set_count(SporeDocument *document, SporeObject *object, const char *property, size_t value,
                          GError **error) {
  g_autofree char *text = g_strdup_printf("%zu", value);
  return spore_document_set_text(document, object, property, text, error);
}

static SporeObject *insert(SporeDocument *document, SporeObject *parent, const char *element, const char *name,
                           GError **error) {
  return spore_document_insert(document, parent, element, name, G_MAXUINT, error);
}

/* The curve asset of that name, which is made where there is none, gets this curve. */
static SporeObject *put_curve(SporeDocument *document, const char *name, const SporeCurve *curve, GError **error) {
  gsize size = 0;
  char *text = spore_curve_format(curve, &size);
  g_autofree char *file = spore_content_file_name(name, "curve", text, size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  spore_document_put_blob(document, file, content);
  SporeObject *asset = spore_document_find(document, "curve", name);
  if (!asset) asset = insert(document, spore_document_section(document, "assets"), "curve", name, error);
  return asset && spore_document_set_text(document, asset, "file", file, error) ? asset : NULL;
}

/* Mass of the line's i-th straight piece, kg. */
static double mass_of(const SporeCurve *curve, size_t i) {
  double outer = 0.5 * (curve->points[4 * i - 1] + curve->points[4 * i + 3]);
  double wall = fmin(BOWEL_WALL, WALL * mean_radius(curve)), inner = fmax(outer - wall, 0);
  return G_PI * spore_vec3_distance(point(curve, i - 1), point(curve, i)) *
         (WALL_DENSITY * (outer * outer - inner * inner) + CONTENT_DENSITY * inner * inner);
}

/* The line's centre of mass, where the mesentery's frame is. */
static SporeVec3 centre_of(const SporeCurve *curve, double *mass) {
  SporeVec3 sum = {0, 0, 0};
  *mass = 0;
  for (size_t i = 1; i < curve->count; i++) {
    double piece = mass_of(curve, i);
    sum = spore_vec3_add_scaled(sum, 0.5 * piece, spore_vec3_add(point(curve, i - 1), point(curve, i)));
    *mass += piece;
  }
  return spore_vec3_scale(1 / *mass, sum);
}

/* The mesentery hangs from the root, and bears the bowel's weight. */
static gboolean set_root(SporeDocument *document, SporeObject *model, const char *name, const SporeCurve *curve,
                         const SporeCurve *root, GError **error) {
  g_autofree char *root_name = g_strdup_printf("%s-root", name);
  SporeObject *asset = put_curve(document, root_name, root, error);
  double mass;
  centre_of(curve, &mass);
  double stiffness = GRAVITY * mass / spore_curve_length(curve) / (SAG * mean_radius(curve));
  return asset && spore_document_set_text(document, spore_object_parent(model), "root", root_name, error) &&
         set_number(document, model, "mesentery_stiffness", stiffness, error);
}

static gboolean insert_model(SporeDocument *document, SporeObject *body, SporeObject *line, const SporeCurve *curve,
                             const SporeCentrelineBodyOptions *options, GError **error) {
  gboolean bowel = options->body == SPORE_CENTRELINE_INTESTINE, tube = options->body == SPORE_CENTRELINE_TUBE;
  double radius = mean_radius(curve);
  size_t count = options->control_points ? options->control_points : spore_centreline_control_points(curve);
  SporeObject *mechanical = insert(document, body, "mechanical", NULL, error);
  if (!mechanical || !spore_document_set_text(document, mechanical, "geometry", spore_object_name(line), error))
    return FALSE;
  SporeObject *model = insert(document, mechanical, bowel ? "intestine" : "spline_1d", NULL, error);
  if (!model || !set_count(document, model, "control_points", count, error)) return FALSE;
  if (bowel && options->root && !set_root(document, model, spore_object_name(body), curve, options->root, error))
    return FALSE;
  if (bowel) return WALL * radius >= BOWEL_WALL || set_number(document, model, "wall_thickness", WALL * radius, error);
  return !tube || (set_number(document, model, "young_modulus", TUBE_YOUNG, error) &&
                   set_number(document, model, "twist_modulus", TUBE_YOUNG / 3, error) &&
                   set_number(document, model, "wall_thickness", WALL * radius, error));
}

static gboolean insert_units(SporeDocument *document, SporeObject *body, const SporeCentrelineBodyOptions *options,
                             SporeObject *mesh, GError **error) {
  SporeObject *collision = insert(document, body, "collision", NULL, error);
  double stiffness = options->body == SPORE_CENTRELINE_INTESTINE ? BOWEL_STIFFNESS : STIFFNESS;
  if (!collision || !set_number(document, collision, "stiffness", stiffness, error) ||
      !set_number(document, collision, "damping", 0.3, error) ||
      !spore_document_set_text(document, collision, "self", "true", error))
    return FALSE;
  SporeObject *visual = spore_object_child_of(body, "visual");
  if (!visual) visual = insert(document, body, "visual", NULL, error);
  if (!visual) return FALSE;
  if (mesh) return spore_document_set_text(document, visual, "mesh", spore_object_name(mesh), error);
  int shown = spore_parameter_find(spore_object_type(visual)->table, "mesh");
  return spore_document_unset(document, visual, (guint)shown, error);
}

static gboolean insert_pin(SporeDocument *document, SporeObject *body, const char *name, SporeVec3 p, double radius,
                           GError **error) {
  SporeObject *pin = insert(document, spore_document_section(document, "links"), "pin", name, error);
  char place[3][G_ASCII_DTOSTR_BUF_SIZE];
  SporeVec3 placed = spore_pose_apply(spore_body_pose(body), p);
  const double at[3] = {placed.x, placed.y, placed.z};
  for (int k = 0; k < 3; k++) g_ascii_formatd(place[k], sizeof place[k], "%.6g", at[k]);
  g_autofree char *text = g_strjoin(" ", place[0], place[1], place[2], NULL);
  return pin && spore_document_set_text(document, pin, "body", spore_object_name(body), error) &&
         spore_document_set_text(document, pin, "point", text, error) &&
         set_number(document, pin, "radius", radius, error);
}

static gboolean hold(SporeDocument *document, SporeObject *body, const SporeCurve *curve, SporeCentrelineBody kind,
                     GError **error) {
  double mass;
  if (kind == SPORE_CENTRELINE_INTESTINE)
    return insert_pin(document, body, "mesentery", centre_of(curve, &mass), ROOT_PIN * mean_radius(curve), error);
  size_t last = curve->count - 1;
  return insert_pin(document, body, "beginning", point(curve, 0), PIN * curve->points[3], error) &&
         insert_pin(document, body, "end", point(curve, last), PIN * curve->points[4 * last + 3], error);
}

/* Removes units and holds that the body has from an earlier call or from another model. */
static gboolean empty(SporeDocument *document, SporeObject *body, GError **error) {
  static const char *const units[] = {"mechanical", "collision"};
  gboolean done = TRUE;
  for (guint i = 0; done && i < G_N_ELEMENTS(units); i++) {
    SporeObject *unit = spore_object_child_of(body, units[i]);
    done = !unit || spore_document_remove(document, unit, error);
  }
  SporeObject *links = spore_document_section(document, "links");
  for (guint i = spore_object_child_count(links); done && i-- > 0;) {
    SporeObject *link = spore_object_child(links, i);
    if (g_str_equal(spore_object_type(link)->element, "pin") && spore_object_reference(link, "body") == body)
      done = spore_document_remove(document, link, error);
  }
  int role = spore_parameter_find(spore_object_type(body)->table, "role");
  return done && spore_document_unset(document, body, (guint)role, error);
}

gboolean spore_centreline_body_fill(SporeDocument *document, SporeObject *body, SporeObject *line,
                                    const SporeCurve *curve, const SporeCentrelineBodyOptions *options,
                                    SporeObject *mesh, GError **error) {
  return empty(document, body, error) && insert_model(document, body, line, curve, options, error) &&
         insert_units(document, body, options, mesh, error) && hold(document, body, curve, options->body, error);
}

SporeObject *spore_centreline_body_insert(SporeDocument *document, const char *name, const SporeCurve *curve,
                                          const SporeCentrelineBodyOptions *options, SporeObject *mesh,
                                          GError **error) {
  g_autofree char *line_name = g_strdup_printf("%s-line", name);
  SporeObject *line = put_curve(document, line_name, curve, error);
  if (!line) return NULL;
  SporeObject *body = insert(document, spore_document_section(document, "bodies"), "body", name, error);
  return body && spore_centreline_body_fill(document, body, line, curve, options, mesh, error) ? body : NULL;
}
