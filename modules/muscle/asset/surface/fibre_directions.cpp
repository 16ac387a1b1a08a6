#include "modules/muscle/asset/surface/fibre_directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// How near to the insertion a carrier is: a bone is there or is not, sections count along the line.
std::vector<float> places_of_carriers(const SurfaceAsset& asset) {
  std::vector<float> places;
  for (const SurfaceCarrier& carrier : asset.carriers) {
    const bool inserts = std::ranges::any_of(asset.attachments, [&](const SurfaceAttachmentAsset& attachment) {
      return attachment.bone == carrier.bone && !attachment.origin;
    });
    places.push_back(carrier.bone < 0 ? carrier.section : inserts ? 1.0f : 0.0f);
  }
  return places;
}

// Of the linear function on a triangle that has these values at its corners, times twice the area.
glm::vec3 slope(const std::array<glm::vec3, 3>& corner, const std::array<float, 3>& value) {
  const glm::vec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const float length = glm::length(normal);
  if (!(length > 0.0f)) return glm::vec3(0.0f);
  return glm::cross(normal / length, value[0] * (corner[2] - corner[1]) + value[1] * (corner[0] - corner[2]) +
                                         value[2] * (corner[1] - corner[0]));
}

}  // namespace

FibreDirections::FibreDirections(const SurfaceAsset& asset, std::span<const glm::vec3> positions)
    : asset_(asset), positions_(positions) {
  if (!asset.fibres.empty() || asset.carry.empty()) return;
  const std::vector<float> places = places_of_carriers(asset);
  for (const CarryWeights& carry : asset.carry) {
    float share = 0.0f;
    for (std::size_t i = 0; i < 4; ++i) share += carry.weight[i] * places[carry.carrier[i]];
    share_.push_back(share);
  }
}

float FibreDirections::across(const Hinge& hinge) const {
  const glm::vec3 p = positions_[hinge.vertex[0]], q = positions_[hinge.vertex[1]];
  const float length = glm::distance(p, q);
  const glm::vec3 fibre = asset_.fibres.empty() ? gradient(hinge) : given(0.5f * (p + q));
  return length > 0.0f ? 1.0f - std::abs(glm::dot(q - p, fibre)) / length : 1.0f;
}

// The direction of the fibre nearest to a place.
glm::vec3 FibreDirections::given(const glm::vec3& place) const {
  float nearest = std::numeric_limits<float>::max();
  glm::vec3 direction(0.0f);
  for (const FibreLine& fibre : asset_.fibres) {
    for (std::size_t i = 0; i + 1 < fibre.points.size(); ++i) {
      const glm::vec3 along = fibre.points[i + 1] - fibre.points[i];
      const float square = glm::dot(along, along);
      if (!(square > 0.0f)) continue;
      const float f = glm::clamp(glm::dot(place - fibre.points[i], along) / square, 0.0f, 1.0f);
      const float distance = glm::distance(place, fibre.points[i] + f * along);
      if (!(distance < nearest)) continue;
      nearest = distance;
      direction = along / std::sqrt(square);
    }
  }
  return direction;
}

// Over an edge's two triangles.
glm::vec3 FibreDirections::gradient(const Hinge& hinge) const {
  if (share_.empty()) return glm::vec3(0.0f);
  const auto corners = [&](std::size_t a, std::size_t b, std::size_t c) {
    const std::array<std::uint32_t, 3> v = {hinge.vertex[a], hinge.vertex[b], hinge.vertex[c]};
    return slope({positions_[v[0]], positions_[v[1]], positions_[v[2]]}, {share_[v[0]], share_[v[1]], share_[v[2]]});
  };
  const glm::vec3 sum = corners(0, 1, 2) + corners(1, 0, 3);
  const float length = glm::length(sum);
  return length > 0.0f ? sum / length : glm::vec3(0.0f);
}

}  // namespace fascicle::muscle
