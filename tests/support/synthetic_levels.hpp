// The synthetic lower body at several levels of detail, as fits to one anatomy would give them: bent lines, flattened
// and lobed sections, both sampled from smooth shapes, and noise of each level's own.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::test {

// A fit of `muscle` at the level that its description says. `noise` is relative to the radii.
inline muscle::MuscleFit synthetic_fit(const muscle::MuscleDescription& muscle, std::uint32_t index, float noise) {
  constexpr float kPi = 3.14159265f;
  const std::uint32_t count = muscle.section_vertices;
  const auto segments = static_cast<std::uint32_t>(muscle.attachments.size() - 1) << muscle.longitudinal_subdivision;
  std::uint32_t random = 7919u * index + 31u * count + segments;
  const auto next = [&] {  // in [-1, 1)
    random = random * 1664525u + 1013904223u;
    return static_cast<float>(random >> 8) / 8388608.0f - 1.0f;
  };
  const float turn = 0.7f * static_cast<float>(index);
  muscle::MuscleFit fit;
  for (std::uint32_t k = 0; k <= segments; ++k) {
    const float s = static_cast<float>(k) / static_cast<float>(segments);
    const float bulge = std::sin(kPi * s);
    fit.displacements.push_back(0.01f * bulge * glm::vec3(std::cos(turn), 0.2f * bulge, std::sin(turn)));
    for (std::uint32_t i = 0; i < count; ++i) {
      const float angle = 2.0f * kPi * static_cast<float>(i) / static_cast<float>(count);
      const float shape = 1.0f + 0.3f * std::cos(2.0f * angle + turn) + 0.1f * std::sin(3.0f * angle - turn);
      fit.radii.push_back((0.006f + 0.018f * bulge) * shape * (1.0f + noise * next()));
    }
  }
  return fit;
}

inline std::shared_ptr<const muscle::MuscleAsset> synthetic_level(
    const std::vector<muscle::MuscleDescription>& descriptions, float noise = 0.0f) {
  std::vector<muscle::MuscleFit> fits;
  for (std::uint32_t m = 0; m < descriptions.size(); ++m) fits.push_back(synthetic_fit(descriptions[m], m, noise));
  const auto built = muscle::build_muscle_asset(descriptions, rest_bones(), fits);
  return built.ok() ? *built : nullptr;
}

inline void coarsen(std::vector<muscle::MuscleDescription>& descriptions) {
  for (muscle::MuscleDescription& description : descriptions) {
    const muscle::MuscleLevel level =
        muscle::coarser_level({description.section_vertices, description.longitudinal_subdivision});
    description.section_vertices = level.section_vertices;
    description.longitudinal_subdivision = level.longitudinal_subdivision;
  }
}

// `count` levels from `finest` on; null where they cannot be.
inline std::shared_ptr<const muscle::MuscleLevels> synthetic_levels(muscle::MuscleLevel finest = {36, 3},
                                                                    std::size_t count = 3, float noise = 0.0f) {
  auto descriptions = synthetic_muscles(finest.section_vertices, finest.longitudinal_subdivision);
  std::vector<std::shared_ptr<const muscle::MuscleAsset>> assets;
  for (std::size_t level = 0; level < count; ++level) {
    assets.push_back(synthetic_level(descriptions, noise));
    coarsen(descriptions);
  }
  const auto levels = muscle::make_muscle_levels(assets);
  return levels.ok() ? *levels : nullptr;
}

}  // namespace fascicle::test
