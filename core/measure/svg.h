/* SVG text that is put together piece by piece. */
#ifndef SPORE_MEASURE_SVG_H
#define SPORE_MEASURE_SVG_H

#include "core/measure/text_buffer.h"

/* The head of a document of that size in pixels, on white, with its title above. */
void spore_svg_open(SporeTextBuffer *svg, const char *title, double width, double height);
/* Text with what markup knows escaped. */
void spore_svg_escaped(SporeTextBuffer *svg, const char *text, size_t size);
/* ` name="value"`, to a hundredth, in the C locale. */
void spore_svg_attribute(SporeTextBuffer *svg, const char *name, double value);
/* rest: further attributes, with a blank in front, or "". content: is escaped. */
void spore_svg_line(SporeTextBuffer *svg, double x1, double y1, double x2, double y2, const char *rest);
void spore_svg_rectangle(SporeTextBuffer *svg, double x, double y, double width, double height, const char *rest);
void spore_svg_text(SporeTextBuffer *svg, double x, double y, const char *rest, const char *content);

#endif
