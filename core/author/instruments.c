/* The library of instruments: nothing but the list, and how to find one in it. */
#include "core/author/instruments.h"

#include <glib/gi18n.h>

static const char *const pressing[] = {"trigger", "button", "opening", "1.2", "torque", "0.01", "strength", "4", NULL};
static const char *const cutting[] = {"trigger", "button", "opening", "1", NULL};
static const char *const heating[] = {"radius", "0.004", NULL};
static const char *const sucking[] = {"trigger", "button", NULL};
/* Such tubes have holes at their sides, too. */
static const char *const rinsing[] = {"trigger", "button", "radius", "0.006", NULL};

const SporeInstrumentKind spore_instruments[] = {
    {"probe", N_("Probe"), N_("presses and stirs"), "probe", SPORE_HEAD_BALL, .radius = 0.0035, .head_radius = 0.005,
     .clearance = 0.02},
    {"grasper", N_("Grasper"), N_("holds tissue while it is closed"), "grasper", SPORE_HEAD_JAWS, .radius = 0.0025,
     .head_length = 0.018, .head_radius = 0.0015, .clearance = 0.01, .settings = pressing},
    {"clamp", N_("Clamp"), N_("stays closed on tissue until it is opened"), "clamp", SPORE_HEAD_JAWS, .radius = 0.0025,
     .head_length = 0.024, .head_radius = 0.0015, .clearance = 0.01, .settings = pressing},
    {"clip", N_("Clip"), N_("is put on tissue as an effect: nothing feels it, it goes along and is seen to squeeze"),
     "clamp", SPORE_HEAD_JAWS, .radius = 0.0025, .head_length = 0.012, .head_radius = 0.001, .clearance = 0.01,
     .mode = "effect", .settings = pressing},
    {"scissors", N_("Scissors"), N_("cuts what is between its blades"), "scissors", SPORE_HEAD_BLADES, .radius = 0.0025,
     .head_length = 0.016, .head_radius = 0.0012, .clearance = 0.01, .settings = cutting},
    {"bipolar", N_("Bipolar forceps"), N_("coagulates what it is near"), "bipolar", SPORE_HEAD_PRONGS, .radius = 0.0025,
     .head_length = 0.014, .head_radius = 0.001, .clearance = 0.01, .settings = heating},
    {"suction", N_("Suction"), N_("draws fluid away"), "suction", SPORE_HEAD_MOUTH, .radius = 0.0025, .clearance = 0.01,
     .settings = sucking},
    {"irrigator", N_("Suction and irrigation"), N_("draws fluid away, and pours water"), "suction", SPORE_HEAD_MOUTH,
     .radius = 0.0025, .clearance = 0.02, .fluid = "irrigation", .settings = rinsing},
    {"needle", N_("Needle with thread"), N_("stitches"), "needle", SPORE_HEAD_ARC, .radius = 0.0004,
     .head_radius = 0.007, .clearance = 0.01},
    {"bag", N_("Specimen bag"), N_("takes away what was cut off"), "probe", SPORE_HEAD_HOOP, .radius = 0.0035,
     .head_length = 0.059, .head_radius = 0.028, .clearance = 0.06},
    {"endoscope", N_("Endoscope"), N_("looks straight ahead"), "probe", SPORE_HEAD_LENS, .radius = 0.005,
     .clearance = 0.08},
    {"endoscope_30", N_("Endoscope, 30 degrees"), N_("looks down from its shaft"), "probe", SPORE_HEAD_LENS,
     .radius = 0.005, .clearance = 0.08, .look_rad = G_PI / 6},
    {NULL},
};

const SporeInstrumentKind *spore_instrument_find(const char *name) {
  const SporeInstrumentKind *instrument = spore_instruments;
  while (instrument->name && !g_str_equal(instrument->name, name)) instrument++;
  return instrument->name ? instrument : NULL;
}

gboolean spore_instrument_has_jaws(const SporeInstrumentKind *instrument) {
  return instrument->head == SPORE_HEAD_JAWS || instrument->head == SPORE_HEAD_BLADES;
}

SporeVec3 spore_instrument_tip(const SporeInstrumentKind *instrument) {
  if (instrument->head == SPORE_HEAD_ARC) return (SporeVec3){instrument->head_radius, 0, 0};
  return (SporeVec3){0, -instrument->head_length, 0};
}
