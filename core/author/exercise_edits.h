/* Steps and metrics of an exercise: added where an author picks, put in order, judged, removed. Which bodies, places
 * and tools a kind has is read from the table of its kind. No GTK. */
#ifndef SPORE_AUTHOR_EXERCISE_EDITS_H
#define SPORE_AUTHOR_EXERCISE_EDITS_H

#include "core/author/link_edits.h"

/* Whether the object is a step, or a metric, of an exercise. NULL is none. */
gboolean spore_step_is(const SporeObject *object);
gboolean spore_metric_is(const SporeObject *object);
/* How many places are picked for a kind of step: a place or a body, and what it is put into where it is put into
 * something. */
guint spore_step_end_count(const SporeObjectType *type);
/* What the end is, translated, as the kind's table says. Borrowed. */
const char *spore_step_end_doc(const SporeObjectType *type, guint end);

/* Whether a step of that element can be added: it is one, and the scene has a tool that can do it. */
gboolean spore_edit_can_add_step(SporeDocument *document, const char *element, GError **error);
/* Adds a step of that element at the picked ends, as the last one and as one undo step; the first end's body gives its
 * name. A kind that has a place takes the place of the first end, and the first tool that can do it; others take its
 * body. NULL with a GError: it cannot be added, an end lacks its body, or both ends are of one body. */
SporeObject *spore_edit_add_step(SporeDocument *document, const char *element, const SporeLinkEnd *ends, guint count,
                                 GError **error);
/* Gives an existing step other ends, as one undo step. Its other parameters stay. */
gboolean spore_edit_aim_step(SporeDocument *document, SporeObject *step, const SporeLinkEnd *ends, guint count,
                             GError **error);
/* Adds a metric of that element, as one undo step. A kind that needs a body or a camera takes `body` (NULL: none) where
 * that is of the right kind, else the first of the scene. NULL with a GError: no metric of that kind, or the scene has
 * nothing to measure. */
SporeObject *spore_edit_add_metric(SporeDocument *document, const char *element, const SporeObject *body,
                                   GError **error);
/* Moves a step or metric before the one above it (-1) or behind the one below it (1) among its like. FALSE without a
 * GError: there is none. */
gboolean spore_edit_move_part(SporeDocument *document, SporeObject *part, int by, GError **error);
/* Removes a step or metric, as one undo step. Steps that wait for it wait for what it waited for. */
gboolean spore_edit_remove_part(SporeDocument *document, SporeObject *part, GError **error);
/* Sets a metric's threshold, "good" or "pass". A number without unit is of the metric's own; an empty text is no
 * threshold. FALSE with a GError: no number, or another unit. */
gboolean spore_edit_set_threshold(SporeDocument *document, SporeObject *metric, const char *property, const char *text,
                                  GError **error);

#endif
