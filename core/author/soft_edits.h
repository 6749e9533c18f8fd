/* Makes organs soft in one step: tetrahedra, collision spheres, the tissue that the name says, and a pin. No GTK. */
#ifndef SPORE_AUTHOR_SOFT_EDITS_H
#define SPORE_AUTHOR_SOFT_EDITS_H

#include "core/author/generator_work.h"

/* Cells and spheres that are shared by all organs of one step, in equal parts. */
#define SPORE_SOFT_CELLS 3000
#define SPORE_SOFT_SPHERES 240

/* What is made of one organ. */
typedef struct SporeSoftOrgan {
  char *name;                    /* of the body */
  SporeGenerateWork *tetrahedra; /* with the result, once it was run */
  SporeGenerateWork *spheres;    /* the same; NULL: the body keeps the spheres that it has */
  GError *refused;               /* why it cannot be made soft; NULL: it was made, or not run yet */
} SporeSoftOrgan;

/* A run as data, which any thread may run; one thread owns the document. */
typedef struct SporeSoftWork {
  GPtrArray *organs; /* of SporeSoftOrgan * */
} SporeSoftWork;

/* Whether a body can be made soft: it shows a mesh, has no model yet, and no hand leads it. FALSE with a GError. */
gboolean spore_soft_may(SporeDocument *document, SporeObject *body, GError **error);
/* bodies: of SporeObject *, one or more; a body that is there twice counts once. Copies their meshes. NULL with a
 * GError: one of them cannot be made soft. */
SporeSoftWork *spore_soft_work_new(SporeDocument *document, const GPtrArray *bodies, GError **error);
void spore_soft_work_free(gpointer work);
/* Makes tetrahedra and spheres. An organ of which none can be made is left out, and says why. FALSE with a GError:
 * cancelled, or no organ is left. */
gboolean spore_soft_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* Puts the organs that were made into the document, as one undo step: their results, the usual model for tetrahedra,
 * colour and tissue by their names, and a pin for a body that no link holds. FALSE with a GError: nothing was changed;
 * a mesh is another one by now. */
gboolean spore_soft_work_apply(const SporeSoftWork *work, SporeDocument *document, GError **error);
/* What was made of an organ, or why it was left out, in one line, translated. g_free. */
char *spore_soft_organ_text(const SporeSoftOrgan *organ);

#endif
