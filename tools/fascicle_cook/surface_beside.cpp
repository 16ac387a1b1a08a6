#include "tools/fascicle_cook/surface_beside.hpp"

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

}  // namespace fascicle::cook
