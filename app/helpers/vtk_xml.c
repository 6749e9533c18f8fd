/* The XML format of VTK, PolyData. It is read tag by tag. Nothing is expanded, and a DOCTYPE is refused. */
#include <stdlib.h>
#include <string.h>

#include "app/helpers/vtk.h"

#define N_(text) text
#define VALUE 128                      /* of an attribute, at most */
#define MOST_BYTES ((uint64_t)1 << 30) /* of one array */

typedef struct Tag {
  const char *name, *end; /* from the name to '>' */
  size_t length;          /* of the name */
} Tag;

typedef struct Array {
  double *values;
  size_t count;
} Array;

enum { NO_SECTION = -1, POINTS, POLYS, STRIPS, SECTIONS };

typedef struct Xml {
  const char *at, *end;
  const char *appended; /* the first of the appended data; NULL: there are none */
  bool raw;             /* they are bytes, else base64 */
  bool big, wide, compressed;
  int section; /* that the tags lie in */
  Array points, corners[SECTIONS], ends[SECTIONS];
  SporeVtkSurface surface;
  SporeHelperFailure *failure;
} Xml;

/* Goes to the next tag. Comments and processing instructions are passed over. */
static bool next_tag(Xml *xml, Tag *tag) {
  for (;;) {
    const char *open = memchr(xml->at, '<', (size_t)(xml->end - xml->at));
    if (!open || xml->end - open < 2) return false;
    const bool comment = xml->end - open >= 4 && memcmp(open, "<!--", 4) == 0;
    const char *close = comment ? memmem(open, (size_t)(xml->end - open), "-->", 3) : NULL;
    char quote = 0;
    if (!comment)
      for (close = open + 1; close < xml->end && (quote || *close != '>'); close++)
        quote = quote ? (*close == quote ? 0 : quote) : *close == '"' || *close == '\'' ? *close : 0;
    if (!close || close >= xml->end) return false;
    xml->at = close + 1;
    if (comment || open[1] == '?') continue;
    *tag = (Tag){open + 1, close, 0};
    while (tag->name + tag->length < close && !strchr(" \t\r\n/", tag->name[tag->length])) tag->length++;
    if (*tag->name == '/') tag->length = 1 + strcspn(tag->name + 1, " \t\r\n>");
    return true;
  }
}

static bool is(const Tag *tag, const char *name) {
  return tag->length == strlen(name) && memcmp(tag->name, name, tag->length) == 0;
}

/* Copies the value of an attribute; "" where the tag has none. */
static const char *attribute(const Tag *tag, const char *name, char value[VALUE]) {
  const size_t length = strlen(name);
  value[0] = '\0';
  for (const char *at = tag->name + tag->length; at + length + 2 < tag->end; at++) {
    if (!strchr(" \t\r\n", at[-1]) || memcmp(at, name, length) != 0) continue;
    const char *start = at + length;
    while (start < tag->end && strchr(" \t\r\n=", *start)) start++;
    const char *close = start < tag->end ? memchr(start + 1, *start, (size_t)(tag->end - start - 1)) : NULL;
    if ((*start != '"' && *start != '\'') || !close || close - start > VALUE) continue;
    memcpy(value, start + 1, (size_t)(close - start - 1));
    value[close - start - 1] = '\0';
    break;
  }
  return value;
}

static uint64_t head_number(const Xml *xml, const uint8_t *bytes, size_t i) {
  const SporeVtkType type = xml->wide ? SPORE_VTK_UINT64 : SPORE_VTK_UINT32;
  const double value = spore_vtk_number(type, bytes + i * spore_vtk_bytes[type], xml->big);
  return value < 1e15 ? (uint64_t)value : UINT64_MAX / 4;
}

static bool take_numbers(const Xml *xml, SporeVtkType type, const uint8_t *bytes, size_t size, Array *array) {
  const size_t each = spore_vtk_bytes[type];
  array->count = size / each;
  array->values = spore_vtk_room(array->count, xml->failure);
  for (size_t i = 0; array->values && i < array->count; i++)
    array->values[i] = spore_vtk_number(type, bytes + i * each, xml->big);
  return array->values != NULL;
}

/* Blocks: their number, their size, that of the last if it is smaller, and the compressed size of each. */
static bool inflate_blocks(const Xml *xml, SporeVtkType type, const uint8_t *bytes, size_t size, Array *array) {
  const size_t word = xml->wide ? 8 : 4;
  if (size < word) return spore_vtk_fail_short(xml->failure);
  const uint64_t blocks = head_number(xml, bytes, 0);
  if (!blocks) return take_numbers(xml, type, bytes, 0, array);
  if (blocks > size / word || (3 + blocks) * word > size) return spore_vtk_fail_short(xml->failure);
  const uint64_t block = head_number(xml, bytes, 1), last = head_number(xml, bytes, 2);
  if (block > MOST_BYTES || last > block || blocks * block > MOST_BYTES)
    return spore_vtk_fail_word(xml->failure, "size");
  const size_t whole = (size_t)((blocks - 1) * block + (last ? last : block));
  uint8_t *plain = (uint8_t *)spore_vtk_room(whole / 8 + 1, xml->failure);
  bool done = plain != NULL;
  size_t at = (size_t)(3 + blocks) * word;
  for (uint64_t b = 0; done && b < blocks; b++) {
    const uint64_t packed = head_number(xml, bytes, 3 + (size_t)b);
    const size_t open = b + 1 == blocks && last ? (size_t)last : (size_t)block;
    done = packed <= size - at ? spore_vtk_inflate(bytes + at, (size_t)packed, plain + b * block, open, xml->failure)
                               : spore_vtk_fail_short(xml->failure);
    at += done ? (size_t)packed : 0;
  }
  done = done && take_numbers(xml, type, plain, whole, array);
  free(plain);
  return done;
}

/* Data of an array, after their head. */
static bool read_block(const Xml *xml, SporeVtkType type, const uint8_t *bytes, size_t size, Array *array) {
  const size_t word = xml->wide ? 8 : 4;
  if (xml->compressed) return inflate_blocks(xml, type, bytes, size, array);
  if (size < word) return spore_vtk_fail_short(xml->failure);
  const uint64_t said = head_number(xml, bytes, 0);
  if (said > size - word) return spore_vtk_fail_short(xml->failure);
  return take_numbers(xml, type, bytes + word, (size_t)said, array);
}

static bool read_base64(const Xml *xml, SporeVtkType type, const char *from, const char *end, Array *array) {
  uint8_t *bytes;
  size_t size;
  if (!spore_vtk_base64(from, (size_t)(end - from), &bytes, &size, xml->failure)) return false;
  const bool done = read_block(xml, type, bytes, size, array);
  free(bytes);
  return done;
}

static bool read_ascii(const Xml *xml, const char *end, Array *array) {
  SporeVtkText text = {xml->at, end}, counted = text;
  char word[64];
  while (spore_vtk_word(&counted, word, sizeof word)) array->count++;
  array->values = spore_vtk_room(array->count, xml->failure);
  return array->values && spore_vtk_numbers(&text, array->values, array->count, xml->failure);
}

static bool read_appended(const Xml *xml, const Tag *tag, SporeVtkType type, Array *array) {
  char value[VALUE];
  const double offset = strtod(attribute(tag, "offset", value), NULL);
  if (!xml->appended || !(offset >= 0 && offset <= (double)(xml->end - xml->appended)))
    return spore_vtk_fail_short(xml->failure);
  const char *from = xml->appended + (size_t)offset;
  return xml->raw ? read_block(xml, type, (const uint8_t *)from, (size_t)(xml->end - from), array)
                  : read_base64(xml, type, from, xml->end, array);
}

/* The text behind the tag, up to the next tag, or what the tag says of the appended data. */
static bool read_array(Xml *xml, const Tag *tag, Array *array) {
  char value[VALUE], format[VALUE];
  const SporeVtkType type = spore_vtk_type(attribute(tag, "type", value));
  if (type == SPORE_VTK_TYPES || array->values) return spore_vtk_fail_word(xml->failure, value);
  attribute(tag, "format", format);
  const char *close = memchr(xml->at, '<', (size_t)(xml->end - xml->at));
  if (!close) return spore_vtk_fail_short(xml->failure);
  if (strcmp(format, "appended") == 0) return read_appended(xml, tag, type, array);
  if (strcmp(format, "ascii") == 0) return read_ascii(xml, close, array);
  return strcmp(format, "binary") == 0 ? read_base64(xml, type, xml->at, close, array)
                                       : spore_vtk_fail_word(xml->failure, format);
}

static void clear_piece(Xml *xml) {
  free(xml->points.values);
  xml->points = (Array){0};
  for (int s = 0; s < SECTIONS; s++) {
    free(xml->corners[s].values);
    free(xml->ends[s].values);
    xml->corners[s] = xml->ends[s] = (Array){0};
  }
}

/* Adds what a piece holds to the surface. */
static bool end_piece(Xml *xml) {
  const size_t first = xml->surface.vertex_count;
  bool done = spore_vtk_add_points(&xml->surface, xml->points.values, xml->points.count / 3, xml->failure);
  for (int s = POLYS; s <= STRIPS && done; s++)
    done = spore_vtk_add_faces(&xml->surface, first, xml->corners[s].values, xml->corners[s].count, xml->ends[s].values,
                               xml->ends[s].count, s == STRIPS, xml->failure);
  clear_piece(xml);
  return done;
}

static void enter(Xml *xml, const Tag *tag) {
  static const struct {
    const char *open, *close;
    int section;
  } sections[] = {{"Points", "/Points", POINTS}, {"Polys", "/Polys", POLYS}, {"Strips", "/Strips", STRIPS}};
  for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
    if (is(tag, sections[i].open)) xml->section = sections[i].section;
    if (is(tag, sections[i].close)) xml->section = NO_SECTION;
  }
}

/* The array of a section that a surface is made of. NULL: it is some other array. */
static Array *array_of(Xml *xml, const Tag *tag) {
  char name[VALUE];
  attribute(tag, "Name", name);
  if (xml->section == POINTS) return &xml->points;
  if (xml->section == NO_SECTION) return NULL;
  if (strcmp(name, "connectivity") == 0) return &xml->corners[xml->section];
  return strcmp(name, "offsets") == 0 ? &xml->ends[xml->section] : NULL;
}

static bool read_piece_tags(Xml *xml) {
  Tag tag;
  char value[VALUE];
  while (next_tag(xml, &tag) && !is(&tag, "AppendedData")) {
    bool done = true;
    enter(xml, &tag);
    Array *array = is(&tag, "DataArray") ? array_of(xml, &tag) : NULL;
    if (array) done = read_array(xml, &tag, array);
    else if (is(&tag, "Piece")) {
      xml->surface.passed_over += (size_t)strtoul(attribute(&tag, "NumberOfVerts", value), NULL, 10) % MOST_BYTES;
      xml->surface.passed_over += (size_t)strtoul(attribute(&tag, "NumberOfLines", value), NULL, 10) % MOST_BYTES;
    } else if (is(&tag, "/Piece")) done = end_piece(xml);
    if (!done) return false;
  }
  return true;
}

/* What the first tag says, and where the appended data begin. */
static bool read_head(Xml *xml) {
  Tag tag;
  char value[VALUE];
  bool found = false;
  while (next_tag(xml, &tag)) {
    if (*tag.name == '!') return spore_vtk_fail_word(xml->failure, "<!");
    if (is(&tag, "VTKFile") && !found) {
      found = true;
      if (strcmp(attribute(&tag, "type", value), "PolyData") != 0)
        return spore_helper_fail(xml->failure,
                                 N_("the VTK file holds no surface; expected polygons (POLYDATA); extract the surface "
                                    "and export it"),
                                 "%s", value);
      xml->big = strcmp(attribute(&tag, "byte_order", value), "BigEndian") == 0;
      xml->wide = strcmp(attribute(&tag, "header_type", value), "UInt64") == 0;
      xml->compressed = *attribute(&tag, "compressor", value) != '\0';
      if (xml->compressed && strcmp(value, "vtkZLibDataCompressor") != 0)
        return spore_vtk_fail_compression(xml->failure, value);
    }
    if (!is(&tag, "AppendedData")) continue;
    xml->raw = strcmp(attribute(&tag, "encoding", value), "base64") != 0;
    const char *mark = memchr(xml->at, '_', (size_t)(xml->end - xml->at));
    xml->appended = mark ? mark + 1 : NULL;
    break;
  }
  return found || spore_vtk_fail_word(xml->failure, "VTKFile");
}

bool spore_vtk_xml(const char *content, size_t size, void **answer, size_t *answer_size, SporeHelperFailure *failure) {
  if (!size) content = ""; /* may be NULL */
  Xml xml = {.at = content, .end = content + size, .section = NO_SECTION, .failure = failure};
  bool done = read_head(&xml);
  xml.at = content;
  done = done && read_piece_tags(&xml) && spore_vtk_answer(&xml.surface, answer, answer_size, failure);
  clear_piece(&xml);
  spore_vtk_clear(&xml.surface);
  return done;
}
