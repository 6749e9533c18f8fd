/* Units of length, and a guess which of them a mesh file uses. */
#include "core/scene/length_unit.h"

#include <glib/gi18n.h>

const char *const spore_length_units[] = {"m", "cm", "mm", "um", "in", NULL};
const double spore_length_unit_m[] = {1, 1e-2, 1e-3, 1e-6, 0.0254};

#define USUAL_SMALLEST_M 0.02
#define USUAL_LARGEST_M 1.0

int spore_length_unit_guess(double diagonal) {
  static const int order[] = {2, 0, 1, 3, 4};
  for (gsize i = 0; i < G_N_ELEMENTS(order); i++) {
    double metres = diagonal * spore_length_unit_m[order[i]];
    if (metres >= USUAL_SMALLEST_M && metres <= USUAL_LARGEST_M) return order[i];
  }
  return -1;
}

char *spore_length_text(double length_m) {
  if (length_m >= 1) return g_strdup_printf("%.3g m", length_m);
  if (length_m >= 1e-3) return g_strdup_printf("%.3g mm", length_m * 1e3);
  return g_strdup_printf("%.3g µm", length_m * 1e6);
}

char *spore_length_doubt(double diagonal_m, int unit) {
  if (diagonal_m >= SPORE_ORGAN_SMALLEST_M && diagonal_m <= SPORE_ORGAN_LARGEST_M) return NULL;
  double diagonal = diagonal_m / spore_length_unit_m[unit];
  int guess = spore_length_unit_guess(diagonal);
  if (guess < 0) return g_strdup(_("no unit of length would make it an organ: look at the file"));
  g_autofree char *length = spore_length_text(diagonal * spore_length_unit_m[guess]);
  return g_strdup_printf(_("in %s it would be %s across"), spore_length_units[guess], length);
}
