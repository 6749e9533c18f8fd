/* Reads and writes .spheres and .curve: "x y z r" a line, metres, # comments. Spheres with weights have lines "x y z r
 * w", and a comment "# level H" may stand before the first line: readers without weights skip it. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "core/io/scanner.h"

/* The words for a kind of rows in messages. */
typedef struct RowWords {
  const char *numbers[4];
  const char *weight; /* NULL: has none */
  const char *radius, *too_many, *none;
} RowWords;

static const RowWords sphere_words = {
    .numbers = {N_("the x of a sphere, in metres"), N_("the y of a sphere, in metres"),
                N_("the z of a sphere, in metres"), N_("the radius of a sphere, in metres")},
    .weight = N_("the weight of a sphere"),
    .radius = N_("the radius %g is not above 0; expected a length in metres; correct or remove the sphere"),
    .too_many = N_("there are more than %u spheres; expected fewer; split the file"),
    .none = N_("there is no sphere in the file; expected lines \"x y z r\" in metres; generate the set again")};

static const RowWords curve_words = {
    .numbers = {N_("the x of a point, in metres"), N_("the y of a point, in metres"), N_("the z of a point, in metres"),
                N_("the radius at a point, in metres")},
    .radius = N_("the radius %g is not above 0; expected a length in metres; correct or remove the point"),
    .too_many = N_("there are more than %u points; expected fewer; use a coarser curve"),
    .none = N_("there is no point in the file; expected lines \"x y z r\" in metres; generate the curve again")};

/* Rows of a file: 4 numbers each, or 5 where the first row has a weight. */
typedef struct Rows {
  GArray *numbers;
  guint columns; /* 0 before the first row */
  double level;  /* m */
} Rows;

/* Skips a comment that stands alone on its line; FALSE where the next text is no such comment. */
static gboolean pass_comment(SporeScanner *scanner) {
  if (scanner->at == scanner->end || *scanner->at != '#') return FALSE;
  const char *newline = memchr(scanner->at, '\n', (gsize)(scanner->end - scanner->at));
  scanner->at = newline ? newline + 1 : scanner->end;
  scanner->line_start = scanner->at;
  scanner->line++;
  return TRUE;
}

/* Whether the comment that begins here is "# level H". `number` has then read H. */
static gboolean is_level(const SporeScanner *scanner, SporeScanner *number, double *level) {
  *number = *scanner;
  if (number->at == number->end || *number->at != '#') return FALSE;
  number->at++;
  if (!spore_scanner_next(number) || number->word_line != scanner->line || !spore_scanner_is(number, "level"))
    return FALSE;
  g_autoptr(GError) none = NULL;
  return spore_scanner_more_on_line(number) && spore_scanner_real(number, "", level, &none) &&
         !spore_scanner_more_on_line(number);
}

/* Reads the level, where one of the comments at the start of a set holds it. */
static gboolean read_level(SporeScanner *scanner, Rows *rows, GError **error) {
  SporeScanner number;
  double level;
  while (!is_level(scanner, &number, &level))
    if (!pass_comment(scanner)) return TRUE;
  if (!(level >= 0))
    return spore_scanner_fail(&number, error, _("the level %g is below 0; expected a length in metres; correct it"),
                              level);
  rows->level = level;
  rows->columns = 5;
  return TRUE;
}

/* Reads the weight of a row. Either all rows have a weight or none. */
static gboolean read_weight(SporeScanner *scanner, const RowWords *words, Rows *rows, double *weight, GError **error) {
  gboolean more = spore_scanner_more_on_line(scanner);
  if (!rows->columns) rows->columns = more && words->weight ? 5 : 4;
  if (rows->columns == 5 && !more)
    return spore_scanner_fail(scanner, error,
                              _("the sphere has no weight, others have; expected \"x y z r w\"; give it one"));
  if (rows->columns == 4 && more && words->weight)
    return spore_scanner_fail(
        scanner, error,
        _("there is more behind the four numbers, and the spheres before have no weight; expected \"x y z r\"; remove "
          "it or put # before it"));
  if (rows->columns == 5 && !spore_scanner_real(scanner, _(words->weight), weight, error)) return FALSE;
  if (rows->columns == 5 && !(*weight > 0))
    return spore_scanner_fail(
        scanner, error, _("the weight %g is not above 0; expected a number; correct or remove the sphere"), *weight);
  return TRUE;
}

static gboolean read_row(SporeScanner *scanner, const RowWords *words, Rows *rows, GError **error) {
  double row[5];
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
  if (rows->columns && rows->numbers->len / rows->columns >= SPORE_MESH_MAXIMUM)
    return spore_scanner_fail(scanner, error, _(words->too_many), SPORE_MESH_MAXIMUM);
#pragma GCC diagnostic pop
  if (!read_weight(scanner, words, rows, &row[4], error)) return FALSE;
  if (spore_scanner_more_on_line(scanner))
    return rows->columns == 5
               ? spore_scanner_fail(scanner, error,
                                    _("there is more behind the five numbers; expected \"x y z r w\"; remove it or put "
                                      "# before it"))
               : spore_scanner_fail(scanner, error,
                                    _("there is more behind the four numbers; expected \"x y z r\"; remove it or put # "
                                      "before it"));
  g_array_append_vals(rows->numbers, row, rows->columns);
  return TRUE;
}

/* Reads all rows; on failure `numbers` is NULL and the error is set. */
static Rows read_rows(SporeScanner *scanner, const RowWords *words, GError **error) {
  Rows rows = {.numbers = g_array_new(FALSE, FALSE, sizeof(double))};
  gboolean done = !words->weight || read_level(scanner, &rows, error);
  while (done) {
    SporeScanner ahead = *scanner;
    if (!spore_scanner_next(&ahead)) break;
    done = read_row(scanner, words, &rows, error);
  }
  if (done && !rows.numbers->len) done = spore_scanner_fail(scanner, error, "%s", _(words->none));
  if (!done) g_clear_pointer(&rows.numbers, g_array_unref);
  return rows;
}

static gboolean finish(SporeScanner *scanner, SporeError *failure, GError **error) {
  spore_error_at(failure, scanner->place);
  return spore_error_propagate(failure, error);
}

static gboolean store_spheres(const Rows *rows, SporeSphereSet *set, SporeError *failure) {
  const double *numbers = (const double *)(const void *)rows->numbers->data;
  if (!spore_sphere_set_allocate(set, rows->numbers->len / rows->columns, failure)) return FALSE;
  if (rows->columns == 5 && !spore_sphere_set_add_weights(set, failure)) return FALSE;
  for (gsize i = 0; i < set->count; i++) {
    memcpy(set->spheres + 4 * i, numbers + rows->columns * i, 4 * sizeof *numbers);
    if (set->weights) set->weights[i] = numbers[rows->columns * i + 4];
  }
  set->level = rows->level;
  return spore_sphere_set_validate(set, failure);
}

gboolean spore_spheres_parse(const char *place, const char *text, gsize size, SporeSphereSet *set, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  Rows rows = read_rows(&scanner, &sphere_words, error);
  if (!rows.numbers) return FALSE;
  SporeError failure = SPORE_ERROR_INIT;
  *set = (SporeSphereSet){0};
  gboolean done = store_spheres(&rows, set, &failure);
  g_array_unref(rows.numbers);
  if (done) return TRUE;
  spore_sphere_set_clear(set);
  return finish(&scanner, &failure, error);
}

gboolean spore_curve_parse(const char *place, const char *text, gsize size, SporeCurve *curve, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  g_autoptr(GArray) rows = read_rows(&scanner, &curve_words, error).numbers;
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
  if (!set->weights) return format_rows(set->spheres, set->count, size);
  GString *text =
      g_string_new("# x y z r w, in metres; w: weight of the sphere's depth; level: what the sum is felt above\n");
  if (set->level > 0) {
    g_string_append(text, "# level ");
    spore_append_reals(text, &set->level, 1, 1, "");
  }
  for (gsize i = 0; i < set->count; i++) {
    const double *sphere = set->spheres + 4 * i, row[] = {sphere[0], sphere[1], sphere[2], sphere[3], set->weights[i]};
    spore_append_reals(text, row, 1, 5, "");
  }
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}

char *spore_curve_format(const SporeCurve *curve, gsize *size) {
  return format_rows(curve->points, curve->count, size);
}
