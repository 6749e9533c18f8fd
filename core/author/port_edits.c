/* Moves ports, and says what is reached through them. */
#include "core/author/port_edits.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/math/quat.h"
#include "core/scene/camera_sight.h"
#include "core/scene/compile.h"
#include "core/scene/length_unit.h"

/* How an instrument goes with its port. */
typedef struct Move {
  SporeDocument *document;
  SporePortReach from, to;
  SporeQuat turn; /* about the aim */
} Move;

static SporeVec3 moved_place(const Move *move, SporeVec3 p) {
  SporeVec3 aim = move->from.aim;
  return spore_vec3_add(aim, spore_quat_rotate(move->turn, spore_vec3_sub(p, aim)));
}

static gboolean has(const SporeObject *object, const char *property) {
  return spore_parameter_find(spore_object_type(object)->table, property) >= 0;
}

static gboolean move_place(const Move *move, SporeObject *object, const char *property, GError **error) {
  return spore_edit_set_vector(move->document, object, property,
                               moved_place(move, spore_object_vector(object, property)), error);
}

static gboolean turn_direction(const Move *move, SporeObject *object, const char *property, GError **error) {
  return spore_edit_set_vector(move->document, object, property,
                               spore_quat_rotate(move->turn, spore_object_vector(object, property)), error);
}

static gboolean move_body(const Move *move, SporeObject *body, GError **error) {
  SporeQuat orientation = spore_quat_multiply(move->turn, spore_body_pose(body).orientation);
  return move_place(move, body, "position", error) &&
         spore_edit_set_vector(move->document, body, "rotation", spore_quat_to_rotation_vector(orientation), error);
}

static gboolean move_bodies(const Move *move, GError **error) {
  static const char *const jaws[] = {"jaw_a", "jaw_b"};
  if (!move_body(move, move->from.body, error)) return FALSE;
  for (guint i = 0; i < G_N_ELEMENTS(jaws); i++) {
    SporeObject *jaw = has(move->from.tool, jaws[i]) ? spore_object_reference(move->from.tool, jaws[i]) : NULL;
    if (jaw && !move_body(move, jaw, error)) return FALSE;
  }
  return TRUE;
}

/* A tool has those places that its kind has parameters for. */
static gboolean move_tool(const Move *move, SporeObject *tool, GError **error) {
  static const char *const places[] = {"hinge", "point", "tip", "middle", "swage"};
  for (guint i = 0; i < G_N_ELEMENTS(places); i++)
    if (has(tool, places[i]) && !move_place(move, tool, places[i], error)) return FALSE;
  return !has(tool, "axis") || turn_direction(move, tool, "axis", error);
}

/* The camera looks aside in the scene's axes, so that its turn is another after it has moved. */
static gboolean move_camera(const Move *move, SporeObject *camera, GError **error) {
  SporeVec3 position = moved_place(move, spore_object_vector(camera, "position"));
  SporeVec3 target = moved_place(move, spore_object_vector(camera, "target"));
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  if (!spore_edit_set_vector(move->document, camera, "position", position, error) ||
      !spore_edit_set_vector(move->document, camera, "target", target, error))
    return FALSE;
  if (spore_object_number(camera, "angle") == 0) return TRUE;
  g_ascii_formatd(text, sizeof text, "%.6f", spore_camera_turn_to(position, target, move->from.aim));
  return spore_document_set_text(move->document, camera, "turn", text, error);
}

static gboolean move_cameras(const Move *move, GError **error) {
  const SporeObject *tools = spore_document_section(move->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *camera = spore_object_child(tools, i);
    if (g_str_equal(spore_object_type(camera)->element, "camera") &&
        spore_object_reference(camera, "body") == move->from.body && !move_camera(move, camera, error))
      return FALSE;
  }
  return TRUE;
}

static gboolean is_body(const SporeObject *object) { return g_str_equal(spore_object_type(object)->element, "body"); }
static gboolean is_camera(const SporeObject *object) {
  return g_str_equal(spore_object_type(object)->element, "camera");
}

gboolean spore_edit_move_port(SporeDocument *document, SporeObject *port, SporeVec3 pivot, GError **error) {
  Move move = {.document = document};
  if (!spore_port_reach(document, port, &move.from))
    return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(port), "%s",
                             _("no instrument passes through it; expected the port of a body that a device moves; name "
                               "such a body as body_a"));
  if (!spore_port_moved(&move.from, pivot, &move.to, &move.turn)) {
    g_autofree char *way = spore_length_text(spore_vec3_distance(pivot, move.from.aim));
    return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(port),
                             _("it would lie %s from what the instrument aims at, and the shaft cannot turn there; "
                               "expected a place beyond the instrument's tip; choose one farther away"),
                             way);
  }
  gboolean own = is_body(move.from.tool) || is_camera(move.from.tool);
  spore_document_begin(document, _("Move port"));
  gboolean done = move_bodies(&move, error) && (own || move_tool(&move, move.from.tool, error)) &&
                  move_cameras(&move, error) && spore_edit_set_vector(document, port, "point", pivot, error) &&
                  turn_direction(&move, port, "direction", error);
  return spore_edit_finish(document, done);
}

/* Sentences. */

static void say(GString *text, SporeDocument *document, const SporePortReach *reach, const SporeObject *body) {
  double share;
  if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE ||
      !spore_ports_share(document, reach, 1, body, &share))
    return;
  g_autofree char *part = spore_port_share_text(share);
  if (text->len) g_string_append_c(text, '\n');
  g_string_append_printf(text, _("\"%s\" reaches %s of \"%s\" through \"%s\""), spore_object_name(reach->tool), part,
                         spore_object_name(body), spore_object_name(reach->port));
}

char *spore_port_sentences(SporeDocument *document, const SporeObject *selected) {
  g_autoptr(GArray) own = spore_ports_of(document, selected);
  g_autoptr(GArray) all = spore_ports_of(document, NULL);
  const SporeObject *bodies = spore_document_section(document, "bodies");
  GString *text = g_string_new(NULL);
  for (guint i = 0; own->len && i < own->len; i++)
    for (guint k = 0; k < spore_object_child_count(bodies); k++)
      say(text, document, &g_array_index(own, SporePortReach, i), spore_object_child(bodies, k));
  for (guint i = 0; !own->len && is_body(selected) && i < all->len; i++)
    say(text, document, &g_array_index(all, SporePortReach, i), selected);
  if (text->len) g_string_append_printf(text, "\n%s", _("What lies in the way is not looked at."));
  return g_string_free(text, text->len == 0);
}
