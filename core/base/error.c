/* Filling in an error, and the translation of its message. */
#include "core/base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Takes an unfinished UTF-8 character off the end of a text that was cut. */
static void trim_cut_character(char *text) {
  size_t end = strlen(text), start = end;
  while (start > 0 && end - start < 4 && ((unsigned char)text[start - 1] & 0xC0) == 0x80) start--;
  if (start == 0) return;
  unsigned char lead = (unsigned char)text[start - 1];
  size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  if (length > 1 && end - (start - 1) < length) text[start - 1] = '\0';
}

static void set_place(SporeError *error, const char *place) {
  int length = snprintf(error->place, sizeof error->place, "%s", place);
  if (length >= (int)sizeof error->place) trim_cut_character(error->place);
}

bool spore_error_set(SporeError *error, SporeErrorCode code, const char *place, const char *format, ...) {
  if (!error) return false;
  error->code = code;
  set_place(error, place ? place : "");
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(error->message, sizeof error->message, format, arguments);
  va_end(arguments);
  if (length >= (int)sizeof error->message) trim_cut_character(error->message);
  return false;
}

void spore_error_at(SporeError *error, const char *place) {
  if (error && !error->place[0]) set_place(error, place);
}

static SporeTranslate translation;

void spore_set_translate(SporeTranslate translate) { translation = translate; }

const char *spore_translate(const char *text) { return translation ? translation(text) : text; }
