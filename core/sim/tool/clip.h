/* A clamp as an effect, as a clip is put on: it closes on tissue without pressing it, goes along with it until it is
 * opened, and the tissue between its jaws is drawn squeezed (Meseure et al. 2003, section 6: clips are not simulated).
 */
#ifndef SPORE_SIM_CLIP_H
#define SPORE_SIM_CLIP_H

#include "core/sim/tool/jaws.h"

/* Whether the clamp moves as an effect does: it is one, or opens before physics has it again. */
bool spore_clip_leads(const SporeJaws *jaws);
/* Its part of the step, in place of pressing: moves the jaws toward `wanted` (rad), and the shaft with the tissue. */
void spore_clip_use(SporeWorld *world, SporeJaws *jaws, double wanted);
/* Brings the shaft back to its device, where a clip that was opened let go of it: as fast as a hand. */
void spore_clip_come_back(SporeWorld *world, SporeJaws *jaws);
/* Slots of the clamp's type. */
void spore_clip_set_effect(SporeWorld *world, SporeTool *tool);
bool spore_clip_squeeze(const SporeWorld *world, const SporeTool *tool, SporeSqueeze *squeeze);
/* Back to time 0. */
void spore_clip_reset(SporeWorld *world, SporeJaws *jaws);

#endif
