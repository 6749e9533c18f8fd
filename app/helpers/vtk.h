/* Reading surfaces of VTK, inside the sandbox: libc, and zlib where it is there. Formats after Kitware, "VTK File
 * Formats" (legacy 1.0 to 5.1; XML PolyData). */
#ifndef SPORE_HELPERS_VTK_H
#define SPORE_HELPERS_VTK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/helpers/failure.h"

/* Decode a content of the legacy format and of XML. *answer: SporeImportAnswer with its arrays, malloc'ed. False with a
 * failure. */
bool spore_vtk_legacy(const char *content, size_t size, void **answer, size_t *answer_size,
                      SporeHelperFailure *failure);
bool spore_vtk_xml(const char *content, size_t size, void **answer, size_t *answer_size, SporeHelperFailure *failure);

/* What both share. */

typedef enum SporeVtkType {
  SPORE_VTK_INT8,
  SPORE_VTK_UINT8,
  SPORE_VTK_INT16,
  SPORE_VTK_UINT16,
  SPORE_VTK_INT32,
  SPORE_VTK_UINT32,
  SPORE_VTK_INT64,
  SPORE_VTK_UINT64,
  SPORE_VTK_FLOAT,
  SPORE_VTK_DOUBLE,
  SPORE_VTK_TYPES
} SporeVtkType;
extern const size_t spore_vtk_bytes[SPORE_VTK_TYPES];

/* The type of a name of either format ("float", "vtktypeint64", "Float32"); SPORE_VTK_TYPES: not known. */
SporeVtkType spore_vtk_type(const char *name);
/* A number that is stored at `bytes`; big: the highest byte first. */
double spore_vtk_number(SporeVtkType type, const uint8_t *bytes, bool big);

/* A text that numbers are read from, word by word. */
typedef struct SporeVtkText {
  const char *at, *end;
} SporeVtkText;
/* Copies the next word, cut to `room`. False: there is none. */
bool spore_vtk_word(SporeVtkText *text, char *word, size_t room);
/* Reads `count` numbers into `values`. False with a failure. */
bool spore_vtk_numbers(SporeVtkText *text, double *values, size_t count, SporeHelperFailure *failure);

/* The surface that is put together. All zero at first; spore_vtk_clear. */
typedef struct SporeVtkSurface {
  double *vertices;
  uint32_t *triangles;
  size_t vertex_count, triangle_count, vertex_room, triangle_room, passed_over;
} SporeVtkSurface;
void spore_vtk_clear(SporeVtkSurface *surface);
/* Adds points, 3 numbers each; takes nothing over. */
bool spore_vtk_add_points(SporeVtkSurface *surface, const double *points, size_t count, SporeHelperFailure *failure);
/* Adds a face, or a strip of triangles, of `count` corners. Their numbers count from the vertex `first`. */
bool spore_vtk_add_face(SporeVtkSurface *surface, size_t first, const double *corners, size_t count, bool strip,
                        SporeHelperFailure *failure);
/* Adds `count` faces: the corners of the i-th are those from ends[i - 1] (0) to ends[i] of `corners`. */
bool spore_vtk_add_faces(SporeVtkSurface *surface, size_t first, const double *corners, size_t corner_count,
                         const double *ends, size_t count, bool strips, SporeHelperFailure *failure);
bool spore_vtk_answer(const SporeVtkSurface *surface, void **answer, size_t *answer_size, SporeHelperFailure *failure);

/* Room for `count` numbers; NULL with a failure. free. */
double *spore_vtk_room(size_t count, SporeHelperFailure *failure);
bool spore_vtk_fail_short(SporeHelperFailure *failure);
bool spore_vtk_fail_word(SporeHelperFailure *failure, const char *word);

/* Undoes base64 up to the first character that is none, at most `most`. Streams that follow each other are joined.
 * *result malloc'ed. */
bool spore_vtk_base64(const char *text, size_t most, uint8_t **result, size_t *result_size,
                      SporeHelperFailure *failure);
bool spore_vtk_fail_compression(SporeHelperFailure *failure, const char *name);
/* Undoes zlib's compression of a block into exactly `size` bytes. */
bool spore_vtk_inflate(const uint8_t *from, size_t from_size, uint8_t *into, size_t size, SporeHelperFailure *failure);

#endif
