#include "modules/muscle/asset/hull/direction_parts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

constexpr std::uint32_t kParts = 8;

// 0..1: where on the line a place's nearest point is.
float nearest_along(std::span<const HullLinePoint> line, const glm::vec3& place) {
  float total = 0.0f, best = std::numeric_limits<float>::max(), along = 0.0f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const glm::vec3 side = line[i + 1].rest - line[i].rest;
    const float length = glm::length(side);
    if (!(length > 0.0f)) continue;
    const float part = glm::clamp(glm::dot(place - line[i].rest, side) / (length * length), 0.0f, 1.0f);
    const float distance = glm::distance(place, line[i].rest + part * side);
    if (distance < best) {
      best = distance;
      along = total + part * length;
    }
    total += length;
  }
  return total > 0.0f ? along / total : 0.0f;
}

}  // namespace

DirectionParts find_direction_parts(const SurfaceAsset& surface, std::span<const HullLinePoint> line) {
  std::array<std::vector<std::uint32_t>, kParts> members;
  std::array<double, kParts> sums{};
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    const SurfacePoint& p = surface.rest[v];
    const float along = nearest_along(line, {p.x, p.y, p.z});
    const auto part = std::min(static_cast<std::uint32_t>(along * static_cast<float>(kParts)), kParts - 1);
    members[part].push_back(v);
    sums[part] += static_cast<double>(along);
  }
  DirectionParts parts;
  std::vector<Eigen::Triplet<double>> entries;
  std::size_t before = kParts;  // the part before; none
  Eigen::Index row = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    if (members[part].empty()) continue;
    parts.along.push_back(static_cast<float>(sums[part] / static_cast<double>(members[part].size())));
    if (before < kParts) {
      for (const std::uint32_t v : members[part]) entries.emplace_back(row, v, 1.0 / static_cast<double>(members[part].size()));
      for (const std::uint32_t v : members[before]) entries.emplace_back(row, v, -1.0 / static_cast<double>(members[before].size()));
      ++row;
    }
    before = part;
  }
  parts.differences.resize(row, surface.vertex_count);
  parts.differences.setFromTriplets(entries.begin(), entries.end());
  return parts;
}

}  // namespace fascicle::muscle
