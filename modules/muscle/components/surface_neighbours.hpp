// State: which surface muscles of a character may touch each other, on the character's entity. They take their substeps
// together (systems/4_solve/solve_surface_neighbours.hpp), in the order in which they were spawned.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/ecs/entity.hpp"
#include "modules/muscle/kernels/surface/surface_pairs.hpp"

namespace fascicle::muscle {

struct NeighbourPair {
  std::uint32_t first = 0, second = 0;                     // in `muscles`
  std::vector<float> first_clearance, second_clearance;    // m, at rest, by vertex; empty: nowhere near
  SurfacePairs pairs;
  std::uint32_t first_restarts = 0, second_restarts = 0;   // of their scratch when pairs were last found
  glm::mat4 second_to_first{1.0f};                         // between their simulation's frames, at the last step
};

struct SurfaceNeighbours {
  std::vector<ecs::Entity> muscles;
  std::vector<NeighbourPair> pairs;
  std::vector<std::uint8_t> solved;  // scratch: by muscle, whether it is solved in this step
};

}  // namespace fascicle::muscle
