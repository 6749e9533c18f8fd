/* Rows of a measurement, as CSV and as JSON. */
#include "core/measure/numbers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/text_buffer.h"

#define FIRST_ROWS 256

static size_t width(const SporeNumbers *numbers) {
  size_t count;
  spore_measurement_columns(numbers->measurement, &count);
  return count;
}

/* Room for another row; NULL: no memory. */
static double *new_row(SporeNumbers *numbers) {
  size_t columns = width(numbers);
  double *values =
      spore_room_for_one(numbers->values, numbers->row_count, &numbers->capacity, FIRST_ROWS, columns * sizeof *values);
  if (!values) return NULL;
  numbers->values = values;
  return values + columns * numbers->row_count++;
}

bool spore_numbers_add(SporeNumbers *numbers) {
  double *row = new_row(numbers);
  if (row) spore_measurement_take(numbers->measurement, row);
  return row != NULL;
}

bool spore_numbers_add_row(SporeNumbers *numbers, const double *values) {
  double *row = new_row(numbers);
  if (row) memcpy(row, values, width(numbers) * sizeof *row);
  return row != NULL;
}

void spore_numbers_thin(SporeNumbers *numbers) {
  size_t columns = width(numbers), kept = (numbers->row_count + 1) / 2;
  for (size_t i = 1; i < kept; i++)
    memcpy(numbers->values + columns * i, numbers->values + columns * 2 * i, columns * sizeof *numbers->values);
  numbers->row_count = kept;
}

void spore_numbers_clear(SporeNumbers *numbers) {
  spore_free(numbers->values);
  *numbers = (SporeNumbers){.measurement = numbers->measurement};
}

static char *finish(SporeTextBuffer *text, size_t *size) {
  *size = text->size;
  if (!text->failed) return text->bytes;
  spore_free(text->bytes);
  return NULL;
}

/* A field in quotes where it needs them. */
static void add_field(SporeTextBuffer *text, const char *name, const char *unit) {
  bool quoted = strpbrk(name, ",\"\r\n") != NULL;
  if (quoted) spore_text_add(text, "\"");
  for (; *name; name++) spore_text_add_bytes(text, *name == '"' ? "\"\"" : name, *name == '"' ? 2 : 1);
  if (*unit) {
    spore_text_add(text, " [");
    spore_text_add(text, unit);
    spore_text_add(text, "]");
  }
  if (quoted) spore_text_add(text, "\"");
}

char *spore_numbers_csv(const SporeNumbers *numbers, size_t *size) {
  SporeTextBuffer text = {0};
  size_t count;
  const SporeColumn *columns = spore_measurement_columns(numbers->measurement, &count);
  for (size_t c = 0; c < count; c++) {
    if (c > 0) spore_text_add(&text, ",");
    add_field(&text, columns[c].name, columns[c].unit);
  }
  spore_text_add(&text, "\r\n");
  for (size_t i = 0; i < numbers->row_count * count; i++) {
    spore_text_add_number(&text, numbers->values[i]);
    spore_text_add(&text, (i + 1) % count == 0 ? "\r\n" : ",");
  }
  return finish(&text, size);
}

static void add_string(SporeTextBuffer *text, const char *string) {
  spore_text_add(text, "\"");
  for (; *string; string++) {
    char escaped[8];
    if ((unsigned char)*string < ' ' || *string == '"' || *string == '\\') {
      snprintf(escaped, sizeof escaped, "\\u%04x", (unsigned)*string);
      spore_text_add(text, escaped);
    } else {
      spore_text_add_bytes(text, string, 1);
    }
  }
  spore_text_add(text, "\"");
}

static void add_json_number(SporeTextBuffer *text, double value) {
  if (isfinite(value)) spore_text_add_number(text, value);
  else spore_text_add(text, "null");
}

static void add_json_columns(SporeTextBuffer *text, const SporeColumn *columns, size_t count) {
  for (size_t c = 0; c < count; c++) {
    spore_text_add(text, c > 0 ? ",\n    {\"name\": " : "\n    {\"name\": ");
    add_string(text, columns[c].name);
    spore_text_add(text, ", \"unit\": ");
    add_string(text, columns[c].unit);
    spore_text_add(text, "}");
  }
}

char *spore_numbers_json(const SporeNumbers *numbers, const char *scene, double dt_s, size_t *size) {
  SporeTextBuffer text = {0};
  size_t count;
  const SporeColumn *columns = spore_measurement_columns(numbers->measurement, &count);
  spore_text_add(&text, "{\n  \"scene\": ");
  add_string(&text, scene);
  spore_text_add(&text, ",\n  \"dt_s\": ");
  add_json_number(&text, dt_s);
  spore_text_add(&text, ",\n  \"columns\": [");
  add_json_columns(&text, columns, count);
  spore_text_add(&text, "\n  ],\n  \"rows\": [");
  for (size_t i = 0; i < numbers->row_count * count; i++) {
    spore_text_add(&text, i % count > 0 ? ", " : i > 0 ? "],\n    [" : "\n    [");
    add_json_number(&text, numbers->values[i]);
  }
  spore_text_add(&text, numbers->row_count > 0 ? "]\n  ]\n}\n" : "]\n}\n");
  return finish(&text, size);
}
