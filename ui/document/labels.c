/* Labels that people read, made from names in parameter tables. */
#include "ui/document/labels.h"

#include <string.h>

/* Words with a spelling of their own. */
static const char *own_way(const char *name) {
  static const char *const words[][2] = {{"rk4", "RK4"}, {"bdf2", "BDF2"}, {"tr_bdf2", "TR-BDF2"}};
  for (gsize i = 0; i < G_N_ELEMENTS(words); i++)
    if (strcmp(name, words[i][0]) == 0) return words[i][1];
  return NULL;
}

char *spore_label_of_name(const char *name) {
  if (own_way(name)) return g_strdup(own_way(name));
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
