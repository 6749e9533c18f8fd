/* .spheres and .curve: "x y z r" a line, metres, # comments. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "core/io/scanner.h"

/* What messages say of a kind of rows. */
typedef struct RowWords {
  const char *numbers[4];
  const char *radius, *too_many, *none;
} RowWords;

static const RowWords sphere_words = {
    .numbers = {N_("the x of a sphere, in metres"), N_("the y of a sphere, in metres"),
                N_("the z of a sphere, in metres"), N_("the radius of a sphere, in metres")},
    .radius = N_("the radius %g is not above 0; expected a length in metres; correct or remove the sphere"),
    .too_many = N_("there are more than %u spheres; expected fewer; split the file"),
    .none = N_("there is no sphere in the file; expected lines \"x y z r\" in metres; generate the set again")};

static const RowWords curve_words = {
    .numbers = {N_("the x of a point, in metres"), N_("the y of a point, in metres"), N_("the z of a point, in metres"),
                N_("the radius at a point, in metres")},
    .radius = N_("the radius %g is not above 0; expected a length in metres; correct or remove the point"),
    .too_many = N_("there are more than %u points; expected fewer; use a coarser curve"),
    .none = N_("there is no point in the file; expected lines \"x y z r\" in metres; generate the curve again")};

static gboolean read_row(SporeScanner *scanner, const RowWords *words, GArray *rows, GError **error) {
  double row[4];
  unsigned line = 0;
  for (int i = 0; i < 4; i++) {
    if (!spore_scanner_real(scanner, _(words->numbers[i]), &row[i], error)) return FALSE;
    if (i == 0) line = scanner->word_line;
    if (scanner->word_line != line)
      return spore_scanner_fail(
          scanner, error, _("line %u has fewer than four numbers; expected \"x y z r\"; complete or remove it"), line);
  }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  if (!(row[3] > 0)) return spore_scanner_fail(scanner, error, _(words->radius), row[3]);
  if (rows->len / 4 >= SPORE_MESH_MAXIMUM)
    return spore_scanner_fail(scanner, error, _(words->too_many), SPORE_MESH_MAXIMUM);
#pragma GCC diagnostic pop
  if (spore_scanner_more_on_line(scanner))
    return spore_scanner_fail(
        scanner, error, _("there is more behind the four numbers; expected \"x y z r\"; remove it or put # before it"));
  g_array_append_vals(rows, row, 4);
  return TRUE;
}

/* All rows, 4 numbers each; NULL with a message. */
static GArray *read_rows(SporeScanner *scanner, const RowWords *words, GError **error) {
  GArray *rows = g_array_new(FALSE, FALSE, sizeof(double));
  gboolean done = TRUE;
  while (done) {
    SporeScanner ahead = *scanner;
    if (!spore_scanner_next(&ahead)) break;
    done = read_row(scanner, words, rows, error);
  }
  if (done && !rows->len) done = spore_scanner_fail(scanner, error, "%s", _(words->none));
  if (done) return rows;
  g_array_unref(rows);
  return NULL;
}

static gboolean finish(SporeScanner *scanner, SporeError *failure, GError **error) {
  spore_error_at(failure, scanner->place);
  return spore_error_propagate(failure, error);
}

gboolean spore_spheres_parse(const char *place, const char *text, gsize size, SporeSphereSet *set, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  g_autoptr(GArray) rows = read_rows(&scanner, &sphere_words, error);
  if (!rows) return FALSE;
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_sphere_set_allocate(set, rows->len / 4, &failure)) return finish(&scanner, &failure, error);
  memcpy(set->spheres, rows->data, rows->len * sizeof(double));
  if (spore_sphere_set_validate(set, &failure)) return TRUE;
  spore_sphere_set_clear(set);
  return finish(&scanner, &failure, error);
}

gboolean spore_curve_parse(const char *place, const char *text, gsize size, SporeCurve *curve, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  g_autoptr(GArray) rows = read_rows(&scanner, &curve_words, error);
  if (!rows) return FALSE;
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_curve_allocate(curve, rows->len / 4, &failure)) return finish(&scanner, &failure, error);
  memcpy(curve->points, rows->data, rows->len * sizeof(double));
  if (spore_curve_validate(curve, &failure)) return TRUE;
  spore_curve_clear(curve);
  return finish(&scanner, &failure, error);
}

static char *format_rows(const double *rows, gsize count, gsize *size) {
  GString *text = g_string_new("# x y z r, in metres\n");
  spore_append_reals(text, rows, count, 4, "");
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}

char *spore_spheres_format(const SporeSphereSet *set, gsize *size) {
  return format_rows(set->spheres, set->count, size);
}

char *spore_curve_format(const SporeCurve *curve, gsize *size) {
  return format_rows(curve->points, curve->count, size);
}
