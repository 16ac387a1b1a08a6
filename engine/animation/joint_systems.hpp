// Systems that play recorded motions on joint models, one character an entity. In frame order: advance_motions,
// sample_motions, pose_joint_models; then `compose_bones`, as for glTF characters.
#pragma once

#include <memory>
#include <vector>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/motion.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/loop/frame_time.hpp"

namespace fascicle {

// Component: the coordinates of a joint model, one value each (rad, m). A game may write it itself, without a player.
struct CoordinatePose {
  std::shared_ptr<const JointModel> model;
  std::vector<double> values;
};

inline std::size_t heap_bytes(const CoordinatePose& pose) { return pose.values.capacity() * sizeof(double); }

// Component: plays a motion on the entity's CoordinatePose. The motion must have been read for the same model.
struct MotionPlayer {
  std::shared_ptr<const Motion> motion;
  double time = 0.0;      // s since the start of the motion's cycle (looped) or of the record
  double speed = 1.0;     // negative plays backwards
  bool loop = true;       // false: the record once, held at its ends
  bool in_place = false;  // leaves the travel of looped translations out
};

void advance_motions(ecs::View<MotionPlayer> players, ecs::Resource<const FrameTime> time);
void sample_motions(ecs::View<const MotionPlayer, CoordinatePose> characters);
void pose_joint_models(ecs::View<const CoordinatePose, LocalPose> characters);

// The component for a model at its defaults.
CoordinatePose make_coordinate_pose(std::shared_ptr<const JointModel> model);

}  // namespace fascicle
