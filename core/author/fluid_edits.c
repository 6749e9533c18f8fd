/* Puts fluids of the library into a scene: their bodies, the surfaces that they fill, and their emitters. */
#include "core/author/fluid_edits.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/edits.h"
#include "core/author/fluid_place.h"
#include "core/integrate/integrator.h"
#include "core/io/mesh_import.h"
#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"
#include "core/sim/solve/step_limit.h"

#define SPACING                                                                                                        \
  0.004 /* m: from one particle to the next, so that each is a drop of .06 ml; finer ones jostle faster,               \
           and contacts of the usual step of 4 ms lose them */
#define LEAST_PARTICLES 12 /* of what is poured where there is little room */
#define LESS 0.5           /* of the particles, from one try to the next */
#define RINGS 8            /* of the ball that is filled */
#define SIDES 16
#define MOUTH_PART 0.6 /* radius of a mouth, as a part of the spacing: a particle's way out */

/* What is being added. */
typedef struct Addition {
  SporeDocument *document;
  const SporeFluidKind *kind;
  const char *name;
  SporeObject *source;                /* what the mouth is in */
  SporeVec3 mouth, direction, middle; /* middle: of the ball that is filled */
  double spacing;
  unsigned particles;
} Addition;

static gboolean refuse(const Addition *addition, const char *message, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, _(addition->kind->label), "%s", message);
}

/* Where. */

/* Of the ball that is filled; the outer particles reach beyond by half their distance. */
static double radius_of(const Addition *addition) {
  return addition->spacing * cbrt(addition->particles * 3 / (4 * G_PI));
}

/* The body of a tool of that kind: the one whose point is nearest to the place, or, where there is a body, that body.
 */
static SporeObject *nearest_holder(SporeDocument *document, const char *element, const SporeObject *body,
                                   SporeVec3 place, SporeVec3 *point) {
  const SporeObject *tools = spore_document_section(document, "tools");
  SporeObject *nearest = NULL;
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *tool = spore_object_child(tools, i);
    SporeObject *holder = spore_object_reference(tool, "body");
    if (!g_str_equal(spore_object_type(tool)->element, element) || !holder || (body && body != holder)) continue;
    int property = spore_parameter_find(spore_object_type(tool)->table, "point");
    SporeVec3 at = spore_vec3_load(spore_object_value(tool, (guint)property)->number);
    if (nearest && spore_vec3_distance(at, place) >= spore_vec3_distance(*point, place)) continue;
    nearest = holder;
    *point = at;
  }
  return nearest;
}

static gboolean can_be_cut(const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  return model && spore_object_type(model)->model->cut;
}

/* Less of it where there is less room. */
static gboolean pour(Addition *addition, const SporeSurfacePlace *place, GError **error) {
  while (!spore_surface_room(addition->document, place, radius_of(addition) + 0.5 * addition->spacing,
                             &addition->middle)) {
    addition->particles = (unsigned)(LESS * addition->particles);
    if (addition->particles < LEAST_PARTICLES)
      return refuse(addition, _("there is no room over this place; choose one that is open"), error);
  }
  return TRUE;
}

static gboolean place_on_organ(Addition *addition, SporeObject *organ, SporeVec3 at, GError **error) {
  SporeSurfacePlace place;
  if (!spore_surface_nearest(addition->document, organ, at, &place))
    return refuse(addition, _("nothing here shows a surface; click on an organ"), error);
  if (spore_vec3_distance(place.at, at) > place.size)
    return refuse(addition, _("no organ is near the place; give one on an organ, in metres"), error);
  if (addition->kind->mouth == SPORE_MOUTH_TISSUE && !can_be_cut(place.body))
    return refuse(addition, _("the organ cannot be cut; make it soft first, or choose bleeding from the start"), error);
  addition->spacing = SPACING;
  if (addition->kind->mouth == SPORE_MOUTH_NONE) return pour(addition, &place, error);
  double clear = spore_surface_clear(addition->document, &place, 0.5 * addition->spacing);
  addition->source = place.body;
  addition->direction = place.outward;
  addition->mouth = spore_vec3_add_scaled(place.at, clear, place.outward);
  addition->middle = spore_vec3_add_scaled(place.at, clear + radius_of(addition), place.outward);
  return TRUE;
}

static gboolean place_in_heater(Addition *addition, SporeVec3 at, GError **error) {
  addition->source = nearest_holder(addition->document, "bipolar", NULL, at, &addition->mouth);
  if (!addition->source) return refuse(addition, _("nothing here coagulates; add bipolar forceps first"), error);
  addition->spacing = SPACING;
  addition->direction = (SporeVec3){0, 1, 0};
  addition->middle = addition->mouth;
  return TRUE;
}

/* Out of the end of the tube, clear of what is felt of the tube. A shaft comes from +y of its body. */
static gboolean place_in_tube(Addition *addition, const SporeObject *body, SporeVec3 at, GError **error) {
  SporeSurfacePlace place = {0};
  place.body = nearest_holder(addition->document, "suction", body, at, &place.at);
  if (!place.body) return refuse(addition, _("nothing here draws fluid away; add a suction tube first"), error);
  place.outward = spore_quat_rotate(spore_body_pose(place.body).orientation, (SporeVec3){0, -1, 0});
  addition->source = place.body;
  addition->spacing = SPACING;
  addition->direction = place.outward;
  addition->mouth = spore_vec3_add_scaled(
      place.at, spore_surface_clear(addition->document, &place, 0.5 * addition->spacing), place.outward);
  addition->middle = addition->mouth;
  return TRUE;
}

static gboolean find_place(Addition *addition, SporeObject *organ, SporeVec3 at, GError **error) {
  if (addition->kind->mouth == SPORE_MOUTH_HEATER) return place_in_heater(addition, at, error);
  if (addition->kind->mouth == SPORE_MOUTH_TUBE) return place_in_tube(addition, organ, at, error);
  return place_on_organ(addition, organ, at, error);
}

/* The body. */

static gboolean set_all(const Addition *addition, SporeObject *object, const char *const *settings, GError **error) {
  for (; settings && *settings; settings += 2)
    if (!spore_document_set_text(addition->document, object, settings[0], settings[1], error)) return FALSE;
  return TRUE;
}

static gboolean set_number(const Addition *addition, SporeObject *object, const char *property, double value,
                           GError **error) {
  g_autofree char *text = g_strdup_printf("%.6g", value);
  return spore_document_set_text(addition->document, object, property, text, error);
}

static guint32 corner(guint ring, guint side) {
  return ring == 0 ? 0 : ring == RINGS ? 1 + (RINGS - 1) * SIDES : 1 + (ring - 1) * SIDES + side % SIDES;
}

/* A closed ball about the origin. *mesh borrows both arrays. */
static void make_ball(double radius, GArray *vertices, GArray *triangles, SporeTriangleMesh *mesh) {
  for (guint ring = 0; ring <= RINGS; ring++) {
    double polar = G_PI * ring / RINGS;
    for (guint side = 0; side < (ring == 0 || ring == RINGS ? 1 : SIDES); side++) {
      double angle = 2 * G_PI * side / SIDES;
      double row[3] = {radius * sin(polar) * cos(angle), radius * cos(polar), -radius * sin(polar) * sin(angle)};
      g_array_append_vals(vertices, row, 3);
    }
  }
  for (guint ring = 0; ring < RINGS; ring++)
    for (guint side = 0; side < SIDES; side++) {
      guint32 upper[3] = {corner(ring, side), corner(ring + 1, side), corner(ring, side + 1)};
      guint32 lower[3] = {corner(ring, side + 1), corner(ring + 1, side), corner(ring + 1, side + 1)};
      if (ring > 0) g_array_append_vals(triangles, upper, 3);
      if (ring + 1 < RINGS) g_array_append_vals(triangles, lower, 3);
    }
  *mesh = (SporeTriangleMesh){.vertex_count = vertices->len / 3,
                              .triangle_count = triangles->len / 3,
                              .vertices = (double *)vertices->data,
                              .triangles = (guint32 *)triangles->data};
}

static SporeObject *put_ball(const Addition *addition, GError **error) {
  g_autoptr(GArray) vertices = g_array_new(FALSE, FALSE, sizeof(double));
  g_autoptr(GArray) triangles = g_array_new(FALSE, FALSE, sizeof(guint32));
  g_autofree char *name = g_strdup_printf("%s_ball", addition->kind->fluid);
  SporeTriangleMesh mesh;
  gsize size;
  make_ball(radius_of(addition), vertices, triangles, &mesh);
  char *text = spore_off_format(&mesh, &size);
  return spore_edit_put_asset(addition->document, "mesh", name, "off", text, size, error);
}

static SporeObject *add_body(const Addition *addition, SporeObject *ball, GError **error) {
  const SporeFluidKind *kind = addition->kind;
  SporeDocument *document = addition->document;
  const char *name = kind->mouth == SPORE_MOUTH_NONE && addition->name ? addition->name : kind->fluid;
  SporeObject *body =
      spore_document_insert(document, spore_document_section(document, "bodies"), "body", name, G_MAXUINT, error);
  SporeObject *visual = body && spore_edit_set_vector(document, body, "position", addition->middle, error) &&
                                spore_edit_set_model(document, body, kind->model, error)
                            ? spore_edit_child_or_new(document, body, "visual", error)
                            : NULL;
  if (!visual || !spore_document_set_text(document, visual, "colour", kind->colour, error) ||
      !spore_document_set_text(document, visual, "wetness", kind->wetness, error) ||
      (kind->opacity && !spore_document_set_text(document, visual, "opacity", kind->opacity, error)))
    return NULL;
  SporeObject *collision = kind->contact ? spore_edit_child_or_new(document, body, "collision", error) : NULL;
  SporeObject *fidelity = kind->mode ? spore_edit_child_or_new(document, body, "fidelity", error) : NULL;
  SporeObject *model = spore_body_model_object(body);
  gboolean done =
      (!kind->contact || (collision && set_all(addition, collision, kind->contact, error))) &&
      (!kind->mode || (fidelity && spore_document_set_text(document, fidelity, "mode", kind->mode, error))) &&
      spore_document_set_text(document, spore_object_child_of(body, "mechanical"), "geometry", spore_object_name(ball),
                              error) &&
      set_number(addition, model, "particles", addition->particles, error) &&
      set_all(addition, model, kind->settings, error);
  return done ? body : NULL;
}

/* Its particles. */

/* The model, as the scene will have it. NULL with the error. */
static SporeModel *make_model(const Addition *addition, SporeObject *body, SporeObject *ball, GError **error) {
  const SporeObject *object = spore_body_model_object(body);
  const SporeModelType *type = spore_object_type(object)->model;
  const SporeTriangleMesh *surface = spore_document_mesh(addition->document, ball, error);
  g_autofree void *fields = g_malloc0(type->parameters.size);
  SporeError fault = SPORE_ERROR_INIT;
  if (!surface) return NULL;
  spore_object_fields(object, fields);
  SporeModel *model = spore_model_create(type, &(SporeGeometry){.surface = surface}, fields, &fault);
  if (!model) spore_error_raise(error, fault.code, _(addition->kind->label), "%s", fault.message);
  return model;
}

/* As many substeps as particles that explicit steps move need, if the scene's own are too few. */
static gboolean set_substeps(const Addition *addition, SporeObject *body, const SporeModel *model, GError **error) {
  SporeSolverFields solver;
  SporeStepLimit limit;
  SporeError fault = SPORE_ERROR_INIT;
  spore_object_fields(spore_document_section(addition->document, "solver"), &solver);
  SporeIntegratorKind kind = solver.integrator;
  if (spore_integrator(kind)->implicit) kind = SPORE_INTEGRATOR_VERLET;
  if (!model->type->rates) return TRUE;
  if (!spore_step_limit(model, kind, NULL, NULL, NULL, 0, &limit, &fault))
    return spore_error_raise(error, fault.code, _(addition->kind->label), "%s", fault.message);
  double needed = limit.dt_s > 0 ? ceil(solver.time_step / limit.dt_s) : HUGE_VAL;
  if (needed > SPORE_SUBSTEPS_MAXIMUM)
    return refuse(addition, _("the scene's step is too long for a fluid; set a smaller time_step"), error);
  return needed <= (double)solver.substeps ||
         set_number(addition, spore_object_child_of(body, "mechanical"), "substeps", needed, error);
}

/* The emitter keeps back all of them. */
static SporeObject *add_emitter(const Addition *addition, const SporeObject *body, gsize particles, GError **error) {
  SporeDocument *document = addition->document;
  const char *name = addition->name ? addition->name : addition->kind->name;
  SporeObject *emitter =
      spore_document_insert(document, spore_document_section(document, "effects"), "emitter", name, G_MAXUINT, error);
  gboolean done = emitter && spore_document_set_text(document, emitter, "body", spore_object_name(body), error) &&
                  spore_document_set_text(document, emitter, "source", spore_object_name(addition->source), error) &&
                  spore_edit_set_vector(document, emitter, "point", addition->mouth, error) &&
                  spore_edit_set_vector(document, emitter, "direction", addition->direction, error) &&
                  set_number(addition, emitter, "reserve", (double)particles, error) &&
                  set_number(addition, emitter, "radius", MOUTH_PART * addition->spacing, error) &&
                  set_all(addition, emitter, addition->kind->flow, error);
  return done ? emitter : NULL;
}

static SporeObject *add(Addition *addition, GError **error) {
  SporeObject *ball = put_ball(addition, error);
  SporeObject *body = ball ? add_body(addition, ball, error) : NULL;
  SporeModel *model = body ? make_model(addition, body, ball, error) : NULL;
  if (!model) return NULL;
  SporeObject *added = set_substeps(addition, body, model, error) ? body : NULL;
  if (added && addition->kind->mouth != SPORE_MOUTH_NONE) added = add_emitter(addition, body, model->node_count, error);
  model->type->destroy(model);
  return added;
}

SporeObject *spore_edit_add_fluid(SporeDocument *document, const SporeFluidKind *kind, const char *name,
                                  SporeObject *organ, SporeVec3 place, GError **error) {
  g_autofree char *label = g_strdup_printf(_("Add %s"), _(kind->label));
  Addition addition = {.document = document, .kind = kind, .name = name, .particles = kind->particles};
  if (!find_place(&addition, organ, place, error)) return NULL;
  spore_document_begin(document, label);
  SporeObject *added = add(&addition, error);
  return spore_edit_finish(document, added != NULL) ? added : NULL;
}
