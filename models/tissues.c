#include "models/tissues.h"

/* A shear modulus in kPa gives young_modulus in Pa: times 2900. */
#define TISSUE(name, label, young)                                                                                     \
  {                                                                                                                    \
    name, label, "PMC6925591", { "young_modulus", young, "poisson_ratio", "0.45", "density", "1060", NULL }            \
  }

const SporePreset spore_tissues[] = {
    TISSUE("stomach", N_("Stomach"), "1856"),                 /* 0.64 kPa */
    TISSUE("liver", N_("Liver"), "5220"),                     /* 1.8 kPa */
    TISSUE("gallbladder", N_("Gallbladder"), "246500"),       /* 85 kPa */
    TISSUE("bile_duct", N_("Bile duct"), "481400"),           /* 166 kPa */
    TISSUE("hepatic_artery", N_("Hepatic artery"), "609000"), /* 210 kPa */
    {0},
};
