/* Levels of detail of bodies: coarser forms that a body takes while it runs. No GTK. */
#ifndef SPORE_AUTHOR_LEVEL_EDITS_H
#define SPORE_AUTHOR_LEVEL_EDITS_H

#include "core/author/generator_work.h"

/* A new level as data, which any thread may make; one thread owns the document. */
typedef struct SporeLevelWork {
  guint32 body;                /* object id */
  const char *element;         /* coarse or medium */
  char *settings;              /* in which its model differs from the body's; NULL: in none */
  SporeGenerateWork *generate; /* its tetrahedra; NULL: the body's own geometry */
} SporeLevelWork;

/* Whether a body can get a level of that element (coarse, medium): its model has a number that can be less, or
 * tetrahedra, and it has no such level yet. FALSE with a GError. */
gboolean spore_level_may(SporeDocument *document, SporeObject *body, const char *element, GError **error);
/* A level with about half the degrees of freedom of the body (medium) or a quarter of them (coarse). NULL with a
 * GError: see spore_level_may, or the body shows no mesh that tetrahedra could be made of. */
SporeLevelWork *spore_level_work_new(SporeDocument *document, SporeObject *body, const char *element, GError **error);
void spore_level_work_free(gpointer work);
/* Makes the tetrahedra, where it needs some. FALSE with a GError: cancelled, or they cannot be made. */
gboolean spore_level_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* Adds the level to the body's fidelity, as one undo step. Returns the level. NULL with a GError: nothing was changed;
 * the body or its mesh is another one by now. */
SporeObject *spore_level_work_apply(const SporeLevelWork *work, SporeDocument *document, GError **error);

/* Removes a level by its path, and with it tetrahedra that nothing else uses; a body that begins at it begins fine. One
 * undo step. FALSE with a GError: there is no such level. */
gboolean spore_edit_remove_level(SporeDocument *document, const char *path, GError **error);

#endif
