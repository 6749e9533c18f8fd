/* Positions of a patient, and gravity in each. */
#include "core/author/patient_positions.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/scene/schema_fields.h"

#define EARTH_M_S2 9.81
#define SINE_15 0.25881904510252074
#define COSINE_15 0.9659258262890683
#define ALIKE_RAD 0.0017 /* a tenth of a degree */

const SporePatientPosition spore_patient_positions[] = {
    {"supine", N_("On the back (supine)"), {0, 0, 1}},
    {"prone", N_("On the belly (prone)"), {0, 0, -1}},
    {"left_lateral", N_("On the left side"), {-1, 0, 0}},
    {"right_lateral", N_("On the right side"), {1, 0, 0}},
    {"trendelenburg", N_("Head 15° down (Trendelenburg)"), {0, SINE_15, COSINE_15}},
    {"reverse_trendelenburg", N_("Head 15° up (reverse Trendelenburg)"), {0, -SINE_15, COSINE_15}},
    {"upright", N_("Upright"), {0, -1, 0}},
    {NULL, NULL, {0, 0, 0}},
};

static const SporePatientPosition *find(const char *name, GError **error) {
  g_autoptr(GString) names = g_string_new(NULL);
  for (const SporePatientPosition *one = spore_patient_positions; one->name; one++) {
    if (g_str_equal(one->name, name)) return one;
    g_string_append_printf(names, names->len ? ", %s" : "%s", one->name);
  }
  spore_error_raise(error, SPORE_ERROR_INPUT, name, _("a patient cannot lie so; expected one of: %s"), names->str);
  return NULL;
}

static SporeVec3 gravity_of(const SporeDocument *document) {
  SporeEnvironmentFields fields;
  spore_object_fields(spore_document_section(document, "environment"), &fields);
  return spore_vec3_load(fields.gravity);
}

gboolean spore_edit_lay_patient(SporeDocument *document, const char *name, GError **error) {
  const SporePatientPosition *position = find(name, error);
  if (!position) return FALSE;
  double strength = spore_vec3_length(gravity_of(document));
  SporeVec3 gravity = spore_vec3_scale(strength > 0 ? strength : EARTH_M_S2, position->down);
  spore_document_begin(document, _("Lay the patient"));
  return spore_edit_finish(document, spore_edit_set_vector(document, spore_document_section(document, "environment"),
                                                           "gravity", gravity, error));
}

const SporePatientPosition *spore_patient_position_of(const SporeDocument *document) {
  SporeVec3 gravity = gravity_of(document);
  for (const SporePatientPosition *one = spore_patient_positions; one->name; one++) {
    SporeVec3 across = spore_vec3_cross(gravity, one->down);
    double along = spore_vec3_dot(gravity, one->down);
    if (along > 0 && spore_vec3_length(across) < ALIKE_RAD * along) return one;
  }
  return NULL;
}
