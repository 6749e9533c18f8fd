/* What the name of an organ says: the colour that it is drawn in, and its tissue. */
#include "core/author/anatomy.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/body/tissue.h"

#define GOLDEN 0.6180339887 /* hues of numbers in a row lie far apart */
#define MUTED 0.35
#define BRIGHT 0.78
#define USUAL_MODULUS 5000.0 /* Pa: of organs like liver and kidney */
#define LEAST_WEIGHT 0.5
#define MOST_WEIGHT 2.0

/* A word at the beginning of a part of a name, and what it says; the first that is found counts. */
typedef struct Word {
  const char *word, *material;
  double colour[3];
  double adult_g;           /* of one such organ of the reference adult man or woman; 0: none is told */
  double least_ml, most_ml; /* outside of it the unit is more likely wrong than the organ ill, or a newborn's */
} Word;

/* Masses: ICRP Publication 89 (2002), reference values. Volumes: half a newborn's there, and what diseases lead to. */
static const Word words[] = {
    {"tumor", NULL, {0.86, 0.80, 0.55}},
    {"tumour", NULL, {0.86, 0.80, 0.55}},
    {"lesion", NULL, {0.86, 0.80, 0.55}},
    {"cyst", NULL, {0.86, 0.80, 0.55}},
    {"hepatic_artery", "hepatic_artery", {0.82, 0.16, 0.13}},
    {"artery", NULL, {0.82, 0.16, 0.13}},
    {"aorta", NULL, {0.82, 0.16, 0.13}},
    {"vein", NULL, {0.24, 0.34, 0.68}},
    {"vena", NULL, {0.24, 0.34, 0.68}},
    {"vessel", NULL, {0.62, 0.20, 0.26}},
    {"bile_duct", "bile_duct", {0.42, 0.55, 0.22}},
    {"gallbladder", "gallbladder", {0.36, 0.52, 0.24}},
    {"liver", "liver", {0.52, 0.20, 0.14}, 1800, 60, 3600},
    {"spleen", "spleen", {0.48, 0.16, 0.24}, 150, 4, 2500},
    {"kidney", "kidney", {0.58, 0.22, 0.17}, 155, 5, 1500},
    {"adrenal", NULL, {0.85, 0.63, 0.32}, 7, 0.5, 500},
    {"pancreas", "pancreas", {0.87, 0.69, 0.47}, 140, 2, 600},
    {"stomach", "stomach", {0.84, 0.53, 0.48}},
    {"duodenum", "small_intestine", {0.88, 0.60, 0.53}},
    {"small_bowel", "small_intestine", {0.88, 0.60, 0.53}},
    {"small_intestine", "small_intestine", {0.88, 0.60, 0.53}},
    {"colon", NULL, {0.80, 0.55, 0.45}},
    {"bowel", NULL, {0.80, 0.55, 0.45}},
    {"rectum", NULL, {0.80, 0.55, 0.45}},
    {"esophagus", NULL, {0.78, 0.50, 0.45}},
    {"uterus", "uterus", {0.80, 0.42, 0.40}, 80, 0.5, 4000},
    {"fallopian", NULL, {0.84, 0.48, 0.46}},
    {"oviduct", NULL, {0.84, 0.48, 0.46}},
    {"salpinx", NULL, {0.84, 0.48, 0.46}},
    {"ovary", "ovary", {0.90, 0.76, 0.70}, 5.5, 0.1, 1000},
    {"prostate", NULL, {0.78, 0.56, 0.48}, 17, 0.3, 500},
    {"bladder", NULL, {0.86, 0.70, 0.52}},
    {"urinary_bladder", NULL, {0.86, 0.70, 0.52}},
    {"lung", NULL, {0.86, 0.62, 0.62}},
    {"trachea", NULL, {0.76, 0.83, 0.86}},
    {"heart", NULL, {0.66, 0.20, 0.18}, 840, 20, 3000},
    {"brain", NULL, {0.88, 0.76, 0.70}, 1450, 150, 2500},
    {"spinal", NULL, {0.90, 0.84, 0.62}},
    {"nerve", NULL, {0.93, 0.85, 0.42}},
    {"lymph", NULL, {0.47, 0.66, 0.36}},
    {"thyroid", NULL, {0.68, 0.30, 0.27}, 20, 0.5, 600},
    {"fat", "fat", {0.93, 0.81, 0.47}},
    {"skin", NULL, {0.90, 0.72, 0.60}},
    {"muscle", "muscle", {0.60, 0.24, 0.20}},
    {"gluteus", "muscle", {0.60, 0.24, 0.20}},
    {"iliopsoas", "muscle", {0.60, 0.24, 0.20}},
    {"autochthon", "muscle", {0.60, 0.24, 0.20}},
    {"cartilage", NULL, {0.80, 0.85, 0.85}},
    {"bone", NULL, {0.90, 0.86, 0.74}},
    {"vertebra", NULL, {0.90, 0.86, 0.74}},
    {"rib", NULL, {0.90, 0.86, 0.74}},
    {"sternum", NULL, {0.90, 0.86, 0.74}},
    {"sacrum", NULL, {0.90, 0.86, 0.74}},
    {"hip", NULL, {0.90, 0.86, 0.74}},
    {"pelvis", NULL, {0.90, 0.86, 0.74}},
    {"femur", NULL, {0.90, 0.86, 0.74}},
    {"humerus", NULL, {0.90, 0.86, 0.74}},
    {"scapula", NULL, {0.90, 0.86, 0.74}},
    {"clavic", NULL, {0.90, 0.86, 0.74}},
    {"skull", NULL, {0.90, 0.86, 0.74}},
};

/* Small letters, and "_" for all that is no letter. g_free. */
static char *plain(const char *name) {
  char *text = g_ascii_strdown(name, -1);
  for (char *c = text; *c; c++)
    if (!g_ascii_isalpha(*c)) *c = '_';
  return text;
}

static gboolean has_word(const char *text, const char *word) {
  for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
    if (at == text || at[-1] == '_') return TRUE;
  return FALSE;
}

static const Word *word_of(const char *name) {
  g_autofree char *text = plain(name);
  for (gsize i = 0; i < G_N_ELEMENTS(words); i++)
    if (has_word(text, words[i].word)) return &words[i];
  return NULL;
}

void spore_anatomy_colour(const char *name, guint number, double colour[3]) {
  const Word *word = word_of(name);
  double turn = fmod(GOLDEN * number, 1);
  for (int k = 0; k < 3; k++) {
    double wave = 0.5 + 0.5 * cos(2 * G_PI * (turn - k / 3.0));
    colour[k] = word ? word->colour[k] : BRIGHT * (1 - MUTED + MUTED * wave);
  }
}

gboolean spore_anatomy_knows(const char *name) { return word_of(name) != NULL; }

const char *spore_anatomy_material(const char *name) {
  const Word *word = word_of(name);
  return word ? word->material : NULL;
}

/* Whether the name says that organ as a whole: not a segment, a valve or a stem of it. */
static gboolean is_whole(const char *name, const Word *word) {
  static const char *const others[] = {"", "left", "right", "l", "r", NULL};
  g_autofree char *text = plain(name);
  g_auto(GStrv) parts = g_strsplit(text, "_", -1);
  for (char **part = parts; *part; part++)
    if (!g_str_equal(*part, word->word) && !g_strv_contains(others, *part)) return FALSE;
  return TRUE;
}

char *spore_anatomy_doubt(const char *name, double volume_m3) {
  const Word *word = word_of(name);
  double volume_ml = 1e6 * volume_m3;
  if (!word || word->adult_g == 0 || !is_whole(name, word) ||
      (volume_ml >= word->least_ml && volume_ml <= word->most_ml))
    return NULL;
  g_autofree char *volume =
      volume_ml < 1000 ? g_strdup_printf("%.3g ml", volume_ml) : g_strdup_printf("%.3g l", 1e-3 * volume_ml);
  return g_strdup_printf(_("its volume is %s, while that organ of a reference adult weighs %.4g g; check the unit"),
                         volume, word->adult_g);
}

double spore_anatomy_cell_weight(const char *name) {
  const char *material = spore_anatomy_material(name);
  for (const SporeTissue *tissue = spore_tissues; material && tissue->name; tissue++) {
    const SporeTissueQuantity *modulus = spore_tissue_find(tissue, "young_modulus");
    if (modulus && g_str_equal(tissue->name, material))
      return CLAMP(sqrt(USUAL_MODULUS / modulus->typical.number[0]), LEAST_WEIGHT, MOST_WEIGHT);
  }
  return 1;
}

gboolean spore_edit_use_anatomy(SporeDocument *document, SporeObject *body, const char *name, guint number,
                                GError **error) {
  double colour[3];
  const char *material = spore_anatomy_material(name);
  SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  spore_anatomy_colour(name, number, colour);
  return spore_edit_set_colour(document, body, colour, error) &&
         (!mechanical || !material || spore_document_set_text(document, mechanical, "material", material, error));
}
