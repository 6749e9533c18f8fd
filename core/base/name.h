/* Names that people write: their form, and the nearest known one to a misspelt one. */
#ifndef SPORE_BASE_NAME_H
#define SPORE_BASE_NAME_H

#include <stdbool.h>
#include <stddef.h>

/* [A-Za-z_][A-Za-z0-9_.-]* */
bool spore_name_is_valid(const char *name);

/* Number of insertions, deletions, replacements and swaps of neighbours from one name to the other, letter case
 * apart; SIZE_MAX where either is longer than 63 bytes. */
size_t spore_name_distance(const char *a, const char *b);

/* Whether a name at that distance is near enough to be suggested for `name`. */
bool spore_name_is_near(const char *name, size_t distance);

/* The nearest of a NULL-terminated list, the first of equals; NULL when none is near or the list is NULL. */
const char *spore_name_nearest(const char *const *names, const char *name);

#endif
