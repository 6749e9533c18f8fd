/* Puts SVG text together. */
#include "core/measure/svg.h"

#include <math.h>
#include <string.h>

#define TITLE_LEFT 24.
#define TITLE_BASE 28.

void spore_svg_escaped(SporeTextBuffer *svg, const char *text, size_t size) {
  for (const char *end = text + size; text < end; text++) {
    if (*text == '&') spore_text_add(svg, "&amp;");
    else if (*text == '<') spore_text_add(svg, "&lt;");
    else if (*text == '>') spore_text_add(svg, "&gt;");
    else spore_text_add_bytes(svg, text, 1);
  }
}

void spore_svg_attribute(SporeTextBuffer *svg, const char *name, double value) {
  spore_text_add(svg, " ");
  spore_text_add(svg, name);
  spore_text_add(svg, "=\"");
  spore_text_add_number(svg, round(value * 100) / 100);
  spore_text_add(svg, "\"");
}

void spore_svg_line(SporeTextBuffer *svg, double x1, double y1, double x2, double y2, const char *rest) {
  spore_text_add(svg, "<line");
  spore_svg_attribute(svg, "x1", x1);
  spore_svg_attribute(svg, "y1", y1);
  spore_svg_attribute(svg, "x2", x2);
  spore_svg_attribute(svg, "y2", y2);
  spore_text_add(svg, rest);
  spore_text_add(svg, "/>\n");
}

void spore_svg_rectangle(SporeTextBuffer *svg, double x, double y, double width, double height, const char *rest) {
  spore_text_add(svg, "<rect");
  spore_svg_attribute(svg, "x", x);
  spore_svg_attribute(svg, "y", y);
  spore_svg_attribute(svg, "width", width);
  spore_svg_attribute(svg, "height", height);
  spore_text_add(svg, rest);
  spore_text_add(svg, "/>\n");
}

void spore_svg_text(SporeTextBuffer *svg, double x, double y, const char *rest, const char *content) {
  spore_text_add(svg, "<text");
  spore_svg_attribute(svg, "x", x);
  spore_svg_attribute(svg, "y", y);
  spore_text_add(svg, rest);
  spore_text_add(svg, ">");
  spore_svg_escaped(svg, content, strlen(content));
  spore_text_add(svg, "</text>\n");
}

void spore_svg_open(SporeTextBuffer *svg, const char *title, double width, double height) {
  spore_text_add(svg, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"");
  spore_svg_attribute(svg, "width", width);
  spore_svg_attribute(svg, "height", height);
  spore_text_add(svg, " viewBox=\"0 0 ");
  spore_text_add_number(svg, width);
  spore_text_add(svg, " ");
  spore_text_add_number(svg, height);
  spore_text_add(svg,
                 "\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\" fill=\"#222222\">\n<title>");
  spore_svg_escaped(svg, title, strlen(title));
  spore_text_add(svg, "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n");
  spore_svg_text(svg, TITLE_LEFT, TITLE_BASE, " font-size=\"16\" font-weight=\"bold\"", title);
}
