/* What is known of tissues: one table for presets, the scene's attribute `material`, checks and `spore models`. */
#ifndef SPORE_SIM_TISSUE_H
#define SPORE_SIM_TISSUE_H

#include "core/base/parameter.h"

/* The tissues, T(name, label, source of the modulus, quantities): quantities are Q(quantity, typical, minimum, maximum,
 * source), of which a tissue has those that somebody measured. minimum and maximum: as the source gives them (a range,
 * or one standard deviation either way), 0 and 0 where it gives none. Quantities and their units are those of models'
 * parameters; a modulus is Young's, of small slow strains, 2 (1 + Poisson's ratio) times the shear modulus where that
 * was measured (with 0.45: 2.9); tear_strain is of length; stiffness_damping is the shear viscosity over the shear
 * modulus of the same measurement, where the material was fitted by a spring beside a dashpot, or, of the liver, by one
 * beside a spring and dashpot in line, which is the same below 43 Hz. What spore_tissue_wanted lists and a tissue does
 * not have, nobody was found to have measured: the model's own value stands, and `spore models --materials` says so.
 *
 * Sources, as found: PMC6925591, table 1 (shear moduli, densities and ultimate true strains, compiled there from
 * measurements); AJR doi 10.2214/AJR.10.5449 (shear wave elastography of 127 healthy people); PMC11196258 (the same of
 * 27 women); Yildirim et al., J Ultrasound Med, doi 10.1002/jum.16731 (the same of the ovaries of 54 healthy women; 7.8
 * and 8.6 kPa in 16 others: medultrason.ro, article 1849); Asbach et al., Magn Reson Med 60:373, 2008 (magnetic
 * resonance elastography of 8 healthy people: 1.16 and 1.97 kPa, 7.3 +- 2.3 Pa s); Shearwave dispersion ultrasound
 * vibrometry on swine kidney, 2011 (cortex of 8 kidneys: 1.81 kPa, 1.48 +- 0.49 Pa s); Terry et al. 2014 (pigs, along
 * the bowel); J Mech Behav Biomed Mater 2023, Strain-dependent shear properties of human adipose tissue in vivo
 * (magnetic resonance elastography at 50 Hz, undeformed); Tribology Letters 51:377, 2013 (steel on the inside of small
 * bowel); Kaye and Laby, section 2.4.6 (densities, as listed by medicalalgorithms.com). */
#define SPORE_TISSUE_NEARLY                                                                                            \
  Q(poisson_ratio, 0.45, 0, 0, N_("assumed: nearly incompressible, and what linear elements take"))
#define SPORE_TISSUES                                                                                                  \
  T(stomach, N_("Stomach"), "PMC6925591",                                                                              \
    Q(young_modulus, 1847, 0, 0, "PMC6925591: 0.637 kPa") SPORE_TISSUE_NEARLY Q(density, 1058, 0, 0, "PMC6925591")     \
        Q(tear_strain, 0.93, 0, 0, "PMC6925591: 0.66, logarithmic"))                                                   \
  T(liver, N_("Liver"), "PMC6925591",                                                                                  \
    Q(young_modulus, 5220, 4060, 6380, "PMC6925591: 1.8 +- 0.4 kPa")                                                   \
        SPORE_TISSUE_NEARLY Q(density, 1060, 1050, 1070, "Kaye and Laby")                                              \
            Q(tear_strain, 0.46, 0, 0, "PMC6925591: 0.38, logarithmic")                                                \
                Q(stiffness_damping, 0.0063, 0.0043, 0.0083, "Magn Reson Med 60:373: 7.3 +- 2.3 Pa s, 1.16 kPa"))      \
  T(gallbladder, N_("Gallbladder"), "PMC6925591",                                                                      \
    Q(young_modulus, 246500, 222720, 270280, "PMC6925591: 85 +- 8.2 kPa")                                              \
        SPORE_TISSUE_NEARLY Q(density, 1060, 0, 0, "PMC6925591")                                                       \
            Q(tear_strain, 0.54, 0.14, 1.08, "PMC6925591: 0.43 +- 0.3, logarithmic"))                                  \
  T(bile_duct, N_("Bile duct"), "PMC6925591",                                                                          \
    Q(young_modulus, 481400, 287100, 675700, "PMC6925591: 166 +- 67 kPa")                                              \
        SPORE_TISSUE_NEARLY Q(density, 1060, 0, 0, "PMC6925591"))                                                      \
  T(hepatic_artery, N_("Hepatic artery"), "PMC6925591",                                                                \
    Q(young_modulus, 609000, 472700, 745300, "PMC6925591: 210 +- 47 kPa")                                              \
        SPORE_TISSUE_NEARLY Q(density, 1050, 0, 0, "PMC6925591")                                                       \
            Q(tear_strain, 0.88, 0, 0, "PMC6925591: 0.63, logarithmic"))                                               \
  T(kidney, N_("Kidney"), "AJR.10.5449",                                                                               \
    Q(young_modulus, 5000, 2100, 7900, "AJR.10.5449: cortex, 5.0 +- 2.9 kPa")                                          \
        SPORE_TISSUE_NEARLY Q(density, 1050, 0, 0, "Kaye and Laby")                                                    \
            Q(stiffness_damping, 0.00082, 0.00055, 0.0011, "SDUV on swine kidney, 2011: 1.48 +- 0.49 Pa s, 1.81 kPa")) \
  T(spleen, N_("Spleen"), "AJR.10.5449",                                                                               \
    Q(young_modulus, 2900, 1100, 4700, "AJR.10.5449: 2.9 +- 1.8 kPa")                                                  \
        SPORE_TISSUE_NEARLY Q(density, 1054, 0, 0, "Kaye and Laby"))                                                   \
  T(pancreas, N_("Pancreas"), "AJR.10.5449",                                                                           \
    Q(young_modulus, 4800, 1800, 7800, "AJR.10.5449: 4.8 +- 3 kPa")                                                    \
        SPORE_TISSUE_NEARLY Q(density, 1045, 1040, 1050, "Kaye and Laby"))                                             \
  T(uterus, N_("Uterus"), "PMC11196258",                                                                               \
    Q(young_modulus, 6380, 2760, 11310, "PMC11196258: myometrium, 2.76 to 11.31 kPa")                                  \
        SPORE_TISSUE_NEARLY Q(density, 1052, 0, 0, "Kaye and Laby"))                                                   \
  T(ovary, N_("Ovary"), "doi 10.1002/jum.16731",                                                                       \
    Q(young_modulus, 8820, 7200, 10440, "doi 10.1002/jum.16731: 8.82 +- 1.62 kPa") SPORE_TISSUE_NEARLY)                \
  T(small_intestine, N_("Small intestine"), "Terry et al. 2014",                                                       \
    Q(young_modulus, 307000, 0, 0, "Terry et al. 2014: 307 kPa along it, pig")                                         \
        SPORE_TISSUE_NEARLY Q(friction, 0.03, 0.007, 0.054, "Tribology Letters 51:377: steel on its inside"))          \
  T(muscle, N_("Muscle"), "PMC11196258",                                                                               \
    Q(young_modulus, 7220, 5110, 9390, "PMC11196258: quadriceps, 5.11 to 9.39 kPa")                                    \
        SPORE_TISSUE_NEARLY Q(density, 1047, 1038, 1056, "Kaye and Laby"))                                             \
  T(fat, N_("Fat"), "J Mech Behav Biomed Mater 2023",                                                                  \
    Q(young_modulus, 2181, 0, 0, "J Mech Behav Biomed Mater 2023: 752 Pa, undeformed")                                 \
        SPORE_TISSUE_NEARLY Q(density, 923, 917, 939, "Kaye and Laby"))

typedef struct SporeTissueQuantity {
  const char *name; /* of a parameter; NULL: the end */
  const char *unit;
  SporeValue typical;
  double minimum, maximum; /* 0 and 0: not known */
  const char *source;      /* translatable where it is words */
} SporeTissueQuantity;

typedef struct SporeTissue {
  const char *name, *label, *source; /* label: translatable; source: of its modulus */
  SporeTissueQuantity quantities[6];
} SporeTissue;

extern const SporeTissue spore_tissues[];        /* ended by one without a name */
extern const char *const spore_material_names[]; /* "none", then the tissues'; NULL */
extern const char *const spore_tissue_wanted[];  /* quantities that a soft solid has; NULL */

/* The quantity of a tissue that stands for a parameter; NULL: it has none. */
const SporeTissueQuantity *spore_tissue_find(const SporeTissue *tissue, const char *parameter);

/* Whether a body of a tissue takes the quantity where its author says nothing: what makes it tear, and friction, which
 * is of a pair, are said by the author. */
bool spore_tissue_fills(const char *parameter);
/* What a model's parameter takes of the tissue; NULL: nothing, or it cannot (smoke as dense as liver). */
const SporeValue *spore_tissue_value(const SporeTissue *tissue, const SporeParameter *parameter);

#endif
