/* What a program outside needs: a stone falls onto a table of spheres and lies still. */
#include <math.h>
#include <stdio.h>

#include <spore.h>

static SporeModel *make_stone(SporeError *error) {
  static double corners[] = {0, 0, 0, .02, 0, 0, 0, .02, 0, 0, 0, .02};
  static uint32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  SporeTriangleMesh mesh = {.vertex_count = 4, .triangle_count = 4, .vertices = corners, .triangles = faces};
  SporeGeometry geometry = {.surface = &mesh};
  const SporeModelType *type = spore_model_type_find(spore_model_registry, "rigid_body");
  void *fields = spore_allocate(1, type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  SporeModel *model = type->create(&geometry, fields, error);
  spore_free(fields);
  return model;
}

int main(void) {
  SporeError error = SPORE_ERROR_INIT;
  double table[4 * 49], stone[] = {.005, .005, .005, .005};
  for (int i = 0; i < 49; i++)
    table[4 * i] = .01 * (i % 7) - .03, table[4 * i + 1] = -.03, table[4 * i + 2] = .01 * (i / 7) - .03,
              table[4 * i + 3] = .01;
  SporeSphereSet table_set = {.count = 49, .spheres = table}, stone_set = {.count = 1, .spheres = stone};
  SporeBodyDescription bodies[2] = {
      {.name = "table", .role = SPORE_UNMOVABLE, .pose = {{0, 0, 0}, {1, 0, 0, 0}}, .spheres = &table_set},
      {.name = "stone",
       .role = SPORE_PASSIVE,
       .model = make_stone(&error),
       .integrator = SPORE_INTEGRATOR_DEFAULT,
       .pose = {{0, 0, 0}, {1, 0, 0, 0}},
       .spheres = &stone_set}};
  for (int i = 0; i < 2; i++) spore_parameters_set_initial(&spore_contact_parameters, &bodies[i].contact);
  SporeWorldDescription description = {.body_count = 2, .bodies = bodies, .gravity = {0, -9.81, 0}};
  spore_parameters_set_initial(&spore_solver_parameters, &description.solver);
  SporeWorld *world = bodies[1].model ? spore_world_create(&description, NULL, &error) : NULL;
  if (!world) {
    fprintf(stderr, "%s: %s\n", error.place, error.message);
    return 1;
  }
  for (int i = 0; i < 500; i++) spore_world_step(world);
  double height = spore_world_q(world, 1)[1];
  printf("after %g s the stone lies at %g m\n", spore_world_time_s(world), height);
  spore_world_free(world);
  return height > -.03 && height < .01 ? 0 : 1;
}
