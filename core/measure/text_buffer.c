/* Text that grows as it is written. */
#include "core/measure/text_buffer.h"

#include <string.h>

#include "core/base/memory.h"
#include "core/base/number.h"

void spore_text_add_bytes(SporeTextBuffer *text, const char *bytes, size_t size) {
  if (text->failed) return;
  if (text->size + size + 1 > text->capacity) {
    size_t capacity = 2 * (text->size + size + 1) + 4096;
    char *grown = spore_reallocate(text->bytes, text->capacity, capacity, 1);
    if (!grown) {
      text->failed = true;
      return;
    }
    text->bytes = grown, text->capacity = capacity;
  }
  memcpy(text->bytes + text->size, bytes, size);
  text->bytes[text->size += size] = '\0';
}

void spore_text_add(SporeTextBuffer *text, const char *string) { spore_text_add_bytes(text, string, strlen(string)); }

void spore_text_add_number(SporeTextBuffer *text, double value) {
  char digits[SPORE_NUMBER_TEXT];
  spore_text_add_bytes(text, digits, (size_t)spore_number_format(value, digits));
}
