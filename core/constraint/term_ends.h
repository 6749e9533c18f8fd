/* Ends of terms: where they are, how they move, and what forces on them do to their bodies. For the files that
 * evaluate terms alone. */
#ifndef SPORE_SIM_TERM_ENDS_H
#define SPORE_SIM_TERM_ENDS_H

#include "core/constraint/term.h"

/* Terms are evaluated by the thousand: what follows is small, and compiled into each place. */
#define INLINE static inline __attribute__((always_inline))

INLINE SporeVec3 position_of(const SporeEnd *end, const SporeSite *sites, const double *q) {
  if (end->prescribed) return spore_vec3_add(end->position, end->offset);
  const double *local = q + sites[end->body].q;
  if (end->mapping->kind == SPORE_MAPPING_IDENTITY) return spore_vec3_load(local + 3 * (size_t)end->point);
  return spore_mapping_position(end->mapping, end->point, local);
}

/* With its body, by physics. */
INLINE bool turns(const SporeEnd *end) { return !end->prescribed && end->mapping->kind == SPORE_MAPPING_RIGID; }

/* Position of the end; keeps the lever of a force that acts `arm` away from it. */
INLINE SporeVec3 locate(SporeEnd *end, SporeVec3 arm, const SporeSite *sites, const double *q) {
  SporeVec3 position = position_of(end, sites, q);
  if (turns(end)) end->offset = spore_vec3_add(spore_vec3_sub(position, spore_vec3_load(q + sites[end->body].q)), arm);
  return position;
}

/* What the velocity-like vector x gives the point where the force acts; nothing to a prescribed end. */
INLINE SporeVec3 gather(const SporeEnd *end, const SporeSite *sites, const double *x) {
  if (end->prescribed) return (SporeVec3){0, 0, 0};
  const double *local = x + sites[end->body].v;
  switch (end->mapping->kind) {
  case SPORE_MAPPING_IDENTITY:
    return spore_vec3_load(local + 3 * (size_t)end->point);
  case SPORE_MAPPING_RIGID:
    return spore_vec3_add(spore_vec3_load(local), spore_vec3_cross(spore_vec3_load(local + 3), end->offset));
  case SPORE_MAPPING_LINEAR:
  case SPORE_MAPPING_FRAMES:
  case SPORE_MAPPING_FIXED:
    break;
  }
  return spore_mapping_velocity(end->mapping, end->point, NULL, local);
}

/* The transpose of gather. */
INLINE void scatter(const SporeEnd *end, const SporeSite *sites, SporeVec3 force, double *f) {
  if (end->prescribed) return;
  double *local = f + sites[end->body].v;
  switch (end->mapping->kind) {
  case SPORE_MAPPING_IDENTITY:
    spore_vec3_accumulate(local + 3 * (size_t)end->point, force);
    return;
  case SPORE_MAPPING_RIGID:
    spore_vec3_accumulate(local, force);
    spore_vec3_accumulate(local + 3, spore_vec3_cross(end->offset, force));
    return;
  case SPORE_MAPPING_LINEAR:
  case SPORE_MAPPING_FRAMES:
  case SPORE_MAPPING_FIXED:
    break;
  }
  spore_mapping_add_force(end->mapping, end->point, NULL, force, local);
}

INLINE SporeVec3 velocity(const SporeEnd *end, const SporeSite *sites, const double *v) {
  return end->prescribed ? end->velocity : gather(end, sites, v);
}

INLINE void scatter_pair(const SporeEnd *a, const SporeEnd *b, const SporeSite *sites, SporeVec3 force, double *f) {
  scatter(a, sites, force, f);
  scatter(b, sites, spore_vec3_scale(-1, force), f);
}

#endif
