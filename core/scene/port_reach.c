/* What an instrument reaches through its port. */
#include "core/scene/port_reach.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/math/quat.h"
#include "core/scene/camera_sight.h"
#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"

#define LEAST_WAY_M 0.01 /* from the port to what the instrument aims at */

static gboolean is_element(const SporeObject *object, const char *element) {
  return g_str_equal(spore_object_type(object)->element, element);
}

static const SporeTriangleMesh *drawn_mesh(SporeDocument *document, const SporeObject *body) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = visual ? spore_object_reference(visual, "mesh") : NULL;
  return asset && is_element(asset, "mesh") ? spore_document_mesh(document, asset, NULL) : NULL;
}

/* Tools. */

/* Whether a tool, or a camera, has this body as one of its own. */
static gboolean names_body(const SporeObject *tool, const SporeObject *body) {
  static const char *const parts[] = {"body", "jaw_a", "jaw_b"};
  for (guint i = 0; i < G_N_ELEMENTS(parts); i++)
    if (spore_parameter_find(spore_object_type(tool)->table, parts[i]) >= 0 &&
        spore_object_reference(tool, parts[i]) == body)
      return TRUE;
  return FALSE;
}

/* The tool that moves the body, or the camera that goes with it; NULL: none. */
static SporeObject *find_tool(SporeDocument *document, const SporeObject *body, gboolean camera) {
  const SporeObject *tools = spore_document_section(document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *tool = spore_object_child(tools, i);
    if (is_element(tool, "camera") == camera && names_body(tool, body)) return tool;
  }
  return NULL;
}

/* How deep the drawn part of a body goes beyond the pivot, m; `least`, where that is deeper. */
static double depth_of(SporeDocument *document, const SporePortReach *reach, const SporeObject *body, double least) {
  const SporeTriangleMesh *mesh = body ? drawn_mesh(document, body) : NULL;
  for (gsize v = 0; mesh && v < mesh->vertex_count; v++) {
    SporeVec3 p = spore_pose_apply(spore_body_pose(body), spore_vec3_load(mesh->vertices + 3 * v));
    least = fmax(least, spore_vec3_dot(spore_vec3_sub(p, reach->pivot), reach->along));
  }
  return least;
}

static void find_tip(SporeDocument *document, SporePortReach *reach) {
  static const char *const jaws[] = {"jaw_a", "jaw_b"};
  SporeVec3 origin = spore_body_pose(reach->body).position;
  double depth = spore_vec3_dot(spore_vec3_sub(origin, reach->pivot), reach->along);
  depth = depth_of(document, reach, reach->body, depth);
  for (guint i = 0; i < G_N_ELEMENTS(jaws); i++)
    if (spore_parameter_find(spore_object_type(reach->tool)->table, jaws[i]) >= 0)
      depth = depth_of(document, reach, spore_object_reference(reach->tool, jaws[i]), depth);
  reach->tip = spore_vec3_add_scaled(reach->pivot, depth, reach->along);
}

static SporeVec3 sight_of(const SporeObject *camera) {
  SporeCameraFields fields = {.angle = spore_object_number(camera, "angle"),
                              .turn = spore_object_number(camera, "turn")};
  spore_vec3_store(fields.position, spore_object_vector(camera, "position"));
  spore_vec3_store(fields.target, spore_object_vector(camera, "target"));
  return spore_camera_sight(&fields);
}

gboolean spore_port_reach(SporeDocument *document, SporeObject *port, SporePortReach *reach) {
  SporeObject *body = is_element(port, "port") ? spore_object_reference(port, "body_a") : NULL;
  if (!body || (SporeRole)spore_object_number(body, "role") != SPORE_ACTIVE) return FALSE;
  SporeVec3 direction = spore_object_vector(port, "direction");
  if (!(spore_vec3_length(direction) > 0)) return FALSE;
  SporeObject *camera = find_tool(document, body, TRUE), *tool = find_tool(document, body, FALSE);
  *reach = (SporePortReach){.port = port,
                            .body = body,
                            .tool = tool     ? tool
                                    : camera ? camera
                                             : body,
                            .pivot = spore_object_vector(port, "point"),
                            .along = spore_vec3_scale(1 / spore_vec3_length(direction), direction),
                            .angle = spore_object_number(port, "reach_angle"),
                            .shallowest = spore_object_number(port, "reach_least"),
                            .deepest = spore_object_number(port, "reach_most")};
  /* The file says a line; into the patient is where the instrument's origin lies, with what it works with. */
  SporeVec3 inward = spore_vec3_sub(spore_body_pose(body).position, reach->pivot);
  if (spore_vec3_dot(inward, reach->along) < 0) reach->along = spore_vec3_scale(-1, reach->along);
  find_tip(document, reach);
  reach->aim = camera ? sight_of(camera) : reach->tip;
  return TRUE;
}

GArray *spore_ports_of(SporeDocument *document, const SporeObject *object) {
  GArray *found = g_array_new(FALSE, FALSE, sizeof(SporePortReach));
  const SporeObject *links = spore_document_section(document, "links");
  SporePortReach reach;
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    SporeObject *port = spore_object_child(links, i);
    if (!spore_port_reach(document, port, &reach)) continue;
    if (!object || object == port || object == reach.body || object == reach.tool || names_body(reach.tool, object) ||
        names_body(object, reach.body))
      g_array_append_val(found, reach);
  }
  return found;
}

gboolean spore_port_moved(const SporePortReach *reach, SporeVec3 pivot, SporePortReach *moved, SporeQuat *turn) {
  SporeVec3 outward = spore_vec3_scale(-1, reach->along), way = spore_vec3_sub(pivot, reach->aim);
  /* The point of the shaft's line that is nearest to the aim, seen from there. */
  SporeVec3 base = spore_vec3_sub(reach->pivot, reach->aim);
  base = spore_vec3_add_scaled(base, -spore_vec3_dot(base, outward), outward);
  double distance = spore_vec3_length(way), aside = spore_vec3_length(base);
  if (!(distance > fmax(aside, LEAST_WAY_M))) return FALSE;
  SporeVec3 on_line = spore_vec3_add_scaled(base, sqrt(distance * distance - aside * aside), outward);
  SporeQuat by = spore_quat_between(spore_vec3_scale(1 / distance, on_line), spore_vec3_scale(1 / distance, way));
  SporeVec3 to_tip = spore_vec3_sub(reach->tip, reach->aim);
  *moved = *reach;
  moved->pivot = pivot;
  moved->along = spore_quat_rotate(by, reach->along);
  moved->tip = spore_vec3_add(reach->aim, spore_quat_rotate(by, to_tip));
  if (turn) *turn = by;
  return TRUE;
}

gboolean spore_port_reaches(const SporePortReach *reach, SporeVec3 place) {
  SporeVec3 way = spore_vec3_sub(place, reach->pivot);
  double depth = spore_vec3_length(way);
  return depth >= reach->shallowest && depth <= reach->deepest &&
         spore_vec3_dot(way, reach->along) >= depth * cos(reach->angle);
}

static gboolean any_reaches(const SporePortReach *ports, guint count, SporeVec3 place) {
  for (guint i = 0; i < count; i++)
    if (spore_port_reaches(&ports[i], place)) return TRUE;
  return FALSE;
}

gboolean spore_ports_share(SporeDocument *document, const SporePortReach *ports, guint count, const SporeObject *body,
                           double *share) {
  const SporeTriangleMesh *mesh = drawn_mesh(document, body);
  SporePose pose = spore_body_pose(body);
  double within = 0, whole = 0;
  for (gsize t = 0; mesh && t < mesh->triangle_count; t++) {
    SporeVec3 corners[3];
    guint reached = 0;
    for (guint k = 0; k < 3; k++) {
      corners[k] = spore_pose_apply(pose, spore_vec3_load(mesh->vertices + 3 * mesh->triangles[3 * t + k]));
      reached += (guint)any_reaches(ports, count, corners[k]);
    }
    SporeVec3 across = spore_vec3_cross(spore_vec3_sub(corners[1], corners[0]), spore_vec3_sub(corners[2], corners[0]));
    whole += spore_vec3_length(across);
    within += spore_vec3_length(across) * reached / 3;
  }
  *share = whole > 0 ? within / whole : 0;
  return whole > 0;
}

char *spore_port_share_text(double share) {
  if (share <= 0) return g_strdup(_("nothing"));
  if (share >= 1 - 1e-12) return g_strdup(_("all"));
  return g_strdup_printf(_("%.0f %%"), CLAMP(100 * share, 1, 99));
}

/* The cone as lines. */

#define SIDES 12 /* lines of the mantle */
#define RINGS 3  /* across them, at equal depths, and one at the least depth */
#define ARCS 48  /* of a ring */

static SporeVec3 on_mantle(const SporePortReach *reach, double depth, double turn) {
  SporeVec3 u = spore_vec3_any_across(reach->along), v = spore_vec3_cross(reach->along, u);
  SporeVec3 aside = spore_vec3_add(spore_vec3_scale(cos(turn), u), spore_vec3_scale(sin(turn), v));
  SporeVec3 way = spore_vec3_add_scaled(spore_vec3_scale(sin(reach->angle), aside), cos(reach->angle), reach->along);
  return spore_vec3_add_scaled(reach->pivot, depth, way);
}

static void add_line(double **points, SporeVec3 from, SporeVec3 to) {
  spore_vec3_store(*points, from);
  spore_vec3_store(*points + 3, to);
  *points += 6;
}

void spore_port_lines(const SporePortReach *reach, double *points) {
  _Static_assert(SPORE_PORT_LINES == SIDES + (RINGS + 1) * ARCS + 1, "a line for each side and arc, and the shaft");
  double way = reach->deepest - reach->shallowest;
  for (int side = 0; side < SIDES; side++)
    add_line(&points, on_mantle(reach, reach->shallowest, side * 2 * G_PI / SIDES),
             on_mantle(reach, reach->deepest, side * 2 * G_PI / SIDES));
  for (int ring = 0; ring <= RINGS; ring++)
    for (int arc = 0; arc < ARCS; arc++)
      add_line(&points, on_mantle(reach, reach->shallowest + way * ring / RINGS, arc * 2 * G_PI / ARCS),
               on_mantle(reach, reach->shallowest + way * ring / RINGS, (arc + 1) * 2 * G_PI / ARCS));
  add_line(&points, reach->pivot, reach->tip);
}
