/* Where a camera of the scene looks: an endoscope may look aside from the axis of its shaft. */
#ifndef SPORE_SCENE_CAMERA_SIGHT_H
#define SPORE_SCENE_CAMERA_SIGHT_H

#include "core/math/vec3.h"
#include "core/scene/document.h"
#include "core/scene/schema_fields.h"

/* What the camera looks at, m, at the start: as far away as its target, `angle` from the axis from position to target,
 * and so to the side as `turn` says. The target itself where the angle is 0 or the axis has no length. */
SporeVec3 spore_camera_sight(const SporeCameraFields *fields);
/* The turn, rad, with which a camera of that axis looks aside to where `place` lies. */
double spore_camera_turn_to(SporeVec3 position, SporeVec3 target, SporeVec3 place);

/* Which of the document's cameras it is, from 0: the number of its eye and lens in the world. */
guint spore_camera_number(SporeDocument *document, const SporeObject *camera);

#endif
