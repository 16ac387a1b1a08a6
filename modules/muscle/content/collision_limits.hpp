// The limits of a collision file's figures: shared by its reader and, by a test, content/schema/collision.schema.json.
#pragma once

#include <cstddef>

#include "engine/content/json_reader.hpp"

namespace fascicle::muscle {

inline constexpr NumberRange kSubstepsRange{.min = 1, .max = 32};
inline constexpr NumberRange kIterationsRange{.min = 1, .max = 64};
inline constexpr NumberRange kRelaxationRange{.min = 0, .max = 10000};     // ms
inline constexpr NumberRange kSmoothingRange{.min = 0, .max = 1};
inline constexpr NumberRange kMarginRange{.min = 0, .max = 50};            // mm
inline constexpr NumberRange kSampleSpacingRange{.min = 1, .max = 1000};   // mm
inline constexpr NumberRange kBoneVoxelRange{.min = 0.25, .max = 50};      // mm
// Of the rest line's arc length. The ends are attached to bone and cannot move; nothing else of a line is this near.
inline constexpr NumberRange kPlaceRange{.min = 0.001, .max = 0.999};
inline constexpr NumberRange kStretchRange{.min = 0, .max = 1};            // of the rest line's arc length
inline constexpr NumberRange kAngleRange{.min = 0, .max = 6.2832};         // rad: a turn, rounded up as authors do
inline constexpr std::size_t kMostTags = 100000;                           // of each kind in a file
inline constexpr std::size_t kMostStayOutBones = 1000;

}  // namespace fascicle::muscle
