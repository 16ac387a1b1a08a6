// State: lengths, volume, mass and force capacity of the muscles as they are now (1.1, 1.6), for gameplay, overlays
// and statistics. On a musculature's entity; all arrays by muscle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle::muscle {

struct MuscleMeasures {
  std::vector<float> length;         // m, functional: along the attachments alone, whatever the level of detail
  std::vector<float> drawn_length;   // m, along the drawn line
  std::vector<float> volume;         // m^3, of the belly
  std::vector<float> mass;           // kg, of the belly
  std::vector<float> pcsa;           // m^2; zero where the fibre length is unknown
  std::vector<float> force;          // N, pcsa * specific tension
  std::vector<glm::vec3> tendon_point;  // m, world: where the insertion's tendon ends
};

std::size_t heap_bytes(const MuscleMeasures& measures);

}  // namespace fascicle::muscle
