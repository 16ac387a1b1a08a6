// What of a simulation's characters is behind a pixel: a muscle's section and vertex, or a bone.
#pragma once

#include <functional>
#include <optional>

#include "engine/render/pick.hpp"
#include "game/simulation.hpp"
#include "game/tag_editor.hpp"

namespace fascicle::game {

// What can be picked: what is seen.
struct PickFilter {
  bool muscles = true, bones = true;
  std::function<bool(const std::string& muscle)> is_hidden = {};  // may be empty
};

// The nearest; of muscles the place as it was drawn after the last step.
std::optional<PickedPlace> pick_place(const Simulation& simulation, const PickFilter& filter, const Ray& ray);

}  // namespace fascicle::game
