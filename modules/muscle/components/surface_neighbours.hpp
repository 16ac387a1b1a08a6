// State: which surface muscles of a character may touch each other, on the character's entity. They take their substeps
// together (systems/4_solve/solve_surface_neighbours.hpp), in the order in which they were spawned.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"
#include "modules/muscle/kernels/surface/surface_pairs.hpp"

namespace fascicle::muscle {

struct NeighbourPair {
  std::uint32_t first = 0, second = 0;                     // in `muscles`
  std::vector<float> first_clearance, second_clearance;    // m, at rest, by vertex; empty: nowhere near
  SurfacePairs pairs;
  std::uint32_t first_restarts = 0, second_restarts = 0;   // of their scratch when pairs were last found
  RigidMotion second_to_first;                             // between their simulation's frames, in the last step
};

struct SurfaceNeighbours {
  std::vector<ecs::Entity> muscles;
  std::vector<NeighbourPair> pairs;
  std::vector<std::uint8_t> solved;  // scratch, by muscle: 0 not solved in this step, 1 touches no other, 2 may touch one
};

}  // namespace fascicle::muscle
