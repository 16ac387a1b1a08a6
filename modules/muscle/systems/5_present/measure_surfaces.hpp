// System: how well surface muscles keep their shape (4.3), on those that have a SurfaceQuality. Nobody has one unless
// somebody wants to know (a report, fascicle-cook, a test): then it costs a few milliseconds a muscle and step.
#pragma once

#include "engine/ecs/view.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

void measure_surfaces(ecs::View<const SurfaceMuscle, const SurfaceState, SurfaceQuality> muscles);

}  // namespace fascicle::muscle
