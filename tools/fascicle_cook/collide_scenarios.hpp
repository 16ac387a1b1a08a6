// Disturbances that collision has to get over: hips and knees swept through their range, muscles started on the wrong
// side of a bone, teleports, pauses, long frames. Each begins and ends in the walk of a scene's first character.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fascicle::game {
class Simulation;
}
namespace fascicle::muscle {
struct CharacterAsset;
}

namespace fascicle::cook {

struct CollideScenario {
  std::string name;
  std::uint64_t steps = 0;  // that it lasts
  // Plays its step `i`, 0..steps - 1; with the last one the character is back in its walk.
  std::function<void(game::Simulation&, std::uint64_t i)> play;
};

// Those that the character has the bones, the clip and the muscles for: the walker has all.
std::vector<CollideScenario> collide_scenarios(const muscle::CharacterAsset& character);

}  // namespace fascicle::cook
