/* Kept poses: where a body is at time 0, taken from a run, as a file beside the scene. A pose belongs to what the body
 * is made of; where that has changed since, the pose is stale, and the body begins as its geometry says. */
#ifndef SPORE_SCENE_KEPT_POSE_H
#define SPORE_SCENE_KEPT_POSE_H

#include "core/base/progress.h"
#include "core/body/model.h"
#include "core/scene/document.h"

typedef enum SporeKeptPoseState {
  SPORE_POSE_NONE,  /* the body names no file */
  SPORE_POSE_FRESH, /* the pose is one of the body */
  SPORE_POSE_STALE  /* the pose is of another shape, model or number of nodes */
} SporeKeptPoseState;

/* A pose that was taken from a run. */
typedef struct SporeKeptPose {
  guint64 hash; /* of what it is a pose of */
  SporePose frame;
  gsize count;
  double *q; /* count */
} SporeKeptPose;
/* Takes it: q as spore_world_q gives it, of which spare nodes are left out. model: at the level of detail at which the
 * body begins; NULL: physics does not move the body. Free with spore_kept_pose_clear. */
SporeKeptPose spore_kept_pose_take(const SporeModel *model, SporePose frame, const double *q);
void spore_kept_pose_clear(SporeKeptPose *pose);
/* The pose as a file: a line "spore-pose 1", a line "of HASH", a line "at X Y Z W X Y Z" with the body's frame (m, and
 * a quaternion wxyz) and a line "numbers N", then N lines with a number each, all to the bit. g_free. Takes long where
 * there are many, on any thread. NULL with a GError: cancelled. */
char *spore_kept_pose_format(const SporeKeptPose *pose, const SporeProgress *progress, gsize *size, GError **error);
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
