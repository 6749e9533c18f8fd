/* Units of length in files, and which of them gives a mesh the size of an organ. */
#ifndef SPORE_SCENE_LENGTH_UNIT_H
#define SPORE_SCENE_LENGTH_UNIT_H

#include <glib.h>

/* By index, as in the file; NULL-terminated. */
extern const char *const spore_length_units[]; /* m cm mm um in */
extern const double spore_length_unit_m[];

/* Smallest and largest size of organs and instruments (diagonal of the bounding box). */
#define SPORE_ORGAN_SMALLEST_M 0.002
#define SPORE_ORGAN_LARGEST_M 2.0

/* The unit in which a thing with that diagonal would have the usual size of an organ, 20 mm to 1 m: mm where that fits,
 * else m, else cm, um or in. -1: no unit does. */
int spore_length_unit_guess(double diagonal);

/* A length in the unit that people would use for it: "150 mm". g_free. */
char *spore_length_text(double length_m);

/* NULL where the size is that of an organ. Else a translated part of a sentence that names the unit which would give
 * that size: "in mm it would be 150 mm across". g_free. */
char *spore_length_doubt(double diagonal_m, int unit);

#endif
