/* Lays several pictures and colours side by side in one. */
#include "app/helpers/atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#if SPORE_HAVE_JPEG
#include "app/helpers/photograph.h"
#endif
#include "core/math/colour.h"

#define CHANNELS 3
#define MARGIN 16
#define GRID 32     /* a pixel of the picture at a 32th of its size lies in one cell */
#define HALVINGS 14 /* leave one pixel of any picture */

/* The rectangle of a look in the atlas. */
typedef struct Cell {
  SporeAtlasLook *look;
  const SporeAtlasPicture *picture; /* NULL: a colour */
  int64_t first[2];                 /* pixel of the repeated picture at the upper left corner within the margin */
  int64_t sides[2];                 /* with margins, multiples of GRID */
  int64_t at[2];
} Cell;

typedef struct Atlas {
  SporeAtlasPicture *pictures;
  Cell *cells;
  size_t picture_count, cell_count;
  int64_t sides[2];
  unsigned char *pixels;
} Atlas;

static uint32_t big_endian(const unsigned char *bytes) {
  return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Width and height as its head says them; 0: it is no picture. */
static void measure(SporeAtlasPicture *picture) {
  static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                            0,    0,   0,   13,  'I',  'H',  'D',  'R'};
  const unsigned char *bytes = picture->content;
  picture->sides[0] = picture->sides[1] = picture->halvings = 0;
  picture->lost = picture->smaller = false;
  if (picture->size >= sizeof signature + 8 && memcmp(bytes, signature, sizeof signature) == 0)
    for (int k = 0; k < 2; k++) picture->sides[k] = big_endian(bytes + sizeof signature + 4 * k);
#if SPORE_HAVE_JPEG
  int width, height;
  if (spore_photograph_is(bytes, picture->size) && spore_photograph_size(bytes, picture->size, &width, &height))
    picture->sides[0] = width, picture->sides[1] = height;
#endif
  for (int k = 0; k < 2; k++)
    if (picture->sides[k] < 1 || picture->sides[k] > SPORE_ATLAS_SIDE_MAXIMUM) picture->lost = true;
}

/* Its pixels, red green blue, as large as it was measured; free. NULL: it cannot be decoded. */
static unsigned char *decode(const SporeAtlasPicture *picture) {
  png_image image = {.version = PNG_IMAGE_VERSION};
  unsigned char *pixels = NULL;
#if SPORE_HAVE_JPEG
  int width, height;
  if (spore_photograph_is(picture->content, picture->size))
    return spore_photograph_pixels(picture->content, picture->size, &width, &height);
#endif
  if (!png_image_begin_read_from_memory(&image, picture->content, picture->size)) return NULL;
  image.format = PNG_FORMAT_RGBA; /* what is clear keeps its colour, as it is drawn elsewhere */
  pixels = malloc((size_t)image.width * image.height * 4);
  if (pixels && png_image_finish_read(&image, NULL, pixels, 0, NULL)) {
    for (size_t i = 0; i < (size_t)image.width * image.height; i++)
      memmove(pixels + CHANNELS * i, pixels + 4 * i, CHANNELS);
    return pixels;
  }
  png_image_free(&image);
  free(pixels);
  return NULL;
}

static unsigned char byte_of(double light) { return (unsigned char)lround(255 * fmin(spore_srgb(light), 1)); }

/* To half the width and height, in place: the mean light of four pixels. */
static void halve(unsigned char *pixels, int64_t sides[2], const double light[256]) {
  int64_t width = sides[0], half[2];
  for (int k = 0; k < 2; k++) half[k] = sides[k] > 1 ? sides[k] / 2 : 1;
  for (int64_t y = 0; y < half[1]; y++)
    for (int64_t x = 0; x < half[0]; x++)
      for (int c = 0; c < CHANNELS; c++) {
        double sum = 0;
        for (int i = 0; i < 4; i++) {
          int64_t from_x = 2 * x + i % 2, from_y = 2 * y + i / 2;
          if (from_x >= sides[0]) from_x = 0;
          if (from_y >= sides[1]) from_y = 0;
          sum += light[pixels[CHANNELS * (from_y * width + from_x) + c]];
        }
        pixels[CHANNELS * (y * half[0] + x) + c] = byte_of(sum / 4);
      }
  sides[0] = half[0], sides[1] = half[1];
}

/* Width or height once halved. */
static int64_t side_of(const SporeAtlasPicture *picture, int k) {
  int64_t side = picture->sides[k] >> picture->halvings;
  return side > 1 ? side : 1;
}

/* Of a picture of one pixel, a colour is left, however often it repeats. */
static void size_cell(Atlas *atlas, Cell *cell) {
  const SporeAtlasLook *look = cell->look;
  const SporeAtlasPicture *picture = look->picture ? &atlas->pictures[look->picture - 1] : NULL;
  if (picture && picture->lost) picture = NULL;
  cell->picture = picture;
  for (int k = 0; k < 2; k++) {
    cell->first[k] = 0, cell->sides[k] = GRID;
    if (!picture || (side_of(picture, 0) == 1 && side_of(picture, 1) == 1)) continue;
    cell->first[k] = (int64_t)floor(look->low[k] * (double)side_of(picture, k));
    int64_t end = (int64_t)ceil(look->high[k] * (double)side_of(picture, k));
    cell->sides[k] = (end - cell->first[k] + 2 * MARGIN + GRID - 1) / GRID * GRID;
  }
}

static int by_height(const void *a, const void *b) {
  const Cell *first = a, *second = b;
  if (first->sides[1] != second->sides[1]) return first->sides[1] < second->sides[1] ? 1 : -1;
  return first->look < second->look ? -1 : 1;
}

/* Cells, the highest first, in rows of at most that width. Returns the height. */
static int64_t lay_rows(Atlas *atlas, int64_t width) {
  int64_t x = 0, y = 0, row = 0;
  for (size_t i = 0; i < atlas->cell_count; i++) {
    Cell *cell = &atlas->cells[i];
    if (x + cell->sides[0] > width) x = 0, y += row, row = 0;
    if (row == 0) row = cell->sides[1];
    cell->at[0] = x, cell->at[1] = y;
    x += cell->sides[0];
  }
  return y + row;
}

/* Finds the width of least area. False: the cells do not fit. */
static bool pack(Atlas *atlas) {
  int64_t widest = 0, area = 0, best = 0, least = SPORE_ATLAS_PIXELS_MAXIMUM + 1;
  for (size_t i = 0; i < atlas->cell_count; i++) {
    const int64_t *sides = atlas->cells[i].sides;
    if (sides[0] > SPORE_ATLAS_SIDE_MAXIMUM || sides[1] > SPORE_ATLAS_SIDE_MAXIMUM) return false;
    if (sides[0] > widest) widest = sides[0];
    area += sides[0] * sides[1];
  }
  if (area > SPORE_ATLAS_PIXELS_MAXIMUM) return false;
  qsort(atlas->cells, atlas->cell_count, sizeof *atlas->cells, by_height);
  for (int64_t tenths = 8; tenths <= 30; tenths++) {
    int64_t width = (int64_t)(sqrt((double)area) * (double)tenths / 10) / GRID * GRID;
    if (width < widest) width = widest;
    if (width > SPORE_ATLAS_SIDE_MAXIMUM) width = SPORE_ATLAS_SIDE_MAXIMUM;
    int64_t height = lay_rows(atlas, width);
    if (height <= SPORE_ATLAS_SIDE_MAXIMUM && width * height < least) least = width * height, best = width;
  }
  if (!best) return false;
  atlas->sides[0] = best, atlas->sides[1] = lay_rows(atlas, best);
  return true;
}

/* Halves the picture of the largest cell. False: none is left. */
static bool shrink(Atlas *atlas) {
  const Cell *largest = NULL;
  double area = 0;
  for (size_t i = 0; i < atlas->cell_count; i++) {
    const Cell *cell = &atlas->cells[i];
    double one = (double)cell->sides[0] * (double)cell->sides[1];
    if (cell->picture && cell->picture->halvings < HALVINGS && one > area) largest = cell, area = one;
  }
  if (!largest) return false;
  SporeAtlasPicture *picture = &atlas->pictures[largest->look->picture - 1];
  picture->halvings++;
  picture->smaller = true;
  for (size_t i = 0; i < atlas->cell_count; i++) size_cell(atlas, &atlas->cells[i]);
  return true;
}

/* A cell without neighbour on its right, or lower than its row, reaches there, so that no pixel is foreign to the mesh.
 */
static void fill_rows(Atlas *atlas) {
  for (size_t i = 0, row = 0; i < atlas->cell_count; i++) {
    Cell *cell = &atlas->cells[i];
    if (cell->at[1] != atlas->cells[row].at[1]) row = i;
    cell->sides[1] = atlas->cells[row].sides[1];
    if (i + 1 == atlas->cell_count || atlas->cells[i + 1].at[1] != cell->at[1])
      cell->sides[0] = atlas->sides[0] - cell->at[0];
  }
}

static int64_t within(int64_t at, int64_t side) { return (at % side + side) % side; }

/* pixels: of its picture, halved; NULL: the colour alone. */
static void paint(Atlas *atlas, const Cell *cell, const unsigned char *pixels, const double light[256]) {
  static const unsigned char white[CHANNELS] = {255, 255, 255};
  unsigned char shade[CHANNELS][256];
  int64_t sides[2] = {1, 1};
  for (int c = 0; c < CHANNELS; c++)
    for (int i = 0; i < 256; i++) shade[c][i] = byte_of(light[i] * spore_linear_light((double)cell->look->colour[c]));
  for (int k = 0; k < 2 && pixels; k++) sides[k] = side_of(cell->picture, k);
  for (int64_t y = 0; y < cell->sides[1]; y++)
    for (int64_t x = 0; x < cell->sides[0]; x++) {
      int64_t from =
          within(cell->first[1] + y - MARGIN, sides[1]) * sides[0] + within(cell->first[0] + x - MARGIN, sides[0]);
      const unsigned char *pixel = pixels ? pixels + CHANNELS * from : white;
      unsigned char *to = atlas->pixels + CHANNELS * ((cell->at[1] + y) * atlas->sides[0] + cell->at[0] + x);
      for (int c = 0; c < CHANNELS; c++) to[c] = shade[c][pixel[c]];
    }
}

/* Paints the cells of a picture; of NULL: the colours. */
static void paint_all(Atlas *atlas, SporeAtlasPicture *picture, const double light[256]) {
  unsigned char *pixels = picture ? decode(picture) : NULL;
  if (picture && !pixels) picture->lost = true;
  if (pixels) {
    int64_t sides[2] = {picture->sides[0], picture->sides[1]};
    for (int i = 0; i < picture->halvings; i++) halve(pixels, sides, light);
  }
  for (size_t i = 0; i < atlas->cell_count; i++)
    if (atlas->cells[i].picture == picture) paint(atlas, &atlas->cells[i], pixels, light);
  free(pixels);
}

/* Where the look's places lie in the atlas. All of a colour are in the middle of its cell. */
static void place(const Atlas *atlas, const Cell *cell) {
  for (int k = 0; k < 2; k++) {
    double whole = (double)atlas->sides[k], side = cell->picture ? (double)side_of(cell->picture, k) : 1;
    bool plain = !cell->picture || (side_of(cell->picture, 0) == 1 && side_of(cell->picture, 1) == 1);
    cell->look->scale[k] = plain ? 0 : side / whole;
    cell->look->offset[k] = (double)(cell->at[k] + MARGIN - cell->first[k]) / whole;
  }
}

static bool encode(const Atlas *atlas, void **png, size_t *size) {
  png_image image = {.version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB};
  image.width = (png_uint_32)atlas->sides[0], image.height = (png_uint_32)atlas->sides[1];
  png_alloc_size_t room = PNG_IMAGE_PNG_SIZE_MAX(image);
  *png = malloc(room);
  if (*png && png_image_write_to_memory(&image, *png, &room, 0, atlas->pixels, 0, NULL)) {
    *size = room;
    return true;
  }
  free(*png);
  *png = NULL;
  return false;
}

static bool fit(Atlas *atlas, SporeAtlasLook *looks) {
  for (size_t i = 0; i < atlas->picture_count; i++) measure(&atlas->pictures[i]);
  for (size_t i = 0; i < atlas->cell_count; i++) {
    atlas->cells[i].look = &looks[i];
    size_cell(atlas, &atlas->cells[i]);
  }
  while (!pack(atlas))
    if (!shrink(atlas)) return false;
  fill_rows(atlas);
  return true;
}

static void draw(Atlas *atlas) {
  double light[256];
  for (int i = 0; i < 256; i++) light[i] = spore_linear_light(i / 255.0);
  paint_all(atlas, NULL, light);
  for (size_t i = 0; i < atlas->picture_count; i++)
    if (!atlas->pictures[i].lost) paint_all(atlas, &atlas->pictures[i], light);
}

bool spore_atlas_make(SporeAtlasPicture *pictures, size_t picture_count, SporeAtlasLook *looks, size_t look_count,
                      void **png, size_t *png_size) {
  Atlas atlas = {pictures, calloc(look_count, sizeof(Cell)), picture_count, look_count, {0}, NULL};
  bool done = atlas.cells && fit(&atlas, looks);
  if (done) atlas.pixels = malloc((size_t)(atlas.sides[0] * atlas.sides[1] * CHANNELS));
  done = done && atlas.pixels;
  if (done) draw(&atlas);
  for (size_t i = 0; done && i < look_count; i++) place(&atlas, &atlas.cells[i]);
  done = done && encode(&atlas, png, png_size);
  free(atlas.pixels);
  free(atlas.cells);
  return done;
}
