/* Moving bodies with all that is placed on them. No GTK. */
#ifndef SPORE_AUTHOR_PLACEMENT_H
#define SPORE_AUTHOR_PLACEMENT_H

#include "core/math/quat.h"
#include "core/scene/document.h"

/* The box around what the body shows, else what physics moves, else what is felt, at time 0 in the scene, m. FALSE: it
 * has none of these, and the box is the place of its frame. */
gboolean spore_body_box(SporeDocument *document, SporeObject *body, double lower[3], double upper[3]);

/* Bodies that move together, and where they and what is placed on them stand before; opaque. */
typedef struct SporePlacement SporePlacement;

/* Of these bodies (of SporeObject *), with the other bodies of their tools: jaws go with their shaft; and with what
 * is tied to nothing but instruments that move: the film of a bag. Places and
 * directions of tools and of a source go with its body; an end of a link goes with the body of that end; what a link
 * has one of goes where all bodies go that the link ties. Valid until objects come or go. */
SporePlacement *spore_placement_new(SporeDocument *document, const GPtrArray *bodies);
void spore_placement_free(SporePlacement *placement);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporePlacement, spore_placement_free)
/* The box around the bodies themselves, without their tools' others, and its middle; in the scene, m. */
void spore_placement_box(const SporePlacement *placement, double lower[3], double upper[3]);
SporeVec3 spore_placement_middle(const SporePlacement *placement);
/* Puts everything to where that motion of the scene takes it from where it stood: p to R p + t. Motions do not add up,
 * so that a drag may call this over and over. Of several commands: call it inside a group. FALSE with a GError: a place
 * would be out of range. */
gboolean spore_placement_move(SporePlacement *placement, SporePose motion, GError **error);
/* The bodies that move: those given and the others of their tools, in the order of the scene. g_ptr_array_unref. */
GPtrArray *spore_placement_bodies(const SporePlacement *placement);
/* Puts frames and what is placed so many times as far from the middle as they stood, and makes lengths of links and
 * emitters (radius of a pin, rest length of a spring) as many times as large. Otherwise like spore_placement_move. */
gboolean spore_placement_scale(SporePlacement *placement, double factor, GError **error);
/* The motion that turns by an angle, rad, about an axis of length 1 through that place. */
SporePose spore_placement_turn(SporeVec3 place, SporeVec3 axis, double angle);

/* Moves the bodies, with all that is placed on them, by that way, m, as one undo step. FALSE with a GError: a place
 * would be out of range. */
gboolean spore_edit_move(SporeDocument *document, const GPtrArray *bodies, SporeVec3 by, GError **error);
/* Turns them by an angle, rad, about that axis of the scene (0: x) through the middle of the box around them. */
gboolean spore_edit_turn(SporeDocument *document, const GPtrArray *bodies, int axis, double angle, GError **error);

/* Where the coordinate stands that bodies are aligned by: the least, the middle, the greatest of their boxes. */
typedef enum SporeAlignment { SPORE_ALIGN_LEAST, SPORE_ALIGN_MIDDLE, SPORE_ALIGN_GREATEST } SporeAlignment;
/* By its name: least, middle, greatest. Below 0: there is none of that name. */
int spore_alignment_find(const char *name);

/* Moves the other bodies along an axis (0: x) until their boxes are aligned with that of the first one, as one undo
 * step. FALSE with a GError: fewer than two bodies. */
gboolean spore_edit_align(SporeDocument *document, const GPtrArray *bodies, int axis, SporeAlignment alignment,
                          GError **error);

#endif
