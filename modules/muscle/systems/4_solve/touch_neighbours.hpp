// Contacts between two surface muscles within a step that both take together.
#pragma once

#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/components/surface_neighbours.hpp"

namespace fascicle::muscle {

struct TouchingMuscle {
  const SurfaceMuscle* muscle = nullptr;
  SurfaceState* state = nullptr;
};

// After begin_step of both: finds what may touch in this step.
void find_touching(const TouchingMuscle& first, const TouchingMuscle& second, NeighbourPair& pair);

// In each substep, which ends at this part of the step: so far have the muscles' frames moved, each with a bone of its
// own.
void push_apart(const TouchingMuscle& first, const TouchingMuscle& second, double fraction, NeighbourPair& pair);

}  // namespace fascicle::muscle
