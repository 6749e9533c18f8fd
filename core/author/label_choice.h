/* What becomes of each label of a map: tetrahedra, an unmovable surface, or nothing. */
#ifndef SPORE_AUTHOR_LABEL_CHOICE_H
#define SPORE_AUTHOR_LABEL_CHOICE_H

#include "core/author/generator_work.h"

typedef enum SporeLabelChoice { SPORE_LABEL_SOFT, SPORE_LABEL_AROUND, SPORE_LABEL_LEFT_OUT } SporeLabelChoice;

/* i: place of the label in the source of the options. */
SporeLabelChoice spore_label_choice(const SporeGenerateOptions *options, gsize i);
void spore_label_choose(SporeGenerateOptions *options, gsize i, SporeLabelChoice choice);
/* Chooses for all labels of a source that was read. Where the scene has organs of a map under those names, they are
 * soft, and the rest is left out. Else few are soft: the largest of those whose names say a tissue; where none does,
 * the largest one. The rest is around them. */
void spore_label_propose(SporeGenerateOptions *options, SporeDocument *document);

#endif
