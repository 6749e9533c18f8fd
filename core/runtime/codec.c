/* Walks over structures by their tables of rows. One walk serves both ways, so that what is read is what was written.
 * Nothing that is read is trusted: counts are bounded by the bytes that are left before memory is asked for. */
#include "core/runtime/codec.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define LONGEST_TEXT 65536u
#define DEEPEST_COUNT (SIZE_MAX / 65536) /* no product of a count, a repeat and a size overflows below it */

void *spore_arena_allocate(SporeArena *arena, size_t count, size_t size) {
  void **blocks = spore_room_for_one(arena->blocks, arena->count, &arena->capacity, 64, sizeof *blocks);
  if (!blocks) return NULL;
  arena->blocks = blocks;
  void *block = spore_allocate(count, size);
  if (block) blocks[arena->count++] = block;
  return block;
}

void spore_arena_clear(SporeArena *arena) {
  for (size_t i = 0; i < arena->count; i++) spore_free(arena->blocks[i]);
  spore_free(arena->blocks);
  *arena = (SporeArena){0};
}

static bool no_memory(SporeCodec *codec) {
  return spore_error_set(codec->error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the runtime file"));
}

static bool damaged(SporeCodec *codec, const char *member) {
  return spore_error_set(codec->error, SPORE_ERROR_INPUT, NULL,
                         _("the file is damaged at byte %zu, in %s; expected what `spore export --format runtime` "
                           "writes; export the scene again"),
                         codec->at, member);
}

/* Bytes and numbers. */

static bool make_room(SporeCodec *codec, size_t size) {
  while (codec->size - codec->at < size) {
    size_t capacity = codec->size;
    uint8_t *bytes = spore_grow(codec->bytes, &capacity, 4096, 1);
    if (!bytes) return no_memory(codec);
    codec->bytes = bytes;
    codec->size = capacity;
  }
  return true;
}

static bool transfer(SporeCodec *codec, const char *member, void *memory, size_t size) {
  if (codec->writing) {
    if (!make_room(codec, size)) return false;
    if (size > 0) memcpy(codec->bytes + codec->at, memory, size);
  } else {
    if (codec->size - codec->at < size) return damaged(codec, member);
    if (size > 0) memcpy(memory, codec->source + codec->at, size);
  }
  codec->at += size;
  return true;
}

static bool transfer_reals(SporeCodec *codec, const char *member, double *reals, size_t count) {
  if (!transfer(codec, member, reals, count * sizeof *reals)) return false;
  for (size_t i = 0; !codec->writing && i < count; i++)
    if (!isfinite(reals[i])) return damaged(codec, member);
  return true;
}

static bool transfer_size(SporeCodec *codec, const char *member, size_t *size) {
  uint64_t wide = *size;
  if (!transfer(codec, member, &wide, sizeof wide)) return false;
  if (wide > DEEPEST_COUNT) return damaged(codec, member);
  *size = (size_t)wide;
  return true;
}

static bool transfer_flag(SporeCodec *codec, const char *member, bool *flag) {
  uint8_t byte = *flag ? 1 : 0;
  if (!transfer(codec, member, &byte, 1)) return false;
  if (byte > 1) return damaged(codec, member);
  *flag = byte == 1;
  return true;
}

static bool transfer_choice(SporeCodec *codec, const SporeRow *row, void *choice) {
  int32_t number;
  static_assert(sizeof(SporeRole) == sizeof number && sizeof(int) == sizeof number, "enums and choices are ints");
  memcpy(&number, choice, sizeof number);
  if (!transfer(codec, row->name, &number, sizeof number)) return false;
  if (number < row->least || number > row->most) return damaged(codec, row->name);
  memcpy(choice, &number, sizeof number);
  return true;
}

static bool transfer_bodies(SporeCodec *codec, const char *member, uint32_t *bodies, size_t count) {
  if (!transfer(codec, member, bodies, count * sizeof *bodies)) return false;
  for (size_t i = 0; !codec->writing && i < count; i++)
    if (bodies[i] != SPORE_NO_BODY && bodies[i] >= *codec->body_count) return damaged(codec, member);
  return true;
}

static bool transfer_text(SporeCodec *codec, const char *member, const char **text) {
  bool present = *text != NULL;
  size_t length = present ? strlen(*text) : 0;
  if (!transfer_flag(codec, member, &present)) return false;
  if (!present) return true;
  if (!transfer_size(codec, member, &length)) return false;
  if (codec->writing) return transfer(codec, member, (char *)*text, length);
  if (length > LONGEST_TEXT || length > codec->size - codec->at) return damaged(codec, member);
  char *copy = spore_arena_allocate(codec->arena, length + 1, 1);
  if (!copy) return no_memory(codec);
  *text = copy;
  return transfer(codec, member, copy, length) && (strlen(copy) == length || damaged(codec, member));
}

/* Parameters. */

static bool transfer_parameter(SporeCodec *codec, const SporeParameter *parameter, void *field) {
  switch (parameter->type) {
  case SPORE_REAL:
    return transfer_reals(codec, parameter->name, field, 1);
  case SPORE_VECTOR:
    return transfer_reals(codec, parameter->name, field, 3);
  case SPORE_INTEGER:
    return transfer(codec, parameter->name, field, sizeof(int64_t));
  case SPORE_BOOLEAN:
    return transfer_flag(codec, parameter->name, field);
  case SPORE_CHOICE:
    return transfer(codec, parameter->name, field, sizeof(int));
  default:
    return transfer_text(codec, parameter->name, field);
  }
}

/* Of numbers and choices; names are those of the scene's file, which nothing reads. */
static bool in_range(SporeCodec *codec, const SporeParameterTable *table, const void *fields) {
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (parameter->type >= SPORE_TEXT) continue;
    const SporeValue value = spore_parameter_load(parameter, fields);
    if (!spore_parameter_check(parameter, &value, codec->error)) return false;
  }
  return true;
}

static bool transfer_parameters(SporeCodec *codec, const char *member, const SporeParameterTable *table, void *fields) {
  const uint64_t expected = spore_parameters_signature(table);
  uint64_t signature = expected;
  if (!transfer(codec, member, &signature, sizeof signature)) return false;
  if (signature != expected)
    return spore_error_set(codec->error, SPORE_ERROR_UNSUPPORTED, NULL,
                           _("the file was written by a version of SPORE with other parameters, in %s; expected one "
                             "of the same version; export the scene again"),
                           member);
  for (size_t i = 0; i < table->count; i++)
    if (!transfer_parameter(codec, &table->parameters[i], (char *)fields + table->parameters[i].offset)) return false;
  return codec->writing || in_range(codec, table, fields);
}

/* Types by their names. */

static bool transfer_type(SporeCodec *codec, const SporeRow *row, const void **type) {
  const char *name = *type ? row->types->name(*type) : NULL;
  if (!transfer_text(codec, row->name, &name)) return false;
  if (codec->writing || !name) return true;
  *type = row->types->find(codec->registry, name);
  return *type || spore_error_set(codec->error, SPORE_ERROR_UNSUPPORTED, NULL,
                                  _("the file names the kind \"%.100s\", which this program does not have; expected "
                                    "one that it has; link that or export the scene again"),
                                  name);
}

/* The type in the first member. */
static const void *type_of(const SporeRowTable *table, const void *structure) {
  const void *type;
  assert(table->rows[0].kind == SPORE_ROW_TYPE && table->rows[0].offset == 0);
  memcpy(&type, structure, sizeof type);
  return type;
}

static bool transfer_type_values(SporeCodec *codec, const SporeRow *row, const void *type, void *fields) {
  return !type || transfer_parameters(codec, row->name, row->types->parameters(type), fields);
}

static bool transfer_type_fields(SporeCodec *codec, const SporeRow *row, const void *type, void **fields) {
  if (!type) return true;
  const SporeParameterTable *table = row->types->parameters(type);
  if (!codec->writing) *fields = spore_arena_allocate(codec->arena, table->size > 0 ? table->size : 1, 1);
  return *fields ? transfer_parameters(codec, row->name, table, *fields) : no_memory(codec);
}

/* Pointers. */

/* The fewest bytes that an element takes in the file: what bounds a count. */
static size_t least_bytes(const SporeRowTable *table) {
  size_t bytes = 0;
  for (size_t i = 0; i < table->count; i++) {
    const SporeRow *row = &table->rows[i];
    switch (row->kind) {
    case SPORE_ROW_SKIPPED:
    case SPORE_ROW_OPTION:
    case SPORE_ROW_TYPE_FIELDS:
    case SPORE_ROW_TYPE_VALUES:
      break;
    case SPORE_ROW_REALS:
      bytes += row->repeat * sizeof(double);
      break;
    case SPORE_ROW_RECORD:
      bytes += least_bytes(row->table);
      break;
    default:
      bytes += 1;
    }
  }
  return bytes > 0 ? bytes : 1;
}

static bool transfer_elements(SporeCodec *codec, const SporeRow *row, void *elements, size_t count) {
  if (row->element == SPORE_ROW_REAL) return transfer_reals(codec, row->name, elements, count);
  if (row->element == SPORE_ROW_WORD) return transfer(codec, row->name, elements, count * sizeof(uint32_t));
  assert(row->element == SPORE_ROW_RECORD);
  for (size_t i = 0; i < count; i++)
    if (!spore_codec_record(codec, row->table, (char *)elements + i * row->table->size)) return false;
  return true;
}

static bool transfer_pointer(SporeCodec *codec, const SporeRow *row, const void *structure, void **pointer) {
  bool present = *pointer != NULL;
  if (!transfer_flag(codec, row->name, &present)) return false;
  size_t count = 1, size = row->element == SPORE_ROW_RECORD ? row->table->size
                           : row->element == SPORE_ROW_REAL ? sizeof(double)
                                                            : sizeof(uint32_t);
  if (row->count != SPORE_ROW_ONCE) memcpy(&count, (const char *)structure + row->count, sizeof count);
  if (!present) return true;
  if (!codec->writing) {
    size_t least = row->element == SPORE_ROW_RECORD ? least_bytes(row->table) : size;
    if (count > (codec->size - codec->at) / (least * row->repeat)) return damaged(codec, row->name);
    *pointer = spore_arena_allocate(codec->arena, count * row->repeat, size);
    if (!*pointer) return no_memory(codec);
  }
  return transfer_elements(codec, row, *pointer, count * row->repeat);
}

/* Records. */

static bool transfer_row(SporeCodec *codec, const SporeRowTable *table, const SporeRow *row, void *structure) {
  void *member = (char *)structure + row->offset;
  switch (row->kind) {
  case SPORE_ROW_SKIPPED:
  case SPORE_ROW_OPTION:
    return true;
  case SPORE_ROW_REAL:
    return transfer_reals(codec, row->name, member, 1);
  case SPORE_ROW_REALS:
    return transfer_reals(codec, row->name, member, row->repeat);
  case SPORE_ROW_WORD:
    return transfer(codec, row->name, member, sizeof(uint32_t));
  case SPORE_ROW_WIDE:
    return transfer(codec, row->name, member, sizeof(uint64_t));
  case SPORE_ROW_SIZE:
    return transfer_size(codec, row->name, member);
  case SPORE_ROW_CHOICE:
    return transfer_choice(codec, row, member);
  case SPORE_ROW_FLAG:
    return transfer_flag(codec, row->name, member);
  case SPORE_ROW_BODY:
    return transfer_bodies(codec, row->name, member, 1);
  case SPORE_ROW_BODIES:
    return transfer_bodies(codec, row->name, member, row->repeat);
  case SPORE_ROW_TEXT:
    return transfer_text(codec, row->name, member);
  case SPORE_ROW_RECORD:
    return spore_codec_record(codec, row->table, member);
  case SPORE_ROW_FIELDS:
    return transfer_parameters(codec, row->name, row->parameters, member);
  case SPORE_ROW_TYPE:
    return transfer_type(codec, row, member);
  case SPORE_ROW_TYPE_FIELDS:
    return transfer_type_fields(codec, row, type_of(table, structure), member);
  case SPORE_ROW_TYPE_VALUES:
    return transfer_type_values(codec, row, type_of(table, structure), member);
  case SPORE_ROW_POINTER:
    return transfer_pointer(codec, row, structure, member);
  }
  return false;
}

bool spore_codec_record(SporeCodec *codec, const SporeRowTable *table, void *structure) {
  for (size_t i = 0; i < table->count; i++) {
    assert(i == 0 || table->rows[i].offset > table->rows[i - 1].offset); /* each member once */
    if (!transfer_row(codec, table, &table->rows[i], structure)) return false;
  }
  return true;
}
