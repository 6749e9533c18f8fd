/* Decodes a JPEG and writes its pixels as PNG. */
#include "app/helpers/photograph.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>

#define CHANNELS 3

typedef struct Fault {
  struct jpeg_error_mgr manager; /* first, so that the library's pointer to it is one to the whole */
  jmp_buf back;
} Fault;

static void fail(j_common_ptr reader) { longjmp(((Fault *)reader->err)->back, 1); }

/* A warning means that a part is missing or damaged. */
static void count_warning(j_common_ptr reader, int level) {
  if (level < 0) fail(reader);
}

bool spore_photograph_is(const void *content, size_t size) {
  return size > 3 && memcmp(content, "\xff\xd8\xff", 3) == 0;
}

/* Reads the head, and makes room for the pixels. */
static unsigned char *begin(struct jpeg_decompress_struct *reader, const void *content, size_t size) {
  jpeg_mem_src(reader, content, size);
  jpeg_read_header(reader, TRUE);
  if (reader->image_width > SPORE_PHOTOGRAPH_SIDE_MAXIMUM || reader->image_height > SPORE_PHOTOGRAPH_SIDE_MAXIMUM)
    return NULL;
  reader->out_color_space = JCS_RGB;
  jpeg_start_decompress(reader);
  return malloc((size_t)reader->output_width * reader->output_height * CHANNELS);
}

/* The pixels; NULL: it cannot be decoded. */
static unsigned char *decode(const void *content, size_t size, png_image *image) {
  struct jpeg_decompress_struct reader;
  Fault fault;
  unsigned char *volatile pixels = NULL;
  volatile bool done = false;
  reader.err = jpeg_std_error(&fault.manager);
  fault.manager.error_exit = fail;
  fault.manager.emit_message = count_warning;
  if (setjmp(fault.back) == 0) {
    jpeg_create_decompress(&reader);
    pixels = begin(&reader, content, size);
    image->width = reader.output_width, image->height = reader.output_height;
    while (pixels && reader.output_scanline < reader.output_height) {
      JSAMPROW row = pixels + (size_t)reader.output_scanline * reader.output_width * CHANNELS;
      jpeg_read_scanlines(&reader, &row, 1);
    }
    done = pixels && jpeg_finish_decompress(&reader);
  }
  jpeg_destroy_decompress(&reader);
  if (done) return pixels;
  free(pixels);
  return NULL;
}

bool spore_photograph_convert(const void *content, size_t size, void **png, size_t *png_size) {
  png_image image = {.version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB};
  unsigned char *pixels = decode(content, size, &image);
  if (!pixels) return false;
  png_alloc_size_t room = PNG_IMAGE_PNG_SIZE_MAX(image);
  *png = malloc(room);
  bool done = *png && png_image_write_to_memory(&image, *png, &room, 0, pixels, 0, NULL);
  free(pixels);
  *png_size = room;
  if (done) return true;
  free(*png);
  *png = NULL;
  return false;
}
