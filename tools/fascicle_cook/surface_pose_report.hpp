// What `fascicle-cook surface` prints and writes of muscles that are posed by their coarse hulls (4.5).
#pragma once

#include <string>

#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// A row a pose, by its angle; of many, about a dozen. `smooth`: beside each, where there is one, the figures of the
// muscle by dynamics, and how far the two shapes are from each other.
std::string surface_pose_table(const SurfaceMuscleRun& run, const SurfaceMuscleRun* smooth = nullptr);

// A row a pose: how far each iteration moved a vertex, first of the hull, then of the full mesh.
std::string surface_residual_table(const SurfaceMuscleRun& run);

// A line a muscle, step and iteration.
std::string surface_residual_csv(const SurfaceRun& run);

}  // namespace fascicle::cook
