/* Numbers to text and back, whatever the locale. */
#include "core/base/number.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST 1000

static size_t digits(const char *text, size_t at, size_t size) {
  size_t start = at;
  while (at < size && text[at] >= '0' && text[at] <= '9') at++;
  return at - start;
}

static bool is_sign(char c) { return c == '+' || c == '-'; }

/* Length of the number at the start of text by the grammar; *point: where its decimal point stands, or size. */
static size_t scan(const char *text, size_t size, size_t *point) {
  size_t at = size > 0 && is_sign(text[0]) ? 1 : 0;
  size_t whole = digits(text, at, size), fraction = 0;
  at += whole;
  *point = size;
  if (at < size && text[at] == '.') {
    fraction = digits(text, at + 1, size);
    if (whole + fraction > 0) *point = at, at += 1 + fraction;
  }
  if (whole + fraction == 0) return 0;
  if (at < size && (text[at] == 'e' || text[at] == 'E')) {
    size_t exponent = at + 1 + (at + 1 < size && is_sign(text[at + 1]));
    size_t count = digits(text, exponent, size);
    if (count > 0) at = exponent + count;
  }
  return at;
}

size_t spore_number_read(const char *text, size_t size, double *value) {
  size_t point, length = scan(text, size, &point);
  if (length == 0 || length > LONGEST) return 0;
  char buffer[LONGEST + 16], *end;
  memcpy(buffer, text, length);
  buffer[length] = '\0';
  *value = strtod(buffer, &end);
  if (end == buffer + length) return length;
  /* The locale has another decimal point: put that one in. */
  char sample[16];
  int sample_length = snprintf(sample, sizeof sample, "%.1f", 0.5);
  size_t mark = (size_t)sample_length - 2;
  memcpy(buffer + point, sample + 1, mark);
  memcpy(buffer + point + mark, text + point + 1, length - point - 1);
  buffer[length - 1 + mark] = '\0';
  *value = strtod(buffer, &end);
  return length;
}

/* Puts the C locale's point in the place of another one, which may have several bytes. */
static int restore_point(char *text) {
  char *to = text;
  bool written = false;
  for (const char *from = text; *from; from++) {
    if ((*from >= '0' && *from <= '9') || is_sign(*from) || *from == 'e') *to++ = *from;
    else if (!written) *to++ = '.', written = true;
  }
  *to = '\0';
  return (int)(to - text);
}

int spore_number_format(double value, char text[SPORE_NUMBER_TEXT]) {
  if (!isfinite(value)) return snprintf(text, SPORE_NUMBER_TEXT, isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
  for (int precision = 15;; precision++) {
    snprintf(text, SPORE_NUMBER_TEXT, "%.*g", precision, value);
    int length = restore_point(text);
    double back;
    if (precision >= 17 || (spore_number_read(text, (size_t)length, &back) && back == value)) return length;
  }
}

int spore_number_format_rounded(double value, int digits, char text[SPORE_NUMBER_TEXT]) {
  assert(digits >= 1);
  double unit = value != 0 && isfinite(value) ? pow(10, floor(log10(fabs(value))) - digits + 1) : 1;
  double rounded = unit < 1 ? round(value / unit) / round(1 / unit) : round(value / unit) * unit;
  return spore_number_format(rounded, text);
}
