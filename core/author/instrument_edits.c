/* Puts instruments of the library into a scene: where they stand, their bodies, tool, device and port. */
#include "core/author/instrument_edits.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/edits.h"
#include "core/author/fluid_edits.h"
#include "core/author/instrument_bag.h"
#include "core/io/mesh_import.h"
#include "core/math/quat.h"
#include "core/scene/fidelity.h"
#include "core/scene/camera_sight.h"
#include "core/scene/compile.h"
#include "core/scene/length_unit.h"

#define LEAST_WAY 0.005    /* m: from the entry to the tip, and from there to the target */
#define UPRIGHT 1e-3       /* rad: what is nearer to the vertical has no side that is down */
#define FREE_ENTRY 0.2     /* m: above the target, where there is no entry */
#define FREE_LENGTH 0.065  /* m: of the shaft of an instrument without a port */
#define OUTSIDE 0.06       /* m: of the shaft, outside the port */
#define LENGTH_STEP 0.01   /* m: of shafts, so that instruments share their meshes */
#define THREAD_LENGTH 0.12 /* m */
#define THREAD_POINTS 25
#define THREAD_RADIUS 0.0002 /* m */
#define FIELD_OF_VIEW "0.9"
#define LENS "0.004"     /* m: of a shaft of 10 mm */
#define HAZE "8"         /* s: of a cavity that is insufflated on */
#define DISTORTION "0.2" /* measured of rigid endoscopes: corners at 80 % (Laryngoscope 125, 2015, p. 561) */
#define METAL "0.80 0.80 0.82"
#define THREAD_COLOUR "0.25 0.30 0.62"

static const char *const thread_settings[] = {"control_points", "40",      "young_modulus", "4e8", "straight_at_rest",
                                              "true",           "damping", "0.1",           NULL};

/* What is being added. */
typedef struct Addition {
  SporeDocument *document;
  const SporeInstrumentKind *instrument;
  char *name;
  SporePose pose;
  double length; /* of the shaft, m */
  double view;   /* from the tip to what it points at, m */
} Addition;

static gboolean set(const Addition *addition, SporeObject *object, const char *property, const char *text,
                    GError **error) {
  return spore_document_set_text(addition->document, object, property, text, error);
}

static gboolean set_all(const Addition *addition, SporeObject *object, const char *const *settings, GError **error) {
  for (; settings && *settings; settings += 2)
    if (!set(addition, object, settings[0], settings[1], error)) return FALSE;
  return TRUE;
}

static SporeObject *insert(const Addition *addition, const char *section, const char *element, const char *name,
                           GError **error) {
  return spore_document_insert(addition->document, spore_document_section(addition->document, section), element, name,
                               G_MAXUINT, error);
}

/* Where it points. */

/* Of the drawn vertices, the one nearest to a place. passive: of the bodies alone that physics moves. */
static gboolean nearest_drawn(SporeDocument *document, SporeVec3 place, gboolean passive, SporeVec3 *nearest) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  double least = HUGE_VAL;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    SporeRole role = (SporeRole)spore_object_number(body, "role");
    SporeObject *asset = spore_edit_used_asset(document, body, "visual", "mesh", "mesh");
    const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, NULL) : NULL;
    if (role == SPORE_ACTIVE || (passive && role != SPORE_PASSIVE)) continue;
    for (gsize v = 0; mesh && v < mesh->vertex_count; v++) {
      SporeVec3 p = spore_pose_apply(spore_body_pose(body), spore_vec3_load(mesh->vertices + 3 * v));
      double distance = spore_vec3_distance(p, place);
      if (distance < least) least = distance, *nearest = p;
    }
  }
  return isfinite(least);
}

static SporeVec3 target_of(SporeDocument *document, const SporeInstrumentPlaces *places) {
  static const SporeVec3 sky = {0, 1e3, 0};
  SporeVec3 target = {0, 0, 0};
  if (places->target) return *places->target;
  if (places->entry) target = spore_vec3_add_scaled(*places->entry, -0.5 * FREE_ENTRY, (SporeVec3){0, 1, 0});
  SporeVec3 from = places->entry ? *places->entry : sky;
  if (!places->entry || !nearest_drawn(document, from, TRUE, &target)) nearest_drawn(document, from, FALSE, &target);
  return target;
}

/* The pose of an instrument whose shaft points along `along`; `down` is across that, as unit vectors. */
static SporeQuat oriented(SporeVec3 along, SporeVec3 down) {
  SporeVec3 y = spore_vec3_scale(-1, along), z = spore_vec3_scale(-1, down), x = spore_vec3_cross(y, z);
  return spore_quat_from_mat3((SporeMat3){{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}});
}

static SporeVec3 across_of(SporeVec3 v, SporeVec3 unit) {
  return spore_vec3_add_scaled(v, -spore_vec3_dot(v, unit), unit);
}

/* The unit vector across `along` that points most nearly down; forward, where `along` is upright. */
static SporeVec3 down_across(SporeVec3 along) {
  SporeVec3 down = across_of((SporeVec3){0, -1, 0}, along), forward = across_of((SporeVec3){0, 0, -1}, along);
  SporeVec3 chosen = spore_vec3_length(down) > UPRIGHT ? down : forward;
  return spore_vec3_scale(1 / spore_vec3_length(chosen), chosen);
}

/* The tip stands where it sees the target at the angle of its view: of the triangle of entry, tip and target, the
 * longest side, the side at the target and the angle at the tip are known. */
static void stand(Addition *addition, SporeVec3 entry, SporeVec3 target) {
  const SporeInstrumentKind *instrument = addition->instrument;
  SporeVec3 way = spore_vec3_sub(target, entry);
  double whole = spore_vec3_length(way), look = instrument->look_rad;
  double clear = fmin(instrument->clearance, 0.5 * (whole - instrument->head_length));
  SporeVec3 straight = spore_vec3_scale(1 / whole, way);
  SporeVec3 aside = down_across(straight);
  double sine = clear * sin(look) / whole, cosine = sqrt(1 - sine * sine);
  SporeVec3 along = spore_vec3_add_scaled(spore_vec3_scale(cosine, straight), -sine, aside);
  SporeVec3 down = spore_vec3_add_scaled(spore_vec3_scale(cosine, aside), sine, straight);
  double depth = whole * cosine - clear * cos(look);
  addition->pose.orientation = oriented(along, down);
  SporeVec3 tip = spore_quat_rotate(addition->pose.orientation, spore_instrument_tip(instrument));
  addition->pose.position = spore_vec3_sub(spore_vec3_add_scaled(entry, depth, along), tip);
  addition->length = LENGTH_STEP * ceil((depth - instrument->head_length + OUTSIDE) / LENGTH_STEP);
  addition->view = clear;
}

static gboolean place(Addition *addition, const SporeInstrumentPlaces *places, GError **error) {
  SporeVec3 target = target_of(addition->document, places);
  SporeVec3 entry = places->entry ? *places->entry : spore_vec3_add_scaled(target, FREE_ENTRY, (SporeVec3){0, 1, 0});
  double least = addition->instrument->head_length + 2 * LEAST_WAY;
  if (spore_vec3_distance(entry, target) < least) {
    g_autofree char *there = spore_length_text(spore_vec3_distance(entry, target)), *text = spore_length_text(least);
    return spore_error_raise(error, SPORE_ERROR_INPUT, addition->instrument->name,
                             _("it enters %s from what it points at; expected %s at least; choose places that are "
                               "farther apart"),
                             there, text);
  }
  stand(addition, entry, target);
  if (!places->entry) addition->length = FREE_LENGTH;
  return TRUE;
}

/* Bodies. */

/* The asset with this content. Takes text. */
static SporeObject *put_asset(const Addition *addition, const char *element, const char *part, const char *extension,
                              char *text, gsize size, GError **error) {
  gboolean felt = g_str_equal(element, "spheres");
  g_autofree char *name = g_strdup_printf(felt ? "%s_%s_spheres" : "%s_%s", addition->instrument->name, part);
  return spore_edit_put_asset(addition->document, element, name, extension, text, size, error);
}

static SporeObject *insert_body(const Addition *addition, const char *name, GError **error) {
  SporeObject *body = insert(addition, "bodies", "body", name, error);
  gboolean done = body && spore_edit_set_vector(addition->document, body, "position", addition->pose.position, error) &&
                  spore_edit_set_vector(addition->document, body, "rotation",
                                        spore_quat_to_rotation_vector(addition->pose.orientation), error);
  return done ? body : NULL;
}

/* A unit of the body, with what it uses. */
static SporeObject *use(const Addition *addition, SporeObject *body, const char *unit, const char *property,
                        const SporeObject *asset, GError **error) {
  SporeObject *part = asset ? spore_edit_child_or_new(addition->document, body, unit, error) : NULL;
  return part && set(addition, part, property, spore_object_name(asset), error) ? part : NULL;
}

static gboolean dress(const Addition *addition, SporeObject *body, SporeInstrumentPart part, GError **error) {
  static const char *const parts[] = {"shaft", "jaw_a", "jaw_b"};
  gsize size;
  char *mesh = spore_instrument_mesh(addition->instrument, part, addition->length, &size);
  SporeObject *visual =
      use(addition, body, "visual", "mesh", put_asset(addition, "mesh", parts[part], "off", mesh, size, error), error);
  if (!visual || !set(addition, visual, "colour", METAL, error) || !set(addition, visual, "wetness", "0", error))
    return FALSE;
  char *spheres = spore_instrument_spheres(addition->instrument, part, addition->length, &size);
  return !spheres || use(addition, body, "collision", "spheres",
                         put_asset(addition, "spheres", parts[part], "spheres", spheres, size, error), error);
}

static SporeObject *add_part(const Addition *addition, const char *name, SporeInstrumentPart part, GError **error) {
  SporeObject *body = insert_body(addition, name, error);
  return body && set(addition, body, "role", "active", error) && dress(addition, body, part, error) ? body : NULL;
}

/* The thread of a needle hangs from its swage. */
static SporeObject *add_thread(const Addition *addition, GError **error) {
  double points[4 * THREAD_POINTS];
  for (int i = 0; i < THREAD_POINTS; i++) {
    SporeVec3 at = {-addition->instrument->head_radius, THREAD_LENGTH * i / (THREAD_POINTS - 1), 0};
    spore_vec3_store(points + 4 * i, at);
    points[4 * i + 3] = THREAD_RADIUS;
  }
  const SporeCurve curve = {THREAD_POINTS, points};
  gsize size;
  char *text = spore_curve_format(&curve, &size);
  g_autofree char *name = g_strdup_printf("%s_thread", addition->name);
  SporeObject *asset = put_asset(addition, "curve", "thread", "curve", text, size, error);
  SporeObject *body = asset ? insert_body(addition, name, error) : NULL;
  SporeObject *mechanical = body ? use(addition, body, "mechanical", "geometry", asset, error) : NULL;
  SporeObject *model =
      mechanical ? spore_document_insert(addition->document, mechanical, "spline_1d", NULL, G_MAXUINT, error) : NULL;
  SporeObject *visual = model && set_all(addition, model, thread_settings, error)
                            ? spore_edit_child_or_new(addition->document, body, "visual", error)
                            : NULL;
  return visual && set(addition, visual, "colour", THREAD_COLOUR, error) ? body : NULL;
}

/* The other bodies that the tool names. */
static gboolean add_others(const Addition *addition, SporeObject *tool, GError **error) {
  static const char *const jaws[] = {"jaw_a", "jaw_b"};
  for (int i = 0; i < 2 && spore_instrument_has_jaws(addition->instrument); i++) {
    g_autofree char *name = g_strdup_printf("%s_%s", addition->name, jaws[i]);
    SporeObject *jaw = add_part(addition, name, i ? SPORE_PART_JAW_B : SPORE_PART_JAW_A, error);
    if (!jaw || !set(addition, tool, jaws[i], spore_object_name(jaw), error)) return FALSE;
  }
  if (addition->instrument->head != SPORE_HEAD_ARC) return TRUE;
  SporeObject *thread = add_thread(addition, error);
  return thread && set(addition, tool, "thread", spore_object_name(thread), error);
}

/* Tool, device, port. */

/* Places of the tool, in the axes of the instrument. A tool has those that its kind has parameters for. */
static gboolean set_places(const Addition *addition, SporeObject *tool, GError **error) {
  SporeVec3 tip = spore_instrument_tip(addition->instrument);
  double arc = addition->instrument->head_radius;
  const struct {
    const char *property;
    SporeVec3 at;
  } places[] = {{"hinge", {0, 0, 0}}, {"point", tip}, {"tip", tip}, {"middle", {0, arc, 0}}, {"swage", {-arc, 0, 0}}};
  const SporeParameterTable *table = spore_object_type(tool)->table;
  for (gsize i = 0; i < G_N_ELEMENTS(places); i++)
    if (spore_parameter_find(table, places[i].property) >= 0 &&
        !spore_edit_set_vector(addition->document, tool, places[i].property,
                               spore_pose_apply(addition->pose, places[i].at), error))
      return FALSE;
  return spore_parameter_find(table, "axis") < 0 ||
         spore_edit_set_vector(addition->document, tool, "axis",
                               spore_quat_rotate(addition->pose.orientation, (SporeVec3){1, 0, 0}), error);
}

static SporeObject *mouse_of(const Addition *addition, GError **error) {
  SporeObject *mouse = spore_object_child_of(spore_document_section(addition->document, "devices"), "mouse");
  return mouse ? mouse : insert(addition, "devices", "mouse", "mouse", error);
}

static gboolean set_mode(const Addition *addition, SporeObject *tool, GError **error) {
  const char *mode = addition->instrument->mode;
  return !mode || spore_fidelity_set_mode(addition->document, tool, mode, error);
}

static gboolean add_tool(const Addition *addition, SporeObject *body, GError **error) {
  SporeObject *mouse = mouse_of(addition, error);
  SporeObject *tool = mouse ? insert(addition, "tools", addition->instrument->tool, addition->name, error) : NULL;
  return tool && set(addition, tool, "body", spore_object_name(body), error) &&
         set(addition, tool, "device", spore_object_name(mouse), error) && set_places(addition, tool, error) &&
         set_all(addition, tool, addition->instrument->settings, error) && set_mode(addition, tool, error) &&
         add_others(addition, tool, error);
}

/* What comes out of it, named after it. */
static gboolean add_fluid(const Addition *addition, SporeObject *body, GError **error) {
  const SporeFluidKind *kind = spore_fluid_find(addition->instrument->fluid);
  g_autofree char *name = g_strdup_printf("%s_%s", addition->name, kind->name);
  return spore_edit_add_fluid(addition->document, kind, name, body, addition->pose.position, error) != NULL;
}

/* How an optic looks aside from its shaft to what the endoscope points at. */
static gboolean set_look(const Addition *addition, SporeObject *camera, SporeVec3 ahead, GError **error) {
  double look = addition->instrument->look_rad;
  if (look == 0) return TRUE;
  SporeVec3 at = {0, -addition->view * cos(look), -addition->view * sin(look)};
  double turn = spore_camera_turn_to(addition->pose.position, ahead, spore_pose_apply(addition->pose, at));
  g_autofree char *angle_text = g_strdup_printf("%.6g", look), *turn_text = g_strdup_printf("%.6f", turn);
  return set(addition, camera, "angle", angle_text, error) && set(addition, camera, "turn", turn_text, error);
}

/* What an endoscope shows, from the end of its shaft. */
static gboolean add_camera(const Addition *addition, SporeObject *body, GError **error) {
  SporeVec3 ahead = spore_pose_apply(addition->pose, (SporeVec3){0, -addition->view, 0});
  g_autofree char *name = g_strdup_printf("%s_view", addition->name);
  SporeObject *camera = insert(addition, "tools", "camera", name, error);
  return camera && set(addition, camera, "body", spore_object_name(body), error) &&
         spore_edit_set_vector(addition->document, camera, "position", addition->pose.position, error) &&
         spore_edit_set_vector(addition->document, camera, "target", ahead, error) &&
         set_look(addition, camera, ahead, error) && set(addition, camera, "field_of_view", FIELD_OF_VIEW, error) &&
         set(addition, camera, "distortion", DISTORTION, error) && set(addition, camera, "lens", LENS, error) &&
         set(addition, camera, "haze", HAZE, error);
}

static gboolean add_port(const Addition *addition, SporeObject *body, SporeVec3 entry, GError **error) {
  g_autofree char *name = g_strdup_printf("%s_port", addition->name);
  SporeObject *port = insert(addition, "links", "port", name, error);
  return port && set(addition, port, "body_a", spore_object_name(body), error) &&
         spore_edit_set_vector(addition->document, port, "point", entry, error) &&
         spore_edit_set_vector(addition->document, port, "direction",
                               spore_quat_rotate(addition->pose.orientation, (SporeVec3){0, 1, 0}), error);
}

/* Whether a body or a tool has the name. */
static gboolean is_taken(SporeDocument *document, const char *name) {
  static const char *const sections[] = {"bodies", "tools"};
  for (gsize s = 0; s < G_N_ELEMENTS(sections); s++) {
    SporeObject *section = spore_document_section(document, sections[s]);
    for (guint i = 0; i < spore_object_child_count(section); i++)
      if (g_strcmp0(spore_object_name(spore_object_child(section, i)), name) == 0) return TRUE;
  }
  return FALSE;
}

static char *free_name(SporeDocument *document, const char *begins) {
  char *name = g_strdup_printf("%s_1", begins);
  for (guint i = 2; is_taken(document, name); i++) {
    g_free(name);
    name = g_strdup_printf("%s_%u", begins, i);
  }
  return name;
}

static SporeObject *add(Addition *addition, const SporeInstrumentPlaces *places, GError **error) {
  const SporeInstrumentKind *instrument = addition->instrument;
  SporeObject *body =
      place(addition, places, error) ? add_part(addition, addition->name, SPORE_PART_SHAFT, error) : NULL;
  if (!body) return NULL;
  addition->pose = spore_body_pose(body); /* as it was rounded */
  gboolean done =
      add_tool(addition, body, error) && (!instrument->fluid || add_fluid(addition, body, error)) &&
      (instrument->head != SPORE_HEAD_LENS || add_camera(addition, body, error)) &&
      (instrument->head != SPORE_HEAD_HOOP ||
       spore_instrument_add_film(addition->document, instrument, body, addition->pose, error)) &&
      (instrument->head == SPORE_HEAD_ARC || !places->entry || add_port(addition, body, *places->entry, error));
  return done ? body : NULL;
}

SporeObject *spore_edit_add_instrument(SporeDocument *document, const SporeInstrumentKind *instrument, const char *name,
                                       SporeInstrumentPlaces places, GError **error) {
  g_autofree char *label = g_strdup_printf(_("Add %s"), _(instrument->label));
  g_autofree char *chosen = name ? g_strdup(name) : free_name(document, instrument->name);
  Addition addition = {.document = document, .instrument = instrument, .name = chosen};
  spore_document_begin(document, label);
  SporeObject *body = add(&addition, &places, error);
  return spore_edit_finish(document, body != NULL) ? body : NULL;
}

gboolean spore_edit_turn_optic(SporeDocument *document, SporeObject *camera, double by, GError **error) {
  if (spore_object_number(camera, "angle") == 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(camera), "%s",
                             _("it looks along its axis, and a turn changes nothing; expected an optic that looks "
                               "aside; give it an angle, or add an endoscope of 30 degrees"));
  g_autofree char *text = g_strdup_printf("%.4f", remainder(spore_object_number(camera, "turn") + by, 2 * G_PI));
  spore_document_begin(document, _("Turn the optic"));
  return spore_edit_finish(document, spore_document_set_text(document, camera, "turn", text, error));
}

guint spore_instrument_outline(SporeDocument *document, const SporeInstrumentKind *instrument,
                               SporeInstrumentPlaces places, SporeVec3 points[SPORE_OUTLINE_POINTS]) {
  Addition addition = {.document = document, .instrument = instrument};
  if (!place(&addition, &places, NULL)) return 0;
  SporeVec3 tip = spore_instrument_tip(instrument), tail = {0, addition.length, 0};
  if (instrument->head != SPORE_HEAD_ARC) {
    points[0] = spore_pose_apply(addition.pose, tail);
    points[1] = spore_pose_apply(addition.pose, tip);
    return 2;
  }
  for (guint i = 0; i < SPORE_OUTLINE_POINTS; i++) {
    double angle = G_PI * i / (SPORE_OUTLINE_POINTS - 1), radius = instrument->head_radius;
    points[i] = spore_pose_apply(addition.pose, (SporeVec3){-radius * cos(angle), radius * sin(angle), 0});
  }
  return SPORE_OUTLINE_POINTS;
}
