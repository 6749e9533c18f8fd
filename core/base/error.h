/* Errors of the kernel: a small value that needs no library. Rooms from core/scene up turn it into a GError. */
#ifndef SPORE_BASE_ERROR_H
#define SPORE_BASE_ERROR_H

#include <stdbool.h>

/* What kind of thing went wrong: what a program can decide by. */
typedef enum SporeErrorCode {
  SPORE_ERROR_NONE = 0,
  SPORE_ERROR_INPUT,       /* a value, mesh or file content the user can mend */
  SPORE_ERROR_FILE,        /* the file system said no */
  SPORE_ERROR_MEMORY,      /* not enough memory */
  SPORE_ERROR_NUMERICAL,   /* it cannot be computed as asked */
  SPORE_ERROR_CANCELLED,   /* the user stopped it */
  SPORE_ERROR_UNSUPPORTED, /* not in this build, or not on this machine */
  SPORE_ERROR_INTERNAL     /* a fault of ours */
} SporeErrorCode;

/* place: "FILE:LINE:COLUMN", an object path such as "bodies/liver", or empty.
 * message: "what is wrong; what was expected; what to do", translated, without a full stop. */
typedef struct SporeError {
  SporeErrorCode code;
  char place[256];
  char message[512];
} SporeError;

/* An error in which nothing is said yet. */
#define SPORE_ERROR_INIT ((SporeError){SPORE_ERROR_NONE, "", ""})

/* Fills *error (which may be NULL) and returns false, so that a caller can write `return spore_error_set(...)`.
 * place may be NULL; longer texts are cut at a whole character. */
bool spore_error_set(SporeError *error, SporeErrorCode code, const char *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Puts `place` in front where *error has none yet; does nothing when error is NULL. */
void spore_error_at(SporeError *error, const char *place);

/* The kernel has no catalogue of its own: a program that translates hands in its gettext.
 * Without one, texts come out as they are written. */
typedef const char *(*SporeTranslate)(const char *text);
/* Hands in the translator of all messages, before the first call that could fail; NULL: none. */
void spore_set_translate(SporeTranslate translate);
/* The text as the user reads it; the text itself where there is no translator. */
const char *spore_translate(const char *text) __attribute__((format_arg(1)));

#endif
