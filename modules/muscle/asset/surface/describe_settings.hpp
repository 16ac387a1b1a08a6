// A surface muscle's settings in words, so that everything that quotes figures says with which configuration they were
// got, in one way.
#pragma once

#include <string>

#include "modules/muscle/asset/surface/surface_description.hpp"

namespace fascicle::muscle {

// One line, every setting with its unit.
std::string to_text(const SurfaceSettings& settings);

}  // namespace fascicle::muscle
