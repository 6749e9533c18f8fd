/* spore edit: moves, turns, scales and aligns bodies. */
#include "app/cli/edit_place.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/scene.h"
#include "core/author/placement.h"
#include "core/author/scale_edits.h"
#include "core/scene/watch_place.h"

/* Adds the bodies of a list of names, apart by commas. */
static gboolean add_bodies(SporeDocument *document, const char *option, const char *list, GPtrArray *bodies,
                           GError **error) {
  g_auto(GStrv) names = g_strsplit(list, ",", -1);
  for (char **name = names; *name; name++) {
    SporeObject *body = spore_cli_find_body(document, option, *name, error);
    if (!body) return FALSE;
    g_ptr_array_add(bodies, body);
  }
  return TRUE;
}

static gboolean refuse_move(const char *text, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                           _("this is no body and a way; expected BODY=X,Y,Z in metres, such as liver=0.01,0,0"));
}

static gboolean refuse_turn(const char *text, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                           _("this is no body, axis and angle; expected BODY=AXIS:DEGREES with the axis x, y or z, "
                             "such as liver=z:30"));
}

static gboolean refuse_scale(const char *text, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                           _("this is no body and a factor; expected BODY=FACTOR, such as liver=1.2"));
}

static gboolean refuse_align(const char *text, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                           _("these are no bodies, axis and side; expected BODY,BODY=AXIS:SIDE with the axis x, y or z "
                             "and the side least, middle or greatest, such as liver,spleen=y:least"));
}

/* BODY=X,Y,Z */
static gboolean move(SporeDocument *document, const char *list, const char *value, GPtrArray *bodies, GError **error) {
  SporeVec3 by;
  if (!spore_place_parse(value, &by)) return refuse_move(value, error);
  return add_bodies(document, "--move", list, bodies, error) && spore_edit_move(document, bodies, by, error);
}

/* x, y or z and a colon; returns what stands behind the colon. NULL: it is not of that form. */
static const char *axis_and_rest(const char *text, int *axis) {
  if (text[0] < 'x' || text[0] > 'z' || text[1] != ':') return NULL;
  *axis = text[0] - 'x';
  return text + 2;
}

static gboolean turn(SporeDocument *document, const char *list, const char *value, GPtrArray *bodies, GError **error) {
  int axis = 0;
  char *end = NULL;
  const char *rest = axis_and_rest(value, &axis);
  double degrees = rest ? g_ascii_strtod(rest, &end) : 0;
  if (!rest || end == rest || *end || !isfinite(degrees)) return refuse_turn(value, error);
  return add_bodies(document, "--turn", list, bodies, error) &&
         spore_edit_turn(document, bodies, axis, degrees * G_PI / 180, error);
}

static gboolean scale(SporeDocument *document, const char *list, const char *value, GPtrArray *bodies, GError **error) {
  char *end = NULL;
  double factor = g_ascii_strtod(value, &end);
  if (end == value || *end) return refuse_scale(value, error);
  return add_bodies(document, "--scale", list, bodies, error) && spore_edit_scale(document, bodies, factor, error);
}

static gboolean align(SporeDocument *document, const char *list, const char *value, GPtrArray *bodies, GError **error) {
  int axis = 0;
  const char *rest = axis_and_rest(value, &axis);
  int side = rest ? spore_alignment_find(rest) : -1;
  if (side < 0) return refuse_align(value, error);
  return add_bodies(document, "--align", list, bodies, error) &&
         spore_edit_align(document, bodies, axis, (SporeAlignment)side, error);
}

typedef gboolean (*Place)(SporeDocument *document, const char *list, const char *value, GPtrArray *bodies,
                          GError **error);
typedef gboolean (*Refuse)(const char *text, GError **error);

/* LIST=VALUE, each of the texts */
static gboolean place_all(SporeDocument *document, char **texts, Place place, Refuse refuse, GPtrArray *changed,
                          GError **error) {
  for (; texts && *texts; texts++) {
    const char *equals = strrchr(*texts, '=');
    if (!equals) return refuse(*texts, error);
    g_autofree char *list = g_strndup(*texts, (gsize)(equals - *texts));
    g_autoptr(GPtrArray) bodies = g_ptr_array_new();
    if (!place(document, list, equals + 1, bodies, error)) return FALSE;
    for (guint i = 0; i < bodies->len; i++) g_ptr_array_add(changed, spore_object_path(bodies->pdata[i]));
  }
  return TRUE;
}

gboolean spore_cli_place(SporeDocument *document, const SporeCliPlacing *placing, GPtrArray *changed, GError **error) {
  return place_all(document, placing->move, move, refuse_move, changed, error) &&
         place_all(document, placing->turn, turn, refuse_turn, changed, error) &&
         place_all(document, placing->scale, scale, refuse_scale, changed, error) &&
         place_all(document, placing->align, align, refuse_align, changed, error);
}
