/* Names of labels by the numbers of common sets, for maps that name none of them. */
#include "core/io/label_survey.h"

#define FEWEST 10    /* labels: fewer numbers lie in nearly every set */
#define GLAND 4.0e-5 /* m^3: no adrenal gland is as large; a set that makes one of a larger label is another */

/* Numbers of the classes, from 1 on, as TotalSegmentator writes them (Wasserthal et al. 2023, "TotalSegmentator: Robust
 * Segmentation of 104 Anatomic Structures in CT Images"; its file map_to_binary.py: total, total_v1, total_mr). */
static const char total_2[] =
    "spleen kidney_right kidney_left gallbladder liver stomach pancreas adrenal_gland_right adrenal_gland_left "
    "lung_upper_lobe_left lung_lower_lobe_left lung_upper_lobe_right lung_middle_lobe_right lung_lower_lobe_right "
    "esophagus trachea thyroid_gland small_bowel duodenum colon urinary_bladder prostate kidney_cyst_left "
    "kidney_cyst_right sacrum vertebrae_S1 vertebrae_L5 vertebrae_L4 vertebrae_L3 vertebrae_L2 vertebrae_L1 "
    "vertebrae_T12 vertebrae_T11 vertebrae_T10 vertebrae_T9 vertebrae_T8 vertebrae_T7 vertebrae_T6 vertebrae_T5 "
    "vertebrae_T4 vertebrae_T3 vertebrae_T2 vertebrae_T1 vertebrae_C7 vertebrae_C6 vertebrae_C5 vertebrae_C4 "
    "vertebrae_C3 vertebrae_C2 vertebrae_C1 heart aorta pulmonary_vein brachiocephalic_trunk "
    "subclavian_artery_right subclavian_artery_left common_carotid_artery_right common_carotid_artery_left "
    "brachiocephalic_vein_left brachiocephalic_vein_right atrial_appendage_left superior_vena_cava "
    "inferior_vena_cava portal_vein_and_splenic_vein iliac_artery_left iliac_artery_right iliac_vena_left "
    "iliac_vena_right humerus_left humerus_right scapula_left scapula_right clavicula_left clavicula_right "
    "femur_left femur_right hip_left hip_right spinal_cord gluteus_maximus_left gluteus_maximus_right "
    "gluteus_medius_left gluteus_medius_right gluteus_minimus_left gluteus_minimus_right autochthon_left "
    "autochthon_right iliopsoas_left iliopsoas_right brain skull rib_left_1 rib_left_2 rib_left_3 rib_left_4 "
    "rib_left_5 rib_left_6 rib_left_7 rib_left_8 rib_left_9 rib_left_10 rib_left_11 rib_left_12 rib_right_1 "
    "rib_right_2 rib_right_3 rib_right_4 rib_right_5 rib_right_6 rib_right_7 rib_right_8 rib_right_9 rib_right_10 "
    "rib_right_11 rib_right_12 sternum costal_cartilages";

static const char total_1[] =
    "spleen kidney_right kidney_left gallbladder liver stomach aorta inferior_vena_cava "
    "portal_vein_and_splenic_vein pancreas adrenal_gland_right adrenal_gland_left lung_upper_lobe_left "
    "lung_lower_lobe_left lung_upper_lobe_right lung_middle_lobe_right lung_lower_lobe_right vertebrae_L5 "
    "vertebrae_L4 vertebrae_L3 vertebrae_L2 vertebrae_L1 vertebrae_T12 vertebrae_T11 vertebrae_T10 vertebrae_T9 "
    "vertebrae_T8 vertebrae_T7 vertebrae_T6 vertebrae_T5 vertebrae_T4 vertebrae_T3 vertebrae_T2 vertebrae_T1 "
    "vertebrae_C7 vertebrae_C6 vertebrae_C5 vertebrae_C4 vertebrae_C3 vertebrae_C2 vertebrae_C1 esophagus trachea "
    "heart_myocardium heart_atrium_left heart_ventricle_left heart_atrium_right heart_ventricle_right "
    "pulmonary_artery brain iliac_artery_left iliac_artery_right iliac_vena_left iliac_vena_right small_bowel "
    "duodenum colon rib_left_1 rib_left_2 rib_left_3 rib_left_4 rib_left_5 rib_left_6 rib_left_7 rib_left_8 "
    "rib_left_9 rib_left_10 rib_left_11 rib_left_12 rib_right_1 rib_right_2 rib_right_3 rib_right_4 rib_right_5 "
    "rib_right_6 rib_right_7 rib_right_8 rib_right_9 rib_right_10 rib_right_11 rib_right_12 humerus_left "
    "humerus_right scapula_left scapula_right clavicula_left clavicula_right femur_left femur_right hip_left "
    "hip_right sacrum face gluteus_maximus_left gluteus_maximus_right gluteus_medius_left gluteus_medius_right "
    "gluteus_minimus_left gluteus_minimus_right autochthon_left autochthon_right iliopsoas_left iliopsoas_right "
    "urinary_bladder";

static const char total_mr[] =
    "spleen kidney_right kidney_left gallbladder liver stomach pancreas adrenal_gland_right adrenal_gland_left "
    "lung_left lung_right esophagus small_bowel duodenum colon urinary_bladder prostate sacrum vertebrae "
    "intervertebral_discs spinal_cord heart aorta inferior_vena_cava portal_vein_and_splenic_vein "
    "iliac_artery_left iliac_artery_right iliac_vena_left iliac_vena_right humerus_left humerus_right "
    "scapula_left scapula_right clavicula_left clavicula_right femur_left femur_right hip_left hip_right "
    "gluteus_maximus_left gluteus_maximus_right gluteus_medius_left gluteus_medius_right gluteus_minimus_left "
    "gluteus_minimus_right autochthon_left autochthon_right iliopsoas_left iliopsoas_right brain";
static const char *const sets[] = {total_2, total_1, total_mr};

static gboolean is_gland(const char *name) { return g_str_has_prefix(name, "adrenal_gland"); }

/* Whether every label lies in the set, and none is too large for what the set says it is. */
static gboolean may_be(char *const *set, const SporeLabelSize *labels, gsize count) {
  const gsize most = g_strv_length((char **)set);
  for (gsize i = 0; i < count; i++)
    if (labels[i].label < 1 || labels[i].label > most ||
        (is_gland(set[labels[i].label - 1]) && labels[i].volume > GLAND))
      return FALSE;
  return TRUE;
}

/* Adds the set's names; a name that is there already, and is another, becomes "". */
static void add(GHashTable *names, char *const *set, const SporeLabelSize *labels, gsize count) {
  for (gsize i = 0; i < count; i++) {
    gpointer key = GUINT_TO_POINTER((guint)labels[i].label);
    const char *name = set[labels[i].label - 1], *there = g_hash_table_lookup(names, key);
    g_hash_table_insert(names, key, g_strdup(!there || g_str_equal(there, name) ? name : ""));
  }
}

static gboolean is_open(gpointer key, gpointer name, gpointer data) { return *(const char *)name == '\0'; }

GHashTable *spore_label_guess(const SporeLabelSize *labels, gsize count) {
  GHashTable *names = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  for (gsize s = 0; s < G_N_ELEMENTS(sets) && count >= FEWEST; s++) {
    g_auto(GStrv) set = g_strsplit(sets[s], " ", -1);
    if (may_be(set, labels, count)) add(names, set, labels, count);
  }
  g_hash_table_foreach_remove(names, is_open, NULL);
  return names;
}
