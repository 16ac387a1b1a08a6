#include "tools/fascicle_cook/posed_muscles.hpp"

#include <cmath>
#include <numbers>

#include "engine/animation/clip.hpp"
#include "engine/animation/joint_model.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::cook {

std::vector<std::vector<glm::mat4>> pose_range(const muscle::CharacterAsset& character, const Motion* motion,
                                               const std::string& clip, std::uint32_t frames) {
  const Skeleton& skeleton = *character.skeleton;
  std::vector<std::vector<glm::mat4>> poses{skeleton.rest_world};
  const auto add = [&](const std::vector<Trs>& local) {
    poses.emplace_back(skeleton.size());
    compose(skeleton, local, glm::mat4(1.0f), poses.back());
  };
  for (const auto& played : character.clips) {
    if (!clip.empty() && played->name != clip) continue;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      std::vector<Trs> local = skeleton.rest_local;
      sample_clip(*played, played->start + played->duration() * static_cast<float>(frame) / static_cast<float>(frames),
                  local);
      add(local);
    }
  }
  if (motion != nullptr && character.joints) {
    std::vector<double> values = default_coordinates(*character.joints);
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      sample_cycle(*motion, motion->cycle.length() * frame / frames, true, values);
      std::vector<Trs> local = skeleton.rest_local;
      pose_joints(*character.joints, values, local);
      add(local);
    }
  }
  return poses;
}

PosedMuscles::PosedMuscles(std::shared_ptr<const muscle::MuscleAsset> asset) : asset_(std::move(asset)) {
  world_.set_resource(FrameTime{});
  muscle::prepare_muscles(world_);
  muscle::add_muscle_systems(schedule_);
  character_ = world_.create();
  world_.add(character_, BoneMatrices{});
  musculature_ = muscle::spawn_musculature(world_, character_, asset_);
}

void PosedMuscles::pose(const std::vector<glm::mat4>& bones) {
  BoneMatrices& matrices = world_.get<BoneMatrices>(character_);
  matrices.world = bones;
  ++matrices.teleport_count;  // poses far apart are no movement
  schedule_.run(world_, workers_);
}

std::vector<glm::vec3> PosedMuscles::vertices(std::uint32_t muscle) const {
  const muscle::CrossSections& sections = world_.get<muscle::CrossSections>(musculature_);
  const muscle::MuscleLayout& layout = asset_->muscles[muscle];
  const std::uint32_t count = layout.section_vertices;
  const muscle::Circle& circle = asset_->circles[layout.circle];
  std::vector<glm::vec3> vertices;
  for (std::uint32_t k = 0; k < layout.section_count; ++k) {
    const std::uint32_t slot = asset_->slot(muscle, k);
    const glm::vec3 u(sections.ux[slot], sections.uy[slot], sections.uz[slot]);
    const glm::vec3 v(sections.vx[slot], sections.vy[slot], sections.vz[slot]);
    for (std::uint32_t i = 0; i < count; ++i) {
      vertices.push_back(centre(muscle, k) +
                         sections.radii[asset_->radius(muscle, k) + i] * (circle.cosines[i] * u + circle.sines[i] * v));
    }
  }
  vertices.push_back(centre(muscle, 0));
  vertices.push_back(centre(muscle, layout.section_count - 1));
  return vertices;
}

glm::vec3 PosedMuscles::centre(std::uint32_t muscle, std::uint32_t section) const {
  return muscle::line_point(*asset_, world_.get<muscle::ActionLines>(musculature_), muscle, section);
}

}  // namespace fascicle::cook
