// The limits of the figures of surface muscles: shared by their reader and, by a test, content/schema/
// character.schema.json.
#pragma once

#include <cstddef>

#include "engine/content/json_reader.hpp"

namespace fascicle::muscle {

inline constexpr NumberRange kSurfaceSubstepsRange{.min = 1, .max = 64};
inline constexpr NumberRange kDensityRange{.min = 100, .max = 20000};             // kg/m^3
inline constexpr NumberRange kStretchComplianceRange{.min = 0, .max = 1000};      // m/N
inline constexpr NumberRange kAlongFibresRange{.min = 0, .max = 1};
inline constexpr NumberRange kBendComplianceRange{.min = 0, .max = 1e9};          // rad/(N m)
inline constexpr NumberRange kAnchorComplianceRange{.min = 0, .max = 1e9};        // m/N
inline constexpr NumberRange kVolumeComplianceRange{.min = 0, .max = 1};          // m^3/Pa
inline constexpr NumberRange kDampingRange{.min = 0, .max = 10000};               // 1/s
inline constexpr NumberRange kContactDistanceRange{.min = 0, .max = 50};          // mm
inline constexpr NumberRange kFrictionRange{.min = 0, .max = 10};
inline constexpr NumberRange kAttachmentDistanceRange{.min = 0, .max = 1000, .above_min = true};  // mm
inline constexpr NumberRange kPlaneRange{.min = -1e6, .max = 1e6};                // in the mesh's unit, or m
inline constexpr NumberRange kFibrePointRange{.min = -1e6, .max = 1e6};           // in the fibres' unit
inline constexpr NumberRange kHeadRange{.min = 0, .max = 63};
inline constexpr NumberRange kFibreCountRange{.min = 1, .max = 100000};
inline constexpr NumberRange kPointsPerFibreRange{.min = 2, .max = 1000};
inline constexpr NumberRange kFibrePennationRange{.min = 0, .max = 1.5};          // rad
inline constexpr NumberRange kPieceRange{.min = 1, .max = 1000};
inline constexpr NumberRange kAbovePixelsRange{.min = 0, .max = 100000};
inline constexpr NumberRange kHullVerticesRange{.min = 4, .max = 1000};           // its matrices grow by their square
inline constexpr NumberRange kHullErrorRange{.min = 0, .max = 1000};              // mm
inline constexpr NumberRange kHullIterationsRange{.min = 1, .max = 100};
inline constexpr NumberRange kHullToleranceRange{.min = 0, .max = 0.1, .above_min = true};  // of the muscle's size
inline constexpr NumberRange kRefinementsRange{.min = 0, .max = 100};
inline constexpr NumberRange kHullWeightRange{.min = 0, .max = 1000};             // beside the shape's, which is 1
inline constexpr NumberRange kLinePointRange{.min = -1e6, .max = 1e6};            // in the mesh's unit, or m
inline constexpr std::size_t kMostSurfaceLevels = 8;
inline constexpr std::size_t kMostLinePoints = 256;
inline constexpr std::size_t kMostSurfaceMuscles = 10000;
inline constexpr std::size_t kMostSurfaceAttachments = 1000;
inline constexpr std::size_t kMostFibreEntries = 100000;
inline constexpr std::size_t kMostFibrePoints = 100000;                           // written out, of one fibre

// A mesh whose box is longer or shorter has the wrong unit.
inline constexpr float kLongestMuscle = 10.0f;    // m
inline constexpr float kShortestMuscle = 0.003f;  // m
// A line that is shorter has no direction.
inline constexpr float kShortestLine = 1.0e-3f;   // m
// How far from the muscle a fibre's nearest point may be for the two to touch. Anatomical data are no better: of the
// gluteus' fibres in the real data one is 8 mm away.
inline constexpr float kFibreReach = 0.01f;       // m

}  // namespace fascicle::muscle
