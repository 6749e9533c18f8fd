/* Contacts with bodies whose surface is one depth field.
 *
 * A sphere (the probe) that touches several spheres of such a body has one contact with the field. Depth and normal
 * change smoothly when the probe slides from one sphere to the next. In a corner the probe has one contact with each
 * side. Where both bodies have a field, the field is that of the body with the larger spheres, and the smaller spheres
 * of the other are the probes, since they lie closer to its true surface. Where both are equal, the first body has the
 * field. A probe on which the body may lie flat touches the spheres of the body one by one: a single contact would not
 * hold the body. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/collide/narrow.h"
#include "core/sim/world_private.h"

/* Between its spheres a field reaches further than the spheres do. So the grid takes radii larger by this part. */
#define REACH 0.5
/* Sides of a corner whose normals are nearer than this (cosine) count as one rounded side. PLACES: number of places
 * that are looked at. */
#define SAME_SIDE 0.5
#define PLACES 4

static bool has_field(const SporeBody *body) { return body->collision.field.count > 0; }

/* Whether contacts between the two bodies are with the field of `body`. first: `body` has the lower index. */
static bool is_one_field(const SporeBody *body, const SporeBody *other, bool first) {
  if (!has_field(body) || !has_field(other)) return has_field(body);
  double mean = body->collision.field.mean_radius, others = other->collision.field.mean_radius;
  return mean > others || (mean == others && first);
}

/* Only a body that keeps its shape has a field that can be made once. */
static bool wants_field(const SporeBody *body) {
  SporeMappingKind kind = body->collision.spheres.kind;
  return body->collision.fields.surface == SPORE_SURFACE_DEPTH_FIELD && body->collision.spheres.point_count > 1 &&
         (kind == SPORE_MAPPING_RIGID || kind == SPORE_MAPPING_FIXED);
}

/* points: centres, `stride` numbers each. */
static bool make_field(SporeDepthField *field, const double *points, size_t stride, const SporeSphereSet *set) {
  assert(set && stride >= 3);
  double *centre = SPORE_NEW_ARRAY(double, 3 * set->count), *radius = SPORE_NEW_ARRAY(double, set->count);
  bool made = centre && radius;
  for (size_t i = 0; made && i < set->count; i++) {
    for (size_t k = 0; k < 3; k++) centre[3 * i + k] = points[stride * i + k];
    radius[i] = set->spheres[4 * i + 3];
  }
  made = made && spore_depth_field_create(field, centre, radius, set->weights, set->level, set->count);
  spore_free(centre);
  spore_free(radius);
  return made;
}

bool spore_spheres_radii(const SporeSphereSet *set, double *radius, size_t stride) {
  assert(set && radius && stride > 0);
  SporeDepthField field = {0};
  for (size_t i = 0; i < set->count; i++) radius[stride * i] = set->spheres[4 * i + 3];
  if (!set->weights) return true;
  if (!make_field(&field, set->spheres, 4, set)) return false;
  for (size_t i = 0; i < set->count; i++) radius[stride * i] = spore_depth_field_felt_radius(&field, (uint32_t)i);
  spore_depth_field_clear(&field);
  return true;
}

/* Of the margin of a sphere no more than its radius counts: beyond, pairs grow as the square of the margin, and what
 * comes from so far in a step is found by its way. */
static double useful_margin(double margin, double radius) { return fmin(margin, radius); }

static void report_margins(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    const double *radius = world->contact.spheres.radius + body->collision.start;
    double widest = 0;
    for (size_t i = 0; i < body->collision.spheres.point_count; i++) widest = fmax(widest, radius[i]);
    if (widest == 0 || !(body->collision.fields.margin > widest)) continue;
    spore_world_report(world,
                       _("%s: its margin of %.3g m counts as no more than the radius of each sphere, %.3g m at most; "
                         "take about a quarter of the radius"),
                       body->name, body->collision.fields.margin, widest);
  }
}

bool spore_world_create_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  assert(description->body_count == world->body_count);
  const SporeSpheres *spheres = &world->contact.spheres;
  world->contact.reach = SPORE_NEW_ARRAY(double, spheres->count);
  bool made = world->contact.reach;
  for (size_t i = 0; made && i < spheres->count; i++)
    world->contact.reach[i] =
        spheres->radius[i] + useful_margin(world->bodies[spheres->body[i]].collision.fields.margin, spheres->radius[i]);
  report_margins(world);
  for (size_t b = 0; made && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!wants_field(body)) continue;
    made = make_field(&body->collision.field, body->collision.spheres.points, 3, description->bodies[b].spheres);
    for (size_t i = 0; made && i < body->collision.field.count; i++)
      world->contact.reach[body->collision.start + i] = (1 + REACH) * body->collision.field.ball[4 * i + 3];
  }
  return made || spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                                 _("not enough memory for smooth surfaces; use fewer spheres, or surface spheres"));
}

/* Whether the two spheres move so far past each other in the step that the present field cannot predict their
 * contact. */
static bool is_fast(const SporeWorld *world, const SporeContact *contact) {
  const double *velocity = world->contact.spheres.velocity, *radius = world->contact.spheres.radius;
  SporeVec3 a = spore_vec3_load(velocity + 3 * (size_t)contact->a),
            b = spore_vec3_load(velocity + 3 * (size_t)contact->b);
  return spore_vec3_distance(a, b) * world->solver.time_step > fmin(radius[contact->a], radius[contact->b]);
}

/* Sets depth and normal by the field of the body that has the sphere `owner`, for the sphere `probe`. False: they stay
 * apart in this step. The normal of the contact points from b to a, the normal of the field out of the body. */
static bool evaluate_field(const SporeWorld *world, uint32_t owner, uint32_t probe, SporeContact *contact) {
  assert(owner < world->contact.spheres.count && probe < world->contact.spheres.count);
  const SporeBody *body = &world->bodies[world->contact.spheres.body[owner]];
  assert(has_field(body));
  const double *q = world->state.q + body->q_offset;
  bool turned = body->collision.spheres.kind == SPORE_MAPPING_RIGID;
  SporePose pose = {turned ? spore_vec3_load(q) : spore_vec3(0, 0, 0),
                    turned ? spore_quat_load(q + 3) : spore_quat_identity()};
  SporeVec3 centre = spore_vec3_sub(spore_vec3_load(world->contact.spheres.centre + 3 * (size_t)probe), pose.position),
            normal;
  centre = spore_quat_rotate(spore_quat_conjugate(pose.orientation), centre);
  uint32_t nearest = owner - (uint32_t)body->collision.start;
  double depth =
      spore_depth_field_ball(&body->collision.field, nearest, centre, world->contact.spheres.radius[probe], &normal);
  normal = spore_quat_rotate(pose.orientation, normal);
  const double *velocity = world->contact.spheres.velocity;
  SporeVec3 relative =
      spore_vec3_sub(spore_vec3_load(velocity + 3 * (size_t)probe), spore_vec3_load(velocity + 3 * (size_t)owner));
  contact->depth = depth;
  contact->normal = contact->a == probe ? normal : spore_vec3_scale(-1, normal);
  contact->gap_speed = spore_vec3_dot(normal, relative);
  return depth - world->solver.time_step * contact->gap_speed > 0;
}

/* Unit direction from the owner to the probe. */
static SporeVec3 direction(const SporeWorld *world, uint32_t owner, uint32_t probe) {
  const double *centre = world->contact.spheres.centre;
  SporeVec3 apart =
      spore_vec3_sub(spore_vec3_load(centre + 3 * (size_t)probe), spore_vec3_load(centre + 3 * (size_t)owner));
  return spore_vec3_normalise(apart, (SporeVec3){0, 0, 0});
}

static bool seen(const SporeVec3 *sides, size_t count, SporeVec3 normal) {
  for (size_t i = 0; i < count; i++)
    if (spore_vec3_dot(sides[i], normal) > SAME_SIDE) return true;
  return false;
}

/* Radius of a sphere in the field of its body. The radius of the sphere alone is no larger. */
static double full_radius(const SporeWorld *world, uint32_t sphere) {
  assert(sphere < world->contact.spheres.count);
  const SporeBody *body = &world->bodies[world->contact.spheres.body[sphere]];
  assert(sphere >= body->collision.start && sphere - body->collision.start < body->collision.field.count);
  return body->collision.field.ball[4 * (sphere - body->collision.start) + 3];
}

/* Index of the deepest pair on a side that was not looked at yet; `count`: there is none. */
static size_t next_place(const SporeWorld *world, const SporeManifoldContact *pairs, size_t count, bool owner_is_a,
                         const SporeVec3 *looked, size_t looked_count) {
  assert(pairs && count > 0);
  size_t deepest = count;
  double most = -HUGE_VAL;
  for (size_t i = 0; i < count; i++) {
    const SporeContact *pair = &pairs[i].contact;
    uint32_t owner = owner_is_a ? pair->a : pair->b, probe = owner_is_a ? pair->b : pair->a;
    double depth = pair->depth - REACH * full_radius(world, owner);
    if (depth <= most || (looked_count && seen(looked, looked_count, direction(world, owner, probe)))) continue;
    most = depth;
    deepest = i;
  }
  return deepest;
}

static SporeManifoldContact one_by_one(SporeContact contact) {
  return (SporeManifoldContact){contact, contact.a, contact.b, false, false};
}

static SporeManifoldContact as_one(const SporeWorld *world, SporeContact contact, bool owner_is_a) {
  uint32_t owner = owner_is_a ? contact.a : contact.b, probe = owner_is_a ? contact.b : contact.a;
  uint32_t whole = (uint32_t)world->bodies[world->contact.spheres.body[owner]].collision.start;
  return (SporeManifoldContact){contact, owner_is_a ? whole : probe, owner_is_a ? probe : whole, owner_is_a,
                                !owner_is_a};
}

/* Contacts of pairs of spheres, without the field. */
static size_t meet(const SporeWorld *world, const SporeManifoldContact *pairs, size_t count, SporeManifoldContact *to) {
  size_t made = 0;
  for (size_t i = 0; i < count; i++) {
    SporeContact contact = pairs[i].contact;
    if (spore_narrow_contact(&world->contact.spheres, contact.a, contact.b, world->solver.time_step, true, &contact))
      to[made++] = one_by_one(contact);
  }
  return made;
}

/* Whether the probe touches the spheres and not the field. Either the body may lie flat on the probe, or the probe is
 * so fast that only the step itself shows which sphere stops it. */
static bool meets_spheres(const SporeWorld *world, const SporeContact *nearest, uint32_t owner, uint32_t probe) {
  const SporeDepthField *field = &world->bodies[world->contact.spheres.body[owner]].collision.field;
  return world->contact.spheres.radius[probe] > field->half_width || is_fast(world, nearest);
}

/* Of the pairs of one probe with one body, which lie next to each other, makes the contacts that are manifold; returns
 * how many. `to` may be `pairs`. */
static size_t merge(const SporeWorld *world, const SporeManifoldContact *pairs, size_t count, bool owner_is_a,
                    SporeManifoldContact *to) {
  assert(count > 0 && to);
  SporeManifoldContact made[PLACES];
  SporeVec3 looked[2 * PLACES], sides[PLACES];
  size_t looked_count = 0, made_count = 0;
  for (size_t place = 0; place < PLACES; place++) {
    size_t i = next_place(world, pairs, count, owner_is_a, looked, looked_count);
    if (i == count) break;
    SporeContact contact = pairs[i].contact;
    uint32_t owner = owner_is_a ? contact.a : contact.b, probe = owner_is_a ? contact.b : contact.a;
    if (place == 0 && meets_spheres(world, &contact, owner, probe)) return meet(world, pairs, count, to);
    looked[looked_count++] = direction(world, owner, probe);
    if (!evaluate_field(world, owner, probe, &contact)) continue;
    SporeVec3 out = spore_vec3_scale(owner_is_a ? -1 : 1, contact.normal);
    if (seen(sides, made_count, out)) continue;
    looked[looked_count++] = sides[made_count] = out;
    made[made_count++] = as_one(world, contact, owner_is_a);
  }
  for (size_t i = 0; i < made_count; i++) to[i] = made[i];
  return made_count;
}

/* Shell's sort, which needs no memory. */
static void sort(SporeManifoldContact *manifold, size_t count,
                 bool (*before)(const SporeManifoldContact *a, const SporeManifoldContact *b)) {
  for (size_t gap = count / 2; gap > 0; gap /= 2)
    for (size_t i = gap; i < count; i++) {
      SporeManifoldContact moving = manifold[i];
      size_t k = i;
      for (; k >= gap && before(&moving, &manifold[k - gap]); k -= gap) manifold[k] = manifold[k - gap];
      manifold[k] = moving;
    }
}

static bool probe_before(const SporeManifoldContact *a, const SporeManifoldContact *b) {
  return a->contact.b < b->contact.b || (a->contact.b == b->contact.b && a->contact.a < b->contact.a);
}

static bool pair_before(const SporeManifoldContact *a, const SporeManifoldContact *b) {
  if (a->pair_a != b->pair_a) return a->pair_a < b->pair_a;
  if (a->pair_b != b->pair_b) return a->pair_b < b->pair_b;
  return a->contact.a < b->contact.a || (a->contact.a == b->contact.a && a->contact.b < b->contact.b);
}

/* Margin of a sphere of a body without a field, m. */
static double margin_of(const SporeWorld *world, uint32_t sphere) {
  assert(sphere < world->contact.spheres.count);
  return world->contact.reach[sphere] - world->contact.spheres.radius[sphere];
}

/* What comes of pairs of one sphere a with one body, in place. */
static size_t make_probe_contacts(const SporeWorld *world, SporeManifoldContact *manifold, size_t count) {
  const uint32_t *body = world->contact.spheres.body;
  const SporeBody *a = &world->bodies[body[manifold->contact.a]], *b = &world->bodies[body[manifold->contact.b]];
  if (is_one_field(b, a, false)) return merge(world, manifold, count, false, manifold);
  for (size_t i = 0; i < count; i++) {
    manifold[i] = one_by_one(manifold[i].contact);
    manifold[i].contact.depth -= margin_of(world, manifold[i].contact.a) + margin_of(world, manifold[i].contact.b);
  }
  return count;
}

/* What comes of all pairs of a body with a field that lie in its spheres a, in place: first those that feel it as one,
 * probe by probe, then others. */
static size_t make_field_contacts(const SporeWorld *world, const SporeContact *found, SporeManifoldContact *manifold,
                                  size_t count) {
  assert(count > 0 && found && manifold);
  const uint32_t *body = world->contact.spheres.body;
  const SporeBody *a = &world->bodies[body[found->a]];
  assert(has_field(a));
  size_t own = 0, made = 0;
  for (size_t i = 0; i < count; i++)
    if (is_one_field(a, &world->bodies[body[found[i].b]], true)) manifold[own++].contact = found[i];
  sort(manifold, own, probe_before);
  for (size_t i = 0, end; i < own; i = end) {
    for (end = i + 1; end < own && manifold[end].contact.b == manifold[i].contact.b;) end++;
    made += merge(world, manifold + i, end - i, true, manifold + made);
  }
  for (size_t i = 0, end; i < count; i = end) {
    end = i + 1;
    if (is_one_field(a, &world->bodies[body[found[i].b]], true)) continue;
    while (end < count && found[end].a == found[i].a && body[found[end].b] == body[found[i].b]) end++;
    for (size_t k = i; k < end; k++) manifold[made + k - i].contact = found[k];
    made += make_probe_contacts(world, manifold + made, end - i);
  }
  sort(manifold, made, pair_before);
  return made;
}

size_t spore_world_find_manifold(SporeWorld *world) {
  assert(world->contact.count == 0 || world->contact.grid);
  assert(world->contact.count <= world->contact.capacity);
  const SporeContact *found = spore_grid_contacts(world->contact.grid);
  const uint32_t *body = world->contact.spheres.body;
  size_t made = 0;
  for (size_t i = 0, end; i < world->contact.count; i = end) {
    uint32_t a = body[found[i].a], b = body[found[i].b];
    SporeManifoldContact *manifold = world->contact.manifold + made;
    end = i + 1;
    if (has_field(&world->bodies[a])) {
      while (end < world->contact.count && body[found[end].a] == a) end++;
      made += make_field_contacts(world, found + i, manifold, end - i);
      continue;
    }
    if (has_field(&world->bodies[b]))
      while (end < world->contact.count && found[end].a == found[i].a && body[found[end].b] == b) end++;
    for (size_t k = i; k < end; k++) manifold[k - i].contact = found[k];
    made += make_probe_contacts(world, manifold, end - i);
  }
  return made;
}
