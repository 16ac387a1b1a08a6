// What `fascicle-cook fibres` says of a bundle: a table, a CSV file of its points, a picture.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "modules/muscle/asset/fibres/fibre_bundle.hpp"

namespace fascicle::cook {

struct MuscleFibres {
  std::shared_ptr<const muscle::SurfaceAsset> surface;
  std::shared_ptr<const muscle::FibreBundleAsset> bundle;
};

const char* to_string(muscle::FibreMethod method);
const char* to_string(muscle::FibreArrangement arrangement);

// Numbers, lengths at rest, repairs, directions against the fibres given on the surface.
std::string fibres_table(const MuscleFibres& muscle);
// A line a point: muscle, fibre, head, the fibre's length (mm), the point's number and place (m, rest space).
std::string fibres_csv(std::span<const MuscleFibres> muscles);
// The fibres at rest from the front (x, y) and from the side (z, y), coloured by where they begin; those given on the
// surface in black.
std::string fibres_svg(const MuscleFibres& muscle);

}  // namespace fascicle::cook
