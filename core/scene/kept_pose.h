/* Kept poses: where a body is at time 0, taken from a run, as a file beside the scene. A pose belongs to what the body
 * is made of; where that has changed since, the pose is stale, and the body begins as its geometry says. */
#ifndef SPORE_SCENE_KEPT_POSE_H
#define SPORE_SCENE_KEPT_POSE_H

#include "core/body/model.h"
#include "core/scene/document.h"

typedef enum SporeKeptPoseState {
  SPORE_POSE_NONE,  /* the body names no file */
  SPORE_POSE_FRESH, /* the pose is one of the body */
  SPORE_POSE_STALE  /* the pose is of another shape, model or number of nodes */
} SporeKeptPoseState;

/* A pose as a file: a line "spore-pose 1", a line "of HASH", a line "at X Y Z W X Y Z" with the body's frame (m, and a
 * quaternion wxyz) and a line "numbers N", then N lines with a number each, as spore_world_q gives them without spare
 * nodes, all to the bit. model: at the level of detail at which the body begins; NULL: physics does not move the body.
 * g_free. */
char *spore_kept_pose_format(const SporeModel *model, SporePose frame, const double *q, gsize *size);
/* Reads the pose that the body names. frame: where the body's frame stands; nodes go with it where the scene has moved
 * it since. q: *count numbers, g_free; NULL where the state is not FRESH. FALSE with a GError: the file cannot be read,
 * is no pose, has too few numbers or some that are not finite, or turns tetrahedra inside out. */
gboolean spore_kept_pose_read(SporeDocument *document, const SporeObject *body, const SporeModel *model,
                              SporePose frame, SporeKeptPoseState *state, double **q, gsize *count, GError **error);
/* How many bodies name a pose. */
guint spore_document_kept_poses(const SporeDocument *document);
/* How many of the body's tetrahedra these places of its nodes turn inside out; 0 where it has none. q: at its finest
 * level of detail. */
gsize spore_kept_pose_inverted(SporeDocument *document, const SporeObject *body, const SporeModel *model,
                               const double *q);

#endif
