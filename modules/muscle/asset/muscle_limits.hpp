// The limits of a muscle's figures: the one table that the reader of character files and the builder's checks share,
// and that a test holds content/schema/character.schema.json to. The ranges are those of anything that walks on earth,
// from a mouse to an elephant, in SI units: a figure outside them is a slip of unit.
#pragma once

#include <cstddef>
#include <numbers>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {

// In a description 0 stands for an unknown fibre length, source length and specific tension; a file leaves them out.
inline constexpr NumberRange kForceRange{.min = 0, .max = 1e7};                               // N
inline constexpr NumberRange kFibreLengthRange{.min = 0, .max = 100, .above_min = true};      // m
inline constexpr NumberRange kTendonLengthRange{.min = 0, .max = 100};                        // m
inline constexpr NumberRange kSourceLengthRange{.min = 0, .max = 100, .above_min = true};     // m
inline constexpr NumberRange kSpecificTensionRange{.min = 1e4, .max = 1e7};                   // N/m^2
inline constexpr NumberRange kPcsaRange{.min = 0, .max = 100, .above_min = true};             // m^2
inline constexpr NumberRange kVolumeRange{.min = 0, .max = 100, .above_min = true};           // m^3
inline constexpr NumberRange kFractionRange{.min = 0, .max = 1};                              // of a length
inline constexpr NumberRange kRadiusRange{.min = 0, .max = 10};                               // m, absolute
inline constexpr NumberRange kRelativeRadiusRange{.min = 0, .max = 1e6};                      // weights
inline constexpr NumberRange kPositionRange{.min = -100, .max = 100};  // m along each axis, from the bone or the origin
inline constexpr NumberRange kSectionVerticesRange{.min = 6, .max = static_cast<double>(kMaxSectionVertices)};  // even
inline constexpr NumberRange kSubdivisionRange{.min = 0, .max = 6};
inline constexpr NumberRange kCoarserLevelsRange{.min = 0, .max = 6};
inline constexpr NumberRange kSupersamplingRange{.min = 1, .max = 16};                        // CSS
inline constexpr NumberRange kMaxDistanceRange{.min = 0, .max = 1000, .above_min = true};     // mm
inline constexpr NumberRange kAreaRange{.min = 0, .max = 1000, .above_min = true};            // mm
inline constexpr float kRightAngle = std::numbers::pi_v<float> / 2.0f;  // rad: pennation is at least 0 and below it
inline constexpr std::size_t kMostViaPoints = 256;
inline constexpr std::size_t kFewestProfilePoints = 2;
inline constexpr std::size_t kMostProfilePoints = 64;

// False for NaN.
constexpr bool lies_in(double value, const NumberRange& range) {
  return value <= range.max && (range.above_min ? value > range.min : value >= range.min);
}

}  // namespace fascicle::muscle
