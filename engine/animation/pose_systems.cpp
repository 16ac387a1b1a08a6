#include "engine/animation/pose_systems.hpp"

#include "engine/animation/clip_travel.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle {
namespace {

// A character's pose is a few microseconds of work.
constexpr std::size_t kCharactersPerTask = 8;

}  // namespace

void advance_clips(ecs::View<ClipPlayer> players, ecs::Resource<const FrameTime> time) {
  players.each([&](ClipPlayer& player) {
    if (player.clip == nullptr) return;
    player.time = wrap_clip_time(*player.clip, player.time + player.speed * time->step, player.loop);
  });
}

void sample_clips(ecs::View<const ClipPlayer, LocalPose> characters) {
  parallel::for_range(characters.candidates(), kCharactersPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      characters.visit(i, [](const ClipPlayer& player, LocalPose& pose) {
        if (player.clip == nullptr) return;
        const float time = player.clip->start + player.time;
        sample_clip(*player.clip, time, pose.bones);
        if (player.in_place && pose.skeleton != nullptr) {
          hold_in_place(*player.clip, *pose.skeleton, time, pose.bones);
        }
      });
    }
  });
}

void compose_bones(ecs::View<const LocalPose, const Placement, BoneMatrices> characters) {
  parallel::for_range(characters.candidates(), kCharactersPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      characters.visit(i, [](const LocalPose& pose, const Placement& placement, BoneMatrices& bones) {
        if (pose.skeleton == nullptr) return;
        // Both grow in the first frame only.
        if (bones.world.size() != pose.bones.size()) bones.world = pose.skeleton->rest_world;
        bones.next.resize(pose.bones.size());
        compose(*pose.skeleton, pose.bones, to_matrix(placement), bones.next);
        if (!are_usable(bones.next)) {
          ++bones.held_steps;
          return;
        }
        bones.world.swap(bones.next);
        bones.teleport_count = placement.teleport_count;
      });
    }
  });
}

}  // namespace fascicle
