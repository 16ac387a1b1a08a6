// Systems that play clips and turn poses into bone matrices, one character an entity.
#pragma once

#include <memory>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/frame_time.hpp"

namespace fascicle {

// Component: plays a clip on the entity's LocalPose. A clip never moves the entity's Placement: where its root travels,
// a looped character walks away from its placement and jumps back to it when the clip starts over. With `in_place` it
// walks on the spot and without a jump (clip_travel.hpp); a game that moves the Placement itself wants that too.
struct ClipPlayer {
  std::shared_ptr<const Clip> clip;
  float time = 0.0f;   // s since the clip's start
  float speed = 1.0f;  // negative plays backwards
  bool loop = true;
  bool in_place = false;  // leaves the level travel of the clip's root out
};

void advance_clips(ecs::View<ClipPlayer> players, ecs::Resource<const FrameTime> time);
void sample_clips(ecs::View<const ClipPlayer, LocalPose> characters);
// Bone matrices from pose and placement. Where one of them comes out NaN, infinite or absurdly large (see are_usable),
// the character keeps the last good matrices, or before the first its rest pose, and `held_steps` counts the step.
void compose_bones(ecs::View<const LocalPose, const Placement, BoneMatrices> characters);

}  // namespace fascicle
