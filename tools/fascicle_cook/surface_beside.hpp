// Position based dynamics beside the coarse hull (4.5): the same characters going smoothly through a motion, for dynamics
// know no poses, only ways to them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::cook {

// The scene with that motion in the place of its own: a file, or a name among the content's motions. Played whole, and
// begun so that the first step shows the record's first pose.
Result<std::shared_ptr<const muscle::SceneAsset>> scene_beside(const muscle::SceneAsset& scene,
                                                               const std::string& motion);

// Steps of such a scene until the coordinates are furthest from where they were at the first.
std::uint64_t steps_to_peak(const muscle::SceneAsset& beside);

}  // namespace fascicle::cook
