/* The table of quantities, and measuring them. */
#include "core/measure/quantities.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/momentum.h"

struct SporeMeasurement {
  const SporeWorld *world;
  size_t point_count, point_made; /* asked for; made so far */
  char **point_names;
  SporeWatch *points;
  bool chosen[SPORE_QUANTITY_COUNT];
  size_t column_count;
  SporeColumn *columns;
  bool summed; /* momentum and angular are those of the state that is being measured */
  SporeVec3 momentum, angular;
};

/* Sums over bodies. */

static void measure_time(SporeMeasurement *measurement, size_t i, double *values) {
  values[0] = spore_world_time_s(measurement->world);
}

static void measure_energy(SporeMeasurement *measurement, size_t i, double *values) {
  SporeEnergy energy = spore_world_energy(measurement->world);
  const double parts[] = {energy.kinetic, energy.internal, energy.gravity, energy.contact,
                          energy.kinetic + energy.internal + energy.gravity + energy.contact};
  memcpy(values, parts, sizeof parts);
}

/* Momentum and angular momentum, about the origin of the scene, of all that physics moves; once a row. */
static void sum_momentum(SporeMeasurement *measurement) {
  const SporeVec3 origin = {0, 0, 0};
  const SporeWorld *world = measurement->world;
  if (measurement->summed) return;
  measurement->summed = true;
  measurement->momentum = measurement->angular = origin;
  for (uint32_t body = 0; body < spore_world_body_count(world); body++) {
    const SporeModel *model = spore_world_body_model(world, body);
    if (!model) continue;
    SporeMotion motion = spore_model_motion(model, spore_world_q(world, body), spore_world_v(world, body), &origin);
    measurement->momentum = spore_vec3_add(measurement->momentum, motion.momentum);
    measurement->angular = spore_vec3_add(measurement->angular, motion.angular);
  }
}

static void measure_momentum(SporeMeasurement *measurement, size_t i, double *values) {
  sum_momentum(measurement);
  spore_vec3_store(values, measurement->momentum);
}

static void measure_angular_momentum(SporeMeasurement *measurement, size_t i, double *values) {
  sum_momentum(measurement);
  spore_vec3_store(values, measurement->angular);
}

static void measure_contacts(SporeMeasurement *measurement, size_t i, double *values) {
  SporeStepCounts counts = spore_world_counts(measurement->world);
  values[0] = (double)counts.contacts;
  values[1] = counts.contact_depth;
  values[2] = counts.contact_force;
}

/* The solver and the clock. */

static void measure_solver(SporeMeasurement *measurement, size_t i, double *values) {
  SporeStepCounts counts = spore_world_counts(measurement->world);
  values[0] = counts.residual;
  values[1] = (double)counts.newton_iterations;
  values[2] = (double)counts.linear_iterations;
  values[3] = (double)counts.force_evaluations;
}

static void measure_unsolved(SporeMeasurement *measurement, size_t i, double *values) {
  const SporeWorld *world = measurement->world;
  values[0] = 0;
  for (size_t k = 0; k < spore_world_unsolved_count(world); k++)
    values[0] += (double)spore_world_unsolved(world, k).steps;
}

static double last_us(const SporeProfilePhase *phase) {
  return phase && phase->count > 0 ? 1e-3 * (double)spore_profile_last_ns(phase) : NAN;
}

static void measure_step_time(SporeMeasurement *measurement, size_t i, double *values) {
  values[0] = last_us(spore_world_profile(measurement->world));
}

static size_t stage_count(const SporeMeasurement *measurement) {
  return spore_world_plan(measurement->world)->stage_count;
}

static const char *stage_name(const SporeMeasurement *measurement, size_t i) {
  const SporePlanStage *stage = &spore_world_plan(measurement->world)->stages[i];
  return stage->included ? stage->name : NULL;
}

static void measure_stage(SporeMeasurement *measurement, size_t i, double *values) {
  values[0] = last_us(spore_world_plan(measurement->world)->stages[i].profile);
}

/* Links. */

static size_t link_count(const SporeMeasurement *measurement) { return spore_world_link_count(measurement->world); }

static const char *link_name(const SporeMeasurement *measurement, size_t i) {
  return spore_world_link_state(measurement->world, i).name;
}

static void measure_link(SporeMeasurement *measurement, size_t i, double *values) {
  SporeLinkState state = spore_world_link_state(measurement->world, i);
  spore_vec3_store(values, state.force);
  values[3] = state.load;
  values[4] = state.drift;
}

/* Bodies. */

static size_t body_count(const SporeMeasurement *measurement) { return spore_world_body_count(measurement->world); }

static const char *name_of_role(const SporeMeasurement *measurement, size_t i, bool wanted) {
  return wanted ? spore_world_body_name(measurement->world, (uint32_t)i) : NULL;
}

static const char *prescribed_name(const SporeMeasurement *measurement, size_t i) {
  return name_of_role(measurement, i, spore_world_body_role(measurement->world, (uint32_t)i) != SPORE_PASSIVE);
}

static void measure_reaction(SporeMeasurement *measurement, size_t i, double *values) {
  memcpy(values, spore_world_reaction(measurement->world, (uint32_t)i), 6 * sizeof *values);
}

static const char *driven_name(const SporeMeasurement *measurement, size_t i) {
  return name_of_role(measurement, i, spore_world_feedback(measurement->world, (uint32_t)i) != NULL);
}

static void measure_feedback(SporeMeasurement *measurement, size_t i, double *values) {
  const SporeDeviceCommand *command = spore_world_feedback(measurement->world, (uint32_t)i);
  for (int k = 0; k < 7; k++) values[k] = NAN;
  if (!command) return;
  memcpy(values, command->force, sizeof command->force);
  memcpy(values + 3, command->torque, sizeof command->torque);
  values[6] = command->grip_N;
}

static const char *moving_name(const SporeMeasurement *measurement, size_t i) {
  return name_of_role(measurement, i, spore_world_body_role(measurement->world, (uint32_t)i) != SPORE_UNMOVABLE);
}

/* Centre of mass and its velocity; of particles, of those that are in the world. */
static void measure_centre(const SporeModel *model, const double *q, const double *v, double *values) {
  SporeVec3 position = {0, 0, 0}, velocity = {0, 0, 0};
  double mass = 0;
  for (size_t i = 0; i < model->node_count; i++) {
    if (model->type->particles && spore_particle_is_out(q + 3 * i)) continue;
    mass += model->block_mass[i];
    position = spore_vec3_add_scaled(position, model->block_mass[i], spore_vec3_load(q + 3 * i));
    velocity = spore_vec3_add_scaled(velocity, model->block_mass[i], spore_vec3_load(v + 3 * i));
  }
  double share = mass > 0 ? 1 / mass : NAN;
  spore_vec3_store(values, spore_vec3_scale(share, position));
  spore_vec3_store(values + 3, spore_vec3_scale(share, velocity));
}

/* What a device moves has no mass: the origin of its frame stands for the centre. */
static void measure_body(SporeMeasurement *measurement, size_t i, double *values) {
  const SporeWorld *world = measurement->world;
  const SporeModel *model = spore_world_body_model(world, (uint32_t)i);
  const double *q = spore_world_q(world, (uint32_t)i), *v = spore_world_v(world, (uint32_t)i);
  if (model) {
    measure_centre(model, q, v, values);
  } else {
    memcpy(values, q, 3 * sizeof *values);
    memcpy(values + 3, v, 3 * sizeof *values);
  }
}

/* Watched points. */

static size_t point_count(const SporeMeasurement *measurement) { return measurement->point_made; }

static const char *point_name(const SporeMeasurement *measurement, size_t i) { return measurement->point_names[i]; }

static void measure_point(SporeMeasurement *measurement, size_t i, double *values) {
  spore_watch_measure(&measurement->points[i], measurement->world, values, values + 3);
}

#define PARTS(...)                                                                                                     \
  sizeof((SporeQuantityPart[]){__VA_ARGS__}) / sizeof(SporeQuantityPart), (const SporeQuantityPart[]) { __VA_ARGS__ }
#define FORCE                                                                                                          \
  {"x", "N"}, {"y", "N"}, { "z", "N" }
#define TORQUE                                                                                                         \
  {"torque_x", "N m"}, {"torque_y", "N m"}, { "torque_z", "N m" }
#define MOTION                                                                                                         \
  {"x", "m"}, {"y", "m"}, {"z", "m"}, {"velocity_x", "m/s"}, {"velocity_y", "m/s"}, { "velocity_z", "m/s" }

const SporeQuantity spore_quantities[SPORE_QUANTITY_COUNT] = {
    {"time", N_("simulated time; always there"), SPORE_QUANTITY_ALWAYS, PARTS({"", "s"}), NULL, NULL, measure_time},
    {"energy", N_("kinetic, elastic (with links), of gravity, of contacts, and total"), SPORE_QUANTITY_USUAL,
     PARTS({"kinetic", "J"}, {"elastic", "J"}, {"gravity", "J"}, {"contact", "J"}, {"total", "J"}), NULL, NULL,
     measure_energy},
    {"momentum", N_("of all that physics moves"), SPORE_QUANTITY_USUAL, PARTS({"x", "N s"}, {"y", "N s"}, {"z", "N s"}),
     NULL, NULL, measure_momentum},
    {"angular_momentum", N_("of all that physics moves, about the origin of the scene"), SPORE_QUANTITY_USUAL,
     PARTS({"x", "N m s"}, {"y", "N m s"}, {"z", "N m s"}), NULL, NULL, measure_angular_momentum},
    {"contacts",
     N_("of bodies that are awake: how many, depth of the deepest when the step began, sum of their normal forces"),
     SPORE_QUANTITY_USUAL, PARTS({"count", ""}, {"depth", "m"}, {"force", "N"}), NULL, NULL, measure_contacts},
    {"solver", N_("of the step: relative residual, Newton iterations, linear iterations, evaluations of the forces"),
     SPORE_QUANTITY_USUAL, PARTS({"residual", ""}, {"newton", ""}, {"linear", ""}, {"evaluations", ""}), NULL, NULL,
     measure_solver},
    {"unsolved", N_("steps so far that were not solved as the scene is written, of all bodies and causes"),
     SPORE_QUANTITY_USUAL, PARTS({"steps", ""}), NULL, NULL, measure_unsolved},
    {"watch", N_("position and velocity of each point of --watch"), SPORE_QUANTITY_USUAL, PARTS(MOTION), point_count,
     point_name, measure_point},
    {"bodies",
     N_("position and velocity of the centre of mass of each body that moves; of what a device moves, of its "
        "frame"),
     SPORE_QUANTITY_ASKED, PARTS(MOTION), body_count, moving_name, measure_body},
    {"links", N_("of each link but pins: force on its first body, load, and how far apart it is"), SPORE_QUANTITY_USUAL,
     PARTS(FORCE, {"load", "N"}, {"drift", "m"}), link_count, link_name, measure_link},
    {"reactions", N_("of contacts and links: force and torque on each body that physics does not move"),
     SPORE_QUANTITY_ASKED, PARTS(FORCE, TORQUE), body_count, prescribed_name, measure_reaction},
    {"devices", N_("what each device is told: force, torque, and force on the grip"), SPORE_QUANTITY_USUAL,
     PARTS(FORCE, TORQUE, {"grip", "N"}), body_count, driven_name, measure_feedback},
    {"step_time", N_("time of the clock that the step took"), SPORE_QUANTITY_ASKED, PARTS({"", "us"}), NULL, NULL,
     measure_step_time},
    {"stages", N_("the same by stages of the step"), SPORE_QUANTITY_ASKED, PARTS({"", "us"}), stage_count, stage_name,
     measure_stage},
};

size_t spore_quantity_find(const char *name, size_t length) {
  size_t i = 0;
  while (i < SPORE_QUANTITY_COUNT &&
         !(strlen(spore_quantities[i].name) == length && memcmp(spore_quantities[i].name, name, length) == 0))
    i++;
  return i;
}

/* Columns. */

static size_t item_count(const SporeMeasurement *measurement, const SporeQuantity *quantity) {
  return quantity->items ? quantity->items(measurement) : 1;
}

/* NULL: the item has no such quantity. "": there is but one. */
static const char *item_name(const SporeMeasurement *measurement, const SporeQuantity *quantity, size_t i) {
  return quantity->items ? quantity->item(measurement, i) : "";
}

static char *column_name(const char *quantity, const char *item, const char *part) {
  size_t size = strlen(quantity) + strlen(item) + strlen(part) + 3;
  char *name = SPORE_NEW_ARRAY(char, size);
  if (name) snprintf(name, size, "%s%s%s%s%s", quantity, *item ? "." : "", item, *part ? "." : "", part);
  return name;
}

static bool add_columns(SporeMeasurement *measurement, size_t index, size_t i, const char *item) {
  const SporeQuantity *quantity = &spore_quantities[index];
  for (size_t part = 0; part < quantity->part_count; part++) {
    SporeColumn *column = &measurement->columns[measurement->column_count];
    column->name = column_name(quantity->name, item, quantity->parts[part].name);
    column->unit = quantity->parts[part].unit;
    column->quantity = index;
    column->item = i;
    if (!column->name) return false;
    measurement->column_count++;
  }
  return true;
}

static bool make_columns(SporeMeasurement *measurement) {
  size_t most = 0;
  for (size_t k = 0; k < SPORE_QUANTITY_COUNT; k++)
    most += spore_quantities[k].part_count * item_count(measurement, &spore_quantities[k]);
  measurement->columns = SPORE_NEW_ARRAY(SporeColumn, most);
  if (!measurement->columns) return false;
  for (size_t k = 0; k < SPORE_QUANTITY_COUNT; k++)
    for (size_t i = 0; measurement->chosen[k] && i < item_count(measurement, &spore_quantities[k]); i++) {
      const char *item = item_name(measurement, &spore_quantities[k], i);
      if (item && !add_columns(measurement, k, i, item)) return false;
    }
  return true;
}

static bool make_points(SporeMeasurement *measurement, const SporeWatchRequest *points, SporeError *error) {
  for (size_t i = 0; i < measurement->point_count; i++, measurement->point_made++) {
    measurement->point_names[i] = spore_copy_text(points[i].name);
    if (!measurement->point_names[i]) return false;
    if (!spore_watch_init(&measurement->points[i], measurement->world, points[i].body, points[i].at, error)) {
      spore_error_at(error, points[i].name);
      spore_free(measurement->point_names[i]);
      return false;
    }
  }
  return true;
}

SporeMeasurement *spore_measurement_create(const SporeWorld *world, const bool *chosen, const SporeWatchRequest *points,
                                           size_t point_count, SporeError *error) {
  SporeMeasurement *measurement = SPORE_NEW(SporeMeasurement);
  if (error) *error = SPORE_ERROR_INIT;
  if (measurement) {
    measurement->world = world;
    measurement->point_count = point_count;
    for (size_t k = 0; k < SPORE_QUANTITY_COUNT; k++) {
      SporeQuantityUse use = spore_quantities[k].use;
      bool wanted = chosen ? chosen[k] : use == SPORE_QUANTITY_USUAL;
      measurement->chosen[k] = use == SPORE_QUANTITY_ALWAYS || wanted || spore_quantities[k].measure == measure_point;
    }
    measurement->point_names = SPORE_NEW_ARRAY(char *, point_count);
    measurement->points = SPORE_NEW_ARRAY(SporeWatch, point_count);
    if (measurement->point_names && measurement->points && make_points(measurement, points, error) &&
        make_columns(measurement))
      return measurement;
  }
  spore_measurement_free(measurement);
  if (!error || error->code == SPORE_ERROR_NONE)
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                    _("not enough memory to measure the run; choose fewer quantities"));
  return NULL;
}

void spore_measurement_free(SporeMeasurement *measurement) {
  if (!measurement) return;
  for (size_t i = 0; i < measurement->point_made; i++) {
    spore_free(measurement->point_names[i]);
    spore_watch_clear(&measurement->points[i]);
  }
  for (size_t i = 0; i < measurement->column_count; i++) spore_free(measurement->columns[i].name);
  spore_free(measurement->point_names);
  spore_free(measurement->points);
  spore_free(measurement->columns);
  spore_free(measurement);
}

const SporeColumn *spore_measurement_columns(const SporeMeasurement *measurement, size_t *count) {
  *count = measurement->column_count;
  return measurement->columns;
}

void spore_measurement_take(SporeMeasurement *measurement, double *row) {
  measurement->summed = false;
  for (size_t c = 0; c < measurement->column_count;) {
    const SporeColumn *column = &measurement->columns[c];
    const SporeQuantity *quantity = &spore_quantities[column->quantity];
    quantity->measure(measurement, column->item, row + c);
    c += quantity->part_count;
  }
}
