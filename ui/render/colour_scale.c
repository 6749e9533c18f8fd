/* The scale of colours, for widgets and as shader code. */
#include "ui/render/colour_scale.h"

#include <glib.h>
#include <math.h>

#define STOPS 9
static const unsigned char stops[STOPS][3] = {{68, 1, 84},    {71, 45, 123},  {59, 82, 139},
                                              {44, 114, 142}, {33, 145, 140}, {40, 174, 128},
                                              {94, 201, 98},  {173, 220, 48}, {253, 231, 37}};

void spore_colour_scale(double value, double srgb[3]) {
  double place = CLAMP(value, 0, 1) * (STOPS - 1);
  int below = MIN((int)place, STOPS - 2);
  for (int i = 0; i < 3; i++)
    srgb[i] = (stops[below][i] + (place - below) * (stops[below + 1][i] - stops[below][i])) / 255;
}

char *spore_colour_scale_shader(void) {
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, "const vec3 scale_stops[%d] = vec3[](", STOPS);
  for (int s = 0; s < STOPS; s++) {
    char number[3][G_ASCII_DTOSTR_BUF_SIZE];
    for (int i = 0; i < 3; i++)
      g_ascii_formatd(number[i], sizeof *number, "%.5f", spore_linear_light(stops[s][i] / 255.0));
    g_string_append_printf(text, "%svec3(%s, %s, %s)", s ? ", " : "", number[0], number[1], number[2]);
  }
  g_string_append_printf(text,
                         ");\n"
                         "vec3 scale_colour(float value) {\n"
                         "  float place = clamp(value, 0.0, 1.0) * %d.0;\n"
                         "  int below = min(int(place), %d);\n"
                         "  return mix(scale_stops[below], scale_stops[below + 1], place - float(below));\n"
                         "}\n",
                         STOPS - 1, STOPS - 2);
  return g_string_free(text, FALSE);
}
