/* What becomes of each label of a map: tetrahedra, an unmovable surface, or nothing. */
#include "core/author/label_choice.h"

#include "core/author/anatomy.h"
#include "core/io/organ.h"

#define FEW 3 /* soft organs that are proposed */

static void set_bit(guint64 *bits, gsize i, gboolean on) {
  const guint64 bit = (guint64)1 << (i % 64);
  bits[i / 64] = on ? bits[i / 64] | bit : bits[i / 64] & ~bit;
}

SporeLabelChoice spore_label_choice(const SporeGenerateOptions *options, gsize i) {
  if (!(options->unwanted[i / 64] >> (i % 64) & 1)) return SPORE_LABEL_SOFT;
  return options->around[i / 64] >> (i % 64) & 1 ? SPORE_LABEL_AROUND : SPORE_LABEL_LEFT_OUT;
}

void spore_label_choose(SporeGenerateOptions *options, gsize i, SporeLabelChoice choice) {
  set_bit(options->unwanted, i, choice != SPORE_LABEL_SOFT);
  set_bit(options->around, i, choice == SPORE_LABEL_AROUND);
}

/* Whether the scene has tetrahedra of a label map under that name. */
static gboolean is_made(SporeDocument *document, const SporeLabelSource *source, gsize i) {
  g_autofree char *called = spore_label_source_name(source, i), *name = spore_organ_name(called);
  SporeObject *asset = spore_document_find(document, "tetrahedra", name);
  const char *map = asset ? spore_object_text(asset, "source") : NULL;
  return map && spore_document_find(document, "label_map", map);
}

static gboolean has_tissue(const SporeLabelSource *source, gsize i) {
  g_autofree char *name = spore_label_source_name(source, i);
  return spore_anatomy_material(name) != NULL;
}

/* The largest label that is not soft yet; the count: there is none. */
static gsize largest(const SporeGenerateOptions *options, gboolean of_tissue) {
  const gsize count = spore_label_source_count(options->labels);
  gsize found = count;
  for (gsize i = 0; i < count; i++) {
    if (spore_label_choice(options, i) == SPORE_LABEL_SOFT || (of_tissue && !has_tissue(options->labels, i))) continue;
    if (found == count ||
        spore_label_source_volume(options->labels, i) > spore_label_source_volume(options->labels, found))
      found = i;
  }
  return found;
}

void spore_label_propose(SporeGenerateOptions *options, SporeDocument *document) {
  const gsize count = spore_label_source_count(options->labels);
  gboolean made = FALSE;
  options->chosen = TRUE;
  for (gsize i = 0; i < count; i++) made = made || is_made(document, options->labels, i);
  for (gsize i = 0; i < count; i++) {
    SporeLabelChoice rest = made ? SPORE_LABEL_LEFT_OUT : SPORE_LABEL_AROUND;
    spore_label_choose(options, i, made && is_made(document, options->labels, i) ? SPORE_LABEL_SOFT : rest);
  }
  if (made) return;
  gboolean tissues = largest(options, TRUE) < count;
  for (int k = 0; k < (tissues ? FEW : 1); k++) {
    gsize i = largest(options, tissues);
    if (i < count) spore_label_choose(options, i, SPORE_LABEL_SOFT);
  }
}
