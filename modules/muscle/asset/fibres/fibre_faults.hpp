// Errors about a muscle's fibres, at the muscle's name.
#pragma once

#include <string>
#include <utility>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

inline Diagnostic fibre_fault(const SurfaceAsset& surface, std::string cause, std::string remedy) {
  return {"", 0, 0, surface.name + "/inner_fibres", std::move(cause), std::move(remedy)};
}

}  // namespace fascicle::muscle
