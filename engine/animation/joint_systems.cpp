#include "engine/animation/joint_systems.hpp"

#include <cassert>
#include <cstddef>
#include <utility>

#include "engine/parallel/for_range.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kCharactersPerChunk = 8;  // a dozen joints each: tens of microseconds a chunk

}  // namespace

void advance_motions(ecs::View<MotionPlayer> players, ecs::Resource<const FrameTime> time) {
  const double step = time->step;
  players.each([step](MotionPlayer& player) { player.time += player.speed * step; });
}

void sample_motions(ecs::View<const MotionPlayer, CoordinatePose> characters) {
  const auto sample = [](const MotionPlayer& player, CoordinatePose& pose) {
    if (!player.motion) return;
    assert(player.motion->coordinates == pose.values.size());
    if (player.loop) {
      sample_cycle(*player.motion, player.time, player.in_place, pose.values);
    } else {
      sample_motion(*player.motion, player.motion->times.front() + player.time, pose.values);
    }
  };
  parallel::for_range(characters.candidates(), kCharactersPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) characters.visit(i, sample);
  });
}

void pose_joint_models(ecs::View<const CoordinatePose, LocalPose> characters) {
  const auto pose_one = [](const CoordinatePose& pose, LocalPose& local) {
    if (pose.model) pose_joints(*pose.model, pose.values, local.bones);
  };
  parallel::for_range(characters.candidates(), kCharactersPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) characters.visit(i, pose_one);
  });
}

CoordinatePose make_coordinate_pose(std::shared_ptr<const JointModel> model) {
  std::vector<double> values = default_coordinates(*model);
  return {std::move(model), std::move(values)};
}

}  // namespace fascicle
