/* The kernel in a program of your own: a stone of 2 cm falls onto a table of spheres and comes to rest.
 *
 * Build and run it against an installed libspore (`meson install -C build`) with `make run` in this folder. The library
 * needs libc and libm alone; there is no window, no file and no thread here.
 *
 * All numbers are SI: metres, kilograms, seconds. A body has a mechanical model, which says how the body moves, and a
 * set of spheres, which says where the body is touched. Both are given in the body's own frame. */
#include <stdio.h>

#include <spore.h>

enum { TABLE, STONE, BODY_COUNT }; /* bodies are known by their number, in the order of the description */
enum { SIDE = 7, TABLE_SPHERES = SIDE * SIDE };

/* A rigid body from a closed surface mesh; NULL, and the reason in *error, when the model cannot be made.
 * Any other model is made in the same way: find its type, fill its parameters, hand over the geometry that it asks for
 * (`spore models NAME --json` lists both). */
static SporeModel *make_stone(SporeError *error) {
  /* A tetrahedron. Triangles turn counter-clockwise when they are seen from outside. */
  double corners[] = {0, 0, 0, .02, 0, 0, 0, .02, 0, 0, 0, .02};
  uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  SporeTriangleMesh mesh = {.vertex_count = 4, .triangle_count = 4, .vertices = corners, .triangles = triangles};
  SporeGeometry geometry = {.surface = &mesh}; /* read during `create` alone */

  const SporeModelType *type = spore_model_type_find(spore_model_registry, "rigid_body");
  void *fields = spore_allocate(1, type->parameters.size);
  if (!fields) return NULL;
  spore_parameters_set_initial(&type->parameters, fields); /* every parameter has a default */
  /* One parameter by its name, as a scene file would set it. The range is checked, and the unit is in the message. */
  const SporeParameter *density = &type->parameters.parameters[spore_parameter_find(&type->parameters, "density")];
  SporeValue value;
  SporeModel *model = NULL;
  if (spore_parameter_parse(density, "2500", &value, error)) {
    spore_parameter_store(density, &value, fields);
    model = type->create(&geometry, fields, error);
  }
  spore_free(fields);
  return model;
}

/* Spheres of 1 cm on a square of 7 x 7, three centimetres below the origin; x y z r each. */
static void place_table(double spheres[4 * TABLE_SPHERES]) {
  for (int i = 0; i < TABLE_SPHERES; i++) {
    double *sphere = spheres + 4 * i;
    sphere[0] = .01 * (i % SIDE - SIDE / 2);
    sphere[1] = -.03;
    sphere[2] = .01 * (i / SIDE - SIDE / 2);
    sphere[3] = .01;
  }
}

/* Puts the bodies together into a world. The world owns the models as soon as it is there; spheres and names need live
 * no longer than this call. */
static SporeWorld *make_world(SporeError *error) {
  const SporePose upright = {{0, 0, 0}, {1, 0, 0, 0}}; /* position, and orientation as a quaternion w x y z */
  double table[4 * TABLE_SPHERES], stone[] = {.005, .005, .005, .005};
  place_table(table);
  SporeSphereSet table_set = {.count = TABLE_SPHERES, .spheres = table}, stone_set = {.count = 1, .spheres = stone};
  SporeBodyDescription bodies[BODY_COUNT] = {
      [TABLE] = {.name = "table", .role = SPORE_UNMOVABLE, .pose = upright, .spheres = &table_set},
      [STONE] = {.name = "stone",
                 .role = SPORE_PASSIVE, /* moved by physics */
                 .model = make_stone(error),
                 .integrator = SPORE_INTEGRATOR_DEFAULT,
                 .pose = upright,
                 .spheres = &stone_set},
  };
  if (!bodies[STONE].model) return NULL;
  for (int i = 0; i < BODY_COUNT; i++) spore_parameters_set_initial(&spore_contact_parameters, &bodies[i].contact);

  SporeWorldDescription description = {.body_count = BODY_COUNT, .bodies = bodies, .gravity = {0, -9.81, 0}};
  spore_parameters_set_initial(&spore_solver_parameters, &description.solver); /* a step of 1 ms, among other things */
  SporeWorld *world = spore_world_create(&description, NULL, error);           /* NULL: no further threads */
  if (!world) bodies[STONE].model->type->destroy(bodies[STONE].model);         /* not owned by a world */
  return world;
}

int main(void) {
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = make_world(&error);
  if (!world) {
    fprintf(stderr, "%s: %s\n", error.place, error.message); /* where, what is wrong, what to do */
    return 1;
  }
  for (int step = 0; step < 500; step++) {
    spore_world_step(world); /* allocates nothing and locks nothing */
    /* The state of a rigid body: position of its centre of mass, then its orientation. Valid until the next step. */
    const double *q = spore_world_q(world, STONE);
    if (step % 100 == 99) printf("%.3f s: the stone is at %+.4f m\n", spore_world_time_s(world), q[1]);
  }
  /* The world never stops on bad numbers: its monitor takes the step again, and tells what happened. */
  const SporeMonitor *monitor = spore_world_monitor(world);
  double height = spore_world_q(world, STONE)[1];
  printf("%llu steps were taken again; the state's hash is %016llx\n", (unsigned long long)monitor->recoveries,
         (unsigned long long)spore_world_hash(world));
  spore_world_free(world);
  return height > -.03 && height < .01 ? 0 : 1;
}
