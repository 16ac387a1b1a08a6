// How well a bundle runs as the fibres given on the surface do.
#pragma once

#include <cstddef>
#include <span>

#include "modules/muscle/asset/fibres/fibre_bundle.hpp"

namespace fascicle::muscle {

struct DirectionError {
  double mean = 0.0, max = 0.0;      // rad, 0..pi/2: of lines, whatever way they run
  double distance = 0.0;             // m, mean: from the places asked to the nearest fibre
  std::size_t places = 0;            // asked: one a millimetre of the given fibres, and one a segment at least
};

// At every place of the given fibres the angle between their tangent and that of the bundle's nearest segment, at rest.
DirectionError measure_direction(const FibreBundleAsset& bundle, std::span<const FibreLine> given);

}  // namespace fascicle::muscle
