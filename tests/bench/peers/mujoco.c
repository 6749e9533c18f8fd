/* Cases of case.h by MuJoCo, built from its own composites: rope, string, cloth and pile. With springs=1 rope and cloth
 * are the system of case.h itself: nodes on three slides each, a spring between two of them as a spatial tendon. */
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

static char text[1000000];

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

static char *add_node(char *to, unsigned i, const double x[3], double mass, int held) {
  to += sprintf(to, "<body pos='%.17g %.17g %.17g'>", x[0], x[1], x[2]);
  for (int axis = 0; axis < 3 && !held; axis++)
    to += sprintf(to, "<joint type='slide' axis='%d %d %d'/>", axis == 0, axis == 1, axis == 2);
  return to + sprintf(to, "<inertial pos='0 0 0' mass='%.17g' diaginertia='1e-6 1e-6 1e-6'/><site name='%u'/></body>",
                      mass, i);
}

static char *add_spring(char *to, const CaseRun *run, unsigned a, unsigned b, const double x[3], const double y[3],
                        double stiffness, double damping) {
  double square = 0;
  for (int k = 0; k < 3; k++) square += (x[k] - y[k]) * (x[k] - y[k]);
  return to + sprintf(to,
                      "<spatial stiffness='%.17g' damping='%g' springlength='%.17g'><site site='%u'/><site site='%u'/>"
                      "</spatial>",
                      case_number(run, "stiffness", stiffness), damping, sqrt(square), a, b);
}

static void build_rope(CaseRun *run) {
  char *to = head(run);
  double x[ROPE_NODES][3] = {{0}};
  for (unsigned i = 0; i < ROPE_NODES; i++) {
    x[i][0] = i * ROPE_LENGTH / (ROPE_NODES - 1);
    to = add_node(to, i, x[i], ROPE_MASS / ROPE_NODES, i == 0);
  }
  to += sprintf(to, "</worldbody><tendon>");
  for (unsigned i = 1; i < ROPE_NODES; i++) to = add_spring(to, run, i - 1, i, x[i - 1], x[i], 1000, 0);
  sprintf(to, "</tendon></mujoco>");
}

static void build_cloth(CaseRun *run) {
  enum { NODES = CLOTH_NODES * CLOTH_NODES };
  static double x[NODES][3], mass[NODES];
  static char tied[NODES][NODES];
  char *to = head(run);
  unsigned corner[3];
  for (unsigned t = 0; t < CLOTH_TRIANGLES; t++) {
    cloth_triangle(t, corner);
    for (int k = 0; k < 3; k++) mass[corner[k]] += CLOTH_MASS / (3.0 * CLOTH_TRIANGLES);
  }
  for (unsigned i = 0; i < NODES; i++) {
    cloth_node(i, x[i]);
    to = add_node(to, i, x[i], mass[i], i < CLOTH_NODES);
  }
  to += sprintf(to, "</worldbody><tendon>");
  for (unsigned t = 0; t < CLOTH_TRIANGLES; t++) {
    cloth_triangle(t, corner);
    for (int k = 0; k < 3; k++) {
      unsigned a = corner[k], b = corner[(k + 1) % 3], low = a < b ? a : b, high = a < b ? b : a;
      if (!tied[low][high]) to = add_spring(to, run, low, high, x[low], x[high], 100, CLOTH_DAMPING);
      tied[low][high] = 1;
    }
  }
  sprintf(to, "</tendon></mujoco>");
}

static void build_composite(CaseRun *run, const char *name) {
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

static void build(CaseRun *run, const char *name) {
  int springs = case_number(run, "springs", 0) != 0;
  if (springs && !strcmp(name, "rope")) build_rope(run);
  else if (springs && !strcmp(name, "cloth")) build_cloth(run);
  else build_composite(run, name);
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

/* A run that broke down began again by itself, with a word on standard output: here it fails instead. */
static void keep_silent(const char *message) { (void)message; }
static void check(const mjData *data) {
  static const int bad[] = {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC};
  for (int i = 0; i < 3; i++)
    if (data->warning[bad[i]].number > 0) fprintf(stderr, "not stable\n"), exit(1);
}

int main(int argc, char **argv) {
  mju_user_warning = keep_silent;
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
    check(data);
    mj_kinematics(model, data); /* a step leaves bodies where it found them */
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
