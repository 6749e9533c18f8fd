/* The library of fluids: nothing but the list, and how to find one in it. */
#include "core/author/fluids.h"

#include <glib/gi18n.h>

#define BLOOD "blood", "lennard_jones", "0.45 0.02 0.02", "1", NULL
#define STEAM "steam", "smoke", "0.90 0.90 0.92", "0", "effect"

/* At that temperature the particles stay a liquid: models/particles/lennard_jones.c. */
static const char *const liquid[] = {"temperature", "0.7", "thermostat", "200", NULL};
static const char *const wet[] = {"stiffness", "60", "damping", "0.02", "friction", "1", NULL};
static const char *const bleeding[] = {"rate", "4", "speed", "0.05", NULL};
static const char *const wound[] = {"rate", "4", "speed", "0.05", "trigger", "wound", NULL};
static const char *const rising[] = {"rate", "70", "speed", "0.03", "radius", "0.0015", NULL};
static const char *const coagulation[] = {"rate",   "70",      "speed",       "0.03", "radius",
                                          "0.0015", "trigger", "coagulation", NULL};

const SporeFluidKind spore_fluids[] = {
    {"bleeding", N_("Bleeding"), N_("comes out of an organ from the start"), BLOOD, SPORE_MOUTH_ORGAN, 100, liquid, wet,
     bleeding},
    {"wound", N_("Bleeding of a cut"), N_("begins when the organ is cut, and ends when it is coagulated"), BLOOD,
     SPORE_MOUTH_TISSUE, 100, liquid, wet, wound},
    {"pool", N_("Pool of blood"), N_("is poured onto the organ"), BLOOD, SPORE_MOUTH_NONE, 100, liquid, wet, NULL},
    {"steam", N_("Steam"), N_("rises from an organ all the time"), STEAM, SPORE_MOUTH_ORGAN, 120, NULL, NULL, rising},
    {"coagulation", N_("Steam of coagulation"), N_("rises where a bipolar instrument coagulates"), STEAM,
     SPORE_MOUTH_HEATER, 120, NULL, NULL, coagulation},
    {NULL},
};

const SporeFluidKind *spore_fluid_find(const char *name) {
  const SporeFluidKind *kind = spore_fluids;
  while (kind->name && !g_str_equal(kind->name, name)) kind++;
  return kind->name ? kind : NULL;
}
