#include "tools/fascicle_cook/collide_scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "engine/animation/clip.hpp"
#include "engine/animation/pose_systems.hpp"
#include "engine/animation/skeleton.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/muscle.hpp"
#include "tools/walker/skeleton.hpp"

namespace fascicle::cook {
namespace {

using game::Simulation;
using muscle::MuscleCollision;

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;
constexpr float kSweepBlend = 0.1f;  // of the sweep, at either end: from the walk's pose and back to it
constexpr float kMiddleFrom = 0.3f, kMiddleTo = 0.7f;  // of a muscle's sections

ecs::Entity character_of(const Simulation& simulation) { return simulation.characters().front().entity; }

// Flexions are positive.
void bend_legs(float hip, float knee, std::vector<Trs>& pose, const Skeleton& skeleton) {
  const glm::vec3 lateral = walker::from_opensim({0.0f, 0.0f, 1.0f});
  for (const std::string side : {"_r", "_l"}) {
    const auto bone = [&](const char* name) -> Trs& {
      return pose[static_cast<std::size_t>(skeleton.find(name + side))];
    };
    bone("femur").rotation = glm::angleAxis(hip, lateral);
    bone("tibia").rotation = glm::angleAxis(-knee, lateral);
    bone("tibia").translation = walker::tibia_in_femur(-knee);
    glm::vec3 pole = walker::patella_pole_in_tibia(-knee);
    pole.x *= side == "_r" ? 1.0f : -1.0f;
    bone("patella").translation = pole;
    bone("patella").rotation = glm::angleAxis(0.45f * knee, lateral);
  }
}

// Hips from -20 to 100 degrees and knees from 0 to 120, there and back.
void sweep(Simulation& simulation, std::uint64_t i, std::uint64_t steps) {
  ecs::World& world = simulation.world();
  ClipPlayer& player = world.get<ClipPlayer>(character_of(simulation));
  const auto clip = simulation.scene().characters.front().animation.clip;
  if (i + 1 == steps) {
    player.clip = clip;
    return simulation.step();
  }
  player.clip = nullptr;
  LocalPose& pose = world.get<LocalPose>(character_of(simulation));
  sample_clip(*clip, clip->start + player.time, pose.bones);
  std::vector<Trs> swept = pose.bones;
  const float way = static_cast<float>(i + 1) / static_cast<float>(steps);
  const float turn = 2.0f * std::numbers::pi_v<float> * way;
  bend_legs((40.0f + 60.0f * std::sin(turn - std::asin(2.0f / 3.0f))) * kDegrees,
            60.0f * (1.0f - std::cos(turn)) * kDegrees, swept, *pose.skeleton);
  const float weight = std::clamp(std::min(way, 1.0f - way) / kSweepBlend, 0.0f, 1.0f);
  for (std::size_t b = 0; b < swept.size(); ++b) {
    pose.bones[b].rotation = glm::slerp(pose.bones[b].rotation, swept[b].rotation, weight);
    pose.bones[b].translation = glm::mix(pose.bones[b].translation, swept[b].translation, weight);
  }
  simulation.step();
}

// The muscle's middle sections are put as far beyond the bone's axis as they are on this side of it.
void put_beyond(Simulation& simulation, std::uint32_t muscle, std::size_t bone, std::size_t next_bone) {
  ecs::World& world = simulation.world();
  const ecs::Entity musculature = simulation.characters().front().musculature;
  const std::vector<glm::mat4>& bones = world.get<BoneMatrices>(character_of(simulation)).world;
  MuscleCollision* collision = world.try_get<MuscleCollision>(musculature);
  if (collision != nullptr && collision->asset != nullptr) {
    const muscle::CollisionAsset& asset = *collision->asset;
    const muscle::ActionLines& lines = world.get<muscle::ActionLines>(musculature);
    const glm::vec3 top(bones[bone][3]), axis = glm::normalize(glm::vec3(bones[next_bone][3]) - top);
    const std::uint32_t first = asset.first_section[muscle], count = asset.first_section[muscle + 1] - first;
    for (std::uint32_t s = first; s < first + count; ++s) {
      const muscle::CollisionSection& section = asset.sections[s];
      const float place = static_cast<float>(section.section) / static_cast<float>(count - 1);
      if (section.end || place < kMiddleFrom || place > kMiddleTo) continue;
      const std::uint32_t slot = section.slot;
      const glm::vec3 centre(lines.x[slot], lines.y[slot], lines.z[slot]);
      const glm::vec3 across = centre - (top + glm::dot(centre - top, axis) * axis);
      const glm::vec3 moved = glm::transpose(glm::mat3(bones[section.bone])) * (-2.0f * across);
      collision->offset_x[slot] += moved.x;
      collision->offset_y[slot] += moved.y;
      collision->offset_z[slot] += moved.z;
    }
  }
  simulation.step();
}

void teleport(Simulation& simulation, bool told) {
  Placement& placement = simulation.world().get<Placement>(character_of(simulation));
  placement.position += glm::vec3(5.0f, 0.5f, -3.0f);
  placement.rotation = glm::angleAxis(2.1f, glm::vec3(0.0f, 1.0f, 0.0f)) * placement.rotation;
  if (told) ++placement.teleport_count;
  simulation.step();
}

void step_slowly(Simulation& simulation, float seconds) {
  const float usual = simulation.loop().time().step;
  simulation.loop().set_step(seconds);
  simulation.step();
  simulation.loop().set_step(usual);
}

}  // namespace

std::vector<CollideScenario> collide_scenarios(const muscle::CharacterAsset& character) {
  std::vector<CollideScenario> list;
  const Skeleton& skeleton = *character.skeleton;
  bool has_legs = !character.clips.empty();
  for (const char* name : {"femur_r", "tibia_r", "patella_r", "femur_l", "tibia_l", "patella_l"}) {
    has_legs = has_legs && skeleton.find(name) >= 0;
  }
  if (has_legs) {
    constexpr std::uint64_t kSteps = 60;
    list.push_back({"sweep", kSteps, [](Simulation& simulation, std::uint64_t i) { sweep(simulation, i, kSteps); }});
  }
  for (const std::string name : {"rectus_femoris", "vastus_intermedius", "biceps_femoris_short_head"}) {
    const std::int32_t muscle = character.muscles ? find_muscle(*character.muscles, name + "_r") : -1;
    if (!has_legs || muscle < 0) continue;
    const auto femur = static_cast<std::size_t>(skeleton.find("femur_r"));
    const auto tibia = static_cast<std::size_t>(skeleton.find("tibia_r"));
    list.push_back({"beyond femur: " + name, 1, [=](Simulation& simulation, std::uint64_t) {
                      put_beyond(simulation, static_cast<std::uint32_t>(muscle), femur, tibia);
                    }});
  }
  list.push_back({"teleport", 1, [](Simulation& simulation, std::uint64_t) { teleport(simulation, true); }});
  list.push_back({"teleport untold", 1, [](Simulation& simulation, std::uint64_t) { teleport(simulation, false); }});
  list.push_back({"pause", 30, [](Simulation& simulation, std::uint64_t) { simulation.refresh(); }});
  list.push_back({"frame of 1/15 s", 1,
                  [](Simulation& simulation, std::uint64_t) { step_slowly(simulation, 1.0f / 15.0f); }});
  return list;
}

}  // namespace fascicle::cook
