/* Orients the triangles of a surface outward. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"

/* One set of triangles joined by edges. */
typedef struct Component {
  double lower[3], upper[3];
  double volume;  /* signed, after its triangles have got one orientation */
  uint32_t first; /* one of its triangles */
  bool closed;    /* each edge has two triangles */
  bool trusted;   /* closed, and its triangles had one orientation in the input */
  bool flip;
} Component;

typedef struct Orientation {
  SporeTriangleMesh *mesh;
  SporeHalfEdges halves;
  uint32_t *twin;      /* 3 x triangle_count: half-edge across a manifold edge, or UINT32_MAX */
  uint32_t *component; /* triangle_count; UINT32_MAX: not reached yet */
  uint32_t *stack;     /* triangle_count */
  Component *components;
  size_t component_count;
} Orientation;

static void find_twins(Orientation *o) {
  memset(o->twin, 0xff, 3 * o->mesh->triangle_count * sizeof *o->twin);
  for (size_t i = 0, end; i < o->halves.count; i = end) {
    end = spore_half_edges_end(&o->halves, i);
    if (end - i != 2) continue;
    o->twin[o->halves.half[i]] = o->halves.half[i + 1];
    o->twin[o->halves.half[i + 1]] = o->halves.half[i];
  }
}

static void flip_triangle(Orientation *o, uint32_t triangle) {
  assert(triangle < o->mesh->triangle_count);
  uint32_t *v = o->mesh->triangles + 3 * (size_t)triangle, *twin = o->twin + 3 * (size_t)triangle;
  uint32_t corner = v[1], across = twin[0];
  v[1] = v[2], v[2] = corner;
  /* sides 0-1, 1-2, 2-0 become 0-2, 2-1, 1-0: the first and the last change places */
  twin[0] = twin[2], twin[2] = across;
  if (twin[0] != UINT32_MAX) o->twin[twin[0]] = 3 * triangle;
  if (twin[2] != UINT32_MAX) o->twin[twin[2]] = 3 * triangle + 2;
}

/* Gives all triangles that are connected with `seed` the orientation of `seed`. */
static void spread(Orientation *o, uint32_t seed) {
  assert(o->component[seed] == UINT32_MAX);
  uint32_t number = (uint32_t)o->component_count++;
  Component *component = o->components + number;
  *component = (Component){.first = seed, .closed = true, .trusted = true};
  size_t waiting = 0;
  o->component[seed] = number;
  o->stack[waiting++] = seed;
  while (waiting) {
    uint32_t triangle = o->stack[--waiting];
    for (uint32_t side = 0; side < 3; side++) {
      uint32_t half = 3 * triangle + side, twin = o->twin[half];
      component->closed &= twin != UINT32_MAX;
      if (twin == UINT32_MAX || o->component[twin / 3] != UINT32_MAX) continue;
      if (spore_half_edge_ascends(o->mesh->triangles, half) == spore_half_edge_ascends(o->mesh->triangles, twin)) {
        flip_triangle(o, twin / 3);
        component->trusted = false;
      }
      o->component[twin / 3] = number;
      o->stack[waiting++] = twin / 3;
    }
  }
  component->trusted &= component->closed;
}

static void measure_components(Orientation *o) {
  for (size_t c = 0; c < o->component_count; c++)
    for (int k = 0; k < 3; k++) o->components[c].lower[k] = HUGE_VAL, o->components[c].upper[k] = -HUGE_VAL;
  for (size_t t = 0; t < o->mesh->triangle_count; t++) {
    Component *component = o->components + o->component[t];
    SporeVec3 origin = spore_mesh_vertex(o->mesh->vertices, o->mesh->triangles[3 * (size_t)component->first]), p[3];
    for (int i = 0; i < 3; i++) {
      const double *x = o->mesh->vertices + 3 * (size_t)o->mesh->triangles[3 * t + i];
      p[i] = spore_vec3_sub(spore_vec3_load(x), origin);
      for (int k = 0; k < 3; k++) {
        component->lower[k] = fmin(component->lower[k], x[k]);
        component->upper[k] = fmax(component->upper[k], x[k]);
      }
    }
    component->volume += spore_vec3_dot(p[0], spore_vec3_cross(p[1], p[2])) / 6;
  }
}

static bool box_inside(const Component *inner, const Component *outer) {
  for (int k = 0; k < 3; k++)
    if (!(inner->lower[k] > outer->lower[k] && inner->upper[k] < outer->upper[k])) return false;
  return true;
}

/* Solid angle of a component seen from p over 4 pi: about +-1 inside (van Oosterom and Strackee 1983). */
static double winding_of(const Orientation *o, uint32_t number, SporeVec3 p) {
  double sum = 0;
  for (size_t t = 0; t < o->mesh->triangle_count; t++) {
    if (o->component[t] != number) continue;
    SporeVec3 v[3];
    double l[3];
    for (int k = 0; k < 3; k++) {
      v[k] = spore_vec3_sub(spore_mesh_vertex(o->mesh->vertices, o->mesh->triangles[3 * t + k]), p);
      l[k] = spore_vec3_length(v[k]);
    }
    sum += 2 * atan2(spore_vec3_dot(v[0], spore_vec3_cross(v[1], v[2])),
                     l[0] * l[1] * l[2] + spore_vec3_dot(v[0], v[1]) * l[2] + spore_vec3_dot(v[1], v[2]) * l[0] +
                         spore_vec3_dot(v[2], v[0]) * l[1]);
  }
  return sum / (4 * M_PI);
}

/* Whether a shell is the wall of a cavity: it lies inside another shell, and its author gave it the opposite
 * orientation. */
static bool is_cavity(const Orientation *o, const Component *inner) {
  const Component *parent = NULL;
  if (!inner->trusted) return false;
  SporeVec3 p = spore_mesh_vertex(o->mesh->vertices, o->mesh->triangles[3 * (size_t)inner->first]);
  for (uint32_t c = 0; c < o->component_count; c++) {
    const Component *outer = o->components + c;
    if (outer == inner || !outer->trusted || !box_inside(inner, outer)) continue;
    if (parent && fabs(outer->volume) >= fabs(parent->volume)) continue;
    if (fabs(winding_of(o, c, p)) > 0.5) parent = outer;
  }
  return parent && (parent->volume < 0) != (inner->volume < 0);
}

static void turn_outward(Orientation *o) {
  for (size_t c = 0; c < o->component_count; c++) {
    Component *component = o->components + c;
    if (component->closed) component->flip = (component->volume < 0) != is_cavity(o, component);
  }
  for (size_t t = 0; t < o->mesh->triangle_count; t++)
    if (o->components[o->component[t]].flip) flip_triangle(o, (uint32_t)t);
}

bool spore_triangle_mesh_orient(SporeTriangleMesh *mesh, SporeError *error) {
  size_t n = mesh->triangle_count;
  Orientation o = {.mesh = mesh,
                   .twin = SPORE_NEW_ARRAY(uint32_t, 3 * n),
                   .component = SPORE_NEW_ARRAY(uint32_t, n),
                   .stack = SPORE_NEW_ARRAY(uint32_t, n),
                   .components = SPORE_NEW_ARRAY(Component, n)};
  bool done =
      o.twin && o.component && o.stack && o.components && spore_half_edges_create(&o.halves, mesh->triangles, n);
  if (done) {
    find_twins(&o);
    memset(o.component, 0xff, n * sizeof *o.component);
    for (size_t t = 0; t < n; t++)
      if (o.component[t] == UINT32_MAX) spread(&o, (uint32_t)t);
    measure_components(&o);
    turn_outward(&o);
    spore_half_edges_clear(&o.halves);
  }
  spore_free(o.twin);
  spore_free(o.component);
  spore_free(o.stack);
  spore_free(o.components);
  return done || spore_mesh_no_memory(error);
}
