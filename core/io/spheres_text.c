/* .spheres: "x y z r" a line, metres, # comments. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "core/io/scanner.h"

static gboolean read_sphere(SporeScanner *scanner, GArray *spheres, GError **error) {
  static const char *const names[4] = {N_("the x of a sphere, in metres"), N_("the y of a sphere, in metres"),
                                       N_("the z of a sphere, in metres"), N_("the radius of a sphere, in metres")};
  double sphere[4];
  unsigned line = 0;
  for (int i = 0; i < 4; i++) {
    if (!spore_scanner_real(scanner, _(names[i]), &sphere[i], error)) return FALSE;
    if (i == 0) line = scanner->word_line;
    if (scanner->word_line != line)
      return spore_scanner_fail(
          scanner, error, _("line %u has fewer than four numbers; expected \"x y z r\"; complete or remove it"), line);
  }
  if (!(sphere[3] > 0))
    return spore_scanner_fail(
        scanner, error, _("the radius %g is not above 0; expected a length in metres; correct or remove the sphere"),
        sphere[3]);
  if (spore_scanner_more_on_line(scanner))
    return spore_scanner_fail(
        scanner, error, _("there is more behind the four numbers; expected \"x y z r\"; remove it or put # before it"));
  if (spheres->len / 4 >= SPORE_MESH_MAXIMUM)
    return spore_scanner_fail(scanner, error, _("there are more than %u spheres; expected fewer; split the file"),
                              SPORE_MESH_MAXIMUM);
  g_array_append_vals(spheres, sphere, 4);
  return TRUE;
}

gboolean spore_spheres_parse(const char *place, const char *text, gsize size, SporeSphereSet *set, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  GArray *spheres = g_array_new(FALSE, FALSE, sizeof(double));
  gboolean done = TRUE;
  while (done) {
    SporeScanner ahead = scanner;
    if (!spore_scanner_next(&ahead)) break;
    done = read_sphere(&scanner, spheres, error);
  }
  if (done && !spheres->len)
    done = spore_scanner_fail(
        &scanner, error,
        _("there is no sphere in the file; expected lines \"x y z r\" in metres; generate the set again"));
  SporeError failure = SPORE_ERROR_INIT;
  if (done && !spore_sphere_set_allocate(set, spheres->len / 4, &failure)) {
    spore_error_at(&failure, scanner.place);
    done = spore_error_propagate(&failure, error);
  }
  if (done) memcpy(set->spheres, spheres->data, spheres->len * sizeof(double));
  g_array_unref(spheres);
  if (done && !spore_sphere_set_validate(set, &failure)) {
    spore_sphere_set_clear(set);
    spore_error_at(&failure, scanner.place);
    done = spore_error_propagate(&failure, error);
  }
  return done;
}

char *spore_spheres_format(const SporeSphereSet *set, gsize *size) {
  GString *text = g_string_new("# x y z r, in metres\n");
  spore_append_reals(text, set->spheres, set->count, 4, "");
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}
