/* Contacts with bodies that are felt as one depth field: a sphere that touches several spheres of such a body has one
 * contact with it, whose depth and normal change smoothly where it slides from one to the next. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/collide/narrow.h"
#include "core/sim/world_private.h"

/* A field is felt between its spheres before they are: they are looked for with radii larger by this part. */
#define REACH 0.5

static bool has_field(const SporeBody *body) { return body->field.count > 0; }

bool spore_world_compile_fields(SporeWorld *world, SporeError *error) {
  const SporeSpheres *spheres = &world->spheres;
  world->reach = SPORE_NEW_ARRAY(double, spheres->count);
  bool made = world->reach;
  for (size_t i = 0; made && i < spheres->count; i++) world->reach[i] = spheres->radius[i];
  for (size_t b = 0; made && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    size_t count = body->spheres.point_count;
    if (body->role == SPORE_PASSIVE || body->contact.surface != SPORE_SURFACE_DEPTH_FIELD || count < 2) continue;
    const double *radius = spheres->radius + body->sphere_start;
    made = spore_depth_field_create(&body->field, body->spheres.points, radius, count);
    for (size_t i = 0; made && i < count; i++) world->reach[body->sphere_start + i] = (1 + REACH) * radius[i];
  }
  return made || spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                                 _("not enough memory for smooth surfaces; use fewer spheres, or surface spheres"));
}

/* Whether the two spheres move so far past each other in the step that the field of now says nothing of where they
 * meet. */
static bool is_fast(const SporeWorld *world, const SporeContact *contact) {
  const double *velocity = world->spheres.velocity, *radius = world->spheres.radius;
  SporeVec3 a = spore_vec3_load(velocity + 3 * (size_t)contact->a),
            b = spore_vec3_load(velocity + 3 * (size_t)contact->b);
  return spore_vec3_distance(a, b) * world->solver.time_step > fmin(radius[contact->a], radius[contact->b]);
}

/* Depth and normal from the field of the body that `owner` belongs to, for the ball `probe`; false where they stay
 * apart in this step. The contact's normal points from b to a, the field's out of the body. */
static bool feel(const SporeWorld *world, uint32_t owner, uint32_t probe, SporeContact *contact) {
  const SporeBody *body = &world->bodies[world->spheres.body[owner]];
  const double *q = world->q + body->q_offset;
  bool turned = body->spheres.kind == SPORE_MAPPING_RIGID;
  SporePose pose = {turned ? spore_vec3_load(q) : spore_vec3(0, 0, 0),
                    turned ? spore_quat_load(q + 3) : spore_quat_identity()};
  SporeVec3 centre = spore_vec3_sub(spore_vec3_load(world->spheres.centre + 3 * (size_t)probe), pose.position), normal;
  centre = spore_quat_rotate(spore_quat_conjugate(pose.orientation), centre);
  uint32_t nearest = owner - (uint32_t)body->sphere_start;
  double depth = spore_depth_field_ball(&body->field, nearest, centre, world->spheres.radius[probe], &normal);
  normal = spore_quat_rotate(pose.orientation, normal);
  const double *velocity = world->spheres.velocity;
  SporeVec3 relative =
      spore_vec3_sub(spore_vec3_load(velocity + 3 * (size_t)probe), spore_vec3_load(velocity + 3 * (size_t)owner));
  contact->depth = depth;
  contact->normal = contact->a == probe ? normal : spore_vec3_scale(-1, normal);
  contact->gap_speed = spore_vec3_dot(normal, relative);
  return depth - world->solver.time_step * contact->gap_speed > 0;
}

/* Contacts of a body's spheres, in the order of the probes: Shell's sort, which needs no memory. */
static void sort_by_probe(SporeFelt *felt, size_t count) {
  for (size_t gap = count / 2; gap > 0; gap /= 2)
    for (size_t i = gap; i < count; i++) {
      SporeFelt moving = felt[i];
      size_t k = i;
      for (; k >= gap; k -= gap) {
        const SporeContact *before = &felt[k - gap].contact;
        if (before->b < moving.contact.b || (before->b == moving.contact.b && before->a < moving.contact.a)) break;
        felt[k] = felt[k - gap];
      }
      felt[k] = moving;
    }
}

/* Of the contacts of one probe with one body, which lie next to each other, makes those that are felt; returns how
 * many. A fast probe meets spheres one by one: which of them stops it, the step will tell. */
static size_t merge(const SporeWorld *world, const SporeFelt *first, size_t count, bool owner_is_a, SporeFelt *to) {
  size_t nearest = 0, made = 0;
  for (size_t i = 1; i < count; i++)
    if (first[i].contact.depth > first[nearest].contact.depth) nearest = i;
  bool fast = is_fast(world, &first[nearest].contact);
  for (size_t i = fast ? 0 : nearest; i < (fast ? count : nearest + 1); i++) {
    SporeContact contact = first[i].contact;
    uint32_t owner = owner_is_a ? contact.a : contact.b, probe = owner_is_a ? contact.b : contact.a;
    bool felt = fast ? spore_narrow_contact(&world->spheres, contact.a, contact.b, world->solver.time_step, &contact)
                     : feel(world, owner, probe, &contact);
    if (!felt) continue;
    uint32_t whole = (uint32_t)world->bodies[world->spheres.body[owner]].sphere_start;
    to[made++] = (SporeFelt){contact, owner_is_a ? whole : probe, owner_is_a ? probe : whole};
  }
  return made;
}

/* Those of a body with a field, from `first` on; what comes of them lies at the front of felt. */
static size_t merge_body(const SporeWorld *world, SporeFelt *felt, size_t count) {
  size_t made = 0;
  sort_by_probe(felt, count);
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && felt[end].contact.b == felt[i].contact.b;) end++;
    made += merge(world, felt + i, end - i, true, felt + made);
  }
  return made;
}

size_t spore_world_feel(SporeWorld *world) {
  const SporeContact *found = spore_grid_contacts(world->grid);
  const uint32_t *body = world->spheres.body;
  size_t made = 0;
  for (size_t i = 0, end; i < world->contact_count; i = end) {
    uint32_t a = body[found[i].a], b = body[found[i].b];
    SporeFelt *felt = world->felt + made;
    end = i + 1;
    if (has_field(&world->bodies[a])) {
      while (end < world->contact_count && body[found[end].a] == a) end++;
      for (size_t k = i; k < end; k++) felt[k - i].contact = found[k];
      made += merge_body(world, felt, end - i);
    } else if (has_field(&world->bodies[b])) {
      while (end < world->contact_count && found[end].a == found[i].a && body[found[end].b] == b) end++;
      for (size_t k = i; k < end; k++) felt[k - i].contact = found[k];
      made += merge(world, felt, end - i, false, felt);
    } else {
      felt->contact = found[i];
      felt->grip_a = found[i].a;
      felt->grip_b = found[i].b;
      made++;
    }
  }
  return made;
}
