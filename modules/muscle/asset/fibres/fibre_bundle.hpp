// The fibres inside a surface muscle (4.4): made at rest by one of two methods, then bound to the surface, so that they
// follow its deformation at the cost of a few gathers a point. Immutable, shared by all characters with the muscle.
//
// How a point is bound so that it stays inside: see bind_fibres.hpp. It leaves the muscle only where the surface comes
// in across its chord from the side, or passes through itself.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"
#include "engine/math/aligned_vector.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/kernels/surface/place_fibres.hpp"

namespace fascicle::muscle {

struct FibreBundleAsset {
  FibreBundleSettings settings;
  std::uint32_t surface_vertices = 0;       // of the surface that it is bound to
  std::uint32_t count = 0;                  // fibres
  std::uint32_t points_per_fibre = 0;
  AlignedVector<FibreBinding> bindings;     // to the SurfaceAsset's vertices, fibre after fibre, from the origin
  std::vector<glm::vec3> rest_points;       // m, rest space
  std::vector<float> rest_length;           // m, by fibre
  std::vector<std::uint32_t> head;          // by fibre; all zero with the isocontour method
  std::uint32_t pulled_in = 0;              // points that had to be moved to lie inside
  float most_pulled = 0.0f;                 // m
};

// The bundle that the settings ask for. Errors, at the muscle's name: no origin or insertion, several heads (the
// isocontour method has one; the surface-fibre method takes more), no fibres on the surface, fibres that do not touch
// the muscle, settings out of range, points that cannot be brought inside. The same for every thread count.
Result<std::shared_ptr<const FibreBundleAsset>> build_fibre_bundle(const SurfaceAsset& surface,
                                                                   const FibreBundleSettings& settings);

}  // namespace fascicle::muscle
