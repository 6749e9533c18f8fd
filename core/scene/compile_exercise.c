/* Describes the exercise of a document, and makes it for the world that was made of that. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/camera_sight.h"
#include "core/scene/compile_private.h"

/* An exercise that is put together. */
typedef struct Maker {
  SporeCompiler *compiler;
  GPtrArray *instrument_objects, *view_objects, *step_objects; /* by index in the exercise */
  GArray *instruments, *views, *steps, *metrics;               /* of the parts of its description */
} Maker;

/* The bodies of an instrument, as its parameters list them; the first is the one that its device moves. */
static gboolean find_bodies(Maker *maker, const SporeObject *tool, SporeInstrument *instrument) {
  static const char *const bodies[SPORE_TOOL_BODIES] = {"body", "jaw_a", "jaw_b"};
  for (int k = 0; k < SPORE_TOOL_BODIES; k++) {
    instrument->bodies[k] = SPORE_NO_BODY;
    if (spore_parameter_find(spore_object_type(tool)->table, bodies[k]) >= 0 &&
        !spore_compiler_body_index(maker->compiler, tool, bodies[k], &instrument->bodies[k]))
      return FALSE;
  }
  return TRUE;
}

static gboolean add_view(Maker *maker, SporeObject *camera) {
  SporeCameraFields fields;
  spore_object_fields(camera, &fields);
  SporeView view = {.position = spore_vec3_load(fields.position),
                    .target = spore_camera_sight(&fields),
                    .field_of_view = fields.field_of_view};
  if (!spore_compiler_body_index(maker->compiler, camera, "body", &view.body)) return FALSE;
  g_array_append_val(maker->views, view);
  g_ptr_array_add(maker->view_objects, camera);
  return TRUE;
}

static gboolean add_instrument(Maker *maker, SporeObject *tool, guint32 *tools) {
  const char *element = spore_object_type(tool)->element;
  SporeInstrument instrument = {.name = spore_object_name(tool)};
  instrument.tool = spore_tool_type_find(element) ? (*tools)++ : SPORE_NO_PART;
  if (!find_bodies(maker, tool, &instrument)) return FALSE;
  if (instrument.bodies[0] == SPORE_NO_BODY) return TRUE; /* said by spore check */
  g_array_append_val(maker->instruments, instrument);
  g_ptr_array_add(maker->instrument_objects, tool);
  return TRUE;
}

static gboolean add_tools(Maker *maker) {
  const SporeObject *section = spore_document_section(maker->compiler->document, "tools");
  guint32 tools = 0;
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *tool = spore_object_child(section, i);
    gboolean camera = strcmp(spore_object_type(tool)->element, "camera") == 0;
    if (camera ? !add_view(maker, tool) : !add_instrument(maker, tool, &tools)) return FALSE;
  }
  return TRUE;
}

/* Index among the objects of the one that a reference names; SPORE_NO_PART: the kind has no such reference, or it is
 * not set. */
static gboolean find_part(Maker *maker, const SporeObject *object, const char *property, GPtrArray *objects,
                          guint32 *index) {
  SporeObject *target = NULL;
  guint found;
  *index = SPORE_NO_PART;
  if (spore_parameter_find(spore_object_type(object)->table, property) < 0) return TRUE;
  if (!spore_compiler_resolve(maker->compiler, object, property, &target)) return FALSE;
  if (target && g_ptr_array_find(objects, target, &found)) *index = found;
  return TRUE;
}

static gboolean find_body(Maker *maker, const SporeObject *object, const char *property, guint32 *index) {
  *index = SPORE_NO_BODY;
  if (spore_parameter_find(spore_object_type(object)->table, property) < 0) return TRUE;
  return spore_compiler_body_index(maker->compiler, object, property, index);
}

static gboolean lacks(Maker *maker, const SporeObject *object, const char *what) {
  return spore_compiler_refuse(maker->compiler, object, _("\"%s\" names no %s; expected one; set it"),
                               spore_object_name(object), what);
}

static gboolean add_step(Maker *maker, SporeObject *object, const SporeEventKind *kind) {
  SporeExerciseStep step = {.kind = kind};
  spore_object_fields(object, &step.fields);
  if (!find_body(maker, object, "body", &step.body) || !find_body(maker, object, "container", &step.container) ||
      !find_part(maker, object, "tool", maker->instrument_objects, &step.instrument) ||
      !find_part(maker, object, "after", maker->step_objects, &step.after))
    return FALSE;
  if (kind->needs_body && step.body == SPORE_NO_BODY) return lacks(maker, object, "body");
  if (!kind->needs_body && step.body == SPORE_NO_BODY && step.instrument == SPORE_NO_PART)
    return lacks(maker, object, "body or tool");
  gboolean contains = spore_parameter_find(spore_object_type(object)->table, "container") >= 0;
  if (contains && step.container == SPORE_NO_BODY) return lacks(maker, object, "container");
  g_array_append_val(maker->steps, step);
  return TRUE;
}

/* NULL: the body does not deform, and nothing but contact moves it. */
static const SporeModelType *model_type(const SporeCompiler *compiler, guint32 body) {
  guint fine = SPORE_LOD_COUNT * body + SPORE_LOD_FINE;
  return g_array_index(compiler->recipes, SporeModelRecipe, fine).type;
}

static gboolean is_fluid(const SporeCompiler *compiler, guint32 body) {
  const SporeModelType *type = model_type(compiler, body);
  return type && type->particles;
}

static gboolean knows_strain(const SporeCompiler *compiler, guint32 body) {
  const SporeModelType *type = model_type(compiler, body);
  return type && type->strain;
}

static gboolean add_metric(Maker *maker, SporeObject *object, const SporeMetricKind *kind) {
  SporeExerciseMetric metric = {.kind = kind};
  spore_object_fields(object, &metric.fields);
  if (!find_body(maker, object, "body", &metric.body) ||
      !find_part(maker, object, "tool", maker->instrument_objects, &metric.instrument) ||
      !find_part(maker, object, "camera", maker->view_objects, &metric.view))
    return FALSE;
  if (kind->needs_body && metric.body == SPORE_NO_BODY) return lacks(maker, object, "body");
  if (kind->needs_view && metric.view == SPORE_NO_PART) return lacks(maker, object, "camera");
  if (kind->needs_fluid && !is_fluid(maker->compiler, metric.body))
    return spore_compiler_refuse(maker->compiler, object,
                                 _("body=\"%s\" is no fluid; expected one of particles; choose another body"),
                                 metric.fields.body);
  if (kind->needs_strain && !knows_strain(maker->compiler, metric.body))
    return spore_compiler_refuse(maker->compiler, object,
                                 _("body=\"%s\" has no strain that is known; expected a net, a deformable surface, a "
                                   "spline, an intestine, a grid, or tetrahedra that are not condensed; choose "
                                   "another body"),
                                 metric.fields.body);
  g_array_append_val(maker->metrics, metric);
  return TRUE;
}

static gboolean add_parts(Maker *maker, const SporeObject *section) {
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *object = spore_object_child(section, i);
    if (spore_event_kind_find(spore_object_type(object)->element)) g_ptr_array_add(maker->step_objects, object);
  }
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *object = spore_object_child(section, i);
    const char *element = spore_object_type(object)->element;
    const SporeEventKind *step = spore_event_kind_find(element);
    if (step ? !add_step(maker, object, step) : !add_metric(maker, object, spore_metric_kind_find(element)))
      return FALSE;
  }
  return TRUE;
}

/* What the description borrows lives as long as the compilation. */
static gconstpointer keep(const Maker *maker, GArray *array) {
  gpointer data = g_array_free(array, FALSE);
  if (data) g_ptr_array_add(maker->compiler->kept, data);
  return data;
}

static void describe(const Maker *maker, const SporeObject *section, SporeExerciseDescription *description) {
  SporeEnvironmentFields environment;
  spore_object_fields(spore_document_section(maker->compiler->document, "environment"), &environment);
  *description = (SporeExerciseDescription){.up = spore_vec3_scale(-1, spore_vec3_load(environment.gravity)),
                                            .instrument_count = maker->instruments->len,
                                            .view_count = maker->views->len,
                                            .step_count = maker->steps->len,
                                            .metric_count = maker->metrics->len};
  spore_object_fields(section, &description->fields);
  description->instruments = keep(maker, maker->instruments);
  description->views = keep(maker, maker->views);
  description->steps = keep(maker, maker->steps);
  description->metrics = keep(maker, maker->metrics);
}

gboolean spore_compiler_describe_exercise(SporeCompiler *compiler, SporeExerciseDescription *description) {
  const SporeObject *section = spore_document_section(compiler->document, "exercise");
  *description = (SporeExerciseDescription){.step_count = 0};
  if (spore_object_child_count(section) == 0) return TRUE;
  Maker maker = {.compiler = compiler};
  maker.instrument_objects = g_ptr_array_new();
  maker.view_objects = g_ptr_array_new();
  maker.step_objects = g_ptr_array_new();
  maker.instruments = g_array_new(FALSE, TRUE, sizeof(SporeInstrument));
  maker.views = g_array_new(FALSE, TRUE, sizeof(SporeView));
  maker.steps = g_array_new(FALSE, TRUE, sizeof(SporeExerciseStep));
  maker.metrics = g_array_new(FALSE, TRUE, sizeof(SporeExerciseMetric));
  gboolean whole = add_tools(&maker) && add_parts(&maker, section);
  describe(&maker, section, description);
  g_ptr_array_unref(maker.instrument_objects);
  g_ptr_array_unref(maker.view_objects);
  g_ptr_array_unref(maker.step_objects);
  return whole;
}

gboolean spore_compiler_create_exercise(SporeCompiler *compiler, const SporeExerciseDescription *description,
                                        const SporeWorld *world, SporeExercise **exercise) {
  SporeError fault = SPORE_ERROR_INIT;
  *exercise = NULL;
  if (description->step_count + description->metric_count == 0) return TRUE;
  *exercise = spore_exercise_create(description, world, &fault);
  if (!*exercise) spore_compiler_say_in_scene(compiler, &fault);
  return *exercise != NULL;
}
