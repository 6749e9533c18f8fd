/* The legacy format of VTK: a line of version, a title, ASCII or BINARY, and sections of one dataset. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/helpers/vtk.h"

#define N_(text) text
#define WORD 256

typedef struct Legacy {
  SporeVtkText text;
  bool binary, fifth; /* version 5: faces by offsets */
  SporeVtkSurface surface;
  SporeHelperFailure *failure;
} Legacy;

static void skip_line(SporeVtkText *text) {
  const char *end = text->at < text->end ? memchr(text->at, '\n', (size_t)(text->end - text->at)) : NULL;
  text->at = end ? end + 1 : text->end;
}

static bool read_word(Legacy *legacy, char word[WORD]) {
  return spore_vtk_word(&legacy->text, word, WORD) || spore_vtk_fail_short(legacy->failure);
}

/* Reads a number of items, each of which takes at least a byte. */
static bool read_count(Legacy *legacy, size_t *count) {
  double value;
  *count = 0;
  if (!spore_vtk_numbers(&legacy->text, &value, 1, legacy->failure)) return false;
  if (!(value >= 0 && value <= (double)(legacy->text.end - legacy->text.at)))
    return value >= 0 ? spore_vtk_fail_short(legacy->failure) : spore_vtk_fail_word(legacy->failure, "-");
  *count = (size_t)value;
  return true;
}

static bool read_type(Legacy *legacy, SporeVtkType *type) {
  char word[WORD];
  if (!read_word(legacy, word)) return false;
  *type = spore_vtk_type(word);
  return *type < SPORE_VTK_TYPES || spore_vtk_fail_word(legacy->failure, word);
}

/* Reads `count` numbers that follow the line that the text is in; free. values NULL: skips them. */
static bool read_values(Legacy *legacy, SporeVtkType type, size_t count, double **values) {
  SporeVtkText *text = &legacy->text;
  const size_t size = spore_vtk_bytes[type];
  double *kept = NULL;
  if (legacy->binary) skip_line(text);
  if (legacy->binary && count > (size_t)(text->end - text->at) / size) return spore_vtk_fail_short(legacy->failure);
  if (!(kept = spore_vtk_room(count, legacy->failure))) return false;
  bool done = legacy->binary || spore_vtk_numbers(text, kept, count, legacy->failure);
  for (size_t i = 0; i < count && legacy->binary; i++, text->at += size)
    kept[i] = spore_vtk_number(type, (const uint8_t *)text->at, true);
  if (values && done) *values = kept;
  else free(kept);
  return done;
}

static bool read_points(Legacy *legacy) {
  size_t count;
  SporeVtkType type;
  double *points = NULL;
  if (!read_count(legacy, &count) || !read_type(legacy, &type)) return false;
  if (count > SIZE_MAX / 3 || !read_values(legacy, type, 3 * count, &points)) return false;
  bool done = spore_vtk_add_points(&legacy->surface, points, count, legacy->failure);
  free(points);
  return done;
}

/* Faces up to version 4: each begins with its number of corners. */
static bool add_listed(Legacy *legacy, const double *list, size_t size, size_t faces, bool strips) {
  size_t at = 0;
  for (size_t f = 0; f < faces; f++) {
    if (at >= size || !(list[at] >= 0 && list[at] < (double)(size - at)))
      return spore_vtk_fail_word(legacy->failure, "POLYGONS");
    const size_t count = (size_t)list[at];
    if (!spore_vtk_add_face(&legacy->surface, 0, list + at + 1, count, strips, legacy->failure)) return false;
    at += 1 + count;
  }
  return true;
}

/* OFFSETS or CONNECTIVITY of version 5, with the type. */
static bool read_named(Legacy *legacy, const char *name, size_t count, double **values) {
  char word[WORD];
  SporeVtkType type;
  if (!read_word(legacy, word)) return false;
  if (strcasecmp(word, name) != 0) return spore_vtk_fail_word(legacy->failure, word);
  return read_type(legacy, &type) && read_values(legacy, type, count, values);
}

static bool read_faces(Legacy *legacy, bool surface, bool strips) {
  size_t count, size;
  double *ends = NULL, *corners = NULL;
  if (!read_count(legacy, &count) || !read_count(legacy, &size)) return false;
  bool done = legacy->fifth
                  ? read_named(legacy, "OFFSETS", count, &ends) && read_named(legacy, "CONNECTIVITY", size, &corners)
                  : read_values(legacy, SPORE_VTK_INT32, size, &corners);
  if (done && !surface) legacy->surface.passed_over += count - (legacy->fifth && count);
  else if (done && !legacy->fifth) done = add_listed(legacy, corners, size, count, strips);
  else if (done && count) /* the first offset is 0 */
    done = spore_vtk_add_faces(&legacy->surface, 0, corners, size, ends + 1, count - 1, strips, legacy->failure);
  free(ends);
  free(corners);
  return done;
}

/* Skips the arrays of a FIELD. */
static bool skip_fields(Legacy *legacy) {
  char word[WORD];
  size_t arrays, components, tuples;
  SporeVtkType type;
  if (!read_word(legacy, word) || !read_count(legacy, &arrays)) return false;
  for (size_t i = 0; i < arrays; i++) {
    if (!read_word(legacy, word)) return false;
    if (!read_count(legacy, &components) || !read_count(legacy, &tuples) || !read_type(legacy, &type)) return false;
    if (tuples && components > SIZE_MAX / tuples) return spore_vtk_fail_short(legacy->failure);
    if (!read_values(legacy, type, components * tuples, NULL)) return false;
  }
  return true;
}

/* METADATA reaches to the next blank line. */
static void skip_metadata(SporeVtkText *text) {
  do skip_line(text);
  while (text->at < text->end && *text->at != '\n' && *text->at != '\r');
}

static bool read_sections(Legacy *legacy) {
  char word[WORD];
  while (spore_vtk_word(&legacy->text, word, sizeof word)) {
    const bool strips = strcasecmp(word, "TRIANGLE_STRIPS") == 0, polygons = strcasecmp(word, "POLYGONS") == 0,
               others = strcasecmp(word, "VERTICES") == 0 || strcasecmp(word, "LINES") == 0;
    bool done = true;
    if (strcasecmp(word, "POINT_DATA") == 0 || strcasecmp(word, "CELL_DATA") == 0) break;
    if (strips || polygons || others) done = read_faces(legacy, !others, strips);
    else if (strcasecmp(word, "POINTS") == 0) done = read_points(legacy);
    else if (strcasecmp(word, "FIELD") == 0) done = skip_fields(legacy);
    else if (strcasecmp(word, "METADATA") == 0) skip_metadata(&legacy->text);
    else done = spore_vtk_fail_word(legacy->failure, word);
    if (!done) return false;
  }
  return true;
}

static bool read_head(Legacy *legacy) {
  char word[WORD];
  SporeVtkText line = legacy->text;
  for (int i = 0; i < 5; i++) spore_vtk_word(&line, word, sizeof word); /* "# vtk DataFile Version 5.1" */
  legacy->fifth = strtod(word, NULL) >= 5;
  skip_line(&legacy->text);
  skip_line(&legacy->text);
  if (!read_word(legacy, word)) return false;
  legacy->binary = strcasecmp(word, "BINARY") == 0;
  if (!legacy->binary && strcasecmp(word, "ASCII") != 0) return spore_vtk_fail_word(legacy->failure, word);
  if (!read_word(legacy, word)) return false;
  if (strcasecmp(word, "DATASET") != 0) return spore_vtk_fail_word(legacy->failure, word);
  if (!read_word(legacy, word)) return false;
  if (strcasecmp(word, "POLYDATA") == 0) return true;
  return spore_helper_fail(legacy->failure,
                           N_("the VTK file holds no surface; expected polygons (POLYDATA); extract the surface and "
                              "export it"),
                           "%.200s", word);
}

bool spore_vtk_legacy(const char *content, size_t size, void **answer, size_t *answer_size,
                      SporeHelperFailure *failure) {
  if (!size) content = ""; /* may be NULL */
  Legacy legacy = {.text = {content, content + size}, .failure = failure};
  bool done =
      read_head(&legacy) && read_sections(&legacy) && spore_vtk_answer(&legacy.surface, answer, answer_size, failure);
  spore_vtk_clear(&legacy.surface);
  return done;
}
