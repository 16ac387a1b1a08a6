// Whether a description can become a SurfaceAsset: everything that is wrong with it, in one go.
#pragma once

#include <cstdint>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/surface/surface_description.hpp"

namespace fascicle::muscle {

struct MuscleAsset;

// At the description's place, its path extended by `field`.
Diagnostic fault_of(const SurfaceMuscleDescription& description, const std::string& field, std::string cause,
                    std::string remedy);

Diagnostics check_surface(const SurfaceMuscleDescription& description, std::uint32_t bone_count,
                          const MuscleAsset* muscles);

}  // namespace fascicle::muscle
