/* Puts SVG text together. */
#include "core/measure/svg.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/number.h"

#define TITLE_LEFT 24.
#define TITLE_BASE 28.

static void add_bytes(SporeSvg *svg, const char *bytes, size_t size) {
  if (svg->failed) return;
  if (svg->size + size + 1 > svg->capacity) {
    size_t capacity = 2 * (svg->size + size + 1) + 4096;
    char *grown = spore_reallocate(svg->bytes, svg->capacity, capacity, 1);
    if (!grown) {
      svg->failed = true;
      return;
    }
    svg->bytes = grown, svg->capacity = capacity;
  }
  memcpy(svg->bytes + svg->size, bytes, size);
  svg->bytes[svg->size += size] = '\0';
}

void spore_svg_add(SporeSvg *svg, const char *text) { add_bytes(svg, text, strlen(text)); }

static void add_escaped(SporeSvg *svg, const char *text) {
  for (; *text; text++) {
    if (*text == '&') spore_svg_add(svg, "&amp;");
    else if (*text == '<') spore_svg_add(svg, "&lt;");
    else if (*text == '>') spore_svg_add(svg, "&gt;");
    else add_bytes(svg, text, 1);
  }
}

void spore_svg_attribute(SporeSvg *svg, const char *name, double value) {
  char digits[SPORE_NUMBER_TEXT];
  spore_svg_add(svg, " ");
  spore_svg_add(svg, name);
  spore_svg_add(svg, "=\"");
  add_bytes(svg, digits, (size_t)spore_number_format(round(value * 100) / 100, digits));
  spore_svg_add(svg, "\"");
}

void spore_svg_line(SporeSvg *svg, double x1, double y1, double x2, double y2, const char *rest) {
  spore_svg_add(svg, "<line");
  spore_svg_attribute(svg, "x1", x1);
  spore_svg_attribute(svg, "y1", y1);
  spore_svg_attribute(svg, "x2", x2);
  spore_svg_attribute(svg, "y2", y2);
  spore_svg_add(svg, rest);
  spore_svg_add(svg, "/>\n");
}

void spore_svg_rectangle(SporeSvg *svg, double x, double y, double width, double height, const char *rest) {
  spore_svg_add(svg, "<rect");
  spore_svg_attribute(svg, "x", x);
  spore_svg_attribute(svg, "y", y);
  spore_svg_attribute(svg, "width", width);
  spore_svg_attribute(svg, "height", height);
  spore_svg_add(svg, rest);
  spore_svg_add(svg, "/>\n");
}

void spore_svg_text(SporeSvg *svg, double x, double y, const char *rest, const char *content) {
  spore_svg_add(svg, "<text");
  spore_svg_attribute(svg, "x", x);
  spore_svg_attribute(svg, "y", y);
  spore_svg_add(svg, rest);
  spore_svg_add(svg, ">");
  add_escaped(svg, content);
  spore_svg_add(svg, "</text>\n");
}

void spore_svg_open(SporeSvg *svg, const char *title, double width, double height) {
  spore_svg_add(svg, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"");
  spore_svg_attribute(svg, "width", width);
  spore_svg_attribute(svg, "height", height);
  spore_svg_add(svg, " font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\" fill=\"#222222\">\n<title>");
  add_escaped(svg, title);
  spore_svg_add(svg, "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n");
  spore_svg_text(svg, TITLE_LEFT, TITLE_BASE, " font-size=\"16\" font-weight=\"bold\"", title);
}
