/* Units of length in files, and which of them makes an organ of a mesh. */
#ifndef SPORE_SCENE_LENGTH_UNIT_H
#define SPORE_SCENE_LENGTH_UNIT_H

#include <glib.h>

/* By index, as in the file; NULL-terminated. */
extern const char *const spore_length_units[]; /* m cm mm um in */
extern const double spore_length_unit_m[];

/* Organs and instruments are between these across (diagonal of the bounding box). */
#define SPORE_ORGAN_SMALLEST_M 0.002
#define SPORE_ORGAN_LARGEST_M 2.0

/* The unit in which something so many units across would be an organ of usual size, 20 mm to 1 m: mm where that fits,
 * else m, else cm, um or in. -1: none does. */
int spore_length_unit_guess(double diagonal);

/* A length in the unit that people would use for it: "150 mm". g_free. */
char *spore_length_text(double length_m);

/* NULL for an organ's size. Else a sentence part, translated, that says which unit would make it one: "in mm it would
 * be 150 mm across". g_free. */
char *spore_length_doubt(double diagonal_m, int unit);

#endif
