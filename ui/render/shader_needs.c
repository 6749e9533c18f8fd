/* Which shaders a picture of a document needs: those that draw its bodies as stage_body.c builds them, and those that
 * every picture passes through. */
#include "ui/render/shader_needs.h"

#include "ui/render/passes.h"

static const SporeModel *model_of(const SporeSimulation *simulation, const SporeObject *object) {
  const SporeWorld *world = simulation->world;
  for (guint32 i = 0; i < spore_world_body_count(world); i++)
    if (simulation->body_object[i] == spore_object_id(object)) return spore_world_lod_model(world, i, SPORE_LOD_FINE);
  return NULL;
}

static gboolean names(const SporeObject *body, const char *unit, const char *property) {
  const SporeObject *object = spore_object_child_of(body, unit);
  return object && spore_object_text(object, property);
}

/* Smoke by its puffs; a surface of its own, or around liquid; else its spheres. */
static SporeProgramKind drawn_by(const SporeObject *body, const SporeModel *model) {
  gboolean particles = model && model->type->particles, own = model && spore_body_has_own_spheres(body);
  if (particles && model->type->particles->puff) return SPORE_PROGRAM_PUFF;
  if (names(body, "visual", "mesh") || (particles && own)) return SPORE_PROGRAM_SURFACE;
  if (names(body, "mechanical", "geometry")) return SPORE_PROGRAM_SURFACE;
  return names(body, "collision", "spheres") || own ? SPORE_PROGRAM_SPHERE : SPORE_PROGRAM_COUNT;
}

/* Whether a camera of the scene looks through a lens that bends lines, or gets wet. */
static gboolean has_lens(SporeDocument *document) {
  const SporeObject *tools = spore_document_section(document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    const SporeObject *tool = spore_object_child(tools, i);
    if (g_str_equal(spore_object_type(tool)->element, "camera") &&
        (spore_object_number(tool, "distortion") > 0 || spore_object_number(tool, "lens") > 0))
      return TRUE;
  }
  return FALSE;
}

GArray *spore_shader_needs(SporeDocument *document, const SporeSimulation *simulation) {
  static const SporeProgramKind always[] = {SPORE_PROGRAM_BACKGROUND, SPORE_PROGRAM_OCCLUSION, SPORE_PROGRAM_SMOOTH,
                                            SPORE_PROGRAM_GLOW, SPORE_PROGRAM_COMPOSITE};
  GArray *needs = g_array_new(FALSE, FALSE, sizeof(SporeShaderNeed));
  const SporeObject *bodies = spore_document_section(document, "bodies");
  guint counts[SPORE_PROGRAM_COUNT + 1] = {0};
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i);
    counts[drawn_by(body, model_of(simulation, body))]++;
  }
  for (int kind = 0; kind < SPORE_PROGRAM_COUNT; kind++) {
    gboolean needed = counts[kind] > 0 || (kind == SPORE_PROGRAM_LENS && has_lens(document));
    for (gsize i = 0; i < G_N_ELEMENTS(always); i++) needed |= always[i] == (SporeProgramKind)kind;
    const SporeShaderNeed need = {spore_program_name((SporeProgramKind)kind), counts[kind]};
    if (needed) g_array_append_val(needs, need);
  }
  return needs;
}
