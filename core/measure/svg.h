/* SVG text that is put together piece by piece. */
#ifndef SPORE_MEASURE_SVG_H
#define SPORE_MEASURE_SVG_H

#include <stdbool.h>
#include <stddef.h>

/* A document in the making; all zero is an empty one. Once there was no memory, nothing more is added. */
typedef struct SporeSvg {
  char *bytes; /* spore_free */
  size_t size, capacity;
  bool failed;
} SporeSvg;

/* The head of a document of that size in pixels, on white, with its title above. */
void spore_svg_open(SporeSvg *svg, const char *title, double width, double height);
/* As it stands. */
void spore_svg_add(SporeSvg *svg, const char *text);
/* ` name="value"`, to a hundredth, in the C locale. */
void spore_svg_attribute(SporeSvg *svg, const char *name, double value);
/* rest: further attributes, with a blank in front, or "". content: is escaped. */
void spore_svg_line(SporeSvg *svg, double x1, double y1, double x2, double y2, const char *rest);
void spore_svg_rectangle(SporeSvg *svg, double x, double y, double width, double height, const char *rest);
void spore_svg_text(SporeSvg *svg, double x, double y, const char *rest, const char *content);

#endif
