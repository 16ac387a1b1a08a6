// A scene played with fibres in its surface muscles: whether they stay inside, how long they become, what they cost.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "modules/muscle/content/scene_asset.hpp"
#include "tools/fascicle_cook/fibres_report.hpp"

namespace fascicle::cook {

struct FibrePlay {
  std::string muscle;
  std::uint64_t steps = 0, checked = 0;      // checked: steps at which every point was asked whether it is inside
  std::size_t outside = 0;                   // points, at the worst step
  std::uint64_t worst_step = 0;
  std::size_t self_intersections = 0;        // pairs of triangles of the surface that cross, at that step
  double furthest = 0.0;                     // m, outside, at any step
  double least_ratio = 1.0, most_ratio = 1.0, last_ratio = 1.0;  // mean length to rest
  double fibres_us = 0.0, step_us = 0.0;     // median over the steps: this muscle's fibres; the whole simulation
};

// One entry for each of `muscles` that the scene has. Every `every`th step is checked. One worker, so that times mean
// something.
std::vector<FibrePlay> play_fibres(const std::shared_ptr<const muscle::SceneAsset>& scene,
                                   std::span<const MuscleFibres> muscles, std::uint64_t every);

std::string to_table(const FibrePlay& play);

}  // namespace fascicle::cook
