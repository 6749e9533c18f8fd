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

/* The handler that goes back to where `back` was set, at errors and at warnings. */
static struct jpeg_error_mgr *handler_of(Fault *fault) {
  struct jpeg_error_mgr *manager = jpeg_std_error(&fault->manager);
  manager->error_exit = fail;
  manager->emit_message = count_warning;
  return manager;
}

bool spore_photograph_is(const void *content, size_t size) {
  return size > 3 && memcmp(content, "\xff\xd8\xff", 3) == 0;
}

/* Reads the head. False: it is too large. */
static bool begin(struct jpeg_decompress_struct *reader, const void *content, size_t size, int *width, int *height) {
  jpeg_mem_src(reader, content, size);
  jpeg_read_header(reader, TRUE);
  *width = (int)reader->image_width, *height = (int)reader->image_height;
  return reader->image_width <= SPORE_PHOTOGRAPH_SIDE_MAXIMUM && reader->image_height <= SPORE_PHOTOGRAPH_SIDE_MAXIMUM;
}

bool spore_photograph_size(const void *content, size_t size, int *width, int *height) {
  struct jpeg_decompress_struct reader;
  Fault fault;
  volatile bool done = false;
  reader.err = handler_of(&fault);
  if (setjmp(fault.back) == 0) {
    jpeg_create_decompress(&reader);
    done = begin(&reader, content, size, width, height);
  }
  jpeg_destroy_decompress(&reader);
  return done;
}

unsigned char *spore_photograph_pixels(const void *content, size_t size, int *width, int *height) {
  struct jpeg_decompress_struct reader;
  Fault fault;
  unsigned char *volatile pixels = NULL;
  volatile bool done = false;
  reader.err = handler_of(&fault);
  if (setjmp(fault.back) == 0) {
    jpeg_create_decompress(&reader);
    if (begin(&reader, content, size, width, height)) {
      reader.out_color_space = JCS_RGB;
      jpeg_start_decompress(&reader);
      pixels = malloc((size_t)reader.output_width * reader.output_height * CHANNELS);
    }
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
  int width, height;
  unsigned char *pixels = spore_photograph_pixels(content, size, &width, &height);
  if (!pixels) return false;
  image.width = (png_uint_32)width, image.height = (png_uint_32)height;
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
