#include "ui/document/labels.h"

#include <string.h>

char *spore_label_of_name(const char *name) {
  char *label = g_strdelimit(g_strdup(name), "_", ' ');
  label[0] = g_ascii_toupper(label[0]);
  char *person = strstr(label, " euler");
  if (person) person[1] = 'E';
  return label;
}

gboolean spore_name_is_word(const char *name) {
  for (const char *c = name; *c; c++)
    if (g_ascii_isupper(*c)) return FALSE;
  return strlen(name) > 2;
}
