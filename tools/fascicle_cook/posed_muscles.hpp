// A character's muscles over its animation, as the systems pose them without collision: for commands that look at
// every pose.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle {
struct Motion;
}

namespace fascicle::cook {

// The rest pose, then `frames` poses spread evenly over each of the character's clips (or the one named `clip`), or
// over the motion's cycle: bone matrices in the character's space.
std::vector<std::vector<glm::mat4>> pose_range(const muscle::CharacterAsset& character, const Motion* motion,
                                               const std::string& clip, std::uint32_t frames);

class PosedMuscles {
 public:
  explicit PosedMuscles(std::shared_ptr<const muscle::MuscleAsset> asset);

  // Brings the muscles to these bones.
  void pose(const std::vector<glm::mat4>& bones);

  // Vertex i of section k of a muscle is k |C| + i (m), then the centres of the first and the last section.
  std::vector<glm::vec3> vertices(std::uint32_t muscle) const;
  glm::vec3 centre(std::uint32_t muscle, std::uint32_t section) const;
  const muscle::MuscleAsset& asset() const { return *asset_; }

 private:
  std::shared_ptr<const muscle::MuscleAsset> asset_;
  ecs::World world_;
  ecs::Schedule schedule_;
  parallel::WorkerArena workers_{1};
  ecs::Entity character_, musculature_;
};

}  // namespace fascicle::cook
