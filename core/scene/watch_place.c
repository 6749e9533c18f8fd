/* Reads a point of a body that is to be watched. */
#include "core/scene/watch_place.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/number.h"
#include "core/scene/body_shape.h"

gboolean spore_place_parse(const char *text, SporeVec3 *at) {
  double numbers[3];
  for (int k = 0; k < 3; k++) {
    size_t length = spore_number_read(text, strlen(text), &numbers[k]);
    if (length == 0 || !isfinite(numbers[k]) || text[length] != (k < 2 ? ',' : '\0')) return FALSE;
    text += length + 1;
  }
  *at = (SporeVec3){numbers[0], numbers[1], numbers[2]};
  return TRUE;
}

/* The same the other way round. g_free. */
static char *write_place(const char *body, SporeVec3 at) {
  char x[G_ASCII_DTOSTR_BUF_SIZE], y[G_ASCII_DTOSTR_BUF_SIZE], z[G_ASCII_DTOSTR_BUF_SIZE];
  return g_strdup_printf("%s@%s,%s,%s", body, g_ascii_formatd(x, sizeof x, "%.6g", at.x),
                         g_ascii_formatd(y, sizeof y, "%.6g", at.y), g_ascii_formatd(z, sizeof z, "%.6g", at.z));
}

static gboolean find_body(const SporeSimulation *simulation, SporeDocument *document, const char *text,
                          const char *name, guint32 *body, GError **error) {
  SporeObject *object = spore_document_find(document, "body", name);
  *body = object ? spore_simulation_body_of(simulation, object) : SPORE_NO_BODY;
  if (*body != SPORE_NO_BODY) return TRUE;
  g_autoptr(GString) names = g_string_new(NULL);
  for (guint32 b = 0; b < spore_world_body_count(simulation->world); b++)
    g_string_append_printf(names, names->len ? ", %s" : "%s", spore_world_body_name(simulation->world, b));
  return spore_error_raise(error, SPORE_ERROR_INPUT, text, _("there is no body \"%s\"; expected one of: %s"), name,
                           names->len ? names->str : _("none: import a mesh first"));
}

static gboolean check_place(const SporeSimulation *simulation, SporeDocument *document, const char *text, guint32 body,
                            SporeVec3 at, GError **error) {
  SporeBodyPlace place;
  if (!spore_body_find_place(simulation, document, body, at, &place))
    return spore_error_raise(error, SPORE_ERROR_INPUT, text,
                             _("the body has no mesh, curve or spheres, so that it has no point; watch another"));
  if (place.outside <= place.allowed && place.carried) return TRUE;
  g_autofree char *nearest = write_place(spore_world_body_name(simulation->world, body), place.nearest);
  if (place.outside <= place.allowed)
    return spore_error_raise(error, SPORE_ERROR_INPUT, text,
                             _("the body cannot carry this point; expected one on its surface, or on the line of a "
                               "straight thread; the nearest is %s"),
                             nearest);
  return spore_error_raise(error, SPORE_ERROR_INPUT, text,
                           _("this lies %.3g m outside the body; expected at most %.3g m, its mean edge; the nearest "
                             "point of the body is %s"),
                           place.outside, place.allowed, nearest);
}

gboolean spore_watch_place_parse(const SporeSimulation *simulation, SporeDocument *document, const char *text,
                                 guint32 *body, SporeVec3 *at, GError **error) {
  const char *sign = strrchr(text, '@');
  if (!sign || sign == text || !spore_place_parse(sign + 1, at))
    return spore_error_raise(error, SPORE_ERROR_INPUT, text,
                             _("this is no point of a body; expected BODY@X,Y,Z in metres, such as "
                               "liver@0.01,0,0.02"));
  g_autofree char *name = g_strndup(text, (gsize)(sign - text));
  return find_body(simulation, document, text, name, body, error) &&
         check_place(simulation, document, text, *body, *at, error);
}
