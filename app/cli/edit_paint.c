/* Painting from the command line. */
#include "app/cli/edit_paint.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/brush.h"
#include "core/author/region_edits.h"
#include "core/scene/region.h"
#include "core/scene/watch_place.h"

/* X,Y,Z,RADIUS in metres. */
static gboolean read_dab(const char *text, SporeVec3 *place, double *radius) {
  const char *comma = strrchr(text, ',');
  char *end = NULL;
  if (!comma) return FALSE;
  g_autofree char *centre = g_strndup(text, (gsize)(comma - text));
  *radius = g_ascii_strtod(comma + 1, &end);
  return spore_place_parse(centre, place) && end != comma + 1 && !*end && *radius > 0;
}

static GArray *balls_of(const SporeObject *region) {
  guint count;
  g_autofree double *balls = spore_region_balls(region, &count);
  return spore_brush_balls_new(balls, count);
}

static SporeObject *add_region(SporeDocument *document, const char *path, const GArray *balls, GError **error) {
  const char *slash = strrchr(path, '/');
  g_autofree char *holder = slash ? g_strndup(path, (gsize)(slash - path)) : g_strdup(path);
  return spore_edit_add_painted_region(document, holder, slash ? slash + 1 : NULL, spore_brush_numbers(balls),
                                       balls->len, error);
}

gboolean spore_cli_paint(SporeDocument *document, const char *text, GPtrArray *changed, GError **error) {
  const char *equals = strchr(text, '=');
  SporeVec3 place;
  double radius;
  if (!equals || !read_dab(equals + 1, &place, &radius))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, text, "%s",
        _("this is no region and a dab of the brush; expected PATH=X,Y,Z,RADIUS in metres, such as "
          "bodies/liver/regions/scar=0,0.02,0,0.005"));
  g_autofree char *path = g_strndup(text, (gsize)(equals - text));
  SporeObject *region = spore_document_by_path(document, path);
  if (region && !spore_region_is(region)) region = spore_edit_find_region(document, path, error);
  else if (region) {
    g_autoptr(GArray) balls = balls_of(region);
    if (spore_brush_paint(balls, place, radius) &&
        !spore_edit_paint_region(document, region, spore_brush_numbers(balls), balls->len, error))
      return FALSE;
  } else {
    g_autoptr(GArray) balls = spore_brush_balls_new(NULL, 0);
    spore_brush_paint(balls, place, radius);
    region = add_region(document, path, balls, error);
  }
  if (region) g_ptr_array_add(changed, spore_object_path(region));
  return region != NULL;
}
