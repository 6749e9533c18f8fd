/* Numbers of VTK files: words, bytes of either order, base64 and zlib. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/helpers/vtk.h"

#if SPORE_HAVE_ZLIB
#include <zlib.h>
#endif

#define N_(text) text

const size_t spore_vtk_bytes[SPORE_VTK_TYPES] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

SporeVtkType spore_vtk_type(const char *name) {
  static const char *const names[SPORE_VTK_TYPES][4] = {{"char", "Int8", "signed_char"},
                                                        {"unsigned_char", "UInt8"},
                                                        {"short", "Int16"},
                                                        {"unsigned_short", "UInt16"},
                                                        {"int", "Int32", "vtkIdType"},
                                                        {"unsigned_int", "UInt32"},
                                                        {"long", "Int64", "vtktypeint64"},
                                                        {"unsigned_long", "UInt64", "vtktypeuint64"},
                                                        {"float", "Float32"},
                                                        {"double", "Float64"}};
  for (int type = 0; type < SPORE_VTK_TYPES; type++)
    for (int i = 0; i < 4 && names[type][i]; i++)
      if (strcasecmp(name, names[type][i]) == 0) return (SporeVtkType)type;
  return SPORE_VTK_TYPES;
}

double spore_vtk_number(SporeVtkType type, const uint8_t *bytes, bool big) {
  uint64_t bits = 0;
  const size_t size = spore_vtk_bytes[type];
  for (size_t i = 0; i < size; i++) bits = bits << 8 | bytes[big ? i : size - 1 - i];
  const uint32_t half = (uint32_t)bits;
  float narrow;
  double wide;
  switch (type) {
  case SPORE_VTK_INT8:
    return (int8_t)bits;
  case SPORE_VTK_INT16:
    return (int16_t)bits;
  case SPORE_VTK_INT32:
    return (int32_t)bits;
  case SPORE_VTK_INT64:
    return (double)(int64_t)bits;
  case SPORE_VTK_FLOAT:
    memcpy(&narrow, &half, sizeof narrow);
    return narrow;
  case SPORE_VTK_DOUBLE:
    memcpy(&wide, &bits, sizeof wide);
    return wide;
  default:
    return (double)bits;
  }
}

static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool spore_vtk_word(SporeVtkText *text, char *word, size_t room) {
  size_t length = 0;
  while (text->at < text->end && is_space(*text->at)) text->at++;
  for (; text->at < text->end && !is_space(*text->at); text->at++)
    if (length + 1 < room) word[length++] = *text->at;
  word[length] = '\0';
  return length > 0;
}

bool spore_vtk_numbers(SporeVtkText *text, double *values, size_t count, SporeHelperFailure *failure) {
  char word[64], *end;
  for (size_t i = 0; i < count; i++) {
    if (!spore_vtk_word(text, word, sizeof word)) return spore_vtk_fail_short(failure);
    values[i] = strtod(word, &end);
    if (*end) return spore_vtk_fail_word(failure, word);
  }
  return true;
}

double *spore_vtk_room(size_t count, SporeHelperFailure *failure) {
  double *room = count < SIZE_MAX / 16 ? malloc((count + 1) * sizeof *room) : NULL;
  if (room) return room;
  failure->code = SPORE_ERROR_MEMORY;
  failure->message = N_("the mesh needs more memory than it may have; expected a smaller one; decimate it first");
  failure->detail[0] = '\0';
  return NULL;
}

bool spore_vtk_fail_short(SporeHelperFailure *failure) {
  return spore_helper_fail(failure, N_("the VTK file is cut short; expected the whole file; copy or export it again"),
                           "%s", "");
}

bool spore_vtk_fail_word(SporeHelperFailure *failure, const char *word) {
  return spore_helper_fail(failure,
                           N_("the VTK file says what cannot be read; expected a surface of polygons; export it again"),
                           "%.200s", word);
}

static int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool spore_vtk_base64(const char *text, size_t most, uint8_t **result, size_t *result_size,
                      SporeHelperFailure *failure) {
  uint32_t bits = 0;
  int have = 0;
  *result_size = 0;
  *result = (uint8_t *)spore_vtk_room(most / 8 + 1, failure);
  if (!*result) return false;
  for (size_t i = 0; i < most; i++) {
    const int digit = digit_of(text[i]);
    if (text[i] == '=') have = 0; /* the end of one stream */
    else if (digit < 0 && !is_space(text[i])) break;
    if (digit < 0) continue;
    bits = bits << 6 | (uint32_t)digit;
    have += 6;
    if (have < 8) continue;
    have -= 8;
    (*result)[(*result_size)++] = (uint8_t)(bits >> have);
  }
  return true;
}

bool spore_vtk_fail_compression(SporeHelperFailure *failure, const char *name) {
  spore_helper_fail(failure,
                    N_("its data are compressed in a way that is not read here; expected plain data, or zlib in a "
                       "build that has it; export it again without compression"),
                    "%.200s", name);
  failure->code = SPORE_ERROR_UNSUPPORTED;
  return false;
}

#if SPORE_HAVE_ZLIB
bool spore_vtk_inflate(const uint8_t *from, size_t from_size, uint8_t *into, size_t size, SporeHelperFailure *failure) {
  uLongf filled = size;
  if (uncompress(into, &filled, from, from_size) == Z_OK && filled == size) return true;
  return spore_helper_fail(
      failure, N_("its compressed data are cut short or damaged; expected whole blocks of zlib; export it again"), "%s",
      "");
}
#else
bool spore_vtk_inflate(const uint8_t *from, size_t from_size, uint8_t *into, size_t size, SporeHelperFailure *failure) {
  return spore_vtk_fail_compression(failure, "zlib");
}
#endif
