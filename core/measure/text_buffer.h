/* Text that grows as it is written: what files of numbers and pictures are made of. */
#ifndef SPORE_MEASURE_TEXT_BUFFER_H
#define SPORE_MEASURE_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

/* All zero is an empty text. `bytes` ends in NUL once anything was added, and is freed by spore_free. After a failure
 * (no memory) nothing more is added. */
typedef struct SporeTextBuffer {
  char *bytes;
  size_t size, capacity;
  bool failed;
} SporeTextBuffer;

void spore_text_add_bytes(SporeTextBuffer *text, const char *bytes, size_t size);
void spore_text_add(SporeTextBuffer *text, const char *string);
/* The shortest text that reads back to the same bits, in the C locale. */
void spore_text_add_number(SporeTextBuffer *text, double value);

#endif
