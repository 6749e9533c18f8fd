/* The cases that we and other programs run, and how a program is asked and answers; C and C++.
 *
 *   PROGRAM CASE [NAME=NUMBER...] [trajectory=FILE]
 *
 * steps=N steps, a multiple of `frames`, of time/N seconds each. Answers one line of JSON: the CPU seconds of the steps
 * alone, and what else the case counts. FILE takes the positions at `frames` even times after 0, the last one at the
 * end: doubles, x y z a node.
 */
#ifndef SPORE_TESTS_BENCH_CASE_H
#define SPORE_TESTS_BENCH_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define CASE_GRAVITY 9.81 /* m/s^2, along -y */

/* Cloth: a square sheet of nodes, held along one side, let go at an angle and swinging, so that it is stretched at all
 * times: laid flat it would buckle, and after a second nobody's answer could be told from another's. The springs are
 * the edges of its triangles, whose diagonals alternate; a triangle's mass goes to its corners. */
enum { CLOTH_NODES = 20 };
#define CLOTH_SIDE 1.0 /* m */
#define CLOTH_FALL 0.8 /* of its side downward and aside, at the start */
#define CLOTH_ASIDE 0.6
#define CLOTH_MASS 1.0     /* kg */
#define CLOTH_DAMPING 0.01 /* N s/m, of each spring, along it */

/* Net: nodes and springs of the cloth, laid flat, drawn out by NET_STRETCH, held along all sides and let go onto four
 * balls that do not move. Not drawn out it would fold between the balls, and nobody's answer could be told from
 * another's. Nodes touch the balls without friction: a spring for the depth, of NET_CONTACT N/m. The balls stand where
 * no symmetry is. */
enum { NET_BALLS = 4 };
#define NET_STRETCH 1.2
#define NET_NODE_RADIUS 0.01 /* m */
#define NET_BALL_RADIUS 0.2
#define NET_CONTACT 100.0
static const double net_ball[NET_BALLS][3] = {
    {-0.21, -0.22, -0.19}, {0.17, -0.23, -0.2}, {-0.18, -0.225, 0.16}, {0.2, -0.22, 0.22}};

/* Rope: nodes in a row along x, the first held. */
enum { ROPE_NODES = 64 };
#define ROPE_LENGTH 1.0 /* m */
#define ROPE_MASS 0.1   /* kg */

/* Pile: spheres that fell into a box, open above. */
enum { PILE_ACROSS = 8, PILE_SPHERES = 500 };
#define PILE_RADIUS 0.05 /* m */
#define PILE_DENSITY 1000.0
#define PILE_FRICTION 0.5
#define PILE_SPACING 0.105 /* m, at the start */

/* Bar: cells of six tetrahedra each along x, held at x = 0. */
enum { BAR_CELLS_X = 20, BAR_CELLS_Y = 4, BAR_CELLS_Z = 4 };
#define BAR_LENGTH 1.0    /* m */
#define BAR_THICKNESS 0.2 /* m */
#define BAR_YOUNG_MODULUS 1e5
#define BAR_POISSON_RATIO 0.3
#define BAR_DENSITY 1000.0
#define BAR_VISCOSITY 0.01 /* s: viscous stress per stress of the strain rate */

/* Corners of triangle t of the cloth; node (column, row) is at row * CLOTH_NODES + column. */
enum { CLOTH_TRIANGLES = 2 * (CLOTH_NODES - 1) * (CLOTH_NODES - 1) };
static inline void cloth_triangle(unsigned t, unsigned corners[3]) {
  static const unsigned char paths[2][2][3] = {{{0, 1, 2}, {1, 3, 2}}, {{0, 1, 3}, {0, 3, 2}}};
  unsigned column = t / 2 % (CLOTH_NODES - 1), row = t / 2 / (CLOTH_NODES - 1), first = row * CLOTH_NODES + column;
  for (int k = 0; k < 3; k++) {
    unsigned corner = paths[(row + column) % 2][t % 2][k];
    corners[k] = first + corner % 2 + corner / 2 * CLOTH_NODES;
  }
}
static inline void cloth_node(unsigned i, double x[3]) {
  x[0] = (i % CLOTH_NODES * 1.0 / (CLOTH_NODES - 1) - 0.5) * CLOTH_SIDE;
  x[1] = -(double)(i / CLOTH_NODES) * CLOTH_SIDE * CLOTH_FALL / (CLOTH_NODES - 1);
  x[2] = i / CLOTH_NODES * CLOTH_SIDE * CLOTH_ASIDE / (CLOTH_NODES - 1);
}

/* As it is without tension. */
static inline void net_node(unsigned i, double x[3]) {
  x[0] = (i % CLOTH_NODES * 1.0 / (CLOTH_NODES - 1) - 0.5) * CLOTH_SIDE;
  x[1] = 0;
  x[2] = (i / CLOTH_NODES * 1.0 / (CLOTH_NODES - 1) - 0.5) * CLOTH_SIDE;
}
static inline int net_is_held(unsigned i) {
  unsigned column = i % CLOTH_NODES, row = i / CLOTH_NODES;
  return column == 0 || row == 0 || column == CLOTH_NODES - 1 || row == CLOTH_NODES - 1;
}

/* Corners of tetrahedron t of the bar: the six paths along the edges of a cell from its first corner to its last. Each
 * cell may be divided in `parts` a side. */
static inline unsigned bar_nodes(unsigned parts) {
  return (parts * BAR_CELLS_X + 1) * (parts * BAR_CELLS_Y + 1) * (parts * BAR_CELLS_Z + 1);
}
static inline unsigned bar_tetrahedra(unsigned parts) {
  return 6 * BAR_CELLS_X * BAR_CELLS_Y * BAR_CELLS_Z * parts * parts * parts;
}
static inline void bar_tetrahedron(unsigned parts, unsigned t, unsigned corners[4]) {
  static const unsigned char paths[6][4] = {{0, 4, 6, 7}, {0, 6, 2, 7}, {0, 2, 3, 7},
                                            {0, 3, 1, 7}, {0, 1, 5, 7}, {0, 5, 4, 7}};
  unsigned across_y = parts * BAR_CELLS_Y, across_z = parts * BAR_CELLS_Z, cell = t / 6;
  unsigned i = cell / (across_y * across_z), j = cell / across_z % across_y, k = cell % across_z;
  for (int c = 0; c < 4; c++) {
    unsigned n = paths[t % 6][c];
    corners[c] = ((i + n / 4) * (across_y + 1) + j + n / 2 % 2) * (across_z + 1) + k + n % 2;
  }
}
static inline void bar_node(unsigned parts, unsigned i, double x[3]) {
  unsigned across_y = parts * BAR_CELLS_Y, across_z = parts * BAR_CELLS_Z;
  x[0] = i / ((across_y + 1) * (across_z + 1)) * BAR_LENGTH / (parts * BAR_CELLS_X);
  x[1] = i / (across_z + 1) % (across_y + 1) * BAR_THICKNESS / across_y;
  x[2] = i % (across_z + 1) * BAR_THICKNESS / across_z;
}

typedef struct CaseRun {
  int argc;
  char **argv;
  unsigned steps, frames, frame;
  double time, cpu_s, since;
  FILE *trajectory;
} CaseRun;

/* A word or a number of the command line, or `otherwise`. */
static inline const char *case_word(const CaseRun *run, const char *name, const char *otherwise) {
  size_t length = strlen(name);
  for (int i = 2; i < run->argc; i++)
    if (!strncmp(run->argv[i], name, length) && run->argv[i][length] == '=') return run->argv[i] + length + 1;
  return otherwise;
}
static inline double case_number(const CaseRun *run, const char *name, double otherwise) {
  const char *word = case_word(run, name, NULL);
  return word ? atof(word) : otherwise;
}

static inline CaseRun case_begin(int argc, char **argv) {
  CaseRun run = {argc, argv, 0, 0, 0, 0, 0, 0, NULL};
  run.time = case_number(&run, "time", 1);
  run.steps = (unsigned)case_number(&run, "steps", 1000);
  run.frames = (unsigned)case_number(&run, "frames", 10);
  if (run.frames == 0 || run.steps % run.frames) {
    fprintf(stderr, "%u steps cannot end on %u even times\n", run.steps, run.frames);
    exit(2);
  }
  const char *file = case_word(&run, "trajectory", NULL);
  if (file) run.trajectory = fopen(file, "wb");
  return run;
}

static inline double case_time_step(const CaseRun *run) { return run->time / run->steps; }

static inline double case_cpu_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Steps of the next frame, now to be timed; 0: the run is at its end. */
static inline unsigned case_next_frame(CaseRun *run) {
  if (run->frame == run->frames) return 0;
  run->frame++;
  run->since = case_cpu_s();
  return run->steps / run->frames;
}
static inline void case_stop(CaseRun *run) { run->cpu_s += case_cpu_s() - run->since; }
static inline void case_node(CaseRun *run, double x, double y, double z) {
  const double position[3] = {x, y, z};
  if (run->trajectory) fwrite(position, sizeof position, 1, run->trajectory);
}

/* Where sphere i of the pile starts: as the last frame of the trajectory in start=FILE says, or in layers a little
 * askew, so that they do not stand on each other. Box: |x| and |z| up to PILE_HALF, y from 0. */
#define PILE_HALF (0.5 * PILE_ACROSS * PILE_SPACING)
static inline void pile_start(const CaseRun *run, unsigned i, double centre[3]) {
  unsigned column = i % PILE_ACROSS, row = i / PILE_ACROSS % PILE_ACROSS, layer = i / (PILE_ACROSS * PILE_ACROSS);
  double askew = 0.002 * (layer % 3) - 0.002;
  centre[0] = (column + 0.5) * PILE_SPACING - PILE_HALF + askew * (row % 2 ? 1 : -1);
  centre[1] = (layer + 0.5) * 1.1 * PILE_SPACING;
  centre[2] = (row + 0.5) * PILE_SPACING - PILE_HALF + askew * (column % 2 ? 1 : -1);
  const char *name = case_word(run, "start", NULL);
  FILE *file = name ? fopen(name, "rb") : NULL;
  if (!file) return;
  long size = 3 * (long)sizeof(double);
  if (fseek(file, size * ((long)i - PILE_SPHERES), SEEK_END) || fread(centre, (size_t)size, 1, file) != 1) exit(2);
  fclose(file);
}

/* The answer; `more` is what else there is to say, as `, "name": value`. */
static inline void case_end(CaseRun *run, const char *more) {
  printf("{\"cpu_s\": %.9g, \"steps\": %u, \"time_s\": %.9g%s}\n", run->cpu_s, run->steps, run->time, more);
  if (run->trajectory) fclose(run->trajectory);
}

#endif
