#include "tools/fascicle_cook/surface_beside.hpp"

#include <cmath>
#include <filesystem>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/motion_reader.hpp"
#include "modules/muscle/content/find_content.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;

fs::path find_motion(const std::string& name_or_path) {
  std::error_code error;
  if (fs::exists(name_or_path, error) || fs::path(name_or_path).has_extension()) return name_or_path;
  return muscle::find_content_folder() / "motions" / (name_or_path + ".mot");
}

}  // namespace

Result<std::shared_ptr<const muscle::SceneAsset>> scene_beside(const muscle::SceneAsset& scene,
                                                               const std::string& motion) {
  auto beside = std::make_shared<muscle::SceneAsset>(scene);
  for (muscle::SceneCharacter& placed : beside->characters) {
    if (placed.character->joints == nullptr) {
      return Diagnostics{{{motion, 0, 0, {}, placed.character->name + " has no joints that a motion could move",
                           "name a scene whose characters have joints"}},
                         {}};
    }
    auto read = read_motion(find_motion(motion), *placed.character->joints);
    if (!read) return read.diagnostics();
    loop_whole_record(*read);
    auto shared = std::make_shared<const Motion>(std::move(*read));
    // A step ends where it is shown.
    const float cycle = static_cast<float>(shared->cycle.length());
    const float phase = cycle > 0.0f ? 1.0f - 1.0f / (scene.step_hz * cycle) : 0.0f;
    placed.animation = {.clip = nullptr, .motion = std::move(shared), .speed = 1.0f, .phase = phase};
  }
  return std::shared_ptr<const muscle::SceneAsset>(std::move(beside));
}

std::uint64_t steps_to_peak(const muscle::SceneAsset& beside) {
  double furthest = 0.0, when = 0.0;  // s since the record's start
  for (const muscle::SceneCharacter& placed : beside.characters) {
    if (placed.animation.motion == nullptr) continue;
    const Motion& motion = *placed.animation.motion;
    for (std::size_t i = 0; i < motion.values.size(); ++i) {
      const double change = std::abs(motion.values[i] - motion.values[i % motion.coordinates]);
      if (change <= furthest) continue;
      furthest = change;
      when = motion.times[i / motion.coordinates] - motion.times.front();
    }
  }
  return static_cast<std::uint64_t>(std::lround(when * static_cast<double>(beside.step_hz))) + 1;
}

}  // namespace fascicle::cook
