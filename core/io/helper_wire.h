/* Frames between SPORE and its helpers. Native byte order: both run on the same machine. */
#ifndef SPORE_IO_HELPER_WIRE_H
#define SPORE_IO_HELPER_WIRE_H

#include <stdint.h>

#define SPORE_FRAME_MAGIC 0x73706f72u
#define SPORE_FRAME_TEXT 2048 /* bytes of a progress, note or error at most */

typedef enum SporeFrameType {
  SPORE_FRAME_REQUEST = 1, /* to the child: what to do */
  SPORE_FRAME_PROGRESS,    /* double fraction, then the stage */
  SPORE_FRAME_NOTE,        /* text for the log */
  SPORE_FRAME_ERROR,       /* uint32_t SporeErrorCode, message, NUL, detail */
  SPORE_FRAME_ANSWER
} SporeFrameType;

/* Then `size` bytes. */
typedef struct SporeFrame {
  uint32_t magic, type;
  uint64_t size;
} SporeFrame;

#endif
