/* Walls inside the solid, told by their kinds. */
#include <glib/gi18n.h>

#include "core/generate/tetrahedra/private.h"

#define NAMED 8 /* pieces of a kind that are told by name, at most */

/* What is said of a kind of wall: how many there are and which, their holes where they are open, what to do. */
static const struct {
  const char *what, *remedy;
} kinds[] = {
    [SPORE_WALL_OPEN] = {N_("open tubes or sheets inside"),
                         N_("they are left out, and the solid is on both sides of them; for a lumen, close their holes "
                            "on import and ask for hollow; for a wall with an open lumen, make a surface of them")},
    [SPORE_WALL_LUMEN] = {N_("open tubes or sheets inside that are turned inward"),
                          N_("what they hold is cut out as far as they reach; for a lumen that ends where they end, or "
                             "none, close their holes on import, and ask for hollow or for fill")},
    [SPORE_WALL_DOUBLED] = {N_("second walls close inside another one"),
                            N_("they are left out, and what they enclose is filled; for an organ that is hollow, with "
                               "a wall of this thickness, ask for hollow")},
    [SPORE_WALL_CLOSED] = {N_("closed pieces inside, as chambers or parts of an organ"),
                           N_("they are left out, and what they enclose is filled; for cavities, ask for hollow; for "
                              "cells of their own, keep the pieces apart")},
    [SPORE_WALL_TURNED] =
        {N_("closed pieces inside that are turned inside out"),
         N_("each bounds a cavity; if they are parts of the organ, ask for fill, and they are solid")},
};

/* The names of that kind's pieces; of many, the first. g_free. */
static char *names_of(const SporeTetrahedraReport *report, SporePieceWall wall) {
  GString *names = g_string_new(NULL);
  size_t told = 0;
  for (size_t i = 0; i < report->piece_count && told <= NAMED; i++) {
    if (report->piece[i].wall != wall || report->piece[i].parted) continue;
    g_autofree char *name = spore_tetrahedra_piece_called(report, (int)i);
    g_string_append_printf(names, "%s%s", told ? ", " : "", told < NAMED ? name : "...");
    told++;
  }
  return g_string_free(names, FALSE);
}

void spore_tetrahedra_say_walls(GString *text, const SporeTetrahedraReport *report) {
  for (SporePieceWall wall = SPORE_WALL_OPEN; wall <= SPORE_WALL_TURNED; wall++) {
    size_t count = 0, holes = 0;
    for (size_t i = 0; i < report->piece_count; i++) {
      if (report->piece[i].wall != wall || report->piece[i].parted) continue;
      count++;
      holes += report->piece[i].holes;
    }
    if (!count) continue;
    g_autofree char *names = names_of(report, wall);
    g_string_append_printf(text, "%s: %zu (%s)", _(kinds[wall].what), count, names);
    if (holes) g_string_append_printf(text, _("; holes: %zu"), holes);
    g_string_append_printf(text, "; %s\n", _(kinds[wall].remedy));
  }
}
