// Poses of a run that are taken again: does a muscle that is posed by its coarse hull (4.5) have the same shape
// whatever came before? Only of characters with joints, whose coordinates are set to exactly what they were.
#pragma once

#include <memory>
#include <vector>

#include "game/simulation.hpp"
#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// By character: those of its joints. Empty where it has none.
using Coordinates = std::vector<std::vector<double>>;

Coordinates read_coordinates(const game::Simulation& simulation);

// Ends a run of the scene: some of its poses again, from its last to its first, in the same simulation, and each as the
// first step of a new one. SurfaceMuscleRun::revisits has what was found. `by_step`: coordinates of the run's steps.
void revisit(const std::shared_ptr<const muscle::SceneAsset>& scene, const std::vector<Coordinates>& by_step,
             game::Simulation& simulation, SurfaceRun& run);

}  // namespace fascicle::cook
