/* The library of fluids: nothing but the list, and how to find one in it. */
#include "core/author/fluids.h"

#include <glib/gi18n.h>

#define BLOOD "blood", "lennard_jones", "0.45 0.02 0.02", "1", NULL, NULL
#define WATER "water", "lennard_jones", "0.62 0.72 0.76", "1", "0.15", "effect"
#define STEAM "steam", "smoke", "0.90 0.90 0.92", "0", NULL, "effect"

/* At that temperature the particles stay a liquid: models/particles/lennard_jones.c. */
static const char *const liquid[] = {"temperature", "0.7", "thermostat", "200", NULL};
/* Of body temperature and with salt it is much the same. It washes at the rate at which blood stains. */
static const char *const rinsing[] = {"density",    "998", "surface_tension", "0.072", "temperature", "0.7",
                                      "thermostat", "200", "stain",           "-12",   NULL};
static const char *const wet[] = {"stiffness", "60", "damping", "0.02", "friction", "1", NULL};
/* Stiff enough to stop a jet of a litre a minute within a drop, in steps of 2 ms. */
static const char *const jetting[] = {"stiffness", "150", "damping", "0.05", "friction", "0.2", NULL};
static const char *const bleeding[] = {"rate", "4", "speed", "0.05", NULL};
static const char *const wound[] = {"rate", "4", "speed", "0.05", "trigger", "wound", NULL};
/* Laparoscopy needs an irrigator of 1 l/min at least (78 Steps Health Journal, Laparoscopic surgery:
 * irrigation/suction); the bore is that of the tube that the library draws. */
static const char *const pouring[] = {"flow", "1.667e-5", "radius", "0.00175", "trigger", "second_button", NULL};
static const char *const rising[] = {"rate", "70", "speed", "0.03", "radius", "0.0015", NULL};
static const char *const coagulation[] = {"rate",   "70",      "speed",       "0.03", "radius",
                                          "0.0015", "trigger", "coagulation", NULL};

const SporeFluidKind spore_fluids[] = {
    {"bleeding", N_("Bleeding"), N_("comes out of an organ from the start"), BLOOD, SPORE_MOUTH_ORGAN, 100, liquid, wet,
     bleeding},
    {"wound", N_("Bleeding of a cut"), N_("begins when the organ is cut, and ends when it is coagulated or clamped"),
     BLOOD, SPORE_MOUTH_TISSUE, 100, liquid, wet, wound},
    {"pool", N_("Pool of blood"), N_("is poured onto the organ"), BLOOD, SPORE_MOUTH_NONE, 100, liquid, wet, NULL},
    {"steam", N_("Steam"), N_("rises from an organ all the time"), STEAM, SPORE_MOUTH_ORGAN, 120, NULL, NULL, rising},
    {"coagulation", N_("Steam of coagulation"), N_("rises where a bipolar instrument coagulates"), STEAM,
     SPORE_MOUTH_HEATER, 120, NULL, NULL, coagulation},
    {"irrigation", N_("Irrigation"), N_("pours water out of a suction tube while its second button is down"), WATER,
     SPORE_MOUTH_TUBE, 500, rinsing, jetting, pouring},
    {NULL},
};

const SporeFluidKind *spore_fluid_find(const char *name) {
  const SporeFluidKind *kind = spore_fluids;
  while (kind->name && !g_str_equal(kind->name, name)) kind++;
  return kind->name ? kind : NULL;
}
