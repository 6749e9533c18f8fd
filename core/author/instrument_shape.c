/* Meshes and spheres of instruments, made of the figures in their row of the library. Everything is a sweep of rings.
 */
#include <math.h>

#include "core/author/instruments.h"
#include "core/io/mesh_import.h"

#define SIDES 20        /* of a ring */
#define ROUND_RINGS 6   /* of a rounded end */
#define END_PART 0.05   /* radius of the flat middle of a rounded end, as a part of the radius */
#define TAPER 0.55      /* radius of a jaw's tip, as a part of that at the hinge */
#define BLADE_WIDTH 0.6 /* of a blade, as a part of its thickness */
#define PRONG_GAP 1.2   /* between shaft's axis and prong, as a part of the prong's radius */
#define HOOP_RINGS 48
#define WIRE 0.0008      /* m: radius of a hoop's wire */
#define WIRE_GAP 0.0019  /* m: between the mouth of a bag and the middle of the wire */
#define WIRE_DEPTH 0.004 /* m: how far the ends of the wire go into the shaft */
#define WIRE_SPHERES 24
#define ARC_RINGS 40      /* of a needle */
#define POINT_PART 0.25   /* of a needle: how much of it tapers to the point */
#define FELT_LENGTH 0.08  /* m: spheres along the shaft from its end on */
#define SHAFT_SPACING 1.5 /* of the shaft's spheres, in radii */

/* An ellipse with these half axes. The sweep goes on toward u x v. */
typedef struct Ring {
  SporeVec3 centre, u, v;
} Ring;

typedef struct Shape {
  GArray *vertices;  /* of 3 double */
  GArray *triangles; /* of 3 guint32 */
} Shape;

static guint add_vertex(Shape *shape, SporeVec3 at) {
  double row[3];
  spore_vec3_store(row, at);
  g_array_append_vals(shape->vertices, row, 3);
  return shape->vertices->len / 3 - 1;
}

static void add_triangle(Shape *shape, guint32 a, guint32 b, guint32 c) {
  const guint32 row[] = {a, b, c};
  g_array_append_vals(shape->triangles, row, 3);
}

static SporeVec3 on_ring(const Ring *ring, guint side) {
  double angle = 2 * G_PI * side / SIDES;
  return spore_vec3_add_scaled(spore_vec3_add_scaled(ring->centre, cos(angle), ring->u), sin(angle), ring->v);
}

/* What the ring sweeps on its way through these places, closed at both ends. */
static void sweep(Shape *shape, const Ring *rings, guint count) {
  guint start = add_vertex(shape, rings[0].centre);
  for (guint r = 0; r < count; r++)
    for (guint side = 0; side < SIDES; side++) add_vertex(shape, on_ring(&rings[r], side));
  guint end = add_vertex(shape, rings[count - 1].centre);
  for (guint side = 0; side < SIDES; side++) {
    guint next = (side + 1) % SIDES, last = start + 1 + (count - 1) * SIDES;
    add_triangle(shape, start, start + 1 + next, start + 1 + side);
    add_triangle(shape, end, last + side, last + next);
    for (guint r = 0; r + 1 < count; r++) {
      guint here = start + 1 + r * SIDES, there = here + SIDES;
      add_triangle(shape, here + side, here + next, there + next);
      add_triangle(shape, here + side, there + next, there + side);
    }
  }
}

/* A ring around the shaft's axis, of a sweep toward +y. */
static Ring around_y(double radius, double y) { return (Ring){{0, y, 0}, {0, 0, radius}, {radius, 0, 0}}; }

/* A rod along +y that begins round, at y = start. */
static void add_rod(Shape *shape, double radius, double start, double end) {
  Ring rings[ROUND_RINGS + 2];
  for (int i = 0; i <= ROUND_RINGS; i++) {
    double angle = 0.5 * G_PI * i / ROUND_RINGS;
    rings[i] = around_y(radius * fmax(sin(angle), END_PART), start + radius * (1 - cos(angle)));
  }
  rings[ROUND_RINGS + 1] = around_y(radius, end);
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

/* The ball around the end of the shaft, and the shaft. */
static void add_ball(Shape *shape, double ball, double radius, double length) {
  Ring rings[2 * ROUND_RINGS + 2];
  double neck = asin(radius / ball); /* the shaft leaves the ball at this angle from +y */
  for (int i = 0; i <= 2 * ROUND_RINGS; i++) {
    double angle = G_PI + (neck - G_PI) * i / (2 * ROUND_RINGS);
    rings[i] = around_y(ball * fmax(sin(angle), END_PART), ball * cos(angle));
  }
  rings[2 * ROUND_RINGS + 1] = around_y(radius, length);
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

/* A tube with an open end, of a wall as thick as it can be drawn. */
static void add_tube(Shape *shape, double radius, double length) {
  const double hole = 0.7 * radius, depth = 4 * radius;
  const Ring rings[] = {around_y(hole, depth), around_y(hole, 0), around_y(radius, 0), around_y(radius, length)};
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

/* A jaw, blade or prong from y = 0 to y = -length, in the plane of y and z. gap: from the y axis to its middle at its
 * two ends; thick, wide: half axes at y = 0. */
static void add_finger(Shape *shape, double length, const double gap[2], double thick, double wide) {
  Ring rings[ROUND_RINGS + 2];
  rings[0] = (Ring){{0, 0, gap[0]}, {wide, 0, 0}, {0, 0, thick}};
  double tip = TAPER * wide; /* length of the rounded end */
  for (int i = 0; i <= ROUND_RINGS; i++) {
    double angle = 0.5 * G_PI * i / ROUND_RINGS, part = TAPER * fmax(cos(angle), END_PART);
    double y = -length + tip * (1 - sin(angle));
    rings[1 + i] = (Ring){{0, y, gap[1]}, {part * wide, 0, 0}, {0, 0, part * thick}};
  }
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

/* Half a circle in the plane of x and y, from the swage at -x over +y to the point at +x. */
static void add_arc(Shape *shape, double arc, double wire) {
  Ring rings[ARC_RINGS + 1];
  for (int i = 0; i <= ARC_RINGS; i++) {
    double part = (double)i / ARC_RINGS, angle = G_PI * (1 - part);
    double radius = wire * fmax(END_PART, fmin(1, (1 - part) / POINT_PART));
    SporeVec3 out = {cos(angle), sin(angle), 0};
    rings[i] = (Ring){spore_vec3_scale(arc, out), spore_vec3_scale(radius, out), {0, 0, radius}};
  }
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

static SporeVec3 on_hoop(const SporeInstrumentKind *instrument, double angle) {
  double reach = instrument->head_radius + WIRE_GAP, middle = instrument->head_radius - instrument->head_length;
  return (SporeVec3){reach * sin(angle), middle + reach * cos(angle), 0};
}

/* Wire out of the shaft, around the mouth in the plane of x and y, and back. */
static void add_hoop(Shape *shape, const SporeInstrumentKind *instrument) {
  Ring rings[HOOP_RINGS + 3];
  const SporeVec3 along = {0, 0, WIRE};
  for (int i = 0; i <= HOOP_RINGS; i++) {
    double gap = 2 * WIRE / instrument->head_radius, angle = gap + (2 * G_PI - 2 * gap) * i / HOOP_RINGS;
    rings[1 + i] = (Ring){on_hoop(instrument, angle), {WIRE * sin(angle), WIRE * cos(angle), 0}, along};
  }
  rings[0] = (Ring){{2 * WIRE, WIRE_DEPTH, 0}, {WIRE, 0, 0}, along};
  rings[HOOP_RINGS + 2] = (Ring){{-2 * WIRE, WIRE_DEPTH, 0}, {-WIRE, 0, 0}, along};
  sweep(shape, rings, G_N_ELEMENTS(rings));
}

/* On which side of the axis a jaw lies: the first one opens by turning from -y toward -z. */
static double side_of(SporeInstrumentPart part) { return part == SPORE_PART_JAW_A ? -1 : 1; }

static void add_jaw(Shape *shape, const SporeInstrumentKind *instrument, SporeInstrumentPart part) {
  double thick = instrument->head_radius, side = side_of(part);
  double wide = instrument->head == SPORE_HEAD_BLADES ? BLADE_WIDTH * thick : instrument->radius;
  add_finger(shape, instrument->head_length, (double[]){side * thick, side * TAPER * thick}, thick, wide);
}

static void add_shaft(Shape *shape, const SporeInstrumentKind *instrument, double length) {
  double radius = instrument->radius, head = instrument->head_radius;
  switch (instrument->head) {
  case SPORE_HEAD_BALL:
    add_ball(shape, head, radius, length);
    break;
  case SPORE_HEAD_MOUTH:
  case SPORE_HEAD_LENS:
    add_tube(shape, radius, length);
    break;
  case SPORE_HEAD_ARC:
    add_arc(shape, head, radius);
    break;
  case SPORE_HEAD_PRONGS:
    for (int side = -1; side <= 1; side += 2)
      add_finger(shape, instrument->head_length, (double[]){side * PRONG_GAP * head, side * PRONG_GAP * head}, head,
                 head);
    add_rod(shape, radius, -0.5 * radius, length);
    break;
  case SPORE_HEAD_HOOP:
    add_hoop(shape, instrument);
    add_rod(shape, radius, 0, length);
    break;
  case SPORE_HEAD_JAWS:
  case SPORE_HEAD_BLADES:
    add_rod(shape, radius, -0.5 * radius, length); /* round the hinge */
    break;
  }
}

char *spore_instrument_mesh(const SporeInstrumentKind *instrument, SporeInstrumentPart part, double length,
                            gsize *size) {
  Shape shape = {g_array_new(FALSE, FALSE, sizeof(double)), g_array_new(FALSE, FALSE, sizeof(guint32))};
  if (part == SPORE_PART_SHAFT) add_shaft(&shape, instrument, length);
  else add_jaw(&shape, instrument, part);
  const SporeTriangleMesh mesh = {.vertex_count = shape.vertices->len / 3,
                                  .triangle_count = shape.triangles->len / 3,
                                  .vertices = (double *)shape.vertices->data,
                                  .triangles = (guint32 *)shape.triangles->data};
  char *text = spore_off_format(&mesh, size);
  g_array_unref(shape.vertices);
  g_array_unref(shape.triangles);
  return text;
}

/* Spheres. */

static void add_sphere(GArray *spheres, SporeVec3 at, double radius) {
  const double row[] = {at.x, at.y, at.z, radius};
  g_array_append_vals(spheres, row, 4);
}

static void add_jaw_spheres(GArray *spheres, const SporeInstrumentKind *instrument, double side) {
  double radius = instrument->head_radius;
  for (double y = radius; y <= instrument->head_length - radius / 2; y += radius)
    add_sphere(spheres, (SporeVec3){0, -y, side * radius}, radius);
}

/* A mouth lies before the spheres, so that these do not keep off what it sucks. */
static double first_of_shaft(const SporeInstrumentKind *instrument) {
  return instrument->head == SPORE_HEAD_MOUTH ? 3 * instrument->radius : instrument->radius;
}

static void add_shaft_spheres(GArray *spheres, const SporeInstrumentKind *instrument, double length) {
  double radius = instrument->radius, first = first_of_shaft(instrument);
  if (instrument->head == SPORE_HEAD_BALL) add_sphere(spheres, (SporeVec3){0, 0, 0}, instrument->head_radius);
  for (double y = first; y <= fmin(length, FELT_LENGTH) - radius; y += SHAFT_SPACING * radius)
    add_sphere(spheres, (SporeVec3){0, y, 0}, radius);
  for (int i = 0; instrument->head == SPORE_HEAD_HOOP && i < WIRE_SPHERES; i++)
    add_sphere(spheres, on_hoop(instrument, 2 * G_PI * (i + 0.5) / WIRE_SPHERES), WIRE);
}

char *spore_instrument_spheres(const SporeInstrumentKind *instrument, SporeInstrumentPart part, double length,
                               gsize *size) {
  if (instrument->head == SPORE_HEAD_ARC) return NULL; /* its tip feels tissue without */
  if (part != SPORE_PART_SHAFT && instrument->head == SPORE_HEAD_BLADES) return NULL;
  g_autoptr(GArray) spheres = g_array_new(FALSE, FALSE, sizeof(double));
  if (part == SPORE_PART_SHAFT) add_shaft_spheres(spheres, instrument, length);
  else add_jaw_spheres(spheres, instrument, side_of(part));
  const SporeSphereSet set = {.count = spheres->len / 4, .spheres = (double *)spheres->data};
  return spore_spheres_format(&set, size);
}
