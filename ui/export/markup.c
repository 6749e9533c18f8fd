/* What formats of XML share that hold bodies: numbers, places in a body, and inertia. */
#include <string.h>

#include "ui/export/private.h"

void spore_export_attribute(GString *text, const char *name, const double *values, gsize count) {
  g_string_append_printf(text, " %s=\"", name);
  for (gsize i = 0; i < count; i++) {
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append_printf(text, "%s%s", i ? " " : "", g_ascii_formatd(number, sizeof number, "%.12g", values[i]));
  }
  g_string_append_c(text, '"');
}

gboolean spore_export_place(const SporeWorld *world, guint body, const double *points, gsize count, double **places,
                            GError **error) {
  SporeMapping mapping;
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_world_map(world, body, points, count, &mapping, &fault)) return spore_error_propagate(&fault, error);
  *places = g_memdup2(mapping.points, 3 * count * sizeof *points);
  spore_mapping_clear(&mapping);
  return TRUE;
}

SporeMat3 spore_export_inertia(const SporeModel *rigid, const double *q) {
  SporeMat3 turn = spore_quat_to_mat3(spore_quat_load(q + 3));
  return spore_mat3_multiply(spore_mat3_transpose(turn), spore_mat3_multiply(rigid->type->inertia(rigid, q), turn));
}
