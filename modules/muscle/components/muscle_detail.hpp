// State: the level of detail of a character's muscles. On the entity of a musculature that has several levels;
// `select_levels` chooses by what the Viewer sees of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

struct MuscleLevels;

struct MuscleDetail {
  std::shared_ptr<const MuscleLevels> levels;
  std::uint32_t level = 0;        // of levels->assets: Musculature::asset, on its way to the next by Musculature::morph
  // The level of the next step, where that is known: `level` is then just what it draws (a renderer that interpolates
  // between steps takes it over by resample_surface). Else the same as `level`.
  std::uint32_t next = 0;
  std::uint64_t switches = 0;     // of levels, since the spawn
  std::vector<float> twist = {};  // by muscle: scratch of a switch
};

// Resource: who looks at the muscles. Without one that is enabled all are drawn as finely as they can be.
struct Viewer {
  bool enabled = false;
  glm::vec3 eye{0.0f};            // m, world
  float pixels_per_radian = 0.0f;  // in the picture's middle: its height / (2 tan(field of view / 2))
  float tolerance = 1.0f;         // pixels that a coarser level may differ by from the finest
  std::optional<std::uint32_t> level = std::nullopt;  // this one, or the coarsest there is, wherever they are
};

std::size_t heap_bytes(const MuscleDetail& detail);

}  // namespace fascicle::muscle
