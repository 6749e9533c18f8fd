/* The form of names, and the distance between two spellings. */
#include "core/base/name.h"

#include <stdint.h>
#include <string.h>

#define LONGEST 63

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool spore_name_is_valid(const char *name) {
  if (!is_letter(name[0])) return false;
  for (const char *c = name + 1; *c; c++)
    if (!is_letter(*c) && !(*c >= '0' && *c <= '9') && *c != '.' && *c != '-') return false;
  return true;
}

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

size_t spore_name_distance(const char *a, const char *b) {
  size_t a_length = strlen(a), b_length = strlen(b);
  if (a_length > LONGEST || b_length > LONGEST) return SIZE_MAX;
  size_t rows[3][LONGEST + 1]; /* of the table of distances between beginnings: the last three */
  for (size_t j = 0; j <= b_length; j++) rows[0][j] = j;
  for (size_t i = 1; i <= a_length; i++) {
    size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
    row[0] = i;
    for (size_t j = 1; j <= b_length; j++) {
      char ca = lower(a[i - 1]), cb = lower(b[j - 1]);
      row[j] = smaller(smaller(above[j], row[j - 1]) + 1, above[j - 1] + (ca != cb));
      if (i > 1 && j > 1 && ca == lower(b[j - 2]) && cb == lower(a[i - 2]))
        row[j] = smaller(row[j], two_above[j - 2] + 1);
    }
  }
  return rows[a_length % 3][b_length];
}

bool spore_name_is_near(const char *name, size_t distance) {
  size_t length = strlen(name);
  return distance <= (length < 3 ? 1 : length / 3);
}

const char *spore_name_nearest(const char *const *names, const char *name) {
  const char *nearest = NULL;
  size_t best = SIZE_MAX;
  for (; names && *names; names++) {
    size_t distance = spore_name_distance(name, *names);
    if (distance < best) best = distance, nearest = *names;
  }
  return nearest && spore_name_is_near(name, best) ? nearest : NULL;
}
