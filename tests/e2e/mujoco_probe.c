/* mujoco_probe FILE SECONDS: loads a model into MuJoCo, runs it, and prints what MuJoCo makes of it as JSON. */
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>

static void print_row(const char *name, const mjtNum *values, int count) {
  printf("\"%s\": [", name);
  for (int i = 0; i < count; i++) printf("%s%.17g", i ? ", " : "", values[i]);
  printf("]");
}

static void print_bodies(const mjModel *model, const mjData *data) {
  printf("\"bodies\": {");
  for (int i = 1; i < model->nbody; i++) {
    printf("%s\"%s\": {\"mass\": %.17g, \"geoms\": %d, \"freedoms\": %d, ", i > 1 ? ", " : "",
           mj_id2name(model, mjOBJ_BODY, i), model->body_mass[i], model->body_geomnum[i], model->body_dofnum[i]);
    print_row("inertia", model->body_inertia + 3 * i, 3);
    printf(", ");
    print_row("position", data->xpos + 3 * i, 3);
    printf("}");
  }
  printf("}");
}

int main(int argc, char **argv) {
  char error[1000] = "";
  if (argc != 3) return 2;
  mjModel *model = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (!model) return fprintf(stderr, "%s\n", error), 1;
  mjData *data = mj_makeData(model);
  mj_forward(model, data);
  printf("{");
  print_bodies(model, data);
  printf(", ");
  print_row("lengths", data->ten_length, model->ntendon);
  printf(", ");
  print_row("rest", model->tendon_lengthspring, model->ntendon);
  printf(", ");
  print_row("stiffness", model->tendon_stiffness, model->ntendon);
  double seconds = strtod(argv[2], NULL);
  while (data->time < seconds - 1e-9) mj_step(model, data);
  mj_kinematics(model, data);
  printf(", \"equalities\": %d, \"warnings\": %d, \"after\": {", model->neq,
         data->warning[mjWARN_BADQACC].number + data->warning[mjWARN_BADQPOS].number +
             data->warning[mjWARN_CNSTRFULL].number);
  print_bodies(model, data);
  printf("}}\n");
  mj_deleteData(data);
  mj_deleteModel(model);
  return 0;
}
