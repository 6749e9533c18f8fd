/* SPORE, the embeddable kernel: everything a program needs to build a world of bodies and step it.
 *
 *   SporeModel *model = spore_rigid_body.create(&geometry, fields, &error);
 *   SporeWorld *world = spore_world_create(&description, NULL, &error);
 *   spore_world_step(world);
 *
 * cc program.c $(pkg-config --cflags --libs spore) */
#ifndef SPORE_H
#define SPORE_H

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/base/parameter.h"
#include "core/base/profile.h"
#include "core/base/progress.h"
#include "core/base/threads.h"
#include "core/collide/sphere.h"
#include "core/exercise/exercise.h"
#include "core/haptic/device.h"
#include "core/haptic/track.h"
#include "core/integrate/solver.h"
#include "core/linalg/block_matrix.h"
#include "core/math/mat3.h"
#include "core/math/quat.h"
#include "core/math/vec3.h"
#include "core/mesh/bvh.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "core/body/model.h"
#include "core/runtime/runtime.h"
#include "core/sim/world.h"
#include "models/registry.h"

#endif
