// Which way a surface muscle's fibres run at its edges, for anisotropy (4.1): as the nearest of the fibres given with it
// runs or, where none are given, from origin to insertion: up the gradient of how far the insertion's bones carry it.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

class FibreDirections {
 public:
  // Reads fibres, attachments, carriers and carry weights of the asset, which must outlive this; positions (m) by vertex.
  FibreDirections(const SurfaceAsset& asset, std::span<const glm::vec3> positions);

  // k = 1 - |u . v| of an edge, u its direction and v that of the fibres: 0 along them, 1 across or where there are none.
  float across(const Hinge& hinge) const;

 private:
  glm::vec3 given(const glm::vec3& place) const;
  glm::vec3 gradient(const Hinge& hinge) const;

  const SurfaceAsset& asset_;
  std::span<const glm::vec3> positions_;
  std::vector<float> share_;  // by vertex: of what carries it, the insertion's; empty: no telling
};

}  // namespace fascicle::muscle
