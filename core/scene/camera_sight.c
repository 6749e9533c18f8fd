/* Where a camera of the scene looks. */
#include "core/scene/camera_sight.h"

#include <math.h>
#include <string.h>

/* Right and up of a level picture along the axis: up is the scene's y as far as the axis leaves that open. */
static void level(SporeVec3 back, SporeVec3 *right, SporeVec3 *up) {
  double azimuth = atan2(back.x, back.z);
  *right = spore_vec3(cos(azimuth), 0, -sin(azimuth));
  *up = spore_vec3_scale(1 / spore_vec3_length(back), spore_vec3_cross(back, *right));
}

SporeVec3 spore_camera_sight(const SporeCameraFields *fields) {
  SporeVec3 position = spore_vec3_load(fields->position), target = spore_vec3_load(fields->target), right, up;
  SporeVec3 back = spore_vec3_sub(position, target);
  double distance = spore_vec3_length(back), away = distance * sin(fields->angle);
  if (fields->angle == 0 || !(distance > 0)) return target;
  level(back, &right, &up);
  SporeVec3 ahead = spore_vec3_add_scaled(position, -cos(fields->angle), back);
  ahead = spore_vec3_add_scaled(ahead, -away * cos(fields->turn), up);
  return spore_vec3_add_scaled(ahead, away * sin(fields->turn), right);
}

double spore_camera_turn_to(SporeVec3 position, SporeVec3 target, SporeVec3 place) {
  SporeVec3 back = spore_vec3_sub(position, target), aside = spore_vec3_sub(place, target), right, up;
  if (!(spore_vec3_length(back) > 0)) return 0;
  level(back, &right, &up);
  return atan2(spore_vec3_dot(aside, right), -spore_vec3_dot(aside, up));
}

guint spore_camera_number(SporeDocument *document, const SporeObject *camera) {
  const SporeObject *tools = spore_document_section(document, "tools");
  guint number = 0;
  for (guint i = 0; i < spore_object_child_count(tools) && spore_object_child(tools, i) != camera; i++)
    number += strcmp(spore_object_type(spore_object_child(tools, i))->element, "camera") == 0;
  return number;
}
