/* NRRD with attached data: "Definition of NRRD file format", teem.sourceforge.net/nrrd/format.html. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/helpers/volume.h"

#define N_(text) text
#define LINE 1024

typedef struct Fields {
  bool sized, spaced, directed;
  int dimension;
  double spacing[3], direction[9], origin[3]; /* direction: a column a voxel axis */
  int signs[3];                               /* of the space's axes, to right, front, up */
  double unit_m;
  bool big, endian_said, encoded;
} Fields;

static bool fail_field(SporeHelperFailure *failure, const char *line) {
  return spore_helper_fail(failure,
                           N_("its header says what cannot be read or cannot be; expected the fields of one "
                              "volume of labels; save it again"),
                           "%.200s", line);
}

static bool one_of(const char *text, const char *const *names) {
  for (; *names; names++)
    if (strcasecmp(text, *names) == 0) return true;
  return false;
}

static bool take_type(const char *text, SporeVoxelType *type) {
  static const char *const names[SPORE_VOXEL_TYPES][8] = {
      {"uchar", "unsigned char", "uint8", "uint8_t"},
      {"signed char", "int8", "int8_t"},
      {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"},
      {"short", "short int", "signed short", "signed short int", "int16", "int16_t"},
      {"uint", "unsigned int", "uint32", "uint32_t"},
      {"int", "signed int", "int32", "int32_t"},
      {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"},
      {"longlong", "long long", "long long int", "signed long long", "int64", "int64_t"},
      {"float"},
      {"double"}};
  for (int i = 0; i < SPORE_VOXEL_TYPES; i++)
    if (one_of(text, names[i])) {
      *type = (SporeVoxelType)i;
      return true;
    }
  return false;
}

/* The space states where the three axes point; each axis by its first letter. */
static bool take_space(const char *text, int signs[3]) {
  static const struct {
    const char *names[3];
    int signs[3];
  } known[] = {{{"right-anterior-superior", "RAS"}, {1, 1, 1}},
               {{"left-anterior-superior", "LAS"}, {-1, 1, 1}},
               {{"left-posterior-superior", "LPS"}, {-1, -1, 1}}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (one_of(text, known[i].names)) {
      memcpy(signs, known[i].signs, sizeof known[i].signs);
      return true;
    }
  return false;
}

/* Reads `count` numbers; skips brackets and commas. */
static bool take_numbers(const char *text, double *numbers, int count) {
  for (int i = 0; i < count; i++) {
    text += strspn(text, " \t(),");
    char *end;
    numbers[i] = strtod(text, &end);
    if (end == text) return false;
    text = end;
  }
  return text[strspn(text, " \t(),")] == '\0';
}

static bool take_sizes(const char *text, uint64_t size[3]) {
  double numbers[3];
  if (!take_numbers(text, numbers, 3)) return false;
  for (int i = 0; i < 3; i++) {
    if (!(numbers[i] >= 1 && numbers[i] <= (double)SPORE_VOLUME_VOXELS) || numbers[i] != floor(numbers[i]))
      return false;
    size[i] = (uint64_t)numbers[i];
  }
  return true;
}

static bool take_unit(const char *text, double *unit_m) {
  static const char *const mm[] = {"\"mm\"", "mm", NULL}, *const m[] = {"\"m\"", "m", NULL};
  char first[16];
  if (sscanf(text, "%15s", first) != 1) return false;
  if (one_of(first, mm)) *unit_m = 1e-3;
  else if (one_of(first, m)) *unit_m = 1;
  else return false;
  return true;
}

static bool take_field(const char *name, const char *value, Fields *fields, SporeVolumeHead *head) {
  if (strcasecmp(name, "type") == 0) return take_type(value, &head->type);
  if (strcasecmp(name, "dimension") == 0) return sscanf(value, "%d", &fields->dimension) == 1 && fields->dimension == 3;
  if (strcasecmp(name, "sizes") == 0) return fields->sized = take_sizes(value, head->answer.size);
  if (strcasecmp(name, "spacings") == 0) return fields->spaced = take_numbers(value, fields->spacing, 3);
  if (strcasecmp(name, "space directions") == 0) return fields->directed = take_numbers(value, fields->direction, 9);
  if (strcasecmp(name, "space origin") == 0) return take_numbers(value, fields->origin, 3);
  if (strcasecmp(name, "space") == 0) return take_space(value, fields->signs);
  if (strcasecmp(name, "space units") == 0) return take_unit(value, &fields->unit_m);
  if (strcasecmp(name, "endian") == 0) {
    fields->endian_said = true;
    fields->big = strcasecmp(value, "big") == 0;
    return fields->big || strcasecmp(value, "little") == 0;
  }
  if (strcasecmp(name, "encoding") == 0) {
    fields->encoded = true;
    head->compressed = strcasecmp(value, "gzip") == 0 || strcasecmp(value, "gz") == 0;
    return head->compressed || strcasecmp(value, "raw") == 0;
  }
  /* Fields for data in another file, or not directly behind the header, are refused. */
  return !(strcasecmp(name, "data file") == 0 || strcasecmp(name, "datafile") == 0 ||
           strcasecmp(name, "line skip") == 0 || strcasecmp(name, "byte skip") == 0 ||
           strcasecmp(name, "block size") == 0);
}

/* The next line, without its end, cut at LINE; false: there is none. */
static bool next_line(const uint8_t *bytes, size_t size, size_t *at, char line[LINE]) {
  const uint8_t *end = *at < size ? memchr(bytes + *at, '\n', size - *at) : NULL;
  if (!end) return false;
  size_t length = (size_t)(end - bytes) - *at, kept = length < LINE - 1 ? length : LINE - 1;
  memcpy(line, bytes + *at, kept);
  if (kept && line[kept - 1] == '\r') kept--;
  line[kept] = '\0';
  *at += length + 1;
  return true;
}

static bool read_line(char *line, Fields *fields, SporeVolumeHead *head, SporeHelperFailure *failure) {
  if (line[0] == '#' || strstr(line, ":=")) return true; /* comments, and private fields of programs */
  char whole_line[LINE], *colon = strstr(line, ": ");
  memcpy(whole_line, line, sizeof whole_line);
  if (!colon) return fail_field(failure, whole_line);
  *colon = '\0';
  char *value = colon + 2 + strspn(colon + 2, " \t");
  for (size_t n = strlen(value); n && (value[n - 1] == ' ' || value[n - 1] == '\t'); n--) value[n - 1] = '\0';
  return take_field(line, value, fields, head) || fail_field(failure, whole_line);
}

static void make_axes(const Fields *fields, double axes[12]) {
  for (int row = 0; row < 3; row++) {
    double scale = fields->signs[row] * fields->unit_m;
    for (int k = 0; k < 3; k++)
      axes[4 * row + k] = scale * (fields->directed ? fields->direction[3 * k + row]
                                   : row == k       ? fields->spacing[k]
                                                    : 0);
    axes[4 * row + 3] = scale * fields->origin[row];
  }
}

bool spore_nrrd_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure) {
  Fields fields = {.spacing = {1, 1, 1}, .signs = {1, 1, 1}, .unit_m = 1e-3};
  char line[LINE] = "";
  size_t at = 0;
  *head = (SporeVolumeHead){.slope = 1, .type = SPORE_VOXEL_TYPES};
  if (!next_line(bytes, size, &at, line)) return fail_field(failure, "NRRD");
  while (next_line(bytes, size, &at, line) && *line)
    if (!read_line(line, &fields, head, failure)) return false;
  if (*line)
    return spore_helper_fail(failure, N_("the NRRD file is cut short; expected the whole file; copy it again"), "%s",
                             "");
  bool wide = head->type < SPORE_VOXEL_TYPES && spore_voxel_bytes[head->type] > 1;
  if (head->type == SPORE_VOXEL_TYPES || !fields.sized || !fields.dimension || !fields.encoded ||
      (wide && !fields.endian_said))
    return fail_field(failure, head->type == SPORE_VOXEL_TYPES ? "type: ?"
                               : !fields.sized                 ? "sizes: ?"
                               : !fields.dimension             ? "dimension: ?"
                               : !fields.encoded               ? "encoding: ?"
                                                               : "endian: ?");
  head->swapped = fields.big != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__) && wide;
  make_axes(&fields, head->answer.axes);
  head->data = at;
  return true;
}
