/* Cases of case.h by MuJoCo, built from its own composites: rope, string, cloth and pile. */
#include <math.h>
#include <mujoco/mujoco.h>

#include "case.h"

#define HEAD                                                                                                           \
  "<mujoco><option timestep='%g' gravity='0 -9.81 0' integrator='%s' solver='%s' iterations='%d' jacobian='auto'/>"    \
  "<size njmax='8000' nconmax='2000' nstack='%d'/><visual/><worldbody>"
#define TAIL "</worldbody></mujoco>"

static mjModel *load(const char *text) {
  static mjVFS files;
  char error[512] = "";
  mj_defaultVFS(&files);
  mj_makeEmptyFileVFS(&files, "case.xml", (int)strlen(text));
  memcpy(files.filedata[0], text, strlen(text));
  mjModel *model = mj_loadXML("case.xml", &files, error, sizeof error);
  mj_deleteVFS(&files);
  if (!model) fprintf(stderr, "%s\n", error), exit(1);
  return model;
}

static char text[400000];

static char *head(CaseRun *run) {
  return text + sprintf(text, HEAD, case_time_step(run), case_word(run, "integrator", "Euler"),
                        case_word(run, "solver", "Newton"), (int)case_number(run, "iterations", 100),
                        (int)case_number(run, "stack", 4e6));
}

static void composite(CaseRun *run, const char *type, const char *count, double spacing, const char *geometry) {
  char *to = head(run);
  sprintf(to,
          "<body name='B0' pos='0 0 0'><composite type='%s' count='%s' spacing='%g' offset='0 0 0'>%s</composite>"
          "</body>" TAIL,
          type, count, spacing, geometry);
}

static void build(CaseRun *run, const char *name) {
  if (!strcmp(name, "rope"))
    composite(run, "rope", "64 1 1", ROPE_LENGTH / (ROPE_NODES - 1),
              "<joint kind='main' damping='0.0001'/><geom type='capsule' size='0.003 0.007' contype='0' conaffinity='0'"
              " mass='0.0015625'/>");
  else if (!strcmp(name, "string"))
    composite(run, "grid", "64 1 1", ROPE_LENGTH / (ROPE_NODES - 1),
              "<pin coord='0'/><geom size='0.003' contype='0' conaffinity='0' mass='0.0015625'/>");
  else if (!strcmp(name, "cloth"))
    composite(run, "grid", "20 20 1", CLOTH_SIDE / (CLOTH_NODES - 1),
              "<pin coord='0 0'/><pin coord='19 0'/><geom size='0.01' contype='0' conaffinity='0' mass='0.0025'/>");
  else exit(2);
}

static void build_pile(CaseRun *run) {
  static const char *walls[5] = {"0 0 0' zaxis='0 1 0", "%g 0 0' zaxis='1 0 0", "%g 0 0' zaxis='-1 0 0",
                                 "0 0 %g' zaxis='0 0 1", "0 0 %g' zaxis='0 0 -1"};
  unsigned spheres = (unsigned)case_number(run, "spheres", PILE_SPHERES);
  char *to = head(run);
  for (int i = 0; i < 5; i++) {
    char place[80];
    snprintf(place, sizeof place, walls[i], i % 2 ? -PILE_HALF : PILE_HALF);
    to += sprintf(to, "<geom type='plane' size='5 5 1' friction='%g' pos='%s'/>", PILE_FRICTION, place);
  }
  for (unsigned i = 0; i < spheres; i++) {
    double x[3];
    pile_start(run, i, x);
    to += sprintf(to, "<body pos='%g %g %g'><freejoint/><geom size='%g' density='%g' friction='%g'/></body>", x[0],
                  x[1], x[2], PILE_RADIUS, PILE_DENSITY, PILE_FRICTION);
  }
  sprintf(to, TAIL);
}

int main(int argc, char **argv) {
  CaseRun run = case_begin(argc, argv);
  const char *name = argc > 1 ? argv[1] : "";
  if (!strcmp(name, "pile")) build_pile(&run);
  else build(&run, name);
  mjModel *model = load(text);
  mjData *data = mj_makeData(model);
  for (unsigned i = 0; i < (unsigned)case_number(&run, "settle", 0); i++) mj_step(model, data);
  for (unsigned count; (count = case_next_frame(&run));) {
    for (unsigned i = 0; i < count; i++) mj_step(model, data);
    case_stop(&run);
    for (int b = 1; b < model->nbody; b++)
      case_node(&run, data->xpos[3 * b], data->xpos[3 * b + 1], data->xpos[3 * b + 2]);
  }
  double depth = 0;
  for (int i = 0; i < data->ncon; i++) depth -= data->contact[i].dist / data->ncon;
  char more[128];
  snprintf(more, sizeof more, ", \"contacts\": %d, \"depth\": %.6g", data->ncon, depth / PILE_RADIUS);
  case_end(&run, more);
  mj_deleteData(data);
  mj_deleteModel(model);
  return 0;
}
