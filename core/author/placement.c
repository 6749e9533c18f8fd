/* What moves with a body, and by how much. Which places an object has is read from the table of its kind. */
#include "core/author/placement.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/mesh/common.h"
#include "core/scene/compile.h"

#define FINENESS 1e-6 /* m, and of directions and angles */

/* Boxes. */

/* Grows the box around points of the body, `stride` doubles apart, with their radii behind them where it is 4. */
static void grow(SporePose pose, const double *points, gsize count, gsize stride, double lower[3], double upper[3]) {
  for (gsize i = 0; i < count; i++) {
    double at[3], radius = stride == 4 ? points[4 * i + 3] : 0;
    spore_vec3_store(at, spore_pose_apply(pose, spore_vec3_load(points + stride * i)));
    for (int k = 0; k < 3; k++) {
      lower[k] = fmin(lower[k], at[k] - radius);
      upper[k] = fmax(upper[k], at[k] + radius);
    }
  }
}

static void grow_by_asset(SporeDocument *document, SporePose pose, SporeObject *asset, double lower[3],
                          double upper[3]) {
  const char *element = asset ? spore_object_type(asset)->element : "";
  if (g_str_equal(element, "mesh")) {
    const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, NULL);
    if (mesh) grow(pose, mesh->vertices, mesh->vertex_count, 3, lower, upper);
  } else if (g_str_equal(element, "tetrahedra")) {
    const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(document, asset, NULL);
    if (mesh) grow(pose, mesh->vertices, mesh->vertex_count, 3, lower, upper);
  } else if (g_str_equal(element, "curve")) {
    const SporeCurve *curve = spore_document_curve(document, asset, NULL);
    if (curve) grow(pose, curve->points, curve->count, 4, lower, upper);
  } else if (g_str_equal(element, "spheres")) {
    const SporeSphereSet *set = spore_document_spheres(document, asset, NULL);
    if (set) grow(pose, set->spheres, set->count, 4, lower, upper);
  }
}

gboolean spore_body_box(SporeDocument *document, SporeObject *body, double lower[3], double upper[3]) {
  static const char *const units[][3] = {{"visual", "mesh", "mesh"},
                                         {"mechanical", "geometry", "mesh|tetrahedra|curve"},
                                         {"collision", "spheres", "spheres"}};
  SporePose pose = spore_body_pose(body);
  for (int k = 0; k < 3; k++) lower[k] = HUGE_VAL, upper[k] = -HUGE_VAL;
  for (gsize i = 0; i < G_N_ELEMENTS(units) && !isfinite(lower[0]); i++)
    grow_by_asset(document, pose, spore_edit_used_asset(document, body, units[i][0], units[i][1], units[i][2]), lower,
                  upper);
  if (isfinite(lower[0])) return TRUE;
  spore_vec3_store(lower, pose.position);
  spore_vec3_store(upper, pose.position);
  return FALSE;
}

/* What goes along. */

/* How a value follows a motion. Lengths (in `before.x`) follow a scaling alone. */
typedef enum Kind { PLACE, DIRECTION, ROTATION, LENGTH } Kind;

typedef struct Part {
  SporeObject *object;
  guint property;
  Kind kind;
  SporeVec3 before;
} Part;

struct SporePlacement {
  SporeDocument *document;
  GArray *parts;      /* of Part */
  GHashTable *moving; /* of SporeObject *, the bodies */
  SporeVec3 lower, upper, middle;
};

static const SporeParameter *parameter_of(const SporeObject *object, guint property) {
  return &spore_object_type(object)->table->parameters[property];
}

static guint parameter_count(const SporeObject *object) { return (guint)spore_object_type(object)->table->count; }

static SporeObject *body_at(const SporeObject *object, guint property) {
  const SporeParameter *parameter = parameter_of(object, property);
  gboolean names = parameter->type == SPORE_REFERENCE && g_str_equal(parameter->references, "body");
  return names ? spore_object_reference(object, parameter->name) : NULL;
}

static void add_part(SporePlacement *placement, SporeObject *object, guint property, Kind kind) {
  SporeVec3 before = spore_vec3_load(spore_object_value(object, property)->number);
  Part part = {object, property, kind, before};
  g_array_append_val(placement->parts, part);
}

static void add_bodies_of(SporePlacement *placement, const SporeObject *tool, gboolean *more) {
  gboolean goes = FALSE;
  for (guint i = 0; i < parameter_count(tool); i++)
    goes = goes || g_hash_table_contains(placement->moving, body_at(tool, i));
  for (guint i = 0; goes && i < parameter_count(tool); i++)
    if (body_at(tool, i) && g_hash_table_add(placement->moving, body_at(tool, i))) *more = TRUE;
}

/* Bodies that one tool names move together. */
static void add_tools(SporePlacement *placement) {
  const SporeObject *tools = spore_document_section(placement->document, "tools");
  for (gboolean more = TRUE; more;) {
    more = FALSE;
    for (guint i = 0; i < spore_object_child_count(tools); i++)
      add_bodies_of(placement, spore_object_child(tools, i), &more);
  }
}

/* Whether the link ties the body to instruments that move, and to nothing else. */
static gboolean ties_to_instruments(const SporePlacement *placement, const SporeObject *link, const SporeObject *body) {
  gboolean ties = FALSE;
  for (guint i = 0; i < parameter_count(link); i++) {
    SporeObject *other = body_at(link, i);
    if (!other || other == body) continue;
    ties = g_hash_table_contains(placement->moving, other) &&
           (SporeRole)spore_object_number(other, "role") == SPORE_ACTIVE;
    if (!ties) return FALSE;
  }
  return ties;
}

/* Whether the body has links, which all tie it to instruments that move. */
static gboolean hangs(const SporePlacement *placement, const SporeObject *body) {
  const SporeObject *links = spore_document_section(placement->document, "links");
  gboolean any = FALSE;
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    const SporeObject *link = spore_object_child(links, i);
    if (!spore_object_refers_to(link, body)) continue;
    if (!ties_to_instruments(placement, link, body)) return FALSE;
    any = TRUE;
  }
  return any;
}

/* Whether the body is a fluid that comes out of instruments which move, and is not in the scene before. */
static gboolean comes_out(const SporePlacement *placement, const SporeObject *body) {
  const SporeObject *effects = spore_document_section(placement->document, "effects");
  if (!spore_body_is_kept_back(placement->document, body)) return FALSE;
  for (guint i = 0; i < spore_object_child_count(effects); i++) {
    const SporeObject *emitter = spore_object_child(effects, i);
    SporeObject *source = spore_object_reference(emitter, "source");
    gboolean moves = source && g_hash_table_contains(placement->moving, source) &&
                     (SporeRole)spore_object_number(source, "role") == SPORE_ACTIVE;
    if (spore_object_reference(emitter, "body") == body && !moves) return FALSE;
  }
  return TRUE;
}

/* What hangs on an instrument alone goes with it, the film of a bag, and what comes out of it alone, water. */
static void add_hanging(SporePlacement *placement) {
  const SporeObject *bodies = spore_document_section(placement->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (!g_hash_table_contains(placement->moving, body) && (hangs(placement, body) || comes_out(placement, body)))
      g_hash_table_add(placement->moving, body);
  }
}

/* Whether all bodies that the object names move, of which there is one at least. */
static gboolean all_move(const SporePlacement *placement, const SporeObject *object) {
  gboolean any = FALSE;
  for (guint i = 0; i < parameter_count(object); i++) {
    SporeObject *body = body_at(object, i);
    if (body && !g_hash_table_contains(placement->moving, body)) return FALSE;
    any = any || body;
  }
  return any;
}

static gboolean moves(const SporePlacement *placement, const SporeObject *object, const char *property) {
  return g_hash_table_contains(placement->moving, spore_object_reference(object, property));
}

/* Whether a place or direction of the object goes along. */
static gboolean goes(const SporePlacement *placement, const SporeObject *object, const char *property) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  if (spore_parameter_find(table, "source") >= 0) return moves(placement, object, "source");
  if (g_str_has_suffix(property, "_a")) return moves(placement, object, "body_a");
  if (g_str_has_suffix(property, "_b")) return moves(placement, object, "body_b");
  return all_move(placement, object);
}

static void add_section(SporePlacement *placement, const char *element) {
  const SporeObject *section = spore_document_section(placement->document, element);
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *object = spore_object_child(section, i);
    for (guint p = 0; p < parameter_count(object); p++) {
      const SporeParameter *parameter = parameter_of(object, p);
      gboolean place = g_str_equal(/* or a length */
                                   parameter->unit ? parameter->unit : "", "m");
      if (parameter->type == SPORE_VECTOR && goes(placement, object, parameter->name))
        add_part(placement, object, p, place ? PLACE : DIRECTION);
      if (parameter->type == SPORE_REAL && place && goes(placement, object, parameter->name))
        add_part(placement, object, p, LENGTH);
    }
  }
}

static void add_bodies(SporePlacement *placement) {
  GHashTableIter each;
  gpointer body;
  g_hash_table_iter_init(&each, placement->moving);
  while (g_hash_table_iter_next(&each, &body, NULL)) {
    const SporeParameterTable *table = spore_object_type(body)->table;
    add_part(placement, body, (guint)spore_parameter_find(table, "position"), PLACE);
    add_part(placement, body, (guint)spore_parameter_find(table, "rotation"), ROTATION);
  }
}

SporePlacement *spore_placement_new(SporeDocument *document, const GPtrArray *bodies) {
  SporePlacement *placement = g_new0(SporePlacement, 1);
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  placement->document = document;
  placement->parts = g_array_new(FALSE, FALSE, sizeof(Part));
  placement->moving = g_hash_table_new(NULL, NULL);
  for (guint i = 0; i < bodies->len; i++) {
    double least[3], most[3];
    spore_body_box(document, bodies->pdata[i], least, most);
    for (int k = 0; k < 3; k++) lower[k] = fmin(lower[k], least[k]), upper[k] = fmax(upper[k], most[k]);
    g_hash_table_add(placement->moving, bodies->pdata[i]);
  }
  placement->lower = spore_vec3_load(lower);
  placement->upper = spore_vec3_load(upper);
  placement->middle = spore_vec3_scale(0.5, spore_vec3_add(placement->lower, placement->upper));
  add_tools(placement);
  add_hanging(placement);
  add_bodies(placement);
  add_section(placement, "links");
  add_section(placement, "tools");
  add_section(placement, "effects");
  return placement;
}

void spore_placement_free(SporePlacement *placement) {
  g_array_unref(placement->parts);
  g_hash_table_unref(placement->moving);
  g_free(placement);
}

void spore_placement_box(const SporePlacement *placement, double lower[3], double upper[3]) {
  spore_vec3_store(lower, placement->lower);
  spore_vec3_store(upper, placement->upper);
}

SporeVec3 spore_placement_middle(const SporePlacement *placement) { return placement->middle; }

static SporeVec3 moved(const Part *part, SporePose motion) {
  if (part->kind == PLACE) return spore_pose_apply(motion, part->before);
  if (part->kind == DIRECTION) return spore_quat_rotate(motion.orientation, part->before);
  SporeQuat before = spore_quat_from_rotation_vector(part->before);
  return spore_quat_to_rotation_vector(spore_quat_multiply(motion.orientation, before));
}

/* A length of 0 or below has another meaning, and stays. */
static gboolean put_length(const SporePlacement *placement, const Part *part, double length, GError **error) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  const char *property = parameter_of(part->object, part->property)->name;
  return part->before.x <= 0 || spore_document_set_text(placement->document, part->object, property,
                                                        g_ascii_formatd(text, sizeof text, "%.6g", length), error);
}

/* Finer than what a hand sets: what ties moved bodies has to fit as before. */
static gboolean put(const SporePlacement *placement, const Part *part, SporeVec3 value, GError **error) {
  char text[3][G_ASCII_DTOSTR_BUF_SIZE];
  const double component[3] = {value.x, value.y, value.z};
  SporeVec3 now = spore_vec3_load(spore_object_value(part->object, part->property)->number);
  if (spore_vec3_distance(now, value) < 0.5 * FINENESS) return TRUE;
  for (int i = 0; i < 3; i++)
    g_ascii_formatd(text[i], sizeof text[i], "%.9g", FINENESS * nearbyint(component[i] / FINENESS) + 0.0);
  g_autofree char *joined = g_strjoin(" ", text[0], text[1], text[2], NULL);
  return spore_document_set_text(placement->document, part->object, parameter_of(part->object, part->property)->name,
                                 joined, error);
}

gboolean spore_placement_move(SporePlacement *placement, SporePose motion, GError **error) {
  gboolean turns = fabs(motion.orientation.w) < 1;
  for (guint i = 0; i < placement->parts->len; i++) {
    const Part *part = &g_array_index(placement->parts, Part, i);
    if (part->kind == LENGTH) continue;
    if (!put(placement, part, part->kind == PLACE || turns ? moved(part, motion) : part->before, error)) return FALSE;
  }
  return TRUE;
}

GPtrArray *spore_placement_bodies(const SporePlacement *placement) {
  GPtrArray *bodies = g_ptr_array_new();
  const SporeObject *section = spore_document_section(placement->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(section); i++)
    if (g_hash_table_contains(placement->moving, spore_object_child(section, i)))
      g_ptr_array_add(bodies, spore_object_child(section, i));
  return bodies;
}

gboolean spore_placement_scale(SporePlacement *placement, double factor, GError **error) {
  for (guint i = 0; i < placement->parts->len; i++) {
    const Part *part = &g_array_index(placement->parts, Part, i);
    SporeVec3 out = spore_vec3_sub(part->before, placement->middle);
    if (part->kind == LENGTH && !put_length(placement, part, factor * part->before.x, error)) return FALSE;
    if (part->kind == PLACE && !put(placement, part, spore_vec3_add_scaled(placement->middle, factor, out), error))
      return FALSE;
  }
  return TRUE;
}

SporePose spore_placement_turn(SporeVec3 place, SporeVec3 axis, double angle) {
  SporePose motion = {place, spore_quat_from_rotation_vector(spore_vec3_scale(angle, axis))};
  motion.position = spore_vec3_sub(place, spore_quat_rotate(motion.orientation, place));
  return motion;
}

/* Edits. */

gboolean spore_edit_move(SporeDocument *document, const GPtrArray *bodies, SporeVec3 by, GError **error) {
  g_autoptr(SporePlacement) placement = spore_placement_new(document, bodies);
  spore_document_begin(document, _("Move"));
  return spore_edit_finish(document, spore_placement_move(placement, (SporePose){by, spore_quat_identity()}, error));
}

gboolean spore_edit_turn(SporeDocument *document, const GPtrArray *bodies, int axis, double angle, GError **error) {
  static const SporeVec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  g_autoptr(SporePlacement) placement = spore_placement_new(document, bodies);
  SporePose motion = spore_placement_turn(placement->middle, axes[axis], angle);
  spore_document_begin(document, _("Turn"));
  return spore_edit_finish(document, spore_placement_move(placement, motion, error));
}

/* Aligning. */

int spore_alignment_find(const char *name) {
  static const char *const names[] = {"least", "middle", "greatest"};
  for (int i = 0; i < (int)G_N_ELEMENTS(names); i++)
    if (g_str_equal(names[i], name)) return i;
  return -1;
}

static double coordinate(SporeDocument *document, SporeObject *body, int axis, SporeAlignment alignment) {
  double lower[3], upper[3];
  spore_body_box(document, body, lower, upper);
  if (alignment == SPORE_ALIGN_MIDDLE) return 0.5 * (lower[axis] + upper[axis]);
  return alignment == SPORE_ALIGN_LEAST ? lower[axis] : upper[axis];
}

static gboolean align(SporeDocument *document, SporeObject *body, int axis, SporeAlignment alignment, double to,
                      GError **error) {
  g_autoptr(GPtrArray) one = g_ptr_array_new();
  g_ptr_array_add(one, body);
  g_autoptr(SporePlacement) placement = spore_placement_new(document, one);
  double by[3] = {0, 0, 0};
  by[axis] = to - coordinate(document, body, axis, alignment);
  SporePose motion = spore_pose_identity();
  motion.position = spore_vec3_load(by);
  return spore_placement_move(placement, motion, error);
}

gboolean spore_edit_align(SporeDocument *document, const GPtrArray *bodies, int axis, SporeAlignment alignment,
                          GError **error) {
  if (bodies->len < 2)
    return spore_error_raise(error, SPORE_ERROR_INPUT, _("Align"), "%s",
                             _("there is nothing to align it with; select two bodies or more"));
  double to = coordinate(document, bodies->pdata[0], axis, alignment);
  spore_document_begin(document, _("Align"));
  gboolean done = TRUE;
  for (guint i = 1; done && i < bodies->len; i++) done = align(document, bodies->pdata[i], axis, alignment, to, error);
  return spore_edit_finish(document, done);
}
