// System: where the fibres of surface muscles are and how long (4.4), on those that have a FibreBundle.
#pragma once

#include "engine/ecs/view.hpp"
#include "modules/muscle/components/surface_muscle.hpp"

namespace fascicle::muscle {

// After the surfaces are solved. A bundle whose surface has fewer points than it needs stays as it is.
void measure_fibres(ecs::View<const SurfaceState, FibreBundle> muscles);

// The same for one.
void measure_fibre_bundle(const SurfaceState& state, FibreBundle& bundle);

}  // namespace fascicle::muscle
